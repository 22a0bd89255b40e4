#!/usr/bin/env python3
"""Checks walpha's readers and writers against other programs.

    scripts/check_formats.py [--walpha target/release/walpha] [--env /tmp/walpha-formats]

Makes a Python environment (once) with VTK, nibabel, pynrrd, tifffile, SimpleITK, Pillow, trimesh,
pydicom, zarr, meshio, Open3D, pymeshlab and laspy, writes files of every flavour with these and reads them with walpha, then writes files
with walpha and reads them with these. Prints a line for each; exits with 1 when one is wrong, and with
77 when the packages cannot be had. DICOM, Zarr and LAS are passed over where walpha was built without them.
"""

import argparse
import gzip
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from environment import enter

PACKAGES = ["numpy", "vtk", "nibabel", "pynrrd", "tifffile", "imagecodecs", "SimpleITK", "pillow", "trimesh", "scipy"]
PACKAGES += ["pydicom", "zarr", "meshio", "open3d", "pymeshlab", "laspy[lazrs]"]
# Seconds for the installation of all of them.
PATIENCE = 600


class Checker:
    def __init__(self, walpha, folder):
        self.walpha = str(pathlib.Path(walpha).resolve())
        self.folder = pathlib.Path(folder)
        self.done = self.wrong = 0

    def path(self, name):
        return str(self.folder / name)

    def run(self, *args):
        return subprocess.run([self.walpha, *map(str, args)], capture_output=True, text=True, cwd=self.folder)

    def judge(self, name, complaint):
        self.done += 1
        self.wrong += complaint is not None
        print(f"{'ok   ' if complaint is None else 'WRONG'} {name}{'' if complaint is None else ': ' + complaint}")

    def volume(self, name, file, expected, origin=(0, 0, 0), axes=None, spacing=(1, 1, 1), space=None, unit=None):
        """walpha reads `file` as these samples [z, y, x] in this frame. `axes` has unit columns."""
        axes = np.eye(3) if axes is None else np.asarray(axes, float)
        info = self.run("info", file, "--json")
        out = self.path("back.npy")
        read = self.run("haar", file, "--rms", "0", "--gray", "0..255", "-o", out)
        if info.returncode or read.returncode:
            return self.judge(name, (info.stdout if info.returncode else read.stderr).strip())
        info, found = json.loads(info.stdout), np.load(out)
        if found.shape != expected.shape:
            return self.judge(name, f"shape {found.shape}, not {expected.shape}")
        if not np.allclose(found, expected.astype(np.float64), rtol=1e-5, atol=1e-3):
            return self.judge(name, f"samples differ, e.g. {found.ravel()[:8]}, not {expected.ravel()[:8]}")
        for key, value in [("space", space), ("unit", unit)]:
            if value is not None and info[key] != value:
                return self.judge(name, f"{key} {info[key]}, not {value}")
        for key, value in [("origin", origin), ("spacing", spacing), ("direction", axes)]:
            if not np.allclose(info[key], value, rtol=1e-5, atol=1e-6):
                return self.judge(name, f"{key} {info[key]}, not {np.asarray(value).tolist()}")
        self.judge(name, None)

    def points(self, name, file, positions, weights=None, values=None):
        out = self.path("back-points.npy")
        options = ["--weights", "column"] if weights is not None else ["--weights", "common=0"]
        read = self.run("points", file, *options, "-o", out)
        if read.returncode:
            return self.judge(name, read.stderr.strip())
        found = np.load(out)
        places = np.column_stack([found[axis] for axis in "xyz"])
        for what, column, expected in [("places", places, positions), ("weights", found["weight"], weights)]:
            if expected is not None and not np.allclose(column, expected, rtol=1e-6):
                return self.judge(name, f"{what} differ: {column[:4]}, not {expected[:4]}")
        if values is not None and ("value" not in found.dtype.names or not np.allclose(found["value"], values, rtol=1e-6)):
            return self.judge(name, f"values differ: {found[:4]}, not {values[:4]}")
        self.judge(name, None)

    def refused(self, name, file, word):
        run = self.run("haar", file)
        good = run.returncode == 1 and word in run.stderr
        self.judge(name, None if good else f"exit {run.returncode}, {run.stderr.strip()!r} without {word!r}")

    def described(self, name, file, word, refusal):
        """`info` describes what no shape is made of; what would take its samples is refused."""
        info = self.run("info", file)
        good = info.returncode == 0 and word in info.stdout
        self.judge(f"{name} described", None if good else f"exit {info.returncode}, {info.stdout!r} without {word!r}")
        self.refused(name, file, refusal)

    def lacks(self, name, file):
        """Whether walpha was built without the feature this file needs; says so."""
        lacks = "was built without" in self.run("info", file).stderr
        if lacks:
            print(f"passed over: {name}, which this walpha was built without")
        return lacks

    def equal(self, name, found, expected, tolerance=1e-6):
        found, expected = np.asarray(found), np.asarray(expected)
        if found.dtype.kind == "U":
            return self.judge(name, None if (found == expected).all() else f"{found}, not {expected}")
        if found.shape != expected.shape:
            return self.judge(name, f"shape {found.shape}, not {expected.shape}")
        good = np.allclose(found, expected, rtol=tolerance, atol=tolerance)
        self.judge(name, None if good else f"{found.ravel()[:6]}, not {expected.ravel()[:6]}")


TYPES = ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"]
ORIGIN, SPACING = (1.5, -2.0, 30.0), (0.5, 0.75, 2.0)


def samples(dtype="i2", shape=(3, 4, 5)):
    """[z, y, x]; numbers of up to 120, so that they fit each type."""
    return (np.arange(np.prod(shape)).reshape(shape) * 2).astype(dtype)


def rotation():
    """A turn by 30° about z and an odd flip of y; columns are axes."""
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.diag([1, -1, 1])


def read_nrrd(check):
    directions = rotation() * SPACING
    for dtype, endian, encoding in itertools.product(TYPES, "<>", ["raw", "gzip", "ASCII"]):
        data = samples(dtype).astype(np.dtype(dtype).newbyteorder(endian))
        header = {
            "encoding": encoding,
            "space": "left-posterior-superior",
            "space directions": directions.T,
            "space origin": np.array(ORIGIN),
        }
        for detached in [False, True]:
            file = check.path("a.nhdr" if detached else "a.nrrd")
            nrrd.write(file, data.T.copy(order="F"), header, detached_header=detached, index_order="F")
            name = f"pynrrd {dtype}{endian} {encoding}{' detached' if detached else ''}"
            check.volume(name, file, data, ORIGIN, rotation(), SPACING)
    data = samples("f4")
    nrrd.write(check.path("s.nrrd"), data.T.copy(order="F"), {"spacings": list(SPACING)})
    check.volume("pynrrd spacings", check.path("s.nrrd"), data, spacing=SPACING)
    nrrd.write(check.path("b.nrrd"), data.T.copy(order="F"), {"encoding": "bzip2"})
    check.volume("pynrrd bzip2", check.path("b.nrrd"), data)
    colour = np.zeros((3, 4, 5, 6), "u1")
    nrrd.write(check.path("c.nrrd"), colour, {"kinds": ["RGB-color", "space", "space", "space"]})
    check.described("pynrrd colours", check.path("c.nrrd"), "3 values a voxel", "only scalar")


