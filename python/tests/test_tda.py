import pickle

import numpy as np
import pytest

import walpha

base = pytest.importorskip("sklearn.base")
tda = pytest.importorskip("walpha.tda")
AlphaPersistence, BettiCurve = tda.AlphaPersistence, tda.BettiCurve
PersistenceImage, PersistenceLandscape = tda.PersistenceImage, tda.PersistenceLandscape
FEATURES = [PersistenceImage(7, power=0), PersistenceLandscape(3, resolution=11), BettiCurve(resolution=9)]
BOX = [[1, 0, 0], [0.3, 1, 0], [0, 0, 1]]


@pytest.fixture(scope="module")
def clouds():
    rng = np.random.default_rng(3)
    return [rng.random((n, 3)) for n in (60, 80, 5)]


@pytest.fixture(scope="module")
def diagrams(clouds):
    return AlphaPersistence(radius=True).fit_transform(clouds)


@pytest.mark.parametrize("n_jobs", [None, 1, 3, -1])
@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("periodic", [None, BOX])
def test_diagrams_are_those_of_filtrations(clouds, n_jobs, weighted, periodic):
    weights = [0.01 * points[:, 0] for points in clouds]
    given = [np.column_stack([*columns]) for columns in zip(clouds, weights)] if weighted else clouds
    transformer = AlphaPersistence(weighted=weighted, periodic=periodic, n_jobs=n_jobs)
    diagrams = transformer.fit_transform(given)
    assert diagrams.shape[0] == 3 and diagrams.shape[2] == 3 and np.isinf(diagrams).any() == (periodic is not None)
    for points, own, diagram in zip(clouds, weights, diagrams):
        simplices = walpha.filtration(points, weights=own if weighted else None, periodic=periodic).simplices()
        for dimension in (0, 1, 2):
            wanted = simplices.persistence(dimension)
            wanted = wanted[np.isfinite(wanted[:, 1])] if dimension == 0 else wanted
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
    with pytest.raises(ValueError, match="periodic has shape"):
        AlphaPersistence(periodic=[1, 2]).fit(clouds)
    with pytest.raises(ValueError, match="^cloud 1 has shape"):
        AlphaPersistence(weighted=True).fit_transform([np.ones((4, 3)), np.ones((4, 2))])
    with pytest.raises(ValueError, match="radius=True: α is -0.25"):
        AlphaPersistence(radius=True, weighted=True).fit_transform([[[0, 0, 0, 0.5], [1, 0, 0, 0.25]]])


def grids(transformer, dimension, kind):
    grid = transformer.grids_[dimension]
    return grid if kind is PersistenceImage else [grid[0], grid[-1]]


@pytest.mark.parametrize("dimension", [1, 2])
def test_features_are_those_of_gudhi(diagrams, dimension):
    representations = pytest.importorskip("gudhi.representations")
    given = diagrams[:, diagrams[0, :, 2] == dimension]
    theirs = [rows[rows[:, 1] > rows[:, 0], :2] for rows in given]
    image = PersistenceImage(13, bandwidth=0.03, power=1.5).fit(given)
    births, persistence = image.grids_[dimension]
    wanted = representations.PersistenceImage(
        bandwidth=0.03, weight=lambda place: place[1] ** 1.5, resolution=[13, 13], im_range=[births[0], births[-1], 0, persistence[-1]]
    )
    assert np.allclose(image.transform(given), wanted.fit_transform(theirs), rtol=1e-12) and image.transform(given).max() > 1e-3
    landscape = PersistenceLandscape(4, resolution=23).fit(given)
    ends = landscape.grids_[dimension][[0, -1]]
    wanted = representations.Landscape(num_landscapes=4, resolution=23, sample_range=ends).fit_transform(theirs)
    assert np.allclose(np.sqrt(2) * landscape.transform(given), wanted, atol=1e-14) and wanted[:2].all(axis=0).any()
    curve = BettiCurve(resolution=31).fit(given)
    wanted = representations.BettiCurve(predefined_grid=curve.grids_[dimension]).fit_transform(theirs)
    assert np.array_equal(curve.transform(given), wanted) and wanted.max() > 2


