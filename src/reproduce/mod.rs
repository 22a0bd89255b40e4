//! Reproduction of the paper: Table 1, Figures 1 to 11, and a report on whether our numbers bear out
//! each of its claims.
//!
//! Every verdict is a comparison of computed numbers, shown next to the paper's own numbers and words. Nothing is tuned to agree.

mod compare;
mod error;
mod figures;
mod html;
mod off;
pub mod plane;
mod report;
mod study;
mod text;

pub use error::ReproduceError;
pub use html::page;
pub use off::{OffError, OffMesh};
pub use report::ShapeNumbers;
pub use report::{Fact, File, Finding, Input, Item, Report, Table, Verdict};
pub use study::Subject;

use walpha_base::Monitor;

use study::{Clock, Shapes, Study};

/// The report, and the files that belong to it.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Every number and verdict.
    pub report: Report,
    /// Figures and meshes.
    pub files: Vec<File>,
}

/// Makes the table and all figures, and judges the paper's claims.
///
/// Stages are reported to the monitor. Everything but [`Report::seconds`] is a function of
/// the subject alone. A quarter of a minute for 64³ samples on two cores; memory for one whole
/// triangulation of the points for each thread, for the shapes and for the files.
///
/// # Errors
/// When the subject yields no points, or points that span no volume.
pub fn reproduce(subject: &Subject<'_>, monitor: &Monitor) -> Result<Reproduction, ReproduceError> {
    let mut clock = Clock::new(monitor);
    clock.enter("wavelets and points")?;
    let study = Study::new(subject, monitor)?;
    let shapes = Shapes::new(&study, &mut clock)?;
    let mut bench = figures::Bench::new(&study, &shapes, monitor);
    let mut items = Vec::new();
    for (done, (name, make)) in figures::ALL.into_iter().enumerate() {
        clock.enter(name)?;
        monitor.report(done as u64, figures::ALL.len() as u64)?;
        items.push(make(&mut bench)?);
    }
    let files = bench.files;
    let report = Report::new(study.input(), subject.date, items, clock.stop());
    Ok(Reproduction { report, files })
}
