//! Kinds of files that are recognised by their first bytes but are read neither as volumes nor as points.

use std::path::Path;

use walpha_base::advice::advice;
use walpha_base::shown::shown;

use crate::Reason;

/// A kind of file: what it is, in words that follow "is ", and what to do about it.
struct Kind {
    begins: fn(&[u8]) -> bool,
    what: &'static str,
    advice: &'static str,
}

/// Defines a kind by its first bytes.
macro_rules! kind {
    ($($start:literal)|+, $what:literal, $advice:expr) => {
        Kind {
            begins: |start| [$(&$start[..]),+].iter().any(|magic| start.starts_with(magic)),
            what: $what,
            advice: $advice,
        }
    };
}

const SLICES: &str = "give the folder of all slices, as PNG, JPEG or TIFF";
const CONVERT: &str = "convert it to NRRD, NIfTI or TIFF";
const UNPACK: &str = "unpack it, and name the file in it";
const SAVE_TABLE: &str = "save it as CSV";
pub(crate) const OF_SIMPLICES: &str =
    "judge them by `walpha check`, or name the points that they are of";
const DOWNLOAD: &str = "download the file itself: this is what a server said instead";

/// The kinds, in the order in which they are tried.
static KINDS: [Kind; 53] = [
    kind!(b"\x89PNG", "a PNG picture, one slice", SLICES),
    kind!(b"\xff\xd8\xff", "a JPEG picture, one slice", SLICES),
    kind!(b"GIF8", "a GIF picture", SLICES),
    Kind { begins: is_bmp, what: "a BMP picture", advice: SLICES },
    Kind {
        begins: |start| start.starts_with(b"RIFF") && start.get(8..12) == Some(b"WEBP"),
        what: "a WebP picture",
        advice: SLICES,
    },
    kind!(b"\0\0\0\x0cjP  ", "a JPEG 2000 picture", SLICES),
    Kind { begins: is_pnm, what: "a PGM or PPM picture", advice: SLICES },
    Kind {
        begins: |start| {
            start.get(4..8) == Some(b"ftyp")
                || start.starts_with(b"RIFF") && start.get(8..12) == Some(b"AVI ")
        },
        what: "a video",
        advice: "save its pictures as PNG, and give their folder",
    },
    kind!(b"8BPS", "a Photoshop picture", SLICES),
    kind!(
        b"MATLAB 7.3 MAT-file",
        "a MATLAB file (.mat, which is HDF5), which is not read",
        "save the array as NRRD or NPY"
    ),
    kind!(
        b"MATLAB 5.0 MAT-file",
        "a MATLAB file (.mat), which is not read",
        "save the array as NRRD, or load it by scipy.io.loadmat and save it by numpy.save"
    ),
    kind!(b"\x89HDF\r\n", "HDF5 (or MINC2, NetCDF-4), which is not read", CONVERT),
    kind!(b"CDF\x01" | b"CDF\x02" | b"CDF\x05", "NetCDF (or MINC1), which is not read", CONVERT),
    kind!(b"SIMPLE  =", "FITS, which is not read", CONVERT),
    kind!(b"ZISRAWFILE", "a CZI file of ZEISS, which is not read", "export it as OME-TIFF"),
    kind!(b"\xda\xce\xbe\x0a", "an ND2 file of Nikon, which is not read", "export it as OME-TIFF"),
    Kind {
        begins: |start| start.get(208..212) == Some(b"MAP "),
        what: "an MRC or CCP4 map, which is not read",
        advice: CONVERT,
    },
    kind!(b"BZh", "compressed with bzip2", UNPACK),
    kind!(b"\xfd7zXZ", "compressed with xz", UNPACK),
    kind!(b"\x28\xb5\x2f\xfd", "compressed with Zstandard", UNPACK),
    kind!(b"\x04\x22\x4d\x18", "compressed with LZ4", UNPACK),
    kind!(b"\x1f\x9d", "compressed with compress (.Z)", UNPACK),
    kind!(b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    kind!(b"Rar!\x1a\x07", "a RAR archive", UNPACK),
    kind!(b"PK\x03\x04" | b"PK\x05\x06", "a zip archive", UNPACK),
    Kind {
        begins: |start| start.get(257..262) == Some(b"ustar"),
        what: "a tar archive",
        advice: UNPACK,
    },
    Kind {
        begins: |start| matches!(start, [0x80, 2..=5, ..]),
        what: "a pickle of Python, which may run programs and is not read",
        advice: "save the array by numpy.save",
    },
    kind!(b"PAR1", "a Parquet table, which is not read", SAVE_TABLE),
    kind!(b"ARROW1" | b"FEA1", "an Arrow table, which is not read", SAVE_TABLE),
    kind!(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a document of an older Office program, which is not read",
        SAVE_TABLE
    ),
    kind!(b"SQLite format 3", "an SQLite database, which is not read", SAVE_TABLE),
    kind!(b"glTF", "a glTF mesh, which is not read", "save it as PLY"),
    Kind {
        begins: is_ptx,
        what: "a PTX scan, whose points have a place of their own, which is not read",
        advice: "convert it to LAS or PLY",
    },
    kind!(b"ASTM-E57", "an E57 scan, which is not read", "convert it to LAS or PLY"),
    kind!(b"%PDF", "a PDF document", "name a file with samples or points in it"),
    kind!(b"%!PS", "a PostScript document", "name a file with samples or points in it"),
    kind!(
        b"version https://git-lfs",
        "a pointer of Git LFS and not the file itself",
        "fetch the file: `git lfs pull`"
    ),
    kind!(
        b"/annex/objects/",
        "a pointer of git-annex and not the file itself",
        "fetch the file: `git annex get`"
    ),
    Kind {
        begins: is_our_page,
        what: "a page of `walpha view`",
        advice: "open it in a browser, and name the input that it was made from",
    },
    Kind {
        begins: |start| text(start).starts_with(b"{\"points\":["),
        what: "the simplices of a shape or a filtration (JSON)",
        advice: OF_SIMPLICES,
    },
    Kind { begins: is_html, what: "an HTML page", advice: DOWNLOAD },
    Kind {
        begins: |start| {
            text(start).starts_with(b"{\"message\"") || text(start).starts_with(b"{\"error\"")
        },
        what: "an error message of a server (JSON)",
        advice: DOWNLOAD,
    },
    Kind {
        begins: |start| is_other_xml(start) && start.windows(4).any(|window| window == b"<OME"),
        what: "OME-XML, the metadata of an image in TIFF files, and no samples",
        advice: "name a TIFF file that has its own metadata: save the image as one OME-TIFF",
    },
    Kind {
        begins: is_other_xml,
        what: "XML, and no file of VTK",
        advice: "name a file with samples or points in it",
    },
    Kind {
        begins: is_pdb,
        what: "a PDB or PQR file of a molecule",
        advice: "call it .pdb or .pqr: the name says what its columns are",
    },
    Kind {
        begins: is_cif,
        what: "a CIF file of a molecule or crystal, which has points and no samples",
        advice: "read it as points: call it .cif",
    },
    Kind {
        begins: is_gro,
        what: "a GRO file of GROMACS, which has points and no samples",
        advice: "read it as points: call it .gro",
    },
    Kind {
        begins: is_lammps_dump,
        what: "a LAMMPS dump, which has points and no samples",
        advice: "read it as points: call it .lammpstrj",
    },
    Kind {
        begins: is_lammps_data,
        what: "a LAMMPS data file, which has points and no samples",
        advice: "read it as points: call it .lmp",
    },
    Kind {
        begins: is_poscar,
        what: "a POSCAR file of VASP, which has points and no samples",
        advice: "read it as points: call it .vasp",
    },
    kind!(
        b"\x7fELF" | b"MZ\x90\0" | b"\xcf\xfa\xed\xfe",
        "a program",
        "name a file with samples or points in it"
    ),
    kind!(b"-----BEGIN ", "a key or certificate", "name a file with samples or points in it"),
    kind!(b"{\\rtf", "an RTF document", "save it as plain text"),
];

/// Why a file with these first bytes is not read, if its kind is known.
pub fn other_kind(start: &[u8]) -> Option<Reason> {
    let kind = kind(start)?;
    Some(Reason::unsupported(format!("is {}", kind.what), kind.advice))
}

/// What a file with these first bytes is, if its kind is known.
#[cfg(feature = "dicom")]
pub(super) fn other_name(start: &[u8]) -> Option<&'static str> {
    Some(kind(start)?.what)
}

