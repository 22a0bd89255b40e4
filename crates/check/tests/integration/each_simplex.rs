//! Each simplex of a complex dropped, and each class exchanged, is found.

use walpha_check::schema::{Classes, ComplexFile, PlacedComplex};
use walpha_check::{Claim, Class, Extent, Finding, Simplices};

use crate::base::{base, findings};
use crate::common::{closed, drop_row, shape_of, sorted};

#[test]
fn each_missing_face() {
    let (case, answer) = base();
    for dimension in 0..3 {
        for row in 0.. {
            let mut mutated = answer.complex.clone();
            let dropped = match dimension {
                0 => drop_row(&mut mutated.vertices, row),
                1 => drop_row(&mut mutated.edges, row),
                _ => drop_row(&mut mutated.facets, row),
            };
            let Some(dropped) = dropped else {
                assert!(row > 20);
                break;
            };
            let all = findings(&case, &answer.with(mutated), Extent::Whole);
            let is_it = |f: &Finding| matches!(f, Finding::MissingFace { face, .. } if sorted(face.vertices()) == dropped);
            assert!(all.iter().any(is_it), "{dropped:?}: {all:?}");
        }
    }
}

#[test]
fn each_dropped_cell() {
    let (case, answer) = base();
    for row in 0..answer.complex.cells.len() {
        let mut mutated = answer.complex.clone();
        let dropped = drop_row(&mut mutated.cells, row).unwrap();
        let all = findings(&case, &answer.with(mutated), Extent::Whole);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
    let shape = shape_of(&answer);
    for row in 0..shape.complex.cells.len() {
        let mut mutated = shape.complex.clone();
        let dropped = drop_row(&mut mutated.cells, row).unwrap();
        let all = findings(&case, &answer.with(mutated), Extent::Shape);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
}

/// Whether there is exactly one finding, the true one.
fn is_missing(all: &[Finding], dropped: &[u32]) -> bool {
    matches!(all, [Finding::MissingCell { cell, .. }] if sorted(cell.vertices()) == dropped)
}

/// The finding also appears if classes were made from the remaining cells.
#[test]
fn each_dropped_cell_of_a_file_without_classes() {
    let (case, answer) = base();
    let shape = shape_of(&answer);
    let mut whole = ComplexFile::from(Claim::new(case.placed(&shape.complex)));
    whole.classes = Classes::default();
    for row in 0..shape.complex.cells.len() {
        let mut file = whole.clone();
        let dropped = sorted(&file.cells.as_mut().unwrap().remove(row));
        let complex = PlacedComplex::try_from(file).unwrap().complex;
        let all = findings(&case, &answer.with(complex), Extent::Shape);
        assert!(is_missing(&all, &dropped), "{dropped:?}: {all:?}");
    }
}

/// The finding also appears if every face that only the dropped cell had is dropped.
#[test]
fn each_cell_dropped_with_its_faces() {
    let (mut case, mut answer) = base();
    case.alpha = f64::NEG_INFINITY;
    answer.complex = closed(answer.complex.cells.rows());
    assert_eq!(findings(&case, &answer, Extent::Whole), []);
    for row in 0..answer.complex.cells.len() {
        let mut cells = answer.complex.cells.rows().to_vec();
        cells.remove(row);
        let all = findings(&case, &answer.with(closed(&cells)), Extent::Whole);
        let geometric = |f: &Finding| {
            matches!(
                f,
                Finding::HullBends { .. }
                    | Finding::HullEdge { .. }
                    | Finding::HullWraps { .. }
                    | Finding::OutsideHull { .. }
                    | Finding::MissingCell { .. }
            )
        };
        assert!(all.iter().any(geometric), "{all:?}");
    }
}

#[test]
fn each_flipped_class() {
    let (case, answer) = base();
    let shape = shape_of(&answer);
    for (answer, extent) in [(&answer, Extent::Whole), (&shape, Extent::Shape)] {
        let c = &answer.complex;
        let counts = [c.cells.len(), c.facets.len(), c.edges.len(), c.vertices.len()];
        for (kind, count) in counts.into_iter().enumerate() {
            for row in 0..count {
                for class in Class::ALL {
                    let mut mutated = answer.complex.clone();
                    let (slot, simplex) = match kind {
                        0 => class_of(&mut mutated.cells, row),
                        1 => class_of(&mut mutated.facets, row),
                        2 => class_of(&mut mutated.edges, row),
                        _ => class_of(&mut mutated.vertices, row),
                    };
                    let right = std::mem::replace(slot, class);
                    if right == class {
                        continue;
                    }
                    let all = findings(&case, &answer.with(mutated), extent);
                    assert!(
                        matches!(&all[..], [Finding::Class { simplex: s, given, expected, .. }]
                            if s.vertices() == simplex && *given == class && *expected == right),
                        "{all:?}"
                    );
                }
            }
        }
    }
}

fn class_of<const N: usize>(s: &mut Simplices<N>, row: usize) -> (&mut Class, Vec<u32>) {
    let simplex = s.rows()[row].to_vec();
    (&mut s.classes_mut()[row], simplex)
}
