use std::sync::atomic::{AtomicU32, Ordering};

use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::ByRow as _;
use walpha_regular::internals::{Interval, Predicates};

use super::Filtration;
use super::build::Incidence;
use super::small::is_even;
use crate::{Alpha, AlphaShape, Betti, Class, Complex, Torus, WeightedPoints};

/// The levels at which the class of a simplex changes. Levels count from 0; the number of levels stands for never. The fields are
/// public because this is plain data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The first level at which it is in the shape.
    pub first: u32,
    /// The first level at which it is a face of another simplex of the shape; it is singular before.
    pub regular: u32,
    /// The first level at which it is not on the boundary.
    pub interior: u32,
}

impl Span {
    fn until(never: u32) -> Self {
        Self { first: never, regular: never, interior: 0 }
    }

    /// Accounts for a coface.
    fn add_coface(&mut self, higher: Self) {
        self.regular = self.regular.min(higher.first);
        self.interior = self.interior.max(higher.interior);
    }

    /// Sets the level at which the simplex enters by its own sphere, if that sphere is empty. It must be called after all
    /// cofaces.
    ///
    /// The smallest orthogonal sphere of a face is no larger than that of a coface, so own ≤ regular. This makes each
    /// level a complex; contradictory predicates would be found here.
    fn set_first(&mut self, own: Option<u32>) {
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

/// A filtration at several α: for each simplex, the first level at which it is in the shape, and the levels at which its class
/// changes. Levels are nested, because a simplex never leaves.
#[derive(Debug)]
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
    /// Decides exactly for every simplex at which α it is in the shape. The α are sorted, and duplicates are removed. O(n log m)
    /// for m levels, and exact arithmetic for ties.
    pub fn levels(&self, alphas: &[Alpha]) -> Levels<'_> {
        let mut alphas = alphas.to_vec();
        alphas.sort_unstable();
        alphas.dedup();
        let spheres = self.spheres();
        let complex = self.whole.complex();
        let never = alphas.len() as u32;
        let cells: Vec<u32> = (complex.cells.rows().par_iter().zip(&self.radii.cells).coarse())
            .map(|(&cell, &radius)| level(&spheres, cell, radius, &alphas))
            .collect();
        let own = OwnLevels {
            facets: |row: usize| {
                let facet = self.incidence.facets[row];
                self.radii.facets[row].known().map(|radius| level(&spheres, facet, radius, &alphas))
            },
            edges: |row: usize| {
                let edge = complex.edges.rows()[row];
                self.radii.edges[row].known().map(|radius| level(&spheres, edge, radius, &alphas))
            },
            vertices: |row: usize| {
                let vertex = complex.vertices.rows()[row];
                self.radii.vertices[row]
                    .known()
                    .map(|radius| level(&spheres, vertex, radius, &alphas))
            },
        };
        let (facets, edges, vertices) = self.spans(never, &cells, own);
        Levels { filtration: self, alphas, cells, facets, edges, vertices }
    }

    /// The spans of facets, edges and vertices, from the levels of cells and of own empty spheres.
    pub(super) fn spans<F, E, V>(
        &self,
        never: u32,
        cells: &[u32],
        own: OwnLevels<F, E, V>,
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
                // Beyond the hull, no cell ever enters.
                let first = if cell == Incidence::OUTSIDE { never } else { cells[cell as usize] };
                span.add_coface(Span { first, regular: first, interior: first });
            }
            span.set_first((own.facets)(row));
            span
        };
        let facets: Vec<Span> =
            incidence.facet_cells.par_iter().coarse().enumerate().map(of_facet).collect();
        // Without cells, the points span no volume, and no simplex is ever interior.
        let faces =
            Span { interior: if cells.is_empty() { never } else { 0 }, ..Span::until(never) };
        let edges = Cofaces::new(complex.edges.len(), faces);
        facets.par_iter().zip(&incidence.facet_edges).coarse().for_each(|(&facet, on)| {
            on.iter().for_each(|&edge| edges.add(edge as usize, facet));
        });
        let edges = edges.finished(own.edges);
        let vertices = Cofaces::new(complex.vertices.len(), faces);
        edges.par_iter().zip(complex.edges.rows()).coarse().for_each(|(&edge, ends)| {
            for &v in ends {
                vertices.add(incidence.vertex_rows[v as usize] as usize, edge);
            }
        });
        let vertices = vertices.finished(own.vertices);
        (facets, edges, vertices)
    }
}

