use rayon::prelude::*;
use walpha_regular::{Interval, Predicates};

use super::Filtration;
use super::incidence::Incidence;
use crate::WeightedPoints;
use crate::{Alpha, Class};

/// From which level on a simplex is what: levels count from 0, and as many as there are means
/// never.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// In the shape.
    pub first: u32,
    /// A face of another simplex of the shape; singular before.
    pub regular: u32,
    /// No more on the boundary.
    pub interior: u32,
}

impl Span {
    fn until(never: u32) -> Self {
        Self { first: never, regular: never, interior: 0 }
    }

    /// Takes in a simplex that this one is a face of.
    fn beside(&mut self, higher: Self) {
        self.regular = self.regular.min(higher.first);
        self.interior = self.interior.max(higher.interior);
    }

    /// Sets the level of its own sphere, if that is empty.
    ///
    /// A sphere of a face is no larger than one of the whole, so own ≤ regular: this is what makes
    /// a level a complex, and where predicates that contradict each other would show.
    fn own(&mut self, own: Option<u32>) {
        assert!(own.is_none_or(|own| own <= self.regular), "a face comes after its coface");
        self.first = own.unwrap_or(self.regular);
    }

    /// The class at a level.
    pub fn class(&self, level: u32) -> Class {
        if level < self.first {
            Class::Exterior
        } else if level < self.regular {
            Class::Singular
        } else if level < self.interior {
            Class::Regular
        } else {
            Class::Interior
        }
    }
}

/// A filtration at several α: for each simplex, the first level at which it is in the shape, and
/// the levels at which its class changes. So levels are nested because a simplex never goes.
pub struct Levels<'a> {
    pub(super) filtration: &'a Filtration,
    pub(super) alphas: Vec<Alpha>,
    /// The first level of each cell, by row.
    pub(super) cells: Vec<u32>,
    pub(super) facets: Vec<Span>,
    pub(super) edges: Vec<Span>,
    pub(super) vertices: Vec<Span>,
}

impl Filtration {
    /// Decides every simplex at every α, exactly. Ascending order and distinct α are made first.
    /// O(n log m) for m levels, and exact arithmetic for ties.
    pub fn levels(&self, alphas: &[Alpha]) -> Levels<'_> {
        let mut alphas = alphas.to_vec();
        alphas.sort_by(|a, b| a.squared().total_cmp(&b.squared()));
        alphas.dedup();
        let spheres = self.spheres();
        let complex = self.whole.complex();
        let never = alphas.len() as u32;
        let cells: Vec<u32> = (complex.cells.rows().par_iter().zip(&self.cells))
            .map(|(&cell, &radius)| level(&spheres, cell, radius, &alphas))
            .collect();
        let own = Own {
            facets: |row: usize| {
                let facet = self.incidence.facets[row];
                self.facets[row].known().map(|radius| level(&spheres, facet, radius, &alphas))
            },
            edges: |row: usize| {
                let edge = complex.edges.rows()[row];
                self.edges[row].known().map(|radius| level(&spheres, edge, radius, &alphas))
            },
            vertices: |row: usize| {
                let vertex = complex.vertices.rows()[row];
                self.vertices[row].known().map(|radius| level(&spheres, vertex, radius, &alphas))
            },
        };
        let (facets, edges, vertices) = self.spans(never, &cells, own);
        Levels { filtration: self, alphas, cells, facets, edges, vertices }
    }

    /// What is below cells, from the levels of these and those of empty spheres of its own.
    pub(super) fn spans<F, E, V>(
        &self,
        never: u32,
        cells: &[u32],
        own: Own<F, E, V>,
    ) -> (Vec<Span>, Vec<Span>, Vec<Span>)
    where
        F: Fn(usize) -> Option<u32> + Sync,
        E: Fn(usize) -> Option<u32> + Sync,
        V: Fn(usize) -> Option<u32> + Sync,
    {
        let (complex, incidence) = (self.whole.complex(), &self.incidence);
        let of_facet = |(row, sides): (usize, &[u32; 2])| {
            let mut span = Span::until(never);
            for &cell in sides {
                // Beyond the hull nothing ever comes.
                let first = if cell == Incidence::OUTSIDE { never } else { cells[cell as usize] };
                span.beside(Span { first, regular: first, interior: first });
            }
            span.own((own.facets)(row));
            span
        };
        let facets: Vec<Span> =
            incidence.facet_cells.par_iter().enumerate().map(of_facet).collect();
        // Where there are no cells, the points span no volume, and space is on both sides of all.
        let faces =
            Span { interior: if cells.is_empty() { never } else { 0 }, ..Span::until(never) };
        let mut edges = vec![faces; complex.edges.len()];
        for (&facet, on) in facets.iter().zip(&incidence.facet_edges) {
            on.iter().for_each(|&edge| edges[edge as usize].beside(facet));
        }
        edges.par_iter_mut().enumerate().for_each(|(row, span)| span.own((own.edges)(row)));
        let mut vertices = vec![faces; complex.vertices.len()];
        for (&edge, ends) in edges.iter().zip(complex.edges.rows()) {
            for &v in ends {
                vertices[incidence.vertex_rows[v as usize] as usize].beside(edge);
            }
        }
        vertices.par_iter_mut().enumerate().for_each(|(row, span)| span.own((own.vertices)(row)));
        (facets, edges, vertices)
    }
}

/// By row, the level at which a simplex comes by its own sphere, if that is empty.
pub(super) struct Own<F, E, V> {
    pub facets: F,
    pub edges: E,
    pub vertices: V,
}

impl Levels<'_> {
    /// The points and their frozen weights.
    pub fn points(&self) -> &WeightedPoints {
        self.filtration.points()
    }

    /// The α of each level, ascending.
    pub fn alphas(&self) -> &[Alpha] {
        &self.alphas
    }

    /// The number of levels.
    pub fn len(&self) -> usize {
        self.alphas.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.alphas.is_empty()
    }
}

/// How many of the α, which ascend, a simplex does not fit, of whose squared radius this is the nearest
/// double.
fn level<const N: usize>(
    spheres: &Predicates<'_>,
    simplex: [u32; N],
    radius: f64,
    alphas: &[Alpha],
) -> u32 {
    let radius = Interval::around(radius);
    let out = alphas.partition_point(|alpha| alpha.squared() < radius.low);
    let doubtful = &alphas[out..];
    let unfit = |alpha: &Alpha| !spheres.fits_by(simplex, radius, alpha.squared());
    (out + doubtful.iter().take_while(|alpha| unfit(alpha)).count()) as u32
}

/// The rows that come at each level, ascending: `rows[starts[k]..starts[k + 1]]` at level k, and
/// those that never come last.
pub(super) struct ByLevel {
    rows: Vec<u32>,
    starts: Vec<usize>,
}

impl ByLevel {
    pub(super) fn new(levels: usize, first: impl ExactSizeIterator<Item = u32> + Clone) -> Self {
        let mut starts = vec![0; levels + 2];
        first.clone().for_each(|level| starts[level as usize + 1] += 1);
        for level in 0..=levels {
            starts[level + 1] += starts[level];
        }
        let mut at = starts.clone();
        let mut rows = vec![0; first.len()];
        for (row, level) in first.enumerate() {
            rows[at[level as usize]] = row as u32;
            at[level as usize] += 1;
        }
        Self { rows, starts }
    }

    /// What comes at a level.
    pub(super) fn at(&self, level: usize) -> &[u32] {
        &self.rows[self.starts[level]..self.starts[level + 1]]
    }
}
