use std::io::{self, Write};

use super::{ExportOptions, Exporter, colour};
use crate::shape::{AlphaShape, Class};

/// PLY: vertices of the boundary with weight, input index and, where known, value and the colour
/// (red, green, blue) that it has between the least and the most; facets with their class
/// (2 regular, 3 singular), their component and, where known, the [sheets](crate::shape::Sheets) in
/// front and behind, −1 for none; singular edges. Coordinates are doubles. Binary little-endian, or
/// text. Of a solid there are no sheets.
#[derive(Clone, Debug, Default)]
pub struct Ply(pub ExportOptions);

impl Exporter for Ply {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let Self(options) = self;
        let surface = options.surface(shape);
        let points = shape.points();
        let sheets = shape.sheets().filter(|_| !options.solid);
        let sheets: Option<Vec<_>> = sheets.map(|sheets| sheets.sides().collect());
        let values: Option<Vec<f64>> = points.values.as_ref().map(|v| surface.numbers(v).collect());
        let format = if options.ascii { "ascii" } else { "binary_little_endian" };
        write!(
            out,
            "ply\nformat {format} 1.0\ncomment walpha: {}\nelement vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty double weight\n",
            shape.options().alpha,
            surface.vertex_count(),
        )?;
        if values.is_some() {
            out.write_all(
                b"property double value\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
            )?;
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

        let mut row = Row { ascii: options.ascii, out, started: false };
        let colours = values.as_deref().map(colour::bytes);
        let vertices: Vec<u32> = surface.indices().collect();
        let places = surface.positions(&points.positions).zip(surface.numbers(&points.weights));
        for (i, (place, weight)) in places.enumerate() {
            for number in [place[0], place[1], place[2], weight] {
                row.put(number, f64::to_le_bytes)?;
            }
            if let (Some(values), Some(colours)) = (&values, &colours) {
                row.put(values[i], f64::to_le_bytes)?;
                for part in colours[i] {
                    row.put(part, u8::to_le_bytes)?;
                }
            }
            row.put(vertices[i], u32::to_le_bytes)?;
            row.end()?;
        }
        let components = shape.component_numbers();
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
