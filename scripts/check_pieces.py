#!/usr/bin/env python3
"""Opens .pvtu or .pvtp files with VTK and compares them with the report of `walpha shape --json`.

    walpha shape sample:phantom@100 --blocks 8 -o head.pvtu head.pvtp --json > head.json
    scripts/check_pieces.py head.json head.pvtu head.pvtp

Needs the Python package vtk. Counts simplices by class, and sums volumes of cells and areas of regular facets.
"""

import json
import sys
from collections import Counter

import vtk
from vtk.util.numpy_support import vtk_to_numpy

CLASSES = {1: "interior", 2: "regular", 3: "singular"}
DIMENSIONS = {vtk.VTK_VERTEX: "vertices", vtk.VTK_LINE: "edges", vtk.VTK_TRIANGLE: "facets", vtk.VTK_TETRA: "cells"}


def opened(path):
    reader = vtk.vtkXMLPUnstructuredGridReader() if path.endswith(".pvtu") else vtk.vtkXMLPPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def check(report, path):
    data = opened(path)
    classes = vtk_to_numpy(data.GetCellData().GetArray("class"))
    found, volume, area = Counter(), 0.0, 0.0
    for i in range(data.GetNumberOfCells()):
        cell = data.GetCell(i)
        dimension = DIMENSIONS[cell.GetCellType()]
        found[dimension, CLASSES[int(classes[i])]] += 1
        corners = [cell.GetPoints().GetPoint(k) for k in range(cell.GetNumberOfPoints())]
        if dimension == "cells":
            volume += vtk.vtkTetra.ComputeVolume(*corners)
        elif dimension == "facets" and classes[i] == 2:
            area += vtk.vtkTriangle.TriangleArea(*corners)
    shape = report["shape"]
    for (dimension, kind), count in sorted(found.items()):
        assert shape[dimension][kind] == count, f"{path}: {count} {kind} {dimension}, not {shape[dimension][kind]}"
    assert abs(area - shape["area"]) < 1e-9 * shape["area"], f"{path}: area {area}, not {shape['area']}"
    if path.endswith(".pvtu"):
        all_of_them = sum(sum(shape[d].values()) for d in DIMENSIONS.values())
        assert data.GetNumberOfCells() == all_of_them, f"{path}: {data.GetNumberOfCells()} of {all_of_them} simplices"
        assert abs(volume - shape["volume"]) < 1e-9 * shape["volume"], f"{path}: volume {volume}"
    print(f"{path}: {data.GetNumberOfCells()} simplices, as reported")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    with open(sys.argv[1]) as file:
        report = json.load(file)
    for path in sys.argv[2:]:
        check(report, path)


if __name__ == "__main__":
    main()
