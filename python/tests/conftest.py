import itertools

import numpy as np
import pytest

import walpha


def pytest_collection_modifyitems(items):
    """A walpha built without CGAL, as for Windows, has one engine."""
    try:
        walpha.alpha_shape(np.eye(4, 3), 1.0, engine="cgal")
    except ValueError as error:
        for item in items:
            if hasattr(item, "callspec") and item.callspec.params.get("engine") == "cgal":
                item.add_marker(pytest.mark.skip(reason=str(error)))


@pytest.fixture(scope="session")
def cloud():
    return np.random.default_rng(20240501).random((600, 3))


@pytest.fixture(scope="session")
def weights():
    return np.random.default_rng(7).random(600) * 0.01


@pytest.fixture(scope="session")
def hollow():
    """A 7³ lattice without its inner 3³: a void of volume 4³ less what α = 0.75 leaves of it."""
    lattice = np.array(list(itertools.product(range(7), repeat=3)), float)
    return lattice[~((lattice >= 2) & (lattice <= 4)).all(axis=1)]
