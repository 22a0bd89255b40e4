//! Zarr arrays and OME-Zarr pyramids, written with the zarrs crate or by hand.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use serde_json::json;
use walpha::Volume;
use walpha::volume::{ReadOptions, VolumeError, read};
use zarrs::array::{ArrayBuilder, DataType, FillValue};
use zarrs::array_subset::ArraySubset;
use zarrs::filesystem::FilesystemStore;
use zarrs::group::GroupBuilder;

use crate::common::Told;
use crate::common::alone;
use crate::common::fails;
use crate::common::largest;

fn open(path: &Path, level: Option<u32>) -> Result<Volume, VolumeError> {
    read(path, &ReadOptions::default().level(level))
}

fn numbers(shape: &[u64]) -> Vec<u16> {
    (0..shape.iter().product::<u64>()).map(|i| 3 * i as u16).collect()
}

/// An array of version 3 in chunks that do not divide it.
fn array(folder: &Path, at: &str, shape: &[u64]) {
    let store = Arc::new(FilesystemStore::new(folder).unwrap());
    let chunks: Vec<u64> = shape.iter().map(|size| (*size).min(2)).collect();
    let array = ArrayBuilder::new(shape.to_vec(), chunks, DataType::UInt16, FillValue::from(0u16))
        .bytes_to_bytes_codecs(vec![Arc::new(zarrs::array::codec::GzipCodec::new(5).unwrap())])
        .build(store, at)
        .unwrap();
    array.store_metadata().unwrap();
    let all = ArraySubset::new_with_shape(shape.to_vec());
    array.store_array_subset_elements(&all, &numbers(shape)).unwrap();
}

/// An uncompressed array of version 2, by hand: one chunk.
fn array_v2(folder: &Path, shape: [u64; 3], dtype: &str, bytes: &[u8]) {
    fs::create_dir_all(folder).unwrap();
    let metadata = json!({
        "zarr_format": 2, "shape": shape, "chunks": shape, "dtype": dtype, "compressor": null,
        "fill_value": 0, "order": "C", "filters": null
    });
    fs::write(folder.join(".zarray"), metadata.to_string()).unwrap();
    fs::write(folder.join("0.0.0"), bytes).unwrap();
}

fn pyramid(folder: &Path, version: u8, datasets: serde_json::Value) {
    let multiscales = json!([{
        "axes": [
            {"name": "c", "type": "channel"},
            {"name": "z", "type": "space"}, {"name": "y", "type": "space"}, {"name": "x", "type": "space"}
        ],
        "datasets": datasets,
        "coordinateTransformations": [{"type": "scale", "scale": [1, 1, 1, 10]}]
    }]);
    if version == 2 {
        fs::write(folder.join(".zgroup"), json!({"zarr_format": 2}).to_string()).unwrap();
        fs::write(folder.join(".zattrs"), json!({"multiscales": multiscales}).to_string()).unwrap();
        return;
    }
    let store = Arc::new(FilesystemStore::new(folder).unwrap());
    let mut group = GroupBuilder::new().build(store, "/").unwrap();
    group
        .attributes_mut()
        .insert("ome".into(), json!({"version": "0.5", "multiscales": multiscales}));
    group.store_metadata().unwrap();
}

fn levels() -> serde_json::Value {
    json!([
        {"path": "0", "coordinateTransformations": [{"type": "scale", "scale": [1, 4, 2, 0.5]}]},
        {"path": "1", "coordinateTransformations": [
            {"type": "scale", "scale": [1, 8, 4, 1]}, {"type": "translation", "translation": [0, 2, 1, 0.25]}
        ]}
    ])
}

#[test]
fn arrays_of_both_versions_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    array(f, "/", &[3, 4, 5]);
    let volume = open(f, None).unwrap();
    assert_eq!(volume.dims().xyz(), [5, 4, 3]);
    let expected: Vec<f32> = numbers(&[3, 4, 5]).into_iter().map(f32::from).collect();
    assert_eq!(volume.as_slice(), expected);
    let second = f.join("v2");
    array_v2(&second, [1, 2, 3], "|u1", &[1, 2, 3, 4, 5, 255]);
    let volume = open(&second, None).unwrap();
    assert_eq!(volume.as_slice(), [1.0, 2.0, 3.0, 4.0, 5.0, 255.0]);
    assert!(volume.has_gray_levels());
    let big: Vec<u8> = [-1.5f64, 2.0].iter().flat_map(|v| v.to_be_bytes()).collect();
    array_v2(&second, [1, 1, 2], ">f8", &big);
    assert_eq!(open(&second, None).unwrap().as_slice(), [-1.5, 2.0]);
}

