//! How far two shapes or pictures are the same.

use crate::render::Picture;
use crate::shape::{Class, Complex, Simplices};

/// Simplices that two shapes over the same points do not share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Difference {
    /// Cells of one only.
    pub cells: usize,
    /// Facets on the boundary, regular or singular, of one only.
    pub boundary: usize,
}

impl Difference {
    pub fn between(a: &Complex, b: &Complex) -> Self {
        let boundary = [Class::Regular, Class::Singular];
        Self {
            cells: not_shared(&a.cells, &b.cells, &[Class::Interior]),
            boundary: not_shared(&a.facets, &b.facets, &boundary),
        }
    }
}

/// Rows of these classes that stand in one list only. Rows ascend in both.
fn not_shared<const N: usize>(a: &Simplices<N>, b: &Simplices<N>, classes: &[Class]) -> usize {
    let rows = |list: &Simplices<N>| -> Vec<([u32; N], Class)> {
        let rows = list.iter().filter(|(_, class)| classes.contains(class));
        rows.map(|(&row, class)| (row, class)).collect()
    };
    let (a, b) = (rows(a), rows(b));
    let shared = a.iter().filter(|row| b.binary_search(row).is_ok()).count();
    a.len() + b.len() - 2 * shared
}

/// Pixels at which two pictures of one size differ.
pub(super) fn pixels(a: &Picture, b: &Picture) -> usize {
    a.pixels().iter().zip(b.pixels()).filter(|(a, b)| a != b).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simplices(rows: &[([u32; 3], Class)]) -> Simplices<3> {
        let (vertices, classes) = rows.iter().copied().unzip();
        Simplices { vertices, classes }
    }

    #[test]
    fn rows_and_classes_must_both_agree() {
        use Class::{Interior, Regular, Singular};
        let a = simplices(&[([0, 1, 2], Regular), ([0, 2, 3], Regular), ([1, 2, 3], Interior)]);
        let b = simplices(&[([0, 1, 2], Singular), ([0, 2, 3], Regular), ([1, 2, 4], Regular)]);
        assert_eq!(not_shared(&a, &b, &[Regular, Singular]), 3);
        assert_eq!(not_shared(&a, &a, &[Regular, Singular]), 0);
        assert_eq!(not_shared(&a, &b, &[Interior]), 1);
    }
}
