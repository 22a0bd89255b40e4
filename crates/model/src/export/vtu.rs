use std::borrow::Cow;
use std::io::{self, Write};

use super::about::solid;
use super::{ExportOptions, Exporter};
use walpha_shape::{Alpha, AlphaShape, Complex, Simplices};
use walpha_volume::{Coordinates, annotation};

/// Writes VTU, VTK's unstructured grid: every simplex of the shape, vertices first, with its class as cell data (1 interior, 2
/// regular, 3 singular); `weight`, `value`, `input_index` and further columns as
/// point data. Field data record how it was made: `alpha` (a squared
/// length), `alpha_radius` unless α is negative, `class_legend`, `made_by` (program and version) and, if known, `input` and
/// `unit`, the unit of length; `solid`, what is filled, of a solid, which has no α; and `periodic` of a periodic box, which is
/// laid out in space. Texts are arrays of UTF-8 bytes, as meshio refuses files with strings. Arrays are appended raw,
/// little-endian, with 64-bit sizes.
///
/// Exterior simplices of the complex, if it has any, are written as class 0.
#[derive(Clone, Debug, Default)]
pub struct Vtu(pub ExportOptions);

impl Exporter for Vtu {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        match shape.options().periodic {
            // No copies are needed where nothing crosses the sides.
            Some(_) => self.write_grid(&shape.unwrapped(), true, out),
            None => self.encode(shape, out),
        }
    }

    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        self.write_grid(shape, !shape.copies().is_empty(), out)
    }
}

impl Vtu {
    fn write_grid(
        &self,
        shape: &AlphaShape,
        laid_out: bool,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let vertices: Vec<u32> = shape.complex().vertices.rows().iter().map(|&[v]| v).collect();
        let made = Provenance { laid_out, ..Provenance::of(shape, &self.0) };
        write_grid(shape.complex(), &vertices, &PointData::of(shape, &self.0), &made, out)
    }
}

/// A record of how a shape was made, for the field data of files.
pub(crate) struct Provenance<'a> {
    /// α as a squared length, like the weights, whichever balls the shape is made of.
    pub alpha: Alpha,
    pub coordinates: Coordinates,
    pub input: Option<&'a str>,
    /// What the shape is, if it is a solid of labels or inside an isosurface, which has no α.
    pub solid: Option<String>,
    /// Whether the shape is that of a periodic box, laid out in space.
    pub laid_out: bool,
}

impl<'a> Provenance<'a> {
    /// The record for a shape that was made from the input in the options.
    pub(crate) fn of(shape: &AlphaShape, options: &'a ExportOptions) -> Self {
        let (alpha, coordinates) = (shape.power_alpha(), shape.coordinates());
        let (input, laid_out) = (options.input.as_deref(), !shape.copies().is_empty());
        Self { alpha, coordinates, input, solid: solid(shape), laid_out }
    }

    /// Describes the shape: by `alpha`, a text about α, or as a solid of labels.
    pub(super) fn about(&self, alpha: String) -> String {
        self.solid.clone().unwrap_or(alpha)
    }
}

/// Data of the points, by the numbers that corners of simplices refer to.
pub(crate) struct PointData<'a> {
    pub positions: &'a [[f64; 3]],
    pub weights: &'a [f64],
    pub values: Option<&'a [f64]>,
    /// The indices of the points in a volume, if they are numbered within a block; otherwise their numbers are indices of the
    /// input.
    pub voxels: Option<&'a [u64]>,
    /// Further columns, by name.
    pub columns: Vec<(String, Cow<'a, [f64]>)>,
}

/// The names of point data that are not those of further columns.
const OWN: [&str; 4] = ["weight", "value", "input_index", "Points"];

impl<'a> PointData<'a> {
    /// The data of a shape's points.
    pub(crate) fn of(shape: &'a AlphaShape, options: &'a ExportOptions) -> Self {
        let points = shape.points();
        Self {
            positions: points.positions(),
            weights: shape.power_weights(),
            values: points.values(),
            voxels: None,
            columns: options.columns_of(shape, &OWN),
        }
    }

    /// Writes the array that identifies the points: `voxel` or `input_index`.
    pub(super) fn write_ids(
        &self,
        file: &mut Appended,
        vertices: impl Iterator<Item = u32>,
    ) -> io::Result<()> {
        let Some(voxels) = self.voxels else {
            let indices = bytes(vertices.map(u32::to_le_bytes));
            return file.array("UInt32", "input_index", 1, indices);
        };
        let voxels = bytes(vertices.map(|v| voxels[v as usize].to_le_bytes()));
        file.array("Int64", "voxel", 1, voxels)
    }
}

