"""The ways to build that ./dev does not use: a portable wheel used elsewhere, and each library alone."""

import os
import pathlib
import subprocess
import sys

import pytest

from tests.conftest import REPOSITORY

pytestmark = pytest.mark.slow

USE_ALL_MODULES = """
import os
from peclet import dem, flow
from peclet.core import geom
scene = geom.SceneBuilder()
scene.add_instance(scene.add_leaf("sphere", [2.0]), [3.5, 3.5, 3.5])
solver = flow.Solver(8, 8, 8)
solver.set_scene(*scene.encode(), periodic=True)
solver.set_solid_from_scene()
solver.step()
libraries = {line.split()[-1] for line in open("/proc/self/maps") if "kokkoscore" in line}
print(len(libraries), *(os.path.dirname(module.__file__) for module in (geom, flow, dem)), sep="\\n")
"""


def run(*command: str | pathlib.Path, **options) -> str:
    answer = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    assert answer.returncode == 0, answer.stdout + answer.stderr
    return answer.stdout


def test_wheel_works_elsewhere_without_the_source_tree(tmp_path):
    run(
        *(sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", tmp_path),
        *("-C", "cmake.define.PECLET_NATIVE=OFF", REPOSITORY),
    )
    (wheel,) = tmp_path.glob("peclet_resolved-*.whl")
    elsewhere = tmp_path / "elsewhere"
    run(sys.executable, "-m", "pip", "install", "--no-deps", "--target", elsewhere, wheel)
    code = f"import sys; sys.path.insert(0, {str(elsewhere)!r})\n" + USE_ALL_MODULES
    count, *folders = run(sys.executable, "-I", "-c", code, cwd=tmp_path).split()
    assert count == "1"
    assert folders == [str(elsewhere / "peclet" / name) for name in ("core/geom", "flow", "dem")]


def test_libraries_build_alone_and_run_together(tmp_path):
    builds = {name: tmp_path / name for name in ("core", "flow", "dem")}
    for name, build in builds.items():
        run("cmake", "-S", REPOSITORY / name, "-B", build, f"-DPython_EXECUTABLE={sys.executable}")
        run("cmake", "--build", build)
    code = f"import sys; sys.path.insert(0, {str(REPOSITORY / 'examples')!r})\n"
    code += "import local_build; local_build.use_local_build()\n" + USE_ALL_MODULES
    environment = os.environ | {"PECLET_LOCAL_BUILD": os.pathsep.join(map(str, builds.values()))}
    count, *folders = run(sys.executable, "-c", code, cwd=tmp_path, env=environment).split()
    assert count == "1"
    assert folders == [
        str(builds[name] / "peclet" / inside)
        for name, inside in {"core": "core/geom", "flow": "flow", "dem": "dem"}.items()
    ]
