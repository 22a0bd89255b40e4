//! Converts shapes to the claims that the checker judges.

use walpha_check::Claim;
use walpha_check::schema::{BoxVectors, ComplexFile, PlacedComplex, PointCopy};
use walpha_shape::AlphaShape;

/// The claim of a shape, for the checker, as a complex in space.
pub fn claim(shape: &AlphaShape) -> Claim<'_> {
    Claim::new(shape.placed()).with_hidden(shape.hidden()).with_duplicates(shape.duplicates())
}

/// The file of a shape's complex, also of one on a torus.
pub(super) fn complex_file(shape: &AlphaShape) -> ComplexFile {
    let mut file = ComplexFile::from(claim(shape));
    file.periodic = shape.options().periodic.map(|torus| BoxVectors(torus.vectors()));
    file.copies = point_copies(shape);
    if file.copies.is_some() {
        file.points.truncate(shape.own_points());
        file.weights.iter_mut().for_each(|weights| weights.truncate(shape.own_points()));
    }
    file.voxels = shape.voxels().cloned();
    file.isovalue = shape.isovalue();
    file
}

/// The copies of points that the rows of a shape of a torus name, if they do.
pub(super) fn point_copies(shape: &AlphaShape) -> Option<Vec<PointCopy>> {
    let copy = |(&v, &[a, b, c]): (&u32, &[i32; 3])| [v as i32, a, b, c];
    let copies = shape.options().periodic.map(|_| shape.copies()).filter(|all| !all.is_empty())?;
    Some(copies.iter().zip(shape.shifts()).map(copy).collect())
}

/// A copy of a shape's complex with its points, for the checker; also for a shape on a torus. Where rows name copies of points, it is that of
/// several copies of the box.
#[expect(clippy::missing_panics_doc, reason = "an invariant")]
pub fn placed_complex(shape: &AlphaShape) -> PlacedComplex {
    if point_copies(shape).is_some() {
        return PlacedComplex::try_from(complex_file(shape)).expect("copies near the box");
    }
    let vectors = shape.options().periodic.map(|torus| BoxVectors(torus.vectors()));
    PlacedComplex::from(claim(shape))
        .with_periodic(vectors)
        .with_voxels(shape.voxels().cloned())
        .with_isovalue(shape.isovalue())
}
