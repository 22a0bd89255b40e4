//! What the system says of this process's memory, and large pieces of it that may not be had.

use std::cell::Cell;
use std::collections::TryReserveError;

use crate::advice::Advice;

/// The most memory this process ever held, in bytes; `None` where the system does not say (only
/// Linux does).
pub fn peak_bytes() -> Option<u64> {
    status("VmHWM:")
}

/// The memory this process holds now, in bytes; `None` where the system does not say.
pub fn resident_bytes() -> Option<u64> {
    status("VmRSS:")
}

/// Bytes as people read them: a whole number of the largest unit that leaves at least one.
pub fn readable(bytes: u64) -> String {
    let units = [(1 << 20, "MiB"), (1 << 10, "KiB"), (1, "bytes")];
    let (unit, name) = units.into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or(units[2]);
    format!("{} {name}", bytes / unit)
}

/// Gives freed memory back to the system, where the allocator would keep it for itself (glibc).
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

fn status(field: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(field))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// Memory for something large cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} needs {bytes} bytes of memory, which cannot be had")]
pub struct NoMemory {
    what: String,
    bytes: u128,
}

impl NoMemory {
    /// What to do about it.
    pub fn advice(&self) -> Advice {
        "make it smaller".into()
    }

    /// What was to be made.
    pub fn what(&self) -> &str {
        &self.what
    }

    /// The bytes that it needs.
    pub fn bytes(&self) -> u128 {
        self.bytes
    }
}

thread_local! {
    static ASKING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread asks for memory that it may be refused: a failure is an error then, and the end of
/// the process otherwise. For allocators of programs that must not end.
pub fn is_asking() -> bool {
    ASKING.get()
}

/// Asks for memory that may be refused, as [`is_asking`] then says.
///
/// # Errors
/// Those of the asking.
pub fn asking<T>(ask: impl FnOnce() -> Result<T, TryReserveError>) -> Result<T, TryReserveError> {
    let outer = ASKING.replace(true);
    let answer = ask();
    ASKING.set(outer);
    answer
}

/// Room for so many items, or an error that names what they are for. What is large, and grows with
/// what a user asks for, begins here.
///
/// # Errors
/// [`NoMemory`] where it cannot be had.
pub fn room<T>(count: usize, what: impl FnOnce() -> String) -> Result<Vec<T>, NoMemory> {
    let mut items = Vec::new();
    let bytes = count as u128 * size_of::<T>() as u128;
    asking(|| items.try_reserve_exact(count)).map_err(|_| NoMemory { what: what(), bytes })?;
    Ok(items)
}

/// Whether so many bytes can be had at once, or an error that names what they are for: a plan for
/// work that takes them piece by piece. They are asked for and given back, and other threads may
/// take them; so this finds what cannot be, and does not promise what can.
///
/// # Errors
/// [`NoMemory`] where they cannot be had.
pub fn afford(bytes: usize, what: impl FnOnce() -> String) -> Result<(), NoMemory> {
    room::<u8>(bytes, what).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_an_error() {
        let asked = room::<u64>(usize::MAX / 8, || "a volume".into());
        let text = asked.unwrap_err().to_string();
        assert!(text.starts_with("a volume needs 18446744073709551608 bytes"), "{text}");
        assert!(room::<u64>(1000, String::new).unwrap().capacity() >= 1000);
        let planned = afford(usize::MAX / 2, || "transforming it".into());
        let text = planned.unwrap_err().to_string();
        assert!(text.starts_with("transforming it needs 9223372036854775807 bytes"), "{text}");
        assert_eq!(afford(1000, String::new), Ok(()));
    }
}
