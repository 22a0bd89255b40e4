//! How far from a block what matters to it may be.

use walpha_regular::Sites;

/// How far the halo of a block goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// To the points whose balls at this α meet one of the block's: what decides the shape at α.
    Balls(f64),
    /// So far, whatever the balls.
    Distance(f64),
}

impl Reach {
    /// Everything there is; of a torus, so many copies as decide the whole triangulation.
    ///
    /// Of the copies of the heaviest point, one is within half a diagonal of any place z, so the
    /// largest empty orthogonal sphere has R² + max ω ≤ (diagonal / 2)². A vertex v of it is at √(R² + ω(v))
    /// from its centre, no more than half a diagonal, and so is any point that could refute it.
    pub(crate) fn whole(sites: &Sites<'_>) -> Self {
        Self::Distance(sites.torus().map_or(f64::INFINITY, |torus| torus.diagonal()))
    }

    /// What decides the shape at α.
    pub(crate) fn at(sites: &Sites<'_>, alpha: f64, heaviest: f64) -> Self {
        let whole = Self::whole(sites);
        match whole {
            Self::Distance(most) if 2.0 * (alpha + heaviest).max(0.0).sqrt() >= most => whole,
            _ => Self::Balls(alpha),
        }
    }

    /// How far from a point of a weight those of another weight matter; NaN if they never do.
    #[inline]
    pub(crate) fn from(self, weight: f64, other: f64) -> f64 {
        match self {
            Self::Balls(alpha) => (alpha + weight).max(0.0).sqrt() + (alpha + other).sqrt(),
            Self::Distance(distance) => distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use walpha_regular::Torus;

    use super::*;

    /// Half of a diagonal of 13 is 6.5, whose square is 42.25.
    #[test]
    fn large_balls_of_a_torus_ask_for_all_of_it() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let torus = Torus::new([3.0, 4.0, 12.0]).unwrap();
        let periodic = Sites::on_torus(&positions, &[0.25; 4], torus).unwrap();
        assert_eq!(Reach::at(&periodic, 41.75, 0.25), Reach::Balls(41.75));
        assert_eq!(Reach::at(&periodic, 42.25, 0.25), Reach::whole(&periodic));
        assert!(
            matches!(Reach::whole(&periodic), Reach::Distance(most) if (most - 13.0).abs() < 1e-9)
        );
        let sites = Sites::new(&positions, &[0.25; 4]).unwrap();
        assert_eq!(Reach::at(&sites, 42.25, 0.25), Reach::Balls(42.25));
        assert_eq!(Reach::whole(&sites), Reach::Distance(f64::INFINITY));
    }

    #[test]
    fn balls_reach_as_far_as_both_their_radii() {
        assert_eq!(Reach::Balls(5.0).from(4.0, 11.0), 7.0);
        assert_eq!(Reach::Balls(5.0).from(-6.0, 11.0), 4.0);
        assert!(Reach::Balls(5.0).from(4.0, -6.0).is_nan());
        assert_eq!(Reach::Distance(2.0).from(4.0, -6.0), 2.0);
    }
}
