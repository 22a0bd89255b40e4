use serde::{Deserialize, Serialize};

use super::BlocksError;
use crate::haar::HaarOptions;
use crate::pipeline::{AlphaRule, Parameter, ParameterOrigin};
use crate::points::{Selection, Units, Weighting};
use crate::shape::{Alpha, Balls, Engine};
use crate::volume::{Dims, Frame, GrayRange, ReadOptions, Source, any_size};

/// What is to be computed: an input and the options of every stage. Plans hold it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Job {
    /// A sample or a file.
    pub input: String,
    /// How it is read.
    pub read: ReadOptions,
    /// The values that become gray 0 and 255; `None` leaves unsigned bytes as they are, and takes the smallest
    /// and largest value of others.
    pub gray: Option<GrayRange>,
    /// Whether points get gray levels rather than the values of the input.
    pub gray_out: bool,
    /// Samples along x, y and z.
    #[serde(deserialize_with = "any_size")]
    pub dims: Dims,
    /// Where the grid lies.
    pub frame: Frame,
    /// What coordinates are measured in.
    pub units: Units,
    /// How the volume is transformed and truncated.
    pub haar: HaarOptions,
    /// Which samples become points.
    pub selection: Selection,
    /// Drops samples below this value of the input; instead of [`Selection::gray_min`].
    pub value_min: Option<f64>,
    /// Where weights come from.
    pub weighting: Weighting,
    /// The parameter α, a squared length.
    pub alpha: f64,
    /// Where it comes from.
    pub alpha_origin: ParameterOrigin,
    /// What α + ω means.
    pub balls: Balls,
    /// Which program computes the shape.
    pub engine: Engine,
}

impl Job {
    /// The default options of every stage, for the volume behind an input, which is opened.
    ///
    /// # Errors
    /// The input cannot be read in parts.
    pub fn new(input: &str, read: ReadOptions) -> Result<Self, BlocksError> {
        let source = Source::open(input, &read)?;
        let mut job = Self {
            input: input.to_owned(),
            read,
            gray: None,
            gray_out: false,
            dims: source.dims(),
            frame: *source.frame(),
            units: Units::default(),
            haar: HaarOptions::default(),
            selection: Selection::default(),
            value_min: None,
            weighting: Weighting::Common(0.0),
            alpha: 0.0,
            alpha_origin: ParameterOrigin::Default,
            balls: Balls::default(),
            engine: Engine::default(),
        };
        job.set_alpha(AlphaRule::Default)?;
        Ok(job)
    }

    /// Takes α from a rule, in the units that are set.
    ///
    /// # Errors
    /// An α that is to be found: that takes all points at once.
    pub fn set_alpha(&mut self, rule: AlphaRule) -> Result<(), BlocksError> {
        let found = rule.of_frame(&self.frame, self.units)?;
        let Some(Parameter { alpha, origin, .. }) = found else {
            return Err(BlocksError::not_local("--alpha auto", "give α as a number"));
        };
        (self.alpha, self.alpha_origin) = (alpha.squared(), origin);
        Ok(())
    }

    /// Whether it can be done in blocks.
    ///
    /// # Errors
    /// [`BlocksError::NotLocal`].
    pub fn check(&self) -> Result<(), BlocksError> {
        let not_local = |what: &str, next: &'static str| Err(BlocksError::not_local(what, next));
        if !self.alpha.is_finite() {
            return not_local("α = inf, the convex hull,", "give a finite α");
        }
        if self.engine == Engine::Cgal {
            return not_local("the engine cgal", "use the engine native");
        }
        if self.weighting == Weighting::Column {
            return Err(crate::points::PointsError::NoColumn.into());
        }
        let axes = self.frame.axes();
        if self.units == Units::World && inverse(axes).is_none() {
            return not_local("a grid whose axes lie in one plane", "correct its directions");
        }
        Ok(())
    }

    /// α as a parameter.
    pub fn parameter(&self) -> Parameter {
        let unit = self.units.coordinates_of(&self.frame).unit;
        Parameter { alpha: self.squared(), unit, origin: self.alpha_origin }
    }

    pub(super) fn squared(&self) -> Alpha {
        Alpha::from_squared(self.alpha).unwrap_or(Alpha::ZERO)
    }

    /// How many samples along x, y and z balls of this radius reach.
    pub(super) fn reach(&self, radius: f64) -> [usize; 3] {
        let samples = |step: f64| (radius * step).ceil().max(0.0) as usize;
        match self.units {
            Units::Voxel => [samples(1.0); 3],
            Units::World => {
                let inverse = inverse(self.frame.axes()).unwrap_or([[f64::INFINITY; 3]; 3]);
                inverse.map(|row| samples(row.iter().map(|v| v * v).sum::<f64>().sqrt()))
            }
        }
    }
}

/// The rows of the inverse of the matrix of these columns, if there is one.
fn inverse([a, b, c]: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    use walpha_base::vector::{cross, dot};
    let volume = dot(a, cross(b, c));
    let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|v| v / volume));
    rows.as_flattened().iter().all(|v| v.is_finite()).then_some(rows)
}
