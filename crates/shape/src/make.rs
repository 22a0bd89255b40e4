use std::num::NonZeroUsize;

use walpha_base::parallel::in_pool;
use walpha_base::parallel::prelude::*;
use walpha_base::{Coordinates, Monitor};
use walpha_regular::internals::{Scaled, Sites, check_numbers, lattice};
use walpha_regular::{SitesError, Torus};

use super::agreement::agree;
use super::blocks::{self, BlockParams, Limits, Plan, Reach};
use super::derived::Derived;
use super::flat::{FlatShape, flat, flat_on_torus};
use super::ladder::Filtration;
use super::topology::{components, connected_on_torus, sheet_betti, torus_betti};
use super::{
    Alpha, AlphaShape, Balls, Betti, CgalError, Classifier, Complex, Engine, ShapeError,
    ShapeOptions, Sheets, Simplices, WeightedPoints,
};

/// The alpha shape of weighted points.
///
/// The shape owns its points: a `Vec` or [`WeightedPoints`] are taken over, and borrowed points are copied, 24 bytes each.
///
/// Of points with equal positions, the heaviest is kept ([`AlphaShape::duplicates`]). An empty shape is a result, not an error.
/// At α = ∞ the shape is the convex hull.
///
/// Points in one plane or on one line, which is decided exactly, have their shape there: there are no cells, a simplex of the
/// shape is singular if it is not a face of another one, otherwise regular, and none is interior. Ties are broken as in space.
/// [`AlphaShape::outline`] has the classes of the plane, and polygons. Such a shape is computed in one block, regardless of the
/// options.
///
/// With [`ShapeOptions::periodic`] the shape is that of a torus. Its points are the given ones, moved into the box and rounded as
/// in [`Torus::wrap`](super::Torus::wrap). A simplex of the torus is listed once, by the input indices of its vertices. Its
/// copies in space are those in which all other vertices are nearer to the first than half of the box, along each axis
/// ([`AlphaShape::corners`]). If 4 √(α + max ω) is less than the shortest side, no edge is longer. In a smaller box an edge may be longer; rows then
/// name copies of points ([`AlphaShape::copies`]), and the shape is taken from the filtration of several copies of the box. At α = ∞ the shape is the whole torus.
///
/// # Errors
/// [`CgalError::Absent`] for [`Engine::Cgal`] without a [classifier](ShapeOptions::classifier), and other errors of that engine; numbers that are not finite or too large, no
/// points, and with [`ShapeOptions::refuse_flat`] points that span no volume: see
/// [`SitesError`](walpha_regular::SitesError); a negative radius: [`ShapeError::Radius`]; incompatible options:
/// [`ShapeOptions::check`]. [`ShapeError::Cancelled`], once a [`Monitor`] that watches is cancelled; the engine of another
/// crate cannot be interrupted.
pub fn alpha_shape(
    points: impl Into<WeightedPoints>,
    options: &ShapeOptions,
) -> Result<AlphaShape, ShapeError> {
    let monitor = &*Monitor::current();
    let points = points.into();
    in_pool(points.len(), || {
        let Some(torus) = options.periodic else { return in_large_box(points, options, monitor) };
        match in_large_box(points.clone(), options, monitor) {
            Err(ShapeError::Wraps { .. }) => in_small_box(torus, points, *options, monitor),
            found => found,
        }
    })
}

/// The shape in space, or in a box in which no edge of it spans half of a vector.
pub(crate) fn in_large_box(
    points: WeightedPoints,
    options: &ShapeOptions,
    monitor: &Monitor,
) -> Result<AlphaShape, ShapeError> {
    let options = match options.engine {
        Engine::Auto => options.engine(Engine::Native),
        _ => *options,
    };
    if options.engine == Engine::Both {
        options.check()?;
        let by = |engine| {
            let options = options.engine(engine);
            monitor.watch(|| alpha_shape(points.clone(), &options))
        };
        let (native, cgal) = (by(Engine::Native)?, by(Engine::Cgal)?);
        agree(cgal.complex(), native.complex())?;
        return Ok(native.by(Engine::Both));
    }
    if options.engine == Engine::Cgal {
        options.check()?;
        let Classifier(classify) = options.classifier.ok_or(CgalError::Absent)?;
        return alpha_shape_by(points, &options, classify, monitor);
    }
    let find = |sites: &Sites<'_>, options: &ShapeOptions| by_blocks(sites, options, monitor);
    shape_by(points, options, &find, monitor)
}

