use rayon::prelude::*;

use super::Levels;
use super::incidence::Incidence;
use super::levels::Span;
use crate::{AlphaShape, Betti, Class, Complex};

impl Levels<'_> {
    /// The shape at a level, as [`alpha_shape`](crate::alpha_shape) makes it; with `exterior`,
    /// simplices outside are kept. `betti` is the level's, of [`Levels::betti`]. O(n log n).
    ///
    /// # Panics
    /// When there is no such level.
    pub fn shape(&self, level: usize, exterior: bool, betti: Betti) -> AlphaShape {
        let alpha = self.alphas[level];
        self.filtration.whole.at(alpha, exterior, self.complex(level, exterior), betti)
    }

    /// The facets that are on the boundary of some level or singular there, counter-clockwise seen
    /// from where the shape comes later: each once for all levels. O(n).
    pub fn facets(&self) -> Vec<([u32; 3], Span)> {
        let incidence = &self.filtration.incidence;
        let shown = self.facets.par_iter().enumerate();
        let shown = shown.filter(|(_, span)| span.first < span.interior);
        shown.map(|(row, span)| (self.turned(row, incidence.facet_cells[row]), *span)).collect()
    }

    /// The edges that are singular at some level. O(n).
    pub fn singular_edges(&self) -> Vec<([u32; 2], Span)> {
        let rows = self.filtration.whole.complex().edges.rows();
        let edges = rows.iter().copied().zip(self.edges.iter().copied());
        edges.filter(|(_, span)| span.first < span.regular).collect()
    }

    /// All vertices of the triangulation. O(n).
    pub fn vertices(&self) -> Vec<(u32, Span)> {
        let rows = self.filtration.whole.complex().vertices.rows();
        rows.iter().map(|&[v]| v).zip(self.vertices.iter().copied()).collect()
    }

    /// The classified complex of a level, in canonical order.
    fn complex(&self, level: usize, exterior: bool) -> Complex {
        let whole = self.filtration.whole.complex();
        let level = level as u32;
        let cell_class =
            |first: u32| if first <= level { Class::Interior } else { Class::Exterior };
        let cells = self.cells.iter().map(|&first| cell_class(first));
        let class = |span: &Span| span.class(level);
        let facets = self.facets.iter().map(class);
        let mut oriented: Vec<_> =
            select(&self.filtration.incidence.facets, facets.clone(), exterior);
        let outward = self.outward(level);
        // Rows of both lists are in the same order.
        let mut at = outward.iter();
        for (row, class) in &mut oriented {
            if *class == Class::Regular {
                *row = *at.next().expect("each regular facet is turned");
            }
        }
        oriented.par_sort_unstable_by_key(|pair| pair.0);
        Complex {
            cells: select(whole.cells.rows(), cells, exterior),
            facets: oriented.into_iter().collect(),
            edges: select(whole.edges.rows(), self.edges.iter().map(class), exterior),
            vertices: select(whole.vertices.rows(), self.vertices.iter().map(class), exterior),
        }
    }

    /// The regular facets, counter-clockwise seen from outside, smallest vertex first, in the order
    /// of their sorted rows.
    fn outward(&self, level: u32) -> Vec<[u32; 3]> {
        let incidence = &self.filtration.incidence;
        let regular = self.facets.par_iter().enumerate();
        let regular = regular.filter(|(_, span)| span.class(level) == Class::Regular);
        regular.map(|(row, _)| self.turned(row, incidence.facet_cells[row])).collect()
    }

    /// A facet as seen from the side on which a cell comes later, or never.
    fn turned(&self, row: usize, sides: [u32; 2]) -> [u32; 3] {
        let incidence = &self.filtration.incidence;
        let comes = |cell: u32| match cell {
            Incidence::OUTSIDE => u32::MAX,
            cell => self.cells[cell as usize],
        };
        let inside = if comes(sides[0]) < comes(sides[1]) { sides[0] } else { sides[1] };
        // In a plane, where no side is the outer one.
        if inside == Incidence::OUTSIDE {
            return incidence.facets[row];
        }
        let facets = &incidence.cell_facets[inside as usize];
        let opposite = facets.iter().position(|&facet| facet as usize == row).expect("its facet");
        let cell = self.filtration.whole.complex().cells.rows()[inside as usize];
        // Seen from outside a positive cell, the corners after an even one turn clockwise.
        let mut facet = [1, 2, 3].map(|step| cell[(opposite + step) % 4]);
        if opposite % 2 == 1 {
            facet.swap(1, 2);
        }
        let first = (0..3).min_by_key(|&k| facet[k]).unwrap_or(0);
        facet.rotate_left(first);
        facet
    }
}

/// The rows that a level lists, each with its class.
fn select<const N: usize, S: FromIterator<([u32; N], Class)>>(
    rows: &[[u32; N]],
    classes: impl Iterator<Item = Class>,
    exterior: bool,
) -> S {
    let wanted = rows.iter().copied().zip(classes);
    wanted.filter(|&(_, class)| exterior || class != Class::Exterior).collect()
}
