"""Gradients of values, diagrams and balls, against differences."""

import subprocess
import sys

import numpy as np
import pytest

import walpha

torch = pytest.importorskip("torch")
walpha_torch = pytest.importorskip("walpha.torch")


def tensor(array, **options):
    return torch.tensor(array, dtype=torch.float64, **options)


def summed(numbers):
    """Their sum, each times a factor of its own: one number has one gradient to compare."""
    return numbers @ torch.cos(torch.arange(len(numbers), dtype=torch.float64))


@pytest.fixture(params=["space", "plane", "box", "small box"])
def case(request):
    """Points, weights and the box. In a box that is small rows name copies of points."""
    rng = np.random.default_rng(8)
    box = [[1, 0, 0], [0.25, 1, 0], [0, 0, 1.5]]
    of = {"space": (14, 3, None), "plane": (14, 2, None), "box": (125, 3, box), "small box": (3, 3, box)}
    count, axes, periodic = of[request.param]
    points, weights = rng.random((count, axes)), tensor(0.02 * rng.random(count))
    if request.param == "box":
        # In each of 5 x 5 x 5 parts of it.
        points = (np.indices((5, 5, 5)).reshape(3, -1).T + points) / 5 @ box
    points = tensor(points)
    assert (len(walpha.filtration(points, weights=weights, periodic=periodic).copies) > 0) == (request.param == "small box")
    return points, weights, periodic


def check_gradients(function, points, weights, count=4):
    """By the first points and weights alone, as differences take long."""

    def of_first(own, its):
        return summed(function(torch.cat([own, points[count:]]), torch.cat([its, weights[count:]])))

    given = points[:count].clone().requires_grad_(), weights[:count].clone().requires_grad_()
    assert torch.autograd.gradcheck(of_first, given, atol=1e-4, rtol=1e-4)


def test_values_are_differentiable(case):
    points, weights, periodic = case
    simplices, values = walpha_torch.values(points, weights, periodic=periodic)
    assert np.array_equal(values, simplices.values)
    assert (simplices.gabriel_simplices != np.arange(len(simplices))).any()
    # Flat simplices on the hull have large derivatives.
    moderate = np.flatnonzero(simplices.values < 1)
    check_gradients(lambda *given: walpha_torch.values(*given, periodic=periodic)[1][moderate], points, weights)


def test_diagrams_are_differentiable(case):
    points, weights, periodic = case
    diagrams = walpha_torch.persistence(points, (0, 1, 2), weights=weights, periodic=periodic)
    made = walpha.filtration(points, weights=weights, periodic=periodic).simplices()
    for dimension, diagram in enumerate(diagrams):
        assert np.array_equal(diagram, made.persistence(dimension))

    def finite(points, weights):
        found = torch.cat(walpha_torch.persistence(points, weights=weights, periodic=periodic)).ravel()
        return found[torch.isfinite(found) & (found < 1)]

    check_gradients(finite, points, weights)


@pytest.mark.parametrize("periodic", [None, 1.5])
def test_balls_are_differentiable(periodic):
    rng = np.random.default_rng(4)
    centers = tensor(rng.random((12, 3)), requires_grad=True)
    radii = tensor(0.2 + 0.1 * rng.random(12), requires_grad=True)
    parts = walpha_torch.balls(centers, radii, periodic=periodic)
    balls = walpha.alpha_shape(centers.detach(), 0, weights=radii.detach() ** 2, periodic=periodic).balls
    assert float(parts.volumes.detach().sum()) == pytest.approx(balls.volume.value, rel=1e-12)
    assert float(parts.areas.detach().sum()) == pytest.approx(balls.area.value, rel=1e-12)
    assert torch.autograd.gradcheck(lambda *given: tuple(walpha_torch.balls(*given, periodic=periodic)), (centers, radii))
    # One of them alone, and weighed.
    weighed = tensor(rng.random(12))
    for name in ("volumes", "areas"):
        assert torch.autograd.gradcheck(lambda *given: getattr(walpha_torch.balls(*given, periodic=periodic), name) @ weighed, (centers, radii))


def test_tensors_come_back_as_they_were_given():
    points = torch.rand(30, 3, requires_grad=True)
    [loops] = walpha_torch.persistence(points, [1])
    assert loops.dtype == torch.float32
    loops.sum().backward()
    assert points.grad.dtype == torch.float32 and points.grad.abs().sum() > 0
    # Weights alone.
    weights = torch.zeros(30, dtype=torch.float64, requires_grad=True)
    walpha_torch.persistence(points.detach(), [0], weights=weights)[0][:-1].sum().backward()
    assert weights.grad.abs().sum() > 0


def test_what_is_wrong_is_said():
    with pytest.raises(ValueError, match="dimension=3: there are 0, 1 and 2"):
        walpha_torch.persistence(torch.rand(5, 3), [3])
    with pytest.raises(ValueError, match="radii: -1.0 is negative"):
        walpha_torch.balls(torch.rand(1, 3), torch.tensor([-1.0]))
    points = torch.rand(8, 3, dtype=torch.float64, requires_grad=True)
    [loops] = walpha_torch.persistence(points, [0])
    [first] = torch.autograd.grad(loops[:-1].square().sum(), points, create_graph=True)
    with pytest.raises(RuntimeError, match="once_differentiable"):
        first.sum().backward()


def test_walpha_does_not_load_it():
    program = "import sys, walpha; assert not {'torch', 'sklearn'} & sys.modules.keys()"
    subprocess.run([sys.executable, "-c", program], check=True, timeout=120)
