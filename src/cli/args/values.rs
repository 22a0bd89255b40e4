//! Parsers of the values of options.

use crate::cli::errors::{CommandError, command_error, fail};
use crate::volume::Nan;
use crate::{Alpha, Dims, GrayRange, points, volume};

pub(super) fn input_format(text: &str) -> Result<String, CommandError> {
    let named = text.trim_start_matches('.').to_lowercase();
    let volumes = volume::FORMATS.iter().flat_map(|format| format.extensions);
    let known: Vec<&str> = volumes
        .chain(points::FORMATS.iter().flat_map(|format| format.extensions))
        .copied()
        .collect();
    if !known.contains(&named.as_str()) {
        fail!("no format that is read has the extension {text:?}" => "give one of {}", known.join(", "));
    }
    Ok(named)
}

pub(super) fn dims(text: &str) -> Result<Dims, CommandError> {
    let size = |size: &str| {
        let whole = size.trim().parse::<u64>();
        whole.map_err(
            |_| command_error!("{size:?} is not a whole number" => "give sizes as in 64,64,64"),
        )
    };
    let sizes: Vec<u64> = text.split(',').map(size).collect::<Result<_, _>>()?;
    let [x, y, z] = sizes[..] else {
        fail!("three sizes are needed" => "give those along x, y and z, as in 64,64,64");
    };
    Ok(Dims::unbounded(x, y, z)?)
}

pub(super) fn nan(text: &str) -> Result<Nan, CommandError> {
    if text == "mask" {
        return Ok(Nan::Mask);
    }
    let value = number(text)? as f32;
    if !value.is_finite() {
        fail!("a finite number is needed" => "give it as in -1000, or give none");
    }
    Ok(Nan::Value(value))
}

pub(super) fn gray_range(text: &str) -> Result<GrayRange, CommandError> {
    let Some((low, high)) = text.split_once("..") else {
        fail!("two numbers are needed" => "give them as in -1000..2000");
    };
    let range = GrayRange { low: number(low)?, high: number(high)? };
    if !(range.low < range.high && range.low.is_finite() && range.high.is_finite()) {
        fail!("LO must be less than HI, and both finite" => "give them as in -1000..2000");
    }
    Ok(range)
}

pub(super) fn bytes(text: &str) -> Result<u64, CommandError> {
    let units = [("K", 10), ("M", 20), ("G", 30), ("T", 40)];
    let unit = units.iter().find_map(|(name, bits)| Some((text.strip_suffix(name)?, bits)));
    let (number, bits) = unit.unwrap_or((text, &0));
    let Some(bytes) = number.parse().ok().and_then(|n: u64| n.checked_mul(1 << bits)) else {
        fail!("a whole number of bytes is needed" => "give it as in 2G, 500M or 1073741824");
    };
    Ok(bytes)
}

pub(crate) fn number(text: &str) -> Result<f64, CommandError> {
    text.trim()
        .parse()
        .map_err(|_| command_error!("{text:?} is not a number" => "give one as in 10 or 2.5"))
}

pub(super) fn count(text: &str) -> Result<u64, CommandError> {
    match text.trim().parse() {
        Ok(0) => fail!("a count from 1 up is needed" => "give it as in 15956"),
        count => count.map_err(
            |_| command_error!("{text:?} is not a whole number" => "give one as in 15956"),
        ),
    }
}

pub(super) fn share(text: &str) -> Result<f64, CommandError> {
    let share = number(text)?;
    if !(share > 0.0 && share <= 1.0) {
        fail!("a share above 0 and up to 1 is needed" => "give it as in 0.0609 for 6.09 %");
    }
    Ok(share)
}

pub(super) fn not_nan(text: &str) -> Result<f64, CommandError> {
    let number = number(text)?;
    if number.is_nan() {
        fail!("a gray level is needed" => "give it as in 50 or 12.5");
    }
    Ok(number)
}

pub(crate) fn not_negative(text: &str) -> Result<f64, CommandError> {
    let number = number(text)?;
    if number.is_nan() || number < 0.0 {
        fail!("a number from 0 up is needed" => "give it as in 1 or 2.5");
    }
    Ok(number)
}

pub(super) fn positive(text: &str) -> Result<f64, CommandError> {
    let number = number(text)?;
    if !(number > 0.0 && number.is_finite()) {
        fail!("a positive number is needed" => "give it as in 0.5");
    }
    Ok(number)
}

/// The codes of a class in LAS, by name or number (ASPRS LAS 1.4, table 17).
pub(super) fn class(text: &str) -> Result<Vec<u8>, CommandError> {
    Ok(match text.trim() {
        "unclassified" => vec![0, 1],
        "ground" => vec![2],
        "vegetation" => vec![3, 4, 5],
        "building" => vec![6],
        "water" => vec![9],
        number => match number.parse() {
            Ok(number) => vec![number],
            Err(_) => {
                fail!("{number:?} is no class of points" => "give ground, vegetation, building, water, unclassified, or a number from 0 to 255")
            }
        },
    })
}

pub(super) fn alpha_radius(text: &str) -> Result<Alpha, CommandError> {
    Ok(Alpha::from_radius(number(text)?)?)
}
