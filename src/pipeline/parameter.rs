use std::fmt::{self, Display};
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::Monitor;
use walpha_base::number_or_null_or_name;
use walpha_base::shown::{number, six_digits};

use super::PipelineError;
use crate::ladder::Filtration;
use crate::points::{Points, Units, WeightedPoints};
use crate::shape::{Alpha, AlphaError, ShapeError, Torus};
use crate::volume::{Frame, LengthUnit, Volume};

/// Which α a shape is made at.
///
/// Serialised as `default`, `auto` or a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub enum AlphaRule {
    /// For a volume 10 h², h³ being the volume of a voxel; [`AlphaRule::Auto`] for scattered points.
    #[default]
    Default,
    /// The smallest α at which all points are in one solid component ([`Filtration::one_region`]); if weights are
    /// proportional to α, that of the points without weights.
    Auto,
    /// This α.
    Given(Alpha),
}

impl From<Alpha> for AlphaRule {
    fn from(alpha: Alpha) -> Self {
        Self::Given(alpha)
    }
}

impl FromStr for AlphaRule {
    type Err = AlphaError;

    /// `auto`, or α as a number.
    fn from_str(text: &str) -> Result<Self, AlphaError> {
        if text.trim() == "auto" { Ok(Self::Auto) } else { Ok(Self::Given(text.trim().parse()?)) }
    }
}

impl From<AlphaRule> for String {
    fn from(rule: AlphaRule) -> Self {
        match rule {
            AlphaRule::Default => "default".into(),
            AlphaRule::Auto => "auto".into(),
            AlphaRule::Given(alpha) => alpha.squared().to_string(),
        }
    }
}

impl TryFrom<String> for AlphaRule {
    type Error = AlphaError;

    fn try_from(text: String) -> Result<Self, AlphaError> {
        if text == "default" { Ok(Self::Default) } else { text.parse() }
    }
}

/// α, and where it comes from.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "ParameterFields")]
#[non_exhaustive]
pub struct Parameter {
    /// α, a squared length.
    pub alpha: Alpha,
    /// Unit of length; α is in its square.
    pub unit: LengthUnit,
    /// Where it comes from.
    pub origin: ParameterOrigin,
}

/// Where an α comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ParameterOrigin {
    /// It was given.
    Given,
    /// Ten squared voxels, as in the paper.
    Default,
    /// Stored in the file of points.
    Stored,
    /// The smallest at which all points are in one solid component.
    Auto,
    /// The same for the points without weights, as the weights are proportional to α.
    AutoUnweighted,
}

/// α as a squared length and as a radius.
#[derive(Serialize)]
struct ParameterFields {
    squared: Alpha,
    #[serde(serialize_with = "number_or_null_or_name")]
    radius: Option<f64>,
    unit: LengthUnit,
    origin: ParameterOrigin,
}

/// The default α of a volume, in squared sides of a voxel.
const SQUARED_VOXELS: f64 = 10.0;

impl AlphaRule {
    /// The α for the points of a volume; `None` if it is still to be found.
    ///
    /// # Errors
    /// A voxel so large that 10 h² is not finite.
    pub fn of_volume(
        self,
        volume: &Volume,
        units: Units,
    ) -> Result<Option<Parameter>, PipelineError> {
        self.of_frame(volume.frame(), units)
    }

    /// [`of_volume`](Self::of_volume) for the grid of a volume.
    pub(crate) fn of_frame(
        self,
        frame: &Frame,
        units: Units,
    ) -> Result<Option<Parameter>, PipelineError> {
        let unit = units.coordinates_of(frame).unit;
        if self != Self::Default {
            return Ok(self.given(unit));
        }
        let h = units.cell(frame).cbrt();
        let alpha = Alpha::from_squared(SQUARED_VOXELS * h * h)?;
        Ok(Some(Parameter { alpha, unit, origin: ParameterOrigin::Default }))
    }

    /// The given α; `None` if it is still to be found.
    pub fn given(self, unit: LengthUnit) -> Option<Parameter> {
        match self {
            Self::Given(alpha) => Some(Parameter { alpha, unit, origin: ParameterOrigin::Given }),
            Self::Auto | Self::Default => None,
        }
    }
}

impl Parameter {
    /// The smallest α of a filtration at which all points are in one solid component.
    pub fn of_filtration(filtration: &Filtration, unit: LengthUnit) -> Self {
        Self { alpha: filtration.one_region(), unit, origin: ParameterOrigin::Auto }
    }

    /// Finds α for points, optionally on a torus, from their triangulation.
    pub(super) fn find(
        points: &WeightedPoints,
        torus: Option<Torus>,
        unit: LengthUnit,
        monitor: &Monitor,
    ) -> Result<Self, ShapeError> {
        Ok(Self::of_filtration(&Filtration::monitored(torus, points.clone(), monitor)?, unit))
    }

    /// Finds the α that weights will be proportional to: that of the points without weights.
    pub(super) fn find_unweighted(
        points: &Points,
        unit: LengthUnit,
        monitor: &Monitor,
    ) -> Result<Self, PipelineError> {
        let unweighted = WeightedPoints::unweighted(points.positions.clone());
        let found = Self::of_filtration(&Filtration::monitored(None, unweighted, monitor)?, unit);
        Ok(Self { origin: ParameterOrigin::AutoUnweighted, ..found })
    }

    /// Whether it was found rather than given.
    pub fn is_found(&self) -> bool {
        matches!(self.origin, ParameterOrigin::Auto | ParameterOrigin::AutoUnweighted)
    }
}

impl From<Parameter> for ParameterFields {
    fn from(Parameter { alpha, unit, origin }: Parameter) -> Self {
        Self { squared: alpha, radius: alpha.radius(), unit, origin }
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
            ParameterOrigin::Given => "",
            ParameterOrigin::Default => ", the default",
            ParameterOrigin::Stored => ", that of the file",
            ParameterOrigin::Auto => {
                ", the smallest at which all points are in one solid component"
            }
            ParameterOrigin::AutoUnweighted => {
                ", the smallest at which all points, without weights, are in one solid component"
            }
        })
    }
}
