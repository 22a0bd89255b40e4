from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _pictures, _walpha
from ._pictures import Chart
from ._typing import Floats, Indices


class Simplices:
    """Every simplex of a filtration, and when it comes.

    Simplices have *numbers*: vertices first, then edges, facets, cells, those of one dimension in
    lexicographic order of their vertices. All arrays but those of vertices are by these numbers. They are made when they are
    first asked for, and pairs are found then: those of loops take longer than the order, the others less.
    """

    _simplices: _walpha.Simplices

    def __init__(self) -> None:
        raise TypeError("Simplices are made by walpha.filtration(points).simplices()")

    @classmethod
    def _of(cls, given: _walpha.Simplices) -> Simplices:
        made = cls.__new__(cls)
        made._simplices = given
        return made

    @functools.cached_property
    def vertices(self) -> Indices:
        """ndarray of int64, (m,): input indices."""
        return _arrays.kept(self._simplices.vertices[:, 0])

    @functools.cached_property
    def edges(self) -> Indices:
        """ndarray of int64, (m, 2): input indices, ascending in each row."""
        return _arrays.kept(self._simplices.edges)

    @functools.cached_property
    def facets(self) -> Indices:
        """ndarray of int64, (m, 3): triangles."""
        return _arrays.kept(self._simplices.facets)

    @functools.cached_property
    def cells(self) -> Indices:
        """ndarray of int64, (m, 4): tetrahedra."""
        return _arrays.kept(self._simplices.cells)

    @functools.cached_property
    def values(self) -> Floats:
        """ndarray of float64, (n,): the α, squared lengths, from which on each is in the shape: the double nearest to the exact number."""
        return _arrays.frozen(self._simplices.intervals)[:, 0]

    @functools.cached_property
    def regular(self) -> Floats:
        """ndarray of float64, (n,): from which α on each is a face of another simplex of the shape."""
        return _arrays.frozen(self._simplices.intervals)[:, 1]

    @functools.cached_property
    def interior(self) -> Floats:
        """ndarray of float64, (n,): from which α on each is off the boundary."""
        return _arrays.frozen(self._simplices.intervals)[:, 2]

    @functools.cached_property
    def ranks(self) -> Indices:
        """ndarray of int64, (n,): the place of the exact value among all that are different, from 0.

        It is equal for equal numbers only, even where two different ones have one nearest double.
        """
        return _arrays.kept(self._simplices.ranks)

    @functools.cached_property
    def gabriel(self) -> NDArray[np.bool_]:
        """ndarray of bool, (n,): whether the smallest orthogonal sphere of each is empty; else it comes with a simplex it is a face of."""
        return _arrays.frozen(self._simplices.gabriel)

    @functools.cached_property
    def gabriel_simplices(self) -> Indices:
        """ndarray of int64, (n,): the number of the Gabriel simplex whose sphere gives the value: its own, or that of the one it comes with.

        How values change with the points, :meth:`Filtration.derivatives` tells of these.
        """
        return _arrays.kept(self._simplices.gabriel_simplices)

    @functools.cached_property
    def cech_values(self) -> Floats:
        """ndarray of float64, (n,): Delaunay–Čech values, squared lengths: the α from which on the balls of all points of each have a point in common.

        Without weights that is the squared radius of the smallest ball that encloses the simplex, as the exact number's nearest double.
        It is at most the value, and at least that of each face; for points in general position the persistent homology is the same.
        """
        return _arrays.frozen(self._simplices.cech_values)

    @functools.cached_property
    def order(self) -> Indices:
        """ndarray of int64, (n,): numbers in the order in which simplices come: by exact value, dimension, vertices.

        Faces come before what they are faces of.
        """
        return _arrays.kept(self._simplices.order)

    @functools.cached_property
    def component_pairs(self) -> Indices:
        """ndarray of int64, (k, 2): persistence pairs of dimension 0, as numbers: what makes a component, and what ends it.

        Pairs that last no time are there too, in each dimension.
        """
        return _arrays.kept(self._simplices.component_pairs)

    @functools.cached_property
    def loop_pairs(self) -> Indices:
        """ndarray of int64, (k, 2): persistence pairs of dimension 1: what closes a loop, and what fills it."""
        return _arrays.kept(self._simplices.loop_pairs)

    @functools.cached_property
    def void_pairs(self) -> Indices:
        """ndarray of int64, (k, 2): persistence pairs of dimension 2: what shuts a void in, and what fills it."""
        return _arrays.kept(self._simplices.void_pairs)

    @property
    def lasting(self) -> tuple[Indices, Indices, Indices, Indices]:
        """tuple of ndarray of int64: what begins something that never ends, by dimension from 0 to 3; of a torus 1, 3, 3 and 1."""
        return self._lasting_components, self._lasting_loops, self._lasting_voids, self._last_cells

    @functools.cached_property
    def _lasting_components(self) -> Indices:
        return _arrays.kept(self._simplices.lasting(0))

    @functools.cached_property
    def _lasting_loops(self) -> Indices:
        return _arrays.kept(self._simplices.lasting(1))

    @functools.cached_property
    def _lasting_voids(self) -> Indices:
        return _arrays.kept(self._simplices.lasting(2))

    @functools.cached_property
    def _last_cells(self) -> Indices:
        return _arrays.kept(self._simplices.lasting(3))

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in _ARRAYS}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update({name: _arrays.frozen(array) for name, array in state.items()})

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], float]]:
        """Pairs in order: a tuple of vertices, and the value."""
        rows = [row for table in self._tables() for row in table.tolist()]
        for number in self.order.tolist():
            yield tuple(rows[number]), float(self.values[number])

    def __repr__(self) -> str:
        counts = ", ".join(str(len(table)) for table in self._tables())
        return f"<walpha.Simplices {counts} vertices, edges, facets, cells>"

    def _repr_html_(self) -> str:
        names = ["vertices", "edges", "facets", "cells"]
        rows = [(name, _pictures.count(len(table))) for name, table in zip(names, self._tables(), strict=False)]
        return _pictures.summary("walpha.Simplices", [*rows, ("next", "persistence(dimension), plot()")])

    def plot(self) -> Chart:
        """The persistence diagram, which a notebook shows: birth against death, with a colour for each dimension.

        Returns
        -------
        Chart
            Axes are logarithmic, unless weights make values negative. What never ends is on the line above; of dots that
            nearly cover each other, one is drawn.

        Examples
        --------
        >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> walpha.filtration(cube).simplices().plot()
        <walpha.Chart of persistence>
        """
        diagrams = [self.persistence(0), self.persistence(1), self.persistence(2)]
        return Chart(_walpha.persistence_svg(*diagrams), "persistence")

    def persistence(self, dimension: Literal[0, 1, 2]) -> Floats:
        """Intervals of a dimension that last some time: a persistence diagram.

        Parameters
        ----------
        dimension : {0, 1, 2}
            Components, loops or voids; coefficients are rational.

        Returns
        -------
        ndarray of float64, (k, 2)
            Values of birth and death, in order of death for 0 and 1 and of birth for 2; what never ends is
            last and has inf. As ``gudhi.SimplexTree.persistence_intervals_in_dimension`` has them, so
            ``gudhi.representations`` makes landscapes and images of them.

        Raises
        ------
        ValueError
            Another dimension.

        Examples
        --------
        Two points meet where their balls do, at the square of half their distance:

        >>> walpha.filtration([[0, 0, 0], [2, 0, 0], [9, 0, 0]]).simplices().persistence(0)
        array([[ 0.  ,  1.  ],
               [ 0.  , 12.25],
               [ 0.  ,   inf]])

        Four points on a square make a loop, until a disc covers it:

        >>> walpha.filtration([[0, 0], [2, 0], [2, 2], [0, 2]]).simplices().persistence(1)
        array([[1., 2.]])
        """
        pairs, lasting = self._lasting_some_time(dimension)
        never = np.column_stack([self.values[lasting], np.full(len(lasting), np.inf)])
        return np.vstack([self.values[pairs], never])

    def _lasting_some_time(self, dimension: int) -> tuple[Indices, Indices]:
        """Pairs of a dimension whose values differ, and what begins something that never ends."""
        # Loops are found only for those who ask for them.
        if dimension == 0:
            pairs, lasting = self.component_pairs, self._lasting_components
        elif dimension == 1:
            pairs, lasting = self.loop_pairs, self._lasting_loops
        elif dimension == 2:
            pairs, lasting = self.void_pairs, self._lasting_voids
        else:
            raise ValueError(f"dimension={dimension}: there are 0, 1 and 2")
        return pairs[self.ranks[pairs[:, 0]] != self.ranks[pairs[:, 1]]], lasting

    def persistence_diagram(self) -> list[tuple[int, tuple[float, float]]]:
        """The persistence diagrams of all dimensions in GUDHI's form.

        Returns
        -------
        list of (int, (float, float))
            Dimension, birth and death: what ``gudhi.SimplexTree.persistence`` returns, and
            ``gudhi.plot_persistence_diagram`` draws.

        Examples
        --------
        >>> walpha.filtration([[0, 0, 0], [2, 0, 0]]).simplices().persistence_diagram()
        [(0, (0.0, 1.0)), (0, (0.0, inf))]
        """
        dimensions: tuple[Literal[0, 1, 2], ...] = (0, 1, 2)
        return [
            (dimension, (birth, death))
            for dimension in dimensions
            for birth, death in self.persistence(dimension).tolist()
        ]

    def _tables(self) -> tuple[Indices, Indices, Indices, Indices]:
        """Rows of each dimension."""
        return self.vertices[:, None], self.edges, self.facets, self.cells


_ARRAYS = [name for name, made in vars(Simplices).items() if isinstance(made, functools.cached_property)]
