//! `walpha balls`: the union of the balls of points, of atoms above all.

mod outputs;
mod tables;

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use walpha_base::shown::rounded;

use crate::balls::{BallUnion, BallsError, Cavity, DiscUnion, Pocket, with_probe};
use crate::cli::commands::pipeline;
use crate::cli::options::global::Global;
use crate::cli::options::picture::SightArgs;
use crate::cli::options::{self, Declared, InputArgs, OutputArgs, Periodic, WithAlpha};
use crate::cli::process::errors::{Result, fail_usage, option};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::{MovedIntoBox, SCHEMA_VERSION, certain, ending};
use crate::export::{Content, Target, write_all};
use crate::pipeline::{AlphaRule, Input, Origin, Values};
use crate::points::Molecule;
use crate::progress::Stage;
use crate::shape::{Betti, Engine, ShapeOptions};
use crate::{Alpha, AlphaShape, Coordinates};
use outputs::{Looks, Output};
use tables::Table;

/// Measure the union of balls: volume and area, those of each ball, contacts, voids and pockets.
///
/// A point with a radius is a ball: an atom of a molecule (PDB, mmCIF, PQR, GRO, XYZ), or a row of a table with a column radius. Volumes
/// and areas are those of the balls, not of tetrahedra. Each has a bound on its error; the report prints six digits, or those that are
/// certain, --json all. With --probe R all radii grow by R: the area is then the solvent-accessible surface of a molecule.
///
/// Examples:
///
/// walpha balls 1crn.pdb   # volume, area, pockets
///
/// walpha balls 1crn.pdb --probe 1.4 -o atoms.csv residues.csv   # accessible to water
///
/// walpha balls 1hvr.cif --hetero -o pockets.csv pockets.pdb   # with its ligand
///
/// walpha balls 1crn.pdb -o surface.ply picture.png   # surface and picture
///
/// walpha balls foam.csv --periodic 20,20,20 -o contacts.csv   # a periodic box
#[derive(Args)]
pub(crate) struct Balls {
    #[arg(
        short,
        long,
        value_name = "FILE",
        num_args = 1..,
        help = "Files to write. Tables, named by their content: residues.csv, contacts.csv, voids.csv, pockets.csv; any other .csv has a row for each ball, as atoms.csv; pockets.pdb has the atoms at pockets, with the number of the pocket as temperature factor. Names may begin with anything, as in 1crn-pockets.csv. The surface of the union: .ply and .vtp, whose facets have the number of their ball, or .stl. A picture of the balls, coloured by element: .png"
    )]
    output: Vec<PathBuf>,
    /// Add this length to all radii: the radius of a probe that rolls over the balls, as in 1.4 for water in Å.
    #[arg(long, value_name = "R", value_parser = options::not_negative)]
    probe: Option<f64>,
    // What `input` refuses comes after it, as what comes before is no longer there when it looks.
    #[command(flatten)]
    input: InputArgs,
    /// How far a facet of a surface may be from the sphere of its ball, as a part of the radius [default: 0.01].
    #[arg(long, value_name = "PART", value_parser = tolerance, help_heading = "Surfaces (.ply, .stl, .vtp)")]
    tolerance: Option<f64>,
    #[command(flatten)]
    weights: Declared<WithAlpha>,
    #[command(flatten)]
    periodic: Declared<Periodic>,
    #[command(flatten)]
    format: OutputArgs,
    #[command(flatten)]
    sight: SightArgs,
}

/// Parses a tolerance of surfaces.
fn tolerance(text: &str) -> Result<f64> {
    let tolerance = options::not_negative(text)?;
    if !BallUnion::SURFACE_TOLERANCES.contains(&tolerance) {
        return Err(BallsError::Tolerance { tolerance }.into());
    }
    Ok(tolerance)
}

impl Balls {
    /// The outputs. Refuses options that none of them uses.
    fn targets(&self) -> Result<Vec<(Target, Output)>> {
        self.format.check(self.output.iter())?;
        let mut targets = Vec::new();
        for path in &self.output {
            let output = Output::of(&self.format.named(path)?, path)?;
            targets.push((Target::open(path)?, output));
        }
        let typed = &self.input.typed;
        if !has_output(&targets, Output::Picture) {
            typed.refuse(&SightArgs::NAMES, "no picture (.png) is written")?;
        }
        if !targets.iter().any(|(_, output)| output.is_surface()) {
            typed.refuse(&["tolerance"], "no surface (.ply, .stl, .vtp) is written")?;
        }
        Ok(targets)
    }

