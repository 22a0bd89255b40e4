"""Points in a plane: their outlines, and shapely."""

import json
import math

import numpy as np
import pytest

import walpha


def lattice(n, left_out=lambda x, y: False):
    return np.array([(x, y) for y in range(n) for x in range(n) if not left_out(x, y)], float)


@pytest.fixture
def ring():
    """5×5 squares without the middle 3×3, but for the halves at the corners of the hole."""
    return lattice(6, lambda x, y: 1 < x < 4 and 1 < y < 4)


def twice_area(points):
    x, y = points[:, 0], points[:, 1]
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def multi(shapely, made):
    return made if made.geom_type == "MultiPolygon" else shapely.MultiPolygon([made])


def test_a_square_with_a_hole(ring):
    outline = walpha.alpha_shape(ring, alpha=0.5).outline()
    assert (outline.area, outline.perimeter, outline.axes) == (18.0, 24 + 4 * math.sqrt(2), (0, 1))
    assert outline.edges.shape == (0, 2) and outline.points.shape == (0,)
    (polygon,) = outline.polygons
    (hole,) = polygon.holes
    assert (twice_area(ring[polygon.outer]), twice_area(ring[hole])) == (50.0, -14.0)
    assert polygon.outer.dtype == np.int64 and polygon.outer[0] == 0
    # A filtration's shapes have it, too.
    again = walpha.filtration(ring).shape(0.5).outline()
    assert np.array_equal(again.polygons[0].outer, polygon.outer) and again.area == 18.0


def test_what_is_beside_polygons():
    points = [[0, 0], [1, 0], [0, 1], [2.1, 0], [9, 9]]
    outline = walpha.alpha_shape(points, alpha=0.5).outline()
    assert outline.edges.tolist() == [[1, 3]] and outline.points.tolist() == [4]
    assert [p.outer.tolist() for p in outline.polygons] == [[0, 1, 2]]


def test_only_planes_have_outlines(cloud, tmp_path):
    shape = walpha.alpha_shape(cloud, alpha=0.01)
    for ask in (shape.outline, lambda: shape.save(tmp_path / "a.svg")):
        with pytest.raises(ValueError, match="span a volume"):
            ask()
    line = walpha.alpha_shape([[0, 0], [1, 1], [3, 3]], alpha=1)
    with pytest.raises(ValueError, match="on one line"):
        line.outline()
    torus = walpha.alpha_shape(lattice(8), alpha=0.5, periodic=8)
    for ask in (torus.outline, lambda: torus.save(tmp_path / "a.wkt")):
        with pytest.raises(ValueError, match="torus"):
            ask()
    assert not list(tmp_path.iterdir())


def test_files_of_the_plane(ring, tmp_path):
    shape = walpha.alpha_shape(ring, alpha=0.5)
    for extension in ("geojson", "wkt", "svg"):
        shape.save(tmp_path / f"a.{extension}")
    (feature,) = json.loads((tmp_path / "a.geojson").read_text())["features"]
    assert feature["geometry"]["type"] == "Polygon" and feature["properties"]["area"] == 18.0


def test_shapely_has_valid_polygons(ring, tmp_path):
    shapely = pytest.importorskip("shapely", minversion="2")
    shape = walpha.alpha_shape(ring, alpha=0.5)
    polygon = shape.to_shapely()
    assert isinstance(polygon, shapely.Polygon) and polygon.is_valid and not polygon.has_z
    assert polygon.area == 18.0 and math.isclose(polygon.length, 24 + 4 * math.sqrt(2)) and len(polygon.interiors) == 1
    assert polygon.exterior.is_ccw and not polygon.interiors[0].is_ccw
    # At many α, with parts that touch, against the outline's own sizes.
    points = np.random.default_rng(5).random((400, 2))
    pieces, holes = set(), 0
    for alpha in np.linspace(0.025, 0.08, 25) ** 2:
        shape = walpha.alpha_shape(points, alpha=alpha)
        outline, made = shape.outline(), shape.to_shapely()
        assert made.is_valid, shapely.is_valid_reason(made)
        assert math.isclose(made.area, outline.area) and math.isclose(made.length, outline.perimeter)
        parts = getattr(made, "geoms", [made])
        assert len(parts) == len(outline.polygons)
        pieces.add(len(parts))
        holes += sum(len(part.interiors) for part in parts)
        for extension, read in (("wkt", shapely.from_wkt), ("geojson", shapely.from_geojson)):
            shape.save(tmp_path / f"a.{extension}")
            back = read((tmp_path / f"a.{extension}").read_text())
            # There may be lines and points, too, and GeoJSON has a feature for each polygon.
            parts = [part for one in getattr(back, "geoms", [back]) for part in getattr(one, "geoms", [one])]
            found = shapely.MultiPolygon([part for part in parts if part.geom_type == "Polygon"])
            assert back.is_valid and shapely.equals_exact(found.normalize(), multi(shapely, made).normalize())
    assert len(pieces) > 5 and holes > 50
    assert walpha.alpha_shape(points, alpha=-1).to_shapely().is_empty


def test_shapely_in_tilted_planes(ring):
    pytest.importorskip("shapely", minversion="2")
    x, y = ring.T
    tilted = walpha.alpha_shape(np.column_stack([x, y, x + 7]), alpha=np.inf).to_shapely()
    # 25 in x and y, √2 times as much in the plane.
    assert tilted.has_z and tilted.is_valid and tilted.area == 25.0
    vertical = walpha.alpha_shape(np.column_stack([x, 0 * y, y]), alpha=0.5)
    assert vertical.outline().area == 18.0 and vertical.outline().axes == (0, 2)
    with pytest.raises(ValueError, match="vertical"):
        vertical.to_shapely()


def test_sizes_make_sense_in_every_dimension(ring):
    shape = walpha.alpha_shape(ring, alpha=0.5)
    assert (shape.dimension, shape.volume, shape.area, shape.perimeter) == (2, 0, 18, 24 + 4 * math.sqrt(2))
    assert shape.bounds.tolist() == [[0, 0, 0], [5, 5, 0]]
    assert shape.contains([[0.5, 0.5], [2.5, 2.5]]).tolist() == [True, False]
    assert "facets in a plane, area 18" in repr(shape)
    line = walpha.alpha_shape([[0, 0], [1, 1], [3, 3]], alpha=1)
    assert (line.dimension, line.area, line.perimeter) == (1, 0, 0) and "edges on a line" in repr(line)
    assert line.contains([[0.5, 0.5], [2, 2]]).tolist() == [True, False]
    point = walpha.alpha_shape([[1, 2, 3]], alpha=1)
    assert (point.dimension, point.perimeter) == (0, 0) and "at one place" in repr(point)
    assert walpha.alpha_shape(ring, alpha=0.5).keep(1).outline().area == 18
