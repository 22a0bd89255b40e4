//! The standard decomposition, whose functions extend across the volume: computed in a file, slab by slab.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::brick_digests::ReadDigests;
use super::bytes::{self, Digest, Hasher, digest_of};
use super::field::{Field, Passes, Truncated};
use super::{BlocksError, Job, SampleBox};
use crate::export::Target;
use walpha_points::haar::{Decomposition, Truncation};
use walpha_points::internal::Slabs;
use walpha_points::internal::{Counts, Cut, Search};
use walpha_volume::{Dims, Dtype, RawLayout, ReadOptions, Source};

/// The name of the file with the sums of bricks.
pub(super) const SUMS: &str = "sums.f64";
/// The name of the file with the truncated volume of the standard decomposition.
pub(super) const SMOOTHED: &str = "truncated.f32";

/// A file whose digest is in the plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct DigestedFile {
    pub name: String,
    pub bytes: u64,
    pub digest: Digest,
}

impl DigestedFile {
    /// Writes the sums of bricks into a folder.
    pub(super) fn write_sums(sums: &[f64], folder: &Path) -> Result<Self, BlocksError> {
        let bytes: Vec<u8> = sums.iter().flat_map(|sum| sum.to_le_bytes()).collect();
        Target::replacing(folder.join(SUMS))?.write(|out| out.write_all(&bytes))?;
        let digest = Digest::of(&bytes);
        Ok(Self { name: SUMS.into(), bytes: bytes.len() as u64, digest })
    }

    /// Reads the file and verifies it.
    ///
    /// # Errors
    /// The file does not verify, or does not exist.
    pub(super) fn verify(&self, folder: &Path) -> Result<(), BlocksError> {
        let path = folder.join(&self.name);
        let found = match bytes::open(&path) {
            Err(BlocksError::Io { source, .. }) => Err(source),
            opened => digest_of(opened?),
        };
        match found {
            Ok((bytes, digest)) if bytes == self.bytes && self.digest.is(digest) => Ok(()),
            Ok(_) => Err(BlocksError::Damaged { path, what: Self::DAMAGED.into() }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(BlocksError::Damaged { path, what: "is not there".into() })
            }
            Err(source) => Err(BlocksError::Io { path, source }),
        }
    }

    pub(super) const DAMAGED: &str = "is damaged, cut off, or of another plan";
}

/// Opens the truncated volume that a plan of the standard decomposition left in its folder, with empty digests.
pub(super) fn smoothed(folder: &Path, dims: Dims) -> Result<(Source, ReadDigests), BlocksError> {
    let path = folder.join(SMOOTHED);
    bytes::open(&path)?;
    let options = ReadOptions::default().raw(RawLayout::new(dims, Dtype::F32));
    let source = Source::open(&path, &options)?;
    let dims = dims.xyz();
    Ok((source, ReadDigests::none_of(&SampleBox::whole(dims), Field::bricks_of(dims).side(), dims)))
}

/// The number of values left in the search for a cut below which they are listed: 64 MB.
pub(super) const FEW: u64 = 1 << 22;

/// Truncates the volume of a job whose gray levels are known, and returns the file that the plan keeps, if any.
pub(super) fn truncated(
    job: &Job,
    field: &Field,
    folder: &Path,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated, Vec<DigestedFile>), BlocksError> {
    match job.recipe.haar.decomposition {
        Decomposition::NonStandard => {
            let (truncation, truncated) = truncate(job, field, passes)?;
            Ok((truncation, truncated, Vec::new()))
        }
        Decomposition::Standard => truncate_to_file(job, field, folder, passes),
    }
}

