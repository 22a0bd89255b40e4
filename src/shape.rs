//! Alpha shapes by either engine: everything in `walpha-shape`, and CGAL.

pub use walpha_shape::*;

use crate::check::Claim;
use crate::check::schema::PlacedComplex;

/// CGAL's engine, if it is built in (the feature `cgal`): for [`ShapeOptions::classifier`] and
/// [`Recipe::classifier`](crate::Recipe::classifier). [`alpha_shape`] has it at hand anyway.
pub const CGAL: Option<Classifier> = {
    #[cfg(feature = "cgal")]
    {
        Some(Classifier(crate::cgal::complex))
    }
    #[cfg(not(feature = "cgal"))]
    {
        None
    }
};

/// The alpha shape of weighted points, by the engine of the options; both give the same answer. See
/// [`walpha_shape::alpha_shape`] for what a shape is; [`AlphaShape::options`] says which engine ran.
///
/// # Errors
/// The errors of that function; [`CgalError`] if CGAL fails.
pub fn alpha_shape(
    points: impl Into<WeightedPoints>,
    options: &ShapeOptions,
) -> Result<AlphaShape, ShapeError> {
    alpha_shape_monitored(points, options, &Monitor::noop())
}

/// [`alpha_shape`] with progress and cancelling through `monitor`. CGAL cannot be interrupted.
///
/// # Errors
/// Those of [`alpha_shape`], and [`ShapeError::Cancelled`].
pub fn alpha_shape_monitored(
    points: impl Into<WeightedPoints>,
    options: &ShapeOptions,
    monitor: &Monitor,
) -> Result<AlphaShape, ShapeError> {
    let options = options.classifier(options.classifier.or(CGAL));
    walpha_shape::alpha_shape_monitored(points, &options, monitor)
}

/// The claim of a shape, for the checker, as a complex in space.
pub fn claim(shape: &AlphaShape) -> Claim<'_> {
    Claim::new(shape.placed()).with_hidden(shape.hidden()).with_duplicates(shape.duplicates())
}

/// A copy of a shape's complex with its points, for the checker; on a torus too.
pub fn placed_complex(shape: &AlphaShape) -> PlacedComplex {
    let sides = shape.options().periodic.map(|torus| torus.sides());
    PlacedComplex::from(claim(shape)).with_periodic(sides).with_voxels(shape.voxels().cloned())
}
