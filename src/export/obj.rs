use std::io::{self, Write};

use super::{Exporter, stated};
use crate::shape::{AlphaShape, Surface};

/// Wavefront OBJ: the groups `regular` and `singular` hold facets, `edges` singular edges and
/// `points` singular vertices. Numbering starts at 1.
#[derive(Clone, Copy, Debug)]
pub struct Obj;

impl Exporter for Obj {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = Surface::of(shape);
        let positions = &shape.points().positions;
        writeln!(out, "# walpha: {}", shape.options().alpha)?;
        write!(out, "{}", stated::line("#", shape.coordinates()))?;
        for &v in &surface.vertices {
            let [x, y, z] = positions[v as usize];
            writeln!(out, "v {x} {y} {z}")?;
        }
        group(out, "regular", "f", &surface.regular)?;
        group(out, "singular", "f", &surface.singular)?;
        group(out, "edges", "l", &surface.edges)?;
        let points: Vec<[u32; 1]> = surface.points.iter().map(|&v| [v]).collect();
        group(out, "points", "p", &points)
    }
}

fn group<const N: usize>(
    out: &mut dyn Write,
    name: &str,
    element: &str,
    rows: &[[u32; N]],
) -> io::Result<()> {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "g {name}")?;
    for row in rows {
        write!(out, "{element}")?;
        for v in row {
            write!(out, " {}", v + 1)?;
        }
        writeln!(out)?;
    }
    Ok(())
}
