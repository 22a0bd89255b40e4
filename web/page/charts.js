// The histogram, the curve of Betti numbers and the persistence diagram, on canvases.

import { brief } from "./colours.js";

// Components, tunnels and voids, in colours that are readable as text on a light and on a dark page.
const KINDS = ["components", "tunnels", "voids"];
const ON_LIGHT = ["#0072b2", "#b34700", "#00785a"];
const ON_DARK = ["#56b4e9", "#ff9a57", "#2fc79b"];

// A canvas as wide as its place, drawn again when that changes.
class Chart {
  constructor(canvas) {
    this.canvas = canvas;
    this.height = Number(canvas.getAttribute("height"));
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  begin() {
    const width = this.canvas.clientWidth;
    const ratio = devicePixelRatio || 1;
    this.width = width;
    this.canvas.width = width * ratio;
    this.canvas.height = this.height * ratio;
    this.canvas.style.height = `${this.height}px`;
    const context = this.canvas.getContext("2d");
    context.scale(ratio, ratio);
    context.font = "12px system-ui, sans-serif";
    this.text = getComputedStyle(this.canvas).color;
    this.colours = matchMedia("(prefers-color-scheme: dark)").matches ? ON_DARK : ON_LIGHT;
    return width > 0 ? context : null;
  }

  at(event) {
    const rectangle = this.canvas.getBoundingClientRect();
    return [event.clientX - rectangle.left, event.clientY - rectangle.top];
  }
}

// Bars of a volume's values, with the window and the lowest value selected as lines to drag.
export class Histogram extends Chart {
  constructor(canvas, changed) {
    super(canvas);
    this.changed = changed;
    canvas.addEventListener("pointerdown", (event) => this.grab(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", () => this.drop());
    canvas.addEventListener("pointercancel", () => this.drop());
  }

  set(bars, low, high) {
    Object.assign(this, { bars, low, high });
    this.draw();
  }

  // The places of the lines; null where there is none.
  lines(marks) {
    this.marks = marks;
    this.draw();
  }

  x(value) {
    return (value - this.low) / (this.high - this.low || 1) * this.width;
  }

  draw() {
    const context = this.bars && this.begin();
    if (!context) return;
    const most = Math.log1p(Math.max(...this.bars));
    context.fillStyle = this.text;
    context.globalAlpha = 0.45;
    this.bars.forEach((count, k) => {
      const height = Math.log1p(count) / most * (this.height - 16);
      context.fillRect(k / this.bars.length * this.width, this.height - height, this.width / this.bars.length + 0.5, height);
    });
    context.globalAlpha = 1;
    const line = (value, colour, label) => {
      if (value === null || value === undefined || Number.isNaN(value)) return;
      const x = Math.min(this.width - 1, Math.max(1, this.x(value)));
      context.fillStyle = context.strokeStyle = colour;
      context.lineWidth = 2;
      context.beginPath();
      context.moveTo(x, 14);
      context.lineTo(x, this.height);
      context.stroke();
      context.textAlign = x > this.width / 2 ? "right" : "left";
      context.fillText(label, x, 11);
    };
    const [window, least] = this.colours;
    const told = (value) => (value === null || value === undefined || Number.isNaN(value) ? "" : brief(value));
    line(this.marks?.low, window, told(this.marks?.low));
    line(this.marks?.high, window, told(this.marks?.high));
    line(this.marks?.least, least, "lowest");
  }

  grab(event) {
    const [x] = this.at(event);
    const marks = Object.entries(this.marks ?? {}).filter(([, value]) => value !== null);
    const near = marks.map(([name, value]) => [Math.abs(this.x(value) - x), name]).sort((a, b) => a[0] - b[0])[0];
    if (!near || near[0] > 14) return;
    [this.held, this.moved] = [near[1], false];
    this.canvas.setPointerCapture(event.pointerId);
  }

  drag(event) {
    if (!this.held) return;
    const share = Math.min(1, Math.max(0, this.at(event)[0] / this.width));
    this.moved = true;
    this.changed(this.held, this.low + share * (this.high - this.low), false);
  }

  drop() {
    if (this.held && this.moved) this.changed(this.held, this.marks[this.held], true);
    this.held = null;
  }
}

// A scale of α: logarithmic in the squared radius of the largest balls, α + ω, from the first simplices to where topology
// has changed for the last time.
export class AlphaScale {
  constructor({ alphas, b0, b1, b2, largestWeight, reference }) {
    this.shift = largestWeight;
    const size = (alpha) => alpha + largestWeight;
    const same = (k) => [b0, b1, b2].every((counts) => counts[k] === counts[k - 1]);
    let last = alphas.length - 1;
    while (last > 0 && same(last)) last -= 1;
    const first = alphas.findIndex((alpha) => size(alpha) > 0);
    const high = 2 * Math.max(size(alphas[last] ?? 1), size(reference));
    const low = first < 0 ? high / 4 : Math.max(size(alphas[first]), 1e-6 * high);
    // How far it is from one picture to the next, when it is played.
    this.step = 1 / 40;
    // It begins a little below the first value.
    [this.low, this.high] = high > 0 ? [Math.log(low / 1.2), Math.log(high)] : [0, 1];
  }

  share(alpha) {
    const size = alpha + this.shift;
    return size > 0 ? Math.min(1, Math.max(0, (Math.log(size) - this.low) / (this.high - this.low))) : 0;
  }

  alpha(share) {
    return Math.exp(this.low + share * (this.high - this.low)) - this.shift;
  }
}

// A scale of a few stops, all as far from each other.
export class StopScale {
  constructor(alphas) {
    this.alphas = alphas;
    this.step = 1 / Math.max(1, alphas.length - 1);
  }

  // Of the last stop up to an α.
  share(alpha) {
    const above = this.alphas.findIndex((stop) => stop > alpha);
    return Math.max(0, (above < 0 ? this.alphas.length : above) - 1) * this.step;
  }

  alpha(share) {
    return this.alphas[Math.round(share / this.step)];
  }
}

// A radius as an axis has it: two digits.
const tick = (alpha) => (alpha >= 0 ? (Number.isFinite(alpha) ? brief(Number(Math.sqrt(alpha).toPrecision(2))) : "∞") : "0");

// Round radii between two, 1, 2 and 5 times powers of ten, or fewer where these are many.
function radii(low, high) {
  const all = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power++) all.push(...[1, 2, 5].map((factor) => factor * 10 ** power));
  const within = all.filter((radius) => radius >= low && radius <= high);
  return within.length > 7 ? within.filter((radius) => Number.isInteger(Math.round(1e6 * Math.log10(radius)) / 1e6)) : within;
}

// The place of a chart's axes: pixels at its left and below it.
const [LEFT, BELOW] = [48, 34];

// Components, tunnels and voids over α, which is told as the radius of the ball.
export class Curve extends Chart {
  constructor(canvas, chosen) {
    super(canvas);
    const share = (event) => Math.min(1, Math.max(0, (this.at(event)[0] - LEFT) / (this.width - LEFT - 4)));
    const choose = (event) => this.scale && chosen(this.scale.alpha(share(event)));
    canvas.addEventListener("pointerdown", choose);
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) return choose(event);
      if (this.scale) canvas.title = this.tell(this.scale.alpha(share(event)));
      return undefined;
    });
  }

  set(scale, data) {
    Object.assign(this, { scale, data });
    this.draw();
  }

  mark(alpha) {
    this.alpha = alpha;
    this.draw();
  }

  // What there is at an α, in words.
  tell(alpha) {
    const { alphas, b0, b1, b2, unit } = this.data;
    let at = alphas.findIndex((one) => one > alpha);
    at = Math.max(0, (at < 0 ? alphas.length : at) - 1);
    const radius = alpha >= 0 ? `ball radius ${brief(Math.sqrt(alpha))} ${unit}, ` : "";
    return `${radius}α = ${brief(alpha)}: ${[b0, b1, b2].map((counts, k) => `${brief(counts[at])} ${counts[at] === 1 ? KINDS[k].slice(0, -1) : KINDS[k]}`).join(", ")}`;
  }

  draw() {
    const context = this.data && this.begin();
    if (!context) return;
    const { alphas, b0, b1, b2, unit } = this.data;
    const most = Math.max(1, ...b0, ...b1, ...b2);
    const y = (count) => this.height - BELOW - Math.log1p(count) / Math.log1p(most) * (this.height - BELOW - 24);
    const x = (alpha) => LEFT + this.scale.share(alpha) * (this.width - LEFT - 4);
    context.fillStyle = context.strokeStyle = this.text;
    context.textAlign = "right";
    for (let count = 0; count <= most; count = count === 0 ? 1 : 10 * count) {
      context.globalAlpha = 0.2;
      context.fillRect(LEFT, y(count), this.width - LEFT, 1);
      context.globalAlpha = 1;
      context.fillText(count >= 1000 ? `${count / 1000}k` : count, LEFT - 4, y(count) + 4);
    }
    for (const [share, align] of [[0, "left"], [0.5, "center"], [1, "right"]]) {
      const alpha = this.scale.alpha(share);
      context.textAlign = align;
      context.fillText(tick(alpha), LEFT + share * (this.width - LEFT - 4), this.height - BELOW + 15);
    }
    context.textAlign = "center";
    context.fillText(`ball radius in ${unit}`, (LEFT + this.width) / 2, this.height - 4);
    context.textAlign = "left";
    let left = LEFT + 4;
    [b0, b1, b2].forEach((counts, kind) => {
      context.strokeStyle = context.fillStyle = this.colours[kind];
      context.lineWidth = 1.5;
      context.beginPath();
      let before = 0;
      context.moveTo(LEFT, y(0));
      alphas.forEach((alpha, k) => {
        context.lineTo(x(alpha), y(before));
        context.lineTo(x(alpha), y(counts[k]));
        before = counts[k];
      });
      context.lineTo(this.width - 4, y(before));
      context.stroke();
      context.fillText(KINDS[kind], left, 12);
      left += context.measureText(KINDS[kind]).width + 14;
    });
    context.strokeStyle = this.text;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x(this.alpha), 18);
    context.lineTo(x(this.alpha), this.height - BELOW);
    context.stroke();
  }
}

