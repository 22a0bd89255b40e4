//! `--periodic` on the command line, and the exact checker on complexes of a torus.

use walpha::AlphaShape;
use walpha::check::schema::{BoxVectors, ComplexFile, PlacedComplex};
use walpha::check::{CertifyError, Finding, NotJudged, Verdict};
use walpha::export::{ExportOptions, Exporter, Format, Json, Npz, Save, SaveError};
use walpha::shape::{Class, placed_complex};

use super::{
    BCC, CUBIC, FCC, WeightedPoints, alpha_shape, crystal, dense, in_large_box, options, sets,
    shape,
};
use crate::common;

fn findings(placed: &PlacedComplex) -> Vec<Finding> {
    placed.findings().unwrap().0
}

#[test]
fn shapes_of_a_torus_are_certified() {
    let mut judged = 0;
    for (points, sides) in sets(36) {
        for squared in [0.5, 1.0] {
            let Ok(shape) = shape(&points, sides, squared) else { continue };
            assert_eq!(findings(&placed_complex(&shape)), []);
            judged += 1;
        }
    }
    for seed in 0..6 {
        let (points, sides) = dense(seed);
        for squared in [0.2, f64::INFINITY] {
            let whole = options(sides, squared).exterior(true);
            let shape = alpha_shape(points.clone(), &whole).unwrap();
            let (found, certificate) = placed_complex(&shape).findings().unwrap();
            assert_eq!(found, []);
            let is_declined = |rule: &NotJudged| matches!(rule, NotJudged::MissingSimplices(_));
            assert!(!certificate.not_judged.iter().any(is_declined));
            judged += 1;
        }
    }
    assert!(judged > 40, "{judged}");
}

/// The shape of a smaller α, and its cells alone, where more is in the shape.
#[test]
fn what_is_missing_on_a_torus_is_found() {
    let (mut exact, mut wrong, mut right_cells) = (0, 0, 0);
    for (points, sides) in sets(48) {
        for squared in [0.3, 0.5, 0.7, 1.0] {
            let Some(large) = in_large_box(&points, sides, squared) else { continue };
            let large = placed_complex(&large);
            for smaller in [0.3, 0.8, 1.0] {
                let small = placed_complex(&shape(&points, sides, smaller * squared).unwrap());
                let part = PlacedComplex { alpha: large.alpha, ..small };
                let verdict = |part: &PlacedComplex| part.findings().unwrap().1.verdict;
                let expected = |is_all: bool| if is_all { Verdict::Exact } else { Verdict::Wrong };
                let is_all = part.complex == large.complex;
                assert_eq!(verdict(&part), expected(is_all), "{:?}", findings(&part));
                if is_all {
                    exact += 1;
                } else {
                    wrong += 1;
                }
                let mut file = ComplexFile::of_points(part.positions.clone(), part.alpha);
                file.weights = Some(part.weights.clone());
                file.cells = Some(part.complex.cells.rows().to_vec());
                file.periodic = part.periodic;
                let cells = PlacedComplex::try_from(file).unwrap();
                let has_all = cells.complex.cells.rows() == large.complex.cells.rows();
                assert_eq!(verdict(&cells), expected(has_all), "{:?}", findings(&cells));
                right_cells += usize::from(has_all && !is_all);
            }
        }
    }
    assert!(exact > 20 && wrong > 50 && right_cells > 5, "{exact} {wrong} {right_cells}");
}

/// A grid in a box of 96. Its cells have spheres of squared radius 768.
fn grid() -> Vec<[f64; 3]> {
    crystal([3; 3], &CUBIC).positions().iter().map(|place| place.map(|x| 32.0 * x)).collect()
}

/// Large ones, and that much beyond weights far below zero.
#[test]
fn large_spheres_of_a_torus_are_judged() {
    for (weight, squared) in [(0.0, 767.0), (0.0, 768.0), (-5000.0, 5767.0), (-5000.0, 5768.0)] {
        let points = WeightedPoints::new(grid(), vec![weight; 27]).unwrap();
        let shape = alpha_shape(points, &options([96.0; 3], squared).exterior(true)).unwrap();
        let full = squared + weight >= 768.0;
        let class = if full { Class::Interior } else { Class::Exterior };
        assert!(shape.complex().cells.classes().iter().all(|&found| found == class));
        assert_eq!(findings(&placed_complex(&shape)), []);
    }
}

