//! `walpha check` of a filtration.

use std::fmt::{self, Display};
use std::path::Path;
use std::process::ExitCode;

use crate::check::{FiltrationCertificate, FiltrationFinding, certify_filtration};
use crate::progress::Stage;
use serde::Serialize;

use super::check::{MOST_LISTED, MOST_PRINTED};
use super::output::{name, tell};
use super::progress::Progress;
use super::report::SCHEMA_VERSION;
use super::{DIFFERENT, Global, complex_file};

#[derive(Serialize)]
struct Facts {
    schema_version: u32,
    input: String,
    points: usize,
    /// Cells, facets, edges, vertices.
    simplices: [usize; 4],
    valid: bool,
    findings_total: usize,
    /// The first of them.
    findings: Vec<FiltrationFinding>,
    certificate: FiltrationCertificate,
    seconds: f64,
}

/// Judges the filtration of a file.
pub fn run(global: Global, path: &Path, points: Option<&Path>) -> anyhow::Result<ExitCode> {
    let mut progress = Progress::new(global);
    let file = progress.stage(Stage::Read, || complex_file::read_filtration(path, points))?;
    let started = std::time::Instant::now();
    let (mut findings, certificate) =
        progress.stage(Stage::Certify, || certify_filtration(&file))?;
    let seconds = started.elapsed().as_secs_f64();
    progress.finish();
    let findings_total = findings.len();
    findings.truncate(MOST_LISTED);
    let facts = Facts {
        schema_version: SCHEMA_VERSION,
        input: path.display().to_string(),
        points: file.points.len(),
        simplices: [file.cells.len(), file.facets.len(), file.edges.len(), file.vertices.len()],
        valid: findings_total == 0,
        findings_total,
        findings,
        certificate,
        seconds,
    };
    tell(global, &facts)?;
    Ok(if facts.valid { ExitCode::SUCCESS } else { ExitCode::from(DIFFERENT) })
}

impl Display for Facts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [cells, facets, edges, vertices] = self.simplices;
        writeln!(f, "judged    {}: a filtration of {} points", name(&self.input), self.points)?;
        writeln!(
            f,
            "          {cells} cells, {facets} facets, {edges} edges, {vertices} vertices"
        )?;
        for rule in &self.certificate.triangulation.not_judged {
            writeln!(f, "not judged: {rule}")?;
        }
        for part in &self.certificate.not_judged {
            writeln!(f, "not judged: {part}")?;
        }
        for finding in self.findings.iter().take(MOST_PRINTED) {
            writeln!(f, "found     {finding}")?;
        }
        if self.findings_total > MOST_PRINTED {
            writeln!(f, "          and {} more", self.findings_total - MOST_PRINTED)?;
        }
        let verdict = if self.valid { "certified: no finding" } else { "wrong" };
        writeln!(
            f,
            "verdict   {verdict}, {} findings in {:.2} s",
            self.findings_total, self.seconds
        )
    }
}
