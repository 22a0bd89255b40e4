"""Formats that the wheel reads beyond numpy's, each from a file made here byte by byte."""

import json
import struct

import numpy as np
import pytest

import walpha

GRID = np.arange(24, dtype="<u2").reshape(2, 3, 4)


def test_zarr(tmp_path):
    folder = tmp_path / "grid.zarr"
    (folder / "c/0/0").mkdir(parents=True)
    (folder / "zarr.json").write_text(json.dumps({
        "zarr_format": 3,
        "node_type": "array",
        "shape": [2, 3, 4],
        "data_type": "uint16",
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2, 3, 4]}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": 0,
        "codecs": [{"name": "bytes", "configuration": {"endian": "little"}}],
    }))
    (folder / "c/0/0/0").write_bytes(GRID.tobytes())
    assert np.array_equal(walpha.read(folder).samples, GRID)


def element(group, number, kind, value):
    """A data element of DICOM, explicit VR, little-endian."""
    if isinstance(value, str):
        value = value.encode() + (b"\0" if kind == "UI" else b" ") * (len(value) % 2)
    long = kind in ("OB", "OW")
    length = struct.pack("<HI", 0, len(value)) if long else struct.pack("<H", len(value))
    return struct.pack("<HH", group, number) + kind.encode() + length + value


def dicom(path, z, series, samples, more=b"", number=None):
    """A slice of a CT with an Instance Number, by default that of its place, and more elements behind its Pixel Representation."""
    number = z + 1 if number is None else number
    short = lambda number: struct.pack("<H", number)  # noqa: E731
    ct, instance = "1.2.840.10008.5.1.4.1.1.2", f"{series}.{z + 1}"
    meta = (element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", ct) + element(2, 3, "UI", instance)
            + element(2, 0x10, "UI", "1.2.840.10008.1.2.1") + element(2, 0x12, "UI", "1.2.3"))
    rows, columns = samples.shape
    path.write_bytes(
        bytes(128) + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta
        + element(8, 0x16, "UI", ct) + element(8, 0x18, "UI", instance) + element(8, 0x60, "CS", "CT")
        + element(0x18, 0x50, "DS", "3") + element(0x20, 0xD, "UI", "1.2.3") + element(0x20, 0xE, "UI", series)
        + element(0x20, 0x13, "IS", str(number)) + element(0x20, 0x32, "DS", f"10\\20\\{3 * z}")
        + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
        + element(0x28, 2, "US", short(1)) + element(0x28, 4, "CS", "MONOCHROME2")
        + element(0x28, 0x10, "US", short(rows)) + element(0x28, 0x11, "US", short(columns))
        + element(0x28, 0x30, "DS", "2\\1") + element(0x28, 0x100, "US", short(16))
        + element(0x28, 0x101, "US", short(16)) + element(0x28, 0x102, "US", short(15))
        + element(0x28, 0x103, "US", short(0)) + more + element(0x28, 0x1052, "DS", "-5") + element(0x28, 0x1053, "DS", "2")
        + element(0x7FE0, 0x10, "OW", samples.tobytes())
    )


def test_dicom(tmp_path):
    for z in (1, 0):
        dicom(tmp_path / f"{7 - z}.dcm", z, "1.2.3.4", GRID[z])
    ct = walpha.read(tmp_path)
    assert np.array_equal(ct.samples, 2.0 * GRID - 5) and ct.unit == "mm" and ct.space == "LPS"
    assert ct.spacing == (1, 2, 3) and ct.origin == (10, 20, 0)
    assert (ct.affine @ [3, 2, 1, 1]).tolist() == [13, 24, 3, 1]
    # Of two series one must be named.
    for z in (0, 1):
        dicom(tmp_path / f"other-{z}.dcm", z, "1.2.3.9", GRID[z] + np.uint16(100))
    with pytest.raises(ValueError, match="series"):
        walpha.read(tmp_path)
    assert {walpha.read(tmp_path, series=number).samples.max() for number in (1, 2)} == {41, 241}
    assert walpha.read(tmp_path, series="3.9").samples.max() == 241


def test_padding_of_dicom_is_no_data(tmp_path):
    for z in (0, 1):
        dicom(tmp_path / f"{z}.dcm", z, "1.2.3.4", GRID[z], element(0x28, 0x120, "US", struct.pack("<H", 7)))
    ct = walpha.read(tmp_path)
    assert ct.masked and np.array_equal(np.isnan(ct.samples), GRID == 7)
    points = walpha.pipeline(ct, count=23, rms=0, alpha=100.0).points
    assert len(points) == 23 and not (points == [13, 22, 0]).all(axis=1).any()
    assert len(walpha.select(ct, count=23).points) == 23
    assert np.isfinite(walpha.haar(ct)[0]).all() and np.isfinite(walpha.difference(ct)).all()
    filled = walpha.read(tmp_path, nan=-99)
    assert not filled.masked and filled.samples[0, 1, 3] == -99


