use std::num::NonZeroUsize;

use serde::{Deserialize, Serialize};
use walpha_check::{Claim, Placed};

use rayon::prelude::*;

use super::blocks::{self, Limits, Plan, PlanError, Question, Reach};
use super::canonical::canonical;
use super::flat::{self, flat};
use super::measure::together;
use super::parts::wound;
use super::topology::{sheet_betti, torus_betti};
use super::{Alpha, Balls, Betti, Complex, Measures, Sheets, Simplices, direct_betti};
use crate::advice::{Advice, Setting, advice};
use crate::memory::NoMemory;
use crate::points::WeightedPoints;
use crate::triangulation::{
    Maker, Sites, SitesError, Torus, TriangulationError, check_numbers, is_flat, lattice,
};
use crate::volume::Coordinates;

/// Which program computes the shape; all give the same answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// CGAL's `Regular_triangulation_3` and `Fixed_alpha_shape_3`, as in the paper.
    Reference,
    /// CGAL's `Regular_triangulation_3` in blocks, in parallel or in bounded memory, classified by
    /// exact predicates of our own.
    #[cfg_attr(feature = "cgal", default)]
    Cgal,
    /// The same with our own triangulation: no C++, and the fastest.
    #[cfg_attr(not(feature = "cgal"), default)]
    Native,
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
    /// Whether the simplices outside the shape are wanted too: the whole triangulation, which
    /// takes one block.
    pub exterior: bool,
    /// How many blocks the points are cut into, at most one for each; by default, as few as keep the
    /// threads at work and the memory bounded. One block is the whole triangulation.
    pub blocks: Option<NonZeroUsize>,
    /// Bytes of memory that the plan for the blocks keeps to.
    pub memory: Option<u64>,
    /// Whether points in one plane, on one line, or fewer than four are an error. Otherwise their shape
    /// is the one in their plane or on their line, without cells.
    pub refuse_flat: bool,
    /// The box that repeats, if one does: the points are those of a torus, of which the shape is.
    pub periodic: Option<Torus>,
}

impl ShapeOptions {
    /// The shape at α, with power balls, by the default engine, without exterior simplices.
    pub fn new(alpha: Alpha) -> Self {
        Self {
            alpha,
            balls: Balls::default(),
            engine: Engine::default(),
            exterior: false,
            blocks: None,
            memory: None,
            refuse_flat: false,
            periodic: None,
        }
    }

    /// Whether they go together, which [`alpha_shape`] looks at first.
    ///
    /// # Errors
    /// [`ShapeError::Unbounded`] and [`ShapeError::Exterior`]: blocks, or a bound on memory, for what
    /// takes the whole triangulation; [`ShapeError::Unrepeated`].
    pub fn check(&self) -> Result<(), ShapeError> {
        if self.periodic.is_some() && self.engine == Engine::Reference {
            return Err(ShapeError::Unrepeated);
        }
        if let Some(blocks) = self.blocks.map(NonZeroUsize::get)
            && self.exterior
            && blocks > 1
        {
            return Err(ShapeError::Exterior { blocks });
        }
        let unbounded = |by| Err(ShapeError::Unbounded { by });
        match self.memory {
            Some(_) if self.engine == Engine::Reference => unbounded(Whole::Reference),
            Some(_) if self.exterior => unbounded(Whole::Exterior),
            Some(_) if power_alpha(self) == Alpha::INFINITE => unbounded(Whole::Hull),
            _ => Ok(()),
        }
    }
}

/// The weighted alpha shape of a set of points: a classified subcomplex of their regular
/// triangulation, by input index.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaShape {
    pub(super) points: WeightedPoints,
    coordinates: Coordinates,
    pub(super) options: ShapeOptions,
    /// Weights (α + ω)², where the balls are read so.
    pub(super) squared: Option<Vec<f64>>,
    pub(super) complex: Complex,
    /// What the last points are copies of, where a torus is laid out in space.
    pub(super) copies: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
    hidden: Option<Vec<u32>>,
    betti: Option<Betti>,
    sheets: Option<Sheets>,
    measures: Measures,
}

