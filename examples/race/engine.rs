//! What a process of its own does.

use std::time::Instant;

use walpha::ladder::Filtration;
use walpha::shape::{Engine, ShapeOptions};
use walpha::triangulation::{Sites, triangulate};
use walpha::{Alpha, AlphaShape, Simplices, WeightedPoints, alpha_shape};

use super::Result;

/// One engine on points from a file: prints what plain CGAL prints.
pub(super) fn run(
    what: &str,
    points: &str,
    alpha: &str,
    threads: usize,
    memory: Option<u64>,
) -> Result<()> {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let bytes = std::fs::read(points)?;
    let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
    let rows = bytes.as_chunks::<8>().0.as_chunks::<4>().0;
    let positions = rows.iter().map(|[x, y, z, _]| [x, y, z].map(number)).collect();
    let weights = rows.iter().map(|[.., w]| number(w)).collect();
    let points = WeightedPoints::new(positions, weights)?;
    drop(bytes);
    let alpha = Alpha::from_squared(alpha.parse()?)?;
    let shape = |engine| ShapeOptions::new(alpha).engine(engine).memory(memory);
    let started = Instant::now();
    let counts = match what {
        "cgal" => counts(&alpha_shape(points, &shape(Engine::Cgal))?),
        "native" => counts(&alpha_shape(points, &shape(Engine::Native))?),
        "whole" => {
            let options = shape(Engine::Native).exterior(true);
            counts(&alpha_shape(points, &options)?)
        }
        "filtration" => counts(Filtration::new(points)?.whole()),
        "order" => {
            let filtration = Filtration::new(points)?;
            let ordered = filtration.simplices()?;
            assert!(!ordered.is_empty());
            counts(filtration.whole())
        }
        _ => {
            let sites = Sites::new(&points.positions, &points.weights)?;
            assert!(!triangulate(&sites)?.cells().is_empty());
            "0 0 0 0 0 0 0 0 0 0".to_owned()
        }
    };
    println!("{} {} {counts}", started.elapsed().as_secs_f64(), peak());
    Ok(())
}

fn counts(shape: &AlphaShape) -> String {
    assert!(shape.betti().is_some());
    let complex = shape.complex();
    let [facets, edges, vertices] =
        [by_class(&complex.facets), by_class(&complex.edges), by_class(&complex.vertices)];
    format!("{} {facets} {edges} {vertices}", complex.cells.len())
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
