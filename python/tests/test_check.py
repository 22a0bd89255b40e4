import numpy as np
import pytest

import walpha
from walpha import Class


def test_our_shapes_are_valid(cloud, weights):
    for exterior in (False, True):
        verdict = walpha.check(walpha.alpha_shape(cloud, weights, 0.004, exterior=exterior))
        assert verdict and verdict.total == 0 and verdict.findings == []
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
    assert not verdict and verdict.total == 1
    (finding,) = verdict.findings
    assert finding.rule == "class" and sorted(finding.facts["simplex"]) == sorted(shape.facets[row].tolist())
    assert "singular" in str(finding) and finding.facts["expected"] == "regular"
    comparison = walpha.compare(walpha.Complex(cloud, 0.004, **given), shape)
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
