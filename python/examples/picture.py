"""From a volume to a picture, off screen: a phantom head, coloured by its values."""

import pyvista

import walpha

head = walpha.read("sample:phantom")  # or "sample:skull", or walpha.read("ct.nii.gz")
shape = walpha.pipeline(head, weighting="min-max", alpha=10)
print(shape)

plotter = pyvista.Plotter(off_screen=True, window_size=[800, 800])
plotter.add_mesh(shape.to_pyvista(), scalars="value", cmap="bone")
plotter.camera_position = "xz"
plotter.camera.azimuth = 30
plotter.screenshot("phantom.png")
print("phantom.png")
