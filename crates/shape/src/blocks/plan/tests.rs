//! Compares plans with all possible ones, and tests runs that exceed their plans.

use walpha_regular::internals::Lattice;

use super::*;
use crate::ShapeError;
use crate::blocks::{BlockParams, run as run_blocks};

/// Each cube of a grid has six cells, which with their faces are more than the plan expects for each point.
#[test]
fn a_run_that_will_not_keep_its_bound_is_stopped() {
    let (positions, weights) = grid();
    let sites = Sites::new(&positions, &weights).unwrap();
    let lattice = Lattice::of(&positions, &weights);
    let params = BlockParams { alpha: 0.75, lattice, exterior: false };
    let run = |asked| {
        let plan = Plan {
            partition: Partition::new(&sites, 8),
            at_once: 2,
            at_work: positions.len() as u64,
            bound: Some(Bound { asked, resident: 0 }),
        };
        run_blocks(&sites, &plan, &params, &walpha_base::Monitor::noop())
            .map(|merged| merged.complex.cells.len())
    };
    assert_eq!(run(POINTS * 350), Ok(6 * 19 * 19 * 19));
    let error = run(POINTS * 250).unwrap_err();
    assert!(matches!(error, ShapeError::Plan(_)), "{error}");
}

const POINTS: u64 = 20 * 20 * 20;

/// Points and their weights.
fn grid() -> (Vec<[f64; 3]>, Vec<f64>) {
    let point = |i: u64| [i % 20, i / 20 % 20, i / 400].map(|k| k as f64);
    (0..POINTS).map(|i| (point(i), 0.0)).unzip()
}

#[test]
fn threads_have_a_block_each_unless_halos_are_large() {
    let (positions, weights) = grid();
    let sites = Sites::new(&positions, &weights).unwrap();
    for (reach, threads, expected) in [
        (Reach::Balls(0.75), 3, 3),
        (Reach::Balls(0.75), 16, 4),
        // Halos of three layers: the middle one of three blocks has 13 of 20 layers, which is not everything.
        (Reach::Balls(3.0), 2, 1),
        (Reach::Balls(3.0), 3, 1),
        (Reach::Distance(f64::INFINITY), 4, 1),
    ] {
        let plan = Plan::fast(&sites, reach, threads);
        assert_eq!((plan.partition.len(), plan.at_once), (expected, expected), "{reach:?}");
        assert_eq!(plan.buckets(), 1);
    }
}

/// Compares with all possible plans, for every bound at which the answer changes.
#[test]
fn the_fastest_plan_within_the_bound_is_found() {
    let (positions, weights) = grid();
    let sites = Sites::new(&positions, &weights).unwrap();
    let (reach, threads, resident) = (Reach::Balls(0.75), 3, 1_000_000);
    // Bytes, time, blocks, blocks at the same time: the fastest plan first, and of equal ones the plan with fewer blocks.
    let mut plans = Vec::new();
    for blocks in (0..12).map(|step| 3 << step).take_while(|&blocks| blocks <= MAX_BLOCKS) {
        let largest = Partition::new(&sites, blocks).largest(&sites, reach);
        for at_once in 1..=threads {
            let work = AT_WORK * (at_once * largest) as u64;
            let bytes = resident + (POINTS * DONE + work).max(POINTS * MERGED);
            let time = (blocks * largest) as f64 / at_once as f64;
            plans.push((bytes, time, blocks, at_once));
        }
    }
    plans.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.cmp(&b.2)));
    let mut made = 0;
    for asked in plans.iter().flat_map(|plan| [plan.0 - 1, plan.0]) {
        let bound = Bound { asked, resident };
        let plan = Plan::within(bound, &sites, reach, threads);
        match (plans.iter().find(|plan| plan.0 <= asked), plan) {
            (Some(&(.., blocks, at_once)), Ok(plan)) => {
                assert_eq!((plan.partition.len(), plan.at_once), (blocks, at_once));
                assert_eq!(plan.buckets(), BUCKETS);
                made += 1;
            }
            (None, Err(error)) => {
                let least = plans.iter().map(|plan| plan.0).min().unwrap();
                assert_eq!((error.asked, error.needed), (asked, least));
                let least = plans.iter().filter(|plan| plan.0 == least);
                let fewest = least.map(|plan| plan.2).min();
                assert_eq!(Some(error.blocks), fewest);
            }
            (expected, _) => panic!("{expected:?} for {asked}"),
        }
    }
    assert!(made > 6 && made < 2 * plans.len(), "{made}");
}

#[test]
fn a_block_at_work_has_room_for_its_cells() {
    // Uniformly random points have 6.77 cells per point, each with four vertices and four neighbours.
    assert!(AT_WORK as f64 > 6.77 * 32.0);
}

#[test]
fn more_rows_than_planned_are_noticed() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let sites = Sites::new(&positions, &[0.0; 4]).unwrap();
    let bound = Bound { asked: 1000 + 4 * 100 + 4 * LOCATIONS, resident: 1000 };
    let plan = Plan { bound: Some(bound), ..Plan::whole(&sites) };
    assert_eq!(plan.keeps(200, 2, 4), Ok(()));
    let error = plan.keeps(202, 2, 4).unwrap_err();
    assert_eq!((error.asked, error.needed), (bound.asked, bound.asked + 4));
    assert_eq!(Plan::whole(&sites).keeps(u64::MAX, 1, 4), Ok(()));
}
