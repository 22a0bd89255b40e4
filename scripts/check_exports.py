"""What `check_formats.py` checks of meshes and points with meshio, trimesh, Open3D, pymeshlab, VTK and laspy."""

import json

import laspy
import meshio
import numpy as np
import open3d
import pymeshlab
import trimesh
import vtk
from vtk.util.numpy_support import vtk_to_numpy

MESHES = ["ply", "off", "obj", "stl", "glb", "vtp", "vtu"]


def faces_in_vtk(reader_class):
    def faces(file):
        reader = reader_class()
        reader.SetFileName(file)
        reader.Update()
        return reader.GetOutput().GetNumberOfPolys()

    return faces


def faces_in_meshlab(file):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(file)
    return sum(mesh.face_number() for mesh in meshes)


def faces_in_meshio(file):
    return sum(len(block.data) for block in meshio.read(file).cells if block.type == "triangle")


def faces_in_trimesh(file):
    scene = trimesh.load_scene(file)
    return sum(len(g.faces) for g in scene.geometry.values() if hasattr(g, "faces"))


def faces_in_open3d(file):
    return len(open3d.io.read_triangle_mesh(file).triangles)


# A program, how many triangles it finds in a file, and the extensions it reads.
READERS = [
    ("meshio", faces_in_meshio, ["ply", "off", "obj", "stl", "vtu"]),
    ("trimesh", faces_in_trimesh, ["ply", "off", "obj", "stl", "glb"]),
    ("Open3D", faces_in_open3d, ["ply", "off", "obj", "stl", "glb"]),
    ("MeshLab", faces_in_meshlab, ["ply", "off", "obj", "stl"]),
    ("VTK", faces_in_vtk(vtk.vtkPLYReader), ["ply"]),
    ("VTK", faces_in_vtk(vtk.vtkOBJReader), ["obj"]),
    ("VTK", faces_in_vtk(vtk.vtkSTLReader), ["stl"]),
    ("VTK", faces_in_vtk(vtk.vtkXMLPolyDataReader), ["vtp"]),
]


def exports(check):
    """Each program finds all facets in each of our formats that it knows."""
    files = {extension: check.path("mesh." + extension) for extension in MESHES}
    run = check.run("shape", "sample:phantom@24", "--alpha", "2.5", "--json", "-o", *files.values())
    if run.returncode:
        return check.judge("walpha writes meshes", run.stderr.strip())
    facets = json.loads(run.stdout)["shape"]["facets"]
    for program, count, extensions in READERS:
        for extension in extensions:
            name = f"{program} finds all facets in our {extension}"
            # STL has no singular facets, VTU all of them.
            expected = facets["regular"]
            expected += 0 if extension == "stl" else facets["singular"]
            expected += facets["interior"] if extension == "vtu" else 0
            try:
                check.equal(name, count(files[extension]), expected)
            except (Exception, SystemExit) as error:  # Whatever a foreign reader throws is a finding.
                check.judge(name, f"{type(error).__name__}: {error}")
    for part in [scalars, field_data]:
        try:
            part(check, files)
        except (Exception, SystemExit) as error:
            check.judge(part.__doc__, f"{type(error).__name__}: {error}")
    upright(check, files["glb"])


def scalars(check, files):
    """Colours and scalars of a PLY arrive."""
    points = meshio.read(files["ply"]).point_data
    for colour in ["red", "green", "blue"]:
        # meshio takes bytes for signed.
        points[colour] = np.asarray(points[colour]).astype("u1")
    missing = {"value", "weight", "red", "green", "blue"} - set(points)
    check.judge("meshio reads scalars of our ply", f"not {missing}" if missing else None)
    colours = np.asarray(open3d.io.read_triangle_mesh(files["ply"]).vertex_colors)
    check.equal("Open3D reads colours of our ply", 255 * colours[:, 0], points["red"], 1e-3)
    mesh = trimesh.load(files["ply"], process=False)
    check.equal("trimesh reads colours of our ply", mesh.visual.vertex_colors[:, 1], points["green"])
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(files["ply"])
    mesh = meshes.current_mesh()
    check.equal("MeshLab reads colours of our ply", 255 * mesh.vertex_color_matrix()[:, 2], points["blue"], 1e-3)


