//! `walpha check`: is it the α-complex?

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, Command};
use serde::Serialize;

use crate::check::schema::{FiltrationFile, PlacedComplex};
use crate::check::{Comparison, Extent, certify_filtration, compare, enumerate};
use crate::progress::Stage;
use crate::shape::ShapeOptions;
use crate::shown::shown;

use super::args::{PeriodicArgs, PipelineArgs, ShapeArgs};
use super::judged::{self, Judged};
use super::output::{name, tell};
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::said::{Said, misused, refused};
use super::{DIFFERENT, Global, pipeline};

/// Check a complex exactly: one of an engine, or one that another program wrote.
///
/// INPUT is a volume or points, from which an engine computes a shape, or a complex or filtration
/// (.json, .npz). The checker shares no code with the engines or CGAL. Exit code 3 if there are
/// findings.
///
/// Examples:
///
/// walpha check ct.nii.gz --gray 0..1000 --gray-min 64 --threshold 30
///
/// walpha check skull.json
///
/// walpha check theirs.json --points skull.csv
#[derive(Args)]
pub(super) struct Check {
    /// Points of the complex or filtration, where its file lists none: .csv or .npy.
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Also build the answer from the definition, and compare (at most 200 points).
    #[arg(long)]
    enumerate: bool,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: ShapeArgs,
    #[command(flatten)]
    periodic: PeriodicArgs,
}

/// Points that `--enumerate` takes: more would take hours.
const MOST_ENUMERATED: usize = 200;
/// Findings that are printed as text, and as JSON; all are counted.
const MOST_PRINTED: usize = 20;
const MOST_LISTED: usize = 1000;

/// What was found in a complex or filtration.
#[derive(Serialize)]
struct Facts<F, C> {
    schema_version: u32,
    input: String,
    #[serde(skip)]
    kind: &'static str,
    points: usize,
    /// Cells, facets, edges, vertices.
    simplices: [usize; 4],
    /// Of a complex.
    #[serde(skip_serializing_if = "Option::is_none")]
    extent: Option<&'static str>,
    valid: bool,
    findings_total: usize,
    /// The first of them.
    findings: Vec<F>,
    certificate: C,
    /// In words.
    #[serde(skip)]
    not_judged: Vec<String>,
    enumeration: Option<Comparison>,
    seconds: f64,
}

impl Check {
    pub(super) fn run(self, global: Global) -> anyhow::Result<ExitCode> {
        let path = Path::new(&self.pipeline.input.input);
        let mut progress = Progress::new(global);
        if !judged::is_named(path) {
            let made = self.made(path, &mut progress)?;
            return self.complex(global, &made, progress);
        }
        let read = || judged::read(path, self.points.as_deref());
        match progress.stage(Stage::Read, read)? {
            Judged::Complex(complex) => {
                self.refuse_ours(format!("{} is a complex, made already", shown(path)))?;
                self.complex(global, &complex, progress)
            }
            Judged::Filtration(filtration) => {
                self.refuse_ours(format!("{} is a filtration, made already", shown(path)))?;
                if self.enumerate {
                    misused!("--enumerate belongs to a complex, and {} is a filtration", shown(path) => "omit it");
                }
                self.filtration(global, &filtration, progress)
            }
        }
    }

    /// Refuses options of how a complex is made.
    fn refuse_ours(&self, why: String) -> Result<(), Said> {
        let ours = ShapeArgs::augment_args(<PipelineArgs>::augment_args(Command::new("check")));
        let ours = PeriodicArgs::augment_args(ours);
        let options = ours.get_arguments().filter(|arg| !arg.is_positional());
        let names: Vec<&str> = options.map(|arg| arg.get_id().as_str()).collect();
        self.pipeline.input.given.refuse(&names, why)
    }

    /// The shape of INPUT, by an engine.
    fn made(&self, path: &Path, progress: &mut Progress) -> anyhow::Result<PlacedComplex> {
        let periodic = self.periodic.periodic;
        self.shape.check(self.pipeline.weights.alpha(), periodic)?;
        if self.points.is_some() {
            misused!("--points belongs to a complex (.json, .npz), and {} is none", shown(path) => "omit it");
        }
        let given = &self.pipeline.input.given;
        given.refuse(&["refit"], "values are not judged")?;
        let mut options = ShapeOptions { periodic, ..self.shape.options() };
        let stages = pipeline::stages(&self.pipeline);
        let (weighed, _) = pipeline::weighted_points(&self.pipeline, stages, progress)?;
        // The whole triangulation can be judged wholly. Several blocks are judged as they are; and of a
        // torus the shape may have no long edge where the whole has one.
        options.exterior |= options.blocks.is_none_or(|blocks| blocks.get() == 1)
            && options.memory.is_none()
            && periodic.is_none();
        let model = pipeline::shape(weighed, options, progress)?;
        let sides = periodic.map(|torus| torus.sides());
        Ok(PlacedComplex::from(model.shape.claim()).with_periodic(sides))
    }

