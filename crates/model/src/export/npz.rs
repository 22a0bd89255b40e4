use std::io::{self, Cursor, Seek, Write};

use walpha_base::npy::{self, Element};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::Exporter;
use super::claim::point_copies;
use walpha_shape::{AlphaShape, Class, NO_COMPONENT, Torus, Voxels};

/// Writes NPZ, `NumPy`'s archive of arrays: the complex with its points, power weights and α, in the
/// [`schema`](walpha_check::schema) that `walpha check` and `walpha compare` read, as in [`Json`](super::Json). If known, it also
/// contains: `values` of all points; `components` (n), the component number of each point, −1 for points outside the shape;
/// `boundary_sheets` (k×2), the [sheets](walpha_shape::Sheets) in front of and behind the regular facets, followed by the
/// singular ones, −1 for none.
#[derive(Clone, Copy, Debug)]
pub struct Npz;

impl Exporter for Npz {
    fn knows_torus(&self) -> bool {
        true
    }

    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let (points, complex) = (shape.points(), shape.complex());
        let mut archive = Archive::new(ZipWriter::new(Cursor::new(Vec::new())));
        let copies = point_copies(shape);
        let own = copies.as_ref().map_or(points.len(), |_| shape.own_points());
        archive.rows("points", &points.positions()[..own])?;
        archive.list("weights", &shape.power_weights()[..own])?;
        archive.array("alpha", &[], &[shape.power_alpha().squared()])?;
        archive.rows("cells", complex.cells.rows())?;
        archive.rows("facets", complex.facets.rows())?;
        archive.rows("edges", complex.edges.rows())?;
        archive.list("vertices", complex.vertices.rows().as_flattened())?;
        archive.classes("cell_classes", complex.cells.classes())?;
        archive.classes("facet_classes", complex.facets.classes())?;
        archive.classes("edge_classes", complex.edges.classes())?;
        archive.classes("vertex_classes", complex.vertices.classes())?;
        if let Some(hidden) = shape.hidden() {
            archive.list("hidden", hidden)?;
        }
        archive.rows("duplicates", shape.duplicates())?;
        if let Some(torus) = shape.options().periodic {
            archive.box_vectors(torus)?;
        }
        if let Some(copies) = copies {
            archive.rows("copies", &copies)?;
        }
        if let Some(Voxels { dims, origin, axes: [a, b, c], runs }) = shape.voxels() {
            archive.rows("voxel_grid", &[dims.map(f64::from), *origin, *a, *b, *c])?;
            archive.rows("voxel_runs", runs)?;
        }
        if let Some(isovalue) = shape.isovalue() {
            archive.array("isovalue", &[], &[isovalue])?;
        }
        if let Some(values) = points.values() {
            archive.list("values", &values[..own])?;
        }
        let number = |n: u32| if n == NO_COMPONENT { -1 } else { i64::from(n) };
        let components: Vec<i64> =
            shape.component_numbers()[..own].iter().copied().map(number).collect();
        archive.list("components", &components)?;
        if let Some(sheets) = shape.sheets() {
            archive.rows("boundary_sheets", &sheets.sides().collect::<Vec<_>>())?;
        }
        out.write_all(&archive.finish()?.into_inner())
    }
}

/// An archive of arrays under construction.
pub(super) struct Archive<W: Write + Seek> {
    zip: ZipWriter<W>,
    options: SimpleFileOptions,
}

impl<W: Write + Seek> Archive<W> {
    pub(super) fn new(zip: ZipWriter<W>) -> Self {
        // The time of modification is fixed, so that the same shape gives the same bytes.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(true)
            .last_modified_time(DateTime::default());
        Self { zip, options }
    }

    /// Creates an archive of compressed arrays, tuned for speed and not for size.
    pub(super) fn compressed(zip: ZipWriter<W>) -> Self {
        let Self { zip, options } = Self::new(zip);
        let options =
            options.compression_method(CompressionMethod::Deflated).compression_level(Some(1));
        Self { zip, options }
    }

    pub(super) fn finish(self) -> io::Result<W> {
        self.zip.finish().map_err(io::Error::other)
    }

    fn array<T: Element>(&mut self, name: &str, shape: &[usize], elements: &[T]) -> io::Result<()> {
        self.zip.start_file(format!("{name}.npy"), self.options).map_err(io::Error::other)?;
        npy::write(&mut self.zip, shape, elements)?;
        // Ends the block of what is compressed, on which the bytes of the archive depend.
        self.zip.flush()
    }

    /// The sides of a periodic box along the axes, or its vectors as rows.
    pub(super) fn box_vectors(&mut self, torus: Torus) -> io::Result<()> {
        match torus.sides() {
            Some(sides) => self.list("periodic", &sides),
            None => self.rows("periodic", &torus.vectors()),
        }
    }

    pub(super) fn list<T: Element>(&mut self, name: &str, list: &[T]) -> io::Result<()> {
        self.array(name, &[list.len()], list)
    }

    pub(super) fn rows<T: Element, const N: usize>(
        &mut self,
        name: &str,
        rows: &[[T; N]],
    ) -> io::Result<()> {
        self.array(name, &[rows.len(), N], rows.as_flattened())
    }

    fn classes(&mut self, name: &str, classes: &[Class]) -> io::Result<()> {
        self.list(name, &classes.iter().map(|&class| class as u8).collect::<Vec<_>>())
    }
}
