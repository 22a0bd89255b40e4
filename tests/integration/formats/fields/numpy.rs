//! NPY and NPZ.

use std::io::Write;
use std::path::{Path, PathBuf};

use walpha::volume::{Dtype, ReadOptions, Source, read};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

/// An array of version 1.
fn npy(descr: &str, fortran: &str, shape: &str, elements: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}}}\n");
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), elements].concat()
}

fn with(folder: &Path, descr: &str, fortran: &str, shape: &str) -> PathBuf {
    save(folder, "v.npy", npy(descr, fortran, shape, &shorts()))
}

fn archive(folder: &Path, files: &[(&str, &[u8])]) -> PathBuf {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in files {
        archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(bytes).unwrap();
    }
    save(folder, "v.npz", archive.finish().unwrap().into_inner())
}

const CUBE: &str = "(2, 2, 3)";

#[test]
fn each_field_of_the_table() {
    walk(
        "NPY",
        &[
            Field {
                name: "`shape` of three axes, `[z, y, x]`",
                file: |f| with(f, "'<i2'", "False", CUBE),
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "`shape` of four axes",
                file: |f| with(f, "'<i2'", "False", "(2, 1, 2, 3)"),
                fate: Fate::Read(|path| assert_eq!(frame(path, 1).as_slice()[0], 12.0)),
            },
            Field {
                name: "a last axis of one element behind three others",
                file: |f| with(f, "'<i2'", "False", "(2, 2, 3, 1)"),
                fate: Fate::Read(|path| {
                    same(path);
                    let source = Source::open(path, &ReadOptions::default()).unwrap();
                    assert_eq!(source.dims().xyz(), [3, 2, 2]);
                }),
            },
            Field {
                name: "a last axis of 2 to 4 elements, where the others are longer",
                file: |f| save(f, "v.npy", npy("'|u1'", "False", "(5, 6, 3)", &[7; 90])),
                fate: Fate::PassedOver(&["its last axis, of 3", "are channels"]),
            },
            Field {
                name: "other `shape`",
                file: |f| with(f, "'<i2'", "False", "(1, 2, 1, 2, 3)"),
                fate: Fate::Refused(&["[1, 2, 1, 2, 3]", "save a.reshape(z, y, x)"]),
            },
            Field {
                name: "`fortran_order`",
                file: |f| with(f, "'<i2'", "True", "(2, 2, 3)"),
                fate: Fate::Read(|path| assert_eq!(volume(path).as_slice()[..3], [0.0, 8.0, 16.0])),
            },
            Field {
                name: "`fortran_order` of four axes",
                file: |f| with(f, "'<i2'", "True", "(2, 1, 2, 3)"),
                fate: Fate::Refused(&["in Fortran order"]),
            },
            Field {
                name: "`descr`: integers, `f4`, `f8`, byte order",
                file: |f| {
                    let big: Vec<u8> =
                        shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
                    save(f, "v.npy", npy("'>i2'", "False", CUBE, &big))
                },
                fate: Fate::Read(|path| {
                    same(path);
                    assert_eq!(volume(path).dtype(), Dtype::I16);
                }),
            },
            Field {
                name: "`descr`: `b1`",
                file: |f| {
                    save(
                        f,
                        "v.npy",
                        npy("'|b1'", "False", CUBE, &[0, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 1]),
                    )
                },
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!((volume.as_slice()[1], volume.has_gray_levels()), (1.0, false));
                }),
            },
            Field {
                name: "`descr`: `f2`, complex numbers",
                file: |f| with(f, "'<f2'", "False", CUBE),
                fate: Fate::Refused(&["<f2", "save a.astype('f4')"]),
            },
            Field {
                name: "`descr`: several fields",
                file: |f| with(f, "[('a', '<f4'), ('b', '<i2')]", "False", CUBE),
                fate: Fate::Refused(&["save one of its fields"]),
            },
            Field {
                name: "`descr`: objects, texts, dates",
                file: |f| with(f, "'|O'", "False", CUBE),
                fate: Fate::Refused(&["type |O", "save numbers"]),
            },
        ],
    );
    walk(
        "NPZ",
        &[
            Field {
                name: "an array of three axes",
                file: |f| archive(f, &[("a.npy", &npy("'<i2'", "False", CUBE, &shorts()))]),
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "arrays of other shapes, texts and objects beside it",
                file: |f| {
                    let text = npy("'<U1'", "False", "(1,)", b"a\0\0\0");
                    let flat = npy("'<i2'", "False", "(12,)", &shorts());
                    let volume = npy("'<i2'", "False", CUBE, &shorts());
                    archive(
                        f,
                        &[
                            ("t.npy", &text),
                            ("f.npy", &flat),
                            ("v.npy", &volume),
                            ("notes.txt", b"no array"),
                        ],
                    )
                },
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "several arrays of three axes",
                file: |f| {
                    let volume = npy("'<i2'", "False", CUBE, &shorts());
                    archive(f, &[("a.npy", &volume), ("b.npy", &volume)])
                },
                fate: Fate::Refused(&["a.npy, b.npy", "choose one with --array"]),
            },
            Field {
                name: "the name of an array",
                file: |f| {
                    let volume = npy("'<i2'", "False", CUBE, &shorts());
                    archive(f, &[("a.npy", &volume)])
                },
                fate: Fate::Read(|path| {
                    let named = ReadOptions::default().array("a".to_owned());
                    assert_eq!(read(path, &named).unwrap().as_slice(), numbers());
                }),
            },
            Field {
                name: "files that are not arrays, alone",
                // A single text would be points.
                file: |f| archive(f, &[("a.txt", b"1 2 3"), ("b.txt", b"4 5 6")]),
                fate: Fate::Refused(&["a zip archive of a.txt and 1 others", "unpack it"]),
            },
        ],
    );
}
