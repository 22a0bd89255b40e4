import itertools
import pickle

import numpy as np
import pytest

import walpha

LATTICE = np.array(list(itertools.product(range(4), repeat=3)), float)
BCC = np.vstack([LATTICE, LATTICE + 0.5])


def test_a_lattice_fills_the_torus():
    shape = walpha.alpha_shape(BCC, alpha=0.3125, periodic=4)
    assert shape.betti == walpha.TorusBetti(1, 3, 3, 1) and shape.volume == 64 and shape.area == 0
    assert shape.periodic == (4, 4, 4) and "betti (1, 3, 3, 1)" in repr(shape)
    assert [part.rounds for part in shape.components] == [3]
    assert walpha.check(shape)
    # Each cell once, and its corners the copies nearest to the first.
    assert len(shape.cells) == 6 * len(BCC)
    corners = shape.points[shape.cells]
    corners -= 4 * np.round((corners - corners[:, :1]) / 4)
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    assert (volumes > 0).all() and np.isclose(volumes.sum(), 64)


def test_moving_all_points_changes_nothing():
    still = walpha.alpha_shape(LATTICE, alpha=0.5, periodic=(4, 4, 4))
    moved = walpha.alpha_shape(LATTICE + [5, -2, 0.25], alpha=0.5, periodic=(4, 4, 4))
    assert np.array_equal(still.facets, moved.facets) and still.betti == moved.betti
    assert (moved.points >= 0).all() and (moved.points < 4).all()


def test_a_layout_in_space():
    shape = walpha.alpha_shape(BCC, alpha=0.29, periodic=4, exterior=True)
    flat = shape.unwrapped()
    assert flat.periodic is None and len(flat.points) == len(BCC) + len(flat.copies)
    at = flat.points[len(BCC) :]
    assert np.array_equal(np.mod(at, 4), shape.points[flat.copies])
    with pytest.raises(ValueError, match="solid=False"):
        shape.boundary()
    assert len(shape.boundary(solid=False).triangles) == (shape.facet_classes == walpha.Class.REGULAR).sum()
    with pytest.raises(ValueError, match="periodic box"):
        shape.at([[0, 0, 0]], values=np.zeros(len(BCC)))


