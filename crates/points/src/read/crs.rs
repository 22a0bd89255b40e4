//! The reference system of a LAS file, which determines whether its coordinates are lengths in one unit. It is stated as
//! `GeoTIFF`'s keys or as well-known text.
//!
//! Sources: OGC 19-008r4, `GeoTIFF`; OGC 01-009, 12-063r5 and 18-010r7, well-known text, versions 1 and 2; LAS 1.4 R15, section 3.

use std::path::Path;

use crs_definitions::from_code;
use walpha_base::shown::shown;
use walpha_volume::{LengthUnit, Reason};

use crate::{Crs, Vertical};

/// The known properties of a reference system.
#[derive(Default)]
pub(super) struct ReferenceSystem {
    /// Whether x and y are longitude and latitude.
    is_geographic: bool,
    /// The units of x and y, and of z, as far as they are stated.
    units: [Option<Unit>; 2],
    /// The names of the systems of x and y, and of z.
    names: [Option<String>; 2],
    /// The codes of EPSG of the systems of x and y, and of z.
    codes: [Option<u16>; 2],
    /// The well-known text, if it is stated so.
    text: Option<String>,
}

/// A unit of lengths.
#[derive(Clone, Debug, PartialEq)]
struct Unit {
    name: String,
    /// The length in metres, or 0 if it is unknown.
    metres: f64,
}

impl ReferenceSystem {
    /// Reads the reference system from the records of a file, and reports what of them is not used.
    pub(super) fn of(path: &Path, header: &las::Header) -> Self {
        const DIRECTORY: u16 = 34735;
        const ASCII: u16 = 34737;
        const TEXT: u16 = 2112;
        let records = header.vlrs().iter().chain(header.evlrs());
        let records: Vec<_> =
            records.filter(|record| record.user_id == "LASF_Projection").collect();
        let ascii = records.iter().find(|record| record.record_id == ASCII);
        let ascii = ascii.map_or(&[][..], |record| &record.data);
        let stated = records.iter().filter_map(|record| match record.record_id {
            DIRECTORY => Some(Self::of_keys(&record.data, ascii)),
            TEXT => {
                let text = String::from_utf8_lossy(&record.data);
                let text = text.trim_end_matches(['\0', ' ']);
                Some(Self { text: Some(text.to_owned()), ..Self::of_text(text) })
            }
            _ => None,
        });
        let (chosen, remarks) = Self::choose(stated.collect(), header.has_wkt_crs());
        for remark in remarks {
            tracing::warn!("{}: {remark}", shown(path));
        }
        chosen
    }

    /// The system that holds among those that a file states, and remarks on what is not used. The header says whether it is that
    /// of well-known text or that of keys (LAS 1.4 R15, section 2.4); of several of this kind the last one holds.
    fn choose(mut stated: Vec<Self>, wants_text: bool) -> (Self, Vec<String>) {
        stated.retain(|system| system.crs().is_some());
        let wanted = stated.iter().rposition(|system| system.text.is_some() == wants_text);
        let Some(place) = wanted.or(stated.len().checked_sub(1)) else {
            return (Self::default(), Vec::new());
        };
        let mut chosen = stated.swap_remove(place);
        let mut remarks = chosen.complete();
        for mut other in stated {
            other.complete();
            if !chosen.covers(&other) {
                remarks.push(format!(
                    "states two coordinate systems: {} is used, and {} is not",
                    chosen.described(),
                    other.described()
                ));
                break;
            }
        }
        (chosen, remarks)
    }

    /// Whether another statement adds nothing to this one, and contradicts nothing in it.
    fn covers(&self, other: &Self) -> bool {
        let mut units = self.units.iter().zip(&other.units);
        let mut codes = self.codes.iter().zip(&other.codes);
        let agrees = |(own, other): (&Option<Unit>, &Option<Unit>)| match (own, other) {
            (_, None) => true,
            (None, Some(_)) => false,
            (Some(own), Some(other)) => own.is_like(other),
        };
        self.is_geographic == other.is_geographic
            && units.all(agrees)
            && codes.all(|(own, other)| other.is_none() || own == other)
    }

