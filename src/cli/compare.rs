//! `walpha compare`: how do two complexes differ?

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde::Serialize;
use walpha::check::{Comparison, Differences, Placed, compare};

use super::output::tell;
use super::report::SCHEMA_VERSION;
use super::{DIFFERENT, Global, complex_file};

/// Compare two complexes by points and simplices.
///
/// Points are matched by their places, so the two may number them differently. Exit code 3 when
/// the complexes differ.
///
/// Example: walpha compare ours.json theirs.npz
#[derive(Args)]
pub struct Compare {
    /// A complex: .json or .npz, as docs/cross-checking.md describes.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Another.
    #[arg(value_name = "B")]
    b: PathBuf,
}

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    a: String,
    b: String,
    equal: bool,
    #[serde(flatten)]
    comparison: Comparison,
}

impl Compare {
    pub fn run(self, global: Global) -> anyhow::Result<ExitCode> {
        let read = |path: &Path| complex_file::read(path, None);
        let (a, b) = (read(&self.a)?, read(&self.b)?);
        let comparison = compare(
            Placed { positions: &a.positions, complex: &a.complex },
            Placed { positions: &b.positions, complex: &b.complex },
        )?;
        let facts = Facts {
            schema_version: SCHEMA_VERSION,
            a: self.a.display().to_string(),
            b: self.b.display().to_string(),
            equal: comparison.is_equal(),
            comparison,
        };
        tell(global, &facts)?;
        Ok(if facts.equal { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
    }
}

impl Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "A         {}\nB         {}", self.a, self.b)?;
        describe(f, &self.comparison)?;
        writeln!(f, "verdict   {}", if self.equal { "equal" } else { "different" })
    }
}

/// Rows of each kind that are named; the rest is counted.
const MOST_NAMED: usize = 10;

/// Says what only A has, what only B has, and which classes differ.
pub fn describe(f: &mut fmt::Formatter<'_>, comparison: &Comparison) -> fmt::Result {
    named(f, "points only A has", comparison.points_only_a.iter())?;
    named(f, "points only B has", comparison.points_only_b.iter())?;
    for (name, d) in ["vertices", "edges", "facets", "cells"].iter().zip(&comparison.dimensions) {
        let Differences { equal, only_a, only_b, classes } = d;
        writeln!(f, "{name:<9} {equal} equal")?;
        named(
            f,
            "only in A",
            only_a.iter().map(|(simplex, class)| format!("{simplex} {class:?}")),
        )?;
        named(
            f,
            "only in B",
            only_b.iter().map(|(simplex, class)| format!("{simplex} {class:?}")),
        )?;
        named(
            f,
            "other class",
            classes.iter().map(|c| format!("{}: A {:?}, B {:?}", c.simplex, c.a, c.b)),
        )?;
    }
    writeln!(f, "{}", comparison.domain)
}

fn named<T: Display>(
    f: &mut fmt::Formatter<'_>,
    what: &str,
    rows: impl ExactSizeIterator<Item = T>,
) -> fmt::Result {
    let count = rows.len();
    for row in rows.take(MOST_NAMED) {
        writeln!(f, "          {what}: {row}")?;
    }
    if count > MOST_NAMED {
        writeln!(f, "          {what}: and {} more", count - MOST_NAMED)?;
    }
    Ok(())
}
