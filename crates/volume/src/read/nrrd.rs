//! NRRD, the format of teem.

use std::collections::HashMap;
use std::io::BufRead;
use std::path::{Path, PathBuf};

use walpha_base::Monitor;
use walpha_base::shown::shown;
use walpha_base::vector::{V3, cross, scale, unit};

use super::OpenFile;
use super::detached::{self, data_paths, numbered};
use super::frames::FrameChoice;
use super::layout::{Encoding, Layout, diagonal, frame, one_unit, unit_named};
use super::text::Lines;
use super::uncompressed::Uncompressed;
use crate::error::{format_error, io_error};
use crate::{
    Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Space, Volume, VolumeError,
};

/// The first bytes of each NRRD file, before the digit of its version.
const MAGIC: &[u8] = b"NRRD000";

/// All fields of the format.
const FIELDS: [&str; 38] = [
    "axis maxs",
    "axis mins",
    "axismaxs",
    "axismins",
    "block size",
    "blocksize",
    "byte skip",
    "byteskip",
    "centerings",
    "centers",
    "content",
    "dimension",
    "encoding",
    "endian",
    "kinds",
    "labels",
    "line skip",
    "lineskip",
    "max",
    "measurement frame",
    "min",
    "number",
    "old max",
    "old min",
    "oldmax",
    "oldmin",
    "sample units",
    "sampleunits",
    "sizes",
    "space",
    "space dimension",
    "space directions",
    "space origin",
    "space units",
    "spacings",
    "thicknesses",
    "type",
    "units",
];

/// Reads NRRD ("nearly raw raster data", teem.sourceforge.net/nrrd/format.html). Its samples are behind the header (`.nrrd`) or
/// in other files (`.nhdr`: one, a `LIST`, or a numbered sequence).
///
/// All scalar types and the encodings raw, gzip, bzip2 and text are read. `space directions` and `space origin`, or `spacings`
/// and `axis mins`, give the frame, in the space that the file names. An axis whose direction is `none`, or whose kind is a time,
/// is not a spatial axis. Axes beyond the third and behind the spatial ones count volumes, of which `frame` is read; axes of
/// colours or vectors, `hex` and `line skip` are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let header = Header::read(path, &mut lines)?;
    let volume = volume(file, &header, frame, lines, monitor)?;
    Ok(if header.labels { volume.with_labels() } else { volume })
}

/// Reads the samples behind a header, or in the files that it names.
fn volume(
    file: &OpenFile,
    header: &Header,
    frame: Option<u64>,
    lines: Lines<impl BufRead>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let fail = |reason: Reason| format_error(path, reason);
    let layout = header.layout(path, frame)?;
    let skip = header.skip(path, &layout)?;
    match &header.files {
        None => {
            let behind = file.length() - lines.bytes();
            let skip = skip.unwrap_or(behind.saturating_sub(layout.bytes()));
            let mut reader = lines.into_inner();
            let skipped =
                std::io::copy(&mut std::io::Read::take(&mut reader, skip), &mut std::io::sink());
            let bytes = behind - skipped.map_err(io_error(path))?;
            layout.read(path, reader, bytes, monitor)
        }
        Some(names) => {
            if names.is_empty() {
                return Err(fail(Reason::header("names no data file")));
            }
            let each = layout.bytes() / names.len() as u64;
            let skip = |length: u64| skip.unwrap_or(length.saturating_sub(each));
            detached::read(path, layout, &data_paths(path, names), skip, monitor)
        }
    }
}

/// Locates the samples of a volume, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let header = Header::read(path, &mut lines)?;
    let layout = header.layout(path, frame)?;
    let skip = header.skip(path, &layout)?;
    let samples = match &header.files {
        None => Uncompressed::after_header(file, layout, lines.bytes(), skip),
        Some(names) => Uncompressed::in_data_file(path, layout, &data_paths(path, names), skip),
    };
    Ok(samples?.with_labels(header.labels))
}

