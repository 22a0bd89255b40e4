//! Enhanced images and radiation doses: several frames in one file.

use super::{Slice, element, items, open, series, slice};
use crate::common::Told;

/// Frames of an enhanced image, at these heights; what they share stands once.
pub(super) fn enhanced(heights: &[f64]) -> Slice {
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
    // The frames are not in order, and each has its own intercept.
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

/// Three frames at 30, 32 and 34 mm of 32 bits, with such offsets.
fn dose(offsets: &str) -> Slice {
    let number = |n: u16| n.to_le_bytes().to_vec();
    let pixels = (0..18u32).flat_map(|i| (100_000 * i + 1).to_le_bytes()).collect();
    let changed = vec![
        (8, 0x60, b"CS", b"RTDOSE".to_vec()),
        (0x28, 8, b"IS", b"3".to_vec()),
        (0x28, 0x100, b"US", number(32)),
        (0x28, 0x101, b"US", number(32)),
        (0x28, 0x102, b"US", number(31)),
        (0x28, 0x103, b"US", number(0)),
        (0x28, 0x1052, b"DS", Vec::new()),
        (0x28, 0x1053, b"DS", Vec::new()),
        (0x3004, 0xc, b"DS", offsets.as_bytes().to_vec()),
        (0x3004, 0xe, b"DS", b"0.0005".to_vec()),
        (0x7fe0, 0x10, b"OW", pixels),
    ];
    Slice { changed, ..slice(0, 30.0) }
}

#[test]
fn a_dose_is_a_volume_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    // The places start from the first, or are places of the patient.
    for (offsets, order) in
        [("0\\2\\4", [0, 1, 2]), ("30\\32\\34", [0, 1, 2]), ("0\\-2\\-4", [2, 1, 0])]
    {
        dose(offsets).save(folder.path(), "dose.dcm");
        let volume = open(&folder.path().join("dose.dcm")).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((volume.dims().xyz(), volume.dtype()), ([3, 2, 3], walpha::volume::Dtype::F32));
        let value = |i: u32| (f64::from(100_000 * i + 1) * 0.0005) as f32;
        let frames = order.into_iter().flat_map(|frame| (0..6).map(move |i| value(6 * frame + i)));
        assert_eq!(volume.as_slice(), frames.collect::<Vec<f32>>(), "{offsets}");
        let lowest = if order[0] == 0 { 30.0 } else { 26.0 };
        let frame = volume.frame();
        assert_eq!((frame.spacing, frame.origin), ([0.75, 0.5, 2.0], [-10.0, 5.5, lowest]));
    }
    for (offsets, words) in
        [("0\\2", "Grid Frame Offset Vector"), ("", "one place for all of them")]
    {
        dose(offsets).save(folder.path(), "dose.dcm");
        let error = open(&folder.path().join("dose.dcm")).unwrap_err().told();
        assert!(error.contains(words) && !error.contains("echoes"), "{error}");
    }
}
