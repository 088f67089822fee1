"""Files from which a run goes on: named arrays, as .npz or .h5."""

from __future__ import annotations

import pathlib
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

State = dict[str, NDArray[Any]]


def write(path: str | pathlib.Path, state: State) -> None:
    """Write all arrays; a file of that name is replaced only when the new one is complete."""
    path = pathlib.Path(path)
    form = _form(path)
    unfinished = path.with_name(path.name + ".unfinished")
    try:
        if form == ".npz":
            with unfinished.open("wb") as file:
                np.savez(file, **state)
        else:
            with _h5py().File(unfinished, "w") as file:
                for name, array in state.items():
                    file[name] = array
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def read(path: str | pathlib.Path) -> State:
    """What write() wrote."""
    path = pathlib.Path(path)
    form = _form(path)
    if not path.is_file():
        raise FileNotFoundError(f"path: expected a file written by save(), found none at {str(path)!r}")
    if form == ".npz":
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    state: State = {}
    with _h5py().File(path, "r") as file:
        file.visititems(lambda name, item: state.update({name: item[()]}) if hasattr(item, "dtype") else None)
    return {name: np.asarray(array) for name, array in state.items()}


def join(parts: Mapping[str, State]) -> State:
    """One mapping with names such as flow/u.

    >>> list(join({"flow": {"u": np.zeros(1)}}))
    ['flow/u']
    """
    return {f"{part}/{name}": array for part, arrays in parts.items() for name, array in arrays.items()}


def split(state: Mapping[str, Any], parts: Iterable[str]) -> dict[str, State]:
    """The inverse of join()."""
    result: dict[str, State] = {part: {} for part in parts}
    for full_name, array in state.items():
        part, _, name = full_name.partition("/")
        if part not in result or not name:
            raise ValueError(
                f"state: expected names that start with one of {sorted(result)}, found {full_name!r}"
            )
        result[part][name] = np.asarray(array)
    return result


def require_shapes(arrays: State, shapes: Mapping[str, tuple[int, ...]], part: str) -> None:
    """Raise ValueError naming what is missing, unknown, of another shape or not finite."""
    if set(arrays) != set(shapes):
        raise ValueError(f"state: expected {part} with {sorted(shapes)}, found {sorted(arrays)}")
    for name, shape in shapes.items():
        array = arrays[name]
        if array.shape != shape:
            raise ValueError(
                f"state: expected {part}/{name} of shape {shape}, found {array.shape}; "
                "was it saved from a run of the same size?"
            )
        if array.dtype.kind not in "iuf" or not np.isfinite(array).all():
            raise ValueError(f"state: expected finite numbers in {part}/{name}, found others")


def _form(path: pathlib.Path) -> str:
    if path.suffix in (".npz", ".h5"):
        return path.suffix
    raise ValueError(f"path: expected a name that ends in .npz or .h5, found {str(path)!r}")


def _h5py() -> Any:
    try:
        import h5py
    except ImportError:
        raise ImportError(
            'files ending in .h5 need h5py: pip install "peclet-resolved[io]", or end the name in .npz'
        ) from None
    return h5py
