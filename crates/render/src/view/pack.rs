use std::collections::{BTreeMap, HashSet};
use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use ndarray::s;
use serde_json::{Map, Value, json};
use walpha_shape::ladder::{Drawn, Span};

use super::subject::{Detail, Kinds, Original};
use crate::error::RenderError;
use crate::marching::Isosurface;
use base64::prelude::{BASE64_STANDARD, Engine};

/// The alignment of numbers in bytes, which typed arrays of JavaScript require.
const ALIGNMENT: usize = 8;

/// Named arrays of little-endian numbers, one after the other.
#[derive(Default)]
pub(super) struct Arrays {
    /// The JavaScript type of each, its place and its length.
    places: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    fn put<const N: usize>(
        &mut self,
        name: &str,
        kind: &str,
        numbers: impl Iterator<Item = [u8; N]>,
    ) {
        let at = self.bytes.len();
        self.bytes.extend(numbers.flatten());
        let length = (self.bytes.len() - at) / N;
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        self.places.insert(name.into(), json!({ "kind": kind, "at": at, "length": length }));
    }

    fn u8(&mut self, name: &str, bytes: impl Iterator<Item = u8>) {
        self.put(name, "Uint8Array", bytes.map(|byte| [byte]));
    }

    fn u32(&mut self, name: &str, numbers: impl Iterator<Item = u32>) {
        self.put(name, "Uint32Array", numbers.map(u32::to_le_bytes));
    }

    fn f32(&mut self, name: &str, numbers: impl Iterator<Item = f64>) {
        self.put(name, "Float32Array", numbers.map(|number| (number as f32).to_le_bytes()));
    }

    fn f64(&mut self, name: &str, numbers: impl Iterator<Item = f64>) {
        self.put(name, "Float64Array", numbers.map(f64::to_le_bytes));
    }

    /// Positions relative to a centre: in single precision, those of a map would be metres apart otherwise.
    fn positions<'a>(&mut self, positions: impl Iterator<Item = &'a [f64; 3]>, centre: [f64; 3]) {
        self.f32("positions", positions.flat_map(|p| [0, 1, 2].map(|k| p[k] - centre[k])));
    }

    /// The text of an element of the page: base64 of gzip of the length of an object in JSON, the object with the places of the
    /// arrays, and the arrays.
    pub(super) fn packed(self, mut content: Value) -> String {
        content["arrays"] = self.places.into();
        let content = content.to_string();
        let mut bytes = (content.len() as u32).to_le_bytes().to_vec();
        bytes.extend(content.as_bytes());
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        bytes.extend(self.bytes);
        let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
        gzip.write_all(&bytes)
            .and_then(|()| gzip.finish())
            .map(|packed| BASE64_STANDARD.encode(packed))
            .expect("memory takes all bytes")
    }
}

/// The arrays of a level of detail: each simplex once for all α.
pub(super) struct Packed {
    pub arrays: Arrays,
    pub simplified: Option<String>,
}

/// The first level, in the page, of points that are in no shape for any α because they are hidden.
const NEVER: u32 = 255;

/// The most samples along an axis for the surface to compare.
const ISOSURFACE_SAMPLES: usize = 64;

impl Packed {
    pub(super) fn of(
        detail: &Detail<'_>,
        drawn: Drawn<'_>,
        centre: [f64; 3],
        most_facets: usize,
    ) -> Self {
        let Drawn { points, copies, mut facets, mut edges, vertices, voids } = drawn;
        let simplified = simplify(points.positions(), &mut facets, &mut edges, most_facets);
        let mut arrays = Arrays::default();
        arrays.positions(points.positions().iter(), centre);
        arrays.f32("weights", points.weights().iter().copied());
        if let Some(values) = points.values() {
            if single_suffices(values) {
                arrays.f32("values", values.iter().copied());
            } else {
                arrays.f64("values", values.iter().copied());
            }
        }
        if let Some(differences) = detail.differences {
            // They are those of a volume, which has no copies.
            arrays.f32("differences", differences.local.iter().copied());
        }
        let mut spans = vec![Span { first: NEVER, regular: NEVER, interior: NEVER }; points.len()];
        for (v, span) in vertices {
            spans[v as usize] = span;
        }
        arrays.u8("pointSpans", bytes(spans.iter()));
        let levels = detail.levels.alphas().iter().map(|alpha| alpha.squared());
        arrays.f64("alphas", levels);
        arrays.u32("facets", facets.iter().flat_map(|facet| facet.0));
        arrays.u8("facetSpans", bytes(facets.iter().map(|facet| &facet.1)));
        arrays.u32("edges", edges.iter().flat_map(|edge| edge.0));
        arrays.u8("edgeSpans", bytes(edges.iter().map(|edge| &edge.1)));
        for (name, kinds) in [("atoms", detail.atoms), ("codes", detail.classes)] {
            if let Some(Kinds { numbers, .. }) = kinds {
                let of_copies = copies.iter().map(|&v| numbers[v as usize]);
                arrays.u8(name, numbers.iter().copied().chain(of_copies));
            }
        }
        if let Some(colours) = detail.colours {
            let of_copies = copies.iter().map(|&v| colours[v as usize]);
            arrays.u8("tints", colours.iter().copied().chain(of_copies).flatten());
        }
        arrays.u32("copies", copies.iter().copied());
        if let Some(indices) = detail.indices {
            arrays.u32("indices", indices.iter().copied());
        }
        let all = || voids.iter().flatten();
        // Where they are too many, voids are shown by their boxes.
        if all().map(Vec::len).sum::<usize>() <= most_facets {
            arrays.u32("voidCounts", all().map(|facets| facets.len() as u32));
            arrays.u32("voidFacets", all().flatten().flatten().copied());
        }
        Self { arrays, simplified }
    }
}

