"""Array-likes as the library takes them."""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _tables
from ._typing import Arrays, Floats, Indices, Samples

_Number = TypeVar("_Number", bound=np.generic)


class Cloud(NamedTuple):
    """Points as the library takes them."""

    points: Floats
    weights: Floats | None
    values: Floats | None


def cloud(points: Arrays, weights: Arrays | None = None, values: Arrays | None = None, *, valued: bool = True) -> Cloud:
    """Points with their weights and values, given beside them or as columns of a table.

    Masked rows are not points: they are left out, of weights and values too.
    """
    wanted = ("weight", "radius", "value") if valued else ("weight", "radius")
    table = _tables.columns("points", points, wanted)
    given: dict[str, Any]
    if table is None:
        places = _space("points", _real("points", points))
        given = {"weights": weights, "values": values}
    else:
        places = _space("points", _beside("points", table))
        given = {"weights": _own_weights(table), "values": table.get("value")}
        for name, beside in (("weights", weights), ("values", values)):
            if beside is not None and given[name] is not None:
                raise ValueError(f"{name} are given twice: as {name}= and as a column of points; omit one")
            given[name] = given[name] if beside is None else beside
    kept: NDArray[np.bool_] | None = None
    if np.ma.is_masked(places):
        kept = np.logical_not(np.ma.getmaskarray(places).any(axis=1))
    of_points = np.ma.getdata(places)
    columns = {name: _rows_of(name, own, kept) for name, own in given.items() if own is not None}
    return Cloud(of_points if kept is None else of_points[kept], columns.get("weights"), columns.get("values"))


def _own_weights(table: dict[str, Any]) -> Any:
    """The weights of a table: a column weight, or else the squares of a column radius."""
    if "weight" in table or "radius" not in table:
        return table.get("weight")
    name = "points['radius']"
    return doubles(name, _real(name, table["radius"])) ** 2


def _beside(name: str, table: dict[str, Any]) -> NDArray[Any]:
    """The places of a table, n×3 or n×2."""
    named = {axis: f"{name}[{axis!r}]" for axis in ("x", "y", "z") if axis in table}
    axes = [doubles(of, _real(of, table[axis])) for axis, of in named.items()]
    return np.ma.stack(axes, axis=1) if any(map(np.ma.isMaskedArray, axes)) else np.stack(axes, axis=1)


def _rows_of(name: str, given: Arrays, kept: NDArray[np.bool_] | None) -> Floats:
    """A column of the rows that are kept, none of which may be masked."""
    array = _one_each(name, _real(name, given))
    if kept is not None and len(array) != len(kept):
        raise ValueError(f"{len(array)} {name} for {len(kept)} points, those that are masked included")
    if np.ma.is_masked(array):
        missing = np.ma.getmaskarray(array) & (True if kept is None else kept)
        if missing.any():
            row = missing.argmax()
            raise ValueError(f"{name} is masked in row {row}, and the point is not: mask the point, too, or give a number")
    column_ = np.ma.getdata(array)
    return doubles(name, column_ if kept is None else column_[kept])


def column(name: str, given: Arrays, what: str = "point") -> Floats:
    """One number for each point, float64; no copy where they are that already."""
    return doubles(name, _one_each(name, numbers(name, given), what))


def _one_each(name: str, array: NDArray[Any], what: str = "point") -> NDArray[Any]:
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}, expected (n,): give one number for each {what}")
    return array


def optional(name: str, given: Arrays | None) -> Floats | None:
    """One number for each point, where they are given."""
    return None if given is None else column(name, given)


def points(given: Arrays, name: str = "points") -> Floats:
    """Places, n×3; those of a plane, n×2, are at z = 0. An empty list is not a place."""
    table = _tables.columns(name, given, ())
    array = _real(name, given) if table is None else _beside(name, table)
    return _space(name, _unmasked(name, array))


def places(name: str, given: Arrays) -> NDArray[Any]:
    """Places in an array of any shape, the coordinates last, or those of a table."""
    table = _tables.columns(name, given, ())
    return numbers(name, given) if table is None else _unmasked(name, _beside(name, table))


def _space(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """Places n×3, float64, masked where they were."""
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim == 2 and array.shape[1] == 2:
        in_space = (np.ma.zeros if np.ma.isMaskedArray(array) else np.zeros)((len(array), 3))
        in_space[:, :2] = doubles(name, array)
        return in_space
    if array.ndim != 2 or array.shape[1] != 3:
        fourth = array.ndim == 2 and array.shape[1] == 4
        also = "; give a fourth column as weights= or values=" if fourth else ""
        raise ValueError(f"{name} has shape {array.shape}, expected (n, 3) or (n, 2): x, y, z of each{also}")
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


def finite_cloud(points: Arrays, weights: Arrays | None = None, values: Arrays | None = None) -> Cloud:
    """:func:`cloud`, if all of it are numbers and finite."""
    given = cloud(points, weights, values)
    for name, column_ in zip(given._fields, given):
        if column_ is not None:
            finite(name, column_)
    return given


def place(name: str, given: Arrays) -> list[float]:
    """Three finite numbers x, y, z."""
    array = numbers(name, given)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name}={given!r}: give three finite numbers, x, y and z")
    return [float(number) for number in doubles(name, array)]


Box = tuple[float, float, float] | tuple[tuple[float, float, float], ...]


