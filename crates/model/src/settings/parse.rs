//! Parses settings from text. Each parser reports what is wrong, and shows what a value looks like.

use std::num::NonZeroUsize;
use std::str::FromStr;

use walpha_base::advice::Advise;
use walpha_complex::schema::BoxVectors;
use walpha_points::{Cell, Models, Radii};
use walpha_shape::{Alpha, Torus};
use walpha_volume::{Dims, GrayRange, Nan, Region};

use super::SettingError;
use super::choices::Named;
use crate::pipeline::{PeriodicBox, directions};

/// Returns an error: what is wrong, and after `=>` what to do.
macro_rules! fail {
    ($why:literal $(, $of_why:expr)* => $next:literal $(, $of_next:expr)*) => {
        return Err(error!($why $(, $of_why)* => $next $(, $of_next)*))
    };
}

macro_rules! error {
    ($why:literal $(, $of_why:expr)* => $next:literal $(, $of_next:expr)*) => {
        SettingError::new(format!($why $(, $of_why)*), format!($next $(, $of_next)*))
    };
}

/// Takes a text as it is.
#[expect(clippy::unnecessary_wraps, reason = "as all parsers")]
pub(super) fn text(text: &str) -> Result<String, SettingError> {
    Ok(text.to_owned())
}

/// Parses a whole number from 0 up.
///
/// # Errors
/// The text is not such a number, or it is too large for the type.
pub fn whole<T: FromStr>(text: &str) -> Result<T, SettingError> {
    whole_from(0, text)
}

/// Parses a whole number from 1 up.
pub(super) fn natural(text: &str) -> Result<NonZeroUsize, SettingError> {
    whole_from(1, text)
}

fn whole_from<T: FromStr>(least: u8, text: &str) -> Result<T, SettingError> {
    let text = text.trim();
    text.parse().map_err(|_| {
        if text.bytes().all(|byte| byte.is_ascii_digit()) && text.bytes().any(|byte| byte != b'0') {
            error!("{text} is too large" => "give a smaller number")
        } else {
            error!("{text:?} is not a whole number from {least} up" => "give one as in 3")
        }
    })
}

/// Parses a type whose parser gives errors with advice.
pub(super) fn own<T: FromStr<Err: Advise>>(text: &str) -> Result<T, SettingError> {
    text.parse().map_err(|error| SettingError::of(&error))
}

/// Parses one of a few names.
pub(super) fn named<T: Named>(text: &str) -> Result<T, SettingError> {
    let known = || T::NAMES.iter().map(|(_, name, _)| *name).collect::<Vec<_>>().join(", ");
    let found = T::NAMES.iter().find(|(_, name, _)| *name == text);
    found
        .map(|(value, ..)| *value)
        .ok_or_else(|| error!("{text:?} is unknown" => "give one of {}", known()))
}

/// Parses a switch.
pub(super) fn switch(text: &str) -> Result<bool, SettingError> {
    text.parse().map_err(|_| error!("{text:?} is neither true nor false" => "give true or false"))
}

pub(super) fn input_format(text: &str) -> Result<String, SettingError> {
    let named = text.trim_start_matches('.').to_lowercase();
    let volumes = walpha_volume::FORMATS.iter().flat_map(|format| format.extensions);
    let known: Vec<&str> = volumes
        .chain(walpha_points::FORMATS.iter().flat_map(|format| format.extensions))
        .copied()
        .collect();
    if !known.contains(&named.as_str()) {
        fail!("no format that is read has the extension {text:?}" => "give one of {}", known.join(", "));
    }
    Ok(named)
}

pub(super) fn dims(text: &str) -> Result<Dims, SettingError> {
    let size = |size: &str| {
        let whole = size.trim().parse::<u64>();
        whole.map_err(|_| error!("{size:?} is not a whole number" => "give sizes as in 64,64,64"))
    };
    let sizes: Vec<u64> = text.split(',').map(size).collect::<Result<_, _>>()?;
    let [x, y, z] = sizes[..] else {
        fail!("three sizes are needed" => "give those along x, y and z, as in 64,64,64");
    };
    Dims::unbounded(x, y, z).map_err(|error| SettingError::of(&error))
}

