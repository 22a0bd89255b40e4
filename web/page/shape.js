// The shape as it is seen: scene, α, colours and numbers. A source computes or looks up what is there at an α.

import { Box3, Vector3 } from "three";
import { Curve } from "./charts.js";
import { BONE, brief, CLASSES, CUT, EDGES, grouped, INTERIOR, LOOSE, measured, OF_CLASS, placed, REGULAR, short, SINGULAR } from "./colours.js";
import { byId, download, element, rows, setValue, valueOf, valuesOf } from "./dom.js";
import { ShapeScene } from "./scene.js";

// Voids that are listed at most.
const VOIDS = 200;

// Drawers beside the picture, of which those open are remembered.
const DRAWERS = "walpha-drawers";
function remembered() {
  // A page from disk may have no store.
  try {
    return (localStorage.getItem(DRAWERS) ?? "").split(" ");
  } catch {
    return [];
  }
}

export function openDrawer(name, open) {
  byId(name).hidden = !open;
  document.querySelector(`[data-drawer="${name}"]`).ariaExpanded = open;
  const all = [...document.querySelectorAll("[data-drawer]")].filter((button) => button.ariaExpanded === "true");
  try {
    localStorage.setItem(DRAWERS, all.map((button) => button.dataset.drawer).join(" "));
  } catch {
    // It is not remembered.
  }
}

export function wireDrawers() {
  const before = remembered();
  for (const button of document.querySelectorAll("[data-drawer]")) {
    const name = button.dataset.drawer;
    if (before.includes(name)) openDrawer(name, true);
    button.addEventListener("click", () => {
      const open = byId(name).hidden;
      openDrawer(name, open);
      if (open) byId(name).scrollIntoView({ block: "nearest" });
    });
  }
}

// What is chosen of how a shape is drawn.
const choices = () => [...byId("display").querySelectorAll("input, select"), byId("cut"), byId("cut-place")];
export const lookNow = () => valuesOf(choices());

export function setLook(look) {
  for (const control of choices()) {
    if (!(control.id in look) || valueOf(control) === look[control.id]) continue;
    setValue(control, look[control.id]);
    control.dispatchEvent(new Event(control.type === "range" ? "input" : "change", { bubbles: true }));
  }
}

// Gives copies of points, which follow these, what their points have.
function copyKinds(made) {
  const { positions, copies } = made;
  if (!copies) return;
  const own = positions.length / 3 - copies.length;
  for (const [name, width] of [["weights", 1], ["values", 1], ["differences", 1], ["atoms", 1], ["codes", 1], ["tints", 3]]) {
    const before = made[name];
    if (!before) continue;
    const all = new before.constructor(width * (own + copies.length));
    all.set(before.subarray(0, width * own));
    copies.forEach((v, k) => all.set(before.subarray(width * v, width * (v + 1)), width * (own + k)));
    made[name] = all;
  }
}

export class ShapePanel {
  // A source has `at(α)` and `measure(α)`, which promise simplices and numbers, and `voids(α)`, which promises the corners of the facets
  // around each void, and where those of the next begin. It may have `section(α, axis, place)`, which promises
  // the cut cells. Listeners: `failed`, with an error; `moved`, with each α; `rested`, when the numbers of an α are there; `changed`, when
  // something else is shown.
  constructor(source, heard) {
    [this.source, this.heard] = [source, heard];
    this.curve = new Curve(byId("curve"), (alpha) => this.made && this.moveTo(this.stop(alpha)));
    // While a shape is being drawn, only the last α asked for waits.
    [this.drawing, this.next] = [false, null];
    this.clear();
    this.wire();
  }

  // Nothing is known any more.
  clear() {
    [this.made, this.shape, this.alpha, this.around, this.cycle] = [null, null, null, null, null];
  }

