"""Run pages, scripts and tests on build folders instead of the installed package.

PECLET_LOCAL_BUILD=core/build:flow/build:dem/build python examples/drafting-kissing-tumbling/run.py
"""

import os
import pathlib
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent


def _find(folder: str) -> pathlib.Path:
    """Relative folders count from the working directory or from the root of the repository."""
    candidates = (pathlib.Path(folder).absolute(), REPOSITORY / folder)
    for candidate in candidates:
        if (candidate / "peclet").is_dir():
            return candidate
    raise FileNotFoundError(
        f"PECLET_LOCAL_BUILD: expected build folders that contain peclet/, found {folder!r} "
        f"(looked for {' and '.join(str(candidate) for candidate in candidates)})"
    )


def use_local_build() -> list[pathlib.Path]:
    """Put the folders of PECLET_LOCAL_BUILD first on sys.path; without it, change nothing."""
    folders = [_find(entry) for entry in os.environ.get("PECLET_LOCAL_BUILD", "").split(os.pathsep) if entry]
    sys.path[:0] = [str(folder) for folder in folders if str(folder) not in sys.path]
    return folders
