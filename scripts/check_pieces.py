#!/usr/bin/env python3
"""Opens .pvtu or .pvtp files with VTK and compares them with the report of `walpha shape --json`.

    walpha shape sample:phantom@100 --blocks 8 -o head.pvtu head.pvtp --json > head.json
    scripts/check_pieces.py head.json head.pvtu head.pvtp

Needs the Python package vtk. Counts simplices by class, and sums volumes of cells and areas of regular facets,
one piece in memory at a time.
"""

import json
import sys
from collections import Counter

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

CLASSES = {1: "interior", 2: "regular", 3: "singular"}
DIMENSIONS = ["vertices", "edges", "facets", "cells"]


def rows(cells):
    """Corners and numbers of corners of all cells."""
    if cells.GetNumberOfCells() == 0:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    ends = vtk_to_numpy(cells.GetOffsetsArray())
    return vtk_to_numpy(cells.GetConnectivityArray()), np.diff(ends)


def measured(data, found):
    """Adds up what a piece has: simplices by dimension and class, volume of cells, area of regular facets."""
    if data.IsA("vtkPolyData"):
        parts = [rows(cells) for cells in (data.GetVerts(), data.GetLines(), data.GetPolys())]
        corners, sizes = (np.concatenate(part) for part in zip(*parts))
    else:
        corners, sizes = rows(data.GetCells())
    classes = vtk_to_numpy(data.GetCellData().GetArray("class"))
    places = vtk_to_numpy(data.GetPoints().GetData())
    starts = np.cumsum(sizes) - sizes
    volume = area = 0.0
    for dimension, name in enumerate(DIMENSIONS):
        chosen = sizes == dimension + 1
        for number, kind in CLASSES.items():
            found[name, kind] += int(np.count_nonzero(classes[chosen] == number))
        if dimension < 2:
            continue
        wanted = chosen if dimension == 3 else chosen & (classes == 2)
        at = starts[wanted]
        a, *others = (places[corners[at + k]] for k in range(dimension + 1))
        sides = [other - a for other in others]
        across = np.cross(sides[0], sides[1])
        if dimension == 3:
            volume += np.abs(np.einsum("ij,ij->i", across, sides[2])).sum() / 6
        else:
            area += np.linalg.norm(across, axis=1).sum() / 2
    return volume, area


def opened(path):
    reader = vtk.vtkXMLPUnstructuredGridReader() if path.endswith(".pvtu") else vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    return reader


def check(report, path):
    pieces = opened(path).GetNumberOfPieces()
    assert pieces > 0, f"{path} names no pieces"
    found, volume, area = Counter(), 0.0, 0.0
    for piece in range(pieces):
        # A reader keeps all pieces that it has read.
        reader = opened(path)
        reader.UpdatePiece(piece, pieces, 0)
        more = measured(reader.GetOutput(), found)
        volume, area = volume + more[0], area + more[1]
    shape = report["shape"]
    for (dimension, kind), count in sorted(found.items()):
        expected = shape[dimension].get(kind, 0)
        in_surface = dimension != "cells" and kind != "interior" and (dimension == "facets" or kind == "singular")
        if path.endswith(".pvtu") or in_surface:
            assert count == expected, f"{path}: {count} {kind} {dimension}, not {expected}"
    expected = shape["regular_area"]
    assert abs(area - expected) < 1e-9 * expected, f"{path}: area {area} of regular facets, not {expected}"
    if path.endswith(".pvtu"):
        assert abs(volume - shape["volume"]) < 1e-9 * shape["volume"], f"{path}: volume {volume}"
    print(f"{path}: {sum(found.values())} simplices in {pieces} pieces, as reported")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        report = json.load(file)
    for path in sys.argv[2:]:
        check(report, path)


if __name__ == "__main__":
    main()