/// One point is hidden by a heavier one next to it, and one is at the place of another.
#[test]
fn hidden_points_of_a_torus_are_judged() {
    let mut positions = grid();
    positions.extend([[1.0, 0.0, 0.0], [64.0, 0.0, 32.0]]);
    let mut weights = vec![0.0; 27];
    weights.extend([-100.0, -1.0]);
    let points = WeightedPoints::new(positions, weights).unwrap();
    let whole = options([96.0; 3], 768.0).exterior(true);
    let right = placed_complex(&alpha_shape(points, &whole).unwrap());
    assert_eq!(
        (right.hidden.as_deref(), right.duplicates.as_deref()),
        (Some(&[27][..]), Some(&[[28, 19]][..]))
    );
    let (found, certificate) = right.findings().unwrap();
    assert_eq!(found, []);
    // At this α everything is inside: no exterior simplex says that the complex is whole. So it is not judged whether a point is
    // rightly hidden, but it is judged whether it is only hidden.
    assert!(certificate.not_judged.contains(&NotJudged::HiddenAndHull));
    let mut vertex = right;
    vertex.hidden = Some(vec![13, 27]);
    let found = findings(&vertex);
    assert!(matches!(found[..], [Finding::NotOnlyHidden { point: 13 }]), "{found:?}");
}

#[test]
fn what_is_wrong_on_a_torus_is_found() {
    let (points, sides) = dense(7);
    let whole = options(sides, 0.3).exterior(true);
    let right = placed_complex(&alpha_shape(points, &whole).unwrap());
    let count = right.complex.cells.len();
    // Cells at the sides of the box as well as within.
    for at in [0, count / 3, count / 2, count - 1] {
        let mut damaged = right.clone();
        damaged.complex.cells = right
            .complex
            .cells
            .clone()
            .into_iter()
            .enumerate()
            .filter(|(k, _)| *k != at)
            .map(|(_, cell)| cell)
            .collect();
        let found = findings(&damaged);
        let names = |finding: &Finding| {
            matches!(finding, Finding::MissingCell { .. } | Finding::Volume { .. })
        };
        assert!(found.iter().any(names), "{found:?}");
        let mut damaged = right.clone();
        let other =
            |class| if class == Class::Interior { Class::Exterior } else { Class::Interior };
        let cells = right.complex.cells.clone().into_iter().enumerate();
        damaged.complex.cells = cells
            .map(|(k, (row, class))| (row, if k == at { other(class) } else { class }))
            .collect();
        let row = right.complex.cells.rows()[at];
        let found = findings(&damaged);
        let named = found.iter().filter(|finding| matches!(finding, Finding::Class { simplex, .. } if simplex.vertices() == row));
        assert_eq!(named.count(), 1, "{found:?}");
    }
    let mut damaged = right.clone();
    let [a, b, c] = sides.vectors();
    assert_eq!((a, sides.sides()), ([4.0, 0.0, 0.0], Some([4.0, 4.0, 5.0])));
    damaged.periodic = Some(BoxVectors([[5.0, 0.0, 0.0], b, c]));
    assert!(!findings(&damaged).is_empty());
    let mut damaged = right.clone();
    damaged.periodic = Some(BoxVectors([[2.0, 0.0, 0.0], b, c]));
    assert!(matches!(damaged.findings(), Err(CertifyError::NotInBox(_))));
    let mut damaged = right;
    damaged.complex.edges.rows_mut()[0] = [0, 40];
    assert!(
        findings(&damaged).iter().any(|finding| matches!(
            finding,
            Finding::LongEdge { .. } | Finding::MissingFace { .. }
        ))
    );
}

