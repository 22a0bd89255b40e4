#!/usr/bin/env python3
"""Runs commands in 60 MB to 2 GB of address space: `python3 scripts/starve.py target/release/walpha`.

Each run must end with code 0, or with 1, an error and nothing left behind: refused by a plan that names
what is needed, or stopped where an allocation failed. Standard library only; Linux.
"""

import resource
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

MEGABYTES = [60, 85, 120, 170, 240, 340, 480, 680, 1000, 2000]
COMMANDS = [
    "haar sample:phantom@256 -o a.npy",
    "ladder sample:phantom@64 -o made",
    "view sample:phantom@64 -o a.html",
    "check sample:phantom@64",
    "shape sample:phantom@96 -o a.ply a.npz a.png",
    "interpolate sample:phantom@128 --fill -o a.nrrd",
]


def main():
    walpha = Path(sys.argv[1]).resolve()
    wrong, outcomes = 0, Counter()
    for command in COMMANDS:
        for megabytes in MEGABYTES:
            code, said, left = run([walpha, *command.split()], megabytes << 20)
            lines = [line for line in said.splitlines() if line]
            complained = any(line.startswith("error: ") for line in lines)
            named = any(word in said for word in ("bytes of memory", "MiB are needed", "ran out of it"))
            right = code == 0 or code == 1 and complained and not left
            kind = "WRONG" if not right else "done" if code == 0 else "refused" if named else "stopped"
            outcomes[kind] += 1
            wrong += not right
            # Of one that stopped, the line before the error says which allocation failed.
            told = "" if code == 0 else lines[0] if kind != "refused" else lines[1].strip()
            print(f"{megabytes:5} MB  {command:48} {code:3}  {kind:8} {told} {left or ''}", flush=True)
    print(", ".join(f"{count} {kind}" for kind, count in sorted(outcomes.items())))
    sys.exit(wrong > 0)


def run(args, limit):
    """The exit code, standard error, and the files left behind, if it is not 0."""
    with tempfile.TemporaryDirectory() as folder:
        lower = lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))  # noqa: E731
        done = subprocess.run(args, cwd=folder, preexec_fn=lower, capture_output=True, text=True)
        left = sorted(path.name for path in Path(folder).rglob("*")) if done.returncode else []
    return done.returncode, done.stderr, left


main()
