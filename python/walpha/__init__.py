"""Exact weighted alpha shapes of points and volumes.

>>> import walpha
>>> shape = walpha.alpha_shape(points)          # α found from the spacing of the points
>>> shape.cells, shape.boundary().triangles, shape.betti, shape.volume
>>> walpha.filtration(points).betti_curve()     # every α at once
>>> walpha.check(points, np.inf, cells=delaunay.simplices)

α and the weights ω are **squared** lengths, as in CGAL and GUDHI (``alpha_radius=`` takes a radius).
Simplices name input indices. Points are (x, y, z), volumes are arrays ``[z, y, x]``. Work runs without the
interpreter's lock, on as many threads as ``RAYON_NUM_THREADS`` says or there are cores, and gives the same
result on any number of them. Ctrl-C interrupts it.
"""

import atexit as _atexit

from . import _walpha
from ._check import Comparison, Complex, Finding, Verdict, check, compare
from ._class import Class
from ._filtration import (
    BettiCurve,
    Filtration,
    Level,
    Simplices,
    Suggestions,
    TorusBettiCurve,
    filtration,
)
from ._parts import Betti, Boundary, Component, Outline, Polygon, TorusBetti, Void
from ._points import PointFile, read_points, write_points
from ._shape import AlphaShape, alpha_shape
from ._volume import Selected, Volume, difference, haar, pipeline, read, select, weigh

__version__ = _walpha.__version__

__all__ = [
    "AlphaShape",
    "Betti",
    "BettiCurve",
    "Boundary",
    "Class",
    "Comparison",
    "Complex",
    "Component",
    "Filtration",
    "Finding",
    "Level",
    "Outline",
    "PointFile",
    "Polygon",
    "Selected",
    "Simplices",
    "Suggestions",
    "TorusBetti",
    "TorusBettiCurve",
    "Verdict",
    "Void",
    "Volume",
    "alpha_shape",
    "check",
    "compare",
    "difference",
    "filtration",
    "haar",
    "pipeline",
    "read",
    "read_points",
    "select",
    "weigh",
    "write_points",
]

# Interrupted work may still be writing.
_atexit.register(_walpha.sweep)
