import numpy as np
import pytest

import walpha
from walpha.tda import AlphaPersistence


@pytest.fixture(scope="module")
def clouds():
    rng = np.random.default_rng(3)
    return [rng.random((n, 3)) for n in (60, 80, 5)]


def test_diagrams_are_those_of_filtrations(clouds):
    diagrams = AlphaPersistence().fit_transform(clouds)
    assert diagrams.shape[0] == 3 and diagrams.shape[2] == 3 and np.isfinite(diagrams).all()
    for points, diagram in zip(clouds, diagrams):
        simplices = walpha.filtration(points).simplices()
        for dimension in (0, 1, 2):
            wanted = simplices.persistence(dimension)
            wanted = wanted[np.isfinite(wanted[:, 1])]
            of = diagram[diagram[:, 2] == dimension, :2]
            assert np.array_equal(of[: len(wanted)], wanted) and (of[len(wanted) :] == 0).all()
    # By dimension, each as wide as the cloud that needs most.
    assert diagrams[0, :, 2].tolist() == sorted(diagrams[0, :, 2]) and (diagrams[:, :, 2] == diagrams[0, :, 2]).all()
    assert (diagrams[0, :, 2] == 0).sum() == 79


def test_gudhi_has_the_same(clouds):
    gudhi = pytest.importorskip("gudhi")
    tree = gudhi.AlphaComplex(points=clouds[1], precision="exact").create_simplex_tree()
    tree.compute_persistence()
    for dimension in (1, 2):
        (diagram,) = AlphaPersistence((dimension,), radius=True).fit_transform([clouds[1]])
        theirs = np.sqrt(np.sort(tree.persistence_intervals_in_dimension(dimension), axis=0))
        assert len(diagram) > 5 and np.allclose(np.sort(diagram[:, :2], axis=0), theirs)


def test_options(clouds):
    (whole,) = AlphaPersistence((0,), reduced_homology=False).fit_transform(clouds[:1])
    (reduced,) = AlphaPersistence((0,)).fit_transform(clouds[:1])
    assert len(whole) == len(reduced) + 1 == 60 and np.isinf(whole[:, 1]).sum() == 1
    assert AlphaPersistence((2,)).fit_transform(clouds[2:]).shape[1] <= 1
    assert AlphaPersistence().fit_transform(np.array(clouds[:1]))[0].shape[1] == 3
    with pytest.raises(ValueError, match="there are 0, 1 and 2"):
        AlphaPersistence((0, 3)).fit(clouds)
    transformer = AlphaPersistence().set_params(radius=True)
    assert transformer.get_params()["radius"] is True
    with pytest.raises(ValueError, match="radios"):
        transformer.set_params(radios=True)


def test_scikit_learn_takes_it(clouds):
    base = pytest.importorskip("sklearn.base")
    pipeline = pytest.importorskip("sklearn.pipeline")
    preprocessing = pytest.importorskip("sklearn.preprocessing")
    given = AlphaPersistence((0,), threads=1)
    cloned = base.clone(given)
    assert cloned is not given and cloned.homology_dimensions == (0,) and cloned.threads == 1
    flat = preprocessing.FunctionTransformer(lambda diagrams: diagrams.reshape(len(diagrams), -1))
    steps = pipeline.make_pipeline(given, flat, preprocessing.StandardScaler())
    assert steps.fit_transform(clouds).shape == (3, 79 * 3)
