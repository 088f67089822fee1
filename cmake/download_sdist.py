"""Download a source distribution without building it: download_sdist.py 'name==version' FILE.

pip would run the build of the package to read its metadata; the small package unearth does not. It is
installed into a temporary virtual environment when this Python lacks it.
"""

import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import venv


def python_with_unearth(folder: pathlib.Path) -> str:
    if importlib.util.find_spec("unearth"):
        return sys.executable
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    subprocess.run(
        [python, "-m", "pip", "install", "--quiet", "unearth"], check=True, env=clean_environment()
    )
    return str(python)


def clean_environment() -> dict[str, str]:
    """Without the paths by which pip isolates a build; they would hide what the new environment installs."""
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}


def index_options() -> list[str]:
    """The package index that pip is configured to use, if it is not the public one."""
    answer = subprocess.run(
        [sys.executable, "-m", "pip", "config", "get", "global.index-url"], capture_output=True, text=True
    )
    url = os.environ.get("PIP_INDEX_URL") or answer.stdout.strip()
    return ["--index-url", url] if url else []


def main(requirement: str, target: str) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        python = python_with_unearth(folder / "venv")
        command = [python, "-m", "unearth", "--no-binary", *index_options(), "-d", str(folder), requirement]
        answer = subprocess.run(command, capture_output=True, text=True, env=clean_environment())
        if answer.returncode:
            sys.exit(answer.stderr or answer.stdout)
        shutil.move(json.loads(answer.stdout)["local_path"], target)


if __name__ == "__main__":
    main(*sys.argv[1:])