fn kind(start: &[u8]) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| (kind.begins)(start))
}

/// Why a file is not read that holds the samples of a header beside it, or has the name of such a file.
pub(super) fn partner(path: &Path) -> Option<Reason> {
    const HEADERS: [&str; 3] = ["hdr", "mhd", "nhdr"];
    let beside = HEADERS.map(|extension| path.with_extension(extension));
    if let Some(header) = beside.iter().find(|header| header.is_file()) {
        let header = shown(header);
        let what = format!(
            "is not in a format that is recognised by its content; {header} is beside it, a header that may describe it"
        );
        return Some(Reason::content(what, format!("name {header}")));
    }
    let is_image = path.extension().is_some_and(|own| own.eq_ignore_ascii_case("img"));
    is_image.then(|| {
        let header = shown(&beside[0]);
        let what = format!(
            "is named like the samples of a NIfTI pair, but its header {header} is missing"
        );
        use walpha_base::advice::Setting::{Dims, Dtype};
        Reason::content(
            what,
            advice![
                "copy that, too, and name it; for raw samples give ",
                Dims,
                " X,Y,Z and ",
                Dtype
            ],
        )
    })
}

/// Removes the mark of the encoding and leading white space from text.
fn text(start: &[u8]) -> &[u8] {
    start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start()
}

