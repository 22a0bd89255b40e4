import pickle
import warnings

import numpy as np
import pytest

import walpha

from test_shape import same


@pytest.fixture(scope="module")
def phantom():
    return walpha.read("sample:phantom@32")


def test_a_sample_is_read(phantom):
    assert phantom.samples.shape == (32, 32, 32) and phantom.samples.dtype == np.float32
    assert phantom.unit == "voxel" and phantom.spacing == (1, 1, 1)
    assert np.array_equal(np.asarray(phantom), phantom.samples)


def test_whole_numbers_that_are_rounded_are_said():
    with pytest.warns(UserWarning, match="are rounded to samples of single precision"):
        volume = walpha.Volume(np.full((2, 2, 2), 2**24 + 1))
    assert volume.samples[0, 0, 0] == 2**24
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        walpha.Volume(np.full((2, 2, 2), 2**30))
        walpha.Volume(np.full((2, 2, 2), 2**15 - 1, np.int16))


def test_stages_by_hand_are_the_pipeline(phantom):
    low, high = 10.0, 190.0
    gray = (255.0 * (phantom.samples.astype(float) - low) / (high - low)).astype(np.float32)
    smoothed, truncation = walpha.haar(gray)
    assert truncation["rms"] <= 1 and truncation["kept"] < truncation["total"] == 32**3
    assert np.isclose(np.sqrt(((smoothed - gray).astype(float) ** 2).mean()), truncation["rms"], rtol=1e-3)
    chosen = walpha.select(gray, smoothed, count=1500)
    assert chosen.points.shape == (1500, 3)
    x, y, z = chosen.points.astype(int).T
    assert np.array_equal(walpha.difference(smoothed)[z, y, x], chosen.differences)
    assert np.array_equal(chosen.values, gray[z, y, x])
    weights = walpha.weigh(chosen.differences, "min-max", alpha=10)
    assert weights.min() == 0 and weights.max() == 10
    by_hand = walpha.alpha_shape(chosen.points, 10, weights=weights)
    whole = walpha.pipeline(phantom, gray=(low, high), count=1500, weighting="min-max", alpha=10)
    assert same(by_hand, whole) and np.array_equal(by_hand.weights, whole.weights)
    assert whole.truncation["kept"] == truncation["kept"]
    assert np.allclose(whole.values, phantom.samples[z, y, x], atol=1e-4)


def test_haar_keeps_what_is_asked(phantom):
    assert walpha.haar(phantom, coefficients=100)[1]["kept"] == 100
    assert walpha.haar(phantom, epsilon=5)[1]["epsilon"] <= 5
    assert np.array_equal(walpha.haar(phantom, rms=0)[0], phantom.samples)
    standard, nonstandard = (walpha.haar(phantom, coefficients=100, decomposition=d)[0] for d in ("standard", "nonstandard"))
    assert not np.array_equal(standard, nonstandard)


def test_spacing_is_x_y_z_as_places_are(phantom):
    voxels = walpha.pipeline(phantom.samples, count=1000, alpha=10)
    world = walpha.pipeline(phantom.samples, count=1000, spacing=(1, 2, 4), origin=(7, 8, 9), alpha=10)
    assert np.array_equal(world.points, voxels.points * [1, 2, 4] + [7, 8, 9])
    chosen = walpha.select(phantom.samples, count=9, spacing=(1, 2, 4))
    assert np.array_equal(chosen.points, walpha.select(phantom.samples, count=9).points * [1, 2, 4])
    given = walpha.Volume(phantom.samples, spacing=(1, 2, 4), origin=(7, 8, 9), unit="mm")
    assert np.array_equal(walpha.pipeline(given, count=1000, alpha=10).points, world.points)
    with pytest.raises(ValueError, match="has its own spacing"):
        walpha.pipeline(given, spacing=(1, 1, 1))
    # 10 h², h³ being the volume of a voxel.
    default = walpha.pipeline(phantom.samples, count=1000, spacing=(2, 2, 2))
    assert default.alpha == pytest.approx(40) and default.alpha_origin == "default"


def test_bytes_are_gray_levels(phantom):
    gray = np.clip(phantom.samples, 10, 200).astype(np.uint8)
    as_bytes = walpha.pipeline(gray, count=500)
    assert same(as_bytes, walpha.pipeline(gray.astype(float), gray=(0, 255), count=500))
    assert walpha.Volume(gray).gray and not walpha.Volume(gray / 2).gray and not walpha.Volume(gray, gray=False).gray
    assert same(as_bytes, walpha.pipeline(walpha.Volume(gray, unit="voxel"), count=500))
    strided = np.asfortranarray(gray)
    assert same(as_bytes, walpha.pipeline(strided, count=500))


