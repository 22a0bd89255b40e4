"""Numbers that are none, or that no double holds: an error that names the row or the argument, whatever is called.

Each public function and method is in the table with all its parameters, so that a new one is not forgotten.
"""

import inspect
import math

import numpy as np
import pytest

import walpha
from walpha import tda

NAN, INF = math.nan, math.inf
#: Beyond what makes sense of every number.
WRONG = [NAN, INF, -INF, 1e308]
CLOUD = np.random.default_rng(3).random((40, 3))
CORNERS = np.eye(4, 3)
#: What holds no real numbers: options, files, counts, objects.
OTHER = {
    "self", "cls", "progress", "threads", "engine", "exterior", "hidden", "balls", "path", "level", "columns", "classes", "format",
    "array", "frame", "series", "skip_damaged", "shape", "dtype", "offset", "decomposition", "weighting", "select", "exchange",
    "refit", "roi", "keep", "largest", "solid", "allow_empty", "labels", "masked", "resample", "withheld", "what", "ranks", "dimension", "homology_dimensions", "radius", "reduced_homology",
    "radii", "hydrogens", "waters", "hetero", "chains", "model", "like",
    "n_jobs", "weighted", "resolution", "n_layers", "input_features", "transform",
    "view", "colour", "size", "height", "low", "high", "value",
    "y", "duplicates", "cells", "facets", "edges", "vertices", "cell_classes", "facet_classes", "edge_classes",
    "vertex_classes", "closed", "most", "ties", "a", "b", "space", "unit", "gray", "copy", "components", "coefficients", "count", "downsample",
}  # fmt: skip


def rows(of=CLOUD, row=7):
    """Points, or a column, with a wrong number in a row."""

    def make(number):
        wrong = np.array(of, float)
        wrong[row if wrong.ndim == 1 else (row, 1)] = number
        return wrong

    return make


def column(row=7):
    return rows(np.linspace(0, 1, len(CLOUD)), row)


def corners(row=2):
    return rows(CORNERS, row)


def triple(number):
    return (1.0, number, 1.0)


def itself(number):
    return number


def shape():
    return walpha.alpha_shape(CLOUD, 1.0, values=np.ones(len(CLOUD)))


VOLUME = np.random.default_rng(5).random((6, 6, 6)) * 255


def samples(number):
    wrong = VOLUME.copy()
    wrong[1, 2, 3] = number
    return wrong


DIAGRAM = [[[0.0, 1.0, 1.0], [0.5, 0.75, 1.0]]]


def interval(number):
    """A diagram whose row 7 has a wrong death."""
    return [DIAGRAM[0] * 3 + [[0.0, 1.0, 1.0], [0.0, number, 1.0]]]


def complex_of(**given):
    return walpha.Complex(**{"points": CORNERS, "alpha": 1.0, "cells": [[0, 1, 2, 3]], **given})


def check_of(**given):
    return walpha.check(**{"points": CORNERS, "alpha": 1.0, "cells": [[0, 1, 2, 3]], **given})


def from_simplices(**given):
    return walpha.Complex.from_simplices(**{"points": CORNERS, "simplices": [[0, 1, 2, 3]], "alpha": 1.0, **given})


def values_of(number):
    return [([0], 0.0), ([1], number), ([0, 1], 1.0)]


