from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from . import _alpha, _arrays, _pictures, _walpha
from ._classified import Classified
from ._shape import AlphaShape
from ._typing import Arrays, Classes, Floats, Indices, Progress
from ._work import task


class Complex(Classified):
    """A complex that some program made, with its points, to be judged and compared.

    Rows and classes that are missing are filled in, and all are in canonical order; what is given
    stays as it is otherwise, right or wrong.

    Parameters
    ----------
    points : array_like, (n, 3) or (n, 2)
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
        faces of the one above it; :func:`check` then looks for missing simplices of those above alone.
    vertices : array_like of int, (m,); optional
        Input indices.
    cell_classes, facet_classes, edge_classes, vertex_classes : array_like of int, (m,); optional
        A :class:`Class` for each row. Where they are missing all rows are in the shape, and have
        the classes that follow from that.
    hidden : array_like of int, (m,); optional
        Points that are not vertices of the regular triangulation.
    duplicates : array_like of int, (m, 2); optional
        Pairs: a point that went, and the one at its place that stayed.
    periodic : array_like, (3,) or (3, 3), or float, optional
        Sides of a box that repeats, as in :func:`alpha_shape`.

    Raises
    ------
    ValueError
        No α, no simplices, columns of different lengths, indices that no point has.

    Examples
    --------
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> walpha.Complex(corners, alpha=1, cells=[[3, 1, 2, 0]])
    <walpha.Complex alpha=1: 4 points, 1 cells, 4 facets, 6 edges, 4 vertices>
    """

    _complex: _walpha.Complex

    def __init__(
        self,
        points: Arrays,
        *,
        alpha: float | None = None,
        alpha_radius: float | None = None,
        weights: Arrays | None = None,
        cells: Arrays | None = None,
        facets: Arrays | None = None,
        edges: Arrays | None = None,
        vertices: Arrays | None = None,
        cell_classes: Arrays | None = None,
        facet_classes: Arrays | None = None,
        edge_classes: Arrays | None = None,
        vertex_classes: Arrays | None = None,
        hidden: Arrays | None = None,
        duplicates: Arrays | None = None,
        periodic: Arrays | None = None,
    ) -> None:
        unseen = _arrays.indices("hidden", hidden, 1)
        with task(None, None) as how:
            self._complex = _walpha.Complex(
                _arrays.finite("points", _arrays.points(points)),
                None if weights is None else _arrays.finite("weights", _arrays.column("weights", weights)),
                _alpha.squared(alpha, alpha_radius, "; it says what the complex should be"),
                (_arrays.indices("cells", cells, 4), _classes("cell_classes", cell_classes)),
                (_arrays.indices("facets", facets, 3), _classes("facet_classes", facet_classes)),
                (_arrays.indices("edges", edges, 2), _classes("edge_classes", edge_classes)),
                (_arrays.indices("vertices", vertices, 1), _classes("vertex_classes", vertex_classes)),
                None if unseen is None else unseen[:, 0],
                _arrays.indices("duplicates", duplicates, 2),
                _arrays.sides(periodic),
                how,
            )

    @classmethod
    def from_simplices(
        cls,
        points: Arrays,
        simplices: Iterable[Sequence[Any]],
        *,
        alpha: float | None = None,
        alpha_radius: float | None = None,
        weights: Arrays | None = None,
    ) -> Complex:
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

        Raises
        ------
        ValueError
            As above; a simplex of no or more than four vertices.

        Examples
        --------
        >>> walpha.Complex.from_simplices([[0, 0, 0], [2, 0, 0]], [([0], 0), ([1], 0), ([0, 1], 1)], alpha=0.5)
        <walpha.Complex alpha=0.5: 2 points, 0 cells, 0 facets, 0 edges, 2 vertices>
        """
        most = _alpha.squared(alpha, alpha_radius, "; it says what the complex should be")
        rows: tuple[list[Any], ...] = ([], [], [], [])
        for simplex in simplices:
            if len(simplex) == 2 and isinstance(simplex[0], (list, tuple, np.ndarray)):
                simplex, value = simplex
                if value != value:
                    raise ValueError(f"simplices: {simplex!r} has the value NaN: give a squared length")
                if value > most:
                    continue
            if not 1 <= len(simplex) <= 4:
                raise ValueError(f"simplices: {simplex!r} has not 1 to 4 vertices")
            rows[len(simplex) - 1].append(simplex)
        vertices, edges, facets, cells = rows
        return cls(
            points, alpha=most, weights=weights, cells=cells, facets=facets, edges=edges, vertices=vertices
        )

    @classmethod
    def of(cls, shape: AlphaShape) -> Complex:
        """What an alpha shape claims to be.

        Parameters
        ----------
        shape : AlphaShape
            Of any kind.

        Returns
        -------
        Complex
            With the weights and the α that its triangulation is regular for.
        """
        made = cls.__new__(cls)
        made._complex = _walpha.Complex.of(shape._shape)
        return made

    @property
    def _held(self) -> _walpha.Complex:
        return self._complex

    @property
    def points(self) -> Floats:
        """ndarray of float64, (n, 3)."""
        return self._complex.points

    @property
    def hidden(self) -> Indices | None:
        """ndarray of int64, (m,), or None if it is not stated which points are hidden."""
        hidden = self._complex.hidden
        return None if hidden is None else _arrays.kept(hidden)

    @property
    def duplicates(self) -> Indices | None:
        """ndarray of int64, (m, 2), or None if it is not stated which points are equal."""
        duplicates = self._complex.duplicates
        return None if duplicates is None else _arrays.kept(duplicates)

    @property
    def periodic(self) -> _arrays.Box | None:
        """tuple or None: the sides of the box that repeats, if one does, or its vectors, reduced, if it is not along the axes."""
        return _arrays.box(self._complex.periodic)

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("alpha", "weights", "cells", "facets", "edges", "vertices", "cell_classes", "facet_classes",
                 "edge_classes", "vertex_classes", "hidden", "duplicates", "periodic")
        given = {name: getattr(self, name) for name in names}
        return _again, (self.points, given, self._complex.lowest)

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(getattr(self, name))} {name}" for name in ("cells", "facets", "edges", "vertices"))
        return f"<walpha.Complex alpha={self.alpha:g}: {len(self.points)} points, {counts}>"


def _again(points: Arrays, given: dict[str, Any], lowest: int = 0) -> Complex:
    made = Complex(points, **given)
    if lowest:
        # All dimensions are given here, and those below were made of faces.
        made._complex = made._complex.with_lowest(lowest)
    return made


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
    facts: dict[str, Any]

    def __str__(self) -> str:
        return self.text


class Verdict(NamedTuple):
    """What a check came to.

    Attributes
    ----------
    verdict : str
        "exact": what the definition makes, ties decided as CGAL does. "valid": right, with another
        choice at ties, where more points lie on one empty sphere than a simplex has corners, or
        points are equal. "wrong": neither. "exact as far as judged", "valid as far as judged":
        nothing wrong was found, but nobody looked for missing simplices, as too many points are
        near each other; ``not_judged`` names the α beyond which that is so.
    valid : bool
        Whether that is right: exact or valid; with ``ties="exact"``, exact. Not where it is so only
        as far as judged.
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
    findings: list[Finding]
    not_judged: list[str]

    def __bool__(self) -> bool:
        return self.valid

    def __repr__(self) -> str:
        found = "no finding" if self.total == 0 else f"{self.total} findings, the first of them: {self.findings[0]}"
        return f"<walpha.Verdict {self.verdict}: {found}; {len(self.not_judged)} not judged>"

    def _repr_html_(self) -> str:
        rows = [("verdict", self.verdict), ("ties", _pictures.count(self.ties)), ("findings", _pictures.count(self.total))]
        rows += [("finding", str(finding)) for finding in self.findings[:3]]
        return _pictures.summary("walpha.Verdict", rows + [("not judged", text) for text in self.not_judged])


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
    facts: dict[str, Any]

    def __bool__(self) -> bool:
        return self.equal

    def __str__(self) -> str:
        return self.text


