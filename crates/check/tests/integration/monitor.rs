//! Long work reports how far it is, and ends where it is cancelled.

use std::fmt::Debug;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock};

use rayon::ThreadPoolBuilder;
use walpha_base::random::Random;
use walpha_check::schema::{BoxVectors, ComplexFile, FiltrationFile, PairsFile, PlacedComplex};
use walpha_check::{
    CertifyError, CertifyFiltrationError, Claim, CompareError, CompareFiltrationsError,
    EnumerateError, Extent, Monitor, certify_filtration, compare, compare_filtrations, enumerate,
};

use crate::common::{Answer, Case, definition, grid, shape_of};
use crate::ties::mirrored_cube;

/// Does work on one thread, and cancels it at its report number `last`. Returns all reports, and the outcome.
fn reports<T: Send, E: Send>(
    work: &(impl Fn() -> Result<T, E> + Sync),
    last: usize,
) -> (Vec<[u64; 2]>, Result<T, E>) {
    let heard = Arc::new(Mutex::new(Vec::new()));
    let this = Arc::new(OnceLock::<Monitor>::new());
    let (list, own) = (Arc::clone(&heard), Arc::clone(&this));
    let monitor = Monitor::new(move |done, total| {
        let mut list = list.lock().unwrap();
        list.push([done, total]);
        if list.len() == last {
            own.get().unwrap().cancel();
        }
    });
    this.set(monitor.clone()).unwrap();
    let one = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let outcome = one.install(|| monitor.watch(work));
    let heard = heard.lock().unwrap().clone();
    (heard, outcome)
}

/// Asserts that work moves forward on one scale to its end, at least so often; and that, cancelled at any of its
/// reports, it ends there and says so.
fn assert_moves<T: Send, E: Debug + Send>(
    least: usize,
    work: impl Fn() -> Result<T, E> + Sync,
    is_cancelled: impl Fn(&E) -> bool,
) {
    let (all, outcome) = reports(&work, usize::MAX);
    outcome.map(drop).unwrap();
    assert!(all.len() >= least, "{all:?}");
    assert!(all.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{all:?}");
    assert!(all.iter().all(|[_, total]| *total == all[0][1]), "{all:?}");
    assert!(all.last().is_some_and(|[done, total]| done == total), "{all:?}");
    for last in 1..=all.len() {
        let (heard, outcome) = reports(&work, last);
        assert!(heard[..] == all[..last], "after report {last}: {:?}", &heard[last..]);
        let error = outcome.map(drop).expect_err("it was cancelled");
        assert!(is_cancelled(&error), "{error:?}");
    }
}

/// Random points, some of them hidden, or a grid, which is full of ties.
fn case(on_grid: bool) -> Case {
    let mut random = Random::new(30);
    let mut positions = grid(3);
    if !on_grid {
        positions.iter_mut().flatten().for_each(|x| *x = random.unit());
    }
    let weights = positions.iter().map(|_| if on_grid { 0.0 } else { random.unit() / 2.0 });
    Case { weights: weights.collect(), positions, alpha: if on_grid { 0.75 } else { 0.03 } }
}

#[test]
fn judgements_of_complexes_move() {
    let moves = |least, claim: Claim| {
        let is_cancelled = |error: &CertifyError| matches!(error, CertifyError::Cancelled(_));
        assert_moves(least, || claim.findings(), is_cancelled);
        let visit = || claim.visit(&mut |_| ControlFlow::Continue(()));
        assert_moves(least, visit, is_cancelled);
    };
    for on_grid in [false, true] {
        let case = case(on_grid);
        let whole = definition(&case).unwrap();
        assert_eq!(whole.hidden.is_empty(), on_grid);
        moves(15, case.claim(&whole, Extent::Whole));
        moves(15, case.claim(&shape_of(&whole), Extent::Shape));
        let mut gap = whole.clone();
        crate::common::drop_row(&mut gap.complex.cells, 7);
        moves(20, case.claim(&gap, Extent::Whole));
    }
    // Another choice among ties, whose spheres are judged one by one; a plane; and one point.
    let positions = mirrored_cube().points;
    let weights = vec![0.0; 8];
    let cube = Case { positions: positions.clone(), weights, alpha: 0.75 };
    let mirrored = positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let other = definition(&Case { positions: mirrored, ..cube.clone() }).unwrap();
    let other = ComplexFile::new(cube.placed(&other.complex));
    let complex = PlacedComplex::try_from(other).unwrap().complex;
    moves(15, cube.claim(&shape_of(&Answer::of(complex)), Extent::Shape));
    for count in [4, 1] {
        let mut flat = cube.clone();
        flat.positions.truncate(count);
        flat.weights.truncate(count);
        moves(6, flat.claim(&definition(&flat).unwrap(), Extent::Whole));
    }
}

#[test]
fn a_judgement_of_a_torus_moves() {
    let case = case(true);
    let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
    file.edges = Some(Vec::new());
    file.vertices = Some(vec![0, 1, 2]);
    file.periodic = Some(BoxVectors::of_sides([4.0; 3]));
    let placed = PlacedComplex::try_from(file).unwrap();
    assert_moves(4, || placed.findings(), |error| matches!(error, CertifyError::Cancelled(_)));
}

/// A cube with pairs, which are wrong.
fn filtration() -> FiltrationFile {
    FiltrationFile { pairs: Some(PairsFile::default()), ..mirrored_cube() }
}

#[test]
fn the_judgement_of_a_filtration_moves() {
    let file = filtration();
    assert_moves(
        40,
        || certify_filtration(&file),
        |error| matches!(error, CertifyFiltrationError::Cancelled(_)),
    );
}

#[test]
fn an_enumeration_moves() {
    let case = case(false);
    assert_moves(
        200,
        || enumerate(&case.positions, &case.weights, case.alpha()),
        |error| matches!(error, EnumerateError::Cancelled(_)),
    );
}

#[test]
fn comparisons_move() {
    let is_cancelled = |error: &CompareError| matches!(error, CompareError::Cancelled(_));
    let case = case(false);
    let [a, b] = [0.03, 0.05].map(|alpha| definition(&Case { alpha, ..case.clone() }).unwrap());
    let different = || compare(case.placed(&a.complex), case.placed(&b.complex));
    assert_moves(100, different, is_cancelled);
    // The same region is cut in another way, so that both are judged.
    let positions = mirrored_cube().points;
    let cube = Case { weights: vec![0.0; 8], positions, alpha: 0.75 };
    let mirrored = cube.positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
    let other = definition(&Case { positions: mirrored, ..cube.clone() }).unwrap().complex;
    let own = definition(&cube).unwrap().complex;
    let tied = || compare(cube.placed(&own), cube.placed(&other));
    assert_moves(100, tied, is_cancelled);
    let (a, b) = (filtration(), filtration());
    assert_moves(
        100,
        || compare_filtrations(&a, &b),
        |error| matches!(error, CompareFiltrationsError::Cancelled(_)),
    );
}
