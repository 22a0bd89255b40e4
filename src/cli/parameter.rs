//! α: as it was given, by default, or looked for.

use std::fmt::{self, Display};

use serde::Serialize;
use walpha::ladder::Filtration;
use walpha::points::{Units, weigh};
use walpha::shape::number_or_name;
use walpha::{Alpha, Points, Volume, WeightedPoints, Weighting};

use super::args::AlphaArg;
use super::pipeline::cell_volume;
use super::progress::Progress;
use super::report::number_or_null_or_name;

/// α, and where it comes from.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "Facts")]
pub struct Parameter {
    pub alpha: Alpha,
    pub origin: Origin,
}

/// Where an α comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    Given,
    /// Ten squared voxels, as in the paper.
    Default,
    /// The smallest at which all points are in one solid component.
    Auto,
    /// The same without weights, which are in proportion to it.
    AutoUnweighted,
}

/// α as a squared length and as a radius.
#[derive(Serialize)]
struct Facts {
    #[serde(serialize_with = "number_or_name")]
    squared: f64,
    #[serde(serialize_with = "number_or_null_or_name")]
    radius: Option<f64>,
    origin: Origin,
}

impl Parameter {
    /// The default for a volume: 10·h², where h³ is the volume of a voxel.
    pub fn of_volume(volume: &Volume, units: Units) -> anyhow::Result<Self> {
        let h = cell_volume(volume, units).cbrt();
        Ok(Self { alpha: Alpha::from_squared(10.0 * h * h)?, origin: Origin::Default })
    }

    /// What is asked for, if that is a number.
    pub fn given(asked: Option<AlphaArg>) -> Option<Self> {
        match asked {
            Some(AlphaArg::Given(alpha)) => Some(Self { alpha, origin: Origin::Given }),
            Some(AlphaArg::Auto) | None => None,
        }
    }

    /// The smallest α at which all points are in one solid component.
    pub fn found(points: WeightedPoints, progress: &mut Progress) -> anyhow::Result<Self> {
        let found = || Filtration::new(points).map(|filtration| Self::of(None, &filtration));
        Ok(progress.stage("alpha", found)?)
    }

    /// The same where the triangulation is there.
    pub fn of(known: Option<Self>, filtration: &Filtration) -> Self {
        known.unwrap_or_else(|| Self { alpha: filtration.one_region(), origin: Origin::Auto })
    }

    /// The α that weights are to be in proportion to, if nobody gives it: that of the points alone.
    pub fn found_unweighted(points: &Points, progress: &mut Progress) -> anyhow::Result<Self> {
        let unweighted = weigh(points, Weighting::Common(0.0), 0.0)?;
        Ok(Self { origin: Origin::AutoUnweighted, ..Self::found(unweighted, progress)? })
    }
}

impl Parameter {
    /// Whether it was looked for.
    pub fn is_found(self) -> bool {
        matches!(self.origin, Origin::Auto | Origin::AutoUnweighted)
    }
}

impl From<Parameter> for Facts {
    fn from(Parameter { alpha, origin }: Parameter) -> Self {
        Self { squared: alpha.squared(), radius: alpha.radius(), origin }
    }
}

impl Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.alpha)?;
        f.write_str(match self.origin {
            Origin::Given => "",
            Origin::Default => ", the default",
            Origin::Auto => ", the smallest at which all points are in one solid component",
            Origin::AutoUnweighted => {
                ", the smallest at which all points, without weights, are in one solid component"
            }
        })
    }
}