    pub(crate) fn run(self, global: Global) -> Result<()> {
        let targets = self.targets()?;
        let has_table = |table| has_output(&targets, Output::Table(table));
        let input = &self.input;
        let recipe = input.recipe()?;
        let is_periodic = recipe.periodic.is_some();
        if is_periodic {
            refuse_on_torus(&targets)?;
        }
        let mut progress = Progress::new(global);
        let read = pipeline::read(input, &recipe, &mut progress)?;
        pipeline::accept(&read, input)?;
        let Input::Points(points, metadata) = read else {
            fail_usage!("{} holds a volume, whose samples have no radii", name(&input.input) => "give a molecule, or a table with the columns x, y, z and radius");
        };
        let molecule = points.molecule.clone();
        if molecule.is_none() && has_table(Table::Residues) {
            fail_usage!("{} is not a molecule, and has no residues", name(&input.input) => "write balls.csv");
        }
        let has_weights = points.weights.is_some() || recipe.weighting.is_some();
        let alpha = match recipe.alpha {
            AlphaRule::Given(alpha) => alpha,
            AlphaRule::Default if has_weights => Alpha::ZERO,
            AlphaRule::Default => {
                fail_usage!("{} has no radii", name(&input.input) => "give a table with a column radius, or one radius for all points, as in --alpha-radius 1.5")
            }
            _ => {
                fail_usage!("--alpha finds α for a shape, and balls have given radii" => "give a number, or omit it")
            }
        };
        // α is settled, so nothing looks for it.
        let recipe = recipe.alpha(AlphaRule::Given(alpha));
        let weigh = || recipe.weigh(Input::Points(points, metadata), Values::Written);
        let (weighed, _) = progress.watch(weigh)?;
        let Origin { coordinates, torus, folded, .. } = weighed.origin;
        // A periodic box is triangulated as a whole only where voids are asked for: that takes short edges.
        let exterior = !is_periodic || has_table(Table::Voids);
        let (points, alpha) = with_probe(weighed.points, alpha, self.probe.unwrap_or_default())?;
        let shape = progress.stage(Stage::Shape, || {
            let options = ShapeOptions::new(alpha).engine(Engine::Native).exterior(exterior);
            crate::alpha_shape(points, &options.periodic(torus))
        })?;
        let measured =
            progress.stage(Stage::Measure, || Measured::of(&shape, molecule.is_none()))?;
        let is_surface = targets.iter().any(|(_, output)| output.is_surface());
        let surface = is_surface.then(|| {
            let tolerance = self.tolerance.unwrap_or(BallUnion::SURFACE_TOLERANCE);
            let surface = progress.stage(Stage::Measure, || measured.union.surface(tolerance))?;
            Ok::<_, BallsError>((surface, tolerance))
        });
        let looks = Looks {
            surface: surface.transpose()?,
            sight: self.sight,
            input: &input.input.to_string(),
        };
        let squared = || shape.power_weights().iter().map(|weight| alpha.squared() + weight);
        let none = squared().filter(|&squared| squared < 0.0).count();
        if none > 0 {
            let all = shape.points().len();
            tracing::warn!(
                "{none} of {all} points have a squared radius, α + weight, below 0: there is no ball of theirs"
            );
        }
        let radii: Vec<f64> = squared().map(|squared| squared.max(0.0).sqrt()).collect();
        let subject = Subject {
            shape: &shape,
            radii: &radii,
            molecule: molecule.as_ref(),
            measured: &measured,
        };
        progress.stage(Stage::Write, || {
            write_all(targets.into_iter().map(|(target, output)| {
                let (subject, looks) = (&subject, &looks);
                let content = move |out: &mut dyn Write| output.write(subject, looks, out);
                (target, Box::new(content) as Content<'_>)
            }))
        })?;
        let summary = BallsSummary {
            schema_version: SCHEMA_VERSION,
            input: input.input.to_string(),
            molecule: molecule.map(|molecule| molecule.summary().with_names(option)),
            points: shape.own_points(),
            duplicates: shape.duplicates().len(),
            hidden: shape.hidden().map_or(0, <[u32]>::len),
            folded,
            coordinates,
            radii: radii
                .iter()
                .copied()
                .reduce(f64::min)
                .zip(radii.iter().copied().reduce(f64::max)),
            probe: self.probe,
            balls: Numbers::of(&shape, &measured),
            files: self.output.iter().map(|path| path.display().to_string()).collect(),
            seconds: progress.finish().into_iter().collect(),
        };
        print_summary(global, &summary)
    }
}

fn has_output(targets: &[(Target, Output)], wanted: Output) -> bool {
    targets.iter().any(|&(_, output)| output == wanted)
}

/// Refuses outputs that a periodic box does not have.
fn refuse_on_torus(targets: &[(Target, Output)]) -> Result<()> {
    if targets.iter().any(|(_, output)| output.is_surface()) {
        fail_usage!("the sides of a periodic box would cut the surface open" => "omit --periodic, or write tables");
    }
    if targets.iter().any(|(_, output)| output.needs_pockets()) {
        fail_usage!("pockets are not measured in a periodic box" => "write voids.csv, or omit --periodic");
    }
    Ok(())
}

/// What is measured of balls.
struct Measured<'a> {
    union: BallUnion<'a>,
    /// Empty in a periodic box, unless they are asked for.
    voids: Vec<Cavity>,
    /// Largest first, voids included; empty in a periodic box.
    pockets: Vec<Pocket>,
    /// Of points in one plane.
    discs: Option<DiscUnion<'a>>,
}

