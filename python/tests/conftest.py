import itertools

import numpy as np
import pytest


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
