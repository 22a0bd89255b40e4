from __future__ import annotations

from typing import Any, NamedTuple

from . import _arrays, _pictures, _walpha
from ._classified import Frozen
from ._repr import in_a_line
from ._typing import Arrays, Floats, Indices, Progress
from ._work import task


@in_a_line
class PowerDiagram(NamedTuple):
    """The power diagram of weighted points, Voronoi's where weights are equal: the dual of a :class:`Triangulation`.

    The power cell of a point is where no other point has a smaller power distance. Which vertices and facets there are is decided
    exactly: cells of the triangulation with one orthogonal sphere are one vertex, however ties were broken, and a facet that
    degenerates to a point, a segment or a ray is not listed, nor one of a cell without volume, as a point has that is only just not
    hidden: cells of other points meet there. Coordinates, volumes and areas are rounded.

    Attributes
    ----------
    vertices : ndarray of float64, (k, 3)
        The centres of the orthogonal spheres, each once. A coordinate beyond the largest double is infinite.
    same_sphere : ndarray of int64, (m,)
        For each of the triangulation's ``simplices`` its row of ``vertices``. Simplices with the same number have the
        same orthogonal sphere, and are together a polytope (Delaunay's, without weights).
    volumes : ndarray of float64, (n,)
        Of the power cell of each point: infinite where it is unbounded, as for points on the hull, 0 for hidden points and duplicates,
        which have none, and for cells without volume; NaN where it is not known, as doubles do not hold products of three lengths.
    facets : ndarray of int64, (f, 2)
        The two points whose cells share a facet, ascending; both cells have a volume.
    areas : ndarray of float64, (f,)
        Of each facet; infinite if it is unbounded, NaN where doubles do not hold products of two lengths.
    """

    vertices: Floats
    same_sphere: Indices
    volumes: Floats
    facets: Indices
    areas: Floats


