import itertools
import math

import numpy as np
import pytest

import walpha
from walpha import Class

CUBE = np.array(list(itertools.product((0.0, 1.0), repeat=3)))


def arrays(shape):
    return [shape.cells, shape.facets, shape.edges, shape.vertices, *shape._classes]


def same(a, b):
    return all(np.array_equal(x, y) for x, y in zip(arrays(a), arrays(b)))


def test_a_cube_is_full_at_three_quarters_and_not_before():
    full = walpha.alpha_shape(CUBE, alpha=0.75)
    assert full.volume == 1.0 and full.area == 6.0 and full.betti == (1, 0, 0)
    assert len(full.facets[full.facet_classes == Class.REGULAR]) == 12
    assert (full.vertex_classes == Class.REGULAR).all() and full.cells.dtype == np.int64
    less = walpha.alpha_shape(CUBE, alpha=np.nextafter(0.75, 0))
    # The sides of the cube, each of two right triangles.
    assert less.volume == 0.0 and len(less.cells) == 0 and less.betti == (1, 0, 1)
    assert (less.facet_classes == Class.SINGULAR).all() and less.facets.shape == (12, 3)


def test_alpha_is_squared_and_alpha_radius_is_not(cloud):
    squared, radius = walpha.alpha_shape(cloud, alpha=0.0625), walpha.alpha_shape(cloud, alpha_radius=0.25)
    assert squared.alpha == radius.alpha == 0.0625 and radius.alpha_radius == 0.25
    assert same(squared, radius)
    assert not same(squared, walpha.alpha_shape(cloud, alpha=0.01))


@pytest.mark.parametrize("engine", ["auto", "cgal", "native"])
@pytest.mark.parametrize("exterior", [False, True])
def test_engines_agree(cloud, weights, engine, exterior):
    wanted = walpha.alpha_shape(cloud, 0.003, weights=weights, engine="native", exterior=exterior)
    shape = walpha.alpha_shape(cloud, 0.003, weights=weights, engine=engine, exterior=exterior)
    assert same(shape, wanted) and shape.betti == wanted.betti and shape.volume == wanted.volume
    assert exterior == bool((shape.cell_classes == Class.EXTERIOR).any())


def test_strays_do_not_decide(cloud):
    shape = walpha.alpha_shape(cloud)
    stray = walpha.alpha_shape(np.vstack([cloud, [[100.0, 0, 0]]]))
    assert shape.alpha_origin == stray.alpha_origin == "auto"
    assert abs(stray.alpha / shape.alpha - 1) < 0.05 and stray.betti.b0 == 2
    assert walpha.alpha_shape(cloud, alpha="auto").alpha == shape.alpha


def test_auto_connected_is_one_solid_component(cloud):
    shape = walpha.alpha_shape(cloud, alpha="auto:connected")
    assert shape.alpha_origin == "connected" and shape.betti.b0 == 1 and len(shape.components) == 1
    assert shape.alpha == walpha.filtration(cloud).optimal_alpha()
    assert len(np.unique(shape.cells)) == len(cloud)


def test_voids_and_components(hollow):
    for exterior in (False, True):
        shape = walpha.alpha_shape(hollow, alpha=0.75, exterior=exterior)
        (void,) = shape.voids
        assert shape.betti == (1, 0, 1)
        assert void.low == (1, 1, 1) and void.high == (5, 5, 5)
        assert math.isclose(shape.volume + void.volume, 6**3)
        assert (void.filling_alpha is not None) == exterior
    left = walpha.alpha_shape(hollow, alpha=void.filling_alpha, exterior=True)
    assert left.voids == [] and left.volume == 6**3
    (component,) = shape.components
    assert component.voids[0].volume == pytest.approx(void.volume) and component.vertices == len(hollow)
    two = walpha.alpha_shape(np.concatenate([CUBE, CUBE + 9]), alpha=0.75)
    assert [c.volume for c in two.components] == [1, 1]
    assert two.component_numbers.tolist() == [0] * 8 + [1] * 8


def test_voids_that_are_not_known_are_refused(hollow):
    shape = walpha.filtration(hollow).shape(0.75)
    with pytest.raises(ValueError, match="exterior=True"):
        shape.voids
    assert len(walpha.filtration(hollow).shape(0.75, exterior=True).voids) == 1


def test_duplicates_and_hidden_points():
    points = np.concatenate([CUBE, CUBE[:1], [[0.5, 0.5, 0.5]]])
    weights = np.zeros(10)
    weights[9] = -5
    shape = walpha.alpha_shape(points, 1.0, weights=weights, exterior=True)
    assert shape.duplicates.tolist() == [[8, 0]] and shape.hidden.tolist() == [9]
    assert shape.vertices.tolist() == list(range(8))


@pytest.mark.parametrize("engine", ["cgal", "native"])
def test_hidden_points_and_the_engine_that_ran(engine):
    points, weights = np.concatenate([CUBE, [[0.5, 0.5, 0.5]]]), np.array([0.0] * 8 + [-5.0])
    # Points go to our own engine, and those selected from a volume to CGAL, as in the paper.
    for asked in {"cgal": ("cgal",), "native": ("auto", "native")}[engine]:
        assert walpha.alpha_shape(points, 1.0, weights=weights, engine=asked).hidden is None
        shape = walpha.alpha_shape(points, 1.0, weights=weights, engine=asked, hidden=True)
        assert shape.hidden.tolist() == [8] and shape.engine == engine
    assert walpha.alpha_shape(CUBE + 0.25, alpha=0.1, periodic=4).engine == "native"
    assert walpha.pipeline(walpha.read("sample:phantom@16"), count=100).engine == "cgal"


