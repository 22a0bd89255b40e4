#!/usr/bin/env python3
"""Small valid files for every fuzz target, in corpus/TARGET: `python3 fuzz/seeds.py fuzz/corpus`.

Standard library only, and `walpha` for the files of plans. The fuzzer finds the rest from these.
"""

import base64
import gzip
import io
import json
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib
from pathlib import Path

N = 2 * 3 * 2
U8 = bytes(range(N))
F32 = struct.pack(f"<{N}f", *range(N))
F64 = struct.pack(f"<{3 * 4}d", *range(12))


def mgh():
    head = struct.pack(">7i", 1, 2, 3, 2, 1, 3, 0) + struct.pack(">h15f", 1, *[2, 1, 1], *[-1, 0, 0], *[0, 0, -1], *[0, 1, 0], *[3, 4, 5])
    samples = struct.pack(">12f", *range(12))
    return [head.ljust(284, b"\0") + samples, head.ljust(284, b"\0") + samples + b"TR", head]


def inrimage():
    head = "#INRIMAGE-4#{\nXDIM=2\nYDIM=3\nZDIM=2\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\nVX=1\n"
    head += "\n" * (252 - len(head)) + "##}\n"
    whole = head.encode() + F32
    short = head.replace("float", "unsigned fixed").replace("32 bits", "8 bits")
    short = short.replace("\n\n", "\n", 0).encode()
    short = short[: short.index(b"##}")].rstrip(b"\n")
    return [whole, gzip.compress(whole), short + b"\n" * (252 - len(short)) + b"##}\n" + U8]