impl<'a> Measured<'a> {
    /// The measures of balls, and if they may be discs and lie in one plane, those of discs.
    fn of(shape: &'a AlphaShape, may_be_discs: bool) -> Result<Self> {
        let union = BallUnion::new(shape)?;
        // Points in a plane enclose nothing.
        let encloses = shape.options().exterior && !shape.complex().cells.is_empty();
        let voids = if encloses { union.voids()? } else { Vec::new() };
        let is_open = encloses && shape.options().periodic.is_none();
        let pockets = if is_open { union.pockets()? } else { Vec::new() };
        let discs = match DiscUnion::new(shape) {
            _ if !may_be_discs => None,
            Err(BallsError::Solid | BallsError::Periodic) => None,
            discs => Some(discs?),
        };
        Ok(Self { union, voids, pockets, discs })
    }
}

/// What tables are made of.
struct Subject<'a> {
    shape: &'a AlphaShape,
    /// Of the balls, by input index; 0 where there is no ball.
    radii: &'a [f64],
    molecule: Option<&'a Molecule>,
    measured: &'a Measured<'a>,
}

#[derive(Serialize)]
struct BallsSummary {
    schema_version: u32,
    input: String,
    /// The atoms, in words; null unless INPUT is a molecule.
    molecule: Option<String>,
    points: usize,
    duplicates: usize,
    hidden: usize,
    /// Points outside the periodic box that were moved into it; absent without a box.
    #[serde(skip_serializing_if = "Option::is_none")]
    folded: Option<usize>,
    /// The unit of lengths: areas are in its square, volumes in its cube.
    coordinates: Coordinates,
    /// The smallest and the largest radius, with the probe's.
    radii: Option<(f64, f64)>,
    probe: Option<f64>,
    balls: Numbers,
    files: Vec<String>,
    seconds: BTreeMap<&'static str, f64>,
}

/// The measures of the union. The true number is within the bound of each.
#[derive(Serialize)]
struct Numbers {
    volume: f64,
    volume_bound: f64,
    area: f64,
    area_bound: f64,
    /// 4πr for one ball.
    mean_curvature: f64,
    mean_curvature_bound: f64,
    /// 4π times the Euler characteristic.
    gaussian_curvature: f64,
    gaussian_curvature_bound: f64,
    euler_characteristic: i64,
    betti: Option<Betti>,
    /// The share of a periodic box that is filled.
    #[serde(skip_serializing_if = "Option::is_none")]
    box_fraction: Option<f64>,
    contacts: usize,
    /// The discs of points in one plane, in that plane; absent for others, and for molecules.
    #[serde(skip_serializing_if = "Option::is_none")]
    discs: Option<Discs>,
    voids: Vec<Hollow>,
    /// Largest first, voids included.
    pockets: Vec<Hollow>,
}

/// The union of discs.
#[derive(Serialize)]
struct Discs {
    area: f64,
    area_bound: f64,
    perimeter: f64,
    perimeter_bound: f64,
}

impl Discs {
    fn of(union: &DiscUnion<'_>) -> Self {
        let (area, perimeter) = (union.area(), union.perimeter());
        Self {
            area: area.value,
            area_bound: area.bound,
            perimeter: perimeter.value,
            perimeter_bound: perimeter.bound,
        }
    }
}

/// A void or a pocket.
#[derive(Serialize)]
struct Hollow {
    volume: f64,
    volume_bound: f64,
    area: f64,
    area_bound: f64,
    mouths: usize,
    /// Number of balls at it.
    balls: usize,
}

