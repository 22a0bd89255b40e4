//! `walpha-check`: judges complexes in files.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use walpha_check::schema::{ComplexFile, PlacedComplex, SchemaError};

/// Judge weighted alpha shapes exactly.
///
/// Each FILE is a complex in JSON or NPZ: points, power weights, α, simplices and, if known, their
/// classes. Findings name the simplex and the rule that it breaks.
///
/// Exit code: 0 if nothing is found, 1 if a file cannot be judged, 2 for a wrong command line, 3 if
/// something is found.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Complexes: .json or .npz.
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
        match read(path).map_err(Into::into).and_then(|complex| judge(path, &complex)) {
            Ok(valid) => found |= !valid,
            // Whoever read the output has seen enough.
            Err(Failure::Output(error)) if error.kind() == ErrorKind::BrokenPipe => break,
            Err(failure) => {
                failed = true;
                eprintln!("error: {path:?}: {failure}");
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
    Certify(#[from] walpha_check::CertifyError),
    #[error("the result cannot be printed: {0}")]
    Output(#[from] io::Error),
}

fn read(path: &Path) -> Result<PlacedComplex, SchemaError> {
    ComplexFile::open(path)?.into_complex()
}

/// Prints what is found, and gives whether that is nothing.
#[expect(clippy::unnecessary_debug_formatting, reason = "it escapes control characters")]
fn judge(path: &Path, complex: &PlacedComplex) -> Result<bool, Failure> {
    let (findings, certificate) = complex.claim().findings()?;
    let mut out = io::stdout().lock();
    // As Debug prints a path, control characters in its name cannot reach the terminal.
    writeln!(out, "{path:?}: {}", verdict(findings.len()))?;
    for finding in findings.iter().take(MOST_PRINTED) {
        writeln!(out, "  {finding}")?;
    }
    if findings.len() > MOST_PRINTED {
        writeln!(out, "  and {} more", findings.len() - MOST_PRINTED)?;
    }
    for rule in &certificate.not_judged {
        writeln!(out, "  not judged: {rule}")?;
    }
    Ok(findings.is_empty())
}

fn verdict(findings: usize) -> String {
    match findings {
        0 => "no findings".into(),
        1 => "1 finding".into(),
        many => format!("{many} findings"),
    }
}