def test_slices_at_two_spacings(tmp_path):
    for k, z in enumerate((0, 1, 2, 4, 6)):
        dicom(tmp_path / f"{k}.dcm", z, "1.2.3.4", np.full((3, 4), z, "<u2"), number=k + 1)
    volume = walpha.read(tmp_path)
    assert volume.spacing[2] == 3 and volume.samples[:, 0, 0].tolist() == [-5, -3, -1, 1, 3, 5, 7]
    with pytest.raises(ValueError, match="several distances"):
        walpha.read(tmp_path, resample=False)


def las(path, points, classes):
    """LAS 1.2, point format 0."""
    scaled = np.round(np.asarray(points) * 100).astype("<i4")
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    counts = [len(points), 0, 0, 0, 0]
    header = (
        b"LASF" + struct.pack("<HHIHH8sBB", 0, 0, 0, 0, 0, bytes(8), 1, 2) + bytes(64)
        + struct.pack("<HHHIIBHI5I", 1, 2020, 227, 227, 0, 0, 20, len(points), *counts)
        + struct.pack("<3d3d", 0.01, 0.01, 0.01, 0, 0, 0)
        + struct.pack("<6d", high[0], low[0], high[1], low[1], high[2], low[2])
    )
    assert len(header) == 227
    records = b"".join(struct.pack("<iiiHBBbBH", *row.tolist(), 0, 9, of, 0, 0, 0) for row, of in zip(scaled, classes))
    path.write_bytes(header + records)


def test_las(tmp_path):
    points = [[0, 0, 0], [1.25, 0, 0], [0, 2.5, 0], [0, 0, 3], [0.1, 0.1, 0.1]]
    las(tmp_path / "tile.las", points, [2, 6, 2, 5, 9])
    assert np.allclose(walpha.read_points(tmp_path / "tile.las").points, points)
    of = lambda classes: walpha.read_points(tmp_path / "tile.las", classes=classes).points.tolist()  # noqa: E731
    assert of(["ground"]) == of([2]) == [points[0], points[2]] and of(["building", 5]) == [points[1], points[3]]
    assert len(walpha.read_points(tmp_path / "tile.las", thin=1.0).points) == 4
    for how, message in (({"classes": ["grass"]}, "'grass'"), ({"classes": [256]}, "256"), ({"thin": 0}, "thin=0")):
        with pytest.raises(ValueError, match=message):
            walpha.read_points(tmp_path / "tile.las", **how)


def test_withheld_points_of_las(tmp_path):
    points = [[0, 0, 0], [1.25, 0, 0], [0, 2.5, 0]]
    las(tmp_path / "tile.las", points, [2, 2 | 0x80, 6])
    assert walpha.read_points(tmp_path / "tile.las").points.tolist() == [points[0], points[2]]
    assert walpha.read_points(tmp_path / "tile.las", withheld=True).points.tolist() == points


def test_frames_of_a_text(tmp_path):
    (tmp_path / "scans.pts").write_text("1\n0 0 0\n2\n1 2 3\n4 5 6\n")
    assert walpha.read_points(tmp_path / "scans.pts", frame=1).points.tolist() == [[1, 2, 3], [4, 5, 6]]
    with pytest.raises(ValueError, match="holds 2 frames"):
        walpha.read_points(tmp_path / "scans.pts")


def test_arrays_of_points(tmp_path):
    """A fourth column has values, unless it is named; what is written has fields with names."""
    rows = np.array([[1.0, 2.0, 3.0, 7.0], [4.0, 5.0, 6.0, 8.0]])
    np.save(tmp_path / "rows.npy", rows)
    read = walpha.read_points(tmp_path / "rows.npy")
    assert read.weights is None and read.values.tolist() == [7, 8]
    read = walpha.read_points(tmp_path / "rows.npy", columns=["x", "y", "z", "weight"])
    assert read.weights.tolist() == [7, 8] and read.values is None
    walpha.write_points(tmp_path / "fields.npy", rows[:, :3], weights=[7, 8], values=[1, 2])
    assert np.load(tmp_path / "fields.npy").dtype.names == ("x", "y", "z", "weight", "value")
    read = walpha.read_points(tmp_path / "fields.npy")
    assert read.points.tolist() == rows[:, :3].tolist() and read.weights.tolist() == [7, 8] and read.values.tolist() == [1, 2]


def test_columns_of_a_table(tmp_path):
    (tmp_path / "table.csv").write_text("1,2,3,4\n5,6,7,8\n")
    read = walpha.read_points(tmp_path / "table.csv", columns=["value", "z", "y", "x"])
    assert read.points.tolist() == [[4, 3, 2], [8, 7, 6]] and read.values.tolist() == [1, 5]
    with pytest.raises(ValueError, match="z"):
        walpha.read_points(tmp_path / "table.csv", columns=["x", "y", "a", "b"])
