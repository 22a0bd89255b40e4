use super::Ordered;
use crate::ShapeError;

/// A component, loop or void of a filtration: the values between which it exists, and the simplices that begin and end it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Interval {
    /// The value, a squared length, of the simplex that begins it.
    pub birth: f64,
    /// The value of the simplex that ends it; ∞ if nothing does.
    pub death: f64,
    /// The number of the simplex that begins it.
    pub begins: u32,
    /// The number of the simplex that ends it; `None` if nothing does.
    pub ends: Option<u32>,
}

impl Ordered<'_> {
    /// The persistence diagram of a dimension: components (0), loops (1) and voids (2); for a torus also its own class (3).
    /// Classes that begin and end at the same value are left out. The order is that of deaths for dimensions 0 and 1, and of
    /// births for 2; classes that never end come last.
    ///
    /// Values are the doubles nearest to the exact ones, so birth and death may be one double where these differ.
    ///
    /// # Errors
    /// See [`loops`](Self::loops), for dimension 1.
    pub fn persistence(&self, dimension: usize) -> Result<Vec<Interval>, ShapeError> {
        let pairs = self.pairs();
        let (pairs, lasting) = match dimension {
            0 => (&pairs.components[..], &pairs.lasting[..]),
            1 => {
                let loops = self.loops()?;
                (&loops.pairs[..], &loops.lasting[..])
            }
            2 => (&pairs.voids[..], &pairs.lasting_voids[..]),
            3 => (&[][..], pairs.last.as_slice()),
            _ => (&[][..], &[][..]),
        };
        let value = |number: u32| self.simplex(number).value;
        let ended = pairs.iter().filter(|&&pair| self.lasts(pair)).map(|&[begins, ends]| {
            Interval { birth: value(begins), death: value(ends), begins, ends: Some(ends) }
        });
        let lasting = lasting.iter().map(|&begins| Interval {
            birth: value(begins),
            death: f64::INFINITY,
            begins,
            ends: None,
        });
        Ok(ended.chain(lasting).collect())
    }
}
