//! One file of a series: its header, its slices and their pixels.

use std::path::{Path, PathBuf};

use dicom_encoding::{TransferSyntax, TransferSyntaxIndex};
use dicom_object::mem::InMemElement;
use dicom_object::{DefaultDicomObject, InMemDicomObject, OpenFileOptions, Tag};
use dicom_pixeldata::PixelDecoder;
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;
use walpha_base::shown::shown;
use walpha_base::vector::cross;

use super::claims::{self, PIXEL_DATA, damaged};
use crate::error::format_error;
use crate::read::payload::MOST_EXPANSION;
use crate::{Dtype, Reason, VolumeError};

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
// Of doses of radiation (PS3.3, C.8.8.3).
const GRID_FRAME_OFFSETS: Tag = Tag(0x3004, 0x000C);
const DOSE_GRID_SCALING: Tag = Tag(0x3004, 0x000E);
// Functional groups.
const PLANE_POSITION: Tag = Tag(0x0020, 0x9113);
const PLANE_ORIENTATION: Tag = Tag(0x0020, 0x9116);
const PIXEL_MEASURES: Tag = Tag(0x0028, 0x9110);
const PIXEL_VALUE_TRANSFORMATION: Tag = Tag(0x0028, 0x9145);

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
    /// What rescaled pixels are multiplied by, where they are doses.
    pub scaling: Option<f64>,
    /// How pixels of 32 bits are stored, which the decoder does not know.
    pub wide: Option<Wide>,
}

/// Pixels of 32 bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wide {
    unsigned: bool,
    slope: f64,
    intercept: f64,
}

/// A file of a series, whether it is a slice or not.
#[derive(Debug)]
pub(super) struct DicomFile {
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

impl DicomFile {
    /// Reads the header.
    pub(super) fn open(path: &Path) -> Result<Self, VolumeError> {
        let unpacked = claims::check(path)?;
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
            slices: Slice::all(path, &object, unpacked),
        })
    }
}

impl Slice {
    /// The slices of a file, from its header: one, or as many as it has frames. In a packed file, so many bytes are
    /// said to be pixels.
    fn all(
        path: &Path,
        object: &InMemDicomObject,
        unpacked: Option<u64>,
    ) -> Result<Vec<Self>, VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let header = Header::new(path, object);
        if header.number(None, SAMPLES_PER_PIXEL)?.unwrap_or(1.0) != 1.0 {
            return Err(fail(Reason::not_scalar("pixels of colours", None)));
        }
        let [column, row] = [COLUMNS, ROWS].map(|tag| header.number(None, tag));
        let (Some(columns), Some(rows)) = (column?, row?) else {
            return Err(fail(Reason::content(
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
            return Err(fail(Reason::truncated(format!(
                "claims {frames} × {columns}×{rows} pixels, which {length} bytes cannot hold: it is \
                 truncated or damaged"
            ))));
        }
        // One byte may be there to make their number even.
        let expected = frame.saturating_mul(frames as u64);
        if let Some(bytes) = unpacked.filter(|&bytes| bytes > expected.saturating_add(1)) {
            return Err(fail(Reason::header(format!(
                "claims {frames} × {columns}×{rows} pixels, which are {expected} bytes, and {bytes} bytes of them"
            ))));
        }
        let frames = frames as u32;
        let mut slices: Vec<Self> = (0..frames)
            .map(|frame| Self::of(path, header.of_frame(frame), size, [frame, frames]))
            .collect::<Result<_, _>>()?;
        Self::spread(path, object, &mut slices)?;
        Ok(slices)
    }

    /// Places the frames of a file that says how far each is from the first, as doses do.
    fn spread(
        path: &Path,
        object: &InMemDicomObject,
        slices: &mut [Self],
    ) -> Result<(), VolumeError> {
        let fail = |reason: Reason| format_error(path, reason);
        let places =
            |slices: &[Self]| slices.windows(2).any(|two| two[0].position != two[1].position);
        if slices.len() < 2 || places(slices) {
            return Ok(());
        }
        let Some(element) = object.get(GRID_FRAME_OFFSETS) else {
            return Err(fail(Reason::unsupported(
                format!(
                    "has {} frames and one place for all of them: times, views or a cine, and no volume",
                    slices.len()
                ),
                "convert those of one volume to NRRD or NIfTI",
            )));
        };
        let offsets = element.to_multi_float64().unwrap_or_default();
        if offsets.len() != slices.len() || offsets.iter().any(|offset| !offset.is_finite()) {
            return Err(fail(Reason::header(format!(
                "has {} frames, and Grid Frame Offset Vector {GRID_FRAME_OFFSETS} of {} numbers",
                slices.len(),
                offsets.len()
            ))));
        }
        for (slice, offset) in slices.iter_mut().zip(&offsets) {
            let [column, row] = slice.orientation;
            let normal = cross(column, row);
            // Where the first is not 0, they are places along the axis, of which the first is that of the file.
            let step = offset - offsets[0];
            slice.position = [0, 1, 2].map(|k| slice.position[k] + step * normal[k]);
        }
        Ok(())
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
        let scaling = header.number(None, DOSE_GRID_SCALING)?;
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
            dtype: if scaling.is_some() {
                Dtype::F32
            } else {
                dtype(bits, unsigned, slope, intercept)
            },
            scaling,
            wide: (bits == 32.0).then_some(Wide { unsigned, slope, intercept }),
        })
    }

