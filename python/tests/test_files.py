import hashlib
import os
import subprocess
import sys

import numpy as np
import pytest

import walpha

HASH = """
import hashlib, numpy as np, walpha
points = np.round(np.random.default_rng(5).random((20_000, 3)) * 40)
shape = walpha.alpha_shape(points, np.random.default_rng(6).random(20_000), 2.0)
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


@pytest.mark.parametrize("ending", ["ply", "off", "obj", "stl", "glb", "vtp", "vtu", "npz", "json"])
def test_every_format_is_written_the_same_twice(tmp_path, cloud, ending):
    shape = walpha.alpha_shape(cloud, alpha=0.004)
    paths = [tmp_path / f"{k}.{ending}" for k in (0, 1)]
    for path in paths:
        shape.save(path)
    digests = {hashlib.sha256(path.read_bytes()).digest() for path in paths}
    assert len(digests) == 1 and paths[0].stat().st_size > 1000


def test_npz_is_the_arrays(tmp_path, cloud, weights):
    shape = walpha.alpha_shape(cloud, weights, 0.004)
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
    assert mesh.is_watertight and np.isclose(mesh.volume, shape.volume)
