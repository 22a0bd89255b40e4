//! Runs of processes, and their medians.

use std::process::Command;
use std::time::Instant;

use super::Result;
use super::peers::Contestant;

const RUNS: usize = 5;

/// The resources and results of a process.
#[derive(Clone)]
pub(super) struct Run {
    /// Seconds from its start to its end.
    pub process: f64,
    /// Seconds of the work alone.
    pub work: f64,
    /// The most memory it held, in bytes; 0 where that is not known.
    pub peak: u64,
    /// Cells of the shape, and facets, edges and vertices by class; empty where it gives none.
    pub counts: String,
}

/// Runs everything in turn, several times. Gives the medians of times, and the largest peaks.
pub(super) fn medians(contestants: &[Contestant]) -> Result<Vec<Run>> {
    let mut done: Vec<Vec<Run>> = contestants.iter().map(|_| Vec::new()).collect();
    for _ in 0..RUNS {
        for (contestant, done) in contestants.iter().zip(&mut done) {
            done.push((contestant.run)().map_err(|error| format!("{}: {error}", contestant.name))?);
        }
    }
    let counts = done.iter().flatten().map(|run| &run.counts).find(|counts| !counts.is_empty());
    let agree = |run: &Run| run.counts.is_empty() || Some(&run.counts) == counts;
    if let Some(wrong) = done.iter().flatten().find(|run| !agree(run)) {
        return Err(format!("counts differ: {counts:?} and {}", wrong.counts).into());
    }
    let median = |of: &[Run], seconds: fn(&Run) -> f64| {
        let mut all: Vec<f64> = of.iter().map(seconds).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let of = |of: &Vec<Run>| Run {
        process: median(of, |run| run.process),
        work: median(of, |run| run.work),
        peak: of.iter().map(|run| run.peak).max().unwrap_or(0),
        counts: String::new(),
    };
    Ok(done.iter().map(of).collect())
}

/// A process whose last line has seconds of the work, its peak in KiB, and counts if it gives them.
pub(super) fn run(command: &mut Command) -> Result<Run> {
    let (text, process) = output(command)?;
    let mut words = text.lines().last().unwrap_or_default().split_whitespace();
    let mut word = || words.next().ok_or("it printed no seconds and peak");
    let (work, peak) = (word()?.parse()?, word()?.parse::<u64>()? << 10);
    Ok(Run { process, work, peak, counts: words.collect::<Vec<_>>().join(" ") })
}

/// The output of a process, and its seconds.
pub(super) fn output(command: &mut Command) -> Result<(String, f64)> {
    let started = Instant::now();
    let output = command.output()?;
    let seconds = started.elapsed().as_secs_f64();
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok((String::from_utf8(output.stdout)?, seconds))
}
