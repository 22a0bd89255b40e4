import itertools

import numpy as np
import pytest

import walpha

CUBE = np.array(list(itertools.product((0.0, 1.0), repeat=3)))


def rows(simplices):
    return {tuple(sorted(row)) for row in simplices.tolist()}


def oriented(points, simplices):
    a, b, c, d = np.moveaxis(points[simplices], 1, 0)
    return np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))


def test_scipy_has_the_same(cloud):
    spatial = pytest.importorskip("scipy.spatial")
    ours, theirs = walpha.triangulation(cloud), spatial.Delaunay(cloud)
    assert rows(ours.simplices) == rows(theirs.simplices) and len(ours.simplices) == len(theirs.simplices)
    assert rows(ours.convex_hull) == rows(theirs.convex_hull)
    assert ours.simplices.dtype == ours.neighbors.dtype == ours.convex_hull.dtype == np.int64

    def across(triangulation):
        """For each cell and vertex the cell opposite it, by their vertices."""
        cells = [tuple(sorted(row)) for row in triangulation.simplices.tolist()] + [None]
        return {(cell, v): cells[n] for cell, row, near in zip(cells, triangulation.simplices.tolist(), triangulation.neighbors.tolist())
                for v, n in zip(row, near)}

    assert across(ours) == across(theirs)
    places = np.random.default_rng(2).random((5, 400, 3)) * 1.4 - 0.2
    found, wanted = ours.find_simplex(places), theirs.find_simplex(places)
    assert found.shape == (5, 400) and ((found >= 0) == (wanted >= 0)).all()
    assert 300 < (found < 0).sum() < 1900
    inside = found >= 0
    assert (np.sort(ours.simplices[found[inside]]) == np.sort(theirs.simplices[wanted[inside]])).all()


def test_gudhi_has_the_same_with_weights(cloud, weights):
    gudhi = pytest.importorskip("gudhi")
    ours = walpha.triangulation(cloud, weights)
    tree = gudhi.AlphaComplex(points=cloud, weights=weights, precision="exact").create_simplex_tree()
    assert rows(ours.simplices) == {tuple(sorted(s)) for s, _ in tree.get_skeleton(3) if len(s) == 4}
    assert rows(ours.simplices) == rows(walpha.alpha_shape(cloud, np.inf, weights=weights).cells)
    assert len(ours.hidden) > 0 and set(ours.hidden.tolist()) == set(range(600)) - set(ours.simplices.ravel().tolist())
    assert np.array_equal(ours.hidden, walpha.alpha_shape(cloud, 0, weights=weights, hidden=True).hidden)
    assert np.array_equal(ours.weights, weights) and np.array_equal(ours.points, cloud)


@pytest.mark.parametrize("points", [CUBE, np.array(list(itertools.product(range(5), repeat=3)), float)])
def test_orientation_and_adjacency(points):
    made = walpha.triangulation(points)
    assert (oriented(made.points, made.simplices) > 0).all()
    assert oriented(made.points, made.simplices).sum() / 6 == points.max() ** 3
    for cell, near in enumerate(made.neighbors.tolist()):
        for k, other in enumerate(near):
            facet = set(made.simplices[cell]) - {made.simplices[cell, k]}
            if other == -1:
                assert facet in [set(row) for row in made.convex_hull.tolist()]
            else:
                assert facet < set(made.simplices[other]) and cell in made.neighbors[other]
    middle = points.mean(axis=0)
    a, b, c = np.moveaxis(points[made.convex_hull], 1, 0)
    # Counter-clockwise from outside: away from the middle.
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a - middle) > 0).all()


def test_duplicates_and_hidden_points():
    points = np.concatenate([CUBE[:1], CUBE, [[0.5, 0.5, 0.5]]])
    made = walpha.triangulation(points, [0] * 9 + [-5])
    assert made.duplicates.tolist() == [[1, 0]] and made.hidden.tolist() == [9]
    assert set(made.simplices.ravel().tolist()) == {0, *range(2, 9)}
    spatial = pytest.importorskip("scipy.spatial")
    scipys = spatial.Delaunay(points[:9]).coplanar[:, [0, 2]]
    assert scipys.tolist() in ([[1, 0]], [[0, 1]])


def test_places_on_facets_vertices_and_elsewhere():
    made = walpha.triangulation(CUBE)
    places = np.concatenate([CUBE, (CUBE[:, None] + CUBE).reshape(-1, 3) / 2])
    found = made.find_simplex(places)
    assert (found >= 0).all()
    for place, cell in zip(places, found):
        corners = made.points[made.simplices[cell]]
        share = np.linalg.solve(np.vstack([corners.T, np.ones(4)]), [*place, 1])
        assert (share > -1e-12).all()
    outside = [[1, 1, np.nextafter(1, 2)], [np.nan, 0, 0], [1e300, 0, 0], [-np.inf, 0, 0]]
    assert made.find_simplex(outside).tolist() == [-1] * 4
    first, last = made.points[made.simplices[[0, 5]]].mean(axis=1)
    assert made.find_simplex([[np.nan] * 3, last, [2, 2, 2], first]).tolist() == [-1, 5, -1, 0]
    assert made.find_simplex([0.5, 0.25, 0.125]).shape == () and made.find_simplex(np.zeros((0, 3))).shape == (0,)
    with pytest.raises(ValueError, match=r"xi has shape \(2,\)"):
        made.find_simplex([0, 1])


