import hashlib
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

import walpha

HASH = """
import hashlib, numpy as np, walpha
points = np.round(np.random.default_rng(5).random((20_000, 3)) * 40)
shape = walpha.alpha_shape(points, 2.0, weights=np.random.default_rng(6).random(20_000))
curve = walpha.filtration(points[:3000]).betti_curve()
parts = [shape.cells, shape.facets, shape.edges, shape.vertices, *shape._classes, shape.boundary().triangles, *curve]
print(hashlib.sha256(b"".join(np.ascontiguousarray(p).tobytes() for p in parts)).hexdigest(), shape.volume)
"""


def test_the_same_on_any_number_of_threads():
    def run(threads):
        environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
        return subprocess.run([sys.executable, "-c", HASH], env=environment, capture_output=True, text=True, check=True).stdout

    first = run(1)
    assert len(first.split()[0]) == 64 and run(2) == first and run(5) == first


@pytest.mark.parametrize("ending", ["ply", "off", "obj", "stl", "3mf", "glb", "vtp", "vtu", "npz", "json"])
def test_every_format_is_written_the_same_twice(tmp_path, cloud, ending):
    shape = walpha.alpha_shape(cloud, alpha=0.004)
    paths = [tmp_path / f"{k}.{ending}" for k in (0, 1)]
    for path in paths:
        shape.save(path)
    digests = {hashlib.sha256(path.read_bytes()).digest() for path in paths}
    assert len(digests) == 1 and paths[0].stat().st_size > 1000


def test_npz_is_the_arrays(tmp_path, cloud, weights):
    shape = walpha.alpha_shape(cloud, 0.004, weights=weights)
    shape.save(str(tmp_path / "shape.npz"))
    with np.load(tmp_path / "shape.npz") as arrays:
        assert np.array_equal(arrays["cells"], shape.cells)
        assert np.array_equal(arrays["facet_classes"], shape.facet_classes)
        again = walpha.Complex(**{name: arrays[name] for name in arrays if name in (
            "points", "weights", "cells", "facets", "edges", "vertices",
            "cell_classes", "facet_classes", "edge_classes", "vertex_classes")}, alpha=float(arrays["alpha"]))
    assert walpha.compare(again, shape).equal


def test_a_solid_file_is_closed(tmp_path, cloud):
    trimesh = pytest.importorskip("trimesh")
    shape = walpha.alpha_shape(cloud, alpha=0.004)
    shape.save(tmp_path / "solid.ply", solid=True)
    mesh = trimesh.load(tmp_path / "solid.ply", process=False)
    assert mesh.is_watertight and np.isclose(mesh.volume, shape.volume, rtol=2e-3)
    # Vertices at one place are taken for one.
    shape.save(tmp_path / "solid.stl", solid=True)
    assert trimesh.load(tmp_path / "solid.stl").is_volume
    cuts = shape.boundary().cuts
    assert cuts.moved == cuts.vertices + cuts.midpoints > 0 == cuts.together and cuts.largest_move > 0


def test_points_come_back_from_a_file(tmp_path):
    rng = np.random.default_rng(3)
    points = np.unique(rng.integers(0, 20, (500, 3)), axis=0).astype(float)
    points = points[np.lexsort(points.T)]
    values = rng.integers(0, 256, len(points)).astype(float)
    exact, small, table = (tmp_path / name for name in ("exact.wvm", "small.wvm", "table.csv"))
    walpha.write_points(exact, points, values=values, alpha=2.5)
    walpha.write_points(small, points, values=values, value_error=4)
    walpha.write_points(table, points, weights=np.ones(len(points)), values=values)
    read = walpha.read_points(exact)
    assert np.array_equal(read.points, points) and np.array_equal(read.values, values)
    assert (read.weights == 0).all() and read.alpha == 2.5
    assert read.grid == tuple(int(n) + 1 for n in points.max(axis=0)[::-1])
    assert 0 < np.abs(walpha.read_points(small).values - values).max() <= 4
    assert small.stat().st_size < exact.stat().st_size < table.stat().st_size / 3
    read = walpha.read_points(table)
    assert np.array_equal(read.points, points) and read.grid is None and (read.weights == 1).all()


