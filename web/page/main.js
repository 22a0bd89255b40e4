// The page: what the user does, what the worker answers, and what is seen of it.

import { AlphaScale, Diagram, Histogram } from "./charts.js";
import { brief, grouped, measured, placed, short } from "./colours.js";
import { byId, download, element, remark, rows, setValue, showNotices, shown, unpacked, valuesOf } from "./dom.js";
import { Cancelled, Engine, Failure } from "./engine.js";
import { EXAMPLES } from "./examples.js";
import { History } from "./history.js";
import { lookNow, openDrawer, setLook, ShapePanel, wireDrawers } from "./shape.js";
import { Slices } from "./slices.js";
import { keepInput, keepState, restored, restoring } from "./store.js";

// The presets of the command for volumes, and for points.
const OF_VOLUMES = ["ct-bone", "ct-skin", "mri", "paper"];
const OF_POINTS = ["points", "molecule"];
// Names no simplex.
const NEVER = 0xffffffff;
const FORMATS = [
  ["ply", "PLY"], ["stl", "STL, solid"], ["3mf", "3MF"], ["glb", "GLB"], ["vtu", "VTU"], ["npz", "NPZ"], ["csv", "points, CSV"], ["wvm", "points, WVM"],
];

// Atoms whose balls are measured without being asked to.
const FEW_BALLS = 20000;

const state = { input: null, facts: null, grayMin: null, surface: null, opened: null, presets: {}, computed: null, kept: null, isHome: false };
let engine = null;
const panel = new ShapePanel({
  at: (alpha) => engine.call({ do: "at", alpha }),
  measure: (alpha) => engine.call({ do: "measure", alpha }),
  voids: (alpha, most) => engine.call({ do: "voids", alpha, most }),
  section: (alpha, axis, place) => engine.call({ do: "section", alpha, axis, place }),
}, {
  failed: quietly,
  moved: (alpha) => diagram.mark(alpha),
  rested: async () => {
    await command();
    history.note();
  },
  changed: () => history.later(),
});

// Shows what is being done, or that nothing is.
let working = false;
function busy(text) {
  working = text !== null;
  byId("working").hidden = !working;
  // What is shown of a shape that is gone, or not there yet, does nothing.
  byId("shape").inert = !panel.made;
  arrange();
  for (const id of ["alpha-row", "cut-row", "marks", "numbers", "output"]) byId(id).inert = working || !panel.made?.alphas;
  byId("slices").inert = working || !state.opened;
  document.body.dataset.state = text === null ? "ready" : "busy";
  if (text !== null) byId("status").textContent = text;
}

// What is there to open, over the picture or without one.
function arrange() {
  const isEmpty = !panel.made;
  // Without an input, or after one that cannot be read, there is one to choose; otherwise there are options to mend, or to try again.
  const isFree = isEmpty && (state.facts === null || state.facts.kind === "series");
  byId("drop").hidden = working || !(state.isHome || isFree);
  byId("open").hidden = isEmpty && !byId("drop").hidden;
  byId("open").ariaExpanded = !byId("drop").hidden;
  byId("open").disabled = working;
  byId("back").hidden = isEmpty;
  byId("history").hidden = isEmpty;
}

function goHome(isHome) {
  state.isHome = isHome;
  arrange();
}

function hideShape() {
  for (const id of ["shape", "alpha-row", "cut-row"]) byId(id).hidden = true;
}

function fail(error) {
  busy(null);
  // An input that cannot be read has no picture, and no options but those that may help.
  if (state.facts === null) {
    hideShape();
    offer(null, Object.keys(READING).filter((id) => error.next?.includes(`“${id}”`)));
  }
  if (error instanceof Cancelled) {
    const again = element("button", { type: "button", textContent: "Compute again", onclick: () => task("Computing …", compute) });
    byId("status").replaceChildren("Cancelled. ", ...(state.input === null ? [] : [again]));
    document.body.dataset.state = "cancelled";
    return;
  }
  document.body.dataset.state = "failed";
  byId("status").textContent = "";
  // What was changed since there was a shape may be at fault.
  if (state.computed) for (const field of changed(state.computed)) field.ariaInvalid = "true";
  show(error);
}

function show(error) {
  const failure = byId("failure");
  failure.replaceChildren(element("b", { textContent: error.message }));
  if (error.next) failure.append(element("div", { textContent: `Next: ${error.next}.` }));
  // Without a shape, there is something else to open; beside one, the message can go.
  const other = element("button", { type: "button", textContent: "Open another file", onclick: () => byId("files").click() });
  const close = element("button", { type: "button", textContent: "Close", onclick: () => { failure.hidden = true; busy(null); } });
  failure.append(other, close);
  failure.hidden = false;
  goHome(false);
  if (!(error instanceof Failure)) console.error(error);
}

