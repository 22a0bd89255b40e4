"""Exact weighted alpha shapes of points and volumes.

α and the weights ω are **squared** lengths, as in CGAL and GUDHI (``alpha_radius=`` takes a radius). Simplices are
rows of input indices, int64. What has the form of an array, volumes and their shapes, is ``[z, y, x]``; places,
lengths and directions are (x, y, z).

Points come first, α second, all else by name. Work runs without the interpreter's lock, on ``threads=``, or as
many as ``RAYON_NUM_THREADS`` says or there are cores, and gives the same result on any number of them. Ctrl-C
interrupts it, and ``progress=True`` tells how far it is. Every object can be pickled.

Examples
--------
>>> points = np.random.default_rng(0).random((1000, 3))
>>> shape = walpha.alpha_shape(points)          # α found from the spacing of the points
>>> shape.cells.shape, shape.boundary().triangles.shape, shape.betti
((5522, 4), (700, 3), Betti(b0=1, b1=0, b2=0))
>>> curve = walpha.filtration(points).betti_curve()     # every α at once
>>> bool(walpha.check(shape))                   # exactly, by a program of its own
True
>>> walpha.triangulation(points).find_simplex([[0.5, 0.5, 0.5], [2, 2, 2]]) >= 0
array([ True, False])
"""

import atexit as _atexit

from . import _walpha
from ._alpha_shape import alpha_shape
from ._balls import Balls, BallSurface, Bounded, BoundedArray, Cavity, Contacts, Gradients
from ._boxes import FreeSphere, PeriodicPowerDiagram, Pores, periodic_power_diagram, pores
from ._check import Comparison, Complex, Finding, Verdict, check, compare
from ._class import Class
from ._curves import BettiCurve, Level, Suggestions, TorusBettiCurve
from ._cycles import LoopCycle, VoidCycle
from ._filtration import Filtration, filtration
from ._many import alpha_shapes, filtrations
from ._molecule import Molecule, read_molecule
from ._parts import Betti, Boundary, Component, Cuts, Outline, Polygon, TorusBetti, Void
from ._pictures import Chart, Page, Picture
from ._pipeline import Selected, difference, haar, label_shape, pipeline, select, surface_shape, weigh
from ._points import PointFile, read_points, write_points
from ._shape import AlphaShape
from ._simplices import Simplices
from ._triangulation import PowerDiagram, Triangulation, triangulation
from ._volume import Volume, read

__version__ = _walpha.__version__

__all__ = [
    "AlphaShape",
    "BallSurface",
    "Balls",
    "Betti",
    "BettiCurve",
    "Bounded",
    "BoundedArray",
    "Boundary",
    "Cavity",
    "Chart",
    "Class",
    "Comparison",
    "Complex",
    "Component",
    "Contacts",
    "Cuts",
    "Filtration",
    "Finding",
    "FreeSphere",
    "Gradients",
    "Level",
    "LoopCycle",
    "Molecule",
    "Outline",
    "Page",
    "PeriodicPowerDiagram",
    "Picture",
    "PointFile",
    "Polygon",
    "Pores",
    "PowerDiagram",
    "Selected",
    "Simplices",
    "Suggestions",
    "TorusBetti",
    "TorusBettiCurve",
    "Triangulation",
    "Verdict",
    "Void",
    "VoidCycle",
    "Volume",
    "alpha_shape",
    "alpha_shapes",
    "check",
    "compare",
    "difference",
    "filtration",
    "filtrations",
    "haar",
    "label_shape",
    "periodic_power_diagram",
    "pipeline",
    "pores",
    "read",
    "read_molecule",
    "read_points",
    "select",
    "surface_shape",
    "triangulation",
    "weigh",
    "write_points",
]

# Interrupted work may still be writing.
_atexit.register(_walpha.sweep)