/// The files that hold the samples, if the header's file does not.
pub(crate) fn data_files(file: &OpenFile) -> Result<Vec<PathBuf>, VolumeError> {
    let path = file.path();
    let header = Header::read(path, &mut Lines::new(file.reader()?))?;
    Ok(header.files.map_or_else(Vec::new, |names| data_paths(path, &names)))
}

struct Header {
    /// The fields by name, in lower case.
    fields: HashMap<String, String>,
    /// The names of the files that hold the samples; `None` if they follow the header.
    files: Option<Vec<String>>,
    /// Whether the values are labels: the header has keys of 3D Slicer's segments, or the file has the name of a segmentation.
    labels: bool,
}

impl Header {
    fn read(path: &Path, lines: &mut Lines<impl BufRead>) -> Result<Self, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let first = lines.read_line().map_err(io_error(path))?.unwrap_or_default();
        if !first.as_bytes().starts_with(MAGIC) {
            return Err(fail(Reason::other("is not an NRRD file: it does not begin with NRRD000")));
        }
        let mut header =
            Self { fields: HashMap::new(), files: None, labels: is_segmentation(path) };
        // A header alone may end with its file; samples must follow a blank line.
        while let Some(line) = lines.read_line().map_err(io_error(path))? {
            if line.is_empty() {
                return Ok(header);
            }
            if line.starts_with('#') {
                continue;
            }
            if let Some((key, _)) = line.split_once(":=") {
                header.labels |= is_of_segment(key);
                continue;
            }
            let Some((name, value)) = line.split_once(':') else {
                return Err(fail(Reason::header(format!(
                    "has a header line {line:?}, which is not a field"
                ))));
            };
            let (name, value) = (name.trim().to_lowercase(), value.trim());
            if name == "data file" || name == "datafile" {
                header.files = Some(named(path, value, lines)?);
                if value.starts_with("LIST") {
                    return Ok(header);
                }
            } else if header.fields.insert(name.clone(), value.into()).is_some() {
                return Err(fail(Reason::header(format!("gives {name:?} twice in its header"))));
            }
        }
        if header.files.is_some() {
            return Ok(header);
        }
        Err(fail(Reason::truncated("ends inside its NRRD header: it is truncated")))
    }

    fn field(&self, name: &str) -> Option<&str> {
        self.fields.get(name).map(String::as_str)
    }

    fn needed(&self, path: &Path, name: &str) -> Result<&str, VolumeError> {
        let missing =
            || format_error(path, Reason::header(format!("its NRRD header has no {name}")));
        self.field(name).ok_or_else(missing)
    }

    fn layout(&self, path: &Path, frame: Option<u64>) -> Result<Layout, VolumeError> {
        let sizes = self.sizes(path)?;
        self.check_scalar(path, &sizes)?;
        let kept = self.axes_of_space(path, &sizes)?;
        let beyond: Vec<u64> =
            (0..sizes.len()).filter(|axis| !kept.contains(axis)).map(|axis| sizes[axis]).collect();
        let size = |axis: usize| kept.get(axis).map_or(1, |&axis| sizes[axis]);
        let dims = Dims::unbounded(size(0), size(1), size(2))?;
        let (dtype, encoding) = (self.dtype(path)?, self.encoding(path)?);
        let endian = self.endian(path, dtype, encoding)?;
        let frames = FrameChoice::choose(path, &beyond, frame)?;
        let frame = self.frame(path, sizes.len(), &kept, dims.xyz())?;
        self.say_what_is_passed_over(path);
        Ok(Layout { dims, dtype, endian, frame, encoding, frames })
    }

    /// The axes that are x, y and z. Other axes with more than one sample must be behind them, where they count volumes.
    fn axes_of_space(&self, path: &Path, sizes: &[u64]) -> Result<Vec<usize>, VolumeError> {
        let directions = self.directions(path, sizes.len())?;
        let kinds = self.kinds();
        let is_of_space = |axis: usize| match &directions {
            Some(directions) => directions[axis].is_some(),
            None => kinds.get(axis) != Some(&"time"),
        };
        let mut kept: Vec<usize> = (0..sizes.len()).filter(|&axis| is_of_space(axis)).collect();
        while kept.len() > 3 {
            let single = kept.iter().position(|&axis| sizes[axis] == 1);
            kept.remove(single.unwrap_or(3));
        }
        if directions.is_none()
            && kinds.is_empty()
            && sizes.iter().filter(|&&size| size > 1).count() > 3
        {
            tracing::warn!(
                "{}: says neither kinds nor directions of its {} axes, of which the first three are taken for x, y and z",
                shown(path),
                sizes.len()
            );
        }
        let last = kept.last().copied().unwrap_or(0);
        let between = (0..last).find(|axis| sizes[*axis] > 1 && !kept.contains(axis));
        if let Some(axis) = between {
            let size = sizes[axis];
            let what = format!("{size} values a voxel (axis {axis} is not spatial)");
            let dims = <[usize; 3]>::try_from(kept).ok().map(|kept| kept.map(|axis| sizes[axis]));
            return Err(format_error(path, Reason::not_scalar(what, dims)));
        }
        Ok(kept)
    }

    /// The direction of each axis, if the header has them; `None` for an axis that is not spatial. The last of four components is
    /// time.
    fn directions(
        &self,
        path: &Path,
        all: usize,
    ) -> Result<Option<Vec<Option<[f64; 3]>>>, VolumeError> {
        let Some(text) = self.field("space directions") else { return Ok(None) };
        let rows = vectors(text).filter(|rows| rows.len() == all).ok_or_else(|| {
            let what = format!("space directions: {text} are not {all} vectors of numbers");
            format_error(path, Reason::header(what))
        })?;
        let of_space = |row: Option<[f64; 4]>| {
            row.filter(|[x, y, z, t]| *t == 0.0 || [x, y, z] != [&0.0; 3])
                .map(|[x, y, z, _]| [x, y, z])
        };
        Ok(Some(rows.into_iter().map(of_space).collect()))
    }

    /// The kind of each axis.
    fn kinds(&self) -> Vec<&str> {
        self.field("kinds").map(|kinds| kinds.split_whitespace().collect()).unwrap_or_default()
    }

    /// Warns about statements of the header that are not followed.
    fn say_what_is_passed_over(&self, path: &Path) {
        let path = shown(path);
        let mut unknown: Vec<&str> =
            self.fields.keys().map(String::as_str).filter(|name| !FIELDS.contains(name)).collect();
        unknown.sort_unstable();
        for name in unknown {
            tracing::warn!("{path}: the field {name:?} is none of NRRD's, and passed over");
        }
        let quantised = ["old min", "oldmin", "old max", "oldmax"];
        if quantised
            .iter()
            .any(|name| self.field(name).is_some_and(|text| !text.eq_ignore_ascii_case("nan")))
        {
            tracing::warn!("{path}: old min and old max are passed over: values are as stored");
        }
        let space = self.field("space").unwrap_or_default().to_lowercase();
        if !space.is_empty() && !self.space().is_known() {
            tracing::warn!(
                "{path}: the space {space} says nothing of a patient's directions, and is passed over"
            );
        }
    }

    /// The number of samples along each axis, the fastest first.
    fn sizes(&self, path: &Path) -> Result<Vec<u64>, VolumeError> {
        let fail = |what: String| format_error(path, Reason::header(what));
        let text = self.needed(path, "sizes")?;
        let sizes: Result<Vec<u64>, _> = text.split_whitespace().map(str::parse).collect();
        let sizes = sizes.map_err(|_| fail(format!("sizes: {text} are not numbers")))?;
        let dimension = self.needed(path, "dimension")?;
        if dimension.parse() != Ok(sizes.len()) {
            let count = sizes.len();
            return Err(fail(format!("has dimension: {dimension}, but {count} sizes")));
        }
        Ok(sizes)
    }

    /// Refuses axes that give a voxel several values.
    fn check_scalar(&self, path: &Path, sizes: &[u64]) -> Result<(), VolumeError> {
        let kinds = self.kinds();
        for (axis, &size) in sizes.iter().enumerate() {
            let kind = kinds.get(axis).copied().unwrap_or("none");
            let scalar = ["domain", "space", "time", "none", "???", "scalar", "stub"];
            if size > 1 && !scalar.contains(&kind.to_lowercase().as_str()) {
                let what = format!("{size} values a voxel (axis {axis} is of kind {kind})");
                let others = sizes.iter().enumerate().filter(|(other, _)| *other != axis);
                let others: Vec<u64> = others.map(|(_, &size)| size).collect();
                let dims = <[u64; 3]>::try_from(others).ok();
                return Err(format_error(path, Reason::not_scalar(what, dims)));
            }
        }
        Ok(())
    }

    fn dtype(&self, path: &Path) -> Result<Dtype, VolumeError> {
        let name = self.needed(path, "type")?;
        scalar_type(name).ok_or_else(|| {
            let what = format!(
                "holds samples of type {name}: integers of 8 to 64 bits, float and double are read"
            );
            format_error(path, Reason::unsupported(what, "convert it first"))
        })
    }

    fn encoding(&self, path: &Path) -> Result<Encoding, VolumeError> {
        Ok(match self.needed(path, "encoding")?.to_lowercase().as_str() {
            "raw" => Encoding::Raw,
            "gzip" | "gz" => Encoding::Gzip,
            "bzip2" | "bz2" => Encoding::Bzip2,
            "text" | "txt" | "ascii" => Encoding::Text,
            other => {
                let what = format!("is encoded as {other}, which is not read");
                let reason = Reason::unsupported(what, "save it as raw or gzip");
                return Err(format_error(path, reason));
            }
        })
    }

    fn endian(&self, path: &Path, dtype: Dtype, encoding: Encoding) -> Result<Endian, VolumeError> {
        match self.field("endian").map(str::to_lowercase).as_deref() {
            Some("little") => Ok(Endian::Little),
            Some("big") => Ok(Endian::Big),
            None if dtype.size() == 1 || encoding == Encoding::Text => Ok(Endian::Little),
            other => {
                let given = other.unwrap_or("(missing)");
                let what = format!("endian: {given} is not a byte order, little or big");
                Err(format_error(path, Reason::header(what)))
            }
        }
    }

    /// The number of bytes before the samples; `None` if the samples are at the end of the file.
    fn skip(&self, path: &Path, layout: &Layout) -> Result<Option<u64>, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let lines = self.field("line skip").or(self.field("lineskip")).unwrap_or("0");
        if lines != "0" {
            return Err(fail(Reason::unsupported(
                format!("line skip: {lines} is not read"),
                "give byte skip instead",
            )));
        }
        let bytes = self.field("byte skip").or(self.field("byteskip")).unwrap_or("0");
        match bytes.parse::<u64>() {
            Ok(0) => Ok(Some(0)),
            _ if layout.encoding != Encoding::Raw => Err(fail(Reason::unsupported(
                format!("byte skip: {bytes} is read only where the encoding is raw"),
                "convert it first",
            ))),
            Ok(skip) => Ok(Some(skip)),
            Err(_) if bytes == "-1" => Ok(None),
            Err(_) => {
                Err(fail(Reason::header(format!("byte skip: {bytes} is not a number of bytes"))))
            }
        }
    }
}