const STAGES = {
  read: "Reading", haar: "Wavelets", points: "Selecting points", alpha: "Finding α", filtration: "Computing all shapes", curve: "Counting what each α changes",
  order: "Sorting simplices", pairs: "Pairing births and deaths", shape: "Computing the shape", measure: "Measuring balls",
};

function progress({ stage, share }) {
  const bar = byId("progress");
  // What is computed while nobody waits is not told.
  if (!working) return;
  if (stage !== undefined) {
    byId("status").textContent = `${STAGES[stage] ?? stage} …`;
    bar.removeAttribute("value");
  }
  if (share !== undefined) bar.value = share;
}

// Runs a task, which ends the one before; what goes wrong is shown in its place.
let tasks = 0;
async function task(text, work) {
  const mine = ++tasks;
  if (working) engine.cancel();
  byId("failure").hidden = true;
  const before = byId("status").textContent;
  busy(text);
  try {
    await work();
    if (mine !== tasks) return;
    busy(null);
    // What has nothing to say leaves what was said.
    if (byId("status").textContent.endsWith("…")) byId("status").textContent = before;
  } catch (error) {
    if (mine === tasks) fail(error);
  }
}

// After the worker has been ended.
function restarted() {
  state.opened = null;
  panel.clear();
}

// ---- Input

function factsOf(facts) {
  if (facts.kind === "points") {
    const extent = Math.max(...facts.high.map((high, k) => high - facts.low[k]));
    const corner = (at) => at.map((x) => placed(x, extent)).join(", ");
    return [
      ["input", inputName()], ["points", grouped(facts.count)], ["box", `${corner(facts.low)} to ${corner(facts.high)} ${facts.unit}`],
      ["also", [facts.weights && "weights", facts.values && "values"].filter(Boolean).join(", ") || "no weights, no values"],
      ...(facts.cell ? [["cell", facts.cell]] : []),
    ];
  }
  const list = [
    ["input", inputName()],
    ["volume", `${facts.dims.join("×")} samples (x, y, z) of type ${facts.samples}`],
    ["space", facts.coordinates.space],
    ["spacing", `${facts.spacing.map(short).join(", ")} ${facts.unit}`],
    ["origin", `${facts.origin.map(short).join(", ")} ${facts.unit}`],
  ];
  const straight = facts.direction.every((row, i) => row.every((x, j) => x === Number(i === j)));
  if (!straight) list.push(["axes", facts.direction[0].map((_, k) => facts.direction.map((row) => short(row[k])).join(" ")).join(" / ")]);
  list.push(["values", `${short(facts.low)} to ${short(facts.high)}`]);
  if (facts.missing) list.push(["missing", `${facts.missing} samples`]);
  if (facts.hounsfield) {
    const percent = (share) => `${Math.round(100 * share)} %`;
    list.push(["unit", `Hounsfield units: ${percent(facts.hounsfield.air)} air, ${percent(facts.hounsfield.softTissue)} soft tissue`]);
  }
  return list;
}

// The name of the input; what was made here can be saved.
function inputName() {
  if (!EXAMPLES.some(({ input, make }) => make && input === state.input)) return shown(state.input);
  const [{ file }] = engine.files;
  const button = element("button", { type: "button", textContent: "Save", onclick: () => download(file, file.name) });
  return element("span", {}, `${state.input} `, button);
}

// A file, several, or a folder, or a sample by its name; as it was kept, if it was.
function choose(input, files, kept = null) {
  if (!kept) keepInput(input, files, isMade(input));
  return task("Reading …", async () => {
    byId("remarks").replaceChildren();
    byId("series").replaceChildren();
    for (const id of Object.keys(READING)) {
      const value = kept?.form?.[id] ?? "";
      if (id === "series" && value) byId(id).append(element("option", { value }));
      byId(id).value = value;
    }
    Object.assign(state, { input, facts: null, opened: null, suited: false, computed: null, kept, isHome: false });
    history.forget();
    rows(byId("facts"), []);
    offer(null);
    hideShape();
    panel.clear();
    busy("Reading …");
    engine.put(files);
    await compute();
  });
}

// The options of how an input is read, and of which kinds.
const READING = { series: ["series"], frame: ["volume"], downsample: ["volume"], columns: ["points"] };

