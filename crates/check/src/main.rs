//! `walpha-check`: judges complexes in files.

use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::{Parser, ValueEnum};
use walpha_base::advice::{Advice, Advise, wrapped};
use walpha_base::{standard_output, threads};
use walpha_check::meshes::{MeshError, MeshFormat, open_weights};
use walpha_check::schema::{AnyFile, ComplexFile, PlacedComplex, SchemaError};
use walpha_check::{
    Alpha, CertifyError, CertifyFiltrationError, FiltrationFinding, Finding, LikelyCause, Monitor,
    Unjudged, Verdict, certify_filtration, count_by_rule, keep_causes, likely_cause,
    likely_cause_of_values,
};

/// Judge weighted alpha shapes and meshes of tetrahedra exactly.
///
/// Each FILE is a complex in JSON or NPZ: points, power weights, α, simplices and, if known, their
/// classes; a filtration: every simplex, the α at which it enters, and the order; or a mesh of tetrahedra of TetGen
/// (.node, .ele), Gmsh (.msh), Medit (.mesh) or VTK (.vtk). What states no α is judged as a triangulation of its
/// points, at α = ∞. Coordinates in text are decimal numbers, each taken to the nearest double.
///
/// A file is exact; or valid: right, with another choice at ties, where more points lie on one empty sphere than a
/// simplex has corners or points are equal; or wrong. Findings name the simplex and the rule that it breaks. A file that lists
/// cells but no facets, edges or vertices of its own is judged by its cells.
///
/// Exit code: 0 if all files are exact or valid, 1 if a file cannot be judged, 2 for a wrong command line, 3
/// if a file is wrong, 4 if all are right as far as judged, as in one too many points are near each other for a search
/// for missing simplices, 141 if standard output is closed by its reader.
#[derive(Parser)]
#[command(version)]
#[expect(clippy::doc_markdown, reason = "the help would show backticks")]
struct Arguments {
    /// Complexes and filtrations: .json or .npz. Meshes: .node with .ele, .msh, .mesh or .vtk.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// α, a squared length, of files that state none: their cells are then judged as a shape.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    alpha: Option<Alpha>,
    /// Weights, squared lengths, of files that have none: column for the first attribute of TetGen's points, or a
    /// file with one for each point: .npy, or text with one on each line.
    #[arg(long, value_name = "SOURCE")]
    weights: Option<PathBuf>,
    /// Which choices at ties are accepted: any, or only that of the perturbation (exact), so that any other is
    /// a finding.
    #[arg(long, value_enum, default_value_t, value_name = "CHOICE")]
    ties: Ties,
    /// Print exact numbers as fractions, instead of six digits of them.
    #[arg(short = 'v', long = "verbose")]
    fractions: bool,
}

/// Which choices at ties are accepted.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Ties {
    /// Any.
    #[default]
    Any,
    /// That of the perturbation, which CGAL uses, too.
    Exact,
}

/// The most findings printed for a file; all are counted.
const MOST_PRINTED: usize = 20;
const FAILED: u8 = 1;
const USAGE: u8 = 2;
const FOUND: u8 = 3;
const UNDECIDED: u8 = 4;
/// The exit code that shells report for a process ended by SIGPIPE.
const UNREAD: u8 = 141;

#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return print_usage(&error),
    };
    start_threads();
    let (mut failed, mut worst) = (false, Judgement::Right);
    for path in &arguments.files {
        match judge(path, &arguments) {
            Ok(judgement) => worst = worst.max(judgement),
            // Further output would be lost, too.
            Err(Failure::Output(error)) => return unprinted(&error),
            Err(failure) => {
                failed = true;
                complain(&format!("error: {path:?}: {failure}"));
                if let Some(advice) = failure.advice() {
                    complain(&format!("next: {advice}"));
                }
            }
        }
    }
    match worst {
        _ if failed => ExitCode::from(FAILED),
        Judgement::Right => ExitCode::SUCCESS,
        Judgement::Undecided => ExitCode::from(UNDECIDED),
        Judgement::Wrong => ExitCode::from(FOUND),
    }
}

/// The judgement of a file, as far as the exit code reflects it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Judgement {
    Right,
    /// Right as far as judged.
    Undecided,
    Wrong,
}

impl Judgement {
    fn of<F>(findings: &[F], verdict: Verdict) -> Self {
        match (findings, verdict.is_complete()) {
            ([], true) => Self::Right,
            ([], false) => Self::Undecided,
            _ => Self::Wrong,
        }
    }
}

