"""Pictures, charts and pages, as notebooks and files show them. They need nothing but walpha."""

from __future__ import annotations

import base64
import html
import math
import os
import pathlib
import struct
import sys
import tempfile
import webbrowser
import zlib
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _walpha

View = Literal["front", "back", "left", "right", "top", "bottom", "three-quarter"]
Colour = Literal["plain", "value", "class"]


class Picture:
    """A picture: the last line of a notebook's cell shows it.

    Made by :meth:`AlphaShape.plot` and :meth:`Volume.plot`. ``bytes(picture)`` are those of a PNG file.

    Examples
    --------
    >>> picture = walpha.alpha_shape(np.eye(4)[:, :3], alpha=1).plot(size=(64, 48))
    >>> picture
    <walpha.Picture of 64×48 pixels>
    >>> bytes(picture)[:4]
    b'\\x89PNG'
    """

    def __init__(self, png: bytes) -> None:
        self._png = png

    def __bytes__(self) -> bytes:
        return self._png

    def _repr_png_(self) -> bytes:
        return self._png

    def __repr__(self) -> str:
        width, height = struct.unpack(">II", self._png[16:24])
        return f"<walpha.Picture of {width}×{height} pixels>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a file, as PNG.

        Parameters
        ----------
        path : str or path-like
            Ends with ``.png``.

        Raises
        ------
        ValueError
            The name ends with something else.
        """
        _extension(path, ".png")
        _write(path, self._png)


class Chart:
    """A chart: the last line of a notebook's cell shows it.

    Made by :meth:`BettiCurve.plot` and :meth:`Simplices.plot`.

    Attributes
    ----------
    svg : str
        The text of an SVG file.
    """

    def __init__(self, svg: str, what: str) -> None:
        self.svg, self._what = svg, what

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<walpha.Chart of {self._what}>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a file, as SVG.

        Parameters
        ----------
        path : str or path-like
            Ends with ``.svg``.

        Raises
        ------
        ValueError
            The name ends with something else.
        """
        _extension(path, ".svg")
        _write(path, self.svg.encode())