#: By the name of what is called: how, and what makes each of its numbers wrong, and which of the wrong ones are right all the same.
HUGE = {1e308}
INFINITE = {INF, -INF, 1e308}
CALLS = {
    "alpha_shape": (
        lambda **given: walpha.alpha_shape(**{"points": CLOUD, **given}),
        {
            "points": (rows(), ()),
            "weights": (column(), ()),
            # Any double is a value.
            "values": (column(), HUGE),
            # Whole and empty shapes.
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
            "periodic": (triple, ()),
        },
    ),
    "filtration": (
        lambda **given: walpha.filtration(**{"points": CLOUD, **given}),
        {"points": (rows(), ()), "weights": (column(), ()), "periodic": (triple, ())},
    ),
    "periodic_power_diagram": (
        lambda **given: walpha.periodic_power_diagram(**{"points": CLOUD, "periodic": (2, 2, 0), "walls": [[-9] * 3, [9] * 3], **given}),
        {"points": (rows(), ()), "weights": (column(), ()), "periodic": (triple, ()), "walls": (lambda number: [[0, 0, -9], [0, 0, number]], ())},
    ),
    "pores": (
        lambda **given: walpha.pores(**{"points": CLOUD, "periodic": 2, **given}),
        {"points": (rows(), ()), "radii": (column(), ()), "periodic": (triple, ()), "probe": (itself, ())},
    ),
    "filtrations": (
        lambda **given: walpha.filtrations(**{"clouds": [CLOUD, CLOUD], **given}),
        {"clouds": (lambda number: [CLOUD, rows()(number)], ()), "weights": (lambda number: [column()(0), column()(number)], ()), "periodic": (triple, ())},
    ),
    "alpha_shapes": (
        lambda **given: walpha.alpha_shapes(**{"clouds": [CLOUD, CLOUD], **given}),
        {
            "clouds": (lambda number: [CLOUD, rows()(number)], ()),
            "weights": (lambda number: [column()(0), column()(number)], ()),
            "values": (lambda number: [column()(0), column()(number)], HUGE),
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
            "periodic": (triple, ()),
        },
    ),
    "Filtration": (
        lambda **given: walpha.Filtration(**{"points": CLOUD, **given}),
        {"points": (rows(), ()), "weights": (column(), ()), "periodic": (triple, ())},
    ),
    "Filtration.shape": (walpha.filtration(CLOUD).shape, {"alpha": (itself, INFINITE), "alpha_radius": (itself, {INF})}),
    "Filtration.levels": (
        walpha.filtration(CLOUD).levels,
        {"alphas": (lambda number: [0.5, 0.75, number], INFINITE)},
    ),
    "Filtration.voids": (walpha.filtration(CLOUD).voids, {"alpha": (itself, INFINITE)}),
    "Filtration.cycle": (walpha.filtration(CLOUD).cycle, {"pair": (lambda number: [0, number], ())}),
    "Filtration.cycles": (lambda minimum: walpha.filtration(CLOUD).cycles(1, minimum=minimum), {"minimum": (itself, {INF, 1e308})}),
    "Filtration.derivatives": (walpha.filtration(CLOUD).derivatives, {"simplices": (lambda number: [[0.0, number]], ())}),
    "AlphaShape.at": (
        lambda **given: shape().at(**{"places": CLOUD, **given}),
        # Places that are none are outside.
        {"places": (rows(), set(WRONG)), "values": (column(), HUGE)},
    ),
    "AlphaShape.interpolate": (
        lambda **given: shape().interpolate(**{"shape": (2, 2, 2), **given}),
        {
            "low": (triple, ()),
            "high": (triple, HUGE),
            "values": (column(), HUGE),
        },
    ),
    # Places that are none are outside.
    "AlphaShape.contains": (lambda **given: shape().contains(**given), {"places": (rows(), set(WRONG))}),
    "AlphaShape.keep": (lambda **given: shape().keep(1, **given), {"min_volume": (itself, {INF, 1e308})}),
    "AlphaShape.boundary": (lambda **given: shape().boundary(**given), {"min_volume": (itself, {INF, 1e308})}),
    "Balls.gradients": (lambda **given: shape().balls.gradients(**given), {"weights": (column(), HUGE)}),
    "Balls.surface": (lambda **given: shape().balls.surface(**given), {"tolerance": (itself, ())}),
    "triangulation": (
        lambda **given: walpha.triangulation(**{"points": CLOUD, **given}),
        {"points": (rows(), ()), "weights": (column(), ())},
    ),
    "Triangulation.find_simplex": (
        walpha.triangulation(CLOUD).find_simplex,
        {"xi": (rows(), set(WRONG))},
    ),
    "Complex": (
        complex_of,
        {
            # The checker is exact for all doubles.
            "points": (corners(), HUGE),
            "weights": (rows(np.zeros(4), 2), HUGE),
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
            "periodic": (triple, HUGE),
        },
    ),
    "Complex.from_simplices": (
        from_simplices,
        {
            # The checker is exact for all doubles.
            "points": (corners(), HUGE),
            "weights": (rows(np.zeros(4), 2), HUGE),
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
            "simplices": (values_of, INFINITE),
        },
    ),
    "check": (
        check_of,
        {
            # The checker is exact for all doubles.
            "points": (corners(), HUGE),
            "weights": (rows(np.zeros(4), 2), HUGE),
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
            "periodic": (triple, ()),
        },
    ),
    "write_points": (
        lambda **given: walpha.write_points(**{"path": "points.wvm", "points": CORNERS, **given}),
        {
            "points": (corners(), HUGE),
            "weights": (rows(np.zeros(4), 2), HUGE),
            "values": (rows(np.zeros(4), 2), HUGE),
            "alpha": (itself, INFINITE),
            "value_error": (itself, {INF, 1e308}),
        },
    ),
    "read_points": (
        lambda **given: walpha.read_points("corners.csv", **given),
        {"thin": (itself, HUGE)},
    ),
    "read": (lambda **given: walpha.read("sample:phantom@16", **given), {"nan": (itself, set(WRONG))}),
    "Volume": (
        lambda **given: walpha.Volume(**{"samples": VOLUME, **given}),
        {
            # Judged where they are used: `nan=` says what becomes of them.
            "samples": (samples, set(WRONG)),
            "spacing": (triple, HUGE),
            "origin": (triple, HUGE),
            "direction": (lambda number: (triple(number), (0, 1, 0), (0, 0, 1)), HUGE),
        },
    ),
    "label_shape": (
        lambda **given: walpha.label_shape(**{"volume": np.ones((3, 4, 5), np.uint8), "spacing": (1, 1, 1), **given}),
        # Samples that are not whole numbers are refused as such, whichever they are.
        {"volume": (samples, set(WRONG)), "spacing": (triple, HUGE), "origin": (triple, HUGE)},
    ),
    "surface_shape": (
        lambda **given: walpha.surface_shape(**{"volume": VOLUME, "value": 9, "spacing": (1, 1, 1), **given}),
        {
            "volume": (samples, ()),
            "value": (itself, ()),
            "spacing": (triple, HUGE),
            "origin": (triple, HUGE),
            "nan": (itself, set(WRONG)),
        },
    ),
    "haar": (
        lambda **given: walpha.haar(**{"volume": VOLUME, **given}),
        {"volume": (samples, ()), "rms": (itself, {INF, 1e308}), "epsilon": (itself, {INF, 1e308})},
    ),
    "difference": (walpha.difference, {"volume": (samples, ())}),
    "select": (
        lambda **given: walpha.select(**{"volume": VOLUME, **given}),
        {
            "volume": (samples, ()),
            "smoothed": (samples, ()),
            "ratio": (itself, ()),
            # All, and none, which is an error of its own.
            "threshold": (itself, {-INF, INF, 1e308}),
            "gray_min": (itself, {-INF}),
            "spacing": (triple, HUGE),
            "origin": (triple, HUGE),
        },
    ),
    "weigh": (
        lambda **given: walpha.weigh(**{"differences": np.arange(40.0), "weighting": "barycentric-n", "alpha": 1.0, **given}),
        {"differences": (column(), HUGE), "alpha": (itself, HUGE)},
    ),
    "pipeline": (
        lambda **given: walpha.pipeline(**{"volume": VOLUME, **given}),
        {
            "volume": (samples, ()),
            "spacing": (triple, ()),
            "origin": (triple, ()),
            "nan": (itself, set(WRONG)),
            "gray": (lambda number: (0.0, number), HUGE),
            # All coefficients may be dropped.
            "rms": (itself, {INF, 1e308}),
            "epsilon": (itself, {INF, 1e308}),
            "ratio": (itself, ()),
            "threshold": (itself, {-INF, INF, 1e308}),
            "gray_min": (itself, {-INF}),
            "value_min": (itself, {-INF}),
            "target_rmse": (lambda number: number, {INF, 1e308}),
            "max_error": (lambda number: number, {INF, 1e308}),
            "alpha": (itself, INFINITE),
            "alpha_radius": (itself, {INF}),
        },
    ),
    "tda.AlphaPersistence": (lambda periodic: tda.AlphaPersistence(periodic=periodic).transform([CLOUD]), {"periodic": (triple, ())}),
    "tda.AlphaPersistence.transform": (tda.AlphaPersistence().transform, {"X": (lambda number: [rows()(number)], ())}),
    # Not looked at.
    "tda.AlphaPersistence.fit": (tda.AlphaPersistence().fit, {"X": (lambda number: [rows()(number)], set(WRONG))}),
    "tda.PersistenceImage": (
        lambda **given: tda.PersistenceImage(**given).fit(DIAGRAM),
        {"bandwidth": (itself, HUGE), "power": (itself, HUGE)},
    ),
    **{
        f"tda.{name}.{method}": (getattr(getattr(tda, name)().fit(DIAGRAM), method), {"X": (interval, {INF, 1e308})})
        for name in ("PersistenceImage", "PersistenceLandscape", "BettiCurve")
        for method in ("fit", "transform")
    },
}  # fmt: skip
#: What nobody calls: the results of others.
RESULTS = {
    "BallSurface", "Chart", "Page", "Picture", "Betti", "BettiCurve", "Boundary", "Bounded", "BoundedArray", "Cavity", "Class", "Comparison", "Component", "Contacts", "Cuts", "Finding", "Gradients", "Level", "LoopCycle", "Molecule", "Outline", "PointFile", "Polygon",
    "FreeSphere", "PeriodicPowerDiagram", "Pores", "PowerDiagram", "Selected", "Simplices", "Suggestions", "TorusBetti", "TorusBettiCurve", "Verdict", "Void", "VoidCycle",
}  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "corners.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n")