pub(super) fn nan(text: &str) -> Result<Nan, SettingError> {
    if text == "mask" {
        return Ok(Nan::Mask);
    }
    let value = number(text)? as f32;
    if !value.is_finite() {
        fail!("a finite number is needed" => "give it as in -1000, or give none");
    }
    Ok(Nan::Value(value))
}

pub(super) fn gray_range(text: &str) -> Result<GrayRange, SettingError> {
    let Some((low, high)) = text.split_once("..") else {
        fail!("two numbers are needed" => "give them as in -1000..2000");
    };
    let range = GrayRange { low: number(low)?, high: number(high)? };
    if !(range.low < range.high && range.low.is_finite() && range.high.is_finite()) {
        fail!("LO must be less than HI, and both finite" => "give them as in -1000..2000");
    }
    Ok(range)
}

pub(super) fn bytes(text: &str) -> Result<u64, SettingError> {
    let units = [("K", 10), ("M", 20), ("G", 30), ("T", 40)];
    let unit = units.iter().find_map(|(name, bits)| Some((text.strip_suffix(name)?, bits)));
    let (number, bits) = unit.unwrap_or((text, &0));
    let Some(bytes) = number.parse().ok().and_then(|n: u64| n.checked_mul(1 << bits)) else {
        fail!("a whole number of bytes is needed" => "give it as in 2G, 500M or 1073741824");
    };
    Ok(bytes)
}

/// Parses a number, which may be infinite or NaN.
///
/// # Errors
/// The text is not a number.
pub fn number(text: &str) -> Result<f64, SettingError> {
    text.trim()
        .parse()
        .map_err(|_| error!("{text:?} is not a number" => "give one as in 10 or 2.5"))
}

pub(super) fn count(text: &str) -> Result<u64, SettingError> {
    match whole_from(1, text)? {
        0 => fail!("a count from 1 up is needed" => "give it as in 15956"),
        count => Ok(count),
    }
}

pub(super) fn share(text: &str) -> Result<f64, SettingError> {
    let share = number(text)?;
    if !(share > 0.0 && share <= 1.0) {
        fail!("a share above 0 and up to 1 is needed" => "give it as in 0.0609 for 6.09 %");
    }
    Ok(share)
}

pub(super) fn not_nan(text: &str) -> Result<f64, SettingError> {
    let number = number(text)?;
    if number.is_nan() {
        fail!("a gray level is needed" => "give it as in 50 or 12.5");
    }
    Ok(number)
}

/// Parses a number that is not negative.
///
/// # Errors
/// The number is negative or NaN, or the text is not a number.
pub fn not_negative(text: &str) -> Result<f64, SettingError> {
    let number = number(text)?;
    if number.is_nan() || number < 0.0 {
        fail!("a number from 0 up is needed" => "give it as in 1 or 2.5");
    }
    Ok(number)
}

pub(super) fn positive(text: &str) -> Result<f64, SettingError> {
    let number = number(text)?;
    if !(number > 0.0 && number.is_finite()) {
        fail!("a positive number is needed" => "give it as in 0.5");
    }
    Ok(number)
}

/// Parses the codes of classes in LAS, by name or number, separated by commas (ASPRS LAS 1.4, table 17).
pub(super) fn classes(text: &str) -> Result<Vec<u8>, SettingError> {
    let codes = text.split(',').map(class).collect::<Result<Vec<_>, _>>()?;
    Ok(codes.concat())
}

fn class(text: &str) -> Result<Vec<u8>, SettingError> {
    Ok(match text.trim() {
        "unclassified" => vec![0, 1],
        "ground" => vec![2],
        "vegetation" => vec![3, 4, 5],
        "building" => vec![6],
        "water" => vec![9],
        number => match number.parse() {
            Ok(number) => vec![number],
            Err(_) => {
                fail!("{number:?} is not a class of points" => "give ground, vegetation, building, water, unclassified, or a number from 0 to 255")
            }
        },
    })
}

/// The name of a column of points.
pub(super) fn column(text: &str) -> Result<String, SettingError> {
    let name = text.trim();
    if name.is_empty() {
        fail!("the name of a column is needed" => "give it as in intensity or height; walpha info lists those of a file");
    }
    Ok(name.to_owned())
}

/// A set of radii, or the path of a table.
pub(super) fn radii(text: &str) -> Result<Radii, SettingError> {
    if text.is_empty() {
        fail!("a set of radii is needed" => "give bondi, protor, column, none or the path of a table");
    }
    let Ok(radii) = text.parse();
    Ok(radii)
}

