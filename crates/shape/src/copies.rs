//! Copies of the points of a periodic box.

use std::collections::BTreeMap;

use super::winding::{Winding, minus};
use super::{AlphaShape, Complex, ShapeOptions, Torus, WeightedPoints};

/// A copy of a point: the point, and the multiples of the vectors by which the copy is moved.
pub(crate) type Copied = (u32, Winding);

/// The copies that are needed, numbered after the points in the order of their first use.
pub(crate) struct Copier {
    points: usize,
    numbers: BTreeMap<Copied, u32>,
    /// The copies, in the order of their numbers.
    pub copied: Vec<Copied>,
}

impl Copier {
    pub(crate) fn new(points: usize) -> Self {
        Self { points, numbers: BTreeMap::new(), copied: Vec::new() }
    }

    /// The number of a copy; of a point itself, if it is not moved.
    pub(crate) fn number(&mut self, copied: Copied) -> u32 {
        if copied.1 == [0; 3] {
            return copied.0;
        }
        *self.numbers.entry(copied).or_insert_with(|| {
            self.copied.push(copied);
            (self.points + self.copied.len()) as u32 - 1
        })
    }

    /// A row [laid out](AlphaShape::laid_out), by the numbers of copies.
    pub(crate) fn lay_out<const N: usize>(
        &mut self,
        shape: &AlphaShape,
        row: [u32; N],
    ) -> [u32; N] {
        shape.laid_out(row).map(|copied| self.number(copied))
    }
}

impl WeightedPoints {
    /// Keeps this many, the first.
    fn truncate(&mut self, count: usize) {
        self.positions.truncate(count);
        self.weights.truncate(count);
        self.values.iter_mut().for_each(|values| values.truncate(count));
    }

    /// Gives the points, which are the first so many, these copies in place of those that they have.
    pub(crate) fn set_copies(&mut self, own: usize, torus: Torus, copied: &[Copied]) {
        self.truncate(own);
        for &(v, shift) in copied {
            let at = v as usize;
            self.positions.push(torus.moved(self.positions[at], shift));
            self.weights.push(self.weights[at]);
            self.values.iter_mut().for_each(|values| values.push(values[at]));
        }
    }
}

/// The vertices of a simplex of a torus in order, with their shifts; the first shift is 0. It identifies the simplex also where its vertices alone do not.
pub(crate) type Key<const N: usize> = [Copied; N];

/// The vertices in order, moved so that the first shift is 0; and that shift.
pub(crate) fn key<const N: usize>(mut vertices: Key<N>) -> (Key<N>, [i32; 3]) {
    vertices.sort_unstable();
    let first = vertices[0].1;
    (vertices.map(|(v, shift)| (v, minus(shift, first))), first)
}

/// The faces opposite each vertex.
pub(crate) fn faces<const N: usize, const F: usize>(vertices: Key<N>) -> [Key<F>; N] {
    std::array::from_fn(|opposite| {
        std::array::from_fn(|at| vertices[at + usize::from(at >= opposite)])
    })
}

impl AlphaShape {
    /// The vertices of a row, with the multiples of the vectors of the periodic box by which each is moved against the first, which is in the
    /// box. In space all are 0.
    pub(crate) fn shifted<const N: usize>(&self, row: [u32; N]) -> [Copied; N] {
        if let Some(torus) = self.nearest() {
            let place = |v: u32| self.points.positions[v as usize];
            return row.map(|v| (v, torus.windings(place(row[0]), place(v))));
        }
        let first = self.copied(row[0]).1;
        row.map(|v| {
            let (v, shift) = self.copied(v);
            (v, minus(shift, first))
        })
    }

    /// A row in the copy whose lowest parts along the vectors are in the box, so that simplices extend beyond only the upper
    /// faces of the box.
    pub(crate) fn laid_out<const N: usize>(&self, row: [u32; N]) -> [Copied; N] {
        let copied = self.shifted(row);
        let lowest = [0, 1, 2].map(|k| copied.iter().map(|(_, way)| way[k]).min().unwrap_or(0));
        copied.map(|(v, way)| (v, minus(way, lowest)))
    }

    /// The torus on which rows name the copies nearest to their first vertices; `None` in space, and where copies have names of their own.
    #[doc(hidden)]
    pub fn nearest(&self) -> Option<Torus> {
        self.options.periodic.filter(|_| self.copies.is_empty())
    }

    /// The number of points that are not [copies](Self::copies).
    pub fn own_points(&self) -> usize {
        self.points.len() - self.copies.len()
    }

    /// The points without [copies](Self::copies). O(n).
    pub fn without_copies(&self) -> WeightedPoints {
        let own = self.own_points();
        let mut points = self.points.clone();
        points.truncate(own);
        points
    }

    /// The point that a vertex is a copy of, and the multiples of the vectors by which it is moved.
    #[doc(hidden)]
    pub fn copied(&self, v: u32) -> (u32, [i32; 3]) {
        match (v as usize).checked_sub(self.own_points()) {
            None => (v, [0; 3]),
            Some(copy) => (self.copies[copy], self.shifts[copy]),
        }
    }

    /// Gives the shape these copies of its points, in place of those that it has.
    pub(crate) fn set_copies(&mut self, torus: Torus, copied: Vec<Copied>) {
        let own = self.own_points();
        self.points.set_copies(own, torus, &copied);
        if let Some(squared) = &mut self.squared {
            squared.truncate(own);
            copied.iter().for_each(|&(v, _)| squared.push(squared[v as usize]));
        }
        (self.copies, self.shifts) = copied.into_iter().unzip();
    }

    /// The shape with other weights than those that it was found with, which follow from them.
    pub(crate) fn of_points(
        mut self,
        weights: Vec<f64>,
        values: Option<Vec<f64>>,
        squared: Option<Vec<f64>>,
        options: ShapeOptions,
    ) -> Self {
        let Some(torus) = self.options.periodic else { return self };
        let copied = self.copies.iter().copied().zip(self.shifts.iter().copied()).collect();
        self.points.positions.truncate(self.own_points());
        (self.points.weights, self.points.values, self.squared) = (weights, values, squared);
        self.copies.clear();
        self.set_copies(torus, copied);
        self.hidden = self.hidden.filter(|_| options.exterior || options.hidden);
        self.options = ShapeOptions { periodic: Some(torus), ..options };
        self
    }

    /// The shape of a whole torus that this shape of a larger one covers.
    pub(crate) fn divided(mut self, by: Divided) -> Self {
        let Divided { torus, points, complex, hidden, duplicates, copied } = by;
        self.options.periodic = Some(torus);
        (self.points, self.complex, self.hidden, self.duplicates) =
            (points, complex, hidden, duplicates);
        self.set_copies(torus, copied);
        (self.sums, self.solid, self.outline) = Default::default();
        self
    }
}

/// The data of a shape of the whole torus.
pub(crate) struct Divided {
    pub torus: Torus,
    pub points: WeightedPoints,
    pub complex: Complex,
    pub hidden: Option<Vec<u32>>,
    pub duplicates: Vec<[u32; 2]>,
    pub copied: Vec<Copied>,
}
