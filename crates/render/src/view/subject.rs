use walpha_shape::ladder::{Ladder, Levels};
use walpha_volume::{Frame, Volume};

/// What a page shows.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// Its heading.
    pub title: &'a str,
    /// Further facts, as pairs of a name and a value.
    pub facts: &'a [(String, String)],
    /// What coordinates are measured in, as "voxels".
    pub unit: &'a str,
    /// What F is, with its unit, as "value of the original volume, in gray levels".
    pub value: &'a str,
    /// The unit of differences to the original, as "gray levels".
    pub difference: &'a str,
    /// Levels of detail, the coarsest first. The page opens with the last.
    pub details: &'a [Detail<'a>],
    /// What the points come from, to compare.
    pub original: Option<Original<'a>>,
}

/// The shapes of one set of points.
#[derive(Clone, Copy)]
pub struct Detail<'a> {
    /// The shapes.
    pub levels: &'a Levels<'a>,
    /// Their numbers.
    pub ladder: &'a Ladder,
    /// The level shown first.
    pub first: usize,
    /// How far F is from the original, where that is known.
    pub differences: Option<&'a Differences>,
}

/// Differences of an interpolant from a volume.
#[derive(Clone, Debug)]
pub struct Differences {
    /// Root mean squares around each point.
    pub local: Vec<f64>,
    /// The root mean square over all samples.
    pub rmse: f64,
}

impl Subject<'_> {
    /// Whether points have values. All levels of detail are alike in this.
    pub(super) fn is_valued(&self) -> bool {
        self.details.iter().all(|detail| detail.levels.points().values.is_some())
    }

    /// Whether points have differences to the original at every level of detail.
    pub(super) fn is_compared(&self) -> bool {
        self.details.iter().all(|detail| detail.differences.is_some())
    }
}

/// A volume that is shown by its isosurface, from every so many samples if it is large.
#[derive(Clone, Copy)]
pub struct Original<'a> {
    /// The samples.
    pub volume: &'a Volume,
    /// Where the surface is.
    pub isovalue: f64,
    /// Where samples lie in the coordinates of the points: that of the volume, or [`Frame::VOXEL`].
    pub frame: &'a Frame,
}