def test_values_are_fitted(phantom):
    own, fitted = (walpha.pipeline(phantom, count=500, refit=refit) for refit in (None, "shape"))
    assert np.array_equal(fitted.points, own.points)
    assert not np.array_equal(fitted.values, own.values)
    with pytest.raises(ValueError, match="whole, shape"):
        walpha.pipeline(phantom, count=500, refit="all")


def test_axes_are_not_exchanged():
    volume = np.zeros((3, 5, 7))
    volume[1, 2, 4] = 1
    assert walpha.select(volume, count=1).points.tolist() == [[4, 2, 1]]


@pytest.mark.parametrize(
    "options, message",
    [
        ({"rms": 1, "epsilon": 1}, "rms and epsilon contradict"),
        ({"count": 1, "ratio": 0.1}, "count and ratio contradict"),
        ({"count": 1.5}, "count=1.5.*not a whole number"),
        ({"ratio": 2}, "ratio=2.*a share above 0"),
        ({"origin": (0, 0, 0)}, "spacing"),
        ({"spacing": (1, 1)}, "spacing.*three"),
        ({"spacing": (1, 1, -1)}, "above 0"),
        ({"weighting": "heavy"}, "min-max"),
        ({"gray": (5, 5)}, "LO must be less than HI"),
        ({"gray_min": 300}, "less for `gray_min`"),
        ({"gray_min": 30, "value_min": 30}, "gray_min and value_min"),
        ({"decomposition": "cosine"}, "nonstandard"),
    ],
)
def test_options_that_make_no_sense(phantom, options, message):
    with pytest.raises(ValueError, match=message):
        walpha.pipeline(phantom.samples, **options)


def test_volumes_that_are_none():
    with pytest.raises(ValueError, match="three axes"):
        walpha.difference(np.zeros((3, 3)))
    with pytest.raises(ValueError, match="empty"):
        walpha.difference(np.zeros((3, 0, 3)))
    with pytest.raises(ValueError, match="nan|NaN"):
        walpha.haar(np.full((3, 3, 3), np.nan))
    with pytest.raises(ValueError, match="shape"):
        walpha.select(np.zeros((3, 3, 3)), np.zeros((3, 3, 4)), count=1)


def test_points_are_chosen_by_their_error(phantom):
    def rmse(**how):
        shape = walpha.pipeline(phantom, count=600, alpha=1e9, refit="whole", **how)
        assert len(shape.points) == 600
        assert not np.isnan(shape.interpolate(phantom.samples.shape)).any()
        return np.sqrt(((shape.interpolate(phantom.samples.shape) - phantom.samples) ** 2).mean())

    adaptive, exchanged = rmse(select="adaptive"), rmse(select="adaptive", exchange=True)
    assert exchanged < 0.95 * adaptive


def test_the_largest_error_is_bounded(phantom):
    gray = phantom.samples.round().clip(0, 255).astype(np.uint8)
    shape = walpha.pipeline(gray, select="adaptive", max_error=40, alpha=1e9)
    off = np.abs(shape.interpolate(gray.shape) - gray)
    assert 20 < off.max() <= 40 and len(shape.points) < gray.size / 2
    few = walpha.pipeline(gray, select="adaptive", target_rmse=20)
    assert len(few.points) < len(shape.points)


@pytest.mark.parametrize("how", [
    {"exchange": True}, {"max_error": 3}, {"target_rmse": 3}, {"select": "best"},
    {"select": "adaptive", "threshold": 9}, {"select": "adaptive", "exchange": True, "max_error": 3},
])
def test_options_of_adaptive_selection_go_together(phantom, how):
    with pytest.raises(ValueError):
        walpha.pipeline(phantom, **how)


def test_an_affine_places_samples(phantom):
    turned = walpha.Volume(
        phantom.samples, spacing=(0.5, 1, 2), origin=(10, 20, 30), direction=[[0, 1, 0], [-1, 0, 0], [0, 0, 1]], space="LPS", unit="mm"
    )
    chosen = walpha.select(turned, count=20)
    x, y, z = walpha.select(phantom.samples, count=20).points.T
    assert np.allclose(chosen.points, (turned.affine @ [x, y, z, np.ones(20)]).T[:, :3])
    assert np.array_equal(phantom.affine, np.eye(4))


def test_what_is_no_volume(phantom):
    for how, message in (
        ({"spacing": (1, 0, 1)}, "above 0"),
        ({"origin": (0, np.nan, 0)}, "origin"),
        ({"direction": [[1, 0], [0, 1]]}, "direction"),
    ):
        with pytest.raises(ValueError, match=message):
            walpha.Volume(phantom.samples, **how)
    with pytest.raises(ValueError, match="three axes"):
        walpha.Volume(np.zeros((3, 3)))


