//! Gray levels, truncated gray levels and differences in any part of a volume, and passes over all of it, tile by tile.

use ndarray::Array3;
use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;

use super::brick_digests::ReadDigests;
use super::{BlocksError, Job, SampleBox, Team};
use walpha_points::difference;
use walpha_points::haar::HaarError;
use walpha_points::internal::Bricks;
use walpha_points::internal::Cut;
use walpha_volume::{Frame, GrayRange, Nan, Source, Volume, VolumeError};

/// The approximate number of samples processed at a time.
const TILE: usize = 1 << 22;
/// The minimum number of samples along an edge of a tile.
const EDGE: usize = 64;
/// The largest number of sums of bricks of 8 samples a side; if there were more, bricks have 16 samples a side.
const SUMS: usize = 1 << 24;

/// A volume read part by part, as gray levels.
pub(super) struct Field {
    source: Source,
    input: String,
    pub dims: [usize; 3],
    pub bricks: Bricks,
    nan: Option<Nan>,
    /// The values that are gray 0 and 255.
    pub range: GrayRange,
    /// The least value, which replaces missing ones.
    pub least: f32,
    /// The digests of the bricks read so far.
    pub digests: ReadDigests,
}

/// The truncated volume.
#[expect(clippy::large_enum_variant, reason = "there is one for each block at work")]
pub(super) enum Truncated {
    /// Only zeros were dropped: it equals the volume.
    Same,
    /// For the non-standard decomposition: the cut that determines which coefficients stay, and the sums of the bricks of the
    /// truncated volume.
    Bricks { cut: Cut, sums: Vec<f64> },
    /// For the standard decomposition: its samples, and digests of those that were read.
    File(Source, ReadDigests),
}

/// The gray levels of a part, and which samples are missing.
pub(super) struct Grays {
    pub values: Vec<f32>,
    pub missing: Option<Vec<bool>>,
}

/// A sample that may become a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Its index in the volume.
    pub voxel: u64,
    pub difference: f64,
    /// The gray level, before and after truncation.
    pub gray: f32,
    pub smoothed: f32,
    pub missing: bool,
}

impl Field {
    /// Opens the input of a job, of which a part or all will be read.
    pub(super) fn open(job: &Job, part: Option<&SampleBox>) -> Result<Self, BlocksError> {
        let source = Source::open(&job.input, &job.recipe.read)?;
        if source.dims() != job.dims {
            let what = format!("it has {} samples, not {}", source.dims(), job.dims);
            return Err(BlocksError::changed(&job.input, what));
        }
        let dims = source.dims().xyz();
        let (bricks, nan) = (Self::bricks_of(dims), job.recipe.read.nan);
        let digests =
            ReadDigests::none_of(part.unwrap_or(&SampleBox::whole(dims)), bricks.side(), dims);
        let input = job.input.clone();
        let (range, least) = (GrayRange::IDENTITY, 0.0);
        Ok(Self { source, input, dims, bricks, nan, range, least, digests })
    }

    /// Whether the values are gray levels already, and all are numbers.
    pub(super) fn is_gray(&self) -> bool {
        self.source.has_gray_levels()
    }

    /// The size of tiles: whole bricks, and whole pieces of the file unless these are larger.
    pub(super) fn tile(&self) -> [usize; 3] {
        Self::tile_of(&self.source)
    }

    /// The size of tiles for an opened volume.
    pub(super) fn tile_of(source: &Source) -> [usize; 3] {
        let dims = source.dims().xyz();
        let side = Self::bricks_of(dims).side();
        let whole = dims.map(|n| n.next_multiple_of(side));
        let grain = source.grain();
        let mut tile = [0, 1, 2].map(|k| grain[k].max(EDGE).next_multiple_of(side).min(whole[k]));
        let samples = |tile: [usize; 3]| tile.iter().product::<usize>();
        // The tile is enlarged if there is room, and reduced if pieces of the file are too large; z comes first.
        for k in [2, 1, 0] {
            while samples(tile) < TILE && 2 * tile[k] <= 4 * EDGE && tile[k] < whole[k] {
                tile[k] = (2 * tile[k]).min(whole[k]);
            }
            while samples(tile) > 4 * TILE && tile[k] > EDGE {
                tile[k] = (tile[k] / 2).next_multiple_of(side);
            }
        }
        tile
    }

