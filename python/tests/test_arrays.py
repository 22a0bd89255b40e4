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
    wanted = walpha.alpha_shape(cloud, weights, 0.003)
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
        assert same(walpha.alpha_shape(given, weights, 0.003), wanted)
    assert same(walpha.alpha_shape(cloud, weights[::-1].copy()[::-1], 0.003), wanted)


def test_input_is_left_alone(cloud):
    before = cloud.copy()
    cloud.flags.writeable = False
    walpha.alpha_shape(cloud, alpha=0.01)
    assert np.array_equal(cloud, before)


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
        walpha.alpha_shape(cloud, [1, 2, 3], 1)
    with pytest.raises(ValueError, match="3 values for 600 points"):
        walpha.alpha_shape(cloud, alpha=1, values=[1, 2, 3])
    with pytest.raises(ValueError, match="weights has 2 axes"):
        walpha.alpha_shape(cloud, cloud, 1)
