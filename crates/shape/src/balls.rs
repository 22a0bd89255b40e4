use serde::{Deserialize, Serialize};

/// What a point with weight ω is at parameter α.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Balls {
    /// A ball of squared radius α + ω: the usual reading (Edelsbrunner 1992; CGAL), the default.
    #[default]
    Power,
    /// A ball of radius α + ω, as a sentence of the paper's section 4.2 reads: the power weight
    /// (α + ω)² at parameter 0.
    Radius,
}
