//! `walpha compare`: compares two complexes or filtrations; and reads such files.

use std::fmt::{self, Display};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use walpha_base::shown::shown;

use crate::check::schema::{AnyFile, ComplexFile, FiltrationFile, PlacedComplex, SchemaError};
use crate::check::{compare, compare_filtrations};
use crate::cli::options::global::{DIFFERENT, Global, SUCCESS};
use crate::cli::process::errors::{CommandError, Result, command_error, fail};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::SCHEMA_VERSION;
use crate::points::read_points;
use crate::progress::Stage;

/// Compare two complexes by points, weights, α and simplices with their classes, or two filtrations
/// by points, weights, simplices with their values, and order.
///
/// Points are matched by position, so the two may number them differently. Exterior simplices
/// are compared where both complexes list some; windings and lists of hidden points and duplicates
/// are not. Exit code 3 if anything compared differs.
///
/// Examples, of files that `walpha shape sample:skull --weights min-max -o skull.json` and the same
/// with --engine cgal -o cgal.npz make:
///
/// walpha compare skull.json cgal.npz   # two engines
///
/// walpha compare skull.json theirs.json --json   # for programs
#[derive(Args)]
pub(crate) struct Compare {
    /// A complex or a filtration: .json or .npz, as docs/cross-checking.md describes.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// The complex or filtration to compare it with.
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
    pub(crate) fn run(self, global: Global) -> Result<u8> {
        let mut progress = Progress::new(global);
        let mut read = |path: &Path| progress.stage(Stage::Read, || read(path));
        match (read(&self.a)?, read(&self.b)?) {
            (CheckFile::Complex(a), CheckFile::Complex(b)) => {
                if a.periodic.or(b.periodic).is_some() {
                    fail!("complexes of a periodic box are not compared: their simplices have no unique position" => "judge each with `walpha check`");
                }
                let comparison = progress.watch(|| {
                    Stage::Compare.begin()?;
                    compare(a.placed(), b.placed())
                })?;
                progress.finish();
                self.print(global, comparison.is_equal(), comparison)
            }
            (CheckFile::Filtration(a), CheckFile::Filtration(b)) => {
                let comparison = progress.watch(|| {
                    Stage::Compare.begin()?;
                    compare_filtrations(&a, &b)
                })?;
                progress.finish();
                self.print(global, comparison.is_equal(), comparison)
            }
            _ => {
                fail!("one file is a filtration, the other a complex" => "compare two files of the same kind")
            }
        }
    }

    fn print(
        &self,
        global: Global,
        equal: bool,
        comparison: impl Serialize + Display,
    ) -> Result<u8> {
        let [a, b] = [&self.a, &self.b].map(|path| path.display().to_string());
        print_summary(
            global,
            &CompareSummary { schema_version: SCHEMA_VERSION, a, b, equal, comparison },
        )?;
        Ok(if equal { SUCCESS } else { DIFFERENT })
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

/// A file to compare.
#[expect(clippy::large_enum_variant, reason = "there are two, moved a few times")]
enum CheckFile {
    /// A complex whose fields are consistent.
    Complex(PlacedComplex),
    /// A filtration whose fields are consistent.
    Filtration(FiltrationFile),
}

/// Whether the name of a file is that of a complex or filtration: `.json` or `.npz`.
pub(crate) fn is_named(path: &Path) -> bool {
    ComplexFile::is_named(path)
}

/// Reads a complex or filtration.
fn read(path: &Path) -> Result<CheckFile> {
    let judged = match opened(path)? {
        AnyFile::Complex(file) => PlacedComplex::try_from(file).map(CheckFile::Complex),
        AnyFile::Filtration(file) => file.check().map(|()| CheckFile::Filtration(file)),
    };
    judged.map_err(|error| refusal(path, error))
}

/// Replaces the points of a complex by those of a file, and its weights if the file has any.
pub(crate) fn replace_points(
    positions: &mut Vec<[f64; 3]>,
    weights: &mut Option<Vec<f64>>,
    path: &Path,
) -> Result<()> {
    let points = read_points(path, None)?;
    let (own, given) = (positions.len(), points.positions.len());
    if own > 0 && own != given {
        fail!("{} lists {given} points, and the file to check {own}", shown(path) => "give the same points, in the same order");
    }
    *positions = points.positions;
    *weights = points.weights.or(weights.take());
    Ok(())
}

/// Opens a file; the error says why it cannot be opened.
pub(crate) fn opened(path: &Path) -> Result<AnyFile> {
    match AnyFile::open(path) {
        Ok(file) => Ok(file),
        Err(SchemaError::Extension) => {
            fail!("{}: a complex is read from .json or .npz", shown(path) => "see docs/cross-checking.md")
        }
        Err(SchemaError::Io(error)) => {
            let missing = error.kind() == ErrorKind::NotFound;
            let next = missing.then(|| "check the path".to_owned());
            Err(CommandError { next, ..command_error!("cannot read {}: {error}", shown(path)) })
        }
        Err(other) => Err(CommandError::from(other).context(shown(path))),
    }
}

/// The error for a file whose fields are inconsistent.
pub(crate) fn refusal(path: &Path, error: SchemaError) -> CommandError {
    match error {
        SchemaError::NoPoints => command_error!(
            "{}: the file lists no points", shown(path) =>
            "add `points`, or give them in a file of their own with --points"
        ),
        other => CommandError::from(other).context(shown(path)),
    }
}
