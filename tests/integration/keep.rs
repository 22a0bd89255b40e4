//! Some components of a shape: `--keep` and `--min-volume`.

use std::fs;
use std::path::Path;

use crate::common::{fails, json, names, ok};

/// Cubes of side 1, 2 and 3, which stand apart, and a point.
fn cubes(folder: &Path) {
    let mut rows = String::from("x,y,z\n");
    for (from, side) in [(0, 1), (10, 3), (20, 2)] {
        for corner in 0..(side + 1) * (side + 1) * (side + 1) {
            let n = side + 1;
            let at = [from + corner % n, corner / n % n, corner / (n * n)];
            rows += &format!("{},{},{}\n", at[0], at[1], at[2]);
        }
    }
    fs::write(folder.join("cubes.csv"), rows + "40,0,0\n").unwrap();
}

#[test]
fn the_largest_components_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cubes(f);
    let shape = |options: &str| {
        let mut args = vec!["shape", "cubes.csv", "--alpha", "0.75", "-o", "a.vtu", "a.ply"];
        args.extend(options.split_whitespace());
        json(f, &args)
    };
    let all = shape("");
    assert_eq!((&all["shape"]["volume"], &all["kept"]), (&36.0.into(), &serde_json::Value::Null));
    for (options, volume, components) in [
        ("--keep largest", 27.0, 1),
        ("--keep 2", 35.0, 2),
        ("--keep 9", 36.0, 4),
        ("--min-volume 8", 35.0, 2),
        ("--min-volume 9 --keep 3", 27.0, 1),
    ] {
        let facts = shape(options);
        assert_eq!(facts["shape"]["volume"], volume, "{options}");
        assert_eq!(facts["shape"]["betti"][0], components, "{options}");
        assert_eq!(
            (&facts["kept"]["components"], &facts["kept"]["of"], &facts["kept"]["of_volume"]),
            (&components.into(), &4.into(), &36.0.into()),
            "{options}"
        );
        let ply = fs::read(f.join("a.ply")).unwrap();
        let header = String::from_utf8_lossy(&ply[..ply.len().min(600)]).into_owned();
        let vertices = facts["shape"]["vertices"].clone();
        let boundary =
            vertices["regular"].as_u64().unwrap() + vertices["singular"].as_u64().unwrap();
        assert!(header.contains(&format!("element vertex {boundary}\n")), "{options}: {header}");
    }
    let text = ok(f, &["shape", "cubes.csv", "--alpha", "0.75", "--keep", "largest"]);
    names(&text, &["kept      1 of 4 components, which had a volume of 36 unit³ together"]);
}

#[test]
fn what_cannot_be_kept_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cubes(f);
    let shape = "shape cubes.csv --alpha 0.75";
    fails(f, 2, &format!("{shape} --keep 0"), &["\"0\" is not a number of components", "largest"]);
    fails(f, 2, &format!("{shape} --keep all"), &["\"all\" is not a number of components"]);
    fails(
        f,
        1,
        &format!("{shape} --min-volume 28"),
        &["no component of the shape has a volume of 28 unit³: the largest has 27", "--min-volume"],
    );
    for format in ["json", "npz"] {
        let words = ["states the whole shape", "--keep", "VTU"];
        fails(f, 2, &format!("{shape} --keep 1 -o a.{format}"), &words);
        assert!(!f.join(format!("a.{format}")).exists());
    }
    fails(f, 2, &format!("{shape} --keep 1 --exterior -o a.vtu"), &["--exterior has no effect"]);
    fails(f, 2, &format!("{shape} --keep 1 --periodic 99,9,9"), &["--keep", "--periodic"]);
    let ladder = "ladder cubes.csv --alpha-ref 0.75 --alphas 1 -o out";
    fails(f, 2, &format!("{ladder} --keep 1 --periodic 99,9,9"), &["--keep", "--periodic"]);
    fails(
        f,
        1,
        &format!("{ladder} --min-volume 28"),
        &["no component of the shape has a volume of 28"],
    );
    fails(f, 2, &format!("{shape} --keep 1 -o a.pvtu"), &["without --keep", "write one file"]);
}