  // Points, and the first look at their shape. The view stays if it is to be kept.
  look(made, keep = false) {
    [this.made, this.shape, this.alpha] = [made, made, null];
    for (const id of ["shape", "cut-row", "alpha-row"]) byId(id).hidden = false;
    this.scene ??= new ShapeScene(byId("scene"));
    [this.scene.bar, this.scene.axes] = [byId("bar"), byId("axes")];
    const { scene } = this;
    copyKinds(made);
    this.setPoints(keep);
    byId("picked").textContent = "";
    const colour = byId("colour");
    // Weights that are all the same say nothing.
    const weights = made.weights.some((weight) => weight !== made.weights[0]);
    const scales = { value: made.values, difference: made.differences, weight: weights, element: made.atoms, asprs: made.codes, rgb: made.tints };
    for (const option of colour.options) {
      option.hidden = option.value in scales && !scales[option.value];
      if (option.hidden && option.selected) colour.value = "plain";
    }
    // A scan has much that is a surface without an inside, and its height shows it best; atoms are balls; a solid has a material.
    const isScan = !made.atoms && made.singular.length > 0.1 * made.regular.length;
    const suits = made.atoms ? "element" : made.codes ? "asprs" : isScan ? "height" : "plain";
    if (!keep && ["plain", "height", "element", "asprs"].includes(colour.value)) colour.value = suits;
    if (!keep) byId("show-singular").checked = isScan || colour.value !== "plain";
    if (!keep) byId("show-balls").checked = Boolean(made.atoms) && made.weights.some((weight) => weight !== 0);
    if (!keep && made.cell) byId("show-box").checked = true;
    this.stopMeasuring();
    byId("show-original").parentElement.hidden = !made.original;
    this.paint();
    scene.setShape(made, made.reference);
    if (!keep) scene.home();
    // The numbers follow when α rests.
    if (!keep) byId("summary").textContent = "";
    this.legend();
    this.tellAlpha(made.reference);
    document.body.dataset.looked = made.positions.length / 3;
  }

  setPoints(keep) {
    const { made, scene } = this;
    const box = new Box3();
    box.setFromArray(made.positions);
    if (box.isEmpty()) box.set(new Vector3(), new Vector3(1, 1, 1));
    scene.setPoints(made, box, keep);
  }

  // As the controls say.
  paint() {
    this.scene.setColour(byId("colour").value);
    for (const name of ["points", "balls", "hidden", "original", "box"]) this.scene.show(name, byId(`show-${name}`).checked);
    this.showSingular();
  }

  // In a periodic box other simplices need other copies of the points.
  setCopies({ positions, copies }) {
    const same = (a, b) => a.length === b.length && a.every((x, k) => x === b[k]);
    if (same(copies, this.made.copies) && same(positions, this.made.positions)) return;
    Object.assign(this.made, { positions, copies });
    copyKinds(this.made);
    this.setPoints(true);
    this.paint();
  }

  // What there is at all α: stops with their Betti numbers.
  open(all, scale) {
    Object.assign(this.made, all);
    this.scale = scale;
    this.curve.set(scale, this.made);
    return this.setAlpha(this.made.reference);
  }

  // The last of the stops up to an α: nothing needs to be computed for it.
  stop(alpha) {
    const { alphas } = this.made;
    let [low, high] = [0, alphas.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (alphas[middle] <= alpha) low = middle + 1;
      else high = middle;
    }
    return alphas[Math.max(0, low - 1)];
  }

  // The radius of the ball, and α beside it.
  tellAlpha(alpha) {
    const { unit } = this.made;
    const radius = byId("radius-value");
    if (document.activeElement !== radius) radius.value = alpha >= 0 ? short(Math.sqrt(alpha)) : "";
    radius.placeholder = alpha >= 0 ? "" : "α < 0";
    byId("alpha-unit").replaceChildren(element("b", { textContent: unit }), ` α = ${brief(alpha)} ${unit}²`);
    byId("alpha-unit").title = `α = ${alpha} ${unit}²`;
    if (document.activeElement !== byId("alpha-value")) Object.assign(byId("alpha-value"), { value: Number(alpha.toPrecision(6)), title: `α = ${alpha} ${unit}²`, ariaInvalid: null });
    radius.ariaInvalid = null;
  }

