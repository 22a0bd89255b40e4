"""Array-likes as the library takes them."""

from __future__ import annotations

import numpy as np


def floats(name, given, ndim):
    """`given` as float64 of `ndim` axes; no copy where it is that already."""
    array = _numbers(name, given)
    if array.ndim != ndim:
        raise ValueError(f"{name} has {array.ndim} axes, expected {ndim}: its shape is {array.shape}")
    return array.astype(np.float64, copy=False)


def points(given):
    """Places, n×3; those of a plane, n×2, are at z = 0. An empty list is not a place."""
    array = _numbers("points", given)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim == 2 and array.shape[1] == 2:
        in_space = np.zeros((len(array), 3))
        in_space[:, :2] = array
        return in_space
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points have shape {array.shape}, expected (n, 3) or (n, 2): x, y, z of each")
    return array.astype(np.float64, copy=False)


def sides(given):
    """The sides of a periodic box, or None."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.ndim == 0:
        array = np.repeat(array, 3)
    if array.shape != (3,):
        raise ValueError(f"periodic has shape {array.shape}: give the sides of the box along x, y and z")
    return [float(side) for side in array]


def samples(given):
    """A volume `[z, y, x]` as float32, and whether it holds gray levels (unsigned bytes)."""
    array = _numbers("volume", given)
    if array.ndim != 3:
        raise ValueError(f"a volume has three axes [z, y, x], and this one has shape {array.shape}")
    with np.errstate(over="ignore"):
        return array.astype(np.float32, copy=False), array.dtype == np.uint8


def indices(name, given, columns):
    """Rows of input indices as uint32, n×columns."""
    if given is None:
        return None
    array = np.asarray(given)
    if array.size == 0:
        return np.zeros((0, columns), np.uint32)
    if columns == 1 and array.ndim == 1:
        array = array[:, None]
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} have shape {array.shape}, expected (n, {columns})")
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} must be integers, input indices from 0 on, not {array.dtype}")
    least, most = array.min(), array.max()
    if least < 0 or most >= 2**32:
        raise ValueError(f"{name} hold the index {least if least < 0 else most}: they count from 0")
    return array.astype(np.uint32, copy=False)


def _numbers(name, given):
    try:
        array = np.asarray(given)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    if array.size and array.dtype.kind not in "fiub":
        raise ValueError(f"{name} must be real numbers, not {array.dtype}")
    return array
