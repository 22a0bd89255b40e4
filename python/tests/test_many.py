"""Many clouds at once: each as the functions for one make it."""

import pickle

import numpy as np
import pytest

import walpha


@pytest.fixture(scope="module")
def clouds():
    rng = np.random.default_rng(3)
    return [rng.random((n, 3)) for n in (60, 5, 300, 2500)]


@pytest.mark.parametrize("threads", [None, 1, 2, 3])
def test_filtrations_are_those_of_each(clouds, threads):
    weights = [0.01 * np.arange(len(points)) / len(points) for points in clouds]
    many = walpha.filtrations(clouds, weights=weights, threads=threads)
    assert len(many) == len(clouds)
    for points, own, made in zip(clouds, weights, many):
        alone = walpha.filtration(points, weights=own)
        assert isinstance(made, walpha.Filtration) and np.array_equal(made.points, points)
        for name in ("cells", "values", "loop_pairs"):
            assert np.array_equal(getattr(made.simplices(), name), getattr(alone.simplices(), name)), name


def test_what_is_made_is_a_filtration_like_any_other(clouds):
    [made] = walpha.filtrations(clouds[:1], periodic=1.0)
    again = pickle.loads(pickle.dumps(made))
    assert made.periodic == again.periodic == (1, 1, 1)
    assert made.shape(0.01).betti == again.shape(0.01).betti
    assert made.cycles(1)[0].pair == walpha.filtration(clouds[0], periodic=1.0).cycles(1)[0].pair


@pytest.mark.filterwarnings("ignore:alpha was found for each shape")
@pytest.mark.parametrize("alpha", ["auto", 0.02])
def test_shapes_are_those_of_each(clouds, alpha):
    values = [points[:, 0] for points in clouds]
    with_options = {"exterior": True, "periodic": 1.0}
    shapes = walpha.alpha_shapes(clouds, alpha, values=values, **with_options)
    for points, own, shape in zip(clouds, values, shapes, strict=True):
        alone = walpha.alpha_shape(points, alpha, values=own, **with_options)
        assert shape.alpha == alone.alpha and np.array_equal(shape.cells, alone.cells) and np.array_equal(shape.values, alone.values)
    assert walpha.alpha_shapes(clouds[:1], alpha_radius=0.2)[0].alpha == pytest.approx(0.04)


def test_clouds_are_given_in_many_ways(clouds):
    pandas = pytest.importorskip("pandas")
    of_three = np.random.default_rng(1).random((7, 30, 3))
    weights = np.random.default_rng(2).random((7, 30)) / 50
    made = walpha.filtrations(of_three, weights=weights)
    tables = [pandas.DataFrame({"x": x, "y": y, "z": z, "weight": w}) for (x, y, z), w in zip(of_three.transpose(0, 2, 1), weights)]
    frames = walpha.filtrations(table for table in tables)
    for a, b in zip(made, frames, strict=True):
        assert np.array_equal(a.simplices().values, b.simplices().values) and a.weights.any()
    in_planes = walpha.filtrations(of_three[:, :, :2])
    assert all(len(filtration.simplices().cells) == 0 for filtration in in_planes)
    assert walpha.filtrations([]) == walpha.alpha_shapes([], 1) == walpha.filtrations(np.zeros((0, 5, 3))) == []


def test_errors_name_the_first_cloud_that_is_wrong(clouds):
    wrong = [*clouds[:2], np.full((4, 3), np.nan), clouds[2], np.full((4, 3), np.inf)]
    for _ in range(5):
        with pytest.raises(ValueError, match=r"^cloud 2: .*point 0"):
            walpha.filtrations(wrong)
        with pytest.raises(ValueError, match=r"^cloud 2: .*point 0"):
            walpha.alpha_shapes(wrong, 1.0)
    with pytest.raises(ValueError, match=r"^cloud 1: points has shape \(3, 5\)"):
        walpha.filtrations([clouds[0], np.zeros((3, 5))])
    with pytest.raises(ValueError, match="^cloud 1: .*weights"):
        walpha.filtrations(clouds, weights=[np.ones(60), np.ones(6), np.ones(300), np.ones(2500)])
    with pytest.raises(ValueError, match="weights of 2 clouds for 4: give those of each cloud"):
        walpha.filtrations(clouds, weights=[None, None])
    with pytest.raises(ValueError, match="clouds cannot be taken one by one"):
        walpha.filtrations(3)
    with pytest.raises(ValueError, match=r"shape \(60, 3\), as one cloud has: give a list of clouds"):
        walpha.alpha_shapes(clouds[0], 1.0)


def test_progress_counts_clouds_and_can_end_the_work(clouds):
    heard = []
    walpha.filtrations(clouds * 20, progress=lambda *step: heard.append(step))
    assert {stage for stage, _, _ in heard} == {"filtration"} and heard[-1][2] in (0, 80)

    def enough(stage, done, total):
        raise LookupError(stage)

    with pytest.raises(LookupError, match="shape"):
        walpha.alpha_shapes(clouds * 20, 0.01, progress=enough)
