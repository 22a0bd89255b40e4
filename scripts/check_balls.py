"""The bounds of measures of unions of balls, held to the same measures in numbers of 60 digits, on ten thousand small sets.

    cargo build --release -p walpha-balls --example measure
    python3 scripts/check_balls.py [SETS]

The sets have what is hard: balls that touch, or miss it by the last digit, from outside and inside; lattices at the α where balls meet in a
point, exactly and but for the last digit; hidden balls; balls whose centres lie on a sphere or in a plane; radii from a millionth to a million. The dual complex is taken from
the program, as other checks judge it. The formulas are those of inclusion and exclusion as they are usually written, with the measures
of one, two and three balls, and centres of orthogonal spheres by their coordinates; the program has others.

Exit code 1 where a bound is passed, 77 without the package mpmath.
"""

import itertools
import json
import pathlib
import random
import subprocess
import sys

from environment import enter

ROOT = pathlib.Path(__file__).resolve().parent.parent
DIGITS = 60


def families(rng):
    """A set of balls (x, y, z, squared radius) of each kind, for ever."""
    ulp = lambda x: x * (1 + rng.choice([-1, 0, 1]) * 2.0**-52)
    place = lambda side: [rng.uniform(0, side) for _ in range(3)]
    while True:
        count = rng.randint(1, 8)
        side = count ** (1 / 3) * rng.choice([0.6, 1.0, 1.5])
        yield "random", [(*place(side), rng.uniform(0.5, 1.2) ** 2) for _ in range(count)]
        # A pair that touches, or all but, with a third ball near.
        a, b = rng.uniform(0.5, 2), rng.uniform(0.5, 2)
        way = [rng.gauss(0, 1) for _ in range(3)]
        length = sum(x * x for x in way) ** 0.5
        far = (a + b if rng.random() < 0.5 else abs(a - b)) * (1 + rng.choice([0, 0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8]))
        touching = [(0, 0, 0, a * a), (*[x / length * far for x in way], b * b)]
        if rng.random() < 0.5:
            touching.append((*place(2), rng.uniform(0.2, 1)))
        yield "touching", touching
        corners = rng.sample(list(itertools.product(range(3), range(3), range(2))), rng.randint(2, 12))
        squared = rng.choice([0.25, 0.5, 0.75, 1.0, 0.5 * (1 + 2.0**-52), 0.75 * (1 - 2.0**-53)])
        yield "lattice", [(*map(float, corner), squared) for corner in corners]
        yield "nearly a lattice", [(*(ulp(float(x)) for x in corner), ulp(squared)) for corner in corners]
        # Integer points on a sphere of radius 15, and in a plane.
        sphere = [p for p in itertools.product(range(-15, 16), repeat=3) if sum(x * x for x in p) == 225]
        squared = rng.choice([225.0, 225 * (1 + 2.0**-52), 225 * (1 - 2.0**-53), 50.0, 150.0])
        yield "on a sphere", [(*map(float, p), squared) for p in rng.sample(sphere, rng.randint(3, 9))]
        plane = [(*map(float, (x, y, x + y)), rng.choice([1.0, 1.5, 2.0, 3.0])) for x, y in rng.sample(list(itertools.product(range(3), repeat=2)), rng.randint(2, 7))]
        yield "in a plane", plane
        big = 10 ** rng.uniform(-2, 6)
        small = 10 ** rng.uniform(-6, 0)
        spots = [(0.0, 0.0, 0.0, big * big)]
        for _ in range(rng.randint(1, 4)):
            far = big + small * rng.uniform(-1, 1)
            tilt = [small / big * rng.uniform(-2, 2) for _ in range(2)]
            length = (1 + tilt[0] ** 2 + tilt[1] ** 2) ** 0.5
            spots.append((far * tilt[0] / length, far * tilt[1] / length, far / length, (small * rng.uniform(0.5, 1.5)) ** 2))
        yield "of all sizes", spots


