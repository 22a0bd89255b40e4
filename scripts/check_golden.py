#!/usr/bin/env python3
"""Compares the digest of every output with the one on record: `scripts/check_golden.py WALPHA [write]`.

Outputs are the files and the JSON of each command on the built-in data, without times, memory and paths; with a Python that has
walpha, also the arrays of the package. With `write`, the digests of today are put on record in tests/golden.txt: a commit that changes
one names the output and says why. Texts for people are not among them. Standard library only.
"""

import concurrent.futures
import datetime
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RECORD = ROOT / "tests" / "golden.txt"

# What differs from run to run: measured, not computed; and, in the report of the paper, the day.
MEASURED = {"seconds", "peak_memory_bytes"}


def today():
    return datetime.datetime.now(datetime.timezone.utc).date().isoformat()


# Midnight may pass between the two.
STARTED = today()

SHAPES = "ply off obj stl glb vtp vtu npz json png wvm 3mf".split()
VOLUMES = "nrrd nii nii.gz mha vti tif npy raw".split()
POINTS = "csv npy wvm".split()
INPUTS = {"phantom": "sample:phantom@64", "ct": "sample:ct", "skull": "sample:skull"}
PLANE = "x,y\\n0,0\\n4,0\\n4,3\\n0,3\\n1,1\\n2,1\\n2,2\\n1,2\\n6,6\\n7,6\\n6,7\\n"


def named(stem, endings):
    return " ".join(f"{stem}.{ending}" for ending in endings)


def commands():
    """A name, and lines of the shell, in which `walpha` is the program: each line's output and all files are compared."""
    for name, source in INPUTS.items():
        yield f"{name} shape", f"walpha shape {source} -o {named('a', SHAPES)} --json"
        yield f"{name} solid", f"walpha shape {source} --solid -o {named('a', 'ply off obj stl glb vtp 3mf'.split())} --json"
        yield f"{name} text", f"walpha shape {source} --ascii --groups -o {named('a', 'ply off obj'.split())} --json"
        yield f"{name} native", f"walpha shape {source} --engine native --weights min-max -o a.json --json"
        yield f"{name} blocks", f"walpha shape {source} --blocks 3 -o a.pvtu a.pvtp --json"
        for ending in POINTS:
            yield f"{name} points {ending}", f"walpha points {source} --weights min-max -o a.{ending} --json"
        for ending in VOLUMES:
            yield f"{name} haar {ending}", f"walpha haar {source} --rms 2 -o a.{ending} --json"
        yield f"{name} interpolate", f"walpha interpolate {source} --alpha 30 -o a.nrrd --json"
        yield f"{name} ladder", f"walpha ladder {source} --alphas 1,2,5,10,20 -o ladder --json"
        yield f"{name} detail", f"walpha ladder {source} --counts 500,2000 -o detail --json"
        yield f"{name} filtration", f"walpha filtration {source} -o a.json a.npz a.txt a.csv a.svg a.png --json"
        yield f"{name} info", f"walpha info {source} --json"
        yield f"{name} check", f"walpha check {source} --json"
        yield f"{name} view", f"walpha view {source} -o a.html --json"
        yield f"{name} plan", f"walpha blocks plan {source} --blocks 2 -o plan --json\nwalpha blocks run plan 1 --json\nwalpha blocks run plan --json\nwalpha blocks merge plan -o a.pvtu a.json --json"
        yield f"{name} adaptive", f"walpha points {source} --select adaptive --count 400 -o a.csv --json"
        yield f"{name} convert", f"walpha convert {source} -o a.zarr --json"
        yield f"{name} config", f"walpha shape {source} --alpha auto:connected --weights min-max --print-config"
    for preset in "paper ct-bone ct-skin mri".split():
        yield f"preset {preset}", f"walpha shape sample:ct --preset {preset} --print-config\nwalpha shape sample:ct --preset {preset} -o a.json --json"
    yield "preset points", "walpha shape sample:tile --preset points -o a.json --json"
    yield "preset molecule", "walpha shape sample:peptide --preset molecule -o a.json a.ply --json"
    labels = r"yes AABBBC | head -c 8000 | tr 'ABC\n' '\0\1\2\0' > v.raw"
    raw = "v.raw --dims 20,20,20 --dtype u8"
    yield "labels", f"{labels}\nwalpha shape {raw} --preset labels -o a.ply a.json --json\nwalpha shape {raw} --each-label -o each --json"
    yield "surface", "walpha shape sample:phantom@40 --surface 100 -o a.ply --json\nwalpha shape sample:phantom@40 --surface auto:closed -o b.stl --json"
    yield "by", "walpha shape sample:tile --by treeID --alpha 4 -o groups a.csv --json\nwalpha shape sample:tile --by treeID --alpha 4 -o a.geojson --json"
    yield "balls", "walpha balls sample:peptide --json -o a.csv\nwalpha balls sample:peptide --probe 1.4 --json"
    zeolite = shlex.quote(str(ROOT / "docs" / "tutorials" / "chabazite.cif"))
    yield "pores", f"cp {zeolite} z.cif\nwalpha pores z.cif --radii none --alpha-radius 1.35 --probe 1.2 --json\nwalpha balls z.cif --periodic cell --json"
    yield "plane", f"printf '{PLANE}' > p.csv\nwalpha shape p.csv --columns x,y --alpha 3 -o a.geojson a.wkt a.svg a.json --json"
    yield "hard", "walpha info hard:slab-18 --json\nwalpha shape hard:slab-18 --alpha 1 -o a.json --json\nwalpha shape hard:hidden --alpha 1 -o b.json --json"
    yield "periodic", "walpha points sample:phantom@32 --count 300 -o p.csv --json\nwalpha shape p.csv --periodic 32,32,32 --alpha 20 -o a.json a.vtu --json"
    yield "compare", "walpha shape sample:phantom@32 -o a.json -q\nwalpha shape sample:phantom@32 --alpha 9 -o b.json -q\nwalpha compare a.json b.json --json"
    yield "curve", "walpha interpolate sample:phantom@24 --curve -o curve/ --json"
    yield "completions", "walpha completions bash | head -c 400"
    yield "reproduce", "walpha reproduce --out paper --json"


