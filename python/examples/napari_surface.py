"""A boundary as a surface layer of napari: vertices (z, y, x), faces, values."""

import walpha

shape = walpha.pipeline(walpha.read("sample:phantom@32"), weighting="min-max")
boundary = shape.boundary()
surface = boundary.points[:, ::-1], boundary.triangles, shape.values[boundary.indices]
print(f"{len(surface[0])} vertices, {len(surface[1])} faces")

try:
    import napari
except ImportError:
    print("to see it: pip install napari[all]")
else:
    layer = napari.layers.Surface(surface, colormap="bone")
    print(layer)
    if __name__ == "__main__" and hasattr(napari, "current_viewer") and napari.current_viewer():
        napari.current_viewer().add_layer(layer)