def public():
    """Functions and methods by name, with their parameters."""
    places = [("", walpha, name) for name in walpha.__all__] + [("tda.", tda, name) for name in tda.__all__]
    for prefix, module, name in places:
        thing = getattr(module, name)
        if not inspect.isclass(thing):
            yield prefix + name, thing
            continue
        if name in RESULTS:
            continue
        yield prefix + name, thing
        for method, of in inspect.getmembers(thing, callable):
            # What scikit-learn gives to its transformers is not ours.
            if not method.startswith("_") and of.__module__.startswith("walpha"):
                yield f"{prefix}{name}.{method}", of


@pytest.mark.parametrize("name, called", list(public()))
def test_each_public_parameter_is_in_the_table(name, called):
    try:
        parameters = set(inspect.signature(called).parameters)
    except TypeError:
        parameters = set()
    listed = set(CALLS.get(name, (None, {}))[1])
    assert parameters - OTHER == listed - OTHER, f"{name}: list what its numbers may be in CALLS"


CASES = [
    (name, parameter, number)
    for name, (_, parameters) in CALLS.items()
    for parameter in parameters
    for number in WRONG
]


@pytest.mark.parametrize("name, parameter, number", CASES)
def test_numbers_that_are_none_are_refused_by_name(name, parameter, number):
    call, parameters = CALLS[name]
    make, allowed = parameters[parameter]
    given = {parameter: make(number)}
    if parameter == "alpha_radius":
        given["alpha"] = None
    if parameter in ("target_rmse", "max_error"):
        given.update(select="adaptive", count=20)
    is_allowed = any(number == of or (math.isnan(number) and math.isnan(of)) for of in allowed)
    try:
        call(**given)
    except (ValueError, TypeError, OverflowError) as error:
        if is_allowed:
            return
        text = str(error)
        row = 2 if "corners" in getattr(make, "__qualname__", "") else 7
        # Places of samples are made of spacing and origin.
        words = [parameter, parameter.rstrip("s"), f"point {row} ", "point 0 has y 1", f"row {row}", "along x", f"{number:g}", "NaN" if math.isnan(number) else "inf"]
        assert any(word in text for word in words), text
    else:
        assert is_allowed, f"{name} took {parameter} with {number}"


