use std::io::BufRead;
use std::path::{Path, PathBuf};

use super::OpenFile;
use super::detached::{self, data_paths, numbered};
use super::frames::FrameChoice;
use super::layout::{self, Encoding, Layout, diagonal};
use super::text::Lines;
use super::uncompressed::Uncompressed;
use crate::error::{format_error, io_error};
use crate::{Coordinates, Dims, Dtype, Endian, Frame, LengthUnit, Reason, Volume, VolumeError};
use walpha_base::Monitor;
use walpha_base::shown::shown;

/// Keys of the grid, with their synonyms in the order of precedence of `MetaIO` 5.4.
const SPACING: [&str; 2] = ["ElementSpacing", "ElementSize"];
const ORIGIN: [&str; 4] = ["ImagePosition", "Origin", "Offset", "Position"];
const MATRIX: [&str; 3] = ["TransformMatrix", "Rotation", "Orientation"];
const BYTE_ORDER: [&str; 2] = ["BinaryDataByteOrderMSB", "ElementByteOrderMSB"];

/// Reads `MetaImage`, the format of ITK's `MetaIO`. Its samples are behind the header (`.mha`) or in other files (`.mhd`: one, a
/// `LIST`, or a numbered sequence), raw, compressed with zlib, or text.
///
/// `ElementSpacing`, `Offset` and `TransformMatrix`, whose rows are the grid's axes, give the frame. Synonyms and flags are
/// interpreted as by `MetaIO`. A fourth axis counts volumes, of which `frame` is read; several channels are refused.
pub(crate) fn read(
    file: &OpenFile,
    frame: Option<u64>,
    monitor: &Monitor,
) -> Result<Volume, VolumeError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let header = Header::read(path, &mut lines)?;
    let layout = header.layout(path, frame)?;
    let skip = header.skip(path)?;
    let Some(names) = header.names(path, &mut lines)? else {
        let start = header.start_of_local(path, file.length(), lines.bytes(), &layout)?;
        return layout.read(path, file.reader_at(start)?, file.length() - start, monitor);
    };
    let each = layout.bytes() / names.len() as u64;
    let skip = |length: u64| skip.unwrap_or(length.saturating_sub(each));
    detached::read(path, layout, &data_paths(path, &names), skip, monitor)
}

/// Locates the samples of a volume, to be read part by part.
pub(crate) fn box_reader(file: &OpenFile, frame: Option<u64>) -> Result<Uncompressed, VolumeError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let header = Header::read(path, &mut lines)?;
    let layout = header.layout(path, frame)?;
    match header.names(path, &mut lines)? {
        None => {
            let start = header.start_of_local(path, file.length(), lines.bytes(), &layout)?;
            Uncompressed::after_header(file, layout, start, Some(0))
        }
        Some(names) => {
            Uncompressed::in_data_file(path, layout, &data_paths(path, &names), header.skip(path)?)
        }
    }
}

/// The files that hold the samples, if the header's file does not.
pub(crate) fn data_files(file: &OpenFile) -> Result<Vec<PathBuf>, VolumeError> {
    let path = file.path();
    let mut lines = Lines::new(file.reader()?);
    let names = Header::read(path, &mut lines)?.names(path, &mut lines)?;
    Ok(names.map_or_else(Vec::new, |names| data_paths(path, &names)))
}

struct Header {
    fields: Vec<(String, String)>,
    /// The value of `ElementDataFile`, the last field.
    data: String,
}

impl Header {
    fn read(path: &Path, lines: &mut Lines<impl BufRead>) -> Result<Self, VolumeError> {
        let mut fields = Vec::new();
        while let Some(line) = lines.read_line().map_err(io_error(path))? {
            if line.trim().is_empty() {
                continue;
            }
            let Some((key, value)) = line.split_once(['=', ':']) else {
                let line: String = line.chars().take(40).collect();
                let reason = Reason::other(format!(
                    "is not a MetaImage file: its header has a line {line:?}"
                ));
                return Err(format_error(path, reason));
            };
            let (key, value) = (key.trim().to_owned(), value.trim().to_owned());
            if key == "ElementDataFile" {
                return Ok(Self { fields, data: value });
            }
            fields.push((key, value));
        }
        let what = "ends before ElementDataFile: it is truncated, or not a MetaImage file";
        let reason = Reason::claims_more(what);
        Err(format_error(path, reason))
    }

