//! Our engine in a separate process.

use std::time::Instant;

use walpha::balls::BallUnion;
use walpha::ladder::Filtration;
use walpha::shape::{Engine, ShapeOptions};
use walpha::triangulation::triangulate;
use walpha::{Alpha, AlphaShape, Simplices, WeightedPoints, alpha_shape};

use super::Result;

/// Runs `[what, points, alpha, threads]`, and prints seconds, peak KiB and counts as plain CGAL does.
pub(super) fn run(arguments: &[String]) -> Result<()> {
    let [what, points, alpha, threads] = arguments else {
        return Err("run WHAT POINTS ALPHA THREADS".into());
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).build_global()?;
    let bytes = std::fs::read(points)?;
    let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
    let rows = bytes.as_chunks::<8>().0.as_chunks::<4>().0;
    let positions = rows.iter().map(|[x, y, z, _]| [x, y, z].map(number)).collect();
    let weights = rows.iter().map(|[.., w]| number(w)).collect();
    let points = WeightedPoints::new(positions, weights)?;
    drop(bytes);
    let alpha = Alpha::from_squared(alpha.parse()?)?;
    let shape = ShapeOptions::new(alpha).engine(Engine::Native);
    let started = Instant::now();
    let counts = match what.as_str() {
        "native" => measured(&alpha_shape(points, &shape)?),
        "whole" => measured(&alpha_shape(points, &shape.exterior(true))?),
        "balls" => {
            let shape = alpha_shape(points, &shape)?;
            let union = BallUnion::new(&shape)?;
            assert!(union.volume().is_within(1e-9) && union.area().is_within(1e-9));
            String::new()
        }
        "filtration" => counts(Filtration::new(points)?.whole()),
        "order" => {
            let filtration = Filtration::new(points)?;
            let ordered = filtration.simplices()?;
            assert!(!ordered.is_empty());
            counts(filtration.whole())
        }
        "triangulation" => {
            let made = triangulate(points.positions(), Some(points.weights()))?;
            assert!(!made.cells().is_empty());
            String::new()
        }
        other => return Err(format!("{other} cannot be run").into()),
    };
    println!("{} {} {counts}", started.elapsed().as_secs_f64(), peak());
    Ok(())
}

/// The counts of a shape whose sizes are known, too.
fn measured(shape: &AlphaShape) -> String {
    let sizes = shape.measures();
    assert!(sizes.volume > 0.0 || sizes.singular_area > 0.0);
    counts(shape)
}

fn counts(shape: &AlphaShape) -> String {
    assert!(shape.betti().is_some());
    let complex = shape.complex();
    let [facets, edges, vertices] =
        [by_class(&complex.facets), by_class(&complex.edges), by_class(&complex.vertices)];
    let cells = complex.cells.counts().interior;
    format!("{cells} {facets} {edges} {vertices}")
}

fn by_class<const N: usize>(simplices: &Simplices<N>) -> String {
    let counts = simplices.counts();
    format!("{} {} {}", counts.interior, counts.regular, counts.singular)
}

/// The most memory this process ever held, in KiB; 0 where the system does not say.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse().ok()).unwrap_or(0)
}
