//! Delaunay–Čech values: when the balls of a simplex have a point in common.

use walpha_base::parallel::prelude::*;

use super::Ordered;
use crate::ladder::build::Radius;

impl Ordered<'_> {
    /// For each simplex, by its number, its Čech value: the α from which on the balls of all its points, of squared radii α + ω,
    /// have a point in common, rounded to the nearest double. Without weights this is the squared radius of the smallest ball that
    /// encloses the simplex. It is at least that of each face and at most the value of the simplex in the filtration
    /// ([`Entry::value`](super::Entry::value)), so simplices by these values are a filtration, too, the Delaunay–Čech complexes.
    /// For points in general position it has the same persistent homology (Bauer and Edelsbrunner 2017,
    /// doi:10.1090/tran/6991). O(n).
    ///
    /// The value is the least α + ω of which some place has at most this power to all points, maxᵢ |x − pᵢ|² − ωᵢ. If the centre of
    /// the smallest orthogonal sphere has barycentric coordinates that are not negative, it is that place; otherwise the place is that
    /// of a face, whose value is then the largest among faces. A coordinate is negative exactly if its corner lies inside the sphere
    /// of the face opposite it, which is decided exactly; and rounding is monotonic, so the largest rounded value is that of the
    /// largest.
    ///
    /// ```
    /// use walpha_shape::ladder::Filtration;
    ///
    /// // The circumcentre of a flat triangle lies outside of it: its longest edge is a diameter of the smallest disc.
    /// let filtration = Filtration::new(&[[0.0; 3], [8.0, 0.0, 0.0], [4.0, 1.0, 0.0]])?;
    /// let simplices = filtration.simplices()?;
    /// assert_eq!(simplices.cech_values().last(), Some(&16.0));
    /// assert_eq!(simplices.simplex(6).value, 72.25);
    /// # Ok::<(), walpha_shape::ShapeError>(())
    /// ```
    pub fn cech_values(&self) -> Vec<f64> {
        let filtration = self.filtration();
        let (spheres, radii) = (filtration.spheres(), &filtration.radii);
        let incidence = &filtration.incidence;
        let cell_rows = filtration.whole.complex().cells.rows();
        let known =
            |radius: Radius, nearest: &dyn Fn() -> f64| radius.known().unwrap_or_else(nearest);
        let vertices: Vec<f64> = (self.vertices().par_iter().zip(&radii.vertices).coarse())
            .map(|(&vertex, &radius)| known(radius, &|| spheres.nearest_radius(vertex)))
            .collect();
        let edges: Vec<f64> = (self.edges().par_iter().zip(&radii.edges).coarse())
            .map(|(&edge, &radius)| {
                let ends = edge.map(|v| vertices[incidence.vertex_rows[v as usize] as usize]);
                let own = || known(radius, &|| spheres.nearest_radius(edge));
                value(spheres.inside_opposite(edge), ends, own)
            })
            .collect();
        let facets = (self.facets().par_iter().zip(&radii.facets)).zip(&incidence.facet_edges);
        let facets: Vec<f64> = (facets.coarse())
            .map(|((&facet, &radius), sides)| {
                let own = || known(radius, &|| spheres.nearest_radius(facet));
                value(spheres.inside_opposite(facet), sides.map(|edge| edges[edge as usize]), own)
            })
            .collect();
        let cells: Vec<f64> = (self.cell_rows.par_iter().coarse())
            .map(|&row| {
                let row = row as usize;
                let sides = incidence.cell_facets[row].map(|facet| facets[facet as usize]);
                value(spheres.inside_opposite(cell_rows[row]), sides, || radii.cells[row])
            })
            .collect();
        [vertices, edges, facets, cells].concat()
    }
}

/// That of the own sphere, unless its centre lies beyond a face, of which a corner is inside the opposite sphere; otherwise the
/// largest of the faces.
fn value<const N: usize>(inside: [bool; N], faces: [f64; N], own: impl FnOnce() -> f64) -> f64 {
    if inside.contains(&true) { faces.into_iter().fold(f64::NEG_INFINITY, f64::max) } else { own() }
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use crate::ladder::Filtration;
    use crate::{Torus, WeightedPoints};

    /// The least power that some place has to all points, found by moving along the line to the point of the largest power in
    /// shorter and shorter steps (Bădoiu and Clarkson 2003), and a bound on its error.
    fn enclosing(corners: &[[f64; 3]], weights: &[f64]) -> f64 {
        let power = |x: [f64; 3], k: usize| {
            (0..3).map(|a| (x[a] - corners[k][a]).powi(2)).sum::<f64>() - weights[k]
        };
        let farthest = |x: [f64; 3]| {
            (0..corners.len()).max_by(|&a, &b| power(x, a).total_cmp(&power(x, b))).unwrap()
        };
        let mut x = corners[0];
        for step in 1..20_000 {
            let to = corners[farthest(x)];
            x = std::array::from_fn(|a| x[a] + (to[a] - x[a]) / f64::from(step + 1));
        }
        power(x, farthest(x))
    }

    /// In space, in a plane and in a periodic box; with small and with large weights.
    #[test]
    fn cech_values_are_those_of_the_smallest_enclosing_balls() {
        let mut random = Random::new(5);
        let cube = Torus::new([1.0; 3]).unwrap();
        let (mut attached, mut compared) = (0, 0);
        for (count, torus, depth, heaviest) in [
            (40, None, 1.0, 0.0),
            (40, None, 1.0, 0.1),
            (20, None, 0.0, 0.05),
            (120, Some(cube), 1.0, 0.01),
            (2, Some(cube), 1.0, 0.01),
        ] {
            let positions: Vec<_> =
                (0..count).map(|_| [1.0, 1.0, depth].map(|side| side * random.unit())).collect();
            let weights: Vec<_> = (0..count).map(|_| heaviest * random.unit()).collect();
            let points = WeightedPoints::new(positions, weights).unwrap();
            let filtration = Filtration::on(torus, points).unwrap();
            let simplices = filtration.simplices().unwrap();
            for ((number, found), entry) in
                (0..).zip(simplices.cech_values()).zip((0..).map(|n| simplices.simplex(n)))
            {
                assert!(
                    found <= entry.value,
                    "{:?}: {found} above {}",
                    entry.vertices,
                    entry.value
                );
                attached += usize::from(found < entry.value);
                // Each step takes 20 000 of them.
                if number % 7 == 0 {
                    let corners = match *entry.vertices {
                        [a] => filtration.whole.corners([a]).to_vec(),
                        [a, b] => filtration.whole.corners([a, b]).to_vec(),
                        [a, b, c] => filtration.whole.corners([a, b, c]).to_vec(),
                        [a, b, c, d] => filtration.whole.corners([a, b, c, d]).to_vec(),
                        _ => unreachable!("a simplex has at most four vertices"),
                    };
                    let weights =
                        entry.vertices.iter().map(|&v| filtration.points().weights[v as usize]);
                    let wanted = enclosing(&corners, &weights.collect::<Vec<_>>());
                    assert!(
                        (found - wanted).abs() < 2e-3 * (1.0 + wanted),
                        "{:?}: {found}, {wanted}",
                        entry.vertices
                    );
                    compared += 1;
                }
            }
        }
        assert!(
            attached > 300 && compared > 300,
            "{attached} are smaller, {compared} were compared"
        );
    }
}
