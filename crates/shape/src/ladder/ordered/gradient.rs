//! How values change with the points.

use super::rank::NONE;
use super::{Filtration, Ordered};

/// How the value of a simplex changes with one of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// The input index of the point.
    pub vertex: u32,
    /// By its position (x, y, z): a length.
    pub position: [f64; 3],
    /// By its weight.
    pub weight: f64,
}

impl Ordered<'_> {
    /// For each simplex, by its number, the number of the Gabriel simplex that gives its value: itself, or a coface with
    /// which it enters. Of several with the same exact value, where the value has no derivative, it is one whose number does
    /// not depend on threads. O(n).
    pub fn gabriel_simplices(&self) -> Vec<u32> {
        let incidence = &self.filtration().incidence;
        let [_, edges, facets, cells] = self.numbers.first;
        let mut found: Vec<u32> = (0..self.len() as u32)
            .map(|number| if self.is_gabriel(number) { number } else { NONE })
            .collect();
        let mut inherit = |face: u32, coface: u32| {
            if found[face as usize] == NONE && self.rank(face) == self.rank(coface) {
                found[face as usize] = found[coface as usize];
            }
        };
        for (cell, &row) in (cells..).zip(&self.cell_rows) {
            for facet in incidence.cell_facets[row as usize] {
                inherit(facets + facet, cell);
            }
        }
        for (facet, sides) in (facets..).zip(&incidence.facet_edges) {
            sides.iter().for_each(|edge| inherit(edges + edge, facet));
        }
        for (edge, ends) in (edges..).zip(self.edges()) {
            ends.iter().for_each(|&v| inherit(incidence.vertex_rows[v as usize], edge));
        }
        found
    }
}

