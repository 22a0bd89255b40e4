//! What one point more or less would change, with everything else as it is.

use walpha_base::memory::NoMemory;
use walpha_regular::number::{cross, dot};
use walpha_regular::{Growing, Screen, Workspace};

use super::lists::{Lists, samples_of};
use super::sampled::Sampled;
use crate::shape::ShapeError;
use crate::volume::Volume;

/// What the removal of a point would cost.
pub(super) struct Loss {
    /// The point, by its number.
    pub point: u32,
    /// The squared error added.
    pub loss: f64,
    /// The points beside it.
    pub around: Vec<u32>,
}

/// What a new point would gain.
pub(super) struct Gain {
    /// The point, by its number.
    pub point: u32,
    /// The squared error taken away.
    pub gain: f64,
    /// The cells that would go.
    pub removed: Vec<u32>,
    /// The points that would be beside it.
    pub around: Vec<u32>,
}

/// A triangulation that points are tried on.
pub(super) struct Trial<'a> {
    volume: &'a Volume,
    sampled: &'a Sampled<'a>,
    screen: &'a Screen<'a>,
    samples: Lists,
}

impl<'a> Trial<'a> {
    /// Looks up which samples each cell has. O(samples).
    pub(super) fn new(
        volume: &'a Volume,
        sampled: &'a Sampled<'a>,
        screen: &'a Screen<'a>,
    ) -> Result<Self, NoMemory> {
        let samples = samples_of(sampled.cells(), sampled.owners(), volume)?;
        Ok(Self { volume, sampled, screen, samples })
    }

    /// What [`Self::loss`] works with.
    pub(super) fn workspace(&self) -> Result<Workspace, ShapeError> {
        Ok(Workspace::new(self.sampled.voxels().len())?)
    }

    /// What the removal of a vertex costs, where it can be removed.
    pub(super) fn loss(
        &self,
        point: u32,
        workspace: &mut Result<Workspace, ShapeError>,
    ) -> Result<Option<Loss>, ShapeError> {
        let workspace = workspace.as_mut().map_err(|error| error.clone())?;
        let Some(hole) = self.growing().hole(self.screen, point, workspace)? else {
            return Ok(None);
        };
        let rows = hole.filling.iter().map(|cell| cell.corners);
        let cells =
            LinearCells::of(rows.filter(|row| row.iter().all(|&v| v >= Growing::FIRST)), self);
        let mut loss = 0.0;
        for &sample in hole.star.iter().flat_map(|&cell| self.samples.of(cell)) {
            let Some((row, shares)) = cells.at(self.sampled.place(sample)) else {
                return Ok(None);
            };
            let f: f64 = (0..4).map(|k| shares[k] * self.value(row[k])).sum();
            loss += (self.gray(sample) - f).powi(2) - self.error(sample).powi(2);
        }
        Ok(Some(Loss { point, loss, around: cells.vertices(point) }))
    }

    /// What a point gains that is a sample and no vertex, with the value that gains most.
    pub(super) fn gain(&self, point: u32) -> Option<Gain> {
        let cell = self.sampled.owners()[self.sampled.voxels()[point as usize] as usize];
        let insertion = self.growing().insertion(self.screen, point, cell);
        let cells = LinearCells::of(insertion.cells.iter().copied(), self);
        // Of the errors without the new value, e, and its shares φ: Σe², Σφe, Σφ².
        let (mut before, mut errors, mut products, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for &sample in insertion.removed.iter().flat_map(|&cell| self.samples.of(cell)) {
            let (row, shares) = cells.at(self.sampled.place(sample))?;
            let mut error = self.gray(sample);
            for (v, share) in row.into_iter().zip(shares) {
                if v == point {
                    squares += share * share;
                } else {
                    error -= share * self.value(v);
                }
            }
            let share = row.iter().position(|&v| v == point).map_or(0.0, |k| shares[k]);
            before += self.error(sample).powi(2);
            errors += error * error;
            products += share * error;
        }
        (squares > 0.0).then(|| Gain {
            point,
            gain: before - (errors - products * products / squares),
            around: cells.vertices(point),
            removed: insertion.removed,
        })
    }

    fn growing(&self) -> &Growing {
        self.sampled.growing()
    }

    fn value(&self, v: u32) -> f64 {
        self.sampled.values()[v as usize]
    }

    fn gray(&self, sample: u32) -> f64 {
        self.volume.as_slice()[sample as usize].into()
    }

    fn error(&self, sample: u32) -> f64 {
        self.gray(sample) - f64::from(self.sampled.f()[sample as usize])
    }
}

/// A few cells, each with the map from a place to its coordinates there.
struct LinearCells(Vec<LinearCell>);

struct LinearCell {
    row: [u32; 4],
    origin: [f64; 3],
    /// The gradients of the last three coordinates.
    gradients: [[f64; 3]; 3],
}

impl LinearCells {
    fn of(rows: impl Iterator<Item = [u32; 4]>, trial: &Trial<'_>) -> Self {
        Self(rows.filter_map(|row| LinearCell::of(row, trial.growing().positions())).collect())
    }

    /// The cell that a place is in, or nearest to being in, and its coordinates there. Rounding decides
    /// between cells at a face, where all of them say the same.
    fn at(&self, place: [f64; 3]) -> Option<([u32; 4], [f64; 4])> {
        let mut best = None;
        let mut depth = f64::NEG_INFINITY;
        for cell in &self.0 {
            let shares = cell.shares(place);
            let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
            if least > depth {
                depth = least;
                best = Some((cell.row, shares));
                if least >= 0.0 {
                    break;
                }
            }
        }
        best
    }

    /// The vertices, without one.
    fn vertices(&self, without: u32) -> Vec<u32> {
        let all = self.0.iter().flat_map(|cell| cell.row);
        let mut vertices: Vec<u32> = all.filter(|&v| v != without).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }
}

impl LinearCell {
    /// `None` for a cell without volume, as there are among points on one sphere.
    fn of(row: [u32; 4], positions: &[[f64; 3]]) -> Option<Self> {
        let [a, b, c, d] = row.map(|v| positions[v as usize]);
        let from = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let [b, c, d] = [b, c, d].map(from);
        let normals = [cross(&c, &d), cross(&d, &b), cross(&b, &c)];
        let whole = dot(&b, &normals[0]);
        let gradients = normals.map(|normal| normal.map(|x| x / whole));
        let is_solid = whole != 0.0 && gradients.as_flattened().iter().all(|x| x.is_finite());
        is_solid.then_some(Self { row, origin: a, gradients })
    }

    fn shares(&self, place: [f64; 3]) -> [f64; 4] {
        let from = [0, 1, 2].map(|k| place[k] - self.origin[k]);
        let [b, c, d] = self.gradients.map(|gradient| dot(&gradient, &from));
        [1.0 - b - c - d, b, c, d]
    }
}
