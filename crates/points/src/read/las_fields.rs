//! The fields of a point of LAS beside its coordinates: those of its format, and the extra bytes that a record describes. They are
//! read from records, and stored in them.
//!
//! Source: LAS 1.4 R15, tables 7 to 16 and 24 to 26. The names are those of laspy.

use las::point::Format;

use crate::ColumnSummary;

/// The name of the time of a point.
pub(crate) const GPS_TIME: &str = "gps_time";
/// The name of the intensity.
pub(crate) const INTENSITY: &str = "intensity";
/// The size in bytes of a description of extra bytes.
pub(crate) const DESCRIPTION: usize = 192;

/// A field: its name, its type, and how it is read.
pub(crate) struct Field {
    pub name: String,
    kind: &'static str,
    place: usize,
    code: Code,
    /// What a stored number is multiplied by.
    scale: f64,
    /// What is added then.
    offset: f64,
    /// The stored bytes that stand for no number.
    missing: Option<Vec<u8>>,
}

/// How a number is stored.
#[derive(Clone, Copy, PartialEq)]
enum Code {
    /// Some bits of a byte: the lowest, and how many.
    Bits(u8, u8),
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

impl Code {
    /// The types of extra bytes from 1 on, with their sizes.
    const EXTRA: [(Self, usize); 10] = [
        (Self::U8, 1),
        (Self::I8, 1),
        (Self::U16, 2),
        (Self::I16, 2),
        (Self::U32, 4),
        (Self::I32, 4),
        (Self::U64, 8),
        (Self::I64, 8),
        (Self::F32, 4),
        (Self::F64, 8),
    ];

    /// The number at the start of some bytes; NaN behind the end of a record.
    fn read(self, bytes: &[u8]) -> f64 {
        fn first<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
            bytes.first_chunk().copied()
        }
        let number = match self {
            Self::Bits(low, count) => {
                bytes.first().map(|byte| f64::from(byte >> low & ((1u16 << count) - 1) as u8))
            }
            Self::U8 => bytes.first().map(|&byte| f64::from(byte)),
            Self::I8 => first(bytes).map(|bytes| f64::from(i8::from_le_bytes(bytes))),
            Self::U16 => first(bytes).map(|bytes| f64::from(u16::from_le_bytes(bytes))),
            Self::I16 => first(bytes).map(|bytes| f64::from(i16::from_le_bytes(bytes))),
            Self::U32 => first(bytes).map(|bytes| f64::from(u32::from_le_bytes(bytes))),
            Self::I32 => first(bytes).map(|bytes| f64::from(i32::from_le_bytes(bytes))),
            Self::U64 => first(bytes).map(|bytes| u64::from_le_bytes(bytes) as f64),
            Self::I64 => first(bytes).map(|bytes| i64::from_le_bytes(bytes) as f64),
            Self::F32 => first(bytes).map(|bytes| f64::from(f32::from_le_bytes(bytes))),
            Self::F64 => first(bytes).map(f64::from_le_bytes),
        };
        number.unwrap_or(f64::NAN)
    }

    /// The bytes of a number of this size that stand for none, from a description: eight bytes of the kind of the type, that is,
    /// a double or a whole number with or without a sign. `None` if the type cannot hold it.
    fn none(self, size: usize, described: &[u8]) -> Option<Vec<u8>> {
        if self == Self::F32 {
            return Some((Self::F64.read(described) as f32).to_le_bytes().to_vec());
        }
        let (stored, rest) = described.split_at(size);
        let is_signed = matches!(self, Self::I8 | Self::I16 | Self::I32 | Self::I64);
        let is_negative = is_signed && stored.last().is_some_and(|&byte| byte > 127);
        let fill = if is_negative { 255 } else { 0 };
        rest.iter().all(|&byte| byte == fill).then(|| stored.to_vec())
    }

