"""Pictures, charts and pages: what notebooks show, and files."""

import base64
import gzip
import json
import pickle
import re
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest

import walpha


@pytest.fixture(scope="module")
def shape(cloud):
    return walpha.alpha_shape(cloud, values=cloud[:, 2])


def pixels(png):
    """The size of a PNG."""
    assert bytes(png).startswith(b"\x89PNG\r\n\x1a\n")
    return struct.unpack(">II", bytes(png)[16:24])


def test_a_shape_is_drawn(shape):
    picture = shape.plot(size=(120, 90))
    assert pixels(picture) == (120, 90)
    assert picture._repr_png_() == bytes(picture)
    assert repr(picture) == "<walpha.Picture of 120×90 pixels>"
    others = [
        shape.plot(size=(120, 90), view="top"), shape.plot(size=(120, 90), colour="value"), shape.plot(size=(120, 90), colour="class")
    ]
    assert len({bytes(picture), *map(bytes, others)}) == 4
    assert bytes(shape.plot(size=(120, 90))) == bytes(picture), "the same each time"


@pytest.mark.parametrize("wrong, word", [({"view": "behind"}, "behind"), ({"colour": "red"}, "red"), ({"size": (0, 9)}, "0")])
def test_wrong_views_are_refused(shape, wrong, word):
    with pytest.raises(ValueError, match=word):
        shape.plot(**wrong)


def test_values_are_needed_to_colour_by(cloud):
    with pytest.raises(ValueError, match="no values"):
        walpha.alpha_shape(cloud).plot(colour="value")


def test_a_torus_is_drawn_and_has_a_page(cloud, monkeypatch):
    torus = walpha.alpha_shape(cloud, alpha=0.003, periodic=1.0)
    assert pixels(torus.plot(size=(60, 50))) == (60, 50)
    assert "walpha.AlphaShape" in torus._repr_html_()
    monkeypatch.setattr("webbrowser.open", lambda _: True)
    packed = re.search('<script id="page"[^>]*>([^<]+)', torus.show().html)[1]
    unpacked = gzip.decompress(base64.b64decode(packed))
    content = json.loads(unpacked[4 : 4 + int.from_bytes(unpacked[:4], "little")])
    assert content["cell"][1:] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]] and content["points"] == [len(cloud)]
    with pytest.raises(ValueError, match="unwrapped"):
        torus.unwrapped().show()


def test_the_page_is_that_of_the_shape(shape, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    page = shape.show()
    assert opened and opened[0].startswith("file:")
    assert page.html.startswith("<!DOCTYPE html>") and "ball radius" in page.html
    frame = page._repr_html_()
    assert frame.startswith("<iframe") and "srcdoc" in frame and "<script" not in frame, "escaped"
    page.save(tmp_path / "page.html")
    shape.save(tmp_path / "shape.html")
    assert (tmp_path / "page.html").read_bytes() == (tmp_path / "shape.html").read_bytes() == page.html.encode()


def test_files_have_their_extensions(shape, tmp_path):
    shape.save(tmp_path / "shape.png")
    assert pixels((tmp_path / "shape.png").read_bytes()) == (1600, 1360)
    for thing, name in [(shape.plot(size=(9, 9)), "a.jpg"), (shape._page(), "a.png")]:
        with pytest.raises(ValueError, match="a name that ends so"):
            thing.save(tmp_path / name)
    with pytest.raises(ValueError, match="solid=True"):
        shape.save(tmp_path / "b.png", solid=True)
    with pytest.raises(OSError):
        shape.plot(size=(9, 9)).save(tmp_path / "missing" / "a.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["shape.png"]


def test_notebooks_show_a_picture_and_five_numbers(shape):
    text = shape._repr_html_()
    assert text.count("<tr>") == 5 and "data:image/png;base64," in text
    for word in ("600", "ball radius", "component", "volume", "loose"):
        assert word in text, word


def test_a_plane_and_an_empty_shape_are_shown():
    flat = walpha.alpha_shape(np.random.default_rng(1).random((50, 2)), np.inf)
    assert "area" in flat._repr_html_()
    empty = walpha.alpha_shape(np.eye(4)[:, :3], alpha=-1)
    assert "img" not in empty._repr_html_()


def test_a_volume_is_shown_by_its_slices():
    samples = np.zeros((10, 20, 40), np.float32)
    samples[5, 10, 20] = 7
    volume = walpha.Volume(samples, spacing=(1, 1, 2))
    picture = volume.plot(low=0, high=7)
    width, height = pixels(picture)
    # 240 pixels for the 40 along x; the other sides in proportion, and two gaps.
    assert (width, height) == (240 + 8 + 240 + 8 + 120, 120)
    data = bytes(picture)
    packed = data[data.index(b"IDAT") + 4:data.index(b"IEND") - 8]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, width + 1)
    assert (rows[:, 0] == 0).all() and (rows == 255).sum() > 0
    # Gaps are black, whatever the values are.
    assert walpha.Volume(samples + 9, spacing=(1, 1, 2)).plot(low=9, high=16)._repr_png_() == data
    assert "40 × 20 × 10 (x, y, z)" in volume._repr_html_()
    with pytest.raises(ValueError, match="is not below"):
        volume.plot(low=2, high=1)
    assert pixels(walpha.Volume(np.full((3, 3, 3), np.nan), masked=True).plot())


def test_curves_have_axes(cloud):
    curve = walpha.filtration(cloud).betti_curve()
    chart = curve.plot().svg
    for word in ("ball radius", "components", "tunnels", "voids", ">0.01<", ">100<"):
        assert word in chart, word
    assert curve._repr_html_() == chart == curve.plot()._repr_svg_()


def test_other_objects_are_shown(cloud):
    assert "600" in walpha.filtration(cloud)._repr_html_()
    assert "cells" in walpha.triangulation(cloud)._repr_html_()


@pytest.mark.parametrize("arguments, code", [(["--version"], 0), (["shape"], 2), (["shape", "no.xyz"], 1)])
def test_the_command_comes_with_the_package(arguments, code):
    run = subprocess.run([sys.executable, "-m", "walpha._command", *arguments], capture_output=True, text=True, check=False)
    assert run.returncode == code, run.stderr
    assert ("walpha" in run.stdout) == (code == 0) and (run.stderr == "") == (code == 0)


def test_diagrams_are_drawn(cloud):
    simplices = walpha.filtration(cloud).simplices()
    chart = simplices.plot()
    assert chart.svg.startswith("<svg") and "never" in chart.svg
    assert f"{len(simplices.persistence(2))} voids" in chart.svg
    # Of a copy that was stored, too; and of what has no interval.
    assert pickle.loads(pickle.dumps(simplices)).plot().svg == chart.svg
    assert "1 component" in walpha.filtration([[0, 0, 0]]).simplices().plot().svg


def test_summaries_of_parts(cloud):
    shape = walpha.alpha_shape(cloud, 0.05)
    for made, words in [
        (shape.boundary(), ["walpha.Boundary", "triangles"]),
        (walpha.check(shape), ["walpha.Verdict", "exact", "not judged"]),
        (walpha.filtration(cloud).simplices(), ["walpha.Simplices", "facets"]),
    ]:
        summary = made._repr_html_()
        assert all(word in summary for word in words), summary