def check(
    points: Arrays | AlphaShape | Complex,
    alpha: float | None = None,
    *,
    alpha_radius: float | None = None,
    weights: Arrays | None = None,
    cells: Arrays | None = None,
    facets: Arrays | None = None,
    edges: Arrays | None = None,
    vertices: Arrays | None = None,
    cell_classes: Arrays | None = None,
    facet_classes: Arrays | None = None,
    edge_classes: Arrays | None = None,
    vertex_classes: Arrays | None = None,
    hidden: Arrays | None = None,
    duplicates: Arrays | None = None,
    periodic: Arrays | None = None,
    ties: Literal["any", "exact"] = "any",
    most: int = 1000,
    progress: Progress = None,
    threads: int | None = None,
) -> Verdict:
    """Judge a complex exactly: is it the alpha shape of its points?

    Parameters
    ----------
    points : array_like, AlphaShape or Complex
        The points, with the rest as :class:`Complex` takes it: ``check(points, alpha, cells=…)``;
        or a shape or complex, alone.
    alpha : float
        A squared length.
    alpha_radius, weights, cells, facets, edges, vertices : optional
        As :class:`Complex` takes them.
    cell_classes, facet_classes, edge_classes, vertex_classes, hidden, duplicates, periodic : optional
        As :class:`Complex` takes them.
    ties : {"any", "exact"}
        Whether another choice at ties is a finding.
    most : int
        So many findings are listed; all are counted.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Verdict
        True if it is right.

    Raises
    ------
    ValueError
        As :class:`Complex`; simplices beside a shape or complex, which has its own.

    Notes
    -----
    The checker is exact from the doubles given on, and shares no arithmetic and no algorithm with the engines. Cost is
    linear in the complex, and in the number of pairs of points that are not surrounded by cells and
    near enough to each other for an edge between them.

    Examples
    --------
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> walpha.check(corners, np.inf, cells=[[0, 1, 2, 3]]).verdict
    'exact'
    >>> print(walpha.check(corners, np.inf, facets=[[0, 1, 2]]).verdict)
    wrong
    """
    if ties not in ("any", "exact"):
        raise ValueError(f"ties is {ties!r}, and must be 'any' or 'exact'")
    given = {
        "alpha": alpha, "alpha_radius": alpha_radius, "weights": weights, "cells": cells, "facets": facets,
        "edges": edges, "vertices": vertices, "cell_classes": cell_classes, "facet_classes": facet_classes,
        "edge_classes": edge_classes, "vertex_classes": vertex_classes, "hidden": hidden,
        "duplicates": duplicates, "periodic": periodic,
    }  # fmt: skip
    if isinstance(points, (AlphaShape, Complex)):
        named = [name for name, value in given.items() if value is not None]
        if named:
            raise ValueError(f"a shape or complex has its own {' and '.join(named)}: give it alone")
        judged = _complex(points)
    else:
        judged = _again(points, given)
    with task(progress, threads) as how:
        verdict, right, tied, total, findings, not_judged = judged._complex.check(most, ties == "exact", how)
    listed = []
    for text, fields in findings:
        facts = json.loads(fields)
        listed.append(Finding(facts.pop("rule"), text, facts))
    return Verdict(verdict, right, tied, total, listed, json.loads(not_judged))


