from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha
from ._shape import AlphaShape, squared

_CLASSES = ("cell_classes", "facet_classes", "edge_classes", "vertex_classes")


class Complex:
    """A complex that some program made, with its points, to be judged and compared.

    Parameters
    ----------
    points : array_like, (n, 3)
        x, y, z.
    alpha : float
        A squared length; ``inf`` for a whole triangulation. An unweighted complex whose radii are
        called r has α = r².
    alpha_radius : float
        √α instead.
    weights : array_like, (n,), optional
        ω, squared lengths.
    cells, facets, edges : array_like of int, (m, 4), (m, 3), (m, 2); optional
        Rows of input indices, in any order and winding. A dimension that is missing is made of the
        faces of the one above it.
    vertices : array_like of int, (m,); optional
        Input indices.
    cell_classes, facet_classes, edge_classes, vertex_classes : array_like of int, (m,); optional
        A :class:`Class` for each row. Where they are missing all rows are in the shape, and have
        the classes that follow from that.
    hidden : array_like of int, (m,); optional
        Points that are not vertices of the regular triangulation.
    duplicates : array_like of int, (m, 2); optional
        Pairs: a point that went, and the one at its place that stayed.
    """

    def __init__(
        self,
        points,
        alpha=None,
        *,
        alpha_radius=None,
        weights=None,
        cells=None,
        facets=None,
        edges=None,
        vertices=None,
        cell_classes=None,
        facet_classes=None,
        edge_classes=None,
        vertex_classes=None,
        hidden=None,
        duplicates=None,
    ):
        alpha = squared(alpha, alpha_radius)
        if alpha is None or isinstance(alpha, str):
            raise ValueError("what a complex should be depends on alpha: give it, a squared length")
        classes = (cell_classes, facet_classes, edge_classes, vertex_classes)
        rows = (
            _arrays.indices("cells", cells, 4),
            _arrays.indices("facets", facets, 3),
            _arrays.indices("edges", edges, 2),
            _arrays.indices("vertices", vertices, 1),
        )
        hidden = _arrays.indices("hidden", hidden, 1)
        self._complex = _walpha.Complex(
            _arrays.points(points),
            None if weights is None else _arrays.floats("weights", weights, 1),
            alpha,
            *((r, _numbers(name, c)) for r, name, c in zip(rows, _CLASSES, classes)),
            None if hidden is None else hidden[:, 0],
            _arrays.indices("duplicates", duplicates, 2),
        )

    @classmethod
    def from_simplices(cls, points, simplices, alpha=None, *, alpha_radius=None, weights=None):
        """A complex from lists of simplices, as GUDHI has them.

        Parameters
        ----------
        points, alpha, alpha_radius, weights
            As above.
        simplices : iterable
            ``tree.get_filtration()``, ``tree.get_simplices()`` or ``tree.get_skeleton(3)``: pairs
            of a simplex and its filtration value, of which those with a value of at most α are
            taken. Or simplices alone, all of which are.

        Returns
        -------
        Complex
        """
        most = squared(alpha, alpha_radius)
        if isinstance(most, str):
            raise ValueError(f"alpha={most!r}: give a squared length")
        rows = ([], [], [], [])
        for simplex in simplices:
            if len(simplex) == 2 and isinstance(simplex[0], (list, tuple, np.ndarray)):
                simplex, value = simplex
                if most is not None and value > most:
                    continue
            if not 1 <= len(simplex) <= 4:
                raise ValueError(f"{simplex!r} is not a simplex of 1 to 4 vertices")
            rows[len(simplex) - 1].append(simplex)
        vertices, edges, facets, cells = rows
        return cls(
            points, most, weights=weights, cells=cells, facets=facets, edges=edges, vertices=vertices
        )

    @classmethod
    def of(cls, shape):
        """What an :class:`AlphaShape` claims to be."""
        complex_ = cls.__new__(cls)
        complex_._complex = _walpha.Complex.of(shape._shape)
        return complex_


class Finding(NamedTuple):
    """What is wrong with a complex.

    Attributes
    ----------
    rule : str
        The rule that is broken: "not_regular", "class", "missing_face", …
    text : str
        What breaks it, with the exact values that show it.
    facts : dict
        The same by name. Exact values are text.
    """

    rule: str
    text: str
    facts: dict

    def __str__(self):
        return self.text