    /// The names of the data files as the header states them; `None` if the samples follow the header.
    fn names(
        &self,
        path: &Path,
        lines: &mut Lines<impl BufRead>,
    ) -> Result<Option<Vec<String>>, VolumeError> {
        let words: Vec<&str> = self.data.split_whitespace().collect();
        if words.first().is_some_and(|word| word.eq_ignore_ascii_case("local")) {
            return Ok(None);
        }
        let names = if words.first() == Some(&"LIST") {
            let mut names = Vec::new();
            while let Some(line) = lines.read_line().map_err(io_error(path))? {
                if !line.trim().is_empty() {
                    names.push(line.trim().to_owned());
                }
            }
            names
        } else {
            match numbered(&self.numbering(&words)) {
                Some(names) => names.map_err(|reason| format_error(path, reason))?,
                None => vec![self.data.clone()],
            }
        };
        if names.iter().all(String::is_empty) {
            let what = "names no data file (ElementDataFile)";
            return Err(format_error(path, Reason::header(what)));
        }
        Ok(Some(names))
    }

    /// The words of a numbered sequence, with the defaults of a first number, last number and step that are left out.
    fn numbering<'a>(&self, words: &[&'a str]) -> Vec<std::borrow::Cow<'a, str>> {
        let mut full: Vec<std::borrow::Cow<'a, str>> =
            words.iter().map(|&word| word.into()).collect();
        let whole = |text: Option<&str>| text.and_then(|text| text.parse::<i64>().ok());
        let files =
            whole(self.field(&["DimSize"]).and_then(|sizes| sizes.split_whitespace().last()));
        let (Some(files), true) = (files, words.first().is_some_and(|word| word.contains('%')))
        else {
            return full;
        };
        if full.len() == 1 {
            full.push("1".into());
        }
        if let (2, Some(first)) = (full.len(), whole(full.get(1).map(AsRef::as_ref))) {
            full.push(first.saturating_add(files - 1).to_string().into());
        }
        if let (3, Some(first), Some(last)) =
            (full.len(), whole(Some(&full[1])), whole(Some(&full[2])))
        {
            full.push((last.saturating_sub(first) / (files - 1).max(1)).max(1).to_string().into());
        }
        full
    }

    /// The value of the first of these keys that exists. If a key occurs twice, the last value is used.
    fn field(&self, keys: &[&str]) -> Option<&str> {
        let of_key = |wanted: &&str| {
            let field = self.fields.iter().rev().find(|(key, _)| key == wanted);
            field.map(|(_, value)| value.as_str())
        };
        keys.iter().find_map(of_key)
    }

    /// Whether a flag is set: its value begins with T, t or 1.
    fn flag(&self, keys: &[&str]) -> bool {
        self.field(keys).is_some_and(|value| value.starts_with(['T', 't', '1']))
    }

    /// Warns about statements of the header that are not followed.
    fn say_what_is_passed_over(&self, path: &Path) {
        let path = shown(path);
        for keys in [&SPACING[..], &ORIGIN, &MATRIX, &BYTE_ORDER] {
            let mut given = keys.iter().filter_map(|key| Some((key, self.field(&[key])?)));
            let Some((taken, value)) = given.next() else { continue };
            if let Some((other, _)) = given.find(|(_, other)| *other != value) {
                tracing::warn!(
                    "{path}: {taken} = {value} is taken, and {other}, which says otherwise, is not"
                );
            }
        }
        let number = |key: &str| self.field(&[key]).and_then(|text| text.parse::<f64>().ok());
        let scaling = ["ElementToIntensityFunctionSlope", "ElementToIntensityFunctionOffset"];
        if scaling.iter().zip([1.0, 0.0]).any(|(key, none)| number(key).is_some_and(|n| n != none))
        {
            tracing::warn!(
                "{path}: {} and …Offset are passed over, as ITK does: values are as stored",
                scaling[0]
            );
        }
        let centre = self.field(&["CenterOfRotation"]).unwrap_or_default();
        if centre.split_whitespace().any(|number| number.parse() != Ok(0.0)) {
            tracing::warn!("{path}: CenterOfRotation = {centre} is passed over, as ITK does");
        }
        let letters = self.field(&["AnatomicalOrientation"]).unwrap_or("RAI").to_uppercase();
        if self.field(&MATRIX).is_none() && !letters.contains(['?', ' ']) && letters != "RAI" {
            tracing::warn!(
                "{path}: AnatomicalOrientation = {letters} is passed over: without TransformMatrix axes run as \
                 RAI says"
            );
        }
    }

    /// As many numbers as the key should have; `default` for a missing key.
    fn numbers(
        &self,
        path: &Path,
        keys: &[&str],
        count: usize,
        default: f64,
    ) -> Result<Vec<f64>, VolumeError> {
        let Some(text) = self.field(keys) else { return Ok(vec![default; count]) };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().map(|number| number.parse().ok()).collect();
        numbers.filter(|numbers| numbers.len() == count).ok_or_else(|| {
            let reason = Reason::header(format!(
                "{} = {text} in its header is not {count} numbers",
                keys[0]
            ));
            format_error(path, reason)
        })
    }

    fn layout(&self, path: &Path, frame: Option<u64>) -> Result<Layout, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        if let Some(kind) = self.field(&["ObjectType"]).filter(|kind| *kind != "Image") {
            return Err(fail(Reason::unsupported(
                format!("holds an object of type {kind}: only Image is read"),
                "convert it first",
            )));
        }
        let count = match self.needed(path, "NDims")? {
            "2" => 2,
            "3" => 3,
            "4" => 4,
            other => {
                let what = format!("has NDims = {other}: images of 2 to 4 axes are read");
                return Err(fail(Reason::unsupported(what, "save it with 3 axes")));
            }
        };
        let sizes = self.needed(path, "DimSize")?;
        let size: Option<Vec<u64>> = sizes.split_whitespace().map(|n| n.parse().ok()).collect();
        let (dims, volumes) = match size.as_deref() {
            Some(&[x, y]) if count == 2 => (Dims::unbounded(x, y, 1)?, 1),
            Some(&[x, y, z]) if count == 3 => (Dims::unbounded(x, y, z)?, 1),
            Some(&[x, y, z, t]) if count == 4 => (Dims::unbounded(x, y, z)?, t),
            _ => {
                return Err(fail(Reason::header(format!(
                    "DimSize = {sizes} is not {count} sizes"
                ))));
            }
        };
        let frames = FrameChoice::choose(path, &[volumes], frame)?;
        let dtype = self.dtype(path)?;
        let big = self.flag(&BYTE_ORDER);
        let endian = if big { Endian::Big } else { Endian::Little };
        let encoding = if self.field(&["BinaryData"]).is_some() && !self.flag(&["BinaryData"]) {
            Encoding::Text
        } else if self.flag(&["CompressedData"]) {
            Encoding::Zlib
        } else {
            Encoding::Raw
        };
        let frame = self.frame(path, count)?;
        self.say_what_is_passed_over(path);
        Ok(Layout { dims, dtype, endian, frame, encoding, frames })
    }

    fn needed(&self, path: &Path, key: &str) -> Result<&str, VolumeError> {
        self.field(&[key]).ok_or_else(|| {
            let what = format!("its MetaImage header has no {key}");
            format_error(path, Reason::header(what))
        })
    }

    /// The type of samples. A voxel must have only one value.
    fn dtype(&self, path: &Path) -> Result<Dtype, VolumeError> {
        let channels = self.field(&["ElementNumberOfChannels"]).unwrap_or("1");
        if channels != "1" {
            let what = format!("{channels} values a voxel (ElementNumberOfChannels)");
            let sizes = self.field(&["DimSize"]).unwrap_or_default();
            let sizes: Vec<u64> = sizes.split_whitespace().map_while(|n| n.parse().ok()).collect();
            let dims = <[u64; 3]>::try_from(sizes).ok();
            return Err(format_error(path, Reason::not_scalar(what, dims)));
        }
        let name = self.needed(path, "ElementType")?;
        scalar_type(name).ok_or_else(|| {
            let what = format!("holds samples of type {name}, which is not read");
            format_error(path, Reason::unsupported(what, "save it as MET_FLOAT"))
        })
    }

    /// The place of a grid with `count` axes.
    fn frame(&self, path: &Path, count: usize) -> Result<Frame, VolumeError> {
        let spacing = self.numbers(path, &SPACING, count, 1.0)?;
        let origin = self.numbers(path, &ORIGIN, count, 0.0)?;
        let [origin, spacing] = [(origin, 0.0), (spacing, 1.0)].map(|(numbers, default)| {
            [0, 1, 2].map(|k: usize| numbers.get(k).copied().unwrap_or(default))
        });
        // The rows of the matrix are the grid's axes. It has as many dimensions as the image.
        let mut axes = diagonal([1.0; 3]);
        if self.field(&MATRIX).is_some() {
            let matrix = self.numbers(path, &MATRIX, count * count, 0.0)?;
            for (axis, row) in axes.iter_mut().zip(matrix.chunks(count)) {
                let components = count.min(3);
                axis[..components].copy_from_slice(&row[..components]);
            }
        }
        for (axis, length) in axes.iter_mut().zip(spacing) {
            *axis = axis.map(|component| component * length);
        }
        layout::frame(path, origin, axes, self.coordinates())
    }

    /// The coordinates. `MetaImage` is LPS, and in millimetres unless `DistanceUnits` says otherwise.
    fn coordinates(&self) -> Coordinates {
        let keys = [SPACING.as_slice(), &ORIGIN, &MATRIX].concat();
        if self.field(&keys).is_none() {
            return Coordinates::VOXEL;
        }
        match self.field(&["DistanceUnits"]).map(LengthUnit::named) {
            Some(unit) if unit.is_known() => Coordinates { unit, ..Coordinates::PATIENT },
            _ => Coordinates::PATIENT,
        }
    }

    /// The number of bytes before the samples in each data file; `None` if the samples are at its end.
    fn skip(&self, path: &Path) -> Result<Option<u64>, VolumeError> {
        let text = self.field(&["HeaderSize"]).unwrap_or("0");
        match text.parse::<i64>() {
            Ok(-1) => Ok(None),
            Ok(skip) if skip >= 0 => Ok(Some(skip as u64)),
            _ => Err(format_error(
                path,
                Reason::header(format!("HeaderSize = {text} is not a number of bytes")),
            )),
        }
    }
}

