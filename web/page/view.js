// The page that `walpha view` writes: shapes at several α, with their numbers, are in it.

import { StopScale } from "./charts.js";
import { EXTERIOR, grouped, HIDDEN, INTERIOR, REGULAR, SINGULAR } from "./colours.js";
import { byId, element, remark, rows, showNotices, unpacked } from "./dom.js";
import { History } from "./history.js";
import { lookNow, setLook, ShapePanel, wireDrawers } from "./shape.js";

// The first level of what is in no shape, whatever α: the point is hidden.
const NEVER = 255;

// What lies packed in an element: a length, JSON of this length, and the arrays that it names, each at a multiple of eight bytes.
async function open(id) {
  const buffer = await unpacked(id);
  const [length] = new Uint32Array(buffer, 0, 1);
  const { arrays, ...content } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const start = 8 * Math.ceil((4 + length) / 8);
  for (const [name, { kind, at, length: count }] of Object.entries(arrays)) {
    content[name] = new globalThis[kind](buffer, start + at, count);
  }
  return content;
}

// The class of a simplex at a level: three levels say when it enters, is on the boundary, and is within.
function classAt(spans, row, level) {
  const first = spans[3 * row];
  if (level < first) return first === NEVER ? HIDDEN : EXTERIOR;
  return level < spans[3 * row + 1] ? SINGULAR : level < spans[3 * row + 2] ? REGULAR : INTERIOR;
}

// The rows of this many corners that have a class at a level.
function rowsOf(simplices, spans, corners, wanted, level) {
  let count = 0;
  for (let row = 0; 3 * row < spans.length; row++) count += classAt(spans, row, level) === wanted;
  const found = new Uint32Array(corners * count);
  let at = 0;
  for (let row = 0; at < found.length; row++) {
    if (classAt(spans, row, level) !== wanted) continue;
    for (let k = 0; k < corners; k++) found[at++] = simplices[corners * row + k];
  }
  return found;
}

let page = null;
let detail = null;

const source = {
  async at(alpha) {
    const level = detail.alphas.indexOf(alpha);
    const { facets, facetSpans, edges, edgeSpans, pointSpans } = detail;
    return {
      regular: rowsOf(facets, facetSpans, 3, REGULAR, level),
      singular: rowsOf(facets, facetSpans, 3, SINGULAR, level),
      edges: rowsOf(edges, edgeSpans, 2, SINGULAR, level),
      classes: Uint8Array.from({ length: pointSpans.length / 3 }, (_, v) => classAt(pointSpans, v, level)),
      betti: detail.levels[level].betti,
    };
  },
  measure: async (alpha) => detail.levels[detail.alphas.indexOf(alpha)],
  // The voids of all levels follow each other.
  async voids(alpha) {
    const { alphas, levels, voidCounts, voidFacets } = detail;
    if (!voidCounts) return null;
    const before = levels.slice(0, alphas.indexOf(alpha)).reduce((sum, { voids }) => sum + voids.length, 0);
    const starts = [0];
    voidCounts.forEach((count, k) => starts.push(starts[k] + 3 * count));
    return { facets: voidFacets, starts: starts.slice(before) };
  },
};

function fail(error) {
  byId("failure").textContent = error.message;
  byId("failure").hidden = false;
  console.error(error);
}

const panel = new ShapePanel(source, { failed: fail, rested: () => history.note(), changed: () => history.later() });

const history = new History(
  () => (panel.alpha === null ? null : { detail: byId("detail").value, alpha: panel.alpha, look: lookNow() }),
  async (now, before) => {
    if (now.detail !== before.detail) {
      byId("detail").value = now.detail;
      await choose(Number(now.detail));
    }
    setLook(now.look);
    await panel.setAlpha(now.alpha);
  },
);

// Shows a level of detail, at the α that it opens at, or at the last of its own up to the one that is shown.
const details = [];
async function choose(number) {
  panel.pause();
  const before = panel.alpha;
  detail = details[number] ??= await open(`detail-${number}`);
  const { alphas, first, simplified } = detail;
  byId("remarks").replaceChildren();
  if (simplified) remark(`The picture is ${simplified}`);
  const above = before === null ? first + 1 : alphas.findIndex((alpha) => alpha > before);
  const reference = alphas[Math.max(0, (above < 0 ? alphas.length : above) - 1)];
  const { unit, space, domain, centre, titles, original, cell } = page;
  const betti = (k) => detail.levels.map((level) => level.betti[k]);
  const all = { b0: betti(0), b1: betti(1), b2: betti(2) };
  panel.look({ ...detail, rows: detail.rows.map(([name, value]) => [name, /^\d+$/.test(value) ? grouped(value) : value]), unit, space, domain, centre, titles, original, cell, reference, ...await source.at(reference) }, before !== null);
  await panel.open(all, new StopScale(alphas));
  document.body.dataset.detail = number;
}

try {
  page = await open("page");
  if (page.positions) page.original = { positions: page.positions, triangles: page.triangles };
  if (page.isovalue !== null) byId("show-original").nextSibling.textContent = ` isosurface at ${page.isovalue}`;
  rows(byId("facts"), page.facts);
  byId("detail").replaceChildren(...page.points.map((count, k) => element("option", { value: k, textContent: `${count} points` })));
  byId("detail").value = page.points.length - 1;
  byId("detail-label").hidden = page.points.length === 1;
  byId("detail").addEventListener("change", ({ target }) => choose(Number(target.value)).catch(fail));
  byId("alpha-value").addEventListener("change", ({ target }) => target.value !== "" && panel.moveTo(panel.stop(Number(target.value))));
  byId("save-png").addEventListener("click", () => panel.savePicture(`${document.title}, α = ${panel.alpha}.png`));
  showNotices();
  wireDrawers();
  await choose(page.points.length - 1);
  byId("history").hidden = false;
  document.body.dataset.state = "ready";
} catch (error) {
  fail(error);
}
