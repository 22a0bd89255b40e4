"""How well `--alpha auto` does on points of known surfaces and solids.

    python3 -m venv venv && venv/bin/pip install numpy scipy
    venv/bin/python benches/auto_alpha.py target/release/walpha

For each set: α as a radius and the error of the shape by `auto`, by `auto:connected`, and at the best of 24 radii, which
is what any program for alpha shapes would give at its best. The error is the mean of two mean distances, from
the shape's boundary and singular facets to the true surface and back, in percent of the size.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

random = np.random.default_rng(1)


def sphere(n):
    places = random.normal(size=(n, 3))
    return places / np.linalg.norm(places, axis=1)[:, None]


def torus(n):
    u, v, keep = random.uniform(0, 2 * np.pi, 4 * n), random.uniform(0, 2 * np.pi, 4 * n), random.uniform(size=4 * n)
    u, v = u[keep < (1 + 0.4 * np.cos(v)) / 1.4][:n], v[keep < (1 + 0.4 * np.cos(v)) / 1.4][:n]
    return np.stack([(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)], 1)


def box(n, sides):
    """Points on the surface of a box."""
    sides = np.array(sides)
    areas = np.prod(sides) / sides
    axis = random.choice(3, n, p=areas / areas.sum())
    places = random.uniform(size=(n, 3)) * sides
    places[np.arange(n), axis] = sides[axis] * random.integers(0, 2, n)
    return places


def two_densities(n):
    """Half of a sphere with four times as many points as the other half."""
    places = sphere(4 * n)
    return places[(places[:, 0] > 0) | (random.uniform(size=4 * n) < 0.25)][:n]


def ball(n):
    return sphere(n) * random.uniform(size=(n, 1)) ** (1 / 3)


def tile(n, noise):
    """First returns of an airborne scan of 60 m × 60 m: hilly ground, a flat roof, and a tree, seen from above."""
    x, y = random.uniform(0, 60, (2, n))
    z = 1.5 * np.sin(x / 9) + np.cos(y / 7)
    z[(x > 12) & (x < 30) & (y > 15) & (y < 27)] = 8
    in_tree = (x - 44) ** 2 + (y - 40) ** 2 < 36
    z[in_tree] = 5 + np.sqrt(36 - (x - 44) ** 2 - (y - 40) ** 2, where=in_tree, out=np.zeros(n))[in_tree]
    return np.stack([x, y, z + noise * random.normal(size=n)], 1)


def strays(places, count, far):
    return np.concatenate([places, far * sphere(count)])


# Points, and as many of the true surface.
SETS = {
    "sphere, 12 000 points": (sphere(12_000), sphere(200_000)),
    "the same with 20 strays": (strays(sphere(12_000), 20, 3), sphere(200_000)),
    "the same with one far away": (strays(sphere(12_000), 1, 50), sphere(200_000)),
    "torus, 12 000 points": (torus(12_000), torus(200_000)),
    "thin plate 1×1×0.05, 20 000 points": (box(20_000, (1, 1, 0.05)), box(200_000, (1, 1, 0.05))),
    "sphere of two densities, 12 000 points": (two_densities(12_000), sphere(200_000)),
    "solid ball, 20 000 points": (ball(20_000), sphere(200_000)),
    "LiDAR tile of 60 m, 14 400 points": (tile(14_400, 0.03), tile(400_000, 0)),
    "the same with 20 birds": (np.concatenate([tile(14_400, 0.03), random.uniform((0, 0, 20), (60, 60, 60), (20, 3))]), tile(400_000, 0)),
}


def shape(walpha, folder, alpha):
    """The shape's boundary and singular facets as points, and its report."""
    command = [walpha, "shape", "points.csv", *alpha, "-o", "shape.npz", "--json", "-q"]
    report = json.loads(subprocess.run(command, cwd=folder, check=True, capture_output=True).stdout)
    made = np.load(folder / "shape.npz")
    facets = made["facets"][made["facet_classes"] >= 2]
    if len(facets) == 0:
        return report, np.zeros((1, 3))
    a, b, c = (made["points"][facets[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    row = random.choice(len(facets), 100_000, p=areas / areas.sum())
    u, v = random.uniform(size=(2, 100_000, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return report, a[row] + u * (b - a)[row] + v * (c - a)[row]


def main(walpha):
    print("| points | auto: √α, error, apart | auto:connected: √α, error | best of 24: √α, error |")
    print("|---|--:|--:|--:|")
    for name, (points, truth) in SETS.items():
        size = np.ptp(truth, axis=0).max()
        to_truth = cKDTree(truth)
        # The distance that a sample of the truth has from itself is no error.
        noise = to_truth.query(truth[:2000], k=2)[0][:, 1].mean() / 2
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            np.savetxt(folder / "points.csv", points, delimiter=",", header="x,y,z", comments="")

            def judged(*alpha):
                report, made = shape(walpha, folder, alpha)
                there, back = to_truth.query(made)[0].mean(), cKDTree(made).query(truth[:20_000])[0].mean()
                error = max((there + back) / 2 - noise, 0) / size
                return report["alpha"]["radius"] / size, error, report["shape"]["apart"]

            auto, connected = judged("--alpha", "auto"), judged("--alpha", "auto:connected")
            radii = auto[0] * size * np.geomspace(0.3, 3, 24)
            best = min((judged("--alpha-radius", repr(float(radius))) for radius in radii), key=lambda made: made[1])
            cells = [f"{100 * of[0]:.1f} %, {100 * of[1]:.2f} %" for of in (auto, connected, best)]
            print(f"| {name} | {cells[0]}, {auto[2]} | {cells[1]} | {cells[2]} |", flush=True)


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()))
