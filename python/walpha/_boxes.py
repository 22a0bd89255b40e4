from __future__ import annotations

from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha
from ._balls import Bounded
from ._repr import in_a_line
from ._typing import Arrays, Floats, Indices, Progress
from ._work import task


@in_a_line
class PeriodicPowerDiagram(NamedTuple):
    """The power diagram of weighted points in a periodic box, Voronoi's where weights are equal.

    As in :class:`PowerDiagram`, which facets there are is decided exactly: none degenerates to a point or a segment, and none is one of a
    cell without volume. Volumes and areas are rounded.

    Attributes
    ----------
    volumes : ndarray of float64, (n,)
        Of the power cell of each point: 0 for hidden points and duplicates, which have none, and for cells without volume; infinite where it is
        unbounded, as it may be where the box neither repeats nor has walls.
    facets : ndarray of int64, (f, 2)
        The two points whose cells share a facet, ascending. Two cells may share several, and a cell may meet copies of itself: such a facet is
        listed once, although the cell has it twice.
    shifts : ndarray of int64, (f, 3)
        The multiples of the three ``vectors`` by which the second point, in the box, is moved to lie across the facet from the first.
    areas : ndarray of float64, (f,)
        Of each facet; infinite if it is unbounded.
    vectors : ndarray of float64, (3, 3)
        Those of the box, reduced, as rows.
    walls : ndarray of float64, (n, 2, 3), or None
        The areas that each cell has on the lower walls across x, y and z, and on the upper ones; 0 where there is none. None if no walls were given.
    """

    volumes: Floats
    facets: Indices
    shifts: Indices
    areas: Floats
    vectors: Floats
    walls: Floats | None = None


