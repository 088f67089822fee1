"""Tests run on the installed package, or on the build folders named in PECLET_LOCAL_BUILD."""

import importlib.util
import pathlib
import re
import sys

import pytest

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


def run_page(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs the Python cells of folder/index.qmd in order; every figure label belongs to one figure."""
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "path", [*sys.path])
    text = (folder / "index.qmd").read_text(encoding="utf-8")
    names = {}
    for code in re.findall(r"^```\{python\}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        exec(compile(code, "index.qmd", "exec"), names)
    from matplotlib import pyplot

    assert len(pyplot.get_fignums()) == text.count("label: fig-")
    pyplot.close("all")
