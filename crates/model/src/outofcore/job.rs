//! Jobs, and the sizes and times of their input files, which show changes without reading them.

use std::fs::{self, Metadata};
use std::path::Path;
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};

use super::BlocksError;
use crate::Recipe;
use crate::pipeline::{Choice, Parameter};
use walpha_points::{Selection, Units, Weighting};
use walpha_shape::Alpha;
use walpha_volume::{Dims, Frame, GrayRange, Source, any_size, files_of};

/// An input, and the recipe for its shape. It is part of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Job {
    /// The name of a sample or file.
    pub input: String,
    /// The options of all stages.
    pub recipe: Recipe,
    /// The number of samples along x, y and z.
    #[serde(deserialize_with = "any_size")]
    pub dims: Dims,
    /// The place of the grid, in the space of its points.
    pub frame: Frame,
    /// The units of coordinates.
    pub units: Units,
}

impl Job {
    /// Creates a job from an input, which is opened, and a recipe.
    ///
    /// # Errors
    /// The input cannot be read in parts, or an option is not local ([`Job::check`]).
    pub fn new(input: &str, recipe: Recipe) -> Result<Self, BlocksError> {
        let source = Source::open(input, &recipe.read)?;
        Self::of_source(input, recipe, &source)
    }

    /// Like [`new`](Self::new), for a volume that is already open.
    ///
    /// # Errors
    /// An option is not local ([`Job::check`]).
    pub fn of_source(input: &str, recipe: Recipe, source: &Source) -> Result<Self, BlocksError> {
        let (frame, units) = recipe.place(*source.frame())?;
        let job = Self { input: input.to_owned(), recipe, dims: source.dims(), frame, units };
        job.check()?;
        Ok(job)
    }

    /// Checks that the job can be done in blocks.
    ///
    /// # Errors
    /// [`BlocksError::NotLocal`].
    pub fn check(&self) -> Result<(), BlocksError> {
        let not_local = |what: &str, next: &'static str| Err(BlocksError::not_local(what, next));
        let Recipe { choice, refit, exterior, hidden, periodic, engine, .. } = &self.recipe;
        match self.rule()? {
            None => return not_local("--alpha auto", "give α as a number"),
            Some(Parameter { alpha, .. }) if alpha == Alpha::INFINITE => {
                return not_local("α = inf, the convex hull,", "give a finite α");
            }
            Some(_) => {}
        }
        if !matches!(choice, Choice::Difference(_)) {
            return not_local("--select adaptive, which looks at all points at once,", "omit it");
        }
        if *exterior || *hidden {
            return not_local("the whole triangulation", "omit --exterior and --hidden");
        }
        if refit.is_some() {
            return not_local("--refit", "omit it");
        }
        if periodic.is_some() {
            return not_local("--periodic", "omit it");
        }
        if engine.asks_cgal() {
            return not_local("the engine cgal", "use the engine native");
        }
        if self.recipe.weighting == Some(Weighting::Column) {
            return Err(walpha_points::PointsError::NoColumn.into());
        }
        if self.units == Units::World && inverse(self.frame.axes()).is_none() {
            return not_local("a grid whose axes lie in one plane", "correct its directions");
        }
        Ok(())
    }

    /// The α that is given or is the default; `None` if it must be found, which takes all points at once.
    fn rule(&self) -> Result<Option<Parameter>, BlocksError> {
        Ok(self.recipe.alpha.of_frame(&self.frame, self.units)?)
    }

    /// The parameter α with its origin.
    ///
    /// # Panics
    /// α is not known; [`Job::check`] refuses such jobs.
    pub fn parameter(&self) -> Parameter {
        self.rule().ok().flatten().expect("a job that was checked has an α")
    }

    /// The value of α.
    pub(super) fn alpha(&self) -> Alpha {
        self.parameter().alpha
    }

    /// The source of weights.
    pub fn weighting(&self) -> Weighting {
        self.recipe.weighting.unwrap_or(Weighting::Common(0.0))
    }

    /// The selection of the samples that become points; `range` became gray 0 and 255.
    ///
    /// # Panics
    /// Samples are chosen adaptively; [`Job::check`] refuses such jobs.
    pub(super) fn selection(&self, range: &GrayRange) -> Selection {
        self.recipe.selection(range).expect("a job that was checked selects by differences")
    }

    /// The number of samples along x, y and z that balls of this radius reach.
    pub(super) fn reach(&self, radius: f64) -> [usize; 3] {
        let samples = |step: f64| (radius * step).ceil().max(0.0) as usize;
        match self.units {
            Units::Voxel => [samples(1.0); 3],
            Units::World => {
                let inverse = inverse(self.frame.axes()).unwrap_or([[f64::INFINITY; 3]; 3]);
                inverse.map(|row| samples(row.iter().map(|v| v * v).sum::<f64>().sqrt()))
            }
        }
    }
}

/// The rows of the inverse of the matrix with these columns, if it exists.
fn inverse([a, b, c]: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    use walpha_base::vector::{cross, dot};
    let volume = dot(a, cross(b, c));
    let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|v| v / volume));
    rows.as_flattened().iter().all(|v| v.is_finite()).then_some(rows)
}

/// The number and size of an input's files, and the time of the latest change. This is only a hint: a file may be touched without
/// being changed. Samples that were read are verified by their digests ([`ReadDigests`](super::brick_digests::ReadDigests)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Stamp {
    files: u64,
    bytes: u64,
    /// The time in nanoseconds since 1970.
    newest: u64,
}

impl Stamp {
    /// The current stamp of the input of a job; empty for a sample. Examines each file of a folder.
    pub(super) fn of(job: &Job) -> Self {
        let mut stamp = Self::default();
        if !job.input.starts_with("sample:") {
            let files = files_of(Path::new(&job.input)).into_iter();
            // A missing file is reported when it is read.
            files.filter_map(|path| fs::metadata(path).ok()).for_each(|file| stamp.add(&file));
        }
        stamp
    }

    fn add(&mut self, file: &Metadata) {
        self.files += 1;
        self.bytes = self.bytes.wrapping_add(file.len());
        let written = file.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok());
        self.newest = self.newest.max(written.map_or(0, |at| at.as_nanos() as u64));
    }
}