def unnamed(said, folder):
    """A text without the name of the folder and the day."""
    return said.replace(folder, ".").replace(STARTED, "TODAY").replace(today(), "TODAY")


def plain(value, folder):
    """JSON without what was measured, the name of the folder and the day."""
    if isinstance(value, dict):
        return {key: plain(item, folder) for key, item in value.items() if key not in MEASURED}
    if isinstance(value, list):
        return [plain(item, folder) for item in value]
    return unnamed(value, folder) if isinstance(value, str) else value


def text(output, folder):
    try:
        return json.dumps(plain(json.loads(output), folder), indent=1)
    except ValueError:
        return unnamed(output, folder)


def digest(content):
    return hashlib.sha256(content).hexdigest()[:16]


def run(walpha, name, script):
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for number, line in enumerate(script.splitlines()):
            line = re.sub(r"\bwalpha ", shlex.quote(walpha) + " ", line, count=1)
            ran = subprocess.run(line, shell=True, cwd=folder, capture_output=True, text=True)
            found[f"{name}: line {number + 1}"] = digest(f"{ran.returncode} {text(ran.stdout, folder)}".encode())
            if ran.returncode != 0 and "check" not in name and "compare" not in name:
                print(f"{name}: {ran.returncode}\n{ran.stderr[-400:]}", file=sys.stderr)
        for path in sorted(Path(folder).rglob("*")):
            if path.is_file():
                content = path.read_bytes()
                if path.suffix in (".json", ".html", ".csv"):
                    content = text(content.decode(), folder).encode()
                found[f"{name}: {path.relative_to(folder)}"] = digest(content)
    return found


PACKAGE = """
import hashlib, sys
try:
    import numpy as np
    import walpha
except ImportError:
    sys.exit(77)

def say(name, item):
    for part in sorted(dir(item)):
        array = getattr(item, part) if part[0] != "_" else None
        if isinstance(array, (int, float, str)):
            print(name, part, array)
        elif isinstance(array, np.ndarray):
            array = np.ascontiguousarray(array)
            print(name, part, array.dtype, array.shape, hashlib.sha256(array.tobytes()).hexdigest())

rng = np.random.default_rng(0)
points, weights = rng.random((2000, 3)), rng.random(2000) / 100
for engine in ("native", "cgal"):
    say(engine, walpha.alpha_shape(points, 0.02, weights=weights, engine=engine))
filtration = walpha.filtration(points, weights=weights)
say("filtration", filtration)
say("simplices", filtration.simplices())
volume = np.arange(32.0**3).reshape(32, 32, 32) % 91
say("pipeline", walpha.pipeline(volume))
print("haar", "array", hashlib.sha256(np.ascontiguousarray(walpha.haar(volume, rms=2)[0]).tobytes()).hexdigest())
"""


def package():
    ran = subprocess.run([sys.executable, "-c", PACKAGE], capture_output=True, text=True, cwd=tempfile.gettempdir())
    if ran.returncode == 77:
        return None
    if ran.returncode != 0:
        sys.exit(ran.stderr)
    lines = ran.stdout.splitlines()
    return {f"package: {' '.join(line.split()[:2])}": digest(line.encode()) for line in lines}


def main():
    walpha = os.path.abspath(sys.argv[1])
    found = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for part in pool.map(lambda case: run(walpha, *case), commands()):
            found |= part
    arrays = package()
    found |= arrays or {}
    if sys.argv[2:] == ["write"]:
        if arrays is None:
            sys.exit("this Python has no walpha: the digests of its arrays would be lost")
        RECORD.write_text("".join(f"{value}  {name}\n" for name, value in found.items()))
        print(f"{len(found)} digests written")
        return
    record = dict(reversed(line.split("  ", 1)) for line in RECORD.read_text().splitlines())
    if arrays is None:
        record = {name: value for name, value in record.items() if not name.startswith("package:")}
    wrong = [name for name in record | found if record.get(name) != found.get(name)]
    for name in wrong:
        print(f"differs: {name} ({record.get(name, 'new')}, now {found.get(name, 'missing')})")
    print(f"{len(found)} digests, {len(wrong)} differ" + ("" if arrays else "; without the Python package"))
    sys.exit(1 if wrong or not found else 0)


main()
