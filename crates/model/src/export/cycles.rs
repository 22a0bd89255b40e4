//! Writer of representative cycles of persistence pairs.

use std::io::{self, Write};

use walpha_base::parallel::prelude::*;
use walpha_base::sort::sort_by;
use walpha_shape::ShapeError;
use walpha_shape::ladder::{Interval, Ordered};
use walpha_volume::{Coordinates, annotation};

use super::vtu::{Appended, Ids, bytes};

/// How many pairs of each dimension have their cycles written, unless a persistence is given.
const MOST: usize = 100;

/// The intervals of a dimension, 1 or 2, that last longer than this, a squared length; without it the [`MOST`] that last longest. Longest first.
fn longest(
    ordered: &Ordered<'_>,
    dimension: usize,
    above: Option<f64>,
) -> Result<Vec<Interval>, ShapeError> {
    let mut intervals = ordered.persistence(dimension)?;
    let lasts = |interval: &Interval| interval.death - interval.birth;
    sort_by(&mut intervals, |a, b| {
        lasts(b)
            .total_cmp(&lasts(a))
            .then(a.birth.total_cmp(&b.birth))
            .then(a.begins.cmp(&b.begins))
    });
    match above {
        Some(above) => intervals.retain(|interval| lasts(interval) > above),
        None => intervals.truncate(MOST),
    }
    Ok(intervals)
}

/// Writes cycles of persistence pairs as VTP: of those that last longer than `above`, a squared length, or without it of the 100 of each dimension that last
/// longest. For each loop a closed line, its
/// [walk](walpha_shape::ladder::LoopCycle::walk), and for each void the triangles around it. Cell data are `dimension`, `birth`, `death` (infinite for a loop
/// that never ends) and `interval`, the rank among those of its dimension from 0. Surfaces of a torus that never end have no cycles here. On a
/// torus cycles are laid out in space. Points are repeated for each cycle.
///
/// # Errors
/// Errors of `out`; out of memory.
pub fn write_cycles(
    ordered: &Ordered<'_>,
    above: Option<f64>,
    coordinates: Coordinates,
    input: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    let cycles = ordered.cycles();
    let (mut points, mut lines, mut triangles) = (Vec::new(), Vec::new(), 0);
    let mut data: Vec<(u8, f64, f64, u32)> = Vec::new();
    let loops = longest(ordered, 1, above).map_err(io::Error::other)?;
    // A walk may go through much of the complex.
    let paths: Vec<_> =
        loops.par_iter().with_max_len(1).map(|one| cycles.path_of_loop(one.begins)).collect();
    for ((rank, interval), path) in (0..).zip(loops).zip(paths) {
        let Some(path) = path else { continue };
        points.extend(path);
        lines.push(points.len());
        data.push((1, interval.birth, interval.death, rank));
    }
    for (rank, interval) in (0..).zip(longest(ordered, 2, above).map_err(io::Error::other)?) {
        let Some(cycle) = interval.ends.and_then(|cell| cycles.of_void(cell)) else { continue };
        triangles += cycle.corners.len();
        data.resize(data.len() + cycle.corners.len(), (2, interval.birth, interval.death, rank));
        points.extend(cycle.corners.into_iter().flatten());
    }
    let mut file = Appended::default();
    write!(
        file.xml,
        "<?xml version=\"1.0\"?>\n<!-- walpha: cycles of persistence pairs -->\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <PolyData>\n<FieldData>\n",
    )?;
    let made_by = format!("walpha {}", env!("CARGO_PKG_VERSION"));
    let texts = [("made_by", made_by.as_str()), ("input", input)];
    for (name, text) in texts.into_iter().chain(annotation::pairs(coordinates)) {
        file.text(name, text, true)?;
    }
    write!(
        file.xml,
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{triangles}\">\n<CellData>\n",
        points.len(),
        lines.len(),
    )?;
    file.array("UInt8", "dimension", 1, data.iter().map(|row| row.0).collect())?;
    file.array("Float64", "birth", 1, bytes(data.iter().map(|row| row.1.to_le_bytes())))?;
    file.array("Float64", "death", 1, bytes(data.iter().map(|row| row.2.to_le_bytes())))?;
    file.array("UInt32", "interval", 1, bytes(data.iter().map(|row| row.3.to_le_bytes())))?;
    write!(file.xml, "</CellData>\n<Points>\n")?;
    let coordinates = points.as_flattened().iter();
    file.array("Float64", "Points", 3, bytes(coordinates.map(|x: &f64| x.to_le_bytes())))?;
    writeln!(file.xml, "</Points>")?;
    // Points follow each other as the cells need them.
    let of_lines = lines.last().copied().unwrap_or(0);
    cells(&mut file, "Lines", 0..of_lines, &lines)?;
    let ends: Vec<usize> = (1..=triangles).map(|triangle| 3 * triangle).collect();
    cells(&mut file, "Polys", of_lines..points.len(), &ends)?;
    write!(file.xml, "</Piece>\n</PolyData>\n")?;
    file.end(out)
}

/// Cells whose vertices are consecutive points, with the ends of each among these.
fn cells(
    file: &mut Appended,
    name: &str,
    points: std::ops::Range<usize>,
    ends: &[usize],
) -> io::Result<()> {
    writeln!(file.xml, "<{name}>")?;
    let (mut corners, mut offsets) = (Ids::up_to(points.end), Ids::up_to(points.end));
    points.for_each(|v| corners.push(v));
    ends.iter().for_each(|&end| offsets.push(end));
    file.ids("connectivity", corners)?;
    file.ids("offsets", offsets)?;
    writeln!(file.xml, "</{name}>")
}
