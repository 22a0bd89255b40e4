//! Symmetry operations of crystals, as the text of CIF states them (`-y+1/2, x-y, z`), and all atoms of a cell by them
//! (International Tables for Crystallography A).

use std::collections::HashMap;

use walpha_base::memory::{NoMemory, try_reserve};

use crate::Cell;

/// An operation on fractions of a cell: a matrix, and a shift behind it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Operation {
    matrix: [[i32; 3]; 3],
    shift: [f64; 3],
}

impl Operation {
    pub(super) const IDENTITY: Self =
        Self { matrix: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], shift: [0.0; 3] };

    /// Reads an operation: three sums of x, y, z and numbers, which may be quotients. `None` for another text, or for a matrix whose
    /// determinant is not 1 or -1, which maps a lattice to another one.
    pub(super) fn read(text: &str) -> Option<Self> {
        let bare: String =
            text.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_ascii_lowercase();
        let rows: Vec<([i32; 3], f64)> = bare.split(',').map(sum).collect::<Option<_>>()?;
        let [x, y, z]: [_; 3] = rows.try_into().ok()?;
        let operation = Self { matrix: [x.0, y.0, z.0], shift: [x.1, y.1, z.1] };
        let [a, b, c] = operation.matrix;
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        let determinant = a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1);
        (determinant.abs() == 1).then_some(operation)
    }

    /// The image of a place, moved into the cell.
    fn of(&self, place: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let row = self.matrix[k];
            let sum: f64 = (0..3).map(|j| f64::from(row[j]) * place[j]).sum();
            within(sum + self.shift[k])
        })
    }
}

/// The part of a coordinate from 0 to less than 1.
fn within(x: f64) -> f64 {
    let x = x - x.floor();
    if x < 1.0 { x } else { 0.0 }
}

/// The coefficients of x, y and z in a sum, and its number.
fn sum(text: &str) -> Option<([i32; 3], f64)> {
    /// A matrix has coefficients of -1, 0 and 1, and of larger magnitude in no setting that is in use.
    const MOST: i32 = 4;
    let (mut axes, mut shift, mut rest) = ([0_i32; 3], 0.0, text);
    while !rest.is_empty() {
        let (sign, term) = match rest.as_bytes()[0] {
            b'+' => (1, &rest[1..]),
            b'-' => (-1, &rest[1..]),
            _ if rest.len() == text.len() => (1, rest),
            _ => return None,
        };
        let end = term.find(['+', '-']).unwrap_or(term.len());
        match &term[..end] {
            "x" => axes[0] += sign,
            "y" => axes[1] += sign,
            "z" => axes[2] += sign,
            number => shift += f64::from(sign) * quotient(number)?,
        }
        rest = &term[end..];
    }
    (!text.is_empty() && axes.iter().all(|axis: &i32| axis.abs() <= MOST)).then_some((axes, shift))
}

/// A number of digits, or a quotient of two.
fn quotient(text: &str) -> Option<f64> {
    let number = |text: &str| -> Option<f64> {
        let is_plain = text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
        text.parse().ok().filter(|_| is_plain)
    };
    let quotient = match text.split_once('/') {
        Some((above, below)) => number(above)? / number(below)?,
        None => number(text)?,
    };
    quotient.is_finite().then_some(quotient)
}

/// The atoms of a cell, without those that coincide.
pub(super) struct Content<'a> {
    cell: &'a Cell,
    /// The number of boxes along each vector, which are wider than [`Self::NEAR`].
    boxes: [f64; 3],
    /// The images of the last site in each box.
    taken: HashMap<[i64; 3], Vec<usize>>,
    /// Of each atom its place, in fractions of the cell, and its site.
    pub atoms: Vec<([f64; 3], usize)>,
}

impl<'a> Content<'a> {
    /// Images of a site that are nearer than this, in ångströms, are one atom. Those of a place on an element of symmetry are the
    /// same place, but for the rounding of their coordinates: 0.333 in place of 1/3 moves one by 0.001 of a cell, a few hundredths
    /// of an ångström. No two atoms are that near.
    const NEAR: f64 = 0.1;

    pub(super) fn new(cell: &'a Cell) -> Self {
        /// Coordinates below 1 have 53 bits.
        const MOST: f64 = (1_u64 << 50) as f64;
        let [a, b, c] = cell.vectors;
        let volume = dot(a, cross(b, c)).abs();
        let boxes = [cross(b, c), cross(c, a), cross(a, b)].map(|normal| {
            let width = volume / dot(normal, normal).sqrt();
            (width / Self::NEAR).floor().clamp(1.0, MOST)
        });
        Self { cell, boxes, taken: HashMap::new(), atoms: Vec::new() }
    }

