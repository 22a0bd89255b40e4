use walpha_shape::ladder::{Ladder, Levels};
use walpha_volume::{Coordinates, Frame, Volume};

/// The content of a page.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// Its heading.
    pub title: &'a str,
    /// Further facts, as pairs of a name and a value.
    pub facts: &'a [(String, String)],
    /// The unit of coordinates, and the directions of their axes.
    pub coordinates: Coordinates,
    /// The meaning of F with its unit, such as "value of the original volume, in gray levels".
    pub value: &'a str,
    /// The unit of differences to the original, such as "gray levels".
    pub difference: &'a str,
    /// Levels of detail, the coarsest first. The page opens with the last.
    pub details: &'a [Detail<'a>],
    /// The volume that the points are from, for comparison.
    pub original: Option<Original<'a>>,
}

/// The shapes of one set of points.
#[derive(Clone, Copy)]
pub struct Detail<'a> {
    /// The shapes.
    pub levels: &'a Levels<'a>,
    /// The numbers of the levels.
    pub ladder: &'a Ladder,
    /// The level shown first.
    pub first: usize,
    /// The differences of F from the original, if they are known.
    pub differences: Option<&'a Differences>,
    /// The elements of the points, if they are atoms: by atomic number, and 0 where it is not known.
    pub atoms: Option<&'a Kinds>,
    /// The classes of the points, if they are those of a laser scan.
    pub classes: Option<&'a Kinds>,
    /// The colours of the points, if they have their own, as red, green and blue.
    pub colours: Option<&'a [[u8; 3]]>,
    /// The index of each point in the input, if only some of them are shown.
    pub indices: Option<&'a [u32]>,
}

impl<'a> Detail<'a> {
    /// Shapes with their numbers, and the level shown first; what may be known besides is not.
    pub fn new(levels: &'a Levels<'a>, ladder: &'a Ladder, first: usize) -> Self {
        Self {
            levels,
            ladder,
            first,
            differences: None,
            atoms: None,
            classes: None,
            colours: None,
            indices: None,
        }
    }
}

/// Points of several kinds.
#[derive(Clone, Debug)]
pub struct Kinds {
    /// The number of the kind of each.
    pub numbers: Vec<u8>,
    /// Each kind that has a name: its number, its name, and its colour as red, green and blue.
    pub known: Vec<(u8, &'static str, [u8; 3])>,
}

/// Differences of an interpolant from a volume.
#[derive(Clone, Debug)]
pub struct Differences {
    /// Root mean squares around each point.
    pub local: Vec<f64>,
    /// The root mean square over all samples.
    pub rmse: f64,
}

/// A volume that is shown by its isosurface, downsampled if it is large.
#[derive(Clone, Copy)]
pub struct Original<'a> {
    /// The samples.
    pub volume: &'a Volume,
    /// The value of the isosurface.
    pub isovalue: f64,
    /// The frame of the samples in the coordinates of the points: that of the volume, or [`Frame::VOXEL`].
    pub frame: &'a Frame,
}