def itk_image(data):
    image = sitk.GetImageFromArray(data)
    image.SetOrigin(ORIGIN)
    image.SetSpacing(SPACING)
    image.SetDirection(rotation().ravel())
    return image


def read_itk(check):
    for dtype in TYPES:
        data = samples(dtype)
        for extension, packed in itertools.product([".mha", ".mhd", ".nrrd", ".nhdr", ".vtk"], [False, True]):
            if extension == ".vtk" and packed:
                continue
            file = check.path("itk" + extension)
            sitk.WriteImage(itk_image(data), file, useCompression=packed)
            # ITK writes no directions to VTK files.
            axes = np.eye(3) if extension == ".vtk" else rotation()
            check.volume(f"ITK {extension} {dtype}{' packed' if packed else ''}", file, data, ORIGIN, axes, SPACING)
        file = check.path("itk.nii.gz")
        sitk.WriteImage(itk_image(data), file)
        flip = np.diag([-1, -1, 1])
        check.volume(f"ITK .nii.gz {dtype}", file, data, flip @ ORIGIN, flip @ rotation(), SPACING)
    slices = [check.path(f"slice{z}.raw") for z in range(3)]
    data = samples("u2")
    for z, file in enumerate(slices):
        data[z].tofile(file)
    head = "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_USHORT\nElementDataFile = "
    names = [os.path.basename(file) for file in slices]
    for tail in ["LIST\n" + "\n".join(names), "slice%d.raw 0 2 1"]:
        pathlib.Path(check.path("list.mhd")).write_text(head + tail + "\n")
        theirs = sitk.GetArrayFromImage(sitk.ReadImage(check.path("list.mhd")))
        check.volume(f"MetaImage {tail.split()[0]}", check.path("list.mhd"), theirs)
    head = "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_USHORT\n"
    matrices = {"TransformMatrix": "0 1 0 1 0 0 0 0 -1", "Rotation": "0 0 1 0 1 0 -1 0 0", "Orientation": "1 0 0 0 0 1 0 1 0"}
    places = {"ImagePosition": "1 2 3", "Origin": "4 5 6", "Offset": "7 8 9", "Position": "3 2 1"}
    spacings = {"ElementSpacing": "0.5 0.6 2.5", "ElementSize": "1 2 3"}
    flags = {"BinaryDataByteOrderMSB": "tomato", "ElementByteOrderMSB": "False"}
    for synonyms in [matrices, places, spacings, flags]:
        for pair in itertools.permutations(synonyms.items(), 2):
            lines = "".join(f"{key} = {value}\n" for key, value in pair)
            file = check.path("synonyms.mha")
            pathlib.Path(file).write_bytes((head + lines + "ElementDataFile = LOCAL\n").encode() + data.tobytes())
            image = sitk.ReadImage(file)
            axes = np.reshape(image.GetDirection(), (3, 3))
            name = f"MetaImage {pair[0][0]}, {pair[1][0]}"
            check.volume(name, file, sitk.GetArrayFromImage(image), image.GetOrigin(), axes, image.GetSpacing())
    rgb = sitk.GetImageFromArray(np.zeros((3, 4, 5, 3), "u1"), isVector=True)
    sitk.WriteImage(rgb, check.path("rgb.mha"))
    check.described("ITK colours", check.path("rgb.mha"), "3 values a voxel", "only scalar")


def read_nifti(check):
    affine = np.eye(4)
    affine[:3, :3] = rotation() * SPACING
    affine[:3, 3] = ORIGIN
    kinds = [(nib.Nifti1Image, ".nii"), (nib.Nifti1Image, ".nii.gz"), (nib.Nifti1Pair, ".img"), (nib.Nifti2Image, ".nii")]
    for dtype, (kind, extension), endian in itertools.product(TYPES, kinds, "<>"):
        data = samples(dtype)
        header = kind.header_class(endianness=endian)
        header.set_data_dtype(np.dtype(dtype).newbyteorder(endian))
        image = kind(data.T, affine, header)
        file = check.path("n" + extension)
        nib.save(image, file)
        file = file.replace(".img", ".hdr")
        name = f"nibabel {kind.__name__} {extension} {dtype}{endian}"
        check.volume(name, file, data, ORIGIN, rotation(), SPACING)
    for sform, qform in [(0, 1), (0, 0), (2, 0)]:
        image = nib.Nifti1Image(samples().T, affine)
        image.set_sform(affine, sform)
        image.set_qform(affine, qform)
        nib.save(image, check.path("q.nii"))
        frame = (ORIGIN, rotation(), SPACING) if sform + qform else ((0, 0, 0), np.eye(3), SPACING)
        check.volume(f"nibabel sform {sform} qform {qform}", check.path("q.nii"), samples(), *frame)
    image = nib.Nifti1Image(samples("i2").T, affine)
    image.header.set_slope_inter(0.25, -7)
    nib.save(image, check.path("scaled.nii"))
    theirs = nib.load(check.path("scaled.nii")).get_fdata().T
    check.volume("nibabel slope and intercept", check.path("scaled.nii"), theirs, ORIGIN, rotation(), SPACING)
    nib.save(nib.Nifti1Image(samples("c8").T, affine), check.path("complex.nii"))
    check.refused("nibabel complex", check.path("complex.nii"), "complex")
    nib.save(nib.Nifti1Image(np.zeros((3, 3, 3, 2), "f4"), affine), check.path("four.nii"))
    check.described("nibabel 4D", check.path("four.nii"), "2 in the file", "choose one with --frame")