  async setAlpha(alpha) {
    if (!this.made || Number.isNaN(alpha)) return;
    [this.next, this.alpha] = [alpha, alpha];
    if (this.cycle && this.cycle.alpha !== alpha) this.showCycle(null);
    byId("alpha").value = this.scale.share(alpha);
    const { unit } = this.made;
    byId("alpha").ariaValueText = alpha >= 0 ? `${short(Math.sqrt(alpha))} ${unit}` : `α = ${short(alpha)} ${unit}²`;
    this.tellAlpha(alpha);
    this.curve.mark(alpha);
    this.heard.moved?.(alpha);
    if (this.drawing) return;
    this.drawing = true;
    try {
      while (this.next !== null) {
        const wanted = this.next;
        this.next = null;
        const shape = await this.source.at(wanted);
        // A failure may have cleared it meanwhile.
        if (!this.made) return;
        this.shape = shape;
        if (shape.copies) this.setCopies(shape);
        this.scene.setShape(shape, wanted);
        this.legend();
        document.body.dataset.alpha = wanted;
        document.body.dataset.betti = shape.betti.join(",");
        if (byId("cut").value !== "") await this.section(wanted);
      }
      this.later();
    } finally {
      this.drawing = false;
    }
  }

  // As a user asks for it.
  moveTo(alpha) {
    return this.setAlpha(alpha).catch(this.heard.failed);
  }

  // From stop to stop, however far these are apart.
  step(count) {
    const { alphas } = this.made;
    const at = alphas.indexOf(this.stop(this.alpha)) + count;
    return this.moveTo(alphas[Math.min(alphas.length - 1, Math.max(0, at))]);
  }

