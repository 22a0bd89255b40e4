//! Fits values by least squares: sets up the normal equations, and solves them by conjugate gradients.

use walpha_base::memory::{NoMemory, afford, try_with_capacity};
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use super::grid::OUTSIDE;
use super::{Grid, InterpolateError};
use walpha_volume::Volume;

/// The number of rows, or elements of a vector, in one parallel task. It is fixed, so that sums do not depend on the number of
/// threads.
const CHUNK: usize = 1 << 10;

/// The relative residual to be reached.
const TOLERANCE: f64 = 1e-6;

/// Simplices with linear functions on them.
pub(super) trait PiecewiseLinear: Sync {
    /// One more than the largest number of a simplex.
    fn count(&self) -> usize;
    /// The vertices of a simplex, and how many of the four are used.
    fn vertices(&self, part: u32) -> ([u32; 4], usize);
    /// The barycentric coordinates of a position in a simplex, if the simplex contains it.
    fn coordinates(&self, part: u32, place: [f64; 3]) -> Option<[f64; 4]>;
    /// The value of F on a simplex.
    fn value(&self, part: u32, shares: &[f64; 4]) -> f64;
}

/// Symmetric equations for the changes of values, in compressed rows, with the diagonal separate.
pub(super) struct Normal {
    starts: Vec<usize>,
    /// The off-diagonal entries: column and number.
    entries: Vec<(u32, f64)>,
    diagonal: Vec<f64>,
    right: Vec<f64>,
}

/// A solution of normal equations.
pub(super) struct Solved {
    /// The change of each value.
    pub change: Vec<f64>,
    /// The number of steps of conjugate gradients.
    pub steps: usize,
    /// The norm of the residual divided by that of the right-hand side.
    pub residual: f64,
}

/// An equation: its off-diagonal entries, diagonal and right-hand side.
#[derive(Default)]
struct Row {
    entries: Vec<(u32, f64)>,
    diagonal: f64,
    right: f64,
}

impl Normal {
    /// Sets up the equations for the values of the first `free` points; those of the others do not change. Each row is summed by
    /// one thread, over the simplices at its point in their order.
    pub(super) fn assemble(
        cells: &impl PiecewiseLinear,
        owners: &[u32],
        grid: &Grid,
        volume: &Volume,
        free: usize,
    ) -> Result<Self, NoMemory> {
        let sample_of = samples_of(cells.count(), owners, volume)?;
        let part_of = Lists::new(free, |add| {
            for part in 0..cells.count() as u32 {
                if !sample_of.of(part).is_empty() {
                    let (vertices, count) = cells.vertices(part);
                    let corners = vertices[..count].iter();
                    corners.filter(|&&v| (v as usize) < free).for_each(|&v| add(v, part));
                }
            }
        })?;
        let bytes = free.saturating_mul(16 * size_of::<(u32, f64)>());
        afford(bytes, || format!("fitting the values of {free} points"))?;
        let [nx, ny, _] = grid.dims().xyz();
        let row = |v: u32| {
            let mut row = Row::default();
            for &part in part_of.of(v) {
                let (vertices, count) = cells.vertices(part);
                let at = vertices.iter().position(|&w| w == v).expect("a part at this point");
                let (mut products, mut right) = ([0.0; 4], 0.0);
                for &sample in sample_of.of(part) {
                    let i = sample as usize;
                    let place = grid.position([i % nx, i / nx % ny, i / (nx * ny)]);
                    let Some(shares) = cells.coordinates(part, place) else { continue };
                    let error = f64::from(volume.as_slice()[i]) - cells.value(part, &shares);
                    right += shares[at] * error;
                    (0..4).for_each(|k| products[k] += shares[at] * shares[k]);
                }
                row.right += right;
                for (&w, product) in vertices[..count].iter().zip(products) {
                    row.add(v, w, product, free);
                }
            }
            row
        };
        Ok(Self::of_rows((0..free as u32).into_par_iter().map(row).collect()))
    }

    fn of_rows(rows: Vec<Row>) -> Self {
        let mut starts = vec![0];
        let (mut entries, mut diagonal, mut right) = (Vec::new(), Vec::new(), Vec::new());
        for row in rows {
            entries.extend(row.entries);
            starts.push(entries.len());
            diagonal.push(row.diagonal);
            right.push(row.right);
        }
        Self { starts, entries, diagonal, right }
    }

