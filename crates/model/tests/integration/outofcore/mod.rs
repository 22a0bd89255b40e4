//! A shape in independent blocks against the same shape in one piece: ties, noise, flat volumes, and what is refused.

mod damaged;

use std::fs::File;
use std::num::NonZeroUsize;
use std::path::Path;

use walpha_base::random::Random;
use walpha_model::export::{ExportOptions, Format};
use walpha_model::interpolate::Refit;
use walpha_model::outofcore::{Alone, BlocksError, Cutting, Job, Merged, Plan, merge, run, whole};
use walpha_model::pipeline::{AlphaRule, Choice, Goal, Model, PeriodicBox};
use walpha_model::{Advise, Recipe};
use walpha_points::haar::{Decomposition, Tolerance};
use walpha_points::{Selection, SelectionRule, Units, Weighting};
use walpha_shape::{Alpha, AlphaShape, Balls};
use walpha_shape::{Component, Engine, Torus};
use walpha_volume::GrayRange;
use walpha_volume::{Nan, ReadOptions, open};

use crate::has_skull;

/// The job in one piece, in the requested number of blocks of a k-d tree.
fn in_one_piece(job: &Job, blocks: usize) -> Model {
    let volume = open(&job.input, &job.recipe.read).unwrap();
    let recipe = job.recipe.clone().blocks(NonZeroUsize::new(blocks)).refuse_flat(true);
    recipe.run(volume).unwrap()
}

fn planned(job: &Job, blocks: usize, folder: &Path) -> Plan {
    let cutting = Cutting::default().blocks(blocks);
    Plan::make(job.clone(), cutting, folder, &Alone).unwrap()
}

fn in_blocks(job: &Job, blocks: usize) -> (Plan, Merged, AlphaShape) {
    let folder = tempfile::tempdir().unwrap();
    let made = planned(job, blocks, folder.path());
    let plan = Plan::open(folder.path()).unwrap();
    assert_eq!((&plan, plan.digest()), (&made, made.digest()));
    // Blocks can be computed in any order.
    (0..plan.blocks.len()).rev().for_each(|block| run(&plan, block).unwrap());
    let merged = merge(&plan).unwrap();
    let shape = whole(&plan, &merged).unwrap();
    (plan, merged, shape)
}

/// Sizes first, then every number, bit by bit.
fn compare(job: &Job, cuts: &[usize]) -> Model {
    let one = in_one_piece(job, 3);
    let expected = &one.shape;
    for &blocks in cuts {
        let what = format!("{} in {blocks} blocks, {}", job.input, job.weighting());
        let (plan, merged, shape) = in_blocks(job, blocks);
        assert!(plan.blocks.len() <= blocks && (blocks == 1) == (plan.blocks.len() == 1), "{what}");
        assert_eq!(plan.survey.truncation, one.origin.truncation.unwrap(), "{what}");
        assert_eq!(shape.points().len(), expected.points().len(), "{what}");
        assert_eq!(shape.points(), expected.points(), "{what}");
        for (a, b) in [
            (shape.complex().cells.len(), expected.complex().cells.len()),
            (shape.complex().facets.len(), expected.complex().facets.len()),
            (shape.complex().edges.len(), expected.complex().edges.len()),
            (shape.complex().vertices.len(), expected.complex().vertices.len()),
        ] {
            assert_eq!(a, b, "{what}");
        }
        assert_eq!(shape.complex(), expected.complex(), "{what}");
        assert_eq!(shape.sheets(), expected.sheets(), "{what}");
        assert_eq!(shape.coordinates(), expected.coordinates(), "{what}");
        assert_eq!(Some(merged.betti), expected.betti(), "{what}");
        assert_eq!(merged.measures, expected.measures(), "{what}");
        assert_eq!(merged.weights, expected.points().summary(), "{what}");
        assert_eq!(merged.facets.regular, expected.complex().facets.counts().regular, "{what}");
        let components: Vec<Component> = expected.components();
        assert_eq!(merged.components, components, "{what}");
        assert_eq!(shape.components(), components, "{what}");
    }
    one
}

/// The samples of the largest differences.
fn selected(rule: SelectionRule) -> Choice {
    Choice::Difference(Selection::default().rule(rule))
}

