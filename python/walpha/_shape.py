from __future__ import annotations

import functools
import html
import json
import math
import os

import numpy as np

from . import _arrays, _meshes, _parts, _walpha
from ._class import Class
from ._parts import Boundary, Component, Outline, Void


class AlphaShape:
    """The alpha shape of weighted points, by input index.

    Made by :func:`alpha_shape`, :func:`pipeline` and :meth:`Filtration.shape`. Arrays of simplices
    and of points lend the library's memory: they cost nothing, and cannot be written to.

    Notes
    -----
    Rows are in a canonical order. Cells are positively oriented, regular facets turn
    counter-clockwise seen from outside, and equal shapes have equal arrays whatever the engine or
    the number of threads.
    """

    def __init__(self, shape):
        self._shape = shape

    # What it was made of.

    @functools.cached_property
    def points(self):
        """ndarray of float64, (n, 3): the points as given, duplicates and hidden ones too."""
        return self._shape.points

    @functools.cached_property
    def weights(self):
        """ndarray of float64, (n,): the weights ω, squared lengths."""
        return self._shape.weights

    @functools.cached_property
    def values(self):
        """ndarray of float64, (n,), or None: the values that :meth:`at` interpolates."""
        return self._shape.values

    @property
    def alpha(self):
        """float: α, a **squared** length, as in CGAL and GUDHI. See :attr:`alpha_radius`."""
        return self._shape.alpha

    @property
    def alpha_radius(self):
        """float: √α, the radius of the balls of points of weight 0; NaN for a negative α."""
        return math.sqrt(self.alpha) if self.alpha >= 0 else math.nan

    @functools.cached_property
    def _facts(self):
        return json.loads(self._shape.facts)

    @property
    def alpha_origin(self):
        """str: ``given``, ``default`` (10 h² for a volume), ``auto`` or ``connected``, or these
        with ``-unweighted``, where weights are proportional to α."""
        return self._facts["alpha_origin"]

    @property
    def truncation(self):
        """dict or None: what truncation kept of a volume: kept, total, epsilon, rms, asked."""
        return self._facts["truncation"]

    # Simplices.

    @functools.cached_property
    def cells(self):
        """ndarray of uint32, (n, 4): tetrahedra, positively oriented."""
        return self._shape.cells

    @functools.cached_property
    def facets(self):
        """ndarray of uint32, (n, 3): triangles; regular ones turn outward."""
        return self._shape.facets

    @functools.cached_property
    def edges(self):
        """ndarray of uint32, (n, 2): edges."""
        return self._shape.edges

    @functools.cached_property
    def vertices(self):
        """ndarray of uint32, (n, 1): vertices."""
        return self._shape.vertices

    @functools.cached_property
    def _classes(self):
        return self._shape.classes()

    @property
    def cell_classes(self):
        """ndarray of uint8, (n,): the :class:`Class` of each cell."""
        return self._classes[0]

    @property
    def facet_classes(self):
        """ndarray of uint8, (n,): the :class:`Class` of each facet."""
        return self._classes[1]

    @property
    def edge_classes(self):
        """ndarray of uint8, (n,): the :class:`Class` of each edge."""
        return self._classes[2]

    @property
    def vertex_classes(self):
        """ndarray of uint8, (n,): the :class:`Class` of each vertex."""
        return self._classes[3]

    @property
    def engine(self):
        """str: which program computed it, "cgal" or "native"."""
        return self._shape.engine

    @functools.cached_property
    def hidden(self):
        """ndarray of uint32, (n,), or None.

        Points that are not vertices of the regular triangulation, as heavier ones near them make
        them redundant. None unless they were asked for, with ``hidden=True`` or ``exterior=True``.
        """
        return self._shape.hidden

    @functools.cached_property
    def duplicates(self):
        """ndarray of uint32, (n, 2): a point that went, and the one at its place that stayed."""
        return self._shape.duplicates

    # Topology and size.

    @property
    def volume(self):
        """float: the volume of the cells, in cubed units of the points."""
        return self._shape.measures[0]

    @property
    def area(self):
        """float: the area of the regular facets, the boundary of the solid part, in squared units."""
        return self._shape.measures[1]

    @property
    def singular_area(self):
        """float: the area of the singular facets, one side of each, in squared units."""
        return self._shape.measures[2]

    @property
    def betti(self):
        """Betti or None: components, tunnels and voids. Of a torus a TorusBetti."""
        return _parts.betti(self._shape.betti)

    @functools.cached_property
    def components(self):
        """list of Component: in the order of their smallest vertices."""
        return [Component.of(facts) for facts in json.loads(self._shape.components())]

    @functools.cached_property
    def component_numbers(self):
        """ndarray of int64, (n,): for each point the number of its component; −1 outside."""
        return self._shape.component_numbers()

    @functools.cached_property
    def voids(self):
        """list of Void: largest first, in space as many as ``betti.b2``.

        Of a torus those parts of the complement that do not go round it.

        With ``exterior=True`` they are made of exterior cells, and know the α that fills them.
        Without, they are what boundaries shut in: the volume of a component that floats in a void
        then counts as the void's.

        Raises
        ------
        ValueError
            For a shape that knows neither its exterior nor its sheets (a filtration's): make it with
            ``exterior=True``.
        """
        exact = self._shape.voids()
        if exact is not None:
            return [Void.of(facts) for facts in json.loads(exact)]
        shut_in = [component.voids for component in self.components]
        if any(voids is None for voids in shut_in):
            raise ValueError("the voids of this shape are not known: make it with exterior=True")
        return sorted((void for voids in shut_in for void in voids), key=lambda void: -void.volume)

    @property
    def periodic(self):
        """tuple of float or None: the sides of the box that repeats, if one does."""
        sides = self._shape.periodic
        return None if sides is None else tuple(sides)

    @functools.cached_property
    def copies(self):
        """ndarray of uint32, (k,): of which points the last k are copies, in a shape laid out."""
        return self._shape.copies

    def unwrapped(self):
        """A shape of a torus laid out in space.

        Each simplex is placed where its lowest coordinates are in the box; beyond the upper sides it has
        copies of points, which come after all others (:attr:`copies`).

        Returns
        -------
        AlphaShape
            Classes, sizes, components and Betti numbers are those of the torus. The layout is cut
            open along the sides of the box, so its boundary is not closed.
        """
        return AlphaShape(self._shape.unwrapped()) if self.periodic else self

    def boundary(self, solid=True):
        """The boundary of the solid part, as a triangle mesh.

        Parameters
        ----------
        solid : bool
            Cut the boundary apart where parts of the solid only touch, so that it is a closed,
            oriented manifold: every edge is on two triangles. No place moves. With False the
            regular facets are given as they are.

        Returns
        -------
        Boundary
            Its triangles turn counter-clockwise seen from outside; the volume they enclose is
            :attr:`volume`.
        """
        if self.periodic:
            if solid:
                raise ValueError(
                    "the boundary of a shape of a torus is not closed in space: give solid=False"
                )
            return self.unwrapped().boundary(solid=False)
        return Boundary(*self._shape.boundary(solid))

    def outline(self):
        """The shape of points in one plane as polygons with holes.

        The plane may be tilted; that all points lie in it is decided exactly. Classes
        (:attr:`facet_classes` and the others) stay those of space.

        Returns
        -------
        Outline
            Rings are simple, and polygons valid in the sense of OGC Simple Features.

        Raises
        ------
        ValueError
            The points span a volume or lie on one line, or the box is periodic.

        Examples
        --------
        >>> square = [[0, 0], [1, 0], [1, 1], [0, 1]]
        >>> walpha.alpha_shape(square, alpha=0.5).outline().area
        1.0
        """
        return Outline.of(*self._shape.outline())

    # The interpolant.

    def at(self, places, values=None):
        """F at places: linear on each simplex of the shape.

        Parameters
        ----------
        places : array_like, (m, 3)
            x, y, z, in the units of the points.
        values : array_like, (n,), optional
            One for each point; by default those the shape was made with.

        Returns
        -------
        ndarray of float64, (m,)
            NaN outside the shape. Which simplex holds a place is decided exactly.
        """
        return self._shape.at(_arrays.points(places), self._own(values))

    def interpolate(self, shape, low=None, high=None, values=None, progress=None):
        """F on a grid over a box.

        Parameters
        ----------
        shape : tuple of int
            Samples along z, y and x, as numpy orders them.
        low, high : array_like, (3,), optional
            Corners of the box (x, y, z), where the first and last samples are; by default
            those of the points.
        values : array_like, (n,), optional
            As in :meth:`at`.
        progress : callable, optional
            ``progress(stage, done, total)``.

        Returns
        -------
        ndarray of float32, ``shape``
            ``[z, y, x]``, NaN outside the shape.
        """
        nz, ny, nx = (int(n) for n in shape)
        low = self.points.min(axis=0) if low is None else _arrays.floats("low", low, 1)
        high = self.points.max(axis=0) if high is None else _arrays.floats("high", high, 1)
        if low.shape != (3,) or high.shape != (3,) or not (np.isfinite([low, high]).all()):
            raise ValueError("low and high are corners: give three finite numbers x, y, z for each")
        if min(nz, ny, nx) < 1:
            raise ValueError(f"a grid of shape {tuple(shape)} is empty: every axis needs a sample")
        sizes = [nx, ny, nz]
        return self._shape.interpolate(sizes, list(low), list(high), self._own(values), progress)

    @staticmethod
    def _own(values):
        return None if values is None else _arrays.floats("values", values, 1)

    # Elsewhere.

    def save(self, path, solid=False):
        """Write a file; it appears under its name only when it is complete.

        Parameters
        ----------
        path : str or path-like
            Its extension says the format: ``.ply .off .obj .stl .glb .vtp`` (the boundary),
            ``.vtu .npz .json`` (all simplices), ``.geojson .wkt .svg`` (the :meth:`outline` of points
            in a plane).
        solid : bool
            For boundaries: a closed manifold, as :meth:`boundary` makes it.

        Raises
        ------
        OSError
            The file cannot be written. Nothing is left behind.
        ValueError
            No format has this extension, or it holds no boundary, or the shape has no outline for it.
        """
        self._shape.save(os.fspath(path), solid)

    def to_pyvista(self, what="boundary"):
        """For PyVista: the solid boundary (PolyData), or ``what="cells"`` (UnstructuredGrid)."""
        return _meshes.to_pyvista(self, what)

    def to_meshio(self):
        """For meshio: cells, boundary and singular simplices as a ``meshio.Mesh``."""
        return _meshes.to_meshio(self)

    def to_trimesh(self):
        """For trimesh: the solid boundary as a ``trimesh.Trimesh``, closed and oriented."""
        return _meshes.to_trimesh(self)

    def to_shapely(self):
        """For shapely (2.0 and later): the polygons of the :meth:`outline`.

        Returns
        -------
        shapely.Polygon or shapely.MultiPolygon
            A Polygon where there is one, else a MultiPolygon, which may be empty. Singular edges and vertices are
            left out. Coordinates have a z unless it is 0 everywhere; shapely's areas are those in x and y.

        Raises
        ------
        ValueError
            As :meth:`outline`; or the plane is vertical.
        """
        return _meshes.to_shapely(self)

    def counts(self):
        """dict: for each dimension, how many simplices there are of each class, by its name."""
        names = ("cells", "facets", "edges", "vertices")
        return {
            name: {c.name.lower(): int((classes == c).sum()) for c in Class}
            for name, classes in zip(names, self._classes)
        }

    def __repr__(self):
        return (
            f"<walpha.AlphaShape α={self.alpha:g} (√α={self.alpha_radius:g}): {len(self.points)} points, "
            f"{len(self.cells)} cells, volume {self.volume:g}, betti {tuple(self.betti or ())}>"
        )

    def _repr_html_(self):
        head = "".join(f"<th>{c.name.lower()}</th>" for c in Class)
        rows = "".join(
            f"<tr><th>{name}</th>" + "".join(f"<td>{n}</td>" for n in counts.values()) + "</tr>"
            for name, counts in self.counts().items()
        )
        return f"<p>{html.escape(repr(self))}</p><table><tr><th></th>{head}</tr>{rows}</table>"