def field_data(check, files):
    """VTK reads how a file was made."""
    for extension, reader in [("vtp", vtk.vtkXMLPolyDataReader()), ("vtu", vtk.vtkXMLUnstructuredGridReader())]:
        reader.SetFileName(files[extension])
        reader.Update()
        data = reader.GetOutput().GetFieldData()
        texts = [data.GetAbstractArray(name) for name in ["input", "made_by", "class_legend"]]
        if extension == "vtu":
            texts = [bytes(vtk_to_numpy(array)).decode() for array in texts]
        else:
            texts = [array.GetValue(0) for array in texts]
        check.judge(f"VTK reads texts of our {extension}", None if texts[0] == "sample:phantom@24" and texts[1].startswith("walpha ") and "2 regular" in texts[2] else str(texts))
        check.equal(f"VTK reads α of our {extension}", vtk_to_numpy(data.GetArray("alpha")), [2.5])
    run = check.run("shape", "sample:phantom@16", "--alpha", "inf", "-o", check.path("hull.vtu"))
    check.judge("walpha writes a hull", run.stderr.strip() if run.returncode else None)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(check.path("hull.vtu"))
    reader.Update()
    check.judge("VTK reads α = ∞", None if np.isinf(reader.GetOutput().GetFieldData().GetArray("alpha").GetValue(0)) else "it is finite")


def upright(check, glb):
    """glTF's y is up: what was z."""
    flat = trimesh.load(glb.replace(".glb", ".ply"), process=False).bounds
    up = trimesh.load_scene(glb).bounds
    check.equal("our glb stands upright", up[:, 1], flat[:, 2], 1e-4)
    check.equal("and its front looks along z", up[::-1, 2], -flat[:, 1], 1e-4)


def solids(check):
    """Closed, oriented, manifold: as trimesh and MeshLab judge it, on shapes that are not manifold."""
    for alpha in ["2", "2.5", "3", "5"]:
        file = check.path("solid.ply")
        run = check.run("shape", "sample:phantom@32", "--alpha", alpha, "--solid", "--json", "-o", file, check.path("solid.stl"))
        if run.returncode:
            check.judge("walpha writes a solid", run.stderr.strip())
            continue
        report = json.loads(run.stdout)
        mesh = trimesh.load(file, process=False)
        name = f"solid at α = {alpha} ({report['solid']})"
        check.judge(f"{name}: watertight for trimesh", None if mesh.is_watertight else "it is not")
        check.judge(f"{name}: winding for trimesh", None if mesh.is_winding_consistent else "it is inconsistent")
        check.equal(f"{name}: volume", mesh.volume, report["shape"]["volume"], 2e-3)
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(file)
        found = meshes.get_topological_measures()
        check.judge(f"{name}: two-manifold for MeshLab", None if found["is_mesh_two_manifold"] else str(found))
        check.equal(f"{name}: no edge on the border", found["boundary_edges"], 0)
        solid = open3d.io.read_triangle_mesh(file)
        check.judge(f"{name}: edge-manifold for Open3D", None if solid.is_edge_manifold(False) and solid.is_vertex_manifold() else "it is not")


def foreign_points(check):
    """Point files that these programs write are read."""
    positions = np.random.default_rng(5).random((200, 3)).astype("f4").astype("f8") * 10
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(positions))
    cloud.normals = open3d.utility.Vector3dVector(np.tile([0.0, 0.0, 1.0], (200, 1)))
    for text, packed in [(True, False), (False, False), (False, True)]:
        open3d.io.write_point_cloud(check.path("o.pcd"), cloud, write_ascii=text, compressed=packed)
        check.points(f"Open3D PCD text={text} packed={packed}", check.path("o.pcd"), positions)
    open3d.io.write_point_cloud(check.path("o.ply"), cloud)
    check.points("Open3D PLY", check.path("o.ply"), positions)
    hull = trimesh.convex.convex_hull(positions)
    for extension in ["off", "obj", "stl", "ply"]:
        hull.export(check.path("t." + extension))
        found = check.run("info", check.path("t." + extension), "--json")
        count = json.loads(found.stdout)["count"] if found.returncode == 0 else found.stdout.strip()
        check.judge(f"trimesh {extension}", None if count == len(hull.vertices) else f"{count}, not {len(hull.vertices)} points")
    meshio.write_points_cells(check.path("m.stl"), hull.vertices, [("triangle", hull.faces)], file_format="stl", binary=False)
    found = check.run("info", check.path("m.stl"), "--json")
    check.equal("meshio STL in text", json.loads(found.stdout or "{}").get("count", 0), len(hull.vertices))
    las(check, positions)


def las(check, positions):
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales, header.offsets = np.full(3, 0.001), np.zeros(3)
    data = laspy.LasData(header)
    data.x, data.y, data.z = positions.T
    data.intensity = np.arange(len(positions))
    for extension in ["las", "laz"]:
        file = check.path("l." + extension)
        try:
            data.write(file)
        except laspy.errors.LaspyException as error:
            print(f"passed over: laspy cannot write {extension} ({error})")
            continue
        if not check.lacks("LAS", file):
            check.points(f"laspy {extension}", file, np.column_stack([data.x, data.y, data.z]), values=np.arange(len(positions)))


PARTS = [exports, solids, foreign_points]