/// The spans of faces, to which threads add cofaces in any order: the smallest and largest levels do not depend on it.
struct Cofaces(Vec<[AtomicU32; 2]>);

impl Cofaces {
    fn new(rows: usize, span: Span) -> Self {
        let row = |_| [span.regular, span.interior].map(AtomicU32::new);
        Self((0..rows).into_par_iter().coarse().map(row).collect())
    }

    /// Accounts for a coface, like [`Span::add_coface`].
    fn add(&self, row: usize, higher: Span) {
        let [regular, interior] = &self.0[row];
        // Reading is cheaper, and most cofaces change nothing.
        if higher.first < regular.load(Ordering::Relaxed) {
            regular.fetch_min(higher.first, Ordering::Relaxed);
        }
        if higher.interior > interior.load(Ordering::Relaxed) {
            interior.fetch_max(higher.interior, Ordering::Relaxed);
        }
    }

    /// The spans after all cofaces are added, given the levels of own spheres.
    fn finished(self, own: impl Fn(usize) -> Option<u32> + Sync) -> Vec<Span> {
        let span = |(row, levels): (usize, [AtomicU32; 2])| {
            let [regular, interior] = levels.map(AtomicU32::into_inner);
            let mut span = Span { first: regular, regular, interior };
            span.set_first(own(row));
            span
        };
        self.0.into_par_iter().coarse().enumerate().map(span).collect()
    }
}

/// For each row, the level at which a simplex enters by its own sphere, if that sphere is empty.
pub(super) struct OwnLevels<F, E, V> {
    pub facets: F,
    pub edges: E,
    pub vertices: V,
}

impl Levels<'_> {
    /// The first level of each maximal simplex, by row. Maximal simplices are cells or, if points span no volume, triangles,
    /// edges, or one vertex.
    pub(super) fn firsts_of_maximal(&self) -> Vec<u32> {
        let firsts = |spans: &[Span]| spans.iter().map(|span| span.first).collect();
        match self.filtration.dimension() {
            3 => self.cells.clone(),
            2 => firsts(&self.facets),
            1 => firsts(&self.edges),
            _ => firsts(&self.vertices),
        }
    }

    /// The points and their frozen weights.
    pub fn points(&self) -> &WeightedPoints {
        self.filtration.points()
    }

    /// The torus on which the points are, if they are on one.
    pub fn torus(&self) -> Option<Torus> {
        self.filtration.torus()
    }

    /// The number of points without the copies that rows of a small periodic box name.
    pub fn own_points(&self) -> usize {
        self.filtration.whole.own_points()
    }

    /// The α of each level, ascending.
    pub fn alphas(&self) -> &[Alpha] {
        &self.alphas
    }

    /// The number of levels.
    pub fn len(&self) -> usize {
        self.alphas.len()
    }

    /// Whether there are no levels.
    pub fn is_empty(&self) -> bool {
        self.alphas.is_empty()
    }
}

/// The level at which a simplex enters by its own sphere: the number of α, which ascend, that are too small. `radius` is the
/// double nearest to its squared radius.
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

/// The simplices of a triangulation by row, with the levels at which they enter and change, and which are faces of which.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct LevelRows<'a> {
    /// All simplices; the facets are in another order here.
    pub complex: &'a Complex,
    /// The level at which each cell enters.
    pub cells: &'a [u32],
    /// The facets, each sorted, in lexicographic order.
    pub facets: &'a [[u32; 3]],
    pub facet_spans: &'a [Span],
    /// The cells on both sides of each facet; `u32::MAX` beyond the hull.
    pub facet_cells: &'a [[u32; 2]],
    /// The edge opposite each corner of each facet.
    pub facet_edges: &'a [[u32; 3]],
    /// The facet opposite each corner of each cell.
    pub cell_facets: &'a [[u32; 4]],
    pub edge_spans: &'a [Span],
    /// In the order of the vertices of the complex.
    pub vertex_spans: &'a [Span],
}

/// Rows grouped by the level at which they enter, ascending within each: `rows[starts[k]..starts[k + 1]]` at level k;
/// those that never enter are last.
#[doc(hidden)]
#[derive(Debug)]
pub struct ByLevel {
    rows: Vec<u32>,
    starts: Vec<usize>,
}

