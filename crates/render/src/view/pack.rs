use std::collections::{BTreeMap, HashSet};

use ndarray::s;
use serde::Serialize;
use walpha_shape::ladder::Span;

use super::subject::{Detail, Original};
use crate::base64::base64;
use crate::error::RenderError;
use crate::marching::Isosurface;

/// Arrays as base64 of little-endian numbers, by name.
pub(super) type Arrays = BTreeMap<&'static str, Array>;

/// The arrays of a level of detail: each simplex once for all α.
pub(super) struct Packed {
    pub arrays: Arrays,
    pub simplified: Option<String>,
}

/// Numbers of one type.
#[derive(Serialize)]
pub(super) struct Array {
    /// The JavaScript type that holds them.
    kind: &'static str,
    base64: String,
}

impl Array {
    fn u8(bytes: &[u8]) -> Self {
        Self { kind: "Uint8Array", base64: base64(bytes) }
    }

    fn u32(numbers: &[u32]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        Self { kind: "Uint32Array", base64: base64(&bytes) }
    }

    fn f32(numbers: impl Iterator<Item = f64>) -> Self {
        let bytes: Vec<u8> = numbers.flat_map(|n| (n as f32).to_le_bytes()).collect();
        Self { kind: "Float32Array", base64: base64(&bytes) }
    }
}

/// The most samples along an axis for the surface to compare.
const ISOSURFACE_SAMPLES: usize = 64;

impl Packed {
    pub(super) fn of(detail: &Detail<'_>, most_facets: usize) -> Self {
        let points = detail.levels.points();
        let mut facets = detail.levels.facets();
        let mut edges = detail.levels.singular_edges();
        let simplified = simplify(points.positions(), &mut facets, &mut edges, most_facets);
        let axis = |k: usize| Array::f32(points.positions().iter().map(move |p| p[k]));
        let mut arrays = Arrays::from([("x", axis(0)), ("y", axis(1)), ("z", axis(2))]);
        arrays.insert("weights", Array::f32(points.weights().iter().copied()));
        if let Some(values) = points.values() {
            arrays.insert("values", Array::f32(values.iter().copied()));
        }
        if let Some(differences) = detail.differences {
            arrays.insert("differences", Array::f32(differences.local.iter().copied()));
        }
        // Hidden points never enter.
        let never = detail.levels.len() as u32;
        let mut spans = vec![Span { first: never, regular: never, interior: never }; points.len()];
        for (v, span) in detail.levels.vertices() {
            spans[v as usize] = span;
        }
        arrays.insert("pointSpans", Array::u8(&bytes(spans.iter())));
        let flat: Vec<u32> = facets.iter().flat_map(|facet| facet.0).collect();
        arrays.insert("facets", Array::u32(&flat));
        arrays.insert("facetSpans", Array::u8(&bytes(facets.iter().map(|facet| &facet.1))));
        let flat: Vec<u32> = edges.iter().flat_map(|edge| edge.0).collect();
        arrays.insert("edges", Array::u32(&flat));
        arrays.insert("edgeSpans", Array::u8(&bytes(edges.iter().map(|edge| &edge.1))));
        Self { arrays, simplified }
    }
}

/// The arrays of the surface to compare.
pub(super) fn surface(original: &Original<'_>) -> Result<Arrays, RenderError> {
    let surface = isosurface(original)?;
    let axis = |k: usize| Array::f32(surface.positions.iter().map(move |p| p[k]));
    let facets = Array::u32(surface.triangles.as_flattened());
    Ok(Arrays::from([("x", axis(0)), ("y", axis(1)), ("z", axis(2)), ("facets", facets)]))
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
fn bytes<'a>(spans: impl Iterator<Item = &'a Span>) -> Vec<u8> {
    spans.flat_map(|span| [span.first, span.regular, span.interior].map(|k| k as u8)).collect()
}

/// Merges the points in each box of a grid into the first one, with boxes as small as the number of facets
/// allows; returns a description.
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

/// Simplices between the representatives of their vertices; without those that have collapsed, and
/// each once.
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