    /// Solves the equations by conjugate gradients, with the diagonal as preconditioner, starting from 0.
    pub(super) fn solve(&self, monitor: &Monitor) -> Result<Solved, InterpolateError> {
        let n = self.diagonal.len();
        let scaled = |r: &[f64]| -> Vec<f64> {
            let one = |(r, d): (&f64, &f64)| if *d > 0.0 { r / d } else { 0.0 };
            r.par_iter().zip(&self.diagonal).map(one).collect()
        };
        let mut change = vec![0.0; n];
        let mut residual = self.right.clone();
        let whole = dot(&residual, &residual).sqrt();
        let mut direction = scaled(&residual);
        let mut along = dot(&residual, &direction);
        for step in 0..=n + LEAST_STEPS {
            let rest = dot(&residual, &residual).sqrt();
            if rest <= TOLERANCE * whole {
                let residual = if whole > 0.0 { rest / whole } else { 0.0 };
                return Ok(Solved { change, steps: step, residual });
            }
            report_fall(rest / whole, monitor)?;
            let image = self.times(&direction);
            let length = along / dot(&direction, &image);
            add(&mut change, length, &direction);
            add(&mut residual, -length, &image);
            let corrected = scaled(&residual);
            let next = dot(&residual, &corrected);
            let kept = next / along;
            along = next;
            direction.par_iter_mut().zip(corrected).for_each(|(d, c)| *d = c + kept * *d);
        }
        Err(InterpolateError::Fit { steps: n + LEAST_STEPS })
    }

    fn times(&self, vector: &[f64]) -> Vec<f64> {
        let row = |v: usize| {
            let entries = &self.entries[self.starts[v]..self.starts[v + 1]];
            let beside: f64 = entries.iter().map(|&(w, x)| x * vector[w as usize]).sum();
            self.diagonal[v] * vector[v] + beside
        };
        (0..vector.len()).into_par_iter().with_min_len(CHUNK).map(row).collect()
    }
}

/// The least limit of steps. Without rounding, as many steps as values would be enough.
const LEAST_STEPS: usize = 100;

/// Progress on a logarithmic scale, in percent.
fn report_fall(residual: f64, monitor: &Monitor) -> Result<(), Cancelled> {
    let share = residual.log10() / TOLERANCE.log10();
    monitor.report((100.0 * share.clamp(0.0, 1.0)) as u64, 100)
}

impl Row {
    fn add(&mut self, v: u32, w: u32, product: f64, free: usize) {
        if w == v {
            self.diagonal += product;
        } else if (w as usize) < free && product != 0.0 {
            match self.entries.iter_mut().find(|entry| entry.0 == w) {
                Some(entry) => entry.1 += product,
                None => self.entries.push((w, product)),
            }
        }
    }
}

/// The inner product, with sums over chunks of a fixed size.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let of_chunk = |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let sums: Vec<f64> = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(of_chunk).collect();
    sums.iter().sum()
}

/// Computes a + s·b in place of a.
fn add(a: &mut [f64], s: f64, b: &[f64]) {
    a.par_iter_mut().zip(b).with_min_len(CHUNK).for_each(|(a, b)| *a += s * b);
}

/// The samples of each of `simplices` simplices, ascending, given the simplex of each sample. Missing samples are left out.
pub(super) fn samples_of(
    simplices: usize,
    owners: &[u32],
    volume: &Volume,
) -> Result<Lists, NoMemory> {
    Lists::new(simplices, |add| {
        for (sample, &owner) in owners.iter().enumerate() {
            if owner != OUTSIDE && !volume.is_missing(sample) {
                add(owner, sample as u32);
            }
        }
    })
}

/// A list of numbers for each key, stored in one array.
pub(super) struct Lists {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// Creates the lists. `visit` must name all pairs of a key and an item, in the same order each time it is called.
    pub(super) fn new(
        keys: usize,
        visit: impl Fn(&mut dyn FnMut(u32, u32)),
    ) -> Result<Self, NoMemory> {
        let mut starts = try_with_capacity(keys + 2, || "lists of samples".into())?;
        starts.resize(keys + 2, 0u32);
        visit(&mut |key, _| starts[key as usize + 2] += 1);
        for key in 2..starts.len() {
            starts[key] += starts[key - 1];
        }
        let count = starts[keys + 1] as usize;
        let mut items = try_with_capacity(count, || "lists of samples".into())?;
        items.resize(count, 0);
        visit(&mut |key, item| {
            let place = &mut starts[key as usize + 1];
            items[*place as usize] = item;
            *place += 1;
        });
        Ok(Self { starts, items })
    }

    /// The items of a key, in the order in which `visit` named them.
    pub(super) fn of(&self, key: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|k| self.starts[key as usize + k] as usize);
        &self.items[start..end]
    }
}
