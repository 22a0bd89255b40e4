//! The volumes of the bounded cells of a power diagram, the dual of the regular triangulation.

use walpha_regular::{PowerDiagram, TriangulationError, triangulate};

fn main() -> Result<(), TriangulationError> {
    // A lattice of 5³ points, those of the middle layer with balls of squared radius 1/4.
    let points: Vec<[f64; 3]> =
        (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from)).collect();
    let weights: Vec<f64> = points.iter().map(|p| if p[2] == 2.0 { 0.25 } else { 0.0 }).collect();
    let regular = triangulate(&points, Some(&weights))?;
    let power = PowerDiagram::of(&regular, Some(&weights))?;

    // The points inside the hull have bounded cells. The planes between layers are moved by 1/8.
    let bounded = |volume: &f64| volume.is_finite();
    assert_eq!(power.volumes().iter().filter(|volume| bounded(volume)).count(), 27);
    for (point, &volume) in points.iter().zip(power.volumes()) {
        let expected = if point[2] == 2.0 { 1.25 } else { 0.875 };
        assert!(!bounded(&volume) || (volume - expected).abs() < 1e-12);
    }

    // Without weights the cells are unit cubes, the cells of the Voronoi diagram, with six facets each.
    let voronoi = PowerDiagram::of(&triangulate(&points, None)?, None)?;
    assert!(
        voronoi
            .volumes()
            .iter()
            .filter(|volume| bounded(volume))
            .all(|volume| (volume - 1.0).abs() < 1e-12)
    );
    let facets = |diagram: &PowerDiagram| {
        diagram.facets().iter().filter(|facet| facet.contains(&62)).count()
    };
    println!(
        "the cell in the middle has the volume {} and {} facets",
        power.volumes()[62],
        facets(&power)
    );
    println!("without weights: {} and {}", voronoi.volumes()[62], facets(&voronoi));
    Ok(())
}
