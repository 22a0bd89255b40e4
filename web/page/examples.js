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

export const EXAMPLES = [
  { input: "sample:phantom", name: "a phantom of a head, 64³" },
  { input: "sample:ct", name: "a CT of the phantom, in Hounsfield units" },
  { input: "sample:phantom@128", name: "the phantom, 128³" },
  { input: "sample:phantom@256", name: "the phantom, 256³: a million points" },
  { input: "knot.csv", name: "points on a knotted tube", make: knot },
  { input: "hard:voxels", name: "a lattice, where every sphere has eight points" },
  { input: "hard:fcc", name: "a face-centred cubic lattice" },
  { input: "hard:duplicates", name: "a lattice three times, of which two are hidden" },
  { input: "hard:integer-sphere", name: "integer points exactly on a sphere" },
];
