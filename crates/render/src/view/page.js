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
  // Points have a trace for each class.
  const [REGULAR, SINGULAR, EDGES, POINTS, ISOSURFACE] = [0, 1, 2, 3, 6];
  const EVEN = { ...plot.data[REGULAR].lighting, ambient: 0.93, diffuse: 0.18, specular: 0, roughness: 1 };
  const CLASSES = ["exterior", "interior", "regular", "singular"];
  const classAt = (spans, row, level) => {
    const [first, regular, interior] = [spans[3 * row], spans[3 * row + 1], spans[3 * row + 2]];
    return level < first ? 0 : level < regular ? 3 : level < interior ? 2 : 1;
  };

  const corners = (facets) => {
    const corner = (k) => Uint32Array.from({ length: facets.length / 3 }, (_, row) => facets[3 * row + k]);
    return { i: corner(0), j: corner(1), k: corner(2) };
  };
  function range(numbers) {
    let [least, most] = [Infinity, -Infinity];
    for (const number of numbers) {
      if (number < least) least = number;
      if (number > most) most = number;
    }
    return [least, most];
  }
  // Marker diameters: the weight as an area, from 2 to 9 pixels.
  function diameters(weights) {
    const [least, most] = range(weights);
    return Array.from(weights, (weight) =>
      most > least ? 2 + 7 * Math.sqrt((weight - least) / (most - least)) : 3);
  }
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

  // Texts of points are written when the pointer comes: nobody waits for them.
  let unwritten = [];
  function textOf(points, level) {
    const text = new Array(points.length);
    unwritten.push(() => points.forEach((v, k) => { text[k] = words(v, level); }));
    return text;
  }
  function writeTexts() {
    for (const write of unwritten) write();
    unwritten = [];
  }

  function words(v, level) {
    const value = data.values ? `<br>F = ${short(data.values[v])}` : "";
    const difference = data.differences ? `<br>difference ${short(data.differences[v])}` : "";
    const kind = CLASSES[classAt(data.pointSpans, v, level)];
    return `point ${v}${value}${difference}<br>ω = ${short(data.weights[v])}<br>${kind}`;
  }

  const pick = (values, points) => Float32Array.from(points, (v) => values[v]);
  const places = (points) =>
    Object.fromEntries(["x", "y", "z"].map((axis) => [axis, pick(data[axis], points)]));

  // A mesh has no points but its own: each costs time, drawn or not.
  function facetsAt(level, wanted, scale) {
    const points = [];
    const facets = [];
    const numbers = new Int32Array(data.count).fill(-1);
    for (let row = 0; 3 * row < data.facets.length; row++) {
      if (classAt(data.facetSpans, row, level) !== wanted) continue;
      for (let k = 0; k < 3; k++) {
        const v = data.facets[3 * row + k];
        if (numbers[v] < 0) numbers[v] = points.push(v) - 1;
        facets.push(numbers[v]);
      }
    }
    const mesh = { ...places(points), text: textOf(points, level), ...corners(facets) };
    // Nearly without shades: a colour means a value, wherever the facet looks.
    return scale ? { ...mesh, intensity: pick(scale, points), lighting: EVEN } : mesh;
  }

  // The same at all levels.
  const whole = surface && (({ facets, ...places }) => ({ ...places, ...corners(facets) }))(unpackAll(surface));

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

  // Those of one class, or of all that the shape has.
  function pointsAt(level, wanted) {
    const points = [];
    for (let v = 0; v < data.count; v++) {
      const kind = classAt(data.pointSpans, v, level);
      if (kind !== 0 && (wanted === undefined || kind === wanted)) points.push(v);
    }
    return points;
  }

  function markers(points, level, colour) {
    const marker = { ...colour, size: pick(data.sizes, points), line: { width: 0 } };
    return { ...places(points), text: textOf(points, level), marker };
  }

  // What was switched on or off stays so, also where there is nothing of it.
  const visible = plot.data.map((trace) => trace.visible ?? true);
  function remember() {
    (scene.data ?? []).forEach((trace, k) => {
      if (trace.visible !== false) visible[k] = trace.visible ?? true;
    });
    // Points are one thing, whatever their traces.
    const points = [POINTS, POINTS + 1, POINTS + 2];
    const shown = points.some((k) => scene.data?.[k].visible === true) ? true : "legendonly";
    for (const k of points) visible[k] = shown;
  }
  // Traces that are filled only when they are shown.
  const shown = () => [POINTS, ISOSURFACE].filter((k) => visible[k] === true).join(" ");

  function fill(level, name) {
    const scale = data.scales[name];
    unwritten = [];
    const traces = plot.data.map((trace, k) => ({ ...trace, visible: visible[k] }));
    // What is not there is not in the legend either.
    const put = (k, content) => {
      if (content.x.length === 0) traces[k].visible = false;
      Object.assign(traces[k], content);
    };
    const [cmin, cmax] = scale ? range(scale) : [];
    for (const [trace, wanted] of [[REGULAR, 2], [SINGULAR, 3]]) {
      const mesh = facetsAt(level, wanted, scale);
      if (!scale) for (const key of ["colorscale", "intensitymode"]) delete traces[trace][key];
      put(trace, scale ? { ...mesh, cmin, cmax } : mesh);
    }
    put(EDGES, linesAt(level));
    // Hidden points are only counted.
    const hidden = visible[POINTS] !== true;
    for (const kind of [1, 2, 3]) {
      const trace = POINTS + kind - 1;
      if (scale && kind > 1) {
        traces[trace].visible = false;
        continue;
      }
      const points = pointsAt(level, scale ? undefined : kind);
      const colour = scale
        ? { color: pick(scale, points), colorscale: "Viridis", cmin, cmax }
        : { color: colours[kind - 1] };
      if (scale) traces[trace].name = "points";
      put(trace, markers(hidden ? points.slice(0, 1) : points, level, colour));
    }
    if (whole) put(ISOSURFACE, whole);
    // One scale for all, at the first that is coloured by it.
    const barred = [REGULAR, SINGULAR].find((k) => traces[k].visible !== false);
    for (const k of [REGULAR, SINGULAR]) {
      traces[k].showscale = scale !== undefined && k === barred;
      const { colorbar } = plot.data[REGULAR];
      if (scale) traces[k].colorbar = { ...colorbar, title: { ...colorbar.title, text: bars[name] } };
      else delete traces[k].colorbar;
    }
    return traces;
  }

  const byId = (id) => document.getElementById(id);
  const [scene, slider, colour, play, choice] =
    ["scene", "level", "colour", "play", "detail"].map(byId);

  // The box around what is shown, with sides as long as its longest is 1.
  const AXES = ["x", "y", "z"];
  let sides = [1, 1, 1];
  function box() {
    const parts = visible[ISOSURFACE] === true ? [data, whole] : [data];
    const ranges = AXES.map((axis) => {
      const each = parts.map((part) => range(part[axis]));
      return [Math.min(...each.map(([low]) => low)), Math.max(...each.map(([, high]) => high))];
    });
    const longest = Math.max(...ranges.map(([low, high]) => high - low)) || 1;
    // Room beside the points, and something to see of what is flat.
    const padded = ranges.map(([low, high]) => {
      const room = Math.max((high - low) / 32, (longest / 8 - (high - low)) / 2);
      return [low - room, high + room];
    });
    const longestPadded = Math.max(...padded.map(([low, high]) => high - low));
    sides = padded.map(([low, high]) => (high - low) / longestPadded);
    AXES.forEach((axis, k) => {
      Object.assign(plot.layout.scene[`${axis}axis`], { range: padded[k], nticks: 2 + Math.round(4 * sides[k]) });
    });
    plot.layout.scene.aspectratio = Object.fromEntries(AXES.map((axis, k) => [axis, sides[k]]));
  }

  // The camera looks from one side, from higher above what is flatter, and so near that the box and its labels
  // just fit.
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const scaled = (a, s) => a.map((x) => x * s);
  const sum = (...all) => [0, 1, 2].map((k) => all.reduce((total, a) => total + a[k], 0));
  const unit = (a) => scaled(a, 1 / Math.hypot(...a));
  const cross = (a, b) => [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
  const { x, y, z } = plot.layout.scene.camera.eye;
  function directions() {
    const flatness = 1 - Math.min(1, sides[2] / Math.max(sides[0], sides[1]));
    const towards = unit([-x, -y, -z - flatness]);
    const right = unit(cross(towards, [0, 0, 1]));
    return { towards, right, up: cross(right, towards) };
  }
  // Pixels that labels take beside the box.
  const LABELS = { left: 44, right: 54, top: 8, bottom: 36 };
  function fit(width, height) {
    const { towards, right, up } = directions();
    // plotly's field of view is 45° high.
    const focus = height / 2 / Math.tan(Math.PI / 8);
    const box = [...Array(8).keys()].map((n) => sides.map((side, k) => (n >> k & 1 ? side : -side) / 2));
    // At distance d and offset o, a corner c is at focus · (c·axis − o) / (d + c·towards).
    const along = (axis, low, high) => {
      const edge = (bound) => box.map((c) => dot(c, axis) - bound / focus * dot(c, towards));
      const [most, least] = [Math.max(...edge(high)), Math.min(...edge(low))];
      const offset = (d) => (most + least - (low + high) / focus * d) / 2;
      return { distance: focus * (most - least) / (high - low), offset };
    };
    const across = along(right, LABELS.left - width / 2, width / 2 - LABELS.right);
    const upward = along(up, LABELS.bottom - height / 2, height / 2 - LABELS.top);
    // Nearer than this, perspective distorts.
    const least = Math.hypot(...sides);
    const distance = Math.max(across.distance, upward.distance, least);
    const centre = sum(scaled(right, across.offset(distance)), scaled(up, upward.offset(distance)));
    const spare = across.distance > Math.max(upward.distance, least);
    return { centre, eye: sum(centre, scaled(towards, -distance)), spare };
  }

  // Legend and colour bar, in pixels.
  const beside = () => (scene.clientWidth < 600 ? 48 : 30) + (data.scales[colour.value] ? 62 : 10);
  const [LEAST, STEP] = [160, 8];

  // Nothing is left empty above and below what the width allows. The camera found here is home, whatever is chosen later.
  let home = null;
  function settle() {
    scene.style.height = "";
    const width = scene.clientWidth;
    let height = scene.clientHeight - beside();
    while (height > LEAST && fit(width, height).spare) height -= STEP;
    scene.style.height = `${height + beside()}px`;
    const { centre, eye } = fit(width, height);
    const place = (at) => Object.fromEntries(AXES.map((axis, k) => [axis, at[k]]));
    home = { center: place(centre), eye: place(eye), up: place([0, 0, 1]) };
  }

  async function show() {
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
    remember();
    box();
    const traces = fill(level, colour.value);
    if (colour.value === scene.dataset.colour) return Plotly.react(scene, traces, plot.layout, plot.config);
    // A mesh that had a colour scale keeps it, so that other colours need another mesh. The camera stays.
    if (!scene.data) settle();
    plot.layout.scene.camera = scene._fullLayout?.scene?.camera ?? structuredClone(home);
    await Plotly.newPlot(scene, traces, plot.layout, plot.config);
    scene.on("plotly_restyle", () => {
      remember();
      if (shown() !== scene.dataset.shown) refresh();
    });
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
      Object.assign(scene.dataset, now, { shown: shown() });
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
  const goHome = () => Plotly.relayout(scene, { "scene.camera": structuredClone(home) });
  for (const event of ["pointermove", "pointerdown"]) scene.addEventListener(event, writeTexts, true);
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width || !scene.data) return undefined;
    width = innerWidth;
    settle();
    return goHome();
  });
  byId("reset").addEventListener("click", goHome);
  byId("save").addEventListener("click", () => Plotly.downloadImage(scene, {
    format: "png", filename: `${document.title}, ${detail.levels[Number(slider.value)].name}`, scale: 2,
    width: scene.clientWidth, height: scene.clientHeight,
  }));
  open(details.length - 1);
  [slider.max, slider.value] = [detail.levels.length - 1, detail.first];
  refresh();
})();
