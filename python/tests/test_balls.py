"""The union of balls, as the library measures it."""

import math
import pickle

import numpy as np
import pytest

import walpha


def union(centers, radii, **how):
    return walpha.alpha_shape(centers, alpha=0, weights=np.square(radii), **how).balls


@pytest.fixture(scope="module")
def atoms():
    rng = np.random.default_rng(58)
    return rng.random((120, 3)) * 8, 0.8 + rng.random(120)


def holds(number, expected):
    return abs(number.value - expected) <= number.bound + 1e-13 * abs(expected)


def test_one_and_two_balls():
    one = union([[1, 2, 3]], [2])
    assert holds(one.volume, 32 / 3 * math.pi) and holds(one.area, 16 * math.pi)
    assert holds(one.mean_curvature, 8 * math.pi) and holds(one.gaussian_curvature, 4 * math.pi)
    two = union([[0, 0, 0], [1, 0, 0]], [1, 1])
    assert holds(two.volume, 2.25 * math.pi) and holds(two.area, 6 * math.pi)
    assert two.contacts.pairs.tolist() == [[0, 1]] and two.euler_characteristic == 1
    assert two.contacts.areas.values == pytest.approx([0.75 * math.pi], rel=1e-14)
    assert "volume 7.06858" in repr(two)


def test_parts_add_up(atoms):
    balls = union(*atoms, exterior=True)
    for total, parts in ((balls.volume, balls.volumes), (balls.area, balls.areas)):
        assert parts.values.sum() == pytest.approx(total.value, rel=1e-12)
        assert 0 < total.bound < 1e-9 * total.value and (parts.bounds >= 0).all()
    shape = walpha.alpha_shape(atoms[0], alpha=0, weights=np.square(atoms[1]), exterior=True)
    assert len(balls.voids) == shape.betti.b2 and len(balls.pockets) >= len(balls.voids)
    assert all(set(pocket.lining) <= set(range(120)) for pocket in balls.pockets)
    assert balls.volume.value > shape.volume


def test_derivatives_are_those_of_differences(atoms):
    centers, radii = atoms
    gradients = union(centers, radii).gradients()
    h = 1e-6
    for i, k in ((3, 0), (70, 2)):
        moved = [centers.copy(), centers.copy()]
        moved[0][i, k] -= h
        moved[1][i, k] += h
        low, high = (union(places, radii).volume.value for places in moved)
        assert gradients.volume_by_centers[i, k] == pytest.approx((high - low) / (2 * h), rel=1e-5, abs=1e-5)
    grown = [radii.copy(), radii.copy()]
    grown[0][5] -= h
    grown[1][5] += h
    low, high = (union(centers, sizes).area.value for sizes in grown)
    assert gradients.area_by_radii[5] == pytest.approx((high - low) / (2 * h), rel=1e-5, abs=1e-4)


def test_points_drawn_at_random_agree(atoms):
    centers, radii = atoms
    rng = np.random.default_rng(1)
    low, high = centers.min(axis=0) - 2, centers.max(axis=0) + 2
    places = low + rng.random((200_000, 3)) * (high - low)
    inside = np.zeros(len(places), bool)
    for center, radius in zip(centers, radii):
        inside |= ((places - center) ** 2).sum(axis=1) < radius**2
    share = inside.mean()
    expected = share * np.prod(high - low)
    error = math.sqrt(share * (1 - share) / len(places)) * np.prod(high - low)
    assert abs(union(centers, radii).volume.value - expected) < 5 * error


def test_a_box_is_filled():
    lattice = np.array([[x, y, z] for x in range(4) for y in range(4) for z in range(4)], float)
    balls = union(lattice + 0.5, np.full(64, 0.5), periodic=4)
    assert holds(balls.box_fraction, math.pi / 6)


def test_the_surface_is_closed_and_tends_to_the_union(atoms):
    balls = union(*atoms)
    errors = []
    for tolerance in (0.05, 0.0125):
        vertices, triangles, owners = balls.surface(tolerance)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        assert len(np.unique(edges, axis=0)) == len(edges)
        assert {*map(tuple, edges)} == {*map(tuple, edges[:, ::-1])}
        radii = np.linalg.norm(vertices[triangles[:, 0]] - atoms[0][owners], axis=1)
        assert radii == pytest.approx(atoms[1][owners], rel=1e-6)
        a, b, c = vertices[triangles.T]
        volume = (a * np.cross(b, c)).sum() / 6
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        errors.append([1 - volume / balls.volume.value, 1 - area / balls.area.value])
    assert np.abs(errors[1]).max() < 0.0125
    assert (np.abs(errors[0]) > 2.5 * np.abs(errors[1])).all()
    for tolerance in (0, 1, math.nan):
        with pytest.raises(ValueError, match="tolerance"):
            balls.surface(tolerance)


def test_what_has_no_union():
    with pytest.raises(ValueError, match="∞"):
        walpha.alpha_shape(np.eye(4)[:, :3], alpha=np.inf).balls
    with pytest.raises(ValueError, match="exterior"):
        union(np.eye(4)[:, :3], np.full(4, 0.5)).pockets
    with pytest.raises(ValueError, match="weights"):
        union([[0, 0, 0]], [1]).gradients([1, 2])
    with pytest.raises(TypeError):
        walpha.Balls()


def test_balls_come_back_from_a_pickle(atoms):
    balls = union(*atoms)
    back = pickle.loads(pickle.dumps(balls))
    assert back.volume == balls.volume and np.array_equal(back.areas.values, balls.areas.values)
