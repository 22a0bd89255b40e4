//! TIFF, written here tag by tag.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, LengthUnit};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// A file of one strip of JPEG, of a square page.
fn strip_of_jpeg(side: u32, jpeg: &[u8]) -> Vec<u8> {
    let length = jpeg.len() as u32;
    let entries = [
        (256, side),
        (257, side),
        (258, 8),
        (259, 7),
        (262, 1),
        (273, 8),
        (277, 1),
        (278, side),
        (279, length),
    ];
    let entry = |(tag, value): (u16, u32)| {
        let value = [1, value].map(u32::to_le_bytes).concat();
        [&[tag, 4].map(u16::to_le_bytes).concat()[..], &value].concat()
    };
    let directory = entries.into_iter().flat_map(entry).collect::<Vec<u8>>();
    let start = [&b"II*\0"[..], &(8 + length).to_le_bytes()].concat();
    [&start[..], jpeg, &(entries.len() as u16).to_le_bytes(), &directory, &[0; 4]].concat()
}

/// A tag: its number, its type (2 text, 3 and 4 whole numbers, 5 pairs of them) and its bytes.
type Tag<'a> = (u16, u16, &'a [u8]);

/// A file of `pages` pages of 3×2 shorts, the samples of `shorts`, with these tags in place of their own.
fn file(pages: usize, tags: &[Tag]) -> Vec<u8> {
    tiff_of(&vec![tags; pages])
}

fn tiff_of(pages: &[&[Tag]]) -> Vec<u8> {
    let mut bytes = b"II*\0\x08\0\0\0".to_vec();
    for (page, tags) in pages.iter().enumerate() {
        let samples = &shorts()[12 * (page % 2)..][..12];
        let number = |value: u32| value.to_le_bytes().to_vec();
        // Width, height, bits, compression, photometric, place, samples, rows, bytes.
        let own = [
            (256, 3),
            (257, 2),
            (258, 16),
            (259, 1),
            (262, 1),
            (273, 0),
            (277, 1),
            (278, 2),
            (279, 12),
        ];
        let mut all: BTreeMap<u16, (u16, Vec<u8>)> =
            own.iter().map(|&(tag, value)| (tag, (4, number(value)))).collect();
        all.extend(tags.iter().map(|&(tag, kind, value)| (tag, (kind, value.to_vec()))));
        let start = bytes.len() as u32;
        let mut behind = start + 2 + 12 * all.len() as u32 + 4;
        let mut values = samples.to_vec();
        all.get_mut(&273).unwrap().1 = number(behind);
        bytes.extend((all.len() as u16).to_le_bytes());
        behind += samples.len() as u32;
        for (tag, (kind, value)) in all {
            let size = [0, 1, 1, 2, 4, 8][usize::from(kind)];
            bytes.extend([tag, kind].map(u16::to_le_bytes).concat());
            bytes.extend((value.len() as u32 / size).to_le_bytes());
            if value.len() > 4 {
                bytes.extend(behind.to_le_bytes());
                behind += value.len() as u32;
                values.extend(value);
            } else {
                bytes.extend([&value[..], &[0; 4][value.len()..]].concat());
            }
        }
        let next = if page + 1 < pages.len() { behind } else { 0 };
        bytes.extend(next.to_le_bytes());
        bytes.extend(values);
    }
    bytes
}

fn with(folder: &Path, first: &[Tag]) -> PathBuf {
    save(folder, "v.tif", file(2, first))
}

fn described(folder: &Path, text: &[u8]) -> PathBuf {
    let ratio = [4u32, 1].map(u32::to_le_bytes).concat();
    with(folder, &[(270, 2, text), (282, 5, &ratio), (283, 5, &ratio), (296, 3, &[1, 0])])
}