/// Writes simplices of all dimensions. `vertices` contains all their corners, ascending.
pub(crate) fn write_grid(
    complex: &Complex,
    vertices: &[u32],
    corners: &PointData<'_>,
    made: &Provenance<'_>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let number = |v: u32| vertices.binary_search(&v).expect("all corners are there");
    let mut grid = Grid::of(complex);
    grid.push(&complex.vertices, number);
    grid.push(&complex.edges, number);
    grid.push(&complex.facets, number);
    grid.push(&complex.cells, number);

    let of =
        |per_point: &[f64]| bytes(vertices.iter().map(|&v| per_point[v as usize].to_le_bytes()));
    let mut file = Appended::default();
    file.begin(&format!("<!-- walpha: {} -->\n", made.about(made.alpha.to_string())))?;
    file.field_data(made, false)?;
    write!(
        file.xml,
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
        vertices.len(),
        grid.types.len(),
    )?;
    file.array("Float64", "weight", 1, of(corners.weights))?;
    if let Some(values) = corners.values {
        file.array("Float64", "value", 1, of(values))?;
    }
    corners.write_ids(&mut file, vertices.iter().copied())?;
    for (name, numbers) in &corners.columns {
        file.array("Float64", name, 1, of(numbers))?;
    }
    write!(file.xml, "</PointData>\n<CellData>\n")?;
    file.array("UInt8", "class", 1, grid.classes)?;
    writeln!(file.xml, "</CellData>")?;
    let positions = vertices.iter().map(|&v| corners.positions[v as usize]);
    file.grid(positions, grid.connectivity, grid.offsets, grid.types)?;
    file.end(out)
}

/// VTK's codes for a vertex, a line, a triangle and a tetrahedron: simplices by dimension.
pub(super) const VTK_TYPES: [u8; 4] = [1, 3, 5, 10];

struct Grid {
    connectivity: Ids,
    offsets: Ids,
    types: Vec<u8>,
    classes: Vec<u8>,
    /// The number of corners so far, which is the next offset.
    end: usize,
}

impl Grid {
    /// An empty grid with ids wide enough for a complex.
    fn of(complex: &Complex) -> Self {
        let Complex { cells, facets, edges, vertices } = complex;
        let corners = 4 * cells.len() + 3 * facets.len() + 2 * edges.len() + vertices.len();
        let (connectivity, offsets) = (Ids::up_to(corners), Ids::up_to(corners));
        Self { connectivity, offsets, types: Vec::new(), classes: Vec::new(), end: 0 }
    }

    fn push<const N: usize>(&mut self, simplices: &Simplices<N>, number: impl Fn(u32) -> usize) {
        for (row, class) in simplices.iter() {
            row.iter().for_each(|&v| self.connectivity.push(number(v)));
            self.end += N;
            self.offsets.push(self.end);
            self.types.push(VTK_TYPES[N - 1]);
            self.classes.push(class as u8);
        }
    }
}

/// Indices and offsets in VTK: 32-bit numbers if all fit, which halves the size of most files.
pub(super) struct Ids {
    is_wide: bool,
    bytes: Vec<u8>,
}

impl Ids {
    /// An empty list for ids up to `most`.
    pub(super) fn up_to(most: usize) -> Self {
        Self { is_wide: i32::try_from(most).is_err(), bytes: Vec::new() }
    }

    pub(super) fn push(&mut self, id: usize) {
        if self.is_wide {
            self.bytes.extend((id as i64).to_le_bytes());
        } else {
            self.bytes.extend((id as i32).to_le_bytes());
        }
    }
}

/// The XML of the file, and the appended arrays that it refers to.
#[derive(Default)]
pub(super) struct Appended {
    pub xml: Vec<u8>,
    pub data: Vec<u8>,
}

/// The meaning of the numbers of `class`.
const LEGEND: &str = "0 exterior, 1 interior, 2 regular, 3 singular";

impl Appended {
    /// Begins an unstructured grid; `comment` is XML before it.
    pub(super) fn begin(&mut self, comment: &str) -> io::Result<()> {
        write!(
            self.xml,
            "<?xml version=\"1.0\"?>\n{comment}\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <UnstructuredGrid>\n",
        )
    }

