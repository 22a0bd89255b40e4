//! Tests of what the crate offers: in Rust alone, without the command.

mod levels;
mod numbers;
mod outofcore;
mod progress;
mod slabs;
mod solid;

/// Whether `sample:skull` can be read. It comes with CGAL's demo package, which a machine need
/// not have; where `WALPHA_REQUIRE_SKULL` is set, its absence is a failure and not an excuse.
fn has_skull() -> bool {
    let there = walpha_volume::sample("sample:skull");
    if let Err(error) = &there {
        assert!(std::env::var_os("WALPHA_REQUIRE_SKULL").is_none(), "{error}");
        eprintln!("skipped: {error}");
    }
    there.is_ok()
}
