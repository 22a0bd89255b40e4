//! Segmentations: frames of one bit, shares, and label maps.

use std::path::Path;

use walpha::volume::{Dtype, ReadOptions, read};

use super::{Slice, element, items, open, slice};
use crate::common::{Told, json};

/// A frame: its segment, its height and its six pixels.
type Frame = (u16, f64, [u8; 6]);

/// A segmentation of these frames, 8 mm apart where the header says so.
fn segmentation(kind: &str, frames: &[Frame], step: Option<&str>) -> Slice {
    let us = |n: u16| n.to_le_bytes();
    let segment = |number: u16| {
        let label = format!("part {number}");
        [element(0x62, 4, b"US", &us(number)), element(0x62, 5, b"LO", label.as_bytes())].concat()
    };
    let mut numbers: Vec<u16> = frames.iter().map(|frame| frame.0).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let step = step.map(|step| element(0x18, 0x88, b"DS", step.as_bytes())).unwrap_or_default();
    let measures = [element(0x18, 0x50, b"DS", b"3"), step, element(0x28, 0x30, b"DS", b"1\\1")];
    let measures = element(0x28, 0x9110, b"SQ", &items(&[measures.concat()]));
    let frame = |&(number, z, _): &Frame| {
        let place = element(0x20, 0x32, b"DS", format!("0\\0\\{z}").as_bytes());
        let number = element(0x62, 0xb, b"US", &us(number));
        let number = element(0x62, 0xa, b"SQ", &items(&[number]));
        [element(0x20, 0x9113, b"SQ", &items(&[place])), number].concat()
    };
    let is_binary = kind == "BINARY";
    let bits = if is_binary { 1 } else { 8 };
    let pixels: Vec<u8> = frames.iter().flat_map(|frame| frame.2).collect();
    let pixels = if is_binary {
        let byte = |bits: &[u8]| bits.iter().rev().fold(0, |byte, bit| 2 * byte + bit);
        pixels.chunks(8).map(byte).collect()
    } else {
        pixels
    };
    let whole = [
        (8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.66.4".to_vec()),
        (8, 0x60, b"CS", b"SEG".to_vec()),
        (0x20, 0x32, b"DS", Vec::new()),
        (0x28, 8, b"IS", frames.len().to_string().into_bytes()),
        (0x28, 0x30, b"DS", Vec::new()),
        (0x28, 0x100, b"US", us(bits).to_vec()),
        (0x28, 0x101, b"US", us(bits).to_vec()),
        (0x28, 0x102, b"US", us(bits - 1).to_vec()),
        (0x28, 0x103, b"US", us(0).to_vec()),
        (0x28, 0x1052, b"DS", Vec::new()),
        (0x28, 0x1053, b"DS", Vec::new()),
        (0x62, 1, b"CS", kind.as_bytes().to_vec()),
        (0x62, 2, b"SQ", items(&numbers.into_iter().map(segment).collect::<Vec<_>>())),
        (0x62, 0xe, b"US", us(200).to_vec()),
        (0x5200, 0x9229, b"SQ", items(&[measures])),
        (0x5200, 0x9230, b"SQ", items(&frames.iter().map(frame).collect::<Vec<_>>())),
        (0x7fe0, 0x10, b"OB", pixels),
    ];
    slice(0, 0.0).with(whole)
}

fn saved(folder: &Path, segmentation: &Slice) -> std::path::PathBuf {
    segmentation.save(folder, "seg.dcm");
    folder.join("seg.dcm")
}

const LEFT: [u8; 6] = [1, 0, 0, 1, 0, 0];
const RIGHT: [u8; 6] = [0, 0, 1, 0, 1, 1];

#[test]
fn bits_are_labels_in_their_planes() {
    let folder = tempfile::tempdir().unwrap();
    // The frames are not in order, and one plane has no frame.
    let frames = [(3, 8.0, RIGHT), (1, 0.0, LEFT), (1, 8.0, LEFT), (3, 24.0, RIGHT)];
    let path = saved(folder.path(), &segmentation("BINARY", &frames, Some("8")));
    let volume = open(&path).unwrap();
    assert!(volume.states_labels());
    assert_eq!((volume.dims().xyz(), volume.dtype()), ([3, 2, 4], Dtype::U8));
    assert_eq!((volume.frame().origin, volume.frame().spacing), ([0.0; 3], [1.0, 1.0, 8.0]));
    let [one, three] = [LEFT.map(f32::from), RIGHT.map(|v| 3.0 * f32::from(v))];
    let both: Vec<f32> = one.iter().zip(three).map(|(a, b)| a + b).collect();
    assert_eq!(volume.as_slice(), [&one[..], &both, &[0.0; 6], &three].concat());
    // A single frame.
    let second = read(&path, &ReadOptions::default().frame(Some(1))).unwrap();
    assert_eq!(second.as_slice().iter().filter(|&&v| v == 3.0).count(), 6);
    assert_eq!(second.dims().z(), 3);
    // Parts of it state the same.
    let part = walpha::volume::Region { first: [0, 0, 1], end: [None; 3] };
    assert!(read(&path, &ReadOptions::default().region(Some(part))).unwrap().states_labels());
}

#[test]
fn segments_that_overlap_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let frames = [(1, 0.0, LEFT), (2, 0.0, [1, 1, 0, 0, 0, 0])];
    let path = saved(folder.path(), &segmentation("BINARY", &frames, None));
    let text = open(&path).unwrap_err().told();
    assert!(text.contains("segments that overlap, 1 (part 1) and 2 (part 2) in frame 2"), "{text}");
    assert!(text.contains("`frame` (0: 1 (part 1), 1: 2 (part 2))"), "{text}");
    let one = read(&path, &ReadOptions::default().frame(Some(1))).unwrap();
    assert_eq!(one.as_slice(), [2.0, 2.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(one.frame().spacing[2], 3.0);
}

#[test]
fn shares_are_values() {
    let folder = tempfile::tempdir().unwrap();
    let frames = [(1, 0.0, [0, 50, 100, 150, 200, 0]), (1, 3.0, [200; 6])];
    let path = saved(folder.path(), &segmentation("FRACTIONAL", &frames, None));
    let volume = open(&path).unwrap();
    assert_eq!(volume.as_slice()[..6], [0.0, 0.25, 0.5, 0.75, 1.0, 0.0]);
    assert!(!volume.states_labels() && volume.dtype() == Dtype::F32);
    let frames = [(1, 0.0, [200; 6]), (2, 0.0, [100; 6])];
    let path = saved(folder.path(), &segmentation("FRACTIONAL", &frames, None));
    assert!(open(&path).unwrap_err().told().contains("holds 2 volumes"));
    let second = read(&path, &ReadOptions::default().frame(Some(1))).unwrap();
    assert_eq!(second.as_slice(), [0.5; 6]);
}

#[test]
fn label_maps_and_other_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let frames = [(1, 0.0, [0, 1, 2, 3, 4, 5]), (1, 3.0, [5; 6])];
    let path = saved(folder.path(), &segmentation("LABELMAP", &frames, None));
    let volume = open(&path).unwrap();
    assert!(volume.states_labels() && volume.as_slice()[..6] == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let path = saved(folder.path(), &segmentation("OTHER", &frames, None));
    assert!(open(&path).unwrap_err().told().contains("is a segmentation of type \"OTHER\""));
}

/// A segmentation of a series with two spacings takes the nearest slice, and never mixes.
#[test]
fn planes_between_take_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let frames = [0.0, 1.0, 2.0, 5.0, 8.0].map(|z| (1, z, if z > 4.0 { RIGHT } else { LEFT }));
    let path = saved(folder.path(), &segmentation("BINARY", &frames, None));
    let volume = open(&path).unwrap();
    let planes: Vec<f32> = volume.as_slice().chunks(6).map(|plane| plane[0]).collect();
    assert_eq!(planes, [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(volume.as_slice().iter().all(|&v| v == 0.0 || v == 1.0));
    let warned = json(folder.path(), &["info", "seg.dcm"])["warnings"].to_string();
    assert!(warned.contains("take the nearest slice each"), "{warned}");
    let text = read(&path, &ReadOptions::default().no_resample(true)).unwrap_err().told();
    assert!(text.contains("omit `no_resample` to resample them to the nearest slice"), "{text}");
}
