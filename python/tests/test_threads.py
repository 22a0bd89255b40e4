"""The threads of calls stay for later calls; each test has a process of its own."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc and fork")

BEGIN = """
import os, pathlib, sys, threading, time
import numpy as np, walpha
points = np.random.default_rng(0).random((20_000, 3))

def threads():
    "The threads of calls, and what each has for a name."
    found = {}
    for task in pathlib.Path("/proc/self/task").iterdir():
        try:
            name = (task / "comm").read_text().strip()
        except OSError:
            # It has ended.
            continue
        if name.startswith("walpha"):
            found[task.name] = name
    return found

def names():
    return sorted(threads().values())

def shape(points=points, **options):
    return len(walpha.alpha_shape(points, alpha=1e-3, **options).cells)
"""


def run(program, *arguments):
    ran = subprocess.run([sys.executable, "-c", BEGIN + program, *arguments], capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


@pytest.mark.parametrize("count", [1, 2, 3])
def test_as_many_threads_as_asked_for(count):
    run("count = int(sys.argv[1]); shape(threads=count); assert names() == [f'walpha {k}' for k in range(count)]", str(count))


def test_threads_stay():
    """Also those of calls that fail or are interrupted, once their work has ended."""
    run("""
def wrong(stage, done, total):
    raise LookupError

shape(threads=2)
begun = threads()
assert len(begun) == 2
for engine in ["native", "cgal"] * 5:
    shape(threads=2, engine=engine)
    walpha.filtration(points, threads=2).betti_curve(threads=2)
    try:
        walpha.alpha_shape(np.full((5, 3), 1e300), alpha=1, threads=2)
    except ValueError:
        pass
assert threads() == begun
try:
    walpha.filtration(np.tile(points, (5, 1)) + np.arange(100_000)[:, None], threads=2, progress=wrong)
except LookupError:
    pass
time.sleep(2)
shape(threads=2)
assert threads() == begun
""")


def test_calls_at_the_same_time():
    """Each has threads of its own, of which those of a few calls stay."""
    run("""
from concurrent.futures import ThreadPoolExecutor
seen = set()

def work(k):
    return shape(threads=2, progress=lambda *step: seen.add(len(threads())))

expected = shape(threads=2)
with ThreadPoolExecutor(6) as pool:
    assert list(pool.map(work, range(24))) == [expected] * 24
assert max(seen) > 2
# Threads beyond that end on their own.
for _ in range(100):
    if len(threads()) <= 8:
        break
    time.sleep(0.05)
assert 2 <= len(threads()) <= 8
""")


def test_numbers_of_threads_in_turn():
    run("""
for count in [1, 2, 3, 4]:
    shape(threads=count)
begun = threads()
assert len(begun) == 10
for count in [4, 1, 3, 2]:
    shape(threads=count)
assert threads() == begun
""")


def test_a_forked_process_starts_its_own():
    run("""
expected = shape(threads=2)
small = shape(points[:50])
child = os.fork()
if child == 0:
    # They do not exist here.
    assert not threads()
    assert (shape(threads=2), shape(points[:50])) == (expected, small)
    assert len(threads()) == 3
    grandchild = os.fork()
    if grandchild == 0:
        assert shape(threads=2) == expected
        os._exit(0)
    assert os.waitstatus_to_exitcode(os.waitpid(grandchild, 0)[1]) == 0
    # The usual end, with all that is done then.
    sys.exit()
before = threads()
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
assert shape(threads=2) == expected and threads() == before
""")


def test_a_process_forked_during_calls():
    # No properties meanwhile: Python 3.11 locks while it caches one, which a child process then waits for.
    run("""
big = np.random.default_rng(1).random((200_000, 3))
busy = [threading.Thread(target=walpha.alpha_shape, args=(big,), kwargs={"alpha": 1e-3, "threads": 2}) for _ in range(3)]
expected = shape(threads=2)
for thread in busy:
    thread.start()
for _ in range(20):
    child = os.fork()
    if child == 0:
        os._exit(0 if shape(threads=2) == expected else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
for thread in busy:
    thread.join()
assert shape(threads=2) == expected
""")


def test_multiprocessing_by_fork():
    run("""
import multiprocessing
expected = shape(points[:3000])
with multiprocessing.get_context("fork").Pool(2) as pool:
    assert pool.map(shape, [points[:3000]] * 8) == [expected] * 8
""")
