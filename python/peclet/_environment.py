"""What every module checks before it loads compiled code; done once, by importing this file."""

import pathlib
import platform
import sys
import warnings

from peclet import _build

_REFERENCE = ("peclet-flow", "peclet-dem", "peclet-geom")


def _missing_instruction_sets() -> set[str]:
    """Instruction sets that the compiled code uses and this processor lacks."""
    description = pathlib.Path("/proc/cpuinfo")
    if platform.machine() not in ("x86_64", "AMD64") or not description.exists():
        return set()
    for line in description.read_text().splitlines():
        if line.startswith("flags"):
            return set(_build.instruction_sets) - set(line.split())
    return set()


def _check_processor() -> None:
    missing = _missing_instruction_sets()
    if missing:
        raise ImportError(
            f"peclet-resolved was built for processors with {', '.join(sorted(missing))}, "
            "which this one lacks. Build it on this machine, or with "
            "-C cmake.define.PECLET_NATIVE=OFF for any processor since 2015."
        )


def _is_installed(distribution: str) -> bool:
    """Like importlib.metadata, which would be slow to load."""
    pattern = distribution.replace("-", "_") + "-*.dist-info"
    return any(next(pathlib.Path(folder).glob(pattern), None) for folder in sys.path if folder)


def _warn_about_the_other_family() -> None:
    found = [name for name in _REFERENCE if _is_installed(name)]
    if found:
        warnings.warn(
            f"peclet-resolved and {', '.join(found)} provide the same import names and overwrite "
            "each other's files; keep them in separate virtual environments.",
            stacklevel=2,
        )


_check_processor()
_warn_about_the_other_family()