/// Whether a key is one of 3D Slicer's about a segment, such as `Segment0_LabelValue`.
fn is_of_segment(key: &str) -> bool {
    let number = key.strip_prefix("Segment").and_then(|rest| rest.split_once('_'));
    number.is_some_and(|(number, _)| number.parse::<u32>().is_ok())
}

/// Whether the name is one of 3D Slicer's segmentations, `.seg.nrrd` or `.seg.nhdr`.
fn is_segmentation(path: &Path) -> bool {
    let inner = path.file_stem().map(Path::new).and_then(Path::extension);
    inner.is_some_and(|inner| inner.eq_ignore_ascii_case("seg"))
}

fn scalar_type(name: &str) -> Option<Dtype> {
    Some(match name.to_lowercase().as_str() {
        "signed char" | "int8" | "int8_t" => Dtype::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Dtype::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            Dtype::I16
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Dtype::U16,
        "int" | "signed int" | "int32" | "int32_t" => Dtype::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Dtype::U32,
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => Dtype::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            Dtype::U64
        }
        "float" => Dtype::F32,
        "double" => Dtype::F64,
        _ => return None,
    })
}

/// The names that a `data file` field gives: one, a `LIST` of the lines that follow, or a numbered sequence `pattern min max
/// step`, whose pattern has one `%d` or, for example, `%03d`.
fn named(
    path: &Path,
    value: &str,
    lines: &mut Lines<impl BufRead>,
) -> Result<Vec<String>, VolumeError> {
    if value.starts_with("LIST") {
        let mut names = Vec::new();
        while let Some(line) = lines.read_line().map_err(io_error(path))? {
            if !line.trim().is_empty() {
                names.push(line.trim().to_owned());
            }
        }
        return Ok(names);
    }
    let words: Vec<&str> = value.split_whitespace().collect();
    match numbered(&words) {
        Some(names) => names.map_err(|reason| format_error(path, reason)),
        None => Ok(vec![value.to_owned()]),
    }
}

