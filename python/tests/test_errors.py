import subprocess
import sys

import numpy as np
import pytest

import walpha


@pytest.mark.parametrize(
    "points, message",
    [
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, np.nan]], "point 3 .* finite"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.inf, 0, 0]], "point 3 .* finite"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1e200, 0, 0]], "point 3 .* magnitude"),
        ([], "0 distinct points"),
    ],
)
@pytest.mark.parametrize("engine", ["auto", "cgal", "native"])
def test_points_that_make_no_shape(points, message, engine):
    with pytest.raises(ValueError, match=message):
        walpha.alpha_shape(points, alpha=1, engine=engine)
    with pytest.raises(ValueError, match=message):
        walpha.filtration(points)


@pytest.mark.parametrize("engine", ["cgal", "native"])
def test_points_of_a_plane_have_the_shape_that_they_have_there(engine):
    square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [3, 1, 0]]
    shape = walpha.alpha_shape(square, alpha=1, engine=engine)
    assert len(shape.cells) == 0
    assert len(shape.facets) == 2 and len(shape.vertices) == 5
    filtration = walpha.filtration(square)
    assert len(filtration.simplices().cells) == 0
    assert len(filtration.shape(1).facets) == 2
    assert filtration.levels([1])[0].coverage == 0
    assert filtration.optimal_alpha() == filtration.suggestions().one_region


@pytest.mark.parametrize(
    "options, message",
    [
        ({"alpha": 1, "alpha_radius": 1}, "one of them"),
        ({"alpha": np.nan}, "alpha is NaN"),
        ({"alpha": "car"}, "auto"),
        ({"alpha_radius": -1}, "not a radius"),
        ({"alpha": np.zeros(600)}, r"alpha is one number.*\(600,\).*weights="),
        ({"alpha": "auto:connected", "alpha_radius": 1}, "one of them"),
        ({"alpha": object()}, "alpha=.* is not a number"),
        ({"threads": 0}, "threads=0.*from 1 up"),
        ({"threads": 1.5}, "threads=1.5"),
        ({"progress": 7}, "progress=7"),
        ({"engine": "qhull"}, "auto, cgal, native, both"),
        ({"balls": "cubes"}, "power, radius"),
        ({"balls": "radius"}, "α is a radius"),
        ({"alpha": 0.1, "balls": "radius", "weights": np.full(600, -1.0)}, "use `balls` power"),
        ({"weights": np.full(600, np.nan)}, "weight of point 0 is NaN"),
    ],
)
def test_options_that_make_no_sense(cloud, options, message):
    with pytest.raises(ValueError, match=message):
        walpha.alpha_shape(cloud, **options)


def test_unknown_names_are_type_errors(cloud):
    with pytest.raises(TypeError):
        walpha.alpha_shape(cloud, apha=1)


def test_one_order_of_arguments(cloud, weights):
    """Points, then α, then names: weights are never taken for α, nor α for weights."""
    assert walpha.alpha_shape(cloud, 0.01).alpha == walpha.filtration(cloud).shape(0.01).alpha == 0.01
    assert walpha.check(cloud, 0.01, cells=walpha.alpha_shape(cloud, 0.01, exterior=True).cells[:0]) is not None
    for call in (
        lambda: walpha.alpha_shape(cloud, 0.01, weights),
        lambda: walpha.filtration(cloud, weights),
        lambda: walpha.Complex(cloud, 0.01),
        lambda: walpha.check(cloud, 0.01, weights),
        lambda: walpha.write_points("never.csv", cloud, weights),
    ):
        with pytest.raises(TypeError, match="positional"):
            call()
    for kind in (walpha.AlphaShape, walpha.Triangulation, walpha.Simplices):
        with pytest.raises(TypeError, match=f"walpha\\.{'alpha_shape' if kind is walpha.AlphaShape else ''}"):
            kind()


def test_files(tmp_path, cloud):
    with pytest.raises(FileNotFoundError, match="no/such.nrrd"):
        walpha.read("no/such.nrrd")
    (tmp_path / "bad.nrrd").write_text("NRRD0004\n")
    with pytest.raises(ValueError, match="bad.nrrd"):
        walpha.read(tmp_path / "bad.nrrd")
    shape = walpha.alpha_shape(cloud, alpha=0.01)
    with pytest.raises(OSError, match=r"nothing[/\\]here.ply: there is no folder .*nothing;"):
        shape.save(tmp_path / "nothing/here.ply")
    with pytest.raises(ValueError, match="did you mean .ply"):
        shape.save(tmp_path / "here.plyy")
    with pytest.raises(ValueError, match="solid=True"):
        shape.save(tmp_path / "here.vtu", solid=True)
    assert list(tmp_path.iterdir()) == [tmp_path / "bad.nrrd"]


def test_values_are_needed_to_interpolate(cloud):
    with pytest.raises(ValueError, match="values="):
        walpha.alpha_shape(cloud, alpha=0.01).at(cloud)


GREEDY = """
import numpy as np, resource, walpha
shape = walpha.alpha_shape(np.eye(4)[:, :3], alpha=9, values=np.zeros(4))
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, resource.getrlimit(resource.RLIMIT_AS)[1]))
try:
    shape.interpolate((4000, 1000, 1000))
except MemoryError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs RLIMIT_AS")
def test_memory():
    ran = subprocess.run([sys.executable, "-c", GREEDY], capture_output=True, text=True)
    assert "not enough memory: " in ran.stdout, ran.stderr


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_differences_are_finite(bad):
    # Of equal ones, too, whose weights are all 0.
    with pytest.raises(ValueError, match=r"differences\[2\] is "):
        walpha.weigh([0.01, 0.01, bad, 0.01], alpha=0.1)


def test_what_is_told_is_short(cloud):
    shape = walpha.alpha_shape(cloud, 0.02)
    wrong = walpha.check(cloud, 0.025, cells=shape.cells)
    assert not wrong and len(repr(wrong)) < 2000 and repr(wrong).startswith("<walpha.Verdict wrong: ")
    with pytest.raises(ValueError, match=r"\.ply, .*, \.png, \.html; choose one of these$"):
        shape.save("shape.foo")
