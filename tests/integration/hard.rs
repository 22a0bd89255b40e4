//! The built-in hard sets: both engines agree on them, the checker certifies them, and the documents list them.

use walpha::check::Verdict;
use walpha::ladder::Filtration;
use walpha::points::{HARD_SETS, HardSet, Points, hard};
use walpha::shape::{Engine, ShapeOptions, WeightedPoints, alpha_shape, placed_complex};
use walpha::{Alpha, AlphaShape};

use crate::common::{self, Told};

fn weighted(set: &HardSet) -> WeightedPoints {
    let Points { positions, weights, .. } = set.points();
    let weights = weights.unwrap_or_else(|| vec![0.0; positions.len()]);
    WeightedPoints::new(positions, weights).unwrap()
}

fn made(set: &HardSet, alpha: Alpha, engine: Engine) -> AlphaShape {
    alpha_shape(weighted(set), &ShapeOptions::new(alpha).engine(engine).exterior(true)).unwrap()
}

#[test]
fn hard_sets_are_certified_and_engines_agree() {
    let mut sizes = Vec::new();
    for set in HARD_SETS {
        let filtration = Filtration::new(weighted(set)).unwrap();
        let ordered = filtration.simplices().unwrap();
        // At a critical value, equality decides.
        let middle = ordered.values()[ordered.values().len() / 2];
        for alpha in [middle, Alpha::INFINITE] {
            let shape = made(set, alpha, Engine::Native);
            let placed = placed_complex(&shape);
            let (findings, certificate) = placed.claim().findings().unwrap();
            assert_eq!(certificate.verdict, Verdict::Exact, "{}: {findings:?}", set.name);
            #[cfg(feature = "cgal")]
            if !filtration.whole().complex().cells.is_empty() {
                let theirs = made(set, alpha, Engine::Cgal);
                assert!(*theirs.complex() == *shape.complex(), "{} at {alpha}", set.name);
            }
        }
        // Betti numbers count the classes that are born and have not died.
        let betti = ordered.betti_curve();
        for (rank, betti) in betti.iter().enumerate().step_by(1 + betti.len() / 20) {
            let alive = [0, 1, 2].map(|dimension| {
                let there = |number: u32| ordered.simplex(number).rank as usize <= rank;
                let intervals = ordered.persistence(dimension).unwrap().into_iter();
                intervals.filter(|i| there(i.begins) && !i.ends.is_some_and(there)).count() as u64
            });
            assert_eq!(alive, <[u64; 3]>::from(*betti), "{} at rank {rank}", set.name);
        }
        sizes.push(filtration.whole().complex().cells.len());
    }
    // All sets except the two flat ones have cells.
    assert_eq!(sizes.iter().filter(|&&cells| cells == 0).count(), 2, "{sizes:?}");
}

#[test]
fn hard_sets_are_named() {
    let told = hard("hard:voxel").unwrap_err().told();
    assert!(told.contains("hard:fcc") && told.contains("did you mean hard:voxels?"), "{told}");
    assert_eq!(hard("voxels").unwrap(), None);
    let document = include_str!("../../docs/cross-checking.md");
    for set in HARD_SETS {
        assert!(document.contains(&format!("| `{}` | {}", set.name, set.about)), "{}", set.name);
        assert_eq!(hard(format!("hard:{}", set.name)).unwrap(), Some(set.points()));
    }
}

#[test]
fn commands_take_hard_sets_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    common::ok(f, &["points", "hard:hidden", "-o", "hidden.csv"]);
    let options = ["--alpha", "0.75", "-o"];
    common::ok(f, &[&["shape", "hard:hidden"], &options[..], &["named.json"]].concat());
    common::ok(f, &[&["shape", "hidden.csv"], &options[..], &["read.json"]].concat());
    common::ok(f, &["compare", "named.json", "read.json"]);
    assert_eq!(common::json(f, &["check", "hard:hidden", "--alpha", "0.75"])["verdict"], "exact");
    assert_eq!(common::json(f, &["info", "hard:slab-18"])["count"], 18);
    let periodic = ["shape", "hard:periodic", "--periodic", "6,6,6", "--alpha", "0.75"];
    let betti = &common::json(f, &periodic)["shape"]["betti"];
    assert_eq!(*betti, serde_json::json!([1, 3, 3, 1]));
}

#[test]
fn a_set_hides_points_where_it_says_so() {
    let set = HARD_SETS.iter().find(|set| set.name == "hidden").unwrap();
    let shape =
        alpha_shape(weighted(set), &ShapeOptions::new(Alpha::INFINITE).hidden(true)).unwrap();
    let hidden = shape.hidden().unwrap().len();
    assert!((1..set.points().len() / 2).contains(&hidden), "{hidden}");
}
