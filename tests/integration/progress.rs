//! Stages that may take long say how far they are.

use std::fmt::Debug;
use std::sync::{Arc, Mutex};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};
use walpha::interpolate::{Adaptive, adaptive_voxels};
use walpha::ladder::Filtration;
use walpha::progress::TARGET;
use walpha::shape::{Engine, ShapeOptions};
use walpha::{Alpha, Gray, HaarOptions, Units, Volume, WeightedPoints, alpha_shape, haar, volume};

use crate::common::alone::alone;

/// Keeps what is reported.
#[derive(Clone, Default)]
struct Listener(Arc<Mutex<Vec<Parts>>>);

#[derive(Clone, Copy, Debug, Default)]
struct Parts {
    done: u64,
    total: u64,
}

impl Visit for Parts {
    fn record_u64(&mut self, field: &Field, value: u64) {
        match field.name() {
            "done" => self.done = value,
            "total" => self.total = value,
            other => panic!("{other}"),
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn Debug) {}
}

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target() == TARGET
    }

    fn event(&self, event: &Event<'_>) {
        let mut parts = Parts::default();
        event.record(&mut parts);
        self.0.lock().unwrap().push(parts);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// Asserts that work moves forward on one scale, at least so often. For a test [`alone`]: whether anybody listens
/// to an event is found out once in a process, at times by the thread of another test, which nobody listens to.
fn assert_moves(least: usize, work: impl FnOnce()) {
    let listener = Listener::default();
    tracing::subscriber::with_default(listener.clone(), work);
    let told = listener.0.lock().unwrap();
    assert!(told.len() >= least, "{told:?}");
    assert!(told.iter().all(|parts| parts.total == told[0].total), "{told:?}");
    assert!(told.windows(2).all(|pair| pair[0].done < pair[1].done), "{told:?}");
    assert!(told.last().is_some_and(|last| last.done <= last.total), "{told:?}");
}

fn phantom() -> Volume {
    let volume = volume::sample("sample:phantom@16").unwrap();
    volume.into_gray(Gray::Automatic).unwrap().0
}

#[test]
fn the_wavelet_stage_moves() {
    alone(|| {
        assert_moves(2, || drop(haar::smooth(&phantom(), &HaarOptions::default()).unwrap()));
    });
}

/// The points of a lattice.
fn lattice(side: usize) -> WeightedPoints {
    let at = |i: usize| [i % side, i / side % side, i / side / side].map(|c| c as f64);
    let positions: Vec<_> = (0..side.pow(3)).map(at).collect();
    WeightedPoints::unweighted(positions)
}

#[test]
fn a_filtration_moves() {
    alone(|| {
        assert_moves(5, || drop(Filtration::new(lattice(5)).unwrap()));
    });
}

#[test]
fn a_shape_moves_within_its_blocks() {
    alone(|| {
        // Threads of other names would report to nobody.
        let here = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        let here = here.build().unwrap();
        let (alpha, engine) = (Alpha::from_squared(1.0).unwrap(), Engine::Native);
        for blocks in [1, 3] {
            let blocks = std::num::NonZeroUsize::new(blocks);
            let options = ShapeOptions::new(alpha).engine(engine).blocks(blocks);
            let work = || drop(alpha_shape(lattice(27), &options).unwrap());
            here.install(|| assert_moves(4 + 2 * blocks.unwrap().get(), work));
        }
    });
}

#[test]
fn adaptive_selection_moves() {
    alone(|| {
        let goal = Adaptive::new(300);
        assert_moves(4, || drop(adaptive_voxels(&phantom(), &goal, Units::Voxel).unwrap()));
    });
}