    /// The system in words, and how it is stated.
    fn described(&self) -> String {
        let crs = self.crs().unwrap_or_default();
        let mut parts = vec![crs.label()];
        parts.extend(crs.unit.map(|unit| format!("in {unit}")));
        let Vertical { epsg, unit, .. } = crs.vertical;
        parts.extend(epsg.map(|code| format!("heights EPSG:{code}")));
        parts.extend(unit.map(|unit| format!("heights in {unit}")));
        let how = if self.text.is_some() { "well-known text" } else { "GeoTIFF's keys" };
        format!("that of {how} ({})", parts.join(", "))
    }

    /// Adds the names and units that EPSG has for stated codes, where the file does not state them. A code whose unit differs from
    /// the stated one would place the points elsewhere: it is removed, and a remark says so.
    fn complete(&mut self) -> Vec<String> {
        let mut remarks = Vec::new();
        let known = self.codes[0].and_then(from_code);
        // The key of projected systems may hold the code of a geographic one.
        self.is_geographic |= known.is_some_and(|known| known.proj4.starts_with("+proj=longlat"));
        let registered = [
            known.and_then(|known| Unit::of_definition(known.proj4)),
            self.codes[1].and_then(Unit::of_heights),
        ];
        for (axis, registered) in registered.into_iter().enumerate() {
            let (Some(code), Some(registered)) = (self.codes[axis], registered) else { continue };
            match &self.units[axis] {
                None => self.units[axis] = Some(registered),
                Some(unit) if unit.metres > 0.0 && !unit.is_like(&registered) => {
                    remarks.push(format!(
                        "states the unit {} of {}, but EPSG:{code} is in {}: the stated unit holds, and the code is not used",
                        unit.name,
                        ["x and y", "z"][axis],
                        registered.name
                    ));
                    self.codes[axis] = None;
                }
                Some(_) => {}
            }
        }
        #[cfg(not(target_family = "wasm"))]
        if let Some(known) = self.codes[0].and_then(from_code) {
            let [name, _] = Self::of_text(known.wkt).names;
            self.names[0] = self.names[0].take().or(name);
        }
        remarks
    }

    /// The system as far as it is stated; `None` if nothing is.
    pub(super) fn crs(&self) -> Option<Crs> {
        let [unit, height] = &self.units;
        let name = |unit: &Option<Unit>| unit.as_ref().map(|unit| unit.name.clone());
        let [own, vertical] = self.names.clone();
        let crs = Crs {
            epsg: self.codes[0],
            name: own,
            geographic: self.is_geographic,
            unit: name(unit),
            vertical: Vertical { epsg: self.codes[1], name: vertical, unit: name(height) },
            text: None,
            length: unit.as_ref().map_or(LengthUnit::Unstated, |unit| {
                if self.is_geographic {
                    LengthUnit::Unstated
                } else {
                    LengthUnit::of_metres(unit.metres)
                }
            }),
        };
        (crs != Crs::default()).then(|| Crs { text: self.text.clone(), ..crs })
    }

    /// Refuses angles, and heights in another unit than x and y.
    pub(super) fn check(&self) -> Result<(), Reason> {
        if self.is_geographic {
            let what = "states longitude and latitude, which are angles, not lengths";
            return Err(Reason::unsupported(what, "project them to a plane first, as UTM does"));
        }
        if let [Some(plane), Some(height)] = &self.units
            && !plane.is_like(height)
        {
            let (plane, height) = (&plane.name, &height.name);
            let what = format!("states different units, {plane} of x and y and {height} of z");
            return Err(Reason::content(what, "write all coordinates in one unit"));
        }
        Ok(())
    }

