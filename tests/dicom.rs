//! DICOM series, written here element by element as part 5 of the standard has them.
#![cfg(feature = "dicom")]

#[path = "common/told.rs"]
mod told;

use std::fs;
use std::path::Path;

use told::Told;
use walpha::Volume;
use walpha::volume::{ReadOptions, VolumeError, read};

/// A slice of 3 columns and 2 rows; its pixels are its number times 10, and up.
#[derive(Clone)]
struct Slice {
    series: &'static str,
    position: [f64; 3],
    orientation: &'static str,
    rows: u16,
    bits: u16,
    pixels: Vec<i16>,
    /// Slope and intercept.
    rescale: Option<(&'static str, &'static str)>,
    /// Elements that take the place of others, or are left out where empty.
    changed: Vec<(u16, u16, &'static [u8; 2], Vec<u8>)>,
}

fn slice(number: i16, z: f64) -> Slice {
    Slice {
        series: "1.2.3",
        position: [-10.0, 5.5, z],
        orientation: "1\\0\\0\\0\\1\\0",
        rows: 2,
        bits: 16,
        pixels: (0..6).map(|i| 10 * number + i).collect(),
        rescale: None,
        changed: Vec::new(),
    }
}

fn element(group: u16, number: u16, kind: &[u8], value: &[u8]) -> Vec<u8> {
    let mut bytes = [group.to_le_bytes(), number.to_le_bytes()].concat();
    bytes.extend(kind);
    let length = value.len() + value.len() % 2;
    if [b"OW", b"OB", b"SQ"].iter().any(|long| kind == *long) {
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

impl Slice {
    fn bytes(&self) -> Vec<u8> {
        let meta = [
            element(2, 1, b"OB", &[0, 1]),
            element(2, 2, b"UI", b"1.2.840.10008.5.1.4.1.1.2"),
            element(2, 3, b"UI", b"1.2.3.4"),
            element(2, 0x10, b"UI", b"1.2.840.10008.1.2.1"),
            element(2, 0x12, b"UI", b"1.2.3.5"),
        ]
        .concat();
        let [x, y, z] = self.position;
        let number = |n: u16| n.to_le_bytes().to_vec();
        let text = |t: &str| t.as_bytes().to_vec();
        let (slope, intercept) = self.rescale.unwrap_or(("1", "0"));
        let pixels = if self.bits == 8 {
            self.pixels.iter().map(|&v| v as u8).collect()
        } else {
            self.pixels.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()
        };
        let signed = u16::from(self.bits == 16);
        let mut elements: Vec<(u16, u16, &[u8; 2], Vec<u8>)> = vec![
            (8, 0x16, b"UI", text("1.2.840.10008.5.1.4.1.1.2")),
            (8, 0x18, b"UI", text("1.2.3.4")),
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
        elements.sort_by_key(|e| (e.0, e.1));
        let data: Vec<u8> =
            elements.iter().flat_map(|(g, n, k, v)| element(*g, *n, k.as_slice(), v)).collect();
        let length = element(2, 0, b"UL", &(meta.len() as u32).to_le_bytes());
        [&[0; 128][..], b"DICM", &length, &meta, &data].concat()
    }

    fn save(&self, folder: &Path, name: &str) {
        fs::write(folder.join(name), self.bytes()).unwrap();
    }
}

fn open(path: &Path) -> Result<Volume, VolumeError> {
    read(path, &ReadOptions::default())
}

/// Saves slices under names that are not in order, and reads the folder.
fn series(slices: &[Slice]) -> Result<Volume, String> {
    let folder = tempfile::tempdir().unwrap();
    for (number, slice) in slices.iter().enumerate() {
        slice.save(folder.path(), &format!("{:02}.dcm", (7 * number + 3) % 11));
    }
    open(folder.path()).map_err(|error| error.to_string())
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

/// The items of a sequence.
fn items(items: &[Vec<u8>]) -> Vec<u8> {
    let item = |data: &Vec<u8>| {
        [&[0xfe, 0xff, 0x00, 0xe0], &(data.len() as u32).to_le_bytes()[..], data].concat()
    };
    items.iter().flat_map(item).collect()
}

/// Frames of an enhanced image, at these heights; what they share stands once.
fn enhanced(heights: &[f64]) -> Slice {
    let group = |number, content: Vec<u8>| element(0x20, number, b"SQ", &items(&[content]));
    let measures = element(0x28, 0x30, b"DS", b"0.5\\0.75");
    let shared = [
        group(0x9116, element(0x20, 0x37, b"DS", b"1\\0\\0\\0\\1\\0")),
        element(0x28, 0x9110, b"SQ", &items(&[measures])),
    ];
    let frame = |(number, z): (usize, &f64)| {
        let place = element(0x20, 0x32, b"DS", format!("1\\2\\{z}").as_bytes());
        let rescale = [
            element(0x28, 0x1052, b"DS", format!("{}", 100 * number).as_bytes()),
            element(0x28, 0x1053, b"DS", b"1"),
        ];
        let rescale = element(0x28, 0x9145, b"SQ", &items(&[rescale.concat()]));
        [group(0x9113, place), rescale].concat()
    };
    let frames: Vec<Vec<u8>> = heights.iter().enumerate().map(frame).collect();
    let count = heights.len().to_string();
    let mut changed = vec![
        (0x28, 8, b"IS", count.into_bytes()),
        (0x5200, 0x9229, b"SQ", items(&[shared.concat()])),
        (0x5200, 0x9230, b"SQ", items(&frames)),
    ];
    let of_slices = [(0x20, 0x32), (0x20, 0x37), (0x28, 0x30), (0x28, 0x1052), (0x28, 0x1053)];
    changed.extend(of_slices.map(|(group, number)| (group, number, b"DS", Vec::new())));
    let pixels = (0..6 * heights.len() as i16).collect();
    Slice { pixels, changed, ..slice(0, 0.0) }
}

#[test]
fn frames_of_one_file_are_slices() {
    // Not in order, and each with an intercept of its own.
    let volume = series(&[enhanced(&[4.0, 0.0, 2.0])]).unwrap();
    assert_eq!(volume.dims().xyz(), [3, 2, 3]);
    let [first, second, third] = [6 + 100, 12 + 200, 0].map(|start| (0..6).map(move |i| start + i));
    let expected: Vec<f32> = first.chain(second).chain(third).map(|value| value as f32).collect();
    assert_eq!(volume.as_slice(), expected);
    let frame = volume.frame();
    assert_eq!((frame.spacing, frame.origin), ([0.75, 0.5, 2.0], [1.0, 2.0, 0.0]));
    let text = series(&[enhanced(&[0.0, 1.0, 1.0])]).unwrap_err();
    assert!(text.contains("two slices at one place, frame 2 of "), "{text}");
    let mut short = enhanced(&[0.0, 1.0, 2.0]);
    short.pixels.truncate(12);
    assert!(series(&[short]).unwrap_err().contains("03.dcm"));
    let mut many = enhanced(&[0.0, 1.0, 2.0]);
    many.changed[0].3 = b"2000000000".into();
    assert!(series(&[many]).unwrap_err().contains("claims 2000000000"));
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
    // One slice: as thick as its header says.
    assert_eq!(series(&[slice(1, 7.0)]).unwrap().frame().spacing, [0.75, 0.5, 2.5]);
}

#[test]
fn one_file_stands_for_its_series() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for n in 0..3 {
        slice(n, f64::from(n)).save(f, &format!("a{n}"));
        let other = Slice { series: "9.9", position: [0.0, 0.0, f64::from(n)], ..slice(n, 0.0) };
        other.save(f, &format!("b{n}.dcm"));
    }
    fs::write(f.join("notes.txt"), "no slice").unwrap();
    assert_eq!(open(&f.join("a1")).unwrap().frame().origin, [-10.0, 5.5, 0.0]);
    assert_eq!(open(&f.join("b2.dcm")).unwrap().frame().origin, [0.0; 3]);
    let text = open(f).unwrap_err().told();
    assert!(text.contains("2 DICOM series") && text.contains("b0.dcm"), "{text}");
}

#[test]
fn series_in_nested_folders_are_listed_and_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for n in 0..3i16 {
        let deep = f.join(format!("disc/{n}"));
        fs::create_dir_all(&deep).unwrap();
        slice(n, f64::from(n)).save(&deep, "slice");
        let other =
            Slice { series: "1.2.9", rows: 1, pixels: vec![n; 3], ..slice(n, 2.0 * f64::from(n)) };
        other.save(&deep, "other.dcm");
    }
    let of =
        |series: Option<&str>| read(f, &ReadOptions::default().series(series.map(str::to_owned)));
    let text = of(None).unwrap_err().told();
    assert!(text.contains("2 DICOM series") && text.contains("`series`"), "{text}");
    assert!(text.contains("3 slices of 3×1, 1.2.9, as "), "{text}");
    assert_eq!(of(Some("1")).unwrap().dims().xyz(), [3, 1, 3]);
    assert_eq!(of(Some(".9")).unwrap().dims().xyz(), [3, 1, 3]);
    assert_eq!(of(Some("2")).unwrap().dims().xyz(), [3, 2, 3]);
    assert!(of(Some("3")).unwrap_err().told().contains("no series 3"));
    let listed = walpha::volume::series(f).unwrap();
    assert_eq!(
        listed.iter().map(|one| (one.number, one.slices)).collect::<Vec<_>>(),
        [(1, 3), (2, 3)]
    );
    let frame = *of(Some("2")).unwrap().frame();
    assert_eq!(frame.coordinates, walpha::Coordinates::PATIENT);
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

#[test]
fn what_makes_no_volume_is_told() {
    let at = |n: i16| slice(n, f64::from(n));
    let with = |group, number, kind: &'static [u8; 2], value: &str| Slice {
        changed: vec![(group, number, kind, value.into())],
        ..at(1)
    };
    let cases: [(Slice, &[&str]); 9] = [
        (Slice { position: [-10.0, 5.5, 5.0], ..at(1) }, &["gap of 3.000 mm", "slices missing: 1"]),
        (Slice { position: [-10.0, 5.5, 2.0], ..at(1) }, &["two slices at one place"]),
        (Slice { orientation: "0\\1\\0\\0\\0\\1", ..at(1) }, &["different orientations"]),
        (Slice { rows: 1, ..at(1) }, &["3×1 pixels"]),
        (with(0x28, 0x30, b"DS", "0.5\\0.5"), &["mm apart"]),
        (with(0x20, 0x32, b"DS", ""), &["no Image Position", "localisers"]),
        (with(0x28, 8, b"IS", "4"), &["two slices at one place, frame 1 of "]),
        (with(0x20, 0x32, b"DS", "1\\2"), &["no Image Position"]),
        (Slice { pixels: vec![1, 2], ..at(1) }, &["cannot be read"]),
    ];
    for (other, parts) in cases {
        let text = series(&[at(0), other.clone(), at(2)]).unwrap_err();
        for part in parts {
            assert!(text.contains(part), "{part:?} is missing in {text}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let whole = at(0).bytes();
    for length in [132, 150, 200, 300, whole.len() - 40, whole.len() - 1] {
        fs::write(folder.path().join("a.dcm"), &whole[..length]).unwrap();
        let text = open(&folder.path().join("a.dcm")).unwrap_err().told();
        assert!(text.contains("a.dcm"), "{length}: {text}");
    }
    // An element that claims more than there is: of the data, and of the file's own table.
    let lies = |mark: &[u8], length: usize, claim: &[u8]| {
        let mut bytes = at(0).bytes();
        let place = bytes.windows(mark.len()).position(|part| part == mark).unwrap();
        bytes[place + length..place + length + claim.len()].copy_from_slice(claim);
        fs::write(folder.path().join("a.dcm"), bytes).unwrap();
        open(&folder.path().join("a.dcm")).unwrap_err().told()
    };
    let text = lies(b"\xe0\x7f\x10\x00OW", 8, &[0, 0, 0, 0x4e]);
    assert!(text.contains("claims an element of 1308622848 bytes"), "{text}");
    let text = lies(b"\x02\x00\x01\x00OB", 8, &[0, 0, 0, 0x4e]);
    assert!(text.contains("claims an element of 1308622848 bytes"), "{text}");
}
