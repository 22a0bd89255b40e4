"""How work is done: on how many threads, and what receives its progress."""

from __future__ import annotations

import contextlib
import operator
import sys
from collections.abc import Iterator

from ._typing import Listener, Progress


@contextlib.contextmanager
def task(progress: Progress, threads: int | None) -> Iterator[tuple[int | None, Listener | None]]:
    """What the library takes of both, while the work is done."""
    if threads is not None:
        try:
            threads = operator.index(threads)
        except TypeError:
            raise ValueError(f"threads={threads!r} is not a number of threads: give one from 1 up") from None
        if threads < 1:
            raise ValueError(f"threads={threads}: give a number from 1 up, or None for all that may be used")
    if progress is True:
        line = _Line()
        try:
            yield threads, line
        finally:
            line.end()
    elif progress is None or progress is False:
        yield threads, None
    elif callable(progress):
        yield threads, progress
    else:
        raise ValueError(f"progress={progress!r}: give True, or a function of stage, done and total")


class _Line:
    """A line on standard error for each stage: with its share, where that can be written over, as in terminals and notebooks."""

    def __init__(self) -> None:
        self.stage: str | None = None
        self.moves = sys.stderr.isatty() or "ipykernel" in sys.modules

    def __call__(self, stage: str, done: int, total: int) -> None:
        if stage != self.stage:
            self.end()
            self.stage = stage
            if not self.moves:
                print(stage, end="", file=sys.stderr, flush=True)
        if not self.moves:
            return
        share = f" {100 * done // total:3} %" if total else ""
        print(f"\r{stage}{share}", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.stage is not None:
            print(file=sys.stderr)