    /// Reads a directory of keys. Each entry is a number, the place of its values (0: here), their count, and the value, or
    /// where it begins in the text of another record.
    fn of_keys(bytes: &[u8], ascii: &[u8]) -> Self {
        const ASCII: u16 = 34737;
        const UNDEFINED: u16 = 32767;
        /// The keys of codes, and those of names by the system that they belong to.
        const CODES: [u16; 2] = [3072, 4096];
        const GEOGRAPHIC_CODE: u16 = 2048;
        const NAMES: [&[u16]; 2] = [&[3073, 1026], &[4097]];
        const GEOGRAPHIC_NAMES: &[u16] = &[2049, 1026];
        const MODEL: u16 = 1024;
        const GEOGRAPHIC: [u16; 2] = [2048, 2054];
        const UNITS: [u16; 2] = [3076, 4099];
        let (pairs, _) = bytes.as_chunks::<2>();
        let numbers: Vec<u16> = pairs.iter().map(|&pair| u16::from_le_bytes(pair)).collect();
        let keys = || numbers.as_chunks::<4>().0.iter().skip(1);
        let value = |wanted: u16| {
            keys().find(|[key, place, ..]| (*key, *place) == (wanted, 0)).map(|&[.., value]| value)
        };
        let is_projected = || keys().any(|[key, ..]| (3072..=3095).contains(key));
        let is_geographic = match value(MODEL) {
            Some(1 | 3) => false,
            Some(2) => true,
            // A writer may omit the kind of system, and state the system or its unit of angles.
            _ => GEOGRAPHIC.iter().any(|&key| value(key).is_some()) && !is_projected(),
        };
        let text = |wanted: &u16| {
            let [_, _, count, start] =
                *keys().find(|[key, place, ..]| (key, *place) == (wanted, ASCII))?;
            let start = usize::from(start);
            let bytes = ascii.get(start..start + usize::from(count))?;
            // ASCII by the standard; writers in Europe use Latin-1.
            let latin = || bytes.iter().map(|&byte| char::from(byte)).collect();
            let text = str::from_utf8(bytes).map_or_else(|_| latin(), str::to_owned);
            let text = text.trim_matches(['|', '\0', ' ']);
            (!text.is_empty()).then(|| text.to_owned())
        };
        let mut codes = CODES.map(value);
        let mut names = NAMES.map(|keys| keys.iter().find_map(text));
        if is_geographic {
            codes[0] = value(GEOGRAPHIC_CODE);
            names[0] = GEOGRAPHIC_NAMES.iter().find_map(text);
        }
        Self {
            is_geographic,
            units: UNITS.map(|key| value(key).and_then(Unit::of_code)),
            names,
            codes: codes.map(|code| code.filter(|&code| code != 0 && code != UNDEFINED)),
            text: None,
        }
    }

    /// Reads well-known text of either version: nested lists, each with a keyword before its bracket.
    fn of_text(text: &str) -> Self {
        let mut system = Self::default();
        let [mut has_angles, mut has_lengths] = [false; 2];
        let (mut quoted, mut word) = (false, 0);
        let mut open: Vec<Part> = Vec::new();
        let (mut angles, mut base) = ((None, None), None);
        for (at, c) in text.char_indices() {
            quoted ^= c == '"';
            if quoted || !"[(]),".contains(c) {
                continue;
            }
            if c == ']' || c == ')' {
                open.pop();
            } else if c != ',' {
                let (part, content) = (Part::of(text[word..at].trim()), &text[at + 1..]);
                let inside = open.iter().rev().find(|part| **part != Part::Axis);
                match (part, inside) {
                    (Part::Angles, _) => {
                        has_angles = true;
                        base = base.or_else(|| Some(quoted_name(content).map(str::to_owned)));
                    }
                    (Part::Plane, _) => {
                        has_lengths = true;
                        system.name(0, content);
                    }
                    (Part::Height, _) => system.name(1, content),
                    (Part::Code, _) => match open.last() {
                        Some(Part::Plane) => system.code(0, content),
                        Some(Part::Height) => system.code(1, content),
                        Some(Part::Angles) => angles.1 = angles.1.or_else(|| epsg_code(content)),
                        _ => {}
                    },
                    (Part::Axes, _) => has_lengths |= is_cartesian(content),
                    (Part::Unit, Some(Part::Plane)) => system.add(0, Unit::of_text(content)),
                    (Part::Unit, Some(Part::Height)) => system.add(1, Unit::of_text(content)),
                    _ => {}
                }
                open.push(part);
            }
            word = at + 1;
        }
        system.is_geographic = has_angles && !has_lengths;
        angles.0 = base.flatten();
        if system.is_geographic {
            (system.names[0], system.codes[0]) = angles;
        }
        // A geocentric system, say, has a name, too: that of the text, which comes first.
        let whole = || text.split_once(['[', '(']).and_then(|(_, content)| quoted_name(content));
        system.names[0] = system.names[0].take().or_else(|| whole().map(str::to_owned));
        system
    }

