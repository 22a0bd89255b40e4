#!/usr/bin/env python3
"""Compares laser scans with laspy, PROJ and GDAL: `scripts/check_lidar.py WALPHA [TILE.laz …]`.

Tiles of its own, written by laspy in every format of points, and tiles that are given: what `walpha info --json` says of the system of
coordinates, classes and columns is what laspy reads, and geopandas places the outlines of `walpha shape --by` on the tile.
Needs laspy[lazrs], geopandas and pyogrio: PyPI.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import geopandas
import laspy
import numpy as np
import pandas
import pyproj

# Fields of bits have no name of their own in laspy's format.
SKIPPED = {"X", "Y", "Z", "bit_fields", "classification_flags", "raw_classification", "scan_angle_rank", "scan_angle"}


def written(folder, form, suffix, epsg):
    """A tile of 40 trees on ground that has no number."""
    random = np.random.default_rng(form)
    header = laspy.LasHeader(point_format=form, version="1.4")
    header.scales, header.offsets = [0.01] * 3, [481_000, 3_812_000, 0]
    header.add_extra_dim(laspy.ExtraBytesParams(name="treeID", type="int32", no_data=[-1]))
    header.add_extra_dim(laspy.ExtraBytesParams(name="depth", type="int16", scales=[0.1], offsets=[5]))
    header.add_crs(pyproj.CRS.from_epsg(epsg))
    crowns = random.normal(size=(40, 90, 3)) + random.uniform(0, 90, (40, 1, 3)) * [1, 1, 0.1]
    ground = random.uniform(0, 90, (2000, 3)) * [1, 1, 0]
    tile = laspy.LasData(header)
    tile.xyz = np.concatenate([crowns.reshape(-1, 3), ground]) + header.offsets
    count = len(tile.points)
    tile.treeID = np.concatenate([np.repeat(np.arange(40) + 1, 90), np.full(2000, -1)])
    tile.depth = np.round(random.uniform(5, 900, count), 1)
    tile.classification = np.where(np.asarray(tile.treeID) > 0, 5, 2)
    for name in set(tile.point_format.dimension_names) & {"intensity", "user_data", "point_source_id", "red", "green", "blue", "nir"}:
        tile[name] = random.integers(0, 200, count)
    if "gps_time" in tile.point_format.dimension_names:
        tile.gps_time = random.uniform(1e5, 2e5, count)
    path = folder / f"{form}.{suffix}"
    tile.write(path)
    return path


def run(walpha, *args):
    return json.loads(subprocess.run([walpha, *map(str, args), "--json"], check=True, capture_output=True).stdout)


def compare(walpha, path, folder):
    """Compares a tile, and its shapes by tree or else by class."""
    told, tile = run(walpha, "info", path, "--withheld"), laspy.read(path)
    assert told["count"] == len(tile.points), path
    codes, counts = np.unique(np.asarray(tile.classification), return_counts=True)
    assert told["classes"] == {str(code): int(n) for code, n in zip(codes, counts)}, path
    crs = tile.header.parse_crs()
    if crs is not None:
        code = crs.sub_crs_list[0].to_epsg() if crs.sub_crs_list else crs.to_epsg()
        assert (told["crs"] or {}).get("epsg") == code, (path, told["crs"], code)
    names = set(tile.point_format.dimension_names) - SKIPPED
    compared = 0
    for name in sorted(names & set(told["columns"])):
        expected = np.asarray(tile[name], dtype=float)
        if expected.ndim == 1:
            column = told["columns"][name]
            there = with_a_number(expected) if name == "treeID" else expected
            assert np.isclose([column["min"], column["max"]], [there.min(), there.max()], atol=1e-9).all(), (path, name, column)
            compared += 1
    written_again(walpha, path, tile, folder)
    by = "treeID" if "treeID" in names else "classification"
    table, outlines, package = folder / "t.csv", folder / "t.geojson", folder / "t.gpkg"
    made = run(walpha, "shape", path, "--withheld", "--by", by, "-o", table, outlines, package)
    rows = pandas.read_csv(table)
    expected = np.asarray(tile[by], dtype=float)
    expected = with_a_number(expected) if by == "treeID" else expected
    assert dict(zip(rows[by], rows.points)) == {k: (expected == k).sum() for k in np.unique(expected)}, path
    in_place = geopandas.read_file(package)
    assert list(in_place[by]) == list(rows[by]) and np.allclose(in_place.area.fillna(0), rows.outline_area), path
    low, high = np.array(in_place.total_bounds).reshape(2, 2)
    assert (low >= tile.xyz.min(0)[:2]).all() and (high <= tile.xyz.max(0)[:2]).all(), path
    if told["crs"] and told["crs"]["epsg"]:
        assert in_place.crs.to_epsg() == told["crs"]["epsg"], (path, in_place.crs)
    placed = geopandas.read_file(outlines)
    if told["crs"] and told["crs"]["epsg"]:
        placed = placed[~placed.geometry.isna()].to_crs(told["crs"]["epsg"])
        low, high = np.array(placed.total_bounds).reshape(2, 2)
        # PROJ shifts some datums by a metre or two that EPSG's definitions for PROJ 4 take for WGS 84.
        near = 0.01 if path.parent == folder and told["unit"] == "m" else 7
        inside = (low >= tile.xyz.min(0)[:2] - near).all() and (high <= tile.xyz.max(0)[:2] + near).all()
        assert inside and np.allclose(placed.area, placed.outline_area, rtol=1e-5), path
    print(f"{path.name}: {compared} columns, {len(rows)} shapes by {by}, {made['volume']:.6g} {told['unit']}³")


def with_a_number(trees):
    """Without the points of no tree: ours have −1, and lidR's the greatest double."""
    return trees[(trees != -1) & (trees != np.finfo(float).max)]


