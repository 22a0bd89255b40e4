// The shape in three dimensions. Drawn when something changes, not all the time.

import {
  AmbientLight, Box3, Box3Helper, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, InvertStencilOp,
  LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, NotEqualStencilFunc, PerspectiveCamera, Plane,
  PlaneGeometry, Points, Raycaster, Scene, ShaderMaterial, Sphere, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { BONE, CUT, EDGES, EXTERIOR, HIDDEN, INTERIOR, LOOSE, OF_CLASS, placed, range, REGULAR, short, SINGULAR, viridis } from "./colours.js";
import { element as make } from "./dom.js";

const SPHERES = ["points", "balls", "hidden"];
// Where the angle between a facet and the normal blended from those around it has a smaller cosine than this, there is an edge.
const CREASE = 0.25;
// Rounds in which normals are blended, which removes the steps of a grid of samples, as in walpha's pictures.
const ROUNDS = 2;
// Triangles of which neighbours are made to agree, at most: beyond, it takes too long.
const ORIENTED = 200000;
// From where the shape is seen at first.
const HOME = new Vector3(-0.55, -0.75, 0.4);
// Points by which the picture is fitted, at most.
const FITTED = 10000;
// What takes longer than these milliseconds to draw is drawn coarsely while it moves, if it has more triangles than these.
const [SLOW, MANY] = [30, 50000];
// Boxes along the longest side, the points in which become one in a coarse picture.
const COARSE = 64;
// Milliseconds after which it has come to rest.
const REST = 200;

// Points and balls are squares that face the viewer, on which the fragment shader draws a sphere. The radius of a ball is a length,
// that of a point is in pixels.
const VERTEX = `
attribute float radius;
attribute vec3 tint;
uniform bool pixels;
uniform float scale;
varying vec3 colour;
varying vec4 centre;
varying float size;
#include <clipping_planes_pars_vertex>
void main() {
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  size = pixels ? radius * -mvPosition.z / scale : radius;
  colour = tint;
  centre = mvPosition;
  gl_Position = projectionMatrix * mvPosition;
  gl_PointSize = 2.0 * scale * size / -mvPosition.z;
  #include <clipping_planes_vertex>
}`;
const FRAGMENT = `
uniform mat4 projection;
varying vec3 colour;
varying vec4 centre;
varying float size;
#include <clipping_planes_pars_fragment>
void main() {
  #include <clipping_planes_fragment>
  vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
  float rest = 1.0 - dot(at, at);
  if (rest < 0.0) discard;
  vec3 normal = vec3(at, sqrt(rest));
  vec4 place = projection * vec4(centre.xyz + size * normal, 1.0);
  gl_FragDepth = 0.5 + 0.5 * place.z / place.w;
  gl_FragColor = vec4(colour * (0.45 + 0.55 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.5, 0.8))))), 1.0);
  #include <colorspace_fragment>
}`;

// The opacity of a surface through which something is shown.
const FADED = 0.15;
// The colour of what is shown so.
const SHOWN = "#d55e00";
// The ends of the axes of a patient (LPS), and the letters of axes without a known meaning.
const PATIENT = [["L", "R"], ["P", "A"], ["S", "I"]];
const AXES = [["x"], ["y"], ["z"]];
// Pixels that a scale bar is long, about.
const BAR = 110;

// A surface is smooth, but for its edges: there, a fragment has the normal of its facet.
function creased(shader) {
  shader.fragmentShader = shader.fragmentShader.replace("#include <normal_fragment_begin>", `#include <normal_fragment_begin>
    vec3 ofFacet = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));
    float agreement = dot(normal, ofFacet);
    if (abs(agreement) < ${CREASE.toFixed(2)} || !(dot(normal, normal) > 0.5)) normal = ofFacet;
    else if (agreement < 0.0) normal = -normal;`);
}

// Which triangles without an orientation are to be turned, so that neighbours agree: along the smoothest ways first, as walpha's
// pictures do (Hoppe et al. 1992, doi:10.1145/133994.134011). What can be up is.
function turnedAgainst(positions, rows) {
  const count = rows.length / 3;
  const areas = new Float32Array(rows.length);
  const last = new Map();
  const [from, to] = [[], []];
  for (let k = 0; k < count; k++) {
    const corners = [rows[3 * k], rows[3 * k + 1], rows[3 * k + 2]];
    const [a, b, c] = corners.map((v) => 3 * v);
    const u = [0, 1, 2].map((i) => positions[b + i] - positions[a + i]);
    const v = [0, 1, 2].map((i) => positions[c + i] - positions[a + i]);
    areas.set([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], 3 * k);
    for (const [x, y] of [[0, 1], [1, 2], [0, 2]]) {
      const side = Math.min(corners[x], corners[y]) * 2 ** 26 + Math.max(corners[x], corners[y]);
      const other = last.get(side);
      if (other !== undefined) {
        from.push(other);
        to.push(k);
      }
      last.set(side, k);
    }
  }
  const agreement = Float32Array.from(from, (a, way) => {
    const [i, j] = [3 * a, 3 * to[way]];
    const lengths = Math.hypot(...areas.subarray(i, i + 3)) * Math.hypot(...areas.subarray(j, j + 3)) || 1;
    return (areas[i] * areas[j] + areas[i + 1] * areas[j + 1] + areas[i + 2] * areas[j + 2]) / lengths;
  });
  // In steps of a two-hundredth, the smoothest first.
  const steps = Array.from({ length: 201 }, () => []);
  agreement.forEach((value, way) => steps[Math.round(200 * (1 - Math.min(1, Math.abs(value))))].push(way));
  const above = Int32Array.from({ length: count }, (_, k) => k);
  const against = new Uint8Array(count);
  const root = (k) => {
    let turned = 0;
    while (above[k] !== k) {
      const up = above[k];
      against[k] ^= against[up];
      above[k] = above[up];
      turned ^= against[k];
      k = above[k];
    }
    return [k, turned];
  };
  for (const step of steps) {
    for (const way of step) {
      const [[a, ofA], [b, ofB]] = [root(from[way]), root(to[way])];
      if (a === b) continue;
      above[b] = a;
      against[b] = ofA ^ ofB ^ (agreement[way] < 0 ? 1 : 0);
    }
  }
  const up = new Float64Array(count);
  const roots = Array.from({ length: count }, (_, k) => root(k));
  roots.forEach(([at, turned], k) => { up[at] += turned ? -areas[3 * k + 2] : areas[3 * k + 2]; });
  return Uint8Array.from(roots, ([at, turned]) => turned ^ (up[at] < 0 ? 1 : 0));
}

// Normals at points: means of those of the triangles around them, by area, and then of their neighbours. Triangles that are not
// oriented are turned to agree with the first ones.
function smoothNormals(positions, rows, oriented) {
  let normals = new Float32Array(positions.length);
  const turned = oriented || rows.length > 3 * ORIENTED ? null : turnedAgainst(positions, rows);
  const add = (to, v, x, y, z) => {
    to[3 * v] += x;
    to[3 * v + 1] += y;
    to[3 * v + 2] += z;
  };
  for (let row = 0; row < rows.length; row += 3) {
    const [a, b, c] = [3 * rows[row], 3 * rows[row + 1], 3 * rows[row + 2]];
    const [ux, uy, uz] = [positions[b] - positions[a], positions[b + 1] - positions[a + 1], positions[b + 2] - positions[a + 2]];
    const [vx, vy, vz] = [positions[c] - positions[a], positions[c + 1] - positions[a + 1], positions[c + 2] - positions[a + 2]];
    let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    // The ground of a scan is seen from above.
    if (turned ? turned[row / 3] : !oriented && z < 0) [x, y, z] = [-x, -y, -z];
    for (let k = 0; k < 3; k++) add(normals, rows[row + k], x, y, z);
  }
  const unify = () => {
    for (let v = 0; v < normals.length; v += 3) {
      const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
      normals[v] /= length;
      normals[v + 1] /= length;
      normals[v + 2] /= length;
    }
  };
  unify();
  for (let round = 0; round < ROUNDS; round++) {
    const blended = normals.slice();
    for (let row = 0; row < rows.length; row += 3) {
      for (let k = 0; k < 3; k++) {
        const [v, w] = [rows[row + k], rows[row + (k + 1) % 3]];
        const [i, j] = [3 * v, 3 * w];
        // Across an edge normals stay apart.
        const along = normals[i] * normals[j] + normals[i + 1] * normals[j + 1] + normals[i + 2] * normals[j + 2];
        if (along < CREASE) continue;
        add(blended, v, 0.5 * normals[j], 0.5 * normals[j + 1], 0.5 * normals[j + 2]);
        add(blended, w, 0.5 * normals[i], 0.5 * normals[i + 1], 0.5 * normals[i + 2]);
      }
    }
    normals = blended;
    unify();
  }
  return normals;
}

// The eight corners of the box at an origin along three vectors: bit k of their numbers is a step along vector k.
function cornersOf([origin, ...vectors]) {
  const at = (bits) => vectors.reduce((place, vector, k) => (bits >> k & 1 ? place.add(new Vector3(...vector)) : place), new Vector3(...origin));
  return Array.from({ length: 8 }, (_, bits) => at(bits));
}

// Its twelve edges.
function framed(corners) {
  const ends = corners.flatMap((from, bits) => [1, 2, 4].filter((step) => !(bits & step)).flatMap((step) => [from, corners[bits | step]]));
  return new BufferGeometry().setFromPoints(ends);
}

export class ShapeScene {
  constructor(element) {
    this.element = element;
    // Without it everything else works.
    try {
      this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true, stencil: true });
      this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      this.renderer.localClippingEnabled = true;
      element.append(this.renderer.domElement);
    } catch {
      this.renderer = null;
      element.textContent = "This browser has no WebGL, so the shape is not drawn. Numbers, slices and files work as usual.";
    }
    this.labels = make("div", { className: "labels", hidden: true });
    this.length = make("div", { className: "length", hidden: true }, make("span"));
    element.append(this.labels, this.length);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer?.domElement ?? element);
    this.controls.addEventListener("change", () => this.moved());
    // A studio: a sky, a lamp over the viewer's left shoulder, and a weak one at the right that keeps the shadow readable.
    this.scene.add(new AmbientLight(0xffffff, 1.25));
    this.lamps = [[[-0.7, 0.72, 0.5], 2.1], [[0.8, 0.05, 0.6], 0.45]].map(([from, strength]) => {
      const lamp = new DirectionalLight(0xffffff, strength);
      this.scene.add(lamp, lamp.target);
      return { lamp, from: new Vector3(...from) };
    });
    this.plane = new Plane(new Vector3(1, 0, 0), 0);
    this.group = new Group();
    this.scene.add(this.group);
    new ResizeObserver(() => this.resize()).observe(element);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    element.addEventListener("keydown", (event) => this.key(event));
    [this.waiting, this.moving, this.slow, this.turned] = [false, false, false, false];
    this.opacity = 1;
    // A click alone does not turn it.
    let held = false;
    this.controls.addEventListener("start", () => { held = true; });
    this.controls.addEventListener("change", () => { this.turned ||= held; });
    this.controls.addEventListener("end", () => { held = false; });
  }

  // Other points: what was drawn goes. The camera stays where it is to be kept.
  setPoints({ positions, weights, values, differences, atoms, elements, codes, classNames, tints, original, centre, unit, space, cell }, box, keep = false) {
    const before = Object.entries(this.parts ?? {}).map(([name, { visible }]) => [name, visible]);
    this.group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
    this.group.clear();
    this.parts = {};
    [this.classes, this.shades, this.standsFor] = [null, null, null];
    this.corners = cell ? cornersOf(cell) : [];
    this.corners.forEach((corner) => box.expandByPoint(corner));
    this.box = box;
    const heights = () => Float32Array.from({ length: positions.length / 3 }, (_, v) => positions[3 * v + 2]);
    this.data = { positions, centre, weights, values, differences, heights, tints, kinds: { element: { numbers: atoms, known: elements }, asprs: { numbers: codes, known: classNames } } };
    this.setAxes(space === "LPS" ? PATIENT : AXES);
    this.weightRange = range(weights);
    this.position = new BufferAttribute(positions, 3);
    this.colour = new BufferAttribute(new Float32Array(positions.length), 3);
    const surface = (colour) => {
      const material = new MeshLambertMaterial({ color: colour, side: DoubleSide });
      material.onBeforeCompile = creased;
      return material;
    };
    const add = (name, Kind, material, attributes = {}) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", attributes.position ?? this.position);
      geometry.setAttribute("color", attributes.color ?? this.colour);
      geometry.boundingSphere = box.getBoundingSphere(new Sphere());
      this.parts[name] = new Kind(geometry, material);
      // Only what is in view is drawn anyway: there is one shape.
      this.parts[name].frustumCulled = false;
      this.group.add(this.parts[name]);
    };
    add("regular", Mesh, surface(OF_CLASS[REGULAR]));
    add("singular", Mesh, surface(OF_CLASS[SINGULAR]));
    add("edges", LineSegments, new LineBasicMaterial({ color: EDGES }));
    const spheres = () => new ShaderMaterial({
      uniforms: { pixels: { value: false }, scale: { value: 1 }, projection: { value: this.camera.projectionMatrix } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, clipping: true,
    });
    for (const name of SPHERES) {
      add(name, Points, spheres());
      this.parts[name].visible = false;
      this.parts[name].material.uniforms.pixels.value = name !== "balls";
    }
    // Hidden points lie within the shape as a rule, and are to be seen all the same.
    this.parts.hidden.material.depthTest = false;
    this.parts.hidden.renderOrder = 1;
    this.section = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, vertexColors: true }));
    this.section.frustumCulled = false;
    // Where the cells are not known, a plane stands for what is cut of them: it is within the solid where an odd number of facets
    // lies behind it, which the stencil counts before anything else is drawn.
    this.counted = new Mesh(this.parts.regular.geometry, new MeshBasicMaterial({
      side: DoubleSide, colorWrite: false, depthWrite: false, depthTest: false, stencilWrite: true, stencilZPass: InvertStencilOp,
    }));
    this.cap = new Mesh(new PlaneGeometry(), new MeshBasicMaterial({ side: DoubleSide, stencilWrite: true, stencilFunc: NotEqualStencilFunc }));
    [this.counted, this.cap].forEach((part, k) => Object.assign(part, { visible: false, frustumCulled: false, renderOrder: k - 2 }));
    this.lit = new Box3Helper(new Box3(), new Color(SHOWN));
    this.lit.visible = false;
    // Triangles within the surface, and lines: what a list or a diagram points at, and a length that is measured.
    this.inner = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ color: SHOWN, side: DoubleSide, flatShading: true }));
    this.inner.frustumCulled = false;
    const wide = (color) => {
      const line = new LineSegments2(new LineSegmentsGeometry(), new LineMaterial({ color, linewidth: 3, depthTest: false }));
      Object.assign(line, { visible: false, frustumCulled: false, renderOrder: 2 });
      return line;
    };
    [this.walk, this.ruler] = [wide(SHOWN), wide("#d6006c")];
    this.ends = [];
    this.length.hidden = true;
    // A surface to compare with, the same at every α.
    add("original", Mesh, new MeshLambertMaterial({ color: "#bebebe", flatShading: true, side: DoubleSide, transparent: true, opacity: 0.5, depthWrite: false }),
      { position: new BufferAttribute(original?.positions ?? new Float32Array(), 3) });
    this.parts.original.geometry.setIndex(new BufferAttribute(original?.triangles ?? new Uint32Array(), 1));
    this.parts.original.visible = false;
    // The box of what is drawn, or the one that repeats.
    const frame = new Color("#888888");
    this.parts.box = cell ? new LineSegments(framed(this.corners), new LineBasicMaterial({ color: frame })) : new Box3Helper(box, frame);
    this.parts.box.visible = false;
    this.labels.replaceChildren(...["x", "y", "z"].map((axis, k) => {
      const [low, high] = [box.min, box.max].map((corner) => placed(corner[axis] + centre[k], box.max[axis] - box.min[axis]));
      return make("span", { textContent: `${axis}: ${low} to ${high} ${unit}` });
    }));
    this.group.add(this.counted, this.cap, this.section, this.lit, this.inner, this.walk, this.ruler, this.parts.box);
    [this.unit, this.isPeriodic] = [unit, Boolean(cell)];
    this.fade(this.opacity);
    if (keep) {
      for (const [name, visible] of before) this.parts[name].visible = visible;
      return;
    }
    this.turned = false;
    this.resize();
  }

  // The simplices at an α.
  setShape({ regular, singular, edges, classes }, alpha) {
    for (const [name, rows] of Object.entries({ regular, singular, edges })) {
      const part = this.parts[name];
      part.geometry.setIndex(part.whole = new BufferAttribute(rows, 1));
      part.coarse = null;
      if (name !== "edges") {
        const normals = smoothNormals(this.data.positions, rows, name === "regular");
        part.geometry.setAttribute("normal", new BufferAttribute(normals, 3));
      }
    }
    // The surface of a scan is of one material, whether it has cells here and there or not.
    const isSheet = 2 * singular.length > regular.length;
    if (isSheet !== this.isSheet) {
      this.isSheet = isSheet;
      this.paint();
    }
    // Whether it is slow is found out by drawing it a second time: at first, programs and arrays go to the graphics card.
    this.slow = regular.length + singular.length > 3 * MANY ? "at first" : false;
    this.classes = classes;
    this.alpha = alpha;
    this.stale = new Set(SPHERES);
    this.refill();
    this.draw();
  }

  // Spheres are laid out when they are shown.
  refill() {
    const { positions, weights } = this.data;
    const chosen = {
      points: (v) => this.classes[v] !== HIDDEN && this.classes[v] !== EXTERIOR,
      balls: (v) => this.alpha + weights[v] > 0 && this.alpha < Infinity,
      hidden: (v) => this.classes[v] === HIDDEN,
    };
    const [least, most] = this.weightRange;
    // In pixels, with the weight as the area: diameters from 2 to 9.
    const dot = (weight) => (most > least ? 1 + 3.5 * Math.sqrt((weight - least) / (most - least)) : 2.5);
    for (const name of this.stale) {
      const part = this.parts[name];
      if (!part.visible) continue;
      this.stale.delete(name);
      const rows = [];
      for (let v = 0; v < weights.length; v++) if (chosen[name](v)) rows.push(v);
      const [at, radius, tint] = [new Float32Array(3 * rows.length), new Float32Array(rows.length), new Float32Array(3 * rows.length)];
      const colours = OF_CLASS.map((colour) => new Color(colour));
      rows.forEach((v, k) => {
        at.set(positions.subarray(3 * v, 3 * v + 3), 3 * k);
        radius[k] = name === "balls" ? Math.sqrt(this.alpha + weights[v]) : dot(weights[v]);
        if (this.isTinted) tint.set(this.colour.array.subarray(3 * v, 3 * v + 3), 3 * k);
        else colours[this.classes[v]].toArray(tint, 3 * k);
      });
      part.geometry.setAttribute("position", new BufferAttribute(at, 3));
      part.geometry.setAttribute("radius", new BufferAttribute(radius, 1));
      part.geometry.setAttribute("tint", new BufferAttribute(tint, 3));
      part.geometry.deleteAttribute("color");
    }
  }

  // Colours of the material, by class, or by numbers of the points.
  setColour(by) {
    const { centre, values, weights, differences, heights, tints, kinds } = this.data;
    const scale = by === "height" ? heights() : { value: values, weight: weights, difference: differences }[by];
    this.plain = by === "plain";
    const kind = kinds[by];
    this.isTinted = Boolean(scale || kind) || by === "rgb";
    const [low, high] = scale ? range(scale) : [0, 0];
    // Heights are relative to the centre, so that single precision tells them apart, and told in the coordinates of the input.
    this.scale = scale && [low, high].map((number) => number + (by === "height" ? centre[2] : 0));
    this.valueScale = by === "value" ? this.scale : null;
    if (scale) {
      const colour = new Color();
      scale.forEach((number, v) => {
        colour.setRGB(...viridis(high > low ? (number - low) / (high - low) : 0.5), "srgb");
        colour.toArray(this.colour.array, 3 * v);
      });
      this.colour.needsUpdate = true;
    }
    const colourOf = ([r, g, b]) => new Color().setRGB(r / 255, g / 255, b / 255, "srgb");
    if (kind) {
      const colours = Object.fromEntries(Object.entries(kind.known).map(([number, { colour }]) => [number, colourOf(colour)]));
      const unknown = new Color(BONE);
      kind.numbers.forEach((number, v) => (colours[number] ?? unknown).toArray(this.colour.array, 3 * v));
      this.colour.needsUpdate = true;
    }
    if (by === "rgb") {
      for (let v = 0; v < tints.length; v += 3) colourOf(tints.subarray(v, v + 3)).toArray(this.colour.array, v);
      this.colour.needsUpdate = true;
    }
    this.paint();
    this.paintSection();
    if (this.classes) {
      this.stale = new Set(SPHERES);
      this.refill();
    }
    this.draw();
  }

  // The colours of the material, or of classes.
  paint() {
    const colours = this.plain ? [BONE, this.isSheet ? BONE : LOOSE, LOOSE] : [OF_CLASS[REGULAR], OF_CLASS[SINGULAR], EDGES];
    for (const [k, name] of ["regular", "singular", "edges"].entries()) {
      const colour = colours[k];
      const { material } = this.parts[name];
      material.vertexColors = this.isTinted;
      material.color.set(this.isTinted ? "#ffffff" : colour);
      material.needsUpdate = true;
    }
  }

  show(name, visible) {
    const isOther = this.parts[name].visible !== visible;
    this.parts[name].visible = visible;
    if (name === "balls" && isOther && !this.turned) this.home();
    if (this.classes) this.refill();
    this.draw();
  }

  // Cuts everything open: what lies on the viewer's side of the place along the axis is not drawn.
  setCut(axis, place) {
    this.cut = axis === null ? null : { axis, place };
    const cut = this.cut ? [this.plane] : [];
    for (const [name, part] of Object.entries(this.parts)) if (name !== "box") part.material.clippingPlanes = cut;
    if (axis === null) {
      this.setSection({ corners: new Float32Array(), shades: new Float32Array() });
      this.capped = false;
    }
    this.draw();
  }

  // Fills the cut without knowing its cells. The boundary of a periodic box is not closed.
  setCap() {
    this.capped = !this.isPeriodic;
    this.counted.material.clippingPlanes = [this.plane];
    const { axis, place } = this.cut;
    const size = this.box.getSize(new Vector3());
    this.cap.scale.setScalar(2 * Math.max(size.x, size.y, size.z));
    this.box.getCenter(this.cap.position).setComponent(axis, place);
    this.cap.rotation.set(axis === 1 ? Math.PI / 2 : 0, axis === 0 ? Math.PI / 2 : 0, 0);
    this.draw();
  }

  // The cut cells.
  setSection({ corners, shades }) {
    this.shades = shades;
    this.section.geometry.dispose();
    this.section.geometry = new BufferGeometry();
    this.section.geometry.setAttribute("position", new BufferAttribute(corners, 3));
    this.paintSection();
    this.draw();
  }

  paintSection() {
    if (!this.shades) return;
    const { values } = this.data;
    const [low, high] = this.scale && values && this.scale === this.valueScale ? range(values) : [0, 0];
    const plain = new Color(this.plain || this.isTinted ? CUT : OF_CLASS[INTERIOR]);
    const colours = new Float32Array(3 * this.shades.length);
    const colour = new Color();
    this.shades.forEach((shade, k) => {
      if (high > low) colour.setRGB(...viridis((shade - low) / (high - low)), "srgb");
      else colour.copy(plain);
      colour.toArray(colours, 3 * k);
    });
    this.section.geometry.setAttribute("color", new BufferAttribute(colours, 3));
  }

  // What is pointed at in a list, or nothing: its triangles, by the indices of points or of positions of its own, or a box around it where these are
  // not known.
  light(hole) {
    this.lit.visible = Boolean(hole && !hole.facets);
    if (this.lit.visible) this.lit.box.set(new Vector3(...hole.low), new Vector3(...hole.high));
    const positions = hole?.positions ?? this.data.positions;
    const places = new Float32Array(3 * (hole?.facets?.length ?? 0));
    hole?.facets?.forEach((v, k) => places.set(positions.subarray(3 * v, 3 * v + 3), 3 * k));
    this.setInner(places);
    this.walk.visible = false;
    // What lies within is seen through the surface.
    this.seeThrough(Boolean(hole));
  }

  // The cycle of a persistence pair, or nothing: the places along a closed walk, or the corners of triangles.
  setCycle(cycle) {
    this.lit.visible = false;
    this.setInner(cycle?.isWalk ? new Float32Array() : cycle?.places ?? new Float32Array());
    this.walk.visible = Boolean(cycle?.isWalk);
    if (cycle?.isWalk) this.setLine(this.walk, cycle.places);
    this.seeThrough(Boolean(cycle));
  }

  setInner(places) {
    this.inner.geometry.dispose();
    this.inner.geometry = new BufferGeometry();
    this.inner.geometry.setAttribute("position", new BufferAttribute(places, 3));
  }

  // A line along places.
  setLine(line, places) {
    const ends = [];
    for (let at = 0; at + 5 < places.length; at += 3) ends.push(...places.subarray(at, at + 6));
    line.geometry.dispose();
    line.geometry = new LineSegmentsGeometry();
    line.geometry.setPositions(ends);
  }

  seeThrough(isInner) {
    this.fade(isInner ? Math.min(this.opacity, FADED) : this.opacity);
    this.draw();
  }

  // Brings a box to the middle, as large as it can be seen with what is around it.
  zoomTo(low, high) {
    const sphere = new Box3(new Vector3(...low), new Vector3(...high)).getBoundingSphere(new Sphere());
    const arm = this.camera.position.clone().sub(this.controls.target);
    const distance = 3 * sphere.radius / Math.tan(Math.PI / 360 * this.camera.fov);
    this.turned = true;
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).add(arm.setLength(Math.min(arm.length(), distance)));
    this.camera.near = Math.min(this.camera.near, distance / 500);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  // Measures from place to place on the surface; a third place begins anew. Returns the length, when there is one.
  measureAt(event) {
    const hit = this.hit(event);
    if (!hit) return null;
    if (this.ends.length === 2) this.ends = [];
    this.ends.push(hit.point.clone());
    const [a, b] = [this.ends[0], this.ends.at(-1)];
    this.setLine(this.ruler, new Float32Array([...a, ...b]));
    this.ruler.visible = true;
    this.draw();
    return this.ends.length === 2 ? a.distanceTo(b) : null;
  }

  endMeasuring() {
    this.ends = [];
    if (this.ruler) this.ruler.visible = false;
    this.draw();
  }

  // The length, beside the middle of its line; and its first end, before there is a second.
  labelLength() {
    this.length.hidden = this.ends.length === 0;
    if (this.length.hidden) return;
    const [a, b] = [this.ends[0], this.ends.at(-1)];
    const at = a.clone().lerp(b, 0.5).project(this.camera);
    const label = this.length.firstChild;
    label.textContent = this.ends.length === 2 ? `${short(a.distanceTo(b))} ${this.unit}` : "+";
    Object.assign(label.style, { left: `${50 + 50 * at.x}%`, top: `${50 - 50 * at.y}%` });
  }

  // The letters at the ends of the axes, in a corner of the picture.
  setAxes(letters) {
    if (!this.axes) return;
    const drawn = (name, properties) => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(properties)) made.setAttribute(key, value);
      return made;
    };
    this.letters = letters.flatMap((ends, axis) => ends.map((letter, end) => {
      const text = drawn("text", { "text-anchor": "middle", dy: "0.35em" });
      text.textContent = letter;
      return { axis, sign: end === 0 ? 1 : -1, text, line: drawn("line", { x1: 0, y1: 0 }) };
    }));
    this.axes.replaceChildren(...this.letters.map(({ line }) => line), ...this.letters.map(({ text }) => text));
  }

  turnAxes() {
    const back = this.camera.quaternion.clone().invert();
    for (const { axis, sign, text, line } of this.letters ?? []) {
      const { x, y, z } = new Vector3().setComponent(axis, sign).applyQuaternion(back);
      line.setAttribute("x2", 28 * x);
      line.setAttribute("y2", -28 * y);
      text.setAttribute("x", 38 * x);
      text.setAttribute("y", -38 * y);
      // What points away is thinner.
      for (const part of [text, line]) part.setAttribute("class", z < -0.05 ? "far" : "near");
      // An axis along the view is a point, whose letters would hide each other.
      text.style.display = z < -0.95 ? "none" : "";
    }
  }

  // How opaque the surface is, from 0 to 1.
  setOpacity(opacity) {
    this.opacity = opacity;
    this.fade(opacity);
    this.draw();
  }

  fade(opacity) {
    for (const name of ["regular", "singular"]) {
      const { material } = this.parts[name];
      Object.assign(material, { opacity, transparent: opacity < 1, depthWrite: opacity === 1 });
      material.needsUpdate = true;
    }
  }

  // The point of the shape at a place on the screen, if there is one: the dot or the ball there, where these are drawn, or the nearest
  // corner.
  pick(event) {
    const rectangle = this.element.getBoundingClientRect();
    return this.dotAt(event.clientX - rectangle.left, event.clientY - rectangle.top) ?? this.ballAt(event) ?? this.cornerAt(event);
  }

  // Of the dots within five pixels the one in front.
  dotAt(x, y) {
    if (!this.parts.points.visible) return null;
    const { clientWidth: width, clientHeight: height } = this.element;
    const at = new Vector3();
    let [found, depth] = [null, 1];
    for (let v = 0; v < this.position.count; v++) {
      if (this.classes[v] === HIDDEN || this.classes[v] === EXTERIOR) continue;
      at.fromBufferAttribute(this.position, v).project(this.camera);
      const distance = Math.hypot((1 + at.x) / 2 * width - x, (1 - at.y) / 2 * height - y);
      if (distance < 5 && at.z < depth) [found, depth] = [v, at.z];
    }
    return found;
  }

  // The ray from the viewer through a place on the screen.
  rayTo(event) {
    const rectangle = this.element.getBoundingClientRect();
    const at = new Vector2(
      2 * (event.clientX - rectangle.left) / rectangle.width - 1,
      1 - 2 * (event.clientY - rectangle.top) / rectangle.height,
    );
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray;
  }

  // The ball that is in front at a place on the screen, where balls are drawn.
  ballAt(event) {
    if (!this.parts.balls.visible) return null;
    const { ray } = this.rayTo(event);
    const arm = new Vector3();
    let [found, least] = [null, Infinity];
    for (let v = 0; v < this.position.count; v++) {
      const squared = this.alpha + this.data.weights[v];
      if (!(squared > 0)) continue;
      arm.fromBufferAttribute(this.position, v).sub(ray.origin);
      const along = arm.dot(ray.direction);
      const inside = squared - arm.lengthSq() + along * along;
      if (inside < 0) continue;
      const distance = along - Math.sqrt(inside);
      if (distance > 0 && distance < least) [found, least] = [v, distance];
    }
    return found;
  }

  // Where the surface is met at a place on the screen; of a ball the centre.
  hit(event) {
    const ball = this.ballAt(event);
    if (ball !== null) return { point: new Vector3().fromBufferAttribute(this.position, ball) };
    const ray = this.rayTo(event);
    const visible = (hit) => !this.parts.regular.material.clippingPlanes?.some((plane) => plane.distanceToPoint(hit.point) < 0);
    const drawn = [this.parts.regular, this.parts.singular].filter((part) => part.visible);
    return ray.intersectObjects(drawn).find(visible) ?? null;
  }

  cornerAt(event) {
    const hit = this.hit(event);
    if (!hit) return null;
    const corner = new Vector3();
    const distance = (v) => corner.fromBufferAttribute(this.position, v).distanceTo(hit.point);
    return [hit.face.a, hit.face.b, hit.face.c].reduce((near, v) => (distance(v) < distance(near) ? v : near));
  }

  // A bar of a round length, as long as that is at the middle of the shape.
  measureBar() {
    const bar = this.bar;
    if (!bar || !this.box) return;
    const distance = this.camera.position.distanceTo(this.controls.target);
    const pixel = 2 * distance * Math.tan(Math.PI / 360 * this.camera.fov) / this.element.clientHeight;
    const power = 10 ** Math.floor(Math.log10(BAR * pixel));
    const length = power * [5, 2, 1].find((digit) => digit * power <= BAR * pixel);
    if (!Number.isFinite(length)) return;
    bar.style.width = `${length / pixel}px`;
    bar.textContent = `${short(length)} ${this.unit}`;
  }

  // Writes what the box measures beside three of its edges that the viewer sees, within the picture.
  label() {
    this.labels.hidden = !this.parts?.box.visible || this.isPeriodic;
    if (this.labels.hidden) return;
    const { min, max } = this.box;
    const { position } = this.camera;
    const middle = this.box.getCenter(new Vector3());
    const near = (axis) => (position[axis] > middle[axis] ? max : min)[axis];
    const far = (axis) => (position[axis] > middle[axis] ? min : max)[axis];
    const places = [[middle.x, near("y"), min.z], [near("x"), middle.y, min.z], [near("x"), far("y"), middle.z]];
    places.forEach((place, k) => {
      const at = new Vector3(...place).project(this.camera);
      Object.assign(this.labels.children[k].style, { left: `clamp(5rem, ${50 + 50 * at.x}%, 100% - 5rem)`, top: `clamp(1rem, ${50 - 50 * at.y}%, 100% - 1rem)` });
    });
  }

  // The radius of the largest ball that is drawn.
  largestBall() {
    return this.parts.balls.visible ? Math.sqrt(Math.max(0, this.alpha + this.weightRange[1])) || 0 : 0;
  }

  // From how far all of it is just seen, as the height of the picture allows and as its width does, and the place to look at: for
  // a few thousand of the points.
  fit(width, height) {
    const { positions } = this.data;
    const middle = this.box.getCenter(new Vector3());
    const towards = HOME.clone().normalize();
    const right = new Vector3(0, 0, 1).cross(towards).normalize();
    const up = towards.clone().cross(right);
    const tangent = Math.tan(Math.PI / 360 * this.camera.fov) / 1.06;
    // Where d is the distance, o the place to look at and z the depth, |x - o| is at most (d - z) times the tangent.
    const axes = [{ axis: up, tangent }, { axis: right, tangent: tangent * width / height }];
    const place = new Vector3();
    const step = Math.ceil(positions.length / 3 / FITTED);
    for (const one of axes) {
      let [least, most] = [Infinity, -Infinity];
      const see = () => {
        place.sub(middle);
        const [along, depth] = [place.dot(one.axis), one.tangent * place.dot(towards)];
        least = Math.min(least, along - depth);
        most = Math.max(most, along + depth);
      };
      for (let v = 0; v < positions.length / 3; v += step) see(place.fromArray(positions, 3 * v));
      for (const corner of this.corners) see(place.copy(corner));
      // Balls reach beyond their centres, seen from aside.
      const beyond = this.largestBall() * Math.hypot(1, one.tangent);
      one.distance = ((most - least) / 2 + beyond) / one.tangent;
      middle.addScaledVector(one.axis, (most + least) / 2);
    }
    return { upright: axes[0].distance, across: axes[1].distance, middle };
  }

  // From where it is seen, and towards where, relative to the box.
  seenFrom() {
    return { from: this.camera.position.toArray(), to: this.controls.target.toArray(), turned: this.turned };
  }

  look({ from, to, turned }) {
    this.turned = turned;
    if (!turned) return;
    this.camera.position.fromArray(from);
    this.controls.target.fromArray(to);
    this.controls.update();
    this.draw();
  }

  // All of it, from the front and a little above.
  home() {
    this.turned = false;
    const { clientWidth: width, clientHeight: height } = this.element;
    // Points may all be one, or lie behind each other, and there may be none.
    const radius = this.box.getBoundingSphere(new Sphere()).radius || 1;
    let [distance, center] = [3 * radius, this.box.getCenter(new Vector3())];
    if (this.position.count > 0) {
      const { upright, across, middle } = this.fit(width || 1, height || 1);
      [distance, center] = [Math.max(upright, across, 1.2 * radius), middle];
    }
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(HOME.clone().setLength(distance));
    this.camera.near = distance / 500;
    this.camera.far = distance + 50 * radius;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  key(event) {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { "+": 0.9, "-": 1 / 0.9 }[event.key];
    if (!turns && !zoom && event.key !== "Home") return;
    event.preventDefault();
    if (event.key === "Home") return this.home();
    this.turned = true;
    const arm = this.camera.position.clone().sub(this.controls.target);
    if (zoom) arm.multiplyScalar(zoom);
    else {
      const [turn, tilt] = turns.map((step) => step * Math.PI / 24);
      arm.applyAxisAngle(new Vector3(0, 0, 1), turn);
      const height = Math.acos(arm.z / arm.length());
      const lifted = Math.min(Math.PI - 0.05, Math.max(0.05, height + tilt));
      arm.applyAxisAngle(new Vector3(0, 0, 1).cross(arm).normalize(), lifted - height);
    }
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.draw();
  }

  // The picture fills its place. Until somebody turns it, all of the shape is in view.
  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer?.setSize(width, height);
    if (this.box && !this.turned) this.home();
    this.draw();
  }

  // The view has changed, and may go on to.
  moved() {
    if (!this.renderer) return;
    clearTimeout(this.timer);
    this.moving = true;
    document.body.dataset.moving = "";
    this.draw();
  }

  rest() {
    clearTimeout(this.timer);
    this.moving = false;
    delete document.body.dataset.moving;
    this.draw();
  }

  // Triangles between the first points in each of a grid of boxes, without those that have collapsed.
  coarse(rows) {
    const { positions } = this.data;
    const { min, max } = this.box;
    const side = Math.max(max.x - min.x, max.y - min.y, max.z - min.z) / COARSE || 1;
    const first = new Map();
    this.standsFor ??= Uint32Array.from({ length: positions.length / 3 }, (_, v) => {
      const [x, y, z] = [0, 1, 2].map((k) => Math.floor((positions[3 * v + k] - min.getComponent(k)) / side));
      const box = (z * (COARSE + 1) + y) * (COARSE + 1) + x;
      if (!first.has(box)) first.set(box, v);
      return first.get(box);
    });
    const kept = [];
    for (let row = 0; row < rows.length; row += 3) {
      const [a, b, c] = [this.standsFor[rows[row]], this.standsFor[rows[row + 1]], this.standsFor[rows[row + 2]]];
      if (a !== b && b !== c && c !== a) kept.push(a, b, c);
    }
    return new Uint32Array(kept);
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  drawNow() {
    if (!this.renderer) return;
    const started = performance.now();
    this.renderer.setClearColor(getComputedStyle(document.body).backgroundColor);
    if (this.cut) {
      const { axis, place } = this.cut;
      const near = this.camera.position.getComponent(axis) > this.controls.target.getComponent(axis);
      this.plane.set(new Vector3().setComponent(axis, near ? -1 : 1), near ? place : -place);
    }
    // The lamps move with the viewer.
    for (const { lamp, from } of this.lamps) {
      lamp.target.position.copy(this.controls.target);
      lamp.position.copy(from).applyQuaternion(this.camera.quaternion).add(this.controls.target);
    }
    const pixels = this.renderer.getDrawingBufferSize(new Vector2()).y;
    for (const name of SPHERES) {
      const part = this.parts?.[name];
      if (part) part.material.uniforms.scale.value = pixels / 2 / Math.tan(Math.PI / 360 * this.camera.fov);
    }
    const isCoarse = this.slow === true && this.moving;
    // A coarse surface has holes.
    for (const part of [this.counted, this.cap]) if (part) part.visible = Boolean(this.cut && this.capped) && !isCoarse;
    this.cap?.material.color.set(this.plain || this.isTinted ? CUT : OF_CLASS[INTERIOR]);
    if (typeof this.slow === "boolean") {
      for (const name of ["regular", "singular"]) {
        const part = this.parts?.[name];
        if (!part?.whole) continue;
        if (isCoarse) part.coarse ??= new BufferAttribute(this.coarse(part.whole.array), 1);
        part.geometry.setIndex(isCoarse ? part.coarse : part.whole);
      }
    }
    this.renderer.render(this.scene, this.camera);
    if (this.slow === "at first") {
      this.slow = "once more";
    } else if (this.slow === "once more") {
      this.measure(started);
    }
    this.label();
    this.labelLength();
    this.turnAxes();
    this.measureBar();
    if (this.moving) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.rest(), REST);
    }
    document.body.dataset.drawn = isCoarse ? "coarse" : "whole";
    if (isCoarse) document.body.dataset.coarse = "";
    // As long as the browser lets it be known, which is not all that a frame takes.
    document.body.dataset.frame = (performance.now() - started).toFixed(1);
  }

  // Finds out how long this picture takes, without waiting for it.
  measure(started) {
    const context = this.renderer.getContext();
    const drawn = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
    context.flush();
    const measuring = this.slow = {};
    const ask = () => {
      // Another shape is measured by now.
      if (this.slow !== measuring) return context.deleteSync(drawn);
      if (context.clientWaitSync(drawn, 0, 0) === context.TIMEOUT_EXPIRED) return setTimeout(ask, 5);
      context.deleteSync(drawn);
      this.slow = performance.now() - started > SLOW;
      document.body.dataset.slow = this.slow;
      return undefined;
    };
    setTimeout(ask, 5);
  }

  async png() {
    this.rest();
    this.drawNow();
    if (!this.renderer) throw new Error("this browser has no WebGL, so there is no picture");
    return new Promise((resolve) => this.renderer.domElement.toBlob(resolve, "image/png"));
  }
}
