use std::io::{self, Write};

use super::{Exporter, stated};
use crate::shape::{AlphaShape, Class, Surface};

/// PLY: vertices of the boundary with weight, value and input index; facets with their class
/// (2 regular, 3 singular), their component and, where known, the [sheets](crate::shape::Sheets) in
/// front and behind, −1 for none; singular edges. Coordinates are doubles. Binary little-endian, or
/// text.
#[derive(Clone, Copy, Debug)]
pub struct Ply {
    /// Text instead of binary.
    pub ascii: bool,
}

impl Exporter for Ply {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = Surface::of(shape);
        let points = shape.points();
        let sheets: Option<Vec<_>> = shape.sheets().map(|sheets| sheets.sides().collect());
        let format = if self.ascii { "ascii" } else { "binary_little_endian" };
        write!(
            out,
            "ply\nformat {format} 1.0\ncomment walpha: {}\n{}element vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty double weight\n",
            shape.options().alpha,
            stated::line("comment", shape.coordinates()),
            surface.vertices.len(),
        )?;
        if points.values.is_some() {
            writeln!(out, "property double value")?;
        }
        write!(
            out,
            "property uint index\nelement face {}\nproperty list uchar uint vertex_indices\n\
             property uchar class\nproperty uint component\n{}element edge {}\n\
             property uint vertex1\nproperty uint vertex2\nend_header\n",
            surface.regular.len() + surface.singular.len(),
            if sheets.is_some() { "property int sheet\nproperty int sheet_behind\n" } else { "" },
            surface.edges.len(),
        )?;

        let mut row = Row { ascii: self.ascii, out, started: false };
        for &v in &surface.vertices {
            let i = v as usize;
            for coordinate in points.positions[i] {
                row.put(coordinate, f64::to_le_bytes)?;
            }
            row.put(points.weights[i], f64::to_le_bytes)?;
            if let Some(values) = &points.values {
                row.put(values[i], f64::to_le_bytes)?;
            }
            row.put(v, u32::to_le_bytes)?;
            row.end()?;
        }
        let (components, vertices) = (shape.component_numbers(), &surface.vertices);
        for (i, facet) in surface.facets().enumerate() {
            row.put(3u8, u8::to_le_bytes)?;
            for &v in facet {
                row.put(v, u32::to_le_bytes)?;
            }
            let regular = i < surface.regular.len();
            let class = if regular { Class::Regular } else { Class::Singular };
            row.put(class as u8, u8::to_le_bytes)?;
            row.put(components[vertices[facet[0] as usize] as usize], u32::to_le_bytes)?;
            for &sheet in sheets.iter().flat_map(|sheets| &sheets[i]) {
                row.put(sheet, i32::to_le_bytes)?;
            }
            row.end()?;
        }
        for edge in &surface.edges {
            for &v in edge {
                row.put(v, u32::to_le_bytes)?;
            }
            row.end()?;
        }
        Ok(())
    }
}

/// Numbers of one element, as text on a line or as bytes.
struct Row<'a> {
    ascii: bool,
    out: &'a mut dyn Write,
    started: bool,
}

impl Row<'_> {
    fn put<T: std::fmt::Display + Copy, const B: usize>(
        &mut self,
        value: T,
        bytes: impl Fn(T) -> [u8; B],
    ) -> io::Result<()> {
        if !self.ascii {
            return self.out.write_all(&bytes(value));
        }
        let separator = if std::mem::replace(&mut self.started, true) { " " } else { "" };
        write!(self.out, "{separator}{value}")
    }

    fn end(&mut self) -> io::Result<()> {
        self.started = false;
        if self.ascii { writeln!(self.out) } else { Ok(()) }
    }
}
