from __future__ import annotations

import dataclasses
import json
import math
import operator
import os
import sys
from typing import Any, cast

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _arrays, _pictures, _walpha
from ._pictures import Picture
from ._typing import Floats, Place, Progress, Samples
from ._work import task

_ALONG = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Volume:
    """A grid of samples, and where it lies.

    What has the form of an array, ``samples`` and its shape, is ``[z, y, x]``, as numpy and scikit-image have it.
    What is a place, a length or a direction is (x, y, z), as of points.

    Parameters
    ----------
    samples : array_like, (nz, ny, nx)
        Kept as float32, in whatever unit the values have. Masked ones are NaN, and :func:`pipeline` makes no points of them.
    spacing : tuple of float
        Distances between samples along x, y and z.
    origin : tuple of float
        The place (x, y, z) of the first sample.
    direction : tuple of tuple of float
        ``direction[r][c]`` is component r (x, y, z) of the unit vector of the grid's axis c (x, y, z).
    space : {"LPS", "RAS", "unknown"}
        Where x, y and z point to, of a patient.
    unit : str
        Of lengths: "mm", say; "unit" if unknown; "voxel" where coordinates are indices.
    gray : bool, optional
        Whether samples are gray levels 0 to 255 already; by default those of unsigned bytes are.
    masked : bool
        Whether NaN among the samples are not data, as padding of DICOM and masked samples of an array are: they become no
        points, and are not an error.

    Raises
    ------
    ValueError
        Samples that are not an array of three axes; spacing that is not above 0.

    Examples
    --------
    >>> volume = walpha.Volume(np.zeros((4, 3, 2)), spacing=(0.5, 0.5, 2), unit="mm")
    >>> volume
    <walpha.Volume of 4×3×2 samples [z, y, x], spacing (0.5, 0.5, 2.0) mm>
    >>> volume.affine @ [1, 2, 3, 1]
    array([0.5, 1. , 6. , 1. ])
    """

    samples: Samples
    spacing: Place = (1.0, 1.0, 1.0)
    origin: Place = (0.0, 0.0, 0.0)
    direction: tuple[Place, Place, Place] = _ALONG
    space: str = "unknown"
    unit: str = "unit"
    gray: bool | None = None
    masked: bool = False

    def __post_init__(self) -> None:
        samples, gray, masked = _arrays.samples(self.samples)
        axes = np.asarray(self.direction, float)
        if axes.shape != (3, 3) or not np.isfinite(axes).all():
            raise ValueError(f"direction has shape {axes.shape}: give three rows of three numbers")
        spacing = _arrays.place("spacing", self.spacing)
        if min(spacing) <= 0:
            raise ValueError(f"spacing={self.spacing} must be three lengths above 0, along x, y and z")
        own = {
            "samples": samples,
            "spacing": tuple(spacing),
            "origin": tuple(_arrays.place("origin", self.origin)),
            "direction": tuple(map(tuple, axes.tolist())),
            "gray": gray if self.gray is None else self.gray,
            "masked": self.masked or masked,
        }
        for name, value in own.items():
            object.__setattr__(self, name, value)

    @property
    def affine(self) -> Floats:
        """ndarray of float64, (4, 4): from the index (x, y, z, 1) of a sample to its place.

        As nibabel has it, for arrays ``samples.T`` that are indexed [x, y, z], but in :attr:`space`: places in LPS are
        those in RAS+ with x and y negated, ``np.diag([-1, -1, 1, 1]) @ volume.affine``.
        """
        affine = np.eye(4)
        affine[:3, :3] = np.array(self.direction) * self.spacing
        affine[:3, 3] = self.origin
        return affine

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        # NumPy 1 does not know a copy of None, which is one where it is needed.
        return np.asarray(self.samples, dtype) if copy is None else np.array(self.samples, dtype, copy=copy)

    def __repr__(self) -> str:
        sizes = "×".join(map(str, self.samples.shape))
        return f"<walpha.Volume of {sizes} samples [z, y, x], spacing {self.spacing} {self.unit}>"

    def plot(self, *, low: float | None = None, high: float | None = None) -> Picture:
        """The slices through the middle, across z, y and x, which a notebook shows.

        Parameters
        ----------
        low, high : float, optional
            The values that are black and white; by default those which 1 % of the samples are below and above.

        Returns
        -------
        Picture
            With z upwards, and as wide as the volume is in its unit. Samples that are NaN are black.

        Raises
        ------
        ValueError
            ``low`` is not below ``high``.

        Examples
        --------
        >>> walpha.Volume(np.random.default_rng(1).random((40, 30, 20))).plot()
        <walpha.Picture of 436×240 pixels>
        """
        finite = self.samples[np.isfinite(self.samples)]
        ends = np.percentile(finite, (1, 99)) if finite.size else np.array([0.0, 1.0])
        first, last = (float(ends[0]) if low is None else low), (float(ends[1]) if high is None else high)
        if not first < last:
            if low is not None or high is not None:
                raise ValueError(f"low={first:g} is not below high={last:g}")
            last = first + 1
        nz, ny, nx = self.samples.shape
        sx, sy, sz = self.spacing
        slices = [
            (self.samples[nz // 2], sy, sx),
            (self.samples[::-1, ny // 2], sz, sx),
            (self.samples[::-1, :, nx // 2], sz, sy),
        ]
        longest = max(max(plane.shape[0] * up, plane.shape[1] * across) for plane, up, across in slices)
        pixel = longest / _SIDE
        tiles = [_resampled(plane, up, across, pixel) for plane, up, across in slices]
        tall = max(tile.shape[0] for tile in tiles)
        # What is no part of the volume is black.
        rows = [np.pad(tile, ((0, tall - tile.shape[0]), (0, 0)), constant_values=first) for tile in tiles]
        gap = np.full((tall, 8), first, np.float32)
        image = np.concatenate([rows[0], gap, rows[1], gap, rows[2]], axis=1)
        levels = np.nan_to_num((image - first) / (last - first), nan=0.0, posinf=1.0, neginf=0.0)
        return Picture(_pictures.gray_png((255 * levels.clip(0, 1)).round().astype(np.uint8)))

    def _repr_html_(self) -> str:
        nz, ny, nx = self.samples.shape
        finite = self.samples[np.isfinite(self.samples)]
        values = "none that is a number"
        if finite.size:
            values = f"{_pictures.brief(float(finite.min()))} to {_pictures.brief(float(finite.max()))}"
        place = " × ".join(_pictures.brief(step) for step in self.spacing)
        rows = [
            ("samples", f"{nx} × {ny} × {nz} (x, y, z)"),
            ("spacing", f"{place} {self.unit}"),
            ("origin", ", ".join(map(_pictures.brief, self.origin))),
            ("space", self.space),
            ("values", values),
        ]
        picture = _pictures.image(bytes(self.plot()), repr(self), 480)
        return _pictures.summary("walpha.Volume", rows, picture)

    def _frame(self) -> str | None:
        """Where it lies, as the library reads it; None where coordinates are indices."""
        if self.unit == "voxel":
            return None
        return json.dumps({
            "origin": self.origin,
            "spacing": self.spacing,
            "direction": self.direction,
            "coordinates": {"space": self.space, "unit": self.unit},
        })  # fmt: skip


def read(
    path: str | os.PathLike[str],
    *,
    roi: tuple[slice, slice, slice] | None = None,
    downsample: int | None = None,
    nan: float | None = None,
    format: str | None = None,
    level: int | None = None,
    array: str | None = None,
    frame: int | None = None,
    series: int | str | None = None,
    skip_damaged: bool = False,
    resample: bool = True,
    shape: tuple[int, int, int] | None = None,
    dtype: DTypeLike | None = None,
    offset: int = 0,
    progress: Progress = None,
    threads: int | None = None,
) -> Volume:
    """Read a volume.

    Parameters
    ----------
    path : str or path-like
        NRRD, NIfTI, MetaImage, VTK, VTI, TIFF, NPY, NPZ, INRIMAGE, OME-Zarr, DICOM, a folder of slices; or
        ``"sample:ct"``, ``"sample:skull"``, ``"sample:phantom"``, ``"sample:phantom@N"``.
    roi : tuple of slice, optional
        The part to read, as one indexes the samples [z, y, x]: ``np.s_[10:, :, 20:40]``. Its place stays.
    downsample : int, optional
        Average blocks of so many samples along each axis, after ``roi``.
    nan : float, optional
        What replaces samples that are NaN or infinite, an error otherwise. NaN leaves them NaN, for ``nan=`` of
        :func:`pipeline`. Padding (DICOM) is replaced, too; otherwise it is NaN, and the volume ``masked``.
    format : str, optional
        The extension of the file's format, where neither its content nor its name shows it.
    level : int, optional
        Of a pyramid (OME-Zarr); 0 is the finest.
    array : str, optional
        Which array of a file with several (VTK, NPZ).
    frame : int, optional
        Which volume of a file with several (a fourth axis; times, echoes or stacks of DICOM), from 0.
    series : int or str, optional
        Which series of a folder with several (DICOM): its number, from 1, or the end of its UID.
    skip_damaged : bool
        Go on without damaged slices (DICOM).
    resample : bool
        Resample slices at several distances (DICOM) linearly to the finest; otherwise they are an error.
    shape, dtype, offset : tuple of int, dtype, int; optional
        Of a file of bare samples, as ``numpy.memmap`` takes them: samples along z, y and x; their type, with its byte
        order; and the bytes before the first.
    progress, threads
        As in :func:`alpha_shape`.

    Returns
    -------
    Volume
        In LPS where the file says in which space it is.

    Raises
    ------
    OSError
        The system refuses.
    ValueError
        The file is not what it says; options that the file has no use for.

    Examples
    --------
    >>> walpha.read("sample:phantom@32", roi=np.s_[8:24, :, :])
    <walpha.Volume of 16×32×32 samples [z, y, x], spacing (1.0, 1.0, 1.0) voxel>

    >>> np.arange(24, dtype="<u2").tofile("bare.raw")
    >>> float(walpha.read("bare.raw", shape=(2, 3, 4), dtype="<u2").samples[1, 2, 3])
    23.0
    """
    options = {
        "raw": _raw(shape, dtype, offset),
        "format": None if format is None else format.lower().removeprefix("."),
        "level": level,
        "array": array,
        "frame": frame,
        "series": None if series is None else str(series),
        "skip_damaged": bool(skip_damaged),
        "no_resample": not resample,
        "nan": None if nan is None else "mask" if math.isnan(nan) else {"value": float(nan)},
        "region": None if roi is None else _region(roi),
        "downsample": _block(downsample),
    }
    with task(progress, threads) as how:
        samples, gray, frame_of = _walpha.read(os.fspath(path), json.dumps(options), how)
    placed = json.loads(frame_of)
    coordinates = placed.pop("coordinates")
    masked = nan is None and bool(np.isnan(samples).any())
    return Volume(samples, **placed, **coordinates, gray=gray, masked=masked)


def _raw(shape: Any, dtype: DTypeLike | None, offset: int) -> dict[str, Any] | None:
    """The layout of bare samples."""
    if shape is None or dtype is None:
        if shape is not None or dtype is not None or offset:
            raise ValueError("a file of bare samples needs shape= and dtype=, and only such a file has an offset=")
        return None
    nz, ny, nx = map(operator.index, shape)
    of = np.dtype(dtype)
    if of.kind not in "iuf" or of == np.float16 or of.itemsize > 8:
        raise ValueError(f"dtype={of} is not a type of samples: give integers of 8 to 64 bits, float32 or float64")
    order = sys.byteorder if of.byteorder in "=|" else "big" if of.byteorder == ">" else "little"
    return {
        "dims": {"x": nx, "y": ny, "z": nz},
        "dtype": f"{of.kind}{8 * of.itemsize}",
        "endian": order,
        "offset": operator.index(offset),
    }


def _region(roi: Any) -> dict[str, Any]:
    """From slices along z, y and x to ends along x, y and z."""
    if len(roi) != 3 or not all(isinstance(part, slice) for part in roi):
        raise ValueError(f"roi={roi!r}: give three slices along z, y and x, as in np.s_[10:, :, 20:40]")
    if any(part.step not in (None, 1) for part in roi):
        raise ValueError(f"roi={roi!r} has steps: leave them out, and see downsample=")
    first = [0 if part.start is None else operator.index(part.start) for part in reversed(roi)]
    end = [None if part.stop is None else operator.index(part.stop) for part in reversed(roi)]
    if any(number < 0 for number in [*first, *(n for n in end if n is not None)]):
        raise ValueError(f"roi={roi!r} counts from the end: give indices from 0 up")
    return {"first": first, "end": end}


def _block(downsample: int | None) -> int | None:
    if downsample is not None and operator.index(downsample) < 1:
        raise ValueError(f"downsample={downsample}: give a number of samples from 1 up")
    return downsample


#: Pixels along the longest side of a slice.
_SIDE = 240


def _resampled(plane: Samples, up: float, across: float, pixel: float) -> Samples:
    """The nearest samples of a slice, with distances ``up`` and ``across``, at each pixel of this size."""
    sides = [max(1, round(count * step / pixel)) for count, step in zip(plane.shape, (up, across))]
    rows, columns = ((np.arange(side) * count // side) for side, count in zip(sides, plane.shape))
    return cast(Samples, plane[rows][:, columns])
