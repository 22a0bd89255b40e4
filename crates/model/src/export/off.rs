use std::io::{self, Write};

use super::about::about;
use super::{ExportOptions, Exporter, Needs};
use walpha_shape::AlphaShape;
use walpha_volume::annotation;

/// Writes OFF, the object file format of Geomview: boundary facets; with groups, regular facets are light and singular ones
/// orange. The format has no edges or isolated points, so singular edges and vertices are left out.
#[derive(Clone, Debug, Default)]
pub struct Off(pub ExportOptions);

impl Exporter for Off {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = self.0.surface(shape);
        writeln!(out, "OFF")?;
        writeln!(out, "# walpha: {}", about(shape))?;
        write!(out, "{}", annotation::line("#", shape.coordinates()))?;
        let facets = surface.regular.len() + surface.singular.len();
        writeln!(out, "{} {facets} 0", surface.vertex_count())?;
        for [x, y, z] in surface.positions(shape.points().positions()) {
            writeln!(out, "{x} {y} {z}")?;
        }
        for (facets, colour) in
            [(&surface.regular, " 225 220 210"), (&surface.singular, " 230 130 40")]
        {
            let colour = if self.0.groups { colour } else { "" };
            for [a, b, c] in facets {
                writeln!(out, "3 {a} {b} {c}{colour}")?;
            }
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        self.0.needs(Needs::Facet)
    }
}
