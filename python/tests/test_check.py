import itertools

import numpy as np
import pytest

import walpha
from walpha import Class


def test_our_shapes_are_valid(cloud, weights):
    for exterior in (False, True):
        verdict = walpha.check(walpha.alpha_shape(cloud, 0.004, weights=weights, exterior=exterior))
        assert verdict and verdict.total == 0 and verdict.findings == []
        assert verdict.verdict == "exact" and verdict.ties == 0
        assert exterior == (not any("hidden" in rule for rule in verdict.not_judged))


def test_a_wrong_class_is_found(cloud):
    shape = walpha.alpha_shape(cloud, alpha=0.004, exterior=True)
    classes = shape.facet_classes.copy()
    row = int(np.flatnonzero(classes == Class.REGULAR)[0])
    classes[row] = Class.SINGULAR
    given = dict(
        cells=shape.cells, cell_classes=shape.cell_classes, facets=shape.facets, facet_classes=classes,
        edges=shape.edges, edge_classes=shape.edge_classes,
        vertices=shape.vertices, vertex_classes=shape.vertex_classes, hidden=shape.hidden, duplicates=shape.duplicates,
    )
    verdict = walpha.check(cloud, 0.004, **given)
    assert not verdict and verdict.total == 1 and verdict.verdict == "wrong"
    (finding,) = verdict.findings
    assert finding.rule == "class" and sorted(finding.facts["simplex"]) == sorted(shape.facets[row].tolist())
    assert "singular" in str(finding) and finding.facts["expected"] == "regular"
    comparison = walpha.compare(walpha.Complex(cloud, alpha=0.004, **given), shape)
    assert not comparison and len(comparison.facts["dimensions"][2]["classes"]) == 1
    assert walpha.check(cloud, 0.004, **{**given, "facet_classes": shape.facet_classes})


def test_findings_are_counted_and_the_first_are_listed(cloud):
    wrong = np.random.default_rng(0).permutation(600)[:400].reshape(-1, 4)
    verdict = walpha.check(cloud, np.inf, cells=wrong, most=3)
    assert verdict.total > 3 and len(verdict.findings) == 3


def test_points_may_be_numbered_differently(cloud):
    order = np.random.default_rng(0).permutation(600)
    a, b = walpha.alpha_shape(cloud, alpha=0.004), walpha.alpha_shape(cloud[order], alpha=0.004)
    assert walpha.compare(a, b).equal
    other = walpha.compare(a, walpha.alpha_shape(cloud, alpha=0.0041))
    assert not other.equal and "only in B" in other.text


@pytest.mark.parametrize(
    "given, message",
    [
        ({"cells": [[0, 1, 2, 700]]}, "point 700"),
        ({"cells": [[0, 1, 2, -1]]}, "-1"),
        ({"cells": [[0, 1, 2]]}, "expected"),
        ({"cells": [[0.0, 1, 2, 3]]}, "integers"),
        ({}, "no simplices"),
        ({"edges": [[0, 1]], "edge_classes": [7]}, "from 0 to 3"),
        ({"edges": [[0, 1]], "edge_classes": [1, 1]}, "classes.edges"),
    ],
)
def test_what_is_no_complex(cloud, given, message):
    with pytest.raises(ValueError, match=message):
        walpha.check(cloud, 1, **given)


def test_alpha_is_needed(cloud):
    with pytest.raises(ValueError, match="alpha"):
        walpha.check(cloud, cells=[[0, 1, 2, 3]])
    with pytest.raises(ValueError, match="alone"):
        walpha.check(walpha.alpha_shape(cloud, alpha=1), 1)
    with pytest.raises(ValueError, match="not a complex"):
        walpha.compare(cloud, cloud)


def test_another_choice_at_ties_is_valid():
    grid = np.stack(np.meshgrid(*[np.arange(3.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    # Each cube around its diagonal (Kuhn): a Delaunay triangulation, and not CGAL's.
    steps = [np.array(order) for order in itertools.permutations(np.array([9, 3, 1]))]
    corners = [9 * i + 3 * j + k for i in range(2) for j in range(2) for k in range(2)]
    cells = [[c, *(c + np.cumsum(step))] for c in corners for step in steps]
    verdict = walpha.check(grid, np.inf, cells=cells)
    assert verdict and verdict.verdict == "valid" and verdict.ties > 0 and verdict.findings == []
    strict = walpha.check(grid, np.inf, cells=cells, ties="exact")
    assert not strict and strict.verdict == "valid" and strict.total == verdict.ties
    assert {finding.rule for finding in strict.findings} == {"not_regular"}
    assert walpha.check(grid, np.inf, cells=cells[1:]).verdict == "wrong"
    with pytest.raises(ValueError, match="'any' or 'exact'"):
        walpha.check(grid, np.inf, cells=cells, ties="none")
    comparison = walpha.compare(walpha.Complex(grid, alpha=np.inf, cells=cells), walpha.alpha_shape(grid, alpha=np.inf))
    assert comparison.facts["domain"]["same_region"]["verdicts"] == ["valid", "exact"]
