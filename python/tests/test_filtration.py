import itertools
import pickle

import numpy as np
import pytest

import walpha

from test_shape import same


@pytest.mark.parametrize("weighted", [False, True])
def test_each_shape_is_that_of_alpha_shape(cloud, weights, weighted):
    weights = weights if weighted else None
    filtration = walpha.filtration(cloud, weights=weights)
    for alpha in (-0.001, 0, 0.001, 0.004, 0.02, np.inf):
        shape = filtration.shape(alpha)
        wanted = walpha.alpha_shape(cloud, alpha, weights=weights)
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


def test_simplices_come_in_exact_order(cloud, weights):
    filtration = walpha.filtration(cloud, weights=weights)
    simplices = filtration.simplices()
    whole = filtration.whole()
    counts = [len(whole.vertices), len(whole.edges), len(whole.facets), len(whole.cells)]
    assert [len(simplices.vertices), len(simplices.edges), len(simplices.facets), len(simplices.cells)] == counts
    assert len(simplices) == sum(counts) and sorted(simplices.order) == list(range(len(simplices)))
    assert (np.diff(simplices.ranks[simplices.order].astype(int)) >= 0).all()
    assert (np.diff(simplices.values[simplices.order]) >= 0).all()
    seen = set()
    for vertices, value in simplices:
        assert all(face in seen for face in itertools.combinations(vertices, len(vertices) - 1) if face)
        seen.add(vertices)
    assert simplices.gabriel[-counts[3] :].all() and (simplices.regular[-counts[3] :] == np.inf).all()
    assert filtration.simplices() is simplices


def test_gudhi_agrees(cloud, weights):
    gudhi = pytest.importorskip("gudhi")
    filtration = walpha.filtration(cloud, weights=weights)
    theirs = gudhi.AlphaComplex(cloud, weights=weights, precision="exact").create_simplex_tree()
    ours = filtration.simplex_tree()
    values = dict((tuple(s), v) for s, v in ours.get_filtration())
    other = dict((tuple(s), v) for s, v in theirs.get_filtration())
    assert values.keys() == other.keys()
    # GUDHI rounds its exact values within a share of them; those of flat cells are large.
    assert all(values[s] == pytest.approx(other[s], rel=1e-9, abs=1e-12) for s in values)
    assert not ours.make_filtration_non_decreasing()
    ours.compute_persistence(persistence_dim_max=True)
    for dimension in (0, 1, 2):
        found = np.array(ours.persistence_intervals_in_dimension(dimension))
        known = filtration.simplices().persistence(dimension)
        assert len(known) > 5 and np.array_equal(sorted(found.tolist()), sorted(known.tolist()))
    ranked = filtration.simplex_tree(ranks=True)
    assert set(v for _, v in ranked.get_filtration()) == set(map(float, filtration.simplices().ranks))
    with pytest.raises(ValueError, match="dimension=3"):
        filtration.simplices().persistence(3)


@pytest.mark.parametrize("seed", range(40))
def test_gudhi_pairs_the_same_ranks(seed):
    pytest.importorskip("gudhi")
    rng = np.random.default_rng(seed)
    # Full of ties: points of a lattice with weights that hide some, and in every fourth set of one plane.
    points = np.unique(rng.integers(0, 5, (60, 3)), axis=0).astype(float)
    points[:, 2] *= seed % 4 != 0
    points = np.unique(points, axis=0)
    filtration = walpha.filtration(points, weights=rng.integers(0, 3, len(points)) / 2)
    tree = filtration.simplex_tree(ranks=True)
    tree.compute_persistence(homology_coeff_field=2, persistence_dim_max=True)
    simplices = filtration.simplices()
    for dimension, pairs in enumerate((simplices.component_pairs, simplices.loop_pairs, simplices.void_pairs)):
        ranks = simplices.ranks[pairs]
        ours = sorted(ranks[ranks[:, 0] != ranks[:, 1]].tolist())
        theirs = tree.persistence_intervals_in_dimension(dimension)
        assert ours == sorted(theirs[np.isfinite(theirs).all(axis=1)].tolist()) if len(theirs) else ours == []
    # The form in which GUDHI's landscapes and images take diagrams.
    selector = pytest.importorskip("gudhi.representations").DiagramSelector(use=True)
    (finite,) = selector.fit_transform([simplices.persistence(1)])
    assert len(finite) == sum(dimension == 1 for dimension, _ in simplices.persistence_diagram())


