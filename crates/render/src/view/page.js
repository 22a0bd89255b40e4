"use strict";
(() => {
  const json = (id) => JSON.parse(document.getElementById(id).textContent);
  const plot = json("plot");
  const { details, isosurface: surface, colours, bars } = json("data");
  const unpack = ({ kind, base64 }) => {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    return new globalThis[kind](bytes.buffer);
  };
  const unpackAll = (arrays) =>
    Object.fromEntries(Object.entries(arrays).map(([name, array]) => [name, unpack(array)]));
  const [BOUNDARY, SINGULAR, EDGES, POINTS, ISOSURFACE] = [0, 1, 2, 3, 4];
  const EVEN = { ambient: 0.93, diffuse: 0.18, specular: 0, roughness: 1 };
  const CLASSES = ["exterior", "interior", "regular", "singular"];
  const classAt = (spans, row, level) => {
    const [first, regular, interior] = [spans[3 * row], spans[3 * row + 1], spans[3 * row + 2]];
    return level < first ? 0 : level < regular ? 3 : level < interior ? 2 : 1;
  };

  // Marker diameters: the weight as an area, from 2 to 9 pixels.
  function diameters(weights) {
    let [least, most] = [Infinity, -Infinity];
    for (const weight of weights) [least, most] = [Math.min(least, weight), Math.max(most, weight)];
    return Array.from(weights, (weight) =>
      most > least ? 2 + 7 * Math.sqrt((weight - least) / (most - least)) : 3);
  }
  const corners = (facets, rows) => {
    const corner = (k) => Uint32Array.from(rows, (row) => facets[3 * row + k]);
    return { i: corner(0), j: corner(1), k: corner(2) };
  };
  const short = (number) => Number(number.toPrecision(4)).toString();

  // The level of detail that is shown, unpacked when first chosen.
  let [detail, data] = [null, null];
  function open(chosen) {
    detail = details[chosen];
    if (!detail.data) {
      const unpacked = unpackAll(detail.arrays);
      // What facets and points may be coloured by, besides their class.
      const scales = { value: unpacked.values, difference: unpacked.differences };
      detail.data = { ...unpacked, scales, sizes: diameters(unpacked.weights), count: unpacked.x.length };
      delete detail.arrays;
    }
    data = detail.data;
  }

  function facetsAt(level, wanted) {
    const rows = [];
    for (let row = 0; 3 * row < data.facets.length; row++) {
      if (classAt(data.facetSpans, row, level) === wanted) rows.push(row);
    }
    return corners(data.facets, rows);
  }

  // The same at all levels.
  function whole(arrays) {
    const { x, y, z, facets } = unpackAll(arrays);
    return { x, y, z, ...corners(facets, [...Array(facets.length / 3).keys()]) };
  }
  const isosurface = surface && whole(surface);

  function linesAt(level) {
    const line = { x: [], y: [], z: [] };
    for (let row = 0; 2 * row < data.edges.length; row++) {
      if (classAt(data.edgeSpans, row, level) !== 3) continue;
      for (const axis of ["x", "y", "z"]) {
        line[axis].push(data[axis][data.edges[2 * row]], data[axis][data.edges[2 * row + 1]], null);
      }
    }
    return line;
  }

  function words(level) {
    const text = new Array(data.count);
    for (let v = 0; v < data.count; v++) {
      const value = data.values ? `<br>F = ${short(data.values[v])}` : "";
      const difference = data.differences ? `<br>difference ${short(data.differences[v])}` : "";
      const kind = CLASSES[classAt(data.pointSpans, v, level)];
      text[v] = `point ${v}${value}${difference}<br>ω = ${short(data.weights[v])}<br>${kind}`;
    }
    return text;
  }

  function pointsAt(level, text, scale) {
    const shown = [];
    for (let v = 0; v < data.count; v++) if (classAt(data.pointSpans, v, level) !== 0) shown.push(v);
    const pick = (values) => shown.map((v) => values[v]);
    const kind = (v) => colours[classAt(data.pointSpans, v, level) - 1];
    const colour = scale
      ? { color: pick(scale), colorscale: "Viridis" }
      : { color: shown.map(kind) };
    return {
      x: pick(data.x), y: pick(data.y), z: pick(data.z), text: pick(text),
      marker: { ...colour, size: pick(data.sizes), line: { width: 0 } },
    };
  }

  function fill(level, name) {
    const scale = data.scales[name];
    const text = words(level);
    const traces = plot.data.map((trace) => ({ ...trace }));
    for (const [trace, wanted] of [[BOUNDARY, 2], [SINGULAR, 3]]) {
      Object.assign(traces[trace], { x: data.x, y: data.y, z: data.z, text }, facetsAt(level, wanted));
      if (scale) {
        // Nearly without shades: a colour means a value, wherever the facet looks.
        Object.assign(traces[trace], { intensity: scale, lighting: EVEN });
      } else {
        for (const key of ["colorscale", "intensitymode", "colorbar"]) delete traces[trace][key];
        traces[trace].showscale = false;
      }
    }
    if (scale) {
      const { colorbar } = traces[BOUNDARY];
      traces[BOUNDARY].colorbar = { ...colorbar, title: { ...colorbar.title, text: bars[name] } };
    }
    Object.assign(traces[EDGES], linesAt(level));
    Object.assign(traces[POINTS], pointsAt(level, text, scale));
    if (isosurface) Object.assign(traces[ISOSURFACE], isosurface);
    return traces;
  }

  const byId = (id) => document.getElementById(id);
  const [scene, slider, colour, play, choice] =
    ["scene", "level", "colour", "play", "detail"].map(byId);

  // The eye, so far away that all is seen however narrow the scene is.
  const home = plot.layout.scene.camera;
  function camera() {
    const narrow = Math.max(1, 1.35 * scene.clientHeight / scene.clientWidth);
    const eye = Object.fromEntries(["x", "y", "z"].map((axis) => [axis, narrow * home.eye[axis]]));
    return { ...structuredClone(home), eye };
  }

  function show() {
    const level = Number(slider.value);
    if (byId("simplified")) {
      byId("simplified").textContent = detail.simplified ? `This picture is ${detail.simplified}.` : "";
    }
    const { name, rows } = detail.levels[level];
    byId("name").textContent = name;
    byId("numbers").replaceChildren(...[...detail.rows, ...rows].map(([head, value]) => {
      const row = document.createElement("tr");
      row.append(document.createElement("th"), document.createElement("td"));
      [row.firstChild.textContent, row.lastChild.textContent] = [head, value];
      return row;
    }));
    const traces = fill(level, colour.value);
    // What was switched on or off stays so, and the camera where it is.
    (scene.data ?? []).forEach((trace, k) => { traces[k].visible = trace.visible; });
    if (colour.value === scene.dataset.colour) return Plotly.react(scene, traces, plot.layout, plot.config);
    // A mesh that had a colour scale keeps it, so that other colours need another mesh.
    plot.layout.scene.camera = scene._fullLayout?.scene?.camera ?? camera();
    return Plotly.newPlot(scene, traces, plot.layout, plot.config);
  }

  plot.layout.uirevision = "the same scene";
  // As many pixels as the screen has; without a word plotly draws four times as many.
  plot.config.plotGlPixelRatio = Math.min(2, devicePixelRatio);
  // While one level is being drawn only the last asked for waits.
  let [busy, again] = [false, false];
  async function refresh() {
    if (busy) { again = true; return; }
    busy = true;
    do {
      again = false;
      const now = { level: slider.value, colour: colour.value, detail: choice?.value ?? "0" };
      await show();
      Object.assign(scene.dataset, now);
    } while (again);
    busy = false;
  }
  colour.addEventListener("change", refresh);

  // Another level of detail has other levels of α: the last up to the one before is shown.
  function change() {
    const { alpha } = detail.levels[Number(slider.value)];
    open(Number(choice.value));
    const above = detail.levels.findIndex((level) => level.alpha > alpha);
    slider.max = detail.levels.length - 1;
    slider.value = Math.max(0, (above < 0 ? detail.levels.length : above) - 1);
  }
  choice?.addEventListener("change", () => {
    stop();
    change();
    return refresh();
  });

  // From where the slider is to its end, from the start if it is there already.
  let playing = null;
  function stop() {
    clearInterval(playing);
    playing = null;
    play.textContent = "Play";
  }
  function step() {
    if (Number(slider.value) >= Number(slider.max)) return stop();
    if (busy) return undefined;
    slider.value = Number(slider.value) + 1;
    return refresh();
  }
  play.addEventListener("click", () => {
    if (playing !== null) return stop();
    if (slider.value === slider.max) slider.value = 0;
    play.textContent = "Stop";
    playing = setInterval(step, 700);
    return refresh();
  });
  slider.addEventListener("input", () => {
    stop();
    return refresh();
  });
  byId("reset").addEventListener("click", () => Plotly.relayout(scene, { "scene.camera": camera() }));
  byId("save").addEventListener("click", () => Plotly.downloadImage(scene, {
    format: "png", filename: `${document.title}, ${detail.levels[Number(slider.value)].name}`, scale: 2,
    width: scene.clientWidth, height: scene.clientHeight,
  }));
  open(details.length - 1);
  [slider.max, slider.value] = [detail.levels.length - 1, detail.first];
  refresh();
})();
