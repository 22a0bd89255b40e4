//! Volumes, planes and hyperplanes as integers, in units common to all points.

use std::cmp::Ordering;
use std::ops::Add;

use dashu_int::IBig;
use dashu_int::ops::Gcd;
use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};

use super::frame::{WeightedPoint, cross, dot};
use super::number::{Binary, Bits, Number, Range, sign};
use super::wide::Wide;

/// The integer grid that holds a set of positions: coordinates in units of a power of two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    exponent: i32,
    bits: u32,
}

/// Number of tetrahedra that are summed together, few enough for their sum to have at most twelve bits more than each of them.
const CHUNK: usize = 1 << 12;

impl Lattice {
    /// The coarsest lattice through all positions, which are finite.
    pub(crate) fn through(positions: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let coordinates = positions.into_iter().flatten();
        let range = coordinates.fold(Range::EMPTY, |range, x| range.with(Binary::new(x)));
        let exponent = range.unit().unwrap_or(0);
        Self { exponent, bits: range.bits(exponent) }
    }

    /// The lattice's unit of length is two to this power.
    pub(crate) fn exponent(self) -> i32 {
        self.exponent
    }

    /// The exact sum of det(b−a, c−a, d−a) over tetrahedra, in cubed lattice units: six times
    /// their volume. Cost linear, in parallel.
    ///
    /// # Errors
    /// The work was cancelled.
    pub(crate) fn six_volumes<F>(
        self,
        count: usize,
        monitor: &Monitor,
        tetrahedron: F,
    ) -> Result<IBig, Cancelled>
    where
        F: Fn(usize) -> [[f64; 3]; 4] + Sync,
    {
        // A difference has one digit more than a coordinate, a 3×3 determinant three more still.
        let bits = 3 * (self.bits + 1) + 3 + CHUNK.ilog2();
        let chunks = (0..count).into_par_iter().step_by(CHUNK);
        let range = |start: usize| start..(start + CHUNK).min(count);
        let units = monitor.units(count as u64);
        let sums = chunks.map(|start| {
            units.add(range(start).len() as u64)?;
            Ok(if bits <= Bits::I128 {
                let det = |i| det4(tetrahedron(i).map(|p| self.small(p)));
                IBig::from(range(start).map(det).sum::<i128>())
            } else if bits <= Wide::BITS {
                let wide = |p| self.small(p).map(Wide::from);
                let det = |i| det4(tetrahedron(i).map(wide));
                range(start).map(det).fold(Wide::ZERO, |sum, det| sum.plus(&det)).value()
            } else {
                let det = |i| det4(tetrahedron(i).map(|p| self.big(p)));
                range(start).map(det).fold(IBig::ZERO, Add::add)
            })
        });
        sums.try_reduce(|| IBig::ZERO, |a, b| Ok(a + b))
    }

    /// The plane through three points that are not on one line, which does not depend on the choice of points: normal and offset
    /// without common factor, where the first number that is not zero is positive.
    pub(crate) fn plane(self, triangle: [[f64; 3]; 3]) -> [IBig; 4] {
        let [a, b, c] = triangle.map(|p| self.big(p));
        let [x, y, z] = cross(&minus(&b, &a), &minus(&c, &a));
        let offset = dot(&[x.clone(), y.clone(), z.clone()], &a);
        let plane = [x, y, z, offset];
        let numbers = || plane.iter().filter(|number| !number.is_zero());
        let divisor = numbers().cloned().reduce(|common, number| (&common).gcd(&number).into());
        let (Some(divisor), Some(first)) = (divisor, numbers().next()) else { return plane };
        let same_sign = sign(first) == sign(&divisor);
        let divisor = if same_sign { divisor } else { -divisor };
        plane.map(|number| number / &divisor)
    }

    fn small(self, p: [f64; 3]) -> [i128; 3] {
        p.map(|x| Binary::new(x).small(self.exponent))
    }

    fn big(self, p: [f64; 3]) -> [IBig; 3] {
        p.map(|x| Binary::new(x).big(self.exponent))
    }
}

/// Compares the part along vector `k` of a way with `halves` halves, where some of three vectors are 0: the way is the sum of the others, each
/// times its part, and of a way that is perpendicular to all of them.
pub(crate) fn compare_part(
    vectors: [[f64; 3]; 3],
    k: usize,
    way: [f64; 3],
    halves: i32,
) -> Ordering {
    let lattice = Lattice::through(vectors.into_iter().chain([way]));
    let is_other = |other: &usize| vectors[*other] != [0.0; 3];
    let others: Vec<usize> = [(k + 1) % 3, (k + 2) % 3].into_iter().filter(is_other).collect();
    let way = lattice.big(way);
    let vectors = vectors.map(|vector| lattice.big(vector));
    // Perpendicular to the others, and in the span of all.
    let normal = match others[..] {
        [] => vectors[k].clone(),
        [u] => cross(&vectors[u], &cross(&vectors[k], &vectors[u])),
        _ => cross(&vectors[others[0]], &vectors[others[1]]),
    };
    let unit = dot(&vectors[k], &normal);
    let beyond = (dot(&way, &normal) << 1) - &unit * IBig::from(halves);
    if sign(&unit).is_lt() { sign(&beyond).reverse() } else { sign(&beyond) }
}

