//! Filtrations, their order and pairs on one thread and on two, medians of five in turn:
//! `cargo bench -p walpha-benches --bench filtrations`.
//!
//! `… -- 1000000 4` takes a million points and four threads.

mod sets;

use std::hint::black_box;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use sets::SETS;
use walpha_base::random::Random;
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, Engine, ShapeOptions, WeightedPoints, alpha_shape};

/// The timed stages: the shape of the whole triangulation alone, all of [`Filtration::new`], which begins with it, the order of
/// its simplices, their pairs of dimensions 0 and 2, and those of dimension 1.
const STAGES: [&str; 5] = ["whole shape", "filtration", "order", "pairs", "loops"];

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let count = numbers.next().unwrap_or(300_000);
    let threads = numbers.next().unwrap_or(2);
    println!("{count} points; seconds on 1 thread and on {threads}, and their ratio");
    let pools = [1, threads]
        .map(|threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads"));
    for (name, _, set) in SETS {
        let (positions, weights) = set(&mut Random::new(1), count).into_iter().unzip();
        let points = WeightedPoints::new(positions, weights).expect("points");
        let mut runs = [Vec::new(), Vec::new()];
        for _ in 0..5 {
            for (pool, runs) in pools.iter().zip(&mut runs) {
                runs.push(stages(pool, &points));
            }
        }
        for (stage, title) in STAGES.into_iter().enumerate() {
            let [one, all] = [0, 1].map(|pool: usize| {
                let mut times: Vec<f64> = runs[pool].iter().map(|run| run[stage]).collect();
                times.sort_by(f64::total_cmp);
                times[times.len() / 2]
            });
            println!("{name:>8} {title:>12}  {one:.2}  {all:.2}  {:.2}", one / all);
        }
    }
}

/// The seconds of each stage.
fn stages(pool: &ThreadPool, points: &WeightedPoints) -> [f64; 5] {
    pool.install(|| {
        let options = ShapeOptions::new(Alpha::INFINITE).engine(Engine::Native).exterior(true);
        let (_, whole) = timed(|| alpha_shape(points.clone(), &options).expect("a shape"));
        let (filtration, all) = timed(|| Filtration::new(points.clone()).expect("a filtration"));
        let (order, sorted) = timed(|| filtration.simplices().expect("an order"));
        let (_, paired) = timed(|| black_box(order.pairs().voids.len()));
        let (_, looped) = timed(|| black_box(order.loops().expect("loops").pairs.len()));
        [whole, all, sorted, paired, looped]
    })
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let done = work();
    (done, begun.elapsed().as_secs_f64())
}
