//! Weights of one's own: `cargo run --release --example own_weights`.
//!
//! Weights ω are squared lengths, one for each point: at α a point is a ball of squared radius α + ω.
//! Here points on a sphere get heavier towards its top, so that the shape closes there first.

use walpha::points::{Points, Weighting, weigh};
use walpha::shape::{Alpha, ShapeOptions, alpha_shape};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    const COUNT: usize = 2000;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let on_sphere = |i: usize| {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / COUNT as f64;
        let (radius, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
        [radius * turn.cos(), radius * turn.sin(), z]
    };
    let positions: Vec<[f64; 3]> = (0..COUNT).map(on_sphere).collect();
    // Neighbours are about 0.08 apart; a weight of 0.001 adds what a radius of 0.03 has.
    let weights: Vec<_> = positions.iter().map(|[_, _, z]| 0.001 * (z + 1.0)).collect();
    let points = Points::new(positions).with_weights(weights)?;

    println!("        α  triangles  tunnels  voids");
    for alpha in [0.0, 0.0005, 0.001, 0.002, 0.004] {
        let alpha = Alpha::from_squared(alpha)?;
        // `Column` takes the weights that the points brought along.
        let weighted = weigh(points.clone(), Weighting::Column, alpha)?;
        let shape = alpha_shape(weighted, &ShapeOptions::new(alpha))?;
        let facets = shape.complex().facets.len();
        let betti = shape.betti().ok_or("this engine does not count")?;
        println!("{:>9} {facets:>10} {:>8} {:>6}", alpha.squared(), betti.b1, betti.b2);
    }
    Ok(())
}
