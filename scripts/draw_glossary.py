#!/usr/bin/env python3
"""Draws the illustrations of docs/glossary.md: `python3 scripts/draw_glossary.py docs/images`.

In the plane, where a triangle is what a cell is in space. Standard library only; the sets are so small that every triple of points is tried.
"""

import sys
from itertools import combinations
from math import sqrt
from pathlib import Path

BALL, INSIDE, EDGE, POINT = "#cfe3f5", "#8fb8de", "#1f4e79", "#12304d"
SINGULAR, GONE, TEXT = "#d9822b", "#b0b0b0", "#222222"


def orthogonal(points):
    """Centre and squared radius of the smallest circle orthogonal to the (x, y, weight) in `points`; None if they lie on a line."""
    (x0, y0, w0), rest = points[0], points[1:]
    rows = [(x - x0, y - y0, ((x - x0) ** 2 + (y - y0) ** 2 - w + w0) / 2) for x, y, w in rest]
    if len(rows) == 2:
        (a, b, e), (c, d, f) = rows
        determinant = a * d - b * c
        if abs(determinant) < 1e-9:
            return None
        u, v = (e * d - b * f) / determinant, (a * f - e * c) / determinant
    elif len(rows) == 1:
        [(a, b, e)] = rows
        u, v = a * e / (a * a + b * b), b * e / (a * a + b * b)
    else:
        u = v = 0.0
    return x0 + u, y0 + v, u * u + v * v - w0


def empty(circle, points, but):
    """Whether no point, except those of the indices `but`, is inside the circle."""
    x, y, squared = circle
    others = (p for k, p in enumerate(points) if k not in but)
    return all((p[0] - x) ** 2 + (p[1] - y) ** 2 - p[2] - squared > -1e-9 for p in others)


def filtration(points):
    """Every simplex of the regular triangulation, as a tuple of indices, with the α at which it enters."""
    values = {}
    for triple in combinations(range(len(points)), 3):
        circle = orthogonal([points[k] for k in triple])
        if circle and empty(circle, points, triple):
            values[triple] = circle[2]
    for size in (2, 1):
        for simplex in {face for s in values if len(s) == size + 1 for face in combinations(s, size)}:
            circle = orthogonal([points[k] for k in simplex])
            cofaces = [value for s, value in values.items() if len(s) == size + 1 and set(simplex) < set(s)]
            values[simplex] = circle[2] if empty(circle, points, simplex) else min(cofaces)
    return values


class Drawing:
    """An SVG of a given size, in pixels."""

    def __init__(self, width, height):
        self.size, self.lines = (width, height), []

    def add(self, line):
        self.lines.append(line)

    def text(self, x, y, words, anchor="middle", colour=TEXT):
        self.add(f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}" fill="{colour}">{words}</text>')

    def paragraph(self, x, y, texts):
        for k, words in enumerate(texts):
            self.text(x, y + 22 * k, words, "start")

    def circle(self, x, y, radius, fill, stroke="none", dash=""):
        dash = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{stroke}"{dash}/>')

    def line(self, a, b, colour=EDGE, width=2, dash=""):
        dash = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(
            f'<line x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" y2="{b[1]:.1f}" stroke="{colour}" stroke-width="{width}"{dash}/>'
        )

    def triangle(self, corners, fill=INSIDE):
        self.add(f'<polygon points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in corners)}" fill="{fill}"/>')

    def shape(self, points, alpha, origin=(0, 0), balls=True, classes=False):
        """The alpha shape of `points`; `classes` colours edges by what they belong to."""
        values = filtration(points)
        place = [(x + origin[0], y + origin[1]) for x, y, _ in points]
        shown = [s for s, value in values.items() if value <= alpha]
        if balls:
            for (x, y), (_, _, weight) in zip(place, points):
                if alpha + weight > 0:
                    self.circle(x, y, sqrt(alpha + weight), BALL)
        for simplex in sorted(shown, key=len, reverse=True):
            corners = [place[k] for k in simplex]
            if len(simplex) == 3:
                self.triangle(corners)
            elif len(simplex) == 2:
                triangles = sum(len(s) == 3 and set(simplex) < set(s) for s in shown)
                colour, width = [(SINGULAR, 3.5), (EDGE, 3.5), ("#ffffff", 2)][triangles] if classes else (EDGE, 2)
                self.line(*corners, colour, width)
        for x, y in place:
            self.circle(x, y, 3.5, POINT)

    def save(self, path):
        width, height = self.size
        head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
        style = ' font-family="sans-serif" font-size="15"><rect width="100%" height="100%" fill="#ffffff"/>'
        path.write_text("\n".join([head + style, *self.lines, "</svg>", ""]))