/// A page with these tags. Its samples and those of a second page are at the end of the file.
fn behind_one_page(folder: &Path, tags: &[Tag]) -> PathBuf {
    let page = file(1, tags);
    let start = page.windows(12).position(|window| window == &shorts()[..12]).unwrap();
    let place = (page.len() as u32).to_le_bytes();
    let mut page = [&page[..], &shorts()].concat();
    let entry = page.windows(4).position(|window| window == [17, 1, 4, 0]).unwrap();
    assert_eq!(page[entry + 8..entry + 12], (start as u32).to_le_bytes());
    page[entry + 8..entry + 12].copy_from_slice(&place);
    save(folder, "v.tif", page)
}

/// Tags of a page of one row, of 0, 2, 4 or, where `tiff_of` writes it second, 12, 14, 16.
fn row<'a>(tags: &[Tag<'a>]) -> Vec<Tag<'a>> {
    let own: [Tag; 3] = [(257, 4, &[1, 0, 0, 0]), (278, 4, &[1, 0, 0, 0]), (279, 4, &[6, 0, 0, 0])];
    [&own, tags].concat()
}

/// `pages` pages of one row, with the samples of `shorts` one after the other, and a description.
fn rows(folder: &Path, text: &[u8], pages: usize) -> PathBuf {
    let page = |k: usize| if k == 0 { row(&[(270, 2, text)]) } else { row(&[]) };
    let pages: Vec<Vec<Tag>> = (0..pages).map(page).collect();
    let pages: Vec<&[Tag]> = pages.iter().map(Vec::as_slice).collect();
    let mut bytes = tiff_of(&pages);
    // The samples that `tiff_of` wrote as the first rows of two slices.
    let first = [&shorts()[..12], &shorts()[12..]];
    let mut from = 0;
    for k in 0..pages.len() {
        let at =
            bytes[from..].windows(12).position(|window| window == first[k % 2]).unwrap() + from;
        bytes[at..at + 6].copy_from_slice(&shorts()[6 * k..6 * k + 6]);
        from = at + 6;
    }
    save(folder, "v.tif", bytes)
}

/// Two times of two planes, in a table of a kind of scan.
fn lsm(scan: u8) -> Vec<u8> {
    let mut table = vec![0; 100];
    for (place, size) in [(8, 3u32), (12, 1), (16, 2), (20, 1), (24, 2), (88, scan.into())] {
        table[place..place + 4].copy_from_slice(&size.to_le_bytes());
    }
    for (k, metres) in [0.5e-6f64, 0.25e-6, 3e-6].into_iter().enumerate() {
        table[40 + 8 * k..48 + 8 * k].copy_from_slice(&metres.to_le_bytes());
    }
    table
}

