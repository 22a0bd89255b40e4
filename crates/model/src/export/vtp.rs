use std::io::{self, Write};

use super::vtu::{Appended, Ids, PointData, Provenance, bytes};
use super::{ExportOptions, Exporter, Needs};
use walpha_shape::{AlphaShape, Class, Sheets, Surface};
use walpha_volume::annotation;

/// Writes VTP, VTK's polygons: the boundary, singular edges and singular vertices. Cell data are their `class` (2 regular, 3
/// singular), the `component` of the shape that they belong to and, if known, the [sheets](walpha_shape::Sheets) in front
/// (`sheet`) and behind (`sheet_behind`), −1 for none; point data are `weight`, `value`, `input_index` and further columns. Field data are those
/// of [`Vtu`](super::Vtu), with texts as strings. Solids have no sheets. Arrays are appended raw, little-endian, with 64-bit
/// sizes.
#[derive(Clone, Debug, Default)]
pub struct Vtp(pub ExportOptions);

impl Exporter for Vtp {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let membership = Membership {
            components: &shape.component_numbers(),
            sheets: shape.sheets().filter(|_| !self.0.solid),
        };
        let made = Provenance::of(shape, &self.0);
        write_surface(
            &self.0.surface(shape),
            &PointData::of(shape, &self.0),
            &membership,
            &made,
            out,
        )
    }

    fn needs(&self) -> Needs {
        self.0.needs(Needs::FacetOrLine)
    }
}

/// The components and sheets of a surface.
pub(crate) struct Membership<'a> {
    /// The component number of each point.
    pub components: &'a [u32],
    /// The sheets of its facets and edges.
    pub sheets: Option<&'a Sheets>,
}

/// Writes a surface.
pub(crate) fn write_surface(
    surface: &Surface,
    corners: &PointData<'_>,
    membership: &Membership<'_>,
    made: &Provenance<'_>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let facets = surface.regular.len() + surface.singular.len();
    let mut file = Appended::default();
    write!(
        file.xml,
        "<?xml version=\"1.0\"?>\n<!-- walpha: {} -->\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <PolyData>\n",
        made.about(annotation::alpha(made.alpha)),
    )?;
    file.field_data(made, true)?;
    write!(
        file.xml,
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{facets}\">\n<PointData>\n",
        surface.vertex_count(),
        surface.points.len(),
        surface.edges.len(),
    )?;
    let of = |column: &[f64]| bytes(surface.numbers(column).map(f64::to_le_bytes));
    file.array("Float64", "weight", 1, of(corners.weights))?;
    if let Some(values) = corners.values {
        file.array("Float64", "value", 1, of(values))?;
    }
    corners.write_ids(&mut file, surface.indices())?;
    for (name, numbers) in &corners.columns {
        file.array("Float64", name, 1, of(numbers))?;
    }
    write!(file.xml, "</PointData>\n<CellData>\n")?;
    cell_data(&mut file, surface, membership)?;
    write!(file.xml, "</CellData>\n<Points>\n")?;
    let positions = surface.positions(corners.positions).flatten();
    file.array("Float64", "Points", 3, bytes(positions.map(f64::to_le_bytes)))?;
    writeln!(file.xml, "</Points>")?;
    cells(&mut file, "Verts", 1, &surface.points)?;
    cells(&mut file, "Lines", 2, surface.edges.as_flattened())?;
    let facets: Vec<u32> = surface.facets().flatten().copied().collect();
    cells(&mut file, "Polys", 3, &facets)?;
    write!(file.xml, "</Piece>\n</PolyData>\n")?;
    file.end(out)
}

/// Writes class, component and sheets of each cell.
fn cell_data(
    file: &mut Appended,
    surface: &Surface,
    membership: &Membership<'_>,
) -> io::Result<()> {
    let vertices: Vec<u32> = surface.indices().collect();
    let facets = surface.regular.len() + surface.singular.len();
    // VTK counts cells in this order: vertices, lines, polygons.
    let thin = surface.points.len() + surface.edges.len();
    let mut classes = vec![Class::Singular as u8; thin];
    classes.resize(thin + surface.regular.len(), Class::Regular as u8);
    classes.resize(thin + facets, Class::Singular as u8);
    file.array("UInt8", "class", 1, classes)?;
    let firsts = (surface.points.iter().copied())
        .chain(surface.edges.iter().map(|edge| edge[0]))
        .chain(surface.facets().map(|facet| facet[0]));
    let component = |v: u32| membership.components[vertices[v as usize] as usize].to_le_bytes();
    file.array("UInt32", "component", 1, bytes(firsts.map(component)))?;
    if let Some(sheets) = membership.sheets {
        let none = surface.points.iter().map(|_| [Sheets::NONE; 2]);
        let edges = sheets.edges.iter().map(|&sheet| [sheet as i32, Sheets::NONE]);
        let sides: Vec<_> = none.chain(edges).chain(sheets.sides()).collect();
        for (k, name) in ["sheet", "sheet_behind"].into_iter().enumerate() {
            file.array("Int32", name, 1, bytes(sides.iter().map(|side| side[k].to_le_bytes())))?;
        }
    }
    Ok(())
}

/// Writes cells of `size` vertices each.
pub(super) fn cells(
    file: &mut Appended,
    name: &str,
    size: usize,
    vertices: &[u32],
) -> io::Result<()> {
    writeln!(file.xml, "<{name}>")?;
    let most = vertices.len().max(vertices.iter().max().map_or(0, |&v| v as usize));
    let (mut corners, mut ends) = (Ids::up_to(most), Ids::up_to(most));
    vertices.iter().for_each(|&v| corners.push(v as usize));
    (1..=vertices.len() / size).for_each(|cell| ends.push(cell * size));
    file.ids("connectivity", corners)?;
    file.ids("offsets", ends)?;
    writeln!(file.xml, "</{name}>")
}
