from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha
from ._parts import Betti, Void
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
        Components of the cells, joined through facets.
    """

    alpha: np.ndarray
    b0: np.ndarray
    b1: np.ndarray
    b2: np.ndarray
    solid_components: np.ndarray


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
    solid_components : int
        Components of the cells, joined through facets.
    volume, area, singular_area : float
        As those of :class:`AlphaShape`.
    coverage : float
        The share of the convex hull that the cells fill.
    voids : list of Void
        Largest first.
    """

    alpha: float
    cells: int
    facets: dict
    edges: dict
    vertices: dict
    betti: Betti
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
            "betti": Betti(*facts["betti"]),
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
        That, and there is no void.
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
    progress : callable, optional
        ``progress(stage, done, total)``.

    Raises
    ------
    ValueError
        As :func:`alpha_shape`.

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

    def __init__(self, points, weights=None, *, progress=None):
        weights = None if weights is None else _arrays.floats("weights", weights, 1)
        self._filtration = _walpha.Filtration(_arrays.points(points), weights, progress)

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
        if rule is None or rule != rule:
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
        """BettiCurve: Betti numbers and solid components at every critical value."""
        alpha, columns = self._filtration.curve(progress)
        return BettiCurve(alpha, *columns)

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


def filtration(points, weights=None, *, progress=None):
    """All alpha shapes of weighted points: a :class:`Filtration`, which see."""
    return Filtration(points, weights, progress=progress)