def test_curves_are_those_of_filtrations(clouds):
    curve = walpha.filtration(clouds[0]).betti_curve()
    diagram = AlphaPersistence(reduced_homology=False).fit_transform(clouds[:1])
    made = BettiCurve(resolution=57).fit(diagram)
    for dimension, wanted in enumerate((curve.b0, curve.b1, curve.b2)):
        # `alpha` is just above each value, and diagrams have the nearest doubles.
        at = np.searchsorted(curve.alpha, made.grids_[dimension] * (1 + 1e-9), side="right") - 1
        assert np.array_equal(made.transform(diagram).reshape(3, -1)[dimension], wanted[at])


@pytest.mark.parametrize("transformer", FEATURES, ids=lambda of: type(of).__name__)
def test_features_are_tables(diagrams, transformer):
    pandas = pytest.importorskip("pandas")
    fitted = base.clone(transformer).fit(diagrams)
    rows = fitted.transform(diagrams)
    names = fitted.get_feature_names_out()
    assert rows.shape == (3, len(names)) and len(set(names)) == len(names) and {name[:2] for name in names} == {"h0", "h1", "h2"}
    table = fitted.set_output(transform="pandas").transform(diagrams)
    assert isinstance(table, pandas.DataFrame) and table.columns.tolist() == names.tolist() and np.array_equal(table, rows)
    # What fills diagrams, and the order of intervals, change nothing.
    filled = np.concatenate([diagrams[:, ::-1], np.tile([[-1, -1, 1]], (3, 4, 1))], axis=1)
    assert np.allclose(fitted.transform(filled), rows, rtol=1e-12)
    assert np.allclose(base.clone(transformer).fit(filled).transform(diagrams), rows, rtol=1e-12)
    # Fewer intervals than layers, none, and a dimension that was not there.
    assert fitted.transform(np.zeros((2, 0, 3))).shape == (2, rows.shape[1])
    assert not np.asarray(fitted.transform([[[0, 1, 7]]])).any()
    assert np.isfinite(base.clone(transformer).fit_transform([[[0, 0, 1]]])).all()
    assert np.isfinite(np.asarray(fitted.transform([[[0, np.inf, 1]]]))).all()
    again = pickle.loads(pickle.dumps(fitted))
    assert np.array_equal(again.transform(diagrams), table)


@pytest.mark.parametrize("transformer", FEATURES, ids=lambda of: type(of).__name__)
def test_features_refuse_what_is_no_diagram(diagrams, transformer):
    made = base.clone(transformer)
    with pytest.raises(ValueError, match=r"X has shape \(3, 4\)"):
        made.fit(np.ones((3, 4)))
    for row in ([1, 0, 1], [np.nan, 1, 1], [0, np.nan, 1], [-np.inf, 1, 1]):
        with pytest.raises(ValueError, match="X: row 1 of sample 0.*not a birth, a later death and a dimension"):
            made.fit([[[0, 1, 1], row]])
    with pytest.raises(ValueError, match="resolution=0 is not a count"):
        base.clone(transformer).set_params(resolution=0).fit(diagrams)
    for parameter, wrong in {"bandwidth": 0.0, "power": -1.0, "n_layers": 1.5}.items():
        if parameter in made.get_params():
            with pytest.raises(ValueError, match=f"{parameter}="):
                base.clone(transformer).set_params(**{parameter: wrong}).fit(diagrams)


@pytest.mark.parametrize("transformer", [AlphaPersistence(), *FEATURES], ids=lambda of: type(of).__name__)
def test_estimators_keep_the_rules_of_scikit_learn(clouds, diagrams, transformer):
    checks = pytest.importorskip("sklearn.utils.estimator_checks")
    name = type(transformer).__name__
    # Those of its checks that need no table of rows: these would be refused.
    for check in (
        "check_estimator_cloneable", "check_no_attributes_set_in_init", "check_parameters_default_constructible", "check_get_params_invariance",
        "check_set_params", "check_estimator_repr", "check_estimator_tags_renamed", "check_valid_tag_types", "check_mixin_order",
        "check_do_not_raise_errors_in_init_or_set_params",
    ):  # fmt: skip
        getattr(checks, check)(name, base.clone(transformer))
    with pytest.warns(Warning, match="Can't test estimator"):
        checks.check_estimator(base.clone(transformer))
    given = clouds if name == "AlphaPersistence" else diagrams
    made = base.clone(transformer)
    before = made.get_params()
    assert made.fit(given) is made and made.get_params() == before
    assert np.array_equal(made.transform(given), base.clone(transformer).fit_transform(given))
    if name != "AlphaPersistence":
        with pytest.raises(pytest.importorskip("sklearn.exceptions").NotFittedError):
            base.clone(transformer).transform(given)


