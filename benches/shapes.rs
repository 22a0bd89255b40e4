//! Shapes on one thread and on two, medians of five in turn: `cargo bench -p walpha-benches --bench shapes`.
//!
//! `… -- 1000000 4` takes a million points and four threads.

mod sets;

use std::time::Instant;

use sets::SETS;
use walpha_base::random::Random;
use walpha_shape::{Alpha, Engine, ShapeOptions, WeightedPoints, alpha_shape};

fn main() {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let count = numbers.next().unwrap_or(1_000_000);
    let threads = numbers.next().unwrap_or(2);
    println!("{count} points; seconds on 1 thread and on {threads}, and their ratio");
    for (name, alpha, set) in SETS {
        let mut random = Random::new(1);
        let (positions, weights): (Vec<_>, Vec<_>) = set(&mut random, count).into_iter().unzip();
        let points = WeightedPoints::new(positions, weights).expect("points");
        let options = ShapeOptions::new(Alpha::from_squared(alpha).expect("a number"));
        let options = options.engine(Engine::Native);
        let pools = [1, threads].map(|threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
        });
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..5 {
            for (pool, times) in pools.iter().zip(&mut times) {
                let points = points.clone();
                let begun = Instant::now();
                let made = pool.install(|| alpha_shape(points, &options)).expect("a shape");
                times.push(begun.elapsed().as_secs_f64());
                assert!(!made.complex().facets.is_empty());
            }
        }
        let [one, all] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        });
        println!("{name:>16}  {one:.2}  {all:.2}  {:.2}", one / all);
    }
}