def npy(descr, shape, data, fortran=False):
    head = f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}"
    head += " " * (63 - (10 + len(head)) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + data


def npys():
    return [npy("<f4", (2, 3, 2), F32), npy("|u1", (2, 3, 2), U8, True), npy("<f8", (3, 4), F64)]


def npz():
    files = []
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        out = io.BytesIO()
        with zipfile.ZipFile(out, "w", method) as archive:
            archive.writestr("volume.npy", npys()[0])
            archive.writestr("other.npy", npy("<f8", (12,), F64))
        files.append(out.getvalue())
    return files


def nrrd():
    head = "NRRD0004\n# a comment\ntype: {}\ndimension: 3\nsizes: 2 3 2\nendian: little\nencoding: {}\n{}\n"
    world = "space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\n"
    text = " ".join(map(str, range(N)))
    return [
        head.format("float", "raw", "spacings: 1 2 3\n").encode() + F32,
        head.format("uint8", "gzip", world).encode() + gzip.compress(U8),
        head.format("unsigned char", "ascii", world).encode() + text.encode(),
        head.format("uint8", "raw", "axis mins: 1 2 3\nkinds: domain domain domain\n").encode() + U8,
        head.format("uint8", "raw", "data file: LIST\na.raw\nb.raw\n").encode(),
        head.format("uint8", "raw", "data file: v%d.raw 0 1 1 2\n").encode(),
    ]


def metaimage():
    head = "ObjectType = Image\nNDims = 3\nDimSize = 2 3 2\nElementSpacing = 1 2 3\nOffset = 0 1 2\n"
    head += "TransformMatrix = 1 0 0 0 1 0 0 0 1\nElementType = {}\n{}ElementDataFile = {}\n"
    return [
        head.format("MET_FLOAT", "BinaryData = True\nBinaryDataByteOrderMSB = False\n", "LOCAL").encode() + F32,
        head.format("MET_UCHAR", "CompressedData = True\nCompressedDataSize = 20\n", "LOCAL").encode()
        + zlib.compress(U8),
        head.format("MET_UCHAR", "BinaryData = False\n", "LOCAL").encode() + b"0 1 2 3 4 5 6 7 8 9 10 11",
        head.format("MET_UCHAR", "", "LIST").encode() + b"a.raw\nb.raw\n",
        head.format("MET_UCHAR", "HeaderSize = -1\n", "a.raw").encode(),
    ]


def nifti():
    one = bytearray(352)
    struct.pack_into("<i", one, 0, 348)
    struct.pack_into("<8h", one, 40, 3, 2, 3, 2, 1, 1, 1, 1)
    struct.pack_into("<hh", one, 70, 16, 32)
    struct.pack_into("<8f", one, 76, 1, 1, 2, 3, 0, 0, 0, 0)
    struct.pack_into("<fff", one, 108, 352, 2, 1)
    struct.pack_into("<hh", one, 252, 1, 0)
    one[344:348] = b"n+1\0"
    two = bytearray(544)
    struct.pack_into("<i", two, 0, 540)
    two[4:12] = b"n+2\0\r\n\x1a\n"
    struct.pack_into("<hh8q", two, 12, 2, 8, 3, 2, 3, 2, 1, 1, 1, 1)
    struct.pack_into("<8d", two, 104, 1, 1, 1, 1, 0, 0, 0, 0)
    struct.pack_into("<q", two, 168, 544)
    return [bytes(one) + F32, bytes(two) + U8]


def vtk_legacy():
    head = "# vtk DataFile Version {}\ntitle\n{}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 12\n"
    numbers = " ".join(map(str, range(N)))
    return [
        (head.format("3.0", "ASCII") + "SCALARS f float 1\nLOOKUP_TABLE default\n" + numbers).encode(),
        (head.format("5.1", "BINARY") + "METADATA\nINFORMATION 0\n\nSCALARS f unsigned_char 1\nLOOKUP_TABLE default\n").encode() + U8,
        (head.format("4.2", "BINARY") + "FIELD FieldData 1\nf 1 12 float\n").encode()
        + struct.pack(f">{N}f", *range(N)),
    ]


def xml(kind, body, tail=b"", attributes=""):
    head = f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt32"{attributes}>\n'
    return head.encode() + body.encode() + tail + b"</VTKFile>\n"


def blocks(data):
    packed = zlib.compress(data)
    head = struct.pack("<4I", 1, len(data), 0, len(packed))
    return (base64.b64encode(head) + base64.b64encode(packed)).decode()


def vti():
    image = '<ImageData WholeExtent="0 1 0 2 0 1" Origin="0 0 0" Spacing="1 1 1" Direction="1 0 0 0 1 0 0 0 1"><Piece Extent="0 1 0 2 0 1"><PointData Scalars="f">{}</PointData></Piece></ImageData>\n'
    array = '<DataArray type="{}" Name="f" format="{}"{}>{}</DataArray>'
    inline = base64.b64encode(struct.pack("<I", len(F32)) + F32).decode()
    appended = b'<AppendedData encoding="raw">_' + struct.pack("<I", len(F32)) + F32 + b"</AppendedData>"
    coded = b'<AppendedData encoding="base64">_' + inline.encode() + b"</AppendedData>"
    zlib_ = ' compressor="vtkZLibDataCompressor"'
    return [
        xml("ImageData", image.format(array.format("Float32", "ascii", "", " ".join(map(str, range(N)))))),
        xml("ImageData", image.format(array.format("Float32", "binary", "", inline))),
        xml("ImageData", image.format(array.format("Float32", "appended", ' offset="0"', "")), appended),
        xml("ImageData", image.format(array.format("Float32", "appended", ' offset="0"', "")), coded),
        xml("ImageData", image.format(array.format("Float32", "binary", "", blocks(F32))), b"", zlib_),
    ]


def vtk_geometry():
    points = " ".join(map(str, range(12)))
    body = '<{0}><Piece NumberOfPoints="4" {1}="0"><PointData Scalars="value"><DataArray type="Float64" Name="value" format="ascii">1 2 3 4</DataArray></PointData><Points><DataArray type="Float64" NumberOfComponents="3" format="{2}">{3}</DataArray></Points></Piece></{0}>\n'
    inline = base64.b64encode(struct.pack("<I", len(F64)) + F64).decode()
    return [
        xml("PolyData", body.format("PolyData", "NumberOfPolys", "ascii", points)),
        xml("UnstructuredGrid", body.format("UnstructuredGrid", "NumberOfCells", "ascii", points)),
        xml("PolyData", body.format("PolyData", "NumberOfPolys", "binary", inline)),
        xml("PolyData", body.format("PolyData", "NumberOfPolys", "binary", "====")),
        xml("PolyData", body.format("PolyData", "NumberOfPolys", "binary", blocks(F64)), b"", ' compressor="vtkZLibDataCompressor"').replace(
            b'format="ascii">1 2 3 4', b'format="ascii">1 2 3 4'
        ),
    ]


def tiff(big=False, text=b"", packed=False):
    """Two pages of 2x3 bytes."""
    word, mark = ("<Q", b"II+\0\x08\0\0\0") if big else ("<I", b"II*\0")
    size = struct.calcsize(word)
    pages = [zlib.compress(U8[:6]), zlib.compress(U8[6:])] if packed else [U8[:6], U8[6:]]
    out = bytearray(mark + struct.pack(word, 0))
    link = len(mark)
    for page in pages:
        data = len(out)
        out += page
        note = len(out)
        out += text
        here = len(out)
        struct.pack_into(word, out, link, here)
        tags = [(256, 3, 2), (257, 3, 3), (258, 3, 8), (259, 3, 8 if packed else 1), (262, 3, 1)]
        if text:
            tags.append((270, 2, note))
        tags += [(273, 4, data), (277, 3, 1), (278, 3, 3), (279, 4, len(page)), (339, 3, 1)]
        out += struct.pack("<Q" if big else "<H", len(tags))
        for tag, kind, value in tags:
            count = len(text) if tag == 270 else 1
            out += struct.pack("<HH", tag, kind) + struct.pack(word, count)
            out += struct.pack("<H" if kind == 3 else word, value).ljust(size, b"\0")
        link = len(out)
        out += struct.pack(word, 0)
    return bytes(out)


def tiffs():
    imagej = b"ImageJ=1.53\nimages=2\nslices=2\nunit=mm\nspacing=2.5\n\0"
    ome = (
        b'<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"><Image ID="Image:0">'
        b'<Pixels ID="P:0" DimensionOrder="XYZCT" Type="uint8" SizeX="2" SizeY="3" SizeZ="2" SizeC="1" SizeT="1" '
        b'PhysicalSizeX="0.5" PhysicalSizeZ="2"><TiffData/></Pixels></Image></OME>\0'
    )
    return [tiff(), tiff(big=True), tiff(packed=True), tiff(text=imagej), tiff(text=ome)]


def table():
    return [b"x,y,z,weight,value\n0,0,0,1,2\n1,0,0,1,3\n0,1e3,-2.5,0,4\n", b"x\ty\tz\n1\t2\t3\n", b'"x","y","z"\r\n1,2,3\r\n']


def xyz():
    return [b"0 0 0\n1 0 0\n", b"x y z value\n1 2 3 4\n", b"2\nwater\nH 0 0 0\nO 1 0 0\n", b"# a comment\n1 2 3 4\n",
            b"2\nProperties=species:S:1:pos:R:3:radius:R:1 Lattice=\"9 0 0 0 9 0 0 0 9\"\nC 0 0 0 1\nFe 1 0 0 2\n"]


def pdb():
    line = "{:6}{:5} {:4}{:1}{:4}{:1}{:4}{:1}   {:8.3f}{:8.3f}{:8.3f}  1.00  0.00          {:>2}\n"
    atoms = line.format("ATOM", 1, " N", "", "ALA", "A", 1, "", 0, 0, 0, "N") + line.format("ATOM", 2, " CA", "B", "ALA", "A", 1, "C", 1, -2, 3.5, "")
    water = line.format("HETATM", 3, " O", "", "HOH", "A", "A000", "", 1, 1, 1, "O")
    cell = "CRYST1   10.000   20.000   30.000  90.00  80.00  90.00 P 1           1\n"
    return [
        f"HEADER    A\n{cell}{atoms}TER\n{water}END\n".encode(),
        f"MODEL        1\n{atoms}ENDMDL\nMODEL        2\n{atoms}ENDMDL\nEND\n".encode(),
        f"{atoms}END\n{atoms}END\n".replace("\n", "\r\n").encode(),
    ]


def mmcif():
    items = "group_PDB type_symbol label_atom_id label_alt_id label_comp_id auth_asym_id auth_seq_id pdbx_PDB_ins_code Cartn_x Cartn_y Cartn_z"
    tags = "".join(f"_atom_site.{item}\n" for item in items.split())
    rows = "ATOM N N . ALA A 1 ? 0 0 0\nATOM C 'C A' B ALA \"A\" 1 C 1 -2 3.5(1)\nHETATM O\n;O\n; . HOH A 2 ? 1 1 1\n"
    cell = "_cell.length_a 10\n_cell.length_b 20\n_cell.length_c 30\n_cell.angle_alpha 90\n_cell.angle_beta 80\n_cell.angle_gamma 90\n"
    return [
        f"data_1ABC\n# a comment\n{cell}_symmetry.space_group_name_H-M 'P 1'\nloop_\n{tags}{rows}#\n".encode(),
        # A crystal by its operations.
        b"data_q\n_cell_length_a 4.916(1)\n_cell_length_b 4.916\n_cell_length_c 5.4\n_cell_angle_gamma 120\n_symmetry_space_group_name_H-M 'P 32'\n"
        b"loop_\n_space_group_symop_operation_xyz\nx,y,z\n'-y, x-y, z+2/3'\n-x+y,-x,1/3+z\nloop_\n_atom_site_label\n_atom_site_type_symbol\n"
        b"_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n_atom_site_occupancy\nSi1 Si4+ 0.47(1) 0 .667 1\nO1 . -0.4 1.27 ? 0.5\nO2 O 0 0 0 .\n",
        b"data_x\nsave_y\n_atom_site.type_symbol C\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\nsave_\n",
    ]


def pqr():
    return [
        b"REMARK 1\nATOM 1 N ALA A 1 0 0 0 -0.5 1.85\nATOM 2 CA ALA 1 1 0 0 0.25 2.0\nHETATM100003 ZN ZN B1000C 1 2 3 2.0 1.1\nTER\nEND\n",
        b"ATOM      1  N   ALA     1       1.000   2.000   3.000 -0.500 1.850\n",
    ]


def gro():
    return [
        b"Slanted\n    2\n    1SOL     OW    1   0.230   0.628   0.113  0.1000  0.2000  0.3000\n    2ALA     CA    2  -1.000   2.345   3.210\n"
        b"   2.00000   3.00000   4.00000   0.00000   0.00000   0.50000   0.00000  -0.25000   1.00000\n",
        b"t\n1\n    1ALA     CA    1   0.23012   0.62834   0.11356\n 0 0 0\n" * 2,
    ]


def lammps_data():
    head = "units = real\n\n2 atoms\n2 atom types\n\n-1 9 xlo xhi\n2 10 ylo yhi\n0 6 zlo zhi\n3 -2 1 xy xz yz\n\nMasses\n\n1 28.0855 # Si\n2 15.9994\n\nAtoms"
    return [
        f"{head} # full\n\n1 1 1 0.5 -1 2 0 0 0 0\n2 1 2 -0.25 20 5 -3 0 0 1\n\nVelocities\n\n1 0 0 0\n".encode(),
        f"{head}\n\n1 1 0.5 -1 2 0\n2 2 -0.25 20 5 -3\n".encode(),
        f"{head} # sphere\n\n1 1 3.0 1.0 -1 2 0\n2 2 0.5 1 20 5 -3\n\nAtom Type Labels\n\n1 Si\n2 O\n".encode(),
    ]


def lammps_dump():
    frame = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS xy xz yz pp pp ff\n-3 12 3\n2 11 -2\n0 6 1\nITEM: ATOMS id element mass q radius xs ys zs\n"
             "1 Si 28.0855 0.5 1 0 0 0\n2 O 15.9994 -0.25 2 0.25 0.5 0.75\n")
    return [
        f"ITEM: UNITS\nreal\n{frame}".encode(), (frame * 2).encode(),
        b"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp pp\n10 0 0 -1\n3 8 0 2\n-2 1 6 0\nITEM: ATOMS id type x y z\n1 1 1 2 3\n",
    ]