def read_dicom(check):
    # Slices are counted along the normal of rows and columns.
    axes = np.column_stack([*rotation()[:, :2].T, np.cross(*rotation()[:, :2].T)])

    def series(folder, data, spoil=lambda ds, z: None):
        os.makedirs(folder)
        uid = pydicom.uid.generate_uid()
        for z, pixels in enumerate(data):
            ds = pydicom.Dataset()
            ds.file_meta = pydicom.dataset.FileMetaDataset()
            ds.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
            ds.SOPClassUID = ds.file_meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
            ds.SOPInstanceUID = ds.file_meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
            ds.SeriesInstanceUID, ds.StudyInstanceUID, ds.Modality = uid, uid, "CT"
            ds.Rows, ds.Columns = pixels.shape
            ds.PixelSpacing = [SPACING[1], SPACING[0]]
            ds.ImageOrientationPatient = [round(float(v), 9) for v in rotation()[:, :2].T.ravel()]
            at = ORIGIN + axes[:, 2] * SPACING[2] * z
            ds.ImagePositionPatient = [round(float(v), 9) for v in at]
            ds.SamplesPerPixel, ds.PhotometricInterpretation = 1, "MONOCHROME2"
            ds.BitsAllocated = ds.BitsStored = 8 * pixels.dtype.itemsize
            ds.HighBit, ds.PixelRepresentation = ds.BitsStored - 1, int(pixels.dtype.kind == "i")
            ds.PixelData = pixels.tobytes() + b"\0" * (pixels.nbytes % 2)
            spoil(ds, z)
            # Names in the wrong order.
            ds.save_as(os.path.join(folder, f"{(5 * z + 2) % 7}.dcm"), enforce_file_format=True)
        return folder

    def rescaled(ds, z):
        ds.RescaleSlope, ds.RescaleIntercept = "0.5", "-1024"

    def packed(ds, z):
        ds.compress(pydicom.uid.RLELossless, encoding_plugin="pydicom")

    flavours = [("u1", None), ("i2", None), ("u2", None), ("i2", rescaled), ("i2", packed), ("u1", packed)]
    for number, (dtype, spoil) in enumerate(flavours):
        data = samples(dtype)
        folder = series(check.path(f"dicom{number}"), data, spoil or (lambda ds, z: None))
        name = f"DICOM {dtype} {spoil.__name__ if spoil else 'raw'}"
        if check.lacks("DICOM", folder):
            return
        if spoil is not packed:
            reader = sitk.ImageSeriesReader()
            reader.SetFileNames(reader.GetGDCMSeriesFileNames(folder))
            theirs = reader.Execute()
            frame = (theirs.GetOrigin(), np.reshape(theirs.GetDirection(), (3, 3)), theirs.GetSpacing())
            check.volume(f"{name}: as ITK", folder, sitk.GetArrayFromImage(theirs), *frame)
        check.volume(f"{name}: as written", folder, data * 0.5 - 1024 if spoil is rescaled else data, ORIGIN, axes, SPACING)
    for name, data in (("one file", samples("i2")), ("one file, RLE", samples("u2"))):
        # Enhanced CT: frames in any order, elements in functional groups.
        order = np.random.default_rng(7).permutation(len(data))

        def framed(ds, _):
            def groups(**elements):
                outer = pydicom.Dataset()
                for sequence, inner in elements.items():
                    item = pydicom.Dataset()
                    for key, value in inner.items():
                        setattr(item, key, value)
                    setattr(outer, sequence, [item])
                return outer

            ds.SOPClassUID = ds.file_meta.MediaStorageSOPClassUID = pydicom.uid.EnhancedCTImageStorage
            measures = {"PixelSpacing": ds.PixelSpacing, "SliceThickness": SPACING[2]}
            turned = {"ImageOrientationPatient": ds.ImageOrientationPatient}
            ds.SharedFunctionalGroupsSequence = [groups(PixelMeasuresSequence=measures, PlaneOrientationSequence=turned)]
            places = [[round(float(v), 9) for v in ORIGIN + axes[:, 2] * SPACING[2] * z] for z in order]
            values = [{"RescaleSlope": 2, "RescaleIntercept": int(z), "RescaleType": "HU"} for z in order]
            ds.PerFrameFunctionalGroupsSequence = [
                groups(PlanePositionSequence={"ImagePositionPatient": place}, PixelValueTransformationSequence=value)
                for place, value in zip(places, values)
            ]
            for element in ("PixelSpacing", "ImageOrientationPatient", "ImagePositionPatient"):
                delattr(ds, element)
            ds.NumberOfFrames, (_, ds.Rows, ds.Columns) = len(data), data.shape
            ds.PixelData = data[order].tobytes() + b"\0" * (data.nbytes % 2)
            if "RLE" in name:
                packed(ds, 0)

        folder = series(check.path(f"dicom {name}"), data[:1], framed)
        expected = 2.0 * data + np.arange(len(data))[:, None, None]
        check.volume(f"DICOM frames in {name}", folder, expected, ORIGIN, axes, SPACING)
    folder = series(check.path("dicom-gap"), samples("i2", (5, 4, 5)))
    # The third of five, by the names given above.
    os.remove(os.path.join(folder, f"{(5 * 2 + 2) % 7}.dcm"))
    check.refused("DICOM with a slice missing", folder, "slices missing: 1")
    read_values_of_dicom(check, series, axes)


def read_values_of_dicom(check, series, axes):
    """What stored pixels mean, as pydicom has it."""

    def table(first, entries, bits):
        def spoil(ds, z):
            lut = pydicom.Dataset()
            lut.LUTDescriptor, lut.ModalityLUTType = [len(entries) % 2**16, first, bits], "US"
            lut["LUTDescriptor"].VR = "SS" if first < 0 else "US"
            lut.add_new(0x00283006, "OW", np.asarray(entries, "<u2").tobytes())
            ds.ModalityLUTSequence = [lut]

        return spoil

    def bits(stored, high, signed):
        def spoil(ds, z):
            ds.BitsStored, ds.HighBit, ds.PixelRepresentation = stored, high, int(signed)
            if high == stored - 1:
                # What is above is not of the pixel.
                ds.PixelData = (np.frombuffer(ds.PixelData, "<u2") & 0x0FFF).tobytes()

        return spoil

    def of_frame(ds, z):
        ds.RescaleSlope, ds.RescaleIntercept = 1 + z, -10 * z

    def floating(ds, z):
        values = np.frombuffer(ds.PixelData, "<i2")[: ds.Rows * ds.Columns].astype("<f4") / 8
        del ds.PixelData, ds.BitsStored, ds.HighBit, ds.PixelRepresentation
        ds.BitsAllocated, ds.FloatPixelData = 32, values.tobytes()

    def big_endian(ds, z):
        ds.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRBigEndian
        ds.PixelData = np.frombuffer(ds.PixelData, "<i2").astype(">i2").tobytes()

    small = samples("u1")
    kinds = [
        ("a table", small, table(0, 3 * np.arange(256) + 1000, 16)),
        ("a table from 40 on", small, table(40, 7 * np.arange(50), 16)),
        ("a table from below 0 on", samples("i2") % 50 - 25, table(-9, 5 * np.arange(20), 16)),
        ("a table of 65536", samples("i2"), table(-32768, np.arange(65536), 16)),
        ("a table of 8 bits in words", small, table(0, 255 - np.arange(256), 8)),
        ("12 bits", samples("u2") * 30, bits(12, 11, False)),
        ("12 signed bits", samples("i2") * 17 - 1000, bits(12, 11, True)),
        ("a slope of each slice", samples("i2"), of_frame),
        ("Float Pixel Data", samples("i2"), floating),
        ("big endian", samples("i2"), big_endian),
    ]
    for name, data, spoil in kinds:
        folder = series(check.path(f"dicom {name}"), data.astype(data.dtype.str), spoil)
        slices = [pydicom.dcmread(path) for path in pathlib.Path(folder).iterdir()]
        slices.sort(key=lambda ds: float(np.dot(ds.ImagePositionPatient, axes[:, 2])))
        # Wide enough for the difference to the first entry of a table.
        pixels = [ds.pixel_array if "FloatPixelData" in ds else ds.pixel_array.astype("i4") for ds in slices]
        theirs = np.stack([pydicom.pixels.apply_modality_lut(*pair) for pair in zip(pixels, slices)])
        check.volume(f"DICOM with {name}", folder, theirs, ORIGIN, axes, SPACING)

    def padded(ds, z):
        ds.add_new(0x00280120, "SS", int(np.frombuffer(ds.PixelData, "<i2")[0]))

    data = samples("i2")
    folder = series(check.path("dicom padding"), data, padded)
    stored = np.stack([plane == plane.ravel()[0] for plane in data])
    check.volume("DICOM with padding", folder, np.where(stored, data[~stored].min(), data), ORIGIN, axes, SPACING)


