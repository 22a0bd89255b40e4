//! Tests of what the crate offers: in Rust alone, without the command.

mod haar;
mod points;
mod wvm;

use walpha_base::advice::Advice;
use walpha_points::{PointsError, UnknownColumns, UnknownWeighting};

trait Told {
    /// The message and the advice in one text.
    fn told(&self) -> String;
}

macro_rules! told {
    ($($error:ty),*) => {
        $(impl Told for $error {
            fn told(&self) -> String {
                let advice: Option<Advice> = self.advice().into();
                advice.map_or(self.to_string(), |advice| format!("{self}; {advice}"))
            }
        })*
    };
}
told![PointsError, UnknownColumns, UnknownWeighting];
