from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _walpha
from ._typing import Floats, Indices


class Simplices:
    """Every simplex of a filtration, and when it comes.

    Simplices have *numbers*: vertices first, then edges, facets, cells, those of one dimension in
    lexicographic order of their vertices. All arrays but those of vertices are by these numbers.

    Attributes
    ----------
    vertices, edges, facets, cells : ndarray of int64, (m,) to (m, 4)
        Input indices, ascending in each row.
    values : ndarray of float64, (n,)
        The α, squared lengths, from which on each is in the shape: the double nearest to the exact number.
    ranks : ndarray of int64, (n,)
        The place of the exact number among all that are different, from 0: equal for equal numbers
        only, even where two different ones have one nearest double.
    gabriel : ndarray of bool, (n,)
        Whether its own smallest orthogonal sphere is empty; else it comes with a simplex it is a face of.
    gabriel_simplices : ndarray of int64, (n,)
        The number of the Gabriel simplex whose sphere gives the value: its own, or that of the one it comes with. How
        values change with the points, :meth:`Filtration.derivatives` tells of these.
    regular, interior : ndarray of float64, (n,)
        From which α on it is a face of another simplex of the shape, and off the boundary.
    order : ndarray of int64, (n,)
        Numbers in the order in which simplices come: by exact value, dimension, vertices. Faces come
        before what they are faces of.
    component_pairs, loop_pairs, void_pairs : ndarray of int64, (k, 2)
        Persistence pairs of dimensions 0, 1 and 2 as numbers: what makes a component, closes a loop or shuts a
        void in, and what ends it. Those that last no time are there too.
    lasting : tuple of ndarray of int64
        What begins something that never ends, by dimension from 0 to 3; of a torus 1, 3, 3 and 1.
    """

    vertices: Indices
    edges: Indices
    facets: Indices
    cells: Indices
    values: Floats
    ranks: Indices
    gabriel: NDArray[np.bool_]
    gabriel_simplices: Indices
    regular: Floats
    interior: Floats
    order: Indices
    component_pairs: Indices
    loop_pairs: Indices
    void_pairs: Indices
    lasting: tuple[Indices, Indices, Indices, Indices]

    def __init__(self) -> None:
        raise TypeError("Simplices are made by walpha.filtration(points).simplices()")

    @classmethod
    def _of(cls, given: _walpha.Simplices) -> Simplices:
        made = cls.__new__(cls)
        made.vertices = _arrays.kept(given.vertices[:, 0])
        made.edges, made.facets = _arrays.kept(given.edges), _arrays.kept(given.facets)
        made.cells = _arrays.kept(given.cells)
        made.values, made.regular, made.interior = _arrays.frozen(given.intervals).T
        made.ranks, made.gabriel = _arrays.kept(given.ranks), _arrays.frozen(given.gabriel)
        made.gabriel_simplices = _arrays.kept(given.gabriel_simplices)
        made.order = _arrays.kept(given.order)
        made.component_pairs = _arrays.kept(given.component_pairs)
        made.loop_pairs = _arrays.kept(given.loop_pairs)
        made.void_pairs = _arrays.kept(given.void_pairs)
        components, loops, voids, last = (_arrays.kept(np.array(numbers)) for numbers in given.lasting)
        made.lasting = components, loops, voids, last
        return made

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
        if dimension not in (0, 1, 2):
            raise ValueError(f"dimension={dimension}: there are 0, 1 and 2")
        pairs = (self.component_pairs, self.loop_pairs, self.void_pairs)[dimension]
        lasting = self.lasting[dimension]
        pairs = pairs[self.ranks[pairs[:, 0]] != self.ranks[pairs[:, 1]]]
        never = np.column_stack([self.values[lasting], np.full(len(lasting), np.inf)])
        return np.vstack([self.values[pairs], never])

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
