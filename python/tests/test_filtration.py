import numpy as np
import pytest

import walpha

from test_shape import same


@pytest.mark.parametrize("weighted", [False, True])
def test_each_shape_is_that_of_alpha_shape(cloud, weights, weighted):
    weights = weights if weighted else None
    filtration = walpha.filtration(cloud, weights)
    for alpha in (-0.001, 0, 0.001, 0.004, 0.02, np.inf):
        shape = filtration.shape(alpha)
        wanted = walpha.alpha_shape(cloud, weights, alpha)
        assert same(shape, wanted) and shape.betti == wanted.betti and shape.volume == wanted.volume
    assert same(filtration.whole(), filtration.shape(np.inf))


def test_levels_and_voids(hollow):
    filtration = walpha.filtration(hollow)
    levels = filtration.levels([4, 0.75, 0.25, 0.75])
    assert [level.alpha for level in levels] == [0.25, 0.75, 4] and [level.betti.b2 for level in levels] == [0, 1, 0]
    (void,) = filtration.voids(0.75)
    assert void == levels[1].voids[0] and np.isclose(levels[1].volume + void.volume, 216)
    assert filtration.voids(void.filling_alpha) == []
    assert filtration.voids(np.nextafter(void.filling_alpha, 0)) != []
    assert levels[1].facets["regular"] == (filtration.shape(0.75).facet_classes == walpha.Class.REGULAR).sum()


def test_the_curve_ends_in_the_hull(cloud):
    curve = walpha.filtration(cloud).betti_curve()
    assert (np.diff(curve.alpha) > 0).all() and len(set(map(len, curve))) == 1
    assert (curve.b0[0], curve.b0[-1], curve.b1[-1], curve.b2[-1]) == (600, 1, 0, 0)
    assert curve.solid_components[-1] == 1


def test_optimal_alpha_is_the_smallest(cloud):
    filtration = walpha.filtration(cloud)
    alphas = [filtration.optimal_alpha(most) for most in (1, 2, 5)]
    assert alphas == sorted(alphas, reverse=True)
    for most, alpha in zip((1, 2, 5), alphas):
        at, before = filtration.levels([np.nextafter(alpha, 0), alpha])[::-1]
        solid = lambda level: level.solid_components <= most and len(np.unique(filtration.shape(level.alpha).cells)) == 600  # noqa: E731
        assert solid(at) and not solid(before)
    assert filtration.suggestions().one_region == alphas[0]
    with pytest.raises(ValueError, match="components=0"):
        filtration.optimal_alpha(0)


def test_suggestions_are_ordered(cloud):
    found = walpha.filtration(cloud).suggestions()
    assert found.all_points <= found.one_region <= found.no_void and found.plateau[0] < found.plateau[1]


def test_alpha_is_needed(cloud):
    with pytest.raises(ValueError, match="optimal_alpha"):
        walpha.filtration(cloud).shape()
    with pytest.raises(ValueError, match="optimal_alpha"):
        walpha.filtration(cloud).shape("auto")
