//! The memory of this process as the system reports it, and large allocations that may fail.

use std::cell::Cell;
use std::collections::TryReserveError;

use crate::advice::{Advice, Advise, Category};

/// The peak memory of this process in bytes; `None` where the system does not report it (only Linux does).
pub fn peak_bytes() -> Option<u64> {
    status("VmHWM:")
}

/// The current memory of this process in bytes; `None` where the system does not report it.
pub fn resident_bytes() -> Option<u64> {
    status("VmRSS:")
}

/// Bytes in readable form: a whole number of the largest unit of which there is at least one.
pub fn readable(bytes: u64) -> String {
    let units = [(1 << 20, "MiB"), (1 << 10, "KiB"), (1, "bytes")];
    let (unit, name) = units.into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or(units[2]);
    format!("{} {name}", bytes / unit)
}

/// Returns freed memory to the system where the allocator would keep it (glibc).
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        #[expect(unsafe_code, reason = "takes any number, at any time")]
        unsafe extern "C" {
            safe fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        malloc_trim(0);
    }
}

/// Lets threads share heaps where the address space of this process is limited. The GNU C library gives each thread a heap of its
/// own, which takes 64 MiB of addresses even while it is empty (`M_ARENA_MAX` in mallopt(3)).
pub(crate) fn share_heaps() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        const M_ARENA_MAX: std::ffi::c_int = -8;
        /// One heap for each GiB takes a sixteenth of the remaining addresses.
        const EACH: u64 = 1 << 30;
        #[expect(unsafe_code, reason = "takes any numbers, at any time")]
        unsafe extern "C" {
            safe fn mallopt(parameter: std::ffi::c_int, value: std::ffi::c_int) -> std::ffi::c_int;
        }
        if let Some(left) = address_space_left() {
            mallopt(M_ARENA_MAX, i32::try_from(left / EACH).unwrap_or(i32::MAX).max(1));
        }
    }
}

/// The bytes of address space that a limit (`RLIMIT_AS`) leaves; `None` without a limit.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn address_space_left() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = limit.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(status("VmSize:")?))
}

fn status(field: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(field))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// The error for a large allocation that fails for lack of memory.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not enough memory: {what} needs {}", readable(u64::try_from(*bytes).unwrap_or(u64::MAX)))]
pub struct NoMemory {
    what: String,
    bytes: u128,
}

impl Advise for NoMemory {
    fn advice(&self) -> Option<Advice> {
        Some("crop or downsample the input, or ask for a smaller result".into())
    }

    fn category(&self) -> Category {
        Category::Memory
    }
}

impl NoMemory {
    /// What the memory was for.
    pub fn what(&self) -> &str {
        &self.what
    }

    /// The number of bytes needed.
    pub fn bytes(&self) -> u128 {
        self.bytes
    }
}

thread_local! {
    static ASKING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is making an allocation that may fail. If such an allocation fails, the failure is an error; any other
/// failure ends the process. For allocators of programs that must not end.
pub fn is_asking() -> bool {
    ASKING.get()
}

/// Makes an allocation that may fail, during which [`is_asking`] is true.
///
/// # Errors
/// Errors of the allocation.
pub fn asking<T>(ask: impl FnOnce() -> Result<T, TryReserveError>) -> Result<T, TryReserveError> {
    let outer = ASKING.replace(true);
    let answer = ask();
    ASKING.set(outer);
    answer
}

/// Returns an empty vector with capacity for `count` items, or an error that names `what` they are for. For all allocations whose
/// size depends on a user's request.
///
/// # Errors
/// [`NoMemory`].
pub fn try_with_capacity<T>(
    count: usize,
    what: impl FnOnce() -> String,
) -> Result<Vec<T>, NoMemory> {
    let mut items = Vec::new();
    let bytes = count as u128 * size_of::<T>() as u128;
    asking(|| items.try_reserve_exact(count)).map_err(|_| NoMemory { what: what(), bytes })?;
    Ok(items)
}

/// Makes room for `additional` more items in a growing vector, or returns an error that names `what` they are for.
///
/// # Errors
/// [`NoMemory`].
pub fn try_reserve<T>(
    items: &mut Vec<T>,
    additional: usize,
    what: impl FnOnce() -> String,
) -> Result<(), NoMemory> {
    let bytes = (items.len() as u128 + additional as u128) * size_of::<T>() as u128;
    asking(|| items.try_reserve(additional)).map_err(|_| NoMemory { what: what(), bytes })
}

/// Checks that `bytes` bytes are available at once before work that takes them piece by piece, or returns an error that names
/// `what` they are for. They are allocated and freed, and other threads may then take them: this detects what is impossible, but
/// does not guarantee what is possible.
///
/// # Errors
/// [`NoMemory`].
pub fn afford(bytes: usize, what: impl FnOnce() -> String) -> Result<(), NoMemory> {
    try_with_capacity::<u8>(bytes, what).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_an_error() {
        let asked = try_with_capacity::<u64>(usize::MAX / 8, || "a volume".into());
        let text = asked.unwrap_err().to_string();
        assert!(text == "not enough memory: a volume needs 17592186044415 MiB", "{text}");
        assert!(try_with_capacity::<u64>(1000, String::new).unwrap().capacity() >= 1000);
        let planned = afford(usize::MAX / 2, || "transforming it".into());
        let text = planned.unwrap_err().to_string();
        assert!(text == "not enough memory: transforming it needs 8796093022207 MiB", "{text}");
        assert_eq!(afford(1000, String::new), Ok(()));
    }
}
