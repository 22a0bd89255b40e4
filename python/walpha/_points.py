from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple, TypeAlias

from . import _alpha, _arrays, _walpha
from ._repr import in_a_line
from ._typing import Arrays, Floats

Ground: TypeAlias = Literal["unclassified", "ground", "vegetation", "building", "water"]
# Codes of the ASPRS, in the words of the command.
_CLASSES: dict[object, list[int]] = {
    "unclassified": [0, 1],
    "ground": [2],
    "vegetation": [3, 4, 5],
    "building": [6],
    "water": [9],
}


class PointColumns(Mapping[str, Floats]):
    """The columns of a file of points by name, each read when it is asked for, and then kept.

    A name may be in any letter case, and ``class`` is the classification of LAS. Numbers are NaN where a point has none.
    """

    def __init__(self, path: str, reading: dict[str, object]) -> None:
        self._path, self._reading = path, reading
        self._names: list[str] | None = None
        self._read: dict[str, Floats] = {}

    def __getitem__(self, name: str) -> Floats:
        if name not in self._read:
            try:
                self._read[name] = _walpha.point_column(self._path, name, self._reading)
            except ValueError as error:
                if "has no column" in str(error):
                    raise KeyError(str(error)) from None
                raise
        return self._read[name]

    def _all(self) -> list[str]:
        if self._names is None:
            self._names = _walpha.point_columns(self._path, self._reading)
        return self._names

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str):
            return False
        known = {own.lower() for own in self._all()}
        return name.lower() in known or (name.lower() == "class" and "classification" in known)

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __repr__(self) -> str:
        return f"PointColumns({self._all()})"


@in_a_line
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
        Of lengths: "mm", say; "voxel" where coordinates are indices, "ft" and "ftUS" for the two feet, "unit" where
        nobody says.
    classes : dict of int to int, or None
        How many points of LAS and LAZ have each class, by its ASPRS code, whether it was read or not; with ``roi`` those in the
        box.
    crs : dict or None
        The coordinate reference system, where the file states one: "epsg" and "name" (or None), "geographic", "unit", and
        "vertical" for heights.
    columns : mapping of str to ndarray
        The other columns, such as "gps_time" or "treeID". Each is read from the file when it is asked for.
    """

    points: Floats
    weights: Floats | None
    values: Floats | None
    grid: tuple[int, int, int] | None
    alpha: float | None
    unit: str
    classes: dict[int, int] | None
    crs: dict[str, object] | None
    columns: Mapping[str, Floats]


def read_points(
    path: str | os.PathLike[str],
    *,
    level: int | None = None,
    columns: Iterable[str] | None = None,
    frame: int | None = None,
    classes: Iterable[int | Ground] | None = None,
    withheld: bool = False,
    roi: Iterable[tuple[float | None, float | None]] | None = None,
    thin: float | None = None,
    value: str | None = None,
) -> PointFile:
    """Read points.

    Parameters
    ----------
    path : str or path-like
        CSV, XYZ, PTS, PDB, mmCIF, CIF, PQR, GRO, LAMMPS data and dumps, POSCAR, PLY, OFF, OBJ, STL, PCD, LAS, LAZ, VTU, VTP, VTK, NPY or WVM; text, molecules, PLY,
        OFF, OBJ, STL and PCD also compressed with gzip, or alone in a ZIP archive. Weights are a column ``weight``, or else
        the squares of a column ``radius``; a fourth column without a name has values. Of PDB and mmCIF the heavy atoms of
        the polymers in the first model are read; the weight of an atom is its squared radius, of the file or Bondi's. Or
        ``hard:NAME``, a set on which programs fail: the documentation lists them under cross-checking; or
        ``sample:peptide``, a small molecule; or ``sample:tile``, a small laser scan.
    level : int, optional
        For WVM in layers: how many of the last layers to leave out.
    columns : iterable of str, optional
        Names of the columns of a table (CSV, XYZ, PTS, NPY): x, y, z, perhaps weight (or radius) and value, others under
        any name.
    frame : int, optional
        For text with several scans (PTS) or steps of a trajectory (XYZ): which to read, counted from 0.
    classes : iterable of int or str, optional
        For LAS and LAZ: the classes to read, by their codes or as "ground", "vegetation", "building", "water",
        "unclassified".
    withheld : bool
        For LAS and LAZ: also take the points that are flagged as withheld, which are not to be processed.
    roi : iterable of pairs of float, optional
        The box to read: the least and the greatest x, y and z, in the unit of the points; ``None`` means unbounded. Of LAS and
        LAZ only what is in it takes memory, and of COPC only cells that meet it are decompressed.
    thin : float, optional
        Keep the first point in each cube of this side, in the unit of the points. Of LAS and LAZ only the points that are
        kept take memory.
    value : str, optional
        The column whose numbers are F: "height" (z), or one of ``columns``. By default a column value, or the intensity.

    Returns
    -------
    PointFile

    Raises
    ------
    OSError
        The system refuses.
    ValueError
        The file is not what it says.

    Examples
    --------
    >>> walpha.write_points("corners.csv", np.eye(3))
    >>> walpha.read_points("corners.csv").points
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    box = None if roi is None else _box(roi)
    if thin is not None and not 0 < thin < float("inf"):
        raise ValueError(f"thin={thin} is not the side of a cube: give a length above 0")
    named = None if columns is None else ",".join([columns] if isinstance(columns, str) else columns)
    reading: dict[str, object] = {
        "level": level,
        "columns": named,
        "frame": frame,
        "classes": None if classes is None else _codes(classes),
        "withheld": withheld,
        "roi": box,
        "thin": thin,
        "value": value,
    }
    points, weights, values, sizes, alpha, texts = _walpha.read_points(os.fspath(path), reading)
    coordinates, crs, counts = map(json.loads, texts)
    grid = None if sizes is None else (sizes[2], sizes[1], sizes[0])
    by_class = None if counts is None else {int(code): count for code, count in counts.items()}
    # A sample has a name and no path.
    where = os.path.abspath(path) if os.path.exists(path) else os.fspath(path)
    columns_of_file = PointColumns(where, reading)
    return PointFile(points, weights, values, grid, alpha, coordinates["unit"], by_class, crs, columns_of_file)