/// A format that has no torus gets the shape laid out in space, however it is written.
#[test]
fn files_of_other_formats_hold_the_shape_in_space() {
    let (points, sides) = dense(1);
    let shape = shape(&points, sides, 0.3).unwrap();
    let off = Format::of("shape.off").unwrap().exporter(&ExportOptions::default());
    let write = |shape: &AlphaShape| {
        let mut bytes = Vec::new();
        off.write(shape, &mut bytes).unwrap();
        bytes
    };
    assert_eq!(write(&shape), write(&shape.unwrapped()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shape.off");
    shape.save(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), write(&shape));
    let error = shape.save(folder.path().join("shape.offf")).unwrap_err();
    assert!(matches!(error, SaveError::Format(_)), "{error}");
    assert!(shape.save(folder.path().join("none").join("shape.off")).is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn files_hold_the_box() {
    for (seed, is_slanted) in [(1, false), (9, true)] {
        let (points, torus) = dense(seed);
        assert_eq!(torus.sides().is_none(), is_slanted);
        let shape = shape(&points, torus, 0.3).unwrap();
        let (mut json, mut npz) = (Vec::new(), Vec::new());
        Json.write(&shape, &mut json).unwrap();
        Npz.write(&shape, &mut npz).unwrap();
        let json = PlacedComplex::try_from(ComplexFile::read_json(&json[..]).unwrap()).unwrap();
        let npz = ComplexFile::read_npz(std::io::Cursor::new(npz)).unwrap();
        let npz = PlacedComplex::try_from(npz).unwrap();
        assert_eq!(json.periodic, Some(BoxVectors(torus.vectors())));
        assert_eq!((&json, &json), (&npz, &placed_complex(&shape)));
    }
}

fn points(folder: &std::path::Path) {
    let lines = crystal([4, 4, 4], &BCC)
        .into_parts()
        .0
        .into_iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"));
    std::fs::write(folder.join("p.xyz"), lines.collect::<String>()).unwrap();
}

#[test]
fn shapes_filtrations_and_checks() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let make = ["shape", "p.xyz", "--periodic", "4,4,4", "--alpha", "0.3125", "-o"];
    let told = common::json(f, &[&make[..], &["a.json", "a.npz", "a.vtu", "a.ply"]].concat());
    assert_eq!(told["shape"]["betti"], serde_json::json!([1, 3, 3, 1]));
    assert_eq!(told["shape"]["volume"], 64.0);
    assert_eq!(told["shape"]["components"][0]["rounds"], 3);
    for file in ["a.json", "a.npz"] {
        let checked = common::ok(f, &["check", file]);
        assert!(checked.contains("exact: no findings"), "{checked}");
    }
    common::ok(f, &["check", "p.xyz", "--periodic", "4,4,4"]);
    // The smallest α with one solid component is that at which all is filled.
    let rule = ["--alpha", "auto:connected", "-o", "b.json"];
    let auto = common::json(f, &[&["shape", "p.xyz", "--periodic", "4,4,4"][..], &rule].concat());
    assert_eq!(auto["alpha"]["squared"], 0.3125);
    let made = ["filtration", "p.xyz", "--periodic", "4,4,4", "-o", "f.npz", "f.json"];
    let filtration = common::json(f, &made);
    assert_eq!(filtration["values"], 5);
    // The values of the torus, whose first and second Betti numbers are 3: edges wind round it before facets close it.
    let lasting = |of: &str| filtration["persistence"][of].clone();
    assert_eq!(lasting("lasting_loops"), serde_json::json!([0.1875, 0.1875, 0.1875]));
    assert_eq!(lasting("lasting_voids"), serde_json::json!([0.28125, 0.28125, 0.28125]));
    assert_eq!(lasting("last"), 0.3125);
    assert_eq!(common::run(f, &["check", "f.npz"]).0, 1);
    assert_eq!(common::run(f, &["compare", "a.json", "a.npz"]).0, 1);
}

#[test]
fn what_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let refused = |more: &[&str], code: i32, words: &str| {
        let all = [&["shape", "p.xyz", "-o", "a.ply"], more].concat();
        let (found, _, said) = common::run(f, &all);
        assert!(found == code && said.contains(words), "{found}: {said}");
        assert!(!f.join("a.ply").exists());
    };
    refused(&["--periodic", "4,4"], 2, "three sides");
    refused(
        &["--periodic", "4,4,4,90,90,181"],
        2,
        "no three vectors have the angles 90°, 90° and 181°",
    );
    refused(&["--periodic", "4,0,0,0,4,0,4,4,0"], 2, "span almost no volume");
    refused(&["--periodic", "4,0,0,0,nan,0,4,4,0"], 2, "nan");
    refused(&["--periodic", "cell"], 1, "does not state a cell");
    refused(&["--periodic", "4,4,-4"], 2, "along z");
    refused(&["--periodic", "4,4,4", "--solid"], 2, "--solid");
    refused(&["--periodic", "4,4,4", "--engine", "cgal"], 2, "engine cgal");
}

/// Points outside of the box are counted, and a cell that the file states is not passed over in silence.
#[test]
fn what_is_folded_and_stated_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let args = ["shape", "p.xyz", "--periodic", "4,4,4", "--alpha", "0.3125"];
    assert_eq!(common::json(f, &args)["points"]["folded"], 0);
    assert!(!common::ok(f, &args).contains("moved into it"));
    assert_eq!(common::json(f, &["shape", "p.xyz", "--alpha", "1"])["points"].get("folded"), None);
    // The points at x = 0 are moved by one box.
    let text = std::fs::read_to_string(f.join("p.xyz")).unwrap();
    let outside = text.lines().filter(|line| line.starts_with("0 "));
    let shifted = text.lines().map(|line| match line.strip_prefix("0 ") {
        Some(rest) => format!("-4 {rest}\n"),
        None => format!("{line}\n"),
    });
    std::fs::write(f.join("q.xyz"), shifted.collect::<String>()).unwrap();
    let count = outside.count();
    let args = ["shape", "q.xyz", "--periodic", "4,4,4", "--alpha", "0.3125"];
    let told = common::json(f, &args);
    assert_eq!(
        (&told["points"]["folded"], &told["shape"]["volume"]),
        (&serde_json::json!(count), &serde_json::json!(64.0))
    );
    let words = format!("{count} outside of the periodic box, moved into it");
    assert!(count > 0 && common::ok(f, &args).contains(&words));
    let args = ["filtration", "q.xyz", "--periodic", "4,4,4", "-o", "f.json"];
    assert!(common::ok(f, &args).contains(&words));
    assert_eq!(common::json(f, &args)["folded"], count);

    let atoms: String = text.lines().map(|line| format!("Fe {line}\n")).collect();
    let cell = "Lattice=\"4 0 0 0 4 0 0 0 4\"";
    std::fs::write(f.join("e.xyz"), format!("{}\n{cell}\n{atoms}", text.lines().count())).unwrap();
    let plain = ["shape", "e.xyz", "--radii", "none", "--alpha", "0.3125"];
    let warned = common::json(f, &plain)["warnings"].to_string();
    assert!(warned.contains("--periodic cell uses it") && warned.contains("4,4,4"), "{warned}");
    for (command, output) in [("shape", "g.ply"), ("filtration", "g.json")] {
        let args = [command, "e.xyz", "--radii", "none", "--periodic", "4,4,4", "-o", output];
        let told = common::json(f, &args);
        assert_eq!(told.get("warnings"), None);
    }
}

