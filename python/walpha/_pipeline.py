from __future__ import annotations

import functools
import json
import operator
import warnings
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from . import _alpha, _arrays, _settings, _walpha
from ._shape import AlphaShape
from ._repr import in_a_line
from ._typing import Arrays, Balls, Engine, Floats, Place, Progress, Rule, Samples
from ._volume import Volume
from ._work import task

# Decompositions by the names that the library has for them.
_DECOMPOSITIONS = {"nonstandard": "non-standard", "standard": "standard"}

Decomposition: TypeAlias = Literal["nonstandard", "standard"]


@in_a_line
class Selected(NamedTuple):
    """Points of a volume.

    Attributes
    ----------
    points : ndarray of float64, (n, 3)
        x, y, z, in the order of their voxels.
    values : ndarray of float64, (n,)
        The samples there.
    differences : ndarray of float64, (n,)
        L, of which weights are made.
    """

    points: Floats
    values: Floats
    differences: Floats


def haar(
    volume: Arrays | Volume,
    *,
    rms: float | None = None,
    epsilon: float | None = None,
    coefficients: int | None = None,
    decomposition: Decomposition = "nonstandard",
    progress: Progress = None,
    threads: int | None = None,
) -> tuple[Samples, dict[str, Any]]:
    """Drop small coefficients of the orthonormal Haar basis.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Taken as float32, in whatever unit its values have.
    rms, epsilon, coefficients : float, float, int; optional
        One of: the root mean square of the error, in the volume's values (1 by default); its L²
        norm; how many coefficients stay.
    decomposition : {"nonstandard", "standard"}
        All axes at each level, or each axis fully.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    smoothed : ndarray of float32, (nz, ny, nx)
    truncation : dict
        kept, total, epsilon and rms reached, and what was asked.

    References
    ----------
    E. J. Stollnitz, T. D. DeRose and D. H. Salesin, Wavelets for computer graphics: a primer,
    IEEE Computer Graphics and Applications 15 (1995), doi:10.1109/38.376616.

    Examples
    --------
    >>> smoothed, truncation = walpha.haar(walpha.read("sample:phantom@32"), coefficients=100)
    >>> truncation["kept"], truncation["total"]
    (100, 32768)
    """
    settings = _settings.written(
        haar=_decomposition(decomposition),
        **_settings.one_of(rms=rms, epsilon=epsilon, coefficients=coefficients),
    )
    with task(progress, threads) as how:
        samples, facts = _walpha.haar(_grid(volume)[0], _masked(volume), settings, how)
    return samples, json.loads(facts)


def difference(volume: Arrays | Volume) -> Floats:
    """The difference L of each voxel.

    A sixth of the sum of the absolute differences to its six neighbours; a missing neighbour adds 0.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Taken as float32.

    Returns
    -------
    ndarray of float64, (nz, ny, nx)

    Examples
    --------
    >>> walpha.difference(np.arange(3.0).reshape(1, 1, 3))
    array([[[0.16666667, 0.33333333, 0.16666667]]])
    """
    return _walpha.difference(_grid(volume)[0], _masked(volume))


def select(
    volume: Arrays | Volume,
    smoothed: Arrays | Volume | None = None,
    *,
    count: int | None = None,
    ratio: float | None = None,
    threshold: float | None = None,
    gray_min: float | None = None,
    spacing: Place | None = None,
    origin: Place | None = None,
) -> Selected:
    """Select the voxels of the largest differences as points.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Gives the values of the points.
    smoothed : array_like, (nz, ny, nx), optional
        The truncated volume, which differences and ``gray_min`` are judged on; by default the same.
    count, ratio, threshold : int, float, float; optional
        One of: so many voxels; this share of all (0.0609 by default, that of the paper, or all that
        differ from a neighbour where these are fewer); all of at least this L.
    gray_min : float, optional
        Voxels of the smoothed volume below this take no part.
    spacing : tuple of float, optional
        Distances between samples along x, y and z. Without, coordinates are indices.
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.

    Returns
    -------
    Selected

    Raises
    ------
    ValueError
        Volumes of different shapes; options that contradict each other; more voxels asked for than differ
        from a neighbour, or none that does.

    Examples
    --------
    >>> volume = np.zeros((3, 5, 7))
    >>> volume[1, 2, 4] = 1
    >>> walpha.select(volume, count=1).points
    array([[4., 2., 1.]])
    """
    samples, _, frame = _grid(volume, spacing, origin)
    judged = samples if smoothed is None else _grid(smoothed)[0]
    settings = _settings.written(**_settings.one_of(count=count, ratio=ratio, threshold=threshold), gray_min=gray_min)
    return Selected(*_walpha.select(samples, _masked(volume), judged, frame, settings))


