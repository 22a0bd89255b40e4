//! Tests of what the crate offers: in Rust alone, without the command.

mod crystals;
mod haar;
mod molecules;
mod points;
mod wvm;

use walpha_base::advice::Advise;

/// The message and the advice in one text.
trait Told: Advise {
    fn told(&self) -> String {
        self.advice().map_or(self.to_string(), |advice| format!("{self}; {advice}"))
    }
}

impl<E: Advise> Told for E {}