/// The lattice of face-centred cubes in its primitive cell and in cubes: what is counted for each point is the same.
#[test]
fn primitive_and_conventional_cells_agree() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Six primitive cells along each vector, and three cubes along each axis: 216 and 108 points.
    let (mut primitive, mut cubes) = (String::new(), String::new());
    for [i, j, k] in (0..216).map(|n| [n % 6, n / 6 % 6, n / 36].map(f64::from)) {
        primitive += &format!("{} {} {}\n", 0.5 * (j + k), 0.5 * (i + k), 0.5 * (i + j));
    }
    for [x, y, z] in crystal([3; 3], &FCC).positions() {
        cubes += &format!("{x} {y} {z}\n");
    }
    std::fs::write(f.join("primitive.xyz"), primitive).unwrap();
    std::fs::write(f.join("cubes.xyz"), cubes).unwrap();
    let counted = |file: &str, cell: &str, points: f64| {
        let told =
            common::json(f, &["shape", file, "--periodic", cell, "--alpha", "0.2", "-o", "a.npz"]);
        assert!(common::ok(f, &["check", "a.npz"]).contains("exact: no findings"));
        let shape = &told["shape"];
        // Sums of other numbers of terms are rounded elsewhere.
        let of = |value: &serde_json::Value| (1e12 * value.as_f64().unwrap() / points).round();
        let pairs = common::json(f, &["filtration", file, "--periodic", cell]);
        (
            [of(&shape["volume"]), of(&shape["area"]), of(&shape["cells"]["interior"])],
            pairs["values"].clone(),
            pairs["persistence"]["lasting_loops"].clone(),
        )
    };
    // The same cell by its shortest vectors, and by others.
    let expected = counted("cubes.xyz", "3,3,3", 108.0);
    assert_eq!(counted("primitive.xyz", "0,3,3,3,0,3,3,3,0", 216.0), expected);
    assert_eq!(counted("primitive.xyz", "0,3,3,3,3,6,6,9,9", 216.0), expected);
    // One point and four: the edges join points to their own copies.
    std::fs::write(f.join("one.xyz"), "0.25 0.5 0.125\n").unwrap();
    std::fs::write(f.join("four.xyz"), "0 0 0\n0 0.5 0.5\n0.5 0 0.5\n0.5 0.5 0\n").unwrap();
    assert_eq!(counted("one.xyz", "0,0.5,0.5,0.5,0,0.5,0.5,0.5,0", 1.0), expected);
    assert_eq!(counted("four.xyz", "1,1,1", 4.0), expected);
}

