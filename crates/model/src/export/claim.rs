//! Converts shapes to the claims that the checker judges.

use walpha_check::Claim;
use walpha_check::schema::{BoxVectors, PlacedComplex};
use walpha_shape::AlphaShape;

/// The claim of a shape, for the checker, as a complex in space.
pub fn claim(shape: &AlphaShape) -> Claim<'_> {
    Claim::new(shape.placed()).with_hidden(shape.hidden()).with_duplicates(shape.duplicates())
}

/// A copy of a shape's complex with its points, for the checker; also for a shape on a torus.
pub fn placed_complex(shape: &AlphaShape) -> PlacedComplex {
    let vectors = shape.options().periodic.map(|torus| BoxVectors(torus.vectors()));
    PlacedComplex::from(claim(shape))
        .with_periodic(vectors)
        .with_voxels(shape.voxels().cloned())
        .with_isovalue(shape.isovalue())
}
