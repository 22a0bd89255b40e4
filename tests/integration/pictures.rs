//! Pictures of shapes: what is in view, how thick and in which colours it is drawn.

use std::fs;
use std::path::Path;

use image::RgbImage;

use crate::common::{ok, run};

/// A cube of 4×4×4 points with values, a row of points that leads away from it, and more rows.
fn save(folder: &Path, name: &str, more: &str) {
    let mut text = String::from("x,y,z,value\n");
    for n in 0..64 {
        text += &format!("{},{},{},{}\n", n % 4, n / 4 % 4, n / 16, n % 4);
    }
    (4..9).for_each(|x| text += &format!("{x},0,0,3\n"));
    fs::write(folder.join(name), text + more).unwrap();
}

fn picture(folder: &Path, args: &str) -> RgbImage {
    let args = format!("shape {args} --size 120x90 -q -o a.png");
    ok(folder, &args.split(' ').collect::<Vec<_>>());
    image::open(folder.join("a.png")).unwrap().to_rgb8()
}

/// Neither the thickness of edges nor the range of colours depends on points that are not drawn.
#[test]
fn points_outside_the_shape_do_not_matter() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "near.csv", "");
    save(f, "stray.csv", "5000,5000,5000,900\n");
    for colour in ["plain", "value", "height", "class"] {
        let options = format!("--alpha 1 --colour {colour}");
        let near = picture(f, &format!("near.csv {options}"));
        let stray = picture(f, &format!("stray.csv {options} --keep largest"));
        assert!(near == stray, "{colour}");
    }
}

/// A shape is the same in any unit of length, also where single precision ends.
#[test]
fn the_unit_of_length_does_not_matter() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    save(f, "one.csv", "");
    let one = picture(f, "one.csv --alpha 1 --colour height");
    let scaled = fs::read_to_string(f.join("one.csv")).unwrap();
    for power in [-140, 190] {
        let factor = 2f64.powi(power);
        let row = |line: &str| {
            let numbers =
                line.split(',').map(|x| format!("{:e}", x.parse::<f64>().unwrap() * factor));
            numbers.collect::<Vec<_>>().join(",") + "\n"
        };
        let rows: String = scaled.lines().skip(1).map(row).collect();
        fs::write(f.join("scaled.csv"), format!("x,y,z,value\n{rows}")).unwrap();
        let alpha = factor * factor;
        let found = picture(f, &format!("scaled.csv --alpha {alpha:e} --colour height"));
        assert!(found == one, "2^{power}");
    }
    // What is stored in single precision is refused there.
    for file in ["a.glb", "a.stl", "a.3mf"] {
        let (code, _, said) = run(f, &["shape", "scaled.csv", "--alpha", "inf", "-o", file]);
        assert!(code == 1 && said.contains("single precision, which ends at"), "{file}: {said}");
        assert!(!f.join(file).exists());
    }
}

/// A single point is a ball, and a picture that shows nothing is told.
#[test]
fn white_pictures_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("one.csv"), "x,y,z\n5,6,7\n").unwrap();
    let one = picture(f, "one.csv --alpha 4 --allow-empty");
    assert_ne!(one.get_pixel(60, 45).0, [255; 3]);
    fs::write(f.join("flat.csv"), "x,y\n0,0\n1,0\n0,1\n1,1\n").unwrap();
    for (view, is_white) in [("front", true), ("top", false)] {
        let args = ["shape", "flat.csv", "--alpha", "4", "--view", view, "-o", "a.png"];
        let (code, _, said) = run(f, &args);
        assert_eq!((code, said.contains("the picture is white")), (0, is_white), "{view}: {said}");
    }
}
