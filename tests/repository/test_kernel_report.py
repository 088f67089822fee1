"""The report of registers and spills reads what the assembler prints."""

import importlib.util
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOG = """[1/2] Building CXX object flow/a.cpp.o
ptxas info    : 0 bytes gmem
ptxas info    : Compiling entry function '_ZN6peclet4flow5firstEv' for 'sm_90'
ptxas info    : Function properties for _ZN6peclet4flow5firstEv
    16 bytes stack frame, 8 bytes spill stores, 12 bytes spill loads
ptxas info    : Used 255 registers, used 1 barriers, 16 bytes cumulative stack size
ptxas info    : Compiling entry function '_ZN6Kokkos4fillEv' for 'sm_90'
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 8 registers
ptxas info    : Compiling entry function '_ZN6peclet4flow6secondEv' for 'sm_90'
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 40 registers
"""


def load():
    specification = importlib.util.spec_from_file_location(
        "kernel_report", ROOT / "cmake" / "kernel_report.py"
    )
    module = importlib.util.module_from_spec(specification)
    sys.modules["kernel_report"] = module
    specification.loader.exec_module(module)
    return module


def test_registers_and_spills_are_read():
    kernels = load().parse(LOG.splitlines())
    assert [(k.registers, k.stack, k.spills) for k in kernels] == [(255, 16, 20), (8, 0, 0), (40, 0, 0)]


def test_a_kernel_counts_once():
    again = LOG.replace("Used 255", "Used 128")
    kernels = load().parse((LOG + again).splitlines())
    assert len(kernels) == 3
    assert kernels[0].registers == 128


def test_report_lists_our_kernels_by_spills():
    module = load()
    lines = module.report(module.parse(LOG.splitlines()), most=5).splitlines()
    assert lines[0] == "2 kernels, 1 of them spill registers"
    assert [line.split()[:3] for line in lines[2:]] == [["255", "16", "20"], ["40", "0", "0"]]
    assert [line.split()[3:] for line in lines[2:]] == [["first"], ["second"]]