class Exact:
    """The measures of a union from its dual complex, in numbers of many digits."""

    def __init__(self, mp, balls, complex):
        self.mp = mp
        self.p = [[mp.mpf(x) for x in ball[:3]] for ball in balls]
        self.s = [mp.mpf(ball[3]) for ball in balls]
        self.measure(complex)

    def sub(self, a, b):
        return [x - y for x, y in zip(a, b)]

    def dot(self, a, b):
        return sum(x * y for x, y in zip(a, b))

    def cross(self, a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def norm(self, a):
        return self.mp.sqrt(self.dot(a, a))

    def dihedral(self, a, b, c, d):
        """The angle at the edge ab of the tetrahedron abcd."""
        u = self.sub(b, a)
        m, n = self.cross(u, self.sub(c, a)), self.cross(u, self.sub(d, a))
        return self.mp.atan2(self.norm(self.cross(m, n)), self.dot(m, n))

    def solid(self, a, b, c, d):
        """The solid angle at a of the tetrahedron abcd."""
        x, y, z = (self.sub(q, a) for q in (b, c, d))
        i, j, k = map(self.norm, (x, y, z))
        below = i * j * k + self.dot(x, y) * k + self.dot(x, z) * j + self.dot(y, z) * i
        return 2 * self.mp.atan2(abs(self.dot(x, self.cross(y, z))), below)

    def volume(self, a, b, c, d):
        return abs(self.dot(self.sub(b, a), self.cross(self.sub(c, a), self.sub(d, a)))) / 6

    def center(self, simplex):
        """The centre of the smallest orthogonal sphere of a triangle or a tetrahedron."""
        p, s = self.p, self.s
        a = p[simplex[0]]
        ways = [self.sub(p[v], a) for v in simplex[1:]]
        rows = [[self.dot(w, other) for other in ways] for w in ways]
        right = [(self.dot(w, w) + s[simplex[0]] - s[v]) / 2 for w, v in zip(ways, simplex[1:])]
        shares = self.mp.lu_solve(self.mp.matrix(rows), self.mp.matrix(right))
        return [a[k] + sum(shares[i] * ways[i][k] for i in range(len(ways))) for k in range(3)]

    def measure(self, complex):
        mp, p, s = self.mp, self.p, self.s
        pi, root = mp.pi, lambda x: mp.sqrt(max(x, mp.mpf(0)))
        r = [root(x) for x in s]
        key = lambda *vs: tuple(sorted(vs))
        # What is left of the angles around each simplex.
        vertices = {v: mp.mpf(1) for [v] in complex["vertices"]}
        edges = {key(*e): mp.mpf(1) for e in complex["edges"]}
        facets = {key(*f): 2 for f in complex["facets"]}
        total = mp.mpf(0)
        apexes = {}
        for cell in complex["cells"]:
            q = [p[v] for v in cell]
            total += self.volume(*q)
            for k in range(4):
                rest = [q[m] for m in range(4) if m != k]
                vertices[cell[k]] -= self.solid(q[k], *rest) / (4 * pi)
                facets[key(*(cell[m] for m in range(4) if m != k))] -= 1
            for k, m in itertools.combinations(range(4), 2):
                rest = [q[n] for n in range(4) if n not in (k, m)]
                edges[key(cell[k], cell[m])] -= self.dihedral(q[k], q[m], *rest) / (2 * pi)
        lens = {}
        for i, j in edges:
            d = self.norm(self.sub(p[i], p[j]))
            x = (d * d + s[i] - s[j]) / (2 * d)
            lens[i, j] = d, {i: x, j: d - x}, max(s[i] - x * x, mp.mpf(0))
        cap = lambda v, edge: r[v] - lens[edge][1][v]
        areas = [mp.mpf(0)] * len(p)
        for v, left in vertices.items():
            total += left * 4 * pi / 3 * r[v] ** 3
            areas[v] += left * 4 * pi * s[v]
        open_arcs = dict(edges)
        for edge, left in edges.items():
            for v in edge:
                h = cap(v, edge)
                total -= left * pi / 3 * h * h * (3 * r[v] - h)
                areas[v] -= left * 2 * pi * r[v] * h
        # Contacts: cones from the centre of the disc over its part in each tetrahedron.
        kites = {edge: mp.mpf(0) for edge in edges}
        for facet, sides in facets.items():
            if not sides:
                continue
            a, b, c = (p[v] for v in facet)
            normal = self.cross(self.sub(b, a), self.sub(c, a))
            foot = self.center(facet)
            height = root(s[facet[0]] - self.dot(self.sub(foot, a), self.sub(foot, a)))
            x = [foot[k] + normal[k] / self.norm(normal) * height for k in range(3)]
            total += sides * self.volume(a, b, c, x)
            apexes[facet] = foot, x, sides
            for k in range(3):
                v, others = facet[k], [facet[m] for m in range(3) if m != k]
                angle = self.solid(p[v], p[others[0]], p[others[1]], x) / (4 * pi)
                total -= sides * angle * 4 * pi / 3 * r[v] ** 3
                areas[v] -= sides * angle * 4 * pi * s[v]
                edge = key(*others)
                turn = self.dihedral(p[others[0]], p[others[1]], p[v], x) / (2 * pi)
                open_arcs[edge] -= sides * turn
                for w in edge:
                    h = cap(w, edge)
                    total += sides * turn * pi / 3 * h * h * (3 * r[w] - h)
                    areas[w] += sides * turn * 2 * pi * r[w] * h
                kites[edge] += sides * self.kite(edge, v, foot, x)
        for cell in complex["cells"]:
            middle = self.center(cell)
            for facet in itertools.combinations(sorted(cell), 3):
                [apex] = set(cell) - set(facet)
                foot = self.center(facet)
                a, b, c = (p[v] for v in facet)
                normal = self.cross(self.sub(b, a), self.sub(c, a))
                side = self.dot(normal, self.sub(p[apex], a)) * self.dot(normal, self.sub(middle, a))
                for v in facet:
                    edge = key(*(w for w in facet if w != v))
                    kites[edge] += (1 if side >= 0 else -1) * self.kite(edge, v, foot, middle)
        self.total = total
        self.area = sum(areas)
        self.areas = areas
        self.contacts, self.mean = [], sum((4 * pi * r[v] * left for v, left in vertices.items()), mp.mpf(0))
        volumes = [r[v] * areas[v] / 3 for v in range(len(p))]
        for i, j in complex["edges"]:
            d, heights, squared = lens[key(i, j)]
            arc = open_arcs[key(i, j)] * 2 * pi
            contact = squared * arc / 2 + kites[key(i, j)]
            self.contacts.append(contact)
            for v in (i, j):
                volumes[v] += heights[v] * contact / 3
            bend = mp.atan2(d * root(squared), (s[i] + s[j] - d * d) / 2)
            self.mean -= root(squared) * arc * bend / 2
            self.mean -= edges[key(i, j)] * 2 * pi * (cap(i, key(i, j)) + cap(j, key(i, j)))
        for facet, (foot, x, sides) in apexes.items():
            for k in range(3):
                v, others = facet[k], [facet[m] for m in range(3) if m != k]
                self.mean -= sides * self.solid(p[v], p[others[0]], p[others[1]], x) * r[v]
                turn = self.dihedral(p[others[0]], p[others[1]], p[v], x)
                self.mean += sides * turn * sum(cap(w, key(*others)) for w in others)
        self.volumes = volumes

    def kite(self, edge, v, foot, x):
        """The area of the triangle of the disc's centre, the facet's centre and x, positive if the facet's centre is on the side of v."""
        i, j = (self.p[w] for w in edge)
        u = self.sub(j, i)
        d2 = self.dot(u, u)
        share = (d2 + self.s[edge[0]] - self.s[edge[1]]) / (2 * d2)
        middle = [i[k] + share * u[k] for k in range(3)]
        out = self.sub(self.p[v], i)
        out = self.sub(out, [self.dot(out, u) / d2 * y for y in u])
        away = self.dot(self.sub(foot, middle), out)
        area = self.norm(self.sub(foot, middle)) * self.norm(self.sub(x, foot)) / 2
        return area if away >= 0 else -area


def main():
    sets = int(next((word for word in sys.argv[1:] if word.isdigit()), 10_000))
    if "--inside" not in sys.argv:
        enter(ROOT / "target" / "check-balls", ["mpmath"], 120)
    import mpmath as mp

    mp.mp.dps = DIGITS
    named = list(itertools.islice(families(random.Random(26)), sets))
    lines = lambda balls: "\n".join(" ".join(map(repr, map(float, ball))) for ball in balls)
    program = ROOT / "target" / "release" / "examples" / "measure"
    run = subprocess.run([program], input="\n\n".join(lines(balls) for _, balls in named), capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr)
    answers = [json.loads(line) for line in run.stdout.splitlines()]
    assert len(answers) == len(named)
    passed, numbers, worst, widest = 0, 0, mp.mpf(0), {}
    for (name, balls), answer in zip(named, answers):
        true = Exact(mp, balls, answer)
        pairs = [
            ("volume", answer["volume"], true.total),
            ("area", answer["area"], true.area),
            ("mean curvature", answer["mean_curvature"], true.mean),
            ("Gaussian curvature", answer["gaussian_curvature"], 4 * mp.pi * answer["euler_characteristic"]),
        ]
        for kind, wanted in [("volumes", true.volumes), ("areas", true.areas), ("contacts", true.contacts)]:
            pairs += [(kind, pair, number) for pair, number in zip(answer[kind], wanted, strict=True)]
        for kind, (value, bound), wanted in pairs:
            numbers += 1
            off = abs(wanted - mp.mpf(value))
            if bound is None:
                continue
            # Where angles are not determined, 60 digits have an error of their own.
            if off > bound + mp.mpf(10) ** (20 - DIGITS) * (1 + abs(wanted)):
                passed += 1
                print(f"{name}: {kind} {value!r} ± {bound!r}, but {mp.nstr(wanted, 25)}; balls:\n{lines(balls)}")
            elif bound:
                worst = max(worst, off / bound)
        for kind, (value, bound), _ in pairs[:2]:
            if value:
                part = float("inf") if bound is None else bound / abs(value)
                widest[name] = max(widest.get(name, 0), part)
    print(f"{sets} sets, {numbers} numbers: {passed} pass their bounds; the largest error is {mp.nstr(worst, 3)} of its bound")
    for name, part in widest.items():
        print(f"  {name}: volume and area to {part:.1e}, or better")
    sys.exit(1 if passed or any(part > 1e-9 for part in widest.values()) else 0)


if __name__ == "__main__":
    main()
