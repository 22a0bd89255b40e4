//! Processes of their own, and medians of them.

use std::process::Command;

use super::{RUNS, Result};

/// What one process says.
pub(super) struct Run {
    pub seconds: f64,
    /// The most memory it ever held, in bytes.
    pub peak: u64,
    /// What must agree.
    pub counts: String,
}

/// Runs everything in turn, several times; gives the medians of times and peaks.
pub(super) fn medians(runs: &[&dyn Fn() -> Result<Run>]) -> Result<Vec<Run>> {
    let mut done: Vec<Vec<Run>> = runs.iter().map(|_| Vec::new()).collect();
    for _ in 0..RUNS {
        for (run, done) in runs.iter().zip(&mut done) {
            done.push(run()?);
        }
    }
    let counts = done[0][0].counts.clone();
    let median = |mut of: Vec<Run>| {
        assert!(of.iter().all(|run| run.counts == counts), "counts differ");
        of.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let peak = of.iter().map(|run| run.peak).max().unwrap_or(0);
        Run { peak, ..of.swap_remove(RUNS / 2) }
    };
    Ok(done.into_iter().map(median).collect())
}

/// Seconds, peak KiB, counts.
pub(super) fn output(command: &mut Command) -> Result<Run> {
    let output = command.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let mut words = text.split_whitespace();
    let mut word = || words.next().ok_or("seconds and a peak");
    let (seconds, peak) = (word()?.parse()?, word()?.parse::<u64>()? << 10);
    Ok(Run { seconds, peak, counts: words.collect::<Vec<_>>().join(" ") })
}