    /// Stores a number at the start of some bytes. Returns whether the type can hold it.
    #[expect(clippy::cast_lossless, reason = "of some types it loses bits")]
    fn store(self, number: f64, bytes: &mut [u8]) -> bool {
        macro_rules! put {
            ($kind:ty) => {{
                let stored = number as $kind;
                let of_kind = stored.to_le_bytes();
                bytes[..of_kind.len()].copy_from_slice(&of_kind);
                // As a double, the greatest number of 64 bits is one more.
                stored as f64 == number && number < <$kind>::MAX as f64 + 1.0
            }};
        }
        match self {
            Self::Bits(low, count) => {
                let greatest = ((1u16 << count) - 1) as u8;
                bytes[0] = bytes[0] & !(greatest << low) | (number as u8 & greatest) << low;
                number.fract() == 0.0 && (0.0..=f64::from(greatest)).contains(&number)
            }
            Self::U8 => put!(u8),
            Self::I8 => put!(i8),
            Self::U16 => put!(u16),
            Self::I16 => put!(i16),
            Self::U32 => put!(u32),
            Self::I32 => put!(i32),
            Self::U64 => put!(u64),
            Self::I64 => put!(i64),
            Self::F32 => {
                bytes[..4].copy_from_slice(&(number as f32).to_le_bytes());
                number.is_nan() || (number as f32).is_finite() == number.is_finite()
            }
            Self::F64 => {
                bytes[..8].copy_from_slice(&number.to_le_bytes());
                true
            }
        }
    }
}

impl Field {
    fn new(name: &str, place: usize, code: Code) -> Self {
        let kind = match code {
            Code::Bits(..) | Code::U8 => "uint8",
            Code::I8 => "int8",
            Code::U16 => "uint16",
            Code::I16 => "int16",
            Code::U32 => "uint32",
            Code::I32 => "int32",
            Code::U64 => "uint64",
            Code::I64 => "int64",
            Code::F32 => "float32",
            Code::F64 => "float64",
        };
        Self { name: name.to_owned(), kind, place, code, scale: 1.0, offset: 0.0, missing: None }
    }

    fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The number of a point; NaN if it has none.
    pub(crate) fn value(&self, record: &[u8]) -> f64 {
        let bytes = record.get(self.place..).unwrap_or_default();
        if self.missing.as_ref().is_some_and(|missing| bytes.starts_with(missing)) {
            return f64::NAN;
        }
        self.code.read(bytes) * self.scale + self.offset
    }

    /// Stores the number of a point in its record; NaN stands for none.
    ///
    /// # Errors
    /// Why the field cannot hold it.
    pub(crate) fn store(&self, number: f64, record: &mut [u8]) -> Result<(), String> {
        let bytes = &mut record[self.place..];
        if let (true, Some(missing)) = (number.is_nan(), &self.missing) {
            bytes[..missing.len()].copy_from_slice(missing);
            return Ok(());
        }
        let mut stored = (number - self.offset) / self.scale;
        if self.scale == 0.0 && number == self.offset {
            // All stored numbers are this one.
            stored = 0.0;
        }
        let is_whole = (self.scale, self.offset.fract()) == (1.0, 0.0);
        if !is_whole && !matches!(self.code, Code::F32 | Code::F64) {
            stored = stored.round();
        }
        if self.code.store(stored, bytes) {
            return Ok(());
        }
        Err(format!("{} is {number}, and is stored as {}", self.name, self.kind))
    }

    /// A description without its range.
    pub(super) fn summary(&self) -> ColumnSummary {
        ColumnSummary::new(&self.name, self.kind)
    }
}

/// The fields of a format, in the order of its bytes, and the described extra bytes.
pub(crate) fn fields(format: Format, described: &[u8]) -> Vec<Field> {
    let mut all = vec![Field::new(INTENSITY, 12, Code::U16)];
    let mut bits = |named: &[(&str, usize, u8, u8)]| {
        let field =
            |&(name, place, low, count): &_| Field::new(name, place, Code::Bits(low, count));
        all.extend(named.iter().map(field));
    };
    if format.is_extended {
        bits(&[
            ("return_number", 14, 0, 4),
            ("number_of_returns", 14, 4, 4),
            ("synthetic", 15, 0, 1),
            ("key_point", 15, 1, 1),
            ("withheld", 15, 2, 1),
            ("overlap", 15, 3, 1),
            ("scanner_channel", 15, 4, 2),
            ("scan_direction_flag", 15, 6, 1),
            ("edge_of_flight_line", 15, 7, 1),
        ]);
        all.push(Field::new("classification", 16, Code::U8));
        all.push(Field::new("user_data", 17, Code::U8));
        all.push(Field::new("scan_angle", 18, Code::I16).scaled(0.006));
        all.push(Field::new("point_source_id", 20, Code::U16));
    } else {
        bits(&[
            ("return_number", 14, 0, 3),
            ("number_of_returns", 14, 3, 3),
            ("scan_direction_flag", 14, 6, 1),
            ("edge_of_flight_line", 14, 7, 1),
            ("classification", 15, 0, 5),
            ("synthetic", 15, 5, 1),
            ("key_point", 15, 6, 1),
            ("withheld", 15, 7, 1),
        ]);
        all.push(Field::new("scan_angle", 16, Code::I8));
        all.push(Field::new("user_data", 17, Code::U8));
        all.push(Field::new("point_source_id", 18, Code::U16));
    }
    let mut place = if format.is_extended { 22 } else { 20 };
    if format.has_gps_time {
        all.push(Field::new(GPS_TIME, place, Code::F64));
        place += 8;
    }
    if format.has_color {
        for (k, name) in ["red", "green", "blue"].into_iter().enumerate() {
            all.push(Field::new(name, place + 2 * k, Code::U16));
        }
        place += 6;
    }
    if format.has_nir {
        all.push(Field::new("nir", place, Code::U16));
    }
    let start = usize::from(format.len() - format.extra_bytes);
    all.extend(extra(start, described));
    all
}

