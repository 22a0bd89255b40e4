//! Alpha shapes by either engine: everything in `walpha-shape`, and CGAL.

pub use walpha_shape::*;

use crate::check::Claim;
use crate::check::schema::PlacedComplex;

/// The largest number of points for which [`Engine::Auto`] chooses CGAL: about the paper's size, which takes CGAL
/// a third of a second.
pub const MOST_FOR_CGAL: usize = 20_000;

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
    let points = points.into();
    let options = options.engine(chosen(points.len(), options));
    #[cfg(feature = "cgal")]
    if options.engine == Engine::Cgal {
        return alpha_shape_by(points, &options, crate::cgal::complex, monitor);
    }
    walpha_shape::alpha_shape_monitored(points, &options, monitor)
}

/// The engine that runs: the one asked for, or the choice of [`Engine::Auto`] for this number of points.
fn chosen(points: usize, options: &ShapeOptions) -> Engine {
    let needs_native = options.periodic.is_some()
        || options.memory.is_some()
        || options.blocks.is_some_and(|blocks| blocks.get() > 1);
    match options.engine {
        Engine::Auto if cfg!(not(feature = "cgal")) || needs_native => Engine::Native,
        Engine::Auto if points > MOST_FOR_CGAL => Engine::Native,
        Engine::Auto => Engine::Cgal,
        asked => asked,
    }
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

#[cfg(test)]
mod tests {
    use std::num::NonZeroUsize;

    use super::*;

    #[test]
    fn the_engine_suits_the_size_and_what_is_asked_for() {
        let options = ShapeOptions::new(Alpha::ZERO);
        let small = if cfg!(feature = "cgal") { Engine::Cgal } else { Engine::Native };
        let chosen = |points, options: ShapeOptions| chosen(points, &options);
        assert_eq!(chosen(20_000, options), small);
        assert_eq!(chosen(20_001, options), Engine::Native);
        let blocks = |count| options.blocks(NonZeroUsize::new(count));
        assert_eq!((chosen(9, blocks(1)), chosen(9, blocks(2))), (small, Engine::Native));
        assert_eq!(chosen(9, options.memory(1 << 30)), Engine::Native);
        assert_eq!(chosen(9, options.periodic(Torus::new([1.0; 3]).unwrap())), Engine::Native);
        for engine in [Engine::Cgal, Engine::Native] {
            assert_eq!(chosen(9, options.engine(engine)), engine);
            assert_eq!(chosen(1 << 20, options.engine(engine)), engine);
        }
    }
}
