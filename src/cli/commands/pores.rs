//! `walpha pores`: the spheres that fit into a periodic box, and how far they get.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use clap::Args;
use serde::Serialize;
use walpha_base::shown::{counted, rounded, rounded_within};

use crate::balls::{Bounded, FreeSphere, PeriodicBalls, ProbedPores};
use crate::cli::commands::pipeline;
use crate::cli::options::global::Global;
use crate::cli::options::{self, Declared, InputArgs, Periodic, WithAlpha};
use crate::cli::process::errors::{CommandError, Result, command_error, fail, fail_usage, option};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::{MovedIntoBox, SCHEMA_VERSION, ending};
use crate::pipeline::{AlphaRule, Input, Origin, PeriodicBox, Values};
use crate::progress::Stage;
use crate::shape::Torus;
use crate::{Alpha, Coordinates, WeightedPoints};

/// Find the pores of a periodic box: the largest spheres between its balls, channels and pockets.
///
/// For a crystal, a zeolite, a foam or a packing whose points repeat: the largest sphere that fits, the largest one that can move from a place to another
/// copy of it (also along each vector of the box), and the largest that fits on its way. With --probe R, also the number of channels that a sphere of
/// radius R can pass through, and in how many directions; the pockets that it cannot leave; and the share of the box that its centre can reach.
/// Points without radii are balls of radius 0. The box is the cell that the file states, unless --periodic gives another.
///
/// Examples:
///
/// walpha pores zeolite.cif --probe 1.2   # for helium
///
/// walpha pores foam.csv --periodic 20,20,20   # points of radius 0
///
/// walpha pores mof.xyz --radii none --json   # between the centres
#[derive(Args)]
pub(crate) struct Pores {
    /// The radius of a sphere, in the unit of the points: 1.2 for an atom of helium or 1.86 for a molecule of nitrogen in Å.
    #[arg(long, value_name = "R", value_parser = options::not_negative)]
    probe: Option<f64>,
    // What `input` refuses comes after it, as what comes before is no longer there when it looks.
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    weights: Declared<WithAlpha>,
    #[command(flatten)]
    periodic: Declared<Periodic>,
}

impl Pores {
    pub(crate) fn run(self, global: Global) -> Result<()> {
        let input = &self.input;
        let recipe = input.recipe()?;
        let periodic = recipe.periodic.unwrap_or(PeriodicBox::Stated);
        let recipe = recipe.periodic(periodic);
        let mut progress = Progress::new(global);
        let read = pipeline::read(input, &recipe, &mut progress)?;
        pipeline::accept(&read, input)?;
        let Input::Points(points, metadata) = read else {
            fail_usage!("{} holds a volume, and pores are between points", name(&input.input) => "give a crystal, or a table of points");
        };
        let molecule = points.molecule.clone();
        let alpha = match recipe.alpha {
            AlphaRule::Given(alpha) => alpha,
            AlphaRule::Default => Alpha::ZERO,
            _ => {
                fail_usage!("--alpha finds α for a shape, and here it is the squared radius of all balls" => "give a number, or omit it")
            }
        };
        // α is settled, so nothing looks for it.
        let recipe = recipe.alpha(AlphaRule::Given(alpha));
        let weigh = || recipe.weigh(Input::Points(points, metadata), Values::Written);
        let (weighed, _) = progress.watch(weigh)?;
        let Origin { coordinates, torus, folded, .. } = weighed.origin;
        let torus = torus.expect("the box was asked for");
        let Some(box_volume) = torus.volume() else {
            fail!("pores are of boxes that repeat along all three vectors, and this one does not" => "measure the voids of its balls: walpha balls FILE -o voids.csv");
        };
        let balls = balls_of(weighed.points, alpha, torus)?;
        let found = progress.watch(|| {
            Stage::Filtration.begin()?;
            balls.pores()
        })?;
        let probed = self.probe.map(|radius| {
            let found = progress.watch(|| {
                Stage::Measure.begin()?;
                balls.probed(radius)
            });
            Ok::<_, CommandError>(Probe::of(radius, found?))
        });
        let radii = balls.radii().iter().copied();
        let range = [f64::min, f64::max].map(|of| radii.clone().reduce(of).unwrap_or_default());
        let summary = PoresSummary {
            schema_version: SCHEMA_VERSION,
            input: input.input.to_string(),
            molecule: molecule.map(|molecule| molecule.summary().with_names(option)),
            points: balls.radii().len(),
            folded,
            coordinates,
            box_volume,
            vectors: torus.vectors(),
            radii: range,
            pores: Spheres {
                included: found.included.into(),
                free: found.free.into(),
                free_along: found.free_along.map(Sphere::from),
                included_along_free: found.included_along_free.into(),
            },
            probe: probed.transpose()?,
            seconds: progress.finish().into_iter().collect(),
        };
        print_summary(global, &summary)
    }
}

