"""A boundary as a surface layer of napari: vertices (z, y, x), faces, values."""

import walpha

shape = walpha.pipeline(walpha.read("sample:phantom@32"), weighting="min-max")
data, options, kind = shape.to_napari()
print(f"{len(data[0])} vertices, {len(data[1])} faces")

try:
    import napari
except ImportError:
    print("to see it: pip install napari[all]")
else:
    layer = napari.layers.Layer.create(data, options | {"colormap": "bone"}, kind)
    print(layer)
    if __name__ == "__main__" and hasattr(napari, "current_viewer") and napari.current_viewer():
        napari.current_viewer().add_layer(layer)
