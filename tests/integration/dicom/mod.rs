//! DICOM series, written here element by element as part 5 of the standard has them.

mod folders;
mod frames;
mod pixels;
mod segments;
mod spacings;
mod starts;
mod values;
mod volumes;

use std::fs;
use std::path::Path;

use walpha::Volume;
use walpha::volume::{ReadOptions, VolumeError, read};

use crate::common::Told;

/// An element: its group and number, its type, and its value.
pub(crate) type Element = (u16, u16, &'static [u8; 2], Vec<u8>);

/// A slice of 3 columns and 2 rows; its pixels are its number times 10, and up.
#[derive(Clone)]
pub(crate) struct Slice {
    pub series: &'static str,
    pub position: [f64; 3],
    pub orientation: &'static str,
    pub rows: u16,
    pub bits: u16,
    pub pixels: Vec<i16>,
    /// Slope and intercept.
    pub rescale: Option<(&'static str, &'static str)>,
    /// The transfer syntax, and the pixels as it packs them.
    pub packed: Option<(&'static str, Vec<u8>)>,
    /// Elements that take the place of others, or are left out where empty.
    pub changed: Vec<Element>,
}

pub(crate) fn slice(number: i16, z: f64) -> Slice {
    Slice {
        series: "1.2.3",
        position: [-10.0, 5.5, z],
        orientation: "1\\0\\0\\0\\1\\0",
        rows: 2,
        bits: 16,
        pixels: (0..6).map(|i| 10 * number + i).collect(),
        rescale: None,
        packed: None,
        changed: Vec::new(),
    }
}

pub(crate) fn element(group: u16, number: u16, kind: &[u8], value: &[u8]) -> Vec<u8> {
    let mut bytes = [group.to_le_bytes(), number.to_le_bytes()].concat();
    bytes.extend(kind);
    let length = value.len() + value.len() % 2;
    if [b"OW", b"OB", b"SQ", b"OF", b"OD"].iter().any(|long| kind == *long) {
        bytes.extend([0, 0]);
        bytes.extend((length as u32).to_le_bytes());
    } else {
        bytes.extend((length as u16).to_le_bytes());
    }
    bytes.extend(value);
    if value.len() % 2 == 1 {
        bytes.push(if kind == b"UI" || kind == b"OB" { 0 } else { b' ' });
    }
    bytes
}

/// The items of a sequence.
pub(crate) fn items(items: &[Vec<u8>]) -> Vec<u8> {
    let item = |data: &Vec<u8>| {
        [&[0xfe, 0xff, 0x00, 0xe0], &(data.len() as u32).to_le_bytes()[..], data].concat()
    };
    items.iter().flat_map(item).collect()
}

/// The group of elements that names the transfer syntax.
fn meta(syntax: &str) -> Vec<u8> {
    let meta = [
        element(2, 1, b"OB", &[0, 1]),
        element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2"),
        element(2, 3, b"UI", b"1.2.3.4"),
        element(2, 0x10, b"UI", syntax.as_bytes()),
        element(2, 0x12, b"UI", b"1.2.3.5"),
    ]
    .concat();
    [element(2, 0, b"UL", &(meta.len() as u32).to_le_bytes()), meta].concat()
}

impl Slice {
    /// Replaces or adds these elements.
    pub fn with(mut self, changed: impl IntoIterator<Item = Element>) -> Self {
        self.changed.extend(changed);
        self
    }

    /// The elements of its data set, except for packed pixels.
    fn elements(&self) -> Vec<Element> {
        let [x, y, z] = self.position;
        // A different name for each content.
        let content = self.pixels.iter().map(|&v| v as u64).chain([x, y, z].map(f64::to_bits));
        let instance = content.fold(7, |all: u64, part| all.wrapping_mul(31).wrapping_add(part));
        let number = |n: u16| n.to_le_bytes().to_vec();
        let text = |t: &str| t.as_bytes().to_vec();
        let (slope, intercept) = self.rescale.unwrap_or(("1", "0"));
        let pixels = if self.bits == 8 {
            self.pixels.iter().map(|&v| v as u8).collect()
        } else {
            self.pixels.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()
        };
        let signed = u16::from(self.bits == 16);
        let mut elements: Vec<Element> = vec![
            (8, 0x16, b"UI", text("1.2.840.10008.5.1.4.1.1.2")),
            (8, 0x18, b"UI", text(&format!("1.2.3.{instance}"))),
            (0x18, 0x50, b"DS", text("2.5")),
            (0x20, 0xe, b"UI", text(self.series)),
            (0x20, 0x32, b"DS", text(&format!("{x}\\{y}\\{z}"))),
            (0x20, 0x37, b"DS", text(self.orientation)),
            (0x28, 2, b"US", number(1)),
            (0x28, 4, b"CS", text("MONOCHROME2")),
            (0x28, 0x10, b"US", number(self.rows)),
            (0x28, 0x11, b"US", number(3)),
            (0x28, 0x30, b"DS", text("0.5\\0.75")),
            (0x28, 0x100, b"US", number(self.bits)),
            (0x28, 0x101, b"US", number(self.bits)),
            (0x28, 0x102, b"US", number(self.bits - 1)),
            (0x28, 0x103, b"US", number(signed)),
            (0x28, 0x1052, b"DS", text(intercept)),
            (0x28, 0x1053, b"DS", text(slope)),
            (0x7fe0, 0x10, b"OW", pixels),
        ];
        for (group, number, kind, value) in &self.changed {
            elements.retain(|e| (e.0, e.1) != (*group, *number));
            if !value.is_empty() {
                elements.push((*group, *number, kind, value.clone()));
            }
        }
        if self.packed.is_some() {
            elements.retain(|e| e.0 != 0x7fe0);
        }
        elements.sort_by_key(|e| (e.0, e.1));
        elements
    }

    pub fn bytes(&self) -> Vec<u8> {
        let syntax = self.packed.as_ref().map_or("1.2.840.10008.1.2.1", |(syntax, _)| syntax);
        let packed: Vec<u8> = self.packed.as_ref().map_or_else(Vec::new, |(_, pixels)| {
            // An empty table, one fragment, and the end.
            let head = [0xe0, 0x7f, 0x10, 0, b'O', b'B', 0, 0, 0xff, 0xff, 0xff, 0xff];
            let length = (pixels.len() as u32).to_le_bytes();
            let item = [0xfe, 0xff, 0, 0xe0];
            let end = [0xfe, 0xff, 0xdd, 0xe0, 0, 0, 0, 0];
            [&head[..], &item, &[0; 4], &item, &length, pixels, &end].concat()
        });
        [&[0; 128][..], b"DICM", &meta(syntax), &self.data(), &packed].concat()
    }

    /// Its data set, without packed pixels.
    fn data(&self) -> Vec<u8> {
        self.elements().iter().flat_map(|(g, n, k, v)| element(*g, *n, k.as_slice(), v)).collect()
    }

    pub fn save(&self, folder: &Path, name: &str) {
        fs::write(folder.join(name), self.bytes()).unwrap();
    }
}

pub(crate) fn open(path: &Path) -> Result<Volume, VolumeError> {
    read(path, &ReadOptions::default())
}

/// Saves slices under names that are not in order, and reads the folder.
fn series(slices: &[Slice]) -> Result<Volume, String> {
    let folder = tempfile::tempdir().unwrap();
    for (number, slice) in slices.iter().enumerate() {
        slice.save(folder.path(), &format!("{:02}.dcm", (7 * number + 3) % 11));
    }
    open(folder.path()).map_err(|error| error.told())
}

#[test]
fn slices_are_sorted_by_position_and_placed() {
    let slices = [slice(2, 34.0), slice(0, 30.0), slice(1, 32.0)];
    let volume = series(&slices).unwrap();
    assert_eq!(volume.dims().xyz(), [3, 2, 3]);
    let expected: Vec<f32> =
        (0..3).flat_map(|s| (0..6).map(move |i| (10 * s + i) as f32)).collect();
    assert_eq!(volume.as_slice(), expected);
    let frame = volume.frame();
    // The header gives the distance of rows first.
    assert_eq!((frame.spacing, frame.origin), ([0.75, 0.5, 2.0], [-10.0, 5.5, 30.0]));
    assert!(!volume.has_gray_levels());
    // Turned slices are ordered along their normal, here −y, and not along z.
    let turned = |number, y: f64| Slice {
        position: [1.0, y, 3.0],
        orientation: "1\\0\\0\\0\\0\\1",
        ..slice(number, 0.0)
    };
    let volume = series(&[turned(0, 9.0), turned(1, 5.0), turned(2, 1.0)]).unwrap();
    assert_eq!(volume.as_slice(), expected);
    assert_eq!(volume.frame().origin, [1.0, 9.0, 3.0]);
    assert_eq!(volume.frame().axes()[2], [0.0, -4.0, 0.0]);
    // A tilted gantry shifts slices against each other.
    let tilted =
        |n: i16| Slice { position: [0.0, f64::from(n), 2.0 * f64::from(n)], ..slice(n, 0.0) };
    let volume = series(&[tilted(0), tilted(1), tilted(2)]).unwrap();
    let [x, y, z] = volume.frame().axes()[2];
    assert!(x == 0.0 && (y - 1.0).abs() < 1e-12 && (z - 2.0).abs() < 1e-12);
}

#[test]
fn values_are_those_of_the_modality() {
    let rescaled = |n: i16| Slice { rescale: Some(("2", "-1024")), ..slice(n, f64::from(n)) };
    let volume = series(&[rescaled(0), rescaled(1)]).unwrap();
    assert_eq!(volume.as_slice()[..3], [-1024.0, -1022.0, -1020.0]);
    let negative = Slice { pixels: vec![-5, 4, 3, 2, 1, 0], ..slice(0, 0.0) };
    assert_eq!(series(&[negative]).unwrap().as_slice()[0], -5.0);
    let bytes = |n: i16| Slice { bits: 8, ..slice(n, f64::from(n)) };
    let volume = series(&[bytes(0), bytes(20)]).unwrap();
    assert!(volume.has_gray_levels());
    assert_eq!(volume.as_slice()[6..], [200.0, 201.0, 202.0, 203.0, 204.0, 205.0]);
    // A single slice is as thick as its header says.
    assert_eq!(series(&[slice(1, 7.0)]).unwrap().frame().spacing, [0.75, 0.5, 2.5]);
}

/// Some scanners write a TIFF header into the bytes before the mark.
#[test]
fn a_preamble_of_another_format_does_not_matter() {
    let folder = tempfile::tempdir().unwrap();
    for preamble in [b"II*\0", b"MM\0*"] {
        let mut bytes = slice(1, 7.0).bytes();
        bytes[..4].copy_from_slice(preamble);
        let path = folder.path().join("one.dcm");
        fs::write(&path, bytes).unwrap();
        let volume = open(&path).unwrap();
        assert_eq!(volume.dims().xyz(), [3, 2, 1]);
        assert_eq!(walpha::volume::format_name(&path, &ReadOptions::default()).unwrap(), "DICOM");
        assert_eq!(volume.dtype(), walpha::volume::Dtype::I16);
    }
}
