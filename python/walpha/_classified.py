"""What objects of the library have in common."""

from __future__ import annotations

import functools
from typing import Self

from . import _arrays, _walpha
from ._typing import Classes, Floats, Indices


class Frozen:
    """What does not change is its own copy."""

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self


class Classified(Frozen):
    """Weighted points, α, and simplices with their classes, in canonical order."""

    @property
    def _held(self) -> _walpha.Shape | _walpha.Complex:
        """The library's own object."""
        raise NotImplementedError

    @functools.cached_property
    def weights(self) -> Floats:
        """ndarray of float64, (n,): the weights ω, squared lengths."""
        return _arrays.frozen(self._held.weights)

    @property
    def alpha(self) -> float:
        """float: α, a **squared** length, as in CGAL and GUDHI."""
        return self._held.alpha

    @functools.cached_property
    def cells(self) -> Indices:
        """ndarray of int64, (m, 4): tetrahedra."""
        return _arrays.kept(self._held.cells)

    @functools.cached_property
    def facets(self) -> Indices:
        """ndarray of int64, (m, 3): triangles."""
        return _arrays.kept(self._held.facets)

    @functools.cached_property
    def edges(self) -> Indices:
        """ndarray of int64, (m, 2)."""
        return _arrays.kept(self._held.edges)

    @functools.cached_property
    def vertices(self) -> Indices:
        """ndarray of int64, (m,)."""
        return _arrays.kept(self._held.vertices[:, 0])

    @functools.cached_property
    def _classes(self) -> list[Classes]:
        return [_arrays.frozen(classes) for classes in self._held.classes()]

    @property
    def cell_classes(self) -> Classes:
        """ndarray of uint8, (m,): the :class:`Class` of each cell."""
        return self._classes[0]

    @property
    def facet_classes(self) -> Classes:
        """ndarray of uint8, (m,): the :class:`Class` of each facet."""
        return self._classes[1]

    @property
    def edge_classes(self) -> Classes:
        """ndarray of uint8, (m,): the :class:`Class` of each edge."""
        return self._classes[2]

    @property
    def vertex_classes(self) -> Classes:
        """ndarray of uint8, (m,): the :class:`Class` of each vertex."""
        return self._classes[3]