#[test]
fn each_field_of_the_table() {
    walk(
        "TIFF",
        &[
            Field { name: "pages", file: |f| with(f, &[]), fate: Fate::Read(same_without_a_word) },
            Field {
                name: "pages of other sizes",
                file: |f| {
                    let two = 2u32.to_le_bytes();
                    let tags: &[Tag] = &[(256, 4, &two), (279, 4, &8u32.to_le_bytes())];
                    save(f, "v.tif", tiff_of(&[&[], tags]))
                },
                fate: Fate::Refused(&["in page 2", "must be alike"]),
            },
            Field {
                name: "`NewSubfileType`, `SubfileType` of thumbnails and masks",
                file: |f| save(f, "v.tif", tiff_of(&[&[], &[(254, 4, &[1, 0, 0, 0])]])),
                fate: Fate::PassedOver(&["1 page passed over", "smaller copies"]),
            },
            Field {
                name: "`BitsPerSample`, `SampleFormat`",
                file: |f| with(f, &[(339, 3, &[2, 0])]),
                fate: Fate::Read(|path| {
                    same(path);
                    assert_eq!(volume(path).dtype(), Dtype::I16);
                }),
            },
            Field {
                name: "`BitsPerSample` other than 8, 16, 32, 64",
                file: |f| with(f, &[(258, 3, &[12, 0])]),
                fate: Fate::Refused(&["samples of 12 bits"]),
            },
            Field {
                name: "`SampleFormat` of complex numbers, or none",
                file: |f| with(f, &[(339, 3, &[5, 0])]),
                fate: Fate::Refused(&["complex numbers (SampleFormat)"]),
            },
            Field {
                name: "`NewSubfileType` of all pages",
                file: |f| with(f, &[(254, 4, &[1, 0, 0, 0])]),
                fate: Fate::PassedOver(&[
                    "all its pages claim to be smaller copies",
                    "read as slices",
                ]),
            },
            Field {
                name: "`PhotometricInterpretation` 0 (0 is white)",
                file: |f| save(f, "v.tif", tiff_of(&[&[(262, 3, &[0, 0])], &[(262, 3, &[0, 0])]])),
                fate: Fate::PassedOver(&["0 is white", "values are as stored"]),
            },
            Field {
                name: "samples where 0 is white",
                file: |f| {
                    let white: &[Tag] = &[(262, 3, &[0, 0]), (339, 3, &[2, 0])];
                    save(f, "v.tif", tiff_of(&[white, white]))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`PhotometricInterpretation` 3 (a palette)",
                file: |f| with(f, &[(262, 3, &[3, 0])]),
                fate: Fate::Refused(&["palette of colours", "save it as gray"]),
            },
            Field {
                name: "`SamplesPerPixel` above 1",
                file: |f| with(f, &[(277, 3, &[3, 0]), (279, 4, &36u32.to_le_bytes())]),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values in each pixel"), "{error}");
                }),
            },
            Field {
                name: "`Compression`: LZW, Deflate, PackBits, JPEG; `Predictor`",
                file: |f| {
                    use tiff::encoder::{Compression, TiffEncoder, colortype::Gray16};
                    let mut bytes = std::io::Cursor::new(Vec::new());
                    let encoder = TiffEncoder::new(&mut bytes).unwrap();
                    let mut encoder = encoder.with_compression(Compression::Lzw);
                    for page in [[0u16, 2, 4, 6, 8, 10], [12, 14, 16, 18, 20, 22]] {
                        encoder.write_image::<Gray16>(3, 2, &page).unwrap();
                    }
                    save(f, "v.tif", bytes.into_inner())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "JPEG strips and tiles without an end",
                file: |f| {
                    let mut jpeg = std::io::Cursor::new(Vec::new());
                    let image = image::GrayImage::from_fn(40, 40, |x, y| [(x * y) as u8].into());
                    image.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
                    let mut jpeg = jpeg.into_inner();
                    let whole = save(f, "whole.tif", strip_of_jpeg(40, &jpeg));
                    assert_eq!(volume(&whole).dims().xyz(), [40, 40, 1]);
                    // A file whose copying stopped early.
                    let from = jpeg.len() * 3 / 4;
                    jpeg[from..].fill(0);
                    save(f, "v.tif", strip_of_jpeg(40, &jpeg))
                },
                fate: Fate::Refused(&["ends inside its JPEG data"]),
            },
            Field {
                name: "other `Compression`",
                file: |f| with(f, &[(259, 4, &50000u32.to_le_bytes())]),
                fate: Fate::Refused(&["of a kind that is not read", "save it without compression"]),
            },
            Field {
                name: "`FillOrder` 2",
                file: |f| with(f, &[(266, 3, &[2, 0])]),
                fate: Fate::Refused(&["FillOrder 2"]),
            },
            Field {
                name: "`Orientation` other than 1, of any page",
                file: |f| save(f, "v.tif", tiff_of(&[&[], &[(274, 3, &[4, 0])]])),
                fate: Fate::PassedOver(&["Orientation 4"]),
            },
            Field {
                name: "`XResolution`, `YResolution`, `ResolutionUnit`",
                file: |f| {
                    let dots = [300u32, 1].map(u32::to_le_bytes).concat();
                    with(f, &[(282, 5, &dots), (283, 5, &dots), (296, 3, &[2, 0])])
                },
                fate: Fate::PassedOver(&["300 by 300 pixels per inch"]),
            },
            Field {
                name: "ImageJ: `spacing`, `unit`, `xorigin`…, resolution",
                file: |f| {
                    described(f, b"ImageJ=1.53\nimages=2\nslices=2\nunit=um\nzunit=nm\nspacing=500\nxorigin=2\n\0")
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(frame.coordinates.unit, LengthUnit::Micrometre);
                    assert_eq!(
                        (frame.spacing, frame.origin),
                        ([0.25, 0.25, 0.5], [-0.5, 0.0, 0.0])
                    );
                }),
            },
            Field {
                name: "ImageJ: `slices`, `channels`, `frames`",
                file: |f| {
                    let row: &[Tag] = &[
                        (257, 4, &[1, 0, 0, 0]),
                        (278, 4, &[1, 0, 0, 0]),
                        (279, 4, &[6, 0, 0, 0]),
                    ];
                    let text: &[Tag] =
                        &[(270, 2, b"ImageJ=1.53\nimages=4\nslices=2\nchannels=2\n\0")];
                    save(f, "v.tif", tiff_of(&[&[text, row].concat(), row, row, row]))
                },
                // Channels are counted first: the second one has the second and the fourth page.
                fate: Fate::Read(|path| {
                    assert_eq!(frame(path, 1).as_slice(), [12.0, 14.0, 16.0, 12.0, 14.0, 16.0]);
                }),
            },
            Field {
                name: "more `slices`, `channels`, `frames` than pages",
                file: |f| described(f, b"ImageJ=1.53\nimages=4\nslices=2\nframes=2\n\0"),
                fate: Fate::PassedOver(&["has 2 pages, but its description counts 4"]),
            },
            Field {
                name: "ImageJ: a stack behind one page",
                file: |f| behind_one_page(f, &[(270, 2, b"ImageJ=1\nimages=2\nslices=2\n\0")]),
                fate: Fate::Read(same),
            },
            Field {
                name: "ImageJ: calibration of values",
                file: |f| described(f, b"ImageJ=1.53\nslices=2\ncf=0\nc0=-32768\nc1=1\n\0"),
                fate: Fate::PassedOver(&["calibration of values"]),
            },
            Field {
                name: "ImageJ: times or channels of one slice",
                file: |f| described(f, b"ImageJ=1.53\nimages=2\nframes=2\n\0"),
                fate: Fate::PassedOver(&["its pages are times", "read as slices"]),
            },
            Field {
                name: "OME-XML: sizes, order, `PhysicalSizeX`…, units",
                file: |f| {
                    described(f, b"<OME><Image><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"1\" SizeC=\"2\" SizeT=\"1\" PhysicalSizeX=\"500\" \
                                   PhysicalSizeXUnit=\"nm\" PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"&#181;m\"/></Image></OME>\0")
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing[0], frame.coordinates.unit),
                        (500.0, LengthUnit::Nanometre)
                    );
                    assert!((frame.spacing[2] - 2000.0).abs() < 1e-9);
                }),
            },
            Field {
                name: "OME-XML: no `PhysicalSizeX`…, where another is there",
                file: |f| {
                    described(f, b"<OME><Image><Pixels SizeZ=\"2\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\"/></Image></OME>\0")
                },
                fate: Fate::PassedOver(&[
                    "no PhysicalSizeZ is stated: it is taken to be 1 \u{b5}m",
                ]),
            },
            Field {
                name: "OME-XML: `BinaryOnly`",
                file: |f| {
                    described(f, b"<OME><BinaryOnly MetadataFile=\"d.companion.ome\"/></OME>\0")
                },
                fate: Fate::Refused(&[
                    "names the file that has it (BinaryOnly): \"d.companion.ome\"",
                ]),
            },
            Field {
                name: "OME-XML: a volume in several files",
                file: |f| {
                    described(f, b"<OME><Image><Pixels SizeZ=\"2\"><TiffData><UUID FileName=\"a.tif\"/></TiffData><TiffData>\
                                   <UUID FileName=\"b.tif\"/></TiffData></Pixels></Image></OME>\0")
                },
                fate: Fate::Refused(&["one of the 2 files of a volume", "save it as one file"]),
            },
            Field {
                name: "OME-XML: `TiffData` in another order",
                file: |f| {
                    described(f, b"<OME><Image><Pixels SizeZ=\"2\"><TiffData IFD=\"1\" FirstZ=\"0\"/><TiffData IFD=\"0\" FirstZ=\"1\"/>\
                                   </Pixels></Image></OME>\0")
                },
                fate: Fate::Refused(&["another order"]),
            },
            Field {
                name: "SCIFIO: `axes`, `lengths`, `scales`, `units`",
                file: |f| {
                    let text = b"SCIFIO=0.46.0\naxes=X,Y,Channel,Z\nlengths=3,1,2,2\nscales=0.5,0.25,1.0,2500\nunits=um,um,null,nm\n\0";
                    rows(f, text, 4)
                },
                fate: Fate::Read(|path| {
                    // Channels are counted first, as the axes say: the second one is of pages 2 and 4.
                    let volume = frame(path, 1);
                    assert_eq!(volume.as_slice(), [6.0, 8.0, 10.0, 18.0, 20.0, 22.0]);
                    assert_eq!(volume.frame().spacing, [0.5, 0.25, 2.5]);
                    assert_eq!(volume.frame().coordinates.unit, LengthUnit::Micrometre);
                }),
            },
            Field {
                name: "SCIFIO, tifffile: axes of other orders, or more of them",
                file: |f| rows(f, b"SCIFIO=0.46.0\naxes=X,Z,Y\nlengths=3,4,1\n\0", 4),
                fate: Fate::Refused(&[
                    "the axes \"X,Z,Y\" by its description",
                    "save it in that order",
                ]),
            },
            Field {
                name: "tifffile: `shape`, `axes`",
                file: |f| rows(f, b"{\"shape\": [2, 2, 1, 3], \"axes\": \"TZYX\"}\0", 4),
                fate: Fate::Read(|path| {
                    let second = [12.0, 14.0, 16.0, 18.0, 20.0, 22.0];
                    assert_eq!(frame(path, 1).as_slice(), second);
                    let folder = path.parent().unwrap();
                    let unnamed = rows(folder, b"{\"shape\": [2, 2, 1, 3]}\0", 4);
                    assert_eq!(frame(&unnamed, 1).as_slice(), second);
                    // Of two arrays in a file, the first one is read; arrays of one page each are slices.
                    let first = volume(&rows(folder, b"{\"shape\": [2, 1, 3]}\0", 4));
                    assert_eq!(first.as_slice(), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
                    let pages = volume(&rows(folder, b"{\"shape\": [1, 3]}\0", 4));
                    assert_eq!(pages.dims().xyz(), [3, 1, 4]);
                    let by_channel = b"{\"shape\": [2, 2, 1, 3], \"axes\": \"ZCYX\"}\0";
                    let path = rows(folder, by_channel, 4);
                    assert_eq!(frame(&path, 0).as_slice(), [0.0, 2.0, 4.0, 12.0, 14.0, 16.0]);
                    same(&behind_one_page(
                        folder,
                        &[(270, 2, b"{\"shape\": [2, 2, 3], \"truncated\": true}\0")],
                    ));
                }),
            },
            Field {
                name: "tifffile: `spacing`, `unit`",
                file: |f| {
                    described(f, b"{\"shape\": [2, 2, 3], \"axes\": \"ZYX\", \"spacing\": 2.5, \"unit\": \"um\"}\0")
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(frame.spacing, [0.25, 0.25, 2.5]);
                    assert_eq!(frame.coordinates.unit, LengthUnit::Micrometre);
                }),
            },
            Field {
                name: "LSM: sizes and times, distances of voxels",
                file: |f| {
                    save(
                        f,
                        "v.tif",
                        tiff_of(&[&row(&[(34412, 1, &lsm(6))]), &row(&[]), &row(&[]), &row(&[])]),
                    )
                },
                fate: Fate::Read(|path| {
                    let volume = frame(path, 1);
                    assert_eq!(volume.as_slice(), [0.0, 2.0, 4.0, 12.0, 14.0, 16.0]);
                    assert_eq!(volume.frame().spacing, [0.5, 0.25, 3.0]);
                    assert_eq!(volume.frame().coordinates.unit, LengthUnit::Micrometre);
                }),
            },
            Field {
                name: "LSM: scans of other planes, lines and points",
                file: |f| with(f, &[(34412, 1, &lsm(1))]),
                fate: Fate::Refused(&["an LSM file of scan type 1", "export its planes"]),
            },
            Field {
                name: "MetaMorph (STK): planes behind one page",
                file: |f| behind_one_page(f, &[(33629, 5, &[1; 16])]),
                fate: Fate::Read(same),
            },
            Field {
                name: "MetaMorph (STK): distances of planes",
                file: |f| behind_one_page(f, &[(33629, 5, &[1; 16])]),
                fate: Fate::PassedOver(&[
                    "MetaMorph's distances of slices (UIC tags) are passed over",
                ]),
            },
            Field {
                name: "texts in Latin-1",
                file: |f| described(f, b"ImageJ=1.53\nslices=2\nunit=\xb5m\nspacing=2.5\n\0"),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing[2], frame.coordinates.unit),
                        (2.5, LengthUnit::Micrometre)
                    );
                }),
            },
            Field {
                name: "`ImageDepth`",
                file: |f| with(f, &[(32997, 4, &[2, 0, 0, 0])]),
                fate: Fate::Refused(&["a volume in one page (ImageDepth)"]),
            },
            Field {
                name: "`GDAL_NODATA`",
                file: |f| with(f, &[(42113, 2, b"-9999\0")]),
                fate: Fate::PassedOver(&["-9999", "no data"]),
            },
            Field {
                name: "`GDAL_METADATA`: scale and offset of values",
                file: |f| {
                    let text = b"<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>\0";
                    with(f, &[(42112, 2, text)])
                },
                fate: Fate::PassedOver(&["scale and offset of values that GDAL states"]),
            },
            Field {
                name: "`ModelPixelScale` (GeoTIFF)",
                file: |f| with(f, &[(33550, 5, &[1, 0, 0, 0, 1, 0, 0, 0])]),
                fate: Fate::PassedOver(&["place on Earth"]),
            },
            Field {
                name: "BigTIFF, byte order",
                file: |f| {
                    use tiff::encoder::{TiffEncoder, colortype::Gray16};
                    let mut bytes = std::io::Cursor::new(Vec::new());
                    let mut encoder = TiffEncoder::new_big(&mut bytes).unwrap();
                    for page in [[0u16, 2, 4, 6, 8, 10], [12, 14, 16, 18, 20, 22]] {
                        encoder.write_image::<Gray16>(3, 2, &page).unwrap();
                    }
                    save(f, "v.tif", bytes.into_inner())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "other fields",
                file: |f| {
                    with(
                        f,
                        &[
                            (305, 2, b"a program \xe9\0"),
                            (306, 2, b"2026:11:27 00:00:00\0"),
                            (315, 2, b"M\xfcller\0"),
                        ],
                    )
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}

/// Bytes compressed by LZW, as the only strip of a page.
fn lzw(bytes: &[u8]) -> Vec<u8> {
    use tiff::encoder::{Compression, TiffEncoder, colortype::Gray8};
    use tiff::tags::Tag::{StripByteCounts, StripOffsets};
    let mut file = std::io::Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut file).unwrap();
    let mut encoder = encoder.with_compression(Compression::Lzw);
    encoder.write_image::<Gray8>(bytes.len() as u32, 1, bytes).unwrap();
    file.set_position(0);
    let mut decoder = tiff::decoder::Decoder::new(&mut file).unwrap();
    let [place, size] = [StripOffsets, StripByteCounts].map(|tag| {
        let numbers = decoder.get_tag_u32_vec(tag).unwrap();
        assert_eq!(numbers.len(), 1);
        numbers[0] as usize
    });
    file.get_ref()[place..place + size].to_vec()
}

/// Two pages of shorts, in four tiles of 32×32.
fn tiled(big_endian: bool, [width, length]: [u16; 2], sample: fn(u16, u16, u16) -> u16) -> Vec<u8> {
    let short = |value: u16| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let long = |value: u32| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut bytes = if big_endian { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
    bytes.extend([0; 4]);
    let mut link = 4;
    for page in 0..2 {
        let (mut places, mut sizes) = (Vec::new(), Vec::new());
        for (row, column) in [(0, 0), (0, 32), (32, 0), (32, 32)] {
            let there =
                |y: u16, x: u16| if y < length && x < width { sample(page, y, x) } else { 7 };
            let of_row = |y| (column..column + 32).map(move |x| short(there(y, x)));
            let tile: Vec<u8> = (row..row + 32).flat_map(of_row).flatten().collect();
            let packed = lzw(&tile);
            places.extend(long(bytes.len() as u32));
            sizes.extend(long(packed.len() as u32));
            bytes.extend(packed);
        }
        let at = bytes.len() as u32;
        bytes.extend([places, sizes].concat());
        let directory = bytes.len() as u32;
        bytes[link..link + 4].copy_from_slice(&long(directory));
        let small = [
            (256, width),
            (257, length),
            (258, 16),
            (259, 5),
            (262, 1),
            (277, 1),
            (322, 32),
            (323, 32),
        ];
        let value = |value: u16| [short(value), [0; 2]].concat();
        let mut entries: Vec<Vec<u8>> = small
            .map(|(tag, number)| {
                [short(tag).to_vec(), short(3).to_vec(), long(1).to_vec(), value(number)].concat()
            })
            .to_vec();
        for (tag, place) in [(324, at), (325, at + 16)] {
            entries.push(
                [short(tag).to_vec(), short(4).to_vec(), long(4).to_vec(), long(place).to_vec()]
                    .concat(),
            );
        }
        bytes.extend(short(entries.len() as u16));
        bytes.extend(entries.concat());
        link = bytes.len();
        bytes.extend([0; 4]);
    }
    bytes
}

fn sample(page: u16, y: u16, x: u16) -> u16 {
    let [page, y, x] = [page, y, x].map(u32::from);
    let mixed = (1_000_003 * page + 10_007 * y + 101 * x).wrapping_mul(2_654_435_761);
    ((mixed >> 16) % 100) as u16
}

/// The library that decodes them fails at some that are narrower than the page, as those of few values, or where it leaves out what is
/// beyond the edge.
#[test]
fn tiles_of_lzw_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let samples: [fn(u16, u16, u16) -> u16; 3] = [sample, |_, _, _| 7, |page, y, x| page + y + x];
    for (sample, size) in samples.into_iter().flat_map(|f| [[40, 36], [64, 64]].map(|s| (f, s))) {
        for big_endian in [false, true] {
            let file = tiled(big_endian, size, sample);
            let volume = open(&save(folder.path(), "t.tif", file)).unwrap();
            assert_eq!(volume.dims().xyz(), [size[0].into(), size[1].into(), 2]);
            for ((z, y, x), &value) in volume.samples().indexed_iter() {
                assert_eq!(value, f32::from(sample(z as u16, y as u16, x as u16)), "{x} {y} {z}");
            }
        }
    }
}
