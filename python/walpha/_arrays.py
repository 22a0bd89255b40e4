"""Array-likes as the library takes them."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._typing import Arrays, Floats, Indices, Samples

_Number = TypeVar("_Number", bound=np.generic)


def column(name: str, given: Arrays, what: str = "point") -> Floats:
    """One number for each point, float64; no copy where they are that already."""
    array = numbers(name, given)
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}, expected (n,): give one number for each {what}")
    return doubles(name, array)


def optional(name: str, given: Arrays | None) -> Floats | None:
    """One number for each point, where they are given."""
    return None if given is None else column(name, given)


def points(given: Arrays, name: str = "points") -> Floats:
    """Places, n×3; those of a plane, n×2, are at z = 0. An empty list is not a place."""
    array = numbers(name, given)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim == 2 and array.shape[1] == 2:
        in_space = np.zeros((len(array), 3))
        in_space[:, :2] = doubles(name, array)
        return in_space
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, expected (n, 3) or (n, 2): x, y, z of each")
    return doubles(name, array)


def doubles(name: str, array: NDArray[Any]) -> Floats:
    """The numbers as float64. An integer that no double is, is an error, and not another number."""
    nearest = array.astype(np.float64, copy=False)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8:
        # Smaller ones all are doubles.
        for at in zip(*np.nonzero(np.abs(nearest) >= 2.0**53)):
            if int(array[at]) != int(nearest[at]):
                raise ValueError(
                    f"{name}: row {at[0]} holds {array[at]}, which float64 does not hold, only {int(nearest[at])}: "
                    "subtract an offset first, or round on purpose, by .astype(float)"
                )
    return nearest


def finite(name: str, array: Floats) -> Floats:
    """The same, if all of it are numbers and finite."""
    if not np.isfinite(array).all():
        at = tuple(np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name}: row {at[0]} holds {array[at]}: give finite numbers")
    return array


def place(name: str, given: Arrays) -> list[float]:
    """Three finite numbers x, y, z."""
    array = numbers(name, given)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name}={given!r}: give three finite numbers, x, y and z")
    return [float(number) for number in doubles(name, array)]


def sides(given: Arrays | None) -> list[float] | None:
    """The sides of a periodic box, or None."""
    if given is None:
        return None
    array = numbers("periodic", given)
    if array.ndim == 0:
        array = np.repeat(array, 3)
    if array.shape != (3,):
        raise ValueError(f"periodic has shape {array.shape}: give the sides of the box along x, y and z")
    return [float(side) for side in doubles("periodic", array)]


def samples(given: Arrays) -> tuple[Samples, bool]:
    """A volume `[z, y, x]` as float32, and whether it holds gray levels (unsigned bytes)."""
    array = numbers("volume", given)
    if array.ndim != 3:
        raise ValueError(f"volume has shape {array.shape}: give an array of three axes [z, y, x]")
    with np.errstate(over="ignore"):
        return array.astype(np.float32, copy=False), array.dtype == np.uint8


def indices(name: str, given: Arrays | None, columns: int) -> NDArray[np.uint32] | None:
    """Rows of input indices as uint32, n×columns."""
    if given is None:
        return None
    array = _array(name, given)
    if array.size == 0:
        return np.zeros((0, columns), np.uint32)
    if columns == 1 and array.ndim == 1:
        array = array[:, None]
    if array.ndim != 2 or array.shape[1] != columns:
        expected = "(n,)" if columns == 1 else f"(n, {columns})"
        raise ValueError(f"{name} has shape {array.shape}, expected {expected}: rows of input indices")
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} must be integers, input indices from 0 on, not {array.dtype}")
    least, most = array.min(), array.max()
    if least < 0 or most >= 2**32:
        raise ValueError(f"{name} holds the index {least if least < 0 else most}: they count from 0")
    return array.astype(np.uint32, copy=False)


def int64(rows: NDArray[Any]) -> Indices:
    """Indices as they are given out: of 64 bits, as numpy indexes."""
    return rows.astype(np.int64)


def frozen(array: NDArray[_Number]) -> NDArray[_Number]:
    """What an object keeps and gives out again: nobody can write to it."""
    array.flags.writeable = False
    return array


def kept(rows: NDArray[Any]) -> Indices:
    """Indices that an object keeps."""
    return frozen(int64(rows))


def numbers(name: str, given: Arrays) -> NDArray[Any]:
    """An array of real numbers."""
    array = _array(name, given)
    if array.size and array.dtype.kind not in "fiub":
        raise ValueError(f"{name} must be real numbers, not {array.dtype}{_advice(given)}")
    if array.dtype.kind == "f":
        _check_columns(name, given)
    return array


def _check_columns(name: str, frame: Any) -> None:
    """Integers in a frame, which hands over floats where one of its columns has floats, must be doubles."""
    for label in getattr(frame, "columns", ()):
        column = _array(name, frame[label])
        if column.dtype.kind in "iu":
            doubles(f"{name}: column {label!r}", column)


def _array(name: str, given: Any) -> NDArray[Any]:
    try:
        if hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
            return np.from_dlpack(given)
        array = np.asarray(given)
        # Frames with missing values, or of extension types, hand over objects.
        if array.dtype == object and hasattr(given, "columns") and not _advice(given):
            return array.astype(np.float64)
        return array
    except (ValueError, TypeError, RuntimeError, BufferError) as error:
        raise ValueError(f"{name} cannot be read as an array: {error}") from None


def _advice(given: Any) -> str:
    """Which columns of a frame are no numbers."""
    if not hasattr(given, "columns"):
        return ""
    wrong = [name for name, dtype in zip(given.columns, given.dtypes) if not _is_numeric(dtype)]
    if not wrong:
        return ""
    return f": choose columns of numbers; {', '.join(map(repr, wrong))} holds none"


def _is_numeric(dtype: Any) -> bool:
    is_numeric = getattr(dtype, "is_numeric", None)
    if callable(is_numeric):
        return bool(is_numeric())
    return getattr(dtype, "kind", "O") in "fiub"
