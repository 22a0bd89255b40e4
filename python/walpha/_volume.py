from __future__ import annotations

import json
import os
from typing import NamedTuple

import numpy as np

from . import _arrays, _walpha
from ._shape import AlphaShape, squared

# The share of all voxels that the paper selects.
_RATIO = 0.0609
_UNKNOWN = {"space": "unknown", "unit": "unit"}
_ALONG = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


class Volume(NamedTuple):
    """A grid of samples as a file has it.

    Attributes
    ----------
    samples : ndarray of float32, (nz, ny, nx)
        ``[z, y, x]``.
    spacing : tuple of float
        Distances between samples along z, y and x.
    origin : tuple of float
        The place (x, y, z) of the first sample.
    direction : tuple of tuple of float
        ``direction[r][c]`` is component r (x, y, z) of the unit vector of the grid's axis c (x, y, z).
    space : str
        "LPS" where the file says in which space it is (RAS is converted), else "unknown".
    unit : str
        Of lengths: "mm", say; "voxel" where coordinates are indices, "unit" where nobody says.
    gray : bool
        Whether samples are gray levels 0 to 255 already: those of unsigned bytes.
    """

    samples: np.ndarray
    spacing: tuple
    origin: tuple
    direction: tuple
    space: str
    unit: str
    gray: bool

    def __array__(self, dtype=None, copy=None):
        return np.array(self.samples, dtype, copy=True if copy else None)


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

    points: np.ndarray
    values: np.ndarray
    differences: np.ndarray


def read(path, *, progress=None):
    """Read a volume.

    Parameters
    ----------
    path : str or path-like
        NRRD, NIfTI, MetaImage, VTK, VTI, TIFF, NPY, NPZ, INRIMAGE, a folder of slices; or
        ``"sample:ct"``, ``"sample:skull"``, ``"sample:phantom"``, ``"sample:phantom@N"``.
    progress : callable, optional
        ``progress(stage, done, total)``.

    Returns
    -------
    Volume

    Raises
    ------
    OSError
        The system refuses.
    ValueError
        The file is not what it says.
    """
    samples, gray, frame = _walpha.read(os.fspath(path), progress)
    frame = json.loads(frame)
    return Volume(
        samples,
        tuple(reversed(frame["spacing"])),
        tuple(frame["origin"]),
        tuple(map(tuple, frame["direction"])),
        frame["coordinates"]["space"],
        frame["coordinates"]["unit"],
        gray,
    )


def haar(
    volume, *, rms=None, epsilon=None, coefficients=None, decomposition="nonstandard", progress=None
):
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
    progress : callable, optional
        ``progress(stage, done, total)``.

    Returns
    -------
    smoothed : ndarray of float32, (nz, ny, nx)
    truncation : dict
        kept, total, epsilon and rms reached, and what was asked.

    References
    ----------
    E. J. Stollnitz, T. D. DeRose and D. H. Salesin, Wavelets for computer graphics: a primer,
    IEEE Computer Graphics and Applications 15 (1995), doi:10.1109/38.376616.
    """
    tolerance = _tolerance(rms, epsilon, coefficients)
    samples, facts = _walpha.haar(_grid(volume)[0], tolerance, decomposition, progress)
    return samples, json.loads(facts)


def difference(volume):
    """The difference L of each voxel.

    A sixth of the sum of the absolute differences to its six neighbours; a missing neighbour adds 0.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Taken as float32.

    Returns
    -------
    ndarray of float64, (nz, ny, nx)
    """
    return _walpha.difference(_grid(volume)[0])


def select(
    volume,
    smoothed=None,
    *,
    count=None,
    ratio=None,
    threshold=None,
    gray_min=None,
    spacing=None,
    origin=None,
):
    """Select the voxels of the largest differences as points.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        Gives the values of the points.
    smoothed : array_like, (nz, ny, nx), optional
        The truncated volume, which differences and ``gray_min`` are judged on; by default the same.
    count, ratio, threshold : int, float, float; optional
        One of: so many voxels; this share of all (0.0609 by default, that of the paper, or all that take
        part where these are fewer); all of at least this L.
    gray_min : float, optional
        Voxels of the smoothed volume below this take no part.
    spacing : tuple of float, optional
        Distances between samples along z, y and x. Without, coordinates are indices.
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.

    Returns
    -------
    Selected
    """
    samples, _, frame = _grid(volume, spacing, origin)
    smoothed = samples if smoothed is None else _grid(smoothed)[0]
    rule = _rule(count, ratio, threshold)
    return Selected(*_walpha.select(samples, smoothed, frame, rule, gray_min))


def weigh(differences, weighting="min-max", *, alpha):
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
    """
    return _walpha.weigh(_arrays.floats("differences", differences, 1), weighting, float(alpha))


