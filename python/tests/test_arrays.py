import pickle

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


def structured(columns):
    kinds = [(name, np.asarray(column).dtype) for name, column in columns.items()]
    rows = np.zeros(len(next(iter(columns.values()))), kinds)
    for name, column in columns.items():
        rows[name] = column
    return rows


@pytest.fixture(params=["pandas", "polars", "structured", "recarray", "dict"])
def table(request):
    """Makes a table of columns."""
    if request.param in ("pandas", "polars"):
        return pytest.importorskip(request.param).DataFrame
    return {"structured": structured, "recarray": lambda columns: structured(columns).view(np.recarray), "dict": dict}[request.param]


def test_columns_of_tables_have_their_names(cloud, weights, table):
    x, y, z = cloud.T
    values = np.arange(600.0)
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights, values=values)
    assert same(walpha.alpha_shape(table({"x": x, "y": y, "z": z}), 0.003, weights=weights), wanted)
    # In any order and letter case; what else there is is skipped, and said to be.
    with pytest.warns(UserWarning, match="points: skipped, .*: 'id', 'intensity'"):
        shape = walpha.alpha_shape(table({"id": values, "Z": z, "value": values, "y": y, "intensity": x, "weight": weights, "X": x}), 0.003)
    assert same(shape, wanted) and np.array_equal(shape.values, values)
    radii = walpha.alpha_shape(table({"radius": np.full(600, 0.25), "x": x, "y": y, "z": z}), 0.003)
    assert (radii.weights == 0.0625).all()
    plane = walpha.alpha_shape(table({"y": y, "x": x}), 0.003)
    assert np.array_equal(plane.points, np.c_[x, y, 0 * x])
    with pytest.warns(UserWarning, match="'value'"):
        made = walpha.triangulation(table({"x": x, "y": y, "z": z, "weight": weights, "value": values}))
    assert np.array_equal(made.simplices, walpha.triangulation(cloud, weights).simplices)
    inside = table({"z": [0.5], "x": [0.25], "y": [0.75]})
    assert np.array_equal(shape.at(inside), shape.at([[0.25, 0.75, 0.5]]), equal_nan=True)


def test_tables_without_these_names_are_refused(cloud, weights, table):
    x, y, z = cloud.T
    for columns in ({"a": x, "b": y, "c": z}, {"id": x, "x": y, "y": z}, {"x": x, "y": y, "X": z}):
        with pytest.raises(ValueError, match="points: columns .*to_numpy"):
            walpha.alpha_shape(table(columns), 0.003)
    with pytest.raises(ValueError, match="weights are given twice"):
        walpha.alpha_shape(table({"x": x, "y": y, "z": z, "weight": weights}), 0.003, weights=weights)


def test_frames_without_names_are_refused(cloud):
    pandas = pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="points: columns .*to_numpy"):
        walpha.alpha_shape(pandas.DataFrame(cloud), 0.003)


@pytest.mark.parametrize("package", ["pandas", "polars"])
def test_frames(cloud, weights, package):
    frames = pytest.importorskip(package)
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights)
    frame = frames.DataFrame({"x": cloud[:, 0], "y": cloud[:, 1], "z": cloud[:, 2], "w": weights})
    assert same(walpha.alpha_shape(frame[["x", "y", "z"]], 0.003, weights=frame["w"]), wanted)
    assert same(walpha.alpha_shape(frame[["x", "y", "z"]], 0.003, weights=np.c_[weights]), wanted)
    whole = frames.DataFrame({"x": [0, 1, 0, 0], "y": [0.0, 0.0, 1.0, 0.0], "z": np.array([0, 0, 0, 1], np.int8)})
    assert walpha.alpha_shape(whole, 1).volume == pytest.approx(1 / 6)
    named = frames.DataFrame({"x": [0.0], "y": [0.0], "z": ["a"]})
    with pytest.raises(ValueError, match="points\\['z'\\] must be real numbers"):
        walpha.alpha_shape(named)


def test_pandas_with_columns_that_may_miss_values():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"x": [0, 1, 0, 0], "y": [0, 0, 1, 0], "z": [0, 0, 0, 1]}).astype({"x": "Int64", "y": "Float64"})
    assert walpha.alpha_shape(frame, 1).volume == pytest.approx(1 / 6)
    frame.loc[1, "x"] = pandas.NA
    with pytest.raises(ValueError, match="points? .*"):
        walpha.alpha_shape(frame, 1)


def test_masked_rows_are_no_points(cloud, weights):
    values = np.arange(600.0)
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights, values=values)
    assert same(walpha.alpha_shape(np.ma.masked_array(cloud), 0.003, weights=np.ma.masked_array(weights)), wanted)
    # A row is out where any of its coordinates is, whatever lies under the mask, with its weight and value.
    rows = np.insert(cloud, [0, 300], 9e9, axis=0)
    beside = [np.insert(column, [0, 300], np.nan) for column in (weights, values)]
    for mask in (rows > 1, np.c_[rows[:, 0] > 1, np.zeros((602, 2), bool)]):
        points = np.ma.masked_array(rows, mask)
        for columns in (beside, [np.ma.masked_invalid(column) for column in beside]):
            shape = walpha.alpha_shape(points, 0.003, weights=columns[0], values=columns[1])
            assert same(shape, wanted) and np.array_equal(shape.values, values) and np.array_equal(shape.points, cloud)
    assert len(walpha.filtration(points).points) == len(walpha.triangulation(points).points) == 600
    flat = walpha.alpha_shape(points[:, :2], 0.003)
    assert np.array_equal(flat.points[:, :2], cloud[:, :2])
    with pytest.raises(ValueError, match="600 weights for 602 points, those that are masked included"):
        walpha.alpha_shape(points, 0.003, weights=weights)


