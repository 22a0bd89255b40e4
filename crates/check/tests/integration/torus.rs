//! Complexes of a periodic box, by hand.

use walpha_check::schema::{ComplexFile, PlacedComplex, SchemaError};
use walpha_check::{Alpha, CertifyError, Finding};

/// What is found of an edge from the origin along x.
fn findings(end: f64, side: f64) -> Result<Vec<Finding>, CertifyError> {
    let alpha = Alpha::from_squared(16.0).unwrap();
    let mut file = ComplexFile::of_points(vec![[0.0; 3], [end, 0.0, 0.0]], alpha);
    file.edges = Some(vec![[0, 1]]);
    file.vertices = Some(vec![0, 1]);
    file.periodic = Some([side; 3]);
    Ok(PlacedComplex::try_from(file).unwrap().findings()?.0)
}

#[test]
fn edges_span_less_than_half_of_the_box() {
    let long = |end| {
        let found = findings(end, 8.0).unwrap();
        found.iter().any(|found| matches!(found, Finding::LongEdge { .. }))
    };
    assert_eq!([3.75, 4.0, 4.25].map(long), [false, true, false]);
}

/// Beyond 2⁵³ doubles are even.
#[test]
fn copies_of_points_are_exact() {
    let side = 2f64.powi(52);
    let refused = |end| matches!(findings(end, side), Err(CertifyError::NotInBox(1)));
    assert_eq!([2.0, 1.0, -2.0, side].map(refused), [false, true, true, true]);
}

#[test]
fn sides_are_positive_numbers() {
    for side in [0.0, -8.0, f64::NAN, f64::INFINITY] {
        let mut file = ComplexFile::of_points(vec![[0.0; 3]], Alpha::ZERO);
        file.vertices = Some(vec![0]);
        file.periodic = Some([8.0, side, 8.0]);
        let refused = PlacedComplex::try_from(file).unwrap_err();
        assert!(
            matches!(refused, SchemaError::Value { name: "periodic", .. }),
            "{side}: {refused}"
        );
    }
}
