//! The smallest empty spheres through given points.

use walpha_base::sort::sort_handful_by;

use super::emptiness::Emptiness;
use super::finding::Simplex;
use super::structure::Points;
use crate::Alpha;
use crate::exact::{Exact, Side, collinear, orientation, radius, radius_value, side};

/// One to four affinely independent points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Corners {
    row: [u32; 4],
    count: usize,
}

/// Evaluates an expression with the corners as an array, for any number of corners.
macro_rules! of_row {
    ($corners:expr, $row:ident => $value:expr) => {
        match *$corners.numbers() {
            [a] => {
                let $row = [a];
                $value
            }
            [a, b] => {
                let $row = [a, b];
                $value
            }
            [a, b, c] => {
                let $row = [a, b, c];
                $value
            }
            _ => {
                let $row = $corners.row;
                $value
            }
        }
    };
}

impl<const N: usize> From<[u32; N]> for Corners {
    fn from(numbers: [u32; N]) -> Self {
        let mut row = [0; 4];
        row[..N].copy_from_slice(&numbers);
        Self { row, count: N }
    }
}

impl Corners {
    pub(super) fn numbers(&self) -> &[u32] {
        &self.row[..self.count]
    }

    /// The simplex of the corners, with its vertices in ascending order.
    pub(super) fn simplex(&self) -> Simplex {
        let mut sorted = *self;
        sort_handful_by(&mut sorted.row[..self.count], Ord::cmp);
        of_row!(sorted, row => row.into())
    }

    /// The squared radius of their sphere.
    pub(super) fn radius_squared(&self, points: Points) -> Exact {
        of_row!(self, row => radius_value(points.corners(row).each_ref()))
    }
}

/// Looks for empty spheres of squared radius at most α.
#[derive(Clone, Copy)]
pub(super) struct Spheres<'a> {
    pub points: Points<'a>,
    pub alpha: Alpha,
    pub emptiness: &'a Emptiness<'a>,
}

impl Spheres<'_> {
    /// The smallest of all spheres that are orthogonal to some corners, are empty, and have a squared radius of at most α. It is
    /// the sphere of the returned corners, of which the given ones are the first. `near` are points that may be inside, which are
    /// tested first; other points inside are added to them.
    ///
    /// The centres of spheres that are orthogonal to the corners and do not contain a certain point form a half-space of the
    /// places of equal power from all corners. So the smallest sphere is the solution of a convex quadratic program in at most
    /// three dimensions: points inside are considered one after another, and each is on the smallest sphere that does not contain
    /// it.
    pub(super) fn smallest_empty(&self, corners: Corners, near: &mut Vec<u32>) -> Option<Corners> {
        let mut best = self.smallest(corners, near)?;
        while let Some(point) = of_row!(best, row => self.emptiness.refuter(row)) {
            let with = self.with(corners, point).and_then(|with| self.smallest(with, near));
            near.insert(0, point);
            best = with?;
        }
        Some(best)
    }

    /// All points on the sphere of some corners, ascending. The sphere must be empty and its squared radius at most α.
    pub(super) fn on(&self, corners: Corners) -> Vec<u32> {
        of_row!(corners, row => self.emptiness.on_sphere(row))
    }

    /// The smallest sphere with none of `others` inside, ignoring further points.
    ///
    /// The method is that of R. Seidel, "Small-dimensional linear programming and convex hulls made easy", Discrete Comput. Geom.
    /// 6, 1991, doi:10.1007/BF02574699. A point that is inside the smallest sphere for the points before it is on the smallest
    /// sphere that includes it. It is moved to the front, because it may also be inside others.
    fn smallest(&self, corners: Corners, others: &mut [u32]) -> Option<Corners> {
        if !self.fits(corners) {
            return None;
        }
        let mut best = corners;
        for i in 0..others.len() {
            let point = others[i];
            if !best.numbers().contains(&point) && self.is_inside(best, point) {
                let with = self.with(corners, point);
                let with = with.and_then(|with| self.smallest(with, &mut others[..i]));
                others[..=i].rotate_right(1);
                best = with?;
            }
        }
        Some(best)
    }

    /// Whether the squared radius of the sphere of some corners is at most α.
    pub(super) fn fits(&self, corners: Corners) -> bool {
        of_row!(corners, row => radius(self.points.corners(row).each_ref(), self.alpha)).is_le()
    }

    /// Four points, if they span a volume.
    pub(super) fn independent(&self, [a, b, c, d]: [u32; 4]) -> Option<Corners> {
        self.with([a, b, c].into(), d)
    }

    fn is_inside(&self, corners: Corners, point: u32) -> bool {
        let q = self.points.get(point);
        of_row!(corners, row => side(self.points.corners(row).each_ref(), &q)) == Side::Inside
    }

    /// The corners and a point inside their smallest sphere. `None` if the point depends on the corners: then it is inside each
    /// sphere orthogonal to them.
    fn with(&self, corners: Corners, point: u32) -> Option<Corners> {
        let Corners { mut row, count } = corners;
        *row.get_mut(count)? = point;
        let is_independent = match row.map(|v| self.points.position(v)) {
            [a, b, ..] if count == 1 => a != b,
            [a, b, c, _] if count == 2 => !collinear(a, b, c),
            [a, b, c, d] => orientation(a, b, c, d).is_ne(),
        };
        is_independent.then_some(Corners { row, count: count + 1 })
    }
}
