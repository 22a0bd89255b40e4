//! Volume modelling of scattered data with wavelet-weighted alpha shapes, on CGAL.
//!
//! A volume is Haar-transformed, small coefficients are dropped under an L² error, the samples of
//! largest gray difference are kept as points, each gets a weight from that difference, and the
//! weighted alpha shape of these points is computed exactly: tetrahedra, facets, edges, vertices.
//! The method is that of "Volume Modeling of Scattered Data based on Weighted Alpha Shapes", which also uses CGAL.
//!
//! A [`Recipe`] runs every stage, from a volume to the shape:
//!
//! ```
//! use walpha::{Alpha, Class, Recipe, Weighting, volume};
//!
//! let recipe = Recipe::new().weighting(Weighting::MinMax).alpha(Alpha::from_squared(10.0)?);
//! let model = recipe.run(volume::sample("sample:phantom@32")?)?;
//!
//! let truncation = model.origin.truncation.expect("points of a volume have one");
//! assert!(truncation.rms <= 1.0);
//! assert!(model.shape.complex().facets.counts()[Class::Regular] > 0);
//! assert_eq!(model.shape.betti().map(|betti| betti.b0), Some(1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Each stage is also a function from one type to the next, usable alone: [`haar::smooth`],
//! [`points::difference`], [`points::select`], [`points::weigh`], [`alpha_shape`].
//!
//! α and ω are squared lengths. Points are (x, y, z); volumes are stored `[z, y, x]`. Results are
//! independent of the number of threads.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `cgal` | yes | CGAL's engine, through a bridge to C++: the module `cgal`; without it the crate is Rust alone |
//! | `cgal-oracles` | no | more of CGAL to check against: triangulations, all alpha shapes, periodic triangulations |
//! | `gmp` | yes | CGAL computes with GMP and MPFR where they are installed |
//! | `render` | yes | pictures, charts and the interactive page: the module `render` |
//! | `paper` | yes | `walpha reproduce`: the paper's figures and its table |
//! | `dicom` | no | DICOM series |
//! | `las` | no | LAS, LAZ and GeoPackage (builds SQLite) |
//! | `zarr` | no | Zarr, versions 2 and 3, and OME-Zarr; builds the C libraries blosc and zstd |
//! | `mpi` | no | blocks on the processes of `mpirun` |

#![cfg_attr(docsrs, feature(doc_cfg))]
// Not in Cargo.toml, where it would also apply to tests, whose shared modules are `pub` in each test.
#![warn(unreachable_pub)]

pub use ndarray;

#[cfg(feature = "cgal")]
pub mod cgal;
pub mod cli;
#[cfg(feature = "render")]
pub mod pictures;
#[cfg(feature = "paper")]
pub mod reproduce;
pub mod shape;

/// Unions of balls, measured with bounds on errors: a crate of its own, `walpha-balls`, for use in other programs.
pub use walpha_balls as balls;
/// The advice of errors.
pub use walpha_base::advice;
/// Selects weighted points from a volume: the separate crate `walpha-points`, for use in other programs.
pub use walpha_points as points;
pub use walpha_points::haar;
/// Exact regular triangulations: the separate crate `walpha-regular`, for use in other programs.
pub use walpha_regular as triangulation;
/// Pictures, figures and the interactive page: the separate crate `walpha-render`, for use in other programs.
#[cfg(feature = "render")]
pub use walpha_render as render;
/// Many α from one triangulation, and levels of detail.
pub use walpha_shape::ladder;
/// Volumes and their files: the separate crate `walpha-volume`, for use in other programs.
pub use walpha_volume as volume;

pub use walpha_base::threads;
/// The exact checker: the separate crate `walpha-check`, for use in other programs.
pub use walpha_check as check;

/// The recipe and its execution, interpolation, files and work in blocks: the separate crate `walpha-model`, for use in other
/// programs.
pub use walpha_model::{
    Interpolant, LabelChoice, Recipe, Save, Settings, SurfaceChoice, distance, export, interpolate,
    labels, outofcore, pipeline, progress, settings, surface,
};

pub use haar::{Coefficients, Decomposition, HaarOptions, Tolerance, Truncation};
pub use points::{Points, PointsError, Selection, SelectionRule, Units, Weighting};
pub use shape::{
    Alpha, AlphaShape, Balls, CgalError, Class, Complex, Simplices, WeightedPoints, alpha_shape,
};
pub use volume::{
    Coordinates, Dims, Frame, Gray, GrayRange, LengthUnit, Space, Volume, VolumeError,
};
pub use walpha_base::memory::{NoMemory, is_asking, try_with_capacity};