/// Why a shape cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// The points cannot be triangulated.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
    /// The `radius` reading asks for a ball of negative or infinite radius.
    #[error(
        "point {index} would be a ball of radius α + ω = {radius}: where α + ω is a radius it must \
         be finite and not negative"
    )]
    Radius {
        /// Input index of the point.
        index: usize,
        /// Its α + ω.
        radius: f64,
    },
    /// The memory allowed does not suffice for any number of blocks.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// Memory for what is known of the simplices cannot be had.
    #[error(transparent)]
    Memory(#[from] NoMemory),
    /// Memory is bounded by cutting the points into blocks, which this shape is not made in.
    #[error(
        "a bound on memory cannot be kept {}: that takes the whole triangulation at once",
        by.when()
    )]
    Unbounded {
        /// What asks for the whole triangulation.
        by: Whole,
    },
    /// Two points at one place, of a set that is never in one place.
    #[error("two points are at one place, {at:?}, which is not sorted out in separate blocks")]
    Coincident {
        /// The place.
        at: [f64; 3],
    },
    /// Exterior simplices are known to the whole triangulation only.
    #[error(
        "simplices outside the shape are not local: they need the whole triangulation, and \
         {blocks} blocks were asked for"
    )]
    Exterior {
        /// The blocks asked for.
        blocks: usize,
    },
    /// The reference engine knows no periodic boxes.
    #[error(
        "the reference engine is CGAL's alpha shape of points in space, which knows no periodic box"
    )]
    Unrepeated,
    /// An edge is so long that its ends do not say which of their copies it joins.
    #[error(
        "the edge between points {} and {} spans {span} along {axis}, half of the periodic box ({side}) or \
         more: its ends would not say which of their copies it joins",
        edge[0], edge[1]
    )]
    Wraps {
        /// Input indices; equal for an edge from a point to its own copy.
        edge: [u32; 2],
        /// The axis along which it spans most of the box.
        axis: char,
        /// How much it spans.
        span: f64,
        /// The side of the box along that axis.
        side: f64,
    },
}

/// What takes the whole triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Whole {
    /// The reference engine.
    Reference,
    /// The simplices outside the shape.
    Exterior,
    /// α = ∞.
    Hull,
}

impl Whole {
    fn when(self) -> &'static str {
        match self {
            Self::Reference => "by the reference engine",
            Self::Exterior => "with the simplices outside the shape",
            Self::Hull => "at α = inf, the convex hull",
        }
    }
}

impl ShapeError {
    /// What to do about it, where there is something.
    pub fn advice(&self) -> Option<Advice> {
        Some(match self {
            Self::Triangulation(error) => return error.advice(),
            Self::Radius { .. } => advice!["raise α, or use ", Setting::Balls, " power"],
            Self::Plan(error) => error.advice(),
            Self::Memory(lack) => lack.advice(),
            Self::Unbounded { by: Whole::Exterior } => {
                advice!["omit ", Setting::Memory, ", or omit ", Setting::Exterior]
            }
            Self::Unbounded { by: Whole::Hull } => {
                advice!["omit ", Setting::Memory, ", or give a finite ", Setting::Alpha]
            }
            Self::Unbounded { by: Whole::Reference } => {
                let (memory, engine) = (Setting::Memory, Setting::Engine);
                advice!["omit ", memory, ", or use ", engine, " native or ", engine, " cgal"]
            }
            Self::Unrepeated => {
                advice!["use ", Setting::Engine, " native or ", Setting::Engine, " cgal"]
            }
            Self::Wraps { axis, .. } => advice![
                "lower ",
                Setting::Alpha,
                format!(
                    ", or repeat the points along {axis}, and make the box as many times as long"
                )
            ],
            Self::Coincident { .. } => {
                "correct the spacing and directions of the grid, or use voxels as units".into()
            }
            Self::Exterior { .. } => {
                advice!["give ", Setting::Blocks, " 1, or omit ", Setting::Exterior]
            }
        })
    }