/// [`alpha_shape`] by the engine of another crate: components, topology and measures are computed from its complex.
pub(crate) fn alpha_shape_by(
    points: WeightedPoints,
    options: &ShapeOptions,
    classify: impl Fn(&Sites<'_>, f64) -> Result<Complex, ShapeError>,
    monitor: &Monitor,
) -> Result<AlphaShape, ShapeError> {
    let find = |sites: &Sites<'_>, options: &ShapeOptions| {
        monitor.check()?;
        let complex = classify(sites, options.power_alpha().squared())?;
        let hidden = Some(hidden(sites.input(), &complex.vertices));
        let boundary = Some((components(&complex), Sheets::of_whole(&complex), 0));
        let duplicates = sites.duplicates().to_vec();
        Ok(Found { complex, boundary, hidden, duplicates, betti: None })
    };
    shape_by(points, *options, &find, monitor)
}

/// An engine: computes the shape of sites that span a volume.
pub(crate) type Find<'a> = dyn Fn(&Sites<'_>, &ShapeOptions) -> Result<Found, ShapeError> + 'a;

/// The shape of points as an engine finds it; of points that span no volume, the shape that they have in their plane.
pub(crate) fn shape_by(
    mut points: WeightedPoints,
    mut options: ShapeOptions,
    find: &Find<'_>,
    monitor: &Monitor,
) -> Result<AlphaShape, ShapeError> {
    options.check()?;
    if let Some(torus) = options.periodic {
        check_numbers(&points.positions, &points.weights)?;
        let torus = torus.holding(&points.positions)?;
        options.periodic = Some(torus);
        points.positions.par_iter_mut().coarse().for_each(|place| *place = torus.wrap(*place));
    }
    if let Some(values) = points.values()
        && let Some(index) = values.iter().position(|value| !value.is_finite())
    {
        let (what, value, limit) = ("value", values[index], f64::MAX);
        return Err(SitesError::Value { index, what, value, limit }.into());
    }
    let squared = options.balls.power_weights(&points.weights, options.alpha)?;
    let weights = squared.as_deref().unwrap_or(&points.weights);
    // The shape is computed from the points at another scale, with the power weights.
    let alpha = options.power_alpha();
    let scaled = Scaled::of(&points.positions, weights).filter(|_| options.periodic.is_none());
    let scaled = scaled.and_then(|scaled| {
        let alpha = Alpha::from_squared(scaled.square(alpha.squared())?).ok()?;
        Some((alpha, scaled))
    });
    let (alpha, positions, weights) = match &scaled {
        Some((alpha, scaled)) => (*alpha, &scaled.positions[..], &scaled.weights[..]),
        None => (alpha, &points.positions[..], weights),
    };
    let params = options.balls(Balls::Power).alpha(alpha);
    let found = match in_space(positions, weights, &params, find) {
        Err(error) if !options.refuse_flat && error.is_flat() => {
            options.engine = Engine::Native;
            in_plane(positions, weights, &params, monitor)?
        }
        found => found?,
    };
    drop(scaled);
    let Found { mut complex, boundary, hidden, duplicates, betti } = found;
    // Only a whole triangulation has exterior simplices.
    if hidden.is_some() && !options.exterior {
        complex.retain_shape();
    }
    let hidden = hidden.filter(|_| options.exterior || options.hidden);
    let counted = boundary.as_ref().map(|(b0, sheets, windings)| match options.periodic {
        None => sheet_betti(&complex, *b0, sheets),
        Some(torus) => {
            let place = |v: u32| points.positions[v as usize];
            let wound = connected_on_torus(&complex, |[a, b]| {
                [(a, [0; 3]), (b, torus.windings(place(a), place(b)))]
            });
            torus_betti(&complex, wound.directions().rank(), sheets, *windings)
        }
    });
    Ok(AlphaShape {
        points,
        coordinates: Coordinates::default(),
        options,
        squared,
        complex,
        copies: Vec::new(),
        shifts: Vec::new(),
        voxels: None,
        kept: None,
        isovalue: None,
        duplicates,
        hidden,
        betti: betti.or(counted),
        sheets: boundary.map(|(_, sheets, _)| sheets),
        sums: Derived::default(),
        solid: Derived::default(),
        outline: Derived::default(),
    })
}