impl Header {
    /// The place of the grid; `kept` are the axes that are read, of `all`, and `dims` their sizes.
    ///
    /// It is given by `space directions` and `space origin`, or else by `spacings` and `axis mins`, or by `axis mins` and `axis
    /// maxs`. The ends of an axis are at its outer samples, or half a spacing beyond them if `centerings` says `cell` or nothing,
    /// as for teem and ITK.
    fn frame(
        &self,
        path: &Path,
        all: usize,
        kept: &[usize],
        dims: [usize; 3],
    ) -> Result<Frame, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let mut steps = diagonal([1.0; 3]);
        let mut origin = [0.0; 3];
        if let Some(directions) = self.directions(path, all)? {
            for (step, &axis) in steps.iter_mut().zip(kept) {
                if let Some(direction) = directions[axis] {
                    *step = direction;
                }
            }
            // A slice has the third direction across it.
            let is_given = |c: &usize| kept.get(*c).is_some_and(|&axis| directions[axis].is_some());
            if let [lacking] = (0..3).filter(|c| !is_given(c)).collect::<Vec<_>>()[..] {
                let others = [steps[(lacking + 1) % 3], steps[(lacking + 2) % 3]];
                steps[lacking] = across(others, lacking).unwrap_or(steps[lacking]);
            }
        } else {
            let [spacings, mins, maxs] = [
                self.numbers(path, &["spacings"], all)?,
                self.numbers(path, &["axis mins", "axismins"], all)?,
                self.numbers(path, &["axis maxs", "axismaxs"], all)?,
            ];
            let centers = self.field("centerings").or(self.field("centers")).unwrap_or_default();
            let centers: Vec<&str> = centers.split_whitespace().collect();
            for (c, &axis) in kept.iter().enumerate() {
                let node = centers.get(axis).is_some_and(|center| *center == "node");
                let parts = if node { dims[c] - 1 } else { dims[c] };
                let ends = mins[axis].zip(maxs[axis]).filter(|_| parts > 0);
                let between = ends.map(|(low, high)| (high - low) / parts as f64);
                if let Some(step) = spacings[axis].or(between) {
                    steps[c][c] = step;
                }
                if let Some(low) = mins[axis] {
                    origin[c] = if node { low } else { low + steps[c][c] / 2.0 };
                }
            }
        }
        if let Some(text) = self.field("space origin") {
            origin = match vectors(text).as_deref() {
                Some([Some([x, y, z, _])]) => [*x, *y, *z],
                _ => {
                    return Err(fail(Reason::header(format!(
                        "space origin: {text} is not a vector of numbers"
                    ))));
                }
            };
        }
        // Units are those of the axes of the world, or of the grid if its axes run along those of the world.
        let (coordinates, factors) = self.coordinates(path, kept)?;
        for vector in steps.iter_mut().chain([&mut origin]) {
            vector.iter_mut().zip(factors).for_each(|(component, factor)| *component *= factor);
        }
        frame(path, origin, steps, coordinates)
    }

    /// The space that the file names, if it has directions in a patient.
    fn space(&self) -> Space {
        match self.field("space").unwrap_or_default().to_lowercase().as_str() {
            "left-posterior-superior" | "lps" | "left-posterior-superior-time" | "lpst" => {
                Space::Lps
            }
            "right-anterior-superior" | "ras" | "right-anterior-superior-time" | "rast" => {
                Space::Ras
            }
            "left-anterior-superior" | "las" | "left-anterior-superior-time" | "last" => Space::Las,
            _ => Space::Unknown,
        }
    }

    /// The space and its unit, and the factors that convert lengths along each axis to that unit. The unit is that of `space
    /// units`, or else of `units`. If neither exists, a patient is measured in millimetres, as for ITK and Slicer.
    fn coordinates(
        &self,
        path: &Path,
        kept: &[usize],
    ) -> Result<(Coordinates, [f64; 3]), VolumeError> {
        let places = ["space directions", "space origin", "spacings", "axis mins", "axismins"];
        if places.iter().all(|name| self.field(name).is_none()) {
            return Ok((Coordinates::VOXEL, [1.0; 3]));
        }
        let space = self.space();
        let stated = |text: Option<&str>, axis: usize| {
            let name = quoted(text?).nth(axis).filter(|name| !name.trim().is_empty());
            name.map(|name| unit_named(path, name))
        };
        let of_space = [0, 1, 2].map(|axis| stated(self.field("space units"), axis));
        let of_axes = [0, 1, 2].map(|c| stated(self.field("units"), *kept.get(c)?));
        let units = if of_space == [None; 3] { of_axes } else { of_space };
        let (unit, factors) = one_unit(path, units)?;
        let unit = match unit {
            LengthUnit::Unstated if space.is_known() => LengthUnit::Millimetre,
            unit => unit,
        };
        Ok((Coordinates { space, unit }, factors))
    }

    /// A number for each axis; `None` if the field does not exist or is NaN, which means "unknown".
    fn numbers(
        &self,
        path: &Path,
        names: &[&str],
        all: usize,
    ) -> Result<Vec<Option<f64>>, VolumeError> {
        let Some(text) = names.iter().find_map(|name| self.field(name)) else {
            return Ok(vec![None; all]);
        };
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(|n| n.parse().ok()).collect();
        let numbers = numbers.filter(|numbers| numbers.len() == all).ok_or_else(|| {
            format_error(
                path,
                Reason::header(format!("{}: {text} are not {all} numbers", names[0])),
            )
        })?;
        Ok(numbers.into_iter().map(|number| (!number.is_nan()).then_some(number)).collect())
    }
}

