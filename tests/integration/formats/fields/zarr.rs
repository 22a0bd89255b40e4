//! Zarr, of version 2 and 3, written by hand: one chunk, not compressed.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use walpha::volume::{Dtype, LengthUnit, ReadOptions, Source, read};

use super::volumes::{frame, same, same_without_a_word, volume};
use super::{Fate, Field, walk};
use crate::formats::files::*;

fn put(folder: &Path, name: &str, value: &Value) {
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join(name), value.to_string()).unwrap();
}

/// The metadata of an array of version 2, changed.
fn array(folder: &Path, shape: &[u64], changes: &[(&str, Value)], chunk: &[u8]) -> PathBuf {
    let mut metadata = json!({
        "zarr_format": 2, "shape": shape, "chunks": shape, "dtype": "<i2", "compressor": null, "fill_value": 0,
        "order": "C", "filters": null
    });
    changes.iter().for_each(|(name, value)| metadata[*name] = value.clone());
    put(folder, ".zarray", &metadata);
    let separator = metadata["dimension_separator"].as_str().unwrap_or(".");
    let key = folder.join(vec!["0"; shape.len()].join(separator));
    fs::create_dir_all(key.parent().unwrap()).unwrap();
    fs::write(key, chunk).unwrap();
    folder.to_owned()
}

fn with(folder: &Path, changes: &[(&str, Value)]) -> PathBuf {
    array(folder, &[2, 2, 3], changes, &shorts())
}

/// A pyramid of one level, with these axes and transformations.
fn pyramid(folder: &Path, shape: &[u64], axes: Value, inner: Value, outer: Value) -> PathBuf {
    put(folder, ".zgroup", &json!({"zarr_format": 2}));
    let datasets = json!([{"path": "0", "coordinateTransformations": inner}]);
    let multiscales =
        json!([{"axes": axes, "datasets": datasets, "coordinateTransformations": outer}]);
    put(folder, ".zattrs", &json!({"multiscales": multiscales}));
    array(&folder.join("0"), shape, &[], &shorts());
    folder.to_owned()
}

/// An array with attributes.
fn stating(folder: &Path, attributes: Value) -> PathBuf {
    with(folder, &[]);
    stating_beside(folder, attributes)
}

fn stating_beside(array: &Path, attributes: Value) -> PathBuf {
    put(array, ".zattrs", &attributes);
    array.to_owned()
}

/// An array with coordinates along x, packed, and along y, but none along z.
fn coordinates(folder: &Path, y: &[i16]) -> PathBuf {
    let bytes = |row: &[i16]| row.iter().flat_map(|place| place.to_le_bytes()).collect::<Vec<u8>>();
    array(&folder.join("x"), &[3], &[], &bytes(&[10, 11, 12]));
    stating_beside(&folder.join("x"), json!({"units": "mm", "scale_factor": 0.5}));
    array(&folder.join("y"), &[2], &[], &bytes(y));
    stating(&folder.join("density"), json!({"_ARRAY_DIMENSIONS": ["z", "y", "x"]}))
}

/// The samples when they are read in parts.
fn parts(path: &Path) -> Vec<f32> {
    let source = Source::open(path, &ReadOptions::default()).unwrap();
    source.read([0; 3], source.dims().xyz()).unwrap()
}

fn space(name: &str, unit: &str) -> Value {
    json!({"name": name, "type": "space", "unit": unit})
}

/// The samples of `numbers` in the order in which an array of axes x, y, z has them, or in the order F.
fn turned() -> Vec<u8> {
    let at = |x: usize, y: usize, z: usize| 2 * (x + 3 * y + 6 * z);
    let all =
        (0..3).flat_map(|x| (0..2).flat_map(move |y| (0..2).map(move |z| at(x, y, z) as i16)));
    all.flat_map(i16::to_le_bytes).collect()
}

