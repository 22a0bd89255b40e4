use std::path::{Path, PathBuf};

use dicom_object::{DefaultDicomObject, OpenFileOptions, Tag};
use dicom_pixeldata::PixelDecoder;

use super::claims;
use crate::volume::read::format_error;
use crate::volume::read::payload::MOST_EXPANSION;
use crate::volume::{Dtype, Reason, VolumeError};

// By their names in part 6 of the standard.
const SLICE_THICKNESS: Tag = Tag(0x0018, 0x0050);
const SPACING_BETWEEN_SLICES: Tag = Tag(0x0018, 0x0088);
const MODALITY: Tag = Tag(0x0008, 0x0060);
const SERIES_DESCRIPTION: Tag = Tag(0x0008, 0x103E);
const SERIES_INSTANCE_UID: Tag = Tag(0x0020, 0x000E);
const IMAGE_POSITION: Tag = Tag(0x0020, 0x0032);
const IMAGE_ORIENTATION: Tag = Tag(0x0020, 0x0037);
const SAMPLES_PER_PIXEL: Tag = Tag(0x0028, 0x0002);
const NUMBER_OF_FRAMES: Tag = Tag(0x0028, 0x0008);
const ROWS: Tag = Tag(0x0028, 0x0010);
const COLUMNS: Tag = Tag(0x0028, 0x0011);
const PIXEL_SPACING: Tag = Tag(0x0028, 0x0030);
const BITS_ALLOCATED: Tag = Tag(0x0028, 0x0100);
const PIXEL_REPRESENTATION: Tag = Tag(0x0028, 0x0103);
const RESCALE_INTERCEPT: Tag = Tag(0x0028, 0x1052);
const RESCALE_SLOPE: Tag = Tag(0x0028, 0x1053);
const PIXEL_DATA: Tag = Tag(0x7FE0, 0x0010);

/// One slice of a series: all but its pixels.
#[derive(Clone, Debug)]
pub(super) struct Slice {
    pub path: PathBuf,
    pub columns: u64,
    pub rows: u64,
    /// Where its first pixel lies, in mm: x to the patient's left, y to the back, z to the head.
    pub position: [f64; 3],
    /// Unit vectors along which the column and the row index grow.
    pub orientation: [[f64; 3]; 2],
    /// Distance of neighbouring columns and rows in mm.
    pub spacing: [f64; 2],
    /// Distance to the next slice as the header has it, for a series of one.
    pub thickness: f64,
    /// The type of a pixel, where they stand for themselves; else `f32`.
    pub dtype: Dtype,
}

/// A file of a series, whether it is a slice or not.
#[derive(Debug)]
pub(super) struct Found {
    pub path: PathBuf,
    /// The unique name of its series.
    pub series: String,
    /// As CT or MR.
    pub modality: String,
    pub description: String,
    /// Columns and rows, if it is an image.
    pub size: Option<[u64; 2]>,
    /// What it is as a slice, or why it is none.
    pub slice: Result<Slice, VolumeError>,
}

impl Found {
    /// Reads what stands before the pixels.
    pub fn open(path: &Path) -> Result<Self, VolumeError> {
        claims::check(path)?;
        let object = OpenFileOptions::new()
            .read_until(PIXEL_DATA)
            .open_file(path)
            .map_err(|error| damaged(path, &error))?;
        let text = |tag| {
            let element = object.get(tag).and_then(|e| e.to_str().ok());
            element.map(|text| text.trim().to_owned()).unwrap_or_default()
        };
        let header = Header { path, object: &object };
        let number = |tag| header.number(tag).ok().flatten().map(|n| n as u64);
        Ok(Self {
            path: path.to_owned(),
            series: text(SERIES_INSTANCE_UID),
            modality: text(MODALITY),
            description: text(SERIES_DESCRIPTION),
            size: number(COLUMNS).zip(number(ROWS)).map(|(columns, rows)| [columns, rows]),
            slice: Slice::of(path, &object),
        })
    }
}