    /// Whether it says that points span no volume, though there is one at least.
    pub fn is_flat(&self) -> bool {
        matches!(self, Self::Triangulation(error) if is_flat(error))
    }
}

impl From<SitesError> for ShapeError {
    fn from(error: SitesError) -> Self {
        Self::Triangulation(error.into())
    }
}

/// The alpha shape of weighted points.
///
/// Of several points at one place the heaviest stays ([`AlphaShape::duplicates`]). An empty shape
/// is a result, not an error. At α = ∞ the shape is the convex hull.
///
/// Points in one plane or on one line, which is decided exactly, have their shape there: there are no
/// cells, what is in the shape and a face of nothing else there is singular, its faces are regular,
/// and nothing is interior. Ties are broken as in space. It is made in one piece, whatever blocks were
/// asked for.
///
/// With [`ShapeOptions::periodic`] the shape is that of a torus. Its points are those given, moved into the
/// box and rounded as [`Torus::wrap`] does. A simplex of the torus is listed once, by the input indices of
/// its vertices; its copies in space are those that have all other vertices nearer to the first than half of
/// the box, along each axis ([`AlphaShape::corners`]). Where an edge that is to be listed is longer, that
/// would not be so: [`ShapeError::Wraps`]. With 4 √(α + max ω) less than the shortest side there is no
/// such edge. At α = ∞ the shape is the whole torus.
///
/// # Errors
/// NaN or absurd numbers, no points, and with [`ShapeOptions::refuse_flat`] fewer than four different
/// places and points in one plane or on one line: see [`SitesError`]; a negative radius:
/// [`ShapeError::Radius`]; options that do not go together: [`ShapeOptions::check`].
pub fn alpha_shape(
    mut points: WeightedPoints,
    options: &ShapeOptions,
) -> Result<AlphaShape, ShapeError> {
    options.check()?;
    if let Some(torus) = options.periodic {
        check_numbers(&points.positions, &points.weights)?;
        points.positions.par_iter_mut().for_each(|place| *place = torus.wrap(*place));
    }
    let squared = match options.balls {
        Balls::Power => None,
        Balls::Radius => Some(squared_radii(&points.weights, options.alpha)?),
    };
    let weights = squared.as_deref().unwrap_or(&points.weights);
    let found = match in_space(&points.positions, weights, options) {
        Err(error) if !options.refuse_flat && error.is_flat() => {
            in_plane(&points.positions, weights, options)?
        }
        found => found?,
    };
    let Found { mut complex, boundary, hidden, duplicates, direct } = found;
    if boundary.is_none() && !options.exterior {
        complex.retain_shape();
    }
    let (counted, measures) = rayon::join(
        || {
            let (b0, sheets, windings) = boundary.as_ref()?;
            Some(match options.periodic {
                None => sheet_betti(&complex, *b0, sheets),
                Some(torus) => {
                    let wound = wound(&complex, &points.positions, torus);
                    torus_betti(&complex, wound.directions().rank(), sheets, *windings)
                }
            })
        },
        || Measures::of(&complex, &points.positions, options.periodic),
    );
    Ok(AlphaShape {
        points,
        coordinates: Coordinates::default(),
        options: *options,
        squared,
        complex,
        copies: Vec::new(),
        duplicates,
        hidden,
        betti: direct.or(counted),
        sheets: boundary.map(|(_, sheets, _)| sheets),
        measures,
    })
}

/// What an engine found.
struct Found {
    complex: Complex,
    /// The number of components and the sheets of the boundary, where the engine knows them, and in how
    /// many directions the sheets go round a torus.
    boundary: Option<(u64, Sheets, usize)>,
    /// Sites that are not vertices, where the engine saw the whole triangulation.
    hidden: Option<Vec<u32>>,
    duplicates: Vec<[u32; 2]>,
    /// Betti numbers, where they are not counted by sheets.
    direct: Option<Betti>,
}