def compare(
    a: AlphaShape | Complex,
    b: AlphaShape | Complex,
    *,
    progress: Progress = None,
    threads: int | None = None,
) -> Comparison:
    """Say how two complexes over the same points differ.

    Parameters
    ----------
    a, b : AlphaShape or Complex
        Points are matched by their places: the two may number them differently.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Comparison
        True if they are equal. Windings do not count.

    Raises
    ------
    ValueError
        One of them is neither, or of a periodic box.

    Examples
    --------
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> theirs = walpha.Complex(corners, alpha=1, cells=[[0, 1, 2, 3]])
    >>> walpha.compare(theirs, walpha.alpha_shape(corners, 1)).equal
    True
    """
    with task(progress, threads) as how:
        equal, text, facts = _walpha.compare(_complex(a)._complex, _complex(b)._complex, how)
    return Comparison(equal, text, json.loads(facts))


def _complex(given: AlphaShape | Complex) -> Complex:
    if isinstance(given, AlphaShape):
        return Complex.of(given)
    if isinstance(given, Complex):
        return given
    raise ValueError(f"{type(given).__name__} is not a complex: give an AlphaShape or a walpha.Complex")


def _classes(name: str, given: Arrays | None) -> Classes | None:
    if given is None:
        return None
    classes = _arrays.numbers(name, given)
    if classes.ndim != 1 or classes.dtype.kind not in "iu" or not ((classes >= 0) & (classes < 256)).all():
        raise ValueError(f"{name} must be a row of classes, numbers from 0 to 3")
    return classes.astype(np.uint8)