/// Spheres in a brick of one point, through and between its sides, and what is refused.
#[test]
fn pores_of_a_brick() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    std::fs::write(f.join("one.xyz"), "0 0 0\n").unwrap();
    let args = ["pores", "one.xyz", "--periodic", "1,1,3", "--alpha-radius", "0.25"];
    let told = common::json(f, &[&args[..], &["--probe", "0.25"]].concat());
    let is = |value: &serde_json::Value, expected: f64| {
        assert!((value.as_f64().unwrap() - expected).abs() < 1e-12, "{value} is not {expected}");
    };
    // The diagonals of the brick and of its sides, less the balls at their ends.
    let pores = &told["pores"];
    is(&pores["included"]["diameter"], 11f64.sqrt() - 0.5);
    is(&pores["free"]["diameter"], 10f64.sqrt() - 0.5);
    for (k, square) in [(0, 10.0f64), (1, 10.0), (2, 2.0)] {
        is(&pores["free_along"][k]["diameter"], square.sqrt() - 0.5);
    }
    assert_eq!(told["probe"]["channels"], serde_json::json!([3]));
    is(&told["probe"]["void_fraction"], 1.0 - std::f64::consts::PI / 6.0 / 3.0);
    // A larger one passes between planes of points only.
    let told = common::json(f, &[&args[..], &["--probe", "0.6"]].concat());
    assert_eq!(
        (&told["probe"]["channels"], &told["probe"]["pockets"]),
        (&serde_json::json!([2]), &0.into())
    );
    let said = common::ok(f, &args);
    assert!(said.contains("free      2.66228 unit; along a 2.66228 unit"), "{said}");
    let refused = |args: &[&str], code: i32, words: &str| {
        let (found, _, said) = common::run(f, args);
        assert!(found == code && said.contains(words), "{found}: {said}");
    };
    refused(&["pores", "one.xyz"], 1, "does not state a cell");
    refused(&["pores", "sample:phantom@8", "--periodic", "1,1,1"], 2, "pores are between points");
    refused(
        &["pores", "one.xyz", "--periodic", "1,1,1", "--alpha", "auto"],
        2,
        "squared radius of all balls",
    );
    refused(&["pores", "one.xyz", "--periodic", "1,1,1", "--probe", "-1"], 2, "-1");
    // Radii of two kinds.
    std::fs::write(f.join("two.csv"), "x,y,z,radius\n0,0,0,0.25\n1,1,1,0.5\n").unwrap();
    let told = common::json(f, &["pores", "two.csv", "--periodic", "2,2,2", "--probe", "0.1"]);
    assert_eq!((&told["radii"], &told["points"]), (&serde_json::json!([0.25, 0.5]), &2.into()));
    // Among four neighbours, (1, 1 − t, 0) is √(1 + t²) − ½ from the larger balls, and √(1 + (1 − t)²) − ¼ from the smaller ones.
    let t = {
        let (mut low, mut high) = (0.0f64, 1.0f64);
        for _ in 0..60 {
            let t = f64::midpoint(low, high);
            let is_short = 1f64.hypot(t) - 0.5 < 1f64.hypot(1.0 - t) - 0.25;
            (low, high) = if is_short { (t, high) } else { (low, t) };
        }
        low
    };
    is(&told["pores"]["included"]["diameter"], 2.0 * (1f64.hypot(t) - 0.5));
    assert_eq!(told["probe"]["channels"], serde_json::json!([3]));
}