    /// Pixels of 32 bits that are not compressed.
    fn wide_pixels(&self, wide: Wide, object: &InMemDicomObject) -> Result<Vec<f32>, VolumeError> {
        let path = &self.path;
        let fail = |reason: Reason| format_error(path, reason);
        let element = object.get(PIXEL_DATA).and_then(|element| element.value().primitive());
        let Some(value) = element else {
            let what = "has compressed pixels of 32 bits, which are not read";
            return Err(fail(Reason::unsupported(what, "unpack it first")));
        };
        let bytes = value.to_bytes();
        let each = (self.columns * self.rows) as usize;
        let (all, _) = bytes.as_chunks::<4>();
        let pixels = all.chunks_exact(each.max(1)).nth(self.frame as usize).ok_or_else(|| {
            fail(Reason::truncated(format!(
                "claims {} frames of {}×{} pixels and holds {} pixels: it is truncated or damaged",
                self.frames,
                self.columns,
                self.rows,
                all.len()
            )))
        })?;
        let Wide { unsigned, slope, intercept } = wide;
        let factor = self.scaling.unwrap_or(1.0);
        let value = |&bytes: &[u8; 4]| {
            let stored = if unsigned {
                f64::from(u32::from_le_bytes(bytes))
            } else {
                f64::from(i32::from_le_bytes(bytes))
            };
            ((stored * slope + intercept) * factor) as f32
        };
        Ok(pixels.iter().map(value).collect())
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
    check_syntax(path, &object)?;
    if let Some(wide) = first.wide {
        return slices.iter().map(|slice| slice.wide_pixels(wide, &object)).collect();
    }
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
        let failed = |error| damaged(path, &error);
        let pixels = if let Some(scaling) = slice.scaling {
            // Of 32 bits, often.
            let pixels = decoded.to_vec_frame::<f64>(slice.frame).map_err(failed)?;
            pixels.into_iter().map(|pixel| (pixel * scaling) as f32).collect()
        } else {
            decoded.to_vec_frame::<f32>(slice.frame).map_err(failed)?
        };
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

/// Refuses pixels that are compressed in a way that there is no decoder for.
fn check_syntax(path: &Path, object: &DefaultDicomObject) -> Result<(), VolumeError> {
    let uid = object.meta().transfer_syntax();
    let known = TransferSyntaxRegistry.get(uid);
    if known.is_some_and(TransferSyntax::can_decode_all) {
        return Ok(());
    }
    let name = known.map_or("a transfer syntax that is not known", |syntax| syntax.name());
    let what = format!("has pixels compressed as {name} ({uid}), which is not read");
    Err(format_error(path, Reason::unsupported(what, "unpack it first, as `gdcmconv --raw` does")))
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

const SHARED_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9229);
const PER_FRAME_FUNCTIONAL_GROUPS: Tag = Tag(0x5200, 0x9230);

/// The header of a file, as it applies to one of its frames: in enhanced images some elements are in
/// functional groups, of the frame or shared by all frames (PS3.3, C.7.6.16).
#[derive(Clone, Copy)]
struct Header<'a> {
    path: &'a Path,
    object: &'a InMemDicomObject,
    frame: Option<u32>,
}

impl<'a> Header<'a> {
    /// Of a file.
    fn new(path: &'a Path, object: &'a InMemDicomObject) -> Self {
        Self { path, object, frame: None }
    }

    /// As the frame has it that is counted from 0.
    fn of_frame(self, frame: u32) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// The functional groups that hold for the frame, its own first.
    fn groups(&self) -> impl Iterator<Item = &'a InMemDicomObject> {
        let items = |tag: Tag| self.object.get(tag).and_then(|sequence| sequence.items());
        let own = self.frame.and_then(|frame| {
            items(PER_FRAME_FUNCTIONAL_GROUPS).and_then(|items| items.get(frame as usize))
        });
        own.into_iter().chain(items(SHARED_FUNCTIONAL_GROUPS).and_then(|items| items.first()))
    }

    /// An element, from the functional group `group` where there is one.
    fn element(&self, group: Option<Tag>, tag: Tag) -> Option<&'a InMemElement> {
        let in_group = |all: &'a InMemDicomObject| {
            all.get(group?)?.items().and_then(|items| items.first())?.get(tag)
        };
        self.groups().find_map(in_group).or_else(|| self.object.get(tag))
    }

    /// A number, if it is there.
    fn number(&self, group: impl Into<Option<Tag>>, tag: Tag) -> Result<Option<f64>, VolumeError> {
        let Some(element) = self.element(group.into(), tag) else { return Ok(None) };
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

    /// `N` numbers, called `name`, which a volume needs because of `why`.
    fn vector<const N: usize>(
        &self,
        group: Tag,
        tag: Tag,
        name: &str,
        why: &str,
    ) -> Result<[f64; N], VolumeError> {
        let element = self.element(group.into(), tag);
        let numbers = element.and_then(|element| element.to_multi_float64().ok());
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).ok_or_else(|| {
            format_error(
                self.path,
                Reason::header(format!("has no {name} {tag} of {N} numbers, {why}")),
            )
        })
    }
}
