"""Shapes for other packages, which are imported only here, when they are asked for."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from ._class import Class
from ._typing import Indices

if TYPE_CHECKING:
    from ._shape import AlphaShape


def to_pyvista(shape: AlphaShape, what: str) -> Any:
    pyvista = wanted("pyvista", "to_pyvista")
    shape = shape.unwrapped()
    if what == "boundary":
        points, triangles, indices, _ = shape.boundary(solid=not len(shape.copies))
        faces = _with_sizes(triangles)
        mesh = pyvista.PolyData(points, faces=faces) if len(triangles) else pyvista.PolyData()
    elif what == "cells":
        cells = shape.cells[shape.cell_classes == Class.INTERIOR]
        types = np.full(len(cells), pyvista.CellType.TETRA, np.uint8)
        indices = np.arange(len(shape.points))
        mesh = pyvista.UnstructuredGrid(_with_sizes(cells), types, np.array(shape.points))
    else:
        raise ValueError(f'what={what!r} is unknown: there are "boundary" and "cells"')
    if mesh.n_points:
        mesh.point_data["index"] = indices
        mesh.point_data["weight"] = shape.weights[indices]
        if shape.values is not None:
            mesh.point_data["value"] = shape.values[indices]
    return mesh


def to_meshio(shape: AlphaShape) -> Any:
    meshio = wanted("meshio", "to_meshio")
    shape = shape.unwrapped()
    blocks, classes = [], []
    for kind, rows, of in (
        ("tetra", shape.cells, shape.cell_classes),
        ("triangle", shape.facets, shape.facet_classes),
        ("line", shape.edges, shape.edge_classes),
        ("vertex", shape.vertices[:, None], shape.vertex_classes),
    ):
        # Faces of higher simplices would be there twice, but for the boundary.
        seen = of == Class.INTERIOR if kind == "tetra" else of == Class.SINGULAR
        if kind == "triangle":
            seen |= of == Class.REGULAR
        if seen.any():
            blocks.append((kind, rows[seen]))
            classes.append(of[seen])
    data = {"weight": shape.weights}
    if shape.values is not None:
        data["value"] = shape.values
    return meshio.Mesh(np.array(shape.points), blocks, point_data=data, cell_data={"class": classes})


def to_trimesh(shape: AlphaShape) -> Any:
    trimesh = wanted("trimesh", "to_trimesh")
    shape = shape.unwrapped()
    points, triangles, indices, _ = shape.boundary(solid=not len(shape.copies))
    # Processed, its vertices would be in another order than their indices.
    mesh = trimesh.Trimesh(points, triangles, process=False)
    mesh.vertex_attributes["index"] = indices
    return mesh


def to_open3d(shape: AlphaShape) -> Any:
    open3d = wanted("open3d", "to_open3d")
    shape = shape.unwrapped()
    points, triangles, _, _ = shape.boundary(solid=not len(shape.copies))
    vertices = open3d.utility.Vector3dVector(points)
    return open3d.geometry.TriangleMesh(vertices, open3d.utility.Vector3iVector(triangles.astype(np.int32)))


def to_napari(shape: AlphaShape) -> tuple[tuple[np.ndarray[Any, Any], ...], dict[str, Any], str]:
    shape = shape.unwrapped()
    points, triangles, indices, _ = shape.boundary(solid=not len(shape.copies))
    data = [points[:, ::-1], triangles]
    if shape.values is not None:
        data.append(shape.values[indices])
    return tuple(data), {"name": f"α = {shape.alpha:g}"}, "surface"


def to_shapely(shape: AlphaShape) -> Any:
    shapely = wanted("shapely", "to_shapely")
    outline = shape.outline()
    if outline.axes != (0, 1):
        raise ValueError(
            "the points lie in a vertical plane, in which polygons have no area to shapely, which looks at x and y "
            "alone: exchange coordinates first"
        )
    # As in files, z is left out where it is 0 everywhere.
    points = shape.points if shape.points[:, 2].any() else shape.points[:, :2]
    polygons = [
        shapely.Polygon(points[outer], [points[hole] for hole in holes])
        for outer, holes in outline.polygons
    ]
    return polygons[0] if len(polygons) == 1 else shapely.MultiPolygon(polygons)


def _with_sizes(rows: Indices) -> Indices:
    """Rows as VTK lists them, each after its length."""
    listed = np.empty((len(rows), rows.shape[1] + 1), np.int64)
    listed[:, 0] = rows.shape[1]
    listed[:, 1:] = rows
    return listed.ravel()


def wanted(name: str, method: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{method}() needs the package {name}: pip install {name}") from error
