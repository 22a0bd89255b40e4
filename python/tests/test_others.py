"""Against GUDHI, SciPy, PyVista, trimesh, meshio, Open3D and shapely."""

import itertools

import numpy as np
import pytest

import walpha
from walpha import Class


def simplices(shape):
    return {tuple(sorted(row)) for rows in (shape.cells, shape.facets, shape.edges, shape.vertices[:, None]) for row in rows.tolist()}


@pytest.mark.parametrize("weighted", [False, True])
def test_gudhi_has_the_same_complex(cloud, weights, weighted):
    gudhi = pytest.importorskip("gudhi")
    weights = weights if weighted else None
    tree = gudhi.AlphaComplex(points=cloud, weights=weights, precision="exact").create_simplex_tree()
    filtration = walpha.filtration(cloud, weights=weights)
    values = np.array([value for _, value in tree.get_filtration()])
    # Between values, so that their rounding does not matter.
    alphas = [(a + b) / 2 for a, b in zip(values, values[1:]) if b - a > 1e-9][:: len(values) // 12]
    assert len(alphas) > 5
    for alpha in alphas:
        theirs = {tuple(sorted(s)) for s, value in tree.get_filtration() if value <= alpha}
        ours = walpha.alpha_shape(cloud, alpha, weights=weights)
        assert len(simplices(ours)) == len(theirs) and simplices(ours) == theirs
        assert simplices(filtration.shape(alpha)) == theirs
        complex_ = walpha.Complex.from_simplices(cloud, tree.get_filtration(), alpha=alpha, weights=weights)
        comparison = walpha.compare(complex_, ours)
        assert comparison.equal, str(comparison)
        assert walpha.check(complex_).valid


def test_gudhi_has_the_same_betti_numbers(cloud):
    gudhi = pytest.importorskip("gudhi")
    tree = gudhi.AlphaComplex(points=cloud, precision="exact").create_simplex_tree()
    # In the field with two elements; the top dimension counts, too.
    tree.compute_persistence(homology_coeff_field=2, persistence_dim_max=True)
    intervals = [tree.persistence_intervals_in_dimension(k) for k in range(3)]
    curve = walpha.filtration(cloud).betti_curve()
    for k in range(0, len(curve.alpha) - 1, 97):
        if curve.alpha[k + 1] - curve.alpha[k] < 1e-9:
            continue
        alpha = (curve.alpha[k] + curve.alpha[k + 1]) / 2
        theirs = [int(((i[:, 0] <= alpha) & (alpha < i[:, 1])).sum()) if len(i) else 0 for i in intervals]
        assert [curve.b0[k], curve.b1[k], curve.b2[k]] == theirs
        assert walpha.alpha_shape(cloud, alpha=alpha).betti == tuple(theirs)


def test_scipy_has_the_same_delaunay_triangulation(cloud):
    spatial = pytest.importorskip("scipy.spatial")
    theirs = spatial.Delaunay(cloud)
    ours = walpha.alpha_shape(cloud, alpha=np.inf)
    rows = {tuple(sorted(row)) for row in theirs.simplices.tolist()}
    assert rows == {tuple(row) for row in np.sort(ours.cells, axis=1).tolist()}
    assert np.isclose(ours.volume, spatial.ConvexHull(cloud).volume)
    assert np.isclose(ours.area, spatial.ConvexHull(cloud).area)
    assert walpha.check(cloud, np.inf, cells=theirs.simplices).valid
    wrong = walpha.check(cloud, np.inf, cells=theirs.simplices[1:])
    assert not wrong and wrong.total >= 1 and wrong.findings[0].rule


def test_pyvista_has_a_closed_surface_of_the_same_volume(hollow, cloud):
    pyvista = pytest.importorskip("pyvista")
    for points, alpha in ((hollow, 0.75), (cloud, 0.004), (cloud, 0.02)):
        shape = walpha.alpha_shape(points, alpha=alpha, values=points[:, 0])
        mesh = shape.to_pyvista()
        assert mesh.n_cells == len(shape.boundary().triangles) > 0
        assert mesh.is_manifold and mesh.n_open_edges == 0
        # Copies of vertices are moved apart.
        cuts = shape.boundary().cuts
        assert np.isclose(mesh.volume, shape.volume, rtol=2e-3) and np.isclose(mesh.area, shape.regular_area, rtol=2e-3)
        assert np.allclose(mesh["value"], mesh.points[:, 0], atol=0.51 if cuts.midpoints else 1e-12 + cuts.largest_move)
        cells = shape.to_pyvista("cells")
        assert cells.n_cells == (shape.cell_classes == Class.INTERIOR).sum()
        sizes = cells.compute_cell_sizes()["Volume"]
        assert (sizes > 0).all() and np.isclose(sizes.sum(), shape.volume)
    empty = walpha.alpha_shape(cloud, alpha=-1).to_pyvista()
    assert isinstance(empty, pyvista.PolyData) and empty.n_cells == 0


def test_trimesh_has_a_closed_oriented_surface(hollow, cloud):
    pytest.importorskip("trimesh")
    for points, alpha in ((hollow, 0.75), (cloud, 0.004), (cloud, 0.02)):
        shape = walpha.alpha_shape(points, alpha=alpha)
        mesh = shape.to_trimesh()
        assert mesh.is_watertight and mesh.is_winding_consistent and mesh.is_volume
        # Positive: outward.
        assert np.isclose(mesh.volume, shape.volume, rtol=2e-3) and mesh.volume > 0
        assert len(mesh.faces) == len(shape.boundary().triangles)


def test_open3d_has_a_closed_oriented_surface(hollow):
    pytest.importorskip("open3d")
    shape = walpha.alpha_shape(hollow, alpha=0.75)
    mesh = shape.to_open3d()
    assert mesh.is_edge_manifold(allow_boundary_edges=False) and mesh.is_orientable()
    a, b, c = np.moveaxis(np.asarray(mesh.vertices)[np.asarray(mesh.triangles)], 1, 0)
    # Positive: outward, and the void counts off.
    assert np.isclose(np.einsum("ij,ij->", a, np.cross(b, c)) / 6, shape.volume)


def test_a_layer_for_napari(hollow):
    shape = walpha.alpha_shape(hollow, alpha=0.75, values=hollow[:, 2])
    (places, triangles, values), options, kind = shape.to_napari()
    assert kind == "surface" and options["name"] == "α = 0.75"
    # Axes are (z, y, x), and values are those of z.
    assert np.array_equal(places[:, 0], values) and len(triangles) == len(shape.boundary().triangles)
    without, _, _ = walpha.alpha_shape(hollow, alpha=0.75).to_napari()
    assert len(without) == 2


def test_meshio_writes_what_it_gets(cloud, tmp_path):
    meshio = pytest.importorskip("meshio")
    shape = walpha.alpha_shape(cloud, alpha=0.004, values=cloud[:, 1])
    mesh = shape.to_meshio()
    mesh.write(tmp_path / "shape.vtu")
    back = meshio.read(tmp_path / "shape.vtu")
    assert np.array_equal(back.points, cloud) and np.array_equal(back.point_data["value"], cloud[:, 1])
    assert np.array_equal(back.get_cells_type("tetra"), shape.cells)
    boundary = shape.facets[shape.facet_classes != Class.INTERIOR]
    assert np.array_equal(back.get_cells_type("triangle"), boundary)
    kinds = [block.type for block in back.cells]
    for kind, rows, classes in (("line", shape.edges, shape.edge_classes),):
        seen = rows[classes == Class.SINGULAR]
        assert (kind in kinds) == bool(len(seen))
        if len(seen):
            assert np.array_equal(back.get_cells_type(kind), seen)


def test_a_missing_package_is_named(cloud, monkeypatch):
    import sys

    shape = walpha.alpha_shape(cloud, alpha=0.004)
    for name in ("pyvista", "meshio", "trimesh", "open3d", "shapely"):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(ImportError, match=f"pip install {name}"):
            getattr(shape, f"to_{name}")()


def test_importing_walpha_imports_none_of_them():
    import subprocess
    import sys

    code = "import sys, walpha; print([m for m in ('pyvista', 'meshio', 'trimesh', 'shapely', 'scipy', 'open3d', 'pandas') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "[]\n"


def test_a_boundary_is_closed_and_oriented(cloud):
    for alpha in (0.003, 0.006, 0.01):
        boundary = walpha.alpha_shape(cloud, alpha=alpha).boundary()
        sides = [tuple(t[k] for k in pair) for t in boundary.triangles.tolist() for pair in itertools.permutations(range(3), 2) if (pair[1] - pair[0]) % 3 == 1]
        assert len(sides) == len(set(sides)) and {(b, a) for a, b in sides} == set(sides)
        a, b, c = (boundary.points[boundary.triangles[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        assert np.isclose(volume, walpha.alpha_shape(cloud, alpha=alpha).volume, rtol=2e-3)
