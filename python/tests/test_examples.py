import importlib.util
import pathlib
import re
import subprocess
import sys

import pytest

FOLDER = pathlib.Path(__file__).parent.parent / "examples"
NEEDS = {
    "picture.py": ["pyvista"],
    "check_others.py": ["gudhi", "scipy"],
    "own_weights.py": [],
    "napari_surface.py": [],
    "choose_alpha.py": [],
    "optimise_persistence.py": ["torch"],
}


def test_every_example_is_listed():
    assert {path.name for path in FOLDER.glob("*.py")} == set(NEEDS)


@pytest.mark.parametrize("name", NEEDS)
def test_an_example_runs(name, tmp_path):
    for package in NEEDS[name]:
        pytest.importorskip(package)
    command = [sys.executable, "-X", "utf8", FOLDER / name]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, encoding="utf8", timeout=300)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout
    if name == "picture.py":
        assert (tmp_path / "phantom.png").stat().st_size > 10_000
    if name == "optimise_persistence.py":
        first, last = (float(number) for number in re.findall(r"0\.\d+", ran.stdout))
        assert last > 2 * first
    if name == "napari_surface.py" and importlib.util.find_spec("napari") is None:
        assert "pip install napari" in ran.stdout
