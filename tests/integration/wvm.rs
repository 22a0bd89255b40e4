//! `.wvm` on the command line.

use std::fs;

use walpha::volume::{self, VolumeWriter};
use walpha::{Coordinates, Frame, LengthUnit, Space};

use crate::common::{json, ok, run};

/// A scan of 12 bits in the world: what `interpolate` makes of its points directly and of the file is the
/// same, and so are the points.
#[test]
fn the_command_makes_the_same_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let phantom = volume::phantom(20).unwrap();
    let samples = phantom.samples().mapv(|gray| (16.0 * gray).round() - 1024.0);
    let coordinates = Coordinates { space: Space::Ras, unit: LengthUnit::Millimetre };
    let frame =
        Frame { origin: [3.0, -7.5, 0.1], spacing: [0.5, 0.5, 2.0], coordinates, ..Frame::VOXEL };
    let scan = walpha::Volume::new(samples, frame).unwrap();
    let mut bytes = Vec::new();
    VolumeWriter::of("v.nrrd").unwrap().write(&scan, &mut bytes).unwrap();
    fs::write(folder.path().join("v.nrrd"), bytes).unwrap();
    let run_it = |args: &str| ok(folder.path(), &args.split(' ').collect::<Vec<_>>());
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();

    let select = "--select adaptive --count 700 --alpha 3";
    run_it(&format!("points v.nrrd {select} -o m.wvm"));
    run_it(&format!("points v.nrrd {select} -o direct.csv"));
    run_it("points m.wvm -o through.csv");
    assert_eq!(read("direct.csv"), read("through.csv"));
    for fill in ["", " --fill"] {
        run_it(&format!("interpolate v.nrrd {select} -o direct.nrrd{fill}"));
        run_it(&format!("interpolate m.wvm -o through.nrrd{fill}"));
        assert_eq!(read("direct.nrrd"), read("through.nrrd"), "{fill}");
    }
    run_it(&format!("interpolate v.nrrd {select} -o direct.nrrd --gray-out"));
    run_it("interpolate m.wvm -o through.nrrd --gray-out");
    assert_eq!(read("direct.nrrd"), read("through.nrrd"));
    run_it(&format!("shape v.nrrd {select} -o direct.ply"));
    run_it("shape m.wvm -o through.ply again.wvm");
    assert_eq!(read("direct.ply"), read("through.ply"));
    assert_eq!(read("m.wvm"), read("again.wvm"));
    // The α that is found with the shape is kept, too.
    run_it(&format!(
        "shape v.nrrd {} -o auto.ply auto.wvm",
        select.replace("alpha 3", "alpha auto")
    ));
    assert!(json(folder.path(), &["info", "auto.wvm"])["alpha"].as_f64().unwrap() > 0.0);
    run_it("shape auto.wvm -o through.ply");
    assert_eq!(read("auto.ply"), read("through.ply"));

    let told = json(folder.path(), &["info", "m.wvm"]);
    assert_eq!(told["grid"], serde_json::json!([20, 20, 20]));
    assert_eq!(told["coordinates"], serde_json::json!({"space": "LPS", "unit": "mm"}));
    assert_eq!(told["alpha"], 3.0);
    // The recipe that made it is kept through the second file, too.
    let recipe: walpha::Recipe = serde_json::from_value(told["recipe"].clone()).unwrap();
    assert_eq!(recipe.alpha, walpha::Alpha::from_squared(3.0).unwrap().into());
    assert!(
        matches!(recipe.choice, walpha::pipeline::Choice::Adaptive(goal) if goal.count == Some(700))
    );
    let told = json(folder.path(), &["shape", "m.wvm"]);
    assert_eq!(told["alpha"]["origin"], "stored");
}