def test_many_places_on_threads():
    points = np.random.default_rng(1).random((20_000, 3))
    made = walpha.triangulation(points, threads=2)
    one = walpha.triangulation(points, threads=1)
    assert np.array_equal(made.simplices, one.simplices) and np.array_equal(made.neighbors, one.neighbors)
    cells = np.random.default_rng(2).integers(0, len(made.simplices), 5000)
    middles = points[made.simplices[cells]].mean(axis=1)
    stages = set()
    found = made.find_simplex(middles, progress=lambda stage, done, total: stages.add(stage))
    assert (found == cells).mean() > 0.999 and stages == {"location"}


def test_what_makes_no_triangulation():
    for points, message in ((CUBE[:4], "in one plane"), (CUBE[:3], "3 distinct points"), (CUBE[:, :2], "in one plane")):
        with pytest.raises(ValueError, match=message):
            walpha.triangulation(points)
    with pytest.raises(ValueError, match="3 weights for 8 points"):
        walpha.triangulation(CUBE, [1, 2, 3])
    with pytest.raises(ValueError, match="read-only"):
        walpha.triangulation(CUBE).simplices[0] = 0


def test_scipy_has_the_same_voronoi_cells(cloud):
    spatial = pytest.importorskip("scipy.spatial")
    made = walpha.triangulation(cloud)
    ours, theirs = made.power_diagram(), spatial.Voronoi(cloud)
    assert len(ours.vertices) == len(theirs.vertices) == len(made.simplices)
    assert np.allclose(np.linalg.norm(ours.vertices[ours.same_sphere] - cloud[made.simplices[:, 2]], axis=1) ** 2,
                       np.linalg.norm(ours.vertices[ours.same_sphere] - cloud[made.simplices[:, 1]], axis=1) ** 2)
    # In general position each edge has a facet. Qhull leaves out unbounded ones with a single vertex.
    facets = set(map(tuple, ours.facets.tolist()))
    assert facets == {pair for cell in made.simplices.tolist() for pair in itertools.combinations(sorted(cell), 2)}
    assert len(facets) == len(ours.facets) and rows(theirs.ridge_points) < facets
    bounded = 0
    for v, region in enumerate(theirs.point_region):
        corners = theirs.regions[region]
        if -1 in corners:
            assert ours.volumes[v] == np.inf
        else:
            hull = spatial.ConvexHull(theirs.vertices[corners])
            assert ours.volumes[v] == pytest.approx(hull.volume, rel=1e-9)
            assert ours.areas[(ours.facets == v).any(axis=1)].sum() == pytest.approx(hull.area, rel=1e-9)
            bounded += 1
    assert bounded > 300
    bounded = {tuple(sorted(pair)) for pair, ridge in zip(theirs.ridge_points.tolist(), theirs.ridge_vertices) if -1 not in ridge}
    assert set(map(tuple, ours.facets[np.isfinite(ours.areas)].tolist())) == bounded


def test_power_cells_are_intersections_of_half_spaces(cloud, weights):
    spatial = pytest.importorskip("scipy.spatial")
    made = walpha.triangulation(cloud, weights)
    diagram = made.power_diagram(threads=1)
    assert len(made.hidden) > 0 and (diagram.volumes[made.hidden] == 0).all()
    bounded = np.flatnonzero((diagram.volumes > 0) & np.isfinite(diagram.volumes))
    assert len(bounded) > 50
    for v in bounded[:50]:
        others = np.delete(np.arange(len(cloud)), v)
        # Nearer to v than to q in power: 2 (q - v)·x <= |q|² - w(q) - |v|² + w(v).
        normals = 2 * (cloud[others] - cloud[v])
        offsets = (cloud[others] ** 2).sum(axis=1) - weights[others] - (cloud[v] ** 2).sum() + weights[v]
        corners = diagram.vertices[diagram.same_sphere[(made.simplices == v).any(axis=1)]]
        cell = spatial.HalfspaceIntersection(np.column_stack([normals, -offsets]), corners.mean(axis=0))
        hull = spatial.ConvexHull(cell.intersections)
        assert diagram.volumes[v] == pytest.approx(hull.volume, rel=1e-6)
        assert diagram.areas[(diagram.facets == v).any(axis=1)].sum() == pytest.approx(hull.area, rel=1e-6)


def test_a_lattice_has_cubes():
    points = np.array(list(itertools.product(range(5), repeat=3)), float)
    made = walpha.triangulation(points)
    stages = set()
    diagram = made.power_diagram(progress=lambda stage, done, total: stages.add(stage))
    assert stages == {"power diagram"}
    assert diagram.same_sphere.shape == (len(made.simplices),) and len(diagram.vertices) == 64
    # Each of the cubes is 5 or 6 tetrahedra, all of the volume of the cube together.
    assert np.allclose(np.bincount(diagram.same_sphere, oriented(points, made.simplices) / 6), 1)
    assert sorted(set(diagram.volumes.tolist())) == [1, np.inf] and len(diagram.facets) == 3 * 4 * 25
    with pytest.raises(ValueError, match="read-only"):
        diagram.volumes[0] = 0