    /// The bricks, as small as the memory for their sums allows.
    pub(super) fn bricks_of(dims: [usize; 3]) -> Bricks {
        let fine = Bricks::new(dims, 3);
        let is_fit = fine.count().iter().product::<usize>() <= SUMS;
        if is_fit { fine } else { Bricks::new(dims, 4) }
    }

    /// The index of a sample in the volume.
    pub(super) fn voxel(&self, [x, y, z]: [usize; 3]) -> u64 {
        let [nx, ny, _] = self.dims;
        ((z * ny + y) * nx + x) as u64
    }

    /// The values of a part, with the rule for NaN and infinities applied: replaced by a value or [missing](Nan::Mask).
    pub(super) fn values(&self, part: &SampleBox) -> Result<Grays, BlocksError> {
        let mut values = self.source.read(part.first, part.size)?;
        if !self.digests.note(part, &values) {
            let what = "a part of it was read twice, and was not the same".to_owned();
            return Err(BlocksError::changed(&self.input, what));
        }
        let mut missing = None;
        if !self.is_gray() {
            if let Some(Nan::Mask) = self.nan
                && values.par_iter().any(|v| !v.is_finite())
            {
                missing = Some(values.par_iter().map(|v| !v.is_finite()).collect());
            }
            let instead = match self.nan {
                Some(Nan::Value(value)) => value,
                Some(Nan::Mask) => self.least,
                None => f32::NAN,
            };
            values.par_iter_mut().filter(|v| !v.is_finite()).for_each(|v| *v = instead);
            if let Some(i) = values.par_iter().position_first(|v| !v.is_finite()) {
                let [x, y, _] = part.size;
                let at = [i % x, i / x % y, i / (x * y)];
                let first = self.source.first();
                let at = [0, 1, 2].map(|k| first[k] + part.first[k] + at[k]);
                return Err(VolumeError::NotFinite { value: values[i], at }.into());
            }
        }
        Ok(Grays { values, missing })
    }

    /// The gray levels of a part.
    pub(super) fn grays(&self, part: &SampleBox) -> Result<Grays, BlocksError> {
        let mut grays = self.values(part)?;
        if !self.range.is_identity() {
            let range = self.range;
            grays.values.par_iter_mut().for_each(|v| *v = range.gray((*v).into()) as f32);
        }
        Ok(grays)
    }

    /// The coefficients of a part that consists of whole bricks, with the sum of each brick at its first place.
    pub(super) fn coefficients(&self, part: &SampleBox, grays: &[f32]) -> Vec<f64> {
        let mut values: Vec<f64> = grays.par_iter().map(|&v| f64::from(v)).collect();
        self.bricks.fine(&mut values, part.size);
        values
    }

    /// Visits the samples of a part that consists of whole bricks: the index in the part, the index in the volume, and the number
    /// of the brick whose first sample it is, if it is one.
    pub(super) fn places(
        &self,
        part: &SampleBox,
        mut visit: impl FnMut(usize, u64, Option<usize>),
    ) {
        let side = self.bricks.side();
        let [cx, cy, _] = self.bricks.count();
        let mut place = 0;
        for z in part.first[2]..part.first[2] + part.size[2] {
            for y in part.first[1]..part.first[1] + part.size[1] {
                let row = self.voxel([part.first[0], y, z]);
                let bricks =
                    (y % side == 0 && z % side == 0).then(|| (z / side * cy + y / side) * cx);
                for (i, x) in (part.first[0]..part.first[0] + part.size[0]).enumerate() {
                    let brick = bricks.filter(|_| x % side == 0).map(|row| row + x / side);
                    visit(place, row + i as u64, brick);
                    place += 1;
                }
            }
        }
    }

