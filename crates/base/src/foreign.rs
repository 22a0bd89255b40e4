//! Calls decoders of other authors, and turns their panics into errors.

use std::any::Any;
use std::cell::Cell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

/// A decoder panicked. The file is damaged in a way that the decoder does not expect, or the decoder has a bug.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panicked {
    /// The message of the panic.
    pub message: String,
}

impl Panicked {
    fn new(payload: &dyn Any) -> Self {
        let text = payload.downcast_ref::<&str>().copied().map(str::to_owned);
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        // The message is put on one line.
        let message = text.unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
        Self { message }
    }
}

impl fmt::Display for Panicked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { message } = self;
        write!(f, "cannot be decoded: the decoder gave up ({message})")
    }
}

thread_local! {
    /// Whether this thread is inside a decoder.
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// Calls a decoder. What it borrows must not be used after a panic, as it may be half changed.
///
/// The first call installs a panic hook before that of the process, so that such panics of this thread are not printed. In a
/// program that aborts on panics, the hook prints the error, so that whoever restarts the program can show it, as the web page does.
///
/// ```
/// use walpha_base::foreign::decode;
///
/// assert_eq!(decode(|| 3), Ok(3));
/// let error = decode(|| [1, 2][std::hint::black_box(2)]).unwrap_err();
/// assert!(error.to_string().contains("index out of bounds"));
/// ```
///
/// # Errors
/// The decoder panicked.
pub fn decode<T>(decoder: impl FnOnce() -> T) -> Result<T, Panicked> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !WITHIN.get() {
                before(panic);
            } else if cfg!(panic = "abort") {
                eprintln!("{}", Panicked::new(panic.payload()));
            }
        }));
    });
    let outside = WITHIN.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decoder));
    WITHIN.set(outside);
    decoded.map_err(|payload| Panicked::new(&*payload))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_errors() {
        assert_eq!(decode(|| "text"), Ok("text"));
        let message = |error: Result<(), Panicked>| error.unwrap_err().message;
        assert_eq!(message(decode(|| panic!("a\n  b"))), "a b");
        assert_eq!(message(decode(|| panic!("{}", 1 + 1))), "2");
        assert_eq!(message(decode(|| std::panic::panic_any(7))), "");
        // A decoder may call another, and the thread goes on.
        assert_eq!(
            decode(|| decode(|| panic!("inner")).map_err(|e| e.message)),
            Ok(Err::<(), _>("inner".into()))
        );
        assert!(!WITHIN.get());
    }
}