def read_zarr(check):
    for number, (dtype, version) in enumerate(itertools.product(TYPES, [2, 3])):
        file = check.path(f"z{number}.zarr")
        data = samples(dtype)
        array = zarr.create_array(file, shape=data.shape, chunks=(2, 3, 2), dtype=data.dtype, zarr_format=version)
        array[:] = data
        if check.lacks("Zarr", file):
            return
        check.volume(f"Zarr {version} {dtype}", file, data)
    file = check.path("sharded.zarr")
    array = zarr.create_array(file, shape=(6, 8, 4), shards=(4, 4, 4), chunks=(2, 2, 2), dtype="i2")
    array[:] = samples("i2", (6, 8, 4))
    check.volume("Zarr sharded", file, samples("i2", (6, 8, 4)))
    data = samples("i2")
    for version, named in itertools.product([2, 3], ["xyz", "yzx", "zyx", "xzy"]):
        file = check.path(f"{named}{version}.zarr")
        turned = data.transpose(["zyx".index(name) for name in named])
        names = {"dimension_names": list(named)} if version == 3 else {}
        array = zarr.create_array(file, shape=turned.shape, chunks=(2, 3, 2), dtype="i2", zarr_format=version, **names)
        array[:] = turned
        if version == 2:
            array.attrs["_ARRAY_DIMENSIONS"] = list(named)
        check.volume(f"Zarr {version} axes {named}", file, data)
    for name, options in [("order F", {"order": "F"}), ("separator /", {"dimension_separator": "/"}), ("no fill", {"fill_value": None})]:
        file = check.path(f"{name.replace(' ', '').replace('/', 's')}.zarr")
        zarr.create(store=file, shape=data.shape, chunks=(2, 3, 2), dtype="i2", zarr_format=2, **options)[...] = data
        check.volume(f"Zarr 2 {name}", file, data)
    zarr.create(store=check.path("bool.zarr"), shape=data.shape, dtype="bool", zarr_format=2)[...] = data % 3 == 0
    check.volume("Zarr 2 bool", check.path("bool.zarr"), data % 3 == 0)
    for version, wrap in [(2, lambda m: {"multiscales": m}), (3, lambda m: {"ome": {"version": "0.5", "multiscales": m}})]:
        file = check.path(f"ome{version}.zarr")
        group = zarr.open_group(file, mode="w", zarr_format=version)
        datasets = []
        for level in range(2):
            data = samples("u2", (1, 4 >> level, 4, 6))
            group.create_array(str(level), shape=data.shape, chunks=data.shape, dtype=data.dtype)[:] = data
            scale = {"type": "scale", "scale": [1, 2.0 * 2**level, 0.75, 0.5]}
            datasets.append({"path": str(level), "coordinateTransformations": [scale]})
        axes = [{"name": n, "type": "channel" if n == "c" else "space"} for n in "czyx"]
        group.attrs.update(wrap([{"axes": axes, "datasets": datasets}]))
        check.volume(f"OME-Zarr {version}", file, samples("u2", (4, 4, 6)), spacing=SPACING)
        info = json.loads(check.run("info", file, "--level", "1", "--json").stdout)
        check.equal(f"OME-Zarr {version} level 1", [info["dims"], info["spacing"]], [[6, 4, 2], [0.5, 0.75, 4.0]])


def vtk_image(data, cells=False, extent=None):
    image = vtk.vtkImageData()
    shape = np.array(data.shape) + (1 if cells else 0)
    image.SetDimensions(*map(int, shape[::-1]))
    if extent:
        image.SetExtent(*extent)
    image.SetOrigin(*ORIGIN)
    image.SetSpacing(*SPACING)
    image.SetDirectionMatrix(*rotation().ravel())
    array = numpy_to_vtk(data.ravel(), deep=1)
    array.SetName("samples")
    (image.GetCellData() if cells else image.GetPointData()).SetScalars(array)
    return image