def test_what_is_lent_cannot_be_written_and_outlives_the_shape(cloud):
    points = walpha.alpha_shape(cloud, alpha=0.01).points
    assert np.array_equal(points, cloud) and not points.flags.owndata
    shape = walpha.alpha_shape(cloud, alpha=0.01, exterior=True)
    for name in ("points", "cells", "facets", "edges", "vertices", "hidden", "duplicates", "copies"):
        assert getattr(shape, name) is getattr(shape, name)
        with pytest.raises(ValueError, match="read-only"):
            getattr(shape, name)[:] = 0


def test_balls_of_radii(cloud):
    radius = walpha.alpha_shape(cloud, 0.05, weights=np.full(600, 0.02), balls="radius")
    assert same(radius, walpha.alpha_shape(cloud, alpha=0.07**2))


def test_html_has_the_counts(cloud):
    shape = walpha.alpha_shape(cloud, alpha=0.01)
    text = shape._repr_html_()
    assert f"{shape.counts()['facets']['singular']} triangles" in text and "&lt;walpha.AlphaShape" in text
    assert sum(shape.counts()["facets"].values()) == len(shape.facets)


def test_components_are_kept():
    sizes = (1, 3, 2)
    cubes = [
        [20 * k + x, y, z]
        for k, side in enumerate(sizes)
        for x in range(side + 1)
        for y in range(side + 1)
        for z in range(side + 1)
    ]
    shape = walpha.alpha_shape(np.array([*cubes, [90, 0, 0]], float), 0.75, exterior=True)
    assert shape.kept is None and shape.volume == 36 and shape.betti.b0 == 4
    largest = shape.keep("largest")
    assert (largest.volume, largest.area, largest.betti, largest.kept) == (27.0, 54.0, (1, 0, 0), (1, 4))
    assert np.array_equal(largest.points, shape.points) and "1 of 4 components" in repr(largest)
    assert (largest.facet_classes != walpha.Class.EXTERIOR).all()
    assert shape.keep(2).volume == 35 and shape.keep(min_volume=8).volume == 35
    assert shape.keep(3, min_volume=9).volume == 27 and shape.keep(min_volume=28).volume == 0
    assert largest.keep(1).kept == (1, 1)
    one, other = shape.boundary(keep="largest"), largest.boundary()
    assert np.array_equal(one.triangles, other.triangles) and len(one.points) == 56
    for wrong in ({}, {"largest": 0}, {"largest": "most"}, {"min_volume": -1}):
        with pytest.raises(ValueError):
            shape.keep(**wrong)
    with pytest.raises(ValueError, match="torus"):
        walpha.alpha_shape(CUBE + 0.25, alpha=0.1, periodic=4).keep(1)


def test_a_part_is_not_saved_as_the_whole(tmp_path):
    shape = walpha.alpha_shape(CUBE, 0.75).keep(1)
    for name in ("a.json", "a.npz"):
        with pytest.raises(ValueError, match="states the whole shape"):
            shape.save(tmp_path / name)
    shape.save(tmp_path / "a.vtu")


def test_the_area_is_that_of_the_surface():
    rng = np.random.default_rng(1)
    sphere = rng.normal(size=(4000, 3))
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    scan = walpha.alpha_shape(sphere, alpha=0.02)
    assert abs(scan.area / (4 * np.pi) - 1) < 0.05
    assert scan.area == pytest.approx(scan.regular_area + scan.singular_area, rel=1e-14)
    parts = scan.components
    assert sum(part.area for part in parts) == pytest.approx(scan.area, rel=1e-12)
    assert sum(part.regular_area for part in parts) == pytest.approx(scan.regular_area, rel=1e-12)


def test_bounds_and_contains():
    shape = walpha.alpha_shape(np.concatenate([CUBE, [[9.0, 0, 0]]]), 0.75)
    assert shape.bounds.tolist() == [[0, 0, 0], [9, 1, 1]] and shape.dimension == 3 and shape.perimeter is None
    places = [[0.5, 0.5, 0.5], [1, 1, 1], [9, 0, 0], [9, 0, 1e-300], [1.0000000000000002, 0.5, 0.5]]
    assert shape.contains(places).tolist() == [True, True, True, False, False]
    empty = walpha.alpha_shape(CUBE, -1.0)
    assert empty.bounds is None and not empty.contains(CUBE).any()


def test_different_alphas_are_told_once(monkeypatch):
    monkeypatch.setattr(walpha._alpha, "_first", None)
    monkeypatch.setattr(walpha._alpha, "_told", False)
    with pytest.warns(UserWarning, match="volumes and areas do not compare") as told:
        for scale in (1, 1, 2, 3):
            walpha.alpha_shape(scale * CUBE, alpha="auto")
    assert len(told) == 1


def test_tuples_of_arrays_are_shown_in_a_line(cloud):
    shape = walpha.alpha_shape(cloud, 0.05)
    for made in (shape.boundary(), walpha.filtration(cloud).betti_curve()):
        assert "\n" not in repr(made) and len(repr(made)) < 300
    assert repr(shape.boundary()).startswith(f"Boundary(points=<float64 {len(shape.boundary().points)}×3>, triangles=<int64 ")
    assert "<" not in repr(walpha.alpha_shape([[0, 0, 0], [1, 0, 0], [0, 1, 0]], 1.0).betti)
