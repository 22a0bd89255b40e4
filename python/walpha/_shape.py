from __future__ import annotations

import functools
import json
import math
import operator
import os
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, cast, overload

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _meshes, _parts, _pictures, _walpha
from ._balls import Balls
from ._class import Class
from ._classified import Classified
from ._parts import Betti, Boundary, Component, Cuts, Outline, TorusBetti, Void
from ._pictures import Colour, Page, Picture, View
from ._typing import Arrays, Classes, Floats, Indices, Progress, Samples
from ._work import task

if TYPE_CHECKING:
    import meshio
    import open3d
    import pyvista
    import shapely
    import trimesh


class AlphaShape(Classified):
    """The alpha shape of weighted points, by input index.

    Made by :func:`alpha_shape`, :func:`pipeline`, :func:`label_shape`, :func:`surface_shape` and :meth:`Filtration.shape`. It does
    not change: its arrays cannot be written to.

    Notes
    -----
    Rows are in a canonical order. Cells are positively oriented, regular facets turn
    counter-clockwise seen from outside, and equal shapes have equal arrays whatever the engine or
    the number of threads.

    A pickle holds the points and how the shape was made, and loading it computes the same shape again.

    Examples
    --------
    >>> shape = walpha.alpha_shape([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], alpha=1)
    >>> shape.cells
    array([[0, 1, 2, 3]])
    >>> shape
    <walpha.AlphaShape alpha=1 (radius 1): 4 points, 1 cells, volume 0.166667, betti (1, 0, 0)>
    """

    _shape: _walpha.Shape
    #: How it was made, if of more than its points: the call that makes it, and the other shape or the samples that it is made of.
    _made: tuple[Callable[[Any], AlphaShape], Any] | None

    def __init__(self) -> None:
        raise TypeError("an AlphaShape is made by walpha.alpha_shape(points, alpha)")

    @classmethod
    def _of(
        cls,
        shape: _walpha.Shape,
        made: tuple[Callable[[Any], AlphaShape], Any] | None = None,
    ) -> AlphaShape:
        one = cls.__new__(cls)
        one._shape, one._made = shape, made
        return one

    def __reduce__(self) -> tuple[Any, ...]:
        if self._made is not None:
            call, other = self._made
            return call, (other,)
        own = len(self.points) - len(self.copies)
        values = None if self.values is None else self.values[:own]
        return _restored, (self.points[:own], self.weights[:own], values, self._shape.state())

    @property
    def _held(self) -> _walpha.Shape:
        return self._shape

    # What it was made of.

    @functools.cached_property
    def points(self) -> Floats:
        """ndarray of float64, (n, 3): the points as given, duplicates and hidden ones too; of a torus, in its box."""
        return self._shape.points

    @functools.cached_property
    def values(self) -> Floats | None:
        """ndarray of float64, (n,), or None: the values that :meth:`at` interpolates."""
        values = self._shape.values
        return None if values is None else _arrays.frozen(values)

    @property
    def alpha_radius(self) -> float:
        """float: √α, the radius of the balls of points of weight 0; NaN for a negative α."""
        return math.sqrt(self.alpha) if self.alpha >= 0 else math.nan

    @functools.cached_property
    def _facts(self) -> dict[str, Any]:
        return cast(dict[str, Any], json.loads(self._shape.facts))

    @property
    def alpha_origin(self) -> str:
        """str: ``given``, ``default`` (10 h² for a volume), ``auto`` or ``connected``, or these
        with ``-unweighted``, where weights are proportional to α; ``labels`` or ``surface`` where the shape has no α."""
        return cast(str, self._facts["alpha_origin"])

    @property
    def voxels(self) -> int | None:
        """int or None: of a :func:`label_shape` the number of voxels that its cells fill. Its ``alpha`` is infinite,
        as no α has a part in it."""
        return self._shape.voxels

    @property
    def isovalue(self) -> float | None:
        """float or None: of a :func:`surface_shape` the value at whose isosurface it ends. Its ``alpha`` is infinite,
        as no α has a part in it."""
        return self._shape.isovalue

    @property
    def truncation(self) -> dict[str, Any] | None:
        """dict or None: what truncation kept of a volume: kept, total, epsilon, rms, asked."""
        return cast(dict[str, Any] | None, self._facts["truncation"])

    @property
    def engine(self) -> Literal["cgal", "native", "both"]:
        """str: which program computed it: "cgal", "native", or "both"."""
        return self._shape.engine

    @functools.cached_property
    def hidden(self) -> Indices | None:
        """ndarray of int64, (n,), or None.

        Points that are not vertices of the regular triangulation, as heavier ones near them make
        them redundant. None unless they were asked for, with ``hidden=True`` or ``exterior=True``.
        """
        hidden = self._shape.hidden
        return None if hidden is None else _arrays.kept(hidden)

    @functools.cached_property
    def duplicates(self) -> Indices:
        """ndarray of int64, (n, 2): a point that went, and the one at its place that stayed."""
        return _arrays.kept(self._shape.duplicates)

    # Topology and size.

    @property
    def volume(self) -> float:
        """float: the volume of the cells, in cubed units of the points."""
        return self._shape.measures[0]

    @property
    def area(self) -> float:
        """float: the area of the surface, in squared units: of its regular and singular facets.

        Of points in a plane the area of the region that they cover.
        """
        return self._shape.measures[1]

    @property
    def regular_area(self) -> float:
        """float: the area of the regular facets, the boundary of the solid part."""
        return self._shape.measures[2]

    @property
    def singular_area(self) -> float:
        """float: the area of the singular facets, one side of each."""
        return self._shape.measures[3]

    @property
    def dimension(self) -> int:
        """int: that of what the points span: 3, or 2 in one plane, 1 on one line, 0 at one place; decided exactly."""
        return self._shape.dimension

    @functools.cached_property
    def perimeter(self) -> float | None:
        """float or None: of points in one plane the length of the :meth:`outline`, holes included; 0 on a line or at one
        place; None for points that span a volume, whose boundary has an :attr:`area`."""
        if self.dimension == 3 or self.periodic:
            return None
        return self.outline().perimeter if self.dimension == 2 else 0.0

    @functools.cached_property
    def bounds(self) -> Floats | None:
        """ndarray of float64, (2, 3), or None: the lowest and highest x, y and z of the shape; None of an empty one."""
        if not len(self.vertices):
            return None
        places = self.points[self.vertices[self.vertex_classes != Class.EXTERIOR].ravel()]
        return _arrays.frozen(np.array([places.min(axis=0), places.max(axis=0)]))

    @property
    def betti(self) -> Betti | TorusBetti:
        """Betti: components, tunnels and voids. Of a torus a TorusBetti."""
        return _parts.betti(self._shape.betti)

    @functools.cached_property
    def components(self) -> list[Component]:
        """list of Component: in the order of their smallest vertices."""
        return [Component._of(facts) for facts in json.loads(self._shape.components())]

    @functools.cached_property
    def component_numbers(self) -> Indices:
        """ndarray of int64, (n,): for each point the number of its component; −1 outside."""
        return _arrays.frozen(self._shape.component_numbers())

    @functools.cached_property
    def voids(self) -> list[Void]:
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
            return [Void._of(facts) for facts in json.loads(exact)]
        shut_in = [component.voids for component in self.components]
        if any(voids is None for voids in shut_in):
            raise ValueError("the voids of this shape are not known: make it with exterior=True")
        return sorted((void for voids in shut_in for void in voids or ()), key=lambda void: -void.volume)

    @property
    def periodic(self) -> _arrays.Box | None:
        """tuple or None: the sides of the box that repeats, if one does, or its vectors, reduced, if it is not along the axes."""
        return _arrays.box(self._shape.periodic)

    @functools.cached_property
    def copies(self) -> Indices:
        """ndarray of int64, (k,): of which points the last k are copies, in a shape laid out, or in a small periodic box.

        In a box in which an edge spans half of a vector or more, vertices do not identify simplices. Rows name copies of points
        there, which come after all points: ``points[cells]`` are the corners of the cells, and the first vertex of each row is a
        point of the box.
        """
        return _arrays.kept(self._shape.copies)

    @functools.cached_property
    def shifts(self) -> Indices:
        """ndarray of int64, (k, 3): the multiples of the vectors of the box by which each of these :attr:`copies` is moved."""
        return _arrays.kept(self._shape.shifts)

    def unwrapped(self) -> AlphaShape:
        """A shape of a torus laid out in space.

        Each simplex is placed where its lowest coordinates are in the box; beyond the upper sides it has
        copies of points, which come after all others (:attr:`copies`).

        Returns
        -------
        AlphaShape
            Classes, sizes, components and Betti numbers are those of the torus. The layout is cut
            open along the sides of the box, so its boundary is not closed.
        """
        if not self.periodic:
            return self
        return AlphaShape._of(self._shape.unwrapped(), (operator.methodcaller("unwrapped"), self))

    def keep(
        self, largest: int | Literal["largest"] | None = None, *, min_volume: float | None = None
    ) -> AlphaShape:
        """The shape with some of its components.

        Parameters
        ----------
        largest : int or "largest", optional
            Keep this many of the largest components, or the largest one. They are compared by their
            volumes, those of equal volume by area, then by vertices.
        min_volume : float, optional
            Keep components of at least this volume, in cubed units of the points.

        Returns
        -------
        AlphaShape
            Over the same points; :attr:`kept` says how many components there were. Simplices keep their classes;
            exterior ones are left out.

        Raises
        ------
        ValueError
            Neither is given; a number of components below 1; a shape of a torus.

        Examples
        --------
        >>> two = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [9, 0, 0]]
        >>> largest = walpha.alpha_shape(two, alpha=1).keep("largest")
        >>> largest.kept, largest.betti.b0
        ((1, 2), 1)
        """
        if largest is None and min_volume is None:
            raise ValueError('say what to keep: "largest", a number of components, or min_volume=')
        if self.periodic:
            raise ValueError("components are kept of shapes in space, and this is one of a torus")
        if min_volume is not None and not min_volume >= 0:
            raise ValueError(f"min_volume={min_volume} is not a volume: give a number from 0 up")
        count = None if largest is None else str(largest if isinstance(largest, str) else operator.index(largest))
        call = operator.methodcaller("keep", largest, min_volume=min_volume)
        return AlphaShape._of(self._shape.keep(count, min_volume), (call, self))

    @property
    def kept(self) -> tuple[int, int] | None:
        """tuple of int or None: how many components were kept, and of how many; None where all were."""
        return self._shape.kept

    def boundary(
        self,
        *,
        solid: bool = True,
        keep: int | Literal["largest"] | None = None,
        min_volume: float | None = None,
    ) -> Boundary:
        """The boundary of the solid part, as a triangle mesh.

        Parameters
        ----------
        solid : bool
            Cut the boundary apart where parts of the solid only touch, so that it is a closed,
            oriented manifold: every edge is on two triangles. Copies of a vertex are moved apart, by
            a thousandth of an edge or so, and the triangles cross nowhere. With False the
            regular facets are given as they are.
        keep, min_volume : int or "largest", float; optional
            Of which components; as in :meth:`keep`.

        Returns
        -------
        Boundary
            Its triangles turn counter-clockwise seen from outside; the volume they enclose is
            :attr:`volume`, but for what copies of vertices were moved by.

        Raises
        ------
        ValueError
            A closed boundary of a shape of a torus.

        Examples
        --------
        >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> walpha.alpha_shape(cube, 0.75).boundary().triangles.shape
        (12, 3)
        """
        if keep is not None or min_volume is not None:
            return self.keep(keep, min_volume=min_volume).boundary(solid=solid)
        if self.periodic:
            if solid:
                raise ValueError(
                    "the boundary of a shape of a torus is not closed in space: give solid=False"
                )
            return self.unwrapped().boundary(solid=False)
        points, triangles, indices, cuts = self._shape.boundary(solid)
        return Boundary(points, _arrays.int64(triangles), _arrays.int64(indices), Cuts(*cuts))

    def outline(self) -> Outline:
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
        return Outline._of(self._shape.outline())

    @functools.cached_property
    def balls(self) -> Balls:
        """Balls: the union of the balls of the points, of squared radius α + ω: its volume and area, those of each ball, contacts,
        voids and pockets, derivatives. :attr:`volume` and :attr:`area` are those of the tetrahedra.

        Raises
        ------
        ValueError
            α is infinite, or the shape is one of labels.
        """
        return Balls._of(self)

    def contains(self, places: Arrays) -> NDArray[np.bool_]:
        """Whether places are in the shape.

        Parameters
        ----------
        places : array_like, (m, 3) or (m, 2)
            x, y, z, in the units of the points; of a plane x and y.

        Returns
        -------
        ndarray of bool, (m,)
            Decided exactly. Boundary and dangling simplices belong to the shape.

        Raises
        ------
        ValueError
            The shape is one of a torus.

        Examples
        --------
        >>> square = walpha.alpha_shape([[0, 0], [1, 0], [1, 1], [0, 1]], alpha=0.5)
        >>> square.contains([[0.5, 0.25], [2, 0]])
        array([ True, False])
        """
        return ~np.isnan(self.at(places, values=np.zeros(len(self.points))))

    # The interpolant.

    def at(self, places: Arrays, *, values: Arrays | None = None) -> Floats:
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

        Raises
        ------
        ValueError
            The points carry no values; the shape is one of a torus.

        Examples
        --------
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> walpha.alpha_shape(corners, alpha=1, values=[0, 1, 2, 3]).at([[0.5, 0.25, 0], [1, 1, 1]])
        array([ 1., nan])
        """
        return self._shape.at(_arrays.points(places, "places"), _arrays.optional("values", values))

    def interpolate(
        self,
        shape: tuple[int, int, int],
        *,
        low: Arrays | None = None,
        high: Arrays | None = None,
        values: Arrays | None = None,
        progress: Progress = None,
        threads: int | None = None,
    ) -> Samples:
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
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        ndarray of float32, ``shape``
            ``[z, y, x]``, NaN outside the shape.

        Raises
        ------
        ValueError
            As :meth:`at`, and an empty grid.

        Examples
        --------
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> shape = walpha.alpha_shape(corners, alpha=1, values=[0, 1, 2, 3])
        >>> shape.interpolate((1, 2, 2), high=(1, 1, 0))
        array([[[ 0.,  1.],
                [ 2., nan]]], dtype=float32)
        """
        nz, ny, nx = map(operator.index, shape)
        first = _arrays.place("low", self.points.min(axis=0) if low is None else low)
        last = _arrays.place("high", self.points.max(axis=0) if high is None else high)
        if min(nz, ny, nx) < 1:
            raise ValueError(f"shape={tuple(shape)} is an empty grid: every axis needs a sample")
        own = _arrays.optional("values", values)
        with task(progress, threads) as how:
            return self._shape.interpolate([nx, ny, nz], first, last, own, how)

    # Pictures.

    def plot(
        self, *, view: View = "three-quarter", colour: Colour = "plain", size: tuple[int, int] = (800, 680)
    ) -> Picture:
        """A picture of the boundary and of what hangs loose, which a notebook shows.

        Parameters
        ----------
        view : {"three-quarter", "front", "back", "left", "right", "top", "bottom"}
            The side that is seen, of a subject whose face is turned to −y and whose crown to +z.
        colour : {"plain", "value", "class"}
            What colours show: nothing, the values of the points, or the classes of simplices.
        size : tuple of int
            Width and height in pixels.

        Returns
        -------
        Picture
            A torus is laid out in space, cut open along the sides of its box.

        Raises
        ------
        ValueError
            No view or colour has this name; the points have no values; the picture has no pixels, or too many.

        Examples
        --------
        >>> walpha.alpha_shape(np.eye(4)[:, :3], alpha=1).plot(view="top", size=(80, 60))
        <walpha.Picture of 80×60 pixels>
        """
        width, height = map(operator.index, size)
        return Picture(self._shape.picture(view, colour, (width, height)))

    def show(self, *, height: int = 640) -> Page:
        """The interactive page of ``walpha view``: in a notebook in a frame, otherwise in a browser.

        It opens at the α of the shape, and a slider moves through the others. The page needs no network.

        Parameters
        ----------
        height : int
            The height of the frame in pixels.

        Returns
        -------
        Page
            A notebook shows it, and it can be saved.

        Raises
        ------
        ValueError
            The shape is one of a torus, or has no α.
        """
        page = self._page(height)
        if not _pictures.in_notebook():
            page.open()
        return page

    def _page(self, height: int = 640) -> Page:
        return Page(self._shape.page("Alpha shapes", self._rows()), height)

    # Elsewhere.

    def save(self, path: str | os.PathLike[str], *, solid: bool = False, allow_empty: bool = False) -> None:
        """Write a file; it appears under its name only when it is complete.

        Parameters
        ----------
        path : str or path-like
            Its extension says the format: ``.ply .off .obj .stl .3mf .glb .vtp`` (the boundary),
            ``.vtu .npz .json`` (all simplices), ``.geojson .wkt .svg`` (the :meth:`outline` of points
            in a plane), ``.png`` (a picture, as :meth:`plot` makes it), ``.html`` (the page of :meth:`show`).
        solid : bool
            For boundaries: a closed manifold, as :meth:`boundary` makes it.
        allow_empty : bool
            Write a file that holds nothing of the shape, such as an STL without a facet, which otherwise
            is an error.

        Warns
        -----
        UserWarning
            STL, 3MF and GLB have coordinates in single precision, and programs read SVG so. Where that would move them by more than a
            thousandth of the shortest edge, a round number is subtracted, which the file states, too: the
            header of an STL and the description of an SVG as ``OFFSET=x,y,z``, a GLB as the translation of its node,
            a 3MF as that of its item.

        Raises
        ------
        OSError
            The file cannot be written. Nothing is left behind.
        ValueError
            No format has this extension, or it holds no boundary, or the shape has no outline for it, or
            the file would hold nothing of the shape: the message says at which α it would.

        Examples
        --------
        >>> shape = walpha.alpha_shape(np.eye(4)[:, :3], alpha=1)
        >>> shape.save("shape.ply", solid=True)
        """
        extension = _pictures.extension(path)
        if extension in (".png", ".html"):
            if solid:
                raise ValueError(f"solid=True is for formats of boundaries, and {extension} shows the shape: omit it")
            if extension == ".png":
                self.plot(size=(1600, 1360)).save(path)
            else:
                self._page().save(path)
            return
        try:
            remark = self._shape.save(os.fspath(path), solid, allow_empty)
        except ValueError as error:
            # The library knows of files of shapes; pictures and pages are made here.
            raise ValueError(str(error).replace("; choose one of these", ", .png, .html; choose one of these")) from None
        if remark is not None:
            warnings.warn(f"{os.fspath(path)}: {remark}", stacklevel=2)

    @overload
    def to_pyvista(self, what: Literal["boundary"] = "boundary") -> pyvista.PolyData: ...

    @overload
    def to_pyvista(self, what: Literal["cells"]) -> pyvista.UnstructuredGrid: ...

    def to_pyvista(
        self, what: Literal["boundary", "cells"] = "boundary"
    ) -> pyvista.PolyData | pyvista.UnstructuredGrid:
        """For PyVista.

        Parameters
        ----------
        what : {"boundary", "cells"}
            The solid boundary, or the tetrahedra.

        Returns
        -------
        pyvista.PolyData or pyvista.UnstructuredGrid
            With ``index`` (of the input), ``weight`` and, where points have values, ``value`` at each point.
        """
        mesh: pyvista.PolyData | pyvista.UnstructuredGrid = _meshes.to_pyvista(self, what)
        return mesh

    def to_meshio(self) -> meshio.Mesh:
        """For meshio.

        Returns
        -------
        meshio.Mesh
            Cells, boundary and singular simplices, with their ``class``, over all points.
        """
        mesh: meshio.Mesh = _meshes.to_meshio(self)
        return mesh

    def to_trimesh(self) -> trimesh.Trimesh:
        """For trimesh.

        Returns
        -------
        trimesh.Trimesh
            The solid boundary, closed and oriented; the attribute ``index`` of its vertices is that of the input.
        """
        mesh: trimesh.Trimesh = _meshes.to_trimesh(self)
        return mesh

    def to_open3d(self) -> open3d.geometry.TriangleMesh:
        """For Open3D.

        Returns
        -------
        open3d.geometry.TriangleMesh
            The solid boundary, closed and oriented.
        """
        mesh: open3d.geometry.TriangleMesh = _meshes.to_open3d(self)
        return mesh

    def to_napari(self) -> tuple[tuple[np.ndarray[Any, Any], ...], dict[str, Any], str]:
        """For napari, which need not be installed: a layer as data, options and type.

        Returns
        -------
        tuple
            The solid boundary as a layer "surface": places in the order of napari's axes (z, y, x), triangles and,
            where points have values, these. ``napari.layers.Layer.create(*shape.to_napari())`` makes the layer.

        Examples
        --------
        >>> data, options, kind = walpha.alpha_shape(np.eye(4)[:, :3], alpha=1).to_napari()
        >>> kind, data[0].shape, data[1].shape
        ('surface', (4, 3), (4, 3))
        """
        return _meshes.to_napari(self)

    def to_shapely(self) -> shapely.Polygon | shapely.MultiPolygon:
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
        polygons: shapely.Polygon | shapely.MultiPolygon = _meshes.to_shapely(self)
        return polygons

    def counts(self) -> dict[str, dict[str, int]]:
        """How many simplices there are.

        Returns
        -------
        dict of dict of int
            By dimension ("cells", "facets", "edges", "vertices") and name of the class ("exterior", …).

        Examples
        --------
        >>> walpha.alpha_shape(np.eye(4)[:, :3], alpha=1).counts()["cells"]
        {'exterior': 0, 'interior': 1, 'regular': 0, 'singular': 0}
        """
        names = ("cells", "facets", "edges", "vertices")
        return {
            name: {c.name.lower(): int((classes == c).sum()) for c in Class}
            for name, classes in zip(names, self._classes)
        }

    def __repr__(self) -> str:
        alpha = f"alpha={self.alpha:g} (radius {self.alpha_radius:g})"
        made = alpha if self.voxels is None else f"of labels ({self.voxels} voxels)"
        kept = "" if self.kept is None else f", {self.kept[0]} of {self.kept[1]} components"
        if self.isovalue is not None:
            made = f"inside the isosurface at {self.isovalue:g}"
        return (
            f"<walpha.AlphaShape {made}: {self._own_points()} points{kept}, "
            f"{self._size()}, betti {tuple(self.betti)}>"
        )

    def _own_points(self) -> int:
        """Without the copies of a small box; a shape laid out has its copies as points."""
        return len(self.points) - (0 if self.periodic is None else len(self.copies))

    def _size(self) -> str:
        """What fills the space that the points span."""
        if self.dimension == 3:
            return f"{len(self.cells)} cells, volume {self.volume:g}"
        if self.dimension == 2:
            return f"{len(self.facets)} facets in a plane, area {self.area:g}"
        return f"{len(self.edges)} edges on a line" if self.dimension == 1 else "at one place"

    def _rows(self) -> list[tuple[str, str]]:
        """Five numbers, with their names."""
        radius = f"{_pictures.brief(self.alpha_radius)} (α = {_pictures.brief(self.alpha)})"
        if self.voxels is not None or self.isovalue is not None:
            radius = "none: the cells do not depend on α"
        sizes = f"volume {_pictures.brief(self.volume)}, surface {_pictures.brief(self.area)}"
        if self.dimension < 3:
            sizes = f"area {_pictures.brief(self.area)}"
        loose = ((int(np.count_nonzero(classes == Class.SINGULAR)), name) for classes, name in zip(self._classes[1:], _LOOSE))
        return [
            ("points", _pictures.count(self._own_points())),
            ("ball radius", radius),
            ("shape", _topology(self.betti)),
            ("size", sizes),
            ("loose", ", ".join(f"{_pictures.count(count)} {name}" for count, name in loose if count) or "nothing"),
        ]

    def _repr_html_(self) -> str:
        picture = ""
        # Beyond, a picture takes longer than one waits for it.
        if len(self.facets) <= _MOST_DRAWN and len(self.vertices):
            picture = _pictures.image(bytes(self.plot(size=(480, 400))), repr(self), 240)
        return _pictures.summary("walpha.AlphaShape", self._rows(), picture)


#: Facets of a shape that a notebook shows without being asked to.
_MOST_DRAWN = 2_000_000
#: What simplices are called that are part of no other: facets, edges, vertices.
_LOOSE = ("triangles", "edges", "points")


def _topology(betti: Betti | TorusBetti) -> str:
    """Betti numbers in words."""
    names = (("component", betti.b0), ("tunnel", betti.b1), ("void", betti.b2))
    return ", ".join(f"{count} {name}{'' if count == 1 else 's'}" for name, count in names)


def _restored(points: Floats, weights: Floats, values: Floats | None, state: tuple[str, str, str]) -> AlphaShape:
    return AlphaShape._of(_walpha.restored(points, weights, values, state))
