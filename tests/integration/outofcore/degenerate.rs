//! Noise, ties, missing samples, tilted grids and flat volumes.

use std::fs::File;
use std::path::Path;

use walpha::outofcore::{Cutting, Job, Plan};
use walpha::pipeline::Choice;
use walpha::volume::{Nan, ReadOptions, open};
use walpha::{
    Balls, Decomposition, GrayRange, Recipe, Selection, SelectionRule, Tolerance, Units, Weighting,
};
use walpha_base::random::Random;

use super::{alpha, compare, in_blocks, job, selected};

/// Noise in a file: singular simplices of all kinds and thousands of components.
fn noise(folder: &Path, [x, y, z]: [usize; 3], levels: usize) -> String {
    let path = folder.join("noise.npy");
    let mut random = Random::new(12345);
    let samples = ndarray::Array3::from_shape_simple_fn((z, y, x), || {
        random.below(levels) as f32 * 1.3 - 200.0
    });
    ndarray_npy::WriteNpyExt::write_npy(&samples, File::create(&path).unwrap()).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn noise_in_blocks_is_noise() {
    let folder = tempfile::tempdir().unwrap();
    let input = noise(folder.path(), [37, 22, 29], 1 << 24);
    let mut job = job(&input);
    for squared in [0.3, 1.0, 2.25] {
        job.recipe.alpha = alpha(squared);
        job.recipe.choice = selected(SelectionRule::Ratio(0.1));
        let one = compare(&job, &[5, 40]);
        assert!(one.shape.betti().unwrap().b0 > 1 || squared > 0.3);
    }
    job.recipe.balls = Balls::Radius;
    job.recipe.weighting = Some(Weighting::MinMax);
    compare(&job, &[6]);
}

/// Nothing but ties: four levels, so that coefficients, differences and spheres are equal by the thousand.
#[test]
fn ties_across_blocks_are_broken_as_in_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let input = noise(folder.path(), [33, 20, 24], 4);
    let mut job = job(&input);
    job.recipe.haar = job.recipe.haar.tolerance(Tolerance::Coefficients(5001));
    for count in [777, 3000, 15840] {
        job.recipe.choice = selected(SelectionRule::Count(count));
        job.recipe.alpha = alpha(3.0);
        compare(&job, &[4, 25]);
    }
    job.recipe.choice = Choice::Difference(
        Selection::default().rule(SelectionRule::Threshold(60.0)).gray_min(80.0),
    );
    compare(&job, &[4]);
    job.recipe.choice =
        Choice::Difference(Selection::default().rule(SelectionRule::Count(500)).gray_min(170.0));
    compare(&job, &[3]);
    job.recipe.haar.decomposition = Decomposition::Standard;
    compare(&job, &[3]);
}

#[test]
fn missing_samples_and_given_ranges_are_the_same_in_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("holes.npy");
    let samples = ndarray::Array3::from_shape_fn((20, 30, 25), |(z, y, x)| {
        let hole = (x as i32 - 12).pow(2) + (y as i32 - 10).pow(2) < 9;
        if hole { f32::NAN } else { ((x * 7 + y * y * 3 + z * z * z) % 251) as f32 * 3.7 }
    });
    ndarray_npy::WriteNpyExt::write_npy(&samples, File::create(&path).unwrap()).unwrap();
    let input = path.to_str().unwrap();
    for nan in [Nan::Mask, Nan::Value(50.0)] {
        let read = ReadOptions::default().nan(nan);
        let mut job = Job::new(input, Recipe::new().read(read)).unwrap();
        compare(&job, &[5]);
        job.recipe.gray = Some(GrayRange { low: 100.0, high: 700.0 });
        compare(&job, &[3]);
    }
    let error = Plan::make(job(input), Cutting::default(), folder.path()).unwrap_err();
    assert!(error.to_string().contains("is NaN"), "{error}");
}

/// A rotated, stretched grid with an origin, in millimetres, in an MHA; and a part of it.
#[test]
fn world_coordinates_and_regions_are_the_same_in_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turned.mha");
    let volume = walpha::volume::phantom(40).unwrap();
    let axes = [[0.42, 0.56, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.3]];
    let frame = walpha::Frame::from_axes([-31.7, 12.25, 100.0], axes).unwrap();
    let frame = frame.with_coordinates(walpha::Coordinates::PATIENT);
    let volume = volume.with_frame(frame);
    let writer = walpha::volume::VolumeWriter::of(&path).unwrap();
    writer.write(&volume, &mut File::create(&path).unwrap()).unwrap();
    let region = walpha::volume::Region { first: [3, 0, 5], end: [Some(37), None, Some(33)] };
    for region in [None, Some(region)] {
        let read = ReadOptions::default().region(region);
        let recipe = Recipe::new().read(read).weighting(Weighting::MinMax);
        let job = Job::new(path.to_str().unwrap(), recipe).unwrap();
        assert_eq!(job.units, Units::World);
        compare(&job, &[1, 6]);
    }
}

/// A single slice: every block is flat.
#[test]
fn flat_volumes_are_the_same_in_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let input = noise(folder.path(), [60, 50, 1], 1000);
    let job = job(&input);
    let (_, merged, shape) = in_blocks(&job, 6);
    let volume = open(&input, &ReadOptions::default()).unwrap();
    let one = job.recipe.run(volume).unwrap();
    assert_eq!(shape.points(), one.shape.points());
    assert_eq!(shape.complex().facets.len(), {
        let mut complex = one.shape.complex().clone();
        complex.retain_shape();
        assert_eq!(*shape.complex(), complex);
        complex.facets.len()
    });
    assert_eq!(Some(merged.betti), one.shape.betti());
}
