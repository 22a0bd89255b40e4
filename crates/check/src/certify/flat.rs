//! Whole triangulations of points in one plane, on one line, or of one point alone.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use super::finding::Finding;
use super::structure::Points;
use crate::exact::{WeightedPoint, orientation};
use crate::{Class, Complex, Simplices};

/// A cone over a flat triangulation: cells over its largest simplices, with auxiliary apexes outside its plane
/// or line.
///
/// The points of a plane that lie inside a circle are the same for every sphere through that circle, and the auxiliary apexes
/// have no influence on the perturbation. So the cone is the regular triangulation of the points and the apexes if and only if
/// its base is the triangulation of the points.
pub(super) struct Cone {
    pub complex: Complex,
    /// The dimension of the base, 0 to 2.
    pub dimension: usize,
    sites: Vec<WeightedPoint>,
    /// The index of the first apex.
    first: u32,
}

impl Cone {
    /// The cone over a complex without cells whose rows are valid. `None` if no simplex of the dimension that the points span is
    /// listed.
    pub(super) fn over(complex: &Complex, points: Points, apexes: &[[f64; 3]]) -> Option<Self> {
        let first = points.len() as u32;
        let apexes_as_points =
            apexes.iter().map(|&position| WeightedPoint { position, weight: 0.0 });
        let sites: Vec<_> = points.sites.iter().copied().chain(apexes_as_points).collect();
        let at = |k: u32| first + k;
        let cells: Vec<[u32; 4]> = match apexes.len() {
            1 => complex.facets.rows().iter().map(|&[a, b, c]| [a, b, c, at(0)]).collect(),
            2 => complex.edges.rows().iter().map(|&[a, b]| [a, b, at(0), at(1)]).collect(),
            3 => complex.vertices.rows().iter().map(|&[a]| [a, at(0), at(1), at(2)]).collect(),
            _ => Vec::new(),
        };
        if cells.is_empty() {
            return None;
        }
        let positive = |[a, b, c, d]: [u32; 4]| {
            let [p, q, r, s] = [a, b, c, d].map(|v| sites[v as usize].position);
            if orientation(p, q, r, s) == Ordering::Less { [b, a, c, d] } else { [a, b, c, d] }
        };
        let cells: Vec<_> = cells.into_iter().map(positive).collect();
        let dimension = 3 - apexes.len();
        Some(Self { complex: closed(&cells), dimension, sites, first })
    }

    pub(super) fn points(&self) -> Points<'_> {
        Points { sites: &self.sites }
    }

    /// Findings on the cone in terms of its base, each once.
    pub(super) fn at_base(&self, found: Vec<Finding>) -> Vec<Finding> {
        let mut findings: Vec<Finding> = Vec::new();
        for finding in found.into_iter().map(|finding| finding.without(self.first)) {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        findings
    }
}

/// Cells with all their faces; every class is exterior.
pub(super) fn closed(cells: &[[u32; 4]]) -> Complex {
    fn exterior<const N: usize>(rows: impl Iterator<Item = [u32; N]>) -> Simplices<N> {
        let rows: BTreeSet<[u32; N]> = rows.map(sorted).collect();
        rows.into_iter().map(|row| (row, Class::Exterior)).collect()
    }
    let facets = || cells.iter().flat_map(|&cell| outward_facets(cell));
    let edges = || facets().flat_map(|[a, b, c]| [[a, b], [b, c], [a, c]]);
    let mut complex = Complex {
        cells: cells.iter().map(|&cell| (smallest_even(cell), Class::Exterior)).collect(),
        facets: exterior(facets()),
        edges: exterior(edges()),
        vertices: exterior(edges().flat_map(|[a, b]| [[a], [b]])),
    };
    sort(&mut complex);
    complex
}
