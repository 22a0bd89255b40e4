use std::io::{self, Cursor, Write};

use walpha_base::advice::Advice;
use walpha_base::{Coordinates, LengthUnit};
use walpha_shape::{AlphaShape, SinglePrecision, Surface};
use walpha_volume::annotation;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::about::about;
use super::exporter::check_range;
use super::{ExportOptions, Exporter, Needs};

/// Writes 3MF, the 3D Manufacturing Format of slicers: the boundary of a [solid](AlphaShape::solid), whatever the options say, as
/// the format requires it, with its unit. The unit is that of the coordinates, or millimetres if the format does not support
/// that. Coordinates are rounded to `f32`, as slicers do; if that would move them by more than a thousandth of the shortest edge,
/// a round number is subtracted first ([`SinglePrecision`]), and the item is translated by it. The layout in space of a shape on
/// a torus is cut open, and becomes an object of the type `surface`.
#[derive(Clone, Debug, Default)]
pub struct ThreeMf(pub ExportOptions);

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

/// The number of facets from which on the sizes in the archive may exceed 32 bits.
const LARGE: usize = 1 << 24;

impl Exporter for ThreeMf {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = self.options(shape).surface(shape);
        // The time of modification is fixed, so that the same shape gives the same bytes.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .large_file(surface.regular.len() > LARGE)
            .last_modified_time(DateTime::default());
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, text) in [("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS)] {
            archive.start_file(name, options)?;
            archive.write_all(text.as_bytes())?;
        }
        archive.start_file("3D/3dmodel.model", options)?;
        let single = self.0.single(&surface, shape.points().positions());
        check_range(&single)?;
        model(shape, &surface, &single, &mut archive)?;
        out.write_all(&archive.finish()?.into_inner())
    }

    fn needs(&self) -> Needs {
        Needs::RegularFacet
    }

    fn single_precision(&self, shape: &AlphaShape) -> Option<SinglePrecision> {
        Some(self.options(shape).single_precision(shape))
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        let Coordinates { unit, .. } = shape.coordinates();
        unit_of(unit).is_none().then(|| {
            let what = match unit {
                LengthUnit::Voxel => "coordinates are indices of voxels".to_owned(),
                LengthUnit::Unstated => "the unit of the coordinates is not known".to_owned(),
                unit => format!("3MF does not know the unit {}", unit.symbol()),
            };
            format!("{what}, so the file says millimetres: scale it in the slicer").into()
        })
    }
}

impl ThreeMf {
    /// The options for a solid, unless the shape is cut open.
    fn options(&self, shape: &AlphaShape) -> ExportOptions {
        self.0.clone().solid(!is_open(shape))
    }
}

/// Whether the shape is the layout of a shape on a torus.
fn is_open(shape: &AlphaShape) -> bool {
    shape.options().periodic.is_some() || !shape.copies().is_empty()
}

/// The name of a unit in 3MF, if it has one.
fn unit_of(unit: LengthUnit) -> Option<&'static str> {
    match unit {
        LengthUnit::Metre => Some("meter"),
        LengthUnit::Centimetre => Some("centimeter"),
        LengthUnit::Millimetre => Some("millimeter"),
        LengthUnit::Micrometre => Some("micron"),
        LengthUnit::Foot => Some("foot"),
        _ => None,
    }
}

fn model(
    shape: &AlphaShape,
    surface: &Surface,
    single: &SinglePrecision,
    out: &mut impl Write,
) -> io::Result<()> {
    let of_input = shape.points().positions();
    let coordinates = shape.coordinates();
    write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <model unit=\"{}\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n\
         <metadata name=\"Application\">walpha</metadata>\n\
         <metadata name=\"Description\">{}{}</metadata>\n\
         <resources>\n<object id=\"1\" type=\"{}\">\n<mesh>\n<vertices>\n",
        unit_of(coordinates.unit).unwrap_or("millimeter"),
        about(shape),
        annotation::comment(coordinates),
        if is_open(shape) { "surface" } else { "model" },
    )?;
    for place in surface.positions(of_input) {
        let [x, y, z] = single.round(place);
        writeln!(out, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
    }
    write!(out, "</vertices>\n<triangles>\n")?;
    for [a, b, c] in &surface.regular {
        writeln!(out, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")?;
    }
    write!(out, "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"")?;
    if single.has_offset() {
        let [x, y, z] = single.offset;
        write!(out, " transform=\"1 0 0 0 1 0 0 0 1 {x} {y} {z}\"")?;
    }
    write!(out, "/>\n</build>\n</model>\n")
}
