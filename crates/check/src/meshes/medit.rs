//! Medit's `.mesh` as text (INRIA RT-0253, "Medit: an interactive mesh visualization software"): keywords, each with
//! the number of its entries and these. Points are numbered from 1.

use super::scan::{Scan, shown};
use super::{Mesh, MeshError, no_such_point, not_tetrahedra};

/// Keywords of cells that are not tetrahedra of four nodes.
const OTHER_CELLS: [&str; 5] = ["Hexahedra", "Hexaedra", "Prisms", "Pyramids", "TetrahedraP2"];
/// Keywords of simplices and surfaces of less than three dimensions.
const IGNORED: [&str; 3] = ["Triangles", "Quadrilaterals", "Edges"];

pub(super) fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut scan = Scan::with_comments(bytes);
    if scan.word() != Some(b"MeshVersionFormatted") {
        // Binary files begin with the number 1 in either byte order.
        if bytes.starts_with(&[1, 0, 0, 0]) || bytes.starts_with(&[0, 0, 0, 1]) {
            let error = MeshError::new("the file is binary Medit (.meshb), which is not read");
            return Err(error.with_advice("write it as text (.mesh)"));
        }
        let error = MeshError::new(
            "the file does not begin with MeshVersionFormatted: it is not a mesh of Medit",
        );
        return Err(error.with_advice("convert it to .mesh of Medit, .msh of Gmsh or .vtk"));
    }
    scan.int("the version")?;
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    let mut ignored = Vec::new();
    while let Some(word) = scan.word() {
        let keyword = shown(word);
        match &keyword[..] {
            "Dimension" => {
                let dimension = scan.int("the dimension")?;
                if dimension != 3 {
                    return Err(scan.fault(format!("points have {dimension} coordinates, not 3")));
                }
            }
            "Vertices" => {
                let count = scan.size("the number of points")?;
                // Three coordinates and a reference, each but the last followed by a blank.
                points = scan.room(count, 7, "points")?;
                for _ in 0..count {
                    points.push(scan.position()?);
                    scan.int("a reference")?;
                }
            }
            "Tetrahedra" => {
                let count = scan.size("the number of tetrahedra")?;
                cells = scan.room(count, 9, "tetrahedra")?;
                for _ in 0..count {
                    let mut cell = [0; 4];
                    for corner in &mut cell {
                        let number = scan.int("the number of a point")?;
                        let index =
                            usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
                        let index = index.filter(|&index| index < points.len());
                        *corner = index
                            .ok_or_else(|| no_such_point(&scan, number, 1, points.len()))?
                            as u32;
                    }
                    cells.push(cell);
                    scan.int("a reference")?;
                }
            }
            "End" => break,
            _ if !word[0].is_ascii_alphabetic() => {
                return Err(scan.fault(format!("{keyword:?} stands where a keyword should be")));
            }
            _ => {
                let count = skip(&mut scan)?;
                if OTHER_CELLS.contains(&&keyword[..]) && count > 0 {
                    return Err(not_tetrahedra(&format!("{count} {keyword}")));
                }
                if IGNORED.contains(&&keyword[..]) {
                    ignored.push((keyword, count));
                }
            }
        }
    }
    let mesh = Mesh::of_cells(points, cells)?.with_decimal_note().with_numbering_note(1);
    Ok(mesh.with_ignored(&ignored))
}

/// Skips the entries of a keyword, up to the next one, and returns their number as stated; 0 if there is none.
fn skip(scan: &mut Scan) -> Result<u64, MeshError> {
    let mut count = None;
    while scan.peek().is_some_and(|word| !word[0].is_ascii_alphabetic()) {
        let word = scan.expect("a number")?;
        if count.is_none() {
            count = Some(scan.value(word, "a number of entries")?);
        }
    }
    Ok(count.unwrap_or(0))
}
