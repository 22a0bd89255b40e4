//! Shapes of nothing: volumes that no difference tells apart, and files that would hold nothing of a shape.

use std::fs;
use std::path::Path;

use serde_json::Value;
use walpha::export::{EmptyShape, FORMATS, Needs, Save, SaveError};
use walpha::shape::{ShapeOptions, alpha_shape};
use walpha::{Alpha, WeightedPoints};

use crate::common::{fails, json, names, ok, run};

/// The options that read `v.raw`, of 8³ samples.
const RAW: &str = "v.raw --dims 8,8,8 --dtype f32";

/// Samples of 8³, all 0 but those given.
fn volume(folder: &Path, others: &[(usize, f32)]) {
    let mut samples = vec![0f32; 512];
    others.iter().for_each(|&(at, value)| samples[at] = value);
    let bytes: Vec<u8> = samples.into_iter().flat_map(f32::to_le_bytes).collect();
    fs::write(folder.join("v.raw"), bytes).unwrap();
}

/// The corners of a cube of side 2, and its centre.
fn cube(folder: &Path) {
    let corners: String = (0..8)
        .map(|i| format!("{},{},{}\n", 2 * (i & 1), 2 * (i >> 1 & 1), 2 * (i >> 2)))
        .collect();
    fs::write(folder.join("cube.csv"), format!("x,y,z\n{corners}1,1,1\n")).unwrap();
}

/// Writes points of a plane.
fn square(folder: &Path) {
    fs::write(folder.join("square.csv"), "x,y\n0,0\n1,0\n0,1\n1,1\n").unwrap();
}

fn split(args: &str) -> Vec<&str> {
    args.split(' ').collect()
}

/// A constant volume, and one whose contrast is lost in truncation: as a whole, and in blocks.
#[test]
fn no_difference_selects_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let none = "none of the 512 that take part differs from a neighbour";
    // One sample of 1, mapped so that it is one gray level.
    for others in [&[][..], &[(219, 1.0)]] {
        volume(f, others);
        for how in ["", " --count 20", " --ratio 0.5"] {
            for output in ["x.stl", "x.json", "x.pvtp"] {
                let args = format!("shape {RAW} --gray 0..255{how} -o {output}");
                fails(f, 1, &args, &[none, "--rms", "--gray", "contrast"]);
            }
        }
    }
    // The advice names the option that was given.
    fails(f, 1, &format!("points {RAW} --gray 0..255 --epsilon 99 -o p.csv"), &[none, "--epsilon"]);
    // Nothing is lost if a range or a threshold states what counts.
    ok(f, &split(&format!("points {RAW} --gray 0..255 --rms 0 -o p.csv")));
    ok(f, &split(&format!("points {RAW} --gray 0..255 --threshold 0 -o p.csv")));
    volume(f, &[]);
    let args = format!("points {RAW} --gray 0..255 --coefficients 1 -o p.csv");
    fails(f, 1, &args, &[none, "--coefficients"]);
}

/// A sample and its six neighbours differ; a request for more points than these does not invent any.
#[test]
fn no_more_places_than_differ() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    volume(f, &[(219, 100.0)]);
    let raw = format!("{RAW} --rms 0");
    let seven = "7 samples take part and differ from a neighbour";
    for command in ["points", "shape"] {
        let output = if command == "points" { "p.csv" } else { "p.vtu" };
        let args = format!("{command} {raw} --count 8 -o {output}");
        fails(f, 1, &args, &["8 points cannot be selected", seven, "from 1 to 7"]);
    }
    fails(f, 1, &format!("shape {raw} --count 8 -o p.pvtu"), &[seven, "from 1 to 7"]);
    fails(f, 1, &format!("shape {raw} --ratio 0.5 -o p.pvtu"), &[seven, "ratio of at most 0.0136"]);
    fails(f, 1, &format!("points {raw} --ratio 0.5 -o p.csv"), &[seven, "ratio of at most 0.0136"]);
    for allowed in ["--count 7", "--ratio 0.0136", "--count 512", "--ratio 1"] {
        ok(f, &split(&format!("points {raw} {allowed} -o p.csv")));
    }
    // By default the differing samples are selected, with a message.
    for output in ["p.vtu", "p.pvtu"] {
        let report = json(f, &split(&format!("shape {raw} -o {output}")));
        assert_eq!(report["points"]["selected"], 7, "{output}");
        // The first says how samples are selected.
        let warned = report["warnings"][1].as_str().unwrap();
        names(warned, &["7 of 512 samples", "fewer than the 31 that are selected by default"]);
    }
    fails(f, 1, &format!("ladder {raw} --counts 5,8 -o out"), &[seven, "from 1 to 7"]);
}

