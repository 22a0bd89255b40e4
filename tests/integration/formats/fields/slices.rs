//! Folders of slices.

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma};
use walpha::volume::Dtype;

use super::volumes::{same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::common::json;
use crate::formats::files::*;

/// A folder of slices of 3×2 pixels with these names; the first two have the samples of `numbers`.
fn slices(folder: &Path, names: &[&str]) -> PathBuf {
    for (z, name) in names.iter().enumerate() {
        let pixel = |x, y| Luma([(12 * z) as u8 + 2 * (3 * y + x) as u8]);
        GrayImage::from_fn(3, 2, pixel).save(folder.join(name)).unwrap();
    }
    folder.to_owned()
}

/// A PNG of one row of bytes, with this kind of colour and number of bits.
fn png(kind: u8, bits: u8, width: u32, row: &[u8], chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let chunk = |name: &[u8; 4], data: &[u8]| {
        let named = [&name[..], data].concat();
        let mut sum = flate2::Crc::new();
        sum.update(&named);
        [&(data.len() as u32).to_be_bytes()[..], &named, &sum.sum().to_be_bytes()].concat()
    };
    let head = [&width.to_be_bytes()[..], &1u32.to_be_bytes(), &[bits, kind, 0, 0, 0]].concat();
    let between: Vec<u8> = chunks.iter().flat_map(|(name, data)| chunk(name, data)).collect();
    let data = zlib(&[&[0], row].concat());
    let all = [
        &b"\x89PNG\r\n\x1a\n"[..],
        &chunk(b"IHDR", &head),
        &between,
        &chunk(b"IDAT", &data),
        &chunk(b"IEND", &[]),
    ];
    all.concat()
}

fn one(folder: &Path, bytes: &[u8]) -> PathBuf {
    save(folder, "s1.png", bytes);
    save(folder, "s2.png", bytes);
    folder.to_owned()
}

#[test]
fn each_field_of_the_table() {
    walk(
        "folder of slices",
        &[
            Field {
                name: "numbers in the names",
                file: |f| slices(f, &["s9.png", "s10.png"]),
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "numbers with decimals or signs",
                file: |f| slices(f, &["z0.25.png", "z0.5.png", "z0.75.png", "z1.0.png"]),
                fate: Fate::Read(|path| {
                    let told = json(path, &["info", "."])["warnings"].to_string();
                    assert!(
                        told.contains("with their decimals and signs, from z0.25.png"),
                        "{told}"
                    );
                    assert_eq!(volume(path).as_slice()[6], 12.0);
                }),
            },
            Field {
                name: "a number that is missing",
                file: |f| slices(f, &["s1.png", "s2.png", "s4.png"]),
                fate: Fate::Refused(&["misses slice 3: s4.png follows s2.png"]),
            },
            Field {
                name: "two numbers that both count",
                file: |f| slices(f, &["t0_z1.png", "t0_z2.png", "t1_z1.png", "t1_z2.png"]),
                fate: Fate::Refused(&["several groups of slices", "t0_z1.png and t1_z1.png"]),
            },
            Field {
                name: "names that differ in more than numbers",
                file: |f| slices(f, &["a1.png", "b1.png"]),
                fate: Fate::Refused(&["several groups of slices", "a1.png and b1.png"]),
            },
            Field {
                name: "names without numbers",
                file: |f| slices(f, &["front.png", "rear.png"]),
                fate: Fate::PassedOver(&["no numbers", "order of their names"]),
            },
            Field {
                name: "hidden and other files",
                file: |f| {
                    save(f, "._s1.png", b"\0\x05\x16\x07");
                    save(f, "Thumbs.db", [0; 50]);
                    save(f, ".DS_Store", [0; 50]);
                    slices(f, &["s1.png", "s2.png"])
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "sizes that differ",
                file: |f| {
                    GrayImage::new(2, 2).save(f.join("s3.png")).unwrap();
                    slices(f, &["s1.png", "s2.png"])
                },
                fate: Fate::Refused(&["slices must be alike"]),
            },
            Field {
                name: "several kinds of images",
                file: |f| slices(f, &["s1.png", "s2.jpg"]),
                fate: Fate::Refused(&["images of several kinds"]),
            },
            Field {
                name: "PNG: 8 and 16 bits",
                file: |f| one(f, &png(0, 16, 2, &[1, 2, 3, 4], &[])),
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!((volume.as_slice()[0], volume.dtype()), (258.0, Dtype::U16));
                }),
            },
            Field {
                name: "PNG: 1, 2 and 4 bits",
                file: |f| one(f, &png(0, 4, 4, &[0x12, 0x3f], &[])),
                fate: Fate::Read(|path| {
                    assert_eq!(volume(path).as_slice()[..4], [1.0, 2.0, 3.0, 15.0]);
                }),
            },
            Field {
                name: "PNG: a palette",
                file: |f| one(f, &png(3, 8, 2, &[0, 1], &[(b"PLTE", &[1, 1, 1, 2, 2, 2])])),
                fate: Fate::Refused(&["palette of colours"]),
            },
            Field {
                name: "PNG: transparency (alpha, `tRNS`)",
                file: |f| one(f, &png(0, 8, 2, &[0, 1], &[(b"tRNS", &[0, 1])])),
                fate: Fate::Refused(&["gray values with transparency"]),
            },
            Field {
                name: "Exif: `Orientation` other than 1, of any slice",
                file: |f| {
                    let exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
                    one(f, &png(0, 8, 2, &[0, 1], &[]));
                    save(f, "s2.png", png(0, 8, 2, &[0, 1], &[(b"eXIf", exif)]));
                    f.to_owned()
                },
                fate: Fate::PassedOver(&["s2.png: Orientation 6 is passed over"]),
            },
            Field {
                name: "TIFF: 0 is white, in any slice",
                file: |f| {
                    let mut white = tiff(1, None);
                    let entry = white.windows(4).position(|window| window == [6, 1, 3, 0]).unwrap();
                    white[entry + 8] = 0;
                    save(f, "s1.tif", tiff(1, None));
                    save(f, "s2.tif", white);
                    f.to_owned()
                },
                fate: Fate::PassedOver(&["s2.tif: 0 is white", "values are as stored"]),
            },
            Field {
                name: "PNG: `gAMA`, `sBIT`, `pHYs` and other fields",
                file: |f| {
                    let chunks: &[(&[u8; 4], &[u8])] = &[
                        (b"gAMA", &[0, 0, 0xb1, 0x8f]),
                        (b"sBIT", &[4]),
                        (b"pHYs", &[0, 0, 11, 19, 0, 0, 11, 19, 1]),
                    ];
                    one(f, &png(0, 8, 3, &[7, 100, 200], chunks))
                },
                fate: Fate::Read(|path| {
                    assert_eq!(volume(path).as_slice()[..3], [7.0, 100.0, 200.0]);
                }),
            },
            Field {
                name: "JPEG: end marker, data and scans",
                file: |f| {
                    let path = f.join("s1.jpg");
                    GrayImage::from_fn(40, 40, |x, y| Luma([(x * y % 251) as u8]))
                        .save(&path)
                        .unwrap();
                    let bytes = std::fs::read(&path).unwrap();
                    // Half of it, and an end.
                    save(f, "s1.jpg", [&bytes[..bytes.len() * 3 / 4], &[0xff, 0xd9]].concat());
                    f.into()
                },
                fate: Fate::Refused(&["s1.jpg", "ends inside its image"]),
            },
            Field {
                name: "TIFF: a stack in one file",
                file: |f| {
                    save(f, "s1.tif", tiff(2, None));
                    f.to_owned()
                },
                fate: Fate::Refused(&["holds several pages", "name the file itself"]),
            },
            Field {
                name: "TIFF: spacing",
                file: |f| {
                    save(f, "s1.tif", tiff(1, Some("ImageJ=1.53\nunit=um\nspacing=2\n")));
                    f.to_owned()
                },
                fate: Fate::PassedOver(&["its spacing is passed over"]),
            },
        ],
    );
}
