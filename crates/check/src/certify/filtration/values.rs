//! The exact squared radii of empty smallest orthogonal spheres, their order, and the ones from which on each simplex is in the
//! shape, regular and interior.

use std::sync::atomic::{AtomicBool, Ordering};

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use crate::certify::structure::{Points, Structure};
use crate::exact::{Exact, Side, radius_value, side};
use crate::parallel::of_each;
use crate::schema::FiltrationFile;
use crate::{Alpha, Complex};

/// The rank of a simplex whose own smallest orthogonal sphere is not empty.
pub(super) const ATTACHED: u32 = u32::MAX;
/// The rank beyond all values.
pub(super) const NEVER: u32 = u32::MAX;

/// For each row, the rank of the simplex's own squared radius among all distinct ones, or [`ATTACHED`].
pub(super) struct Ranks {
    pub values: Vec<(f64, Exact)>,
    pub vertices: Vec<u32>,
    pub edges: Vec<u32>,
    pub facets: Vec<u32>,
    pub cells: Vec<u32>,
}

impl Ranks {
    /// Ranks of a whole triangulation that was found regular, in which a sphere that is not empty contains a neighbour.
    pub(super) fn of(
        structure: &Structure,
        points: Points,
        monitor: &Monitor,
    ) -> Result<Self, Cancelled> {
        let Complex { cells, facets, edges, vertices } = structure.complex;
        let part = |from| monitor.part(from, from + 1, 12);
        let attached_vertices = attached_vertices(structure, points, &part(0))?;
        let attached_edges = attached_edges(structure, points, &part(1))?;
        let attached_facets = attached_facets(structure, points, &part(2))?;
        let spheres = [
            radii(vertices.rows(), &attached_vertices, points, &part(3))?,
            radii(edges.rows(), &attached_edges, points, &part(4))?,
            radii(facets.rows(), &attached_facets, points, &monitor.part(5, 7, 12))?,
            radii(cells.rows(), &flags(cells.len()), points, &monitor.part(7, 10, 12))?,
        ];
        let counts = spheres.each_ref().map(Vec::len);
        let mut own: Vec<_> = (0..)
            .zip(spheres)
            .flat_map(|(dimension, spheres)| {
                let known = (0..).zip(spheres);
                known.filter_map(move |(row, known): (u32, _)| Some((known?, dimension, row)))
            })
            .collect();
        own.par_sort_unstable_by(|(a, ..): &((f64, Exact), usize, u32), (b, ..)| {
            a.0.total_cmp(&b.0).then_with(|| a.1.compare(&b.1))
        });
        monitor.report(11, 12)?;
        let mut ranks = counts.map(|count| vec![ATTACHED; count]);
        let mut values: Vec<(f64, Exact)> = Vec::new();
        for (value, dimension, row) in own {
            // Values are in lowest terms, so equal numbers have equal fields.
            if values.last() != Some(&value) {
                values.push(value);
            }
            ranks[dimension][row as usize] = values.len() as u32 - 1;
        }
        let [vertices, edges, facets, cells] = ranks;
        Ok(Self { values, vertices, edges, facets, cells })
    }

    /// The double nearest to a value; ∞ for never.
    pub(super) fn alpha(&self, rank: u32) -> Alpha {
        let nearest = |value: &(f64, Exact)| Alpha::from_squared(value.0).expect("never NaN");
        self.values.get(rank as usize).map_or(Alpha::INFINITE, nearest)
    }

    /// The value itself.
    pub(super) fn exact(&self, rank: u32) -> Option<&Exact> {
        self.values.get(rank as usize).map(|value| &value.1)
    }
}

