//! Stages that may take long report how far they are, and end where they are cancelled.

use std::sync::{Arc, Mutex};

use walpha_model::Recipe;
use walpha_model::interpolate::{Adaptive, InterpolateError, adaptive_voxels};
use walpha_model::pipeline::{Choice, Goal, PipelineError, Values};
use walpha_model::progress::{Listener, Monitor, Stage};
use walpha_points::haar::HaarOptions;
use walpha_points::haar::{HaarError, smooth};
use walpha_points::{Points, Units};
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, WeightedPoints};
use walpha_shape::{Engine, ShapeError, ShapeOptions, alpha_shape};
use walpha_volume as volume;
use walpha_volume::{Gray, Volume};
use walpha_volume::{ReadOptions, VolumeError, VolumeWriter, open};

/// Keeps what is reported.
#[derive(Clone, Default)]
struct Heard(Arc<Mutex<Vec<[u64; 2]>>>);

impl Listener for Heard {
    fn progress(&self, done: u64, total: u64) {
        self.0.lock().unwrap().push([done, total]);
    }
}

/// Asserts that work moves forward on one scale, at least so often; and that, cancelled at its second report, it
/// ends with that.
fn assert_moves<T, E: std::fmt::Debug>(
    least: usize,
    work: impl Fn() -> Result<T, E>,
    cancelled: impl Fn(&E) -> bool,
) {
    let heard = Heard::default();
    Monitor::new(heard.clone()).watch(&work).map(drop).unwrap();
    let reports = heard.0.lock().unwrap();
    assert!(reports.len() >= least, "{reports:?}");
    assert!(reports.iter().all(|[_, total]| *total == reports[0][1]), "{reports:?}");
    assert!(reports.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{reports:?}");
    assert!(reports.last().is_some_and(|[done, total]| done <= total), "{reports:?}");

    let this = Arc::new(Mutex::new(None::<Monitor>));
    let (count, inside) = (Mutex::new(0), Arc::clone(&this));
    let monitor = Monitor::new(move |_, _| {
        let mut count = count.lock().unwrap();
        *count += 1;
        assert!(*count <= 2, "it goes on");
        if *count == 2 {
            inside.lock().unwrap().as_ref().unwrap().cancel();
        }
    });
    *this.lock().unwrap() = Some(monitor.clone());
    let error = monitor.watch(&work).map(drop).unwrap_err();
    assert!(cancelled(&error), "{error:?}");
}

fn phantom() -> Volume {
    let volume = volume::sample("sample:phantom@16").unwrap();
    volume.into_gray(Gray::Automatic).unwrap().0
}

#[test]
fn the_wavelet_stage_moves() {
    let options = HaarOptions::default();
    assert_moves(
        2,
        || smooth(&phantom(), &options),
        |error| matches!(error, HaarError::Cancelled(_)),
    );
}

/// The points of a lattice.
fn lattice(side: usize) -> WeightedPoints {
    let at = |i: usize| [i % side, i / side % side, i / side / side].map(|c| c as f64);
    let positions: Vec<_> = (0..side.pow(3)).map(at).collect();
    WeightedPoints::unweighted(positions)
}

fn is_cancelled(error: &ShapeError) -> bool {
    matches!(error, ShapeError::Cancelled(_))
}

#[test]
fn a_filtration_moves() {
    let points = lattice(5);
    assert_moves(5, || Filtration::on(None, points.clone()), is_cancelled);
    let filtration = Filtration::new(points).unwrap();
    // Two threads sort side by side; the first report is the first that is heard of.
    assert_moves(3, || filtration.simplices(), is_cancelled);
}

#[test]
fn a_shape_moves_within_its_blocks() {
    let (alpha, engine) = (Alpha::from_squared(1.0).unwrap(), Engine::Native);
    for blocks in [1, 3] {
        let blocks = std::num::NonZeroUsize::new(blocks);
        let options = ShapeOptions::new(alpha).engine(engine).blocks(blocks);
        let work = || alpha_shape(lattice(27), &options);
        // Use one thread, because others may be in the middle of a report.
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        one.install(|| assert_moves(4 + 2 * blocks.unwrap().get(), work, is_cancelled));
    }
}

#[test]
fn adaptive_selection_moves() {
    let goal = Adaptive::new(300);
    assert_moves(
        4,
        || adaptive_voxels(&phantom(), &goal, Units::Voxel),
        |error| matches!(error, InterpolateError::Cancelled(_)),
    );
}

/// Bytes are read by the megabyte.
#[test]
fn reading_moves() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("v.npy");
    let volume = volume::sample("sample:phantom@200").unwrap();
    let format = VolumeWriter::of(&path).unwrap();
    format.write(&volume, &mut std::fs::File::create(&path).unwrap()).unwrap();
    assert_moves(
        2,
        || open(&path, &ReadOptions::default()),
        |error| matches!(error, VolumeError::Cancelled(_)),
    );
}

/// Each stage is heard of in its turn, and a cancelled pipeline has no further one.
#[test]
fn a_pipeline_announces_its_stages_until_it_is_cancelled() {
    struct Until(&'static str, Arc<Mutex<(Vec<&'static str>, Option<Monitor>)>>);
    impl Listener for Until {
        fn stage(&self, name: &'static str) {
            let mut heard = self.1.lock().unwrap();
            heard.0.push(name);
            if name == self.0 {
                heard.1.as_ref().unwrap().cancel();
            }
        }
        fn progress(&self, _: u64, _: u64) {}
    }
    let recipe = Recipe::new();
    for (last, expected) in [("", 4), ("points", 2), ("shape", 4)] {
        let heard = Arc::default();
        let monitor = Monitor::new(Until(last, Arc::clone(&heard)));
        heard.lock().unwrap().1 = Some(monitor.clone());
        let model = monitor.watch(|| recipe.run(phantom()));
        assert_eq!(model.is_ok(), last.is_empty());
        if let Err(error) = model {
            assert!(matches!(error, PipelineError::Cancelled(_)), "{error:?}");
        }
        let heard = &heard.lock().unwrap().0;
        let all = [Stage::Haar, Stage::Points, Stage::Points, Stage::Shape].map(Stage::name);
        assert_eq!(heard[..], all[..expected]);
    }
}

/// However deep the stage is that was at work.
#[test]
fn a_pipeline_that_is_cancelled_within_a_stage_says_so() {
    let recipe = Recipe::new().choice(Choice::Adaptive(Goal::of_count(300)));
    let source = recipe.source(phantom()).unwrap();
    assert_ends(|| recipe.weighed(&source, Values::Written).map(drop));
    let alpha = Alpha::from_squared(1.0).unwrap();
    let recipe = Recipe::new().alpha(alpha).engine(Engine::Native);
    let points = || Points::new(lattice(27).into_parts().0);
    assert_ends(|| recipe.run_points(points()).map(drop));
}

/// Cancels work at its first report.
fn assert_ends(work: impl FnOnce() -> Result<(), PipelineError>) {
    let this = Arc::new(Mutex::new(None::<Monitor>));
    let inside = Arc::clone(&this);
    let monitor = Monitor::new(move |_, _| inside.lock().unwrap().as_ref().unwrap().cancel());
    *this.lock().unwrap() = Some(monitor.clone());
    let error = monitor.watch(work).unwrap_err();
    assert!(matches!(error, PipelineError::Cancelled(_)), "{error:?}");
}
