use std::path::{Path, PathBuf};

use dicom_object::{InMemDicomObject, OpenFileOptions, Tag};
use dicom_pixeldata::PixelDecoder;

use super::claims;
use super::header::Header;
use crate::shown::shown;
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
// Functional groups.
const PLANE_POSITION: Tag = Tag(0x0020, 0x9113);
const PLANE_ORIENTATION: Tag = Tag(0x0020, 0x9116);
const PIXEL_MEASURES: Tag = Tag(0x0028, 0x9110);
const PIXEL_VALUE_TRANSFORMATION: Tag = Tag(0x0028, 0x9145);
const PIXEL_DATA: Tag = Tag(0x7FE0, 0x0010);

/// One slice of a series: all but its pixels.
#[derive(Clone, Debug)]
pub(super) struct Slice {
    pub path: PathBuf,
    /// Which frame of the file it is, from 0, and how many the file has.
    pub frame: u32,
    pub frames: u32,
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
    /// The type of a pixel if pixels are used unscaled, otherwise `f32`.
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
    /// Its slices, one for each frame, or why it has none.
    pub slices: Result<Vec<Slice>, VolumeError>,
}

impl Found {
    /// Reads the header.
    pub(super) fn open(path: &Path) -> Result<Self, VolumeError> {
        claims::check(path)?;
        let object = OpenFileOptions::new()
            .read_until(PIXEL_DATA)
            .open_file(path)
            .map_err(|error| damaged(path, &error))?;
        let text = |tag| {
            let element = object.get(tag).and_then(|e| e.to_str().ok());
            element.map(|text| text.trim().to_owned()).unwrap_or_default()
        };
        let header = Header::new(path, &object);
        let number = |tag| header.number(None, tag).ok().flatten().map(|n| n as u64);
        Ok(Self {
            path: path.to_owned(),
            series: text(SERIES_INSTANCE_UID),
            modality: text(MODALITY),
            description: text(SERIES_DESCRIPTION),
            size: number(COLUMNS).zip(number(ROWS)).map(|(columns, rows)| [columns, rows]),
            slices: Slice::all(path, &object),
        })
    }
}

impl Slice {
    /// The slices of a file, from its header: one, or as many as it has frames.
    fn all(path: &Path, object: &InMemDicomObject) -> Result<Vec<Self>, VolumeError> {
        let said = |reason: Reason| format_error(path, reason);
        let header = Header::new(path, object);
        if header.number(None, SAMPLES_PER_PIXEL)?.unwrap_or(1.0) != 1.0 {
            return Err(said(Reason::unsupported(
                "has pixels of colours, and only gray is read",
                "convert it",
            )));
        }
        let [column, row] = [COLUMNS, ROWS].map(|tag| header.number(None, tag));
        let (Some(columns), Some(rows)) = (column?, row?) else {
            return Err(said(Reason::content(
                "holds no image",
                "move what is not a slice out of the folder",
            )));
        };
        let size = [columns as u64, rows as u64];
        let frames = header.number(None, NUMBER_OF_FRAMES)?.unwrap_or(1.0).max(1.0);
        let bits = header.number(None, BITS_ALLOCATED)?.unwrap_or(16.0);
        let frame =
            size[0].saturating_mul(size[1]).saturating_mul((bits as u64).div_ceil(8)).max(1);
        let length = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
        if frame.saturating_mul(frames as u64) > length.saturating_mul(MOST_EXPANSION) {
            return Err(said(Reason::truncated(format!(
                "claims {frames} × {columns}×{rows} pixels, which {length} bytes cannot hold: it is \
                 truncated or damaged"
            ))));
        }
        let frames = frames as u32;
        (0..frames)
            .map(|frame| Self::of(path, header.of_frame(frame), size, [frame, frames]))
            .collect()
    }

    /// One frame of several.
    fn of(
        path: &Path,
        header: Header<'_>,
        [columns, rows]: [u64; 2],
        [frame, frames]: [u32; 2],
    ) -> Result<Self, VolumeError> {
        let placed = "which a slice of a volume needs: move localisers and reports away";
        let name = "Image Position (Patient)";
        let position = header.vector::<3>(PLANE_POSITION, IMAGE_POSITION, name, placed)?;
        let name = "Image Orientation (Patient)";
        let [a, b, c, d, e, f] =
            header.vector::<6>(PLANE_ORIENTATION, IMAGE_ORIENTATION, name, placed)?;
        // The standard gives the distance of rows first.
        let [of_rows, of_columns] =
            header.vector::<2>(PIXEL_MEASURES, PIXEL_SPACING, "Pixel Spacing", placed)?;
        let thickness = match header.number(PIXEL_MEASURES, SPACING_BETWEEN_SLICES)? {
            Some(spacing) => spacing.abs(),
            None => header.number(PIXEL_MEASURES, SLICE_THICKNESS)?.unwrap_or(1.0),
        };
        let bits = header.number(None, BITS_ALLOCATED)?.unwrap_or(16.0);
        let unsigned = header.number(None, PIXEL_REPRESENTATION)?.unwrap_or(0.0) == 0.0;
        let slope = header.number(PIXEL_VALUE_TRANSFORMATION, RESCALE_SLOPE)?.unwrap_or(1.0);
        let intercept =
            header.number(PIXEL_VALUE_TRANSFORMATION, RESCALE_INTERCEPT)?.unwrap_or(0.0);
        Ok(Self {
            path: path.to_owned(),
            frame,
            frames,
            columns,
            rows,
            position,
            orientation: [[a, b, c], [d, e, f]],
            spacing: [of_columns, of_rows],
            thickness,
            dtype: dtype(bits, unsigned, slope, intercept),
        })
    }

    /// Its file, for people, and which frame it is of several.
    pub(super) fn name(&self) -> String {
        let file = shown(&self.path);
        if self.frames == 1 { file } else { format!("frame {} of {file}", self.frame + 1) }
    }
}

/// The pixels of frames of one file, row by row, in the units of the modality (rescaled, as Hounsfield
/// units are).
pub(super) fn pixels(slices: &[&Slice]) -> Result<Vec<Vec<f32>>, VolumeError> {
    let Some(&first) = slices.first() else { return Ok(Vec::new()) };
    let Slice { columns, rows, frames: claimed, .. } = *first;
    let path = &first.path;
    let object = dicom_object::open_file(path).map_err(|error| damaged(path, &error))?;
    let decoded = object.decode_pixel_data().map_err(|error| damaged(path, &error))?;
    // The decoder makes a table of all values, and panics if there are none.
    let (stored, allocated) = (decoded.bits_stored(), decoded.bits_allocated());
    if !(1..=allocated).contains(&stored) {
        let reason = Reason::damaged(format!("claims {stored} bits of the {allocated} of a pixel"));
        return Err(format_error(path, reason));
    }
    let found = decoded.number_of_frames();
    if found != claimed {
        let reason = Reason::truncated(format!(
            "claims {claimed} frames and holds {found}: it is truncated or damaged"
        ));
        return Err(format_error(path, reason));
    }
    let frame = |slice: &&Slice| {
        let pixels = decoded.to_vec_frame::<f32>(slice.frame);
        let pixels = pixels.map_err(|error| damaged(path, &error))?;
        let (found, claimed) = (pixels.len() as u64, columns * rows);
        if found != claimed {
            let reason = Reason::truncated(format!(
                "claims {columns}×{rows} pixels and holds {found}: it is truncated or damaged"
            ));
            return Err(format_error(path, reason));
        }
        Ok(pixels)
    };
    slices.iter().map(frame).collect()
}

/// The type of the rescaled values: that of the file, if pixels are only shifted by whole steps.
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
