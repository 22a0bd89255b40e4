//! A shape in blocks that do not know each other, against the same shape in one piece.

mod damaged;
mod degenerate;
mod refused;

use std::num::NonZeroUsize;
use std::path::Path;

use walpha::outofcore::{Cutting, Job, Merged, Plan, merge, run, whole};
use walpha::pipeline::{AlphaRule, Choice, Model};
use walpha::shape::{Component, Engine};
use walpha::volume::open;
use walpha::{
    Alpha, AlphaShape, Decomposition, Recipe, Selection, SelectionRule, Tolerance, Weighting,
};

use crate::common::has_skull;

/// The job in one piece, in as many blocks of a k-d tree as asked for.
fn in_one_piece(job: &Job, blocks: usize) -> Model {
    let volume = open(&job.input, &job.recipe.read).unwrap();
    let recipe = job.recipe.clone().blocks(NonZeroUsize::new(blocks)).refuse_flat(true);
    recipe.run(volume).unwrap()
}

fn planned(job: &Job, blocks: usize, folder: &Path) -> Plan {
    let cutting = Cutting::default().blocks(blocks);
    Plan::make(job.clone(), cutting, folder).unwrap()
}

fn in_blocks(job: &Job, blocks: usize) -> (Plan, Merged, AlphaShape) {
    let folder = tempfile::tempdir().unwrap();
    let made = planned(job, blocks, folder.path());
    let plan = Plan::open(folder.path()).unwrap();
    assert_eq!((&plan, plan.digest()), (&made, made.digest()));
    // In any order.
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
        assert_eq!(merged.measures, *expected.measures(), "{what}");
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

/// No power of two along any edge; a few of its points, so that it takes seconds.
#[test]
fn a_phantom_of_no_power_of_two_in_blocks_is_the_phantom() {
    let mut job = job("sample:phantom@200");
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
    job = self::job("sample:phantom@200");
    job.recipe.haar =
        job.recipe.haar.decomposition(Decomposition::Standard).tolerance(Tolerance::Rms(3.0));
    job.recipe.choice = selected(SelectionRule::Count(30_000));
    (job.recipe.alpha, job.recipe.engine) = (alpha(30.0), Engine::Native);
    compare(&job, &[6]);
}
