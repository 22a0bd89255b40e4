use super::least_squares::Pieces;
use super::raster::{NOTHING, owners};
use super::{Grid, Interpolant, InterpolateError};
use crate::volume::Volume;

impl Interpolant<'_> {
    /// How far F is from a volume around each point: the root mean square difference at the samples of the
    /// point's simplices, each weighted by the point's barycentric coordinate there. In the units of the
    /// values; 0 for a point that no sample counts for. `grid` is that of the volume, in the units of the
    /// points. O(samples).
    ///
    /// # Errors
    /// No memory.
    ///
    /// # Panics
    /// When grid and volume are not of one shape.
    pub fn local_deviations(
        &self,
        original: &Volume,
        grid: &Grid,
    ) -> Result<Vec<f64>, InterpolateError> {
        assert_eq!(original.dims(), grid.dims(), "one grid");
        let [nx, ny, _] = grid.dims().xyz();
        let owners = owners(self, grid)?;
        let mut sums = vec![[0.0; 2]; self.values().len()];
        for (sample, &part) in owners.iter().enumerate() {
            if part == NOTHING || original.is_missing(sample) {
                continue;
            }
            let place = grid.position([sample % nx, sample / nx % ny, sample / (nx * ny)]);
            let Some(shares) = self.coordinates(part, place) else { continue };
            let difference = self.value(part, &shares) - f64::from(original.as_slice()[sample]);
            let (vertices, count) = self.vertices(part);
            for (vertex, share) in vertices[..count].iter().zip(shares) {
                let [squares, weights] = &mut sums[*vertex as usize];
                *squares += share * difference * difference;
                *weights += share;
            }
        }
        let root = |[squares, weights]: [f64; 2]| {
            if weights > 0.0 { (squares / weights).sqrt() } else { 0.0 }
        };
        Ok(sums.into_iter().map(root).collect())
    }
}