fn alpha(squared: f64) -> AlphaRule {
    AlphaRule::Given(Alpha::from_squared(squared).unwrap())
}

fn job(input: &str) -> Job {
    Job::new(input, Recipe::new()).unwrap()
}

const WEIGHTS: [Weighting; 4] =
    [Weighting::Common(0.0), Weighting::MinMax, Weighting::Barycentric, Weighting::BarycentricN];

#[test]
fn the_phantom_in_blocks_is_the_phantom() {
    let mut job = job("sample:phantom@50");
    for weighting in WEIGHTS {
        job.recipe.weighting = Some(weighting);
        compare(&job, &[1, 5, 64]);
    }
    job.recipe.engine = Engine::Native;
    compare(&job, &[2]);
}

#[test]
fn the_skull_in_blocks_is_the_skull() {
    if !has_skull() {
        return;
    }
    let mut job = job("sample:skull");
    for (weighting, blocks) in WEIGHTS.into_iter().zip([[5, 64], [1, 7], [2, 3], [4, 30]]) {
        job.recipe.weighting = Some(weighting);
        let one = compare(&job, &blocks);
        let betti = one.shape.betti().unwrap();
        let has_tunnels = betti.b1 > 0 || weighting != Weighting::Common(0.0);
        assert!(betti.b2 > 0 && has_tunnels, "there is something to cut through: {betti:?}");
    }
}

#[test]
fn a_larger_phantom_in_blocks_is_the_phantom() {
    let mut job = job("sample:phantom@128");
    (job.recipe.engine, job.recipe.weighting) = (Engine::Native, Some(Weighting::MinMax));
    compare(&job, &[5, 64]);
}

/// The size is not a power of two along any edge; few of its points are used, so that it takes seconds.
#[test]
fn a_phantom_of_no_power_of_two_in_blocks_is_the_phantom() {
    let mut job = job("sample:phantom@136");
    job.recipe.choice = selected(SelectionRule::Count(30_000));
    (job.recipe.alpha, job.recipe.weighting) = (alpha(30.0), Some(Weighting::BarycentricN));
    compare(&job, &[5, 64]);
}

/// Functions that reach across the volume, in one slab, and in several.
#[test]
fn the_standard_decomposition_in_blocks_is_the_same() {
    let mut job = job("sample:phantom@50");
    job.recipe.haar.decomposition = Decomposition::Standard;
    for (weighting, tolerance) in WEIGHTS.into_iter().zip([
        Tolerance::Rms(2.0),
        Tolerance::Coefficients(5000),
        Tolerance::Rms(0.0),
        Tolerance::Epsilon(700.0),
    ]) {
        (job.recipe.weighting, job.recipe.haar.tolerance) = (Some(weighting), tolerance);
        let one = compare(&job, &[1, 5, 64]);
        let exact = tolerance == Tolerance::Rms(0.0);
        assert_eq!(one.origin.truncation.unwrap().epsilon == 0.0, exact);
    }
    job = self::job("sample:phantom@136");
    job.recipe.haar =
        job.recipe.haar.decomposition(Decomposition::Standard).tolerance(Tolerance::Rms(3.0));
    job.recipe.choice = selected(SelectionRule::Count(30_000));
    (job.recipe.alpha, job.recipe.engine) = (alpha(30.0), Engine::Native);
    compare(&job, &[6]);
}

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

/// A volume full of ties: four levels, so that thousands of coefficients, differences and spheres are equal.
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
    let error = Plan::make(job(input), Cutting::default(), folder.path(), &Alone).unwrap_err();
    assert!(error.to_string().contains("is NaN"), "{error}");
}

/// A rotated, stretched grid with an origin, in millimetres, in an MHA; and a part of it.
#[test]
fn world_coordinates_and_regions_are_the_same_in_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("turned.mha");
    let volume = walpha_volume::phantom(40).unwrap();
    let axes = [[0.42, 0.56, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.3]];
    let frame = walpha_volume::Frame::from_axes([-31.7, 12.25, 100.0], axes).unwrap();
    let frame = frame.with_coordinates(walpha_volume::Coordinates::PATIENT);
    let volume = volume.with_frame(frame);
    let writer = walpha_volume::VolumeWriter::of(&path).unwrap();
    writer.write(&volume, &mut File::create(&path).unwrap()).unwrap();
    let region = walpha_volume::Region { first: [3, 0, 5], end: [Some(37), None, Some(33)] };
    for region in [None, Some(region)] {
        let read = ReadOptions::default().region(region);
        let recipe = Recipe::new().read(read).weighting(Weighting::MinMax);
        let job = Job::new(path.to_str().unwrap(), recipe).unwrap();
        assert_eq!(job.units, Units::World);
        compare(&job, &[1, 6]);
    }
}