def xml_flavours(writer_class):
    for mode, packed, encode, header, big in itertools.product(
        ["Ascii", "Binary", "Appended"], [False, True], [False, True], [32, 64], [False, True]
    ):
        if (mode == "Ascii" and (packed or header == 64 or big)) or (mode != "Appended" and encode):
            continue
        writer = writer_class()
        getattr(writer, "SetDataModeTo" + mode)()
        writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
        writer.SetEncodeAppendedData(encode)
        getattr(writer, f"SetHeaderTypeToUInt{header}")()
        (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
        yield f"{mode}{' zlib' if packed else ''}{' base64' if encode else ''} {header}{' big' if big else ''}", writer


def save(writer, data, file):
    writer.SetInputData(data)
    writer.SetFileName(file)
    assert writer.Write() == 1


def read_vtk(check):
    file = check.path("v.vti")
    for flavour, writer in xml_flavours(vtk.vtkXMLImageDataWriter):
        save(writer, vtk_image(samples("f4")), file)
        check.volume(f"VTI {flavour}", file, samples("f4"), ORIGIN, rotation(), SPACING)
    large = samples("i4", (40, 41, 42)) % 251
    for flavour, writer in xml_flavours(vtk.vtkXMLImageDataWriter):
        writer.SetBlockSize(8192)
        save(writer, vtk_image(large), file)
        check.volume(f"VTI in blocks {flavour}", file, large, ORIGIN, rotation(), SPACING)
    for dtype in TYPES:
        save(vtk.vtkXMLImageDataWriter(), vtk_image(samples(dtype)), file)
        check.volume(f"VTI {dtype}", file, samples(dtype), ORIGIN, rotation(), SPACING)
        for text in [True, False]:
            writer = vtk.vtkStructuredPointsWriter()
            writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
            image = vtk_image(samples(dtype))
            save(writer, image, check.path("v.vtk"))
            name = f"legacy VTK {'text' if text else 'binary'} {dtype}"
            back = vtk.vtkStructuredPointsReader()
            back.SetFileName(check.path("v.vtk"))
            back.Update()
            axes = np.array([back.GetOutput().GetDirectionMatrix().GetElement(i, j) for i in range(3) for j in range(3)])
            check.volume(name, check.path("v.vtk"), samples(dtype), ORIGIN, axes.reshape(3, 3), SPACING)
            image.GetPointData().SetActiveScalars(None)
            save(writer, image, check.path("field.vtk"))
            check.volume(name + " field", check.path("field.vtk"), samples(dtype), ORIGIN, axes.reshape(3, 3), SPACING)
    half = rotation() @ (np.array(SPACING) / 2)
    save(vtk.vtkXMLImageDataWriter(), vtk_image(samples(), cells=True), file)
    check.volume("VTI of cells", file, samples(), np.array(ORIGIN) + half, rotation(), SPACING)
    save(vtk.vtkXMLImageDataWriter(), vtk_image(samples(), extent=(2, 6, -1, 2, 3, 5)), file)
    corner = np.array(ORIGIN) + rotation() @ (np.array(SPACING) * [2, -1, 3])
    check.volume("VTI with an extent", file, samples(), corner, rotation(), SPACING)
    writer = vtk.vtkXMLImageDataWriter()
    writer.SetCompressorTypeToLZ4()
    save(writer, vtk_image(samples()), file)
    check.volume("VTI LZ4", file, samples(), ORIGIN, rotation(), SPACING)
    for flavour, writer in xml_flavours(vtk.vtkXMLImageDataWriter):
        if "zlib" in flavour:
            writer.SetCompressorTypeToLZ4()
            writer.SetBlockSize(8192)
            save(writer, vtk_image(large), file)
            check.volume(f"VTI LZ4 in blocks {flavour}", file, large, ORIGIN, rotation(), SPACING)


def read_tiff(check):
    for dtype in TYPES:
        for name, options in [
            ("plain", {}),
            ("BigTIFF", {"bigtiff": True}),
            ("big endian", {"byteorder": ">"}),
            ("deflate", {"compression": "zlib"}),
            ("deflate with predictor", {"compression": "zlib", "predictor": True}),
            ("LZW", {"compression": "lzw"}),
            ("PackBits", {"compression": "packbits"}),
            ("tiles", {"tile": (16, 16)}),
            ("strips", {"rowsperstrip": 2}),
        ]:
            data = samples(dtype)
            if "predictor" in options:
                options = {**options, "predictor": 3 if dtype[0] == "f" else 2}
            tifffile.imwrite(check.path("t.tif"), data, photometric="minisblack", **options)
            check.volume(f"tifffile {name} {dtype}", check.path("t.tif"), data)
    for dtype in ["u1", "u2", "f4"]:
        data = samples(dtype)
        options = {"resolution": (1 / 0.5, 1 / 0.75), "metadata": {"spacing": 2.0, "unit": "um", "axes": "ZYX"}}
        tifffile.imwrite(check.path("ij.tif"), data, imagej=True, **options)
        check.volume(f"ImageJ {dtype}", check.path("ij.tif"), data, spacing=SPACING)
        tifffile.imwrite(check.path("ij.tif"), data, imagej=True)
        check.volume(f"ImageJ without axes {dtype}", check.path("ij.tif"), data)
        metadata = {"axes": "ZYX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 0.75, "PhysicalSizeZ": 2.0}
        tifffile.imwrite(check.path("o.ome.tif"), data, metadata=metadata)
        check.volume(f"OME {dtype}", check.path("o.ome.tif"), data, spacing=SPACING)
    for dtype, options in itertools.product(["u1", "u2", "i2", "f4", "f8"], [{}, {"bigtiff": True, "byteorder": ">"}]):
        data = samples(dtype)
        tifffile.imwrite(check.path("w.tif"), data, photometric="miniswhite", **options)
        theirs = tifffile.imread(check.path("w.tif"))
        check.volume(f"tifffile 0 is white {dtype} {options}", check.path("w.tif"), theirs)
    latin = b"ImageJ=1.53\nimages=3\nslices=3\nunit=\xb5m\nspacing=2.0\n"
    options = {"metadata": None, "photometric": "minisblack", "resolution": (1 / 0.5, 1 / 0.75), "resolutionunit": 1}
    tifffile.imwrite(check.path("l.tif"), samples("u2"), description=latin, **options)
    check.volume("ImageJ in Latin-1", check.path("l.tif"), samples("u2"), spacing=SPACING, unit="µm")
    with tifffile.TiffWriter(check.path("thumb.tif")) as writer:
        for page in samples("u2"):
            writer.write(page, contiguous=False)
        writer.write(samples("u2")[0, :2, :2], subfiletype=1)
    check.volume("tifffile with a thumbnail", check.path("thumb.tif"), samples("u2"))
    tifffile.imwrite(check.path("p.tif"), samples("u1")[0], photometric="palette", colormap=np.zeros((3, 256), "u2"))
    check.refused("tifffile palette", check.path("p.tif"), "palette of colours")
    one_page_imagej(check)
    tifffile.imwrite(check.path("rgb.tif"), np.zeros((3, 4, 5, 3), "u1"), photometric="rgb")
    check.described("tifffile colours", check.path("rgb.tif"), "colours", "only gray")
    tifffile.imwrite(check.path("hyper.tif"), np.zeros((2, 3, 4, 5), "u1"), imagej=True, metadata={"axes": "TZYX"})
    check.described("ImageJ hyperstack", check.path("hyper.tif"), "2 in the file", "choose one with --frame")


def one_page_imagej(check):
    """As ImageJ writes stacks beyond 4 GB: all samples behind the first page."""
    data = samples("u2").astype(">u2")
    text = b"ImageJ=1.53t\nimages=3\nslices=3\nspacing=2.0\nloop=false\n\0"
    tags = [(256, 4, 1, 5), (257, 4, 1, 4), (258, 3, 1, 16 << 16), (259, 3, 1, 1 << 16), (262, 3, 1, 1 << 16)]
    after = 8 + 2 + 12 * 11 + 4
    tags += [(270, 2, len(text), after), (273, 4, 1, after + len(text)), (277, 3, 1, 1 << 16), (278, 3, 1, 4 << 16)]
    tags += [(279, 4, 1, 40), (339, 3, 1, 1 << 16)]
    head = b"MM\0*" + (8).to_bytes(4, "big") + len(tags).to_bytes(2, "big")
    for tag, kind, count, value in tags:
        head += tag.to_bytes(2, "big") + kind.to_bytes(2, "big") + count.to_bytes(4, "big") + value.to_bytes(4, "big")
    pathlib.Path(check.path("large.tif")).write_bytes(head + bytes(4) + text + data.tobytes())
    theirs = tifffile.imread(check.path("large.tif"))
    check.volume("ImageJ behind one page", check.path("large.tif"), theirs, spacing=(1, 1, 2))


def read_slices(check):
    for extension, dtype in [("png", "u1"), ("png", "u2"), ("tif", "u1"), ("tif", "f4"), ("jpg", "u1")]:
        folder = pathlib.Path(check.path(f"slices-{extension}-{dtype}"))
        folder.mkdir()
        data = samples(dtype, (12, 8, 16))
        data[:] = np.arange(12).reshape(12, 1, 1) * 20
        for z, page in enumerate(data):
            Image.fromarray(page).save(folder / f"s{z}.{extension}")
        (folder / "notes.txt").write_text("not a slice")
        check.volume(f"folder of {extension} {dtype}", str(folder), data)


def read_numpy(check):
    for save_as in [np.savez, np.savez_compressed]:
        save_as(check.path("v.npz"), samples("f4"))
        check.volume(f"numpy {save_as.__name__}", check.path("v.npz"), samples("f4"))
        save_as(check.path("v.npz"), volume=samples("i2"), other=np.zeros(3))
        check.volume(f"numpy {save_as.__name__} among others", check.path("v.npz"), samples("i2"))


def write_volumes(check):
    source = check.path("source.nrrd")
    data = samples("f4")
    nrrd.write(source, data.T.copy(order="F"), {"space directions": (rotation() * SPACING).T, "space origin": ORIGIN, "space dimension": 3})
    affine = rotation() * SPACING
    for extension in ["nrrd", "nii", "nii.gz", "mha", "vti", "npy", "raw"]:
        made = check.run("haar", source, "--rms", "0", "--gray", "0..255", "-o", check.path("out." + extension))
        check.judge(f"walpha writes .{extension}", made.stderr.strip() if made.returncode else None)
    back, header = nrrd.read(check.path("out.nrrd"))
    check.equal("pynrrd reads ours", back.T, data, 1e-4)
    check.equal("pynrrd directions", header["space directions"].T, affine)
    check.equal("pynrrd origin", header["space origin"], ORIGIN)
    for extension in ["nrrd", "mha"]:
        image = sitk.ReadImage(check.path("out." + extension))
        check.equal(f"ITK reads our {extension}", sitk.GetArrayFromImage(image), data, 1e-4)
        check.equal(f"ITK directions of our {extension}", np.reshape(image.GetDirection(), (3, 3)), rotation())
    for extension in ["nii", "nii.gz"]:
        image = nib.load(check.path("out." + extension))
        check.equal(f"nibabel reads our {extension}", image.get_fdata().T, data, 1e-4)
        check.equal(f"nibabel affine of our {extension}", image.affine[:3], np.column_stack([affine, ORIGIN]))
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(check.path("out.vti"))
    reader.Update()
    image = reader.GetOutput()
    check.equal("VTK reads our vti", vtk_to_numpy(image.GetPointData().GetScalars()).reshape(data.shape), data, 1e-4)
    matrix = [image.GetDirectionMatrix().GetElement(i, j) for i in range(3) for j in range(3)]
    check.equal("VTK frame of our vti", [*image.GetOrigin(), *image.GetSpacing(), *matrix], [*ORIGIN, *SPACING, *rotation().ravel()])
    check.equal("numpy reads our npy", np.load(check.path("out.npy")), data, 1e-4)
    check.equal("numpy reads our raw", np.fromfile(check.path("out.raw"), "<f4").reshape(data.shape), data, 1e-4)
    for z, dtype in [(40000, "f4")]:
        long = samples(dtype, (1, 2, z)) % 100
        np.save(check.path("long.npy"), long)
        check.run("haar", check.path("long.npy"), "--rms", "0", "--gray", "0..255", "-o", check.path("long.nii"))
        image = nib.load(check.path("long.nii"))
        check.judge("our long volumes are NIfTI-2", None if isinstance(image, nib.Nifti2Image) else str(type(image)))
        check.equal("nibabel reads our NIfTI-2", image.get_fdata().T, long, 1e-3)
        check.volume("walpha reads our NIfTI-2", check.path("long.nii"), long)


def itk_place(image, index):
    """Where a voxel is, as ITK sees it: LPS, in millimetres."""
    return image.TransformContinuousIndexToPhysicalPoint([float(i) for i in index])


def vtk_place(check, file, index):
    """The same as VTK sees our file, which must say that it is LPS."""
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(file)
    reader.Update()
    image = reader.GetOutput()
    space, unit = [image.GetFieldData().GetAbstractArray(name).GetValue(0) for name in ["SPACE", "UNIT"]]
    check.judge("VTK finds the space of our vti", None if space == "LPS" else space)
    place = [0.0] * 3
    image.TransformContinuousIndexToPhysicalPoint(list(map(float, index)), place)
    return np.array(place) * {"mm": 1, "um": 0.001}[unit]


def keep_places(check):
    """A voxel keeps its place in the patient and its value, over all pairs of formats, as ITK reads it."""
    data = np.random.default_rng(3).integers(-1000, 2000, (3, 4, 5)).astype("i2")
    index = (3, 1, 2)
    image = itk_image(data)
    truth = itk_place(image, index)
    sources = {}
    for extension in ["nrrd", "nii", "nii.gz", "mha", "mhd"]:
        sources[f"ITK {extension}"] = check.path("place." + extension)
        sitk.WriteImage(image, sources[f"ITK {extension}"])
    axes, flip = rotation() * SPACING, np.diag([-1, -1, 1])
    header = {"space": "RAS", "space directions": (flip @ axes).T, "space origin": flip @ ORIGIN}
    sources["pynrrd RAS"] = check.path("ras.nrrd")
    nrrd.write(sources["pynrrd RAS"], data.T.copy(order="F"), header)
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = flip @ axes * 1000, flip @ ORIGIN * 1000
    small = nib.Nifti1Image(data.T, affine)
    small.header.set_xyzt_units("micron")
    sources["nibabel micrometres"] = check.path("small.nii")
    nib.save(small, sources["nibabel micrometres"])
    outputs = ["nrrd", "nii", "nii.gz", "mha", "vti"]
    for name, source in list(sources.items()):
        for extension in outputs:
            made = check.path("made." + extension)
            run = check.run("haar", source, "--rms", "0", "-o", made)
            if run.returncode:
                check.judge(f"{name} to {extension}", run.stderr.strip())
                continue
            for again in outputs:
                twice = check.path("twice." + again)
                check.run("haar", made, "--rms", "0", "-o", twice)
                if again == "vti":
                    check.equal(f"{name} to {extension} to vti", vtk_place(check, twice, index), truth, 1e-4)
                    continue
                theirs = sitk.ReadImage(twice)
                check.equal(f"{name} to {extension} to {again}: place", itk_place(theirs, index), truth, 1e-4)
                check.equal(f"{name} to {extension} to {again}: values", sitk.GetArrayFromImage(theirs), data, 1e-3)
    written = nib.load(check.path("twice.nii"))
    # The last source is in micrometres, and NIfTI has a word for them.
    check.equal("nibabel's units of ours", [str(u) for u in written.header.get_xyzt_units()], ["micron", "unknown"])
    for name, space, unit in [("ITK nrrd", "LPS", "mm"), ("ITK mha", "LPS", "mm"), ("ITK nii", "RAS", "mm"), ("nibabel micrometres", "RAS", "µm")]:
        info = json.loads(check.run("info", sources[name], "--json").stdout)
        check.judge(f"info of {name}", None if (info["space"], info["unit"]) == (space, unit) else str(info))


def part_of_several(check):
    """Volumes of four axes, arrays by name, NaN and TIFF, against the programs that know them."""
    data = np.random.default_rng(5).integers(0, 900, (2, 3, 4, 5)).astype("i2")
    nib.save(nib.Nifti1Image(data.T, np.eye(4)), check.path("four.nii.gz"))
    nrrd.write(check.path("four.nrrd"), data.T.copy(order="F"), {"kinds": ["domain"] * 3 + ["time"]})
    sitk.WriteImage(sitk.GetImageFromArray(data, isVector=False), check.path("four.mha"))
    np.save(check.path("four.npy"), data)
    tifffile.imwrite(check.path("four.tif"), data, imagej=True, metadata={"axes": "TZYX"})
    tifffile.imwrite(check.path("channels.tif"), data.swapaxes(0, 1), imagej=True, metadata={"axes": "ZCYX"})
    tifffile.imwrite(check.path("four.ome.tif"), data, metadata={"axes": "CZYX"})
    for name in ["four.nii.gz", "four.nrrd", "four.mha", "four.npy", "four.tif", "channels.tif", "four.ome.tif"]:
        for frame in range(2):
            run = check.run("haar", check.path(name), "--frame", frame, "--rms", "0", "-o", check.path("frame.npy"))
            if run.returncode:
                check.judge(f"{name} frame {frame}", run.stderr.strip())
            else:
                check.equal(f"{name} frame {frame}", np.load(check.path("frame.npy")), data[frame], 1e-3)
    both = vtk_image(samples("f4"))
    for name, values in [("second", samples("f4") * 3), ("cells", np.ones((2, 3, 4), "f4"))]:
        array = numpy_to_vtk(values.ravel(), deep=1)
        array.SetName(name)
        (both.GetCellData() if name == "cells" else both.GetPointData()).AddArray(array)
    for writer, name in [(vtk.vtkXMLImageDataWriter(), "both.vti"), (vtk.vtkStructuredPointsWriter(), "both.vtk")]:
        save(writer, both, check.path(name))
        for array, top in [("samples", 118), ("second", 354), ("cells", 1)]:
            info = json.loads(check.run("info", check.path(name), "--array", array, "--json").stdout or "{}")
            check.equal(f"VTK {name} array {array}", info.get("max", -1), top)
        check.equal(f"VTK {name}: points before cells", json.loads(check.run("info", check.path(name), "--json").stdout)["max"], 118)
    sitk.WriteImage(itk_image(samples("f4")), check.path("t.nrrd"))
    check.run("haar", check.path("t.nrrd"), "--rms", "0", "-o", check.path("ours.tif"))
    with tifffile.TiffFile(check.path("ours.tif")) as file:
        check.equal("tifffile reads our tif", file.asarray(), samples("f4"), 1e-4)
        told = file.imagej_metadata
        check.equal("ImageJ's words in our tif", [told["spacing"], told["slices"], told["unit"] == "mm"], [2.0, 3, 1])
        n, d = file.pages[0].tags["XResolution"].value
        check.equal("resolution of our tif", n / d, 2.0)
    image = sitk.GetArrayFromImage(sitk.ReadImage(check.path("ours.tif")))
    check.equal("ITK reads our tif", image, samples("f4"), 1e-4)


def cloud():
    positions = np.random.default_rng(7).random((50, 3)) * 10
    return positions, np.arange(50.0), np.linspace(-1, 1, 50)


def read_points(check):
    positions, weights, values = cloud()
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(positions, deep=1))
    for kind, extension, writer_class in [
        (vtk.vtkUnstructuredGrid, "vtu", vtk.vtkXMLUnstructuredGridWriter),
        (vtk.vtkPolyData, "vtp", vtk.vtkXMLPolyDataWriter),
    ]:
        data = kind()
        data.SetPoints(points)
        for name, column in [("weight", weights), ("temperature", values)]:
            array = numpy_to_vtk(column, deep=1)
            array.SetName(name)
            data.GetPointData().AddArray(array)
        data.GetPointData().SetActiveScalars("temperature")
        for flavour, writer in xml_flavours(writer_class):
            file = check.path("p." + extension)
            save(writer, data, file)
            check.points(f"{extension} {flavour}", file, positions, weights, values)
    for text, big in [(True, False), (False, False), (False, True)]:
        writer = vtk.vtkPLYWriter()
        writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
        writer.SetDataByteOrderToBigEndian() if big else writer.SetDataByteOrderToLittleEndian()
        sphere = vtk.vtkSphereSource()
        sphere.Update()
        save(writer, sphere.GetOutput(), check.path("s.ply"))
        expected = vtk_to_numpy(sphere.GetOutput().GetPoints().GetData())
        check.points(f"VTK PLY text={text} big={big}", check.path("s.ply"), expected)
    for encoding in ["ascii", "binary"]:
        mesh = trimesh.creation.icosphere(2)
        mesh.export(check.path("t.ply"), encoding=encoding)
        check.points(f"trimesh PLY {encoding}", check.path("t.ply"), mesh.vertices)
    for name, separator in [("p.csv", ","), ("p.tsv", "\t")]:
        rows = np.column_stack([positions, weights, values])
        np.savetxt(check.path(name), rows, delimiter=separator, header=separator.join(["x", "y", "z", "weight", "value"]), comments="")
        check.points(f"numpy {name}", check.path(name), positions, weights, values)
    np.savetxt(check.path("p.xyz"), np.column_stack([positions, values]))
    check.points("numpy p.xyz", check.path("p.xyz"), positions, values=values)
    read_point_arrays(check)
    read_point_texts(check)
    read_meshes(check)


def read_point_arrays(check):
    positions, weights, values = cloud()
    for name, order in [("c.npy", "C"), ("f.npy", "F")]:
        np.save(check.path(name), np.asarray(np.column_stack([positions, values]), order=order))
        check.points(f"numpy n×4 in order {order}", check.path(name), positions, values=values)
    fields = np.rec.fromarrays([values, *positions.T, weights], names="intensity,x,y,z,weight")
    np.save(check.path("fields.npy"), fields)
    check.points("numpy fields", check.path("fields.npy"), positions, weights, values)


def read_point_texts(check):
    """Numbers and encodings as programs of other locales write them."""
    positions, _, values = cloud()
    rows = np.column_stack([np.round(positions, 4), values])

    def text(separator, comma):
        return "".join(separator.join(map(str, row)) + "\n" for row in rows.tolist()).replace(".", "," if comma else ".")

    for name, content in [
        ("comma.xyz", text(" ", True).encode()),
        ("comma.tsv", text("\t", True).encode()),
        ("semicolon.csv", ("x;y;z;value\n" + text(";", True)).encode("utf-16")),
        ("cc.txt", f"//X;Y;Z;Intensity\n{len(rows)}\n{text(';', False)}".encode("latin-1")),
        ("cr.xyz", text(" ", False).replace("\n", "\r").encode()),
        ("p.xyz.gz", gzip.compress(text(" ", False).encode())),
    ]:
        pathlib.Path(check.path(name)).write_bytes(content)
        check.points(name, check.path(name), rows[:, :3], values=values)


def read_meshes(check):
    mesh = trimesh.creation.icosphere(2)
    for extension in ["off", "obj"]:
        mesh.export(check.path("m." + extension))
        check.points(f"trimesh {extension}", check.path("m." + extension), mesh.vertices)
    corners = mesh.triangles.reshape(-1, 3).astype("f4").astype("f8")
    first = np.sort(np.unique(corners, axis=0, return_index=True)[1])
    for kind in ["stl", "stl_ascii"]:
        mesh.export(check.path("m.stl"), file_type=kind)
        check.points(f"trimesh {kind}", check.path("m.stl"), corners[first])


def read_las(check):
    positions, _, _ = cloud()
    for version, record, extension in itertools.product(["1.2", "1.4"], [3, 6], ["las", "laz"]):
        if version == "1.2" and record == 6:
            continue
        las = laspy.create(file_version=version, point_format=record)
        las.header.scales = [1e-6] * 3
        las.xyz = positions
        las.intensity = np.arange(len(positions))
        las.withheld = np.arange(len(positions)) % 7 == 3
        file = check.path(f"p.{extension}")
        las.write(file)
        if check.lacks("LAS", file):
            return
        kept = laspy.read(file)
        kept = kept.points[kept.withheld == 0]
        places = np.column_stack([kept.x, kept.y, kept.z])
        check.points(f"laspy {version}, {record}, {extension}", file, places, values=np.asarray(kept.intensity))


def scattered(check):
    """L against SciPy's Delaunay triangulation, which is unique for points in general position."""
    positions, _, values = cloud()
    np.savetxt(check.path("s.xyz"), np.column_stack([positions, values]))
    made = check.run("points", "s.xyz", "--weights", "min-max", "--alpha", "10", "-o", check.path("s.npy"))
    if made.returncode:
        return check.judge("scattered values", made.stderr.strip())
    starts, neighbours = Delaunay(positions).vertex_neighbor_vertices
    around = [neighbours[starts[i] : starts[i + 1]] for i in range(50)]
    mean = np.array([np.abs(values[i] - values[n]).mean() for i, n in enumerate(around)])
    weights = 10 * (mean - mean.min()) / (mean.max() - mean.min())
    check.equal("scattered values against SciPy", np.load(check.path("s.npy"))["weight"], weights)


def write_shapes(check):
    files = [check.path("shape." + e) for e in ["ply", "off", "obj", "stl", "glb", "vtu", "vtp", "npz"]]
    run = check.run("shape", "sample:phantom@24", "--weights", "min-max", "--json", "-o", *files)
    if run.returncode:
        return check.judge("walpha writes shapes", run.stderr.strip())
    arrays = np.load(check.path("shape.npz"))
    regular = arrays["facets"][arrays["facet_classes"] == 2]
    singular = arrays["facets"][arrays["facet_classes"] == 3]
    corners = arrays["points"][regular]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    cells = arrays["points"][arrays["cells"]]
    of_cells = np.abs(np.linalg.det(cells[:, 1:] - cells[:, :1])).sum() / 6
    check.equal("volume inside the boundary is that of the cells", volume, of_cells)
    check.equal("and the one reported", json.loads(run.stdout)["shape"]["volume"], of_cells)
    for extension, count in [("ply", len(regular) + len(singular)), ("off", len(regular) + len(singular)), ("stl", len(regular))]:
        mesh = trimesh.load(check.path("shape." + extension), process=False)
        check.equal(f"trimesh counts facets of our {extension}", len(mesh.faces), count)
        if extension == "stl":
            check.equal("trimesh finds the volume of our stl", mesh.volume, of_cells, 1e-4)
    scene = trimesh.load(check.path("shape.glb"))
    faces = sum(len(g.faces) for g in scene.geometry.values() if hasattr(g, "faces"))
    check.equal("trimesh counts facets of our glb", faces, len(regular) + len(singular))
    for extension, reader in [
        ("vtu", vtk.vtkXMLUnstructuredGridReader()),
        ("vtp", vtk.vtkXMLPolyDataReader()),
        ("ply", vtk.vtkPLYReader()),
        ("stl", vtk.vtkSTLReader()),
        ("obj", vtk.vtkOBJReader()),
    ]:
        reader.SetFileName(check.path("shape." + extension))
        reader.Update()
        data = reader.GetOutput()
        if extension == "vtu":
            classes = vtk_to_numpy(data.GetCellData().GetArray("class"))
            expected = np.concatenate([arrays[k + "_classes"] for k in ["vertex", "edge", "facet", "cell"]])
            check.equal("VTK reads the classes of our vtu", classes, expected)
            inputs = vtk_to_numpy(data.GetPointData().GetArray("input_index"))
            check.equal("VTK reads the points of our vtu", vtk_to_numpy(data.GetPoints().GetData()), arrays["points"][inputs])
        else:
            expected = len(regular) + (0 if extension == "stl" else len(singular))
            found = data.GetNumberOfPolys()
            check.equal(f"VTK counts facets of our {extension}", found, expected)
        if extension == "vtp":
            inputs = vtk_to_numpy(data.GetPointData().GetArray("input_index"))
            check.equal("VTK reads the values of our vtp", vtk_to_numpy(data.GetPointData().GetArray("value")), arrays["values"][inputs])
            classes = vtk_to_numpy(data.GetCellData().GetArray("class"))
            check.equal("VTK reads the classes of our vtp", (classes == 2).sum(), len(regular))
    for extension in ["ply", "vtu", "vtp"]:
        made = check.run("points", check.path("shape." + extension), "--weights", "column")
        check.judge(f"walpha reads our {extension}", made.stderr.strip() if made.returncode else None)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--walpha", default="target/release/walpha")
    arguments.add_argument("--env", default=os.path.join(tempfile.gettempdir(), "walpha-formats"))
    arguments.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = arguments.parse_args()
    if not arguments.inside:
        enter(arguments.env, PACKAGES, PATIENCE)
    with tempfile.TemporaryDirectory() as folder:
        check = Checker(arguments.walpha, folder)
        for part in PARTS:
            part(check)
    print(f"{check.done} checks, {check.wrong} wrong")
    sys.exit(1 if check.wrong else 0)


PARTS = [read_nrrd, read_itk, read_nifti, read_vtk, read_tiff, read_slices, read_numpy, write_volumes, keep_places, part_of_several]
PARTS += [read_points, read_las, scattered, write_shapes, read_dicom, read_zarr]

if "--inside" in sys.argv:
    try:
        import check_exports
        import laspy
        import nibabel as nib
        import nrrd
        import numpy as np
        import pydicom
        import SimpleITK as sitk
        import tifffile
        import trimesh
        import vtk
        import zarr
        from PIL import Image
        from scipy.spatial import Delaunay
        from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    except ImportError as error:
        # Wheels need libraries that a system may lack.
        print(f"skipped: a Python package cannot be used ({error})")
        sys.exit(77)

    PARTS += check_exports.PARTS

if __name__ == "__main__":
    main()