// Births and deaths; what never ends is on the upper edge.
export class Diagram extends Chart {
  constructor(canvas, chosen) {
    super(canvas);
    canvas.addEventListener("click", (event) => this.choose(event, chosen));
    // With many pairs, it is looked for when the mouse rests.
    let resting = null;
    canvas.addEventListener("pointermove", (event) => {
      clearTimeout(resting);
      resting = setTimeout(() => { canvas.title = this.tell(this.nearest(...this.at(event))); }, 80);
    });
  }

  // Pairs of each dimension: birth, death, and the simplex that names it.
  set(scale, pairs, unit) {
    Object.assign(this, { scale, pairs, unit, drawn: null });
    this.draw();
  }

  mark(alpha) {
    this.alpha = alpha;
    this.draw();
  }

  // There may be hundreds of thousands of pairs: they are drawn once for a size.
  dots() {
    const ratio = devicePixelRatio || 1;
    if (this.drawn?.width === this.canvas.width && this.drawn?.height === this.canvas.height) return this.drawn;
    this.drawn = new OffscreenCanvas(this.canvas.width, this.canvas.height);
    const context = this.drawn.getContext("2d");
    context.scale(ratio, ratio);
    context.globalAlpha = 0.7;
    this.colours.forEach((colour, dimension) => {
      context.fillStyle = colour;
      for (const pair of this.pairs[dimension]) {
        const [x, y] = this.place(pair);
        context.beginPath();
        context.arc(x, y, 2.5, 0, 2 * Math.PI);
        context.fill();
      }
    });
    return this.drawn;
  }

