#!/usr/bin/env python3
"""What a certificate costs: `walpha check` of a million points, as whole processes.

    cargo build --release
    python3 benches/certificates.py target/release/walpha [OTHER…]

Each program judges each file five times in turn, the first one having made them. Prints rows of docs/performance.md: medians of seconds, and peaks.
"""

import os
import pathlib
import random
import statistics
import struct
import subprocess
import sys
import tempfile
import time

RUNS = 5
PHANTOM = ["sample:phantom@256", "--weights", "min-max"]
FILES = {
    "shape of the phantom at 256³": [*PHANTOM, "--alpha", "10"],
    "its whole triangulation": [*PHANTOM, "--alpha", "10", "--exterior"],
    "shape of 10⁶ random points": ["random.npy", "--alpha", "1"],
}


def write_npy(path, points):
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(points)}, 3), }}"
    head += " " * (63 - (10 + len(head)) % 64) + "\n"
    rows = b"".join(struct.pack("<3d", *point) for point in points)
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + rows)


def judged(walpha, path):
    begun = time.monotonic()
    process = subprocess.Popen([walpha, "check", path], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{walpha} check {path} failed with {os.waitstatus_to_exitcode(status)}")
    return time.monotonic() - begun, usage.ru_maxrss / 1024


def main():
    programs = [str(pathlib.Path(path).resolve()) for path in sys.argv[1:]]
    print("| file | MB | " + " | ".join(sys.argv[1:]) + " |\n|---|--:|" + "--:|" * len(programs))
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "judged.npz"
        generator = random.Random(1)
        write_npy(path.with_name("random.npy"), [[100 * generator.random() for _ in range(3)] for _ in range(1_000_000)])
        for name, options in FILES.items():
            subprocess.run([programs[0], "shape", *options, "-q", "-o", path, "--in-place"], cwd=folder, check=True)
            runs = [[judged(walpha, path) for walpha in programs] for _ in range(RUNS)]
            cells = []
            for column in zip(*runs):
                seconds, peaks = zip(*column)
                cells.append(f"{statistics.median(seconds):.2f} s, {max(peaks):.0f} MiB")
            print(f"| {name} | {path.stat().st_size / 1e6:.0f} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
