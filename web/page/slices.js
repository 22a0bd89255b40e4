// Three planes through the volume, with the window, the lowest value and the selected points.

import { SELECTED } from "./colours.js";

// Across which axis a plane is, and whether its rows are drawn upwards.
const PLANES = [[2, false], [1, true], [0, true]];
// What the planes across the axes of a patient are called, and the letters towards which these axes run, and from which.
const OF_PATIENT = ["Sagittal", "Coronal", "Axial"];
const TOWARDS = ["LR", "PA", "SI"];
// The signs of axes relative to left, posterior, superior.
const SPACES = { LPS: [1, 1, 1], RAS: [-1, -1, 1], LAS: [1, -1, 1] };

// Along which axis of the patient an axis of samples runs, and the letters at its two ends; null where it is oblique or nothing is known.
function anatomy({ coordinates, direction }, axis) {
  const signs = SPACES[coordinates.space];
  const along = signs?.map((sign, k) => sign * direction[k][axis]);
  const of = along?.findIndex((part) => Math.abs(part) > 0.9) ?? -1;
  if (of < 0) return null;
  const [plus, minus] = along[of] > 0 ? TOWARDS[of] : [...TOWARDS[of]].reverse();
  return { of, plus, minus };
}

export class Slices {
  constructor(element, engine, failed) {
    this.engine = engine;
    this.planes = PLANES.map(([axis, up]) => {
      const figure = document.createElement("div");
      figure.innerHTML = '<div class="plane"><canvas role="img"></canvas><span class="left"></span><span class="right"></span><span class="top"></span><span class="bottom"></span></div><input type="range" min="0" step="1"><div class="soft"></div>';
      const [picture, slider, caption] = figure.children;
      const [canvas, ...letters] = picture.children;
      element.append(figure);
      const plane = { axis, name: "", up, canvas, letters, slider, caption, busy: false, again: false };
      slider.addEventListener("input", () => this.load(plane).catch(failed));
      return plane;
    });
  }

  async open(facts) {
    const { dims, spacing, unit } = facts;
    this.dims = dims;
    this.spacing = spacing;
    this.unit = unit;
    this.points = null;
    const axes = [0, 1, 2].map((axis) => anatomy(facts, axis));
    const isKnown = new Set(axes.map((axis) => axis?.of)).size === 3;
    for (const plane of this.planes) {
      const [across, along] = [0, 1, 2].filter((k) => k !== plane.axis).map((k) => axes[k]);
      const ends = isKnown ? [across.minus, across.plus, ...(plane.up ? [along.plus, along.minus] : [along.minus, along.plus])] : [];
      plane.letters.forEach((letter, k) => { letter.textContent = ends[k] ?? ""; });
      plane.name = isKnown ? OF_PATIENT[axes[plane.axis].of] : `Across ${"xyz"[plane.axis]}`;
      plane.canvas.ariaLabel = `${plane.name} slice`;
      plane.slider.ariaLabel = `Place of the slice: ${plane.name}`;
      plane.slider.max = dims[plane.axis] - 1;
      plane.slider.value = Math.floor(dims[plane.axis] / 2);
      await this.load(plane);
    }
  }

  // While one plane is read, only the last asked for waits.
  async load(plane) {
    if (plane.busy) {
      plane.again = true;
      return;
    }
    plane.busy = true;
    try {
      do {
        plane.again = false;
        const index = Number(plane.slider.value);
        plane.data = { index, ...(await this.engine.call({ do: "plane", axis: plane.axis, index })) };
        this.draw(plane);
      } while (plane.again);
    } finally {
      plane.busy = false;
    }
  }

  setWindow(low, high, least) {
    this.window = { low, high, least };
    this.planes.forEach((plane) => this.draw(plane));
  }

  // Samples (x, y, z) of the selected points, by plane.
  setPoints(samples) {
    this.points = samples;
    this.planes.forEach((plane) => this.draw(plane));
  }

  draw(plane) {
    if (!plane.data || !this.window) return;
    const { canvas, axis, up, data: { columns, rows, values, index } } = plane;
    const { low, high, least } = this.window;
    const [across, along] = [0, 1, 2].filter((k) => k !== axis);
    canvas.width = columns;
    canvas.height = rows;
    canvas.style.aspectRatio = `${columns * this.spacing[across]} / ${rows * this.spacing[along]}`;
    canvas.style.imageRendering = columns < 200 ? "pixelated" : "auto";
    const context = canvas.getContext("2d");
    const image = context.createImageData(columns, rows);
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        const value = values[row * columns + column];
        const gray = 255 * (value - low) / (high - low || 1);
        const to = 4 * ((up ? rows - 1 - row : row) * columns + column);
        const tinted = least !== null && value >= least;
        image.data[to] = gray;
        image.data[to + 1] = gray + (tinted ? 22 : 0);
        image.data[to + 2] = gray + (tinted ? 60 : 0);
        image.data[to + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
    let count = 0;
    if (this.points) {
      context.fillStyle = SELECTED;
      for (let at = 0; at < this.points.length; at += 3) {
        if (this.points[at + axis] !== index) continue;
        count += 1;
        const row = this.points[at + along];
        context.fillRect(this.points[at + across], up ? rows - 1 - row : row, 1, 1);
      }
    }
    plane.caption.textContent = `${plane.name}, slice ${index}${this.points ? `: ${count} points` : ""}`;
  }
}