#[test]
fn levels_of_a_pyramid_are_chosen_and_placed() {
    for version in [2, 3] {
        let folder = tempfile::tempdir().unwrap();
        let f = folder.path();
        pyramid(f, version, levels());
        array(f, "/0", &[1, 3, 4, 5]);
        array(f, "/1", &[1, 2, 2, 3]);
        let fine = open(f, None).unwrap();
        assert_eq!((fine.dims().xyz(), fine.frame().spacing), ([5, 4, 3], [5.0, 2.0, 4.0]));
        let coarse = open(f, Some(1)).unwrap();
        assert_eq!((coarse.dims().xyz(), coarse.frame().spacing), ([3, 2, 2], [10.0, 4.0, 8.0]));
        assert_eq!(coarse.frame().origin, [2.5, 1.0, 2.0]);
        let text = open(f, Some(2)).unwrap_err().told();
        assert!(text.contains("no level 2: there are 2"), "{text}");
        // A level by its own name.
        assert_eq!(open(&f.join("1"), None).unwrap().dims().xyz(), [3, 2, 2]);
        let text = open(&f.join("1"), Some(0)).unwrap_err().told();
        assert!(text.contains("omit `level`"), "{text}");
    }
}

/// The metadata of a store name files in it and no others.
#[test]
fn levels_outside_the_store_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path().join("store");
    array(folder.path(), "/secret", &[1, 2, 2, 2]);
    fs::create_dir(&f).unwrap();
    for name in ["../secret", "0/../../secret", "/../secret"] {
        pyramid(&f, 2, json!([{"path": name}]));
        let text = open(&f, None).unwrap_err().told();
        assert!(text.contains("outside the store") && text.contains("secret"), "{text}");
    }
    // A path that looks absolute is relative to the top of the store.
    pyramid(&f, 2, json!([{"path": folder.path().join("secret")}]));
    assert!(open(&f, None).is_err());
}

#[test]
fn what_is_no_volume_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let refuses = |path: &Path, part: &str| {
        let text = open(path, None).unwrap_err().told();
        assert!(text.contains(part), "{part:?} is missing in {text}");
    };
    fs::write(f.join(".zgroup"), "{\"zarr_format\": 2}").unwrap();
    refuses(f, "of nothing");
    array_v2(&f.join("a"), [1, 1, 2], "<f4", &[0; 8]);
    refuses(f, "name one of these");
    array_v2(&f.join("a"), [1, 1, 2], "<f4", &[0; 7]);
    refuses(&f.join("a"), "cannot be read");
    array_v2(&f.join("a"), [1, 1, 2], "<c8", &[0; 16]);
    refuses(&f.join("a"), "type");
    array_v2(&f.join("a"), [1, 1, 2], "<f4", &f32::NAN.to_le_bytes().repeat(2));
    refuses(&f.join("a"), "NaN");
    array_v2(&f.join("a"), [1 << 20, 1 << 20, 2], "<f4", &[]);
    refuses(&f.join("a"), "too many");
    fs::write(f.join("a/.zarray"), "{").unwrap();
    refuses(&f.join("a"), "cannot be read");
    array(f, "/flat", &[4, 5]);
    refuses(&f.join("flat"), "three axes");
    array(f, "/colours", &[3, 2, 2, 2]);
    refuses(&f.join("colours"), "choose one with `frame`");
    let turned = json!([{"path": "colours", "coordinateTransformations": [{"type": "affine"}]}]);
    array(f, "/colours", &[1, 2, 2, 2]);
    pyramid(f, 2, turned);
    refuses(f, "affine");
}

/// Two slices of six million samples each, in chunks of 3000 rows of which one is there. The samples
/// take 48 MB; nothing else may be so large.
#[test]
fn long_slices_are_read_in_pieces() {
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        let metadata = json!({
            "zarr_format": 2, "shape": [2, 3_000_000, 2], "chunks": [2, 3000, 2], "dtype": "<f8",
            "compressor": null, "fill_value": 0, "order": "C", "filters": null
        });
        fs::write(folder.path().join(".zarray"), metadata.to_string()).unwrap();
        let chunk: Vec<u8> = (0..12_000).flat_map(|i| f64::from(i).to_le_bytes()).collect();
        fs::write(folder.path().join("0.700.0"), chunk).unwrap();
        let volume = open(folder.path(), None).unwrap();
        let samples = volume.samples();
        assert_eq!(samples[[0, 2_100_000, 1]], 1.0);
        assert_eq!(samples[[1, 2_102_999, 1]], 11_999.0);
        assert_eq!(samples.iter().filter(|&&v| v != 0.0).count(), 11_999);
        let largest = largest();
        assert!(largest < 50 << 20, "{largest} bytes at once");
    });
}