fn radii<const N: usize>(
    rows: &[[u32; N]],
    attached: &[AtomicBool],
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<Option<(f64, Exact)>>, Cancelled> {
    of_each(rows.len(), monitor, |i| {
        Some((!attached[i].load(Ordering::Relaxed)).then(|| {
            let exact = radius_value(points.corners(rows[i]).each_ref());
            (exact.nearest(), exact)
        }))
    })
}

fn flags(count: usize) -> Vec<AtomicBool> {
    (0..count).map(|_| AtomicBool::new(false)).collect()
}

fn inside<const N: usize>(points: Points, row: [u32; N], q: u32) -> bool {
    side(points.corners(row).each_ref(), &points.get(q)) == Side::Inside
}

fn attached_facets(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<AtomicBool>, Cancelled> {
    let rows = structure.complex.facets.rows();
    of_each(rows.len(), monitor, |i| {
        let mut halves = structure.halves(i);
        let attached = halves.any(|half| inside(points, rows[i], structure.apex(half)));
        Some(AtomicBool::new(attached))
    })
}

fn attached_edges(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<AtomicBool>, Cancelled> {
    let attached = flags(structure.complex.edges.len());
    let facets = structure.complex.facets.rows();
    of_each(facets.len(), monitor, |i| {
        let [a, b, c] = facets[i];
        for (edge, q) in [([b, c], a), ([a, c], b), ([a, b], c)] {
            if inside(points, edge, q) {
                attached[structure.edges.row(edge) as usize].store(true, Ordering::Relaxed);
            }
        }
        None::<()>
    })?;
    Ok(attached)
}

fn attached_vertices(
    structure: &Structure,
    points: Points,
    monitor: &Monitor,
) -> Result<Vec<AtomicBool>, Cancelled> {
    let attached = flags(structure.complex.vertices.len());
    let edges = structure.complex.edges.rows();
    of_each(edges.len(), monitor, |i| {
        let [a, b] = edges[i];
        for (v, q) in [(a, b), (b, a)] {
            if inside(points, [v], q) {
                attached[structure.vertices.row([v]) as usize].store(true, Ordering::Relaxed);
            }
        }
        None::<()>
    })?;
    Ok(attached)
}

/// Ranks of values; [`NEVER`] if there is no value.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub first: u32,
    pub regular: u32,
    pub interior: u32,
}

/// The spans of all simplices, by row; for cells only the first rank, because they have no cofaces.
pub(super) struct Spans {
    pub cells: Vec<u32>,
    pub facets: Vec<Span>,
    pub edges: Vec<Span>,
    pub vertices: Vec<Span>,
}

impl Spans {
    pub(super) fn of(structure: &Structure, ranks: &Ranks) -> Self {
        let complex = structure.complex;
        let cells = ranks.cells.clone();
        let facets: Vec<Span> = (0..complex.facets.len())
            .map(|facet| {
                let sides: Vec<u32> =
                    structure.halves(facet).map(|half| cells[half.cell]).collect();
                let regular = sides.iter().copied().min().unwrap_or(NEVER);
                // A facet of the hull has one cell, and the outside on its other side.
                let last = if sides.len() == 2 { sides.into_iter().max() } else { None };
                span(ranks.facets[facet], regular, last.unwrap_or(NEVER))
            })
            .collect();
        let of_facet = |&[a, b, c]: &[u32; 3]| {
            [[a, b], [a, c], [b, c]].map(|edge| structure.edges.row(edge) as usize)
        };
        let edges = below(&facets, complex.facets.rows().iter().map(of_facet), &ranks.edges);
        let of_edge = |edge: &[u32; 2]| edge.map(|v| structure.vertices.row([v]) as usize);
        let vertices = below(&edges, complex.edges.rows().iter().map(of_edge), &ranks.vertices);
        Self { cells, facets, edges, vertices }
    }
}

/// The spans of faces from those of their cofaces.
fn below<const M: usize>(
    higher: &[Span],
    faces: impl Iterator<Item = [usize; M]>,
    own: &[u32],
) -> Vec<Span> {
    let mut ends = vec![(NEVER, 0); own.len()];
    for (span, faces) in higher.iter().zip(faces) {
        for face in faces {
            let (regular, interior) = &mut ends[face];
            *regular = span.first.min(*regular);
            *interior = span.interior.max(*interior);
        }
    }
    let of_face = |(&own, (regular, interior))| {
        // A simplex without cofaces is never surrounded.
        span(own, regular, if regular == NEVER { NEVER } else { interior })
    };
    own.iter().zip(ends).map(of_face).collect()
}

fn span(own: u32, regular: u32, interior: u32) -> Span {
    let first = if own == ATTACHED { regular } else { own };
    Span { first, regular, interior }
}

/// The row in the triangulation of each simplex of a file.
pub(super) struct RowNumbers {
    pub vertices: Vec<usize>,
    pub edges: Vec<usize>,
    pub facets: Vec<usize>,
    pub cells: Vec<usize>,
}

impl RowNumbers {
    /// The rows of a file that lists the simplices of the triangulation.
    pub(super) fn of(file: &FiltrationFile, structure: &Structure) -> Self {
        let Structure { vertices, edges, facets, cells, .. } = structure;
        Self {
            vertices: file.vertices.iter().map(|&v| vertices.row([v]) as usize).collect(),
            edges: file.edges.iter().map(|&row| edges.row(row) as usize).collect(),
            facets: file.facets.iter().map(|&row| facets.row(row) as usize).collect(),
            cells: file.cells.iter().map(|&row| cells.row(row) as usize).collect(),
        }
    }
}
