use serde::{Deserialize, Serialize};

use super::canonical::canonical;
use super::{Alpha, Balls, Betti, Class, Complex, Measures, Simplices, direct_betti};
use crate::cgal::{self, CgalError, Sites, SitesError};
use crate::points::WeightedPoints;

/// Which program computes the shape; all give the same answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// CGAL's `Regular_triangulation_3` and `Fixed_alpha_shape_3`, as in the paper.
    #[default]
    Reference,
}

/// How to make a shape of weighted points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeOptions {
    /// The parameter α.
    pub alpha: Alpha,
    /// What α + ω means.
    pub balls: Balls,
    /// Which program computes it.
    pub engine: Engine,
    /// Whether the simplices outside the shape are wanted too: the whole triangulation.
    pub exterior: bool,
}

impl ShapeOptions {
    /// The shape at α, with power balls, by the default engine, without exterior simplices.
    pub fn new(alpha: Alpha) -> Self {
        Self { alpha, balls: Balls::default(), engine: Engine::default(), exterior: false }
    }
}

/// The weighted alpha shape of a set of points: a classified subcomplex of their regular
/// triangulation, by input index.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaShape {
    points: WeightedPoints,
    options: ShapeOptions,
    /// Weights (α + ω)², where the balls are read so.
    squared: Option<Vec<f64>>,
    complex: Complex,
    duplicates: Vec<[u32; 2]>,
    hidden: Option<Vec<u32>>,
    betti: Option<Betti>,
    measures: Measures,
}

/// Why there is no shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// CGAL cannot triangulate the points.
    #[error(transparent)]
    Cgal(#[from] CgalError),
    /// The `radius` reading asks for a ball of negative or infinite radius.
    #[error(
        "point {index} would be a ball of radius α + ω = {radius}: with `--balls radius` it must be \
         finite and not negative; raise α, or use `--balls power`"
    )]
    Radius {
        /// Input index of the point.
        index: usize,
        /// Its α + ω.
        radius: f64,
    },
}

impl From<SitesError> for ShapeError {
    fn from(error: SitesError) -> Self {
        Self::Cgal(error.into())
    }
}

/// The alpha shape of weighted points.
///
/// Of several points at one place the heaviest stays ([`AlphaShape::duplicates`]). An empty shape
/// is a result, not an error. At α = ∞ the shape is the convex hull.
///
/// # Errors
/// NaN or absurd numbers, fewer than four different places, points in one plane or on one line:
/// see [`SitesError`]; a negative radius: [`ShapeError::Radius`].
pub fn alpha_shape(
    points: WeightedPoints,
    options: &ShapeOptions,
) -> Result<AlphaShape, ShapeError> {
    let squared = match options.balls {
        Balls::Power => None,
        Balls::Radius => Some(squared_radii(&points.weights, options.alpha)?),
    };
    let sites = Sites::new(&points.positions, squared.as_deref().unwrap_or(&points.weights))?;
    let raw = cgal::reference(&sites, power_alpha(options))?;
    let mut complex = canonical(&raw, sites.input());
    drop(raw);
    let betti = Some(direct_betti(&complex));
    let hidden = Some(hidden(sites.input(), &complex.vertices));
    if !options.exterior {
        complex.retain_shape();
    }
    let measures = Measures::of(&complex, &points.positions);
    let duplicates = sites.duplicates().to_vec();
    Ok(AlphaShape {
        points,
        options: *options,
        squared,
        complex,
        duplicates,
        hidden,
        betti,
        measures,
    })
}

/// The parameter at which the power weights are judged.
fn power_alpha(options: &ShapeOptions) -> f64 {
    match options.balls {
        Balls::Power => options.alpha.squared(),
        Balls::Radius => 0.0,
    }
}

fn squared_radii(weights: &[f64], alpha: Alpha) -> Result<Vec<f64>, ShapeError> {
    let radius = |(index, weight): (usize, &f64)| {
        let radius = alpha.squared() + weight;
        // NaN compares false: it is refused too.
        if radius >= 0.0 && radius.is_finite() {
            Ok(radius * radius)
        } else {
            Err(ShapeError::Radius { index, radius })
        }
    };
    weights.iter().enumerate().map(radius).collect()
}

/// Sites that are no vertices. Both lists ascend.
fn hidden(sites: &[u32], vertices: &Simplices<1>) -> Vec<u32> {
    let mut vertices = vertices.vertices.iter().peekable();
    sites.iter().copied().filter(|&site| vertices.next_if(|v| v[0] == site).is_none()).collect()
}

impl AlphaShape {
    /// The points as they were given, duplicates and hidden ones included.
    pub fn points(&self) -> &WeightedPoints {
        &self.points
    }

    /// How the shape was made.
    pub fn options(&self) -> &ShapeOptions {
        &self.options
    }

    /// The weights the triangulation is regular for: ω, or (α + ω)² for [`Balls::Radius`].
    pub fn power_weights(&self) -> &[f64] {
        self.squared.as_deref().unwrap_or(&self.points.weights)
    }

    /// The squared radius simplices are compared with: α, or 0 for [`Balls::Radius`].
    pub fn power_alpha(&self) -> f64 {
        power_alpha(&self.options)
    }

    /// The simplices and their classes, in canonical order; exterior ones only if asked for.
    pub fn complex(&self) -> &Complex {
        &self.complex
    }

    /// Pairs of input indices: a point that went, and the one at the same place that stayed.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// Points that are no vertices of the regular triangulation, ascending; `None` when the engine
    /// did not see the whole triangulation.
    pub fn hidden(&self) -> Option<&[u32]> {
        self.hidden.as_deref()
    }

    /// Betti numbers of the shape; `None` when the engine cannot know them.
    pub fn betti(&self) -> Option<Betti> {
        self.betti
    }

    /// Volume and areas.
    pub fn measures(&self) -> &Measures {
        &self.measures
    }

    /// How many points are vertices of the shape.
    pub fn points_in_shape(&self) -> usize {
        self.complex.vertices.len() - self.complex.vertices.counts()[Class::Exterior as usize]
    }
}
