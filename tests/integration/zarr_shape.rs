//! A shape in arrays of Zarr, against the shape in memory.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use walpha::shape::Simplices;
use walpha::volume::{ReadOptions, open};
use walpha::{Alpha, Recipe, Weighting};
use zarrs::array::{Array, ElementOwned};
use zarrs::filesystem::FilesystemStore;

use crate::common::{json, run};

const SIDE: usize = 30;

fn array<T: ElementOwned>(folder: &Path, name: &str) -> Vec<T> {
    let store = Arc::new(FilesystemStore::new(folder).unwrap());
    let array = Array::open(store, &format!("/{name}")).unwrap();
    array.retrieve_array_subset_elements(&array.subset_all()).unwrap()
}

/// Rows by the indices of their corners in the volume, with classes, sorted.
fn expected<const N: usize>(simplices: &Simplices<N>, voxels: &[u64]) -> Vec<([u64; N], u8)> {
    let in_shape = simplices.iter().filter(|(_, class)| *class as u8 > 0);
    let row = |(row, class): (&[u32; N], walpha::shape::Class)| {
        let mut corners = row.map(|v| voxels[v as usize]);
        corners.sort_unstable();
        (corners, class as u8)
    };
    let mut rows: Vec<_> = in_shape.map(row).collect();
    rows.sort_unstable();
    rows
}

fn found<const N: usize>(folder: &Path, name: &str) -> Vec<([u64; N], u8)> {
    let corners = array::<u64>(folder, &format!("{name}/corners"));
    let (corners, rest) = corners.as_chunks::<N>();
    assert!(rest.is_empty() && !corners.is_empty(), "{name}");
    let classes = array::<u8>(folder, &format!("{name}/classes"));
    assert_eq!(classes.len(), corners.len(), "{name}");
    let sorted = |row: &[u64; N]| {
        let mut row = *row;
        row.sort_unstable();
        row
    };
    let mut rows: Vec<_> = corners.iter().map(sorted).zip(classes).collect();
    rows.sort_unstable();
    rows
}

#[test]
fn arrays_have_every_simplex_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let input = format!("sample:phantom@{SIDE}");
    let options = ["--weights", "min-max", "--alpha", "6", "--blocks", "7"];
    let report =
        json(at, &[&["shape", &input][..], &options, &["-o", "out.zarr", "out.pvtp"]].concat());
    let zarr = at.join("out.zarr");

    let volume = open(&input, &ReadOptions::default()).unwrap();
    let alpha = Alpha::from_squared(6.0).unwrap();
    let recipe = Recipe::new().weighting(Weighting::MinMax).alpha(alpha);
    let model = recipe.run(volume).unwrap();
    let (points, complex) = (model.shape.points(), model.shape.complex());
    let voxel =
        |p: &[f64; 3]| p[0] as u64 + SIDE as u64 * (p[1] as u64 + SIDE as u64 * p[2] as u64);
    let voxels: Vec<u64> = points.positions().iter().map(voxel).collect();

    assert_eq!(found::<1>(&zarr, "vertices"), expected(&complex.vertices, &voxels));
    assert_eq!(found::<2>(&zarr, "edges"), expected(&complex.edges, &voxels));
    assert_eq!(found::<3>(&zarr, "facets"), expected(&complex.facets, &voxels));
    assert_eq!(found::<4>(&zarr, "cells"), expected(&complex.cells, &voxels));

    let corners = array::<u64>(&zarr, "vertices/corners");
    let positions = array::<f64>(&zarr, "vertices/positions");
    let weights = array::<f64>(&zarr, "vertices/weights");
    let values = array::<f64>(&zarr, "vertices/values");
    let (positions, _) = positions.as_chunks::<3>();
    assert_eq!([positions.len(), weights.len(), values.len()], [corners.len(); 3]);
    for (k, corner) in corners.iter().enumerate() {
        let v = voxels.binary_search(corner).unwrap();
        assert_eq!(positions[k], points.positions()[v]);
        assert_eq!(weights[k], points.weights()[v]);
        assert_eq!(values[k], points.values().unwrap()[v]);
    }
    let components = array::<u32>(&zarr, "vertices/components");
    let most = components.iter().max().unwrap() + 1;
    assert_eq!(u64::from(most), report["shape"]["betti"][0].as_u64().unwrap());
    let metadata = fs::read_to_string(zarr.join("zarr.json")).unwrap();
    let metadata: serde_json::Value = serde_json::from_str(&metadata).unwrap();
    assert_eq!(metadata["attributes"]["walpha"]["alpha"], 6.0);
}

#[test]
fn a_folder_that_is_there_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::create_dir(at.join("out.zarr")).unwrap();
    fs::write(at.join("out.zarr/kept"), "").unwrap();
    let (code, _, stderr) = run(at, &["shape", "sample:phantom@16", "-o", "out.zarr"]);
    assert!(code == 1 && stderr.contains("out.zarr") && stderr.contains("remove it"), "{stderr}");
    assert!(at.join("out.zarr/kept").exists() && !at.join("out.blocks").exists());
}