// Shows the options of a kind of input: how it is read, and what is made of it.
function offer(kind, others = []) {
  for (const [id, kinds] of Object.entries(READING)) {
    const isKnown = id === "series" && byId(id).options.length > 0;
    byId(id).parentElement.hidden = !(isKnown || kinds.includes(kind) || others.includes(id));
  }
  byId("of-volume").hidden = kind !== "volume";
  byId("of-points").hidden = kind !== "points";
  byId("of-shape").hidden = kind !== "volume" && kind !== "points";
  byId("options").hidden = kind === null && others.length === 0;
  byId("preset-label").hidden = kind !== "volume" && kind !== "points";
  // What has nothing in it has no drawer.
  const has = { input: kind !== null || others.length > 0, slices: kind === "volume", output: kind !== null, numbers: kind !== null, display: kind !== null };
  for (const [name, there] of Object.entries(has)) {
    document.querySelector(`[data-drawer="${name}"]`).hidden = !there;
    if (!there && !byId(name).hidden) openDrawer(name, false);
  }
  if (others.length > 0 || kind === "series") openDrawer("input", true);
}

function reading() {
  const given = (id) => (byId(id).value === "" ? undefined : byId(id).value);
  const number = (id) => (given(id) === undefined ? undefined : Number(given(id)));
  return { frame: number("frame"), downsample: number("downsample"), columns: given("columns"), series: given("series") };
}

// Reads the input; the first time, its options get the values that suit it.
async function open() {
  state.opened = null;
  panel.clear();
  const options = reading();
  let facts = await engine.open({ input: state.input, options });
  if (facts.kind === "large") {
    options.downsample = byId("downsample").value = facts.downsample;
    remark(`${facts.dims.join("×")} samples are too many for a page: ${options.downsample} along each axis become one`);
    facts = await engine.open({ input: state.input, options });
  }
  state.facts = facts;
  ({ presets: state.presets } = await engine.call({ do: "presets" }));
  state.opened = JSON.stringify(reading());
  offer(facts.kind);
  const isVolume = facts.kind === "volume";
  if (facts.kind === "series") {
    rows(byId("facts"), [["input", shown(state.input)], ["series", `${facts.series.length}: choose one below`]]);
    byId("series").replaceChildren(element("option", { value: "", textContent: "choose one" }), ...facts.series.map((series, k) =>
      element("option", { value: k + 1, textContent: `${k + 1}: ${Object.values(series).filter((x) => typeof x === "string").join(", ")}` })));
    return;
  }
  rows(byId("facts"), factsOf(facts));
  if (!state.suited) suit(facts);
  if (!state.suited && state.kept?.form) fill(state.kept.form);
  state.suited = true;
  labelled();
  if (isVolume) {
    histogram.set(facts.histogram, facts.low, facts.high);
    await slices.open(facts);
    marks();
  }
}

// The options that suit an input: a CT's bone, a molecule's balls, or the defaults.
function suit(facts) {
  const isVolume = facts.kind === "volume";
  const names = isVolume ? ["", ...OF_VOLUMES] : ["", ...OF_POINTS];
  byId("preset").replaceChildren(...names.map((name) => element("option", { value: name, textContent: name || "none" })));
  const labels = facts.labels?.map(([label, voxels]) => [String(label), `label ${label}, ${grouped(voxels)} voxels`]) ?? [];
  const choices = [["all", "all but 0"], ...labels, ["", "none: by gray levels"]];
  byId("labels").replaceChildren(...choices.map(([value, textContent]) => element("option", { value, textContent })));
  byId("labels").value = facts.labels ? "all" : "";
  const weights = [["", isVolume || !facts.weights ? "none" : "of the file"], ["common=0", "none"], ["min-max", "min-max (4.1)"], ["barycentric", "barycentric (4.2)"], ["barycentric-n", "barycentric, times N"]];
  const offered = isVolume || !facts.weights ? weights.filter(([name]) => name !== "common=0") : weights;
  byId("weights").replaceChildren(...offered.map(([value, textContent]) => element("option", { value, textContent })));
  const repeats = [["", "not"], ...(facts.cell ? [["cell", "in the cell of the file"]] : []), ["box", "in a box"]];
  byId("periodic").replaceChildren(...repeats.map(([value, textContent]) => element("option", { value, textContent })));
  byId("box").value = "";
  repeated();
  // Atoms are balls of their radii.
  apply(facts.hounsfield ? "ct-bone" : facts.atoms && facts.weights ? "molecule" : "");
}

