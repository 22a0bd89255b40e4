//! The running stage, its progress, and the time of each stage.

use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::cli::options::global::{Global, STACK};
use crate::progress::{Listener, Monitor, Stage};
use crate::threads;

/// The progress bar. There is only one, as there is only one standard error.
static BAR: LazyLock<ProgressBar> = LazyLock::new(|| {
    ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden())
        .with_style(style(WITHOUT_LENGTH))
});

/// The bar of a stage that does not report its progress.
const WITHOUT_LENGTH: &str = "{spinner} {msg} {elapsed}";
/// The bar of a stage that reports its progress.
const WITH_LENGTH: &str = "{spinner} {msg} [{bar:30}] {percent}% {elapsed}, {eta} left, {rate}";

/// Times stages by name and shows the running one on a terminal.
pub(crate) struct Progress {
    times: Arc<Mutex<Times>>,
    monitor: Monitor,
}

/// The seconds of the completed stages, and the running one.
struct Times {
    started: Instant,
    stages: Vec<(&'static str, f64)>,
    /// The running stage, and its start.
    running: Option<(&'static str, Instant)>,
}

/// The work that an interrupt cancels: the work started last.
static WORK: Mutex<Option<Monitor>> = Mutex::new(None);

/// Cancels the running work. Returns whether there is any.
pub(crate) fn cancel() -> bool {
    let work = WORK.lock().unwrap_or_else(PoisonError::into_inner);
    work.as_ref().inspect(|monitor| monitor.cancel()).is_some()
}

/// Whether the running work was cancelled.
pub(crate) fn is_cancelled() -> bool {
    let work = WORK.lock().unwrap_or_else(PoisonError::into_inner);
    work.as_ref().is_some_and(|monitor| monitor.check().is_err())
}

/// The name of the stage announced last, or "".
pub(crate) fn current() -> String {
    BAR.message()
}

/// Removes the bar, so that text can be printed.
pub(crate) fn clear() {
    BAR.finish_and_clear();
}

impl Progress {
    /// Shows progress on standard error if that is a terminal and neither `--quiet` nor `--verbose` was given.
    pub(crate) fn new(global: Global) -> Self {
        // A separate thread draws the bar, and cannot always be started.
        let watched = !global.quiet && !global.verbose && io::stderr().is_terminal();
        let watched = watched && threads::available(1, STACK) == 1;
        if watched {
            BAR.set_draw_target(ProgressDrawTarget::stderr());
            BAR.enable_steady_tick(Duration::from_millis(100));
        }
        let times = Times { started: Instant::now(), stages: Vec::new(), running: None };
        let times = Arc::new(Mutex::new(times));
        let monitor = Monitor::new(ProgressListener { times: Arc::clone(&times), drawn: watched });
        *WORK.lock().unwrap_or_else(PoisonError::into_inner) = Some(monitor.clone());
        Self { times, monitor }
    }

    /// Runs a stage. The times of calls with the same stage add up.
    pub(crate) fn stage<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        self.watch(|| {
            // Cancelled work ends at its next check.
            let _ = stage.begin();
            work()
        })
    }

    /// Runs work that reports the beginning of its stages, which are shown and timed.
    pub(crate) fn watch<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let result = self.monitor.watch(work);
        self.lock().end();
        result
    }

    fn lock(&self) -> MutexGuard<'_, Times> {
        self.times.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Removes the bar; returns the total seconds.
    pub(crate) fn total(self) -> f64 {
        self.finish().last().map_or(0.0, |(_, seconds)| *seconds)
    }

    /// Removes the bar; returns the seconds of each stage, and in total.
    pub(crate) fn finish(self) -> Vec<(&'static str, f64)> {
        clear();
        let times = self.lock();
        let mut stages = times.stages.clone();
        stages.push(("total", times.started.elapsed().as_secs_f64()));
        stages
    }
}

fn style(template: &str) -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        let rate = state.per_sec();
        // Errors of the progress bar are ignored.
        let _ = if rate < 10.0 {
            write!(out, "{rate:.1}/s")
        } else {
            write!(out, "{}/s", HumanCount(rate as u64))
        };
    };
    let style = ProgressStyle::with_template(template).expect("a valid template");
    style.with_key("rate", rate).progress_chars("=> ")
}

impl Times {
    fn begin(&mut self, name: &'static str) {
        self.end();
        self.running = Some((name, Instant::now()));
    }

    fn end(&mut self) {
        let Some((name, started)) = self.running.take() else { return };
        let seconds = started.elapsed().as_secs_f64();
        tracing::debug!(stage = name, seconds);
        match self.stages.iter_mut().find(|stage| stage.0 == name) {
            Some(stage) => stage.1 += seconds,
            None => self.stages.push((name, seconds)),
        }
    }
}

/// Times the stages, and updates the bar if it is drawn.
struct ProgressListener {
    times: Arc<Mutex<Times>>,
    drawn: bool,
}

impl Listener for ProgressListener {
    fn stage(&self, name: &'static str) {
        self.times.lock().unwrap_or_else(PoisonError::into_inner).begin(name);
        // The order matters, as each of these calls draws.
        BAR.set_style(style(WITHOUT_LENGTH));
        BAR.set_message(name);
        BAR.unset_length();
        BAR.reset();
    }

    fn progress(&self, done: u64, total: u64) {
        if !self.drawn {
            return;
        }
        if BAR.length() != Some(total) {
            BAR.set_style(style(WITH_LENGTH));
            BAR.set_length(total);
        }
        BAR.set_position(done);
    }
}
