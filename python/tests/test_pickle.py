"""Every object comes back from a pickle as it was, and has a repr."""

import copy
import itertools
import pickle

import numpy as np
import pytest

import walpha
from walpha.tda import AlphaPersistence

from test_shape import same


def again(given):
    return pickle.loads(pickle.dumps(given))


@pytest.mark.parametrize(
    "how",
    [
        {"alpha": 0.004},
        {"alpha": np.inf, "engine": "native"},
        {"alpha": 0.004, "exterior": True},
        {"alpha": 0.004, "hidden": True},
        {"alpha": 0.004, "hidden": True, "engine": "native"},
        {"alpha": 0.2, "balls": "radius"},
        {"alpha": 0.003, "periodic": (1, 1, 1.25)},
        {},
        {"alpha": "auto:connected"},
        {"alpha": -0.002},
    ],
)
def test_shapes(cloud, weights, how, tmp_path):
    shape = walpha.alpha_shape(cloud, weights=weights, values=cloud[:, 0], **how)
    back = again(shape)
    assert same(back, shape) and repr(back) == repr(shape) and repr(shape).isascii()
    for name in ("alpha", "betti", "volume", "area", "engine", "periodic", "alpha_origin", "truncation"):
        assert getattr(back, name) == getattr(shape, name), name
    for name in ("points", "weights", "values", "hidden", "duplicates", "component_numbers"):
        assert np.array_equal(getattr(back, name), getattr(shape, name)), name
    if not how.get("periodic"):
        part = shape.keep("largest")
        assert same(again(part), part) and again(part).kept == part.kept
    if how.get("periodic"):
        flat = shape.unwrapped()
        assert len(flat.copies) > 0
        assert same(again(flat), flat) and np.array_equal(again(flat).copies, flat.copies)
    assert copy.deepcopy(shape) is copy.copy(shape) is shape


def test_a_shape_of_a_volume_keeps_its_unit(tmp_path):
    volume = walpha.Volume(walpha.read("sample:phantom@32").samples, spacing=(1, 1, 2), space="LPS", unit="mm")
    shape = walpha.pipeline(volume, weighting="min-max")
    back = again(shape)
    assert same(back, shape) and back.truncation == shape.truncation and back.alpha_origin == "default"
    shape.save(tmp_path / "one.json")
    back.save(tmp_path / "two.json")
    assert (tmp_path / "one.json").read_bytes() == (tmp_path / "two.json").read_bytes()
    assert "mm" in (tmp_path / "one.json").read_text()


def test_filtrations(cloud, weights):
    for how in ({"weights": weights}, {"periodic": (1, 1, 1)}):
        filtration = walpha.filtration(cloud, **how)
        back = again(filtration)
        assert repr(back) == repr(filtration) and np.array_equal(back.weights, filtration.weights)
        assert all(np.array_equal(a, b) for a, b in zip(back.betti_curve(), filtration.betti_curve()))
        shape = filtration.shape(0.003)
        assert same(again(shape), shape)
        simplices, other = filtration.simplices(), again(filtration.simplices())
        assert list(simplices) == list(other) and repr(simplices) == repr(other)
        assert np.array_equal(simplices.persistence(2), other.persistence(2))


def test_triangulations(cloud, weights):
    made = walpha.triangulation(cloud, weights)
    back = again(made)
    assert repr(back) == repr(made)
    for name in ("points", "weights", "simplices", "neighbors", "convex_hull", "hidden", "duplicates"):
        assert np.array_equal(getattr(back, name), getattr(made, name)), name
    assert np.array_equal(back.find_simplex(cloud), made.find_simplex(cloud))


def test_complexes(cloud, weights):
    periodic = walpha.alpha_shape(cloud, 0.003, periodic=(1.5, 2, 2))
    wrong = np.random.default_rng(0).permutation(600)[:400].reshape(-1, 4)
    for complex_ in (
        walpha.Complex.of(walpha.alpha_shape(cloud, 0.003, weights=weights, exterior=True)),
        walpha.Complex.of(periodic),
        walpha.Complex(cloud, alpha=np.inf, cells=wrong),
    ):
        back = again(complex_)
        assert repr(back) == repr(complex_) and repr(back).isascii() and back.periodic == complex_.periodic
        assert same(back, complex_) and np.array_equal(back.points, complex_.points)
        assert str(walpha.check(back)) == str(walpha.check(complex_))


def test_what_is_made_of_arrays(cloud):
    shape = walpha.alpha_shape(cloud, 0.004, exterior=True)
    curve, volume = walpha.filtration(cloud).betti_curve(), walpha.read("sample:phantom@32")
    assert again(shape.components) == shape.components and again(shape.voids) == shape.voids
    assert np.array_equal(again(curve).b1, curve.b1)
    assert np.array_equal(again(shape.boundary()).triangles, shape.boundary().triangles)
    assert np.array_equal(again(volume).samples, volume.samples) and again(volume).spacing == volume.spacing
    verdict = walpha.check(shape)
    assert again(verdict) == verdict and again(walpha.Class.REGULAR) is walpha.Class.REGULAR
    transformer = AlphaPersistence((0,), radius=True)
    assert again(transformer).get_params() == transformer.get_params() and repr(again(transformer)) == repr(transformer)


def test_other_processes_get_them(cloud):
    joblib = pytest.importorskip("joblib")
    shape = walpha.alpha_shape(cloud, 0.004)
    volumes = joblib.Parallel(2)(joblib.delayed(getattr)(of, "volume") for of in itertools.repeat(shape, 2))
    assert volumes == [shape.volume] * 2


def test_a_surface_is_that_of_the_samples_then():
    samples = np.zeros((8, 8, 8), np.float32)
    samples[2:6, 2:6, 2:6] = 1
    shape = walpha.surface_shape(walpha.Volume(samples), 0.5)
    samples[:] = 1
    assert pickle.loads(pickle.dumps(shape)).volume == shape.volume