impl Header {
    /// The position of the samples in the header's own file, whose first `lines` bytes are the header. `HeaderSize` counts from
    /// the first byte.
    fn start_of_local(
        &self,
        path: &Path,
        length: u64,
        lines: u64,
        layout: &Layout,
    ) -> Result<u64, VolumeError> {
        match self.skip(path)? {
            Some(0) => Ok(lines),
            Some(skip) if (lines..=length).contains(&skip) => Ok(skip),
            Some(skip) => {
                let what = format!(
                    "has samples at byte {skip} (HeaderSize), where its header or nothing is"
                );
                Err(format_error(path, Reason::header(what)))
            }
            None => Ok(length.saturating_sub(layout.bytes()).max(lines)),
        }
    }
}

fn scalar_type(name: &str) -> Option<Dtype> {
    Some(match name {
        "MET_CHAR" => Dtype::I8,
        "MET_UCHAR" => Dtype::U8,
        "MET_SHORT" => Dtype::I16,
        "MET_USHORT" => Dtype::U16,
        // These have four bytes in MetaIO on every machine.
        "MET_INT" | "MET_LONG" => Dtype::I32,
        "MET_UINT" | "MET_ULONG" => Dtype::U32,
        "MET_LONG_LONG" => Dtype::I64,
        "MET_ULONG_LONG" => Dtype::U64,
        "MET_FLOAT" => Dtype::F32,
        "MET_DOUBLE" => Dtype::F64,
        _ => return None,
    })
}
