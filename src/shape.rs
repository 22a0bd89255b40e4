//! Alpha shapes by either engine: everything in `walpha-shape`, and CGAL.

pub use walpha_model::export::{claim, placed_complex};
pub use walpha_shape::*;

/// CGAL's engine, if it is built in (the feature `cgal`): for [`ShapeOptions::classifier`] and
/// [`Recipe::classifier`](crate::Recipe::classifier). [`alpha_shape`] uses it without that.
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

/// Computes the alpha shape of weighted points with the engine of the options; both engines give the same result. See
/// [`walpha_shape::alpha_shape`] for the definition of a shape; [`AlphaShape::options`] says which engine ran.
///
/// # Errors
/// See [`walpha_shape::alpha_shape`]; and [`CgalError`] if CGAL fails.
pub fn alpha_shape(
    points: impl Into<WeightedPoints>,
    options: &ShapeOptions,
) -> Result<AlphaShape, ShapeError> {
    let options = options.classifier(options.classifier.or(CGAL));
    walpha_shape::alpha_shape(points, &options)
}

/// The suggested values of α, if they are finite.
pub(crate) fn suggested(filtration: &ladder::Filtration, curve: &ladder::Curve) -> Vec<Alpha> {
    let suggested = filtration.suggest(curve);
    let [low, high] = suggested.plateau;
    let also = [suggested.all_points, suggested.one_region, suggested.no_void, low, high];
    also.into_iter().filter(|alpha| alpha.squared().is_finite()).collect()
}