/// The shape in a box that is so small that an edge spans half of it or more, taken from the filtration.
fn in_small_box(
    torus: Torus,
    points: WeightedPoints,
    options: ShapeOptions,
    monitor: &Monitor,
) -> Result<AlphaShape, ShapeError> {
    let squared = options.balls.power_weights(&points.weights, options.alpha)?;
    let weights = squared.as_ref().unwrap_or(&points.weights).clone();
    let power = WeightedPoints { positions: points.positions, weights, values: None };
    let filtration = monitor.watch(|| Filtration::of_small_box(torus, power))?;
    let shape = filtration.shape_with(options.power_alpha(), options.exterior);
    Ok(shape.of_points(points.weights, points.values, squared, options))
}

/// The result of an engine.
pub(crate) struct Found {
    pub complex: Complex,
    /// The number of components, the sheets of the boundary, and the number of independent directions in which the
    /// sheets wind round a torus; `None` for flat shapes.
    pub boundary: Option<(u64, Sheets, usize)>,
    /// Hidden sites, where the engine computed the whole triangulation.
    pub hidden: Option<Vec<u32>>,
    pub duplicates: Vec<[u32; 2]>,
    /// Betti numbers, where they are not counted by sheets.
    pub betti: Option<Betti>,
}

fn in_space(
    positions: &[[f64; 3]],
    weights: &[f64],
    options: &ShapeOptions,
    find: &Find<'_>,
) -> Result<Found, ShapeError> {
    let sites = match options.periodic {
        None => Sites::new(positions, weights)?,
        Some(torus) => Sites::on_torus(positions, weights, torus)?,
    };
    find(&sites, options)
}

/// The shape of points that span no volume.
fn in_plane(
    positions: &[[f64; 3]],
    weights: &[f64],
    options: &ShapeOptions,
    monitor: &Monitor,
) -> Result<Found, ShapeError> {
    let alpha = options.power_alpha().squared();
    let (sites, shape) = match options.periodic {
        None => {
            let sites = Sites::any(positions, weights)?;
            let shape = flat(&sites, alpha, monitor)?;
            (sites, shape)
        }
        Some(torus) => {
            let sites = Sites::on_torus(positions, weights, torus)?;
            let listed = options.exterior || options.hidden;
            let shape = flat_on_torus(&sites, torus, alpha, listed, monitor)?;
            (sites, shape)
        }
    };
    let FlatShape { complex, betti } = shape;
    let hidden = Some(hidden(sites.input(), &complex.vertices));
    let duplicates = sites.duplicates().to_vec();
    Ok(Found { complex, boundary: None, hidden, duplicates, betti: Some(betti) })
}

fn by_blocks(
    sites: &Sites<'_>,
    options: &ShapeOptions,
    monitor: &Monitor,
) -> Result<Found, ShapeError> {
    let asked = options.blocks.map(NonZeroUsize::get);
    // Below −max ω the shape is empty: this is a finite α below that.
    let largest = sites.weights().iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let alpha = options.power_alpha().squared().max(-2.0 * largest.abs() - 1.0);
    // The whole triangulation of a torus comes with its exterior simplices only.
    let exterior = options.exterior || (options.hidden && sites.torus().is_some());
    let plan = if exterior || options.hidden || alpha.is_infinite() {
        Plan::whole(sites)
    } else {
        let reach = Reach::at(sites, alpha, largest);
        Plan::new(sites, reach, Limits { blocks: asked, memory: options.memory })?
    };
    plan.afford(sites.input().len())?;
    let lattice = lattice(sites.positions(), sites.weights(), sites.torus());
    let params = BlockParams { alpha, lattice, exterior };
    let merged = blocks::run(sites, &plan, &params, monitor)?;
    let sheets = Sheets::numbered(&merged.complex, &merged.facet_sheets, &merged.edge_sheets);
    let boundary = Some((merged.b0, sheets, merged.sheet_windings));
    let duplicates = sites.duplicates().to_vec();
    Ok(Found { complex: merged.complex, boundary, hidden: merged.hidden, duplicates, betti: None })
}

/// The sites that are not vertices. Both lists ascend.
fn hidden(sites: &[u32], vertices: &Simplices<1>) -> Vec<u32> {
    let mut vertices = vertices.rows().iter().peekable();
    sites.iter().copied().filter(|&site| vertices.next_if(|v| v[0] == site).is_none()).collect()
}
