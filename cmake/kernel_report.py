"""Registers and spills of kernels, from the log of a build with NVCC_APPEND_FLAGS=-Xptxas=-v.

python cmake/kernel_report.py LOG [number of kernels to list]
"""

from __future__ import annotations

import dataclasses
import pathlib
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable

ENTRY = re.compile(r"Compiling entry function '(\w+)'")
STACK = re.compile(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads")
REGISTERS = re.compile(r"Used (\d+) registers")
NAME = re.compile(r"peclet::(?:\w+::|\(anonymous namespace\)::)*\w+")
LAUNCHERS = re.compile(
    r"::(?:for_each\w*|sum_\w+|max_\w+|enumerate|exclusive_sum|sweep\w*|Array|Field|Stage)$"
)


@dataclasses.dataclass
class Kernel:
    """What the assembler says of one kernel; sizes in bytes per thread."""

    symbol: str
    registers: int = 0
    stack: int = 0
    spill_stores: int = 0
    spill_loads: int = 0
    name: str = ""

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


def name_kernels(kernels: list[Kernel]) -> None:
    """The functions of ours that the symbols contain, launchers left out."""
    names = [kernel.symbol for kernel in kernels]
    if kernels and shutil.which("c++filt"):
        text = "\n".join(names)
        names = subprocess.run(
            ["c++filt"], input=text, capture_output=True, text=True, check=True
        ).stdout.split("\n")
    for kernel, symbol in zip(kernels, names, strict=False):
        ours = [name for name in dict.fromkeys(NAME.findall(symbol)) if not LAUNCHERS.search(name)]
        short = [name.removeprefix("peclet::").replace("(anonymous namespace)::", "") for name in ours[:2]]
        kernel.name = " in ".join(reversed(short)) or symbol[:80]


def report(kernels: list[Kernel], most: int) -> str:
    """Totals, then the kernels with most spills and registers."""
    ours = [kernel for kernel in kernels if "peclet" in kernel.symbol]
    name_kernels(ours)
    ours.sort(key=lambda kernel: (-kernel.spills, -kernel.registers, kernel.name))
    spilling = sum(kernel.spills > 0 for kernel in ours)
    lines = [f"{len(ours)} kernels, {spilling} of them spill registers", "registers  stack  spills  kernel"]
    lines += [f"{k.registers:9d} {k.stack:6d} {k.spills:7d}  {k.name}" for k in ours[:most]]
    return "\n".join(lines)


if __name__ == "__main__":
    log = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8", errors="replace")
    print(report(parse(log.splitlines()), int(sys.argv[2]) if len(sys.argv) > 2 else 20))
