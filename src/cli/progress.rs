//! Which stage is at work, how far it is, and how long each took.

use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use tracing::field::{Field, Visit};
use tracing_subscriber::layer::Context;

use crate::progress::Stage;

use super::{Global, STACK};
use crate::threads;

/// What a terminal shows. There is one, as there is one standard error.
static BAR: LazyLock<ProgressBar> = LazyLock::new(|| {
    ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(style(STAGE))
});

/// The bar of a stage that does not report how far it is.
const STAGE: &str = "{spinner} {msg} {elapsed}";
/// Of one that does.
const PART: &str = "{spinner} {msg} [{bar:30}] {percent}% {elapsed}, {eta} left, {rate}";

/// Times stages by name and shows the running one on a terminal.
pub(super) struct Progress {
    started: Instant,
    stages: Vec<(&'static str, f64)>,
    /// What is at work, and since when.
    running: Option<(Stage, Instant)>,
}

/// The stage that was announced last, or "".
pub(super) fn current() -> String {
    BAR.message()
}

/// Takes the bar away, so that something can be said.
pub(super) fn clear() {
    BAR.finish_and_clear();
}

impl Progress {
    /// Draws on standard error if that is a terminal and nobody asked for quiet.
    pub(super) fn new(global: Global) -> Self {
        // What draws is a thread of its own, which cannot always be had.
        let watched = !global.quiet && !global.verbose && io::stderr().is_terminal();
        if watched && threads::available(1, STACK) == 1 {
            BAR.set_draw_target(ProgressDrawTarget::stderr());
            BAR.enable_steady_tick(Duration::from_millis(100));
        }
        Self { started: Instant::now(), stages: Vec::new(), running: None }
    }

    /// Runs a stage. Calls with the same stage add up.
    pub(super) fn stage<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        self.watch(|hear| {
            hear(stage);
            work()
        })
    }

    /// Runs work that says which stage begins.
    pub(super) fn watch<T>(&mut self, work: impl FnOnce(&mut dyn FnMut(Stage)) -> T) -> T {
        let result = work(&mut |stage| self.begin(stage));
        self.end();
        result
    }

    fn begin(&mut self, stage: Stage) {
        self.end();
        // In this order: each of them draws.
        BAR.set_style(style(STAGE));
        Self::show(stage.name());
        BAR.unset_length();
        BAR.reset();
        self.running = Some((stage, Instant::now()));
    }

    fn end(&mut self) {
        let Some((stage, started)) = self.running.take() else { return };
        let (name, seconds) = (stage.name(), started.elapsed().as_secs_f64());
        tracing::debug!(stage = name, seconds);
        match self.stages.iter_mut().find(|stage| stage.0 == name) {
            Some(stage) => stage.1 += seconds,
            None => self.stages.push((name, seconds)),
        }
    }

    /// Shows what is at work, without timing it: a step of the stage before.
    pub(super) fn show(name: &'static str) {
        BAR.set_message(name);
    }

    /// Ends the show: seconds in all.
    pub(super) fn total(self) -> f64 {
        self.finish().last().map_or(0.0, |(_, seconds)| *seconds)
    }

    /// Ends the show: seconds per stage, and in all.
    pub(super) fn finish(self) -> Vec<(&'static str, f64)> {
        clear();
        let mut stages = self.stages;
        stages.push(("total", self.started.elapsed().as_secs_f64()));
        stages
    }
}

fn style(template: &str) -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        let rate = state.per_sec();
        // An error of the progress bar is nobody's concern.
        let _ = if rate < 10.0 {
            write!(out, "{rate:.1}/s")
        } else {
            write!(out, "{}/s", HumanCount(rate as u64))
        };
    };
    let style = ProgressStyle::with_template(template).expect("a template that is right");
    style.with_key("rate", rate).progress_chars("=> ")
}

/// Hears how far the library is: events of the target [`crate::progress::TARGET`].
pub(super) struct Listener;

impl<S: tracing::Subscriber> tracing_subscriber::Layer<S> for Listener {
    fn on_event(&self, event: &tracing::Event<'_>, _: Context<'_, S>) {
        let mut amount = Amount::default();
        event.record(&mut amount);
        let Amount { done, total } = amount;
        if BAR.length() != Some(total) {
            BAR.set_style(style(PART));
            BAR.set_length(total);
        }
        BAR.set_position(done);
    }
}

/// So much is done of so much.
#[derive(Default)]
struct Amount {
    done: u64,
    total: u64,
}

impl Visit for Amount {
    fn record_u64(&mut self, field: &Field, value: u64) {
        match field.name() {
            "done" => self.done = value,
            "total" => self.total = value,
            _ => {}
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn fmt::Debug) {}
}
