#!/usr/bin/env python3
"""Races walpha's front end against PyWavelets on the same volume.

    benches/race_wavelets.py [--walpha target/release/walpha] [--size 256] [--env /tmp/walpha-wavelets]

Ours is the whole front end of `walpha points`: forward, truncate, inverse, difference, select, weigh.
Theirs is wavedecn, threshold and waverecn in float32, no more. Runs are interleaved; medians of five.
Makes a Python environment with NumPy and PyWavelets once; exits with 77 when these cannot be had.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import venv

RUNS = 5


def enter(folder):
    """Runs this script again with the Python of an environment that has the packages."""
    python = pathlib.Path(folder) / "bin" / "python"
    try:
        if not python.exists():
            venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "numpy", "PyWavelets"], check=True)
    except (OSError, subprocess.SubprocessError) as error:
        print(f"skipped: the Python packages cannot be had ({error})")
        sys.exit(77)
    os.execv(python, [str(python), __file__, "--inside", *sys.argv[1:]])


def ours(walpha, file):
    command = [walpha, "points", file, "--weights", "min-max", "--json"]
    told = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return told["seconds"]["haar"] + told["seconds"]["points"]


def theirs(samples):
    import numpy
    import pywt

    started = time.perf_counter()
    coefficients, places = pywt.coeffs_to_array(pywt.wavedecn(samples, "haar"))
    # The threshold itself is given: finding it from an error bound costs them nothing here.
    coefficients[numpy.abs(coefficients) < 8] = 0
    pywt.waverecn(pywt.array_to_coeffs(coefficients, places), "haar")
    return time.perf_counter() - started


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--walpha", default="target/release/walpha")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--env", default="/tmp/walpha-wavelets")
    parser.add_argument("--inside", action="store_true")
    arguments = parser.parse_args()
    if not arguments.inside:
        enter(arguments.env)
    import numpy

    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "volume.npy")
        sample = f"sample:phantom@{arguments.size}"
        subprocess.run([arguments.walpha, "haar", sample, "--rms", "0", "-o", file, "--quiet"], check=True)
        samples = numpy.load(file).astype(numpy.float32)
        times = [(ours(arguments.walpha, file), theirs(samples)) for _ in range(RUNS)]
    we, they = (statistics.median(column) for column in zip(*times))
    print(f"{sample}: walpha {we:.3f} s, PyWavelets {they:.3f} s, ratio {they / we:.2f}")


if __name__ == "__main__":
    main()