/// The balls of points at α.
fn balls_of(points: WeightedPoints, alpha: Alpha, torus: Torus) -> Result<PeriodicBalls> {
    let (positions, weights, _) = points.into_parts();
    let mut radii = Vec::with_capacity(weights.len());
    for (row, weight) in weights.iter().enumerate() {
        let squared = alpha.squared() + weight;
        if squared < 0.0 {
            return Err(
                command_error!("point {row} has a negative squared radius, {squared}" => "give weights that are squares of radii, or a larger --alpha"),
            );
        }
        radii.push(squared.sqrt());
    }
    Ok(PeriodicBalls::new(torus, positions, radii)?)
}

#[derive(Serialize)]
struct PoresSummary {
    schema_version: u32,
    input: String,
    /// The atoms, in words; null unless INPUT is a molecule.
    molecule: Option<String>,
    points: usize,
    /// Points outside the periodic box that were moved into it.
    folded: Option<usize>,
    /// The unit of lengths.
    coordinates: Coordinates,
    box_volume: f64,
    /// The vectors of the box, reduced, as rows.
    vectors: [[f64; 3]; 3],
    /// The smallest and the largest radius.
    radii: [f64; 2],
    pores: Spheres,
    probe: Option<Probe>,
    seconds: BTreeMap<&'static str, f64>,
}

#[derive(Clone, Copy, Serialize)]
struct Spheres {
    /// The largest.
    included: Sphere,
    /// The largest that can move to another copy of its place: the narrowest place on its way.
    free: Sphere,
    /// The same along each vector of the box.
    free_along: [Sphere; 3],
    /// The largest on the way of the free one.
    included_along_free: Sphere,
}

/// A sphere that touches balls.
#[derive(Clone, Copy, Serialize)]
struct Sphere {
    /// Negative where the balls leave no way.
    diameter: f64,
    center: [f64; 3],
}

impl From<FreeSphere> for Sphere {
    fn from(FreeSphere { diameter, center }: FreeSphere) -> Self {
        Self { diameter, center }
    }
}

#[derive(Serialize)]
struct Probe {
    radius: f64,
    /// In how many independent directions each channel winds round the box.
    channels: Vec<usize>,
    /// Parts of the pores without a way out.
    pockets: usize,
    /// The share of the box in which the centre of the probe can be, of channels and pockets together.
    void_fraction: f64,
    void_fraction_bound: f64,
}

impl Probe {
    fn of(radius: f64, found: ProbedPores) -> Self {
        let ProbedPores { channels, pockets, void_fraction, .. } = found;
        let Bounded { value, bound } = void_fraction;
        Self { radius, channels, pockets, void_fraction: value, void_fraction_bound: bound }
    }
}

impl Display for PoresSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.coordinates.unit.symbol();
        writeln!(f, "input     {}", name(&self.input))?;
        if let Some(molecule) = &self.molecule {
            writeln!(f, "molecule  {molecule}")?;
        }
        let points = counted(self.points as u64, "ball");
        writeln!(f, "balls     {points}{}", MovedIntoBox(self.folded))?;
        let [least, most] = self.radii.map(rounded);
        let range =
            if self.radii[0] == self.radii[1] { least } else { format!("{least} to {most}") };
        writeln!(f, "radii     {range} {unit}")?;
        writeln!(f, "box       {} {unit}³; spheres by diameter:", rounded(self.box_volume))?;
        let Spheres { included, free, free_along, included_along_free } = self.pores;
        let extent = self.vectors.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let at = included.center.map(|x| rounded_within(x, extent)).join(", ");
        writeln!(f, "included  {}, at {at}", included.words(unit))?;
        let [a, b, c] = free_along.map(|sphere| sphere.words(unit));
        writeln!(f, "free      {}; along a {a}, b {b}, c {c}", free.words(unit))?;
        // Without a sphere that is free there is no path.
        if free.diameter > 0.0 {
            writeln!(
                f,
                "on path   {}: the largest sphere along the path of the free one",
                included_along_free.words(unit)
            )?;
        }
        if let Some(Probe { radius, channels, pockets, void_fraction, .. }) = &self.probe {
            let dimensions: Vec<String> =
                channels.iter().map(|dimension| format!("{dimension}-dimensional")).collect();
            let channels = match dimensions.len() {
                0 => "no channel".to_owned(),
                count => {
                    format!("{} ({})", counted(count as u64, "channel"), dimensions.join(", "))
                }
            };
            let (radius, share) = (rounded(*radius), rounded(100.0 * void_fraction));
            let pockets = counted(*pockets as u64, "pocket");
            writeln!(
                f,
                "probe     radius {radius} {unit}: {channels}, {pockets} without a way out; its centre can be in {share} % of the box"
            )?;
        }
        ending(f, &[], &["read", "points", "filtration", "measure", "total"], &self.seconds)
    }
}

impl Sphere {
    /// Its diameter.
    fn words(&self, unit: &str) -> String {
        if self.diameter > 0.0 {
            format!("{} {unit}", rounded(self.diameter))
        } else {
            "none".into()
        }
    }
}
