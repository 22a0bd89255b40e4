//! Reproduction of the paper: Table 1, Figures 1 to 11, and a report on whether our numbers confirm each of its claims.
//!
//! Every verdict is a comparison of computed numbers, shown next to the paper's own numbers and words. Nothing is tuned to agree
//! with the paper.

mod compare;
mod error;
mod figures;
mod html;
mod markdown;
mod off;
mod origin;
pub mod plane;
mod report;
mod study;
mod text;

pub use error::ReproduceError;
pub use html::page;
pub use markdown::markdown;
pub use off::{OffError, OffMesh};
pub use origin::{Checksum, Origin};
pub use report::ShapeNumbers;
pub use report::{Fact, File, Finding, Input, Item, Report, Table, Verdict};
pub use study::Subject;

use std::collections::BTreeSet;

use walpha_base::Monitor;

use figures::Entry;
use study::{Clock, Shapes, Study};

/// The report, and the files that belong to it.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Every number and verdict.
    pub report: Report,
    /// Figures and meshes.
    pub files: Vec<File>,
}

/// The name of an item: `table-1`, `figure-01` to `figure-11`, `extension-1`, `extension-2`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ItemName(&'static str);

impl ItemName {
    /// All names, in the order of the report.
    pub fn all() -> impl Iterator<Item = Self> {
        figures::ALL.iter().map(|entry| Self(entry.name))
    }

    /// The item of this name, if there is one.
    pub fn find(name: &str) -> Option<Self> {
        Self::all().find(|item| item.0 == name)
    }

    /// The name.
    pub fn as_str(self) -> &'static str {
        self.0
    }
}

/// Makes the table and all figures, and judges the paper's claims.
///
/// Stages are reported to the monitor. Everything except [`Report::seconds`] depends only on the subject. Takes a quarter of a
/// minute for 64³ samples on two cores, and memory for a whole triangulation of the points for each thread, for the shapes and
/// for the files.
///
/// # Errors
/// The subject yields no points, or points that span no volume.
pub fn reproduce(subject: &Subject<'_>) -> Result<Reproduction, ReproduceError> {
    let all: Vec<ItemName> = ItemName::all().collect();
    reproduce_only(subject, &all)
}

/// Makes the named items, each in the same way as [`reproduce`] and with the same files, in its order. Shapes that none of them
/// needs are not computed.
///
/// # Errors
/// The subject yields no points, or points that span no volume.
pub fn reproduce_only(
    subject: &Subject<'_>,
    names: &[ItemName],
) -> Result<Reproduction, ReproduceError> {
    let monitor = &*Monitor::current();
    let asked = |entry: &&Entry| names.contains(&ItemName(entry.name));
    let entries: Vec<&Entry> = figures::ALL.iter().filter(asked).collect();
    let needed: BTreeSet<_> = entries.iter().flat_map(|entry| entry.needs).copied().collect();
    let mut clock = Clock::new(monitor);
    clock.enter("wavelets and points")?;
    let study = Study::new(subject, monitor)?;
    clock.enter("shapes")?;
    let shapes = Shapes::new(&study, &needed)?;
    let mut bench = figures::Bench::new(&study, &shapes, monitor);
    let mut items = Vec::new();
    for (done, entry) in entries.iter().enumerate() {
        clock.enter(entry.stage)?;
        monitor.report(done as u64, entries.len() as u64)?;
        let name = ItemName(entry.name);
        let item = (entry.make)(&mut bench)?;
        items.push(Item { id: entry.name, command: subject.command(Some(name)), ..item });
    }
    let files = bench.files;
    let report = Report::new(study.input(Origin::of(subject)?), subject, items, clock.stop());
    Ok(Reproduction { report, files })
}
