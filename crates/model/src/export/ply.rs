use std::borrow::Cow;
use std::io::{self, Write};

use walpha_base::advice::Advice;
use walpha_base::shown::counted;

use super::about::about;
use super::{ExportOptions, Exporter, Needs, colour};
use walpha_points::colours::scan_colours;
use walpha_shape::{AlphaShape, Class, Surface};
use walpha_volume::annotation;

/// Writes PLY: vertices of the boundary with weight, input index and, if known, value and colour (red, green, blue), and
/// further columns of the points ([`ExportOptions::columns`]); facets. The colour is that of the point, if columns have one, or else that of
/// its value.
/// With groups, facets have their class (2 regular, 3 singular), their component and, if known and not of a solid, the
/// [sheets](walpha_shape::Sheets) in front and behind, −1 for none. Coordinates are doubles. The file is binary little-endian, or
/// text.
///
/// Singular edges are left out, as most programs refuse a PLY file with edges. Groups are optional because meshio
/// cannot read properties of facets.
#[derive(Clone, Debug, Default)]
pub struct Ply(pub ExportOptions);

impl Exporter for Ply {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let Self(options) = self;
        let surface = options.surface(shape);
        let sheets = shape.sheets().filter(|_| options.groups && !options.solid);
        let sheets: Option<Vec<_>> = sheets.map(|sheets| sheets.sides().collect());
        let colours = scan_colours(&options.columns)
            .filter(|of_points| of_points.len() == shape.points().len());
        let is_valued = shape.points().values().is_some();
        let is_coloured = is_valued || colours.is_some();
        let columns = options.columns_of(shape, &OWN);
        write!(
            out,
            "ply\nformat {} 1.0\ncomment walpha: {}\n{}element vertex {}\n\
             property double x\nproperty double y\nproperty double z\nproperty double weight\n{}{}\
             property uint index\n{}element face {}\nproperty list uchar uint vertex_indices\n{}{}end_header\n",
            if options.ascii { "ascii" } else { "binary_little_endian" },
            about(shape),
            annotation::line("comment", shape.coordinates()),
            surface.vertex_count(),
            if is_valued { "property double value\n" } else { "" },
            if is_coloured { COLOURED } else { "" },
            columns.iter().map(|(name, _)| format!("property double {name}\n")).collect::<String>(),
            surface.regular.len() + surface.singular.len(),
            if options.groups { "property uchar class\nproperty uint component\n" } else { "" },
            if sheets.is_some() { "property int sheet\nproperty int sheet_behind\n" } else { "" },
        )?;
        let mut row = Row { ascii: options.ascii, out, started: false };
        vertices(&mut row, shape, &surface, colours, &columns)?;
        let (components, indices) =
            (shape.component_numbers(), surface.indices().collect::<Vec<_>>());
        for (i, facet) in surface.facets().enumerate() {
            row.put(3u8, u8::to_le_bytes)?;
            for &v in facet {
                row.put(v, u32::to_le_bytes)?;
            }
            if options.groups {
                let regular = i < surface.regular.len();
                let class = if regular { Class::Regular } else { Class::Singular };
                row.put(class as u8, u8::to_le_bytes)?;
                let component = components[indices[facet[0] as usize] as usize];
                row.put(component, u32::to_le_bytes)?;
            }
            for &sheet in sheets.iter().flat_map(|sheets| &sheets[i]) {
                row.put(sheet, i32::to_le_bytes)?;
            }
            row.end()?;
        }
        Ok(())
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        // A solid has no singular edges.
        let edges = shape.complex().edges.of(Class::Singular).count();
        (edges > 0 && !self.0.solid).then(|| {
            let edges = counted(edges as u64, "singular edge");
            format!("left out: {edges}, as most programs refuse a PLY file with edges; OBJ, GLB and VTP have them").into()
        })
    }

    fn needs(&self) -> Needs {
        self.0.needs(Needs::Facet)
    }
}

/// The properties of a vertex with a colour.
const COLOURED: &str = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

/// The names of properties of vertices that are not those of further columns.
const OWN: [&str; 9] = ["x", "y", "z", "weight", "value", "red", "green", "blue", "index"];

fn vertices(
    row: &mut Row<'_>,
    shape: &AlphaShape,
    surface: &Surface,
    of_points: Option<Vec<[u8; 3]>>,
    columns: &[(String, Cow<'_, [f64]>)],
) -> io::Result<()> {
    let points = shape.points();
    let values: Option<Vec<f64>> = points.values().map(|v| surface.numbers(v).collect());
    let colours = match of_points {
        Some(colours) => Some(surface.indices().map(|index| colours[index as usize]).collect()),
        None => values.as_deref().map(colour::bytes),
    };
    let places = surface.positions(points.positions()).zip(surface.numbers(points.weights()));
    for (i, ((place, weight), index)) in places.zip(surface.indices()).enumerate() {
        for number in [place[0], place[1], place[2], weight] {
            row.put(number, f64::to_le_bytes)?;
        }
        if let Some(values) = &values {
            row.put(values[i], f64::to_le_bytes)?;
        }
        for part in colours.iter().flat_map(|colours| colours[i]) {
            row.put(part, u8::to_le_bytes)?;
        }
        row.put(index, u32::to_le_bytes)?;
        for (_, numbers) in columns {
            row.put(numbers[index as usize], f64::to_le_bytes)?;
        }
        row.end()?;
    }
    Ok(())
}

/// The numbers of one element, as text on a line or as bytes.
pub(super) struct Row<'a> {
    ascii: bool,
    out: &'a mut dyn Write,
    started: bool,
}

impl<'a> Row<'a> {
    /// Bytes.
    pub(super) fn binary(out: &'a mut dyn Write) -> Self {
        Self { ascii: false, out, started: false }
    }
}

impl Row<'_> {
    pub(super) fn put<T: std::fmt::Display + Copy, const B: usize>(
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
