use std::io::{self, Cursor, Write};

use ndarray::{ArrayView1, ArrayView2};
use ndarray_npy::WriteNpyExt;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::Exporter;
use crate::shape::{AlphaShape, NO_COMPONENT, Simplices};

/// NPZ, NumPy's archive of arrays: `positions` (n×3), `weights` and, where known, `values` of all
/// points; `cells` (m×4), `facets` (m×3), `edges` (m×2) and `vertices` (m×1), indices of points, each
/// with its `…_classes` (0 exterior, 1 interior, 2 regular, 3 singular); `components` (n), the number of
/// each point's component, −1 for points that are not in the shape; where known `boundary_sheets`
/// (k×2), the [sheets](crate::shape::Sheets) in front of and behind the regular facets, then the
/// singular ones, −1 for none; `alpha`, a squared length.
#[derive(Clone, Copy, Debug)]
pub struct Npz;

impl Exporter for Npz {
    fn write(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let (points, complex) = (shape.points(), shape.complex());
        let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
        let flat = points.positions.as_flattened();
        let positions = ArrayView2::from_shape((points.len(), 3), flat);
        archive.array("positions", positions.map_err(io::Error::other)?)?;
        archive.array("weights", ArrayView1::from(&points.weights))?;
        if let Some(values) = &points.values {
            archive.array("values", ArrayView1::from(values))?;
        }
        archive.simplices("cells", &complex.cells)?;
        archive.simplices("facets", &complex.facets)?;
        archive.simplices("edges", &complex.edges)?;
        archive.simplices("vertices", &complex.vertices)?;
        let number = |n: u32| if n == NO_COMPONENT { -1 } else { i64::from(n) };
        let components: Vec<i64> = shape.component_numbers().into_iter().map(number).collect();
        archive.array("components", ArrayView1::from(&components))?;
        if let Some(sheets) = shape.sheets() {
            let sides: Vec<[i32; 2]> = sheets.sides().collect();
            let sides = ArrayView2::from_shape((sides.len(), 2), sides.as_flattened());
            archive.array("boundary_sheets", sides.map_err(io::Error::other)?)?;
        }
        archive.array("alpha", ArrayView1::from(&[shape.options().alpha.squared()]))?;
        let bytes = archive.0.finish().map_err(io::Error::other)?.into_inner();
        out.write_all(&bytes)
    }
}

struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn array(&mut self, name: &str, array: impl WriteNpyExt) -> io::Result<()> {
        // Without the time of writing, so that the same shape gives the same bytes.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(true)
            .last_modified_time(DateTime::default());
        self.0.start_file(format!("{name}.npy"), options).map_err(io::Error::other)?;
        array.write_npy(&mut self.0).map_err(io::Error::other)
    }

    fn simplices<const N: usize>(
        &mut self,
        name: &str,
        simplices: &Simplices<N>,
    ) -> io::Result<()> {
        let rows = simplices.vertices.as_flattened();
        let rows = ArrayView2::from_shape((simplices.len(), N), rows).map_err(io::Error::other)?;
        self.array(name, rows)?;
        let classes: Vec<u8> = simplices.classes.iter().map(|&class| class as u8).collect();
        self.array(&format!("{name}_classes"), ArrayView1::from(&classes))
    }
}