/// The words of a text such as `"mm" "mm" ""`, without their quotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2)
}

/// The vectors of a text such as `(1,0,0) none (0,0,2)`, with up to four components.
fn vectors(text: &str) -> Option<Vec<Option<[f64; 4]>>> {
    let mut rest = text.trim();
    let mut rows = Vec::new();
    while !rest.is_empty() {
        if let Some(after) = rest.strip_prefix("none") {
            rows.push(None);
            rest = after.trim_start();
            continue;
        }
        let (row, after) = rest.strip_prefix('(')?.split_once(')')?;
        let numbers: Vec<f64> =
            row.split(',').map(|number| number.trim().parse().ok()).collect::<Option<_>>()?;
        let mut vector = [0.0; 4];
        vector.get_mut(..numbers.len())?.copy_from_slice(&numbers);
        // NaN stands for "unknown".
        rows.push((!numbers.iter().all(|number| number.is_nan())).then_some(vector));
        rest = after.trim_start();
    }
    Some(rows)
}

/// The direction across two others, that which leads along an axis of the world rather than against it.
fn across([a, b]: [V3; 2], axis: usize) -> Option<V3> {
    let normal = unit(cross(a, b))?;
    Some(if normal[axis] < 0.0 { scale(normal, -1.0) } else { normal })
}
