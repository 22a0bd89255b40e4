//! One file of a series: its header and its slices.

use std::path::{Path, PathBuf};

use dicom_object::Tag;
use walpha_base::shown::shown;
use walpha_base::vector::cross;

use super::claims::{self, FLOAT_PIXEL_DATA, PIXEL_DATA, Pixels};
use super::header::Header;
use super::index::{self, Index};
use super::nuclear;
use super::segments::{self, Segment};
use super::start::Start;
use super::values::{Coding, Values};
use crate::error::{format_error, io_error};
use crate::read::payload::MOST_EXPANSION;
use crate::{Dtype, Reason, VolumeError};

/// The largest deviation of a direction's length from 1. A longer or shorter one would scale the distances of pixels.
const LONGER: f64 = 0.01;

// These are named as in part 6 of the standard.
const IMAGE_TYPE: Tag = Tag(0x0008, 0x0008);
const SOP_INSTANCE_UID: Tag = Tag(0x0008, 0x0018);
const MODALITY: Tag = Tag(0x0008, 0x0060);
const SERIES_DESCRIPTION: Tag = Tag(0x0008, 0x103E);
const SLICE_THICKNESS: Tag = Tag(0x0018, 0x0050);
const SPACING_BETWEEN_SLICES: Tag = Tag(0x0018, 0x0088);
const SERIES_INSTANCE_UID: Tag = Tag(0x0020, 0x000E);
const INSTANCE_NUMBER: Tag = Tag(0x0020, 0x0013);
const IMAGE_POSITION: Tag = Tag(0x0020, 0x0032);
const IMAGE_ORIENTATION: Tag = Tag(0x0020, 0x0037);
const SAMPLES_PER_PIXEL: Tag = Tag(0x0028, 0x0002);
const PHOTOMETRIC_INTERPRETATION: Tag = Tag(0x0028, 0x0004);
const NUMBER_OF_FRAMES: Tag = Tag(0x0028, 0x0008);
const ROWS: Tag = Tag(0x0028, 0x0010);
const COLUMNS: Tag = Tag(0x0028, 0x0011);
const PIXEL_SPACING: Tag = Tag(0x0028, 0x0030);
const REAL_WORLD_VALUE_MAPPING: Tag = Tag(0x0040, 0x9096);
/// The frame offsets of radiation doses (PS3.3, C.8.8.3).
const GRID_FRAME_OFFSETS: Tag = Tag(0x3004, 0x000C);
// These are functional groups.
const PLANE_POSITION: Tag = Tag(0x0020, 0x9113);
const PLANE_ORIENTATION: Tag = Tag(0x0020, 0x9116);
const PIXEL_MEASURES: Tag = Tag(0x0028, 0x9110);

/// The records of an index of a medium (DICOMDIR).
const DIRECTORY_RECORDS: Tag = Tag(0x0004, 0x1220);

/// One slice of a series, without its pixels.
#[derive(Clone, Debug)]
pub(super) struct Slice {
    pub path: PathBuf,
    /// The number of this frame in the file, from 0, and the number of frames of the file.
    pub frame: u32,
    pub frames: u32,
    /// The unique name of the file's content.
    pub instance: String,
    /// The number of the slice in its series, if each slice is a file.
    pub number: Option<f64>,
    pub columns: u64,
    pub rows: u64,
    /// The position of the first pixel in mm: x to the patient's left, y to the back, z to the head.
    pub position: [f64; 3],
    /// The unit vectors along which the column index and the row index increase.
    pub orientation: [[f64; 3]; 2],
    /// The distances between neighbouring columns and rows in mm.
    pub spacing: [f64; 2],
    /// The distance to the next slice according to the header, and the thickness of the slice.
    pub step: Option<f64>,
    pub thickness: Option<f64>,
    /// What the slice states about the volume of several that it belongs to.
    pub index: Vec<Index>,
    /// The meaning of its pixels.
    pub values: Values,
    /// The segment that it shows, if it belongs to a segmentation.
    pub segment: Option<Segment>,
}

