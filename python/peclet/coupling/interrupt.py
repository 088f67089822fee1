"""Loops with a progress bar that Ctrl-C ends between two passes."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def between_steps(count: int, progress: bool) -> Iterator[Iterator[int]]:
    """Yield count passes. After Ctrl-C the pass under way ends and KeyboardInterrupt is raised."""
    from tqdm import tqdm

    interrupted = False

    def remember(*_: Any) -> None:
        nonlocal interrupted
        interrupted = True

    def passes() -> Iterator[int]:
        with tqdm(total=count, disable=not progress, unit="step") as bar:
            for n in range(count):
                yield n
                bar.update()
                if interrupted:
                    raise KeyboardInterrupt(f"stopped after {n + 1} of {count} steps")

    # Only the main thread may install handlers; elsewhere Ctrl-C never arrives.
    is_main = threading.current_thread() is threading.main_thread()
    handler = signal.signal(signal.SIGINT, remember) if is_main else None
    try:
        yield passes()
    finally:
        if is_main:
            signal.signal(signal.SIGINT, handler)
