import numpy as np
import pytest

import walpha

from test_shape import same


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64, np.longdouble, np.int16, np.uint64])
def test_any_real_type(cloud, dtype):
    given = (cloud * 100).astype(dtype)
    wanted = walpha.alpha_shape(np.array(given, np.float64), alpha=60)
    assert len(wanted.cells) > 100 and same(walpha.alpha_shape(given, alpha=60), wanted)


def test_any_layout(cloud, weights):
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights)
    wide = np.zeros((600, 7))
    wide[:, 1:7:2] = cloud
    for given in (
        cloud.tolist(),
        np.asfortranarray(cloud),
        wide[:, 1:7:2],
        cloud[::-1].copy()[::-1],
        np.array(cloud.T).T,
        cloud.astype(">f8"),
    ):
        assert same(walpha.alpha_shape(given, 0.003, weights=weights), wanted)
    assert same(walpha.alpha_shape(cloud, 0.003, weights=weights[::-1].copy()[::-1]), wanted)


def test_input_is_left_alone(cloud):
    given = cloud.copy()
    given.flags.writeable = False
    walpha.alpha_shape(given, alpha=0.01)
    assert np.array_equal(given, cloud)


@pytest.mark.parametrize("shape", [(5, 1), (5, 4), (5,), (2, 5, 3)])
def test_other_shapes_are_refused(shape):
    with pytest.raises(ValueError, match="expected"):
        walpha.alpha_shape(np.zeros(shape), alpha=1)


@pytest.mark.parametrize("bad", [np.zeros((5, 3), complex), [["a", "b", "c"]] * 5, [[0, 0], [0, 0, 0]]])
def test_what_is_no_number_is_refused(bad):
    with pytest.raises(ValueError, match="points"):
        walpha.alpha_shape(bad, alpha=1)


def test_as_many_weights_and_values_as_points(cloud):
    with pytest.raises(ValueError, match="3 weights for 600 points"):
        walpha.alpha_shape(cloud, 1, weights=[1, 2, 3])
    with pytest.raises(ValueError, match="3 values for 600 points"):
        walpha.alpha_shape(cloud, alpha=1, values=[1, 2, 3])
    for given, shape in ((cloud, r"\(600, 3\)"), (2.0, r"\(\)")):
        with pytest.raises(ValueError, match=f"weights has shape {shape}, .* one number for each point"):
            walpha.alpha_shape(cloud, 1, weights=given)


class Tensor:
    """What has DLPack, and no more."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **how):
        return self.array.__dlpack__(**how)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def test_tensors(cloud, weights):
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights)
    assert same(walpha.alpha_shape(Tensor(cloud), 0.003, weights=Tensor(weights)), wanted)
    cells = walpha.triangulation(Tensor(cloud)).find_simplex(Tensor(cloud[:5]))
    assert (cells >= 0).all()
    torch = pytest.importorskip("torch")
    assert same(walpha.alpha_shape(torch.tensor(cloud), 0.003, weights=torch.tensor(weights)), wanted)


def test_a_tensor_that_is_elsewhere():
    class Elsewhere:
        def __dlpack__(self, **how):
            raise BufferError("the tensor is on a GPU")

        def __dlpack_device__(self):
            return (2, 0)

    with pytest.raises(ValueError, match="points cannot be read as an array"):
        walpha.alpha_shape(Elsewhere())


@pytest.mark.parametrize("package", ["pandas", "polars"])
def test_frames(cloud, weights, package):
    frames = pytest.importorskip(package)
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights)
    frame = frames.DataFrame({"x": cloud[:, 0], "y": cloud[:, 1], "z": cloud[:, 2], "w": weights})
    assert same(walpha.alpha_shape(frame[["x", "y", "z"]], 0.003, weights=frame["w"]), wanted)
    whole = frames.DataFrame({"x": [0, 1, 0, 0], "y": [0.0, 0.0, 1.0, 0.0], "z": np.array([0, 0, 0, 1], np.int8)})
    assert walpha.alpha_shape(whole, 1).volume == pytest.approx(1 / 6)
    named = frames.DataFrame({"x": [0.0], "y": [0.0], "name": ["a"]})
    with pytest.raises(ValueError, match="points must be real numbers.*'name'"):
        walpha.alpha_shape(named)


def test_pandas_with_columns_that_may_miss_values():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"x": [0, 1, 0, 0], "y": [0, 0, 1, 0], "z": [0, 0, 0, 1]}).astype({"x": "Int64", "y": "Float64"})
    assert walpha.alpha_shape(frame, 1).volume == pytest.approx(1 / 6)
    frame.loc[1, "x"] = pandas.NA
    with pytest.raises(ValueError, match="points? .*"):
        walpha.alpha_shape(frame, 1)


def test_float32_is_widened_exactly(cloud):
    narrow = cloud.astype(np.float32)
    shape = walpha.alpha_shape(narrow, 0.003)
    assert np.array_equal(shape.points, narrow.astype(np.float64)) and not np.array_equal(shape.points, cloud)
    assert same(shape, walpha.alpha_shape(narrow.astype(np.float64), 0.003))


def test_indices_have_64_bits(cloud):
    shape = walpha.alpha_shape(cloud, 0.003, exterior=True)
    simplices = walpha.filtration(cloud).simplices()
    boundary, complex_ = shape.boundary(), walpha.Complex.of(shape)
    for of in (shape, simplices, complex_):
        assert of.vertices.ndim == 1
        for rows in (of.cells, of.facets, of.edges, of.vertices):
            assert rows.dtype == np.int64
    curve = walpha.filtration(cloud).betti_curve()
    others = (shape.hidden, shape.duplicates, shape.copies, shape.component_numbers, boundary.triangles, boundary.indices,
              simplices.ranks, simplices.order, simplices.component_pairs, *simplices.lasting, curve.b0, complex_.hidden)
    assert {rows.dtype for rows in others} == {np.dtype(np.int64)}


def test_arrays_of_objects_cannot_be_written_to():
    cloud = np.random.default_rng(3).random((40, 3))
    weights, values = np.full(40, 0.01), np.arange(40.0)
    weights[7] = 2
    shape = walpha.alpha_shape(cloud, 0.1, weights=weights, values=values, hidden=True)
    filtration = walpha.filtration(cloud, weights=weights)
    objects = [shape, walpha.Complex.of(shape), filtration, filtration.simplices(), walpha.triangulation(cloud, weights)]
    for made in objects:
        names = [name for name in dir(made) if not name.startswith("_")]
        arrays = {name: array for name in names if isinstance(array := getattr(made, name), np.ndarray)}
        assert len(arrays) > 1
        assert not [name for name, array in arrays.items() if array.flags.writeable], made
    assert not any(array.flags.writeable for array in filtration.simplices().lasting)
