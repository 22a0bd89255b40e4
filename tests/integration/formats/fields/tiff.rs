//! TIFF, written here tag by tag.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, LengthUnit};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// A tag: its number, its type (2 text, 3 and 4 whole numbers, 5 pairs of them) and its bytes.
type Tag<'a> = (u16, u16, &'a [u8]);

/// A file of so many pages of 3×2 shorts, the samples of `shorts`, with these tags in place of their own.
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
                name: "`Orientation` other than 1",
                file: |f| with(f, &[(274, 3, &[4, 0])]),
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
                file: |f| {
                    // The samples of the second page are at the end of the file, and the description is in the tag.
                    let page = file(1, &[(270, 2, b"ImageJ=1\nimages=2\nslices=2\n\0")]);
                    let start =
                        page.windows(12).position(|window| window == &shorts()[..12]).unwrap();
                    let place = (page.len() as u32).to_le_bytes();
                    let mut page = [&page[..], &shorts()].concat();
                    let entry = page.windows(4).position(|window| window == [17, 1, 4, 0]).unwrap();
                    assert_eq!(page[entry + 8..entry + 12], (start as u32).to_le_bytes());
                    page[entry + 8..entry + 12].copy_from_slice(&place);
                    save(f, "v.tif", page)
                },
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