fn in_space(
    positions: &[[f64; 3]],
    weights: &[f64],
    options: &ShapeOptions,
) -> Result<Found, ShapeError> {
    let sites = match options.periodic {
        None => Sites::new(positions, weights)?,
        Some(torus) => Sites::on_torus(positions, weights, torus)?,
    };
    match options.engine {
        Engine::Reference => by_reference(&sites, power_alpha(options).squared()),
        Engine::Cgal => by_blocks(&sites, Maker::Cgal, options),
        Engine::Native => by_blocks(&sites, Maker::Native, options),
    }
}

/// The shape of points that span no volume.
fn in_plane(
    positions: &[[f64; 3]],
    weights: &[f64],
    options: &ShapeOptions,
) -> Result<Found, ShapeError> {
    let sites = Sites::any(positions, weights)?;
    let maker = if options.engine == Engine::Native { Maker::Native } else { Maker::Cgal };
    let flat::Found { complex, betti } = flat(&sites, power_alpha(options).squared(), maker)?;
    let hidden = Some(hidden(sites.input(), &complex.vertices));
    let duplicates = sites.duplicates().to_vec();
    Ok(Found { complex, boundary: None, hidden, duplicates, direct: Some(betti) })
}

fn by_reference(sites: &Sites<'_>, alpha: f64) -> Result<Found, ShapeError> {
    let raw = crate::cgal::reference(sites, alpha)?;
    let complex = canonical(&raw, sites.input());
    let hidden = Some(hidden(sites.input(), &complex.vertices));
    // Counted over what is outside, too.
    let direct = Some(direct_betti(&complex));
    let duplicates = sites.duplicates().to_vec();
    Ok(Found { complex, boundary: None, hidden, duplicates, direct })
}

fn by_blocks(sites: &Sites<'_>, maker: Maker, options: &ShapeOptions) -> Result<Found, ShapeError> {
    let asked = options.blocks.map(NonZeroUsize::get);
    // Any α below −max ω asks for the empty shape, and doubles hold one.
    let largest = sites.weights().iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let alpha = power_alpha(options).squared().max(-2.0 * largest.abs() - 1.0);
    let plan = if options.exterior || alpha.is_infinite() {
        Plan::whole(sites)
    } else {
        let reach = Reach::at(sites, alpha, largest);
        Plan::new(sites, reach, maker, Limits { blocks: asked, memory: options.memory })?
    };
    let lattice = lattice(sites.positions(), sites.weights(), sites.torus());
    let question = Question { alpha, lattice, exterior: options.exterior, maker };
    let answer = blocks::run(sites, &plan, &question)?;
    let boundary = Some((answer.b0, Sheets::of(&answer), answer.sheet_windings));
    let duplicates = sites.duplicates().to_vec();
    Ok(Found { complex: answer.complex, boundary, hidden: answer.hidden, duplicates, direct: None })
}

