// Colours, as walpha's pictures have them: classes from a palette for all eyes (Okabe and Ito), values by viridis.

// The numbers of classes, as the library gives them.
export const [EXTERIOR, SINGULAR, REGULAR, INTERIOR, HIDDEN] = [0, 1, 2, 3, 4];
export const CLASSES = ["exterior", "singular", "regular", "interior", "hidden"];
export const OF_CLASS = ["#9aa3b2", "#d55e00", "#0072b2", "#009e73", "#cc79a7"];
// The material of walpha's pictures, and of what hangs loose in them.
export const [BONE, LOOSE] = ["#ded4c2", "#d68a5c"];
export const EDGES = "#e69f00";
// What a plane cuts, beside the material.
export const CUT = "#b9a58c";
export const SELECTED = "#e69f00";

const VIRIDIS = [
  [68, 1, 84], [72, 26, 108], [71, 47, 125], [65, 68, 135], [57, 86, 140], [49, 104, 142], [42, 120, 142], [35, 136, 142],
  [31, 152, 139], [34, 168, 132], [53, 183, 121], [84, 197, 104], [122, 209, 81], [165, 219, 54], [210, 226, 27], [253, 231, 37],
].map((rgb) => rgb.map((c) => c / 255));

// Red, green and blue, 0 to 1, of a share of the range.
export function viridis(share) {
  // A range may be too large for a share to be a number.
  const at = Math.min(1, Math.max(0, share || 0)) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const [a, b] = [VIRIDIS[low], VIRIDIS[low + 1]];
  return a.map((c, k) => c + (at - low) * (b[k] - c));
}

// The least and the largest of numbers.
export function range(numbers) {
  let [low, high] = [Infinity, -Infinity];
  for (const number of numbers) {
    if (number < low) low = number;
    if (number > high) high = number;
  }
  return [low, high];
}

// A number with four significant digits at most.
export function short(number) {
  if (number === "inf" || number === Infinity) return "∞";
  return Number(Number(number).toPrecision(4)).toLocaleString("en", { maximumSignificantDigits: 4, useGrouping: false });
}

// A number for people: four digits at most, and thousands apart by thin spaces; very large and very small ones with a power of ten.
export function brief(number) {
  const size = Math.abs(number);
  if (Number.isFinite(size) && size > 0 && (size >= 1e9 || size < 1e-4)) {
    const [digits, power] = Number(number).toExponential(3).split("e");
    const raised = String(Number(power)).replace(/[-0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
    return `${Number(digits)}·10${raised}`;
  }
  const text = short(number);
  if (!/^-?\d+(\.\d+)?$/.test(text)) return text;
  const [whole, fraction] = text.split(".");
  return whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") + (fraction ? `.${fraction}` : "");
}

// A count, with thousands apart.
export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, "\u202f");

// A length, area or volume with its unit; large ones in millimetres are in centimetres.
export function measured(size, unit, power) {
  const isLarge = unit === "mm" && power > 1 && size >= 1e4;
  return `${brief(isLarge ? size / 10 ** power : size)} ${isLarge ? "cm" : unit}${["", "", "²", "³"][power]}`;
}

// A coordinate, with digits enough to tell places apart that are a ten-thousandth of the whole from each other, however far they lie.
export function placed(coordinate, extent) {
  const digits = extent > 0 ? Math.ceil(Math.log10(Math.abs(coordinate) / extent)) + 4 : 4;
  return String(Number(coordinate.toPrecision(Math.min(17, Math.max(4, Number.isFinite(digits) ? digits : 4)))));
}