/// A file of a series, which may have no slices.
#[derive(Debug)]
pub(super) struct DicomFile {
    pub path: PathBuf,
    /// The UID of its series.
    pub series: String,
    /// The modality, such as CT or MR.
    pub modality: String,
    pub description: String,
    /// Columns and rows, if it is an image.
    pub size: Option<[u64; 2]>,
    /// Whether the file is an index of a medium (DICOMDIR).
    pub is_directory: bool,
    /// Statements of the file that are not followed, or followed in another way. Each is reported once for a series.
    pub notes: Vec<String>,
    /// The slices, one for each frame, or the reason why there are none.
    pub slices: Result<Vec<Slice>, VolumeError>,
}

impl DicomFile {
    /// Reads the header of a file.
    pub(super) fn open(path: &Path) -> Result<Self, VolumeError> {
        let start = Start::of(path)?;
        let pixels = claims::check(path, &start)?;
        let object = start.object(path, Some(FLOAT_PIXEL_DATA))?;
        let header = Header::new(path, &object);
        let text = |tag| header.text(None, tag).unwrap_or_default();
        let number = |tag| header.number(None, tag).ok().flatten().map(|n| n as u64);
        let is_directory = header.has(DIRECTORY_RECORDS);
        let slices = if is_directory {
            Err(format_error(path, directory(path)))
        } else {
            Slice::all(path, header, pixels, &start)
        };
        Ok(Self {
            path: path.to_owned(),
            series: text(SERIES_INSTANCE_UID),
            modality: text(MODALITY),
            description: text(SERIES_DESCRIPTION),
            size: number(COLUMNS).zip(number(ROWS)).map(|(columns, rows)| [columns, rows]),
            is_directory,
            notes: notes(header, &start),
            slices,
        })
    }
}

/// The error for an index of a medium (DICOMDIR), which says what to open instead.
fn directory(path: &Path) -> Reason {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => shown(parent),
        _ => ".".into(),
    };
    let what = "is a DICOMDIR, the index of the files beside it, and holds no image";
    Reason::content(what, format!("name its folder, {folder}, or a file of the series"))
}

/// Statements of the file that are not followed, or followed in another way.
fn notes(header: Header<'_>, start: &Start) -> Vec<String> {
    let inverse =
        header.text(None, PHOTOMETRIC_INTERPRETATION).is_some_and(|of| of == "MONOCHROME1");
    let inverse = inverse.then(|| {
        "is MONOCHROME1, shown with the least value white: values are read as they are stored"
            .to_owned()
    });
    let mapped = header.of_frame(0).has(REAL_WORLD_VALUE_MAPPING);
    let mapped = mapped.then(|| {
        format!(
            "has a Real World Value Mapping {REAL_WORLD_VALUE_MAPPING}, which is passed over: \
                 values are those of the modality"
        )
    });
    start.guessed.clone().into_iter().chain(inverse).chain(mapped).collect()
}

impl Slice {
    /// The slices of a file, according to its header: as many as it has frames.
    fn all(
        path: &Path,
        header: Header<'_>,
        pixels: Option<Pixels>,
        start: &Start,
    ) -> Result<Vec<Self>, VolumeError> {
        let [column, row] = [COLUMNS, ROWS].map(|tag| header.number(None, tag));
        let (Some(columns), Some(rows)) = (column?, row?) else {
            let what = "holds no image";
            return Err(header.fail(Reason::content(
                what,
                "move it out of the folder, or name a file of a series",
            )));
        };
        let size = [columns as u64, rows as u64];
        check_colours(header, size)?;
        if header
            .text(None, IMAGE_TYPE)
            .is_some_and(|of| of.split('\\').any(|part| part == "MOSAIC"))
        {
            let what = "is a mosaic (Image Type with MOSAIC): all slices of a volume side by side in one picture";
            return Err(header.fail(Reason::unsupported(
                what,
                "convert it with dcm2niix, which takes it apart",
            )));
        }
        let coding = Coding::of(header, pixels.map(|pixels| pixels.tag))?;
        let frames = frames(path, header, size, coding, pixels)?;
        if let Some(Pixels { bytes: None, .. }) = pixels {
            check_compressed(header, coding, start)?;
        }
        if segments::is_segmentation(header) {
            segments::check(header)?;
        }
        let mut slices: Vec<Self> = (0..frames)
            .map(|frame| Self::of(path, header.of_frame(frame), size, [frame, frames], coding))
            .collect::<Result<_, _>>()?;
        spread(header, &mut slices)?;
        Ok(slices)
    }

