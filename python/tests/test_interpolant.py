import numpy as np
import pytest

import walpha


def linear(places):
    return places @ np.array([1.0, -2.0, 3.0]) + 0.5


def test_a_linear_function_is_its_own_interpolant(cloud):
    shape = walpha.alpha_shape(cloud, alpha=np.inf, values=linear(cloud))
    places = np.random.default_rng(3).random((500, 3)) * 0.6 + 0.2
    assert np.allclose(shape.at(places), linear(places), atol=1e-12)
    assert np.array_equal(shape.at(cloud), linear(cloud))
    assert np.allclose(shape.at(places, values=np.ones(600)), 1, atol=1e-12)
    assert np.isnan(shape.at([[5, 5, 5], [np.nan, 0, 0]])).all()


def test_a_grid_is_z_y_x(cloud):
    shape = walpha.alpha_shape(cloud, alpha=np.inf, values=linear(cloud))
    grid = shape.interpolate((5, 4, 3), low=[0.4, 0.3, 0.2], high=[0.6, 0.6, 0.6])
    assert grid.shape == (5, 4, 3) and grid.dtype == np.float32
    z, y, x = np.meshgrid(np.linspace(0.2, 0.6, 5), np.linspace(0.3, 0.6, 4), np.linspace(0.4, 0.6, 3), indexing="ij")
    assert np.allclose(grid, linear(np.stack([x, y, z], axis=-1)), atol=1e-6)


def test_outside_is_nan(hollow):
    shape = walpha.alpha_shape(hollow, alpha=0.75, values=np.ones(len(hollow)))
    grid = shape.interpolate((7, 7, 7))
    assert np.isnan(grid[2:5, 2:5, 2:5]).all() and np.isnan(grid).sum() == 27
    assert (grid[~np.isnan(grid)] == 1).all()


@pytest.mark.parametrize("box", [((0, 5, 5), {}), ((5, 5, 5), {"low": [0, 0]}), ((5, 5, 5), {"high": [0, 0, np.inf]})])
def test_grids_that_make_no_sense(cloud, box):
    shape = walpha.alpha_shape(cloud, alpha=1, values=cloud[:, 0])
    with pytest.raises(ValueError):
        shape.interpolate(box[0], **box[1])