def written_again(walpha, path, tile, folder):
    """Compares what walpha writes of a tile, as LAS and LAZ, with the tile: the header, records and all dimensions."""
    for suffix in ["las", "laz"]:
        out = folder / f"again.{suffix}"
        run(walpha, "points", path, "--withheld", "-o", out)
        again = laspy.read(out)
        assert again.point_format.id == tile.point_format.id, path
        # The header of earlier versions has no room for a sixth return.
        assert again.header.version == ("1.4" if tile.return_number.max() > 5 else tile.header.version), path
        assert (again.header.scales == tile.header.scales).all() and (again.header.offsets == tile.header.offsets).all(), path
        assert again.header.global_encoding.gps_time_type == tile.header.global_encoding.gps_time_type, path
        assert again.header.are_points_compressed == (suffix == "laz"), path
        step = 1.5 * tile.header.scales
        assert (abs(again.header.mins - tile.xyz.min(0)) < step).all() and (abs(again.header.maxs - tile.xyz.max(0)) < step).all(), path
        crs, before = again.header.parse_crs(), tile.header.parse_crs()
        assert crs == before, (path, crs, before)
        for dimension in tile.point_format.dimensions:
            found = again[dimension.name]
            assert np.array_equal(np.asarray(found), np.asarray(tile[dimension.name]), equal_nan=dimension.kind.name == "FloatingPoint"), (path, dimension.name)
            of_file = again.point_format.dimension_by_name(dimension.name)
            assert (of_file.dtype, of_file.description) == (dimension.dtype, dimension.description), (path, dimension.name)
    table = folder / "again.csv"
    run(walpha, "points", path, "--withheld", "-o", table)
    rows = pandas.read_csv(table)
    assert np.array_equal(rows[["x", "y", "z"]], tile.xyz) and np.array_equal(rows.intensity, tile.intensity), path
    if "gps_time" in tile.point_format.dimension_names:
        assert np.array_equal(rows.gps_time, tile.gps_time), path


def main():
    walpha, *given = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for form in [0, 1, 2, 3, 6, 7, 8]:
            for suffix in ["las", "laz"]:
                # Metres, international feet, and US survey feet.
                compare(walpha, written(folder, form, suffix, [26912, 2994, 2229][form % 3]), folder)
        for path in given:
            compare(walpha, Path(path), folder)


if __name__ == "__main__":
    main()