def poscar():
    cell = "quartz\n 2.0\n 1.0 0.0 0.0\n -0.5 1.0 0.0\n 0.0 0.0 2.0\n"
    return [
        f"{cell} Si_pv O\n 1 2\nSelective dynamics\nDirect\n 0.5 0 0.25 T T F\n 0 0.5 0.5 T T F\n -0.5 1.5 0 T T F\n\n 0 0 0\n".encode(),
        f"{cell} 1\nCartesian\n 0.5 0 0.25\n".replace("2.0", "-16", 1).encode(),
    ]


def pwn():
    return [b"0 0 0\n1 0 0\n", b"2\n0 0 0\n1 0 0\n0 0 1\n0 0 1\n"]


def npy_points():
    return [npy("<f8", (3, 4), F64), npy("<f8", (3, 4), F64, True)]


def ply():
    head = "ply\nformat {} 1.0\ncomment made\nelement vertex 2\nproperty {t} x\nproperty {t} y\nproperty {t} z\nproperty uchar value\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    files = [head.replace("{t}", "float").format("ascii").encode() + b"0 0 0 1\n1 2 3 4\n3 0 1 1\n"]
    for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        rows = b"".join(struct.pack(order + "dddB", *row) for row in ((0, 0, 0, 1), (1, 2, 3, 4)))
        files.append(head.replace("{t}", "double").format(name).encode() + rows + struct.pack(order + "Biii", 3, 0, 1, 1))
    return files