def pipeline(
    volume,
    *,
    spacing=None,
    origin=None,
    gray=None,
    rms=None,
    epsilon=None,
    coefficients=None,
    decomposition="nonstandard",
    count=None,
    ratio=None,
    threshold=None,
    gray_min=None,
    select="difference",
    target_rmse=None,
    max_error=None,
    exchange=False,
    weighting="common=0",
    alpha=None,
    alpha_radius=None,
    engine="auto",
    balls="power",
    exterior=False,
    hidden=False,
    refit=None,
    progress=None,
):
    """From a volume to its alpha shape: truncation, selection, weights, shape.

    Parameters
    ----------
    volume : array_like or Volume, (nz, ny, nx)
        ``[z, y, x]``, as scikit-image has it. Unsigned bytes are gray levels; anything else is
        mapped to gray levels 0 to 255 from its minimum to its maximum, or from ``gray``.
    spacing : tuple of float, optional
        Distances between samples along z, y and x. Without, and for a :class:`Volume` without a
        unit, coordinates are indices (voxels).
    origin : tuple of float, optional
        The place (x, y, z) of the first sample.
    gray : tuple of float, optional
        The values that become gray 0 and 255.
    rms, epsilon, coefficients, decomposition
        As in :func:`haar`, in gray levels.
    count, ratio, threshold, gray_min
        As in :func:`select`, in gray levels.
    select : {"difference", "adaptive"}
        Which voxels become points: those of the largest differences, or those where the interpolant
        of the ones before is worst, on the whole triangulation, after Garland and Heckbert
        (CMU-CS-95-181, 1995), with ``count`` or ``ratio``, the corners of the volume among them. The
        parameters below are for these.
    target_rmse : float, optional
        End as soon as the root mean square of the error is so small, in gray levels.
    max_error : float, optional
        Choose by the largest error until no sample is off by more, in gray levels. Not with ``exchange``.
    exchange : bool
        Then exchange points whose loss costs little for voxels that lower the error of fitted values;
        for use with ``refit``.
    weighting : str
        As in :func:`weigh`.
    alpha : float, "auto" or "auto:connected", optional
        A squared length; by default 10 h², h³ being the volume of a voxel. The rules are
        those of
        :func:`alpha_shape`.
    alpha_radius, engine, balls, exterior, hidden, progress
        As in :func:`alpha_shape`.
    refit : {"whole", "shape"}, optional
        Fit the values of the points to the volume by least squares: to all its samples, interpolated on
        the whole triangulation of the points and the corners of the volume, or to those that the shape
        covers.

    Returns
    -------
    AlphaShape
        Its points are (x, y, z), their values those of the volume, or fitted.

    Examples
    --------
    >>> shape = walpha.pipeline(walpha.read("sample:phantom@32"), weighting="min-max")
    >>> shape.betti.b0
    1
    """
    samples, is_gray, frame = _grid(volume, spacing, origin)
    tolerance = _tolerance(rms, epsilon, coefficients)
    rule = _rule(count, ratio, threshold)
    adaptive = _adaptive(samples.size, select, count, ratio, target_rmse, max_error, exchange)
    if adaptive is not None and (threshold is not None or gray_min is not None):
        raise ValueError("threshold and gray_min choose by gray levels, which select='adaptive' does not: give a count")
    shape = _walpha.pipeline(
        samples,
        is_gray,
        None if gray is None else tuple(map(float, gray)),
        frame,
        (tolerance, decomposition),
        rule,
        gray_min,
        adaptive,
        weighting,
        squared(alpha, alpha_radius),
        (engine, balls, exterior, hidden),
        refit,
        progress,
    )
    return AlphaShape(shape)


def _adaptive(samples, select, count, ratio, target_rmse, max_error, exchange):
    """How many voxels at most, the errors that are good enough, and whether points are exchanged."""
    if select == "difference":
        if target_rmse is not None or max_error is not None or exchange:
            raise ValueError("target_rmse, max_error and exchange belong to select='adaptive'")
        return None
    if select != "adaptive":
        raise ValueError(f"select={select!r} is unknown: 'difference' and 'adaptive' are known")
    if exchange and max_error is not None:
        raise ValueError("exchange=True may raise the largest error: leave max_error out")
    if count is None and ratio is None and (target_rmse is not None or max_error is not None):
        count = samples
    elif count is None:
        count = round((_RATIO if ratio is None else ratio) * samples)
    optional = None if max_error is None else float(max_error)
    return int(count), float(target_rmse or 0), optional, bool(exchange)


def _grid(volume, spacing=None, origin=None):
    """Samples, whether they are gray levels, and the frame as the library reads it."""
    if isinstance(volume, Volume):
        if spacing is not None or origin is not None:
            raise ValueError("this volume knows its spacing and origin: give volume.samples to say others")
        return volume.samples, volume.gray, _frame_of(volume)
    samples, gray = _arrays.samples(volume)
    if spacing is None:
        if origin is not None:
            raise ValueError("origin is in units of length: give spacing, too")
        return samples, gray, None
    origin = [0.0, 0.0, 0.0] if origin is None else origin
    return samples, gray, _frame(reversed(tuple(spacing)), origin, _ALONG, _UNKNOWN)


def _frame_of(volume):
    if volume.unit == "voxel":
        return None
    coordinates = {"space": volume.space, "unit": volume.unit}
    return _frame(reversed(volume.spacing), volume.origin, volume.direction, coordinates)


def _frame(spacing, origin, direction, coordinates):
    spacing, origin = [float(x) for x in spacing], [float(x) for x in origin]
    if len(spacing) != 3 or len(origin) != 3 or not np.isfinite(spacing + origin).all():
        raise ValueError("spacing are three lengths (z, y, x), and origin is a place (x, y, z)")
    frame = {"origin": origin, "spacing": spacing, "direction": direction, "coordinates": coordinates}
    return json.dumps(frame)


def _tolerance(rms, epsilon, coefficients):
    given = {"rms": rms, "epsilon": epsilon, "coefficients": coefficients}
    return _one_of(given, ("rms", 1.0))


def _rule(count, ratio, threshold):
    return _one_of({"count": count, "ratio": ratio, "threshold": threshold}, ("at_most", _RATIO))


def _one_of(options, default):
    given = [(name, float(value)) for name, value in options.items() if value is not None]
    if len(given) > 1:
        raise ValueError(f"{' and '.join(name for name, _ in given)} contradict each other: give one")
    return given[0] if given else default
