use dashu_int::IBig;
use dashu_int::ops::Gcd;

use super::WeightedPoint;
use super::binary::{Binary, Range};
use super::frame::{cross, dot};
use super::number::{Number, sign};

/// Units in which the coordinates of points and their lifted heights |p|² − ω are integers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lift {
    coordinate: i32,
    height: i32,
}

impl Lift {
    /// The coarsest units for all these points.
    pub(crate) fn through(points: impl Iterator<Item = WeightedPoint>) -> Self {
        let (mut lengths, mut squares) = (Range::EMPTY, Range::EMPTY);
        for point in points {
            lengths = point.position.iter().fold(lengths, |range, &x| range.with(Binary::new(x)));
            squares = squares.with(Binary::new(point.weight));
        }
        let coordinate = lengths.unit().unwrap_or(0);
        let height = squares.unit().unwrap_or(i32::MAX).min(2 * coordinate);
        Self { coordinate, height }
    }

    /// The hyperplane through four lifted points that span a volume, the same for any four of its
    /// points: cells with one orthogonal sphere have one hyperplane.
    ///
    /// For D = det(b−a, c−a, d−a) and n the normal with n·(b−a) = D·(h(b) − h(a)) and so on, the
    /// height at x is (n·x + o)/D. These five integers are without common factor, and D > 0.
    pub(crate) fn hyperplane(self, cell: [WeightedPoint; 4]) -> [IBig; 5] {
        let [(a, height), others @ ..] = cell.map(|point| self.lifted(&point));
        let [(u, s), (v, t), (w, r)] =
            others.map(|(p, h)| ([0, 1, 2].map(|k| &p[k] - &a[k]), h - &height));
        let det = dot(&u, &cross(&v, &w));
        let normals = [cross(&v, &w), cross(&w, &u), cross(&u, &v)];
        let [x, y, z] =
            [0, 1, 2].map(|k| &normals[0][k] * &s + &normals[1][k] * &t + &normals[2][k] * &r);
        let offset = &det * height - dot(&[x.clone(), y.clone(), z.clone()], &a);
        let plane = [x, y, z, offset, det];
        let numbers = plane.iter().filter(|number| !number.is_zero()).cloned();
        let divisor = numbers.reduce(|common, number| (&common).gcd(&number).into());
        let divisor = divisor.expect("four points that span a volume");
        let divisor = if sign(&plane[4]).is_lt() { -divisor } else { divisor };
        plane.map(|number| number / &divisor)
    }

    fn lifted(self, point: &WeightedPoint) -> ([IBig; 3], IBig) {
        let position = point.position.map(|x| Binary::new(x).big(self.coordinate));
        let finer = (2 * self.coordinate - self.height) as usize;
        let square = dot(&position, &position) << finer;
        (position, square.minus(&Binary::new(point.weight).big(self.height)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_on_one_sphere_have_one_hyperplane() {
        let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|k| 0.5 * k as f64);
        // Finer than the coordinates, coarser, and none.
        for weight in [0.1, 2.0, 0.0] {
            let site = |i: usize| WeightedPoint { position: corner(i), weight };
            let lift = Lift::through((0..8).map(site));
            let one = lift.hyperplane([0, 1, 2, 4].map(site));
            assert_eq!(one, lift.hyperplane([7, 6, 5, 3].map(site)));
            assert_eq!(one, lift.hyperplane([1, 0, 2, 4].map(site)));
            let mut far = [7, 6, 5, 3].map(site);
            far[0].position = [1.0; 3];
            assert_ne!(one, Lift::through((0..8).map(site)).hyperplane(far));
            let mut apart = [7, 6, 5, 3].map(site);
            apart[3].weight = apart[3].weight.next_up();
            let lift = Lift::through((0..8).map(site).chain(apart));
            assert_ne!(lift.hyperplane([0, 1, 2, 4].map(site)), lift.hyperplane(apart));
        }
    }
}