/// Prints the help, the version, or the error in the command line.
fn print_usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() {
        let _ = error.print();
        return ExitCode::from(USAGE);
    }
    let print = || standard_output::check().and_then(|()| error.print());
    match print().and_then(|()| io::stdout().flush()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => unprinted(&error),
    }
}

/// Reports that the result cannot be printed.
fn unprinted(error: &io::Error) -> ExitCode {
    complain(&format!("error: the result cannot be printed: {error}"));
    ExitCode::from(if error.kind() == ErrorKind::BrokenPipe { UNREAD } else { FAILED })
}

/// Prints to standard error, and ignores failures.
fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Starts the threads of rayon: fewer if the system refuses more, and only this one if it refuses all.
fn start_threads() {
    /// The default stack size of rayon.
    const STACK: usize = 2 << 20;
    let count = threads::available(threads::wanted(None), STACK);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.max(1));
    let pool = if count == 0 { pool.use_current_thread() } else { pool };
    // If that fails, rayon tries again by itself when it is first needed.
    let _ = pool.build_global();
}

/// Why a file was not judged, or not completely.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Schema(#[from] SchemaError),
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(
        "complexes are read from .json and .npz, meshes from .node, .ele, .msh, .mesh and .vtk"
    )]
    Extension {
        /// Whether `walpha check` reads it.
        by_walpha: bool,
    },
    /// An option that has no effect on the file.
    #[error("{option} has no effect: {why}")]
    Option { option: &'static str, why: &'static str },
    #[error("--weights column asks for the attributes of TetGen's points, and there are none")]
    Attribute,
    #[error(transparent)]
    Certify(#[from] CertifyError),
    #[error(transparent)]
    Filtration(#[from] CertifyFiltrationError),
    #[error("the result cannot be printed: {0}")]
    Output(#[from] io::Error),
}

impl Advise for Failure {
    wrapped!(Schema, Mesh, Certify, Filtration, Output);

    fn advice(&self) -> Option<Advice> {
        let advice = match self {
            Self::Extension { by_walpha: true } => {
                "use `walpha check`, which reads .vtu and .ply, too"
            }
            Self::Extension { by_walpha: false } => "convert it to one of these",
            Self::Option { .. } => "omit it",
            Self::Attribute => "give a file with the weights",
            _ => return self.wrapped()?.advice(),
        };
        Some(advice.into())
    }
}

/// A file with the additions of the options, and notes for the reader of the verdict.
fn read(path: &Path, arguments: &Arguments) -> Result<(AnyFile, Vec<String>), Failure> {
    let (mut file, mut attribute, mut notes) = match MeshFormat::of(path) {
        Some(format) => {
            let mesh = format.read(path)?;
            (AnyFile::Complex(mesh.complex), mesh.attribute, mesh.notes)
        }
        None => match AnyFile::open(path) {
            Err(SchemaError::Extension) => {
                let is_one = |own: &OsStr| {
                    ["vtu", "ply"].iter().any(|known| own.eq_ignore_ascii_case(known))
                };
                return Err(Failure::Extension { by_walpha: path.extension().is_some_and(is_one) });
            }
            file => (file?, None, Vec::new()),
        },
    };
    match &mut file {
        AnyFile::Complex(file) => {
            complete(file, &mut attribute, arguments)?;
            if attribute.is_some() {
                notes.push(
                    "attributes of points are not weights; --weights column takes the first".into(),
                );
            }
            if file.states_no_alpha() {
                notes.push("judged as a triangulation (α = ∞); --alpha makes it a shape".into());
            }
        }
        AnyFile::Filtration(_) => {
            let why = "a filtration has all values of α, and its weights";
            let given = [
                ("--alpha", arguments.alpha.is_some()),
                ("--weights", arguments.weights.is_some()),
            ];
            if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
                return Err(Failure::Option { option, why });
            }
        }
    }
    Ok((file, notes))
}

/// Gives a complex the α and the weights of the options.
fn complete(
    file: &mut ComplexFile,
    attribute: &mut Option<Vec<f64>>,
    arguments: &Arguments,
) -> Result<(), Failure> {
    if let Some(alpha) = arguments.alpha {
        if !file.states_no_alpha() {
            return Err(Failure::Option { option: "--alpha", why: "the file states its α" });
        }
        file.alpha = alpha;
    }
    if let Some(source) = &arguments.weights {
        if file.weights.is_some() {
            return Err(Failure::Option { option: "--weights", why: "the file has weights" });
        }
        file.weights = Some(if source.as_os_str() == "column" {
            attribute.take().ok_or(Failure::Attribute)?
        } else {
            open_weights(source).map_err(|error| error.of_file(source))?
        });
    }
    Ok(())
}

/// Judges a file, prints the findings, and returns the judgement.
fn judge(path: &Path, arguments: &Arguments) -> Result<Judgement, Failure> {
    let (file, notes) = read(path, arguments)?;
    let ties = arguments.ties;
    match file {
        AnyFile::Complex(file) => {
            let is_cells_alone = file.is_cells_alone();
            let complex = PlacedComplex::try_from(file)?;
            let (mut findings, mut certificate) = watched(|| complex.findings())?;
            if is_cells_alone {
                keep_causes(&mut findings, &mut certificate);
            }
            findings.retain(|finding| ties == Ties::Exact || !finding.is_tie());
            let report = Report {
                certificate: &certificate,
                by_rule: count_by_rule(findings.iter().map(Finding::rule)),
                likely_cause: likely_cause(&findings, complex.alpha),
                findings: &findings,
                as_fractions: arguments.fractions,
                rules: &certificate.not_judged,
                parts: &[],
                notes: &notes,
            };
            report.print(path)?;
            Ok(Judgement::of(&findings, certificate.verdict))
        }
        AnyFile::Filtration(file) => {
            let (mut findings, certificate) = watched(|| certify_filtration(&file))?;
            findings.retain(|finding| ties == Ties::Exact || !finding.is_tie());
            let report = Report {
                certificate: &certificate,
                by_rule: count_by_rule(findings.iter().map(FiltrationFinding::rule)),
                likely_cause: likely_cause_of_values(&findings, &file),
                findings: &findings,
                as_fractions: arguments.fractions,
                rules: &certificate.triangulation.not_judged,
                parts: &certificate.not_judged,
                notes: &notes,
            };
            report.print(path)?;
            Ok(Judgement::of(&findings, certificate.verdict))
        }
    }
}

/// Does long work, and shows its progress on a terminal.
fn watched<T>(work: impl FnOnce() -> T) -> T {
    /// Work that takes less time shows no progress.
    const QUICK: Duration = Duration::from_secs(1);
    if !io::stderr().is_terminal() {
        return work();
    }
    let started = Instant::now();
    let monitor = Monitor::new(move |done: u64, total: u64| {
        if started.elapsed() > QUICK {
            let _ = write!(io::stderr().lock(), "\rjudging {:3} %", 100 * done / total.max(1));
        }
    });
    let made = monitor.watch(work);
    if started.elapsed() > QUICK {
        let _ = write!(io::stderr().lock(), "\r{:13}\r", "");
    }
    made
}

/// The printed report of a file.
struct Report<'a, C, F, R> {
    certificate: &'a C,
    by_rule: Vec<(&'static str, usize)>,
    likely_cause: Option<LikelyCause>,
    findings: &'a [F],
    /// Whether exact numbers are printed as fractions.
    as_fractions: bool,
    /// Rules and parts that were not judged.
    rules: &'a [R],
    parts: &'a [Unjudged],
    notes: &'a [String],
}

impl<C: Display, F: Display, R: Display> Report<'_, C, F, R> {
    /// Prints the verdict, the findings, the parts that were not judged, and the notes.
    #[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
    fn print(&self, path: &Path) -> io::Result<()> {
        let Self { certificate, by_rule, findings, rules, parts, notes, .. } = self;
        standard_output::check()?;
        let mut out = io::stdout().lock();
        // Debug escapes the path, so control characters in a name cannot reach the terminal.
        writeln!(out, "{path:?}: {certificate}")?;
        if findings.len() > 1 {
            let counts: Vec<String> =
                by_rule.iter().map(|(rule, count)| format!("{count} {rule}")).collect();
            writeln!(out, "  by rule: {}", counts.join(", "))?;
        }
        if let Some(cause) = &self.likely_cause {
            writeln!(out, "  likely: {cause}")?;
        }
        for finding in findings.iter().take(MOST_PRINTED) {
            if self.as_fractions {
                writeln!(out, "  {finding:#}")?;
            } else {
                writeln!(out, "  {finding}")?;
            }
        }
        if findings.len() > MOST_PRINTED {
            writeln!(out, "  and {} more", findings.len() - MOST_PRINTED)?;
        }
        rules.iter().try_for_each(|rule| writeln!(out, "  not judged: {rule}"))?;
        parts.iter().try_for_each(|part| writeln!(out, "  not judged: {part}"))?;
        notes.iter().try_for_each(|note| writeln!(out, "  note: {note}"))?;
        out.flush()
    }
}
