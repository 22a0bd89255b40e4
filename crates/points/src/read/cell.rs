//! The unit cell of a crystal, as PDB and mmCIF state it.

use crate::Cell;

/// Lengths in ångströms, angles in degrees, and the space group.
pub(super) struct UnitCell {
    pub lengths: [f64; 3],
    pub angles: [f64; 3],
    pub group: String,
}

impl UnitCell {
    /// The cell of a record CRYST1; `None` if its columns are blank.
    ///
    /// # Errors
    /// Which of its fields is not a number.
    pub(super) fn of_pdb(line: &str) -> Result<Option<Self>, String> {
        let columns = [6..15, 15..24, 24..33, 33..40, 40..47, 47..54];
        let fields = columns.map(|columns| line.get(columns).unwrap_or_default().trim());
        if fields == [""; 6] {
            return Ok(None);
        }
        let mut numbers = [0.0; 6];
        for (number, field) in numbers.iter_mut().zip(fields) {
            *number = field
                .parse()
                .map_err(|_| format!("has a CRYST1 with {field:?}, which is not a number"))?;
        }
        let [a, b, c, alpha, beta, gamma] = numbers;
        let group = line.get(55..).unwrap_or_default();
        let group = group.get(..11).unwrap_or(group).trim().to_owned();
        Ok(Some(Self { lengths: [a, b, c], angles: [alpha, beta, gamma], group }))
    }

    /// The cell in which the atoms repeat as they are. With symmetries other than translations, what is listed is a part of its
    /// content; and files without a crystal have a cube of side 1.
    pub(super) fn repeating(self) -> Option<Cell> {
        let Self { lengths: [a, b, c], angles, group } = self;
        let is_p1 = ["", "P1"].contains(&&*group.replace(' ', ""));
        if !is_p1 || [a, b, c].iter().any(|length| !(*length > 1.0 && length.is_finite())) {
            return None;
        }
        Cell::of_angles([a, b, c], angles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Option<Cell> {
        UnitCell::of_pdb(line).unwrap().and_then(UnitCell::repeating)
    }

    #[test]
    fn cells_repeat_where_there_is_no_symmetry() {
        let line = |angles: &str, group: &str| {
            format!("CRYST1   10.000   20.000   30.000{angles} {group}")
        };
        let right = "  90.00  90.00  90.00";
        assert_eq!(of(&line(right, "P 1           1")).unwrap().sides(), Some([10.0, 20.0, 30.0]));
        assert_eq!(of(&line(right, "")).unwrap().sides(), Some([10.0, 20.0, 30.0]));
        assert_eq!(of(&line(right, "P 21 21 21    4")), None);
        assert_eq!(of("CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1"), None);
        assert_eq!(of("CRYST1"), None);
        // a along x, b in the plane of x and y.
        let [a, b, c] = of(&line("  80.00  95.00 120.00", "P 1")).unwrap().vectors;
        assert_eq!((a, b[2]), ([10.0, 0.0, 0.0], 0.0));
        let angle = |u: [f64; 3], v: [f64; 3]| {
            let dot = |u: [f64; 3], v: [f64; 3]| u.iter().zip(v).map(|(x, y)| x * y).sum::<f64>();
            (dot(u, v) / (dot(u, u) * dot(v, v)).sqrt()).acos().to_degrees()
        };
        for (found, expected) in [(angle(b, c), 80.0), (angle(a, c), 95.0), (angle(a, b), 120.0)] {
            assert!((found - expected).abs() < 1e-9, "{found}");
        }
        // No three vectors have these angles.
        assert_eq!(of(&line("  10.00  10.00 120.00", "P 1")), None);
        assert!(UnitCell::of_pdb(&line("  xx.00  90.00  90.00", "P 1")).is_err());
    }
}
