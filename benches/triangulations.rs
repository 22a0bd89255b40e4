//! Whole triangulations on one thread and on two, medians of five in turn: `cargo bench -p walpha-benches --bench triangulations`.
//!
//! `… -- 1000000 4` takes a million points and four threads. `… -- POINTS`, a file as those of `race`, triangulates its points once, on one
//! thread, for programs that count instructions: nothing of CGAL is in this one, which such programs stop at its start.

use std::path::Path;
use std::time::Instant;

use walpha_base::random::Random;
use walpha_regular::triangulate;

fn main() {
    if let Some(points) = std::env::args().nth(1).filter(|points| Path::new(points).is_file()) {
        return once(&points);
    }
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse().ok());
    let count = numbers.next().unwrap_or(1_000_000);
    let threads = numbers.next().unwrap_or(2);
    println!("{count} points; seconds on 1 thread and on {threads}, and their ratio");
    for (name, set) in SETS {
        let mut random = Random::new(1);
        // Nearly cospherical points take exact arithmetic.
        let count = if name == "sphere" { count / 10 } else { count };
        let (positions, weights): (Vec<_>, Vec<_>) = (0..count).map(|_| set(&mut random)).unzip();
        let pools = [1, threads].map(|threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
        });
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..5 {
            for (pool, times) in pools.iter().zip(&mut times) {
                let begun = Instant::now();
                let made = pool
                    .install(|| triangulate(&positions, Some(&weights)))
                    .expect("a triangulation");
                times.push(begun.elapsed().as_secs_f64());
                assert!(!made.cells().is_empty());
            }
        }
        let [one, all] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        });
        println!("{name:>16}  {one:.2}  {all:.2}  {:.2}", one / all);
    }
}

fn once(points: &str) {
    let bytes = std::fs::read(points).expect("a file of points");
    let rows = bytes.as_chunks::<8>().0.as_chunks::<4>().0;
    let point = |row: &[[u8; 8]; 4]| {
        let [x, y, z, weight] = row.map(f64::from_le_bytes);
        ([x, y, z], weight)
    };
    let (positions, weights): (Vec<_>, Vec<_>) = rows.iter().map(point).unzip();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let made = pool.install(|| triangulate(&positions, Some(&weights))).expect("a triangulation");
    assert!(!made.cells().is_empty());
}

/// A weighted point.
type Point = ([f64; 3], f64);

/// Draws a point.
type Draw = fn(&mut Random) -> Point;

/// Sets of points, by a random one of each.
const SETS: [(&str, Draw); 7] = [
    ("random", |r| (unit(r), 0.0)),
    ("weighted", |r| (unit(r), 1e-4 * r.unit())),
    ("lattice", |r| (unit(r).map(|x| (x * 160.0).floor()), 0.0)),
    ("terrain", |r| {
        let [x, y, z] = unit(r);
        ([x, y, 0.05 * (9.0 * x).sin() * (7.0 * y).cos() + 0.002 * z], 0.0)
    }),
    ("noisy torus", |r| {
        let [u, v, w] = unit(r);
        let (u, v, tube) = (TURN * u, TURN * v, 0.3 + 0.003 * w);
        ([(1.0 + tube * v.cos()) * u.cos(), (1.0 + tube * v.cos()) * u.sin(), tube * v.sin()], 0.0)
    }),
    ("bumpy surface", |r| {
        let [x, y, _] = unit(r);
        ([x, y, 0.1 * (12.0 * x).sin() * (9.0 * y).cos()], 0.0)
    }),
    ("sphere", |r| {
        let [u, v, _] = unit(r);
        let (turn, z) = (TURN * u, 2.0 * v - 1.0);
        let radius = (1.0 - z * z).sqrt();
        ([radius * turn.cos(), radius * turn.sin(), z], 0.0)
    }),
];

const TURN: f64 = std::f64::consts::TAU;

fn unit(random: &mut Random) -> [f64; 3] {
    [random.unit(), random.unit(), random.unit()]
}
