"""Incompressible flow around fixed and moving bodies on a staggered grid: see Solver."""

from typing import NoReturn

from peclet import _environment  # noqa: F401  checks the machine before compiled code loads
from peclet.flow import _flow
from peclet.flow._base import SolverReport
from peclet.flow._flow import AdvectionScheme
from peclet.flow.diagnostics import SolverDiagnostics
from peclet.flow.solver import Solver
from peclet.flow.steady import SteadyResult, march_to_steady

__all__ = [
    "AdvectionScheme",
    "Solver",
    "SolverDiagnostics",
    "SolverReport",
    "SteadyResult",
    "execution_space",
    "finalize",
    "has_mpi",
    "march_to_steady",
]

execution_space: str = _flow.execution_space
has_mpi: bool = False


def finalize() -> None:
    """Accepted from scripts: the run time ends with the process."""


def __getattr__(name: str) -> NoReturn:
    if name.startswith("SolverColocated"):
        raise AttributeError(f"{name}: a collocated grid is not part of peclet-resolved")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