def off():
    return [b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", b"# a comment\nCOFF 1 0 0\n1 2 3 0 0 255 1\n", b"NOFF\n1 0 0\n1 2 3 0 0 1\n"]


def obj():
    return [b"o a\nv 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0.5 0.5\nvn 0 0 1\nf 1//1 2//1 3//1\n"]


def stl():
    text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    return [text.encode(), bytes(80) + struct.pack("<I12fH", 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)]


def pcd():
    head = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z w\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA {}\n"
    # One literal run of 32 bytes, then one of 16: LZF that packs nothing.
    packed = b"\x1f" + F32[:32] + b"\x0f" + F32[32:48]
    return [
        head.format("ascii").encode() + b"0 0 0 1\n1 0 0 2\n0 1 0 3\n",
        head.format("binary").encode() + F32,
        head.format("binary_compressed").encode() + struct.pack("<II", len(packed), 48) + packed,
        b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\nPOINTS 1\nDATA ascii\n1 2\n",
    ]


def las():
    """Two points of format 0 in LAS 1.2, the head of one that claims records of 58 369 bytes, and those of
    two in LAS 1.4 that claim more points than there are numbers of bytes, and a record of 2**62 bytes."""
    head = bytearray(227)
    head[0:4] = b"LASF"
    head[24:26] = b"\1\2"
    struct.pack_into("<HHHIIBHI5I", head, 90, 1, 2020, 227, 227, 0, 0, 20, 2, 2, 0, 0, 0, 0)
    struct.pack_into("<3d3d6d", head, 131, 0.01, 0.01, 0.01, 0, 0, 0, 1, 0, 1, 0, 1, 0)
    points = b"".join(struct.pack("<iiiHBBbBH", at, at, at, 7, 0b1001, 2, 0, 0, 1) for at in (0, 100))
    long = bytearray(head)
    struct.pack_into("<H", long, 105, 58_369)
    newer = head.ljust(375, b"\0")
    newer[25] = 4
    struct.pack_into("<HII", newer, 94, 375, 375, 0)
    many = bytearray(newer)
    struct.pack_into("<I", many, 107, 0)
    struct.pack_into("<Q", many, 247, 2**64 - 1)
    record = bytearray(newer)
    struct.pack_into("<QI", record, 235, 375 + len(points), 1)
    extended = struct.pack("<H16sHQ32s", 0, b"", 0, 2**62, b"")
    return [bytes(head) + points, bytes(long) + b"\1\2\3", bytes(many) + points, bytes(record) + points + extended, *laz()]


def laz():
    """Three points as laszip packs them, in chunks (LAS 1.2, format 1) and in layers (LAS 1.4, format 6)."""
    return [base64.b64decode(text) for text in (
        "TEFTRgAAAAAAAAAAAAAAAAAAAAAAAAAAAQJPVEhFUgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAGxhc3B5IDIuNy4wAAAAAAAAAAAAAAAAAAAAAAAAAAAASwHqB+MARwEA"
        "AAEAAACBHAADAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAB7FK5H4XqEP3sUrkfheoQ/exSuR+F6hD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAA"
        "AAAAEEAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAGxhc3ppcCBlbmNvZGVkAAC8Vi4AaHR0cDovL2xhc3ppcC5vcmcAAAAAAAAAAAAAAAAAAAACAAAAAgIAAAAAAABQwwAA"
        "/////////////////////wIABgAUAAIABwAIAAIAfAEAAAAAAAAAAAAAAAAAAAAAAAAHAAAAAAAAAAAAAAAAAAAAQOrwZbXl5IH0aHk7psoAAAAAAAAAAQAAADPfAAAA",
        "TEFTRgAAAAAAAAAAAAAAAAAAAAAAAAAAAQRPVEhFUgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAGxhc3B5IDIuNy4wAAAAAAAAAAAAAAAAAAAAAAAAAAAASwHqB3cB1QEA"
        "AAEAAACGHgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAB7FK5H4XqEP3sUrkfheoQ/exSuR+F6hD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAA"
        "AAAAEEAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAMAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
        "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAABsYXN6aXAgZW5jb2RlZAAAvFYo"
        "AGh0dHA6Ly9sYXN6aXAub3JnAAAAAAAAAAAAAAAAAAAAAwAAAAICAAAAAAAAUMMAAP////////////////////8BAAoAHgADADsCAAAAAAAAAAAAAAAAAAAAAAAABwAAAAAA"
        "AAAAAAAAAAAAAAAAAwAAAAwAAAAHAAAAAAAAAAAAAAAFAAAAAAAAAAAAAAAAAAAAAAAAAAB4gSc2VmovtAAAAEQW/UkAAAAHwAAAAAAAAAABAAAAO+8AAAA=",
    )]


def wvm():
    """Five points on a grid with their values as steps; four off any grid, bit for bit; 24 in two layers."""
    return [base64.b64decode(text) for text in (
        "iXd2bQ0KGgoBOAAAAAAAAAAJAAABBQQIAAQFBgAAAAAAAPA/AAAAAAAA8D8AAAAAAAAAAP6a+Fb4Gdp/d29cnVpu9kaVk9c5",
        "iXd2bQ0KGgoBHQAAAAAAAAAwAAABBCYUEpf8VT142q3FMQ0AAAjEwI6MDPgB/yqQwg9I+CaXgqeF0FKqYXgHHtACDHjaY2DADn4wcAjYOzg4AAAK3AIQeN"
        "pjYMAOPjBcYLAHQgAN+gI/PW7ePw==",
        "iXd2bQ0KGgoBVAAAAAAAAADJAAECBggIABIQFAAICAgAAAAAAABAQAAAAAAAABBAAAAAAAAAAAAAAAAAAAAkQAAAAAAAAAAAAAAAAADgb0CQ8TiLjAsuiM"
        "OwHnVFggEA7SRM+YiSsPjCUBORhaPYaJFHkyJnJOVMB4xz6Zm6aJ7/OHbDox2/ThmRqwvnNTh4",
    )]


def dicom():
    """A slice of 3 columns and 2 rows, explicit little endian; deflated; with 32 bits of 16 stored; and in RLE."""

    def element(group, number, kind, value):
        value += (b"\0" if kind in (b"UI", b"OB") else b" ") * (len(value) % 2)
        length = struct.pack("<xxI" if kind in (b"OB", b"OW") else "<H", len(value))
        return struct.pack("<HH", group, number) + kind + length + value

    def us(value):
        return struct.pack("<H", value)

    body = [
        (0x8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.2"), (0x8, 0x18, b"UI", b"1.2.3.4"), (0x18, 0x50, b"DS", b"2.5"),
        (0x20, 0xE, b"UI", b"1.2.3"), (0x20, 0x32, b"DS", b"-10\\5.5\\30"), (0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0"),
        (0x28, 2, b"US", us(1)), (0x28, 4, b"CS", b"MONOCHROME2"), (0x28, 0x10, b"US", us(2)), (0x28, 0x11, b"US", us(3)),
        (0x28, 0x30, b"DS", b"0.5\\0.75"), (0x28, 0x100, b"US", us(16)), (0x28, 0x101, b"US", us(16)),
        (0x28, 0x102, b"US", us(15)), (0x28, 0x103, b"US", us(1)), (0x28, 0x1052, b"DS", b"-1024"),
        (0x28, 0x1053, b"DS", b"1"), (0x7FE0, 0x10, b"OW", bytes(12)),
    ]
    plain, deflated = b"1.2.840.10008.1.2.1", b"1.2.840.10008.1.2.1.99"
    files = []
    for syntax, stored in ((plain, 16), (deflated, 16), (plain, 32)):
        meta = element(2, 1, b"OB", b"\0\1") + element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2")
        meta += element(2, 3, b"UI", b"1.2.3.4") + element(2, 0x10, b"UI", syntax) + element(2, 0x12, b"UI", b"1.2.3.5")
        packer = zlib.compressobj(wbits=-15)
        rows = [(0x28, 0x101, b"US", us(stored)) if row[:2] == (0x28, 0x101) else row for row in body]
        data = b"".join(element(*row) for row in rows)
        data = packer.compress(data) + packer.flush() if syntax == deflated else data
        files.append(bytes(128) + b"DICM" + element(2, 0, b"UL", struct.pack("<I", len(meta))) + meta + data)
    # Two segments, of the high and the low bytes: a run of six, and six as they are.
    packed = struct.pack("<16I", 2, 64, 66, *[0] * 13) + b"\xfb\0" + b"\5" + bytes(range(6)) + b"\0"
    items = b"\xfe\xff\0\xe0" + bytes(4) + b"\xfe\xff\0\xe0" + struct.pack("<I", len(packed)) + packed
    pixels = b"\xe0\x7f\x10\0OB\0\0\xff\xff\xff\xff" + items + b"\xfe\xff\xdd\xe0" + bytes(4)
    meta = element(2, 1, b"OB", b"\0\1") + element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2")
    meta += element(2, 3, b"UI", b"1.2.3.4") + element(2, 0x10, b"UI", b"1.2.840.10008.1.2.5") + element(2, 0x12, b"UI", b"1.2.3.5")
    head = bytes(128) + b"DICM" + element(2, 0, b"UL", struct.pack("<I", len(meta))) + meta
    return [*files, head + b"".join(element(*row) for row in body[:-1]) + pixels]


def slices():
    """Gray PNG of 8 and 16 bits, and the smallest baseline JPEG: one gray block."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    files = []
    for bits in (8, 16):
        rows = b"".join(b"\0" + bytes(range(3 * bits // 8)) for _ in range(2))
        head = struct.pack(">IIBBBBB", 3, 2, bits, 0, 0, 0, 0)
        files.append(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))

    def segment(mark, data):
        return b"\xff" + bytes([mark]) + struct.pack(">H", len(data) + 2) + data

    one_code = bytes([1]) + bytes(15) + b"\0"
    jpeg = segment(0xDB, b"\0" + bytes([1] * 64)) + segment(0xC0, struct.pack(">BHHB", 8, 8, 8, 1) + b"\1\x11\0")
    jpeg += segment(0xC4, b"\0" + one_code) + segment(0xC4, b"\x10" + one_code) + segment(0xDA, b"\1\1\0\0\x3f\0")
    return [*files, b"\xff\xd8" + jpeg + b"\x3f\xff\xd9"]


def complexes():
    """A tetrahedron with its simplices, as JSON and as NPZ."""
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    facets = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    edges = [[a, b] for a in range(4) for b in range(a + 1, 4)]
    whole = {"points": points, "weights": [0, 0, 0, 0], "alpha": 1, "cells": [[0, 1, 2, 3]], "facets": facets,
             "edges": edges, "vertices": [0, 1, 2, 3], "hidden": [], "duplicates": []}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        coordinates = struct.pack("<12d", *sum(points, []))
        archive.writestr("points.npy", npy("<f8", (4, 3), coordinates))
        archive.writestr("alpha.npy", npy("<f8", (), struct.pack("<d", 1)))
        archive.writestr("cells.npy", npy("<u4", (1, 4), struct.pack("<4I", 0, 1, 2, 3)))
        archive.writestr("vertices.npy", npy("<i8", (4,), struct.pack("<4q", 0, 1, 2, 3)))
    return [json.dumps(whole).encode(), json.dumps(dict(points=points, alpha="inf", cells=[[3, 2, 1, 0]])).encode(), out.getvalue()]


def check_json():
    """The complexes in JSON, one with corners in one place, one with classes and exterior cells."""
    points = [[0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]
    files = [dict(points=points, alpha=1, facets=[[0, 1, 2]]),
             dict(points=points[1:], weights=[0, 0.5, 0, 0, 1], alpha=0.5, cells=[[0, 1, 2, 3], [1, 3, 2, 4]],
                  classes={"cells": ["interior", "exterior"]}, hidden=[], duplicates=[])]
    return [file for file in complexes() if not file.startswith(b"PK")] + [json.dumps(file).encode() for file in files]


def check_npz():
    return [file for file in complexes() if file.startswith(b"PK")]


def filtrations():
    """The filtration of a tetrahedron, as JSON and as NPZ, and one of a box that repeats."""
    points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]
    facets = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    edges = [[a, b] for a in range(4) for b in range(a + 1, 4)]
    values = {"vertices": [0, 0, 0, 0], "edges": [1, 1, 1, 2, 2, 2], "facets": [2, 2, 2, 3], "cells": [3]}
    whole = {"points": points, "weights": [0, 0, 0, 0], "vertices": [0, 1, 2, 3], "edges": edges, "facets": facets,
             "cells": [[0, 1, 2, 3]], "values": values, "order": list(range(15)),
             "pairs": {"components": [[1, 4], [2, 5], [3, 6]], "lasting": [0], "voids": []}}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, rows in (("points", points), ("edges", edges), ("facets", facets), ("cells", whole["cells"]),
                           ("component_pairs", whole["pairs"]["components"]), ("void_pairs", [])):
            flat = sum(rows, [])
            kind, code = ("<f8", "d") if name == "points" else ("<u4", "I")
            shape = (len(rows), len(rows[0]) if rows else 2)
            archive.writestr(f"{name}.npy", npy(kind, shape, struct.pack(f"<{len(flat)}{code}", *flat)))
        lists = {"vertices": [0, 1, 2, 3], "order": whole["order"], "lasting_components": [0]}
        for name, flat in lists.items():
            archive.writestr(f"{name}.npy", npy("<u4", (len(flat),), struct.pack(f"<{len(flat)}I", *flat)))
        for name, dimension in (("vertex", "vertices"), ("edge", "edges"), ("facet", "facets"), ("cell", "cells")):
            flat = values[dimension]
            data = struct.pack(f"<{len(flat)}d", *flat)
            archive.writestr(f"{name}_values.npy", npy("<f8", (len(flat),), data))
    periodic = dict(whole, periodic=[8, 8, 8])
    return [json.dumps(whole).encode(), json.dumps(periodic).encode(), out.getvalue()]


CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))


def gmsh():
    """A tetrahedron with one of its points as an element, in versions 2.2 and 4.1, as text and in binary."""
    rows = "\n".join(f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(CORNERS, 1))
    places = "\n".join(f"{x} {y} {z}" for x, y, z in CORNERS)
    two = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{rows}\n$EndNodes\n$Elements\n2\n1 15 2 0 1 1\n2 4 2 0 1 1 2 3 4\n$EndElements\n"
    four = (f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n{places}\n$EndNodes\n"
            "$Elements\n2 2 1 2\n0 1 15 1\n1 1\n3 1 4 1\n2 1 2 3 4\n$EndElements\n")
    head = "$MeshFormat\n{} 1 8\n".encode()
    one, end = struct.pack("<i", 1), b"\n$EndMeshFormat\n"
    numbers = b"".join(struct.pack("<i3d", k, *row) for k, row in enumerate(CORNERS, 1))
    cells = struct.pack("<3i", 4, 1, 2) + struct.pack("<7i", 1, 0, 1, 1, 2, 3, 4)
    binary_two = head.replace(b"{}", b"2.2") + one + end + b"$Nodes\n4\n" + numbers + b"\n$EndNodes\n$Elements\n1\n" + cells + b"\n$EndElements\n"
    nodes = struct.pack("<4Q3iQ4Q", 1, 4, 1, 4, 3, 1, 0, 4, 1, 2, 3, 4) + struct.pack("<12d", *sum(CORNERS, ()))
    cells = struct.pack("<4Q3iQ5Q", 1, 1, 1, 1, 3, 1, 4, 1, 1, 1, 2, 3, 4)
    binary_four = head.replace(b"{}", b"4.1") + one + end + b"$Nodes\n" + nodes + b"\n$EndNodes\n$Elements\n" + cells + b"\n$EndElements\n"
    return [two.encode(), four.encode(), binary_two, binary_four]


def medit():
    places = "\n".join(f"{x} {y} {z} 0" for x, y, z in CORNERS)
    return [f"MeshVersionFormatted 2\nDimension 3\n# a comment\nVertices 4\n{places}\nTriangles 1\n1 2 3 0\nTetrahedra 1\n1 2 3 4 0\nEnd\n".encode()]


def tetgen():
    """Points with an attribute, from 1, and without, from 0; then the cells."""
    rows = [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(CORNERS)]
    attributes = [f"{k} {x} {y} {z} 0.5" for k, (x, y, z) in enumerate(CORNERS, 1)]
    return [("4 3 0 0\n" + "\n".join(rows) + "\n\0 1 4 0\n0 0 1 2 3\n").encode(),
            ("# made\n4 3 1 0\n" + "\n".join(attributes) + "\n\0" + "1 4 0\n1 1 2 3 4\n").encode()]


def vtk_mesh():
    places = "\n".join(f"{x} {y} {z}" for x, y, z in CORNERS)
    head = f"# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n{places}\n"
    cells = "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
    binary = head[: head.index("POINTS")].replace("ASCII", "BINARY").encode() + b"POINTS 4 double\n" + struct.pack(">12d", *sum(CORNERS, ()))
    binary += b"\nCELLS 1 5\n" + struct.pack(">5i", 4, 0, 1, 2, 3) + b"\nCELL_TYPES 1\n" + struct.pack(">i", 10) + b"\n"
    return [(head + cells).encode(), (head + cells + "POINT_DATA 4\nSCALARS weight double 1\nLOOKUP_TABLE default\n0 0 0 1\n").encode(), binary]


def weights():
    return [b"weight\n0\n1.5\n-2e3\n", npy("<f8", (4,), F64[:32])]


def zarr():
    two = {"zarr_format": 2, "shape": [2, 3, 2], "chunks": [2, 3, 2], "dtype": "|u1", "compressor": None,
           "fill_value": 0, "order": "C", "filters": None}
    three = {"zarr_format": 3, "node_type": "array", "shape": [2, 3, 2], "data_type": "float32", "fill_value": 0.0,
             "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2, 3, 2]}},
             "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
             "codecs": [{"name": "bytes", "configuration": {"endian": "little"}}], "attributes": {}}
    packed = dict(three, codecs=three["codecs"] + [{"name": "gzip", "configuration": {"level": 5}}])
    levels = [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 2, 3]},
                                                           {"type": "translation", "translation": [4, 5, 6]}]}]
    group = {"zarr_format": 3, "node_type": "group", "attributes": {"ome": {"multiscales": [{"datasets": levels}]}}}
    parts = [(two, U8), (dict(two, compressor={"id": "zlib", "level": 1}), zlib.compress(U8)), (three, F32),
             (packed, gzip.compress(F32)), (group, three, F32)]
    return [b"\xff".join(part if isinstance(part, bytes) else json.dumps(part).encode() for part in file) for file in parts]


def plan_files(*names):
    """Files of a plan, as the command writes them, which must be on the path."""
    def files():
        walpha = shutil.which("walpha")
        if walpha is None:
            print(f"no walpha on the path: no seeds for {', '.join(names)}", file=sys.stderr)
            return []
        found = []
        for haar in ("non-standard", "standard"):
            with tempfile.TemporaryDirectory() as folder:
                work = Path(folder) / "work"
                for step in (["plan", "sample:phantom@12", "--engine", "native", "--rms", "2", "--haar", haar, "--blocks", "2", "-o", work],
                             ["run", work]):
                    subprocess.run([walpha, "blocks", *step, "--quiet"], check=True)
                found += [(work / name).read_bytes() for name in names if (work / name).exists()]
        return found
    return files


TARGETS = {
    "inrimage": inrimage, "mgh": mgh, "npy": npys, "npz": npz, "nrrd": nrrd, "metaimage": metaimage, "nifti": nifti,
    "nifti_gzip": lambda: [gzip.compress(file) for file in nifti()], "vtk_legacy": vtk_legacy, "vti": vti,
    "tiff": tiffs, "table": table, "xyz": xyz, "pdb": pdb, "mmcif": mmcif, "pqr": pqr, "gro": gro, "lammps_data": lammps_data, "lammps_dump": lammps_dump, "poscar": poscar, "pwn": pwn, "npy_points": npy_points, "ply": ply, "vtk_geometry": vtk_geometry,
    "off": off, "obj": obj, "stl": stl, "gmsh": gmsh, "medit": medit, "tetgen": tetgen, "vtk_mesh": vtk_mesh, "weights": weights,
    "pcd": pcd, "las": las, "wvm": wvm, "dicom": dicom, "zarr": zarr, "slices": slices, "complex": complexes, "check_json": check_json, "check_npz": check_npz, "filtration": filtrations,
    "plan": plan_files("plan.json"), "block": plan_files("block-00000.walpha", "block-00001.walpha"),
    "sums": plan_files("sums.f64"), "truncated": plan_files("truncated.f32"),
}

if __name__ == "__main__":
    for name, files in TARGETS.items():
        folder = Path(sys.argv[1]) / name
        folder.mkdir(parents=True, exist_ok=True)
        for number, data in enumerate(files()):
            (folder / f"seed{number}").write_bytes(data)
