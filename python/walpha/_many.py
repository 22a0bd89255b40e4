from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from . import _alpha, _arrays, _settings, _walpha
from ._filtration import Filtration
from ._shape import AlphaShape
from ._typing import Arrays, Balls, Progress, Rule
from ._work import task


def filtrations(
    clouds: Iterable[Arrays],
    *,
    weights: Iterable[Arrays] | None = None,
    periodic: Arrays | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> list[Filtration]:
    """The filtrations of many clouds of points, in parallel over clouds.

    Parameters
    ----------
    clouds : iterable of array_like, each (n, 3) or (n, 2), or array_like, (m, n, 3) or (m, n, 2)
        Points as in :func:`filtration`, as many in each cloud as it likes.
    weights : iterable of array_like, each (n,), or array_like, (m, n), optional
        ω of each cloud, squared lengths. By default 0.
    periodic : array_like, (3,) or (3, 3), or float, optional
        The box of all clouds, as in :func:`alpha_shape`.
    progress, threads
        As in :func:`alpha_shape`; parts that are done are clouds.

    Returns
    -------
    list of Filtration
        Each as :func:`filtration` makes it.

    Raises
    ------
    ValueError
        As :func:`filtration`; the text names the cloud, counted from 0.

    Notes
    -----
    Diagrams alone, of many clouds, are found faster by :class:`walpha.tda.AlphaPersistence`, which pairs simplices in parallel, too.

    Examples
    --------
    >>> clouds = np.random.default_rng(0).random((5, 100, 3))
    >>> [len(filtration.simplices().cells) for filtration in walpha.filtrations(clouds)]
    [496, 519, 508, 498, 508]
    """
    given = many(clouds, weights, valued=False)
    with task(progress, threads) as how:
        made = _walpha.filtrations(given, _arrays.sides(periodic), how)
    return [Filtration._of(filtration) for filtration in made]


def alpha_shapes(
    clouds: Iterable[Arrays],
    alpha: float | Rule | None = "auto",
    *,
    alpha_radius: float | None = None,
    weights: Iterable[Arrays] | None = None,
    values: Iterable[Arrays] | None = None,
    exterior: bool = False,
    hidden: bool = False,
    balls: Balls = "power",
    periodic: Arrays | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> list[AlphaShape]:
    """The alpha shapes of many clouds of points, in parallel over clouds.

    Parameters
    ----------
    clouds : iterable of array_like, each (n, 3) or (n, 2), or array_like, (m, n, 3) or (m, n, 2)
        Points as in :func:`alpha_shape`, as many in each cloud as it likes.
    alpha : float, "auto" or "auto:connected"
        α of all clouds, or the rule that finds that of each.
    alpha_radius, exterior, hidden, balls, periodic
        As in :func:`alpha_shape`, for all clouds.
    weights, values : iterable of array_like, each (n,), or array_like, (m, n), optional
        Those of each cloud.
    progress, threads
        As in :func:`alpha_shape`; parts that are done are clouds.

    Returns
    -------
    list of AlphaShape
        Each as :func:`alpha_shape` makes it.

    Raises
    ------
    ValueError
        As :func:`alpha_shape`; the text names the cloud, counted from 0.

    Warns
    -----
    UserWarning
        As :func:`alpha_shape`.

    Examples
    --------
    >>> cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    >>> [shape.volume for shape in walpha.alpha_shapes([cube, 2 * cube], 3)]
    [1.0, 8.0]
    """
    given = many(clouds, weights, values)
    rule = _alpha.rule(alpha, alpha_radius)
    settings = _settings.written(
        alpha=rule, balls=balls, exterior=exterior, hidden=hidden, periodic=_arrays.sides(periodic)
    )
    with task(progress, threads) as how:
        shapes = [AlphaShape._of(shape) for shape in _walpha.alpha_shapes(given, settings, how)]
    if not isinstance(rule, float):
        for shape in shapes:
            _alpha.compared(shape.alpha, stacklevel=3)
    return shapes


def many(
    clouds: Iterable[Arrays],
    weights: Iterable[Arrays] | None = None,
    values: Iterable[Arrays] | None = None,
    *,
    valued: bool = True,
) -> list[_arrays.Cloud]:
    """Clouds as the library takes them."""
    if isinstance(clouds, np.ndarray) and clouds.ndim == 2:
        raise ValueError(f"clouds has shape {clouds.shape}, as one cloud has: give a list of clouds, as in [points]")
    listed = _listed("clouds", clouds)
    columns = []
    for name, column in (("weights", weights), ("values", values)):
        of_each: list[Arrays] | list[None] = [None] * len(listed) if column is None else _listed(name, column)
        if len(of_each) != len(listed):
            raise ValueError(f"{name} of {len(of_each)} clouds for {len(listed)}: give those of each cloud, or None for all")
        columns.append(of_each)
    made = []
    for cloud, (points, its_weights, its_values) in enumerate(zip(listed, *columns)):
        try:
            made.append(_arrays.cloud(points, its_weights, its_values, valued=valued))
        except ValueError as error:
            raise ValueError(f"cloud {cloud}: {error}") from None
    return made


def _listed(name: str, given: Iterable[Arrays]) -> list[Arrays]:
    try:
        return list(given)
    except TypeError:
        raise ValueError(f"{name} cannot be taken one by one: give a list of arrays, or an array of three axes") from None
