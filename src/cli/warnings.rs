//! The warnings of a run, which the JSON of its report repeats: standard error may not be looked at.

use std::fmt::{self, Debug};
use std::sync::{Mutex, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::Context;

/// What was heard so far.
static HEARD: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Hears warnings, once each.
pub(super) struct Listener;

impl<S: Subscriber> Layer<S> for Listener {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if *event.metadata().level() != Level::WARN {
            return;
        }
        let mut message = Message::default();
        event.record(&mut message);
        let mut heard = HEARD.lock().unwrap_or_else(PoisonError::into_inner);
        if !heard.contains(&message.0) {
            heard.push(message.0);
        }
    }
}

/// The text of an event.
#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            fmt::write(&mut self.0, format_args!("{value:?}")).expect("strings take all");
        }
    }
}

/// The warnings so far.
pub(super) fn heard() -> Vec<String> {
    HEARD.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
