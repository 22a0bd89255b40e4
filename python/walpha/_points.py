from __future__ import annotations

import json
import os
from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha


class PointFile(NamedTuple):
    """Points as a file has them.

    Attributes
    ----------
    points : ndarray of float64, (n, 3)
        x, y, z.
    weights, values : ndarray of float64, (n,), or None
        ω, squared lengths, and F, where the file has them.
    grid : tuple of int, or None
        Samples along z, y and x of the grid that the points are samples of, where the file states it.
    alpha : float or None
        The α that their shape is meant to be made at, a **squared** length.
    unit : str
        Of lengths: "mm", say; "voxel" where coordinates are indices, "unit" where nobody says.
    """

    points: np.ndarray
    weights: np.ndarray | None
    values: np.ndarray | None
    grid: tuple | None
    alpha: float | None
    unit: str


def read_points(path, *, level=None):
    """Read points.

    Parameters
    ----------
    path : str or path-like
        CSV, XYZ, PTS, PLY, OFF, OBJ, STL, PCD, VTU, VTP, VTK, NPY or WVM. Weights are a column ``weight``,
        or else the squares of a column ``radius``.
    level : int, optional
        For WVM in layers: how many of the last layers to leave out.

    Returns
    -------
    PointFile

    Raises
    ------
    OSError
        The system refuses.
    ValueError
        The file is not what it says.
    """
    points, weights, values, grid, alpha, coordinates = _walpha.read_points(os.fspath(path), level)
    grid = None if grid is None else tuple(reversed(grid))
    return PointFile(points, weights, values, grid, alpha, json.loads(coordinates)["unit"])


def write_points(path, points, weights=None, values=None, *, alpha=None, value_error=0.0):
    """Write points; the file appears under its name only when it is complete.

    Parameters
    ----------
    path : str or path-like
        Its extension says the format: ``.csv``, ``.npy``, or ``.wvm``, which is small where points lie at
        whole numbers.
    points : array_like, (n, 3)
        x, y, z.
    weights, values : array_like, (n,), optional
        ω, squared lengths (0 by default), and F.
    alpha : float, optional
        For WVM: the α that the shape is meant to be made at, a **squared** length.
    value_error : float
        For WVM: the largest error of a value; 0 keeps every bit.

    Raises
    ------
    OSError
        The file cannot be written. Nothing is left behind.
    ValueError
        No format has this extension, or columns are not one for each point.
    """
    _walpha.write_points(
        os.fspath(path),
        _arrays.points(points),
        None if weights is None else _arrays.floats("weights", weights, 1),
        None if values is None else _arrays.floats("values", values, 1),
        alpha,
        float(value_error),
    )