#[test]
fn each_field_of_the_table() {
    walk(
        "Zarr",
        &[
            Field {
                name: "`shape`, `chunks`",
                file: |f| with(f, &[]),
                fate: Fate::Read(same_without_a_word),
            },
            Field {
                name: "`dtype`, byte order",
                file: |f| {
                    let big: Vec<u8> =
                        shorts().chunks(2).flat_map(|pair| [pair[1], pair[0]]).collect();
                    array(f, &[2, 2, 3], &[("dtype", json!(">i2"))], &big)
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "`dtype` bool",
                file: |f| {
                    let changes = [("dtype", json!("|b1")), ("fill_value", json!(false))];
                    array(f, &[2, 2, 3], &changes, &[0, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 1])
                },
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!(
                        (volume.as_slice()[..3].to_vec(), volume.has_gray_levels()),
                        (vec![0.0, 1.0, 1.0], false)
                    );
                }),
            },
            Field {
                name: "`dtype` of 16-bit floats, complex numbers, texts",
                file: |f| with(f, &[("dtype", json!("<f2"))]),
                fate: Fate::Refused(&["samples of type float16"]),
            },
            Field {
                name: "`order`",
                // The first axis is the fastest.
                file: |f| array(f, &[2, 2, 3], &[("order", json!("F"))], &turned()),
                fate: Fate::Read(same),
            },
            Field {
                name: "`fill_value`, also `null`",
                file: |f| {
                    let path = with(f, &[("fill_value", Value::Null)]);
                    fs::remove_file(path.join("0.0.0")).unwrap();
                    path
                },
                fate: Fate::Read(|path| assert_eq!(volume(path).as_slice(), [0.0; 12])),
            },
            Field {
                name: "`dimension_separator`",
                file: |f| with(f, &[("dimension_separator", json!("/"))]),
                fate: Fate::Read(same),
            },
            Field {
                name: "`compressor`: blosc, zstd, gzip, zlib; `filters`: shuffle, fixed scale and offset",
                file: |f| {
                    let changes = [("compressor", json!({"id": "zlib", "level": 5}))];
                    array(f, &[2, 2, 3], &changes, &zlib(&shorts()))
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "other `compressor` or `filters`",
                file: |f| with(f, &[("filters", json!([{"id": "delta", "dtype": "<i2"}]))]),
                fate: Fate::Refused(&["of a kind that is not read (codec delta", "store it anew"]),
            },
            Field {
                name: "`axes` of OME-Zarr: x, y, z in any order",
                file: |f| {
                    let axes = json!([
                        space("x", "micrometer"),
                        space("y", "micrometer"),
                        space("z", "micrometer")
                    ]);
                    let path = pyramid(
                        f,
                        &[3, 2, 2],
                        axes,
                        json!([{"type": "scale", "scale": [1, 2, 5]}]),
                        json!([]),
                    );
                    fs::write(f.join("0/0.0.0"), turned()).unwrap();
                    path
                },
                fate: Fate::Read(|path| {
                    same(path);
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing, frame.coordinates.unit),
                        ([1.0, 2.0, 5.0], LengthUnit::Micrometre)
                    );
                    // A level alone has its axes from the pyramid.
                    same(&path.join("0"));
                }),
            },
            Field {
                name: "`axes` of time and channels",
                file: |f| {
                    let axes = json!([{"name": "t", "type": "time"}, "y", "x", {"name": "c", "type": "channel"}]);
                    pyramid(f, &[2, 1, 3, 2], axes, json!([]), json!([]))
                },
                fate: Fate::Read(|path| {
                    // The second channel of each time.
                    assert_eq!(frame(path, 3).as_slice(), [14.0, 18.0, 22.0]);
                }),
            },
            Field {
                name: "`dimension_names`, `_ARRAY_DIMENSIONS`",
                file: |f| {
                    let path = array(f, &[3, 2, 2], &[], &turned());
                    put(f, ".zattrs", &json!({"_ARRAY_DIMENSIONS": ["x", "y", "z"]}));
                    path
                },
                fate: Fate::Read(same),
            },
            Field {
                name: "names of axes that are none of x, y, z, time, channel",
                file: |f| {
                    let path = with(f, &[]);
                    put(f, ".zattrs", &json!({"_ARRAY_DIMENSIONS": ["depth", "row", "column"]}));
                    path
                },
                fate: Fate::PassedOver(&["depth", "is taken for z", "in the order z, y, x"]),
            },
            Field {
                name: "names of more or fewer axes than there are",
                file: |f| {
                    let path = with(f, &[]);
                    put(f, ".zattrs", &json!({"_ARRAY_DIMENSIONS": ["y", "x"]}));
                    path
                },
                fate: Fate::Refused(&["names 2 axes of an array of 3"]),
            },
            Field {
                name: "`coordinateTransformations`: scale, translation",
                file: |f| {
                    let axes = json!([space("z", "um"), space("y", "um"), space("x", "um")]);
                    let inner = json!([{"type": "scale", "scale": [5, 2, 1]}, {"type": "translation", "translation": [50, 20, 10]}]);
                    let outer = json!([{"type": "scale", "scale": [10, 10, 10]}, {"type": "translation", "translation": [1, 2, 3]}]);
                    pyramid(f, &[2, 2, 3], axes, inner, outer)
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing, frame.origin),
                        ([10.0, 20.0, 50.0], [103.0, 202.0, 501.0])
                    );
                    assert_eq!(*volume(&path.join("0")).frame(), frame);
                }),
            },
            Field {
                name: "other `coordinateTransformations`",
                file: |f| {
                    let axes = json!(["z", "y", "x"]);
                    pyramid(
                        f,
                        &[2, 2, 3],
                        axes,
                        json!([{"type": "rotation", "rotation": [1]}]),
                        json!([]),
                    )
                },
                fate: Fate::Refused(&["rotation", "only scale and translation"]),
            },
            Field {
                name: "`unit`",
                file: |f| {
                    let axes = json!([
                        space("z", "nanometer"),
                        space("y", "micrometer"),
                        space("x", "micrometer")
                    ]);
                    pyramid(
                        f,
                        &[2, 2, 3],
                        axes,
                        json!([{"type": "scale", "scale": [500, 1, 1]}]),
                        json!([]),
                    )
                },
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!(
                        (frame.spacing, frame.coordinates.unit),
                        ([1.0, 1.0, 0.5], LengthUnit::Micrometre)
                    );
                }),
            },
            Field {
                name: "a `unit` that is not a length",
                file: |f| {
                    let axes = json!([
                        space("z", "furlong"),
                        space("y", "furlong"),
                        space("x", "furlong")
                    ]);
                    pyramid(f, &[2, 2, 3], axes, json!([]), json!([]))
                },
                fate: Fate::PassedOver(&["furlong"]),
            },
            Field {
                name: "`datasets` (levels)",
                file: |f| pyramid(f, &[2, 2, 3], json!(["z", "y", "x"]), json!([]), json!([])),
                fate: Fate::Read(|path| {
                    let error =
                        read(path, &ReadOptions::default().level(1u32)).unwrap_err().to_string();
                    assert!(error.contains("no level 1: there are 1"), "{error}");
                }),
            },
            Field {
                name: "groups without levels",
                file: |f| {
                    put(f, ".zgroup", &json!({"zarr_format": 2}));
                    with(&f.join("a"), &[]);
                    f.to_owned()
                },
                fate: Fate::Refused(&[
                    "a Zarr group without the levels of OME-Zarr",
                    "name one of these",
                ]),
            },
            Field {
                name: "several `multiscales`",
                file: |f| {
                    let path = pyramid(f, &[2, 2, 3], json!(["z", "y", "x"]), json!([]), json!([]));
                    let first = json!({"axes": ["z", "y", "x"], "datasets": [{"path": "0"}]});
                    let second = json!({"axes": ["z", "y", "x"], "datasets": [{"path": "1"}]});
                    put(f, ".zattrs", &json!({"multiscales": [first, second]}));
                    path
                },
                fate: Fate::PassedOver(&["of its 2 images (multiscales) the first is read"]),
            },
            Field {
                name: "`scale_factor`, `add_offset` (CF, xarray)",
                file: |f| stating(f, json!({"scale_factor": 0.5, "add_offset": -1000})),
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!(volume.as_slice()[..3], [-1000.0, -999.0, -998.0]);
                    assert_eq!(volume.dtype(), Dtype::F32);
                    assert_eq!(parts(path)[..3], [-1000.0, -999.0, -998.0]);
                }),
            },
            Field {
                name: "`_FillValue`, `missing_value`",
                file: |f| stating(f, json!({"_FillValue": 0, "missing_value": [22]})),
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    let missing: Vec<usize> = (0..12).filter(|&i| volume.is_missing(i)).collect();
                    assert_eq!((missing, volume.value_range()), (vec![0, 11], (2.0, 20.0)));
                    assert!(parts(path)[0].is_nan() && parts(path)[1] == 2.0);
                }),
            },
            Field {
                name: "`_Unsigned`",
                file: |f| {
                    let bytes: Vec<u8> = (244..=255).collect();
                    array(f, &[2, 2, 3], &[("dtype", json!("|i1"))], &bytes);
                    stating_beside(f, json!({"_Unsigned": "true"}))
                },
                fate: Fate::Read(|path| {
                    let volume = volume(path);
                    assert_eq!((volume.as_slice()[11], volume.dtype()), (255.0, Dtype::U8));
                    assert_eq!(parts(path)[0], 244.0);
                }),
            },
            Field {
                name: "`valid_min`, `valid_max`, `valid_range`",
                file: |f| stating(f, json!({"valid_range": [2, 10]})),
                fate: Fate::PassedOver(&["valid_range is passed over"]),
            },
            Field {
                name: "`fill_value` that xarray takes for missing",
                file: |f| {
                    with(f, &[("fill_value", json!(22))]);
                    stating_beside(f, json!({"_ARRAY_DIMENSIONS": ["z", "y", "x"]}))
                },
                fate: Fate::PassedOver(&["its fill_value 22 is read as a sample"]),
            },
            Field {
                name: "coordinates: arrays called as the axes, beside the array",
                file: |f| coordinates(f, &[10, 8]),
                fate: Fate::Read(|path| {
                    let frame = *volume(path).frame();
                    assert_eq!((frame.spacing, frame.origin), ([0.5, 2.0, 1.0], [5.0, 10.0, 0.0]));
                    assert_eq!(frame.direction[1][1], -1.0);
                    assert_eq!(frame.coordinates.unit, LengthUnit::Millimetre);
                }),
            },
            Field {
                name: "coordinates that are not evenly spaced",
                file: |f| coordinates(f, &[10, 10]),
                fate: Fate::PassedOver(&["the coordinates y beside it are passed over"]),
            },
            Field {
                name: "`omero` and other attributes",
                file: |f| {
                    let path = with(f, &[]);
                    put(f, ".zattrs", &json!({"omero": {"channels": []}, "title": "a head"}));
                    path
                },
                fate: Fate::Read(same_without_a_word),
            },
        ],
    );
}
