use walpha_base::advice::{Advice, Advise, Setting, advice, wrapped};
use walpha_base::monitor::wraps;
use walpha_base::shown::{number, rounded};
use walpha_base::{Cancelled, LengthUnit};

use crate::interpolate::InterpolateError;
use crate::labels::LabelsError;
use walpha_points::PointsError;
use walpha_points::haar::HaarError;
use walpha_shape::{AlphaError, ShapeError, TorusError};

/// An error of a pipeline: of one of its stages, or of contradicting options.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// An error of the wavelet stage.
    #[error(transparent)]
    Haar(HaarError),
    /// An error in reading or selecting points, or in their weights.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// An error in adaptive selection or fitting.
    #[error(transparent)]
    Interpolate(InterpolateError),
    /// An error in making the solid of labels.
    #[error(transparent)]
    Labels(LabelsError),
    /// The volume contains labels, but points were to be selected by gray levels.
    #[error(
        "the volume holds labels, and their solid comes from voxels, without α, differences or weights"
    )]
    OfLabels,
    /// The solid inside an isosurface, where points are to be selected.
    #[error(
        "the solid inside an isosurface is not made of selected points, and has neither α nor weights"
    )]
    OfSurface,
    /// All samples are equal, and a value that divides them was to be found.
    #[error("all samples are {value}, so no value divides them")]
    Constant {
        /// The value of all samples.
        value: f32,
    },
    /// An error in computing the shape.
    #[error(transparent)]
    Shape(ShapeError),
    /// A voxel is so large that 10 h² is not finite.
    #[error(transparent)]
    Alpha(#[from] AlphaError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// With [`Balls::Radius`](walpha_shape::Balls) α is a radius, but the α that was found is a squared radius.
    #[error(
        "with balls of radius α + ω, α is a radius, but the α that was found is a squared radius"
    )]
    Radii {
        /// The radius of the α that was found.
        radius: f64,
    },
    /// A space was given for coordinates in voxels.
    #[error("a space is for world coordinates, and these are voxels")]
    SpaceOfVoxels,
    /// A space was given for a volume that does not state its orientation.
    #[error(
        "the input does not state the orientation of its axes in a patient, so no space can be chosen"
    )]
    UnknownSpace,
    /// No component of the shape has the volume of those to keep.
    #[error(
        "no component of the shape has a volume of {} {symbol}³: the largest has {} {symbol}³",
        number(*.least),
        rounded(*.largest),
        symbol = .unit.symbol()
    )]
    NoComponent {
        /// The least volume, in cubes of the unit.
        least: f64,
        /// That of the largest component.
        largest: f64,
        /// The unit of lengths.
        unit: LengthUnit,
    },
    /// Weights were to be computed from differences to neighbours, for scattered points on a torus.
    #[error(
        "these weights come from differences to neighbours, and neighbours across the sides of a periodic box are not considered"
    )]
    PeriodicWeights,
    /// The periodic box was to be the cell that the input states, and it states none.
    #[error(
        "the input does not state a cell in which its points repeat (of PDB and mmCIF, a cell with symmetries is not one)"
    )]
    NoCell,
    /// The cell that the input states cannot be periodic.
    #[error(transparent)]
    Torus(#[from] TorusError),
}

wraps! {
    PipelineError: Haar(HaarError),
    Interpolate(InterpolateError),
    Labels(LabelsError),
    Shape(ShapeError)
}

impl Advise for PipelineError {
    wrapped!(Haar, Points, Interpolate, Labels, Shape, Alpha, Cancelled, Torus);

    fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::OfLabels => advice![
                "take their solid by `walpha shape`, or say what to look for in gray levels, as by ",
                Setting::Threshold
            ],
            Self::OfSurface => advice![
                "make it by `walpha shape`, or select points by gray levels, as by ",
                Setting::Threshold,
                " 12 and ",
                Setting::GrayMin,
                " 24"
            ],
            Self::Constant { .. } => "give a value, or name another file".into(),
            Self::SpaceOfVoxels | Self::UnknownSpace => advice!["omit ", Setting::Space],
            Self::NoComponent { largest: 0.0, .. } => {
                advice![
                    "omit ",
                    Setting::MinVolume,
                    ", as no component has a volume: ",
                    Setting::Keep,
                    " compares their areas"
                ]
            }
            Self::NoComponent { .. } => advice!["give ", Setting::MinVolume, " less, or omit it"],
            Self::PeriodicWeights => {
                advice!["give weights as a column of the input, or omit ", Setting::Periodic]
            }
            Self::NoCell => advice!["give ", Setting::Periodic, " the sides or vectors of the box"],
            Self::Radii { radius } => {
                advice!["give a number, as in ", Setting::Alpha, format!(" {radius}")]
            }
            _ => return self.wrapped()?.advice(),
        })
    }
}
