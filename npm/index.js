// Weighted alpha shapes of points, computed by the library walpha in WebAssembly.

import { WASM } from "./wasm.js";

const NAMES = ["tetrahedra", "boundary", "triangles", "edges", "isolated"];

let compiled = null;
let instance = null;

async function unpacked(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

// The library, loaded once. After a failure it is started anew, as its memory is in no known state.
async function library() {
  compiled ??= unpacked(WASM);
  const module = await compiled;
  if (!instance) {
    instance = await WebAssembly.instantiate(module, {});
    instance.exports.begin();
  }
  return instance.exports;
}

// The coordinates of all points, three each, and whether they are in a plane.
function coordinates(points) {
  if (ArrayBuffer.isView(points)) {
    if (points.length % 3 !== 0) throw new TypeError(`points have ${points.length} coordinates: an array of numbers has three for each point`);
    return { numbers: points, count: points.length / 3 };
  }
  const rows = Array.from(points);
  const dimension = rows.length ? rows[0].length : 3;
  if (dimension !== 2 && dimension !== 3) throw new TypeError(`point 0 has ${dimension} coordinates: give two or three`);
  const numbers = new Float64Array(3 * rows.length);
  rows.forEach((row, v) => {
    if (row.length !== dimension) throw new TypeError(`point ${v} has ${row.length} coordinates, and point 0 has ${dimension}`);
    for (let k = 0; k < dimension; k++) numbers[3 * v + k] = row[k];
  });
  return { numbers, count: rows.length };
}

// The squared length α, or NaN where it is to be found.
function alphaOf({ radius, alpha }) {
  if (radius !== undefined && alpha !== undefined) throw new TypeError("give radius or alpha, not both: alpha is the square of radius");
  if (radius !== undefined) {
    if (!(radius >= 0)) throw new TypeError(`radius is ${radius}: give a length from 0 up`);
    return radius * radius;
  }
  if (alpha === undefined) return NaN;
  if (typeof alpha !== "number" || Number.isNaN(alpha)) throw new TypeError(`alpha is ${alpha}: give a squared length, or omit it`);
  return alpha;
}

export async function alphaShape(points, options = {}) {
  const { numbers, count } = coordinates(points);
  const { weights } = options;
  if (weights && weights.length !== count) throw new TypeError(`${weights.length} weights for ${count} points: give one for each`);
  const alpha = alphaOf(options);
  const exports = await library();
  const length = (weights ? 4 : 3) * count;
  const at = exports.reserve(length) >>> 0;
  const given = new Float64Array(exports.memory.buffer, at, length);
  given.set(numbers);
  if (weights) given.set(weights, 3 * count);
  let place;
  try {
    place = exports.compute(at, count, weights ? 1 : 0, alpha) >>> 0;
  } catch (error) {
    const text = answer(exports, exports.message() >>> 0).error;
    instance = null;
    throw new Error(text ? `${text} (this is a bug in walpha: please report it)` : `not enough memory, or ${error.message}`, { cause: error });
  }
  const { error, numbers: found, lists } = answer(exports, place);
  if (error) throw new RangeError(error);
  const [squared, dimension, volume, area, perimeter, ...betti] = found;
  const shape = { alpha: squared, radius: Math.sqrt(squared), dimension, volume, area, perimeter, betti };
  NAMES.forEach((name, k) => { shape[name] = lists[k]; });
  shape.polygons = polygons(lists.slice(NAMES.length));
  return shape;
}

// What a call answered, copied out of the memory of the library.
function answer({ memory }, place) {
  const words = (at, length) => new Uint32Array(memory.buffer, at, length);
  const lists = [];
  const [text, numbers] = [0, 1].map((k) => words(place + 8 * k, 2));
  const error = new TextDecoder().decode(new Uint8Array(memory.buffer, text[0], text[1]));
  if (error) return { error };
  const found = new Float64Array(memory.buffer, numbers[0], numbers[1]).slice();
  for (let k = 0; k < NAMES.length + 3; k++) {
    const [at, length] = words(place + 8 * (2 + k), 2);
    lists.push(words(at, length).slice());
  }
  return { error, numbers: found, lists };
}

// Each polygon as its rings, the outer one first.
function polygons([corners, lengths, rings]) {
  let [corner, ring] = [0, 0];
  return Array.from(rings, (count) => Array.from({ length: count }, () => corners.slice(corner, corner += lengths[ring++])));
}
