"""What is found in a shape, as named tuples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, cast

from . import _arrays, _pictures, _walpha
from ._repr import in_a_line
from ._typing import Floats, Indices, Place


class Betti(NamedTuple):
    """Betti numbers.

    Attributes
    ----------
    b0 : int
        Connected components.
    b1 : int
        Independent tunnels.
    b2 : int
        Voids.
    """

    b0: int
    b1: int
    b2: int


class TorusBetti(NamedTuple):
    """Betti numbers of a shape of a torus.

    Attributes
    ----------
    b0 : int
        Connected components.
    b1 : int
        Independent loops that bound nothing, those that go round the torus too.
    b2 : int
        Independent closed surfaces that bound nothing, those that go round the torus too.
    b3 : int
        1 if the shape is the whole torus, else 0.
    """

    b0: int
    b1: int
    b2: int
    b3: int


def betti(numbers: Sequence[int | None]) -> Betti | TorusBetti:
    """Three Betti numbers, or four of a torus."""
    known = [number for number in numbers if number is not None]
    return Betti(*known) if len(known) == 3 else TorusBetti(*known)


class Void(NamedTuple):
    """A bounded component of what is outside the shape.

    Attributes
    ----------
    volume : float
        Cubed units of the points.
    low, high : tuple of float
        Corners of its box, (x, y, z).
    cells : int or None
        Cells of the triangulation that fill it; None without the exterior simplices.
    filling_alpha : float or None
        The smallest α (a squared length) at which nothing of it is left; None likewise.
    """

    volume: float
    low: Place
    high: Place
    cells: int | None = None
    filling_alpha: float | None = None

    @classmethod
    def _of(cls, facts: dict[str, Any]) -> Void:
        """From the fields of the library."""
        return cls(
            facts["volume"],
            cast(Place, tuple(facts["low"])),
            cast(Place, tuple(facts["high"])),
            facts.get("cells"),
            facts.get("filling_alpha"),
        )


class Component(NamedTuple):
    """A connected component of a shape.

    Attributes
    ----------
    vertices, cells : int
        How many it has; 0 cells where it is nowhere solid.
    volume : float
        Of its cells, in cubed units of the points.
    area : float
        Of its regular and singular facets, in squared units.
    regular_area : float
        Of its regular facets, the boundary of its solid part.
    singular_area : float
        Of its singular facets, one side of each.
    low, high : tuple of float
        Corners of its box, (x, y, z).
    voids : list of Void or None
        What its boundary shuts in, largest first. Another component may float in one: its volume
        counts. None where the engine does not count them (shapes of a filtration),
        and of a torus.
    rounds : int or None
        Of a torus: in how many independent directions it goes round. Its box is that of one of its copies.
    """

    vertices: int
    cells: int
    volume: float
    area: float
    regular_area: float
    singular_area: float
    low: Place
    high: Place
    voids: list[Void] | None
    rounds: int | None = None

    @classmethod
    def _of(cls, facts: dict[str, Any]) -> Component:
        """From the fields of the library."""
        voids = facts["voids"]
        return cls(
            facts["vertices"],
            facts["cells"],
            facts["volume"],
            facts["area"],
            facts["regular_area"],
            facts["singular_area"],
            cast(Place, tuple(facts["low"])),
            cast(Place, tuple(facts["high"])),
            None if voids is None else [Void._of(void) for void in voids],
            facts.get("rounds"),
        )


@in_a_line
class Polygon(NamedTuple):
    """A region of a plane without its holes.

    Rings are rows of input indices that pass each vertex once; they are closed without repeating the first.

    Attributes
    ----------
    outer : ndarray of int64, (k,)
        The ring around it, counter-clockwise.
    holes : list of ndarray of int64
        The rings around its holes, clockwise.
    """

    outer: Indices
    holes: list[Indices]


@in_a_line
class Outline(NamedTuple):
    """The shape of points in a plane, as a region of it.

    Attributes
    ----------
    polygons : list of Polygon
        Triangles that are joined through edges make one. Polygons touch each other at vertices at most.
    edges : ndarray of int64, (k, 2)
        The singular edges, those on no triangle.
    points : ndarray of int64, (k,)
        The singular vertices, those on no edge.
    area : float
        Of the polygons, in squared units of the points.
    perimeter : float
        The length of all rings.
    axes : tuple of int
        The two coordinates in which the plane is seen: the first of (0, 1), (0, 2) and (1, 2) that tell
        its points apart. Counter-clockwise is the way from the first axis to the second.
    """

    polygons: list[Polygon]
    edges: Indices
    points: Indices
    area: float
    perimeter: float
    axes: tuple[int, int]

    @classmethod
    def _of(cls, parts: _walpha.Outline) -> Outline:
        """From the parts that the library gives."""
        polygons, edges, points, area, perimeter, axes = parts
        rings = [
            Polygon(_arrays.int64(outer), [_arrays.int64(hole) for hole in holes])
            for outer, holes in polygons
        ]
        one, other = axes
        return cls(rings, _arrays.int64(edges), _arrays.int64(points), area, perimeter, (one, other))


class Cuts(NamedTuple):
    """Where a boundary was cut apart to become a manifold.

    Attributes
    ----------
    edges : int
        At which parts of the solid touched.
    vertices : int
        Copies of vertices that were added.
    midpoints : int
        Vertices that were added on edges.
    moved : int
        Vertices that were moved away from others at the same place.
    largest_move : float
        The largest distance that one was moved.
    together : int
        Vertices that are still where another one is, for lack of room.
    """

    edges: int
    vertices: int
    midpoints: int
    moved: int
    largest_move: float
    together: int


@in_a_line
class Boundary(NamedTuple):
    """A triangle mesh.

    Attributes
    ----------
    points : ndarray of float64, (m, 3)
        Places of its vertices.
    triangles : ndarray of int64, (k, 3)
        Rows of ``points``, counter-clockwise seen from outside the solid.
    indices : ndarray of int64, (m,)
        The input index of each vertex; of a midpoint, that of one end of its edge.
    cuts : Cuts
        Where the boundary was cut apart; all 0 unless it was, to become a manifold.
    """

    points: Floats
    triangles: Indices
    indices: Indices
    cuts: Cuts

    def _repr_html_(self) -> str:
        counts = [("points", self.points), ("triangles", self.triangles)]
        rows = [(name, _pictures.count(len(table))) for name, table in counts]
        return _pictures.summary("walpha.Boundary", [*rows, ("next", "the shape's plot(), save(), to_trimesh()")])
