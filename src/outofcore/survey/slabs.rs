//! The standard decomposition, whose functions reach across the volume: in a file, slab by slab.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::FEW;
use crate::export::Target;
use crate::haar::{Slabs, Truncation};
use crate::outofcore::digest::Hasher;
use crate::outofcore::digested::DigestedFile;
use crate::outofcore::field::{Field, Truncated};
use crate::outofcore::passes::Passes;
use crate::outofcore::{BlocksError, Job, Plan, SampleBox};
use crate::select::{Counts, Cut, Search};

/// Samples of a slab, about; it has at least a plane or a wall.
const SLAB: usize = 1 << 22;

/// Truncates the volume by the standard decomposition, and writes the truncated one into the folder, where all
/// processes find it. The work of the first process: coefficients are 8 bytes for each sample of a file
/// without a name, in four passes and one for each further round of the search.
pub(super) fn truncate_to_file(
    job: &Job,
    field: &Field,
    folder: &Path,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated, Vec<DigestedFile>), BlocksError> {
    let mine = if passes.team.is_first() {
        let io = |source| BlocksError::Written { path: folder.join(Plan::SMOOTHED), source };
        let file = tempfile::tempfile_in(folder).map_err(io)?;
        let mut work = Work { file, dims: field.dims, slabs: Slabs::new(field.dims), folder };
        Some(work.truncate(job, field, passes)?)
    } else {
        None
    };
    let (truncation, kept) = passes.team.broadcast(mine);
    let Some(kept) = kept else { return Ok((truncation, Truncated::Same, Vec::new())) };
    let (source, seen) = Plan::smoothed(folder, job.dims)?;
    Ok((truncation, Truncated::File(source, seen), vec![kept]))
}

/// The coefficients of a volume in a file, in double precision.
struct Work<'a> {
    file: File,
    /// Samples along x, y and z.
    dims: [usize; 3],
    slabs: Slabs,
    /// Of the plan.
    folder: &'a Path,
}