CLOUD = [
    (40, 150), (62, 100), (105, 62), (158, 52), (204, 78), (222, 128), (90, 135), (130, 105), (172, 118), (150, 160), (62, 195), (196, 196),
]  # fmt: skip


def alpha():
    drawing = Drawing(780, 290)
    points = [(x, y, 0) for x, y in CLOUD]
    for k, (value, name) in enumerate([(500, "small α"), (1500, "larger α"), (1e9, "α = ∞: the convex hull")]):
        drawing.shape(points, value, (260 * k, 8), balls=value < 1e6)
        drawing.text(260 * k + 130, 276, name)
    return drawing


def weight():
    drawing = Drawing(560, 250)
    points = [(120, 120, 0), (230, 120, 4500)]
    drawing.shape(points, 1600)
    for (x, y, w), name in zip(points, ["ω = 0", "ω &gt; 0"]):
        radius = sqrt(1600 + w)
        drawing.line((x, y), (x, y - radius), SINGULAR, 2)
        drawing.text(x, 226, name)
    drawing.text(330, 90, "radius √(α + ω)", "start", SINGULAR)
    drawing.paragraph(330, 116, ["The two balls overlap, so the", "edge of their centres belongs", "to the shape."])
    return drawing


def classes():
    drawing = Drawing(600, 250)
    points = [(x, y, 0) for x, y in [(40, 120), (85, 60), (95, 165), (140, 108), (185, 60), (190, 160), (250, 110), (328, 100), (300, 228)]]
    drawing.shape(points, 3000, balls=False, classes=True)
    for k, (colour, name) in enumerate([("#8fb8de", "cell: interior"), (EDGE, "regular: bounds a cell"), (SINGULAR, "singular: bounds none")]):
        drawing.line((370, 70 + 32 * k), (400, 70 + 32 * k), colour, 5)
        drawing.text(412, 75 + 32 * k, name, "start")
    drawing.circle(385, 166, 4, POINT)
    drawing.text(412, 171, "a point alone: singular", "start")
    return drawing


def hidden():
    drawing = Drawing(560, 250)
    drawing.circle(150, 125, 90, BALL, EDGE)
    drawing.circle(185, 105, 18, "#f6dcc0", SINGULAR, "4 3")
    drawing.circle(290, 150, 60, BALL, EDGE)
    drawing.line((150, 125), (290, 150))
    for x, y in [(150, 125), (290, 150)]:
        drawing.circle(x, y, 3.5, POINT)
    drawing.circle(185, 105, 3.5, SINGULAR)
    drawing.text(370, 95, "hidden: its ball is inside", "start", SINGULAR)
    drawing.text(370, 117, "that of a heavier point", "start", SINGULAR)
    return drawing


def ties():
    drawing = Drawing(640, 230)
    square = [(0, 0), (100, 0), (100, 100), (0, 100)]
    for k, (diagonal, name) in enumerate([((0, 2), "the rule's choice"), ((1, 3), "as right, and valid")]):
        corners = [(70 + 220 * k + x, 50 + y) for x, y in square]
        drawing.circle(120 + 220 * k, 100, 50 * sqrt(2), "none", GONE, "5 4")
        drawing.add(f'<polygon points="{" ".join(f"{x},{y}" for x, y in corners)}" fill="{INSIDE}" stroke="{EDGE}" stroke-width="2"/>')
        drawing.line(corners[diagonal[0]], corners[diagonal[1]], SINGULAR, 3)
        for x, y in corners:
            drawing.circle(x, y, 4, POINT)
        drawing.text(120 + 220 * k, 205, name)
    drawing.paragraph(450, 80, ["Four points on one", "circle can be cut", "in two ways."])
    return drawing


def filtered():
    drawing = Drawing(780, 220)
    points = [(65, 60, 0), (120, 54, 0), (131, 98, 0), (76, 109, 0)]
    values = sorted(set(filtration(points).values()))
    chosen = [value for value in values if value > 0]
    for k, value in enumerate([0, chosen[0], chosen[2], chosen[-1]]):
        drawing.shape(points, value, (195 * k, 20))
        drawing.text(195 * k + 95, 205, f"α = {value:.0f}")
    return drawing


def main():
    folder = Path(sys.argv[1])
    for name, draw in [("alpha", alpha), ("weight", weight), ("classes", classes), ("hidden", hidden), ("ties", ties), ("filtration", filtered)]:
        draw().save(folder / f"{name}.svg")


if __name__ == "__main__":
    main()