class Page:
    """An interactive page, which needs no network: the last line of a notebook's cell shows it.

    Made by :meth:`AlphaShape.show`.

    Attributes
    ----------
    html : str
        The text of an HTML file.
    """

    def __init__(self, text: str, height: int) -> None:
        self.html, self._height = text, height

    def _repr_html_(self) -> str:
        inside = html.escape(self.html)
        style = f"width:100%;height:{self._height}px;border:0"
        return f'<iframe title="walpha" style="{style}" sandbox="allow-scripts allow-downloads" srcdoc="{inside}"></iframe>'

    def __repr__(self) -> str:
        return f"<walpha.Page of {len(self.html) / 1e6:.1f} MB>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a file, as HTML.

        Parameters
        ----------
        path : str or path-like
            Ends with ``.html``.

        Raises
        ------
        ValueError
            The name ends with something else.
        """
        _extension(path, ".html")
        _write(path, self.html.encode())

    def open(self) -> str:
        """Write it to a temporary file, and open that in a browser.

        Returns
        -------
        str
            The name of the file, which stays.
        """
        handle, path = tempfile.mkstemp(prefix="walpha-", suffix=".html")
        with os.fdopen(handle, "wb") as file:
            file.write(self.html.encode())
        webbrowser.open(pathlib.Path(path).as_uri())
        return path


def in_notebook() -> bool:
    """Whether a notebook shows the last line of a cell."""
    ipython = sys.modules.get("IPython")
    shell: Any = None if ipython is None else ipython.get_ipython()
    return shell is not None and hasattr(shell, "kernel")


def extension(path: str | os.PathLike[str]) -> str:
    """The extension of a name, in small letters and with its dot."""
    return pathlib.PurePath(os.fspath(path)).suffix.lower()


def _extension(path: str | os.PathLike[str], wanted: str) -> None:
    if extension(path) != wanted:
        raise ValueError(f"{os.fspath(path)}: this is written as {wanted}: give a name that ends so")


def _write(path: str | os.PathLike[str], content: bytes) -> None:
    _walpha.write_whole(os.fspath(path), content)


def brief(value: float) -> str:
    """A number with four digits, and thousands apart."""
    if not math.isfinite(value) or value == 0:
        return f"{value:g}"
    rounded = float(f"{value:.3e}")
    if not 1e-4 <= abs(rounded) < 1e15:
        return f"{rounded:g}"
    text = f"{rounded:,.{max(0, 3 - math.floor(math.log10(abs(rounded))))}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace(",", " ")


def count(number: int) -> str:
    """A number of things, with thousands apart."""
    return f"{number:,}".replace(",", " ")


def summary(title: str, rows: Sequence[tuple[str, str]], picture: str = "") -> str:
    """The summary of an object for a notebook: a picture beside a few numbers."""
    cells = "".join(f"<tr><th style='text-align:left'>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in rows)
    table = f"<table><caption style='text-align:left'>{html.escape(title)}</caption>{cells}</table>"
    return f"<div style='display:flex;gap:1em;align-items:center'>{picture}{table}</div>"


def image(png: bytes, what: str, width: int) -> str:
    """A picture as an element of HTML."""
    data = base64.b64encode(png).decode()
    return f'<img alt="{html.escape(what)}" width="{width}" src="data:image/png;base64,{data}">'


def gray_png(levels: NDArray[np.uint8]) -> bytes:
    """A picture in gray as a PNG file (ISO/IEC 15948)."""
    height, width = levels.shape
    # Each row begins with the number of its filter: none.
    rows = np.concatenate([np.zeros((height, 1), np.uint8), levels], axis=1).tobytes()

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    parts = chunk(b"IHDR", head), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


#: Colours that most people tell apart, after M. Okabe and K. Ito, Color Universal Design (2008), and dark enough for text.
_COLOURS = ("#0072b2", "#b34700", "#00785a")


def steps_chart(
    title: str, across: str, curves: Sequence[tuple[str, NDArray[Any], NDArray[Any]]], what: str
) -> Chart:
    """A chart of counts that change at certain places above 0, both on logarithmic axes.

    Each curve has a name, ascending places, and a count from each place on. The axis of counts shows 0 a step below 1.
    """
    width, height, left, right, top, bottom = 640, 400, 64, 100, 36, 52
    placed = [places[places > 0] for _, places, _ in curves]
    low = min((float(places[0]) for places in placed if len(places)), default=1.0)
    # From the last change on, all stays as it is.
    changes = [places[1:][np.diff(counts) != 0] for _, places, counts in curves]
    high = max((float(places[-1]) for places in changes if len(places) and places[-1] > 0), default=10.0 * low)
    first = math.floor(math.log10(low))
    last = max(math.ceil(math.log10(high)), first + 1)
    most = max((int(counts.max()) for _, _, counts in curves if len(counts)), default=1)
    decades = max(1, math.ceil(math.log10(max(most, 1))))

    def x(place: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(left + (np.log10(place) - first) / (last - first) * (width - left - right))

    def y(count: NDArray[Any]) -> NDArray[Any]:
        # One decade more, whose lower end is 0.
        power = np.where(count > 0, np.log10(np.maximum(count, 1)) + 1, 0)
        return np.asarray(height - bottom - power / (decades + 1) * (height - top - bottom))

    lines = []
    for power in range(first, last + 1):
        at = float(x(np.array(10.0**power)))
        lines.append(f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{top}" y2="{height - bottom}" stroke="#ddd"/>')
        lines.append(f'<text x="{at:.1f}" y="{height - bottom + 20}" text-anchor="middle">{10.0**power:g}</text>')
    for power in range(-1, decades + 1):
        count = 0 if power < 0 else 10**power
        at = float(y(np.array(count)))
        lines.append(f'<line x1="{left}" x2="{width - right}" y1="{at:.1f}" y2="{at:.1f}" stroke="#ddd"/>')
        lines.append(f'<text x="{left - 8}" y="{at + 5:.1f}" text-anchor="end">{count:,}</text>'.replace(",", " "))
    ends = []
    for (name, places, counts), colour in zip(curves, _COLOURS):
        seen = (places > 0) & (places <= 10.0**last)
        heights, across_at = y(counts[seen]), x(places[seen])
        # Changes that are less than a pixel apart cannot be seen.
        path: list[str] = []
        before = None
        for at, up in zip(np.round(across_at, 1), np.round(heights, 1)):
            if (at, up) != before:
                path.append(f"{'H' if path else 'M'}{at:g}{'V' if path else ','}{up:g}")
                before = (at, up)
        path.append(f"H{width - right}")
        lines.append(f'<path d="{"".join(path)}" fill="none" stroke="{colour}" stroke-width="2"/>')
        ends.append((float(heights[-1]) if len(heights) else float(y(np.array(0))), name, colour))
    # From below upwards, as the numbers of the axis are below.
    at = math.inf
    for up, name, colour in sorted(ends, reverse=True):
        at = min(up, at - 16)
        lines.append(f'<text x="{width - right + 8}" y="{at + 5:.1f}" fill="{colour}">{html.escape(name)}</text>')
    return Chart(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        'font-family="sans-serif" font-size="13">'
        f'<rect width="{width}" height="{height}" fill="#fff"/>'
        f'<text x="{left}" y="22" font-size="15">{html.escape(title)}</text>{"".join(lines)}'
        f'<text x="{(left + width - right) / 2}" y="{height - 10}" text-anchor="middle">{html.escape(across)}</text></svg>',
        what,
    )
