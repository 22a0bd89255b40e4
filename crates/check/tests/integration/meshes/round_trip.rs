//! Triangulations written in each format and read back.

use walpha_base::random::Random;

use super::writers::{File, all};
use super::{folder, judge, read};
use crate::common::{Case, definition};

/// Every double and every cell comes back, and the verdict is that of the definition.
#[test]
fn triangulations_come_back() {
    let mut random = Random::new(34);
    let folder = folder();
    let mut read_back = 0;
    for round in 0..40 {
        // Points in general position, and of a lattice, whose digits are few and whose ties are many.
        let side = 2 + random.below(3);
        let lattice = round % 2 == 0;
        let mut coordinate = || {
            if lattice {
                random.below(side) as f64 * 0.1
            } else {
                (random.unit() - 0.5) * 10f64.powi(round % 7 - 3)
            }
        };
        let positions: Vec<[f64; 3]> = (0..12).map(|_| [0; 3].map(|_| coordinate())).collect();
        let case = Case { weights: vec![0.0; positions.len()], positions, alpha: f64::INFINITY };
        let Ok(answer) = definition(&case) else { continue };
        let cells = answer.complex.cells.rows();
        if cells.is_empty() || !answer.duplicates.is_empty() {
            continue;
        }
        for files in all(&case.positions, cells) {
            let files: Vec<(&str, &[u8])> =
                files.iter().map(|(name, bytes): &File| (*name, &bytes[..])).collect();
            let mesh = read(&folder, &files).unwrap();
            assert_eq!(mesh.complex.points, case.positions, "{}", files[0].0);
            assert_eq!(mesh.complex.cells.as_deref(), Some(cells), "{}", files[0].0);
            assert_eq!(judge(mesh).0, "exact: no findings", "{}", files[0].0);
            read_back += 1;
        }
    }
    assert!(read_back > 250, "{read_back}");
}