// Fills the form with a preset.
function apply(name) {
  byId("preset").value = name;
  const preset = state.presets[name] ?? {};
  const [low, high] = preset.gray?.split("..") ?? ["", ""];
  [byId("gray-low").value, byId("gray-high").value] = [low, high];
  state.grayMin = preset["gray-min"] ? Number(preset["gray-min"]) : null;
  // An isosurface has no field: whatever is changed takes its place.
  state.surface = preset.surface ?? null;
  byId("value-min").value = state.grayMin === null ? "" : short(valueOf(state.grayMin));
  const rule = ["threshold", "count", "ratio"].find((rule) => preset[rule] !== undefined);
  byId("rule").value = rule ?? "ratio";
  byId("rule-value").value = rule ? preset[rule] : "";
  byId("rms").value = preset.rms ?? "";
  const weights = preset.weights ?? "";
  const offered = [...byId("weights").options].some((option) => option.value === weights);
  byId("weights").value = offered ? weights : "";
  // A column of weights is taken where there is one.
  if (weights === "column" && !state.facts.weights) remark(`the preset ${name} takes weights from the file, which has none`);
  byId("alpha-ref").value = preset.alpha ?? "";
  ruled();
  marks();
}

function ruled() {
  const rule = byId("rule").value;
  byId("rule-unit").textContent = { threshold: "gray levels", count: "samples", ratio: "of all" }[rule];
  byId("rule-value").ariaLabel = { threshold: "Least difference in gray levels", count: "Number of samples", ratio: "Share of all samples" }[rule];
  byId("rule-value").step = rule === "count" ? 1 : "any";
  byId("rule-value").placeholder = rule === "ratio" ? "0.0609" : "";
}

// The periodic box, as the command takes it.
const periodic = () => {
  const { value } = byId("periodic");
  return (value === "box" ? byId("box").value.trim() : value) || undefined;
};

// A part of a shape is kept in space alone.
function repeated() {
  byId("box-label").hidden = byId("periodic").value !== "box";
  byId("keep-label").hidden = state.facts?.kind === "points" && byId("periodic").value !== "";
  if (byId("keep-label").hidden) byId("keep-largest").checked = false;
}

// Whether the shape is the solid of labels, which no gray level, weight or α has a part in.
const ofLabels = () => state.facts?.kind === "volume" && byId("labels").value !== "";

function labelled() {
  byId("labels-label").hidden = !state.facts?.labels;
  byId("of-grays").hidden = ofLabels();
  byId("preset-label").hidden = ofLabels() || !["volume", "points"].includes(state.facts?.kind);
  byId("of-shape").hidden = ofLabels();
}

// The window: what is not given is the volume's.
const grayRange = () => {
  const own = state.facts.grayLevels ? [0, 255] : [state.facts.low, state.facts.high];
  return ["gray-low", "gray-high"].map((id, k) => (byId(id).value === "" ? own[k] : Number(byId(id).value)));
};
const valueOf = (gray) => {
  const [low, high] = grayRange();
  return low + gray / 255 * (high - low);
};
const least = () => {
  if (state.grayMin !== null) return valueOf(state.grayMin);
  return byId("value-min").value === "" ? null : Number(byId("value-min").value);
};

// The window and the lowest value, in the histogram and the slices.
function marks() {
  if (state.facts?.kind !== "volume") return;
  const [low, high] = grayRange();
  // Where lines lie upon one another the first is dragged.
  histogram.lines({ least: least() ?? low, low, high });
  slices.setWindow(low, high, least());
}

function optionsOfForm() {
  const given = (id) => (byId(id).value.trim() === "" ? undefined : byId(id).value.trim());
  const number = (id) => (given(id) === undefined ? undefined : Number(given(id)));
  const keep = byId("keep-largest").checked ? "largest" : undefined;
  const options = { ...reading(), weights: given("weights"), alpha: given("alpha-ref"), keep };
  if (state.facts.kind === "points") return { ...options, periodic: periodic() };
  if (ofLabels()) return { ...reading(), label: byId("labels").value, keep };
  if (state.surface) return { ...reading(), surface: state.surface, keep };
  if (given("gray-low") !== undefined || given("gray-high") !== undefined) options.gray = grayRange().join("..");
  if (state.grayMin !== null) options["gray-min"] = state.grayMin;
  else options["value-min"] = number("value-min");
  options[byId("rule").value] = number("rule-value");
  options.rms = number("rms");
  // Of a CT the command selects bone, unless something is stated.
  const stated = ["gray", "gray-min", "value-min", "threshold", "count", "ratio"].some((name) => options[name] !== undefined);
  if (state.facts.hounsfield && !stated) options.gray = grayRange().join("..");
  return options;
}

// ---- Shape

