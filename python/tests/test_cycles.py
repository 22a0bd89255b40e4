import numpy as np
import pytest

import walpha


def ring(count=40, noise=0.05, seed=0):
    rng = np.random.default_rng(seed)
    angles = rng.random(count) * 2 * np.pi
    return np.c_[np.cos(angles), np.sin(angles), np.zeros(count)] + noise * rng.normal(size=(count, 3))


def closed(edges, coefficients):
    ends = np.zeros(edges.max() + 1)
    np.add.at(ends, edges[:, 1], coefficients)
    np.add.at(ends, edges[:, 0], -coefficients)
    return not ends.any()


def test_the_loop_of_a_ring():
    filtration = walpha.filtration(ring())
    loops = filtration.cycles(1)
    longest = loops[0]
    diagram = filtration.simplices().persistence(1)
    assert longest.death - longest.birth == (diagram[:, 1] - diagram[:, 0]).max()
    # It goes round the origin once.
    x, y = longest.path[:, 0], longest.path[:, 1]
    turns = np.diff(np.unwrap(np.arctan2(y, x))).sum() / (2 * np.pi)
    assert abs(turns) == pytest.approx(1) and (longest.path[0] == longest.path[-1]).all()
    assert (filtration.points[longest.walk] == longest.path[:-1]).all()
    assert all(closed(loop.edges, loop.coefficients) for loop in loops)
    assert len(loops) == min(100, len(diagram))
    values = filtration.simplices().values
    for loop in loops:
        assert values[loop.pair[0]] == loop.birth and values[loop.pair[1]] == loop.death
    again = filtration.cycle(longest.pair)
    assert (again.walk == longest.walk).all() and again.pair == longest.pair
    some = filtration.cycles(1, minimum=0.02)
    assert [loop.pair for loop in some] == [loop.pair for loop in loops if loop.death - loop.birth >= 0.02]


def test_the_void_of_a_sphere():
    rng = np.random.default_rng(2)
    points = rng.normal(size=(300, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    filtration = walpha.filtration(points)
    void = filtration.cycles(2)[0]
    assert void.death == pytest.approx(1) and len(void.facets) > 400
    a, b, c = np.moveaxis(void.corners, 1, 0)
    volume = np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6
    corners = points[void.cells]
    cells = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6
    assert volume == pytest.approx(cells) and 3.5 < volume < 4.19
    assert (filtration.cycle(void.pair).facets == void.facets).all()


def test_loops_that_wind_round_a_box():
    filtration = walpha.filtration([[0, 0, 0]], periodic=(1, 2, 3))
    loops = [loop for loop in filtration.cycles(1) if loop.death == np.inf]
    assert sorted(tuple(np.abs(loop.path[-1] - loop.path[0])) for loop in loops) == [(0, 0, 3), (0, 2, 0), (1, 0, 0)]
    assert (filtration.cycle([loops[0].pair[0]]).walk == [0]).all()


def test_what_is_not_a_pair_is_refused():
    filtration = walpha.filtration(ring())
    with pytest.raises(ValueError, match="not a pair"):
        filtration.cycle((0, 1))
    with pytest.raises(ValueError, match="dimension=0"):
        filtration.cycles(0)
    with pytest.raises(ValueError, match="pair="):
        filtration.cycle([])
    with pytest.raises(ValueError, match="minimum=-1"):
        filtration.cycles(1, minimum=-1)