/// Names of chains.
pub(super) fn chains(text: &str) -> Result<Vec<String>, SettingError> {
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    if names.iter().any(String::is_empty) {
        fail!("names of chains are needed" => "give them as in A,B");
    }
    Ok(names)
}

pub(super) fn models(text: &str) -> Result<Models, SettingError> {
    match (text, text.parse()) {
        ("all", _) => Ok(Models::All),
        (_, Ok(number)) => Ok(Models::One(number)),
        _ => fail!("{text:?} is not the number of a model" => "give all, or a number as in 2"),
    }
}

/// A radius, √α.
///
/// # Errors
/// It is not a number, or not a radius.
pub fn alpha_radius(text: &str) -> Result<Alpha, SettingError> {
    Alpha::from_radius(number(text)?).map_err(|error| SettingError::of(&error))
}

/// How a periodic box can be given.
const FORMS: &str = "give three sides, as in 10,10,20, three lengths and three angles, as in 10,10,15,90,90,120, nine numbers of three vectors, `cell` for the cell that the file states, or xy for that cell along its first two vectors";

/// Three sides, three lengths and angles, or three vectors of a periodic box, or that of the input; and the directions in which points repeat,
/// if not in all.
pub(super) fn periodic(text: &str) -> Result<PeriodicBox, SettingError> {
    if text == "cell" {
        return Ok(PeriodicBox::Stated);
    }
    if let Some(repeats) = directions(text) {
        return Ok(PeriodicBox::StatedAlong(repeats));
    }
    let (text, repeats) = match text.split_once(':') {
        None => (text, None),
        Some((text, names)) => match directions(names) {
            Some(repeats) => (text, Some(repeats)),
            None => {
                fail!("`{names}` does not name directions in which points repeat" => "give some of x, y and z, which stand for the three vectors, as in 10,10,20:xy")
            }
        },
    };
    if let ("cell", Some(repeats)) = (text, repeats) {
        return Ok(PeriodicBox::StatedAlong(repeats));
    }
    let numbers = text.split(',').map(|number| number.trim().parse());
    let Ok(numbers) = numbers.collect::<Result<Vec<f64>, _>>() else {
        fail!("{text:?} does not describe a periodic box" => "{FORMS}");
    };
    // Unless directions are named, points repeat along all vectors but those of 0.
    let along =
        |vectors: [[f64; 3]; 3]| repeats.unwrap_or(vectors.map(|vector| vector != [0.0; 3]));
    let torus = match numbers[..] {
        [x, y, z] => {
            let vectors = BoxVectors::of_sides([x, y, z]).0;
            match along(vectors) {
                [true, true, true] => Torus::new([x, y, z]),
                along => Torus::repeating(vectors, along),
            }
        }
        [a, b, c, alpha, beta, gamma] => {
            let Some(cell) = Cell::of_angles([a, b, c], [alpha, beta, gamma]) else {
                fail!("no three vectors have the angles {alpha}°, {beta}° and {gamma}°" => "give the angles of b with c, a with c, and a with b in degrees, as in 10,10,15,90,90,120");
            };
            Torus::repeating(cell.vectors, along(cell.vectors))
        }
        [ax, ay, az, bx, by, bz, cx, cy, cz] => {
            let vectors = [[ax, ay, az], [bx, by, bz], [cx, cy, cz]];
            Torus::repeating(vectors, along(vectors))
        }
        _ => {
            fail!("{} numbers do not describe a periodic box", numbers.len() => "{FORMS}")
        }
    };
    torus.map(PeriodicBox::Given).map_err(|error| SettingError::of(&error))
}

/// Splits a text into the ends of three ranges, without surrounding white space.
fn ends(text: &str) -> Result<[[&str; 2]; 3], SettingError> {
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

/// A part of an input: of a volume a range of samples along each axis, from a first index to an exclusive end; of points a box in
/// their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The range of samples, which is [nowhere](Region::NOWHERE) unless all ends are whole numbers from 0 on.
    pub samples: Region,
    /// The box, infinite where ends are missing.
    pub places: walpha_points::Region,
}

