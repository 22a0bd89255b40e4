// Tests of the package as `node --test` runs them: scripts/npm.sh.

import assert from "node:assert/strict";
import test from "node:test";
import { alphaShape } from "walpha";

const cube = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2]);

// Random numbers that are always the same.
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

test("a cube fills at the radius of its sphere, exactly", async () => {
  const shape = await alphaShape(cube, { alpha: 0.75 });
  assert.deepEqual([shape.volume, shape.area, shape.betti, shape.dimension], [1, 6, [1, 0, 0], 3]);
  assert.equal(shape.boundary.length, 3 * 12);
  assert.equal((await alphaShape(cube, { alpha: 0.7499999999999999 })).volume, 0);
  const flat = Float64Array.from(cube.flat());
  assert.deepEqual((await alphaShape(flat, { alpha: 0.75 })).tetrahedra, shape.tetrahedra);
});

test("boundaries are closed, and oriented outwards", async () => {
  const next = random(7);
  const points = Array.from({ length: 400 }, () => [next(), next(), next()]);
  const { boundary, tetrahedra, volume } = await alphaShape(points, { radius: 0.12 });
  const sides = new Map();
  let six = 0;
  for (let at = 0; at < boundary.length; at += 3) {
    const row = boundary.subarray(at, at + 3);
    const [a, b, c] = Array.from(row, (v) => points[v]);
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    for (let k = 0; k < 3; k++) {
      const [v, w] = [row[k], row[(k + 1) % 3]];
      const key = `${Math.min(v, w)} ${Math.max(v, w)}`;
      sides.set(key, (sides.get(key) ?? 0) + (v < w ? 1 : -1));
    }
  }
  assert.ok(boundary.length > 300 && tetrahedra.length > 400);
  assert.ok([...sides.values()].every((sum) => sum === 0));
  assert.ok(Math.abs(six / 6 - volume) < 1e-12);
});

test("a square in the plane has a polygon with a hole", async () => {
  const grid = [];
  for (let x = 0; x < 7; x++) for (let y = 0; y < 7; y++) if (Math.hypot(x - 3, y - 3) > 1.5) grid.push([x, y]);
  const shape = await alphaShape(grid, { radius: 1 });
  assert.equal(shape.dimension, 2);
  assert.deepEqual(shape.betti, [1, 1, 0]);
  const [[outer, hole], ...others] = shape.polygons;
  assert.equal(others.length, 0);
  // Shoelaces of the rings.
  const area = (ring) => ring.reduce((sum, v, k) => {
    const [a, b] = [grid[v], grid[ring[(k + 1) % ring.length]]];
    return sum + (a[0] * b[1] - a[1] * b[0]) / 2;
  }, 0);
  assert.ok(area(outer) === 36 && area(hole) < 0);
  assert.equal(area(outer) + area(hole), shape.area);
  assert.equal(shape.perimeter > 24, true);
  assert.equal(shape.boundary.length / 2, outer.length + hole.length);
});

test("weights are those of balls", async () => {
  // Two balls of radius 1 that touch, at α = 0.
  const shape = await alphaShape([[0, 0, 0], [2, 0, 0]], { alpha: 0, weights: [1, 1] });
  assert.deepEqual([...shape.edges], [0, 1]);
  const apart = await alphaShape([[0, 0, 0], [2.001, 0, 0]], { alpha: 0, weights: [1, 1] });
  assert.deepEqual([apart.edges.length, [...apart.isolated]], [0, [0, 1]]);
});

test("a radius is found where none is given", async () => {
  const points = [];
  for (let x = 0; x < 8; x++) for (let y = 0; y < 8; y++) for (let z = 0; z < 8; z++) points.push([x, y, z]);
  const shape = await alphaShape(points);
  assert.ok(shape.radius > 0.8 && shape.radius < 3);
  assert.ok(Math.abs(shape.volume - 343) < 1e-9);
});

test("duplicates, lines and single points have their shapes", async () => {
  assert.deepEqual([...(await alphaShape([[1, 2], [1, 2]], { radius: 1 })).isolated], [0]);
  const line = await alphaShape([[0, 0], [1, 1], [2, 2]], { radius: 1 });
  assert.deepEqual([line.dimension, [...line.edges]], [1, [0, 1, 1, 2]]);
});

test("wrong arguments are told", async () => {
  await assert.rejects(alphaShape([[0, 0, NaN]], { radius: 1 }), RangeError);
  await assert.rejects(alphaShape([[0, 0, 0], [1, 1]], { radius: 1 }), /point 1 has 2 coordinates/);
  await assert.rejects(alphaShape([[0]], { radius: 1 }), TypeError);
  await assert.rejects(alphaShape(new Float64Array(4), { radius: 1 }), TypeError);
  await assert.rejects(alphaShape(cube, { radius: -1 }), TypeError);
  await assert.rejects(alphaShape(cube, { radius: 1, alpha: 1 }), TypeError);
  await assert.rejects(alphaShape(cube, { alpha: "large" }), TypeError);
  await assert.rejects(alphaShape(cube, { radius: 1, weights: [1] }), /1 weights for 8 points/);
  await assert.rejects(alphaShape([], { radius: 1 }), RangeError);
  // After an error all works as before.
  assert.equal((await alphaShape(cube, { radius: 1 })).volume, 1);
});

test("many points", async () => {
  const next = random(3);
  const points = Float64Array.from({ length: 3 * 20000 }, next);
  const shape = await alphaShape(points, { alpha: Infinity });
  assert.ok(shape.volume > 0.95 && shape.tetrahedra.length > 4 * 120000);
});
