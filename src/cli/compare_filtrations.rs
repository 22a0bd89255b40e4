//! `walpha compare` of two filtrations.

use std::fmt::{self, Display};
use std::path::Path;
use std::process::ExitCode;

use crate::check::{FiltrationComparison, compare_filtrations};
use serde::Serialize;

use super::output::{name, tell};
use super::report::SCHEMA_VERSION;
use super::{DIFFERENT, Global, complex_file};

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    a: String,
    b: String,
    equal: bool,
    #[serde(flatten)]
    comparison: FiltrationComparison,
}

/// Compares the filtrations of two files.
pub fn run(global: Global, a: &Path, b: &Path) -> anyhow::Result<ExitCode> {
    let read = |path: &Path| complex_file::read_filtration(path, None);
    let comparison = compare_filtrations(&read(a)?, &read(b)?)?;
    let facts = Facts {
        schema_version: SCHEMA_VERSION,
        a: a.display().to_string(),
        b: b.display().to_string(),
        equal: comparison.is_equal(),
        comparison,
    };
    tell(global, &facts)?;
    Ok(if facts.equal { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
}

impl Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "A         {}\nB         {}", name(&self.a), name(&self.b))?;
        writeln!(f, "{}", self.comparison)?;
        let verdict = if self.equal { "equal in all that was compared" } else { "different" };
        writeln!(f, "verdict   {verdict}")
    }
}