/// Voxels that touch at a corner are one component.
#[test]
fn components_of_labels_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut labels = vec![0u8; 12 * 12 * 12];
    let mut fill = |x: usize, y: usize, z: usize| labels[x + 12 * (y + 12 * z)] = 1;
    for at in 0..8 {
        fill(1 + (at & 1), 1 + (at >> 1 & 1), 1 + (at >> 2));
    }
    fill(3, 3, 3);
    fill(8, 8, 8);
    fs::write(f.join("l.raw"), labels).unwrap();
    let raw = ["--dims", "12,12,12", "--dtype", "u8"];
    let label = ["shape", "l.raw", "--label", "1", "--keep", "largest"];
    let facts = json(f, &[&label[..], &raw, &["--solid", "-o", "l.stl"]].concat());
    assert_eq!((&facts["shape"]["volume"], &facts["kept"]["of"]), (&9.0.into(), &2.into()));
    assert_eq!(facts["solid"]["vertices"], 1);
    let each = ["shape", "l.raw", "--each-label", "--keep", "largest", "--solid", "-o", "each"];
    let facts = json(f, &[&each[..], &raw].concat());
    let one = &facts["labels"][0];
    assert_eq!((&one["kept"]["components"], &one["solid"]["vertices"]), (&1.into(), &1.into()));
}

/// The page has the points of the components alone.
#[test]
#[cfg(feature = "render")]
fn a_page_shows_the_largest_component() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cubes(f);
    let view = |options: &[&str]| {
        let view = ["view", "cubes.csv", "--alpha-ref", "0.75", "-o", "a.html"];
        let facts = json(f, &[&view[..], options].concat());
        (facts["details"][0]["points"].as_u64().unwrap(), facts["details"][0]["kept"].clone())
    };
    assert_eq!(view(&[]), (8 + 64 + 27 + 1, serde_json::Value::Null));
    let (points, kept) = view(&["--keep", "largest"]);
    assert_eq!((points, &kept["components"], &kept["of"]), (64, &1.into(), &4.into()));
    names(&ok(f, &["view", "cubes.csv", "--keep", "2", "-o", "a.html"]), &["2 of 4 components"]);
    assert_eq!(view(&["--min-volume", "8"]).0, 64 + 27);
}

/// A ladder is of the points of the components alone, and a level of detail is what is kept of its shape.
#[test]
fn ladders_are_of_the_largest_component() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    cubes(f);
    let over_alpha =
        ["ladder", "cubes.csv", "--alpha-ref", "0.75", "--alphas", "0.75,inf", "-o", "out"];
    let facts = json(f, &[&over_alpha[..], &["--keep", "largest"]].concat());
    assert_eq!((&facts["kept"]["components"], &facts["kept"]["of"]), (&1.into(), &4.into()));
    assert_eq!(facts["points"], 64);
    for level in facts["levels"].as_array().unwrap() {
        assert_eq!((&level["volume"], &level["betti"][0]), (&27.0.into(), &1.into()));
    }
    let all = json(f, &over_alpha);
    assert_eq!((&all["points"], &all["kept"]), (&100.into(), &serde_json::Value::Null));
    let text = ok(f, &[&over_alpha[..], &["--min-volume", "8"]].concat());
    names(&text, &["kept      2 of 4 components, which had a volume of 36 unit³ together"]);

    let mut balls = Vec::new();
    for at in 0..24 * 24 * 24_i32 {
        let place = [at % 24, at / 24 % 24, at / 576];
        let away = |centre: i32| place.iter().map(|x| (x - centre) * (x - centre)).sum::<i32>();
        balls.push(if away(7) <= 36 || away(19) <= 9 { 200u8 } else { 0 });
    }
    fs::write(f.join("balls.raw"), balls).unwrap();
    let over_detail = "ladder balls.raw --dims 24,24,24 --dtype u8 --gray-min 100 --count 800 --counts 120 -o detail --mesh ply";
    let ladder = |options: &str| {
        let args: Vec<&str> = over_detail.split(' ').chain(options.split_whitespace()).collect();
        json(f, &args)
    };
    let (all, kept) = (ladder(""), ladder("--keep largest"));
    let [of, one] = [&all, &kept].map(|facts| &facts["levels"][0]);
    assert_eq!(one["betti"][0], 1);
    assert_eq!(
        (&one["kept_components"]["components"], &one["kept_components"]["of"]),
        (&1.into(), &of["betti"][0])
    );
    assert!(
        of["betti"][0].as_u64().unwrap() > 1 && one["kept_components"]["of_volume"] == of["volume"]
    );
    let volume = |facts: &serde_json::Value| facts["volume"].as_f64().unwrap();
    assert!(volume(one) > 0.0 && volume(one) < volume(of));
    assert!(volume(&kept["full"]) < volume(&all["full"]));
    assert_eq!(kept["full"]["kept"]["components"], 1);
}