def test_dionysus_agrees(hollow):
    dionysus = pytest.importorskip("dionysus")
    filtration = walpha.filtration(hollow)
    made = filtration.dionysus()
    assert [tuple(simplex) for simplex in made] == [vertices for vertices, _ in filtration.simplices()]
    diagrams = dionysus.init_diagrams(dionysus.homology_persistence(made), made)
    voids = sorted((point.birth, point.death) for point in diagrams[2])
    assert voids == sorted(map(tuple, filtration.simplices().persistence(2)))


def test_points_of_a_plane(cloud):
    flat = walpha.alpha_shape(cloud[:, :2], alpha=np.inf)
    assert len(flat.cells) == 0 and (flat.facet_classes == walpha.Class.SINGULAR).any()
    assert np.array_equal(flat.points[:, :2], cloud[:, :2]) and (flat.points[:, 2] == 0).all()
    filtration = walpha.filtration(cloud[:, :2])
    assert len(filtration.shape(np.inf).cells) == 0
    assert np.array_equal(filtration.shape(np.inf).facets, flat.facets)
    some = filtration.shape(filtration.optimal_alpha())
    assert 0 < len(some.facets) <= len(flat.facets) and walpha.check(some).verdict == "exact"


def test_derivatives_are_limits_of_differences(cloud, weights):
    """Of all values, by a position and a weight."""
    cloud, weights, step = cloud[:40], weights[:40], 1e-7

    def values(moved):
        simplices = walpha.filtration(moved[:, :3], weights=moved[:, 3]).simplices()
        return {row: value for row, value in simplices}

    given = np.column_stack([cloud, weights])
    filtration = walpha.filtration(cloud, weights=weights)
    simplices = filtration.simplices()
    rows = [tuple(row) for table in simplices._tables() for row in table.tolist()]
    assert (simplices.gabriel_simplices == np.arange(len(rows)))[simplices.gabriel].all()
    assert (simplices.gabriel_simplices != np.arange(len(rows)))[~simplices.gabriel].all() and not simplices.gabriel.all()
    assert (simplices.ranks[simplices.gabriel_simplices] == simplices.ranks).all()
    for axis in range(4):
        low, high = given.copy(), given.copy()
        low[3, axis] -= step
        high[3, axis] += step
        low, high = values(low), values(high)
        compared = 0
        for number, row in enumerate(rows):
            source = rows[simplices.gabriel_simplices[number]]
            if row not in low or row not in high or 3 not in source or simplices.values[number] > 1:
                continue
            positions, of_weights = filtration.derivatives([source])
            assert positions.shape == (1, len(source), 3) and of_weights.shape == (1, len(source))
            found = np.append(positions[0, source.index(3)], of_weights[0, source.index(3)])[axis]
            assert found == pytest.approx((high[row] - low[row]) / (2 * step), rel=1e-3, abs=1e-3)
            compared += 1
        assert compared > 10


