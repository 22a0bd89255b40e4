import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import walpha

LONG = """
import numpy as np, signal, sys, walpha
# Shells ignore it for what they start in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)
points = np.random.default_rng(0).random((1_500_000, 3))
print("begun", flush=True)
try:
    walpha.alpha_shape(points, alpha=1e-4, engine=sys.argv[1], exterior=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    sys.exit(3)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to a process")
@pytest.mark.parametrize("engine", ["native", "cgal"])
def test_ctrl_c_returns_at_once(engine):
    with subprocess.Popen([sys.executable, "-c", LONG, engine], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(1.0)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        waited = time.monotonic() - sent
        assert process.wait(timeout=60) == 3
    # A tick is 50 ms; the rest is the machine's load.
    assert waited < 2.0


def test_the_lock_is_released():
    points = np.random.default_rng(0).random((100_000, 3))
    done, beats = threading.Event(), []

    def beat():
        while not done.is_set():
            beats.append(time.monotonic())
            time.sleep(0.005)

    thread = threading.Thread(target=beat)
    thread.start()
    started = time.monotonic()
    walpha.alpha_shape(points, alpha=1e-3)
    took = time.monotonic() - started
    done.set()
    thread.join()
    # With the lock held there would be one beat before and one after.
    assert len(beats) > 5 and took > 0.05


def test_progress_is_told_in_this_thread(cloud):
    told = []
    points = np.random.default_rng(0).random((60_000, 3))

    def progress(stage, done, total):
        assert threading.current_thread() is threading.main_thread()
        told.append((stage, done, total))

    walpha.alpha_shape(points, alpha="auto:connected", engine="native", progress=progress)
    stages = [stage for stage, _, _ in told]
    assert set(stages) >= {"alpha", "shape"} and stages.index("alpha") < stages.index("shape")
    for name in ("alpha", "shape"):
        shares = [done / total for stage, done, total in told if stage == name and total]
        assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] <= 1
    assert len(told) > 3


def test_an_exception_of_progress_ends_the_work():
    points = np.random.default_rng(0).random((200_000, 3))

    def progress(stage, done, total):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        walpha.filtration(points, progress=progress)


def test_calls_at_the_same_time_have_progress_of_their_own():
    points = np.random.default_rng(0).random((60_000, 3))

    def work(kind):
        stages = set()
        progress = lambda stage, done, total: stages.add(stage)  # noqa: E731
        if kind == "shape":
            walpha.alpha_shape(points, alpha=1e-3, progress=progress)
        else:
            walpha.filtration(points, progress=progress)
        return stages

    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(work, ["shape", "filtration"])) == [{"points", "shape"}, {"filtration"}]


def test_progress_on_standard_error(cloud, capsys, monkeypatch):
    points = np.random.default_rng(0).random((20_000, 3))
    walpha.filtration(points, progress=True).betti_curve(progress=True)
    # Of a file, nothing can be written over.
    assert capsys.readouterr().err == "filtration\ncurve\n"
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    walpha.filtration(points, progress=True).betti_curve(progress=True)
    told = capsys.readouterr().err
    assert told.startswith("\rfiltration") and "\rcurve" in told and told.endswith("\n")
    with pytest.raises(ValueError, match="progress=7"):
        walpha.filtration(cloud, progress=7)