impl Hollow {
    fn of(cavity: &Cavity, mouths: usize) -> Self {
        let Cavity { volume, area, lining, .. } = cavity;
        Self {
            volume: volume.value,
            volume_bound: volume.bound,
            area: area.value,
            area_bound: area.bound,
            mouths,
            balls: lining.len(),
        }
    }
}

impl Numbers {
    fn of(shape: &AlphaShape, measured: &Measured<'_>) -> Self {
        let Measured { union, voids, pockets, discs } = measured;
        let [volume, area, mean, gaussian] =
            [union.volume(), union.area(), union.mean_curvature(), union.gaussian_curvature()];
        Self {
            volume: volume.value,
            volume_bound: volume.bound,
            area: area.value,
            area_bound: area.bound,
            mean_curvature: mean.value,
            mean_curvature_bound: mean.bound,
            gaussian_curvature: gaussian.value,
            gaussian_curvature_bound: gaussian.bound,
            euler_characteristic: union.euler_characteristic(),
            betti: shape.betti(),
            box_fraction: union.box_fraction().map(|share| share.value),
            contacts: union.contacts().pairs.len(),
            discs: discs.as_ref().map(Discs::of),
            voids: voids.iter().map(|void| Hollow::of(void, 0)).collect(),
            pockets: pockets
                .iter()
                .map(|pocket| Hollow::of(&pocket.cavity, pocket.mouths.len()))
                .collect(),
        }
    }
}

impl Display for BallsSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = self.coordinates.unit.symbol();
        writeln!(f, "input     {}", name(&self.input))?;
        if let Some(molecule) = &self.molecule {
            writeln!(f, "molecule  {molecule}")?;
        }
        let Self { points, duplicates, hidden, .. } = self;
        write!(f, "balls     {points}, {duplicates} duplicates, {hidden} hidden")?;
        writeln!(f, "{}", MovedIntoBox(self.folded))?;
        if let Some((least, most)) = self.radii {
            let [least, most] = [least, most].map(rounded);
            write!(f, "radii     {least} to {most} {unit}")?;
            match self.probe {
                Some(probe) => writeln!(f, ", with the probe's {probe} {unit}")?,
                None => writeln!(f)?,
            }
        }
        let Numbers { volume, volume_bound, area, area_bound, .. } = self.balls;
        write!(f, "volume    {} {unit}³", certain(volume, volume_bound))?;
        match self.balls.box_fraction {
            Some(share) => writeln!(f, ", {} % of the box", rounded(100.0 * share))?,
            None => writeln!(f)?,
        }
        writeln!(f, "area      {} {unit}²", certain(area, area_bound))?;
        if let Some(Discs { area, area_bound, perimeter, perimeter_bound }) = &self.balls.discs {
            let (area, perimeter) =
                (certain(*area, *area_bound), certain(*perimeter, *perimeter_bound));
            writeln!(
                f,
                "discs     area {area} {unit}², perimeter {perimeter} {unit}, in their plane"
            )?;
        }
        let Numbers { mean_curvature, mean_curvature_bound, euler_characteristic, .. } = self.balls;
        writeln!(
            f,
            "curvature mean {} {unit}, Gaussian 4π·{euler_characteristic}, integrated",
            certain(mean_curvature, mean_curvature_bound)
        )?;
        if let Some(betti) = self.balls.betti {
            writeln!(f, "topology  {betti}")?;
        }
        writeln!(f, "contacts  {} between two balls", self.balls.contacts)?;
        self.print_hollows(f, "voids", &self.balls.voids)?;
        self.print_hollows(f, "pockets", &self.balls.pockets)?;
        ending(
            f,
            &self.files,
            &["read", "points", "shape", "measure", "write", "total"],
            &self.seconds,
        )
    }
}

impl BallsSummary {
    fn print_hollows(
        &self,
        f: &mut fmt::Formatter<'_>,
        what: &str,
        hollows: &[Hollow],
    ) -> fmt::Result {
        let unit = self.coordinates.unit.symbol();
        let largest = hollows.iter().max_by(|a, b| a.volume.total_cmp(&b.volume));
        let Some(Hollow { volume, volume_bound, area, area_bound, balls, .. }) = largest else {
            return Ok(());
        };
        let (volume, area) = (certain(*volume, *volume_bound), certain(*area, *area_bound));
        writeln!(
            f,
            "{what:<9} {}; the largest has {volume} {unit}³ and {area} {unit}², and is bordered by {balls} balls",
            hollows.len()
        )
    }
}