/// A bound in values of the file is spoken of in these.
#[test]
fn a_bound_is_named_as_it_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    volume(f, &[(219, 1000.0), (220, 500.0)]);
    let raw = format!("{RAW} --rms 0");
    for output in ["p.vtu", "p.pvtu"] {
        let args = format!("shape {raw} --value-min 99999 -o {output}");
        let words = ["reaches the value 99999", "values end at 1000", "less for --value-min"];
        fails(f, 1, &args, &words);
        let args = format!("shape {raw} --gray-min 300 -o {output}");
        let words = ["reaches the gray level 300", "gray levels end at 255", "less for --gray-min"];
        fails(f, 1, &args, &words);
        let none = "no voxel that takes part has a difference of 999 gray levels";
        let args = format!("shape {raw} --value-min 400 --threshold 999 -o {output}");
        fails(f, 1, &args, &[none, "lower --threshold or --value-min"]);
        let args = format!("shape {raw} --gray-min 40 --threshold 999 -o {output}");
        fails(f, 1, &args, &[none, "lower --threshold or --gray-min"]);
        let (_, _, said) = run(f, &split(&format!("shape {raw} --threshold 999 -o {output}")));
        assert!(said.contains(none) && !said.contains("-min"), "{said}");
    }
    fails(f, 1, &format!("points {raw} --value-min NaN -o p.csv"), &["a least value of NaN"]);
    fails(f, 1, &format!("ladder {raw} --counts 3 --value-min 99999 -o out"), &["--value-min"]);
}

/// The formats of a boundary or an outline, and pictures.
fn of_facets() -> Vec<&'static str> {
    let formats = FORMATS.iter().filter(|format| format.boundary).map(|format| format.extension);
    formats.chain(["png"]).collect()
}

#[test]
fn files_that_would_hold_nothing_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cube(f);
    square(f);
    let boundaries = of_facets();
    assert!(boundaries.len() >= 7);
    let cases = boundaries.iter().map(|extension| ("cube.csv", *extension));
    let outlines = ["geojson", "wkt", "svg"].map(|extension| ("square.csv", extension));
    for (points, extension) in cases.chain(outlines) {
        for alpha in ["-3", "0.001"] {
            let args = format!("shape {points} --alpha {alpha} -o e.{extension}");
            let words =
                ["e.", "the shape has no ", "facet at α = ", "--alpha-radius", "--allow-empty"];
            fails(f, 1, &args, &words);
        }
        let args = format!("shape {points} --alpha 0.001 --allow-empty -o e.{extension}");
        ok(f, &split(&args));
        fs::remove_file(f.join(format!("e.{extension}"))).unwrap();
    }
    // A complex of vertices is something, one of nothing is not.
    for extension in ["json", "npz", "vtu"] {
        ok(f, &split(&format!("shape cube.csv --alpha 0.001 -o e.{extension}")));
        fs::remove_file(f.join(format!("e.{extension}"))).unwrap();
        let args = format!("shape cube.csv --alpha -3 -o e.{extension}");
        fails(f, 1, &args, &["the shape has no simplex at α = -3", "--alpha-radius"]);
        ok(f, &split(&format!("shape cube.csv --alpha -3 --exterior -o e.{extension}")));
        fs::remove_file(f.join(format!("e.{extension}"))).unwrap();
    }
    // An error occurs also without files; and if there are several outputs, none is written.
    fails(f, 1, "shape cube.csv --alpha -3", &["the shape has no simplex"]);
    ok(f, &["shape", "cube.csv", "--alpha", "0.001"]);
    fails(f, 1, "shape cube.csv --alpha 0.001 -o e.vtu e.stl e.json", &["e.stl: the shape has"]);
    // The points of a model exist for any α.
    ok(f, &["shape", "cube.csv", "--alpha", "-3", "-o", "e.wvm"]);
}