def test_points_are_not_read_as_a_volume(tmp_path):
    path = tmp_path / "points.xyz"
    path.write_text("1 2 3\n4 5 6\n")
    with pytest.raises(ValueError, match="is not a volume; read_points reads"):
        walpha.read(path)


def test_a_part_is_read(phantom):
    part = walpha.read("sample:phantom@32", roi=np.s_[4:20, 8:, :30])
    assert np.array_equal(part.samples, phantom.samples[4:20, 8:, :30]) and part.origin == (0, 8, 4)
    coarse = walpha.read("sample:phantom@32", downsample=4)
    blocks = phantom.samples.reshape(8, 4, 8, 4, 8, 4).mean(axis=(1, 3, 5))
    assert np.allclose(coarse.samples, blocks, atol=1e-3) and coarse.affine[0, 3] == 1.5
    for how, message in (
        ({"roi": np.s_[::2, :, :]}, "steps"),
        ({"roi": np.s_[:-1, :, :]}, "from 0 up"),
        ({"roi": np.s_[1, :, :]}, "three slices"),
        ({"roi": np.s_[:99, :, :]}, "32"),
        ({"downsample": 0}, "downsample=0"),
    ):
        with pytest.raises(ValueError, match=message):
            walpha.read("sample:phantom@32", **how)


@pytest.mark.parametrize("dtype", ["u1", "<i2", ">i2", ">f4", "<f8"])
def test_bare_samples(tmp_path, dtype):
    wanted = np.arange(60).reshape(3, 4, 5).astype(dtype)
    (tmp_path / "bare").write_bytes(b"header!" + wanted.tobytes())
    read = walpha.read(tmp_path / "bare", shape=(3, 4, 5), dtype=dtype, offset=7)
    assert np.array_equal(read.samples, wanted) and read.gray == (dtype == "u1")
    with pytest.raises(ValueError, match="bytes"):
        walpha.read(tmp_path / "bare", shape=(3, 4, 5), dtype=dtype)
    for how in ({"shape": (3, 4, 5)}, {"dtype": dtype}, {"offset": 7}):
        with pytest.raises(ValueError, match="shape= and dtype="):
            walpha.read(tmp_path / "bare", **how)
    with pytest.raises(ValueError, match="complex128"):
        walpha.read(tmp_path / "bare", shape=(3, 4, 5), dtype=complex)


def test_an_array_and_a_frame_of_several(tmp_path):
    first, second = np.random.default_rng(0).random((2, 3, 4, 5))
    np.savez(tmp_path / "two.npz", first=first, second=second)
    for name, wanted in (("first", first), ("second", second)):
        assert np.array_equal(walpha.read(tmp_path / "two.npz", array=name).samples, wanted.astype(np.float32))
    with pytest.raises(ValueError, match="first"):
        walpha.read(tmp_path / "two.npz")


def test_samples_that_are_missing(tmp_path, phantom):
    holed = phantom.samples.copy()
    holed[:, :, :16] = np.nan
    np.save(tmp_path / "holed.npy", holed)
    with pytest.raises(ValueError, match="NaN|nan"):
        walpha.read(tmp_path / "holed.npy")
    assert (walpha.read(tmp_path / "holed.npy", nan=-5).samples[:, :, :16] == -5).all()
    left = walpha.read(tmp_path / "holed.npy", nan=np.nan)
    assert np.array_equal(left.samples, holed, equal_nan=True)
    with pytest.raises(ValueError, match="NaN|nan"):
        walpha.pipeline(left, count=200)
    masked, filled = walpha.pipeline(left, count=200, nan=np.nan), walpha.pipeline(left, count=200, nan=1e4)
    assert masked.points[:, 0].min() >= 16 > filled.points[:, 0].min()


def test_values_below_a_bound_take_no_part(phantom):
    # Between two values, so that their rounding does not matter.
    least, bound = np.unique(phantom.samples)[[-100, -99]]
    bound = float(least + bound) / 2
    above = int((phantom.samples >= bound).sum())
    shape = walpha.pipeline(phantom, count=above, value_min=bound, rms=0)
    assert np.allclose(np.sort(shape.values), np.sort(phantom.samples[phantom.samples >= bound]), atol=1e-3)
    with pytest.raises(ValueError, match=f"{above}"):
        walpha.pipeline(phantom, count=above + 1, value_min=bound, rms=0)


