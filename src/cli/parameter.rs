//! α: as it was given, by default, or looked for.

use std::fmt::{self, Display};

use serde::Serialize;
use walpha::ladder::Filtration;
use walpha::points::{Units, weigh};
use walpha::shape::{flat_region, number_or_name};
use walpha::shown::{number, six_digits};
use walpha::{Alpha, LengthUnit, Points, Volume, WeightedPoints, Weighting};

use super::args::AlphaArg;
use super::pipeline::side;
use super::progress::Progress;
use super::report::number_or_null_or_name;

/// α, and where it comes from.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "Facts")]
pub struct Parameter {
    pub alpha: Alpha,
    /// Of lengths; α is in its square.
    pub unit: LengthUnit,
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
    unit: LengthUnit,
    origin: Origin,
}

impl Parameter {
    /// The default for a volume: 10·h², where h³ is the volume of a voxel.
    pub fn of_volume(volume: &Volume, units: Units) -> anyhow::Result<Self> {
        let h = side(volume, units);
        let (alpha, unit) = (Alpha::from_squared(10.0 * h * h)?, units.coordinates(volume).unit);
        Ok(Self { alpha, unit, origin: Origin::Default })
    }

    /// What is asked for, if that is a number.
    pub fn given(asked: Option<AlphaArg>, unit: LengthUnit) -> Option<Self> {
        match asked {
            Some(AlphaArg::Given(alpha)) => Some(Self { alpha, unit, origin: Origin::Given }),
            Some(AlphaArg::Auto) | None => None,
        }
    }

    /// The smallest α at which all points are in one solid component.
    pub fn found(
        points: WeightedPoints,
        unit: LengthUnit,
        progress: &mut Progress,
    ) -> anyhow::Result<Self> {
        let found = || match Filtration::new(points.clone()) {
            Err(error) if error.is_flat() => {
                Ok(Self { alpha: flat_region(&points)?, unit, origin: Origin::Auto })
            }
            made => made.map(|filtration| Self::of(None, unit, &filtration)),
        };
        Ok(progress.stage("alpha", found)?)
    }

    /// The same where the triangulation is there.
    pub fn of(known: Option<Self>, unit: LengthUnit, filtration: &Filtration) -> Self {
        let found = || Self { alpha: filtration.one_region(), unit, origin: Origin::Auto };
        known.unwrap_or_else(found)
    }

    /// The α that weights are to be in proportion to, if nobody gives it: that of the points alone.
    pub fn found_unweighted(
        points: &Points,
        unit: LengthUnit,
        progress: &mut Progress,
    ) -> anyhow::Result<Self> {
        let unweighted = weigh(points, Weighting::Common(0.0), 0.0)?;
        Ok(Self { origin: Origin::AutoUnweighted, ..Self::found(unweighted, unit, progress)? })
    }
}

impl Parameter {
    /// Whether it was looked for.
    pub fn is_found(self) -> bool {
        matches!(self.origin, Origin::Auto | Origin::AutoUnweighted)
    }
}

impl From<Parameter> for Facts {
    fn from(Parameter { alpha, unit, origin }: Parameter) -> Self {
        Self { squared: alpha.squared(), radius: alpha.radius(), unit, origin }
    }
}

impl Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (squared, unit) = (number(self.alpha.squared()), self.unit.symbol());
        write!(f, "α = {squared} {unit}² (squared length; ")?;
        match self.alpha.radius() {
            Some(radius) => write!(f, "√α = {} {unit})", number(six_digits(radius)))?,
            None => f.write_str("negative, so no radius)")?,
        }
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
