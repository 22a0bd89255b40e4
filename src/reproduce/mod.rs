//! The paper, made again: Table 1, Figures 1 to 11, and a report that says of each claim
//! whether our numbers bear it out.
//!
//! Every verdict is a comparison of computed numbers; the paper's own numbers and words stand
//! beside them. Nothing is tuned to agree.

mod compare;
mod error;
mod figures;
mod html;
mod off;
pub mod plane;
mod report;
mod study;
mod text;

use std::time::Instant;

pub use error::ReproduceError;
pub use html::page;
pub use off::{OffError, OffMesh};
pub use report::ShapeNumbers;
pub use report::{Fact, Finding, Input, Item, Report, Table, Verdict};

use walpha_base::Cancelled;
use walpha_base::Monitor;

use crate::volume::{GrayRange, Volume};
use study::{Shapes, Study};

/// What the paper is made again on.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// The gray levels.
    pub volume: &'a Volume,
    /// The values that became gray 0 and 255.
    pub range: GrayRange,
    /// What a user writes to get this volume: a sample's name, or a file.
    pub name: &'a str,
    /// The day to write into the report, as 2025-12-31.
    pub date: &'a str,
}

/// The report, and the files that belong beside it.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Every number and verdict.
    pub report: Report,
    /// Figures and meshes.
    pub files: Vec<File>,
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// Makes the table and all figures, and judges the paper's claims.
///
/// The monitor hears what is being worked at. Everything but [`Report::seconds`] is a function of
/// the subject alone. Half a minute for 64³ samples on two cores; memory for one whole
/// triangulation of the points and for the files.
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

/// Times stages, and logs them.
pub(crate) struct Clock<'a> {
    monitor: &'a Monitor,
    running: Option<(&'static str, Instant)>,
    started: Instant,
    seconds: Vec<(&'static str, f64)>,
}

impl<'a> Clock<'a> {
    fn new(monitor: &'a Monitor) -> Self {
        Self { monitor, running: None, started: Instant::now(), seconds: Vec::new() }
    }

    /// Ends the running stage and starts another. Stages of the same name add up.
    fn enter(&mut self, name: &'static str) -> Result<(), Cancelled> {
        self.end();
        self.monitor.stage(name)?;
        self.running = Some((name, Instant::now()));
        Ok(())
    }

    fn end(&mut self) {
        if let Some((name, since)) = self.running.take() {
            let seconds = since.elapsed().as_secs_f64();
            match self.seconds.iter_mut().find(|stage| stage.0 == name) {
                Some(stage) => stage.1 += seconds,
                None => self.seconds.push((name, seconds)),
            }
        }
    }

    /// Seconds of each stage, and of all.
    fn stop(mut self) -> Vec<(&'static str, f64)> {
        self.end();
        self.seconds.push(("total", self.started.elapsed().as_secs_f64()));
        self.seconds
    }
}
