//! Derivatives of values with respect to the points.

use walpha_regular::internals::centre_shares;

use super::rank::NONE;
use super::{Filtration, Ordered};

/// The derivative of the value of a simplex with respect to one of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// The input index of the point.
    pub vertex: u32,
    /// With respect to its position (x, y, z): a length.
    pub position: [f64; 3],
    /// With respect to its weight.
    pub weight: f64,
}

impl Ordered<'_> {
    /// For each simplex, by its number, the number of the Gabriel simplex that gives its value: itself, or a coface with which it
    /// enters. If several have the same exact value, and the value therefore has no derivative, the chosen one does not depend on
    /// threads. O(n).
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
    /// The derivatives of the squared radius of the smallest orthogonal sphere of a simplex with respect to its points, given by
    /// their input indices. This radius is its value if it is Gabriel: see [`Ordered::gabriel_simplices`].
    ///
    /// If c = Σ bᵢ pᵢ is the centre, with Σ bᵢ = 1, the squared radius is the stationary value of Σ bᵢ (|pᵢ|² − wᵢ) − |c|² in b,
    /// so its derivatives are 2 bᵢ (pᵢ − c) by pᵢ and −bᵢ by wᵢ (the envelope theorem). However flat the simplex is, each bᵢ is
    /// correct to 2⁻⁵⁰ of the largest, and each product to that times 2 |pᵢ − c|: they are computed in numbers of two doubles, or
    /// in integers if those are not precise enough. All are NaN for points that span no simplex.
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
    /// If there are no points, more than four, or an index without a point.
    pub fn derivatives(&self, vertices: &[u32]) -> Vec<Derivative> {
        match *vertices {
            [a] => self.of_simplex([a]).to_vec(),
            [a, b] => self.of_simplex([a, b]).to_vec(),
            [a, b, c] => self.of_simplex([a, b, c]).to_vec(),
            [a, b, c, d] => self.of_simplex([a, b, c, d]).to_vec(),
            _ => panic!("a simplex has one to four points, and {} were given", vertices.len()),
        }
    }

    fn of_simplex<const N: usize>(&self, simplex: [u32; N]) -> [Derivative; N] {
        let weights = simplex.map(|v| self.points().weights[v as usize]);
        let shares = centre_shares(self.whole.corners(simplex), weights);
        std::array::from_fn(|k| Derivative {
            vertex: self.whole.copied(simplex[k]).0,
            position: shares[k].moment.map(|moment| 2.0 * moment),
            weight: -shares[k].share,
        })
    }
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

    /// The squared radius is ½ + z², where the centre is at (½, ½, z), z = (h² − 9/20) / 2h; all digits are right.
    #[test]
    fn derivatives_of_flat_cells_are_precise() {
        for h in [1e-3, 1e-8, 1e-14, 1e-30, 1e-100] {
            let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.4, h]];
            // The rounding of 0.3 and 0.4 to doubles does not change the first 15 digits.
            let z = (h * h - 0.45) / (2.0 * h);
            let wanted = 2.0 * z * (0.5 + 0.225 / (h * h));
            let filtration = Filtration::new(positions).unwrap();
            let derivatives = filtration.derivatives(&[0, 1, 2, 3]);
            let found = derivatives[3].position[2];
            assert!((found / wanted - 1.0).abs() < 1e-14, "{h}: {found}, {wanted}");
            // Moving all of them changes nothing.
            let scale = derivatives.iter().map(|d| d.position[2].abs()).fold(0.0, f64::max);
            for k in 0..3 {
                let sum: f64 = derivatives.iter().map(|d| d.position[k]).sum();
                assert!(sum.abs() <= 1e-15 * scale, "{h}: {sum} along {k}");
            }
            let weights: f64 = derivatives.iter().map(|d| d.weight).sum();
            let largest = derivatives.iter().map(|d| d.weight.abs()).fold(0.0, f64::max);
            assert!((weights + 1.0).abs() <= 1e-15 * largest.max(1.0), "{h}: {weights}");
        }
    }

    /// A tilted cell of thickness 10⁻¹⁴, whose derivatives are compared with fractions of integers.
    #[test]
    fn derivatives_of_tilted_flat_cells_are_precise() {
        let positions = vec![
            [0.696209238294651, -0.5587047231316777, -0.4217454796889189],
            [-0.0012561241199390066, 0.0007780136336790403, -0.32133538697137276],
            [0.029573896091458704, -0.02380025910437344, -0.11221524207132894],
            [-0.023820160623561366, 0.01841254536045853, -0.9700123613099884],
        ];
        let wanted: [[f64; 3]; 4] = [
            [1.0797246298395281e+44, 1.3461846286808461e+44, -9.613574115534675e+40],
            [4.157504836892484e+45, 5.1835152690021734e+45, -3.701729105791749e+42],
            [-3.212968803650096e+45, -4.005881774270228e+45, 2.8607399397206424e+42],
            [-1.0525084962263412e+45, -1.3122519576000297e+45, 9.371249072264534e+41],
        ];
        let filtration = Filtration::new(positions).unwrap();
        let found = filtration.derivatives(&[0, 1, 2, 3]);
        let largest = wanted.as_flattened().iter().fold(0f64, |most, x| most.max(x.abs()));
        for (found, wanted) in found.iter().zip(&wanted) {
            for (found, wanted) in found.position.iter().zip(wanted) {
                assert!((found - wanted).abs() <= 1e-15 * largest, "{found} {wanted}");
            }
        }
    }

    /// Derivatives by positions and weights in space, in a plane and on a torus.
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
                    // For flat simplices, a step changes too much.
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