def periodic_power_diagram(
    points: Arrays,
    periodic: Arrays,
    weights: Arrays | None = None,
    *,
    walls: Arrays | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> PeriodicPowerDiagram:
    """The power diagram of points in a periodic box: volumes of cells, areas of facets, and neighbours with their shifts.

    Parameters
    ----------
    points : array_like, (n, 3)
        As in :func:`alpha_shape`. They are moved into the box.
    periodic : array_like, (3,) or (3, 3), or float
        As in :func:`alpha_shape`.
    weights : array_like, (n,), optional
        ω, squared lengths. By default 0: the Voronoi diagram.
    walls : array_like, (2, 3), optional
        The lowest and the highest corner of walls at which cells end, in a box that repeats along one or two vectors: planes perpendicular to the
        axes along which no vector has a component. The coordinates along the other axes mean nothing. Points lie between the walls, or on them.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    PeriodicPowerDiagram

    Raises
    ------
    ValueError
        No points; numbers that are NaN, infinite or absurd; without walls, points in one plane, in a box that does not repeat along all three vectors.
        Points beyond a wall; walls where the box repeats along all three vectors, or along vectors that are not parallel to the walls.
    MemoryError
        The system gives no more.

    Examples
    --------
    The cell of a lone atom of a face-centred lattice is a rhombic dodecahedron: twelve facets, in pairs of opposite ones.

    >>> fcc = walpha.periodic_power_diagram([[0, 0, 0]], [[0, 1, 1], [1, 0, 1], [1, 1, 0]])
    >>> len(fcc.facets), fcc.volumes.round(12)
    (6, array([2.]))

    A layer of atoms between walls: each cell is a brick.

    >>> layer = walpha.periodic_power_diagram([[0, 0, 1], [1, 0, 1]], (2, 1, 0), walls=[[0, 0, 0], [0, 0, 3]])
    >>> layer.volumes.round(12), layer.walls[0].round(12)
    (array([3., 3.]), array([[0., 0., 1.],
           [0., 0., 1.]]))
    """
    cloud = _arrays.cloud(points, weights, valued=False)
    box = _box(periodic)
    corners = None if walls is None else _corners(walls)
    with task(progress, threads) as how:
        diagram, vectors, areas = _walpha.periodic_power_diagram(cloud.points, cloud.weights, box, corners, how)
    return PeriodicPowerDiagram(*diagram, vectors, None if areas is None else areas.reshape(-1, 2, 3))


def _corners(walls: Arrays) -> list[list[float]]:
    """The lowest and the highest corner. Those along axes without walls may be any number."""
    array = _arrays.numbers("walls", walls)
    if array.shape != (2, 3):
        raise ValueError(f"walls has shape {array.shape}: give the lowest and the highest corner, (2, 3)")
    return [[float(x) for x in corner] for corner in _arrays.doubles("walls", array)]


@in_a_line
class FreeSphere(NamedTuple):
    """A sphere that touches balls.

    Attributes
    ----------
    diameter : float
        Negative where the balls leave no way, down to twice the smallest radius.
    center : ndarray of float64, (3,)
        In the box.
    """

    diameter: float
    center: Floats


class Pores(NamedTuple):
    """The pores between the balls of a periodic box.

    Attributes
    ----------
    included : FreeSphere
        The largest that fits.
    free : FreeSphere
        The largest that can move to another copy of its place: the narrowest place on its way.
    free_along : tuple of three FreeSphere
        The same along each vector of the box.
    included_along_free : FreeSphere
        The largest on the way of the free one.
    channels : tuple of int, or None
        In how many independent directions each channel for the probe winds round the box; None without a probe.
    pockets : int or None
        The number of parts that the probe cannot leave.
    void_fraction : Bounded or None
        The share of the box in which the centre of the probe can be, of channels and pockets together.
    """

    included: FreeSphere
    free: FreeSphere
    free_along: tuple[FreeSphere, FreeSphere, FreeSphere]
    included_along_free: FreeSphere
    channels: tuple[int, ...] | None
    pockets: int | None
    void_fraction: Bounded | None


def pores(
    points: Arrays,
    periodic: Arrays,
    radii: Arrays | None = None,
    *,
    probe: float | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> Pores:
    """The largest spheres between the balls of a periodic box, and the channels and pockets for a probe.

    Parameters
    ----------
    points : array_like, (n, 3)
        Centres. They are moved into the box.
    periodic : array_like, (3,) or (3, 3), or float
        As in :func:`alpha_shape`; the box must repeat along all three vectors.
    radii : array_like, (n,), optional
        By default 0.
    probe : float, optional
        The radius of a sphere whose channels and pockets are found.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Pores

    Raises
    ------
    ValueError
        A negative radius; a box that does not repeat along all three vectors; numbers that are NaN, infinite or absurd.
    MemoryError
        The system gives no more.

    Examples
    --------
    In a cubic lattice of balls of radius 0.3, a sphere passes from cube to cube through their faces.

    >>> found = walpha.pores([[0, 0, 0]], 1, [0.3], probe=0.2)
    >>> round(found.included.diameter, 4), round(found.free.diameter, 4), found.channels
    (1.1321, 0.8142, (3,))
    """
    cloud = _arrays.cloud(points, None, valued=False)
    count = len(cloud.points)
    given = np.zeros(count)
    if cloud.weights is not None:
        if radii is not None:
            raise ValueError("radii are given twice: as radii= and as a column of points; omit one")
        if not (cloud.weights >= 0).all():
            raise ValueError("points: weights below 0 are not squares of radii: give radii, or points without weights")
        given = np.sqrt(cloud.weights)
    elif radii is not None:
        given = _arrays.doubles("radii", _arrays.numbers("radii", radii))
    if given.shape != (count,):
        raise ValueError(f"radii have shape {given.shape}: give one for each of {count} points")
    with np.errstate(over="ignore"):
        wrong = np.flatnonzero(~((given >= 0) & np.isfinite(np.square(given))))
    if len(wrong) > 0:
        raise ValueError(f"radii: row {wrong[0]} is {given[wrong[0]]:g}: give a length from 0 up, whose square a double holds")
    if probe is not None and not 0 <= probe < np.inf:
        raise ValueError(f"probe={probe!r}: give a radius, a finite number from 0 up")
    box = _box(periodic)
    with task(progress, threads) as how:
        spheres, probed = _walpha.pores(cloud.points, np.ascontiguousarray(given), box, probe, how)
    included, free, a, b, c, on_way = (FreeSphere(diameter, np.array(center)) for diameter, center in spheres)
    channels, pockets, share = (None, None, None) if probed is None else probed
    return Pores(
        included,
        free,
        (a, b, c),
        on_way,
        None if channels is None else tuple(channels),
        pockets,
        None if share is None else Bounded(*share),
    )


def _box(periodic: Arrays) -> list[float]:
    """The sides or vectors of a box that must be given."""
    box = _arrays.sides(periodic)
    if box is None:
        raise ValueError("periodic=None: give the sides of the box, or its three vectors as rows")
    return box
