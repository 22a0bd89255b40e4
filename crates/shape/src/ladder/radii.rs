//! The squared radii of simplices, where their smallest orthogonal spheres are empty.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

/// The double nearest to the squared radius of the smallest orthogonal sphere of a simplex, if that is
/// empty; otherwise no number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius(pub f64);

impl Radius {
    pub(super) fn known(self) -> Option<f64> {
        (!self.0.is_nan()).then_some(self.0)
    }
}

/// Squared radii of the smallest orthogonal spheres, each the nearest double, by row.
#[derive(Debug)]
pub(super) struct Radii {
    /// Of all cells, …
    pub cells: Vec<f64>,
    /// … and of what is Gabriel among lower simplices.
    pub facets: Vec<Radius>,
    pub edges: Vec<Radius>,
    pub vertices: Vec<Radius>,
}

/// Radii that threads write in the order in which they visit simplices. A slot is NaN once its sphere is known not to be
/// empty, from any thread; its radius is set after that only.
pub(super) struct Slots(Vec<AtomicU64>);

impl Slots {
    pub(super) fn new(rows: usize) -> Self {
        Self((0..rows).into_par_iter().map(|_| AtomicU64::new(0)).collect())
    }

    pub(super) fn set(&self, row: usize, radius: f64) {
        self.0[row].store(radius.to_bits(), Ordering::Relaxed);
    }

    /// Notes which faces, in the order of the corners opposite them, have spheres that are not empty.
    pub(super) fn refute<const N: usize>(&self, inside: [bool; N], faces: [u32; N]) {
        for (_, face) in inside.into_iter().zip(faces).filter(|&(inside, _)| inside) {
            self.set(face as usize, f64::NAN);
        }
    }

    pub(super) fn set_if_empty(&self, row: usize, radius: impl FnOnce() -> f64) {
        if self.0[row].load(Ordering::Relaxed) != f64::NAN.to_bits() {
            self.set(row, radius());
        }
    }

    /// The radii, in the same memory.
    pub(super) fn finished<T>(self, radius: impl Fn(f64) -> T) -> Vec<T> {
        self.0.into_iter().map(|slot| radius(f64::from_bits(slot.into_inner()))).collect()
    }
}