def test_what_is_masked_elsewhere_is_named(cloud, weights, tmp_path):
    missing = np.ma.masked_array(weights, np.arange(600) == 7)
    for name in ("weights", "values"):
        with pytest.raises(ValueError, match=f"{name} is masked in row 7, and the point is not"):
            walpha.alpha_shape(cloud, 0.003, **{name: missing})
    points = np.ma.masked_array(cloud)
    points[3, 1] = np.ma.masked
    shape = walpha.alpha_shape(cloud, 0.003, values=weights)
    for use in (shape.at, walpha.triangulation(cloud).find_simplex, lambda points: walpha.Complex(points, alpha=1)):
        with pytest.raises(ValueError, match="is masked in row 3"):
            use(points)
    walpha.write_points(tmp_path / "kept.csv", points)
    assert len(walpha.read_points(tmp_path / "kept.csv").points) == 599


def test_masked_samples_become_no_points():
    volume = walpha.read("sample:phantom@16").samples
    masked = np.ma.masked_array(volume, np.zeros(volume.shape, bool))
    assert same(walpha.pipeline(masked), walpha.pipeline(volume))
    masked[4:9] = np.ma.masked
    missing = volume.copy()
    missing[4:9] = np.nan
    wanted = walpha.pipeline(missing, nan=np.nan)
    assert not np.isin(wanted.points[:, 2], range(4, 9)).any()
    assert same(walpha.pipeline(masked), wanted) and same(walpha.pipeline(walpha.Volume(masked)), walpha.pipeline(walpha.Volume(missing), nan=np.nan))
    with pytest.raises(ValueError, match="nan"):
        walpha.pipeline(missing)


class Quantity:
    """As pint has them."""

    def __init__(self, magnitude, units):
        self.magnitude, self.units = magnitude, units

    def __array__(self, dtype=None, copy=None):
        return np.array(self.magnitude, dtype)


def test_units_are_passed_over_with_a_word(cloud):
    with pytest.warns(UserWarning, match="points is in millimetre, which is passed over"):
        shape = walpha.alpha_shape(Quantity(cloud, "millimetre"), 0.003)
    assert same(shape, walpha.alpha_shape(cloud, 0.003))


def test_a_fourth_column_is_no_guess(cloud, weights):
    with pytest.raises(ValueError, match="shape \\(600, 4\\).*weights= or values="):
        walpha.alpha_shape(np.c_[cloud, weights], 0.003)
    with pytest.raises(ValueError, match="not object: give numbers of one type"):
        walpha.alpha_shape(cloud.astype(object), 0.003)


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
    assert not pickle.loads(pickle.dumps(filtration.simplices())).order.flags.writeable


def test_columns_of_tables_go_by_their_names():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"z": [0.0, 3], "radius": [0.3, 0.3], "y": [0.0, 2], "x": [0.0, 1]})
    plain = walpha.pores(frame[["x", "y", "z"]].to_numpy(), 4, [0.3, 0.3])
    assert walpha.pores(frame, 4).included.diameter == plain.included.diameter
    with pytest.raises(ValueError, match="radii are given twice"):
        walpha.pores(frame, 4, [0.3, 0.3])
    places = np.random.default_rng(5).random((50, 3))
    cells = walpha.triangulation(np.random.default_rng(4).random((80, 3)))
    swapped = pandas.DataFrame(places[:, ::-1], columns=["z", "y", "x"])
    assert np.array_equal(cells.find_simplex(swapped), cells.find_simplex(places))


def test_masked_rows_are_no_numbers():
    filtration = walpha.filtration(np.eye(3))
    with pytest.raises(ValueError, match="is masked in row 1"):
        filtration.derivatives(np.ma.array([[0, 1], [1, 2]], mask=[[0, 0], [0, 1]]))


def test_flags_and_names_of_columns():
    shape = walpha.alpha_shape(np.eye(4)[:, :3], 9, exterior=np.True_, hidden=np.False_)
    assert len(shape.cells) == 1


def test_weights_of_files_are_not_further_columns(tmp_path):
    for name in ("radius", "Weight"):
        with pytest.raises(ValueError, match="give weights="):
            walpha.write_points(tmp_path / "a.csv", np.eye(3), columns={name: [1, 2, 3]})
    with pytest.raises(ValueError, match="has 2 numbers for 3 points"):
        walpha.write_points(tmp_path / "a.csv", np.eye(3), columns={"id": [1, 2]})
    assert not list(tmp_path.iterdir())
    walpha.write_points(tmp_path / "a.csv", np.eye(3), columns={"treeID": [1, 2, 3]})
    columns = walpha.read_points(tmp_path / "a.csv").columns
    assert "TREEID" in columns and "tree" not in columns and 1 not in columns