/// The parameter at which the power weights are judged.
fn power_alpha(options: &ShapeOptions) -> Alpha {
    match options.balls {
        Balls::Power => options.alpha,
        Balls::Radius => Alpha::ZERO,
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

/// Sites that are not vertices. Both lists ascend.
fn hidden(sites: &[u32], vertices: &Simplices<1>) -> Vec<u32> {
    let mut vertices = vertices.rows().iter().peekable();
    sites.iter().copied().filter(|&site| vertices.next_if(|v| v[0] == site).is_none()).collect()
}

/// A shape as others found it, in canonical order.
pub(crate) struct Assembled {
    pub points: WeightedPoints,
    pub coordinates: Coordinates,
    pub options: ShapeOptions,
    pub complex: Complex,
    pub hidden: Option<Vec<u32>>,
    pub betti: Betti,
    pub sheets: Sheets,
    pub measures: Measures,
}

impl AlphaShape {
    /// A shape that is all known already, of points no two of which are at one place.
    ///
    /// # Errors
    /// A negative radius.
    pub(crate) fn assembled(parts: Assembled) -> Result<Self, ShapeError> {
        let Assembled { points, coordinates, options, complex, hidden, .. } = parts;
        let squared = match options.balls {
            Balls::Power => None,
            Balls::Radius => Some(squared_radii(&points.weights, options.alpha)?),
        };
        Ok(Self {
            points,
            coordinates,
            options,
            squared,
            complex,
            copies: Vec::new(),
            duplicates: Vec::new(),
            hidden,
            betti: Some(parts.betti),
            sheets: Some(parts.sheets),
            measures: parts.measures,
        })
    }

    /// The shape of the same points with the same power weights at another α, which the caller has
    /// found within this one's triangulation.
    pub(crate) fn at(&self, alpha: Alpha, exterior: bool, complex: Complex, betti: Betti) -> Self {
        let measures = Measures::of(&complex, &self.points.positions, self.options.periodic);
        Self {
            points: self.points.clone(),
            coordinates: self.coordinates,
            options: ShapeOptions { alpha, exterior, ..self.options },
            squared: self.squared.clone(),
            complex,
            copies: Vec::new(),
            duplicates: self.duplicates.clone(),
            hidden: self.hidden.clone(),
            betti: Some(betti),
            sheets: None,
            measures,
        }
    }

    /// The same shape, said to stand in these coordinates. Numbers stay what they are.
    #[must_use]
    pub fn meaning(self, coordinates: Coordinates) -> Self {
        Self { coordinates, ..self }
    }

    /// What the coordinates of the points mean, as far as it is known.
    pub fn coordinates(&self) -> Coordinates {
        self.coordinates
    }

    /// The points as they were given, duplicates and hidden ones included; of a torus, in its box.
    pub fn points(&self) -> &WeightedPoints {
        &self.points
    }

    /// The places of a simplex's vertices; on a torus the first is in the box, and the others are the
    /// copies nearest to it.
    pub fn corners<const N: usize>(&self, row: [u32; N]) -> [[f64; 3]; N] {
        together(self.options.periodic, row.map(|v| self.points.positions[v as usize]))
    }

    /// What points are copies of, in a shape that is [laid out](Self::unwrapped): of the last points, in
    /// their order.
    pub fn copies(&self) -> &[u32] {
        &self.copies
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
    pub fn power_alpha(&self) -> Alpha {
        power_alpha(&self.options)
    }

    /// What the shape claims to be, for the checker to judge; of a torus, as a part of a
    /// [`PlacedComplex`](walpha_check::schema::PlacedComplex) that says so.
    pub fn claim(&self) -> Claim<'_> {
        let (positions, weights) = (&self.points.positions, self.power_weights());
        Claim::new(Placed::new(positions, weights, self.power_alpha(), &self.complex))
            .with_hidden(self.hidden())
            .with_duplicates(self.duplicates())
    }

    /// The simplices and their classes, in canonical order; exterior ones only if asked for.
    pub fn complex(&self) -> &Complex {
        &self.complex
    }

    /// Pairs of input indices: a point that went, and the one at the same place that stayed.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// Points that are not vertices of the regular triangulation, ascending; `None` when the engine
    /// did not see the whole triangulation.
    pub fn hidden(&self) -> Option<&[u32]> {
        self.hidden.as_deref()
    }

    /// Betti numbers of the shape; `None` when the engine cannot know them.
    pub fn betti(&self) -> Option<Betti> {
        self.betti
    }

    /// The sheets that boundary facets and singular edges are part of; `None` when the engine does
    /// not know them ([`Engine::Reference`]).
    pub fn sheets(&self) -> Option<&Sheets> {
        self.sheets.as_ref()
    }

    /// Volume and areas.
    pub fn measures(&self) -> &Measures {
        &self.measures
    }

    /// How many points are vertices of the shape.
    pub fn points_in_shape(&self) -> usize {
        self.complex.vertices.counts().in_shape()
    }
}
