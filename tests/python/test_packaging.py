"""What is installed: one Kokkos for all modules, stubs, quiet imports, and help where something is wrong."""

import ast
import importlib
import itertools
import os
import pathlib
import re
import subprocess
import sys

import pytest

from tests.conftest import REPOSITORY, load_script

MODULES = {"peclet.core.geom": "_geom", "peclet.flow": "_flow", "peclet.dem": "_dem"}
local_build = load_script(REPOSITORY / "examples" / "local_build.py")


def run_python(code: str, *path: pathlib.Path, **variables: str) -> subprocess.CompletedProcess:
    """Run code in a new process that sees the folders of path, then what this one sees."""
    folders = [str(folder) for folder in path] + [folder for folder in sys.path if folder]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
    environment |= {"PYTHONPATH": os.pathsep.join(folders)} | variables
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)


def test_peclet_is_a_namespace_that_others_can_extend(tmp_path):
    (tmp_path / "peclet").mkdir()
    (tmp_path / "peclet" / "neighbour.py").write_text("answer = 42\n")
    answer = run_python("import peclet.flow, peclet.neighbour; print(peclet.neighbour.answer)", tmp_path)
    assert answer.stdout == "42\n", answer.stderr


def test_both_names_of_the_geometry_module_mean_the_same():
    from peclet import geom as short
    from peclet.core import geom as long

    assert short.SceneBuilder is long.SceneBuilder


@pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="reads the libraries of a process from /proc"
)
@pytest.mark.parametrize("order", list(itertools.permutations(MODULES)))
def test_the_modules_share_one_kokkos(order):
    code = f"""
import {", ".join(order)}
lines = open("/proc/self/maps").read().splitlines()
print(len({{line.split()[-1] for line in lines if "kokkoscore" in line}}))
"""
    answer = run_python(code)
    assert answer.stdout == "1\n", answer.stderr


def test_imports_are_quiet():
    answer = run_python(f"import {', '.join(MODULES)}")
    assert (answer.returncode, answer.stdout, answer.stderr) == (0, "", "")


@pytest.mark.parametrize(("package", "extension"), MODULES.items())
def test_stub_describes_every_public_name(package, extension):
    module = importlib.import_module(f"{package}.{extension}")
    stub = pathlib.Path(module.__file__).parent / f"{extension}.pyi"
    if importlib.import_module("peclet._build").backend == "cuda":
        pytest.skip("stubs are written on machines without a GPU build")
    assert (stub.parent / "py.typed").exists()
    body = ast.parse(stub.read_text(encoding="utf-8")).body
    described = {node.name for node in body if hasattr(node, "name")}
    described |= {node.target.id for node in body if isinstance(node, ast.AnnAssign)}
    assert {name for name in vars(module) if not name.startswith("_")} <= described


def test_warns_once_where_the_other_family_is_installed(tmp_path):
    (tmp_path / "peclet_flow-0.5.1.dist-info").mkdir()
    answer = run_python(f"import {', '.join(MODULES)}", tmp_path)
    assert answer.returncode == 0, answer.stderr
    assert answer.stderr.count("peclet-resolved and peclet-flow provide the same import names") == 1


@pytest.mark.skipif(sys.platform != "linux", reason="the processor is described in /proc/cpuinfo")
def test_refuses_a_processor_that_it_was_not_built_for(tmp_path):
    (tmp_path / "peclet").mkdir()
    (tmp_path / "peclet" / "_build.py").write_text('backend = "openmp"\ninstruction_sets = {"imaginary"}\n')
    answer = run_python("import peclet.flow", tmp_path)
    assert answer.returncode == 1
    assert "ImportError: peclet-resolved was built for processors with imaginary" in answer.stderr


def test_developers_have_what_the_package_depends_on():
    project = (REPOSITORY / "pyproject.toml").read_text(encoding="utf-8")
    dependencies = ast.literal_eval(re.search(r"^dependencies = (\[.*\])$", project, re.MULTILINE)[1])
    tools = (REPOSITORY / "requirements-dev.txt").read_text(encoding="utf-8").splitlines()
    assert set(dependencies) <= set(tools)


def test_local_build_comes_first_in_the_given_order(tmp_path, monkeypatch):
    for name in ("one", "two"):
        (tmp_path / name / "peclet").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["elsewhere"])
    monkeypatch.setenv("PECLET_LOCAL_BUILD", f"one{os.pathsep}{tmp_path / 'two'}")
    local_build.use_local_build()
    assert sys.path == [str(tmp_path / "one"), str(tmp_path / "two"), "elsewhere"]


def test_local_build_names_the_folder_that_is_no_build(tmp_path, monkeypatch):
    monkeypatch.setenv("PECLET_LOCAL_BUILD", str(tmp_path))
    with pytest.raises(FileNotFoundError, match=r"PECLET_LOCAL_BUILD: expected .* found '.*test_local_build"):
        local_build.use_local_build()


def test_without_local_build_nothing_changes(monkeypatch):
    monkeypatch.delenv("PECLET_LOCAL_BUILD", raising=False)
    before = list(sys.path)
    assert local_build.use_local_build() == []
    assert sys.path == before