/// Finds the cut of the non-standard decomposition, and the sums of bricks of the truncated volume.
pub(super) fn truncate(
    job: &Job,
    field: &Field,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated), BlocksError> {
    let total = job.dims.samples() as u64;
    let tolerance = job.recipe.haar.tolerance;
    tolerance.check()?;
    let search = Search::new(tolerance.budget(total), FEW);
    let mut sums = vec![0.0; field.bricks.count().iter().product()];
    let mut is_first = true;
    let (cut, dropped) = search.find(|search| {
        let mut counts = Counts::default();
        passes.each(
            |tile| {
                let values = field.coefficients(tile, &field.grays(tile)?.values);
                let (mut details, mut firsts) = (Vec::new(), Vec::new());
                details.reserve_exact(values.len());
                field.places(tile, |place, voxel, brick| match brick {
                    Some(brick) => firsts.push((brick, values[place])),
                    None => details.push((values[place], voxel)),
                });
                Ok((search.count(details.into_iter()), firsts))
            },
            |(more, firsts)| {
                counts.join(more);
                if is_first {
                    firsts.into_iter().for_each(|(brick, sum)| sums[brick] = sum);
                }
            },
        )?;
        counts = passes.team.reduce(counts, Counts::join);
        if is_first {
            let mine = std::mem::take(&mut sums);
            sums = passes.team.reduce(mine, |sums, others| either(sums, others));
            field.bricks.coarse(&mut sums);
            is_first = false;
        }
        counts.join(search.count(coarse(field, &sums)));
        Ok::<_, BlocksError>(counts)
    })?;
    let truncation = Truncation::new(tolerance, total, dropped);
    if truncation.epsilon == 0.0 {
        return Ok((truncation, Truncated::Same));
    }
    let kept: Vec<f64> =
        coarse(field, &sums).map(|(v, i)| if cut.keeps(v, i) { v } else { 0.0 }).collect();
    let mut sums = kept;
    field.bricks.inverse_coarse(&mut sums);
    Ok((truncation, Truncated::Bricks { cut, sums }))
}

/// Takes the sums of bricks of another process. Unknown ones are positive zeros.
fn either(sums: &mut [f64], others: Vec<f64>) {
    let known = sums.iter_mut().zip(others).filter(|(_, other)| other.to_bits() != 0);
    known.for_each(|(sum, other)| *sum = other);
}

/// The coefficients of levels above bricks, with their indices in the volume.
fn coarse<'a>(field: &'a Field, sums: &'a [f64]) -> impl Iterator<Item = (f64, u64)> + 'a {
    let ([cx, cy, _], side) = (field.bricks.count(), field.bricks.side());
    sums.iter().enumerate().map(move |(brick, &value)| {
        let at = [brick % cx, brick / cx % cy, brick / (cx * cy)].map(|i| i * side);
        (value, field.voxel(at))
    })
}

/// The approximate number of samples of a slab, which has at least a plane or a wall.
const SLAB: usize = 1 << 22;

/// Truncates the volume by the standard decomposition, and writes the truncated volume into the folder, where all processes find
/// it. The first process does this: coefficients take 8 bytes for each sample in an unnamed file, in four passes and one for each
/// further round of the search.
pub(super) fn truncate_to_file(
    job: &Job,
    field: &Field,
    folder: &Path,
    passes: &mut Passes<'_>,
) -> Result<(Truncation, Truncated, Vec<DigestedFile>), BlocksError> {
    let mine = if passes.team.is_first() {
        let io = |source| BlocksError::Written { path: folder.join(SMOOTHED), source };
        let file = tempfile::tempfile_in(folder).map_err(io)?;
        let mut work =
            StandardTransform { file, dims: field.dims, slabs: Slabs::new(field.dims), folder };
        Some(work.truncate(job, field, passes)?)
    } else {
        None
    };
    let (truncation, kept) = passes.team.broadcast(mine);
    let Some(kept) = kept else { return Ok((truncation, Truncated::Same, Vec::new())) };
    let (source, digests) = smoothed(folder, job.dims)?;
    Ok((truncation, Truncated::File(source, digests), vec![kept]))
}

/// The coefficients of a volume in a file, in double precision.
struct StandardTransform<'a> {
    file: File,
    /// The number of samples along x, y and z.
    dims: [usize; 3],
    slabs: Slabs,
    /// The folder of the plan.
    folder: &'a Path,
}

impl StandardTransform<'_> {
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

    /// Drops coefficients, and writes the samples computed from the remaining ones.
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
        let target = Target::replacing(self.folder.join(SMOOTHED))?;
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
        Ok(DigestedFile { name: SMOOTHED.into(), bytes: length, digest: hasher.digest() })
    }

    /// Cuts the volume into whole planes (axis 2) or whole walls (axis 1), of about [`SLAB`] samples each.
    fn cut(&self, axis: usize) -> Vec<SampleBox> {
        let mut size = self.dims;
        size[axis] = (SLAB * self.dims[axis] / self.dims.iter().product::<usize>()).max(1);
        size[axis] = size[axis].min(self.dims[axis]);
        SampleBox::whole(self.dims).tiles(size)
    }

    /// The coefficients of a part with their indices in the volume.
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

    /// Reads a part that contains all samples along x.
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

    /// Visits the byte ranges of a part that are contiguous in the file, which is positioned at each.
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
        BlocksError::Written { path: self.folder.join(SMOOTHED), source }
    }
}
