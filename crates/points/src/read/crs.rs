//! The reference system of a LAS file, which determines whether its coordinates are lengths in one unit. It is stated as
//! `GeoTIFF`'s keys or as well-known text.
//!
//! Sources: OGC 19-008r4, `GeoTIFF`; OGC 01-009, 12-063r5 and 18-010r7, well-known text, versions 1 and 2; LAS 1.4 R15, section 3.

use crs_definitions::from_code;
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
    /// Reads the reference system from the records of a file.
    pub(super) fn of<'a>(records: impl Iterator<Item = &'a las::Vlr>) -> Self {
        const DIRECTORY: u16 = 34735;
        const ASCII: u16 = 34737;
        const TEXT: u16 = 2112;
        let records: Vec<_> =
            records.filter(|record| record.user_id == "LASF_Projection").collect();
        let ascii = records.iter().find(|record| record.record_id == ASCII);
        let ascii = ascii.map_or(&[][..], |record| &record.data);
        let mut all = Self::default();
        for record in records {
            let own = match record.record_id {
                DIRECTORY => Self::of_keys(&record.data, ascii),
                TEXT => {
                    let text = String::from_utf8_lossy(&record.data);
                    let text = text.trim_end_matches(['\0', ' ']);
                    Self { text: Some(text.to_owned()), ..Self::of_text(text) }
                }
                _ => continue,
            };
            all.is_geographic |= own.is_geographic;
            all.text = own.text.or(all.text.take());
            for (unit, own) in all.units.iter_mut().zip(own.units) {
                *unit = own.or(unit.take());
            }
            for (name, own) in all.names.iter_mut().zip(own.names) {
                *name = own.or(name.take());
            }
            for (code, own) in all.codes.iter_mut().zip(own.codes) {
                *code = own.or(*code);
            }
        }
        all.complete();
        all
    }

    /// Adds the name and unit that EPSG has for a stated code, where the file does not state them.
    fn complete(&mut self) {
        let Some(known) = self.codes[0].and_then(from_code) else { return };
        self.units[0] = self.units[0].take().or_else(|| Unit::of_definition(known.proj4));
        #[cfg(not(target_family = "wasm"))]
        {
            let [name, _] = Self::of_text(known.wkt).names;
            self.names[0] = self.names[0].take().or(name);
        }
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

impl Unit {
    /// The unit with a code of EPSG; `None` if it is undefined.
    fn of_code(code: u16) -> Option<Self> {
        let (name, metres) = match code {
            0 | 32767 => return None,
            9001 => ("metre".to_owned(), 1.0),
            9002 => ("foot".to_owned(), 0.3048),
            9003 => ("US survey foot".to_owned(), 1200.0 / 3937.0),
            other => (format!("EPSG's unit {other}"), 0.0),
        };
        Some(Self { name, metres })
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
            told(&ReferenceSystem::of_keys(&bytes, &[]))
        };
        for keys in
            [&[[1024, 2], [2048, 4326]][..], &[[2048, 4326]], &[[1024, 32767], [2054, 9102]]]
        {
            assert!(told_of_keys(keys).contains("longitude and latitude"), "{keys:?}");
        }
        let told_of_feet = told_of_keys(&[[1024, 1], [3076, 9001], [4099, 9003]]);
        assert!(
            told_of_feet.contains("metre of x and y and US survey foot of z"),
            "{told_of_feet}"
        );
        for keys in [
            &[][..],
            &[[1024, 1], [2048, 4326]],
            &[[2048, 4326], [3072, 32617]],
            &[[1024, 3], [2048, 4978]],
            &[[3076, 9002], [4099, 9003]],
            &[[3076, 9001], [4099, 32767]],
        ] {
            assert_eq!(told_of_keys(keys), "", "{keys:?}");
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