LARGE = 2**53 + 1


@pytest.mark.parametrize("dtype", [np.int64, np.uint64])
@pytest.mark.parametrize(
    "parameter, call",
    [
        ("points", lambda given: walpha.alpha_shape(given.reshape(-1, 1) * np.ones((1, 3), given.dtype))),
        ("points", lambda given: walpha.alpha_shape(given.reshape(-1, 1) * np.ones((1, 2), given.dtype))),
        ("points", lambda given: walpha.triangulation(given.reshape(-1, 1) * np.ones((1, 3), given.dtype))),
        ("weights", lambda given: walpha.alpha_shape(CLOUD, 1.0, weights=given)),
        ("values", lambda given: walpha.alpha_shape(CLOUD, 1.0, values=given)),
        ("weights", lambda given: walpha.filtration(CLOUD, weights=given)),
        ("alphas", lambda given: walpha.filtration(CLOUD).levels(given)),
        ("differences", lambda given: walpha.weigh(given, alpha=1.0)),
        ("values", lambda given: shape().at(CLOUD, values=given)),
        ("values", lambda given: walpha.write_points("points.csv", CLOUD, values=given)),
    ],
)
def test_integers_that_no_double_holds_are_refused_by_their_row(parameter, call, dtype):
    given = np.arange(len(CLOUD)).astype(dtype)
    given[7] = LARGE
    with pytest.raises(ValueError, match=rf"^{parameter}: row 7 holds {LARGE}, which float64 does not hold, only {LARGE - 1}"):
        call(given)


