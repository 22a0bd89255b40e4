//! Text: CSV, XYZ, PTS and PWN.

use std::io::Write;

use walpha::points::{PointOptions, read_model};

use super::points::*;
use super::{Fate, walk};
use crate::common::json;

/// The two points as atoms of these radii, and nothing is said about them.
fn bondi(path: &std::path::Path, radii: [f64; 2]) {
    let points = points(path);
    assert_eq!(points.positions, PLACES);
    assert_eq!(points.weights, Some(radii.map(|r| r * r).to_vec()));
    let told = json(path.parent().unwrap(), &["info", path.to_str().unwrap()]);
    assert_eq!((told.get("warnings"), &told["coordinates"]["unit"]), (None, &"Å".into()), "{told}");
}

fn utf16(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

fn gzip(text: &str) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

fn archive(members: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in members {
        archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(text.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_tables() {
    const ROWS: &str = "1;2;3\n4;5;6\n";
    walk(
        "CSV, TSV",
        &[
            row!("separators", "a.csv", "x\ty\tz\n1\t2\t3\n4\t5\t6\n", Fate::Read(without_a_word)),
            row!("`sep=`", "a.csv", format!("sep=;\nx;y;z\n{ROWS}"), Fate::Read(without_a_word)),
            row!(
                "quotes",
                "a.csv",
                "\"x\",\"y\",\"z\"\n\"1,0\",\"2\",3\n4,5,\"6\"\n",
                Fate::Read(places)
            ),
            row!(
                "decimal commas",
                "a.csv",
                "x;y;z\n1,0;2,0;3,0\n4;5;6,0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "commas that may group thousands",
                "a.tsv",
                "1,234\t5,678\t9,012\n",
                Fate::Refused(&["line 1", "1.234 or 1234", "no row decides", "decimal points"])
            ),
            row!(
                "marks between thousands",
                "a.csv",
                "x;y;z\n1'234.5;2;3\n",
                Fate::Refused(&["line 2, column x", "1'234.5"])
            ),
            row!("exponents with D", "a.csv", "0.1D+01,2,3\n4d0,5,6\n", Fate::Read(without_a_word)),
            row!(
                "names of columns",
                "a.csv",
                "id,Z,Y,X,r\n9,3,2,1,0\n9,6,5,4,0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "names in a comment, without x, y or z",
                "a.csv",
                "# t x y\n0.1 1 2\n0.2 4 5\n",
                Fate::Refused(&["t,x,y", "do not name z"])
            ),
            row!(
                "a comment that may name the columns",
                "a.csv",
                "# made by me\n1 2 3\n4 5 6\n",
                Fate::PassedOver(&["# made by me", "is taken for a remark", "names the columns"])
            ),
            row!(
                "labels that begin as comments do",
                "a.csv",
                "name,x,y,z\n#1,1,2,3\n/b.jpg,4,5,6\n# 1,2 3,4\n",
                Fate::Read(|path| {
                    places(path);
                    let told = warnings(path);
                    assert!(told.contains("2 lines that begin as comments do"), "{told}");
                })
            ),
            row!(
                "a first column that counts up",
                "a.csv",
                "7,1,2,3\n8,4,5,6\n9,1,1,1\n10,0,0,0\n",
                Fate::Read(|path| {
                    assert_eq!(points(path).positions[0], [7.0, 1.0, 2.0]);
                    let told = warnings(path);
                    assert!(told.contains("the first column counts from 7 up"), "{told}");
                    assert!(told.contains("the fourth column is taken for values"), "{told}");
                })
            ),
            row!(
                "names that are numbers",
                "a.csv",
                ",0,1,2\n0,1.5,2,3\n1,4,5,6\n",
                Fate::Refused(&["numbers the columns", "--columns -,x,y,z"])
            ),
            row!("a name twice", "a.csv", "x,y,z,x\n1,2,3,1\n", Fate::Refused(&["name x twice"])),
            row!("no names", "a.csv", "1,2,3,7\n4,5,6,8\n", Fate::Read(values)),
            row!("`weight`", "a.csv", "x,y,z,Weight\n1,2,3,7\n4,5,6,8\n", Fate::Read(weights)),
            row!("`radius`", "a.csv", "x,y,z,radius\n1,2,3,2\n4,5,6,3\n", Fate::Read(radii)),
            row!(
                "`value`, or else `intensity`",
                "a.csv",
                "x,y,z,scalar_Intensity\n1,2,3,7\n4,5,6,8\n",
                Fate::Read(values)
            ),
            row!(
                "a unit",
                "a.csv",
                "x [mm],y (mm),z(mm)\n1,2,3\n4,5,6\n",
                Fate::Read(|path| {
                    places(path);
                    let told = json(path.parent().unwrap(), &["info", "a.csv"]);
                    assert_eq!(told["coordinates"]["unit"], "mm");
                })
            ),
            row!(
                "a unit in a line of its own",
                "a.csv",
                "x,y,z\nm,m,m\n1,2,3\n4,5,6\n",
                Fate::Read(|path| {
                    places(path);
                    let told = json(path.parent().unwrap(), &["info", "a.csv"]);
                    assert_eq!(told["coordinates"]["unit"], "m");
                })
            ),
            row!(
                "a unit that is not known",
                "a.csv",
                "x [furlong],y [furlong],z [furlong]\n1,2,3\n",
                Fate::PassedOver(&["the unit furlong is not known"])
            ),
            row!(
                "units that differ",
                "a.csv",
                "x [m],y [m],z [cm]\n1,2,3\n",
                Fate::Refused(&["different units, m and cm"])
            ),
            row!(
                "longitude and latitude",
                "a.csv",
                "x [deg],y [deg],z [m]\n1,2,3\n",
                Fate::Refused(&["angles and no length", "UTM"])
            ),
            row!(
                "empty cells, NaN",
                "a.csv",
                "x,y,z\n1,,3\n",
                Fate::Refused(&["line 2, column y", "no number"])
            ),
            row!("empty lines", "a.csv", "x,y,z\n\n1,2,3\n,,\n4,5,6\n", Fate::Read(without_a_word)),
            row!(
                "separators at the ends of lines",
                "a.csv",
                "x,y,z,\n1,2,3,\n4,5,6,\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "a count that is right",
                "a.csv",
                "//X;Y;Z\n2\n1;2;3\n4;5;6\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "a count that is wrong",
                "a.csv",
                "X;Y;Z\n1\n1;2;3\n4;5;6\n",
                Fate::Refused(&["claims 1 points in line 2, but has 2", "correct the count"])
            ),
            row!("encoding", "a.csv", utf16(&format!("x;y;z\n{ROWS}")), Fate::Read(without_a_word)),
            row!("ends of lines", "a.csv", "x,y,z\r1,2,3\r4,5,6\r", Fate::Read(without_a_word)),
            row!("gzip", "a.csv.gz", gzip("x,y,z\n1,2,3\n4,5,6\n"), Fate::Read(without_a_word)),
            row!(
                "a ZIP archive of one table",
                "a.zip",
                archive(&[("t/a.csv", "x,y,z\n1,2,3\n4,5,6\n"), ("__MACOSX/t/._a.csv", "")]),
                Fate::Read(without_a_word)
            ),
            row!(
                "other fields",
                "a.csv",
                "# made today\nname,x,y,z\n\"A, 1\",1,2,3\nB,4,5,6\n",
                Fate::Read(without_a_word)
            ),
        ],
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a row for each field")]
fn each_field_of_xyz() {
    walk(
        "XYZ",
        &[
            row!("separators", "a.xyz", "1 2, 3\n4\t5 6\n", Fate::Read(without_a_word)),
            row!("decimal commas", "a.xyz", "1,0 2,0 3,0\n4 5 6,0\n", Fate::Read(places)),
            row!(
                "commas that may group thousands",
                "a.xyz",
                "1,234 5,678 9,012\n1,000 2,000 3,000\n",
                Fate::Refused(&["line 1", "1.234 or 1234"])
            ),
            row!(
                "blanks that may group thousands",
                "a.xyz",
                "1 234,5 2 345,6 3 456,7\n",
                Fate::Refused(&["line 1", "1 and 234.5, or 1234.5"])
            ),
            row!(
                "names of columns",
                "a.txt",
                "//X Y Z\n1 2 3\n4 5 6\n",
                Fate::Read(without_a_word)
            ),
            row!("a fourth column", "a.xyz", "1 2 3 7\n4 5 6 8\n", Fate::Read(values)),
            row!(
                "a fifth column",
                "a.xyz",
                "1 2 3 4 5\n",
                Fate::Refused(&["5 columns", "--columns"])
            ),
            row!(
                "normals and colours",
                "a.xyz",
                "1 2 3 0 0 1\n4 5 6 0 1 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "elements, or atomic numbers",
                "a.xyz",
                "2\nwater\n8 1 2 3\n1 4 5 6\n",
                Fate::Read(|path| bondi(path, [1.52, 1.2]))
            ),
            row!(
                "elements behind a count alone",
                "a.xyz",
                "2\nc 1 2 3\nD 4 5 6\n",
                Fate::Read(|path| bondi(path, [1.7, 1.2]))
            ),
            row!(
                "an element without a radius",
                "a.xyz",
                "2\n\nC 1 2 3\nFe 4 5 6\n",
                Fate::Refused(&[
                    "has an atom whose radius bondi does not tell: Fe",
                    "--radii none"
                ])
            ),
            row!(
                "names of which some are elements",
                "a.xyz",
                "2\n\nC 1 2 3\nCA1 4 5 6\n",
                Fate::Refused(&["does not say of which element", "CA1"])
            ),
            row!(
                "names of which none is an element",
                "a.xyz",
                "2\n\nA 1 2 3\nA 4 5 6\n",
                Fate::PassedOver(&["its names of atoms are not elements", "--radii FILE"])
            ),
            row!(
                "a count without elements",
                "a.xyz",
                "2\n1 2 3\n4 5 6\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "a count that is wrong",
                "a.xyz",
                "3\n\nC 1 2 3\nC 4 5 6\n",
                Fate::Refused(&["claims 3", "has 2", "copy it again"])
            ),
            row!(
                "a count, and as many rows but one more",
                "a.xyz",
                "2\n1 2 3\n4 5 6\n7 8 9\n",
                Fate::Refused(&["counts 2 points, and \"1 2 3\" behind", "or one more of them"])
            ),
            row!(
                "numbers that are not atomic numbers",
                "a.xyz",
                "2\n# cloud\n0 2 3 7\n4 5 6 8\n",
                Fate::Read(|path| {
                    let points = points(path);
                    assert_eq!(points.positions, [[0.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
                    assert_eq!(points.values, Some(vec![7.0, 8.0]));
                })
            ),
            row!(
                "`Properties`",
                "a.xyz",
                "2\nProperties=pos:R:3:id:I:1:radius:R:1:species:S:1\n1 2 3 9 2 C\n4 5 6 9 3 H\n",
                Fate::Read(|path| {
                    radii(path);
                    let (points, metadata) = read_model(path, &PointOptions::default()).unwrap();
                    let atoms = points.molecule.unwrap().atoms;
                    assert_eq!(atoms[1].element.unwrap().symbol(), "H");
                    assert_eq!(metadata.coordinates.unit.symbol(), "Å");
                })
            ),
            row!(
                "columns behind z without `Properties`",
                "a.xyz",
                "2\n\nC 1 2 3 0.5\nC 4 5 6 0.5\n",
                Fate::PassedOver(&["what follows z"])
            ),
            row!(
                "`Lattice`, `pbc`",
                "a.xyz",
                "2\nLattice=\"9 0 0 0 9 0 0 0 9\" pbc=\"T T T\"\nC 1 2 3\nC 4 5 6\n",
                Fate::Read(|path| {
                    let cell = read_model(path, &PointOptions::default()).unwrap().1.cell;
                    assert_eq!(cell.unwrap().sides(), Some([9.0; 3]));
                })
            ),
            row!(
                "`Lattice` twice",
                "a.xyz",
                "1\nLattice=\"9 0 0 0 9 0 0 0 9\" Lattice=\"8 0 0 0 8 0 0 0 8\"\nC 1 2 3\n",
                Fate::Refused(&["Lattice twice"])
            ),
            row!(
                "several frames",
                "a.xyz",
                "1\nstep 0\nC 0 0 0\n2\n1 2 3\nC 1 2 3\nC 4 5 6\n1\n2\nC 0 0 0\n",
                Fate::Refused(&["holds 3 frames", "--frame, from 0 to 2"])
            ),
            row!(
                "a grid of heights",
                "a.asc",
                "ncols 2\nnrows 1\n1 2\n",
                Fate::Refused(&["ESRI ASCII"])
            ),
            row!(
                "other fields",
                "a.xyz",
                "2\n1.0 2.0 energy=3\nC 1 2 3\nH 4 5 6\n",
                Fate::Read(|path| bondi(path, [1.7, 1.2]))
            ),
        ],
    );
}

#[test]
fn a_frame_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name, text| crate::formats::files::save(folder.path(), name, text);
    second_frame(&save("a.xyz", "1\nstep 0\nC 0 0 0\n2\n1 2 3\nC 1 2 3\nC 4 5 6\n1\n2\nC 0 0 0\n"));
    second_frame(&save("a.pts", "1\n0 0 0\n2\n1 2 3\n4 5 6\n1\n0 0 0\n"));
    let told = json(folder.path(), &["info", "a.pts", "--frame", "1"]);
    assert_eq!(told["count"], 2);
    let options = PointOptions::default().frame(Some(3));
    let error = read_model(folder.path().join("a.pts"), &options).unwrap_err().to_string();
    assert!(error.contains("has no frame 3: it holds 3"), "{error}");
    let error = read_model(save("a.obj", "v 1 2 3\n"), &options).unwrap_err().to_string();
    assert!(error.contains("a format with a single frame"), "{error}");
}

#[test]
fn each_field_of_xyzn() {
    walk(
        "XYZ with normals or colours",
        &[
            row!("six columns", "a.xyzn", "1 2 3 0 3 0\n4 5 6 0 0 7\n", Fate::Read(without_a_word)),
            row!("other columns", "a.xyzrgb", "1 2 3 7\n4 5 6 8\n", Fate::Read(values)),
            row!("decimal commas", "a.xyzn", "1,0 2 3 0 0 1\n4 5 6 0 0 1\n", Fate::Read(places)),
        ],
    );
}

#[test]
fn each_field_of_pts() {
    walk(
        "PTS",
        &[
            row!("count", "a.pts", "2\n1 2 3\n4 5 6\n", Fate::Read(without_a_word)),
            row!(
                "a count that is too low",
                "a.pts",
                "1\n1 2 3\n4 5 6\n",
                Fate::Refused(&["claims 1 points in line 1, but has 2", "correct the count"])
            ),
            row!(
                "a count that is too high",
                "a.pts",
                "3\n1 2 3\n4 5 6\n",
                Fate::Refused(&["claims 3 points", "has 2", "copy it again"])
            ),
            row!("intensity", "a.pts", "1 2 3 7 9 9 9\n4 5 6 8 9 9 9\n", Fate::Read(values)),
            row!("colour", "a.pts", "1 2 3 255 0 9\n4 5 6 0 0 9\n", Fate::Read(without_a_word)),
            row!("decimal commas", "a.pts", "2\n1,0 2,0 3,0\n4,0 5,0 6,0\n", Fate::Read(places)),
            row!(
                "several scans",
                "a.pts",
                "1\n1 2 3\n1\n4 5 6\n",
                Fate::Refused(&["holds 2 frames: scans", "--frame, from 0 to 1"])
            ),
            row!(
                "names of columns",
                "a.pts",
                "//X;Y;Z;Rf;Intensity\n2\n1;2;3;0;7\n4;5;6;0;8\n",
                Fate::Read(values)
            ),
        ],
    );
}

#[test]
fn each_field_of_pwn() {
    walk(
        "PWN",
        &[
            row!("count", "a.pwn", "2\n1 2 3\n4 5 6\n", Fate::Read(without_a_word)),
            row!("normals", "a.pwn", "2\n1 2 3\n4 5 6\n0 0 1\n0 0 1\n", Fate::Read(without_a_word)),
            row!(
                "normals beside the points",
                "a.pwn",
                "1 2 3 0 0 1\n4 5 6 1 0 0\n",
                Fate::Read(without_a_word)
            ),
            row!(
                "a count that is wrong",
                "a.pwn",
                "2\n1 2 3\n4 5 6\n0 0 1\n",
                Fate::Refused(&["claims 2 points", "has 3"])
            ),
        ],
    );
}

/// Names and labels behind `#`, in the ways in which programs write them.
#[test]
fn comments_are_names_or_rows_or_neither() {
    let folder = tempfile::tempdir().unwrap();
    let save = |text: &str| crate::formats::files::save(folder.path(), "a.csv", text);
    for text in [
        "# lon,lat,height\n10.5,50,1\n",
        "#longitude,latitude,z\n10.5,50,1\n",
        "# id x y\n1 1 2\n",
        "# r theta z\n1 0.5 2\n",
        "# x y t\n1 2 0.5\n",
        "# n X-coord Y-coord Z-coord\n1 0 0 0\n",
        "// a;b;c\n1;2;3\n",
        "# a,b,c\n# made today\n2\n1,5 2,5 3,5\n1 2 3\n",
    ] {
        let error = walpha::points::read_points(save(text), None).unwrap_err().to_string();
        assert!(error.contains("must name the columns"), "{text}: {error}");
    }
    for text in [
        "# z y x\n3 2 1\n6 5 4\n",
        "# 0 0 0\n1 2 3\n4 5 6\n",
        "# of x and so on\n1 2 3\n4 5 6\n",
        "x,y,z\n1,2,3\n#7,8,9\n4,5,6\n",
        "name,x,y,z\n\"#1\",1,2,3\nb,4,5,6\n",
    ] {
        without_a_word(&save(text));
    }
    let labels = "colour;x;y;z\n#ff0000;1;2;3\n#00ff00;4;5;6\n";
    places(&save(labels));
    places(&save("name x y z\n#1 1,0 2,0 3,0\n#2 4,0 5,0 6,0\n"));
    let columns = "-,x,y,z".parse().unwrap();
    for text in ["# t a b c\n#1 1 2 3\n2 4 5 6\n", labels] {
        let points = walpha::points::read_points(save(text), Some(&columns)).unwrap();
        assert_eq!(points.positions, PLACES, "{text}");
    }
}

/// `--weights column` for a file without a column that is named as a weight.
#[test]
fn a_fourth_column_is_a_weight_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    crate::formats::files::save(f, "a.xyz", "0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n");
    let told = json(f, &["shape", "a.xyz", "--alpha", "1"]);
    assert_eq!(told["weights"]["max"], 0.0);
    let told = json(f, &["shape", "a.xyz", "--alpha", "1", "--weights", "column"]);
    assert_eq!(told["weights"]["max"], 4.0);
    assert!(told["warnings"].to_string().contains("its values are taken for weights"), "{told}");
}

/// Files whose content contradicts their name.
#[test]
fn kinds_that_are_no_text_of_points() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let told = |name: &str, bytes: &[u8]| {
        let path = crate::formats::files::save(f, name, bytes);
        walpha::points::read_points(path, None).unwrap_err().to_string()
    };
    for (name, bytes, words) in [
        ("h.xyz", &b"1,234 5 6.5\n1'234.5 2 3\n"[..], "1.234 or 1234"),
        ("i.xyz", b"1'234.5 2 3\n", "unless its marks group thousands (1234.5)"),
        (
            "a.txt",
            b"REMARK made here\nATOM      1  N   ALA A   1       0.0     1.0     2.0\n",
            "PDB",
        ),
        ("b.txt", b"data_x\nloop_\n_atom_site_fract_x\n_cell_length_a\n", "_atom_site_fract_y"),
        ("c.xyz", b"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\n", "ITEM: ATOMS"),
        ("d.csv", b"%PDF-1.4\n", "PDF"),
        ("e.xyz", b"1 2 3\n4 5 \0\0", "bytes that are 0"),
        ("f.csv", b"\xff\xfex\0;\0y", "ends inside a character"),
        ("g.csv", b"x,y,z\n", "no rows of numbers"),
    ] {
        assert!(told(name, bytes).contains(words), "{name}: {}", told(name, bytes));
    }
    let two = archive(&[("a.xyz", "1 2 3\n"), ("b.xyz", "4 5 6\n")]);
    assert!(
        told("two.xyz", &two).contains("2 files") || told("two.xyz", &two).contains("zip archive")
    );
}
