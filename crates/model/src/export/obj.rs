use std::io::{self, Write};

use super::about::about;
use super::{ExportOptions, Exporter, Needs};
use walpha_shape::AlphaShape;
use walpha_volume::annotation;

/// Writes Wavefront OBJ: facets, regular ones first, singular edges and singular vertices; ungrouped, or on request in the groups
/// `regular`, `singular`, `edges` and `points`. Numbering starts at 1.
#[derive(Clone, Debug, Default)]
pub struct Obj(pub ExportOptions);

impl Exporter for Obj {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = self.0.surface(shape);
        writeln!(out, "# walpha: {}", about(shape))?;
        write!(out, "{}", annotation::line("#", shape.coordinates()))?;
        for [x, y, z] in surface.positions(shape.points().positions()) {
            writeln!(out, "v {x} {y} {z}")?;
        }
        let name = |group| self.0.groups.then_some(group);
        elements(out, name("regular"), "f", &surface.regular)?;
        elements(out, name("singular"), "f", &surface.singular)?;
        elements(out, name("edges"), "l", &surface.edges)?;
        let points: Vec<[u32; 1]> = surface.points.iter().map(|&v| [v]).collect();
        elements(out, name("points"), "p", &points)
    }

    fn needs(&self) -> Needs {
        self.0.needs(Needs::FacetOrLine)
    }
}

fn elements<const N: usize>(
    out: &mut dyn Write,
    group: Option<&str>,
    element: &str,
    rows: &[[u32; N]],
) -> io::Result<()> {
    if let (Some(group), false) = (group, rows.is_empty()) {
        writeln!(out, "g {group}")?;
    }
    for row in rows {
        write!(out, "{element}")?;
        for v in row {
            write!(out, " {}", v + 1)?;
        }
        writeln!(out)?;
    }
    Ok(())
}