/// Parses a part of an input; ends may be omitted.
pub(super) fn part(text: &str) -> Result<Part, SettingError> {
    let ends = ends(text)?;
    let places = region(ends, true)?;
    let index = |text: &str| if text.is_empty() { Ok(None) } else { text.parse().map(Some) };
    let samples = || -> Result<Region, std::num::ParseIntError> {
        let mut region = Region::default();
        for (k, [first, end]) in ends.into_iter().enumerate() {
            (region.first[k], region.end[k]) = (index(first)?.unwrap_or(0), index(end)?);
        }
        Ok(region)
    };
    Ok(Part { samples: samples().unwrap_or(Region::NOWHERE), places })
}

/// Parses a box in the units of the points, including its boundary: `X0:X1,Y0:Y1,Z0:Z1`.
///
/// # Errors
/// The text is not three ranges of finite numbers.
pub fn places(text: &str) -> Result<walpha_points::Region, SettingError> {
    region(ends(text)?, false)
}

/// The box between these ends, which may be missing if it is `open`.
fn region(ends: [[&str; 2]; 3], open: bool) -> Result<walpha_points::Region, SettingError> {
    let mut region = walpha_points::Region::EVERYWHERE;
    for (k, [low, high]) in ends.into_iter().enumerate() {
        let set = |end: &mut f64, text: &str| match text.parse() {
            Ok(number) if f64::is_finite(number) => {
                *end = number;
                Ok(())
            }
            _ if open && text.is_empty() => Ok(()),
            _ => Err(error!("`{text}` is not a finite number" => "give one, as in 20 or 2.5")),
        };
        set(&mut region.low[k], low)?;
        set(&mut region.high[k], high)?;
        if region.low[k] > region.high[k] {
            fail!("`{low}:{high}` is not a range" => "give the smaller number first, as in 20:40");
        }
    }
    Ok(region)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions follow numbers, or stand for the cell that the file states.
    #[test]
    fn boxes_repeat_in_the_directions_named() {
        let given = |text: &str| periodic(text).unwrap().given().unwrap();
        assert_eq!(given("4,5,6").repeats(), [true; 3]);
        let slab = given("4,5,6:xz");
        assert_eq!(slab.sides(), Some([4.0, 0.0, 6.0]));
        assert_eq!(given("4,4,6,90,90,120:xy").repeats(), [true, true, false]);
        assert_eq!(given("0,2,2,1,0,0,0,0,0:x").vectors()[0], [0.0, 2.0, 2.0]);
        assert_eq!(given("4,5,0").repeats(), [true, true, false]);
        assert_eq!(given("1,0,0,0,2,0,0,0,0").repeats(), [true, true, false]);
        for text in ["yx", "cell:xy"] {
            assert_eq!(periodic(text).unwrap(), PeriodicBox::StatedAlong([true, true, false]));
        }
        for text in ["4,5,6:", "4,5,6:xx", "4,5,6:ab", "0,0,0", "4,5,0:xz", "xxy", "cell:q", ""] {
            assert!(periodic(text).is_err(), "{text}");
        }
        for recipe in [r#""xy""#, "[4.0,0.0,6.0]", r#""cell""#] {
            let read: PeriodicBox = serde_json::from_str(recipe).unwrap();
            assert_eq!(serde_json::to_string(&read).unwrap(), recipe);
        }
    }

    #[test]
    fn both_kinds_of_ranges_are_read() {
        let Part { samples, places: open } = part("20:40, : ,10:").unwrap();
        assert_eq!((samples.first, samples.end), ([20, 0, 10], [Some(40), None, None]));
        assert_eq!((open.low[0], open.high[0], open.low[2]), (20.0, 40.0, 10.0));
        assert_eq!((open.low[1], open.high[2]), (f64::NEG_INFINITY, f64::INFINITY));
        let region = places("-1:2.5,0:0, 1e3 :2e3").unwrap();
        assert_eq!((region.low, region.high), ([-1.0, 0.0, 1e3], [2.5, 0.0, 2e3]));
        for text in ["1:2,3:4", "1:2,3:4,5", "1:2,3:4,5:x", "1:2,3:4,5:6,7:8", "1:2,3:4,6:5"] {
            assert!(part(text).is_err() && places(text).is_err(), "{text}");
        }
        for text in ["1:2,3:4,:", "1:2,3:4,5:inf"] {
            assert!(places(text).is_err(), "{text}");
        }
        assert_eq!(part("1.5:2,3:4,5:6").unwrap().samples, Region::NOWHERE);
    }
}
