// The shape as it is seen: scene, α, colours and numbers. A source computes or looks up what is there at an α.

import { Box3, Vector3 } from "three";
import { Curve } from "./charts.js";
import { CLASSES, EDGES, INTERIOR, OF_CLASS, placed, REGULAR, short, SINGULAR } from "./colours.js";
import { byId, download, element, rows } from "./dom.js";
import { ShapeScene } from "./scene.js";

export class ShapePanel {
  // A source has `at(α)` and `measure(α)`, which promise simplices and numbers, and may have `section(α, axis, place)`, which promises
  // the cut cells. Listeners: `failed`, with an error; `moved`, with each α; `rested`, when the numbers of an α are there.
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
    [this.made, this.shape, this.alpha] = [null, null, null];
  }

  // Points, and the first look at their shape. The view stays if it is to be kept.
  look(made, keep = false) {
    [this.made, this.shape, this.alpha] = [made, made, null];
    byId("shape").hidden = false;
    this.scene ??= new ShapeScene(byId("scene"));
    const { scene } = this;
    const box = new Box3();
    box.setFromArray(made.positions);
    if (box.isEmpty()) box.set(new Vector3(), new Vector3(1, 1, 1));
    scene.setPoints(made, box, keep);
    byId("picked").textContent = "";
    const colour = byId("colour");
    const scales = { value: made.values, difference: made.differences };
    for (const option of colour.options) {
      option.hidden = option.value in scales && !scales[option.value];
      if (option.hidden && option.selected) colour.value = "class";
    }
    byId("show-original").parentElement.hidden = !made.original;
    scene.setColour(colour.value);
    for (const name of ["points", "balls", "hidden", "original", "box"]) scene.show(name, byId(`show-${name}`).checked);
    this.showSingular();
    scene.setShape(made, made.reference);
    this.legend();
    byId("alpha-unit").textContent = `${made.unit}²`;
    byId("alpha-value").value = made.reference;
    document.body.dataset.looked = made.positions.length / 3;
  }

  // What there is at all α: stops with their Betti numbers.
  open(all, scale) {
    Object.assign(this.made, all);
    this.scale = scale;
    byId("numbers").hidden = false;
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

  async setAlpha(alpha) {
    if (!this.made || Number.isNaN(alpha)) return;
    [this.next, this.alpha] = [alpha, alpha];
    byId("alpha").value = this.scale.share(alpha);
    byId("alpha").ariaValueText = `${short(alpha)} ${this.made.unit}²`;
    if (document.activeElement !== byId("alpha-value")) byId("alpha-value").value = alpha;
    this.curve.mark(alpha);
    this.heard.moved?.(alpha);
    if (this.drawing) return;
    this.drawing = true;
    try {
      while (this.next !== null) {
        const wanted = this.next;
        this.next = null;
        const shape = await this.source.at(wanted);
        this.shape = shape;
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
    const classes = (counts) => ["interior", "regular", "singular"].map((name) => `${counts[name]} ${name}`).join(", ");
    const [b0, b1, b2] = level.betti;
    const radius = this.alpha >= 0 ? ` (√α = ${short(Math.sqrt(this.alpha))} ${unit})` : "";
    rows(byId("measures"), [
      this.made.labels ? ["labels", this.made.labels] : ["α", `${short(this.alpha)} ${unit}²${radius}`],
      ["cells", level.cells], ["facets", classes(level.facets)], ["edges", classes(level.edges)], ["vertices", classes(level.vertices)],
      ["components", b0], ["tunnels", b1], ["voids", b2],
      ["volume", `${short(level.volume)} ${unit}³, ${(100 * level.coverage).toFixed(1)} % of ${domain}`],
      ["area", `${short(level.area)} ${unit}²`],
      ...(this.made.rows ?? []),
    ]);
    document.body.dataset.cells = level.cells;
    const shown = (level.voids ?? []).slice(0, 200).map((hole) => {
      const [low, high] = [hole.low, hole.high].map((corner) => corner.map((x, k) => x - centre[k]));
      const item = element("li", { tabIndex: 0, textContent: `${short(hole.volume)} ${unit}³, ${hole.cells} cells, filled at α = ${short(hole.filling_alpha)}` });
      item.onpointerenter = item.onfocus = () => this.scene.light(low, high);
      item.onpointerleave = item.onblur = () => this.scene.light();
      return item;
    });
    byId("voids").replaceChildren(...(shown.length ? shown : [element("li", { textContent: level.voids ? "none" : "not listed" })]));
  }

  // What is drawn, in its colours.
  legend() {
    const box = (colour) => element("i", { style: `background: ${colour}` });
    const by = byId("colour").value;
    if (by !== "class" && this.scene.scale) {
      const [low, high] = this.scene.scale;
      const title = this.made.titles?.[by] ?? { value: "F", weight: "ω" }[by];
      byId("legend").replaceChildren(element("span", {}, `${title}: ${short(low)} `, element("i", { className: "scale" }), ` ${short(high)}`));
      return;
    }
    const { regular, singular, edges, classes } = this.shape;
    const parts = [[OF_CLASS[REGULAR], regular.length / 3, "regular facets"]];
    if (byId("show-singular").checked) {
      parts.push([OF_CLASS[SINGULAR], singular.length / 3, "singular facets"], [EDGES, edges.length / 2, "singular edges"]);
    }
    if (byId("show-points").checked) {
      const counts = CLASSES.map(() => 0);
      for (const kind of classes) counts[kind] += 1;
      for (const kind of [INTERIOR, REGULAR, SINGULAR]) parts.push([OF_CLASS[kind], counts[kind], `${CLASSES[kind]} points`]);
    }
    const shown = parts.filter(([, count]) => count > 0);
    byId("legend").replaceChildren(...shown.map(([colour, count, name]) => element("span", {}, box(colour), `${count} ${name}`)));
    if (regular.length + singular.length + edges.length > 0) return;
    const pointsToo = [INTERIOR, REGULAR, SINGULAR].some((kind) => classes.includes(kind));
    byId("legend").append(`${pointsToo ? "Only points are" : "Nothing is"} in the shape at this α.`);
  }

  showSingular() {
    for (const name of ["singular", "edges"]) this.scene.show(name, byId("show-singular").checked);
  }

  // The index of a point, and what is known of it.
  wordsOf(v) {
    const { positions, weights, values, differences, centre, unit } = this.made;
    const { min, max } = this.scene.box;
    const extent = Math.max(max.x - min.x, max.y - min.y, max.z - min.z);
    const at = [0, 1, 2].map((k) => placed(positions[3 * v + k] + centre[k], extent)).join(", ");
    const value = values ? `, F = ${short(values[v])}` : "";
    const difference = differences ? `, difference ${short(differences[v])}` : "";
    return `point ${v} at (${at}) ${unit}${value}${difference}, ω = ${short(weights[v])}, ${CLASSES[this.shape.classes[v]]}`;
  }

  // Says what is known of the point at a place on the screen.
  tell(event) {
    if (!this.shape) return;
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
  }

  cut() {
    const on = byId("cut").value !== "";
    byId("cut-place").disabled = !on;
    if (!on) return this.scene.setCut(null);
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
    byId("play").addEventListener("click", () => this.play());
    byId("colour").addEventListener("change", () => {
      this.scene.setColour(byId("colour").value);
      this.legend();
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
    byId("home").addEventListener("click", () => this.scene.home());
    let down = null;
    byId("scene").addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    byId("scene").addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      this.tell(event);
    });
    // A mouse need not click: it is enough that it rests.
    let resting = null;
    byId("scene").addEventListener("pointermove", (event) => {
      clearTimeout(resting);
      if (event.pointerType === "mouse" && event.buttons === 0) resting = setTimeout(() => this.tell(event), 150);
    });
    byId("scene").addEventListener("pointerleave", () => clearTimeout(resting));
  }

  async savePicture(name) {
    try {
      download(await this.scene.png(), name);
    } catch (error) {
      this.heard.failed(error);
    }
  }
}