def test_integers_that_doubles_hold_are_taken():
    for large in [2**53, 2**60, -(2**63), 2**53 + 2]:
        weights = np.zeros(len(CLOUD), np.int64)
        weights[3] = large
        assert walpha.triangulation(CLOUD, weights).weights[3] == large
    weights = np.full(len(CLOUD), 2**63, np.uint64)
    assert (walpha.triangulation(CLOUD, weights).weights == 2.0**63).all()
    weights[3] = 2**64 - 1
    with pytest.raises(ValueError, match="weights: row 3 holds 18446744073709551615"):
        walpha.triangulation(CLOUD, weights)


def test_integers_of_frames_are_refused_by_their_column():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"x": [0, 1, LARGE, 0], "y": [0.5, 0, 0, 1], "z": [0.0, 1, 0, 0]})
    with pytest.raises(ValueError, match=rf"points\['x'\]: row 2 holds {LARGE}"):
        walpha.alpha_shape(frame)


def test_points_that_span_no_simplex_have_no_derivative():
    filtration = walpha.filtration([[0, 0, 0], [1, 1, 1], [2, 2, 2], [1, 0, 0], [0, 1, 5]])
    with pytest.raises(ValueError, match=r"row 1, \[0, 1, 2\], spans no simplex"):
        filtration.derivatives([[0, 1, 3], [0, 1, 2]])


def test_radii_whose_squares_no_double_holds():
    for radius in [1e200, 1e-200]:
        with pytest.raises(ValueError, match="alpha_radius=.*a double does not hold its square"):
            walpha.alpha_shape(CLOUD, alpha_radius=radius)
    assert walpha.alpha_shape(CLOUD, alpha_radius=INF).alpha == INF


def test_power_cells_without_volume_and_beyond_the_doubles():
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 2, 0], [1, 0, 2]], float)
    diagram = walpha.triangulation(points, [0, -1, 0, 0, 0]).power_diagram()
    assert diagram.volumes.tolist() == [INF, 0, INF, INF, INF]
    assert [0, 2] in diagram.facets.tolist() and 1 not in diagram.facets
    cloud = walpha.triangulation(CLOUD).power_diagram()
    huge = walpha.triangulation(CLOUD * 1e120).power_diagram()
    assert np.array_equal(np.isinf(cloud.volumes), np.isinf(huge.volumes))
    assert np.isnan(huge.volumes[np.isfinite(cloud.volumes)]).all() and np.isfinite(cloud.volumes).any()
