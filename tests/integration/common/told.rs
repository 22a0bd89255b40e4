//! What an error says, and what it says to do.

use walpha::advice::Advice;
use walpha::points::{UnknownColumns, UnknownWeighting};
use walpha::shape::ShapeError;
use walpha::volume::UnknownFormat;
use walpha::{PointsError, VolumeError};

pub trait Told {
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
told![PointsError, ShapeError, UnknownColumns, UnknownFormat, UnknownWeighting, VolumeError];
