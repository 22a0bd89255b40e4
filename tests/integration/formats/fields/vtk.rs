//! VTK's image data, in XML and in the legacy format.

use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, ReadOptions, read};

use super::volumes::{same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

const TEXT: &str = "0 2 4 6 8 10 12 14 16 18 20 22";

/// A VTI file of text, changed.
fn xml(folder: &Path, from: &str, to: &str) -> PathBuf {
    let file = vti("", &format!("format=\"ascii\">{TEXT}"), b"");
    let file = String::from_utf8(file).unwrap();
    assert!(file.contains(from), "{from}");
    save(folder, "v.vti", file.replace(from, to))
}

/// A legacy file of text, changed.
fn legacy(folder: &Path, from: &str, to: &str) -> PathBuf {
    assert!(VTK.contains(from), "{from}");
    save(folder, "v.vtk", VTK.replace(from, to) + TEXT + "\n")
}

#[test]
fn each_field_of_xml() {
    walk(
        "VTK image data (XML)",
        &[
            Field {
                name: "`WholeExtent`, `Extent`",
                file: |f| xml(f, "0 2 0 1 0 1", "10 12 0 1 0 1"),
                fate: Fate::Read(|path| assert_eq!(volume(path).frame().origin, [14.0, 5.0, 6.0])),
            },
            Field {
                name: "several pieces, or one of a larger image",
                file: |f| xml(f, "WholeExtent=\"0 2", "WholeExtent=\"0 9"),
                fate: Fate::Refused(&["a piece of a larger image", "write it whole"]),
            },
            Field {
                name: "`Origin`, `Spacing`, `Direction`",
                file: |f| xml(f, "Spacing=", "Direction=\"0 1 0 1 0 0 0 0 1\" Spacing="),
                fate: Fate::Read(|path| {
                    let axes = volume(path).frame().axes();
                    assert_eq!(axes, [[0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
                }),
            },
            Field {
                name: "`type` of an array",
                file: |f| xml(f, "", ""),
                fate: Fate::Read(|path| assert_eq!(volume(path).dtype(), Dtype::I16)),
            },
            Field {
                name: "`NumberOfComponents` above 1",
                file: |f| xml(f, "Name=\"s\"", "Name=\"s\" NumberOfComponents=\"3\""),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel"), "{error}");
                }),
            },
            Field {
                name: "`Scalars` (active), names of arrays",
                file: |f| {
                    let other = "<DataArray type=\"Int16\" Name=\"other\" format=\"ascii\">9 9 9 9 9 9 9 9 9 9 9 9</DataArray>";
                    xml(f, "<DataArray", &format!("{other}<DataArray"))
                },
                fate: Fate::Read(|path| {
                    same(path);
                    let other = ReadOptions::default().array("other".to_owned());
                    assert_eq!(read(path, &other).unwrap().as_slice()[0], 9.0);
                }),
            },
            Field {
                name: "arrays beside the one that is read",
                file: |f| {
                    let other = "<DataArray type=\"Int16\" Name=\"other\" format=\"ascii\">9 9 9 9 9 9 9 9 9 9 9 9</DataArray>";
                    xml(f, "<DataArray", &format!("{other}<DataArray"))
                },
                fate: Fate::PassedOver(&["of the arrays s, other the first is read"]),
            },
            Field {
                name: "`CellData`",
                file: |f| {
                    let path = xml(f, "PointData", "CellData");
                    let text = std::fs::read_to_string(&path).unwrap();
                    save(f, "v.vti", text.replace("0 2 0 1 0 1", "0 3 0 2 0 2"))
                },
                fate: Fate::Read(|path| assert_eq!(volume(path).frame().origin, [4.5, 6.0, 7.5])),
            },
            Field {
                name: "`byte_order`, `header_type`, `compressor`",
                file: |f| {
                    let packed = zlib(&shorts());
                    let blocks = [1u64, 24, 0, packed.len() as u64].map(u64::to_le_bytes).concat();
                    let text = base64(&blocks) + &base64(&packed);
                    let attributes = "compressor=\"vtkZLibDataCompressor\" header_type=\"UInt64\"";
                    save(f, "v.vti", vti(attributes, &format!("format=\"binary\">{text}"), b""))
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "`compressor` LZMA",
                file: |f| {
                    let text = base64(&[1u64, 24, 0, 9].map(u64::to_le_bytes).concat());
                    let attributes = "compressor=\"vtkLZMADataCompressor\" header_type=\"UInt64\"";
                    save(f, "v.vti", vti(attributes, &format!("format=\"binary\">{text}"), b""))
                },
                fate: Fate::Refused(&["vtkLZMADataCompressor", "choose LZ4, ZLib or none"]),
            },
            Field {
                name: "`format`: `ascii`, `binary`, `appended`",
                file: |f| {
                    let size = (shorts().len() as u32).to_le_bytes();
                    let raw = [
                        b"<AppendedData encoding=\"raw\">_",
                        &size[..],
                        &shorts(),
                        b"</AppendedData>",
                    ]
                    .concat();
                    save(f, "v.vti", vti("", "format=\"appended\" offset=\"0\">", &raw))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "text without a `format`, or with a `compressor`",
                file: |f| {
                    let compressor = "compressor=\"vtkLZMADataCompressor\"";
                    save(f, "v.vti", vti(compressor, &format!(">{TEXT}"), b""))
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "`vtkGhostType`",
                file: |f| {
                    let ghosts = "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">2 0 0 0 0 0 0 0 0 0 0 1</DataArray>";
                    xml(f, "<DataArray", &format!("{ghosts}<DataArray"))
                },
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!((volume.samples_there(), volume.is_missing(0)), (11, true));
                    // The least of the others stands for it.
                    assert_eq!(volume.as_slice()[..3], [2.0, 2.0, 4.0]);
                }),
            },
            Field {
                name: "`TimeValue` and other `FieldData`",
                file: |f| {
                    let time = "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">3</DataArray>\
                                </FieldData>";
                    xml(f, "<Piece", &format!("{time}<Piece"))
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}

#[test]
fn each_field_of_the_legacy_format() {
    walk(
        "VTK structured points",
        &[
            Field {
                name: "`DIMENSIONS`",
                file: |f| legacy(f, "", ""),
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "`DATASET` other than `STRUCTURED_POINTS`",
                file: |f| legacy(f, "STRUCTURED_POINTS", "RECTILINEAR_GRID"),
                fate: Fate::Refused(&["dataset RECTILINEAR_GRID", "convert it first"]),
            },
            Field {
                name: "`ORIGIN`, `SPACING`, `DIRECTION`",
                file: |f| {
                    legacy(
                        f,
                        "SPACING 1 2 3\n",
                        "ASPECT_RATIO 1 2 3\nDIRECTION 0 1 0 1 0 0 0 0 1\n",
                    )
                },
                fate: Fate::Read(|path| {
                    let axes = volume(path).frame().axes();
                    assert_eq!(axes, [[0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
                }),
            },
            Field {
                name: "`ASCII`, `BINARY`",
                file: |f| {
                    let big: Vec<u8> =
                        shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
                    save(
                        f,
                        "v.vtk",
                        [VTK.replace("ASCII", "BINARY").as_bytes(), &big, b"\n"].concat(),
                    )
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`SCALARS`, its type",
                // VTK stores its indices in four bytes.
                file: |f| {
                    let numbers: Vec<u8> = (0..12i32).flat_map(|i| (2 * i).to_be_bytes()).collect();
                    let header = VTK.replace("ASCII", "BINARY").replace("s short", "s vtkIdType");
                    save(f, "v.vtk", [header.as_bytes(), &numbers, b"\n"].concat())
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`SCALARS` of several components, `VECTORS`, `TENSORS`",
                file: |f| legacy(f, "s short", "s short 3"),
                fate: Fate::Read(|path| {
                    let error = open(path).unwrap_err().to_string();
                    assert!(error.contains("3 values a voxel"), "{error}");
                }),
            },
            Field {
                name: "`SCALARS` of bits or texts",
                file: |f| legacy(f, "s short", "s string"),
                fate: Fate::Refused(&["type string"]),
            },
            Field {
                name: "`POINT_DATA`, `CELL_DATA`",
                file: |f| {
                    let path = legacy(f, "POINT_DATA", "CELL_DATA");
                    let text = std::fs::read_to_string(&path).unwrap();
                    save(f, "v.vtk", text.replace("DIMENSIONS 3 2 2", "DIMENSIONS 4 3 3"))
                },
                fate: Fate::Read(|path| assert_eq!(volume(path).frame().origin, [4.5, 6.0, 7.5])),
            },
            Field {
                name: "numbers of values that disagree",
                file: |f| legacy(f, "DIMENSIONS 3 2 2", "DIMENSIONS 3 2 3"),
                fate: Fate::Refused(&["has 12 values for 3×2×3 samples", "correct its header"]),
            },
            Field {
                name: "`FIELD`",
                file: |f| {
                    let field = "FIELD FieldData 1\ns 1 12 short\n";
                    legacy(f, "SCALARS s short\nLOOKUP_TABLE default\n", field)
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`FIELD` of the whole dataset",
                file: |f| {
                    let time = "STRUCTURED_POINTS\nFIELD FieldData 1\nTimeValue 1 1 double\n0.5\n";
                    legacy(f, "STRUCTURED_POINTS\n", time)
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "keywords and types in any letter case",
                file: |f| {
                    let (version, rest) = VTK.split_once('\n').unwrap();
                    let rest = rest.to_lowercase().replace("short", "SHORT\n");
                    save(f, "v.vtk", format!("{version}\n{rest}{TEXT}\n"))
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "arrays beside the one that is read",
                file: |f| {
                    let more =
                        format!("{VTK}{TEXT}\nFIELD FieldData 1\nother 1 12 short\n{TEXT}\n");
                    save(f, "v.vtk", more)
                },
                fate: Fate::PassedOver(&["of the arrays s, other the first is read"]),
            },
            Field {
                name: "`vtkGhostType`",
                file: |f| {
                    let ghosts = "FIELD FieldData 1\nvtkGhostType 1 12 unsigned_char\n2 0 0 0 0 0 0 0 0 0 0 1\n";
                    save(f, "v.vtk", format!("{VTK}{TEXT}\n{ghosts}"))
                },
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!((volume.samples_there(), volume.as_slice()[0]), (11, 2.0));
                }),
            },
            Field {
                name: "`METADATA`, `LOOKUP_TABLE` and the title",
                file: |f| save(f, "v.vtk", format!("{VTK}{TEXT}\nMETADATA\nINFORMATION 0\n\n")),
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