class Verdict(NamedTuple):
    """What a check came to.

    Attributes
    ----------
    verdict : str
        "exact": what the definition makes, ties decided as CGAL does. "valid": right, with another
        choice at ties, where more points lie on one empty sphere than a simplex has corners, or
        points are equal. "wrong": neither.
    valid : bool
        Whether that is right: exact or valid; with ``ties="exact"``, exact.
    ties : int
        At how many ties another choice was made.
    total : int
        How many findings there are.
    findings : list of Finding
        The first of them.
    not_judged : list of str
        What could not be judged, in words: hidden points, say, where no exterior simplices are.
    """

    verdict: str
    valid: bool
    ties: int
    total: int
    findings: list
    not_judged: list

    def __bool__(self):
        return self.valid


class Comparison(NamedTuple):
    """How two complexes differ.

    Attributes
    ----------
    equal : bool
        Whether points, weights, α and all simplices with their classes are the same.
    text : str
        The differences in words.
    facts : dict
        By name: ``dimensions`` (vertices, edges, facets, cells), each with ``equal``, ``only_a``,
        ``only_b`` and ``classes``; ``domain``, ``weights``, ``points_only_a``, ``points_only_b``.
    """

    equal: bool
    text: str
    facts: dict

    def __bool__(self):
        return self.equal

    def __str__(self):
        return self.text


def check(points, alpha=None, *, ties="any", most=1000, progress=None, **complex_):
    """Judge a complex exactly: is it the alpha shape of its points?

    Parameters
    ----------
    points : array_like, AlphaShape or Complex
        The points, with the rest as :class:`Complex` takes it: ``check(points, alpha, cells=…)``;
        or a shape or complex, alone.
    alpha : float
        A squared length.
    ties : {"any", "exact"}
        Whether another choice at ties is a finding.
    most : int
        So many findings are listed; all are counted.
    progress : callable, optional
        ``progress(stage, done, total)``.
    **complex_
        ``weights``, ``cells``, ``facets``, ``edges``, ``vertices``, … of :class:`Complex`.

    Returns
    -------
    Verdict
        True if it is right.

    Notes
    -----
    The checker is exact from the doubles given on, linear in the complex, and shares no code with
    the engines.

    Examples
    --------
    >>> tri = scipy.spatial.Delaunay(points)
    >>> walpha.check(points, np.inf, cells=tri.simplices).valid
    True
    """
    if ties not in ("any", "exact"):
        raise ValueError(f"ties is {ties!r}, and must be 'any' or 'exact'")
    if isinstance(points, (AlphaShape, Complex)):
        if alpha is not None or complex_:
            raise ValueError("a shape or complex knows its alpha and simplices: give it alone")
        judged = _complex(points)
    else:
        judged = Complex(points, alpha, **complex_)
    verdict, tied, total, findings, not_judged = judged._complex.check(most, ties == "exact", progress)
    listed = []
    for text, facts in findings:
        facts = json.loads(facts)
        listed.append(Finding(facts.pop("rule"), text, facts))
    return Verdict(verdict, total == 0, tied, total, listed, json.loads(not_judged))


def compare(a, b):
    """Say how two complexes over the same points differ.

    Parameters
    ----------
    a, b : AlphaShape or Complex
        Points are matched by their places: the two may number them differently.

    Returns
    -------
    Comparison
        True if they are equal. Windings do not count.
    """
    equal, text, facts = _walpha.compare(_complex(a)._complex, _complex(b)._complex)
    return Comparison(equal, text, json.loads(facts))


def _complex(given):
    if isinstance(given, AlphaShape):
        return Complex.of(given)
    if isinstance(given, Complex):
        return given
    raise ValueError(f"{type(given).__name__} is not a complex: give an AlphaShape or a walpha.Complex")


def _numbers(name, classes):
    if classes is None:
        return None
    classes = np.asarray(classes)
    if classes.ndim != 1 or classes.dtype.kind not in "iu" or not ((classes >= 0) & (classes < 256)).all():
        raise ValueError(f"{name} must be a row of classes, numbers from 0 to 3")
    return classes.astype(np.uint8)