def test_pipelines_and_searches(clouds):
    pipeline = pytest.importorskip("sklearn.pipeline")
    selection = pytest.importorskip("sklearn.model_selection")
    linear = pytest.importorskip("sklearn.linear_model")
    rng = np.random.default_rng(0)
    # Points on spheres have a void, those in balls have none that lasts.
    directions = rng.normal(size=(24, 60, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    labels = np.arange(24) % 2
    radii = np.where(labels[:, None], 1, rng.random((24, 60)) ** (1 / 3))
    given = directions * radii[:, :, None]
    union = pipeline.make_union(PersistenceImage(4), BettiCurve(resolution=5))
    steps = pipeline.make_pipeline(AlphaPersistence((2,), radius=True, n_jobs=-1), union).set_output(transform="pandas")
    table = steps.fit_transform(given)
    assert table.shape == (24, 4 * 4 + 5) and "bettcurve"[:4] in "".join(table.columns).lower()
    assert steps.get_feature_names_out().tolist() == table.columns.tolist()
    classifier = pipeline.make_pipeline(AlphaPersistence((1, 2)), PersistenceLandscape(resolution=10), linear.LogisticRegression())
    search = selection.GridSearchCV(classifier, {"alphapersistence__radius": [False, True], "persistencelandscape__n_layers": [1, 2]}, cv=3)
    assert search.fit(given, labels).best_score_ > 0.9


def test_weighted_clouds_may_be_tables_or_masked(clouds):
    pandas = pytest.importorskip("pandas")
    weights = [np.linspace(0, 0.01, len(cloud)) for cloud in clouds]
    arrays = [np.column_stack([cloud, of]) for cloud, of in zip(clouds, weights)]
    wanted = AlphaPersistence(weighted=True).fit_transform(arrays)
    tables = [pandas.DataFrame({"weight": of, "z": c[:, 2], "y": c[:, 1], "x": c[:, 0]}) for c, of in zip(clouds, weights)]
    assert np.array_equal(AlphaPersistence(weighted=True).fit_transform(tables), wanted)
    balls = [table.assign(radius=np.sqrt(table.weight)).drop(columns="weight") for table in tables]
    assert np.allclose(AlphaPersistence(weighted=True).fit_transform(balls), wanted)
    with pytest.raises(ValueError, match="has no column weight or radius"):
        AlphaPersistence(weighted=True).fit_transform([tables[0][["x", "y", "z"]]])
    more = [np.ma.masked_invalid(np.vstack([array, [np.nan] * 4])) for array in arrays]
    assert np.array_equal(AlphaPersistence(weighted=True).fit_transform(more), wanted)


@pytest.mark.parametrize("transformer", FEATURES)
def test_features_of_few_intervals(transformer):
    # None at all, and those that never end.
    assert base.clone(transformer).fit_transform(np.zeros((2, 0, 3))).shape == (2, 0)
    lasting = np.array([[[0, np.inf, 0]]])
    assert np.isfinite(base.clone(transformer).fit_transform(lasting)).all()
    fitted = base.clone(transformer).fit([[[0, 1, 1], [1, 2, 1]]])
    count = len(fitted.get_feature_names_out())
    assert fitted.transform(np.zeros((0, 2, 3))).shape == (0, count)
    fitted.set_params(resolution=3)
    assert fitted.transform([[[0, 1, 1]]]).shape == (1, count) and len(fitted.get_feature_names_out()) == count
    with pytest.raises(ValueError, match="a later death and a dimension"):
        base.clone(transformer).fit([[[0, 1, 0.5]]])
