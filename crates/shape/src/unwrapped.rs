//! Shapes of a torus unwrapped into space.

use std::collections::BTreeMap;

use super::{AlphaShape, Simplices, Torus};

/// A copy of a point: the point, and the multiples of the vectors by which the copy is moved.
type Copied = (u32, [i32; 3]);

/// The copies that are needed, numbered after the points in the order of their first use.
pub(super) struct Layout<'a> {
    torus: Torus,
    positions: &'a [[f64; 3]],
    numbers: BTreeMap<Copied, u32>,
    /// The copies, in the order of their numbers.
    pub copied: Vec<Copied>,
}

impl<'a> Layout<'a> {
    pub(super) fn new(torus: Torus, positions: &'a [[f64; 3]]) -> Self {
        Self { torus, positions, numbers: BTreeMap::new(), copied: Vec::new() }
    }

    /// Places each simplex in the copy whose lowest parts along the vectors are in the box, so that simplices extend beyond only the upper
    /// faces of the box.
    pub(super) fn lay_out<const N: usize>(&mut self, simplices: &Simplices<N>) -> Simplices<N> {
        simplices.iter().map(|(&row, class)| (self.row(row), class)).collect()
    }

    fn row<const N: usize>(&mut self, row: [u32; N]) -> [u32; N] {
        let place = |v: u32| self.positions[v as usize];
        let ways = row.map(|v| self.torus.windings(place(row[0]), place(v)));
        let lowest = [0, 1, 2].map(|k| ways.iter().map(|way| way[k]).min().unwrap_or(0));
        let mut laid_out = row;
        for (v, way) in laid_out.iter_mut().zip(ways) {
            *v = self.number((*v, [0, 1, 2].map(|k| way[k] - lowest[k])));
        }
        laid_out
    }

    fn number(&mut self, copied: Copied) -> u32 {
        if copied.1 == [0; 3] {
            return copied.0;
        }
        *self.numbers.entry(copied).or_insert_with(|| {
            self.copied.push(copied);
            (self.positions.len() + self.copied.len()) as u32 - 1
        })
    }
}

impl AlphaShape {
    /// A shape of a torus unwrapped into space, for programs without periodic boxes: a row for each simplex, as in
    /// [`AlphaShape::complex`], except that simplices which cross an upper side of the box have copies of points in place of the
    /// points. Copies come after all points. Along the sides the result is cut open, so it is not the α-complex of its points;
    /// classes, sizes, components and sheets are those of the torus. A shape in space is returned unchanged. O(n log n).
    #[must_use]
    pub fn unwrapped(&self) -> Self {
        let Some(torus) = self.options.periodic else { return self.clone() };
        let mut layout = Layout::new(torus, &self.points.positions);
        let mut complex = self.complex.clone();
        complex.cells = layout.lay_out(&self.complex.cells);
        complex.facets = layout.lay_out(&self.complex.facets);
        complex.edges = layout.lay_out(&self.complex.edges);
        let classes: BTreeMap<u32, _> =
            self.complex.vertices.iter().map(|(&[v], class)| (v, class)).collect();
        let points = self.points.len() as u32;
        let copied = layout.copied;
        for (copy, (v, _)) in (points..).zip(&copied) {
            complex.vertices.push([copy], classes[v]);
        }
        let mut unwrapped = self.clone();
        unwrapped.complex = complex;
        unwrapped.options.periodic = None;
        (unwrapped.sums, unwrapped.solid, unwrapped.outline) = Default::default();
        for (v, way) in copied {
            let place = torus.moved(self.points.positions[v as usize], way);
            unwrapped.push_copy(v, place);
        }
        unwrapped
    }

    fn push_copy(&mut self, v: u32, place: [f64; 3]) {
        let at = v as usize;
        self.points.positions.push(place);
        self.points.weights.push(self.points.weights[at]);
        if let Some(values) = &mut self.points.values {
            values.push(values[at]);
        }
        if let Some(squared) = &mut self.squared {
            squared.push(squared[at]);
        }
        self.copies.push(v);
    }
}