    /// Sets the name of a system, unless it is already known.
    fn name(&mut self, axis: usize, content: &str) {
        let known = &mut self.names[axis];
        *known = known.take().or_else(|| quoted_name(content).map(str::to_owned));
    }

    /// Sets the code of a system, unless it is already known.
    fn code(&mut self, axis: usize, content: &str) {
        self.codes[axis] = self.codes[axis].or_else(|| epsg_code(content));
    }

    /// Sets the unit of an axis, unless it is already known.
    fn add(&mut self, axis: usize, unit: Option<Unit>) {
        let known = &mut self.units[axis];
        *known = known.take().or(unit);
    }
}

/// The part of well-known text that a keyword begins, as far as it matters here.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// A system of longitude and latitude, unless it is Cartesian, that is, geocentric.
    Angles,
    /// A system of lengths.
    Plane,
    Height,
    Axes,
    Axis,
    Unit,
    /// The code of an authority.
    Code,
    Other,
}

impl Part {
    fn of(keyword: &str) -> Self {
        match keyword.to_ascii_uppercase().as_str() {
            "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS" | "GEODCRS" | "GEODETICCRS" => Self::Angles,
            "PROJCS" | "PROJCRS" | "PROJECTEDCRS" | "DERIVEDPROJCRS" | "LOCAL_CS" | "ENGCRS"
            | "ENGINEERINGCRS" => Self::Plane,
            "VERT_CS" | "VERTCS" | "VERTCRS" | "VERTICALCRS" => Self::Height,
            "CS" => Self::Axes,
            "AXIS" => Self::Axis,
            "UNIT" | "LENGTHUNIT" => Self::Unit,
            "AUTHORITY" | "ID" => Self::Code,
            _ => Self::Other,
        }
    }
}

/// The text in quotes at the start of the content of brackets.
fn quoted_name(content: &str) -> Option<&str> {
    let (name, _) = content.trim_start().strip_prefix('"')?.split_once('"')?;
    (!name.is_empty()).then_some(name)
}

/// The code in the content of `AUTHORITY[…]` or `ID[…]`, if EPSG is the authority.
fn epsg_code(content: &str) -> Option<u16> {
    let rest = content.trim_start().strip_prefix("\"EPSG\"")?.trim_start().strip_prefix(',')?;
    rest.split([',', ']', ')']).next()?.trim_matches(['"', ' ']).parse().ok()
}

/// Whether axes are Cartesian, according to the text after `CS[`.
fn is_cartesian(content: &str) -> bool {
    const WORD: &str = "Cartesian";
    content.trim_start().get(..WORD.len()).is_some_and(|kind| kind.eq_ignore_ascii_case(WORD))
}

