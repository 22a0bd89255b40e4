use std::io::{self, Write};

use walpha_shape::SinglePrecision;
use walpha_volume::{Coordinates, annotation};

use super::exporter::stated_offset;
use super::ply::Row;
use super::stl;
use super::vtp::cells;
use super::vtu::{Appended, bytes};

/// A closed mesh of triangles, each with the number of the thing that it is of: the surface of a union of balls.
#[derive(Debug)]
pub struct LabelledMesh<'a> {
    /// The vertices.
    pub positions: &'a [[f64; 3]],
    /// The triangles, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// What the numbers of the triangles are called in files.
    pub label: &'static str,
    /// A number for each triangle.
    pub labels: &'a [u32],
    /// A colour for each triangle, red, green and blue, if there are colours.
    pub colours: Option<Vec<[u8; 3]>>,
    /// What the mesh is, for comments.
    pub about: String,
    /// The name of the input.
    pub input: &'a str,
    /// Which way the axes run, and the unit.
    pub coordinates: Coordinates,
}

impl LabelledMesh<'_> {
    /// The extensions of the formats.
    pub const EXTENSIONS: [&'static str; 3] = ["ply", "stl", "vtp"];

    /// Writes the mesh as PLY or VTP, with numbers and colours of triangles, or as STL, which has neither.
    ///
    /// # Errors
    /// Errors of `out`.
    ///
    /// # Panics
    /// If the format is not one of [`Self::EXTENSIONS`].
    pub fn write(&self, extension: &str, out: &mut dyn Write) -> io::Result<()> {
        match extension {
            "ply" => self.write_ply(out),
            "stl" => self.write_stl(out),
            "vtp" => self.write_vtp(out),
            _ => panic!("{extension} is not among the formats"),
        }
    }

    /// Binary PLY with coordinates as doubles. Faces have their number and, if there are colours, red, green and blue.
    fn write_ply(&self, out: &mut dyn Write) -> io::Result<()> {
        let colours = if self.colours.is_some() {
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        } else {
            ""
        };
        write!(
            out,
            "ply\nformat binary_little_endian 1.0\ncomment walpha: {}\n{}element vertex {}\n\
             property double x\nproperty double y\nproperty double z\nelement face {}\n\
             property list uchar uint vertex_indices\nproperty uint {}\n{colours}end_header\n",
            self.about,
            annotation::line("comment", self.coordinates),
            self.positions.len(),
            self.triangles.len(),
            self.label,
        )?;
        let mut row = Row::binary(out);
        for &x in self.positions.as_flattened() {
            row.put(x, f64::to_le_bytes)?;
        }
        for (i, (triangle, &label)) in self.triangles.iter().zip(self.labels).enumerate() {
            row.put(3u8, u8::to_le_bytes)?;
            for &v in triangle.iter().chain([&label]) {
                row.put(v, u32::to_le_bytes)?;
            }
            for part in self.colours.iter().flat_map(|colours| colours[i]) {
                row.put(part, u8::to_le_bytes)?;
            }
        }
        Ok(())
    }

    /// VTK's polygons; cell data are the numbers and `colour`. Field data are `made_by`, `input` and the unit.
    fn write_vtp(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut file = Appended::default();
        write!(
            file.xml,
            "<?xml version=\"1.0\"?>\n<!-- walpha: {} -->\n\
             <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <PolyData>\n<FieldData>\n",
            self.about,
        )?;
        let made_by = format!("walpha {}", env!("CARGO_PKG_VERSION"));
        let texts = [("made_by", made_by.as_str()), ("input", self.input)];
        for (name, text) in texts.into_iter().chain(annotation::pairs(self.coordinates)) {
            file.text(name, text, true)?;
        }
        write!(
            file.xml,
            "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{}\">\n<CellData>\n",
            self.positions.len(),
            self.triangles.len(),
        )?;
        let labels = bytes(self.labels.iter().map(|label| label.to_le_bytes()));
        file.array("UInt32", self.label, 1, labels)?;
        if let Some(colours) = &self.colours {
            file.array("UInt8", "colour", 3, colours.as_flattened().to_vec())?;
        }
        write!(file.xml, "</CellData>\n<Points>\n")?;
        let coordinates = self.positions.as_flattened().iter();
        file.array("Float64", "Points", 3, bytes(coordinates.map(|x| x.to_le_bytes())))?;
        writeln!(file.xml, "</Points>")?;
        cells(&mut file, "Polys", 3, self.triangles.as_flattened())?;
        write!(file.xml, "</Piece>\n</PolyData>\n")?;
        file.end(out)
    }

    /// Binary STL in single precision, with an offset where coordinates need one.
    fn write_stl(&self, out: &mut dyn Write) -> io::Result<()> {
        let edges = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let single = SinglePrecision::of(self.positions, edges);
        let offset = stated_offset(&single);
        let offset = offset.map_or(", surface of balls".into(), |offset| format!(" {offset}"));
        let about = format!("walpha{offset}{}", annotation::comment(self.coordinates));
        out.write_all(&stl::head(&about)?)?;
        stl::facets(self.positions, self.triangles, &single, out)
    }
}
