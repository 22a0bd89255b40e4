"""Persistence diagrams of many point clouds, and features of diagrams, as transformers of scikit-learn.

Diagrams have the layout of giotto-tda: an array (n_samples, n_intervals, 3) of births, deaths and dimensions. So its transformers
take them, and those here take its diagrams.

Examples
--------
Four clouds become rows of a table, for any classifier:

>>> from sklearn.pipeline import make_pipeline
>>> from walpha.tda import AlphaPersistence, BettiCurve
>>> clouds = np.random.default_rng(0).random((4, 50, 3))
>>> make_pipeline(AlphaPersistence(radius=True), BettiCurve(resolution=10)).fit_transform(clouds).shape
(4, 30)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _tables, _walpha
from ._many import many
from ._typing import Arrays, Floats
from ._work import task

try:
    import joblib
    from sklearn.base import BaseEstimator, TransformerMixin
    from sklearn.utils.validation import check_is_fitted
except ImportError as error:
    raise ImportError(f"walpha.tda needs scikit-learn ({error}): pip install scikit-learn") from error

__all__ = ["AlphaPersistence", "BettiCurve", "PersistenceImage", "PersistenceLandscape"]


class AlphaPersistence(TransformerMixin, BaseEstimator, auto_wrap_output_keys=None):  # type: ignore[misc, call-arg]
    """Diagrams of the alpha filtrations of point clouds, in the layout of giotto-tda.

    Parameters
    ----------
    homology_dimensions : sequence of int
        Of 0 (components), 1 (loops) and 2 (voids).
    radius : bool
        Births and deaths are radii √α, as those of a Čech filtration, and not α itself, squared lengths. With weights α may be
        negative, and has no root.
    reduced_homology : bool
        Leave out the component that never ends. With False its death is inf.
    weighted : bool
        The last column of each cloud has the weights ω of its points, squared lengths. Tables need no such word: they have a column
        weight, or radius.
    periodic : array_like, (3,) or (3, 3), or float, optional
        The box of all clouds, as in :func:`walpha.alpha_shape`. Loops and voids that never end, as they go round the box, have inf.
    n_jobs : int, optional
        How many threads work, as everywhere in scikit-learn: None is one, or what ``joblib.parallel_config`` says, and -1 one for
        each processor. Each works at one cloud at a time, without the interpreter's lock.

    Notes
    -----
    Values are the doubles nearest to the exact ones, or their roots; what lasts no time is left out.

    Examples
    --------
    >>> from walpha.tda import AlphaPersistence
    >>> pair, triple = [[0, 0, 0], [2, 0, 0]], [[0, 0, 0], [2, 0, 0], [8, 0, 0]]
    >>> AlphaPersistence(homology_dimensions=(0,)).fit_transform([pair, triple])
    array([[[0., 1., 0.],
            [0., 0., 0.]],
    <BLANKLINE>
           [[0., 1., 0.],
            [0., 9., 0.]]])
    """

    def __init__(
        self,
        homology_dimensions: Sequence[int] = (0, 1, 2),
        *,
        radius: bool = False,
        reduced_homology: bool = True,
        weighted: bool = False,
        periodic: Arrays | None = None,
        n_jobs: int | None = None,
    ) -> None:
        # As scikit-learn wants it: as given, and checked by fit.
        self.homology_dimensions = homology_dimensions
        self.radius = radius
        self.reduced_homology = reduced_homology
        self.weighted = weighted
        self.periodic = periodic
        self.n_jobs = n_jobs

    def fit(self, X: Iterable[Arrays], y: object = None) -> AlphaPersistence:
        """Check the parameters: there is nothing to learn.

        Parameters
        ----------
        X : iterable of array_like
            Not looked at.
        y
            Not looked at.

        Returns
        -------
        AlphaPersistence
            Itself.
        """
        if any(dimension not in (0, 1, 2) for dimension in self.homology_dimensions):
            raise ValueError(f"homology_dimensions={self.homology_dimensions}: there are 0, 1 and 2")
        _arrays.sides(self.periodic)
        return self

    def transform(self, X: Iterable[Arrays], y: object = None) -> Floats:
        """The diagram of each point cloud.

        Parameters
        ----------
        X : iterable of array_like, each (n, 3) or (n, 2)
            Point clouds, of as many points as they like; or an array (n_samples, n, 3). With weights there is one more column.
        y
            Not looked at.

        Returns
        -------
        ndarray of float64, (n_samples, n_intervals, 3)
            Birth, death and dimension, by dimension. Diagrams with fewer intervals than the largest are filled with
            such as are born and die at 0: [0, 0, dimension].

        Raises
        ------
        ValueError
            Dimensions other than 0, 1 and 2; what :func:`walpha.filtrations` raises.
        """
        self.fit(X)
        dimensions = [int(dimension) for dimension in self.homology_dimensions]
        clouds, weights = _weighed(X) if self.weighted else (X, None)
        given = many(clouds, weights, valued=False)
        with task(None, joblib.effective_n_jobs(self.n_jobs)) as how:  # pyright: ignore
            found = _walpha.diagrams(given, dimensions, _arrays.sides(self.periodic), how)
        blocks = []
        for dimension, of_one in zip(dimensions, zip(*found)):
            kept = [self._kept(dimension, intervals) for intervals in of_one]
            block = np.zeros((len(kept), max(map(len, kept)), 3))
            block[:, :, 2] = dimension
            for rows, intervals in zip(block, kept):
                rows[: len(intervals), :2] = intervals
            blocks.append(block)
        return np.concatenate(blocks, axis=1) if blocks else np.zeros((len(found), 0, 3))

    def _kept(self, dimension: int, intervals: Floats) -> Floats:
        if dimension == 0 and self.reduced_homology:
            intervals = intervals[np.isfinite(intervals[:, 1])]
        if not self.radius:
            return intervals
        if (intervals < 0).any():
            raise ValueError(f"radius=True: α is {intervals.min():g} where points with weights begin, and has no root: give radius=False")
        return np.sqrt(intervals)

    def set_output(self, *, transform: str | None = None) -> AlphaPersistence:  # pyright: ignore
        """For pipelines that are asked for tables: diagrams are not tables, and stay arrays.

        Parameters
        ----------
        transform : str, optional
            Without effect.

        Returns
        -------
        AlphaPersistence
            Itself.
        """
        return self

    def get_feature_names_out(self, input_features: object = None) -> NDArray[np.object_]:
        """What the last axis has.

        Parameters
        ----------
        input_features
            Not looked at.

        Returns
        -------
        ndarray of str
        """
        return np.array(["birth", "death", "dimension"], object)

    def __sklearn_tags__(self) -> Any:
        return _tags(super().__sklearn_tags__(), requires_fit=False)


class _OfDiagrams(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """A transformer that learns a grid for each dimension, and makes a row of numbers on the grids of each diagram."""

    def fit(self, X: Arrays, y: object = None) -> Self:
        """Find the grid of each dimension.

        Parameters
        ----------
        X : array_like, (n_samples, n_intervals, 3)
            Diagrams, as :class:`AlphaPersistence` has them.
        y
            Not looked at.

        Returns
        -------
        object
            Itself. ``grids_`` has the grid of each dimension, ascending.
        """
        self._check()
        diagrams = _diagrams(X)
        self.grids_ = {}
        for dimension in np.unique(diagrams[:, :, 2]).astype(int).tolist():
            intervals = _lasting(diagrams.reshape(-1, 3), dimension)
            self.grids_[dimension] = self._grid(intervals if len(intervals) else np.zeros((1, 2)))
        return self

    def transform(self, X: Arrays) -> Floats:
        """The row of each diagram.

        Parameters
        ----------
        X : array_like, (n_samples, n_intervals, 3)
            Diagrams. Dimensions that ``fit`` has not seen are passed over.

        Returns
        -------
        ndarray of float64, (n_samples, n_features)
            By dimension; a table of pandas or polars where ``set_output`` asks for it.

        Raises
        ------
        ValueError
            An array of another shape, or whose rows are not intervals.
        """
        check_is_fitted(self)
        diagrams = _diagrams(X)
        rows = np.zeros((len(diagrams), len(self.get_feature_names_out())))
        for row, diagram in zip(rows, diagrams):
            blocks = [self._row(dimension, _lasting(diagram, dimension)).ravel() for dimension in self.grids_]
            row[:] = np.concatenate([np.zeros(0), *blocks])
        return rows

    def get_feature_names_out(self, input_features: object = None) -> NDArray[np.object_]:
        """The names of the columns.

        Parameters
        ----------
        input_features
            Not looked at.

        Returns
        -------
        ndarray of str
            The dimension, "h1", and indices on its grid, from 0.
        """
        check_is_fitted(self)
        return np.array([f"h{dimension}_{name}" for dimension in self.grids_ for name in self._names(dimension)], object)

    def _check(self) -> None:
        for name in ("resolution", "n_layers"):
            number = getattr(self, name, 1)
            if not (isinstance(number, (int, np.integer)) and number >= 1):
                raise ValueError(f"{name}={number!r} is not a count: give a whole number from 1 up")

    def _grid(self, intervals: Floats) -> Any:
        raise NotImplementedError

    def _row(self, dimension: int, intervals: Floats) -> Floats:
        raise NotImplementedError

    def _names(self, dimension: int) -> list[str]:
        raise NotImplementedError

    def __sklearn_tags__(self) -> Any:
        return _tags(super().__sklearn_tags__(), requires_fit=True)


class PersistenceImage(_OfDiagrams):
    """Persistence images: sums of Gaussians at intervals, on a grid of births and persistence.

    Parameters
    ----------
    resolution : int
        Pixels along each axis, whose first and last are at the least and at the largest birth and at persistence 0 and the largest
        persistence that ``fit`` sees. Births that all are equal, as those of components without weights, have one column.
    bandwidth : float, optional
        The standard deviation of the Gaussians, in the unit of the diagrams. By default the larger distance of two pixels, of each
        dimension.
    power : float
        An interval weighs its persistence to this power; 0 counts them.

    Notes
    -----
    Intervals that never end are left out. A pixel has the sum of densities at its place, as in GUDHI.

    References
    ----------
    H. Adams et al., Persistence images, Journal of Machine Learning Research 18 (2017),
    http://jmlr.org/papers/v18/16-337.html.

    Examples
    --------
    >>> from walpha.tda import PersistenceImage
    >>> diagrams = [[[0, 1, 1], [1, 2, 1]]]
    >>> PersistenceImage(resolution=2, bandwidth=1).fit_transform(diagrams).round(3)
    array([[0.155, 0.155, 0.256, 0.256]])
    """

    def __init__(self, resolution: int = 20, *, bandwidth: float | None = None, power: float = 1.0) -> None:
        self.resolution = resolution
        self.bandwidth = bandwidth
        self.power = power

    def _check(self) -> None:
        super()._check()
        if self.bandwidth is not None and not 0 < self.bandwidth < np.inf:
            raise ValueError(f"bandwidth={self.bandwidth} is not a width: give a length above 0")
        if not 0 <= self.power < np.inf:
            raise ValueError(f"power={self.power}: give a number from 0 up")

    def _grid(self, intervals: Floats) -> tuple[Floats, Floats]:
        intervals = _ended(intervals)
        if len(intervals) == 0:
            intervals = np.zeros((1, 2))
        births, persistence = intervals[:, 0], intervals[:, 1] - intervals[:, 0]
        low, high = births.min(), births.max()
        columns = np.linspace(low, high, self.resolution) if low < high else births[:1]
        return columns, np.linspace(0, persistence.max(), self.resolution)

    def _row(self, dimension: int, intervals: Floats) -> Floats:
        births, persistence = self.grids_[dimension]
        width = self.bandwidth or max((axis[1] - axis[0] for axis in (births, persistence) if len(axis) > 1), default=0) or 1.0
        at, lasts = _ended(intervals).T
        lasts = lasts - at
        along = np.exp(-((births - at[:, None]) ** 2) / (2 * width**2))
        up = np.exp(-((persistence - lasts[:, None]) ** 2) / (2 * width**2)) * (lasts**self.power)[:, None]
        image: Floats = up.T @ along / (2 * np.pi * width**2)
        return image

    def _names(self, dimension: int) -> list[str]:
        births, persistence = self.grids_[dimension]
        return [f"persistence{i}_birth{j}" for i in range(len(persistence)) for j in range(len(births))]


class PersistenceLandscape(_OfDiagrams):
    """Persistence landscapes: at each α the largest, second largest, … of min(α − birth, death − α).

    Parameters
    ----------
    n_layers : int
        How many.
    resolution : int
        Places from the least birth to the largest death that ``fit`` sees.

    Notes
    -----
    An interval that never ends grows without end. GUDHI's ``Landscape`` has √2 times these numbers.

    References
    ----------
    P. Bubenik, Statistical topological data analysis using persistence landscapes, Journal of Machine Learning Research 16 (2015),
    http://jmlr.org/papers/v16/bubenik15a.html.

    Examples
    --------
    >>> from walpha.tda import PersistenceLandscape
    >>> PersistenceLandscape(n_layers=2, resolution=5).fit_transform([[[0, 4, 1], [2, 4, 1]]])
    array([[0., 1., 2., 1., 0., 0., 0., 0., 1., 0.]])
    """

    def __init__(self, n_layers: int = 5, *, resolution: int = 100) -> None:
        self.n_layers = n_layers
        self.resolution = resolution

    def _grid(self, intervals: Floats) -> Floats:
        return _places(intervals, self.resolution)

    def _row(self, dimension: int, intervals: Floats) -> Floats:
        grid = self.grids_[dimension]
        births, deaths = intervals.T[:, :, None]
        tents = np.maximum(np.minimum(grid - births, deaths - grid), 0)
        layers = np.zeros((self.n_layers, len(grid)))
        largest = -np.sort(-tents, axis=0)[: self.n_layers]
        layers[: len(largest)] = largest
        return layers

    def _names(self, dimension: int) -> list[str]:
        return [f"layer{layer}_{place}" for layer in range(self.n_layers) for place in range(len(self.grids_[dimension]))]


class BettiCurve(_OfDiagrams):
    """Betti curves: how many intervals there are at each α.

    Parameters
    ----------
    resolution : int
        Places from the least birth to the largest death that ``fit`` sees. An interval is there from its birth on, until before its death.

    Notes
    -----
    Of one cloud, :meth:`walpha.Filtration.betti_curve` has the numbers at every critical value.

    Examples
    --------
    >>> from walpha.tda import BettiCurve
    >>> BettiCurve(resolution=5).fit_transform([[[0, 4, 1], [2, 4, 1]]])
    array([[1., 1., 2., 2., 0.]])
    """

    def __init__(self, *, resolution: int = 100) -> None:
        self.resolution = resolution

    def _grid(self, intervals: Floats) -> Floats:
        return _places(intervals, self.resolution)

    def _row(self, dimension: int, intervals: Floats) -> Floats:
        grid = self.grids_[dimension]
        born, died = (np.searchsorted(np.sort(ends), grid, side="right") for ends in intervals.T)
        counts: Floats = (born - died).astype(np.float64)
        return counts

    def _names(self, dimension: int) -> list[str]:
        return [str(place) for place in range(len(self.grids_[dimension]))]


def _weighed(clouds: Iterable[Arrays]) -> tuple[list[Floats], list[Floats]]:
    """Clouds without their last columns, and these."""
    places, weights = [], []
    for number, given in enumerate(clouds):
        if _tables.names(given) is not None:
            of_table = _arrays.cloud(given, valued=False)
            if of_table.weights is None:
                raise ValueError(f"cloud {number} has no column weight or radius")
            places.append(of_table.points)
            weights.append(of_table.weights)
            continue
        rows: NDArray[Any] = np.asarray(given)
        if rows.ndim == 2 and isinstance(given, np.ma.MaskedArray):
            # As in other clouds, masked rows are not points.
            rows = rows[~np.ma.getmaskarray(given).any(axis=1)]
        if rows.ndim != 2 or rows.shape[1] not in (3, 4):
            raise ValueError(f"cloud {number} has shape {rows.shape}, expected (n, 4) or (n, 3): x, y, z or x, y, and the weight of each")
        places.append(rows[:, :-1])
        weights.append(rows[:, -1])
    return places, weights


def _diagrams(X: Arrays) -> Floats:
    diagrams = _arrays.numbers("X", X)
    if diagrams.ndim != 3 or diagrams.shape[2] != 3:
        raise ValueError(f"X has shape {diagrams.shape}, expected (n_samples, n_intervals, 3): diagrams, as AlphaPersistence makes them")
    diagrams = _arrays.doubles("X", diagrams)
    is_whole = diagrams[:, :, 2] == np.floor(diagrams[:, :, 2])
    wrong = np.argwhere(~((diagrams[:, :, 0] <= diagrams[:, :, 1]) & np.isfinite(diagrams[:, :, [0, 2]]).all(axis=2) & is_whole))
    if len(wrong):
        sample, row = wrong[0]
        raise ValueError(f"X: row {row} of sample {sample}, {diagrams[sample, row].tolist()}, is not a birth, a later death and a dimension")
    return diagrams


def _lasting(diagram: Floats, dimension: int) -> Floats:
    """Births and deaths of a dimension, without rows that fill."""
    here = (diagram[:, 2] == dimension) & (diagram[:, 0] < diagram[:, 1])
    return diagram[here, :2]


def _ended(intervals: Floats) -> Floats:
    return intervals[np.isfinite(intervals[:, 1])]


def _places(intervals: Floats, count: int) -> Floats:
    """From the least birth to the largest death that is finite."""
    ends = intervals[np.isfinite(intervals)]
    return np.linspace(ends.min(), ends.max(), count)


def _tags(tags: Any, *, requires_fit: bool) -> Any:
    """Samples are clouds or diagrams, and not rows."""
    tags.input_tags.two_d_array = False
    tags.input_tags.three_d_array = True
    tags.requires_fit = requires_fit
    return tags