    /// Judges a complex.
    fn complex(
        &self,
        global: Global,
        judged: &PlacedComplex,
        mut progress: Progress,
    ) -> anyhow::Result<ExitCode> {
        let n = judged.positions.len();
        if self.enumerate && judged.periodic.is_some() {
            refused!("--enumerate knows no periodic box" => "omit it");
        }
        if self.enumerate && n > MOST_ENUMERATED {
            refused!("--enumerate takes at most {MOST_ENUMERATED} points, and there are {n}" => "omit it");
        }
        let (claim, complex) = (judged.claim(), &judged.complex);
        let started = Instant::now();
        let (findings, certificate) = progress.stage(Stage::Certify, || judged.findings())?;
        let seconds = started.elapsed().as_secs_f64();
        let enumeration = if self.enumerate {
            Some(progress.stage(Stage::Enumerate, || by_definition(judged))?)
        } else {
            None
        };
        progress.finish();
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input.clone(),
            kind: "",
            points: n,
            simplices: [
                complex.cells.len(),
                complex.facets.len(),
                complex.edges.len(),
                complex.vertices.len(),
            ],
            extent: Some(if claim.extent == Extent::Whole { "whole" } else { "shape" }),
            valid: findings.is_empty() && enumeration.as_ref().is_none_or(Comparison::is_equal),
            findings_total: findings.len(),
            findings,
            not_judged: certificate.not_judged.iter().map(ToString::to_string).collect(),
            certificate,
            enumeration,
            seconds,
        };
        facts.tell(global)
    }

    /// Judges a filtration.
    fn filtration(
        &self,
        global: Global,
        file: &FiltrationFile,
        mut progress: Progress,
    ) -> anyhow::Result<ExitCode> {
        let started = Instant::now();
        let (findings, certificate) =
            progress.stage(Stage::Certify, || certify_filtration(file))?;
        let seconds = started.elapsed().as_secs_f64();
        progress.finish();
        let of_triangulation = certificate.triangulation.not_judged.iter().map(ToString::to_string);
        let of_values = certificate.not_judged.iter().map(ToString::to_string);
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input.clone(),
            kind: "a filtration of ",
            points: file.points.len(),
            simplices: [file.cells.len(), file.facets.len(), file.edges.len(), file.vertices.len()],
            extent: None,
            valid: findings.is_empty(),
            findings_total: findings.len(),
            findings,
            not_judged: of_triangulation.chain(of_values).collect(),
            certificate,
            enumeration: None,
            seconds,
        };
        facts.tell(global)
    }
}

/// How a complex (A) differs from the one its definition makes (B).
fn by_definition(judged: &PlacedComplex) -> anyhow::Result<Comparison> {
    let judged = judged.placed();
    let made = enumerate(judged.positions, judged.weights, judged.alpha)?;
    Ok(compare(judged, judged.with_complex(&made.complex))?)
}

impl<F: Serialize + Display, C: Serialize> Facts<F, C> {
    /// Prints them.
    fn tell(mut self, global: Global) -> anyhow::Result<ExitCode> {
        self.findings.truncate(MOST_LISTED);
        tell(global, &self)?;
        Ok(if self.valid { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
    }
}

impl<F: Display, C> Display for Facts<F, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [cells, facets, edges, vertices] = self.simplices;
        writeln!(f, "judged    {}: {}{} points", name(&self.input), self.kind, self.points)?;
        writeln!(
            f,
            "          {cells} cells, {facets} facets, {edges} edges, {vertices} vertices"
        )?;
        for rule in &self.not_judged {
            writeln!(f, "not judged: {rule}")?;
        }
        for finding in self.findings.iter().take(MOST_PRINTED) {
            writeln!(f, "found     {finding}")?;
        }
        if self.findings_total > MOST_PRINTED {
            writeln!(f, "          and {} more", self.findings_total - MOST_PRINTED)?;
        }
        if let Some(enumeration) = &self.enumeration {
            writeln!(f, "against the definition (A: judged, B: made from the definition)")?;
            writeln!(f, "{enumeration}")?;
        }
        let verdict = if self.valid { "certified: no finding" } else { "wrong" };
        writeln!(
            f,
            "verdict   {verdict}, {} findings in {:.2} s",
            self.findings_total, self.seconds
        )
    }
}