/// The codes of systems of heights and depths in metres (EPSG, version 12).
const HEIGHTS_IN_METRES: [u16; 276] = [
    3855, 3886, 3900, 4440, 4458, 5193, 5195, 5214, 5237, 5317, 5336, 5597, 5600, 5601, 5602, 5603,
    5604, 5605, 5606, 5607, 5608, 5609, 5610, 5611, 5612, 5613, 5615, 5616, 5617, 5618, 5619, 5620,
    5621, 5701, 5703, 5704, 5705, 5706, 5709, 5710, 5711, 5712, 5713, 5714, 5715, 5716, 5717, 5718,
    5719, 5720, 5721, 5722, 5723, 5724, 5725, 5726, 5727, 5728, 5729, 5730, 5731, 5732, 5733, 5734,
    5735, 5736, 5737, 5738, 5739, 5740, 5741, 5742, 5743, 5744, 5745, 5746, 5747, 5748, 5749, 5750,
    5751, 5752, 5753, 5755, 5756, 5757, 5758, 5759, 5760, 5761, 5762, 5763, 5764, 5765, 5766, 5767,
    5768, 5769, 5770, 5771, 5772, 5773, 5774, 5775, 5776, 5777, 5778, 5779, 5780, 5781, 5782, 5783,
    5784, 5785, 5786, 5787, 5788, 5789, 5790, 5791, 5792, 5793, 5794, 5795, 5796, 5797, 5798, 5799,
    5829, 5831, 5843, 5861, 5862, 5863, 5864, 5865, 5866, 5867, 5868, 5869, 5870, 5871, 5872, 5873,
    5874, 5941, 6178, 6179, 6180, 6181, 6182, 6183, 6184, 6185, 6186, 6187, 6357, 6638, 6639, 6640,
    6641, 6642, 6643, 6644, 6647, 6693, 6694, 6695, 6916, 7446, 7447, 7651, 7652, 7699, 7700, 7707,
    7832, 7837, 7839, 7841, 7888, 7889, 7890, 7962, 7968, 7976, 7979, 8089, 8266, 8267, 8357, 8358,
    8378, 8434, 8675, 8690, 8691, 8841, 8881, 8904, 8911, 9130, 9245, 9255, 9274, 9279, 9287, 9288,
    9303, 9335, 9351, 9389, 9390, 9392, 9393, 9394, 9395, 9396, 9397, 9398, 9399, 9400, 9401, 9402,
    9451, 9458, 9471, 9650, 9651, 9663, 9666, 9669, 9672, 9675, 9681, 9721, 9722, 9923, 9927,
    10150, 10151, 10190, 10349, 10352, 10353, 10354, 10364, 10370, 10371, 10372, 10373, 10374,
    10375, 10376, 10377, 10378, 10379, 10482, 10483, 10484, 10485, 10547, 10548, 10549, 10550,
    10551, 10552, 10565, 10588, 10649, 10650, 10678, 20000, 20034, 20035, 20036,
];

impl Unit {
    /// The unit with a code of EPSG; `None` if it is undefined.
    fn of_code(code: u16) -> Option<Self> {
        let (name, metres) = match code {
            0 | 32767 => return None,
            9001 => ("metre".to_owned(), 1.0),
            9002 => ("foot".to_owned(), 0.3048),
            9003 => ("US survey foot".to_owned(), 1200.0 / 3937.0),
            9005 => ("Clarke's foot".to_owned(), 0.304_797_265_4),
            9036 => ("kilometre".to_owned(), 1000.0),
            9095 => ("British foot (1936)".to_owned(), 0.304_800_749_1),
            other => (format!("EPSG's unit {other}"), 0.0),
        };
        Some(Self { name, metres })
    }

    /// The unit of the system of heights with a code of EPSG; `None` if no such system has it.
    fn of_heights(code: u16) -> Option<Self> {
        match code {
            5614 | 6130..=6132 | 8050 | 8051 | 8228 | 8897 => Self::of_code(9002),
            5702 | 6358..=6360 | 8052 | 8053 => Self::of_code(9003),
            5754 => Self::of_code(9095),
            code if HEIGHTS_IN_METRES.contains(&code) => Self::of_code(9001),
            _ => None,
        }
    }

    /// The unit in a definition in the form of PROJ.
    fn of_definition(definition: &str) -> Option<Self> {
        let value = |key: &str| definition.split(' ').find_map(|word| word.strip_prefix(key));
        if let Some(metres) = value("+to_meter=") {
            let metres: f64 = metres.parse().ok()?;
            return Some(Self { name: format!("{metres} m"), metres });
        }
        let (name, metres) = match value("+units=")? {
            "m" => ("metre", 1.0),
            "km" => ("kilometre", 1000.0),
            "ft" => ("foot", 0.3048),
            "us-ft" => ("US survey foot", 1200.0 / 3937.0),
            _ => return None,
        };
        Some(Self { name: name.to_owned(), metres })
    }

    /// The unit with a name in quotes and a number of metres.
    fn of_text(content: &str) -> Option<Self> {
        let (name, rest) = content.trim_start().strip_prefix('"')?.split_once('"')?;
        let number = rest.trim_start().strip_prefix(',')?.split([',', ']', ')']).next()?;
        Some(Self { name: name.to_owned(), metres: number.trim().parse().ok()? })
    }