class Triangulation(Frozen):
    """The regular triangulation of weighted points, Delaunay's where weights are equal.

    Made by :func:`triangulation`. Names and layout are those of ``scipy.spatial.Delaunay``. It does not change: its
    arrays cannot be written to.

    Notes
    -----
    Points on one sphere are triangulated as CGAL does, whatever their order. Cells are positively oriented: their
    determinant is positive, exactly. A pickle holds points and weights, and loading it triangulates them again.

    Examples
    --------
    >>> walpha.triangulation([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    <walpha.Triangulation of 5 points: 2 cells, 0 hidden, 0 duplicates>
    """

    _triangulation: _walpha.Triangulation

    #: ndarray of float64, (n, 3): the points as given.
    points: Floats
    #: ndarray of float64, (n,): the weights ω, squared lengths.
    weights: Floats
    #: ndarray of int64, (m, 4): the cells, rows of input indices.
    simplices: Indices
    #: ndarray of int64, (m, 4): column k is the cell across the facet opposite vertex k; −1 where that is on the hull.
    neighbors: Indices
    #: ndarray of int64, (k, 3): the facets of the convex hull, counter-clockwise seen from outside.
    convex_hull: Indices
    #: ndarray of int64, (k,): points that heavier ones near them make redundant, which are on no cell.
    hidden: Indices
    #: ndarray of int64, (k, 2): a point that went, and the one at its place that stayed, the heaviest or first;
    #: columns 0 and 2 of scipy's ``coplanar``.
    duplicates: Indices

    def __init__(self) -> None:
        raise TypeError("a Triangulation is made by walpha.triangulation(points)")

    @classmethod
    def _of(cls, given: _walpha.Triangulation) -> Triangulation:
        made = cls.__new__(cls)
        made._triangulation = given
        made.points, made.weights = given.points, _arrays.frozen(given.weights)
        made.simplices, made.neighbors = given.simplices, given.neighbors
        made.convex_hull = given.convex_hull
        made.hidden, made.duplicates = _arrays.frozen(given.hidden), given.duplicates
        return made

    def find_simplex(
        self, xi: Arrays, *, progress: Progress = None, threads: int | None = None
    ) -> Indices:
        """The cells that hold places.

        Parameters
        ----------
        xi : array_like, (..., 3)
            x, y, z.
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        ndarray of int64, (...)
            Numbers of rows of :attr:`simplices`, which are closed, decided exactly: of a place on a facet
            one of the two. −1 outside the hull, and for NaN.

        Notes
        -----
        A walk from cell to cell, along a Hilbert curve through the places. O(n) once for each call, so ask for many
        places at a time.

        Examples
        --------
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> walpha.triangulation(corners).find_simplex([[0.1, 0.1, 0.1], [1, 1, 1]])
        array([ 0, -1])
        """
        places = _arrays.places("xi", xi)
        if places.ndim < 1 or places.shape[-1] != 3:
            raise ValueError(f"xi has shape {places.shape}, expected (..., 3): x, y, z of each place")
        with task(progress, threads) as how:
            found = self._triangulation.find(_arrays.points(places.reshape(-1, 3), "xi"), how)
        return found.reshape(places.shape[:-1])

    def power_diagram(self, *, progress: Progress = None, threads: int | None = None) -> PowerDiagram:
        """The power diagram of the points: volumes of cells, areas of facets, and which simplices share a sphere.

        Parameters
        ----------
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        PowerDiagram

        Notes
        -----
        O(m). It is computed anew at each call.

        Examples
        --------
        Of a lattice of 3³ points, the one in the middle has a bounded cell, a cube with six facets.

        >>> lattice = [[x, y, z] for x in range(3) for y in range(3) for z in range(3)]
        >>> diagram = walpha.triangulation(lattice).power_diagram()
        >>> float(diagram.volumes[13]), int((diagram.facets == 13).any(axis=1).sum()), len(diagram.vertices)
        (1.0, 6, 8)
        """
        with task(progress, threads) as how:
            made = self._triangulation.power_diagram(how)
        return PowerDiagram(
            made.vertices,
            _arrays.frozen(made.same_sphere),
            _arrays.frozen(made.volumes),
            _arrays.kept(made.facets),
            _arrays.frozen(made.areas),
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return triangulation, (self.points, self.weights)

    def __repr__(self) -> str:
        return (
            f"<walpha.Triangulation of {len(self.points)} points: {len(self.simplices)} cells, "
            f"{len(self.hidden)} hidden, {len(self.duplicates)} duplicates>"
        )

    def _repr_html_(self) -> str:
        counts = [("points", self.points), ("cells", self.simplices), ("hidden", self.hidden), ("duplicates", self.duplicates)]
        return _pictures.summary("walpha.Triangulation", [(name, _pictures.count(len(of))) for name, of in counts])


def triangulation(
    points: Arrays,
    weights: Arrays | None = None,
    *,
    progress: Progress = None,
    threads: int | None = None,
) -> Triangulation:
    """The regular triangulation of weighted points.

    No point has a power below 0 to the orthogonal sphere of a cell. Every decision is exact.

    Parameters
    ----------
    points : array_like, (n, 3)
        As in :func:`alpha_shape`; they must span a volume.
    weights : array_like, (n,), optional
        ω, squared lengths. By default 0: the Delaunay triangulation.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Triangulation

    Raises
    ------
    ValueError
        Points that span no volume; numbers that are NaN, infinite or absurd.
    MemoryError
        The system gives no more.

    References
    ----------
    F. Aurenhammer, Power diagrams: properties, algorithms and applications, SIAM Journal on Computing 16 (1987),
    doi:10.1137/0216006.

    Examples
    --------
    >>> made = walpha.triangulation([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    >>> made.simplices.shape, made.convex_hull.shape
    ((2, 4), (6, 3))
    >>> made.neighbors.max(axis=1)
    array([1, 0])
    """
    cloud = _arrays.cloud(points, weights, valued=False)
    with task(progress, threads) as how:
        given = _walpha.Triangulation(cloud.points, cloud.weights, how)
    return Triangulation._of(given)