impl Slice {
    /// Of what stands before the pixels.
    fn of(path: &Path, object: &DefaultDicomObject) -> Result<Self, VolumeError> {
        let said = |reason: Reason| format_error(path, reason);
        let header = Header { path, object };
        let frames = header.number(NUMBER_OF_FRAMES)?.unwrap_or(1.0);
        if frames > 1.0 {
            return Err(said(Reason::content(
                format!("holds {frames} frames, and series of single slices are read"),
                "convert it to NRRD or NIfTI",
            )));
        }
        if header.number(SAMPLES_PER_PIXEL)?.unwrap_or(1.0) != 1.0 {
            return Err(said(Reason::unsupported(
                "has pixels of colours, and only gray is read",
                "convert it",
            )));
        }
        let [column, row] = [COLUMNS, ROWS].map(|tag| header.number(tag));
        let (Some(columns), Some(rows)) = (column?, row?) else {
            return Err(said(Reason::content(
                "holds no image",
                "move what is no slice out of the folder",
            )));
        };
        let placed = "which a slice of a volume needs: move localisers and reports away";
        let position = header.vector::<3>(IMAGE_POSITION, "Image Position (Patient)", placed)?;
        let [a, b, c, d, e, f] =
            header.vector::<6>(IMAGE_ORIENTATION, "Image Orientation (Patient)", placed)?;
        // The standard gives the distance of rows first.
        let [of_rows, of_columns] = header.vector::<2>(PIXEL_SPACING, "Pixel Spacing", placed)?;
        let thickness = match header.number(SPACING_BETWEEN_SLICES)? {
            Some(spacing) => spacing.abs(),
            None => header.number(SLICE_THICKNESS)?.unwrap_or(1.0),
        };
        let bits = header.number(BITS_ALLOCATED)?.unwrap_or(16.0);
        let (columns, rows) = (columns as u64, rows as u64);
        let claimed = columns.saturating_mul(rows).saturating_mul((bits as u64).div_ceil(8));
        let length = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
        if claimed > length.saturating_mul(MOST_EXPANSION) {
            return Err(said(Reason::truncated(format!(
                "claims {columns}×{rows} pixels, which {length} bytes cannot hold: it is \
                     truncated or damaged"
            ))));
        }
        let unsigned = header.number(PIXEL_REPRESENTATION)?.unwrap_or(0.0) == 0.0;
        let slope = header.number(RESCALE_SLOPE)?.unwrap_or(1.0);
        let intercept = header.number(RESCALE_INTERCEPT)?.unwrap_or(0.0);
        Ok(Self {
            path: path.to_owned(),
            columns,
            rows,
            position,
            orientation: [[a, b, c], [d, e, f]],
            spacing: [of_columns, of_rows],
            thickness,
            dtype: dtype(bits, unsigned, slope, intercept),
        })
    }

    /// The pixels, row by row, in the units of the modality (rescaled, as Hounsfield units are).
    pub fn pixels(&self) -> Result<Vec<f32>, VolumeError> {
        let path = &self.path;
        let object = dicom_object::open_file(path).map_err(|error| damaged(path, &error))?;
        let pixels = object.decode_pixel_data().and_then(|pixels| pixels.to_vec::<f32>());
        let pixels = pixels.map_err(|error| damaged(path, &error))?;
        let (found, claimed) = (pixels.len() as u64, self.columns * self.rows);
        if found != claimed {
            let (columns, rows) = (self.columns, self.rows);
            let reason = Reason::truncated(format!(
                "claims {columns}×{rows} pixels and holds {found}: it is truncated or damaged"
            ));
            return Err(format_error(path, reason));
        }
        Ok(pixels)
    }
}

/// The type of the numbers that pixels stand for: that of the file, if these are shifted by whole steps.
fn dtype(bits: f64, unsigned: bool, slope: f64, intercept: f64) -> Dtype {
    match (bits as u64, unsigned) {
        (8, true) if (slope, intercept) == (1.0, 0.0) => Dtype::U8,
        _ if slope != 1.0 || intercept.fract() != 0.0 => Dtype::F32,
        (8, false) => Dtype::I8,
        (16, true) if intercept >= 0.0 => Dtype::U16,
        (16, _) => Dtype::I16,
        _ => Dtype::F32,
    }
}

pub(super) fn damaged(path: &Path, error: &dyn std::error::Error) -> VolumeError {
    let mut what = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        what = format!("{what}, {inner}");
        cause = inner.source();
    }
    let reason = Reason::content(
        format!("is a DICOM file that cannot be read ({what})"),
        "copy it again, or convert the series to NRRD",
    );
    format_error(path, reason)
}

struct Header<'a> {
    path: &'a Path,
    object: &'a DefaultDicomObject,
}

impl Header<'_> {
    fn number(&self, tag: Tag) -> Result<Option<f64>, VolumeError> {
        let Some(element) = self.object.get(tag) else { return Ok(None) };
        if element.value().multiplicity() == 0 {
            return Ok(None);
        }
        let number = element.to_float64().ok().filter(|number| number.is_finite());
        number.map(Some).ok_or_else(|| {
            format_error(
                self.path,
                Reason::damaged(format!("has no number at {tag}: it is damaged")),
            )
        })
    }

    fn vector<const N: usize>(
        &self,
        tag: Tag,
        name: &str,
        why: &str,
    ) -> Result<[f64; N], VolumeError> {
        let numbers = self.object.get(tag).and_then(|element| element.to_multi_float64().ok());
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).ok_or_else(|| {
            format_error(
                self.path,
                Reason::header(format!("has no {name} {tag} of {N} numbers, {why}")),
            )
        })
    }
}
