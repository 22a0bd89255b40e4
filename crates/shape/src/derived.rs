//! Values that are computed from a shape or a filtration when they are first needed, and kept.

use std::sync::{Arc, OnceLock};

/// A value that is computed once and shared by the clones of its shape. It follows from the rest of the shape, so all are
/// equal.
#[derive(Clone, Debug)]
pub(crate) struct Derived<T>(OnceLock<Arc<T>>);

impl<T> Derived<T> {
    /// Returns the value, which the first call computes; simultaneous calls may each compute it. No lock is held meanwhile: a
    /// thread that waits for its share of parallel work takes other work, which may need the same value.
    pub(crate) fn get(&self, compute: impl FnOnce() -> T) -> &T {
        if let Some(value) = self.0.get() {
            return value;
        }
        let value = Arc::new(compute());
        self.0.get_or_init(|| value)
    }
}

impl<T> Default for Derived<T> {
    fn default() -> Self {
        Self(OnceLock::new())
    }
}

impl<T> PartialEq for Derived<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

    use super::*;

    /// The first of three threads waits for the second, which computes a part of the value; meanwhile the third requests the
    /// value twice, and the first takes over one of these requests.
    #[test]
    fn values_may_be_computed_in_parallel_by_parallel_work() {
        let (done, wait) = channel();
        thread::spawn(move || {
            let three = rayon::ThreadPoolBuilder::new().num_threads(3).build();
            let value = Derived::default();
            let nap = |millis| thread::sleep(Duration::from_millis(millis));
            let compute = || {
                rayon::join(|| nap(5), || nap(100));
                1
            };
            let ask = || assert_eq!(*value.get(compute), 1);
            let ask_twice = || {
                nap(30);
                rayon::join(ask, ask);
            };
            three.expect("three threads").install(|| rayon::join(ask, ask_twice));
            done.send(()).expect("the test waits");
        });
        assert_eq!(wait.recv_timeout(Duration::from_secs(30)), Ok(()), "a thread waits for itself");
    }
}