/// What a page of `walpha view` begins with, as `web/page/build.mjs` makes it.
const OUR_PAGE: &[u8] = b"<!DOCTYPE html><!-- Made by `node web/page/build.mjs`";

fn is_our_page(start: &[u8]) -> bool {
    start.starts_with(OUR_PAGE)
}

fn is_html(start: &[u8]) -> bool {
    let start = text(start);
    let begins =
        |tag: &[u8]| start.get(..tag.len()).is_some_and(|own| own.eq_ignore_ascii_case(tag));
    begins(b"<!doctype html") || begins(b"<html") || begins(b"<head")
}

/// Whether the file is XML other than VTK's. A VTK file may begin with a comment that hides its first element from us.
fn is_other_xml(start: &[u8]) -> bool {
    let start = text(start);
    start.starts_with(b"<svg")
        || start.starts_with(b"<?xml") && !start.windows(4).any(|window| window == b"<!--")
}

/// Whether the file is in GROMACS's GRO format: a title, a count, and a line of a residue's number and name, an atom's name and
/// number, and a position, each in columns of fixed width.
pub fn is_gro(start: &[u8]) -> bool {
    let mut lines = start.split(|&byte| byte == b'\n').skip(1);
    let mut next = || str::from_utf8(lines.next()?).ok();
    let (Some(count), Some(atom)) = (next(), next()) else { return false };
    let whole = |from: usize, to: usize| {
        atom.get(from..to).is_some_and(|text| text.trim().parse::<u32>().is_ok())
    };
    let place = |axis: usize| {
        let text = atom.get(20 + 8 * axis..28 + 8 * axis).unwrap_or_default();
        text.contains('.') && text.trim().parse::<f64>().is_ok()
    };
    let is_name = |text: &str| text.contains(|c: char| c.is_ascii_alphabetic());
    count.trim().parse::<u32>().is_ok()
        && whole(0, 5)
        && whole(15, 20)
        && atom.get(5..15).is_some_and(is_name)
        && (0..3).all(place)
}

/// Whether the file begins as a dump of LAMMPS.
pub fn is_lammps_dump(start: &[u8]) -> bool {
    ["ITEM: TIMESTEP", "ITEM: UNITS", "ITEM: TIME\n"]
        .iter()
        .any(|item| start.starts_with(item.as_bytes()))
}

/// Whether the file is a data file of LAMMPS: behind a title it has lines with the numbers of atoms and of their types.
pub fn is_lammps_data(start: &[u8]) -> bool {
    let counts = |line: &[u8], what: &[&str]| {
        let line = str::from_utf8(line).unwrap_or_default();
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        words.next().is_some_and(|word| word.parse::<u64>().is_ok())
            && words.eq(what.iter().copied())
    };
    let has =
        |what: &[&str]| start.split(|&byte| byte == b'\n').skip(1).any(|line| counts(line, what));
    has(&["atoms"]) && has(&["atom", "types"])
}

/// Whether the file is a POSCAR of VASP: a title, a scale, three vectors, names of elements, and as many numbers of atoms.
pub fn is_poscar(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines().skip(1).map(|line| line.split_whitespace().collect::<Vec<_>>());
    let mut next = || lines.next().unwrap_or_default();
    let are_numbers = |words: &[&str], count: usize| {
        words.len() == count && words.iter().all(|word| word.parse::<f64>().is_ok())
    };
    let (scale, vectors) = (next(), [next(), next(), next()]);
    let (names, counts) = (next(), next());
    (are_numbers(&scale, 1) || are_numbers(&scale, 3))
        && vectors.iter().all(|vector| are_numbers(vector, 3))
        && !names.is_empty()
        && names.iter().all(|name| name.starts_with(|c: char| c.is_ascii_alphabetic()))
        && counts.len() == names.len()
        && counts.iter().all(|count| count.parse::<u64>().is_ok())
}

/// Whether the first lines contain words that CIF files have.
pub fn is_cif(start: &[u8]) -> bool {
    const WORDS: [&[u8]; 4] = [b"_entry", b"_audit", b"_cell", b"_atom_site"];
    let start = text(start);
    let has = |word: &&[u8]| start.windows(word.len()).any(|window| window == *word);
    start.starts_with(b"data_") && WORDS.iter().any(has)
}

