//! The threads that work for calls. They stay when a call has ended, and work for the next one.

use std::cell::OnceCell;
use std::num::NonZeroUsize;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::{mem, process};

use pyo3::PyResult;
use pyo3::exceptions::PyMemoryError;
use rayon::{ThreadPool, ThreadPoolBuilder};
use walpha::threads;

use crate::allocator::starting;
use crate::call::Call;

/// The size of the stack of a main thread; rayon's default is a quarter of it.
const STACK: usize = 8 << 20;
/// How many pools are kept for later calls. Calls at the same time need one each.
const KEPT: usize = 4;

/// The pools that work for no call, the last used one at the end.
static IDLE: Mutex<Vec<Arc<Pool>>> = Mutex::new(Vec::new());

thread_local! {
    /// The place of the pool that this thread belongs to.
    static PLACE: OnceCell<Arc<Place>> = const { OnceCell::new() };
}

/// Threads that work for one call at a time. Dropping this, when all work of the call has ended, keeps them for another call.
#[derive(Debug)]
pub struct Workers(Arc<Pool>);

#[derive(Debug)]
struct Pool {
    threads: ThreadPool,
    place: Arc<Place>,
    /// The process that the threads are in.
    process: u32,
}

/// The call that the threads of a pool work for. Nothing is allocated while this is locked, as the allocator locks it.
#[derive(Debug, Default)]
struct Place(Mutex<Option<Arc<Call>>>);

impl Workers {
    /// As many threads as asked for, else as `RAYON_NUM_THREADS` says, else one for each processor. If the system cannot start so
    /// many, there are fewer, or those of another number that were kept.
    ///
    /// # Errors
    /// The system cannot start one, and none are kept.
    pub fn take(asked: Option<NonZeroUsize>) -> PyResult<Self> {
        let wanted = threads::wanted(asked.map(NonZeroUsize::get));
        if let Some(pool) = idle(|count| count == wanted) {
            return Ok(Self(pool));
        }
        let pool = starting(|| {
            let available = threads::available(wanted, STACK);
            let kept = (available < wanted).then(|| idle(|count| count >= available));
            kept.flatten().map_or_else(|| Pool::start(available).map(Arc::new), Ok)
        });
        pool.map(Self)
    }

    /// Begins work for a call in these threads, and passes them to it.
    pub fn begin(self, call: &Arc<Call>, work: impl FnOnce(Self) + Send + 'static) {
        self.0.place.set(Some(Arc::clone(call)));
        let pool = Arc::clone(&self.0);
        pool.threads.spawn(move || work(self));
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        self.0.place.set(None);
        keep(Arc::clone(&self.0));
    }
}

impl Pool {
    fn start(count: usize) -> PyResult<Self> {
        if count == 0 {
            return Err(no_threads());
        }
        let place = Arc::<Place>::default();
        let given = Arc::clone(&place);
        let threads = ThreadPoolBuilder::new()
            .num_threads(count)
            .thread_name(|i| format!("walpha {i}"))
            .stack_size(STACK)
            .start_handler(move |_| {
                PLACE.with(|place| {
                    place.get_or_init(|| Arc::clone(&given));
                });
                #[cfg(feature = "cgal")]
                walpha::cgal::prepare_thread();
            })
            .build()
            .map_err(|_| no_threads())?;
        // A thread that finds no memory when it starts ends the process, so no work begins before all have started.
        threads.broadcast(|_| ());
        Ok(Self { threads, place, process: process::id() })
    }
}

impl Place {
    fn lock(&self) -> MutexGuard<'_, Option<Arc<Call>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set(&self, call: Option<Arc<Call>>) {
        let before = mem::replace(&mut *self.lock(), call);
        drop(before);
    }
}

/// Takes a kept pool with a suitable number of threads.
fn idle(suits: impl Fn(usize) -> bool) -> Option<Arc<Pool>> {
    let mut pools = pools()?;
    let at = pools.iter().rposition(|pool| suits(pool.threads.current_num_threads()))?;
    Some(pools.remove(at))
}

/// Keeps a pool for later calls, instead of the one that has not been used for the longest time if there are too many.
fn keep(pool: Arc<Pool>) {
    let Some(mut pools) = pools() else { return };
    let surplus = (pools.len() >= KEPT).then(|| pools.remove(0));
    pools.push(pool);
    drop(pools);
    // Its threads end.
    drop(surplus);
}

/// The kept pools, unless they are locked. This does not wait: in a child process that was forked at such a moment they stay locked.
fn pools() -> Option<MutexGuard<'static, Vec<Arc<Pool>>>> {
    let mut pools = IDLE.try_lock().ok()?;
    // A child process has none of its parent's threads, so it cannot end them either.
    let process = process::id();
    pools.extract_if(.., |pool| pool.process != process).for_each(mem::forget);
    Some(pools)
}

/// Whether this is one of these threads. If so, the call that it works for, if any, is ended since memory has run out. Allocates
/// nothing.
pub fn starve() -> bool {
    let starve = |place: &OnceCell<Arc<Place>>| {
        let place = place.get()?;
        if let Some(call) = &*place.lock() {
            call.starve();
        }
        Some(())
    };
    PLACE.try_with(starve).is_ok_and(|starved| starved.is_some())
}

/// The memory that was free when threads were counted may be gone when they start.
fn no_threads() -> pyo3::PyErr {
    PyMemoryError::new_err(
        "no threads to work in: memory, or the number of processes, is limited too much",
    )
}
