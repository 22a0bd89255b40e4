//! `walpha check`: is it the α-complex?

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::check::schema::PlacedComplex;
use crate::check::{Certificate, Comparison, Extent, Finding, compare, enumerate};
use crate::progress::Stage;
use crate::shape::ShapeOptions;
use crate::shown::shown;
use clap::{Args, Command};
use serde::Serialize;

use super::args::{PeriodicArgs, PipelineArgs, ShapeArgs};
use super::output::{name, tell};
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::said::{Said, misused, refused};
use super::{DIFFERENT, Global, check_filtration, complex_file, pipeline};

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
pub struct Check {
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
pub const MOST_PRINTED: usize = 20;
pub const MOST_LISTED: usize = 1000;

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    input: String,
    points: usize,
    /// Cells, facets, edges, vertices.
    simplices: [usize; 4],
    extent: &'static str,
    valid: bool,
    findings_total: usize,
    /// The first of them.
    findings: Vec<Finding>,
    certificate: Certificate,
    enumeration: Option<Comparison>,
    seconds: f64,
}

impl Check {
    pub fn run(self, global: Global) -> anyhow::Result<ExitCode> {
        let path = Path::new(&self.pipeline.input.input);
        if complex_file::is_complex(path) && complex_file::is_filtration(path) {
            return self.filtration(global, path);
        }
        self.shape.check(self.pipeline.weights.alpha(), self.periodic.periodic)?;
        let mut progress = Progress::new(global);
        let judged = self.complex(&mut progress)?;
        let n = judged.positions.len();
        if self.enumerate && judged.periodic.is_some() {
            refused!("--enumerate knows no periodic box" => "omit it");
        }
        if self.enumerate && n > MOST_ENUMERATED {
            refused!("--enumerate takes at most {MOST_ENUMERATED} points, and there are {n}" => "omit it");
        }
        let claim = judged.claim();
        let started = std::time::Instant::now();
        let (mut findings, certificate) = progress.stage(Stage::Certify, || judged.findings())?;
        let seconds = started.elapsed().as_secs_f64();
        let enumeration = if self.enumerate {
            Some(progress.stage(Stage::Enumerate, || by_definition(&judged))?)
        } else {
            None
        };
        progress.finish();

        let complex = &judged.complex;
        let total = findings.len();
        findings.truncate(MOST_LISTED);
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            input: self.pipeline.input.input,
            points: n,
            simplices: [
                complex.cells.len(),
                complex.facets.len(),
                complex.edges.len(),
                complex.vertices.len(),
            ],
            extent: if claim.extent == Extent::Whole { "whole" } else { "shape" },
            valid: total == 0 && enumeration.as_ref().is_none_or(Comparison::is_equal),
            findings_total: total,
            findings,
            certificate,
            enumeration,
            seconds,
        };
        tell(global, &facts)?;
        Ok(if facts.valid { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
    }

    /// Judges a filtration.
    fn filtration(&self, global: Global, path: &Path) -> anyhow::Result<ExitCode> {
        self.refuse_ours(format!("{} is a filtration, made already", shown(path)))?;
        if self.enumerate {
            misused!("--enumerate belongs to a complex, and {} is a filtration", shown(path) => "omit it");
        }
        check_filtration::run(global, path, self.points.as_deref())
    }

    /// Refuses options of how a complex is made.
    fn refuse_ours(&self, why: String) -> Result<(), Said> {
        let ours = ShapeArgs::augment_args(PipelineArgs::augment_args(Command::new("check")));
        let ours = PeriodicArgs::augment_args(ours);
        let options = ours.get_arguments().filter(|arg| !arg.is_positional());
        let names: Vec<&str> = options.map(|arg| arg.get_id().as_str()).collect();
        self.pipeline.input.given.refuse(&names, why)
    }

    /// The complex to judge.
    fn complex(&self, progress: &mut Progress) -> anyhow::Result<PlacedComplex> {
        let path = Path::new(&self.pipeline.input.input);
        if complex_file::is_complex(path) {
            self.refuse_ours(format!("{} is a complex, made already", shown(path)))?;
            return progress
                .stage(Stage::Read, || complex_file::read(path, self.points.as_deref()));
        }
        if self.points.is_some() {
            misused!("--points belongs to a complex (.json, .npz), and {} is none", shown(path) => "omit it");
        }
        let (weighed, _) = pipeline::weighted_points(&self.pipeline, progress)?;
        let periodic = self.periodic.periodic;
        let mut options = ShapeOptions { periodic, ..self.shape.options() };
        // The whole triangulation can be judged wholly. Several blocks are judged as they are; and of a torus
        // the shape may have no long edge where the whole has one.
        options.exterior |= options.blocks.is_none_or(|blocks| blocks.get() == 1)
            && options.memory.is_none()
            && periodic.is_none();
        let model = pipeline::shape(weighed, options, progress)?;
        let sides = periodic.map(|torus| torus.sides());
        Ok(PlacedComplex::from(model.shape.claim()).with_periodic(sides))
    }
}

/// How a complex (A) differs from the one its definition makes (B).
fn by_definition(judged: &PlacedComplex) -> anyhow::Result<Comparison> {
    let judged = judged.placed();
    let made = enumerate(judged.positions, judged.weights, judged.alpha)?;
    Ok(compare(judged, judged.with_complex(&made.complex))?)
}

impl std::fmt::Display for Facts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [cells, facets, edges, vertices] = self.simplices;
        writeln!(f, "judged    {}: {} points", name(&self.input), self.points)?;
        writeln!(
            f,
            "          {cells} cells, {facets} facets, {edges} edges, {vertices} vertices"
        )?;
        for rule in &self.certificate.not_judged {
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
