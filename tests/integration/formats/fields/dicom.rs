//! The fields of DICOM.

use std::fs;
use std::path::{Path, PathBuf};

use walpha::volume::{ReadOptions, read};

use super::{Fate, Field, walk};
use crate::common::json;
use crate::dicom::{Element, Slice, element, items, open, slice};

fn us(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A folder of three slices, each with these elements.
fn three(folder: &Path, elements: &[Element]) -> PathBuf {
    at(folder, &[0.0, 1.0, 2.0], elements)
}

/// A folder of slices at these heights.
fn at(folder: &Path, heights: &[f64], elements: &[Element]) -> PathBuf {
    for (n, &z) in (0..).zip(heights) {
        slice(n, z).with(elements.iter().cloned()).save(folder, &format!("{n}.dcm"));
    }
    folder.to_owned()
}

/// One file.
fn one(folder: &Path, slice: &Slice) -> PathBuf {
    slice.save(folder, "a.dcm");
    folder.join("a.dcm")
}

fn first(path: &Path) -> Vec<f32> {
    open(path).unwrap().as_slice()[..3].to_vec()
}

/// A sequence of one item.
fn sequence(group: u16, number: u16, content: &[Vec<u8>]) -> Element {
    (group, number, b"SQ", items(&[content.concat()]))
}

/// The bytes of a [`sequence`] inside an item.
fn inner(group: u16, number: u16, content: &[Vec<u8>]) -> Vec<u8> {
    let (group, number, kind, value) = sequence(group, number, content);
    element(group, number, kind, &value)
}

fn table() -> Element {
    let descriptor = element(0x28, 0x3002, b"US", &us(&[2, 1, 16]));
    sequence(0x28, 0x3000, &[descriptor, element(0x28, 0x3006, b"OW", &us(&[70, 80]))])
}

/// An enhanced image of two frames, whose groups also hold these elements.
fn enhanced(folder: &Path, of_frame: fn(u8) -> Vec<u8>) -> PathBuf {
    let frame = |n: u8| {
        let place = element(0x20, 0x32, b"DS", format!("1\\2\\{n}").as_bytes());
        [inner(0x20, 0x9113, &[place]), of_frame(n)].concat()
    };
    let elements = [
        (0x20, 0x32, b"DS", Vec::new()),
        (0x28, 8, b"IS", b"2".to_vec()),
        (0x5200, 0x9230, b"SQ", items(&[frame(0), frame(4)])),
    ];
    one(folder, &Slice { pixels: (0..12).collect(), ..slice(0, 0.0) }.with(elements))
}

fn field(name: &'static str, file: fn(&Path) -> PathBuf, fate: Fate) -> Field {
    Field { name, file, fate }
}

#[test]
fn dicom() {
    use Fate::{PassedOver, Read, Refused};
    walk(
        "DICOM",
        &[
            field(
                "Transfer Syntax UID",
                |f| {
                    let data = slice(1, 0.0).bytes();
                    fs::write(f.join("a"), &data[128 + 4..]).unwrap();
                    f.join("a")
                },
                Read(|path| assert_eq!(first(path), [10.0, 11.0, 12.0])),
            ),
            field(
                "Transfer Syntax UID of JPEG-LS, video and others",
                |f| {
                    one(
                        f,
                        &Slice {
                            packed: Some(("1.2.840.10008.1.2.4.80", vec![1, 2])),
                            ..slice(0, 0.0)
                        },
                    )
                },
                Refused(&["JPEG-LS Lossless", "gdcmconv --raw"]),
            ),
            field(
                "no Transfer Syntax UID",
                |f| {
                    let bytes = slice(1, 0.0).bytes();
                    let data = bytes.windows(4).position(|part| part == [8, 0, 0x16, 0]).unwrap();
                    fs::write(f.join("a"), &bytes[data..]).unwrap();
                    f.join("a")
                },
                PassedOver(&[
                    "does not say how it is encoded, and is read as explicit little endian",
                ]),
            ),
            field(
                "Directory Record Sequence (DICOMDIR)",
                |f| {
                    one(
                        f,
                        &slice(0, 0.0).with([(
                            4,
                            0x1220,
                            b"SQ",
                            Vec::from([0xfe, 0xff, 0, 0xe0, 0, 0, 0, 0]),
                        )]),
                    )
                },
                Refused(&["is a DICOMDIR", "name its folder"]),
            ),
            field(
                "SOP Instance UID",
                |f| {
                    slice(1, 0.0).save(f, "copy.dcm");
                    at(f, &[2.0, 0.0, 1.0], &[]);
                    slice(1, 0.0).save(f, "1.dcm");
                    f.to_owned()
                },
                Read(|path| {
                    let told = json(path, &["info", "."]);
                    assert!(told["warnings"].to_string().contains("1 slice of"), "{told}");
                    assert_eq!(told["dims"][2], 3, "{told}");
                }),
            ),
            field(
                "Series Instance UID",
                |f| {
                    Slice { series: "9.9", ..slice(7, 9.0) }.save(f, "other.dcm");
                    at(f, &[0.0, 1.0], &[]).join("0.dcm")
                },
                Read(|path| assert_eq!(open(path).unwrap().dims().z(), 2)),
            ),
            field(
                "Rows, Columns, Number of Frames",
                |f| one(f, &slice(0, 0.0).with([(0x28, 8, b"IS", b"2".to_vec())])),
                Refused(&["claims 2 × 3×2 pixels, which are 24 bytes, and 12 bytes of them"]),
            ),
            field(
                "Photometric Interpretation of colours",
                |f| three(f, &[(0x28, 4, b"CS", b"PALETTE COLOR".to_vec())]),
                Read(|path| {
                    let told = json(path, &["info", "."]);
                    assert!(told["voxels"].to_string().contains("PALETTE COLOR"), "{told}");
                    assert!(open(path).is_err());
                }),
            ),
            field(
                "Photometric Interpretation MONOCHROME1",
                |f| three(f, &[(0x28, 4, b"CS", b"MONOCHROME1".to_vec())]),
                PassedOver(&["is MONOCHROME1", "values are read as they are stored"]),
            ),
            field(
                "Bits Allocated, Bits Stored, High Bit, Pixel Representation",
                |f| {
                    let bits = [(0x28, 0x101, b"US", us(&[4])), (0x28, 0x102, b"US", us(&[4]))];
                    let pixels = vec![0b10_0000, 0b1_1110, 0b1_0000, 0, 0, 0];
                    one(f, &Slice { pixels, ..slice(0, 0.0) }.with(bits))
                },
                Read(|path| assert_eq!(first(path), [0.0, -1.0, -8.0])),
            ),
            field(
                "Bits Allocated other than 1, 8, 16 and 32",
                |f| {
                    one(
                        f,
                        &slice(0, 0.0).with([
                            (0x28, 0x100, b"US", us(&[12])),
                            (0x28, 0x101, b"US", us(&[12])),
                        ]),
                    )
                },
                Refused(&["has pixels of 12 bits"]),
            ),
            field(
                "Float Pixel Data, Double Float Pixel Data",
                |f| {
                    let values: Vec<u8> =
                        [0.5f32; 6].iter().flat_map(|v| v.to_le_bytes()).collect();
                    let elements = [(0x7fe0, 0x10, b"OW", Vec::new()), (0x7fe0, 8, b"OF", values)];
                    one(f, &slice(0, 0.0).with(elements))
                },
                Read(|path| assert_eq!(first(path), [0.5; 3])),
            ),
            field(
                "Rescale Slope, Rescale Intercept",
                |f| {
                    three(
                        f,
                        &[
                            (0x28, 0x1053, b"DS", b"2".to_vec()),
                            (0x28, 0x1052, b"DS", b"-5".to_vec()),
                        ],
                    )
                },
                Read(|path| assert_eq!(first(path), [-5.0, -3.0, -1.0])),
            ),
            field(
                "Modality LUT Sequence",
                |f| three(f, &[table()]),
                Read(|path| assert_eq!(first(path), [70.0, 70.0, 80.0])),
            ),
            field(
                "Modality LUT Sequence beside a rescale",
                |f| three(f, &[table(), (0x28, 0x1053, b"DS", b"2".to_vec())]),
                Refused(&["states a Modality LUT Sequence", "only one of them can hold"]),
            ),
            field(
                "Real World Value Mapping Sequence",
                |f| {
                    three(
                        f,
                        &[sequence(
                            0x40,
                            0x9096,
                            &[element(0x40, 0x9225, b"FD", &2f64.to_le_bytes())],
                        )],
                    )
                },
                PassedOver(&["Real World Value Mapping (0040,9096), which is passed over"]),
            ),
            field(
                "Pixel Padding Value, Pixel Padding Range Limit",
                |f| three(f, &[(0x28, 0x120, b"SS", us(&[0])), (0x28, 0x121, b"SS", us(&[1]))]),
                Read(|path| {
                    let volume = open(path).unwrap();
                    assert!(
                        volume.is_missing(0)
                            && volume.is_missing(1)
                            && volume.samples_there() == 16
                    );
                }),
            ),
            field(
                "Image Orientation that has not the length 1",
                |f| {
                    let orientation = "2\\0\\0\\0\\2\\0";
                    (0..3).for_each(|n| {
                        Slice { orientation, ..slice(n, f64::from(n)) }
                            .save(f, &format!("{n}.dcm"));
                    });
                    f.to_owned()
                },
                Refused(&["of the lengths [2.0, 2.0], where directions have the length 1"]),
            ),
            field(
                "Image Position, Image Orientation",
                |f| {
                    let orientation = "0\\1\\0\\1\\0\\0";
                    let turned = |n: i16| Slice { orientation, ..slice(n, f64::from(-n)) };
                    (0..3).for_each(|n| turned(n).save(f, &format!("{n}.dcm")));
                    f.to_owned()
                },
                Read(|path| {
                    let frame = *open(path).unwrap().frame();
                    assert_eq!(frame.axes(), [[0.0, 0.75, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, -1.0]]);
                }),
            ),
            field(
                "no Image Position",
                |f| three(f, &[(0x20, 0x32, b"DS", Vec::new())]),
                Refused(&["has no Image Position (Patient)", "leave out localisers"]),
            ),
            field(
                "Image Position of several distances",
                |f| at(f, &[0.0, 1.0, 2.0, 4.0, 6.0], &[]),
                PassedOver(&["resampled linearly to 7 slices 1 mm apart"]),
            ),
            field(
                "Image Position with a hole",
                |f| at(f, &[0.0, 1.0, 3.0, 4.0], &[]),
                Refused(&["gap of 2.000 mm between", "(slices missing: 1)"]),
            ),
            field(
                "Instance Number",
                |f| {
                    for (n, z) in (0i16..).zip([0.0, 1.0, 2.0, 4.0]) {
                        let number = (0x20, 0x13, b"IS", format!("{n}").into_bytes());
                        slice(n, z).with([number]).save(f, &format!("{n}.dcm"));
                    }
                    f.to_owned()
                },
                Read(|path| assert_eq!(open(path).unwrap().dims().z(), 5)),
            ),
            field(
                "Pixel Spacing",
                |f| three(f, &[(0x28, 0x30, b"DS", b"3\\4".to_vec())]),
                Read(|path| assert_eq!(open(path).unwrap().frame().spacing, [4.0, 3.0, 1.0])),
            ),
            field(
                "Slice Thickness, Spacing Between Slices",
                |f| one(f, &slice(0, 0.0).with([(0x18, 0x88, b"DS", b"-7".to_vec())])),
                Read(|path| assert_eq!(open(path).unwrap().frame().spacing[2], 7.0)),
            ),
            field(
                "functional groups",
                |f| {
                    enhanced(f, |n| {
                        let slope = element(0x28, 0x1053, b"DS", b"1");
                        let rescale =
                            element(0x28, 0x1052, b"DS", format!("{}", 10 * n).as_bytes());
                        inner(0x28, 0x9145, &[rescale, slope])
                    })
                },
                Read(|path| {
                    let volume = open(path).unwrap();
                    assert_eq!((volume.as_slice()[0], volume.as_slice()[6]), (0.0, 46.0));
                    assert_eq!(volume.frame().spacing[2], 4.0);
                }),
            ),
            field(
                "Stack ID, Temporal Position, Dimension Index Values",
                |f| {
                    enhanced(f, |n| {
                        inner(0x20, 0x9111, &[element(0x20, 0x9056, b"SH", &[b'a' + n])])
                    })
                },
                Read(|path| {
                    assert!(open(path).is_err());
                    let second = read(path, &ReadOptions::default().frame(Some(1))).unwrap();
                    assert_eq!((second.as_slice()[0], second.frame().origin[2]), (6.0, 4.0));
                }),
            ),
            field(
                "Slice Vector and others of nuclear medicine",
                |f| {
                    let elements = [
                        (8, 0x60, b"CS", b"NM".to_vec()),
                        (0x18, 0x88, b"DS", b"-5".to_vec()),
                        (0x28, 8, b"IS", b"2".to_vec()),
                        (0x54, 0x80, b"US", us(&[1, 2])),
                    ];
                    one(f, &Slice { pixels: (0..12).collect(), ..slice(0, 0.0) }.with(elements))
                },
                Read(|path| {
                    let volume = open(path).unwrap();
                    assert_eq!((volume.frame().origin[2], volume.as_slice()[0]), (-5.0, 6.0));
                }),
            ),
            field(
                "Grid Frame Offset Vector, Dose Grid Scaling",
                |f| {
                    let elements = [
                        (0x28, 8, b"IS", b"2".to_vec()),
                        (0x3004, 0xc, b"DS", b"0\\3".to_vec()),
                        (0x3004, 0xe, b"DS", b"0.5".to_vec()),
                    ];
                    one(f, &Slice { pixels: (0..12).collect(), ..slice(0, 0.0) }.with(elements))
                },
                Read(|path| {
                    let volume = open(path).unwrap();
                    assert_eq!((volume.frame().spacing[2], volume.as_slice()[7]), (3.0, 3.5));
                }),
            ),
            field(
                "Segmentation Type, Segment Identification",
                |f| {
                    let segment = inner(0x62, 0xa, &[element(0x62, 0xb, b"US", &us(&[5]))]);
                    let elements = [
                        (8, 0x16, b"UI", b"1.2.840.10008.5.1.4.1.1.66.4".to_vec()),
                        (0x28, 0x100, b"US", us(&[1])),
                        (0x28, 0x101, b"US", us(&[1])),
                        (0x28, 0x102, b"US", us(&[0])),
                        (0x62, 1, b"CS", b"BINARY".to_vec()),
                        (0x5200, 0x9230, b"SQ", items(&[segment])),
                        (0x7fe0, 0x10, b"OB", vec![0b10_0110, 0]),
                    ];
                    one(f, &slice(0, 0.0).with(elements))
                },
                Read(|path| {
                    let volume = open(path).unwrap();
                    assert_eq!(volume.as_slice(), [0.0, 5.0, 5.0, 0.0, 0.0, 5.0]);
                    assert!(volume.states_labels());
                }),
            ),
            field(
                "other fields",
                |f| {
                    let elements = [
                        (0x10, 0x10, b"PN", b"TEST^BODY".to_vec()),
                        (0x28, 0x1050, b"DS", b"40".to_vec()),
                        (0x28, 0x1051, b"DS", b"400".to_vec()),
                        (0x2050, 0x20, b"CS", b"INVERSE".to_vec()),
                    ];
                    three(f, &elements)
                },
                Read(|path| {
                    assert_eq!(first(path), [0.0, 1.0, 2.0]);
                    assert_eq!(json(path, &["info", "."]).get("warnings"), None);
                }),
            ),
        ],
    );
}