/// A lone point, through all commands that take a periodic box.
#[test]
fn a_lone_point_goes_through_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    std::fs::write(f.join("one.xyz"), "0 0 0\n").unwrap();
    let fcc = "0,2,2,2,0,2,2,2,0";
    let args = ["shape", "one.xyz", "--periodic", fcc, "--alpha", "3"];
    let outputs = ["-o", "a.npz", "a.json", "a.vtu", "a.ply", "a.png"];
    common::ok(f, &[&args[..], &outputs].concat());
    let told = common::json(f, &[&args[..], &["--exterior"]].concat());
    assert_eq!(
        (&told["points"]["selected"], &told["shape"]["cells"]["interior"]),
        (&1.into(), &2.into())
    );
    assert_eq!(told["shape"]["betti"], serde_json::json!([1, 3, 3, 0]));
    for file in ["a.npz", "a.json"] {
        let told = common::json(f, &["check", file]);
        assert_eq!((&told["points"], &told["simplices"][0]), (&1.into(), &2.into()), "{told}");
        assert_eq!(told["valid"], true);
    }
    let args = ["filtration", "one.xyz", "--periodic", fcc];
    common::ok(f, &[&args[..], &["-o", "f.npz", "f.json", "f.csv", "f.txt"]].concat());
    assert!(common::ok(f, &["compare", "f.npz", "f.json"]).contains("equal in all"));
    let pairs = std::fs::read_to_string(f.join("f.csv")).unwrap();
    let ends = |line: &&str| line.contains(",inf,");
    assert_eq!(pairs.lines().filter(ends).count(), 1 + 3 + 3 + 1, "{pairs}");
    assert!(pairs.contains("\n1,2.0,2.6666666666666665,0 0:0:1:0,0 0:0:0:1 0:0:1:0\n"), "{pairs}");
    let text = std::fs::read_to_string(f.join("f.txt")).unwrap();
    assert_eq!(text.lines().count(), 1 + 1 + 7 + 12 + 6);
    let args = ["balls", "one.xyz", "--periodic", fcc, "--alpha-radius", "1.5"];
    let told = common::json(f, &[&args[..], &["-o", "b.csv", "b.png"]].concat());
    // Twelve neighbours at √8: of each, half of a lens.
    let (r, d) = (1.5f64, 8f64.sqrt());
    let cap = std::f64::consts::PI * (r - d / 2.0).powi(2) * (2.0 * r + d / 2.0) / 3.0;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * r.powi(3) - 12.0 * cap;
    assert!((told["balls"]["volume"].as_f64().unwrap() - volume).abs() < 1e-12, "{told}");
    assert_eq!(std::fs::read_to_string(f.join("b.csv")).unwrap().lines().count(), 2);
    let args = ["ladder", "one.xyz", "--periodic", fcc, "--alphas", "1,3,inf", "-o", "ladder"];
    let told = common::json(f, &[&args[..], &["--mesh", "ply"]].concat());
    assert_eq!(told["levels"][2]["volume"], 16.0);
    assert!(f.join("ladder/level-2-alpha-3.ply").exists());
}