def alpha_shape(
    points,
    weights=None,
    alpha="auto",
    *,
    alpha_radius=None,
    engine="auto",
    exterior=False,
    hidden=False,
    balls="power",
    values=None,
    periodic=None,
    progress=None,
):
    """The alpha shape of weighted points.

    The simplices of their regular triangulation whose smallest orthogonal sphere is empty and has
    a squared radius of at most α, and the faces of these. Every decision is exact.

    Parameters
    ----------
    points : array_like, (n, 3) or (n, 2)
        x, y, z, or the points of a plane. Any real type, contiguous or not; taken as float64. Points in one
        plane or on one line get the shape that they have there: triangles or edges, no cells.
    weights : array_like, (n,), optional
        ω, squared lengths: at α a point is a ball of squared radius α + ω. By default 0.
    alpha : float, "auto" or "auto:connected"
        α, a **squared** length, as in CGAL and GUDHI; ``inf`` gives the convex hull. "auto" comes from
        the spacing of the points, so that a few strays do not matter: the squared distance within which
        nine of ten points have eight neighbours, less their weights. "auto:connected" is the smallest α
        at which all points are in one solid component.
    alpha_radius : float, optional
        √α instead of α, as Open3D and PyVista have it.
    engine : {"auto", "cgal", "native"}
        Which program computes it; both give the same answer. "auto" takes CGAL for up to 20 000 points, and
        our own, the fastest, beyond and for periodic boxes: :attr:`AlphaShape.engine` says which one it was.
    exterior : bool
        Keep the simplices outside the shape: the whole triangulation. Voids then know what fills
        them, and hidden points are known.
    hidden : bool
        Find the points that heavier ones hide (:attr:`AlphaShape.hidden`), which takes the whole triangulation, too.
    balls : {"power", "radius"}
        "radius": a point is a ball of radius α + ω instead.
    values : array_like, (n,), optional
        Values that :meth:`AlphaShape.at` interpolates.
    periodic : array_like, (3,), or float, optional
        Sides of a box that repeats along x, y and z: the points are those of a torus, moved into the box
        (:attr:`AlphaShape.points`). A row of input indices means the copies nearest to its first vertex,
        along each axis; no edge may span half of the box. With ``4 * sqrt(alpha + max(weights))`` less
        than each side, none does. ``betti.b3`` is 1 where the shape is the whole torus.
    progress : callable, optional
        ``progress(stage, done, total)``, called in this thread, at most 20 times a second: so many
        of ``total`` equal parts of a stage ("alpha", "shape", …) are done. A total of 0 says that a
        stage begins. An exception ends the work.

    Returns
    -------
    AlphaShape

    Raises
    ------
    ValueError
        Numbers that are NaN, infinite or absurd, no points, an edge that spans half of the periodic box,
        options that contradict each other.
    MemoryError
        The system gives no more.

    References
    ----------
    H. Edelsbrunner and E. P. Mücke, Three-dimensional alpha shapes, ACM Transactions on Graphics
    13 (1994), doi:10.1145/174462.156635.

    H. Edelsbrunner, Weighted alpha shapes, UIUCDCS-R-92-1760 (1992).

    Examples
    --------
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> walpha.alpha_shape(cube, alpha=0.75).volume
    1.0
    """
    weights = None if weights is None else _arrays.floats("weights", weights, 1)
    values = None if values is None else _arrays.floats("values", values, 1)
    rule = squared(alpha, alpha_radius)
    shape = _walpha.alpha_shape(
        _arrays.points(points),
        weights,
        values,
        rule,
        (engine, balls, exterior, hidden),
        _arrays.sides(periodic),
        progress,
    )
    return AlphaShape(shape)


def squared(alpha, alpha_radius):
    """α as the library has it: None by default, the name of a rule, or a squared length."""
    if alpha_radius is not None:
        if alpha is not None and not isinstance(alpha, str):
            raise ValueError("alpha is the square of alpha_radius: give one of them")
        radius = float(alpha_radius)
        if not radius >= 0:
            raise ValueError(f"alpha_radius={radius} is not a radius: give a number from 0 up")
        return radius * radius
    if alpha is None or isinstance(alpha, str):
        return alpha
    alpha = float(alpha)
    if math.isnan(alpha):
        raise ValueError('alpha is NaN: give a squared length, "auto" or "auto:connected"')
    return alpha