#[test]
fn options_without_effect_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    ok(
        folder.path(),
        &["points", "sample:phantom@8", "--count", "40", "--layers", "2", "-o", "m.wvm"],
    );
    let refuses = |args: &[&str], part: &str| {
        let (code, _, error) = run(folder.path(), args);
        assert!(code != 0 && error.contains(part), "{args:?}: {error}");
    };
    refuses(&["points", "m.wvm", "--layers", "2", "-o", "n.wvm"], "--layers has no effect");
    refuses(&["points", "m.wvm", "--value-error", "2", "-o", "n.csv"], "no .wvm is written");
    refuses(&["points", "m.wvm", "--level", "2"], "has 2 levels");
    refuses(&["points", "m.wvm", "--count", "9"], "--count has no effect");
    ok(folder.path(), &["haar", "sample:phantom@8", "-o", "v.npy"]);
    refuses(
        &["shape", "v.npy", "-o", "s.vtu", "s.wvm", "s.pvtu"],
        "s.wvm takes all points at once",
    );
    assert!(!folder.path().join("s.wvm").exists());
    fs::write(folder.path().join("p.csv"), "x,y,z\n0,0,0\n").unwrap();
    refuses(&["points", "p.csv", "--gray-out"], "--gray-out has no effect");
    let told = json(folder.path(), &["points", "m.wvm", "--level", "1"]);
    assert_eq!(told["points"]["selected"], 10);
}

/// Points of a volume lie in clusters, and near values are similar, which the model uses.
#[test]
fn points_of_a_volume_take_less_than_chance_would() {
    let folder = tempfile::tempdir().unwrap();
    let select = ["--select", "adaptive", "--count", "3000", "--value-error", "3"];
    ok(folder.path(), &[&["points", "sample:phantom@48", "-o", "m.wvm"][..], &select].concat());
    let recipe = json(folder.path(), &["info", "m.wvm"])["recipe"].to_string().len();
    let bytes = fs::metadata(folder.path().join("m.wvm")).unwrap().len() as f64 - recipe as f64;
    let share: f64 = 3000.0 / 48f64.powi(3);
    let chance = -(share * share.log2() + (1.0 - share) * (1.0 - share).log2()) / share;
    // Any of 43 steps of 6 in 0..255 would take 5.4 bits.
    let bits = 8.0 * bytes / 3000.0;
    assert!(bits < 0.8 * (chance + 5.4), "{bits} bits a point, {chance} for places by chance");
}

/// What a file states of its shape beside α is to be given again, which is said.
/// An error that no step can have leaves values as they are.
#[test]
fn any_error_of_values_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows = "x,y,z,value\n0,0,0,1\n1,0,0,2\n0,1,0,3\n0,0,1,4\n";
    fs::write(f.join("p.csv"), rows).unwrap();
    for error in ["inf", "1e308", "1e307", "0"] {
        ok(f, &["points", "p.csv", "--value-error", error, "-o", "p.wvm"]);
        assert_eq!(json(f, &["info", "p.wvm"])["count"], 4, "{error}");
    }
}

#[test]
fn a_box_and_balls_of_radii_are_not_lost_in_silence() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let points = "x,y,z,weight\n.1,.1,.1,.1\n.6,.2,.3,.1\n.4,.7,.2,.2\n.3,.4,.8,.1\n.9,.9,.6,.1\n";
    fs::write(f.join("p.csv"), points).unwrap();
    let warned = |args: &str| {
        let (code, stdout, stderr) = run(f, &args.split(' ').collect::<Vec<_>>());
        assert_eq!(code, 0, "{args}\n{stderr}");
        let same: Vec<&str> = stdout.lines().filter(|line| line.starts_with("shape")).collect();
        (same.join("\n"), stderr)
    };
    for (given, word) in [
        ("--periodic 3,2,2.5", "--periodic 3,2,2.5 uses it"),
        ("--balls radius", "--balls radius uses it"),
    ] {
        let (made, stderr) = warned(&format!("shape p.csv {given} --alpha 0.5 -o m.wvm"));
        assert!(!stderr.contains("ignored"), "{stderr}");
        let (_, stderr) = warned("shape m.wvm");
        assert!(stderr.contains(word), "{stderr}");
        let (again, stderr) = warned(&format!("shape m.wvm {given}"));
        assert_eq!(made, again, "{given}");
        assert!(!stderr.contains("ignored"), "{stderr}");
    }
}