/// Boxes whose first vector points to the left, that of the file along some directions, and vectors that are 0.
#[test]
fn boxes_are_given_in_any_form() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    points(f);
    let shape = |file: &str, cell: &str| {
        let more = ["--periodic", cell, "--radii", "none", "--alpha", "0.3125"];
        common::json(f, &[&["shape", file][..], &more].concat())["shape"].clone()
    };
    let of_box = shape("p.xyz", "4,4,4");
    assert_eq!(shape("p.xyz", "-4,0,0,0,4,0,0,0,-4"), of_box);
    let rows = std::fs::read_to_string(f.join("p.xyz")).unwrap();
    let rows: String = rows.lines().map(|row| format!("C {row}\n")).collect();
    let save = |lattice: &str| {
        let head = format!("128\nLattice=\"{lattice}\" Properties=species:S:1:pos:R:3");
        std::fs::write(f.join("c.xyz"), format!("{head}\n{rows}")).unwrap();
    };
    save("4 0 0 0 4 0 0 0 4");
    assert_eq!(shape("c.xyz", "cell:xyz"), of_box);
    assert_eq!(shape("c.xyz", "cell:xy"), shape("c.xyz", "xy"));
    save("4 0 0 0 4 0 0 0 0");
    assert_eq!(shape("c.xyz", "cell"), shape("p.xyz", "4,4,0"));
    save("0 0 0 0 0 0 0 0 0");
    let told = common::ok(f, &["info", "c.xyz"]);
    assert!(!told.contains("--periodic"), "{told}");
    for wrong in ["abc", "10 10 10", "10;10;10", "cell:q"] {
        let (code, _, said) = common::run(f, &["shape", "p.xyz", "--periodic", wrong]);
        assert!(code == 2 && !said.contains("10 or 2.5"), "{wrong}: {said}");
    }
}

/// Filtrations of the same points are equal in whatever order these are, and those of different boxes are not compared.
#[test]
fn filtrations_of_a_box_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let random = &mut walpha_base::random::Random::new(8);
    let places: Vec<String> = (0..60)
        .map(|_| [0.0; 3].map(|_: f64| (10.0 * random.unit()).to_string()).join(","))
        .collect();
    let save = |name: &str, rows: Vec<&str>| {
        std::fs::write(f.join(name), format!("x,y,z\n{}\n", rows.join("\n"))).unwrap();
    };
    save("a.csv", places.iter().map(String::as_str).collect());
    save("b.csv", places.iter().rev().map(String::as_str).collect());
    let make = |points: &str, to: &str, more: &[&str]| {
        common::ok(f, &[&["filtration", points, "-q", "-o", to], more].concat());
    };
    make("a.csv", "a.json", &["--periodic", "10,10,10"]);
    make("b.csv", "b.json", &["--periodic", "10,10,10"]);
    let equal = common::ok(f, &["compare", "a.json", "b.json"]);
    assert!(equal.contains("0 only in A, 0 only in B\n"), "{equal}");
    make("b.csv", "other.json", &["--periodic", "10,10,10.5"]);
    make("a.csv", "space.json", &[]);
    for other in ["other.json", "space.json"] {
        let (code, _, said) = common::run(f, &["compare", "a.json", other]);
        assert!(code == 1 && said.contains("periodic boxes"), "{code}: {said}");
    }
    // One value is another.
    let text = std::fs::read_to_string(f.join("b.json")).unwrap();
    let mut changed: serde_json::Value = serde_json::from_str(&text).unwrap();
    changed["values"]["cells"][0] = serde_json::json!(77.0);
    std::fs::write(f.join("b.json"), changed.to_string()).unwrap();
    assert_eq!(common::run(f, &["compare", "a.json", "b.json"]).0, 3);
}

