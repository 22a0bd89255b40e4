use std::path::Path;

use super::{PipelineError, Recipe};
use walpha_points::read_model_file;
use walpha_points::{ModelMetadata, Points, PointsError, Units, hard};
use walpha_volume::{GrayRange, OpenFile, OpenVolume, Volume};

/// The content of an input.
#[derive(Debug)]
pub enum Input {
    /// A grid of gray levels.
    Volume(GrayVolume),
    /// A segmentation, whose labels the recipe [asks for](Recipe::labels).
    Labels(Volume),
    /// A volume inside whose isosurface the recipe [asks for](Recipe::surface) the solid.
    Surface(Volume),
    /// Points, perhaps with weights and values, and the metadata of their file.
    Points(Points, ModelMetadata),
}

/// An input whose kind is known, and whose content has not been read. A file is open: whatever is asked of it comes from
/// this open file.
pub enum Opened {
    /// A set of points that is made by its name.
    Made(Points),
    /// A file of points.
    Points(OpenFile),
    /// A volume.
    Volume(OpenVolume),
}

/// A volume in gray levels, and the values that they stand for.
#[derive(Debug)]
#[non_exhaustive]
pub struct GrayVolume {
    /// Gray levels.
    pub volume: Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The mapping to written values, or the identity.
    pub written: GrayRange,
}

/// A volume in gray levels, in the coordinates of its points.
#[derive(Debug)]
#[non_exhaustive]
pub struct PlacedVolume {
    /// Gray levels.
    pub volume: Volume,
    /// Units of the coordinates.
    pub units: Units,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// The mapping to written values, or the identity.
    pub written: GrayRange,
}

/// Which values the points get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Gray levels, if the points come from a volume.
    Gray,
    /// The values to write: those of the input, unless the recipe asks for gray levels.
    Written,
}

impl Recipe {
    /// Reads a file or a sample.
    ///
    /// # Errors
    /// [`PipelineError::Points`] if the input cannot be read.
    pub fn open(&self, input: &Path) -> Result<Input, PipelineError> {
        self.clone().open_suited(input, |_, _| None)
    }

    /// Reads a file or a sample. For a volume `suited` may change the recipe, before its values become gray levels.
    ///
    /// # Errors
    /// [`PipelineError::Points`] if the input cannot be read.
    pub fn open_suited(
        &mut self,
        input: &Path,
        suited: impl FnOnce(&Self, &Volume) -> Option<Self>,
    ) -> Result<Input, PipelineError> {
        let opened = self.opened(input)?;
        self.read_suited(opened, suited)
    }

    /// Opens a file, or finds a sample or a set of points by its name.
    ///
    /// # Errors
    /// [`PipelineError::Points`] if there is none, or it cannot be opened.
    pub fn opened(&self, input: &Path) -> Result<Opened, PipelineError> {
        if let Some(points) = hard(input)? {
            return Ok(Opened::Made(points));
        }
        Ok(match OpenVolume::open(input).map_err(PointsError::from)? {
            OpenVolume::File(file)
                if self.read.raw.is_none() && self.of_points().holds_points(&file)? =>
            {
                Opened::Points(file)
            }
            volume => Opened::Volume(volume),
        })
    }

    /// [`open_suited`](Self::open_suited) for an input that is open.
    ///
    /// # Errors
    /// Those of [`open_suited`](Self::open_suited).
    pub fn read_suited(
        &mut self,
        opened: Opened,
        suited: impl FnOnce(&Self, &Volume) -> Option<Self>,
    ) -> Result<Input, PipelineError> {
        let volume = match opened {
            Opened::Made(points) => return Ok(Input::Points(points, ModelMetadata::default())),
            Opened::Points(file) => {
                let (points, metadata) = self.read_points(&file)?;
                return Ok(Input::Points(points, metadata));
            }
            Opened::Volume(volume) => volume.read(&self.read).map_err(PointsError::from)?,
        };
        if let Some(suited) = suited(self, &volume) {
            *self = suited;
        }
        if self.labels.is_some() {
            return Ok(Input::Labels(volume));
        }
        if self.surface.is_some() {
            return Ok(Input::Surface(volume));
        }
        Ok(Input::Volume(self.grays(volume)?))
    }

    /// Reads points, with their values as they are to be written.
    fn read_points(&self, file: &OpenFile) -> Result<(Points, ModelMetadata), PipelineError> {
        let (mut points, mut metadata) = read_model_file(file, &self.of_points())?;
        if let Some(range) = &mut metadata.range {
            let written = self.written(*range);
            if written != *range {
                to_gray(&mut points, range);
                *range = written;
            }
        }
        Ok((points, metadata))
    }

    /// Maps a volume to gray levels. One that has gray levels is left unchanged, unless the recipe has a range.
    ///
    /// # Errors
    /// A range that is empty, or too narrow for a sample.
    pub fn grays(&self, volume: Volume) -> Result<GrayVolume, PipelineError> {
        let (volume, range) = volume.into_gray(self.gray_levels()).map_err(PointsError::from)?;
        Ok(GrayVolume { volume, range, written: self.written(range) })
    }

    /// The volume in the coordinates that its points will have.
    ///
    /// # Errors
    /// The errors of [`Recipe::place`].
    pub fn source(&self, grays: GrayVolume) -> Result<PlacedVolume, PipelineError> {
        let GrayVolume { volume, range, written } = grays;
        let (frame, units) = self.place(*volume.frame())?;
        Ok(PlacedVolume { volume: volume.with_frame(frame), units, range, written })
    }
}

/// Maps the values of points to gray levels, in single precision as in a volume.
pub(super) fn to_gray(points: &mut Points, range: &GrayRange) {
    let gray = |value: &mut f64| *value = f64::from(range.gray(*value) as f32);
    points.values.iter_mut().flatten().for_each(gray);
}
