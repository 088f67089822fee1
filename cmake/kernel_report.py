"""Registers and spills of kernels, from the log of a build with NVCC_APPEND_FLAGS=-Xptxas=-v.

python cmake/kernel_report.py LOG [number of kernels to list]
"""

from __future__ import annotations

import dataclasses
import pathlib
import re
import sys
from collections.abc import Iterable

ENTRY = re.compile(r"Compiling entry function '(\w+)'")
STACK = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
REGISTERS = re.compile(r"Used (\d+) registers")
LENGTH = re.compile(r"S[0-9A-Z]*_|([1-9]\d*)")  # or a substitution
LAUNCHER = re.compile(
    r"peclet|core|flow|dem|detail|launch\w*|for_each\w*|sum_\w+|max_\w+|list_where|exclusive_sum|sweep\w*"
    r"|Array|Field|Stage|RowRanges|_GLOBAL_\w*"
)


@dataclasses.dataclass
class Kernel:
    """What the assembler says of one kernel; sizes in bytes per thread."""

    symbol: str
    registers: int = 0
    stack: int = 0
    spill_stores: int = 0
    spill_loads: int = 0

    @property
    def name(self) -> str:
        """As in the sources."""
        return name_of(self.symbol)

    @property
    def spills(self) -> int:
        """Stores and loads together."""
        return self.spill_stores + self.spill_loads


def parse(lines: Iterable[str]) -> list[Kernel]:
    """Kernels of a log; one that was compiled again counts as in its last compilation."""
    kernels: dict[str, Kernel] = {}
    kernel = None
    for line in lines:
        if found := ENTRY.search(line):
            kernel = kernels[found[1]] = Kernel(found[1])
        elif kernel and (found := STACK.search(line)):
            kernel.stack, kernel.spill_stores, kernel.spill_loads = map(int, found.groups())
        elif kernel and (found := REGISTERS.search(line)):
            kernel.registers = int(found[1])
            kernel = None
    return list(kernels.values())


def identifiers(symbol: str) -> list[str]:
    """The names in a mangled symbol, each of which follows its length."""
    names, place = [], 0
    while found := LENGTH.search(symbol, place):
        place = found.end()
        name = symbol[place : place + int(found[1] or 0)]
        if name.isidentifier():
            names.append(name)
            place += len(name)
    return names


def name_of(symbol: str) -> str:
    """The first names of ours that are not those of launchers; demanglers reject symbols of nvcc."""
    ours = symbol.partition("6peclet")[2].partition("PKc")[0]
    names = [name for name in dict.fromkeys(identifiers(ours)) if not LAUNCHER.fullmatch(name)]
    return " ".join(names[:3]) or symbol[:80]


def report(kernels: list[Kernel], most: int) -> str:
    """Totals, then the kernels with most spills and registers."""
    ours = [kernel for kernel in kernels if "peclet" in kernel.symbol]
    ours.sort(key=lambda kernel: (-kernel.spills, -kernel.registers, kernel.name))
    spilling = sum(kernel.spills > 0 for kernel in ours)
    lines = [f"{len(ours)} kernels, {spilling} of them spill registers", "registers  stack  spills  kernel"]
    lines += [f"{k.registers:9d} {k.stack:6d} {k.spills:7d}  {k.name}" for k in ours[:most]]
    return "\n".join(lines)


if __name__ == "__main__":
    log = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8", errors="replace")
    print(report(parse(log.splitlines()), int(sys.argv[2]) if len(sys.argv) > 2 else 20))