def weigh(differences: Arrays, weighting: str = "min-max", *, alpha: float) -> Floats:
    """Weights ω from differences L.

    Parameters
    ----------
    differences : array_like, (n,)
        L of each point.
    weighting : str
        "min-max": α (L − Lmin)/(Lmax − Lmin); "barycentric": α L/ΣL; "barycentric-n": n times that;
        "common=C": C for all.
    alpha : float
        The α, a squared length, that weights are in proportion to.

    Returns
    -------
    ndarray of float64, (n,)
        Squared lengths.

    Raises
    ------
    ValueError
        Another kind of weights.

    Examples
    --------
    >>> walpha.weigh([1, 2, 3], "min-max", alpha=10)
    array([ 0.,  5., 10.])
    """
    given = _arrays.column("differences", differences)
    return _walpha.weigh(given, weighting, _alpha.squared(alpha, None, ""))


def pipeline(
    volume: Arrays | Volume,
    *,
    spacing: Place | None = None,
    origin: Place | None = None,
    nan: float | None = None,
    gray: tuple[float, float] | None = None,
    rms: float | None = None,
    epsilon: float | None = None,
    coefficients: int | None = None,
    decomposition: Decomposition = "nonstandard",
    count: int | None = None,
    ratio: float | None = None,
    threshold: float | None = None,
    gray_min: float | None = None,
    value_min: float | None = None,
    select: Literal["difference", "adaptive"] = "difference",
    target_rmse: float | None = None,
    max_error: float | None = None,
    exchange: bool = False,
    weighting: str = "common=0",
    alpha: float | Rule | None = None,
    alpha_radius: float | None = None,
    engine: Engine = "auto",
    balls: Balls = "power",
    exterior: bool = False,
    hidden: bool = False,
    refit: Literal["whole", "shape"] | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> AlphaShape:
    """From a volume to its alpha shape: truncation, selection, weights, shape.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        ``[z, y, x]``, as scikit-image has it. Masked samples become no points. Unsigned bytes are gray levels; anything else is
        mapped to gray levels 0 to 255 from its minimum to its maximum, or from ``gray``. Of values that look like
        Hounsfield units (a CT) bone is selected, as `walpha shape` does, unless ``gray`` or an option of the
        selection is given.
    spacing : tuple of float, optional
        Distances between samples along x, y and z. Without, and for a :class:`Volume` without a
        unit, coordinates are indices (voxels).
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.
    nan : float, optional
        What replaces samples that are NaN or infinite, an error otherwise. NaN masks them: they become no points and
        have no error.
    gray : tuple of float, optional
        The values that become gray 0 and 255: the window.
    rms, epsilon, coefficients, decomposition
        As in :func:`haar`, in gray levels.
    count, ratio, threshold, gray_min
        As in :func:`select`, in gray levels.
    value_min : float, optional
        Instead of ``gray_min``: voxels below this value of the volume take no part.
    select : {"difference", "adaptive"}
        Which voxels become points: those of the largest differences, or those where the interpolant
        of the ones before is worst, on the whole triangulation, after Garland and Heckbert
        (CMU-CS-95-181, 1995), with ``count`` or ``ratio``, the corners of the volume among them. The
        parameters below are for these.
    target_rmse : float, optional
        End when the root mean square of the error is at most this, in gray levels.
    max_error : float, optional
        Choose by the largest error until no sample is off by more, in gray levels. Not with ``exchange``.
    exchange : bool
        Then exchange points whose loss costs little for voxels that lower the error of fitted values;
        for use with ``refit``.
    weighting : str
        As in :func:`weigh`.
    alpha : float, "auto" or "auto:connected", optional
        A squared length; by default 10 h², h³ being the volume of a voxel. The rules are those of
        :func:`alpha_shape`.
    alpha_radius, engine, balls, exterior, hidden, progress, threads
        As in :func:`alpha_shape`.
    refit : {"whole", "shape"}, optional
        Fit the values of the points to the volume by least squares: to all its samples, interpolated on
        the whole triangulation of the points and the corners of the volume, or to those that the shape
        covers.

    Returns
    -------
    AlphaShape
        Its points are (x, y, z), their values those of the volume, or fitted.

    Raises
    ------
    ValueError
        Samples that are not finite; options that contradict each other; no contrast to select points by.
    MemoryError
        The system gives no more.

    Warns
    -----
    UserWarning
        Bone is selected, as the values look like Hounsfield units.

    Examples
    --------
    >>> shape = walpha.pipeline(walpha.read("sample:phantom@32"), weighting="min-max")
    >>> shape.betti.b0
    1
    """
    samples, is_gray, frame = _grid(volume, spacing, origin)
    if gray_min is not None and value_min is not None:
        raise ValueError("gray_min and value_min are one bound in two units: give one")
    if exchange and max_error is not None:
        raise ValueError("exchange=True may raise the largest error: leave max_error out")
    settings = _settings.written(
        nan=_settings.replacement(nan, _masked(volume)),
        gray=_settings.window(gray),
        haar=_decomposition(decomposition),
        **_settings.one_of(rms=rms, epsilon=epsilon, coefficients=coefficients),
        **_settings.one_of(count=count, ratio=ratio, threshold=threshold),
        gray_min=gray_min,
        value_min=value_min,
        select=select if select != "difference" else None,
        target_rmse=target_rmse,
        max_error=max_error,
        exchange=exchange,
        weights=weighting,
        alpha=_alpha.rule(alpha, alpha_radius),
        engine=engine,
        balls=balls,
        exterior=exterior,
        hidden=hidden,
        refit=refit,
    )
    with task(progress, threads) as how:
        shape = AlphaShape._of(_walpha.pipeline(samples, is_gray, frame, settings, how))
    found = shape._facts.get("hounsfield")
    if found is not None:
        warnings.warn(
            f"the values look like Hounsfield units ({found['air']:.0%} air, {found['soft_tissue']:.0%} soft tissue), so bone is "
            "selected, as by gray=(0, 1000), gray_min=64, threshold=30, rms=4: give these, or other ones, to say what to look for",
            stacklevel=2,
        )
    return shape


def label_shape(
    volume: Arrays | Volume,
    labels: int | Sequence[int] | None = None,
    *,
    spacing: Place | None = None,
    origin: Place | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> AlphaShape:
    """The solid of labels of a segmentation, without α.

    Its cells fill the voxels that have one of the labels, and nothing else: so its volume is the number of voxels times that
    of one.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Labels, ``[z, y, x]``: whole numbers, or booleans. NaN is not a label.
    labels : int or sequence of int, optional
        The labels to take. By default all that are not 0.
    spacing : tuple of float, optional
        Distances between samples along x, y and z. Without, coordinates are indices (voxels). A voxel is the box of
        half of them around its sample.
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    AlphaShape
        Its points are corners of voxels, its values the labels there: that of most of the voxels at a corner, of equally many the
        least. ``voxels`` is their number. Parts that share an edge or a corner are one component; in ``boundary(solid=True)``
        they are apart.

    Raises
    ------
    ValueError
        Values that are not whole numbers, or beyond 2²⁴; a label that no voxel has; all voxels are 0.
    MemoryError
        The system gives no more.

    Examples
    --------
    >>> mask = np.zeros((3, 4, 5), bool)
    >>> mask[1, 1:3, 1:4] = True
    >>> solid = walpha.label_shape(mask, spacing=(0.5, 1, 2))
    >>> solid.voxels, solid.volume
    (6, 6.0)
    """
    given = volume.samples if isinstance(volume, Volume) else np.asarray(volume)
    if given.dtype.kind in "iu" and given.size and max(int(given.max()), -int(given.min())) > 1 << 24:
        # Single precision would merge them.
        raise ValueError("labels beyond 2**24 are not told apart: renumber them")
    asked = None if labels is None else [operator.index(label) for label in np.atleast_1d(labels).tolist()]
    samples, _, frame = _grid(volume, spacing, origin)
    with task(progress, threads) as how:
        shape = _walpha.label_shape(samples, frame, asked, how)
    return AlphaShape._of(shape)


def surface_shape(
    volume: Arrays | Volume,
    value: float | Literal["auto"],
    *,
    closed: bool = False,
    spacing: Place | None = None,
    origin: Place | None = None,
    nan: float | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> AlphaShape:
    """The solid inside an isosurface, without α: of the samples that are at least a value.

    Its boundary has its vertices where edges of the grid take the value, by linear interpolation, as marching cubes places them, and
    where the grid ends. The samples say which tetrahedra of a triangulation it has, so a gap one sample wide stays open.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        ``[z, y, x]``, as scikit-image has it. Masked samples are outside.
    value : float or "auto"
        The value; "auto" is the one that best divides the histogram of the samples (Otsu 1979).
    closed : bool
        Keep the largest part alone, and fill its cavities: one piece without a void.
    spacing : tuple of float, optional
        Distances between samples along x, y and z. Without, coordinates are indices (voxels).
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.
    nan : float, optional
        What replaces samples that are NaN or infinite, an error otherwise. NaN masks them.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    AlphaShape
        Its points are the vertices of its boundary and the samples inside near it; deep within it has no others. Its values are
        ``isovalue`` at the former, and those of the samples. It holds the samples of the volume, of which a pickle consists.

    Raises
    ------
    ValueError
        No sample reaches the value; fewer than two samples along an axis; samples that are not finite.
    MemoryError
        The system gives no more.

    Examples
    --------
    >>> solid = walpha.surface_shape(walpha.read("sample:ct"), 250)
    >>> solid.isovalue, solid.betti.b0 > 0
    (250.0, True)
    """
    samples, is_gray, frame = _grid(volume, spacing, origin)
    surface = _settings.surface(value, closed)
    settings = _settings.written(surface=surface, nan=_settings.replacement(nan, _masked(volume)))
    # An array of the caller's may change, and that of a Volume may be one.
    is_own = not isinstance(volume, Volume) and samples.base is None and samples is not volume
    return _inside(is_gray, frame, settings, samples if is_own else samples.copy(), progress, threads)


def _inside(
    is_gray: bool,
    frame: str | None,
    settings: list[tuple[str, str]],
    samples: Samples,
    progress: Progress = None,
    threads: int | None = None,
) -> AlphaShape:
    """The solid inside an isosurface of samples; a pickle calls this again."""
    with task(progress, threads) as how:
        shape = _walpha.pipeline(samples, is_gray, frame, settings, how)
    return AlphaShape._of(shape, (functools.partial(_inside, is_gray, frame, settings), samples))


def _decomposition(name: str) -> str:
    """The name that the library has for a decomposition."""
    if name not in _DECOMPOSITIONS:
        raise ValueError(f"decomposition={name!r} is unknown: give 'nonstandard' or 'standard'")
    return _DECOMPOSITIONS[name]


def _grid(
    volume: Arrays | Volume, spacing: Place | None = None, origin: Place | None = None
) -> tuple[Samples, bool, str | None]:
    """Samples, whether they are gray levels, and the frame as the library reads it."""
    if isinstance(volume, Volume):
        if spacing is not None or origin is not None:
            raise ValueError("this volume has its own spacing and origin: give volume.samples to say others")
        return volume.samples, bool(volume.gray), volume._frame()
    samples, gray, _ = _arrays.samples(volume)
    if spacing is None:
        if origin is not None:
            raise ValueError("origin is in units of length: give spacing, too")
        return samples, gray, None
    placed = Volume(samples, spacing, (0.0, 0.0, 0.0) if origin is None else origin)
    return samples, gray, placed._frame()


def _masked(volume: Arrays | Volume) -> bool:
    """Whether NaN among the samples are not data."""
    return volume.masked if isinstance(volume, Volume) else bool(np.ma.is_masked(volume))