    /// The truncated gray levels of a part that consists of whole bricks.
    fn smoothed(
        &self,
        part: &SampleBox,
        grays: &[f32],
        truncated: &Truncated,
    ) -> Result<Volume, BlocksError> {
        let samples = match truncated {
            Truncated::Same => grays.to_vec(),
            Truncated::File(samples, digests) => {
                let samples = samples.read(part.first, part.size)?;
                digests.note(part, &samples);
                samples
            }
            Truncated::Bricks { cut, sums } => {
                let mut values = self.coefficients(part, grays);
                self.places(part, |place, voxel, brick| {
                    let value = &mut values[place];
                    *value = match brick {
                        Some(brick) => sums[brick],
                        None if cut.keeps(*value, voxel) => *value,
                        None => 0.0,
                    };
                });
                self.bricks.inverse_fine(&mut values, part.size);
                values.par_iter().map(|&v| v as f32).collect()
            }
        };
        let [x, y, z] = part.size;
        let samples = Array3::from_shape_vec((z, y, x), samples).expect("as many as the part has");
        Ok(Volume::new(samples, Frame::VOXEL).map_err(HaarError::from)?)
    }

    /// Visits the samples of a part in order of their index. Bricks around it are computed, too.
    pub(super) fn samples(
        &self,
        part: &SampleBox,
        truncated: &Truncated,
        mut visit: impl FnMut(Sample),
    ) -> Result<(), BlocksError> {
        let outer = part.grown([1; 3], self.dims).aligned(self.bricks.side(), self.dims);
        let Grays { values, missing } = self.grays(&outer)?;
        let smoothed = self.smoothed(&outer, &values, truncated)?;
        // These are wrong only at the ends of the outer part, unless the ends are those of the volume.
        let differences = difference(&smoothed);
        let differences = differences.as_slice().expect("standard layout");
        let [nx, ny, _] = outer.size;
        for z in part.first[2]..part.first[2] + part.size[2] {
            for y in part.first[1]..part.first[1] + part.size[1] {
                let row = self.voxel([part.first[0], y, z]);
                let from = part.first[0] - outer.first[0];
                let from = ((z - outer.first[2]) * ny + y - outer.first[1]) * nx + from;
                for i in 0..part.size[0] {
                    let at = from + i;
                    visit(Sample {
                        voxel: row + i as u64,
                        difference: differences[at],
                        gray: values[at],
                        smoothed: smoothed.as_slice()[at],
                        missing: missing.as_ref().is_some_and(|missing| missing[at]),
                    });
                }
            }
        }
        Ok(())
    }
}

/// Passes over all tiles.
pub(super) struct Passes<'a> {
    pub team: &'a dyn Team,
    monitor: &'a Monitor,
    /// The tiles of this process.
    tiles: Vec<SampleBox>,
    done: u64,
}

impl<'a> Passes<'a> {
    /// The passes of a process of a team.
    pub(super) fn new(team: &'a dyn Team, tiles: &[SampleBox], monitor: &'a Monitor) -> Self {
        let tiles = team.own(tiles.len()).map(|tile| tiles[tile]).collect();
        Self { team, monitor, tiles, done: 0 }
    }

    /// The usual number of passes.
    const USUAL: u64 = 5;

    /// Processes each tile of this process, several at a time, and joins the results in their order.
    pub(super) fn each<T: Send>(
        &mut self,
        work: impl Fn(&SampleBox) -> Result<T, BlocksError> + Sync,
        mut join: impl FnMut(T),
    ) -> Result<(), BlocksError> {
        let all = self.tiles.len() as u64;
        let total = Self::USUAL.max(self.done + 1) * all;
        let mut tiles_done = 0;
        for batch in self.tiles.chunks(rayon::current_num_threads()) {
            let results: Result<Vec<T>, _> = batch.par_iter().map(&work).collect();
            results?.into_iter().for_each(&mut join);
            tiles_done += batch.len() as u64;
            self.monitor.report(self.done * all + tiles_done, total)?;
        }
        self.done += 1;
        Ok(())
    }

    /// Processes pieces of the volume one after the other, only in this process.
    pub(super) fn serial(
        &mut self,
        pieces: &[SampleBox],
        mut work: impl FnMut(&SampleBox) -> Result<(), BlocksError>,
    ) -> Result<(), BlocksError> {
        let all = pieces.len() as u64;
        let total = Self::USUAL.max(self.done + 1) * all;
        for (piece, done) in pieces.iter().zip(1..) {
            work(piece)?;
            self.monitor.report(self.done * all + done, total)?;
        }
        self.done += 1;
        Ok(())
    }
}