def _box(roi: Iterable[tuple[float | None, float | None]]) -> list[list[float]]:
    infinity = float("inf")
    ends = [[-infinity if low is None else float(low), infinity if high is None else float(high)] for low, high in roi]
    if len(ends) != 3 or not all(low <= high for low, high in ends):
        raise ValueError("roi: give three pairs along x, y and z, the smaller number first, as in ((0, 10), (0, 10), (None, None))")
    return ends


def _codes(classes: Iterable[int | Ground]) -> list[int]:
    codes = []
    for given in [classes] if isinstance(classes, (str, int)) else classes:
        known = _CLASSES.get(given) if isinstance(given, str) else [given] if 0 <= given < 256 else None
        if known is None:
            known_names = ", ".join(map(repr, _CLASSES))
            raise ValueError(f"classes: {given!r} is not a class: give codes from 0 to 255, or some of {known_names}")
        codes += known
    return codes


def write_points(
    path: str | os.PathLike[str],
    points: Arrays,
    *,
    weights: Arrays | None = None,
    values: Arrays | None = None,
    columns: Mapping[str, Arrays] | None = None,
    like: str | os.PathLike[str] | None = None,
    alpha: float | None = None,
    value_error: float = 0.0,
) -> None:
    """Write points; the file appears under its name only when it is complete.

    Parameters
    ----------
    path : str or path-like
        Its extension says the format: ``.csv``, ``.npy`` (a structured array with fields of the names of columns), ``.las``
        or ``.laz``, or ``.wvm``, which is small where points lie at whole numbers.
    points : array_like, (n, 3)
        x, y, z.
    weights, values : array_like, (n,), optional
        ω, squared lengths (0 by default), and F.
    columns : mapping of str to array_like, (n,), optional
        Further columns, such as those of :class:`PointFile`, except a weight or radius, which are ``weights``; not for WVM. In LAS each
        has the field of its name, as "classification", or is stored as extra bytes; NaN stands for no number.
    like : str or path-like, optional
        For LAS: a file of LAS or LAZ whose version, point format, scales, offsets, coordinate system and other records the
        file gets. Otherwise scales are the coarsest powers of ten that move no point, or the finest that 32 bits allow.
    alpha : float, optional
        For WVM: the α that the shape is meant to be made at, a **squared** length.
    value_error : float
        For WVM: the largest error of a value; 0 keeps every bit.

    Raises
    ------
    OSError
        The file cannot be written. Nothing is left behind.
    ValueError
        No format has this extension, columns are not one for each point, a number is not finite, or its field in LAS cannot
        hold it.

    Examples
    --------
    >>> walpha.write_points("weighted.csv", np.eye(3), weights=[1, 2, 3])
    >>> walpha.write_points("trees.csv", np.eye(3), columns={"treeID": [1, 1, 2]})
    >>> walpha.read_points("trees.csv").columns["treeID"]
    array([1., 1., 2.])
    """
    further = [] if columns is None else [(name, _arrays.column(f"columns[{name!r}]", columns[name])) for name in columns]
    cloud = _arrays.finite_cloud(points, weights, values)
    for name, numbers in further:
        if name.lower() in ("weight", "radius"):
            raise ValueError(f"columns[{name!r}]: readers take it for the weights: give weights=, squared lengths, or use another name")
        if len(numbers) != len(cloud.points):
            raise ValueError(f"columns[{name!r}] has {len(numbers)} numbers for {len(cloud.points)} points")
    _walpha.write_points(
        os.fspath(path),
        *cloud,
        further,
        None if like is None else os.fspath(like),
        None if alpha is None else _alpha.squared(alpha, None, ""),
        float(value_error),
    )