impl Filtration {
    /// How the squared radius of the smallest orthogonal sphere of a simplex changes with its points, given by their input indices.
    /// That is its value, if it is Gabriel: see [`Ordered::gabriel_simplices`].
    ///
    /// Where c = Σ bᵢ pᵢ is the centre, with Σ bᵢ = 1, the squared radius is the stationary value of Σ bᵢ (|pᵢ|² − wᵢ) − |c|² in b,
    /// so that its derivatives are 2 bᵢ (pᵢ − c) by pᵢ and −bᵢ by wᵢ (the envelope theorem). In doubles, by a QR decomposition of the
    /// sides: the flatter the simplex, the fewer digits are right.
    ///
    /// ```
    /// use walpha_shape::WeightedPoints;
    /// use walpha_shape::ladder::Filtration;
    ///
    /// // Half the distance, squared, grows by half the distance when one end moves away.
    /// let points = WeightedPoints::unweighted(vec![[0.0; 3], [4.0, 0.0, 0.0]]);
    /// let filtration = Filtration::new(points)?;
    /// let [_, end] = filtration.derivatives(&[0, 1])[..] else { panic!("there are two ends") };
    /// assert_eq!((end.vertex, end.position, end.weight), (1, [2.0, 0.0, 0.0], -0.5));
    /// # Ok::<(), walpha_shape::ShapeError>(())
    /// ```
    ///
    /// # Panics
    /// If there are no points, more than four, or an index of none.
    pub fn derivatives(&self, vertices: &[u32]) -> Vec<Derivative> {
        let (positions, weights) = (self.points().positions(), self.points().weights());
        let first = vertices[0] as usize;
        let sides: Vec<[f64; 3]> = vertices[1..]
            .iter()
            .map(|&v| {
                let [from, to] = [first, v as usize].map(|v| positions[v]);
                let copy = self.torus().map_or(to, |torus| {
                    let winding = torus.windings(from, to);
                    [0, 1, 2].map(|k| to[k] + f64::from(winding[k]) * torus.sides()[k])
                });
                [0, 1, 2].map(|k| copy[k] - from[k])
            })
            .collect();
        let powers = sides
            .iter()
            .zip(&vertices[1..])
            .map(|(side, &v)| 0.5 * (dot(*side, *side) - weights[v as usize] + weights[first]));
        let (centre, shares) = orthogonal_centre(&sides, &powers.collect::<Vec<_>>());
        let own = 1.0 - shares.iter().sum::<f64>();
        let corners = std::iter::once(([0.0; 3], own)).chain(sides.into_iter().zip(shares));
        let derivative = |(&vertex, (corner, share)): (&u32, ([f64; 3], f64))| Derivative {
            vertex,
            position: [0, 1, 2].map(|k| 2.0 * share * (corner[k] - centre[k])),
            weight: -share,
        };
        vertices.iter().zip(corners).map(derivative).collect()
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The point x in the span of independent sides whose product with each is a number given, and its coordinates in them.
fn orthogonal_centre(sides: &[[f64; 3]], products: &[f64]) -> ([f64; 3], Vec<f64>) {
    let n = sides.len();
    // Sides are Σ r q, of orthonormal q: r is an upper triangle.
    let (mut q, mut r) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    for (j, side) in sides.iter().enumerate() {
        let mut rest = *side;
        for i in 0..j {
            r[i][j] = dot(q[i], rest);
            (0..3).for_each(|k| rest[k] -= r[i][j] * q[i][k]);
        }
        r[j][j] = dot(rest, rest).sqrt();
        q[j] = rest.map(|x| x / r[j][j]);
    }
    let mut y = [0.0; 3];
    for j in 0..n {
        y[j] = (products[j] - (0..j).map(|i| r[i][j] * y[i]).sum::<f64>()) / r[j][j];
    }
    let mut shares = vec![0.0; n];
    for i in (0..n).rev() {
        shares[i] = (y[i] - (i + 1..n).map(|j| r[i][j] * shares[j]).sum::<f64>()) / r[i][i];
    }
    ([0, 1, 2].map(|k| (0..n).map(|i| y[i] * q[i][k]).sum()), shares)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use walpha_base::random::Random;

    use crate::ladder::Filtration;
    use crate::{Torus, WeightedPoints};

    /// The values of all simplices.
    fn values(filtration: &Filtration) -> BTreeMap<Vec<u32>, f64> {
        let simplices = filtration.simplices().unwrap();
        simplices.iter().map(|entry| (entry.vertices.to_vec(), entry.value)).collect()
    }

    /// In space, in a plane and on a torus, by positions and weights.
    #[test]
    fn derivatives_are_limits_of_differences() {
        const STEP: f64 = 1e-6;
        let mut random = Random::new(11);
        let torus = Torus::new([1.0; 3]).unwrap();
        for (count, torus, depth) in [(14, None, 1.0), (14, None, 0.0), (250, Some(torus), 1.0)] {
            let place = |random: &mut Random| [1.0, 1.0, depth].map(|side| side * random.unit());
            let positions: Vec<_> = (0..count).map(|_| place(&mut random)).collect();
            let weights: Vec<_> = (0..count).map(|_| 0.02 * random.unit()).collect();
            let at = |v: usize, axis: usize, step: f64| {
                let (mut positions, mut weights) = (positions.clone(), weights.clone());
                match axis {
                    3 => weights[v] += step,
                    _ => positions[v][axis] += step,
                }
                Filtration::on(torus, WeightedPoints::new(positions, weights).unwrap()).unwrap()
            };
            let filtration = at(0, 3, 0.0);
            let simplices = filtration.simplices().unwrap();
            let gabriel = simplices.gabriel_simplices();
            assert!((0..).zip(&gabriel).any(|(number, &own)| number != own), "some are attached");
            let mut compared = 0;
            for (v, axis) in (0..6).flat_map(|v| [0, 1, 2, 3].map(|axis| (v, axis))) {
                if depth == 0.0 && axis == 2 {
                    continue;
                }
                let [low, high] = [-STEP, STEP].map(|step| values(&at(v, axis, step)));
                for (number, &own) in (0..).zip(&gabriel) {
                    let entry = simplices.simplex(number);
                    assert_eq!(entry.rank, simplices.simplex(own).rank);
                    assert!(simplices.simplex(own).gabriel);
                    // Of flat simplices a step changes too much.
                    let vertices = entry.vertices;
                    let (Some(low), Some(high)) = (low.get(vertices), high.get(vertices)) else {
                        continue;
                    };
                    if entry.value > 10.0 {
                        continue;
                    }
                    let wanted = (high - low) / (2.0 * STEP);
                    let derivatives = filtration.derivatives(simplices.simplex(own).vertices);
                    let of = derivatives.iter().filter(|d| d.vertex as usize == v);
                    let given: f64 =
                        of.map(|d| if axis == 3 { d.weight } else { d.position[axis] }).sum();
                    assert!(
                        (given - wanted).abs() <= 1e-4 * (1.0 + wanted.abs()),
                        "{vertices:?} by {axis} of {v}: {given}, {wanted}"
                    );
                    compared += usize::from(wanted != 0.0);
                }
            }
            assert!(compared > 100, "{compared} of {} simplices", gabriel.len());
        }
    }
}
