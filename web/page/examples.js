// Inputs at a click: samples that the library has, and points made here.

// A tube round a trefoil knot, as a table of points.
function knot() {
  const lines = ["x,y,z,value"];
  const [around, along] = [24, 260];
  for (let i = 0; i < along; i++) {
    const t = 2 * Math.PI * i / along;
    const at = (s) => [Math.sin(s) + 2 * Math.sin(2 * s), Math.cos(s) - 2 * Math.cos(2 * s), -Math.sin(3 * s)];
    const centre = at(t);
    const tangent = unit(at(t + 1e-3).map((x, k) => x - centre[k]));
    const side = unit(cross(tangent, [0.3, 0.5, 0.81]));
    const other = cross(tangent, side);
    for (let j = 0; j < around; j++) {
      // Every second ring is turned by half a step.
      const turn = 2 * Math.PI * (j + i % 2 / 2) / around;
      const point = centre.map((x, k) => x + 0.38 * (Math.cos(turn) * side[k] + Math.sin(turn) * other[k]));
      lines.push([...point.map((x) => x.toFixed(4)), (i / along).toFixed(3)].join(","));
    }
  }
  return `${lines.join("\n")}\n`;
}

const cross = (a, b) => [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
const unit = (a) => a.map((x) => x / Math.hypot(...a));

// A hill with a house and trees, as a scanner over it would see them: x, y and z in metres.
function tile() {
  let seed = 1;
  // A linear congruential generator: Numerical Recipes, "quick and dirty".
  const random = () => (seed = (1664525 * seed + 1013904223) >>> 0) / 2 ** 32;
  const ground = (x, y) => 6 * Math.sin(x / 18) + 4 * Math.cos(y / 23) + 0.05 * x;
  const trees = Array.from({ length: 14 }, () => [8 + 84 * random(), 8 + 84 * random(), 4 + 4 * random()]);
  const height = (x, y) => {
    if (x > 40 && x < 58 && y > 44 && y < 56) return ground(49, 50) + 9 - 0.6 * Math.abs(y - 50);
    const tops = trees.map(([tx, ty, tall]) => ground(tx, ty) + 2 * tall - Math.hypot(x - tx, y - ty) * 2.2);
    const low = ground(x, y) + 0.05 * random();
    const top = Math.max(...tops);
    return top > low + 1 ? top + 0.2 * random() : low;
  };
  const lines = Array.from({ length: 16000 }, () => {
    const [x, y] = [100 * random(), 100 * random()];
    return [x, y, height(x, y)].map((c) => c.toFixed(2)).join(" ");
  });
  return `x[m] y[m] z[m]\n${lines.join("\n")}\n`;
}

// Drawings of the examples, in their colours.
const drawing = (inner) => `<svg viewBox="0 0 200 100" aria-hidden="true">${inner}</svg>`;
const SKULL = drawing('<g stroke="#a89878" stroke-width="1.5"><path d="M106 6c30 0 50 18 50 42 0 13-6 23-17 27l-26 2-31-2-7-9-6-3 3-11-3-7c-1-22 11-39 37-39z" fill="#ded4c2"/><path d="M82 76l31 2 20-3-4 12c-9 8-31 9-42 5z" fill="#d3c7b1"/></g><ellipse cx="88" cy="48" rx="10" ry="9" fill="#6b5f4c"/><path d="M77 60l7-3 3 8-7 2z" fill="#6b5f4c"/><path d="M84 78h26" stroke="#6b5f4c" stroke-width="3" stroke-dasharray="3 2"/>');
const HILLS = drawing('<path d="M0 78q40-34 80-16t60-14 60-8v60H0z" fill="#21918c"/><path d="M0 88q50-20 100-8t100-14v34H0z" fill="#3b528b"/><path d="M96 62V46l16-10 16 10v16z" fill="#fde725"/><circle cx="48" cy="46" r="11" fill="#5ec962"/><circle cx="160" cy="34" r="12" fill="#5ec962"/>');
const ATOMS = drawing('<g stroke="#555" stroke-width="1"><circle cx="60" cy="58" r="20" fill="#909090"/><circle cx="88" cy="42" r="20" fill="#3050f8"/><circle cx="114" cy="60" r="21" fill="#909090"/><circle cx="142" cy="46" r="19" fill="#ff0d0d"/><circle cx="104" cy="30" r="12" fill="#eee"/></g>');

export const EXAMPLES = [
  {
    input: "sample:ct", name: "a CT of a head, in Hounsfield units",
    card: { title: "CT", text: "The bone of a head, a made-up one", picture: SKULL },
  },
  {
    input: "tile.xyz", name: "a laser scan of a hill with a house and trees", make: tile,
    card: { title: "Laser scan", text: "A hill with a house and trees, 16 000 points", picture: HILLS },
  },
  {
    input: "sample:peptide", name: "a peptide, by its atoms",
    card: { title: "Molecule", text: "A peptide, by the radii of its atoms", picture: ATOMS },
  },
  { input: "sample:phantom", name: "a phantom of a head, 64³" },
  { input: "sample:phantom@128", name: "the phantom, 128³" },
  { input: "sample:phantom@256", name: "the phantom, 256³: a million points" },
  { input: "knot.csv", name: "points on a knotted tube", make: knot },
];
