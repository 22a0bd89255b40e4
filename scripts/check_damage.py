#!/usr/bin/env python3
"""Changes each byte of a small file of each format, and runs `walpha info` on it: `scripts/check_damage.py WALPHA [FORMAT...]`.

Whatever is damaged, the command must end within ten seconds with 0, 1 or 2, and within 500 MB. Standard library only; the files are the
seeds of the fuzz targets. The new value of a byte depends on its place alone, so two runs are the same.
"""

import concurrent.futures
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "fuzz"))
import seeds  # noqa: E402

MOST_BYTES = 500 << 20
SECONDS = 10
# Of address space: what asks for more than there is must be able to say so.
ADDRESSES = 2 << 30

# The targets of formats, with the extension of their files.
EXTENSIONS = {
    "inrimage": "inr", "mgh": "mgh", "npy": "npy", "npz": "npz", "nrrd": "nrrd", "metaimage": "mha", "nifti": "nii", "nifti_gzip": "nii.gz",
    "vtk_legacy": "vtk", "vti": "vti", "tiff": "tif", "table": "csv", "xyz": "xyz", "pdb": "pdb", "mmcif": "cif", "pqr": "pqr", "gro": "gro", "lammps_data": "lmp", "lammps_dump": "dump", "poscar": "vasp", "pwn": "pwn", "npy_points": "npy", "ply": "ply",
    "vtk_geometry": "vtu", "off": "off", "obj": "obj", "stl": "stl", "gmsh": "msh", "medit": "mesh", "tetgen": "node", "vtk_mesh": "vtk",
    "pcd": "pcd", "las": "las", "wvm": "wvm", "check_json": "json", "check_npz": "npz",
}


def folders():
    """Files in folders: a name, the files, and which of them is changed."""
    plain, *_, rle = seeds.dicom()
    yield "DICOM", {"0.dcm": plain}, "0.dcm"
    yield "DICOM, RLE", {"0.dcm": rle}, "0.dcm"
    png, *_, jpeg = seeds.slices()
    yield "PNG", {"0.png": png}, "0.png"
    yield "JPEG", {"0.jpg": jpeg}, "0.jpg"
    two, packed, *_, group = seeds.zarr()
    for kind, data, names in (
        ("Zarr 2", two, ("a.zarr/.zarray", "a.zarr/0.0.0")),
        ("Zarr 2, zlib", packed, ("a.zarr/.zarray", "a.zarr/0.0.0")),
        ("OME-Zarr", group, ("a.zarr/zarr.json", "a.zarr/0/zarr.json", "a.zarr/0/c/0/0/0")),
    ):
        files = dict(zip(names, data.split(b"\xff", len(names) - 1), strict=True))
        for name in names:
            yield f"{kind}, {name}", files, name


def cases():
    for target, extension in EXTENSIONS.items():
        file = seeds.TARGETS[target]()[0]
        yield target, {f"a.{extension}": file}, f"a.{extension}"
    for kind, file in zip(("LAZ in chunks", "LAZ in layers"), seeds.laz(), strict=True):
        yield kind, {"a.laz": file}, "a.laz"
    yield from folders()


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(walpha, path):
    """What is wrong with one run, if anything is."""
    with subprocess.Popen([walpha, "info", path, "--quiet", "--threads", "1"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          preexec_fn=limits) as child:
        try:
            error = child.communicate(timeout=SECONDS)[1].decode(errors="replace")
        except subprocess.TimeoutExpired:
            child.kill()
            return f"does not end in {SECONDS} s"
    if child.returncode not in (0, 1, 2):
        return f"ends with {child.returncode}: {error[:300]}"
    if "panicked" in error:
        return error[:300]
    return None


def try_all(walpha, name, files, changed):
    """The findings of one file, and the number of runs."""
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        for path, data in files.items():
            (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / path).write_bytes(data)
        at, data = Path(folder) / changed, files[changed]
        top = Path(folder) / changed.split("/")[0]
        # Single slices are read as folders.
        path = top if "/" in changed or len(files) == 1 and top.suffix not in (".jpg", ".png") else folder
        for place in range(len(data)):
            damaged = bytearray(data)
            damaged[place] = (damaged[place] + 1 + place * 101 % 255) & 0xFF
            at.write_bytes(damaged)
            if finding := run(walpha, path):
                findings.append(f"{name}, byte {place} {data[place]} → {damaged[place]}: {finding}")
    return findings, len(data)


def main():
    walpha, wanted = os.path.abspath(sys.argv[1]), sys.argv[2:]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        chosen = [case for case in cases() if not wanted or case[0].startswith(tuple(wanted))]
        results = list(pool.map(lambda case: try_all(walpha, *case), chosen))
    findings = [finding for found, _ in results for finding in found]
    runs = sum(count for _, count in results)
    print(*findings, sep="\n")
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    if peak << 10 > MOST_BYTES:
        findings.append(f"a run took {peak >> 10} MiB")
        print(findings[-1])
    print(f"{runs} changed files, {len(findings)} findings, at most {peak >> 10} MiB")
    sys.exit(1 if findings or not runs else 0)


if __name__ == "__main__":
    main()