    /// One of the frames of a file.
    fn of(
        path: &Path,
        header: Header<'_>,
        [columns, rows]: [u64; 2],
        [frame, frames]: [u32; 2],
        coding: Coding,
    ) -> Result<Self, VolumeError> {
        let next = "leave out localisers, reports and other pictures without a position in the patient, or convert them \
                    to NRRD with a spacing of your own";
        let name = "Image Position (Patient)";
        let position = header.vector::<3>(PLANE_POSITION, IMAGE_POSITION, name, next)?;
        let name = "Image Orientation (Patient)";
        let [a, b, c, d, e, f] =
            header.vector::<6>(PLANE_ORIENTATION, IMAGE_ORIENTATION, name, next)?;
        // The lengths of the directions, which are 1 up to the digits written.
        let lengths = [[a, b, c], [d, e, f]].map(|[x, y, z]| x.hypot(y).hypot(z));
        if lengths.iter().any(|length| (length - 1.0).abs() > LONGER) {
            let what = format!(
                "has {name} {IMAGE_ORIENTATION} of the lengths {lengths:?}, where directions have the length 1"
            );
            return Err(header.fail(Reason::header(what)));
        }
        // The standard puts the distance of rows first.
        let [of_rows, of_columns] =
            header.vector::<2>(PIXEL_MEASURES, PIXEL_SPACING, "Pixel Spacing", next)?;
        let number = (frames == 1).then(|| header.number(None, INSTANCE_NUMBER)).transpose()?;
        let segment = segments::of_frame(header)?;
        let values = Values::of(header, coding)?;
        Ok(Self {
            path: path.to_owned(),
            frame,
            frames,
            instance: header.text(None, SOP_INSTANCE_UID).unwrap_or_default(),
            number: number.flatten(),
            columns,
            rows,
            position,
            orientation: [[a, b, c], [d, e, f]],
            spacing: [of_columns, of_rows],
            step: header.number(PIXEL_MEASURES, SPACING_BETWEEN_SLICES)?,
            thickness: header.number(PIXEL_MEASURES, SLICE_THICKNESS)?,
            index: index::of_frame(header, frame),
            values: match &segment {
                Some(Segment { share: Some(most), .. }) => values.times(1.0 / most),
                _ => values,
            },
            segment,
        })
    }

    /// The name of its file, for people, and the number of the frame if there are several.
    pub(super) fn name(&self) -> String {
        let file = shown(&self.path);
        if self.frames == 1 { file } else { format!("frame {} of {file}", self.frame + 1) }
    }

    /// The direction from one slice to the next.
    pub(super) fn normal(&self) -> [f64; 3] {
        let [column, row] = self.orientation;
        cross(column, row)
    }

    /// The type of the values.
    pub(super) fn dtype(&self) -> Dtype {
        self.values.dtype()
    }
}

/// The number of frames of a file. The size of its pixels is compared with the header's claim.
fn frames(
    path: &Path,
    header: Header<'_>,
    [columns, rows]: [u64; 2],
    coding: Coding,
    pixels: Option<Pixels>,
) -> Result<u32, VolumeError> {
    let frames = header.number_or(NUMBER_OF_FRAMES, 1.0)?.max(1.0);
    let each = columns.saturating_mul(rows);
    let expected = coding.bytes(each.saturating_mul(frames as u64).max(1));
    let length = std::fs::metadata(path).map_err(io_error(path))?.len();
    let claim = format!("claims {frames} × {columns}×{rows} pixels");
    // Compression makes pixels smaller, but by a limited factor.
    if expected > length.saturating_mul(MOST_EXPANSION) {
        let what = format!("{claim}, which {length} bytes cannot hold: it is truncated or damaged");
        return Err(header.fail(Reason::truncated(what)));
    }
    let claim = format!("{claim}, which are {expected} bytes");
    match pixels {
        None => {
            let next =
                "copy it again if it is shorter than its original, or move it out of the folder";
            let what = format!("{claim}, and has none: no Pixel Data {PIXEL_DATA}");
            Err(header.fail(Reason::content(what, next)))
        }
        // Each compressed frame has at least one fragment, with a header of 8 bytes.
        Some(Pixels { bytes: None, .. }) if frames > (length / 8) as f64 => {
            let what = format!("{claim}, and {length} bytes in all: it is truncated or damaged");
            Err(header.fail(Reason::truncated(what)))
        }
        // Up to a frame of padding may follow, such as one byte that makes the length even.
        Some(Pixels { bytes: Some(found), .. })
            if found < expected || found - expected >= coding.bytes(each).max(2) =>
        {
            let what = format!("{claim}, and {found} bytes of them");
            Err(header.fail(Reason::header(what)))
        }
        Some(_) => Ok(frames as u32),
    }
}