    /// Whether lengths in one unit are lengths in the other, except for the two feet, which differ by 2 in a million.
    fn is_like(&self, other: &Self) -> bool {
        self.name == other.name || (self.metres / other.metres - 1.0).abs() < 1e-5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREES: &str = r#"["WGS 84",DATUM["World, \"[new]\"",ELLIPSOID["WGS 84",6378137,298.257,LENGTHUNIT["metre",1]]],UNIT["degree",0.0175]"#;

    fn told(system: &ReferenceSystem) -> String {
        system.check().map_or_else(|reason| reason.to_string(), |()| String::new())
    }

    fn told_of_text(text: &str) -> String {
        told(&ReferenceSystem::of_text(&text.replace('*', DEGREES)))
    }

    #[test]
    fn systems_of_angles_are_refused_however_they_are_wrapped() {
        for text in [
            "GEOGCS*]",
            " geogcs *]",
            r#"COMPD_CS["both",GEOGCS*],VERT_CS["h",UNIT["metre",1]]]"#,
            r#"COMPOUNDCRS["both",GEOGCRS*,CS[ellipsoidal,2]],VERTCRS["h",LENGTHUNIT["foot",0.3048]]]"#,
            "BOUNDCRS[SOURCECRS[GEOGRAPHICCRS*]],TARGETCRS[GEOGCRS*]]]",
            "GEODCRS*,CS[ellipsoidal,3]]",
            "GEODETICCRS(\"WGS 84\")",
        ] {
            assert!(told_of_text(text).contains("longitude and latitude"), "{text}");
        }
        for text in [
            r#"PROJCS["UTM",GEOGCS*],UNIT["metre",1]]"#,
            r#"BOUNDCRS[SOURCECRS[PROJCRS["UTM",BASEGEOGCRS*]]],TARGETCRS[GEOGCRS*]]]"#,
            "GEODCRS*,CS[Cartesian,3]]",
            "GEOCCS*]",
            "",
            "]][",
        ] {
            assert_eq!(told_of_text(text), "", "{text}");
        }
    }

    #[test]
    fn heights_in_another_unit_are_refused() {
        const FEET: &str = r#"UNIT["US survey foot",0.3048006096012192]"#;
        let both = |plane: &str, height: &str| {
            let plane = format!(r#"PROJCS["p",GEOGCS*],PARAMETER["a",1],{plane}]"#);
            told_of_text(&format!(r#"COMPD_CS["c",{plane},VERT_CS["v",{height},AXIS["Up",UP]]]"#))
        };
        let told = both(r#"UNIT["metre",1]"#, FEET);
        assert!(told.contains("metre of x and y and US survey foot of z"), "{told}");
        let axis = r#"AXIS["e",east,LENGTHUNIT["metre",1]],AXIS["n",north,LENGTHUNIT["metre",1]]"#;
        assert!(both(axis, &FEET.replace("UNIT", "LENGTHUNIT")).contains("units"));
        for (plane, height) in [
            (FEET, FEET),
            (FEET, r#"UNIT["foot",0.3048]"#),
            (r#"UNIT["metre",1]"#, r#"UNIT["m",1.0,AUTHORITY["EPSG","9001"]]"#),
            (r#"UNIT["metre",1]"#, ""),
            ("", FEET),
        ] {
            assert_eq!(both(plane, height), "", "{plane} {height}");
        }
    }

    #[test]
    fn keys_tell_angles_and_units() {
        let told_of_keys = |keys: &[[u16; 2]]| {
            let count = keys.len() as u16;
            let keys = keys.iter().flat_map(|&[key, value]| [key, 0, 1, value]);
            let bytes: Vec<u8> =
                [1, 1, 0, count].into_iter().chain(keys).flat_map(u16::to_le_bytes).collect();
            let mut system = ReferenceSystem::of_keys(&bytes, &[]);
            system.complete();
            told(&system)
        };
        for keys in [
            &[[1024, 2], [2048, 4326]][..],
            &[[2048, 4326]],
            &[[1024, 32767], [2054, 9102]],
            // The code of a geographic system in the key of projected ones.
            &[[1024, 1], [3072, 4326]],
        ] {
            assert!(told_of_keys(keys).contains("longitude and latitude"), "{keys:?}");
        }
        let told_of_feet = told_of_keys(&[[1024, 1], [3076, 9001], [4099, 9003]]);
        assert!(
            told_of_feet.contains("metre of x and y and US survey foot of z"),
            "{told_of_feet}"
        );
        // Without keys of units those of EPSG's codes hold: NAVD88 in US survey feet and in metres, and British feet.
        for (plane, heights, told) in [
            (26912, 6360, "metre of x and y and US survey foot of z"),
            (25832, 8228, "metre of x and y and foot of z"),
            (2263, 5703, "and metre of z"),
            (27700, 5754, "British foot"),
        ] {
            let found = told_of_keys(&[[1024, 1], [3072, plane], [4096, heights]]);
            assert!(found.contains(told), "{plane} {heights}: {found}");
        }
        for keys in [
            &[][..],
            &[[3072, 2263], [4096, 6360]],
            &[[3072, 26912], [4096, 5703]],
            // The code of a datum.
            &[[3072, 2263], [4096, 5103]],
            &[[1024, 1], [2048, 4326]],
            &[[2048, 4326], [3072, 32617]],
            &[[1024, 3], [2048, 4978]],
            &[[3076, 9002], [4099, 9003]],
            &[[3076, 9001], [4099, 32767]],
        ] {
            assert_eq!(told_of_keys(keys), "", "{keys:?}");
        }
    }

    fn of_keys(keys: &[[u16; 2]]) -> ReferenceSystem {
        let keys = keys.iter().flat_map(|&[key, value]| [key, 0, 1, value]);
        let bytes: Vec<u8> =
            [1, 1, 0, 0].into_iter().chain(keys).flat_map(u16::to_le_bytes).collect();
        ReferenceSystem::of_keys(&bytes, &[])
    }

    fn of_text(text: &str) -> ReferenceSystem {
        ReferenceSystem { text: Some(text.to_owned()), ..ReferenceSystem::of_text(text) }
    }

    const UTM: &str = r#"PROJCS["UTM 32N",UNIT["metre",1],AUTHORITY["EPSG","25832"]]"#;
    const STATE_PLANE: &[[u16; 2]] = &[[1024, 1], [3072, 2263], [3076, 9003]];

    /// Parts of two systems never make one.
    #[test]
    fn of_two_systems_the_one_of_the_header_holds() {
        for wants_text in [false, true] {
            let both = [
                vec![of_text(UTM), of_keys(STATE_PLANE)],
                vec![of_keys(STATE_PLANE), of_text(UTM)],
            ];
            for stated in both {
                let (system, remarks) = ReferenceSystem::choose(stated, wants_text);
                let crs = system.crs().unwrap();
                let (epsg, unit) =
                    if wants_text { (25832, "metre") } else { (2263, "US survey foot") };
                assert_eq!((crs.epsg, crs.unit.as_deref()), (Some(epsg), Some(unit)));
                assert_eq!(crs.text.is_some(), wants_text);
                let [remark] = &remarks[..] else { panic!("{remarks:?}") };
                let used = format!("EPSG:{epsg}), in {unit}) is used");
                assert!(
                    remark.contains("two coordinate systems") && remark.contains(&used),
                    "{remark}"
                );
            }
        }
        let same = vec![of_text(UTM), of_keys(&[[1024, 1], [3072, 25832]])];
        assert_eq!(ReferenceSystem::choose(same, true).1, [""; 0]);
        let heights = vec![of_text(UTM), of_keys(&[[3072, 25832], [4099, 9002]])];
        let (_, remarks) = ReferenceSystem::choose(heights, true);
        assert!(remarks[0].contains("heights in foot) is not"), "{remarks:?}");
        let texts = vec![of_text(&UTM.replace("25832", "25833")), of_text(UTM)];
        let (system, remarks) = ReferenceSystem::choose(texts, true);
        assert_eq!((system.codes[0], remarks.len()), (Some(25832), 1));
        // The header may ask for what is not there.
        let (system, remarks) =
            ReferenceSystem::choose(vec![of_keys(STATE_PLANE), of_text("")], true);
        assert_eq!((system.codes[0], remarks.len()), (Some(2263), 0));
    }

    #[test]
    fn a_code_of_another_unit_is_not_used() {
        let feet = UTM.replace(r#"["metre",1]"#, r#"["US survey foot",0.304800609601219]"#);
        for (stated, told) in [
            (
                of_keys(&[[3072, 26912], [3076, 9003]]),
                "US survey foot of x and y, but EPSG:26912 is in metre",
            ),
            (of_keys(&[[3072, 2263], [3076, 9001]]), "metre of x and y, but EPSG:2263 is in"),
            (of_text(&feet), "US survey foot of x and y, but EPSG:25832 is in metre"),
        ] {
            let unit = stated.units[0].clone();
            let (system, remarks) = ReferenceSystem::choose(vec![stated], false);
            assert!(remarks.len() == 1 && remarks[0].contains(told), "{remarks:?}");
            assert_eq!((system.codes[0], &system.units[0]), (None, &unit));
        }
        let (system, remarks) = ReferenceSystem::choose(
            vec![of_keys(&[[3072, 2263], [3076, 9003], [4096, 5703], [4099, 9003]])],
            false,
        );
        assert_eq!(system.codes, [Some(2263), None]);
        assert!(remarks[0].contains("of z, but EPSG:5703 is in metre"), "{remarks:?}");
        // The two feet are one unit, and a unit that is not known cannot be compared.
        for unit in [9002, 9003, 9042] {
            let (system, remarks) =
                ReferenceSystem::choose(vec![of_keys(&[[3072, 2263], [3076, unit]])], false);
            assert_eq!((system.codes[0], remarks.len()), (Some(2263), 0));
        }
    }

    #[test]
    fn systems_have_the_names_and_codes_that_are_stated() {
        let of_text = |text: &str| {
            let mut system = ReferenceSystem::of_text(&text.replace('*', DEGREES));
            system.complete();
            system.crs().unwrap()
        };
        let utm = r#"PROJCS["NAD83 / UTM zone 12N",GEOGCS*,AUTHORITY["EPSG","4269"]],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","26912"]]"#;
        let crs = of_text(utm);
        assert_eq!(crs.label(), "NAD83 / UTM zone 12N (EPSG:26912)");
        assert_eq!((crs.length, crs.geographic), (LengthUnit::Metre, false));
        let both = of_text(&format!(
            r#"COMPD_CS["both",{utm},VERT_CS["NAVD88 height",UNIT["foot",0.3048],AUTHORITY["EPSG","6360"]]]"#
        ));
        assert_eq!((both.epsg, both.vertical.epsg), (Some(26912), Some(6360)));
        assert_eq!(both.vertical.name.as_deref(), Some("NAVD88 height"));
        assert_eq!(both.vertical.unit.as_deref(), Some("foot"));
        let second = of_text(r#"PROJCRS["UTM",BASEGEOGCRS*,ID["EPSG",4269]],ID["EPSG",26912]]"#);
        assert_eq!((second.epsg, second.name.as_deref()), (Some(26912), Some("UTM")));
        // The unit is that of EPSG's register.
        assert_eq!(second.length, LengthUnit::Metre);
        let degrees = of_text(r#"GEOGCS*,AUTHORITY["EPSG","4326"]]"#);
        assert_eq!((degrees.epsg, degrees.geographic), (Some(4326), true));
        assert_eq!(degrees.length, LengthUnit::Unstated);
        for geocentric in ["GEOCCS*]", "GEODCRS*,CS[Cartesian,3]]"] {
            let crs = of_text(geocentric);
            assert_eq!((crs.name.as_deref(), crs.geographic), (Some("WGS 84"), false));
        }
        let keys = [
            [1, 1, 0, 4],
            [1024, 0, 1, 1],
            [1026, 34737, 5, 2],
            [3072, 0, 1, 2994],
            [3076, 0, 1, 9002],
        ];
        let bytes: Vec<u8> =
            keys.as_flattened().iter().flat_map(|x: &u16| x.to_le_bytes()).collect();
        let crs = ReferenceSystem::of_keys(&bytes, b"x|Name|").crs().unwrap();
        assert_eq!((crs.epsg, crs.name.as_deref()), (Some(2994), Some("Name")));
        assert_eq!(crs.length, LengthUnit::Foot);
    }
}
