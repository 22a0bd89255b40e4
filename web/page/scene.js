// The shape in three dimensions. Drawn when something changes, not all the time.

import {
  AmbientLight, Box3, Box3Helper, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, LineBasicMaterial,
  LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Plane, Points, Raycaster, Scene, ShaderMaterial,
  Sphere, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { EDGES, OF_CLASS, range, viridis } from "./colours.js";

const [EXTERIOR, SINGULAR, REGULAR, INTERIOR, HIDDEN] = [0, 1, 2, 3, 4];

// Points and balls are squares that face the viewer, on which the fragment shader draws a sphere: of the ball's own radius, or
// of a radius on the screen.
const VERTEX = `
attribute float radius;
attribute vec3 tint;
uniform float pixels;
uniform float scale;
varying vec3 colour;
varying vec4 centre;
varying float size;
#include <clipping_planes_pars_vertex>
void main() {
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  size = pixels > 0.0 ? pixels * -mvPosition.z / scale : radius;
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

export class ShapeScene {
  constructor(element) {
    this.element = element;
    // Without it everything else works.
    try {
      this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
      this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      this.renderer.localClippingEnabled = true;
      element.append(this.renderer.domElement);
    } catch {
      this.renderer = null;
      element.textContent = "This browser has no WebGL, so the shape is not drawn. Numbers, slices and files work as usual.";
    }
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer?.domElement ?? element);
    this.controls.addEventListener("change", () => this.draw());
    this.scene.add(new AmbientLight(0xffffff, 1.3));
    this.lamp = new DirectionalLight(0xffffff, 2.2);
    this.scene.add(this.lamp, this.lamp.target);
    this.plane = new Plane(new Vector3(1, 0, 0), 0);
    this.group = new Group();
    this.scene.add(this.group);
    new ResizeObserver(() => this.resize()).observe(element);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    element.addEventListener("keydown", (event) => this.key(event));
    this.waiting = false;
  }

  // Other points: what was drawn goes.
  setPoints({ positions, weights, values }, box) {
    this.group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
    this.group.clear();
    this.parts = {};
    [this.classes, this.shades] = [null, null];
    this.box = box;
    this.data = { positions, weights, values };
    this.position = new BufferAttribute(positions, 3);
    this.colour = new BufferAttribute(new Float32Array(positions.length), 3);
    const surface = (colour) => new MeshLambertMaterial({ color: colour, flatShading: true, side: DoubleSide });
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
      uniforms: { pixels: { value: 0 }, scale: { value: 1 }, projection: { value: this.camera.projectionMatrix } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, clipping: true,
    });
    for (const name of ["points", "balls", "hidden"]) {
      add(name, Points, spheres());
      this.parts[name].visible = false;
    }
    // Hidden points lie within the shape as a rule, and are to be seen all the same.
    this.parts.hidden.material.depthTest = false;
    this.parts.hidden.renderOrder = 1;
    this.section = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, vertexColors: true }));
    this.section.frustumCulled = false;
    this.lit = new Box3Helper(new Box3(), new Color("#d55e00"));
    this.lit.visible = false;
    this.group.add(this.section, this.lit);
    this.home();
  }

  // The simplices at an α.
  setShape({ regular, singular, edges, classes }, alpha) {
    const index = (name, rows) => this.parts[name].geometry.setIndex(new BufferAttribute(rows, 1));
    index("regular", regular);
    index("singular", singular);
    index("edges", edges);
    this.classes = classes;
    this.alpha = alpha;
    this.stale = new Set(["points", "balls", "hidden"]);
    this.refill();
    this.draw();
  }

  // Spheres are laid out when they are shown.
  refill() {
    const { positions, weights } = this.data;
    const chosen = {
      points: (v) => this.classes[v] !== HIDDEN && this.classes[v] !== EXTERIOR,
      balls: (v) => this.alpha + weights[v] > 0,
      hidden: (v) => this.classes[v] === HIDDEN,
    };
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
        radius[k] = Math.sqrt(Math.max(0, this.alpha + weights[v]));
        if (this.scale) tint.set(this.colour.array.subarray(3 * v, 3 * v + 3), 3 * k);
        else colours[this.classes[v]].toArray(tint, 3 * k);
      });
      part.geometry.setAttribute("position", new BufferAttribute(at, 3));
      part.geometry.setAttribute("radius", new BufferAttribute(radius, 1));
      part.geometry.setAttribute("tint", new BufferAttribute(tint, 3));
      part.geometry.deleteAttribute("color");
      part.material.uniforms.pixels.value = name === "balls" ? 0 : 2.5;
    }
  }

  // Colours by class, or by values or weights; returns the range of the scale.
  setColour(by) {
    const scale = { value: this.data.values, weight: this.data.weights }[by];
    this.scale = scale && range(scale);
    if (scale) {
      const [low, high] = this.scale;
      const colour = new Color();
      scale.forEach((number, v) => {
        colour.setRGB(...viridis(high > low ? (number - low) / (high - low) : 0.5), "srgb");
        colour.toArray(this.colour.array, 3 * v);
      });
      this.colour.needsUpdate = true;
    }
    for (const [name, colour] of [["regular", OF_CLASS[REGULAR]], ["singular", OF_CLASS[SINGULAR]], ["edges", EDGES]]) {
      const { material } = this.parts[name];
      material.vertexColors = scale !== undefined;
      material.color.set(scale ? "#ffffff" : colour);
      material.needsUpdate = true;
    }
    this.paintSection();
    if (this.classes) {
      this.stale = new Set(["points", "balls", "hidden"]);
      this.refill();
    }
    this.draw();
    return this.scale;
  }

  show(name, visible) {
    this.parts[name].visible = visible;
    if (this.classes) this.refill();
    this.draw();
  }

  // Cuts everything open: what lies on the viewer's side of the place along the axis is not drawn.
  setCut(axis, place) {
    this.cut = axis === null ? null : { axis, place };
    const cut = this.cut ? [this.plane] : [];
    for (const part of Object.values(this.parts)) part.material.clippingPlanes = cut;
    if (axis === null) this.setSection({ corners: new Float32Array(), shades: new Float32Array() });
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
    const [low, high] = this.scale && values ? range(values) : [0, 0];
    const plain = new Color(OF_CLASS[INTERIOR]);
    const colours = new Float32Array(3 * this.shades.length);
    const colour = new Color();
    this.shades.forEach((shade, k) => {
      if (high > low) colour.setRGB(...viridis((shade - low) / (high - low)), "srgb");
      else colour.copy(plain);
      colour.toArray(colours, 3 * k);
    });
    this.section.geometry.setAttribute("color", new BufferAttribute(colours, 3));
  }

  // A box around what is pointed at in a list, or nothing.
  light(low, high) {
    this.lit.visible = low !== undefined;
    if (low) this.lit.box.set(new Vector3(...low), new Vector3(...high));
    this.draw();
  }

  // The point of the shape at a place on the screen, if there is one.
  pick(event) {
    const rectangle = this.element.getBoundingClientRect();
    const at = new Vector2(
      2 * (event.clientX - rectangle.left) / rectangle.width - 1,
      1 - 2 * (event.clientY - rectangle.top) / rectangle.height,
    );
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const visible = (hit) => !this.parts.regular.material.clippingPlanes?.some((plane) => plane.distanceToPoint(hit.point) < 0);
    const [hit] = ray.intersectObjects([this.parts.regular, this.parts.singular]).filter(visible);
    if (!hit) return null;
    const corner = new Vector3();
    const distance = (v) => corner.fromBufferAttribute(this.position, v).distanceTo(hit.point);
    return [hit.face.a, hit.face.b, hit.face.c].reduce((near, v) => (distance(v) < distance(near) ? v : near));
  }

  // All of it, from the front and a little above.
  home() {
    const { center, radius: own } = this.box.getBoundingSphere(new Sphere());
    // Points may all be one.
    const radius = own || 1;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = 1.05 * radius / Math.sin(Math.PI / 360 * this.camera.fov) / narrow;
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new Vector3(-0.55, -0.75, 0.4).setLength(distance));
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

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer?.setSize(width, height);
    if (this.box && !this.sized) this.home();
    this.sized = this.box !== undefined;
    this.draw();
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
    // The lamp is over the viewer's left shoulder.
    const { position, quaternion } = this.camera;
    this.lamp.position.copy(position).add(new Vector3(-0.5, 0.6, 0.2).applyQuaternion(quaternion).multiplyScalar(position.length() + 1));
    this.lamp.target.position.copy(this.controls.target);
    const pixels = this.renderer.getDrawingBufferSize(new Vector2()).y;
    for (const name of ["points", "balls", "hidden"]) {
      const part = this.parts?.[name];
      if (part) part.material.uniforms.scale.value = pixels / 2 / Math.tan(Math.PI / 360 * this.camera.fov);
    }
    this.renderer.render(this.scene, this.camera);
    // As long as the browser lets it be known, which is not all that a frame takes.
    document.body.dataset.frame = (performance.now() - started).toFixed(1);
  }

  async png() {
    this.drawNow();
    if (!this.renderer) throw new Error("this browser has no WebGL, so there is no picture");
    return new Promise((resolve) => this.renderer.domElement.toBlob(resolve, "image/png"));
  }
}
