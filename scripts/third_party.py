#!/usr/bin/env python3
"""Prints the notices of all that a build contains and others wrote: names, versions, licences, and the texts of these.

    python3 scripts/third_party.py -p walpha --features dicom,las,zarr > THIRD-PARTY.md

Takes the arguments by which `cargo tree` selects packages, features and a target. Standard library only; nothing is fetched. What is
printed follows from Cargo.lock, so scripts/release.sh makes it for each artefact, and it is not kept in the repository.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Packages that contain more than their authors wrote: what it is, its licence, its authors, the file with the text of its licence.
INSIDE = {
    "blosc-src": [
        ("c-blosc with BloscLZ", "BSD-3-Clause", "Francesc Alted and the Blosc Development Team", None),
        ("bitshuffle", "MIT", "Kiyoshi Masui", None),
    ],
    "cxx": [
        ("CGAL", "GPL-3.0-or-later AND LGPL-3.0-or-later", "the authors of CGAL", None),
        ("Boost", "BSL-1.0", "the authors of Boost", None),
    ],
    "epaint_default_fonts": [
        ("the font Ubuntu Light", "Ubuntu-font-1.0", "Canonical Ltd.", "fonts/UFL.txt"),
        ("the font Hack", "MIT AND Bitstream-Vera", "Source Foundry Authors, Bitstream Inc.", "fonts/Hack-Regular.txt"),
    ],
    "libz-sys": [("zlib", "Zlib", "Jean-loup Gailly and Mark Adler", "src/zlib/LICENSE")],
    "lz4-sys": [("LZ4", "BSD-2-Clause", "Yann Collet", "liblz4/lib/LICENSE")],
    "snappy_src": [("Snappy", "BSD-3-Clause", "Google Inc.", "snappy/COPYING")],
    "zstd-sys": [("Zstandard", "BSD-3-Clause", "Meta Platforms, Inc. and affiliates", "zstd/LICENSE")],
}
# The page of `walpha view`, with the scripts of others and the texts of their licences: a part of walpha-render.
PAGE = ROOT / "crates/render/src/view/page.html"
# Texts that walpha has, for packages without one.
OURS = {"Apache-2.0": "crates/base/LICENSE-APACHE", "GPL-3.0-or-later": "LICENSE"}
TEXT = re.compile(r"(licen[cs]e|copying|copyright|notice|unlicense)([-_.].*)?", re.IGNORECASE)


def run(*command):
    done = subprocess.run(["cargo", *command, "--offline", "--locked"], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout


def packages(arguments):
    """What is built into the packages that the arguments select, without those of this workspace; and whether the page is."""
    tree = run("tree", "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}", *arguments)
    built = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    known = json.loads(run("metadata", "--format-version", "1", "--all-features"))["packages"]
    theirs = [package for package in known if package["source"] and (package["name"], f"v{package['version']}") in built]
    return sorted(theirs, key=lambda package: (package["name"], package["version"])), any(name == "walpha-render" for name, _ in built)


def texts(package):
    """The files with the licence of a package. Where one may choose MIT, its text is enough."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file() and TEXT.fullmatch(path.name))
    if " AND " not in package["license"] and any("MIT" in path.name.upper() for path in files):
        files = [path for path in files if not re.search("APACHE|LLVM|_A2", path.name.upper())]
    inside = [folder / path for *_, path in INSIDE.get(package["name"], []) if path]
    return files + inside


def of_page():
    """The names of what is in the page, and the text of each licence."""
    notices = re.search(r'<pre id="notices-text"[^>]*>(.*?)</pre>', PAGE.read_text(encoding="utf-8"), re.DOTALL)
    return [section.strip().split("\n", 1) for section in notices[1].split("## ")[1:]]


def main():
    found, has_page = packages(sys.argv[1:])
    rows, by_text, without = [], {}, []
    for package in found:
        name = f"{package['name']} {package['version']}"
        rows.append((name, package["license"] or "see its text", package["repository"] or ""))
        rows += [(f"in it: {what}", licence, who) for what, licence, who, _ in INSIDE.get(package["name"], [])]
        files = texts(package)
        if not files:
            without.append(f"{name} ({', '.join(package['authors']) or 'no authors stated'})")
        for path in files:
            text = path.read_text(encoding="utf-8", errors="replace").strip()
            key = " ".join(text.split())
            by_text.setdefault(key, (text, []))[1].append(name)
    for name, text in of_page() if has_page else []:
        rows.append((f"in pages: {name}", "MIT", "its authors"))
        by_text[" ".join(text.split())] = (text.strip(), [name])
    print("# Third-party notices\n\nWhat is built into this artefact of walpha and was written by others. walpha itself is under its LICENSE.\n")
    print("| what | licence | where it is from |\n|---|---|---|")
    print("".join(f"| {' | '.join(row)} |\n" for row in rows))
    print("The standard library of Rust is MIT or Apache-2.0.\n")
    if without:
        print(f"These come without a text of their licence, which is the one of that name below: {'; '.join(without)}.\n")
    used = " ".join(licence for _, licence, _ in rows)
    for licence, path in OURS.items():
        if licence in used:
            text = (ROOT / path).read_text(encoding="utf-8").strip()
            by_text.setdefault(" ".join(text.split()), (text, []))[1].append(licence)
    for text, names in by_text.values():
        fence = "~~~~~~~~"
        print(f"## {', '.join(dict.fromkeys(names))}\n\n{fence}\n{text}\n{fence}\n")


if __name__ == "__main__":
    main()
