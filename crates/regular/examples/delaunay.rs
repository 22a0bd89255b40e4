//! Computes the Delaunay triangulation of points, and locates points in it.

use walpha_regular::{Location, TriangulationError, triangulate};

fn main() -> Result<(), TriangulationError> {
    let points: Vec<[f64; 3]> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from)).collect();
    let lattice = triangulate(&points, None)?;
    for (cell, corners) in lattice.finite_cells().take(3) {
        println!("cell {cell} has the corners {corners:?}");
    }
    println!("{} facets of the hull", lattice.hull_facets().count());
    assert!(matches!(lattice.locate([0.5; 3]), Some(Location::OnEdge { .. })));
    Ok(())
}
