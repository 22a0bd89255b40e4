use std::fmt;

use serde::{Deserialize, Serialize};
use walpha_base::advice::Advise;
use walpha_base::shown::counted;

/// The Betti numbers of a shape: components, tunnels, voids. Written `[b0, b1, b2]`, and `[b0, b1, b2, b3]` for a torus. The
/// fields are public because this is plain data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<u64>", try_from = "Vec<u64>")]
pub struct Betti {
    /// Connected components.
    pub b0: u64,
    /// Tunnels: independent loops that bound nothing; on a torus, also those that wind round it.
    pub b1: u64,
    /// Voids: bounded components of the complement. On a torus, independent closed surfaces that bound nothing: if the shape does
    /// not cover the torus, the surfaces around the parts of the complement, one fewer than there are, and one for each direction
    /// in which the complement does not wind round.
    pub b2: u64,
    /// On a torus: 1 for the whole torus, otherwise 0. `None` in space, where it is always 0.
    pub b3: Option<u64>,
}

/// Writes words in space and letters on a torus.
impl fmt::Display for Betti {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { b0, b1, b2, b3 } = *self;
        if let Some(b3) = b3 {
            return write!(f, "b0 = {b0}, b1 = {b1}, b2 = {b2}, b3 = {b3} in the periodic box");
        }
        let (components, tunnels, voids) =
            (counted(b0, "component"), counted(b1, "tunnel"), counted(b2, "void"));
        write!(f, "{components}, {tunnels}, {voids}")
    }
}

impl Betti {
    /// The Betti numbers of a shape in space.
    pub fn in_space(b0: u64, b1: u64, b2: u64) -> Self {
        Self { b0, b1, b2, b3: None }
    }

    /// The Betti numbers, with b1 from the Euler characteristic: b1 = b0 + b2 − b3 − χ.
    pub(crate) fn with_euler(b0: u64, b2: u64, b3: Option<u64>, euler: i64) -> Self {
        let b1 = (b0 + b2) as i64 - b3.unwrap_or(0) as i64 - euler;
        Self { b0, b1: u64::try_from(b1).expect("b1 counts something"), b2, b3 }
    }
}

impl From<Betti> for [u64; 3] {
    fn from(betti: Betti) -> Self {
        [betti.b0, betti.b1, betti.b2]
    }
}

impl From<Betti> for Vec<u64> {
    fn from(Betti { b0, b1, b2, b3 }: Betti) -> Self {
        [b0, b1, b2].into_iter().chain(b3).collect()
    }
}

/// A list with a wrong number of Betti numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{given} Betti numbers: there must be three, or four of a torus")]
#[non_exhaustive]
pub struct BettiError {
    /// The number of numbers that were given.
    pub given: usize,
}

impl Advise for BettiError {}

impl TryFrom<Vec<u64>> for Betti {
    type Error = BettiError;

    fn try_from(numbers: Vec<u64>) -> Result<Self, Self::Error> {
        match numbers[..] {
            [b0, b1, b2] => Ok(Self::in_space(b0, b1, b2)),
            [b0, b1, b2, b3] => Ok(Self { b0, b1, b2, b3: Some(b3) }),
            _ => Err(BettiError { given: numbers.len() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_numbers_or_four() {
        let betti = |numbers: &[u64]| Betti::try_from(numbers.to_vec());
        assert_eq!(betti(&[1, 2, 3]), Ok(Betti::in_space(1, 2, 3)));
        assert_eq!(betti(&[1, 3, 3, 1]).map(Vec::from), Ok(vec![1, 3, 3, 1]));
        let error = betti(&[1, 2]).unwrap_err();
        assert_eq!(error.to_string(), "2 Betti numbers: there must be three, or four of a torus");
    }
}
