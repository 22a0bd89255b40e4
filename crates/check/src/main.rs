//! `walpha-check`: judges complexes in files.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use walpha_base::{standard_output, threads};
use walpha_check::schema::{AnyFile, PlacedComplex, SchemaError};
use walpha_check::{CertifyError, CertifyFiltrationError, Unjudged, certify_filtration};

/// Judge weighted alpha shapes exactly.
///
/// Each FILE is a complex in JSON or NPZ: points, power weights, α, simplices and, if known, their
/// classes; or a filtration: every simplex, the α at which it enters, and the order. A file is exact; or valid:
/// right, with another choice at ties, where more points lie on one empty sphere than a simplex has corners
/// or points are equal; or wrong. Findings name the simplex and the rule that it breaks.
///
/// Exit code: 0 if all files are exact or valid, 1 if a file cannot be judged, 2 for a wrong command line, 3
/// if a file is wrong, 141 if standard output is closed by its reader.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Complexes and filtrations: .json or .npz.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Which choices at ties are accepted: any, or only that of the perturbation (exact), so that any other is
    /// a finding.
    #[arg(long, value_enum, default_value_t, value_name = "CHOICE")]
    ties: Ties,
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
/// The exit code that shells report for a process ended by SIGPIPE.
const UNREAD: u8 = 141;

#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn main() -> ExitCode {
    let Arguments { files, ties } = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return print_usage(&error),
    };
    start_threads();
    let (mut failed, mut found) = (false, false);
    for path in &files {
        match judge(path, ties) {
            Ok(right) => found |= !right,
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
    match (failed, found) {
        (true, _) => ExitCode::from(FAILED),
        (false, true) => ExitCode::from(FOUND),
        (false, false) => ExitCode::SUCCESS,
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

/// Starts the threads of rayon: fewer where the system refuses more, and none but this one where it refuses all.
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
    Certify(#[from] CertifyError),
    #[error(transparent)]
    Filtration(#[from] CertifyFiltrationError),
    #[error("the result cannot be printed: {0}")]
    Output(#[from] io::Error),
}

impl Failure {
    fn advice(&self) -> Option<&'static str> {
        match self {
            Self::Schema(error) => error.advice(),
            Self::Certify(error) => error.advice(),
            Self::Filtration(error) => error.advice(),
            Self::Output(_) => None,
        }
    }
}

/// Judges a file, prints the findings, and returns whether it is right.
fn judge(path: &Path, ties: Ties) -> Result<bool, Failure> {
    match AnyFile::open(path)? {
        AnyFile::Complex(file) => {
            let (mut findings, certificate) = PlacedComplex::try_from(file)?.findings()?;
            findings.retain(|finding| ties == Ties::Exact || !finding.is_tie());
            print(path, &certificate, &findings, &certificate.not_judged, &[])?;
            Ok(findings.is_empty())
        }
        AnyFile::Filtration(file) => {
            let (mut findings, certificate) = certify_filtration(&file)?;
            findings.retain(|finding| ties == Ties::Exact || !finding.is_tie());
            let unjudged = &certificate.triangulation.not_judged;
            print(path, &certificate, &findings, unjudged, &certificate.not_judged)?;
            Ok(findings.is_empty())
        }
    }
}

/// Prints the verdict, the findings, and what was not judged.
#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn print(
    path: &Path,
    certificate: &impl Display,
    findings: &[impl Display],
    rules: &[impl Display],
    parts: &[Unjudged],
) -> Result<(), Failure> {
    standard_output::check()?;
    let mut out = io::stdout().lock();
    // As Debug prints a path, control characters in its name cannot reach the terminal.
    writeln!(out, "{path:?}: {certificate}")?;
    for finding in findings.iter().take(MOST_PRINTED) {
        writeln!(out, "  {finding}")?;
    }
    if findings.len() > MOST_PRINTED {
        writeln!(out, "  and {} more", findings.len() - MOST_PRINTED)?;
    }
    rules.iter().try_for_each(|rule| writeln!(out, "  not judged: {rule}"))?;
    parts.iter().try_for_each(|part| writeln!(out, "  not judged: {part}"))?;
    out.flush()?;
    Ok(())
}