#[test]
fn chunks_far_larger_than_their_array_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    array_v2(folder.path(), [2, 3, 2], "|u1", &[0; 12]);
    let metadata = fs::read_to_string(folder.path().join(".zarray")).unwrap();
    let large = metadata.replace("\"chunks\":[2,3,2]", "\"chunks\":[2,3,1099511627776]");
    assert_ne!(large, metadata);
    fs::write(folder.path().join(".zarray"), large).unwrap();
    let error = open(folder.path(), None).unwrap_err().told();
    assert!(error.contains("has chunks of 6597069766656 samples"), "{error}");
}

/// A chunk that holds chunks: of two the index says where they are.
#[test]
fn a_shard_leads_nowhere_else_than_into_itself() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = json!([{"name": "bytes", "configuration": {"endian": "little"}}]);
    let metadata = |location: &str| {
        json!({
            "zarr_format": 3, "node_type": "array", "shape": [1, 2, 4], "data_type": "uint8", "fill_value": 7,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [1, 2, 4]}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
            "codecs": [{"name": "sharding_indexed", "configuration": {
                "chunk_shape": [1, 1, 4], "codecs": bytes, "index_codecs": bytes, "index_location": location
            }}]
        })
    };
    fs::create_dir_all(folder.path().join("c/0/0")).unwrap();
    let shard = |location: &str, index: [u64; 4]| {
        fs::write(folder.path().join("zarr.json"), metadata(location).to_string()).unwrap();
        let index = index.map(u64::to_le_bytes).concat();
        let data = [1, 2, 3, 4, 5, 6, 7, 8];
        let parts = if location == "end" { [&data[..], &index] } else { [&index[..], &data] };
        fs::write(folder.path().join("c/0/0/0"), parts.concat()).unwrap();
        open(folder.path(), None).map(|volume| volume.as_slice().to_vec())
    };
    let samples = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    assert_eq!(shard("end", [0, 4, 4, 4]).unwrap(), samples);
    assert_eq!(shard("start", [32, 4, 36, 4]).unwrap(), samples);
    let half = [7.0, 7.0, 7.0, 7.0, 5.0, 6.0, 7.0, 8.0];
    assert_eq!(shard("end", [u64::MAX, u64::MAX, 4, 4]).unwrap(), half);
    // Twice 2⁶³ is 0, to who adds 64 bits; and more.
    for wrong in
        [[1 << 63, 1 << 63, 4, 4], [0, 4, 1 << 63, 4], [0, 4, 4, 1 << 40], [0, 4, u64::MAX, 4]]
    {
        for location in ["start", "end"] {
            let error = shard(location, wrong).unwrap_err().told();
            assert!(error.contains("a shard of 40 bytes says that a chunk of"), "{error}");
        }
    }
    fs::write(folder.path().join("c/0/0/0"), [0; 20]).unwrap();
    let error = open(folder.path(), None).unwrap_err().told();
    assert!(error.contains("too short for its index"), "{error}");
}

/// 600 million samples, of which nothing is there.
#[test]
fn claims_that_nothing_stored_can_bear_out_take_no_memory() {
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        let metadata = json!({
            "zarr_format": 2, "shape": [600, 1000, 1000], "chunks": [10, 100, 100], "dtype": "|u1",
            "compressor": null, "fill_value": 0, "order": "C", "filters": null
        });
        fs::write(folder.path().join(".zarray"), metadata.to_string()).unwrap();
        let error = open(folder.path(), None).unwrap_err().told();
        assert!(error.contains("claims 1000×1000×600 samples and holds"), "{error}");
        assert!(error.contains("nearly all its chunks are missing"), "{error}");
        assert!(largest() < 50 << 20);
    });
}

/// An array of 4 GB of which nothing is stored: whoever goes through its parts would not end.
#[test]
fn missing_chunks_are_not_visited() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let head = json!({
        "zarr_format": 2, "shape": [65536, 65535, 1], "chunks": [64, 64, 1], "dtype": "|u1",
        "compressor": null, "fill_value": 0, "order": "C", "filters": null,
    });
    fs::create_dir(f.join("a.zarr")).unwrap();
    fs::write(f.join("a.zarr/.zarray"), head.to_string()).unwrap();
    for command in [
        "info a.zarr",
        "convert a.zarr -o b.zarr",
        "blocks plan a.zarr --alpha 10 --blocks 2 -o work",
        "shape a.zarr --alpha 10 --blocks 2 -o x.pvtu",
    ] {
        fails(f, 1, command, &["nearly all its chunks are missing", "copy the whole store"]);
    }
}
