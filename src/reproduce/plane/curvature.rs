/// The parameter α of Edelsbrunner, Kirkpatrick and Seidel: the signed curvature, a reciprocal
/// **length**, of the boundary of a *generalised disc*.
///
/// The generalised disc of radius 1/α is a disc of that radius for α > 0, a half-plane for α = 0,
/// and the complement of an open disc of radius −1/α for α < 0; it always contains its boundary.
/// As α grows from −∞ the shape goes from single points by way of the convex hull (α = 0) to the
/// points that hold the smallest enclosing circle.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Curvature(f64);

impl Curvature {
    /// Straight: half-planes, the convex hull.
    pub const ZERO: Self = Self(0.0);
    /// The least and the greatest magnitude but 0, 2^∓1000: beyond these, lengths near the radius
    /// are not doubles.
    pub const MAGNITUDE: [f64; 2] =
        [f64::from_bits((1023 - 1000) << 52), f64::from_bits((1023 + 1000) << 52)];

    /// α as a reciprocal length.
    ///
    /// # Errors
    /// [`NotACurvature`] for NaN and for magnitudes outside [`Curvature::MAGNITUDE`] that are
    /// not 0.
    pub fn new(alpha: f64) -> Result<Self, NotACurvature> {
        let [least, greatest] = Self::MAGNITUDE;
        if alpha == 0.0 || (least..=greatest).contains(&alpha.abs()) {
            Ok(Self(alpha))
        } else {
            Err(NotACurvature { given: alpha })
        }
    }

    /// α, a reciprocal length.
    pub fn value(self) -> f64 {
        self.0
    }

    /// The radius of the circles, 1/|α|, rounded; infinite for α = 0.
    pub fn radius(self) -> f64 {
        self.0.abs().recip()
    }
}

impl std::fmt::Display for Curvature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (alpha, radius) = (self.0, self.radius());
        if alpha > 0.0 {
            write!(f, "α = {alpha} (discs of radius {radius:.6})")
        } else if alpha < 0.0 {
            write!(f, "α = {alpha} (complements of discs of radius {radius:.6})")
        } else {
            write!(f, "α = 0 (half-planes)")
        }
    }
}

/// The number given as α is not a curvature.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "α cannot be {given}: a generalised disc needs 0 or a finite reciprocal length of magnitude {least:e} to {greatest:e}",
    least = Curvature::MAGNITUDE[0],
    greatest = Curvature::MAGNITUDE[1]
)]
pub struct NotACurvature {
    given: f64,
}