/// The fields that descriptions of extra bytes, 192 bytes each, place behind those of the format. An array of several numbers has
/// a field for each.
pub(crate) fn extra(mut place: usize, described: &[u8]) -> Vec<Field> {
    let mut fields = Vec::new();
    for one in described.as_chunks::<DESCRIPTION>().0 {
        let (kind, options) = (usize::from(one[2]), one[3]);
        if kind == 0 {
            // Bytes without a meaning: the options are their number.
            place += usize::from(options);
            continue;
        }
        let Some((code, size, count)) = kind_of(kind) else { break };
        let name = one[4..36].split(|&byte| byte == 0).next().unwrap_or_default();
        let name = String::from_utf8_lossy(name).trim().to_owned();
        let number = |start: usize, k: usize| Code::F64.read(&one[start + 8 * k..]);
        for k in 0..count {
            let has = |bit: u8| options & 1 << bit != 0;
            let missing = code.none(size, &one[40 + 8 * k..][..8]);
            let name = if count == 1 { name.clone() } else { format!("{name}_{k}") };
            fields.push(Field {
                scale: if has(3) { number(112, k) } else { 1.0 },
                offset: if has(4) { number(136, k) } else { 0.0 },
                missing: if has(0) { missing } else { None },
                ..Field::new(&name, place, code)
            });
            place += size;
        }
    }
    fields
}

/// The type of a description of extra bytes from 1 on, its size in bytes, and how many numbers there are; `None` for one that is
/// not known.
fn kind_of(kind: usize) -> Option<(Code, usize, usize)> {
    let &(code, size) = Code::EXTRA.get((kind - 1) % 10)?;
    let count = (kind - 1) / 10 + 1;
    (count <= 3).then_some((code, size, count))
}

/// The descriptions of extra bytes that are numbers, and how many bytes they describe. Bytes without a meaning are left out, so the
/// fields lie one after another.
pub(crate) fn of_numbers(described: &[u8]) -> (Vec<u8>, usize) {
    let all = described.as_chunks::<DESCRIPTION>().0;
    let known = all.iter().filter(|one| one[2] > 0);
    let known: Vec<_> =
        known.map_while(|one| kind_of(one[2].into()).map(|kind| (one, kind))).collect();
    let size = known.iter().map(|(_, (_, size, count))| size * count).sum();
    (known.iter().flat_map(|(one, _)| **one).collect(), size)
}

/// The number of bytes that descriptions place behind the fields of a format, as far as their types are known.
pub(crate) fn described_bytes(described: &[u8]) -> usize {
    let all = described.as_chunks::<DESCRIPTION>().0.iter();
    let size = |one: &[u8; DESCRIPTION]| match one[2] {
        0 => Some(usize::from(one[3])),
        kind => kind_of(kind.into()).map(|(_, size, count)| size * count),
    };
    all.map_while(size).sum()
}

/// The part of a name that a description holds: 32 bytes, ending with a whole character.
pub(crate) fn stored_name(name: &str) -> &str {
    let end = (0..=name.len().min(32)).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
    &name[..end]
}