    /// Writes the points and cells of the only piece of an unstructured grid, whose data were written before.
    pub(super) fn grid(
        &mut self,
        positions: impl Iterator<Item = [f64; 3]>,
        connectivity: Ids,
        offsets: Ids,
        types: Vec<u8>,
    ) -> io::Result<()> {
        writeln!(self.xml, "<Points>")?;
        self.array("Float64", "Points", 3, bytes(positions.flatten().map(f64::to_le_bytes)))?;
        write!(self.xml, "</Points>\n<Cells>\n")?;
        self.ids("connectivity", connectivity)?;
        self.ids("offsets", offsets)?;
        self.array("UInt8", "types", 1, types)?;
        write!(self.xml, "</Cells>\n</Piece>\n</UnstructuredGrid>\n")
    }

    /// Writes the file.
    pub(super) fn end(mut self, out: &mut dyn Write) -> io::Result<()> {
        write!(self.xml, "<AppendedData encoding=\"raw\">\n_")?;
        out.write_all(&self.xml)?;
        out.write_all(&self.data)?;
        write!(out, "\n</AppendedData>\n</VTKFile>\n")
    }

    /// Writes the record of how the shape was made, with texts as strings or as arrays of bytes.
    pub(super) fn field_data(&mut self, made: &Provenance<'_>, as_strings: bool) -> io::Result<()> {
        let alpha = made.alpha;
        writeln!(self.xml, "<FieldData>")?;
        for (name, number) in [("alpha", Some(alpha.squared())), ("alpha_radius", alpha.radius())] {
            if let Some(number) = number.filter(|_| made.solid.is_none()) {
                // The number is binary, as VTK cannot read "inf".
                self.field("DataArray", "Float64", name, 1, &number.to_le_bytes())?;
            }
        }
        let made_by = format!("walpha {}", env!("CARGO_PKG_VERSION"));
        let texts = [
            ("made_by", Some(made_by.as_str())),
            ("class_legend", Some(LEGEND)),
            ("input", made.input),
            ("solid", made.solid.as_deref()),
            ("periodic", made.laid_out.then_some("laid out in space, with copies of points")),
        ];
        let texts = texts.into_iter().filter_map(|(name, text)| Some((name, text?)));
        for (name, text) in texts.chain(annotation::pairs(made.coordinates)) {
            self.text(name, text, as_strings)?;
        }
        writeln!(self.xml, "</FieldData>")
    }

    /// Writes a text of field data, as a string or as an array of bytes.
    pub(super) fn text(&mut self, name: &str, text: &str, as_string: bool) -> io::Result<()> {
        // A zero byte ends the string, so the text must not contain one.
        let text = text.replace('\0', " ");
        if as_string {
            self.field("Array", "String", name, 1, (text + "\0").as_bytes())
        } else {
            self.field("DataArray", "UInt8", name, text.len(), text.as_bytes())
        }
    }

    /// Writes an array of field data.
    fn field(
        &mut self,
        element: &str,
        kind: &str,
        name: &str,
        tuples: usize,
        bytes: &[u8],
    ) -> io::Result<()> {
        writeln!(
            self.xml,
            "<{element} type=\"{kind}\" Name=\"{name}\" NumberOfTuples=\"{tuples}\" \
             format=\"appended\" offset=\"{}\"/>",
            self.data.len()
        )?;
        self.append(bytes);
        Ok(())
    }

    fn append(&mut self, bytes: &[u8]) {
        self.data.extend((bytes.len() as u64).to_le_bytes());
        self.data.extend(bytes);
    }

    pub(super) fn ids(&mut self, name: &str, ids: Ids) -> io::Result<()> {
        self.array(if ids.is_wide { "Int64" } else { "Int32" }, name, 1, ids.bytes)
    }

    pub(super) fn array(
        &mut self,
        kind: &str,
        name: &str,
        components: u8,
        bytes: Vec<u8>,
    ) -> io::Result<()> {
        writeln!(
            self.xml,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>",
            self.data.len()
        )?;
        self.append(&bytes);
        Ok(())
    }
}

pub(super) fn bytes<const B: usize>(values: impl Iterator<Item = [u8; B]>) -> Vec<u8> {
    values.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_as_wide_as_they_must_be() {
        for (most, width) in [(0, 4), (i32::MAX as usize, 4), (i32::MAX as usize + 1, 8)] {
            let mut ids = Ids::up_to(most);
            ids.push(most);
            assert_eq!(ids.bytes, (most as u64).to_le_bytes()[..width]);
        }
    }
}
