use std::fmt::{self, Display};
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use walpha_base::number_or_null_or_name;
use walpha_base::shown::{brief, rounded};

use super::PipelineError;
use super::spacing::spacing_alpha;
use walpha_points::{Points, Units, WeightedPoints};
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, AlphaError, ShapeError, Torus};
use walpha_volume::{Frame, LengthUnit, Volume};

/// The rule that determines the α of a shape.
///
/// It is serialised as `default`, `auto`, `auto:connected` or a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub enum AlphaRule {
    /// For a volume 10 h², where h³ is the volume of a voxel; [`AlphaRule::Auto`] for scattered points.
    #[default]
    Default,
    /// The α from the spacing of the points, at which nine of ten balls reach the centres of their eighth neighbours
    /// ([`Parameter::of_spacing`]). If weights are proportional to α, the α of the points without weights is used.
    Auto,
    /// The smallest α at which all points are in one solid component ([`Filtration::one_region`]). If weights are proportional to
    /// α, the α of the points without weights is used.
    Connected,
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

    /// Parses `auto`, `auto:connected`, or α as a number.
    fn from_str(text: &str) -> Result<Self, AlphaError> {
        Ok(match text.trim() {
            "auto" => Self::Auto,
            "auto:connected" => Self::Connected,
            number => Self::Given(number.parse()?),
        })
    }
}

impl From<AlphaRule> for String {
    fn from(rule: AlphaRule) -> Self {
        match rule {
            AlphaRule::Default => "default".into(),
            AlphaRule::Auto => "auto".into(),
            AlphaRule::Connected => "auto:connected".into(),
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

/// The value of α, and its origin.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(into = "ParameterFields")]
#[non_exhaustive]
pub struct Parameter {
    /// The value of α, a squared length.
    pub alpha: Alpha,
    /// The unit of length; α is in its square.
    pub unit: LengthUnit,
    /// The origin of the value.
    pub origin: ParameterOrigin,
}

/// The origin of a value of α.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ParameterOrigin {
    /// α was given.
    Given,
    /// α is the default: ten squared voxels, as in the paper.
    Default,
    /// α was stored in the file of points.
    Stored,
    /// α was found from the spacing of the points.
    Auto,
    /// Like `Auto`, for the points without weights, as the weights are proportional to α.
    AutoUnweighted,
    /// α is the smallest at which all points are in one solid component.
    Connected,
    /// Like `Connected`, for the points without weights, as the weights are proportional to α.
    ConnectedUnweighted,
    /// There is no α, as the shape is the solid of labels.
    Labels,
    /// There is none: the shape is the solid inside an isosurface.
    Surface,
}

/// The value of α as a squared length and as a radius.
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
    /// The α for the points of a volume; `None` if it must still be found.
    ///
    /// # Errors
    /// A voxel is so large that 10 h² is not finite.
    pub fn of_volume(
        self,
        volume: &Volume,
        units: Units,
    ) -> Result<Option<Parameter>, PipelineError> {
        self.of_frame(volume.frame(), units)
    }

    /// Like [`of_volume`](Self::of_volume), for the grid of a volume.
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
        let squared = SQUARED_VOXELS * h * h;
        if squared.is_infinite() {
            return Err(AlphaError::Square(SQUARED_VOXELS.sqrt() * h).into());
        }
        let alpha = Alpha::from_squared(squared)?;
        Ok(Some(Parameter { alpha, unit, origin: ParameterOrigin::Default }))
    }

    /// The α for points whose filtration, in space, is known.
    #[expect(clippy::missing_panics_doc, reason = "the points of a filtration are in range")]
    pub fn on(self, filtration: &Filtration, unit: LengthUnit) -> Parameter {
        let found = || match self {
            Self::Connected => Parameter::of_filtration(filtration, unit),
            _ => Parameter::of_spacing(filtration.points(), None, unit)
                .expect("the points of a filtration were checked"),
        };
        self.given(unit).unwrap_or_else(found)
    }

    /// The given α; `None` if it must still be found.
    pub fn given(self, unit: LengthUnit) -> Option<Parameter> {
        match self {
            Self::Given(alpha) => Some(Parameter { alpha, unit, origin: ParameterOrigin::Given }),
            Self::Auto | Self::Connected | Self::Default => None,
        }
    }
}