def test_a_filtration_of_a_torus():
    rng = np.random.default_rng(3)
    points, weights = rng.random((400, 3)), rng.random(400) * 0.002
    filtration = walpha.filtration(points, weights=weights, periodic=1)
    curve = filtration.betti_curve()
    assert (curve.b0[-1], curve.b1[-1], curve.b2[-1], curve.b3[-1]) == (1, 3, 3, 1)
    for k in range(0, len(curve.alpha), len(curve.alpha) // 7):
        shape = walpha.alpha_shape(points, curve.alpha[k], weights=weights, periodic=1)
        assert shape.betti == (curve.b0[k], curve.b1[k], curve.b2[k], curve.b3[k])
        assert np.array_equal(shape.cells, filtration.shape(curve.alpha[k]).cells)
    simplices = filtration.simplices()
    assert [len(numbers) for numbers in simplices.lasting] == [1, 3, 3, 1]


def test_gudhi_finds_the_torus():
    pytest.importorskip("gudhi")
    rng = np.random.default_rng(5)
    filtration = walpha.filtration(rng.random((250, 3)), periodic=(1, 1, 1.25))
    tree = filtration.simplex_tree()
    tree.compute_persistence(homology_coeff_field=11, persistence_dim_max=True)
    assert tree.betti_numbers() == [1, 3, 3, 1]
    curve = filtration.betti_curve()
    for k in range(0, len(curve.alpha), len(curve.alpha) // 9):
        # Values are the nearest doubles, so half way to the next.
        at = curve.alpha[k] / 2 + curve.alpha[min(k + 1, len(curve.alpha) - 1)] / 2
        found = [len([0 for b, d in tree.persistence_intervals_in_dimension(n) if b <= at < d]) for n in range(4)]
        assert found == [curve.b0[k], curve.b1[k], curve.b2[k], curve.b3[k]]


@pytest.mark.parametrize(
    ("sides", "words"),
    [((1, 1), "three sides|sides of the box"), ((1, 1, -1), "along z"), ((1, 1, np.nan), "along z")],
)
def test_bad_boxes_are_refused(sides, words):
    points = np.random.default_rng(1).random((50, 3))
    with pytest.raises(ValueError, match=words):
        walpha.alpha_shape(points, alpha=1, periodic=sides)


FCC = 2 * (1 - np.eye(3))


def test_a_lone_point_in_a_slanted_box():
    shape = walpha.alpha_shape([[0, 0, 0]], alpha=np.inf, periodic=FCC, exterior=True)
    assert shape.betti == walpha.TorusBetti(1, 3, 3, 1) and shape.volume == 16
    assert [len(rows) for rows in (shape.cells, shape.facets, shape.edges, shape.vertices)] == [6, 12, 7, 1]
    assert "1 points" in repr(shape) and len(shape.points) == 1 + len(shape.copies) and set(shape.copies) == {0}
    # Rows name copies, and their corners are where these are.
    assert np.array_equal(shape.points[1:], shape.shifts @ np.array(shape.periodic))
    corners = shape.points[shape.cells]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    assert (volumes > 0).all() and np.isclose(volumes.sum(), 16) and (shape.cells[:, 0] == 0).all()
    assert walpha.check(shape)
    back = pickle.loads(pickle.dumps(shape))
    assert np.array_equal(back.points, shape.points) and np.array_equal(back.cells, shape.cells)


def test_filtrations_and_balls_of_small_boxes():
    filtration = walpha.filtration([[0, 0, 0]], periodic=FCC)
    simplices = filtration.simplices()
    assert [len(numbers) for numbers in simplices.lasting] == [1, 3, 3, 1] and len(simplices) == 26
    suggested = filtration.suggestions()
    assert suggested.no_void >= suggested.one_region == 4
    assert pickle.loads(pickle.dumps(filtration)).simplices().values.tolist() == simplices.values.tolist()
    assert len(filtration.copies) == len(filtration.shifts) > 0
    with pytest.raises(ValueError, match="repeat the points"):
        filtration.simplex_tree()
    # Twelve neighbours at √8: of each, half of a lens.
    balls = walpha.alpha_shape([[0, 0, 0]], alpha=1.5**2, periodic=FCC).balls
    height = 1.5 - np.sqrt(2)
    expected = 4 / 3 * np.pi * 1.5**3 - 12 * np.pi * height**2 * (3 * 1.5 - height) / 3
    assert abs(balls.volume.value - expected) < 1e-12 and len(balls.volumes.values) == 1
    assert balls.contacts.pairs.tolist() == [[0, 0]] * 6


def test_power_cells_fill_the_box():
    rng = np.random.default_rng(5)
    vectors = np.array([[4, 0, 0], [1, 3.5, 0], [-0.5, 0.25, 5]])
    points = rng.random((300, 3)) @ vectors
    made = walpha.periodic_power_diagram(points, vectors, rng.random(300) * 0.1)
    assert np.isclose(made.volumes.sum(), np.linalg.det(vectors))
    assert len(made.facets) == len(made.shifts) == len(made.areas) > 1500 and (made.areas > 0).all()
    # The volume of each cell from the pyramids over its facets, as without weights half of the way is the height.
    made = walpha.periodic_power_diagram(points, vectors)
    ends = points[made.facets]
    # Points were in the box of the given vectors, and shifts are of reduced ones: of the same length here.
    assert np.allclose(made.vectors, vectors)
    inside = ends - np.floor(ends @ np.linalg.inv(vectors)) @ vectors
    way = inside[:, 1] + made.shifts @ made.vectors - inside[:, 0]
    pyramids = made.areas * np.linalg.norm(way, axis=1) / 6
    volumes = np.bincount(made.facets.ravel(), np.repeat(pyramids, 2), minlength=300)
    assert np.allclose(volumes, made.volumes)
    # Without a side to repeat along, cells have no end.
    slab = walpha.periodic_power_diagram(points, vectors * [[1], [1], [0]])
    assert np.isinf(slab.volumes).any() and np.isfinite(slab.volumes).any()
    assert slab.walls is None
    for wrong in [{"weights": [1]}, {"points": np.full((3, 3), np.nan)}, {"points": np.empty((0, 3))}, {"periodic": None}]:
        with pytest.raises(ValueError):
            walpha.periodic_power_diagram(**{"points": points, "periodic": vectors, **wrong})


def test_power_cells_end_at_walls():
    """Each cell is an intersection of half-spaces, whose volume qhull finds."""
    from scipy.optimize import linprog
    from scipy.spatial import ConvexHull, HalfspaceIntersection

    rng = np.random.default_rng(6)
    vectors = np.array([[2.0, 0, 0], [0.5, 1.75, 0], [0, 0, 0]])
    points = np.column_stack([rng.random((40, 2)) @ vectors[:2, :2], rng.random(40)])
    # Some on the walls.
    points[:6, 2] = [0, 0, 0, 1, 1, 1]
    weights = rng.random(40) * 0.02
    made = walpha.periodic_power_diagram(points, vectors, weights, walls=[[0, 0, 0], [9, 9, 1]])
    assert np.isclose(made.volumes.sum(), 2 * 1.75)
    assert np.allclose(made.walls.sum(axis=0), [[0, 0, 3.5]] * 2) and made.walls.shape == (40, 2, 3)
    shifts = np.array([[i, j, 0] for i in range(-2, 3) for j in range(-2, 3)])
    copies = (points[None] + (shifts @ vectors)[:, None]).reshape(-1, 3)
    of_copies = np.tile(weights, len(shifts))
    for at in range(40):
        way = copies - points[at]
        other = (way != 0).any(axis=1)
        # 2 x · (q - p) ≤ |q|² - ω_q - |p|² + ω_p
        limit = (copies**2).sum(axis=1) - of_copies - points[at] @ points[at] + weights[at]
        sides = np.column_stack([2 * way, -limit])[other]
        sides = np.vstack([sides, [[0, 0, -1, 0], [0, 0, 1, -1]]])
        # The largest ball inside.
        reach = np.column_stack([sides[:, :3], np.linalg.norm(sides[:, :3], axis=1)])
        *centre, radius = linprog([0, 0, 0, -1], A_ub=reach, b_ub=-sides[:, 3], bounds=[(None, None)] * 3 + [(0, None)]).x
        assert radius > 1e-6
        corners = HalfspaceIntersection(sides, np.array(centre)).intersections
        assert np.isclose(ConvexHull(corners).volume, made.volumes[at]), at
    # Facets and walls close each cell.
    sums = np.zeros((40, 3))
    inside = points.copy()
    inside[:, :2] -= np.floor(points[:, :2] @ np.linalg.inv(vectors[:2, :2])) @ vectors[:2, :2]
    assert np.allclose(made.vectors[:2], vectors[:2])
    way = inside[made.facets[:, 1]] + made.shifts @ made.vectors - inside[made.facets[:, 0]]
    pull = way * (made.areas / np.linalg.norm(way, axis=1))[:, None]
    np.add.at(sums, made.facets[:, 0], pull)
    np.add.at(sums, made.facets[:, 1], -pull)
    assert np.allclose(sums + made.walls[:, 1] - made.walls[:, 0], 0, atol=1e-9)
    for wrong in [{"walls": [[0, 0, 0]]}, {"walls": [[0, 0, 1], [0, 0, 0]]}, {"walls": [[0, 0, 0.5], [0, 0, 1]]}, {"periodic": (2, 2, 2)}, {"periodic": vectors + [[0, 0, 0], [0, 0, 1], [0, 0, 0]]}]:
        with pytest.raises(ValueError):
            walpha.periodic_power_diagram(**{"points": points, "periodic": vectors, "walls": [[0, 0, 0], [0, 0, 1]], **wrong})


def test_pores_of_balls():
    # A simple cubic lattice, and the same cell twice: channels in all directions.
    one = walpha.pores([[0, 0, 0]], 1, [0.3], probe=0.2)
    two = walpha.pores([[0, 0, 0], [1, 0, 0]], (2, 1, 1), [0.3, 0.3], probe=0.2)
    assert np.isclose(one.included.diameter, 3**0.5 - 0.6) and np.isclose(one.free.diameter, 2**0.5 - 0.6)
    assert one.included.diameter == two.included.diameter and one.channels == two.channels == (3,)
    assert abs(one.void_fraction.value - (1 - 4 / 3 * np.pi * 0.125)) <= one.void_fraction.bound
    assert one.pockets == 0
    # A probe that cannot pass the windows stays in its pocket.
    assert walpha.pores([[0, 0, 0]], 1, [0.3], probe=0.45).channels == ()
    assert walpha.pores([[0, 0, 0]], 1, [0.3], probe=0.45).pockets == 1
    # Of two radii: the largest sphere on a fine grid is hardly smaller.
    rng = np.random.default_rng(7)
    points, radii = rng.random((12, 3)) * 4, rng.uniform(0.2, 1.0, 12)
    steps = (np.arange(64) + 0.5) / 16
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    way = grid[:, None] - points
    way -= 4 * np.round(way / 4)
    best = 2 * (np.linalg.norm(way, axis=2) - radii).min(axis=1).max()
    assert best <= walpha.pores(points, 4, radii).included.diameter < best + 2 * 3**0.5 / 32
    found = walpha.pores(BCC, 4)
    assert found.channels is found.pockets is found.void_fraction is None and found.included.center.shape == (3,)
    for wrong in [{"radii": [-1.0]}, {"radii": [1, 2]}, {"probe": -1}, {"probe": np.inf}, {"periodic": (1, 1, 0)}, {"periodic": None}]:
        with pytest.raises(ValueError):
            walpha.pores(**{"points": [[0, 0, 0]], "periodic": 1, **wrong})


def test_sides_of_0_do_not_repeat():
    points = np.random.default_rng(2).random((60, 3))
    for box in [(1, 1, 0), np.diag([1, 1, 0]), [[1, 0.2, 0], [0, 1, 0], [0, 0, 0]]]:
        shape = walpha.alpha_shape(points, 0.05, periodic=box)
        same = walpha.filtration(points, periodic=box).shape(0.05)
        assert shape.betti == same.betti and len(shape.cells) == len(same.cells) > 0
        assert np.isclose(shape.volume, same.volume)
    many = walpha.alpha_shapes([points], 0.05, periodic=(1, 1, 0))
    assert many[0].betti == walpha.alpha_shape(points, 0.05, periodic=(1, 1, 0)).betti
