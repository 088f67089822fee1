"""Tests run on the installed package, or on the build folders named in PECLET_LOCAL_BUILD."""

import importlib.util
import pathlib
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent


def load_script(path: pathlib.Path, name: str | None = None):
    """Import a Python file that belongs to no package."""
    name = name or path.stem
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


load_script(REPOSITORY / "examples" / "local_build.py").use_local_build()
