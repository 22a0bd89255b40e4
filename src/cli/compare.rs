//! `walpha compare`: how do two complexes or filtrations differ?

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde::Serialize;

use crate::check::{compare_filtrations_monitored, compare_monitored};
use crate::progress::Stage;

use super::judged::{self, Judged};
use super::output::{name, tell};
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::said::refused;
use super::{DIFFERENT, Global};

/// Compare two complexes by points, weights, α and simplices with their classes, or two filtrations
/// by points, weights, simplices with their values, and order.
///
/// Points are matched by their places, so the two may number them differently. Exterior simplices
/// are compared where both complexes list some; windings and lists of hidden points and duplicates
/// are not. Exit code 3 if anything compared differs.
///
/// Examples, of files that `walpha shape sample:skull --weights min-max -o skull.json` and the same
/// with --engine cgal -o cgal.npz make:
///
/// walpha compare skull.json cgal.npz
///
/// walpha compare skull.json theirs.json --json
#[derive(Args)]
pub(super) struct Compare {
    /// A complex or a filtration: .json or .npz, as docs/cross-checking.md describes.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Another.
    #[arg(value_name = "B")]
    b: PathBuf,
}

#[derive(Serialize)]
struct CompareSummary<C> {
    schema_version: u32,
    a: String,
    b: String,
    equal: bool,
    #[serde(flatten)]
    comparison: C,
}

impl Compare {
    pub(super) fn run(self, global: Global) -> anyhow::Result<ExitCode> {
        let mut progress = Progress::new(global);
        let mut read = |path: &Path| progress.stage(Stage::Read, || judged::read(path, None));
        match (read(&self.a)?, read(&self.b)?) {
            (Judged::Complex(a), Judged::Complex(b)) => {
                if a.periodic.or(b.periodic).is_some() {
                    refused!("complexes of a periodic box are not compared: their simplices have no one place" => "judge each with `walpha check`");
                }
                let comparison = progress.watch(|monitor| {
                    Stage::Compare.begin(monitor)?;
                    compare_monitored(a.placed(), b.placed(), monitor)
                })?;
                progress.finish();
                self.tell(global, comparison.is_equal(), comparison)
            }
            (Judged::Filtration(a), Judged::Filtration(b)) => {
                let comparison = progress.watch(|monitor| {
                    Stage::Compare.begin(monitor)?;
                    compare_filtrations_monitored(&a, &b, monitor)
                })?;
                progress.finish();
                self.tell(global, comparison.is_equal(), comparison)
            }
            _ => {
                refused!("one file is a filtration, the other a complex" => "compare two of a kind")
            }
        }
    }

    fn tell(
        &self,
        global: Global,
        equal: bool,
        comparison: impl Serialize + Display,
    ) -> anyhow::Result<ExitCode> {
        let [a, b] = [&self.a, &self.b].map(|path| path.display().to_string());
        tell(global, &CompareSummary { schema_version: SCHEMA_VERSION, a, b, equal, comparison })?;
        Ok(if equal { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
    }
}

impl<C: Display> Display for CompareSummary<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "A         {}\nB         {}", name(&self.a), name(&self.b))?;
        writeln!(f, "{}", self.comparison)?;
        let verdict = if self.equal { "equal in all that was compared" } else { "different" };
        writeln!(f, "verdict   {verdict}")
    }
}