async function compute() {
  byId("remarks").replaceChildren();
  for (const field of fields()) field.ariaInvalid = null;
  pending(false);
  if (state.opened !== JSON.stringify(reading())) await open();
  if (state.facts.kind === "series") return;
  panel.clear();
  const form = formNow();
  const made = await engine.call({ do: "shape", options: optionsOfForm() });
  made.domain = made.cell ? "the periodic box" : state.facts.kind === "volume" && !made.labels ? "the volume" : "the box";
  state.toml = null;
  byId("command").textContent = "";
  // The first look, while the shapes at all other α are computed.
  panel.look(made);
  explain(made);
  suggestions([]);
  if (made.samples) slices.setPoints(made.samples);
  if (innerWidth < 760) byId("stage").scrollIntoView();
  busy(`${STAGES.filtration} …`);
  const all = await engine.call({ do: "filtration" });
  if (panel.made !== made) return;
  diagram.set(new AlphaScale({ ...made, ...all }), null);
  byId("diagram").hidden = true;
  byId("compute-diagram").hidden = Boolean(made.labels);
  for (const id of ["alpha-row", "marks"]) byId(id).hidden = Boolean(made.labels);
  for (const extension of ["csv", "wvm"]) byId(`save-${extension}`).hidden = Boolean(made.labels);
  // It states the whole shape, so that it can be checked.
  byId("save-npz").hidden = byId("keep-largest").checked;
  made.rows = [["points", grouped(made.points)], ["triangulation", `${grouped(all.cells)} cells`]];
  if (made.truncation) {
    const { kept, total } = made.truncation;
    made.rows.push(["detail kept", `${brief(100 * kept / total)} % of the wavelet coefficients`]);
  }
  byId("status").textContent = "";
  state.computed = form;
  await panel.open(all, diagram.scale);
  const { kept } = state;
  state.kept = null;
  if (kept?.shown) await showAgain(kept.shown);
  if (kept?.camera) panel.scene.look(kept.camera);
  restoring(false);
  byId("balls").hidden = !state.facts.weights || Boolean(made.labels);
  byId("balls-measured").replaceChildren();
  byId("balls-command").textContent = ballsCommand();
  byId("probe-unit").textContent = made.unit;
  if (made.labels) return;
  if (!byId("balls").hidden && made.points <= FEW_BALLS) balls(made).catch(quietly);
  // Nobody waits for these.
  engine.call({ do: "suggest" }).then((found) => {
    if (panel.made !== made) return;
    suggestions([
      ["all points from", found.all_points], ["one piece from", found.one_region], ["no void from", found.no_void], ["steadiest from", found.plateau[0]],
    ]);
  }, quietly);
}

// Volume and area of the union of the balls that the input has, as `walpha balls` measures them.
async function balls(made = panel.made) {
  const probe = Number(byId("probe").value) || 0;
  byId("balls-command").textContent = ballsCommand();
  const { volume, volumeBound, area, areaBound } = await engine.call({ do: "balls", probe });
  if (panel.made !== made || probe !== (Number(byId("probe").value) || 0)) return;
  rows(byId("balls-measured"), [["volume", measured(volume, made.unit, 3)], ["surface", measured(area, made.unit, 2)]]);
  byId("balls-measured").title = `${volume} ± ${volumeBound} ${made.unit}³, ${area} ± ${areaBound} ${made.unit}²`;
  document.body.dataset.balls = `${volume},${area}`;
  if (made.atoms && probe === 0) {
    made.union = { volume, area };
    panel.later();
  }
}

function ballsCommand() {
  const probe = Number(byId("probe").value) || 0;
  const box = periodic() === undefined ? "" : ` --periodic ${periodic()}`;
  return `walpha balls ${quotedInput()}${probe > 0 ? ` --probe ${probe}` : ""}${box}`;
}