def test_labels_fill_their_voxels():
    z, y, x = np.mgrid[:9, :10, :11]
    labels = ((x - 5) ** 2 + (y - 5) ** 2 + (z - 4) ** 2 < 14).astype(np.int16)
    labels[4, 5, 5] = 0
    labels[2, 3:5, 4] = 7
    whole = walpha.label_shape(labels, spacing=(0.5, 1, 2), origin=(1, 2, 3))
    assert whole.voxels == np.count_nonzero(labels) and whole.volume == whole.voxels
    assert whole.betti == (1, 0, 1) and whole.alpha_origin == "labels"
    assert set(whole.values) <= {1, 7} and "of labels" in repr(whole)
    assert walpha.check(whole) and walpha.check(whole).verdict == "exact"
    for seven in (walpha.label_shape(labels, 7), walpha.label_shape(labels == 7), walpha.label_shape(labels, [7])):
        assert seven.voxels == 2 and np.array_equal(seven.points.min(0), [3.5, 2.5, 1.5])
    again = pickle.loads(pickle.dumps(whole))
    assert same(again, whole) and again.voxels == whole.voxels and np.array_equal(again.values, whole.values)
    assert again.alpha_origin == "labels"


def test_an_isosurface_has_a_solid_inside():
    z, y, x = np.mgrid[:20, :21, :22]
    ball = 100 + 8 - np.sqrt((x - 10.3) ** 2 + (y - 10.1) ** 2 + (z - 9.7) ** 2)
    solid = walpha.surface_shape(ball, 100, spacing=(0.5, 1, 2), origin=(1, 2, 3))
    assert abs(solid.volume / (4 / 3 * np.pi * 8**3) - 1) < 0.02
    assert solid.betti == (1, 0, 0) and (solid.isovalue, solid.alpha_origin) == (100, "surface")
    assert "inside the isosurface at 100" in repr(solid) and solid.voxels is None
    at_surface = np.unique(solid.facets[solid.facet_classes == walpha.Class.REGULAR])
    assert np.all(solid.values >= 100) and np.all(solid.values[at_surface] == 100)
    judged = walpha.check(solid)
    assert not judged and judged.verdict == "exact as far as judged" and not judged.findings
    # A pickle is of the samples as they were.
    samples = ball.astype(np.float32)
    frozen = walpha.surface_shape(samples, 100, closed=True)
    of_volume = walpha.surface_shape(walpha.Volume(samples.copy(), spacing=(1, 2, 1)), 100)
    samples[:] = 0
    for one in (solid, frozen, of_volume, frozen.keep("largest")):
        again = pickle.loads(pickle.dumps(one))
        assert same(again, one) and again.betti == (1, 0, 0)
        for name in ("points", "values", "isovalue", "volume", "alpha_origin", "kept"):
            assert np.array_equal(getattr(again, name), getattr(one, name)), name
    # Two classes, of which the surface lies between.
    two = np.where(ball > 104, 50.0, 10.0)
    assert 10 < walpha.surface_shape(two, "auto").isovalue < 50
    masked = np.where(ball > 107, np.nan, ball)
    assert walpha.surface_shape(masked, 100, nan=np.nan).betti == (1, 0, 1)
    assert walpha.surface_shape(masked, 100, nan=np.nan, closed=True).betti == (1, 0, 0)
    with pytest.raises(ValueError, match="no sample reaches the value 200: the largest is 10"):
        walpha.surface_shape(ball, 200)
    with pytest.raises(ValueError, match="two or more along each axis"):
        walpha.surface_shape(ball[:1], 100)
    with pytest.raises(ValueError, match="is not a value"):
        walpha.surface_shape(ball, "much")


def test_labels_that_are_none_are_refused():
    with pytest.raises(ValueError, match="no voxel has the label 3; there are 1"):
        walpha.label_shape(np.ones((2, 2, 2), int), 3)
    with pytest.raises(ValueError, match="whole numbers"):
        walpha.label_shape(np.full((2, 2, 2), 0.5))
    with pytest.raises(ValueError, match="the background"):
        walpha.label_shape(np.zeros((2, 2, 2)))
    with pytest.raises(ValueError, match="renumber"):
        walpha.label_shape(np.full((2, 2, 2), 1 << 25))
    with pytest.raises(TypeError):
        walpha.label_shape(np.ones((2, 2, 2)), 1.5)


def test_a_ct_is_taken_as_the_command_takes_it():
    ct = walpha.read("sample:ct")
    with pytest.warns(UserWarning, match="look like Hounsfield units"):
        shape = walpha.pipeline(ct)
    stated = walpha.pipeline(ct, gray=(0, 1000), gray_min=64, threshold=30, rms=4)
    assert same(shape, stated) and abs(shape.volume - 709169.34) < 0.01
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert walpha.pipeline(ct, count=2000).volume != shape.volume
