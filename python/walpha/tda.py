"""Persistence diagrams of many point clouds, as a transformer of scikit-learn.

scikit-learn is not needed: :class:`AlphaPersistence` has the methods that its pipelines and grid searches call.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal, cast

import numpy as np

from ._filtration import filtration
from ._typing import Arrays, Floats

__all__ = ["AlphaPersistence"]


class AlphaPersistence:
    """Diagrams of the alpha filtrations of point clouds, in the layout of giotto-tda.

    Parameters
    ----------
    homology_dimensions : tuple of int
        Of 0 (components), 1 (loops) and 2 (voids).
    radius : bool
        Births and deaths are radii √α, as those of a Čech filtration, and not α itself, squared lengths.
    reduced_homology : bool
        Leave out the component that never ends. With False its death is inf.
    threads : int, optional
        As in :func:`walpha.alpha_shape`.

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
        threads: int | None = None,
    ) -> None:
        # As scikit-learn wants it: as given, and checked by fit.
        self.homology_dimensions = homology_dimensions
        self.radius = radius
        self.reduced_homology = reduced_homology
        self.threads = threads

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters by name.

        Parameters
        ----------
        deep : bool
            Without effect: no parameter has parameters.

        Returns
        -------
        dict
        """
        return dict(vars(self))

    def set_params(self, **parameters: Any) -> AlphaPersistence:
        """Change parameters.

        Parameters
        ----------
        **parameters
            By name.

        Returns
        -------
        AlphaPersistence
            Itself.
        """
        for name, value in parameters.items():
            if name not in vars(self):
                raise ValueError(f"{name} is not a parameter: there are {', '.join(vars(self))}")
            setattr(self, name, value)
        return self

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
        wrong = [dimension for dimension in self.homology_dimensions if dimension not in (0, 1, 2)]
        if wrong:
            raise ValueError(
                f"homology_dimensions={self.homology_dimensions}: there are 0, 1 and 2"
            )
        return self

    def transform(self, X: Iterable[Arrays], y: object = None) -> Floats:
        """The diagram of each point cloud.

        Parameters
        ----------
        X : iterable of array_like, each (n, 3) or (n, 2)
            Point clouds, of as many points as they like; or an array (n_samples, n, 3).
        y
            Not looked at.

        Returns
        -------
        ndarray of float64, (n_samples, n_features, 3)
            Birth, death and dimension, by dimension. Diagrams with fewer features than the largest are filled with
            such as are born and die at 0: [0, 0, dimension].

        Raises
        ------
        ValueError
            Dimensions other than 0, 1 and 2; what :func:`walpha.filtration` raises.
        """
        self.fit(X)
        diagrams = [self._diagram(points) for points in X]
        blocks = []
        for dimension, of_one in zip(self.homology_dimensions, zip(*diagrams)):
            block = np.zeros((len(of_one), max(map(len, of_one)), 3))
            block[:, :, 2] = dimension
            for rows, intervals in zip(block, of_one):
                rows[: len(intervals), :2] = intervals
            blocks.append(block)
        return np.concatenate(blocks, axis=1) if blocks else np.zeros((len(diagrams), 0, 3))

    def fit_transform(self, X: Iterable[Arrays], y: object = None) -> Floats:
        """The same as :meth:`transform`.

        Parameters
        ----------
        X, y
            As there.

        Returns
        -------
        ndarray of float64, (n_samples, n_features, 3)
        """
        return self.transform(X)

    def _diagram(self, points: Arrays) -> list[Floats]:
        """Births and deaths by dimension."""
        simplices = filtration(points, threads=self.threads).simplices(threads=self.threads)
        diagram = []
        for dimension in self.homology_dimensions:
            intervals = simplices.persistence(cast(Literal[0, 1, 2], dimension))
            if dimension == 0 and self.reduced_homology:
                intervals = intervals[np.isfinite(intervals[:, 1])]
            diagram.append(np.sqrt(intervals) if self.radius else intervals)
        return diagram

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in vars(self).items())
        return f"AlphaPersistence({given})"