// As `shell.rs` quotes it.
function quotedInput() {
  const { input } = state;
  const word = input.startsWith("-") ? `./${input}` : input;
  return /^[A-Za-z0-9_./:=,@%+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

// Buttons for α: the one that the shape opens at, and others at which something happens.
function suggestions(others) {
  const { reference, origin } = panel.made;
  const name = { default: "default", given: "given", stored: "stored" }[origin.origin] ?? "auto";
  const finite = [[name, reference], ...others].filter(([, alpha]) => Number.isFinite(alpha));
  const { unit } = panel.made;
  const told = (alpha) => (alpha >= 0 ? `${brief(Math.sqrt(alpha))} ${unit}` : `α = ${brief(alpha)}`);
  byId("marks").replaceChildren(...finite.map(([text, alpha]) =>
    element("button", { type: "button", textContent: `${text} ${told(alpha)}`, title: `α = ${alpha} ${unit}²`, onclick: () => panel.moveTo(alpha) })));
}

// What ends with a task that was cancelled is not a failure of its own.
function quietly(error) {
  if (!(error instanceof Cancelled)) show(error);
}

// ---- Output

// The name of a file to save: never that of the input, which the command would refuse to replace.
function nameOf(extension) {
  const stem = state.input.replace(/^.*[/:]/, "").replace(/(\.nii)?\.[^.]*$/, "").replace(/@.*/, "") || "shape";
  const name = `${stem}.${extension}`;
  return name === state.input ? `${stem}-shape.${extension}` : name;
}

// The command that makes a file of this name, and its recipe.
async function command(name = nameOf("ply"), alpha = panel.alpha, solid = false) {
  const { command: text, toml } = await engine.call({ do: "command", name, alpha, solid });
  byId("command").textContent = text;
  state.toml = toml;
}

async function save(extension) {
  const name = nameOf(extension);
  return task(`Writing ${shown(name)} …`, async () => {
    const { alpha } = panel;
    const solid = extension === "stl" || extension === "3mf";
    const { bytes, remarks } = await engine.call({ do: "save", name, alpha, solid });
    download(bytes, name);
    remarks.forEach(remark);
    await command(name, alpha, solid);
    document.body.dataset.saved = name;
    const said = byId("status").textContent = `${shown(name)}: ${(bytes.length / 1e6).toFixed(2)} MB.`;
    setTimeout(() => { if (byId("status").textContent === said) byId("status").textContent = ""; }, 8000);
  });
}

// ---- What the user does

const histogram = new Histogram(byId("histogram"), (mark, value, done) => {
  const shown = short(value);
  if (mark === "least") {
    state.grayMin = null;
    byId("value-min").value = shown;
  } else {
    // The lowest value stays where it is.
    keepLeast();
    byId(mark === "low" ? "gray-low" : "gray-high").value = shown;
  }
  byId("preset").value = "";
  state.surface = null;
  marks();
  if (done) byId("options").requestSubmit();
});
const diagram = new Diagram(byId("diagram"), async (alpha, near) => {
  const { dimension, pair: [, , simplex] } = near;
  try {
    await panel.setAlpha(alpha);
    if (dimension === 0 || simplex === NEVER) return panel.showCycle(null);
    const { places } = await engine.call({ do: "cycle", dimension, simplex });
    if (panel.alpha !== alpha || places.length === 0) return undefined;
    document.body.dataset.cycle = `${dimension},${places.length / 3}`;
    const of = dimension === 1 ? `a closed way along ${places.length / 3 - 1} edges` : `its boundary, ${places.length / 9} triangles`;
    return panel.showCycle({ isWalk: dimension === 1, places, text: `${diagram.tell(near)}: ${of}. Escape hides it.` });
  } catch (error) {
    return quietly(error);
  }
});
let slices = null;

// ---- What was before

const history = new History(
  () => (state.computed && panel.alpha !== null && panel.made?.alphas ? { form: state.computed, shown: shownNow() } : null),
  (now, before) => {
    if (JSON.stringify(now.form) === JSON.stringify(before.form)) return showAgain(now.shown).catch(quietly);
    return task("Computing …", async () => {
      fill(now.form);
      await compute();
      await showAgain(now.shown);
    });
  },
  persist,
);

function persist() {
  if (!state.computed || !panel.made?.alphas) return;
  keepState({ form: state.computed, shown: shownNow(), camera: panel.scene.seenFrom() });
}

// The form as it is, with what no field of it has.
const fields = () => [byId("preset"), ...byId("options").querySelectorAll("input, select")];

// The fields that are not as in a form.
const changed = (form) => fields().filter((field) => field.id in form && valuesOf([field])[field.id] !== form[field.id]);

function formNow() {
  const { grayMin, surface } = state;
  return { ...valuesOf(fields()), grayMin, surface };
}

function fill({ grayMin, surface, ...values }) {
  for (const field of fields()) if (field.id in values) setValue(field, values[field.id]);
  Object.assign(state, { grayMin, surface });
  ruled();
  labelled();
  repeated();
  marks();
}

// What is seen of a shape.
const shownNow = () => ({ alpha: panel.alpha, look: lookNow() });

async function showAgain({ alpha, look }) {
  setLook(look);
  if (alpha !== panel.alpha) await panel.setAlpha(alpha);
}

// What the shape is of, where that may surprise. Values without a unit are treated as in the paper unless the form says more,
// and people expect an object.
function explain({ labels: solid, kept }) {
  const { kind, hounsfield, labels } = state.facts;
  const stated = Object.entries(optionsOfForm()).some(([name, value]) => value !== undefined && !(name in READING));
  const asInPaper = kind === "volume" && !hounsfield && !labels && !stated;
  const what = asInPaper ? "samples are selected by their gray differences, as in the paper" : solid;
  const sentences = [what, kept].filter(Boolean).map((text) => `${text[0].toUpperCase()}${text.slice(1)}.`);
  byId("made").firstElementChild.textContent = sentences.join(" ");
  byId("object").hidden = !asInPaper;
  byId("made").hidden = sentences.length === 0;
}

// Whether the form says other than what is shown.
function pending(isPending) {
  const submit = byId("options").querySelector("[type=submit]");
  submit.classList.toggle("pending", isPending);
  submit.textContent = isPending ? "Apply changes" : "Compute";
}

const isMade = (input) => /^(sample|hard):/.test(input) || EXAMPLES.some((example) => example.input === input && example.make);

function keepLeast() {
  if (state.grayMin === null) return;
  byId("value-min").value = short(valueOf(state.grayMin));
  state.grayMin = null;
}

function wire() {
  byId("options").addEventListener("submit", (event) => {
    event.preventDefault();
    return task("Computing …", compute);
  });
  byId("cancel").addEventListener("click", () => engine.cancel());
  byId("options").addEventListener("input", () => pending(true));
  byId("probe").addEventListener("change", () => balls().catch(quietly));
  byId("open").addEventListener("click", () => goHome(byId("drop").hidden));
  byId("back").addEventListener("click", () => goHome(false));
  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && state.isHome) goHome(false);
  });
  addEventListener("pagehide", persist);
  for (const id of ["of-grays", "of-shape"]) {
    byId(id).addEventListener("input", ({ target }) => {
      if (target !== byId("preset")) state.surface = null;
    });
  }
  byId("preset").addEventListener("change", () => {
    apply(byId("preset").value);
    byId("options").requestSubmit();
  });
  byId("object").addEventListener("click", () => {
    apply("mri");
    byId("options").requestSubmit();
  });
  byId("rule").addEventListener("change", ruled);
  byId("periodic").addEventListener("change", repeated);
  byId("labels").addEventListener("change", labelled);
  byId("value-min").addEventListener("input", () => { state.grayMin = null; marks(); });
  for (const id of ["gray-low", "gray-high"]) byId(id).addEventListener("input", () => { keepLeast(); marks(); });
  byId("series").addEventListener("change", () => {
    state.suited = false;
    return task("Reading …", compute);
  });
  byId("alpha-value").addEventListener("change", ({ target }) => target.value !== "" && panel.moveTo(Number(target.value)));
  byId("save-png").addEventListener("click", () => panel.savePicture(nameOf("png")));
  byId("compute-diagram").addEventListener("click", () => task("Sorting simplices …", async () => {
    const found = await engine.call({ do: "diagram" });
    const pairs = [0, 1, 2].map((dimension) => {
      const [flat, simplices] = [found[`pairs${dimension}`], found[`simplices${dimension}`]];
      return Array.from(simplices, (simplex, k) => [flat[2 * k], flat[2 * k + 1], simplex]);
    });
    byId("diagram").hidden = false;
    byId("compute-diagram").hidden = true;
    diagram.set(diagram.scale, pairs, panel.made.unit);
    document.body.dataset.pairs = pairs.map((list) => list.length).join(",");
  }));
  byId("formats").replaceChildren(...FORMATS.map(([extension, name]) =>
    element("button", { type: "button", id: `save-${extension}`, textContent: name, onclick: () => save(extension) })));
  byId("save-toml").addEventListener("click", () => state.toml && download(state.toml, "recipe.toml"));
  showNotices();
  byId("copy").addEventListener("click", async () => {
    await navigator.clipboard?.writeText(byId("command").textContent);
    byId("copy").textContent = "Copied";
    setTimeout(() => { byId("copy").textContent = "Copy"; }, 1500);
  });

  const chosen = (list) => {
    const files = [...list].filter((file) => !file.name.startsWith("."));
    if (files.length === 0) return undefined;
    const entries = files.map((file) => ({ path: file.webkitRelativePath || file.name, file }));
    return take(entries);
  };
  for (const [button, input] of [["choose", "files"], ["choose-folder", "folder"]]) {
    byId(button).addEventListener("click", () => byId(input).click());
    byId(input).addEventListener("change", () => { chosen(byId(input).files); byId(input).value = ""; });
  }
  addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("over"); });
  addEventListener("dragleave", () => document.body.classList.remove("over"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("over");
    // All that is asked of an item has to be asked at once.
    const dropped = [...event.dataTransfer.items].filter((item) => item.kind === "file").map((item) => {
      const entry = item.webkitGetAsEntry?.();
      return entry?.isDirectory ? { entry, handle: item.getAsFileSystemHandle?.() } : { file: item.getAsFile() };
    });
    return Promise.all(dropped.map(filesOf)).then((files) => take(files.flat())).catch(quietly);
  });
  const show = (example) => choose(example.input, filesOfExample(example));
  byId("examples").append(...EXAMPLES.map(({ input, name }) => element("option", { value: input, textContent: name })));
  byId("examples").addEventListener("change", ({ target }) => {
    const example = EXAMPLES.find(({ input }) => input === target.value);
    target.value = "";
    if (example) show(example);
  });
  byId("cards").replaceChildren(...EXAMPLES.filter(({ card }) => card).map((example) => {
    const { title, text, picture } = example.card;
    const card = element("button", { type: "button", onclick: () => show(example) }, element("b", { textContent: title }), element("span", { textContent: text }));
    card.insertAdjacentHTML("afterbegin", picture);
    return card;
  }));
  wireDrawers();
  offer(null);
}