/// Whether single precision tells values apart that differ by a ten-thousandth of their range.
fn single_suffices(values: &[f64]) -> bool {
    let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
        [low.min(value), high.max(value)]
    });
    let [low, high] = ends;
    let largest = low.abs().max(high.abs());
    let is_fine = largest * f64::from(f32::EPSILON) <= 1e-4 * (high - low);
    largest <= f64::from(f32::MAX) && (is_fine || low == high)
}

/// The surface to compare.
pub(super) fn surface(original: &Original<'_>, centre: [f64; 3]) -> Result<Arrays, RenderError> {
    let surface = isosurface(original)?;
    let mut arrays = Arrays::default();
    arrays.positions(surface.positions.iter(), centre);
    arrays.u32("triangles", surface.triangles.as_flattened().iter().copied());
    Ok(arrays)
}

/// The surface to compare, in the coordinates of the points.
fn isosurface(original: &Original<'_>) -> Result<Isosurface, RenderError> {
    let volume = original.volume;
    let longest = volume.dims().xyz().into_iter().max().unwrap_or(1);
    let step = longest.div_ceil(ISOSURFACE_SAMPLES);
    let coarse = volume.samples().slice_move(s![..;step, ..;step, ..;step]);
    let mut surface = Isosurface::new(coarse, original.isovalue)?;
    for position in &mut surface.positions {
        *position = original.frame.to_world(position.map(|x| x * step as f64));
    }
    Ok(surface)
}

/// Three levels per span, a byte each.
fn bytes<'a>(spans: impl Iterator<Item = &'a Span>) -> impl Iterator<Item = u8> {
    spans.flat_map(|span| [span.first, span.regular, span.interior].map(|k| k as u8))
}

/// Merges the points in each box of a grid into the first one, with boxes as small as the number of facets allows; returns a
/// description.
fn simplify(
    positions: &[[f64; 3]],
    facets: &mut Vec<([u32; 3], Span)>,
    edges: &mut Vec<([u32; 2], Span)>,
    most_facets: usize,
) -> Option<String> {
    let before = facets.len();
    if before <= most_facets {
        return None;
    }
    let low = [0, 1, 2].map(|k| positions.iter().fold(f64::INFINITY, |low, p| low.min(p[k])));
    let extent =
        (0..3).fold(0f64, |most, k| positions.iter().fold(most, |most, p| most.max(p[k] - low[k])));
    // Each halving of the boxes along an edge makes about four times as many facets.
    let mut boxes = 1024.0;
    loop {
        let side = extent / boxes;
        let mut first = BTreeMap::new();
        let stands_for: Vec<u32> = (positions.iter().enumerate())
            .map(|(v, p)| {
                let key = [0, 1, 2].map(|k| ((p[k] - low[k]) / side) as u32);
                *first.entry(key).or_insert(v as u32)
            })
            .collect();
        let kept = collapsed(facets, &stands_for);
        if kept.len() <= most_facets || boxes < 4.0 {
            *facets = kept;
            *edges = collapsed(edges, &stands_for);
            return Some(format!(
                "simplified for display: points in boxes of side {side:.3} are drawn as one, which \
                 leaves {} of {before} facets; numbers are those of the whole shape",
                facets.len()
            ));
        }
        boxes *= 0.75;
    }
}

/// Simplices between the representatives of their vertices, each once, without collapsed ones.
fn collapsed<const N: usize>(
    simplices: &[([u32; N], Span)],
    stands_for: &[u32],
) -> Vec<([u32; N], Span)> {
    let mut seen = HashSet::new();
    let moved = simplices.iter().map(|&(row, span)| (row.map(|v| stands_for[v as usize]), span));
    moved
        .filter(|&(row, span)| {
            let mut sorted = row;
            sorted.sort_unstable();
            sorted.windows(2).all(|pair| pair[0] != pair[1])
                && seen.insert((sorted, span.first, span.regular, span.interior))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_facets_become_few_and_none_degenerate() {
        let side = 40u32;
        let at = |v: u32| [v % side, v / side, 0].map(f64::from);
        let positions: Vec<_> = (0..side * side).map(at).collect();
        let span = Span { first: 0, regular: 0, interior: 1 };
        let square = |v: u32| [[v, v + 1, v + side], [v + 1, v + side + 1, v + side]];
        let corners = (0..side * (side - 1)).filter(|v| v % side < side - 1);
        let mut facets: Vec<_> = corners.flat_map(square).map(|row| (row, span)).collect();
        let all = facets.clone();
        assert_eq!(simplify(&positions, &mut facets, &mut Vec::new(), all.len()), None);
        assert_eq!(facets, all);
        let text = simplify(&positions, &mut facets, &mut Vec::new(), 500).unwrap();
        assert!(facets.len() <= 500 && facets.len() > 100, "{}", facets.len());
        assert!(text.contains(&format!("{} of {} facets", facets.len(), all.len())), "{text}");
        assert!(facets.iter().all(|([a, b, c], _)| a != b && b != c && a != c));
    }
}