impl Parameter {
    /// The α of [`AlphaRule::Auto`]: the least at which the balls of nine of ten points reach the centres of their eighth
    /// neighbours. It is the quantile of r² − ω over points, where r is the distance to the eighth of the other positions and ω
    /// the weight. Surfaces become closed and solids filled, and a few strays do not matter. The points may be on a torus. O(n
    /// log n); if there are more than 20 000 points, a sample of them is examined.
    ///
    /// # Errors
    /// Coordinates or weights are not finite or are too large.
    pub fn of_spacing(
        points: &WeightedPoints,
        torus: Option<Torus>,
        unit: LengthUnit,
    ) -> Result<Self, ShapeError> {
        Ok(Self { alpha: spacing_alpha(points, torus)?, unit, origin: ParameterOrigin::Auto })
    }

    /// The α of [`AlphaRule::Connected`]: the smallest α of a filtration at which all points are in one solid component.
    pub fn of_filtration(filtration: &Filtration, unit: LengthUnit) -> Self {
        Self { alpha: filtration.one_region(), unit, origin: ParameterOrigin::Connected }
    }

    /// Finds α for points, optionally on a torus: for [`AlphaRule::Connected`] from their triangulation, otherwise from their
    /// spacing.
    pub(super) fn find(
        rule: AlphaRule,
        points: &WeightedPoints,
        torus: Option<Torus>,
        unit: LengthUnit,
    ) -> Result<Self, ShapeError> {
        if rule != AlphaRule::Connected {
            return Self::of_spacing(points, torus, unit);
        }
        Ok(Self::of_filtration(&Filtration::on(torus, points.clone())?, unit))
    }

    /// Finds the α to which weights will be proportional: that of the points without weights.
    pub(super) fn find_unweighted(
        rule: AlphaRule,
        points: &Points,
        unit: LengthUnit,
    ) -> Result<Self, PipelineError> {
        let unweighted = WeightedPoints::unweighted(points.positions.clone());
        let found = Self::find(rule, &unweighted, None, unit)?;
        let origin = match found.origin {
            ParameterOrigin::Connected => ParameterOrigin::ConnectedUnweighted,
            _ => ParameterOrigin::AutoUnweighted,
        };
        Ok(Self { origin, ..found })
    }

    /// The parameter of a solid of labels, which has no α: it is infinite.
    pub(super) fn of_labels(unit: LengthUnit) -> Self {
        Self { alpha: Alpha::INFINITE, unit, origin: ParameterOrigin::Labels }
    }

    /// The parameter of a solid inside an isosurface, which has no α: it is infinite.
    pub(super) fn of_surface(unit: LengthUnit) -> Self {
        Self { alpha: Alpha::INFINITE, unit, origin: ParameterOrigin::Surface }
    }

    /// Whether α was found and not given.
    pub fn is_found(&self) -> bool {
        use ParameterOrigin::{Auto, AutoUnweighted, Connected, ConnectedUnweighted};
        matches!(self.origin, Auto | AutoUnweighted | Connected | ConnectedUnweighted)
    }
}

impl From<Parameter> for ParameterFields {
    fn from(Parameter { alpha, unit, origin }: Parameter) -> Self {
        Self { squared: alpha, radius: alpha.radius(), unit, origin }
    }
}

/// The radius of the ball and α, with four digits, or with six where the form is alternate (`{:#}`); and where they come from.
impl Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.origin == ParameterOrigin::Labels {
            return f.write_str("none: the cells are those of voxels, by their labels");
        }
        if self.origin == ParameterOrigin::Surface {
            return f.write_str("none: the cells are those inside an isosurface, by the samples");
        }
        let shown = if f.alternate() { rounded } else { brief };
        let (squared, unit) = (shown(self.alpha.squared()), self.unit.symbol());
        match self.alpha.radius() {
            Some(radius) if radius.is_finite() => {
                write!(f, "ball radius {} {unit} (α = {squared} {unit}²)", shown(radius))?;
            }
            Some(_) => f.write_str("α = inf, the convex hull")?,
            None => write!(f, "α = {squared} {unit}² (negative, so no ball radius)")?,
        }
        f.write_str(match self.origin {
            ParameterOrigin::Given | ParameterOrigin::Labels | ParameterOrigin::Surface => "",
            ParameterOrigin::Default => ", the default",
            ParameterOrigin::Stored => ", that of the file",
            ParameterOrigin::Auto => ", from the spacing of the points",
            ParameterOrigin::AutoUnweighted => ", from the spacing of the points, without weights",
            ParameterOrigin::Connected => {
                ", the smallest at which all points are in one solid component"
            }
            ParameterOrigin::ConnectedUnweighted => {
                ", the smallest at which all points, without weights, are in one solid component"
            }
        })
    }
}
