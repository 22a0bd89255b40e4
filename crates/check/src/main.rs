//! `walpha-check`: judges complexes in files.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use walpha_check::schema::{AnyFile, SchemaError};
use walpha_check::{CertifyError, CertifyFiltrationError, Unjudged, certify_filtration};

/// Judge weighted alpha shapes exactly.
///
/// Each FILE is a complex in JSON or NPZ: points, power weights, α, simplices and, if known, their
/// classes; or a filtration: every simplex, when it comes, and the order. Findings name the simplex and the rule that it breaks.
///
/// Exit code: 0 if nothing is found, 1 if a file cannot be judged, 2 for a wrong command line, 3 if
/// something is found.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Complexes and filtrations: .json or .npz.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// Findings printed for a file; all are counted.
const MOST_PRINTED: usize = 20;
const FAILED: u8 = 1;
const FOUND: u8 = 3;

#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn main() -> ExitCode {
    let Arguments { files } = Arguments::parse();
    let (mut failed, mut found) = (false, false);
    for path in &files {
        match judge(path) {
            Ok(valid) => found |= !valid,
            // Whoever read the output has seen enough.
            Err(Failure::Output(error)) if error.kind() == ErrorKind::BrokenPipe => break,
            Err(failure) => {
                failed = true;
                eprintln!("error: {path:?}: {failure}");
                if let Some(advice) = failure.advice() {
                    eprintln!("next: {advice}");
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

/// Why a file was not judged, or not to the end.
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

/// Judges a file, prints what is found, and gives whether that is nothing.
fn judge(path: &Path) -> Result<bool, Failure> {
    match AnyFile::open(path)? {
        AnyFile::Complex(file) => {
            let (findings, certificate) = file.into_complex()?.findings()?;
            print(path, &findings, &certificate.not_judged, &[])
        }
        AnyFile::Filtration(file) => {
            let (findings, certificate) = certify_filtration(&file)?;
            print(path, &findings, &certificate.triangulation.not_judged, &certificate.not_judged)
        }
    }
}

/// Prints what is found and what was not judged, and gives whether nothing is found.
#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn print(
    path: &Path,
    findings: &[impl Display],
    rules: &[impl Display],
    parts: &[Unjudged],
) -> Result<bool, Failure> {
    let mut out = io::stdout().lock();
    // As Debug prints a path, control characters in its name cannot reach the terminal.
    writeln!(out, "{path:?}: {}", verdict(findings.len()))?;
    for finding in findings.iter().take(MOST_PRINTED) {
        writeln!(out, "  {finding}")?;
    }
    if findings.len() > MOST_PRINTED {
        writeln!(out, "  and {} more", findings.len() - MOST_PRINTED)?;
    }
    rules.iter().try_for_each(|rule| writeln!(out, "  not judged: {rule}"))?;
    parts.iter().try_for_each(|part| writeln!(out, "  not judged: {part}"))?;
    Ok(findings.is_empty())
}

fn verdict(findings: usize) -> String {
    match findings {
        0 => "no findings".into(),
        1 => "1 finding".into(),
        many => format!("{many} findings"),
    }
}