/// A cell that the file states, of three angles of 120, 90 and 90 degrees.
#[test]
fn the_cell_of_the_file_is_used() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut atoms = String::new();
    for n in 0..6 * 6 * 5 {
        let [i, j, k] = [n % 6, n / 6 % 6, n / 36].map(f64::from);
        atoms += &format!("C {} {} {}\n", i - 0.5 * j, 0.875 * j, k);
    }
    let head = "180\nLattice=\"6 0 0 -3 5.25 0 0 0 5\" Properties=species:S:1:pos:R:3";
    std::fs::write(f.join("a.xyz"), format!("{head}\n{atoms}")).unwrap();
    let make = |cell: &str| {
        let more = ["--periodic", cell, "--radii", "none", "--alpha", "0.6"];
        common::json(f, &[&["shape", "a.xyz", "-o", "a.json"][..], &more].concat())
    };
    let stated = make("cell");
    assert_eq!(stated["shape"]["betti"], serde_json::json!([1, 3, 3, 1]));
    assert_eq!(stated["shape"]["volume"], 6.0 * 5.25 * 5.0);
    assert!(common::ok(f, &["check", "a.json"]).contains("exact: no findings"));
    assert_eq!(make("6,0,0,-3,5.25,0,0,0,5")["shape"], stated["shape"]);
    let told = common::ok(f, &["info", "a.xyz", "--radii", "none"]);
    assert!(told.contains("--periodic cell makes points repeat"), "{told}");
    let slab = head.replace("Properties", "pbc=\"T T F\" Properties");
    std::fs::write(f.join("slab.xyz"), format!("{slab}\n{atoms}")).unwrap();
    // Four layers between five of points; the way up is as long as it is.
    let of = |file: &str, cell: &str| {
        let more = ["--periodic", cell, "--radii", "none", "--alpha", "0.6"];
        let report = common::json(f, &[&["shape", file, "-o", "slab.json"][..], &more].concat());
        assert!(common::ok(f, &["check", "slab.json"]).contains("exact: no findings"), "{cell}");
        report["shape"].clone()
    };
    let slab = of("slab.xyz", "cell");
    assert_eq!(slab["betti"], serde_json::json!([1, 2, 1, 0]));
    assert_eq!(slab["volume"], 6.0 * 5.25 * 4.0);
    let written = std::fs::read_to_string(f.join("slab.json")).unwrap();
    let written: serde_json::Value = serde_json::from_str(&written).unwrap();
    assert_eq!(written["periodic"][2], serde_json::json!([0.0, 0.0, 0.0]));
    for cell in ["xy", "6,0,0,-3,5.25,0,0,0,1:xy"] {
        assert_eq!(of("a.xyz", cell), slab, "{cell}");
    }
    // A bar of 6 × 5 by 5 columns and rows is a rod along the third vector.
    let rod = of("slab.xyz", "z");
    assert_eq!(rod["betti"], serde_json::json!([1, 1, 0, 0]));
    assert_eq!(rod["volume"], 5.0 * 0.875 * 5.0 * 5.0);
    let pores = ["pores", "slab.xyz", "--periodic", "cell", "--radii", "none"];
    let (code, _, said) = common::run(f, &pores);
    assert!(code == 1 && said.contains("repeat along all three vectors"), "{code}: {said}");
    let radius = ["--radii", "none", "--alpha-radius", "0.25", "--json"];
    let balls = ["balls", "slab.xyz", "--periodic", "cell"];
    let balls: serde_json::Value =
        serde_json::from_str(&common::ok(f, &[&balls[..], &radius].concat())).unwrap();
    let volume = balls["balls"]["volume"].as_f64().or(balls["volume"].as_f64()).unwrap();
    assert!((volume / (180.0 * std::f64::consts::PI / 48.0) - 1.0).abs() < 1e-9, "{volume}");
    let pairs =
        ["filtration", "slab.xyz", "--periodic", "xy", "--radii", "none", "-o", "pairs.csv"];
    common::ok(f, &pairs);
    let pairs = std::fs::read_to_string(f.join("pairs.csv")).unwrap();
    let lasting = |dimension: &str| {
        let of = pairs.lines().filter(|line| line.split(',').next() == Some(dimension));
        of.filter(|line| line.split(',').nth(2) == Some("inf")).count()
    };
    assert_eq!(["0", "1", "2", "3"].map(lasting), [1, 2, 1, 0], "{}", &pairs[..200]);
}
