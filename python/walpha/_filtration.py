from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha
from ._meshes import wanted
from ._parts import Void, betti
from ._shape import AlphaShape, squared


class BettiCurve(NamedTuple):
    """The topology at every critical value of α.

    Attributes
    ----------
    alpha : ndarray of float64, (m,)
        A double just above each critical value, ascending; row k holds from ``alpha[k]`` on to the
        next. Squared lengths.
    b0, b1, b2 : ndarray of uint64, (m,)
        Components, tunnels, voids.
    solid_components : ndarray of uint64, (m,)
        Components of the cells, joined through facets; of points that span no volume triangles joined
        through edges, or edges through vertices.
    """

    alpha: np.ndarray
    b0: np.ndarray
    b1: np.ndarray
    b2: np.ndarray
    solid_components: np.ndarray


class TorusBettiCurve(NamedTuple):
    """The topology of a torus's shapes at every critical value of α.

    Attributes
    ----------
    alpha, b0, b1, b2, solid_components : ndarray, (m,)
        As in :class:`BettiCurve`.
    b3 : ndarray of uint64, (m,)
        1 from where on the shape is the whole torus: the last row.
    """

    alpha: np.ndarray
    b0: np.ndarray
    b1: np.ndarray
    b2: np.ndarray
    solid_components: np.ndarray
    b3: np.ndarray


class Simplices:
    """Every simplex of a filtration, and when it comes.

    Simplices have *numbers*: vertices first, then edges, facets, cells, those of one dimension in
    lexicographic order of their vertices. All arrays but those of vertices are by these numbers.

    Attributes
    ----------
    vertices, edges, facets, cells : ndarray of uint32, (m, 1) to (m, 4)
        Input indices, ascending in each row.
    values : ndarray of float64, (n,)
        The α, squared lengths, from which on each is in the shape: the double nearest to the exact number.
    ranks : ndarray of uint32, (n,)
        The place of the exact number among all that are different, from 0: equal for equal numbers
        only, even where two different ones have one nearest double.
    gabriel : ndarray of bool, (n,)
        Whether its own smallest orthogonal sphere is empty; else it comes with a simplex it is a face of.
    regular, interior : ndarray of float64, (n,)
        From which α on it is a face of another simplex of the shape, and off the boundary.
    order : ndarray of uint32, (n,)
        Numbers in the order in which simplices come: by exact value, dimension, vertices. Faces come
        before what they are faces of.
    component_pairs, void_pairs : ndarray of uint32, (k, 2)
        Persistence pairs of dimensions 0 and 2 as numbers: what makes a component or shuts a void in, and
        what ends it. Those that last no time are there too.
    lasting : tuple of ndarray of uint32
        What begins something that never ends, by dimension 0, 2 and 3; of a torus 1, 3 and 1.
    """

    def __init__(self, simplices):
        self._simplices = simplices
        self.vertices, self.edges = simplices.vertices, simplices.edges
        self.facets, self.cells = simplices.facets, simplices.cells
        self.values, self.regular, self.interior = simplices.intervals.T
        self.ranks, self.gabriel, self.order = simplices.ranks, simplices.gabriel, simplices.order
        self.component_pairs, self.void_pairs = simplices.component_pairs, simplices.void_pairs
        self.lasting = tuple(np.array(numbers, np.uint32) for numbers in simplices.lasting)

    def __len__(self):
        return len(self.values)

    def __iter__(self):
        """Pairs in order: a tuple of vertices, and the value."""
        rows = [row for table in self._tables() for row in table.tolist()]
        for number in self.order.tolist():
            yield tuple(rows[number]), float(self.values[number])

    def __repr__(self):
        counts = ", ".join(str(len(table)) for table in self._tables())
        return f"<walpha.Simplices {counts} vertices, edges, facets, cells>"

    def persistence(self, dimension):
        """Intervals of dimension 0 or 2 that last some time.

        Parameters
        ----------
        dimension : {0, 2}
            Components or voids. Loops take a reduction of matrices: see :meth:`Filtration.simplex_tree`.

        Returns
        -------
        ndarray of float64, (k, 2)
            Values of birth and death, in order of death for 0 and of birth for 2; what never ends is
            last and has inf.
        """
        if dimension not in (0, 2):
            raise ValueError(f"dimension={dimension}: pairs are known of 0 and 2; see simplex_tree()")
        pairs = self.component_pairs if dimension == 0 else self.void_pairs
        lasting = self.lasting[0 if dimension == 0 else 1]
        pairs = pairs[self.ranks[pairs[:, 0]] != self.ranks[pairs[:, 1]]]
        never = np.column_stack([self.values[lasting], np.full(len(lasting), np.inf)])
        return np.vstack([self.values[pairs], never])

    def _tables(self):
        return self.vertices, self.edges, self.facets, self.cells


class Level(NamedTuple):
    """One α of a ladder, in numbers.

    Attributes
    ----------
    alpha : float
        A squared length.
    cells : int
        Cells of the shape.
    facets, edges, vertices : dict
        How many there are, by the name of their class.
    betti : Betti
        Of a torus TorusBetti.
    solid_components : int
        Components of the cells, joined through facets.
    volume, area, singular_area : float
        As those of :class:`AlphaShape`.
    coverage : float
        The share of the volume of the convex hull that the cells fill; 0 of points that span no volume.
    voids : list of Void
        Largest first.
    """

    alpha: float
    cells: int
    facets: dict
    edges: dict
    vertices: dict
    betti: tuple
    solid_components: int
    volume: float
    area: float
    singular_area: float
    coverage: float
    voids: list

    @classmethod
    def of(cls, facts):
        """From the fields of the library."""
        changed = {
            "alpha": float(facts["alpha"]),
            "betti": betti(facts["betti"]),
            "voids": [Void.of(void) for void in facts["voids"]],
        }
        return cls(**{name: changed.get(name, facts[name]) for name in cls._fields})


