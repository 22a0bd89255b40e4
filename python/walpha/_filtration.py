from __future__ import annotations

import functools
import json
import operator
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _alpha, _arrays, _pictures, _walpha
from ._classified import Frozen
from ._curves import BettiCurve, Level, Suggestions, TorusBettiCurve
from ._cycles import LoopCycle, VoidCycle
from ._meshes import wanted
from ._parts import Void
from ._shape import AlphaShape
from ._simplices import Simplices
from ._typing import Arrays, Floats, Indices, Progress
from ._work import task

if TYPE_CHECKING:
    import gudhi


class Filtration(Frozen):
    """All alpha shapes of a set of weighted points, from one triangulation.

    Parameters
    ----------
    points : array_like, (n, 3) or (n, 2)
        As in :func:`alpha_shape`.
    weights : array_like, (n,), optional
        ω, squared lengths, the same for every α. By default 0.
    periodic : array_like, (3,) or (3, 3), or float, optional
        Sides of a box that repeats, or its vectors as rows, as in :func:`alpha_shape`.
    progress, threads
        As in :func:`alpha_shape`.

    Raises
    ------
    ValueError
        As :func:`alpha_shape`.

    Notes
    -----
    A simplex comes at the squared radius of its smallest orthogonal sphere if that is empty, else
    with the first simplex it is a face of. What is in a shape is decided exactly: each shape is
    the one that :func:`alpha_shape` makes.

    A pickle holds points, weights and box, and loading it computes the filtration again.

    References
    ----------
    H. Edelsbrunner and E. P. Mücke, Three-dimensional alpha shapes, ACM Transactions on Graphics
    13 (1994), doi:10.1145/174462.156635.

    Examples
    --------
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> filtration = walpha.filtration(cube)
    >>> filtration
    <walpha.Filtration of 8 points>
    >>> filtration.optimal_alpha()
    0.75
    >>> filtration.shape(0.5).betti
    Betti(b0=1, b1=0, b2=1)
    """

    def __init__(
        self,
        points: Arrays,
        *,
        weights: Arrays | None = None,
        periodic: Arrays | None = None,
        progress: Progress = None,
        threads: int | None = None,
    ) -> None:
        cloud = _arrays.cloud(points, weights, valued=False)
        with task(progress, threads) as how:
            self._filtration = _walpha.Filtration(cloud.points, cloud.weights, _arrays.sides(periodic), how)
        self._simplices: Simplices | None = None

    @classmethod
    def _of(cls, given: _walpha.Filtration) -> Filtration:
        made = cls.__new__(cls)
        made._filtration, made._simplices = given, None
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        own = self._own_points()
        return _again, (self.points[:own], self.weights[:own], self.periodic)

    def _own_points(self) -> int:
        return len(self.points) - len(self.copies)

    def __repr__(self) -> str:
        box = "" if self.periodic is None else f" in a periodic box {self.periodic}"
        return f"<walpha.Filtration of {self._own_points()} points{box}>"

    def _repr_html_(self) -> str:
        points = _pictures.count(self._own_points())
        box = "none"
        if self.periodic is not None:
            numbers = np.array(self.periodic)
            lengths = numbers if numbers.ndim == 1 else np.linalg.norm(numbers, axis=1)
            box = " × ".join(_pictures.brief(float(length)) for length in lengths)
            box += "" if numbers.ndim == 1 else ", slanted"
        shown = "none"
        if self.weights.any():
            shown = f"{_pictures.brief(float(self.weights.min()))} to {_pictures.brief(float(self.weights.max()))}"
        rows = [("points", points), ("weights", shown), ("periodic box", box)]
        rows += [("next", "betti_curve().plot(), simplices().plot(), shape(α)")]
        return _pictures.summary("walpha.Filtration", rows)

    @property
    def points(self) -> Floats:
        """ndarray of float64, (n, 3): the points as given; of a torus, in its box, and after them :attr:`copies`."""
        return self._filtration.points

    @property
    def weights(self) -> Floats:
        """ndarray of float64, (n,): the weights ω, squared lengths."""
        return _arrays.frozen(self._filtration.weights)

    @property
    def periodic(self) -> _arrays.Box | None:
        """tuple or None: the sides of the box that repeats, if one does, or its vectors, reduced, if it is not along the axes."""
        return _arrays.box(self._filtration.periodic)

    @functools.cached_property
    def copies(self) -> Indices:
        """ndarray of int64, (k,): of which points the last k are copies, in a small periodic box (:attr:`AlphaShape.copies`)."""
        return _arrays.kept(self._filtration.copies)

    @functools.cached_property
    def shifts(self) -> Indices:
        """ndarray of int64, (k, 3): the multiples of the vectors of the box by which each of these :attr:`copies` is moved."""
        return _arrays.kept(self._filtration.shifts)

    def simplices(self, *, progress: Progress = None, threads: int | None = None) -> Simplices:
        """Every simplex with its exact value, in order.

        Parameters
        ----------
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        Simplices
            Computed once.
        """
        if self._simplices is None:
            with task(progress, threads) as how:
                self._simplices = Simplices._of(self._filtration.simplices(how))
        return self._simplices

    def cycle(self, pair: Sequence[int]) -> LoopCycle | VoidCycle:
        """A cycle that represents a persistence pair of dimension 1 or 2.

        Parameters
        ----------
        pair : sequence of int
            The numbers of the simplices that begin and end it: a row of :attr:`Simplices.loop_pairs` or :attr:`Simplices.void_pairs`;
            of a loop that never ends, the edge alone.

        Returns
        -------
        LoopCycle or VoidCycle

        Raises
        ------
        ValueError
            Numbers that are not a pair of these dimensions.
        """
        simplices = self.simplices()
        try:
            begins, *ends = (operator.index(number) for number in pair)
        except (TypeError, ValueError):
            raise ValueError(f"pair={pair}: give the numbers of the simplices that begin and end it") from None
        loops, voids = simplices.loop_pairs, simplices.void_pairs
        is_loop = ends in loops[loops[:, 0] == begins, 1:].tolist() or (not ends and begins in simplices.lasting[1])
        if is_loop:
            return self._loops([begins], [ends[0] if ends else None])[0]
        if ends in voids[voids[:, 0] == begins, 1:].tolist():
            return self._voids([begins], ends)[0]
        raise ValueError(f"pair={tuple(pair)} is not a pair: give a row of simplices().loop_pairs or simplices().void_pairs")

    def cycles(self, dimension: Literal[1, 2], *, minimum: float | None = None) -> list[LoopCycle] | list[VoidCycle]:
        """Cycles that represent persistence pairs, the most persistent first.

        Parameters
        ----------
        dimension : {1, 2}
            Loops or voids. Surfaces that never end, of a periodic box, are not among them.
        minimum : float, optional
            Of all pairs whose death is at least this much above their birth, a squared length. By default of the 100 of largest
            persistence.

        Returns
        -------
        list of LoopCycle or of VoidCycle

        Examples
        --------
        Four points on a square:

        >>> [loop] = walpha.filtration([[0, 0], [2, 0], [2, 2], [0, 2]]).cycles(1)
        >>> loop.birth, loop.death, sorted(loop.walk.tolist())
        (1.0, 2.0, [0, 1, 2, 3])
        """
        if dimension not in (1, 2):
            raise ValueError(f"dimension={dimension}: there are cycles of dimensions 1 and 2")
        if minimum is not None and not minimum >= 0:
            raise ValueError(f"minimum={minimum}: give a persistence that is not negative")
        simplices = self.simplices()
        pairs = simplices.loop_pairs if dimension == 1 else simplices.void_pairs
        pairs = pairs[simplices.ranks[pairs[:, 0]] != simplices.ranks[pairs[:, 1]]]
        begins, ends = pairs[:, 0], pairs[:, 1]
        persistence = simplices.values[ends] - simplices.values[begins]
        if dimension == 1:
            lasting = simplices.lasting[1]
            begins = np.concatenate([begins, lasting])
            ends = np.concatenate([ends, np.full(len(lasting), -1)])
            persistence = np.concatenate([persistence, np.full(len(lasting), np.inf)])
        order = np.argsort(-persistence, kind="stable")
        order = order[:100] if minimum is None else order[persistence[order] >= minimum]
        if dimension == 2:
            return self._voids(begins[order].tolist(), ends[order].tolist())
        return self._loops(begins[order].tolist(), [None if end < 0 else end for end in ends[order].tolist()])

    def _loops(self, begins: list[int], ends: list[int | None]) -> list[LoopCycle]:
        simplices = self.simplices()
        found = simplices._simplices.loop_cycles(np.array(begins, np.uint32))
        first = len(simplices.vertices)
        loops = []
        for begin, end, cycle in zip(begins, ends, found):
            assert cycle is not None, "a loop begins with this edge"
            walk, path, edges, coefficients = cycle
            death = np.inf if end is None else float(simplices.values[end])
            rows = simplices.edges[edges.astype(np.int64) - first]
            loop = LoopCycle(
                float(simplices.values[begin]), death, (begin, end), walk.astype(np.int64), path, rows, coefficients.astype(np.int64)
            )
            loops.append(loop)
        return loops

    def _voids(self, begins: list[int], ends: list[int]) -> list[VoidCycle]:
        simplices = self.simplices()
        found = simplices._simplices.void_cycles(np.array(ends, np.uint32))
        first = len(simplices.values) - len(simplices.cells)
        voids = []
        for begin, end, cycle in zip(begins, ends, found):
            assert cycle is not None, "a void ends with this cell"
            cells, facets, corners = cycle
            birth, death = float(simplices.values[begin]), float(simplices.values[end])
            rows = simplices.cells[cells.astype(np.int64) - first]
            void = VoidCycle(birth, death, (begin, end), rows, facets.astype(np.int64), corners.reshape(-1, 3, 3))
            voids.append(void)
        return voids

    def derivatives(self, simplices: Arrays) -> tuple[Floats, Floats]:
        """How the values of Gabriel simplices change with their points.

        Parameters
        ----------
        simplices : array_like of int, (m, k)
            Rows of one to four input indices. Of these points the squared radius of the smallest orthogonal sphere is meant, which is
            the value of a Gabriel simplex; :attr:`Simplices.gabriel_simplices` says which one gives the value of another.

        Returns
        -------
        positions : ndarray of float64, (m, k, 3)
            Derivatives by x, y and z of each point, lengths.
        weights : ndarray of float64, (m, k)
            Derivatives by the weight of each point.

        Raises
        ------
        ValueError
            Another shape, an index of no point, or points that span no simplex, as equal ones do.

        Notes
        -----
        With c the centre and bᵢ its barycentric coordinates these are 2 bᵢ (pᵢ - c) and -bᵢ. However flat a simplex is, each bᵢ is right
        to 1e-15 of the largest, and each product to that times 2 ‖pᵢ - c‖.

        Examples
        --------
        The square of half the distance grows by half the distance:

        >>> positions, weights = walpha.filtration([[0, 0, 0], [4, 0, 0]]).derivatives([[0, 1]])
        >>> positions
        array([[[-2.,  0.,  0.],
                [ 2.,  0.,  0.]]])
        >>> weights
        array([[-0.5, -0.5]])
        """
        rows = _arrays.numbers("simplices", simplices)
        if rows.ndim != 2 or not 1 <= rows.shape[1] <= 4 or rows.dtype.kind not in "iu":
            raise ValueError(f"simplices has shape {rows.shape} and type {rows.dtype}: give rows of one to four indices")
        count = len(self.points)
        if rows.size and not (0 <= rows.min() and rows.max() < count):
            raise ValueError(f"simplices has indices from {rows.min()} to {rows.max()}: there are {count} points")
        with task(None, None) as how:
            flat = self._filtration.derivatives(rows.astype(np.uint32).ravel(), rows.shape[1], how)
        found = flat.reshape(*rows.shape, 4)
        flat_rows = np.flatnonzero(np.isnan(found).any(axis=(1, 2)))
        if len(flat_rows):
            row = flat_rows[0]
            raise ValueError(f"simplices: row {row}, {rows[row].tolist()}, spans no simplex: leave it out")
        return found[..., :3], found[..., 3]

    def simplex_tree(self, *, ranks: bool = False) -> gudhi.SimplexTree:
        """For GUDHI: a ``gudhi.SimplexTree`` of all simplices.

        Parameters
        ----------
        ranks : bool
            Give each simplex the rank of its value instead (:attr:`Simplices.ranks`): a whole number, so that
            values which differ by less than doubles can resolve stay apart. ``Simplices.values`` of one
            simplex of a rank is its value.

        Returns
        -------
        gudhi.SimplexTree
            Its filtration values are squared lengths, as those of ``gudhi.AlphaComplex``.
        """
        self._refuse_copies("simplex_tree")
        gudhi = wanted("gudhi", "simplex_tree")
        simplices = self.simplices()
        values = simplices.ranks.astype(np.float64) if ranks else simplices.values
        tree, first = gudhi.SimplexTree(), 0
        for rows in simplices._tables():
            # Faces first, so that each keeps its own value.
            if len(rows):
                of = np.ascontiguousarray(values[first : first + len(rows)])
                tree.insert_batch(np.ascontiguousarray(rows.T.astype(np.int32)), of)
            first += len(rows)
        return tree

    def dionysus(self, *, ranks: bool = False) -> Any:
        """For Dionysus 2: a ``dionysus.Filtration`` of all simplices, in order.

        Parameters
        ----------
        ranks : bool
            As in :meth:`simplex_tree`.

        Returns
        -------
        dionysus.Filtration
            Not to be sorted again: faces come before what they are faces of.
        """
        self._refuse_copies("dionysus")
        dionysus = wanted("dionysus", "dionysus")
        simplices = self.simplices()
        values = simplices.ranks if ranks else simplices.values
        tables = [row for table in simplices._tables() for row in table.tolist()]
        made = dionysus.Filtration()
        for number in simplices.order.tolist():
            made.append(dionysus.Simplex(tables[number], float(values[number])))
        return made

    def _refuse_copies(self, name: str) -> None:
        """A simplicial complex is asked for, where vertices do not identify simplices."""
        if len(self.copies):
            raise ValueError(
                f"{name}: in this periodic box several simplices have the same points, so it is not a simplicial complex: "
                "repeat the points along the vectors of the box, and give the box that holds them"
            )

    def whole(self) -> AlphaShape:
        """The whole regular triangulation as a shape.

        Returns
        -------
        AlphaShape
            α = ∞.
        """
        return AlphaShape._of(self._filtration.whole())

    def shape(
        self,
        alpha: float | None = None,
        *,
        alpha_radius: float | None = None,
        exterior: bool = False,
        progress: Progress = None,
        threads: int | None = None,
    ) -> AlphaShape:
        """The shape at an α.

        Parameters
        ----------
        alpha : float
            A squared length.
        alpha_radius : float
            √α instead.
        exterior : bool
            Keep the simplices outside the shape.
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        AlphaShape
        """
        at = _alpha.squared(alpha, alpha_radius, "; optimal_alpha() finds one")
        with task(progress, threads) as how:
            return AlphaShape._of(self._filtration.shape(at, exterior, how))

    def levels(
        self, alphas: Arrays, *, progress: Progress = None, threads: int | None = None
    ) -> list[Level]:
        """Shapes at several α in numbers, for about the price of one.

        Parameters
        ----------
        alphas : array_like, (m,)
            Squared lengths.
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        list of Level
            Ascending; equal α are one.

        Examples
        --------
        >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> [level.volume for level in walpha.filtration(cube).levels([0.5, 0.75])]
        [0.0, 1.0]
        """
        given = _arrays.column("alphas", alphas, "shape")
        if np.isnan(given).any():
            raise ValueError(f"alphas: row {np.flatnonzero(np.isnan(given))[0]} is NaN: give squared lengths")
        with task(progress, threads) as how:
            return [Level._of(facts) for facts in json.loads(self._filtration.ladder(given, how))]

    def voids(
        self, alpha: float, *, progress: Progress = None, threads: int | None = None
    ) -> list[Void]:
        """The voids of the shape at an α.

        Parameters
        ----------
        alpha : float
            A squared length.
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        list of Void
            Largest first.
        """
        at = _alpha.squared(alpha, None, "")
        return self.levels([at], progress=progress, threads=threads)[0].voids

    def betti_curve(
        self, *, progress: Progress = None, threads: int | None = None
    ) -> BettiCurve | TorusBettiCurve:
        """Betti numbers and solid components at every critical value.

        Parameters
        ----------
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        BettiCurve
            Of a torus TorusBettiCurve.

        Examples
        --------
        >>> curve = walpha.filtration(np.eye(4)[:, :3]).betti_curve()
        >>> curve.b0
        array([4, 1, 1, 1])
        """
        with task(progress, threads) as how:
            alpha, columns = self._filtration.curve(how)
        kind = BettiCurve if self.periodic is None else TorusBettiCurve
        return kind(alpha, *map(_arrays.int64, columns))

    def suggestions(self, *, progress: Progress = None, threads: int | None = None) -> Suggestions:
        """Values of α to try.

        Parameters
        ----------
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        Suggestions
        """
        with task(progress, threads) as how:
            facts = json.loads(self._filtration.suggestions(how))
        low, high = facts["plateau"]
        return Suggestions(**{**facts, "plateau": (float(low), float(high))})

    def optimal_alpha(
        self, components: int = 1, *, progress: Progress = None, threads: int | None = None
    ) -> float:
        """The smallest α at which all points are in at most so many solid components.

        Parameters
        ----------
        components : int
            From 1 up.
        progress, threads
            As in :func:`alpha_shape`.

        Returns
        -------
        float
            A squared length: the smallest double at which this holds, exactly. CGAL's
            ``find_optimal_alpha`` searches by halving, and may find a larger one.
        """
        with task(progress, threads) as how:
            return self._filtration.optimal_alpha(components, how)


def filtration(
    points: Arrays,
    *,
    weights: Arrays | None = None,
    periodic: Arrays | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> Filtration:
    """All alpha shapes of weighted points.

    Parameters
    ----------
    points : array_like, (n, 3) or (n, 2)
        As in :func:`alpha_shape`.
    weights : array_like, (n,), optional
        ω, squared lengths, the same for every α. By default 0.
    periodic : array_like, (3,) or (3, 3), or float, optional
        Sides of a box that repeats, or its vectors as rows, as in :func:`alpha_shape`.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Filtration

    Examples
    --------
    >>> walpha.filtration([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], weights=[1, 1, 1, 1]).optimal_alpha()
    2.0
    """
    return Filtration(points, weights=weights, periodic=periodic, progress=progress, threads=threads)


def _again(points: Floats, weights: Floats, periodic: _arrays.Box | None) -> Filtration:
    return Filtration(points, weights=weights, periodic=periodic)
