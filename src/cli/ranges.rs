//! Ranges along x, y and z: X0:X1,Y0:Y1,Z0:Z1.

use crate::points;
use crate::volume::Region;

use super::errors::{CommandError, command_error, fail};

/// The ends of three ranges as text, without surrounding white space.
fn ends(text: &str) -> Result<[[&str; 2]; 3], CommandError> {
    let ranges: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = ranges.as_slice() else {
        fail!("three ranges are needed" => "give those of x, y and z, as in 20:40,20:40,10:30");
    };
    let mut ends = [[""; 2]; 3];
    for (range, ends) in [x, y, z].into_iter().zip(&mut ends) {
        let Some((first, end)) = range.split_once(':') else {
            fail!("`{range}` is not a range" => "give two numbers, as in 20:40");
        };
        *ends = [first.trim(), end.trim()];
    }
    Ok(ends)
}

/// Samples from one index up to, and without, another; ends may be omitted.
pub(super) fn samples(text: &str) -> Result<Region, CommandError> {
    let mut region = Region::default();
    for (k, [first, end]) in ends(text)?.into_iter().enumerate() {
        let index = |text: &str| {
            match text {
            "" => Ok(None),
            text => text.parse().map(Some).map_err(
                |_| command_error!("`{text}` is not an index of a sample" => "give whole numbers, as in 20:40"),
            ),
        }
        };
        (region.first[k], region.end[k]) = (index(first)?.unwrap_or(0), index(end)?);
    }
    Ok(region)
}

/// A box in the units of the points, borders included.
pub(super) fn places(text: &str) -> Result<points::Region, CommandError> {
    let mut region = points::Region { low: [0.0; 3], high: [0.0; 3] };
    for (k, [low, high]) in ends(text)?.into_iter().enumerate() {
        let finite = |text: &str| match text.parse() {
            Ok(number) if f64::is_finite(number) => Ok(number),
            _ => Err(
                command_error!("`{text}` is not a finite number" => "give one, as in 20 or 2.5"),
            ),
        };
        (region.low[k], region.high[k]) = (finite(low)?, finite(high)?);
        if region.low[k] > region.high[k] {
            fail!("`{low}:{high}` is not a range" => "give the smaller number first, as in 20:40");
        }
    }
    Ok(region)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_of_ranges_are_read() {
        let region = samples("20:40, : ,10:").unwrap();
        assert_eq!((region.first, region.end), ([20, 0, 10], [Some(40), None, None]));
        let region = places("-1:2.5,0:0, 1e3 :2e3").unwrap();
        assert_eq!((region.low, region.high), ([-1.0, 0.0, 1e3], [2.5, 0.0, 2e3]));
        for text in ["1:2,3:4", "1:2,3:4,5", "1:2,3:4,5:x", "1:2,3:4,5:6,7:8"] {
            assert!(samples(text).is_err() && places(text).is_err(), "{text}");
        }
        for text in ["1:2,3:4,:", "1:2,3:4,6:5", "1:2,3:4,5:inf"] {
            assert!(places(text).is_err(), "{text}");
        }
        assert!(samples("1.5:2,3:4,5:6").is_err());
    }
}