const filesOfExample = ({ input, make }) => (make ? [{ path: input, file: new File([make()], input) }] : []);

// What a reload has lost, as it was; or a card for it, if its bytes were not kept or it has ended the page before.
async function reopen() {
  const kept = await restored();
  if (!kept) return;
  const { input, files, state: before = null, failed } = kept;
  const example = EXAMPLES.find((example) => kept.isMade && example.input === input);
  const go = (found) => {
    restoring(true);
    return choose(input, found, before ?? {});
  };
  const known = example ? filesOfExample(example) : files;
  if (known && !failed) return go(known);
  const card = element("button", { type: "button", id: "reopen" }, element("b", { textContent: `Reopen ${shown(input)}` }),
    element("span", { textContent: known ? "as it was before the reload" : "Choose it again: it is shown as it was before the reload" }));
  card.addEventListener("click", () => {
    if (known) return go(known);
    state.reopening = { input, before };
    return byId(input.includes(".") ? "files" : "folder").click();
  });
  byId("cards").prepend(card);
  return undefined;
}

// What was dropped, with paths: a file, or those of a folder. Chromium opens no entries of pages from disk, but has handles.
async function filesOf({ file, entry, handle }) {
  if (file) return file.name.startsWith(".") ? [] : [{ path: file.name, file }];
  const folder = await handle;
  return folder ? ofHandle(folder, "") : ofEntry(entry);
}

