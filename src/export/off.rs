use std::io::{self, Write};

use super::{Exporter, stated};
use crate::shape::{AlphaShape, Surface};

/// OFF, the object file format of Geomview: boundary facets with a colour each, regular ones
/// light, singular ones orange. It knows no edges or lone points, so singular ones are left out.
#[derive(Clone, Copy, Debug)]
pub struct Off;

impl Exporter for Off {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = Surface::of(shape);
        let positions = &shape.points().positions;
        writeln!(out, "OFF")?;
        writeln!(out, "# walpha: {}", shape.options().alpha)?;
        write!(out, "{}", stated::line("#", shape.coordinates()))?;
        let facets = surface.regular.len() + surface.singular.len();
        writeln!(out, "{} {facets} 0", surface.vertices.len())?;
        for &v in &surface.vertices {
            let [x, y, z] = positions[v as usize];
            writeln!(out, "{x} {y} {z}")?;
        }
        for [a, b, c] in &surface.regular {
            writeln!(out, "3 {a} {b} {c} 225 220 210")?;
        }
        for [a, b, c] in &surface.singular {
            writeln!(out, "3 {a} {b} {c} 230 130 40")?;
        }
        Ok(())
    }
}
