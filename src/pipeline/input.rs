use std::path::Path;

use walpha_base::Monitor;

use super::{PipelineError, Recipe};
use crate::points::{ModelMetadata, Points, PointsError, Units, read_model_file};
use crate::volume::{self, GrayRange, OpenFile, Volume};

/// The content of an input.
#[derive(Debug)]
#[non_exhaustive]
pub enum Input {
    /// A grid of gray levels.
    Volume(Grays),
    /// Points, perhaps with weights and values, and what else their file states.
    Points(Points, ModelMetadata),
}

/// A volume in gray levels, and what they stand for.
#[derive(Debug)]
#[non_exhaustive]
pub struct Grays {
    /// Gray levels.
    pub volume: Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The mapping to written values, or the identity.
    pub written: GrayRange,
}

/// A volume in gray levels, in the space that its points are in.
#[derive(Debug)]
#[non_exhaustive]
pub struct Source {
    /// Gray levels.
    pub volume: Volume,
    /// What coordinates are measured in.
    pub units: Units,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The mapping to written values, or the identity.
    pub written: GrayRange,
}

/// Which values points get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Gray levels, where they come from a volume.
    Gray,
    /// Those that are written: of the input, unless the recipe asks for gray levels.
    Written,
}

impl Recipe {
    /// Whether this file or sample holds points rather than a volume.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn is_points(&self, input: &Path) -> Result<bool, PipelineError> {
        let is_volume = is_sample(input) || self.read.raw.is_some();
        Ok(!is_volume && self.of_points().is_point_file(input)?)
    }

    /// Reads a file or a sample.
    ///
    /// # Errors
    /// [`PipelineError::Points`]: what cannot be read, and why.
    pub fn open(&self, input: &Path, monitor: &Monitor) -> Result<Input, PipelineError> {
        if is_sample(input) || input.is_dir() {
            let volume = volume::open_monitored(input, &self.read, monitor);
            return Ok(Input::Volume(self.grays(volume.map_err(PointsError::from)?)?));
        }
        // From here on the file is open, and nothing opens it again.
        let file = OpenFile::open(input).map_err(PointsError::from)?;
        if self.read.raw.is_none() && self.of_points().holds_points(&file)? {
            let (mut points, mut facts) = read_model_file(&file, &self.of_points())?;
            if let Some(range) = &mut facts.range {
                let written = self.written(*range);
                if written != *range {
                    to_gray(&mut points, range);
                    *range = written;
                }
            }
            return Ok(Input::Points(points, facts));
        }
        let volume = volume::read_file(&file, &self.read, monitor).map_err(PointsError::from)?;
        Ok(Input::Volume(self.grays(volume)?))
    }

    /// A volume in gray levels. One that has gray levels stays as it is, unless the recipe has a range.
    ///
    /// # Errors
    /// A range that is empty, or too narrow for a sample.
    pub fn grays(&self, volume: Volume) -> Result<Grays, PipelineError> {
        let (volume, range) = volume.into_gray(self.gray_levels()).map_err(PointsError::from)?;
        Ok(Grays { volume, range, written: self.written(range) })
    }

    /// The volume in the space that its points are going to be in.
    ///
    /// # Errors
    /// The errors of [`Recipe::place`].
    pub fn source(&self, grays: Grays) -> Result<Source, PipelineError> {
        let Grays { volume, range, written } = grays;
        let (frame, units) = self.place(*volume.frame())?;
        Ok(Source { volume: volume.with_frame(frame), units, range, written })
    }
}

fn is_sample(input: &Path) -> bool {
    input.to_str().is_some_and(|name| name.starts_with("sample:"))
}

/// Gives points gray levels for values. As in a volume, they are of single precision.
pub(super) fn to_gray(points: &mut Points, range: &GrayRange) {
    let gray = |value: &mut f64| *value = f64::from(range.gray(*value) as f32);
    points.values.iter_mut().flatten().for_each(gray);
}
