//! Which stage is at work, and how long each took.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Global;

/// Times stages by name and shows the running one on a terminal.
pub struct Progress {
    bar: ProgressBar,
    started: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Progress {
    /// Draws on standard error if that is a terminal and nobody asked for quiet.
    pub fn new(global: Global) -> Self {
        let target = if global.quiet || global.verbose {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(None, target);
        let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
        bar.set_style(style.expect("a template that is right"));
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar, started: Instant::now(), stages: Vec::new() }
    }

    /// Runs a stage. Calls with the same name add up.
    pub fn stage<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        self.bar.set_message(name);
        let started = Instant::now();
        let result = work();
        let seconds = started.elapsed().as_secs_f64();
        tracing::debug!(stage = name, seconds);
        match self.stages.iter_mut().find(|stage| stage.0 == name) {
            Some(stage) => stage.1 += seconds,
            None => self.stages.push((name, seconds)),
        }
        result
    }

    /// Shows what is at work, without timing it.
    pub fn show(&self, name: &'static str) {
        self.bar.set_message(name);
    }

    /// Ends the show: seconds per stage, and in all.
    pub fn finish(self) -> Vec<(&'static str, f64)> {
        self.bar.finish_and_clear();
        let mut stages = self.stages;
        stages.push(("total", self.started.elapsed().as_secs_f64()));
        stages
    }
}