impl ByLevel {
    /// Rows by their levels; the number of levels stands for never.
    pub fn new(levels: usize, first: impl ExactSizeIterator<Item = u32> + Clone) -> Self {
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

    /// The rows that enter at a level.
    pub fn at(&self, level: usize) -> &[u32] {
        &self.rows[self.starts[level]..self.starts[level + 1]]
    }
}

impl Levels<'_> {
    /// The shape at a level, equal to that of [`alpha_shape`](crate::alpha_shape); with `exterior`,
    /// simplices outside are kept. `betti` is the level's, of [`Levels::betti`]. O(n log n).
    ///
    /// # Panics
    /// If the level does not exist.
    pub fn shape(&self, level: usize, exterior: bool, betti: Betti) -> AlphaShape {
        let alpha = self.alphas[level];
        self.filtration.whole.at(alpha, exterior, self.complex(level, exterior), betti)
    }

    /// All simplices of the triangulation with their levels, and which are faces of which.
    #[doc(hidden)]
    pub fn rows(&self) -> LevelRows<'_> {
        let Filtration { whole, incidence, .. } = self.filtration;
        LevelRows {
            complex: whole.complex(),
            cells: &self.cells,
            facets: &incidence.facets,
            facet_spans: &self.facets,
            facet_cells: &incidence.facet_cells,
            facet_edges: &incidence.facet_edges,
            cell_facets: &incidence.cell_facets,
            edge_spans: &self.edges,
            vertex_spans: &self.vertices,
        }
    }

    /// The facets that are regular or singular at some level, counter-clockwise seen from the side whose cell enters
    /// later: each once for all levels. O(n).
    pub fn facets(&self) -> Vec<([u32; 3], Span)> {
        let incidence = &self.filtration.incidence;
        let shown = self.facets.par_iter().coarse().enumerate();
        let shown = shown.filter(|(_, span)| span.first < span.interior);
        shown.map(|(row, span)| (self.oriented(row, incidence.facet_cells[row]), *span)).collect()
    }

    /// The edges that are singular at some level. O(n).
    pub fn singular_edges(&self) -> Vec<([u32; 2], Span)> {
        let rows = self.filtration.whole.complex().edges.rows();
        let edges = rows.iter().copied().zip(self.edges.iter().copied());
        edges.filter(|(_, span)| span.first < span.regular).collect()
    }

    /// All cells of the triangulation, each with the level at which it enters the shape. O(n).
    pub fn cells(&self) -> Vec<([u32; 4], u32)> {
        let rows = self.filtration.whole.complex().cells.rows();
        rows.iter().copied().zip(self.cells.iter().copied()).collect()
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
                *row = *at.next().expect("each regular facet is oriented");
            }
        }
        oriented.sort_by_row();
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
        let regular = self.facets.par_iter().coarse().enumerate();
        let regular = regular.filter(|(_, span)| span.class(level) == Class::Regular);
        regular.map(|(row, _)| self.oriented(row, incidence.facet_cells[row])).collect()
    }

    /// A facet, counter-clockwise seen from the side whose cell enters later, or never.
    fn oriented(&self, row: usize, sides: [u32; 2]) -> [u32; 3] {
        let incidence = &self.filtration.incidence;
        let entry = |cell: u32| match cell {
            Incidence::OUTSIDE => u32::MAX,
            cell => self.cells[cell as usize],
        };
        let inside = if entry(sides[0]) < entry(sides[1]) { sides[0] } else { sides[1] };
        // Points in a plane: there are no cells, so neither side is outside.
        if inside == Incidence::OUTSIDE {
            return incidence.facets[row];
        }
        let facets = &incidence.cell_facets[inside as usize];
        let opposite = facets.iter().position(|&facet| facet as usize == row).expect("its facet");
        let cell = self.filtration.whole.complex().cells.rows()[inside as usize];
        let mut facet = Incidence::outward(opposite).map(|k| cell[k]);
        let whole = &self.filtration.whole;
        if !whole.copies().is_empty() {
            // The corners of the cell may be other copies than those of the row.
            let mut row = incidence.facets[row];
            if !is_even(facet.map(|v| whole.copied(v))) {
                row.swap(1, 2);
            }
            return row;
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
