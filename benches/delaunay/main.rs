//! The Delaunay triangulation of random points by the crate `delaunay` and by walpha on one thread: milliseconds, medians of five, and numbers
//! of cells, which must agree.
//!
//! ```text
//! cargo run --release --manifest-path benches/delaunay/Cargo.toml --target-dir target -- 100 1000
//! ```
//!
//! Ten thousand points take it minutes.

use std::time::Instant;

use delaunay::prelude::construction::{DelaunayTriangulationBuilder, TopologyGuarantee, vertex};
use delaunay::prelude::geometry::FastKernel;
use walpha_base::random::Random;
use walpha_regular::triangulate;

fn main() {
    let counts: Vec<usize> = std::env::args()
        .skip(1)
        .map(|count| count.parse().expect("numbers of points"))
        .collect();
    println!("points\tdelaunay\twalpha\tcells");
    for &count in if counts.is_empty() { &[100, 1000][..] } else { &counts } {
        let mut random = Random::new(1);
        let points: Vec<[f64; 3]> =
            (0..count).map(|_| [random.unit(), random.unit(), random.unit()]).collect();
        let vertices: Vec<_> = points.iter().map(|&point| vertex!(point)).collect();
        // The kernel and the guarantee with which it is quickest.
        let theirs = median(|| {
            DelaunayTriangulationBuilder::new(&vertices)
                .topology_guarantee(TopologyGuarantee::Pseudomanifold)
                .build_with_kernel::<_, ()>(&FastKernel::new())
                .expect("a triangulation")
                .number_of_simplices()
        });
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let ours = pool.install(|| {
            median(|| triangulate(&points, None).expect("a triangulation").finite_cells().count())
        });
        assert_eq!(theirs.1, ours.1, "numbers of cells");
        println!("{count}\t{:.2}\t{:.2}\t{}", theirs.0, ours.0, ours.1);
    }
}

/// Milliseconds of some work, and its result.
fn median(work: impl Fn() -> usize) -> (f64, usize) {
    let runs = [(); 5].map(|()| {
        let begun = Instant::now();
        let cells = work();
        (1000.0 * begun.elapsed().as_secs_f64(), cells)
    });
    let mut times = runs.map(|(time, _)| time);
    times.sort_by(f64::total_cmp);
    (times[2], runs[0].1)
}