def sides(given: Arrays | None) -> list[float] | None:
    """The sides of a periodic box, or the components of its vectors, or None."""
    if given is None:
        return None
    array = numbers("periodic", given)
    if array.ndim == 0:
        array = np.repeat(array, 3)
    if array.shape not in ((3,), (3, 3)):
        raise ValueError(
            f"periodic has shape {array.shape}: give the sides of the box along x, y and z, or its three vectors as rows"
        )
    return [float(number) for number in doubles("periodic", array).ravel()]


def box(numbers: list[float] | None) -> Box | None:
    """The sides or vectors of a periodic box, of :func:`sides`."""
    if numbers is None:
        return None
    if len(numbers) == 3:
        return numbers[0], numbers[1], numbers[2]
    return tuple((numbers[k], numbers[k + 1], numbers[k + 2]) for k in (0, 3, 6))


def samples(given: Arrays) -> tuple[Samples, bool, bool]:
    """A volume `[z, y, x]` as float32, whether it holds gray levels (unsigned bytes), and whether samples are masked, which
    are NaN then."""
    array = _real("volume", given)
    if array.ndim != 3:
        raise ValueError(f"volume has shape {array.shape}: give an array of three axes [z, y, x]")
    masked = np.ma.getmaskarray(array) if np.ma.is_masked(array) else None
    numbers = np.ma.getdata(array)
    with np.errstate(over="ignore"):
        values = numbers.astype(np.float32, copy=masked is not None)
    is_wide = numbers.dtype.kind in "iu" and numbers.dtype.itemsize > 2
    if is_wide and np.any(values.astype(np.float64) != numbers):
        text = (
            "volume: whole numbers beyond 16777216 (2²⁴) are rounded to samples of single precision: "
            "different ones, as of labels, may become the same"
        )
        warnings.warn(text, stacklevel=4)
    if masked is not None:
        values[masked] = np.nan
    return values, array.dtype == np.uint8, masked is not None


def indices(name: str, given: Arrays | None, columns: int) -> NDArray[np.uint32] | None:
    """Rows of input indices as uint32, n×columns."""
    if given is None:
        return None
    array = _unmasked(name, _array(name, given))
    if array.size == 0:
        return np.zeros((0, columns), np.uint32)
    if columns == 1 and array.ndim == 1:
        array = array[:, None]
    if array.ndim != 2 or array.shape[1] != columns:
        expected = "(n,)" if columns == 1 else f"(n, {columns})"
        raise ValueError(f"{name} has shape {array.shape}, expected {expected}: rows of input indices")
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} must be integers, input indices from 0 on, not {array.dtype}")
    if array.dtype == np.uint32:
        return array
    # Room comes first: a view that repeats a row more often than there is memory for is refused at once, and not read to its end.
    rows = np.empty(array.shape, np.uint32)
    least, most = array.min(), array.max()
    if least < 0 or most >= 2**32:
        raise ValueError(f"{name} holds the index {least if least < 0 else most}: they count from 0")
    np.copyto(rows, array, casting="unsafe")
    return rows


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
    """An array of real numbers, none of them masked."""
    return _unmasked(name, _real(name, given))


def _unmasked(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """An array of whose rows none is masked."""
    missing = np.ma.getmaskarray(array) if np.ma.is_masked(array) else None
    if missing is None:
        return np.ma.getdata(array)
    row = int(np.flatnonzero(missing.reshape(len(missing), -1).any(axis=1))[0]) if missing.ndim else 0
    raise ValueError(f"{name} is masked in row {row}, and each is needed: leave masked rows out, or fill them")


def _real(name: str, given: Arrays) -> NDArray[Any]:
    """An array of real numbers, which may be masked."""
    array = _array(name, given)
    if array.size and array.dtype.kind not in "fiub":
        objects = ": give numbers of one type, as astype(float) makes them" if array.dtype == object else ""
        raise ValueError(f"{name} must be real numbers, not {array.dtype}{objects}")
    return array


def _array(name: str, given: Any) -> NDArray[Any]:
    try:
        given = _without_unit(name, given)
        if hasattr(given, "__dlpack__") and not hasattr(given, "__array__"):
            return np.from_dlpack(given)
        if np.ma.isMaskedArray(given):
            return given
        array = np.asarray(given)
        # Columns of frames with missing values, or of extension types, hand over objects.
        if array.dtype == object and _is_numeric(getattr(given, "dtype", None)):
            return array.astype(np.float64)
        return array
    except (ValueError, TypeError, RuntimeError, BufferError) as error:
        raise ValueError(f"{name} cannot be read as an array: {error}") from None


def _without_unit(name: str, given: Any) -> Any:
    """The numbers of a quantity, as pint and astropy have them; a warning names the unit, which is passed over."""
    for number, unit in (("magnitude", "units"), ("value", "unit")):
        if hasattr(given, unit) and hasattr(given, number):
            text = f"{name} is in {getattr(given, unit)}, which is passed over: all numbers must be in one unit, and α and weights in its square"
            warnings.warn(text, stacklevel=5)
            return getattr(given, number)
    return given


def _is_numeric(dtype: Any) -> bool:
    is_numeric = getattr(dtype, "is_numeric", None)
    if callable(is_numeric):
        return bool(is_numeric())
    return getattr(dtype, "kind", "O") in "fiub"