class Suggestions(NamedTuple):
    """Values of α to try, squared lengths.

    Attributes
    ----------
    all_points : float
        Every vertex is one of a cell (MATLAB's ``criticalAlpha(shp, 'all-points')``).
    one_region : float
        That, and the cells are one solid component (CGAL's ``find_optimal_alpha(1)``).
    no_void : float
        The same, and without voids.
    plateau : tuple of float
        From where to where the Betti numbers stay the same longest, as a ratio of the squared radii
        of the largest balls.
    """

    all_points: float
    one_region: float
    no_void: float
    plateau: tuple


class Filtration:
    """All alpha shapes of a set of weighted points, from one triangulation.

    Parameters
    ----------
    points : array_like, (n, 3)
        x, y, z.
    weights : array_like, (n,), optional
        ω, squared lengths, the same for every α. By default 0.
    periodic : array_like, (3,), or float, optional
        Sides of a box that repeats, as in :func:`alpha_shape`. No edge of the whole triangulation may
        span half of it.
    progress : callable, optional
        ``progress(stage, done, total)``.

    Raises
    ------
    ValueError
        As :func:`alpha_shape`, and points in one plane.

    Notes
    -----
    A simplex comes at the squared radius of its smallest orthogonal sphere if that is empty, else
    with the first simplex it is a face of. What is in a shape is decided exactly: each shape is
    the one that :func:`alpha_shape` makes.

    References
    ----------
    H. Edelsbrunner and E. P. Mücke, Three-dimensional alpha shapes, ACM Transactions on Graphics
    13 (1994), doi:10.1145/174462.156635.
    """

    def __init__(self, points, weights=None, *, periodic=None, progress=None):
        weights = None if weights is None else _arrays.floats("weights", weights, 1)
        sides = _arrays.sides(periodic)
        self._filtration = _walpha.Filtration(_arrays.points(points), weights, sides, progress)
        self._simplices = None

    @property
    def periodic(self):
        """tuple of float or None: the sides of the box that repeats, if one does."""
        sides = self._filtration.periodic
        return None if sides is None else tuple(sides)

    def simplices(self, *, progress=None):
        """Every simplex with its exact value, in order.

        Parameters
        ----------
        progress : callable, optional
            ``progress(stage, done, total)``.

        Returns
        -------
        Simplices
            Computed once.
        """
        if self._simplices is None:
            self._simplices = Simplices(self._filtration.simplices(progress))
        return self._simplices

    def simplex_tree(self, *, ranks=False):
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

    def dionysus(self, *, ranks=False):
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
        dionysus = wanted("dionysus", "dionysus")
        simplices = self.simplices()
        values = simplices.ranks if ranks else simplices.values
        tables = [row for table in simplices._tables() for row in table.tolist()]
        made = dionysus.Filtration()
        for number in simplices.order.tolist():
            made.append(dionysus.Simplex(tables[number], float(values[number])))
        return made

    def whole(self):
        """AlphaShape: the whole regular triangulation, α = ∞."""
        return AlphaShape(self._filtration.whole())

    def shape(self, alpha=None, *, alpha_radius=None, exterior=False, progress=None):
        """The shape at an α.

        Parameters
        ----------
        alpha : float
            A squared length.
        alpha_radius : float
            √α instead.
        exterior : bool
            Keep the simplices outside the shape.
        progress : callable, optional
            ``progress(stage, done, total)``.

        Returns
        -------
        AlphaShape
        """
        rule = squared(alpha, alpha_radius)
        if rule is None or isinstance(rule, str):
            raise ValueError("give alpha, a squared length, or alpha_radius; see optimal_alpha()")
        return AlphaShape(self._filtration.shape(rule, exterior, progress))

    def levels(self, alphas, *, progress=None):
        """Shapes at several α in numbers, for about the price of one.

        Parameters
        ----------
        alphas : array_like, (m,)
            Squared lengths.
        progress : callable, optional
            ``progress(stage, done, total)``.

        Returns
        -------
        list of Level
            Ascending; equal α are one.
        """
        alphas = _arrays.floats("alphas", alphas, 1)
        return [Level.of(facts) for facts in json.loads(self._filtration.ladder(alphas, progress))]

    def voids(self, alpha, *, progress=None):
        """list of Void: those of the shape at ``alpha``, a squared length, largest first."""
        return self.levels([alpha], progress=progress)[0].voids

    def betti_curve(self, *, progress=None):
        """BettiCurve, of a torus TorusBettiCurve: Betti numbers and solid components at every critical value."""
        alpha, columns = self._filtration.curve(progress)
        kind = BettiCurve if self.periodic is None else TorusBettiCurve
        return kind(alpha, *columns)

    def suggestions(self, *, progress=None):
        """Suggestions: values of α to try."""
        facts = json.loads(self._filtration.suggestions(progress))
        facts["plateau"] = tuple(float(end) for end in facts["plateau"])
        return Suggestions(**facts)

    def optimal_alpha(self, components=1, *, progress=None):
        """The smallest α at which all points are in at most so many solid components.

        Parameters
        ----------
        components : int
            From 1 up.
        progress : callable, optional
            ``progress(stage, done, total)``.

        Returns
        -------
        float
            A squared length: the first double at which the shape is so, exactly. CGAL's
            ``find_optimal_alpha`` searches by halving, and may find a larger one.
        """
        return self._filtration.optimal_alpha(components, progress)


def filtration(points, weights=None, *, periodic=None, progress=None):
    """All alpha shapes of weighted points: a :class:`Filtration`, which see."""
    return Filtration(points, weights, periodic=periodic, progress=progress)
