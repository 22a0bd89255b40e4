//! Enhanced images: the frames of one file are slices.

use super::{Slice, element, series, slice};

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
