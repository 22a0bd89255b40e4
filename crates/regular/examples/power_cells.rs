//! The volumes of the bounded cells of a power diagram, the dual of the regular triangulation.

use walpha_regular::{Triangulation, TriangulationError, triangulate};

fn main() -> Result<(), TriangulationError> {
    // A lattice of 5³ points, those of the middle layer with balls of squared radius 1/4.
    let points: Vec<[f64; 3]> =
        (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from)).collect();
    let weights: Vec<f64> = points.iter().map(|p| if p[2] == 2.0 { 0.25 } else { 0.0 }).collect();
    let volumes = power_cells(&triangulate(&points, Some(&weights))?, &weights);

    // The points inside the hull have bounded cells. The planes between layers are moved by 1/8.
    assert_eq!(volumes.iter().flatten().count(), 27);
    for (point, volume) in points.iter().zip(&volumes) {
        let expected = if point[2] == 2.0 { 1.25 } else { 0.875 };
        assert!(volume.is_none_or(|volume| (volume - expected).abs() < 1e-12));
    }

    // Without weights the cells are unit cubes, those of the Voronoi diagram.
    let voronoi = power_cells(&triangulate(&points, None)?, &[0.0; 125]);
    assert!(voronoi.iter().flatten().all(|volume| (volume - 1.0).abs() < 1e-12));
    println!(
        "the cell in the middle has the volume {:?}, and without weights {:?}",
        volumes[62], voronoi[62]
    );
    Ok(())
}

/// The volume of the power cell of each point; `None` where it is unbounded, and for points that have none.
///
/// A cell is divided into simplices whose corners are the weighted circumcentres of a vertex, an edge, a facet and a
/// tetrahedron, each a face of the next. They have a sign, as centres may lie outside of their faces (Mullen, Memari, de Goes
/// and Desbrun 2011, doi:10.1145/1964921.1964998).
fn power_cells(triangulation: &Triangulation, weights: &[f64]) -> Vec<Option<f64>> {
    let bounded =
        |v: u32| triangulation.star(v).into_iter().all(|cell| triangulation.is_finite(cell));
    let mut volumes: Vec<Option<f64>> = (0..triangulation.ghost())
        .map(|v| (triangulation.is_vertex(v) && bounded(v)).then_some(0.0))
        .collect();
    for (_, corners) in triangulation.finite_cells() {
        for order in orders(corners) {
            if let Some(volume) = &mut volumes[order[0] as usize] {
                *volume += signed_volume(
                    order.map(|v| (triangulation.positions()[v as usize], weights[v as usize])),
                );
            }
        }
    }
    volumes
}

/// The 24 orders of four corners.
fn orders([a, b, c, d]: [u32; 4]) -> impl Iterator<Item = [u32; 4]> {
    let first = [[a, b, c, d], [b, a, c, d], [c, a, b, d], [d, a, b, c]];
    first.into_iter().flat_map(|[p, q, r, s]| {
        [[p, q, r, s], [p, q, s, r], [p, r, q, s], [p, r, s, q], [p, s, q, r], [p, s, r, q]]
    })
}

/// The volume of the simplex of the centres of the first point, the first two, three and four; negative where the way from
/// centre to centre goes away from the next point an odd number of times.
fn signed_volume([(p, weight), rest @ ..]: [([f64; 3], f64); 4]) -> f64 {
    // The centre, seen from p, and orthogonal directions: Gram and Schmidt. A step along a direction does not change the
    // powers of the points before, and is as long as makes that of the next point equal to theirs.
    let (mut centre, mut volume) = ([0.0; 3], 1.0 / 6.0);
    let mut directions: Vec<[f64; 3]> = Vec::new();
    for (q, other) in rest {
        let way = [0, 1, 2].map(|k| q[k] - p[k]);
        let mut direction = way;
        for d in &directions {
            let share = dot(way, *d) / dot(*d, *d);
            direction = [0, 1, 2].map(|k| direction[k] - share * d[k]);
        }
        let square = dot(direction, direction);
        let step = ((dot(way, way) + weight - other) / 2.0 - dot(centre, way)) / square;
        centre = [0, 1, 2].map(|k| centre[k] + step * direction[k]);
        volume *= step * square.sqrt();
        directions.push(direction);
    }
    volume
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
