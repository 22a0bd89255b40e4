#!/usr/bin/env python3
"""Runs the notebooks of docs/notebooks, each in a kernel and a folder of its own, with the walpha of this Python.

    python scripts/run_notebooks.py          # every cell runs without an error, and prints what is stored
    python scripts/run_notebooks.py write    # run them, and store what they print and draw

Pictures are stored so that readers see them; they are not compared. Needs nbclient and ipykernel. Exit code 1 where something differs.
"""

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

FOLDER = Path(__file__).resolve().parent.parent / "docs/notebooks"
#: Of all notebooks together, in bytes: they are in the repository.
MOST = 400_000


def printed(cell):
    """What a cell prints, without its pictures."""
    return "".join(output["text"] for output in cell.get("outputs", []) if output["output_type"] == "stream")


def run(path):
    """A notebook as stored, and as it is after every cell has run."""
    stored, ran = (nbformat.read(path, as_version=4) for _ in range(2))
    with tempfile.TemporaryDirectory() as folder:
        NotebookClient(ran, timeout=300, kernel_name="python3", record_timing=False, resources={"metadata": {"path": folder}}).execute()
    # Versions of what ran it are not of interest.
    ran.metadata = stored.metadata
    return stored, ran


def main():
    write = sys.argv[1:] == ["write"]
    wrong = []
    paths = sorted(FOLDER.glob("*.ipynb"))
    for path in paths:
        try:
            stored, ran = run(path)
        except CellExecutionError as error:
            wrong.append(f"{path.name}: {error}")
            continue
        if write:
            nbformat.write(ran, path)
            continue
        for before, after in zip(stored.cells, ran.cells):
            if printed(before) != printed(after):
                wrong.append(f"{path.name}, cell {after.id} prints\n{printed(after)}\nand is stored with\n{printed(before)}")
    size = sum(path.stat().st_size for path in paths)
    if size > MOST:
        wrong.append(f"the notebooks have {size} bytes: make their pictures smaller")
    for text in wrong:
        print(text)
    print(f"{len(paths)} notebooks, {size} bytes; {len(wrong)} things are wrong (`write` stores what they print)")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
