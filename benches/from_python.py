"""Race walpha against GUDHI, diode and SciPy's Delaunay; prints a table in Markdown.

    pip install gudhi scipy diode    # those that are there take part
    python race.py [--runs 5] [--once SECONDS] [--sizes 30000,128000] [--cpu] [--only native,filtration,fast]

All in one run, medians; each gets points in memory, and hands back arrays or a tree. What takes longer than --once is
not run again. With --cpu it counts the time of all processors, which other work on the machine changes less.
"""

import argparse
import datetime
import importlib.metadata
import os
import platform
import statistics
import time

import numpy as np

import walpha


def lattice(n):
    """The points of a volume: samples of a phantom head of the largest differences, full of ties."""
    size = 64 if n <= 60_000 else 128 if n <= 500_000 else 256
    head = walpha.read(f"sample:phantom@{size}").samples
    chosen = walpha.select(walpha.haar(head)[0], count=n)
    return chosen.points, walpha.weigh(chosen.differences, "min-max", alpha=10)


def scattered(n):
    """Points in a cube, at random, with weights of about the squared distance between them."""
    rng = np.random.default_rng(1)
    points = rng.random((n, 3)) * n ** (1 / 3)
    return points, rng.random(n)


def contestants(points, weights, alpha):
    """Each with what it does."""
    for engine in ("native", "cgal"):
        yield f"`alpha_shape`, `engine=\"{engine}\"`", lambda engine=engine: walpha.alpha_shape(
            points, alpha, weights=weights, engine=engine
        ).cells
    yield "`filtration`", lambda: walpha.filtration(points, weights=weights)
    yield "`filtration`, `.simplices()`", lambda: walpha.filtration(points, weights=weights).simplices()
    try:
        import gudhi
    except ImportError:
        pass
    else:
        for precision in ("fast", "safe", "exact"):
            yield f"GUDHI, filtration, `{precision}`", lambda precision=precision: gudhi.AlphaComplex(
                points=points, weights=weights, precision=precision
            ).create_simplex_tree()
    try:
        import diode
    except ImportError:
        pass
    else:
        weighted = np.column_stack([points, weights])
        yield "diode, filtration", lambda: diode.fill_weighted_alpha_shapes(weighted)
        yield "diode, filtration, `exact`", lambda: diode.fill_weighted_alpha_shapes(weighted, exact=True)
    try:
        import scipy.spatial
    except ImportError:
        pass
    else:
        yield "SciPy, Delaunay, without weights", lambda: scipy.spatial.Delaunay(points)


def median(work, runs, once, clock):
    times = []
    for _ in range(runs):
        started = clock()
        result = work()
        times.append(clock() - started)
        del result
        if times[0] > once:
            break
    return statistics.median(times)


def machine():
    with open("/proc/cpuinfo") as lines:
        cpu = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    packages = []
    for name in ("walpha", "gudhi", "diode", "scipy", "numpy"):
        try:
            packages.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            packages.append(f"no {name}")
    return f"{datetime.date.today()}, {cpu}, {os.cpu_count()} cores, Python {platform.python_version()}, {', '.join(packages)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--once", type=float, default=float("inf"))
    parser.add_argument("--sizes", default="30000,128000")
    parser.add_argument("--cpu", action="store_true")
    parser.add_argument("--only", default="", help="words, of which a name has one")
    arguments = parser.parse_args()
    clock = time.process_time if arguments.cpu else time.perf_counter
    columns, table = [], {}
    for n in map(int, arguments.sizes.split(",")):
        for kind, make in (("volume", lattice), ("at random", scattered)):
            columns.append(f"{n:,} points, {kind}".replace(",", " "))
            points, weights = make(n)
            alpha = 10.0 if make is lattice else 1.0
            for name, work in contestants(points, weights, alpha):
                if not any(word in name for word in arguments.only.split(",")):
                    continue
                try:
                    seconds = f"{median(work, arguments.runs, arguments.once, clock):.2f}"
                except Exception as error:
                    seconds = type(error).__name__
                table.setdefault(name, {})[columns[-1]] = seconds
                print(f"{columns[-1]}: {name} {seconds}", flush=True)
    print(f"\nSeconds{' of processors' if arguments.cpu else ''}, medians of {arguments.runs} (of one above {arguments.once} s); {machine()}\n")
    print("| | " + " | ".join(columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    for name, times in table.items():
        print(f"| {name} | " + " | ".join(times.get(column, "") for column in columns) + " |")


if __name__ == "__main__":
    main()