/// Whether the file begins as PNM: with a letter, a digit, white space, and a whole number or a comment. Rows of a label and at
/// least three numbers, as in `P1 1 2 3`, are a table of points.
fn is_pnm(start: &[u8]) -> bool {
    let words =
        |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    let mut lines = start.split(|&byte| byte == b'\n');
    let (first, second) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let is_table = words(first) > 3
        && words(second) == words(first)
        && second.first().is_some_and(u8::is_ascii_alphabetic);
    let header = first.split(|&byte| byte == b'#').next().unwrap_or_default();
    matches!(start, [b'P', b'1'..=b'6', b' ' | b'\n' | b'\r' | b'\t', b'0'..=b'9' | b'#', ..])
        && !header.contains(&b'.')
        && !is_table
}

/// Whether the file begins as PTX: with two counts, the position of the scanner, its axes, and a matrix, as lines of 1, 1, 3, 3,
/// 3, 3, 4, 4, 4 and 4 numbers.
fn is_ptx(start: &[u8]) -> bool {
    let lines = start.split(|&byte| byte == b'\n').take(10);
    let counts = lines.map(|line| {
        let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let numbers = words.map(|word| str::from_utf8(word).ok()?.parse::<f64>().ok());
        numbers.collect::<Option<Vec<_>>>().map(|numbers| numbers.len())
    });
    counts.eq([1, 1, 3, 3, 3, 3, 4, 4, 4, 4].map(Some))
}

/// Whether the file begins as BMP: with a header of 14 bytes and one of a length that exists.
fn is_bmp(start: &[u8]) -> bool {
    start.starts_with(b"BM")
        && matches!(start.get(14..18), Some([12 | 40 | 52 | 56 | 64 | 108 | 124, 0, 0, 0]))
}

/// Whether the file begins as PDB: with a record of six characters, of which few come first in a file.
pub fn is_pdb(start: &[u8]) -> bool {
    const RECORDS: [&[u8]; 9] = [
        b"HEADER  ",
        b"ATOM ",
        b"HETATM ",
        b"REMARK ",
        b"CRYST1 ",
        b"COMPND ",
        b"TITLE  ",
        b"MODEL  ",
        b"EXPDTA ",
    ];
    RECORDS.iter().any(|record| start.starts_with(record))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_from_text_and_from_each_other() {
        let told = |start: &[u8]| other_kind(start).map(|reason| reason.to_string());
        for (start, word) in [
            (&b"\xef\xbb\xbf \n<!DOCTYPE HTML><html>"[..], "HTML"),
            (b"<?xml version=\"1.0\"?><gpx/>", "XML"),
            (b"version https://git-lfs.github.com/spec/v1\noid", "Git LFS"),
            (b"ATOM      1  N   MET A   1", "PDB"),
            (b"data_1ABC\n#\n_entry.id 1ABC\n", "CIF"),
            (
                b"2\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n10 20 30 1\n1 2 3 0.5\n",
                "PTX",
            ),
            (b"ATOM 1 N ALA 1 0.0 0.0 0.0 -0.4 1.85\n", "PQR"),
            (b"water\n 2\n    1SOL     OW    1   0.126   1.624   1.679\n", "GROMACS"),
            (b"ITEM: TIMESTEP\n0\n", "LAMMPS dump"),
            (b"title\n\n2 atoms\n1 atom types # no\n", "LAMMPS data"),
            (b"quartz\n1.0\n4.9 0 0\n-2.4 4.2 0\n0 0 5.4\nSi O\n3 6\nDirect\n", "POSCAR"),
            (b"\x80\x04\x95", "pickle"),
            (b"P5\n# a remark\n3 2\n255\n", "PGM"),
            (b"P2 3 2 255\n1 2 3\n4 5 6\n", "PGM"),
            (b"P6 # 1.5\n3 2\n255\n", "PGM"),
            (b"\0\0\0\x20ftypisom", "video"),
            (b"BM\x00\x00\x00\x00\x00\x00\x00\x00\x36\x00\x00\x00\x28\x00\x00\x00", "BMP"),
        ] {
            assert!(
                told(start).is_some_and(|text| text.contains(word)),
                "{word}: {:?}",
                told(start)
            );
        }
        for start in [
            &b"1 2 3\n"[..],
            b"x,y,z\n",
            b"",
            b"data_x,data_y\n1,2\n",
            b"BMI,age\n1,2\n",
            b"TITLE,x",
            b"P1 1 2 3\nP2 4 5 6\n",
            b"P5\t1\t2\t3\r\nx7\t4\t5\t6\r\n",
            b"P1 1.5 2 3\n",
            b"2 atoms\n1 2 3\n",
            b"a\n1\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n",
        ] {
            assert_eq!(told(start), None);
        }
    }
}
