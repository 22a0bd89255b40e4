"""Cycles that represent persistence pairs."""

from __future__ import annotations

from typing import NamedTuple

from ._repr import in_a_line
from ._typing import Floats, Indices


@in_a_line
class LoopCycle(NamedTuple):
    """A loop of a filtration, represented by cycles of edges; made by :meth:`Filtration.cycles`.

    Attributes
    ----------
    birth, death : float
        The values between which the loop is there; inf if it never ends.
    pair : tuple of int
        The numbers of the edge that creates it and of the facet that ends it, or None (:class:`Simplices`).
    walk : ndarray of int64, (k,)
        The vertices along a short closed walk, by input index: along the edge that creates the loop, and back on a shortest
        path through edges that are there before. It is of the class of ``edges``, up to classes that are older.
    path : ndarray of float64, (k + 1, 3)
        Their positions, and that of the first again. In a periodic box the walk is laid out in space; one that winds round the box ends at
        another copy of its first vertex.
    edges : ndarray of int64, (m, 2)
        The edges of the cycle that is a boundary from ``death`` on, and not before.
    coefficients : ndarray of int64, (m,)
        The coefficient of each, in the direction of its row: 1 or −1 with few exceptions.
    """

    birth: float
    death: float
    pair: tuple[int, int | None]
    walk: Indices
    path: Floats
    edges: Indices
    coefficients: Indices


@in_a_line
class VoidCycle(NamedTuple):
    """A void of a filtration at its birth; made by :meth:`Filtration.cycles`.

    Attributes
    ----------
    birth, death : float
        The values between which the void is there.
    pair : tuple of int
        The numbers of the facet that closes it and of the cell that fills it (:class:`Simplices`).
    cells : ndarray of int64, (m, 4)
        The tetrahedra that fill it.
    facets : ndarray of int64, (k, 3)
        The triangles around it, by input index, counter-clockwise seen from outside the void.
    corners : ndarray of float64, (k, 3, 3)
        The positions of their corners. In a periodic box the void is laid out in space.
    """

    birth: float
    death: float
    pair: tuple[int, int]
    cells: Indices
    facets: Indices
    corners: Floats