/// Refuses colours, including those of a palette.
fn check_colours(header: Header<'_>, [columns, rows]: [u64; 2]) -> Result<(), VolumeError> {
    let photometric = header.text(None, PHOTOMETRIC_INTERPRETATION).unwrap_or_default();
    let what = if photometric == "PALETTE COLOR" {
        "pixels that are numbers of colours in a palette (PALETTE COLOR)".into()
    } else if header.number_or(SAMPLES_PER_PIXEL, 1.0)? != 1.0 {
        let named = if photometric.is_empty() { photometric } else { format!(" ({photometric})") };
        format!("pixels of colours{named}")
    } else {
        return Ok(());
    };
    let frames = header.number_or(NUMBER_OF_FRAMES, 1.0)?.max(1.0) as u64;
    Err(header.fail(Reason::not_scalar(what, Some([columns, rows, frames]))))
}

/// Refuses compressed pixels that have no decoder.
fn check_compressed(header: Header<'_>, coding: Coding, start: &Start) -> Result<(), VolumeError> {
    let next = "unpack it first, as `gdcmconv --raw` does";
    let bits = match coding {
        Coding::Integer { bytes: 1 | 2, .. } => return Ok(()),
        Coding::Bit => "1 bit".to_owned(),
        _ => format!("{} bits", 8 * coding.bytes(1)),
    };
    let what = format!(
        "has compressed pixels of {bits} (transfer syntax {}), which are not read",
        start.uid
    );
    Err(header.fail(Reason::unsupported(what, next)))
}

/// Places the frames of a file that states the distance of each from the first, as for doses and nuclear medicine.
fn spread(header: Header<'_>, slices: &mut [Slice]) -> Result<(), VolumeError> {
    let differ = |slices: &[Slice]| {
        let differ = |two: &[Slice]| {
            let [a, b] = [&two[0], &two[1]];
            a.position != b.position || a.index != b.index || a.segment != b.segment
        };
        slices.windows(2).any(differ)
    };
    if slices.len() < 2 || slices.windows(2).any(|two| two[0].position != two[1].position) {
        return Ok(());
    }
    if nuclear::is_nuclear(header) {
        return nuclear::place(header, slices);
    }
    if header.element(None, GRID_FRAME_OFFSETS).is_none() {
        if differ(slices) {
            return Ok(());
        }
        let what = format!(
            "has {} frames and one place for all of them: times, views or a cine, not a volume",
            slices.len()
        );
        return Err(
            header.fail(Reason::unsupported(what, "convert those of one volume to NRRD or NIfTI"))
        );
    }
    let offsets = header.numbers(None, GRID_FRAME_OFFSETS);
    if offsets.len() != slices.len() || offsets.iter().any(|offset| !offset.is_finite()) {
        return Err(header.fail(Reason::header(format!(
            "has {} frames, and Grid Frame Offset Vector {GRID_FRAME_OFFSETS} of {} numbers",
            slices.len(),
            offsets.len()
        ))));
    }
    for (slice, offset) in slices.iter_mut().zip(&offsets) {
        // If the first offset is not 0, offsets are positions along the axis, and the first is that of the file.
        slice.move_by(offset - offsets[0]);
    }
    Ok(())
}

impl Slice {
    /// Moves the slice along its normal.
    pub(super) fn move_by(&mut self, length: f64) {
        let normal = self.normal();
        self.position = [0, 1, 2].map(|k| self.position[k] + length * normal[k]);
    }
}
