//! What blocks cannot do, and blocks that are not there.

use std::fs::File;

use walpha::interpolate::Refit;
use walpha::outofcore::{BlocksError, Job, merge, run};
use walpha::pipeline::{AlphaRule, Choice, Goal};
use walpha::shape::Engine;
use walpha::shape::Torus;
use walpha::{Alpha, Recipe};

use super::{alpha, job, planned};

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
        Recipe::new().periodic(Torus::new([20.0; 3]).ok()),
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
    // A block that is there stays as it is.
    let written = || std::fs::metadata(plan.block_file(1)).unwrap().modified().unwrap();
    let before = written();
    (0..4).for_each(|block| run(&plan, block).unwrap());
    assert_eq!(written(), before);
    merge(&plan).unwrap();
    assert!(matches!(run(&plan, 4), Err(BlocksError::NoBlock { index: 4, count: 4 })));

    // The same folder, another α: what is there does not belong to it.
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