/// A single slice: every block is flat. Files are the same, byte by byte.
#[test]
fn flat_volumes_are_the_same_in_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let input = noise(folder.path(), [60, 50, 1], 1000);
    let job = job(&input);
    let (_, merged, shape) = in_blocks(&job, 6);
    let volume = open(&input, &ReadOptions::default()).unwrap();
    let one = job.recipe.run(volume).unwrap();
    assert_eq!((shape.sheets(), one.shape.sheets()), (None, None));
    assert_eq!(merged.components, one.shape.components());
    let written = |shape: &AlphaShape, format: &str| {
        let mut bytes = Vec::new();
        let exporter = Format::of(Path::new(format)).unwrap().exporter(&ExportOptions::default());
        exporter.write(shape, &mut bytes).unwrap();
        bytes
    };
    for format in ["a.npz", "a.vtp", "a.ply", "a.glb"] {
        assert!(written(&shape, format) == written(&one.shape, format), "{format}");
    }
    assert_eq!(shape.points(), one.shape.points());
    assert_eq!(shape.complex().facets.len(), {
        let mut complex = one.shape.complex().clone();
        complex.retain_shape();
        assert_eq!(*shape.complex(), complex);
        complex.facets.len()
    });
    assert_eq!(Some(merged.betti), one.shape.betti());
}

#[test]
fn what_is_not_local_is_refused() {
    let refused = |job: &Job| {
        let error = job.check().unwrap_err();
        assert!(matches!(error, BlocksError::NotLocal { .. }), "{error}");
        assert!(error.advice().is_some());
    };
    let fresh = Job::new("sample:phantom@20", Recipe::new()).unwrap();
    let recipes = [
        Recipe::new().alpha(Alpha::INFINITE),
        Recipe::new().alpha(AlphaRule::Auto),
        Recipe::new().engine(Engine::Cgal),
        Recipe::new().choice(Choice::Adaptive(Goal::default())),
        Recipe::new().exterior(true),
        Recipe::new().hidden(true),
        Recipe::new().refit(Refit::Shape),
        Recipe::new().periodic(Torus::new([20.0; 3]).ok().map(PeriodicBox::Given)),
    ];
    for recipe in recipes {
        let mut job = fresh.clone();
        job.recipe = recipe;
        refused(&job);
    }
}

#[test]
fn blocks_that_are_missing_or_of_another_plan_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut job = job("sample:phantom@30");
    let plan = planned(&job, 4, folder.path());
    run(&plan, 1).unwrap();
    run(&plan, 3).unwrap();
    let error = merge(&plan).unwrap_err();
    assert_eq!(error.to_string(), "2 of 4 blocks are missing: 0, 2");
    assert_eq!(plan.missing().unwrap(), [0, 2]);
    // An existing block is not changed.
    let written = || std::fs::metadata(plan.block_file(1)).unwrap().modified().unwrap();
    let before = written();
    (0..4).for_each(|block| run(&plan, block).unwrap());
    assert_eq!(written(), before);
    merge(&plan).unwrap();
    assert!(matches!(run(&plan, 4), Err(BlocksError::NoBlock { index: 4, count: 4 })));

    // The existing blocks of the same folder do not belong to another α.
    job.recipe.alpha = alpha(5.0);
    let other = planned(&job, 4, folder.path());
    assert_ne!(other.digest(), plan.digest());
    assert!(matches!(merge(&other), Err(BlocksError::OtherPlan { .. })));
    (0..4).for_each(|block| run(&other, block).unwrap());
    merge(&other).unwrap();

    // Cut off.
    let file = File::options().write(true).open(other.block_file(2)).unwrap();
    file.set_len(file.metadata().unwrap().len() - 1).unwrap();
    assert!(matches!(merge(&other), Err(BlocksError::Damaged { .. })));
    assert_eq!(other.missing().unwrap(), [2]);
}