fn det4<T: Number>([a, b, c, d]: [[T; 3]; 4]) -> T {
    dot(&cross(&minus(&b, &a), &minus(&c, &a)), &minus(&d, &a))
}

fn minus<T: Number>(u: &[T; 3], v: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|k| u[k].minus(&v[k]))
}

/// The centroid of a tetrahedron, as the centre of a closed surface around it.
pub(crate) struct Star {
    lattice: Lattice,
    /// Twelve times the centroid: an integer, and so is twelve times a triangle's.
    center: [IBig; 3],
}

impl Star {
    /// The centroid of a positively oriented cell.
    pub(crate) fn new(lattice: Lattice, cell: [[f64; 3]; 4]) -> Self {
        let [a, b, c, d] = cell.map(|p| lattice.big(p));
        let center = std::array::from_fn(|k| (&a[k] + &b[k] + &c[k] + &d[k]) * 3);
        Self { lattice, center }
    }

    /// Whether the centre is strictly on the inner side of a triangle that turns
    /// counter-clockwise seen from outside.
    pub(crate) fn inside(&self, triangle: [[f64; 3]; 3]) -> bool {
        let [a, b, c] = triangle.map(|p| self.spoke(p));
        det3(&a, &b, &c).is_gt()
    }

    /// Whether the ray from the centre through the centroid of `target` meets `triangle`, borders
    /// included; the centre must be [inside](Self::inside) both.
    pub(crate) fn ray_meets(&self, target: [[f64; 3]; 3], triangle: [[f64; 3]; 3]) -> bool {
        let [a, b, c] = target.map(|p| self.spoke(p));
        let ray = std::array::from_fn(|k| &a[k] + &b[k] + &c[k]);
        let [a, b, c] = triangle.map(|p| self.spoke(p));
        [(&a, &b), (&b, &c), (&c, &a)].iter().all(|(u, v)| det3(&ray, u, v).is_ge())
    }

    /// The vector from the centre to a point, multiplied by twelve.
    fn spoke(&self, p: [f64; 3]) -> [IBig; 3] {
        let p = self.lattice.big(p);
        std::array::from_fn(|k| &p[k] * 12 - &self.center[k])
    }
}

fn det3(u: &[IBig; 3], v: &[IBig; 3], w: &[IBig; 3]) -> Ordering {
    sign(&dot(&cross(u, v), w))
}

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

    /// The hyperplane through four lifted points that span a volume. It does not depend on the choice of four points: cells with
    /// the same orthogonal sphere have the same hyperplane.
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

    /// The largest tetrahedra of a lattice, so many that their sum exceeds an `i128`, and 256 bits.
    #[test]
    fn volumes_do_not_overflow() {
        let noop = Monitor::noop();
        for bits in (34..42).chain(76..84) {
            let m = f64::from(2).powi(bits) - if bits < 53 { 1.0 } else { 0.0 };
            let cell = [[m, m, m], [m, -m, -m], [-m, -m, m], [-m, m, -m]];
            let lattice = Lattice::through(cell.into_iter().chain([[1.0; 3]]));
            let one = lattice.six_volumes(1, &noop, |_| cell).unwrap();
            let side = IBig::from(2 * m as i128);
            assert_eq!(one, IBig::from(2) * &side * &side * &side);
            for count in [CHUNK, if bits == 36 { 64 * CHUNK + 5 } else { CHUNK + 5 }] {
                let sum = lattice.six_volumes(count, &noop, |_| cell).unwrap();
                assert_eq!(sum, &one * count, "{bits} {count}");
            }
        }
    }

    #[test]
    fn triangles_of_a_plane_have_one_plane() {
        let at = |x: i32, y: i32| [x, y, 3 - 2 * x + y].map(|k| 0.5 * f64::from(k));
        let positions = [at(0, 0), at(1, 0), at(0, 1), at(4, -6), at(-3, 8), at(2, 2)];
        let lattice = Lattice::through(positions);
        assert_eq!(lattice.exponent(), -1);
        let one = lattice.plane([positions[0], positions[1], positions[2]]);
        assert_eq!(one, lattice.plane([positions[2], positions[1], positions[0]]));
        assert_eq!(one, lattice.plane([positions[3], positions[4], positions[5]]));
        assert_eq!(one, lattice.plane([positions[5], positions[0], positions[3]]));
        let above = positions.map(|[x, y, z]| [x, y, z + 0.5]);
        assert_ne!(one, lattice.plane([above[3], above[4], above[5]]));
    }

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