  // Numbers and voids, once α rests.
  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(async () => {
      if (!this.made) return;
      try {
        const { alpha } = this;
        const measured = await this.source.measure(alpha);
        if (alpha !== this.alpha) return;
        this.measures(measured);
        await this.heard.rested?.();
        document.body.dataset.measured = alpha;
      } catch (error) {
        this.heard.failed(error);
      }
    }, 150);
  }

  measures(level) {
    const { unit, domain, centre } = this.made;
    const classes = (counts) => ["interior", "regular", "singular"].map((name) => `${grouped(counts[name])} ${name}`).join(", ");
    const counted = (count, noun) => `${grouped(count)} ${noun}${count === 1 ? "" : "s"}`;
    const [b0, b1, b2] = level.betti;
    const [volume, area] = [measured(level.volume, unit, 3), measured(level.area, unit, 2)];
    // In a periodic box some loops and surfaces go round it: they are neither tunnels nor voids.
    const [loops, surfaces] = this.made.cell ? ["loop", "closed surface"] : ["tunnel", "void"];
    const topology = [counted(b0, "part"), counted(b1, loops), counted(b2, surfaces)].join(", ");
    // Of atoms, people want the volume of the balls, which is measured as the file has them.
    const balls = this.alpha === this.made.reference ? this.made.union : null;
    const size = balls ? `Balls: volume ${measured(balls.volume, unit, 3)}, surface ${measured(balls.area, unit, 2)}`
      : `${this.made.atoms ? "Tetrahedra: volume" : "Volume"} ${volume}, surface ${area}`;
    byId("summary").textContent = `${size}, ${topology}`;
    byId("summary").title = balls ? `${balls.volume} ${unit}³, ${balls.area} ${unit}²` : `${level.volume} ${unit}³, ${level.area} ${unit}²`;
    const radius = this.alpha >= 0 ? [["ball radius", `${brief(Math.sqrt(this.alpha))} ${unit}`]] : [];
    rows(byId("measures"), [
      ...(this.made.labels ? [["labels", this.made.labels]] : [...radius, ["α", `${brief(this.alpha)} ${unit}²`]]),
      ["volume", `${volume}, ${(100 * level.coverage).toFixed(1)} % of ${domain}`],
      ["surface", area],
      ["parts", grouped(b0)], [`${loops}s`, grouped(b1)], [`${surfaces}s`, grouped(b2)],
      ["cells", grouped(level.cells)], ["facets", classes(level.facets)], ["edges", classes(level.edges)], ["vertices", classes(level.vertices)],
      ...(this.made.rows ?? []),
    ]);
    document.body.dataset.cells = level.cells;
    const shown = (level.voids ?? []).slice(0, VOIDS).map((hole, row) => {
      const [low, high] = [hole.low, hole.high].map((corner) => corner.map((x, k) => x - centre[k]));
      const text = `${measured(hole.volume, unit, 3)}, filled from radius ${brief(Math.sqrt(Math.max(0, hole.filling_alpha)))} ${unit}`;
      const item = element("button", { type: "button", textContent: text });
      item.title = `${hole.volume} ${unit}³, ${hole.cells} cells, filled at α = ${hole.filling_alpha}. A click zooms to it.`;
      item.onpointerenter = item.onfocus = () => this.light(item, row, low, high);
      item.onpointerleave = item.onblur = () => this.light(null);
      item.onclick = () => this.scene.zoomTo(low, high);
      return element("li", {}, item);
    });
    byId("voids").replaceChildren(...(shown.length ? shown : [element("li", { textContent: level.voids ? "none" : "not listed" })]));
  }

  // Shows a void, or none. Its box is there at once, its faces a little later.
  async light(item, row, low, high) {
    this.lit = item;
    if (this.cycle) this.showCycle(null);
    if (!item) return this.scene.light(null);
    const { alpha } = this;
    if (this.around?.alpha !== alpha) {
      this.scene.light({ low, high });
      this.around = { alpha, facets: this.source.voids(alpha, VOIDS) };
    }
    try {
      const found = await this.around.facets;
      if (this.lit !== item || this.alpha !== alpha) return undefined;
      this.scene.light({ low, high, positions: found?.positions, facets: found?.facets.subarray(found.starts[row], found.starts[row + 1]) });
    } catch (error) {
      this.around = null;
      this.heard.failed(error);
    }
    return undefined;
  }

  // Shows the cycle of a persistence pair, which stays as long as α does, or none.
  showCycle(cycle) {
    this.cycle = cycle && { ...cycle, alpha: this.alpha };
    this.scene?.setCycle(cycle);
    byId("picked").textContent = cycle?.text ?? "";
  }

  // What is drawn, in its colours.
  legend() {
    const box = (colour) => element("i", { style: `background: ${colour}` });
    const by = byId("colour").value;
    if (this.scene.scale) {
      const [low, high] = this.scene.scale;
      const title = this.made.titles?.[by] ?? { value: "F", weight: "ω", height: `height in ${this.made.unit}` }[by];
      byId("legend").replaceChildren(element("span", {}, `${title}: ${placed(low, high - low)} `, element("i", { className: "scale" }), ` ${placed(high, high - low)}`));
      return;
    }
    if (by === "rgb") {
      byId("legend").textContent = "The colours of the points.";
      return;
    }
    const { regular, singular, edges, classes } = this.shape;
    const kind = this.scene.data.kinds[by];
    if (kind) {
      const counts = new Map();
      for (const number of kind.numbers.subarray(0, this.own)) counts.set(number, (counts.get(number) ?? 0) + 1);
      const named = [...counts].map(([number, count]) => ({ count, ...(kind.known[number] ?? { name: "not known", colour: null }) }));
      byId("legend").replaceChildren(...named.sort((a, b) => b.count - a.count).map(({ count, name, colour }) =>
        element("span", {}, box(colour ? `rgb(${colour.join(" ")})` : BONE), `${grouped(count)} ${name}`)));
      return;
    }
    const plain = by === "plain";
    const parts = [[plain ? BONE : OF_CLASS[REGULAR], regular.length / 3, plain ? "boundary triangles" : "regular facets"]];
    if (byId("show-singular").checked) {
      if (plain && this.scene.isSheet) parts[0] = [BONE, (regular.length + singular.length) / 3, "triangles of a surface"];
      else parts.push([plain ? LOOSE : OF_CLASS[SINGULAR], singular.length / 3, plain ? "loose triangles" : "singular facets"]);
      parts.push([plain ? LOOSE : EDGES, edges.length / 2, plain ? "loose edges" : "singular edges"]);
    }
    if (byId("show-points").checked) {
      const counts = CLASSES.map(() => 0);
      for (const kind of classes.subarray(0, this.own)) counts[kind] += 1;
      for (const kind of [INTERIOR, REGULAR, SINGULAR]) parts.push([OF_CLASS[kind], counts[kind], `${CLASSES[kind]} points`]);
    }
    const shown = parts.filter(([, count]) => count > 0);
    const entries = shown.map(([colour, count, name]) => element("span", {}, box(colour), `${grouped(count)} ${name}`));
    if (byId("cut").value !== "" && regular.length > 0) entries.push(element("span", {}, box(plain ? CUT : OF_CLASS[INTERIOR]), "cut cells"));
    byId("legend").replaceChildren(...entries);
    if (regular.length + singular.length + edges.length > 0) return;
    const pointsToo = [INTERIOR, REGULAR, SINGULAR].some((kind) => classes.includes(kind));
    if (this.made.cell && classes.includes(INTERIOR)) {
      byId("legend").append("The shape fills the box at this α, and has no boundary.");
      return;
    }
    byId("legend").append(pointsToo ? "Only points are in the shape at this ball radius: Look shows them." : "Nothing is in the shape at this α.");
  }

  showSingular() {
    for (const name of ["singular", "edges"]) this.scene.show(name, byId("show-singular").checked);
  }

  // The number of points that are not copies, which follow them.
  get own() {
    return this.made.positions.length / 3 - (this.made.copies?.length ?? 0);
  }

  // The index of a point, and what is known of it.
  wordsOf(v) {
    const { positions, weights, values, differences, atoms, elements, codes, classNames, centre, unit, copies, indices } = this.made;
    const { min, max } = this.scene.box;
    const extent = Math.max(max.x - min.x, max.y - min.y, max.z - min.z);
    const at = [0, 1, 2].map((k) => placed(positions[3 * v + k] + centre[k], extent)).join(", ");
    const value = values ? `, value F = ${short(values[v])}` : "";
    const difference = differences ? `, difference ${short(differences[v])}` : "";
    const kind = elements?.[atoms?.[v]]?.name ?? classNames?.[codes?.[v]]?.name;
    const ofInput = (point) => indices?.[point] ?? point;
    const name = v < this.own ? `point ${ofInput(v)}` : `a copy of point ${ofInput(copies[v - this.own])}`;
    return `${name}${kind ? ` (${kind})` : ""} at (${at}) ${unit}${value}${difference}, weight ω = ${short(weights[v])}, ${CLASSES[this.shape.classes[v]]}`;
  }

  startMeasuring() {
    byId("measure").ariaPressed = true;
    byId("scene").classList.add("measuring");
    byId("picked").textContent = "Click two places on the surface.";
  }

  stopMeasuring() {
    byId("measure").ariaPressed = false;
    byId("scene").classList.remove("measuring");
    this.scene?.endMeasuring();
  }

  get measuring() {
    return byId("measure").ariaPressed === "true";
  }

  measureAt(event) {
    if (!this.shape) return;
    const length = this.scene.measureAt(event);
    byId("picked").textContent = length === null ? "Click a place on the surface to measure to." : `Length ${brief(length)} ${this.made.unit}`;
    byId("picked").title = length === null ? "" : `${length} ${this.made.unit}`;
  }

  // Says what is known of the point at a place on the screen.
  tell(event) {
    if (!this.shape || this.measuring || this.cycle) return;
    const v = this.scene.pick(event);
    byId("picked").textContent = v === null ? "" : this.wordsOf(v);
  }

  // The cut, with the cells that it goes through where these are known.
  async section(alpha) {
    const axis = Number(byId("cut").value);
    const name = ["x", "y", "z"][axis];
    const { min, max } = this.scene.box;
    // Not exactly through the samples of a grid, where cells have their facets.
    const place = min[name] + (Number(byId("cut-place").value) + 1e-6) * (max[name] - min[name]);
    this.scene.setCut(axis, place);
    if (this.source.section) this.scene.setSection(await this.source.section(alpha, axis, place + this.made.centre[axis]));
    else this.scene.setCap();
  }

  cut() {
    const on = byId("cut").value !== "";
    byId("cut-place").hidden = !on;
    if (this.shape) this.legend();
    this.heard.changed?.();
    if (!on) return this.scene?.setCut(null);
    return this.alpha === null ? undefined : this.moveTo(this.alpha);
  }

  // From where α is to the end of its scale, from the start if it is there already.
  async play() {
    if (this.playing) return this.pause();
    const { alphas } = this.made;
    const mine = this.playing = {};
    byId("play").textContent = "Stop";
    let at = alphas.indexOf(this.stop(this.alpha));
    if (at === alphas.length - 1) at = -1;
    while (this.playing === mine && at < alphas.length - 1) {
      const share = at < 0 ? -Infinity : this.scale.share(alphas[at]);
      at = alphas.findIndex((alpha, k) => k > at && this.scale.share(alpha) >= share + 0.99 * this.scale.step);
      if (at < 0) at = alphas.length - 1;
      await this.moveTo(alphas[at]);
      await new Promise((resolve) => { setTimeout(resolve, 400); });
    }
    if (this.playing === mine) this.pause();
    return undefined;
  }

  pause() {
    this.playing = null;
    byId("play").textContent = "Play";
  }

  wire() {
    const alpha = byId("alpha");
    alpha.addEventListener("input", () => {
      this.pause();
      this.moveTo(this.stop(this.scale.alpha(Number(alpha.value))));
    });
    alpha.addEventListener("keydown", (event) => {
      const count = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 20, PageDown: -20 }[event.key];
      if (!count) return;
      event.preventDefault();
      this.pause();
      this.step(count);
    });
    byId("radius-value").addEventListener("change", ({ target }) => {
      const radius = Number(target.value.replace(",", "."));
      if (target.value.trim() !== "" && radius >= 0) return this.moveTo(this.nearest(radius * radius));
      // What is no radius is marked, and stays to be corrected.
      target.ariaInvalid = this.made ? "true" : null;
      return undefined;
    });
    byId("play").addEventListener("click", () => this.play());
    byId("colour").addEventListener("change", () => {
      this.scene.setColour(byId("colour").value);
      this.legend();
    });
    byId("measure").addEventListener("click", () => {
      if (!this.measuring) return this.startMeasuring();
      this.stopMeasuring();
      byId("picked").textContent = "";
      return undefined;
    });
    byId("full").addEventListener("click", () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else document.documentElement.requestFullscreen?.().catch(this.heard.failed);
    });
    byId("full").hidden = !document.fullscreenEnabled;
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      if (this.measuring) byId("measure").click();
      if (this.cycle) this.showCycle(null);
    });
    byId("show-singular").addEventListener("change", () => {
      this.showSingular();
      this.legend();
    });
    for (const name of ["points", "balls", "hidden", "original", "box"]) {
      byId(`show-${name}`).addEventListener("change", ({ target }) => {
        this.scene.show(name, target.checked);
        this.legend();
      });
    }
    byId("cut").addEventListener("change", () => this.cut());
    byId("cut-place").addEventListener("input", () => this.cut());
    byId("display").addEventListener("change", () => this.heard.changed?.());
    byId("cut-place").addEventListener("change", () => this.heard.changed?.());
    byId("opacity").addEventListener("input", ({ target }) => this.scene?.setOpacity(Number(target.value)));
    byId("home").addEventListener("click", () => this.scene.home());
    let down = null;
    byId("scene").addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    byId("scene").addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      if (this.measuring) this.measureAt(event);
      else if (this.cycle) this.showCycle(null);
      else this.tell(event);
    });
    // A mouse need not click: it is enough that it rests.
    let resting = null;
    byId("scene").addEventListener("pointermove", (event) => {
      clearTimeout(resting);
      if (event.pointerType === "mouse" && event.buttons === 0) resting = setTimeout(() => this.tell(event), 150);
    });
    byId("scene").addEventListener("pointerleave", () => clearTimeout(resting));
  }

  // The α that a number stands for: that itself, or a stop where there are no shapes between.
  nearest(alpha) {
    return this.source.section ? alpha : this.stop(alpha);
  }

  async savePicture(name) {
    try {
      download(await this.scene.png(), name);
    } catch (error) {
      this.heard.failed(error);
    }
  }
}