def test_points_that_cannot_be_written_or_read(tmp_path):
    points = np.eye(3)
    for call in (
        lambda: walpha.write_points(tmp_path / "a.ply", points),
        lambda: walpha.write_points(tmp_path / "a.csv", points, alpha=1.0),
        lambda: walpha.write_points(tmp_path / "a.wvm", points, value_error=-1),
        lambda: walpha.write_points(tmp_path / "a.wvm", points, values=[1.0]),
    ):
        with pytest.raises(ValueError):
            call()
    assert list(tmp_path.iterdir()) == []
    walpha.write_points(tmp_path / "a.wvm", points)
    data = bytearray((tmp_path / "a.wvm").read_bytes())
    data[-5] ^= 1
    (tmp_path / "a.wvm").write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        walpha.read_points(tmp_path / "a.wvm")


def test_a_file_of_nothing_is_an_error(tmp_path):
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    shape = walpha.alpha_shape(corners, 0.001)
    assert shape.boundary().triangles.shape == (0, 3) and shape.cells.shape == (0, 4)
    for name in ("e.stl", "e.ply", "e.glb"):
        with pytest.raises(ValueError, match="the shape has no .*facet at α = 0.001.*`alpha_radius`.*allow_empty=True"):
            shape.save(tmp_path / name)
        assert not (tmp_path / name).exists()
        shape.save(tmp_path / name, allow_empty=True)
    shape.save(tmp_path / "e.json")
    with pytest.raises(ValueError, match="no simplex"):
        walpha.alpha_shape(corners, -1).save(tmp_path / "e.npz")


def test_single_precision_far_away_has_an_offset(tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(0, 1, 0.05)]))
    roof = np.c_[x + 434123.4, y + 5412345.6, 412 + 0.2 * np.abs(x - 0.5)]
    shape = walpha.alpha_shape(np.r_[roof, roof - [0, 0, 0.3]], alpha_radius=0.2)
    with pytest.warns(UserWarning, match="roof.stl: .*434000, 5412000, 0 is subtracted"):
        shape.save(tmp_path / "roof.stl")
    written = (tmp_path / "roof.stl").read_bytes()
    assert written.startswith(b"walpha OFFSET=434000,5412000,0 ")
    rows = np.frombuffer(written[84:], [("numbers", "<f4", 12), ("end", "<u2")])["numbers"]
    found = np.unique(rows[:, 3:].reshape(-1, 3).astype(float) + [434000, 5412000, 0], axis=0)
    wanted = shape.boundary(solid=False).points
    assert len(found) == len(wanted)
    assert np.abs(found - wanted[np.lexsort(wanted.T[::-1])]).max() < 5e-5


def test_a_scan_has_classes_a_system_and_columns():
    tile = walpha.read_points("sample:tile", classes=["vegetation"], value="height")
    assert (tile.crs["epsg"], tile.unit, tile.classes[5]) == (25832, "m", len(tile.points))
    assert set(tile.classes) == {2, 5, 6}
    np.testing.assert_array_equal(tile.values, tile.points[:, 2])
    assert list(tile.columns) == ["intensity", "classification", "treeID"]
    assert set(tile.columns["treeid"]) == {1, 2, 3, 4, 5}
    assert "treeID" in tile.columns and "height" not in tile.columns
    with pytest.raises(KeyError, match="treeID"):
        tile.columns["nope"]
    again = pickle.loads(pickle.dumps(tile))
    np.testing.assert_array_equal(again.columns["class"], np.full(len(tile.points), 5.0))


def test_columns_of_a_table(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("x,y,z,label,kind\n0,0,0,1,oak\n1,0,0,,ash\n")
    points = walpha.read_points(path)
    assert (points.classes, points.crs) == (None, None)
    assert list(points.columns) == ["label"]
    np.testing.assert_array_equal(points.columns["label"], [1, np.nan])
    with pytest.raises(ValueError, match="no column nope"):
        walpha.read_points(path, value="nope")