    /// Adds the images of a site by all operations: itself first. O(operations).
    ///
    /// # Errors
    /// There is not enough memory.
    pub(super) fn add(
        &mut self,
        site: usize,
        place: [f64; 3],
        operations: &[Operation],
    ) -> Result<(), NoMemory> {
        self.taken.clear();
        for operation in [&Operation::IDENTITY].into_iter().chain(operations) {
            let image = operation.of(place);
            let at = [0, 1, 2].map(|k| (image[k] * self.boxes[k]).floor() as i64);
            if self.has_near(at, image) {
                continue;
            }
            try_reserve(&mut self.atoms, 1, || "the atoms of a cell".into())?;
            self.taken.entry(at).or_default().push(self.atoms.len());
            self.atoms.push((image, site));
        }
        Ok(())
    }

    /// Whether an image of the last site is near a place in a box.
    fn has_near(&self, at: [i64; 3], place: [f64; 3]) -> bool {
        (0..27).any(|index| {
            let beside = [index % 3, index / 3 % 3, index / 9];
            let at = [0, 1, 2].map(|k| (at[k] + beside[k] - 1).rem_euclid(self.boxes[k] as i64));
            self.taken.get(&at).is_some_and(|atoms| {
                atoms.iter().any(|&atom| self.distance(place, self.atoms[atom].0) < Self::NEAR)
            })
        })
    }

    /// The distance of two places by the shortest way across the sides of the cell, where they are near.
    fn distance(&self, one: [f64; 3], other: [f64; 3]) -> f64 {
        let way = [0, 1, 2].map(|k| one[k] - other[k]).map(|x| x - x.round());
        let way = self.cell.place(way);
        dot(way, way).sqrt()
    }
}

fn dot(u: [f64; 3], v: [f64; 3]) -> f64 {
    u.iter().zip(v).map(|(x, y)| x * y).sum()
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| u[i] * v[j] - u[j] * v[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_read_in_all_their_spellings() {
        let of = |text: &str| Operation::read(text).map(|operation| operation.of([0.1, 0.2, 0.3]));
        let near = |text: &str, expected: [f64; 3]| {
            let found = of(text).unwrap_or_else(|| panic!("{text}"));
            let off = (0..3).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12, "{text}: {found:?}, not {expected:?}");
        };
        near("x,y,z", [0.1, 0.2, 0.3]);
        near("-x+1/2, Y , -Z", [0.4, 0.2, 0.7]);
        near("1/2+x,+y,.25-z", [0.6, 0.2, 0.95]);
        near("-y,x-y,z+2/3", [0.8, 0.9, 0.3 + 2.0 / 3.0 - 0.0]);
        near("z,x,y-0.5", [0.3, 0.1, 0.7]);
        near("2/3+x,1/3+y,4/3+z", [0.1 + 2.0 / 3.0, 0.2 + 1.0 / 3.0, 0.3 + 1.0 / 3.0]);
        for wrong in [
            "",
            "x",
            "x,y",
            "x,y,z,t",
            "x,y,",
            "x,y,x",
            "x,y,0",
            "x,y,2z",
            "xy,z,x",
            "x,y,z+1/0",
            "x,y,z+",
            "x,y,w",
            "x,y,z+1e3",
            "x y z",
            "x,y,--z",
        ] {
            assert_eq!(of(wrong), None, "{wrong}");
        }
        assert_eq!(Operation::read("x,y,z"), Some(Operation::IDENTITY));
    }

    /// Counts the images of a place.
    fn images(cell: &Cell, place: [f64; 3], operations: &[&str]) -> usize {
        let operations: Vec<Operation> =
            operations.iter().map(|text| Operation::read(text).unwrap()).collect();
        let mut content = Content::new(cell);
        content.add(0, place, &operations).unwrap();
        content.atoms.len()
    }

    #[test]
    fn images_that_coincide_are_one_atom() {
        let cell = Cell::of_angles([20.0, 20.0, 30.0], [90.0, 90.0, 120.0]).unwrap();
        let threefold = ["x,y,z", "-y,x-y,z", "-x+y,-x,z"];
        assert_eq!(images(&cell, [0.1, 0.2, 0.3], &threefold), 3);
        // On the axis, with three digits.
        assert_eq!(images(&cell, [0.333, 0.667, 0.3], &threefold), 1);
        assert_eq!(images(&cell, [0.34, 0.667, 0.3], &threefold), 3);
        // Across the sides of the cell, and with a place that is itself outside of it.
        assert_eq!(images(&cell, [0.0004, 0.9996, 0.9999], &["x,y,z", "-x,-y,-z"]), 1);
        assert_eq!(images(&cell, [-0.3, 1.2, 5.5], &["x,y,z", "x,y,-z"]), 1);
        // A cell that is not wider than atoms are apart.
        let small = Cell::of_angles([0.15; 3], [90.0; 3]).unwrap();
        assert_eq!(images(&small, [0.1, 0.1, 0.1], &["-x,-y,-z"]), 1);
    }
}