@pytest.mark.parametrize("simplices", [[0, 1], [[0, 1, 2, 3, 4]], [[0, 9]], [[-1, 0]], [[0.0, 1.0]]])
def test_derivatives_of_what_is_no_simplex(simplices):
    with pytest.raises(ValueError, match="simplices has"):
        walpha.filtration([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).derivatives(simplices)


def test_derivatives_of_nothing():
    filtration = walpha.filtration([[0, 0, 0], [1, 0, 0]])
    positions, weights = filtration.derivatives(np.empty((0, 3), dtype=int))
    assert positions.shape == (0, 3, 3) and weights.shape == (0, 3)


def test_loops_are_found_for_those_who_ask(cloud):
    stages = set()
    simplices = walpha.filtration(cloud).simplices(progress=lambda stage, done, total: stages.add(stage))
    assert stages == {"order"}
    assert len(simplices.persistence(0)) > 0 and len(simplices.persistence(2)) > 0
    assert not {"loop_pairs", "_lasting_loops"} & set(vars(simplices))
    assert len(simplices.persistence(1)) > 0 and "loop_pairs" in vars(simplices)


def test_slanted_boxes():
    """Points of a box along the axes, in one that is slanted by whole units."""
    points = np.stack(np.meshgrid(*[np.arange(5.0)] * 3), axis=-1).reshape(-1, 3)
    straight = walpha.alpha_shape(points, alpha=0.75, periodic=5)
    vectors = ((5.0, 0.0, 0.0), (1.0, 5.0, 0.0), (0.0, -1.0, 5.0))
    slanted = walpha.alpha_shape(points, alpha=0.75, periodic=vectors)
    assert straight.periodic == (5.0, 5.0, 5.0) and slanted.periodic == vectors
    assert slanted.volume == straight.volume == 125.0 and slanted.betti == straight.betti
    filtration = walpha.filtration(points, periodic=np.array(vectors))
    assert filtration.periodic == vectors and "5 × 5.099 × 5.099, slanted" in filtration._repr_html_()
    again = pickle.loads(pickle.dumps(filtration))
    assert again.periodic == vectors and np.array_equal(again.points, filtration.points)
    assert walpha.check(slanted).verdict.startswith("exact")
    for wrong in ([[1, 2, 3]], [1, 2], np.ones((3, 3))):
        with pytest.raises(ValueError, match="periodic"):
            walpha.alpha_shape(points, alpha=1, periodic=wrong)


def smallest_ball(corners):
    """The squared radius of the smallest ball around a few points: that of the smallest circumscribed one which holds all."""
    found = []
    for count in range(1, len(corners) + 1):
        for some in itertools.combinations(corners, count):
            first, rest = some[0], np.array(some[1:]).reshape(-1, 3) - some[0]
            # The centre is in their span.
            along = np.linalg.lstsq(2 * rest @ rest.T, (rest**2).sum(axis=1), rcond=None)[0] @ rest
            squares = ((corners - first - along) ** 2).sum(axis=1)
            if squares.max() <= (along**2).sum() * (1 + 1e-9):
                found.append(squares.max())
    return min(found)


def test_cech_values_are_those_of_smallest_balls(cloud):
    simplices = walpha.filtration(cloud[:150]).simplices()
    values = simplices.cech_values
    assert (values <= simplices.values).all() and 0.1 < (values < simplices.values).mean() < 0.9
    tables = [row for table in simplices._tables() for row in table]
    for number in range(0, len(tables), 7):
        assert values[number] == pytest.approx(smallest_ball(cloud[tables[number]]), rel=1e-9, abs=1e-30)


def test_cech_values_have_the_same_persistence(cloud):
    gudhi = pytest.importorskip("gudhi")
    points = cloud[:200]
    simplices = walpha.filtration(points).simplices()
    tree, first = gudhi.SimplexTree(), 0
    for table in simplices._tables():
        for row, value in zip(table.tolist(), simplices.cech_values[first:]):
            tree.insert(row, value)
        first += len(table)
    # Faces come first: nothing has to be lowered.
    assert not tree.make_filtration_non_decreasing()
    tree.compute_persistence(homology_coeff_field=2)
    for dimension in (0, 1, 2):
        theirs = tree.persistence_intervals_in_dimension(dimension)
        ours = simplices.persistence(dimension)
        assert len(theirs) == len(ours) and np.allclose(np.sort(theirs, axis=0), np.sort(ours, axis=0), rtol=1e-12)
    theirs = gudhi.DelaunayCechComplex(points, precision="exact").create_simplex_tree()
    for number, row in enumerate(row for table in simplices._tables() for row in table.tolist()):
        assert theirs.filtration(row) == pytest.approx(simplices.cech_values[number], rel=1e-9)