  place([birth, death]) {
    const size = [this.width - LEFT - 6, this.height - BELOW - 18];
    const up = Number.isFinite(death) ? this.scale.share(death) : 1;
    return [LEFT + this.scale.share(birth) * size[0], this.height - BELOW - up * size[1]];
  }

  draw() {
    const context = this.pairs && this.begin();
    if (!context) return;
    context.strokeStyle = this.text;
    context.globalAlpha = 0.4;
    context.beginPath();
    context.moveTo(LEFT, this.height - BELOW);
    context.lineTo(this.width - 6, 18);
    const [x, y] = this.place([this.alpha, this.alpha]);
    context.moveTo(x, this.height - BELOW);
    context.lineTo(x, y);
    context.lineTo(LEFT, y);
    context.moveTo(LEFT, 18);
    context.lineTo(LEFT, this.height - BELOW);
    context.lineTo(this.width - 6, this.height - BELOW);
    context.stroke();
    context.globalAlpha = 1;
    context.drawImage(this.dots(), 0, 0, this.width, this.height);
    let left = LEFT + 4;
    KINDS.forEach((name, kind) => {
      context.fillStyle = this.colours[kind];
      context.fillText(name, left, 12);
      left += context.measureText(name).width + 14;
    });
    context.fillStyle = this.text;
    const [least, most] = [0, 1].map((share) => Math.sqrt(Math.max(0, this.scale.alpha(share))));
    const ends = least > 0 && Number.isFinite(most) ? radii(least, most) : [least, most];
    for (const radius of ends) {
      const [at, up] = this.place([radius * radius, radius * radius]);
      const label = brief(Number(radius.toPrecision(2)));
      context.textAlign = "center";
      context.fillRect(at, this.height - BELOW, 1, 4);
      context.fillText(label, at, this.height - BELOW + 15);
      context.textAlign = "right";
      context.fillRect(LEFT - 4, up, 4, 1);
      context.fillText(label, LEFT - 6, up + 4);
    }
    context.textAlign = "center";
    context.fillText(`born at this ball radius in ${this.unit}`, (LEFT + this.width) / 2, this.height - 4);
    context.save();
    context.translate(12, (this.height - BELOW) / 2);
    context.rotate(-Math.PI / 2);
    context.fillText("gone at this ball radius", 0, 0);
    context.restore();
  }

  // Between a birth and a death, in the middle of the scale, what they bound is there.
  choose(event, chosen) {
    const [x, y] = this.at(event);
    const near = this.nearest(x, y);
    if (!near) return;
    const [birth, death] = near.pair;
    const end = Number.isFinite(death) ? this.scale.share(death) : 1;
    chosen(Math.max(birth, this.scale.alpha((this.scale.share(birth) + end) / 2)), near);
  }

  // The pair at a place, with its dimension.
  nearest(x, y) {
    let [near, least] = [null, 12];
    this.pairs?.forEach((pairs, dimension) => pairs.forEach((pair) => {
      const [px, py] = this.place(pair);
      const distance = Math.hypot(px - x, py - y);
      if (distance < least) [near, least] = [{ dimension, pair }, distance];
    }));
    return near;
  }

  tell(near) {
    if (!near) return "";
    const radius = (alpha) => (Number.isFinite(alpha) ? `${brief(Math.sqrt(Math.max(0, alpha)))} ${this.unit}` : "no radius");
    const [birth, death] = near.pair.map(radius);
    return `${["component", "tunnel", "void"][near.dimension]}, born at ball radius ${birth}, gone at ${death}`;
  }
}