impl Work<'_> {
    fn truncate(
        &mut self,
        job: &Job,
        field: &Field,
        passes: &mut Passes<'_>,
    ) -> Result<(Truncation, Option<DigestedFile>), BlocksError> {
        let (tolerance, total) = (job.recipe.haar.tolerance, job.dims.samples() as u64);
        tolerance.check()?;
        let [planes, walls] = [self.cut(2), self.cut(1)];
        passes.serial(&planes, |planes| {
            let grays = field.grays(planes)?.values;
            let mut values: Vec<f64> = grays.into_iter().map(f64::from).collect();
            self.slabs.forward_planes(&mut values);
            self.write(planes, &values)
        })?;
        let mut search = Search::new(tolerance.budget(total), FEW);
        let mut counts = Counts::default();
        passes.serial(&walls, |walls| {
            let mut values = self.read(walls)?;
            self.slabs.forward_walls(&mut values, walls.first[1]);
            counts.join(search.count(self.indexed(walls, &values)));
            self.write(walls, &values)
        })?;
        search.learn(counts);
        let (cut, dropped) = search.find(|search| {
            let mut counts = Counts::default();
            passes.serial(&planes, |planes| {
                counts.join(search.count(self.indexed(planes, &self.read(planes)?)));
                Ok(())
            })?;
            Ok::<_, BlocksError>(counts)
        })?;
        let truncation = Truncation::new(tolerance, total, dropped);
        let smooth = || self.smooth(cut, [&planes, &walls], passes);
        let kept = (truncation.epsilon > 0.0).then(smooth).transpose()?;
        Ok((truncation, kept))
    }

    /// Drops coefficients, and writes the samples of what stays.
    fn smooth(
        &mut self,
        cut: Cut,
        [planes, walls]: [&[SampleBox]; 2],
        passes: &mut Passes<'_>,
    ) -> Result<DigestedFile, BlocksError> {
        passes.serial(walls, |walls| {
            let mut values = self.read(walls)?;
            let kept: Vec<f64> = self
                .indexed(walls, &values)
                .map(|(value, voxel)| if cut.keeps(value, voxel) { value } else { 0.0 })
                .collect();
            values.copy_from_slice(&kept);
            self.slabs.inverse_walls(&mut values, walls.first[1]);
            self.write(walls, &values)
        })?;
        let target = Target::open(&self.folder.join(Plan::SMOOTHED))?;
        let (mut failed, mut hasher, mut length) = (None, Hasher::default(), 0);
        let written = target.write(|out| {
            let done = passes.serial(planes, |planes| {
                let mut values = self.read(planes)?;
                self.slabs.inverse_planes(&mut values);
                let bytes = values.iter().flat_map(|&value| (value as f32).to_le_bytes());
                let bytes: Vec<u8> = bytes.collect();
                hasher.update(&bytes);
                length += bytes.len() as u64;
                out.write_all(&bytes).map_err(|error| self.failed(error))
            });
            done.map_err(|error| {
                failed = Some(error);
                io::Error::other("the slabs before it")
            })
        });
        if let Some(error) = failed {
            return Err(error);
        }
        written?;
        Ok(DigestedFile { name: Plan::SMOOTHED.into(), bytes: length, digest: hasher.digest() })
    }

    /// Whole planes (axis 2) or whole walls (axis 1), of about [`SLAB`] samples each.
    fn cut(&self, axis: usize) -> Vec<SampleBox> {
        let mut size = self.dims;
        size[axis] = (SLAB * self.dims[axis] / self.dims.iter().product::<usize>()).max(1);
        size[axis] = size[axis].min(self.dims[axis]);
        SampleBox::whole(self.dims).tiles(size)
    }

    /// Coefficients of a part with their indices in the volume.
    fn indexed<'v>(
        &self,
        part: &SampleBox,
        values: &'v [f64],
    ) -> impl Iterator<Item = (f64, u64)> + use<'v> {
        let ([nx, ny, _], part) = (self.dims, *part);
        let rows = part.size[1];
        values.chunks(nx).enumerate().flat_map(move |(row, values)| {
            let (y, z) = (part.first[1] + row % rows, part.first[2] + row / rows);
            let first = ((z * ny + y) * nx) as u64;
            values.iter().copied().zip(first..)
        })
    }

    /// Reads a part that has all samples along x.
    fn read(&self, part: &SampleBox) -> Result<Vec<f64>, BlocksError> {
        let mut bytes = vec![0; 8 * part.samples()];
        self.each_run(part, |mut file, run| file.read_exact(&mut bytes[run]))?;
        let (numbers, _) = bytes.as_chunks::<8>();
        Ok(numbers.iter().map(|&number| f64::from_le_bytes(number)).collect())
    }

    fn write(&self, part: &SampleBox, values: &[f64]) -> Result<(), BlocksError> {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.each_run(part, |mut file, run| file.write_all(&bytes[run]))
    }

    /// Visits the bytes of a part that follow each other in the file, which is at them then.
    fn each_run(
        &self,
        part: &SampleBox,
        mut work: impl FnMut(&File, std::ops::Range<usize>) -> io::Result<()>,
    ) -> Result<(), BlocksError> {
        let [nx, ny, _] = self.dims;
        let run = 8 * nx * part.size[1];
        for k in 0..part.size[2] {
            let start = 8 * nx * ((part.first[2] + k) * ny + part.first[1]);
            (&self.file)
                .seek(SeekFrom::Start(start as u64))
                .and_then(|_| work(&self.file, k * run..(k + 1) * run))
                .map_err(|error| self.failed(error))?;
        }
        Ok(())
    }

    fn failed(&self, source: io::Error) -> BlocksError {
        BlocksError::Written { path: self.folder.join(Plan::SMOOTHED), source }
    }
}