/// A description of extra bytes that hold a column, and their number. `kind` is the type that is stated for it; doubles are the
/// default.
pub(crate) fn description(name: &str, kind: &str) -> ([u8; DESCRIPTION], usize) {
    let known = |&(code, _): &(Code, usize)| Field::new("", 0, code).kind == kind;
    let position = Code::EXTRA.iter().position(known).unwrap_or(Code::EXTRA.len() - 1);
    let mut one = [0; DESCRIPTION];
    one[2] = position as u8 + 1;
    let name = stored_name(name).as_bytes();
    one[4..4 + name.len()].copy_from_slice(name);
    (one, Code::EXTRA[position].1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A description with this type, options and name, a number that stands for none, a scale and an offset.
    fn described(kind: u8, options: u8, name: &str, none: i64, scale: f64, offset: f64) -> Vec<u8> {
        let mut bytes = vec![0; 192];
        (bytes[2], bytes[3]) = (kind, options);
        bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
        bytes[40..48].copy_from_slice(&none.to_le_bytes());
        bytes[112..120].copy_from_slice(&scale.to_le_bytes());
        bytes[136..144].copy_from_slice(&offset.to_le_bytes());
        bytes
    }

    #[test]
    fn extra_bytes_are_read_as_they_are_described() {
        let all = [
            described(0, 3, "", 0, 0.0, 0.0),
            described(6, 1, "treeID", i64::from(i32::MIN), 0.0, 0.0),
            described(4, 24, "height", 0, 0.01, 100.0),
            described(13, 0, "rgb", 0, 0.0, 0.0),
        ]
        .concat();
        let fields = extra(2, &all);
        let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["treeID", "height", "rgb_0", "rgb_1"]);
        let mut record = vec![0; 5];
        record.extend((-7i32).to_le_bytes());
        record.extend(250i16.to_le_bytes());
        record.extend(3u16.to_le_bytes());
        record.extend(4u16.to_le_bytes());
        let values: Vec<f64> = fields.iter().map(|field| field.value(&record)).collect();
        assert_eq!(values, [-7.0, 102.5, 3.0, 4.0]);
        record[5..9].copy_from_slice(&i32::MIN.to_le_bytes());
        assert!(fields[0].value(&record).is_nan());
        assert!(fields[3].value(&record[..13]).is_nan(), "behind the end");
    }

    /// The number that stands for none is compared as it is stored: a float of 32 bits, or a whole number of 64.
    #[test]
    fn no_number_is_one_of_the_type() {
        let field = |kind: u8, none: [u8; 8]| {
            let mut one = described(kind, 1, "a", 0, 0.0, 0.0);
            one[40..48].copy_from_slice(&none);
            extra(0, &one).remove(0)
        };
        let lowest = field(9, (-3.4e38f64).to_le_bytes());
        assert!(lowest.value(&(-3.4e38f32).to_le_bytes()).is_nan());
        assert_eq!(lowest.value(&1.5f32.to_le_bytes()), 1.5);
        let mut bytes = [0; 4];
        lowest.store(f64::NAN, &mut bytes).unwrap();
        assert_eq!(bytes, (-3.4e38f32).to_le_bytes());
        let greatest = field(7, u64::MAX.to_le_bytes());
        assert!(greatest.value(&u64::MAX.to_le_bytes()).is_nan());
        assert_eq!(greatest.value(&(u64::MAX - 4).to_le_bytes()), (u64::MAX - 4) as f64);
        let negative = field(4, (-1i64).to_le_bytes());
        assert!(negative.value(&(-1i16).to_le_bytes()).is_nan());
        // 65 536 + 7 is no number of 16 bits.
        assert_eq!(field(3, 65_543u64.to_le_bytes()).value(&7u16.to_le_bytes()), 7.0);
    }

    #[test]
    fn numbers_are_stored_as_they_were_read() {
        for (options, scale, offset) in
            [(24, 1.0, 0.1), (8, 0.0, 0.0), (24, 0.0, 2.5), (24, 0.01, 0.1)]
        {
            let field = extra(0, &described(4, options, "a", 0, scale, offset)).remove(0);
            for stored in [1i16, 4, 22, -7] {
                let number = field.value(&stored.to_le_bytes());
                let mut bytes = [0; 2];
                field.store(number, &mut bytes).unwrap();
                assert_eq!(field.value(&bytes), number, "{scale} {offset}");
            }
        }
        // Without a scale, and with a whole offset, a fraction does not fit.
        let whole = extra(0, &described(4, 16, "a", 0, 0.0, 100.0)).remove(0);
        assert!(whole.store(7.5, &mut [0; 2]).is_err());
        let nothing = extra(0, &described(4, 8, "a", 0, 0.0, 0.0)).remove(0);
        assert!(nothing.store(1.0, &mut [0; 2]).is_err());
    }
}