async function ofHandle(handle, parent) {
  const path = parent + handle.name;
  if (handle.kind === "file") return filesOf({ file: await handle.getFile() }).then((files) => files.map(({ file }) => ({ path, file })));
  const all = [];
  for await (const child of handle.values()) all.push(...await ofHandle(child, `${path}/`));
  return all;
}

async function ofEntry(entry) {
  const path = entry.fullPath.replace(/^\//, "");
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    return file.name.startsWith(".") ? [] : [{ path, file }];
  }
  const reader = entry.createReader();
  const all = [];
  // A reader gives a hundred entries at a time.
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...(await Promise.all(some.map(ofEntry))).flat());
  }
}

// Headers whose samples may lie in a file beside them.
const HEADERS = /\.(nhdr|mhd|hdr)$/i;
// What is one input: a file, a header with the file beside it, or a folder of slices.
function take(files) {
  if (files.length === 0) return undefined;
  const [first] = files;
  const folder = first.path.includes("/") ? first.path.slice(0, first.path.indexOf("/")) : null;
  if (folder !== null) return choose(folder, files);
  const header = files.find(({ path }) => HEADERS.test(path));
  if (files.length === 1 || header) {
    const input = (header ?? first).path;
    const again = state.reopening?.input === input ? state.reopening.before : null;
    state.reopening = null;
    if (again) keepInput(input, files, false);
    return choose(input, files, again);
  }
  // Slices, chosen one by one: for the command they have to lie in a folder.
  return choose("slices", files.map(({ path, file }) => ({ path: `slices/${path}`, file })));
}

try {
  const module = await WebAssembly.compile(await unpacked("wasm"));
  engine = new Engine(module, byId("worker").textContent, { progress, remark, restarted });
  slices = new Slices(byId("planes"), engine, quietly);
  wire();
  document.body.dataset.state = "ready";
  await reopen();
} catch (error) {
  fail(error);
}
