//! What the system says of this process's memory.

/// The most memory this process ever held, in bytes; `None` where the system does not tell (only
/// Linux does).
pub fn peak_bytes() -> Option<u64> {
    status("VmHWM:")
}

/// The memory this process holds now, in bytes; `None` where the system does not tell.
pub fn resident_bytes() -> Option<u64> {
    status("VmRSS:")
}

/// Bytes as people read them: a whole number of the largest unit that leaves at least one.
pub(crate) fn readable(bytes: u64) -> String {
    let units = [(1 << 20, "MiB"), (1 << 10, "KiB"), (1, "bytes")];
    let (unit, name) = units.into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or(units[2]);
    format!("{} {name}", bytes / unit)
}

fn status(field: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(field))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