/// The suggested value works.
#[test]
fn the_suggested_radius_is_enough() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cube(f);
    // Two turns of a helix: neighbours in space lie along the curve.
    let turn = |k: usize| 0.05 * k as f64;
    let helix =
        (0..250).map(|k| format!("{},{},{}\n", 9.0 * turn(k).cos(), 9.0 * turn(k).sin(), turn(k)));
    fs::write(f.join("helix.csv"), format!("x,y,z\n{}", helix.collect::<String>())).unwrap();
    for points in ["cube.csv", "helix.csv", "sample:phantom@16"] {
        for balls in ["power", "radius"] {
            let base = format!("shape {points} --balls {balls} -o e.stl");
            let alpha = if balls == "power" { "-3" } else { "0.001" };
            let (code, _, said) = run(f, &split(&format!("{base} --alpha {alpha}")));
            assert_eq!(code, 1, "{said}");
            let option = if balls == "power" { "--alpha-radius " } else { "--alpha " };
            let suggested = said.split("as in ").nth(1).and_then(|rest| rest.strip_prefix(option));
            let suggested = suggested.unwrap_or_else(|| panic!("no {option} in {said}"));
            let radius = suggested.split(',').next().unwrap();
            ok(f, &split(&format!("{base} {option}{radius}")));
            let facets = fs::read(f.join("e.stl")).unwrap();
            assert!(u32::from_le_bytes(facets[80..84].try_into().unwrap()) > 0);
        }
    }
}

/// Points in a plane have no regular facets, and those on a line no facets, at any α: the error says so.
#[test]
fn flat_points_are_told_of_formats_that_hold_them() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    square(f);
    fs::write(f.join("line.csv"), "x,y,z\n0,0,0\n1,1,1\n2,2,2\n").unwrap();
    fs::write(f.join("place.csv"), "x,y,z\n1,2,3\n1,2,3\n").unwrap();
    let plane = ["at any α, as its points lie in one plane", "as PLY does"];
    fails(f, 1, "shape square.csv --alpha 9 -o e.stl", &plane);
    fails(f, 1, "shape square.csv --alpha 9 --solid -o e.ply", &plane);
    let line = ["at any α, as its points lie on one line", "as VTU does"];
    fails(f, 1, "shape line.csv --alpha 9 -o e.off", &line);
    fails(
        f,
        1,
        "shape place.csv --alpha 9 -o e.obj",
        &["as its points are at one place", "as VTU does"],
    );
    // The existing parts are written.
    ok(f, &split("shape square.csv --alpha 9 -o e.ply e.off e.obj e.glb e.vtp e.png"));
    ok(f, &split("shape line.csv --alpha 9 -o e.obj e.glb e.vtp e.png e.vtu"));
    ok(f, &split("shape place.csv --alpha 9 -o e.vtu e.json e.npz"));
}

/// Levels without a simplex are rows of zeros, and blocks of nothing are blocks.
#[test]
fn ladders_and_blocks_have_empty_levels() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cube(f);
    ok(f, &split("ladder cube.csv --alphas -3,0.001,9 --mesh stl,vtu -o out"));
    let report: Value =
        serde_json::from_slice(&fs::read(f.join("out/ladder.json")).unwrap()).unwrap();
    let counts: Vec<_> = (0..3).map(|k| &report["levels"][k]["vertices"]).collect();
    assert!(counts.iter().all(|counts| counts.is_object()), "{report}");
    assert_eq!(report["levels"][0]["measures"], report["levels"][1]["measures"]);
    assert!(f.join("out/level-1-alpha--3.stl").exists());
    let (code, _, said) = run(f, &split("shape sample:phantom@8 --alpha 0.001 -o e.pvtp e.stl"));
    assert_eq!(code, 0, "{said}");
    names(&said, &["e.stl: it holds nothing of the shape"]);
    let page = "view cube.csv --alphas -3 -o e.html";
    fails(f, 1, page, &["no shape has a simplex up to -3", "--alphas"]);
}

/// A library that saves is told, too; what writes bytes writes them.
#[test]
fn shapes_do_not_save_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let points = WeightedPoints::unweighted(vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ]);
    let at = |alpha: f64| {
        alpha_shape(points.clone(), &ShapeOptions::new(Alpha::from_squared(alpha).unwrap()))
            .unwrap()
    };
    let path = folder.path().join("e.stl");
    match at(0.001).save(&path) {
        Err(SaveError::Empty(EmptyShape {
            needs: Needs::RegularFacet,
            suggested: Some(radius),
            ..
        })) => {
            at(radius * radius).save(&path).unwrap();
        }
        other => panic!("{other:?}"),
    }
    at(0.001).save(folder.path().join("e.json")).unwrap();
}
