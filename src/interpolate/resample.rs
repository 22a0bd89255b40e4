use ndarray::Array3;
use rayon::prelude::*;
use walpha_base::memory::try_with_capacity;

use super::raster::{NOTHING, owners};
use super::{Grid, Interpolant, InterpolateError};
use crate::volume::Volume;

/// F on the samples of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampled {
    volume: Volume,
    /// The simplex each sample belongs to.
    pub(super) owners: Vec<u32>,
}

impl Interpolant<'_> {
    /// F on a grid. Each sample belongs to one simplex, decided as [`Interpolant`] says. O(simplices
    /// + samples), in parallel over both, the same on any number of threads; 8 bytes a sample.
    ///
    /// # Errors
    /// Values that pass the range of `f32`; no memory for as many samples.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn resample(&self, grid: &Grid) -> Result<Resampled, InterpolateError> {
        let owners = owners(self, grid)?;
        let [nx, ny, _] = grid.dims().xyz();
        let dims = grid.dims();
        let mut samples =
            try_with_capacity(dims.samples(), || format!("a volume of {dims} samples"))?;
        samples.resize(dims.samples(), 0f32);
        samples.par_chunks_mut(nx).zip(owners.par_chunks(nx)).enumerate().for_each(
            |(row, (samples, owners))| {
                for (i, (sample, &part)) in samples.iter_mut().zip(owners).enumerate() {
                    let place = || grid.position([i, row % ny, row / ny]);
                    if part != NOTHING
                        && let Some(coordinates) = self.coordinates(part, place())
                    {
                        *sample = self.value(part, &coordinates) as f32;
                    }
                }
            },
        );
        let samples = Array3::from_shape_vec(dims.shape(), samples).expect("as many as dims say");
        let volume = Volume::new(samples, *grid.frame())?.with_gray_levels();
        Ok(Resampled { volume, owners })
    }
}

impl Resampled {
    /// The values, 0 outside the shape.
    pub fn volume(&self) -> &Volume {
        &self.volume
    }

    /// Gives the values away.
    pub fn into_volume(self) -> Volume {
        self.volume
    }

    /// Whether a sample, by its index in memory order, is on the shape.
    pub fn is_inside(&self, sample: usize) -> bool {
        self.owners[sample] != NOTHING
    }

    /// Samples on the shape.
    pub fn covered(&self) -> usize {
        self.owners.par_iter().filter(|&&part| part != NOTHING).count()
    }

    /// A volume that is 1 on the shape and 0 outside.
    ///
    /// # Errors
    /// No memory for it.
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never met")]
    pub fn mask(&self) -> Result<Volume, InterpolateError> {
        let dims = self.volume.dims();
        let mut inside = try_with_capacity(dims.samples(), || format!("a mask of {dims} samples"))?;
        let value = |&part: &u32| f32::from(u8::from(part != NOTHING));
        inside.par_extend(self.owners.par_iter().map(value));
        let samples = Array3::from_shape_vec(dims.shape(), inside).expect("one for each sample");
        Ok(Volume::new(samples, *self.volume.frame())?)
    }
}
