//! Computes alpha shapes from volumes or points, by one [`Recipe`]; and derives files and interpolants from a shape, or computes
//! it in blocks.
//!
//! ```
//! use walpha_model::Recipe;
//! use walpha_points::Weighting;
//! use walpha_shape::{Alpha, Class};
//!
//! let recipe = Recipe::new().weighting(Weighting::MinMax).alpha(Alpha::from_squared(10.0)?);
//! let model = recipe.run(walpha_volume::sample("sample:phantom@32")?)?;
//! assert!(model.shape.complex().facets.counts()[Class::Regular] > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]
// The slicing macro of ndarray allows unsafe code within itself, so it cannot be forbidden.
#![deny(unsafe_code)]
#![warn(unreachable_pub)]

pub mod distance;
pub mod export;
pub mod interpolate;
pub mod labels;
pub mod outofcore;
pub mod pipeline;
pub mod progress;
pub mod settings;
pub mod surface;

pub use export::Save;
pub use interpolate::Interpolant;
pub use labels::LabelChoice;
pub use pipeline::Recipe;
pub use settings::Settings;
pub use surface::SurfaceChoice;
pub use walpha_base::advice::Advise;
