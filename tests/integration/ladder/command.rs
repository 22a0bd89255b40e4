//! `walpha ladder`.

use crate::common;

#[test]
fn the_command_writes_tables_plots_and_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let made = common::json(
        folder.path(),
        &[
            "ladder",
            "sample:phantom@24",
            "--weights",
            "min-max",
            "--alphas",
            "10,2,inf,2",
            "--mesh",
            "ply,off",
            "-o",
            "out",
        ],
    );
    let alphas: Vec<_> = made["levels"].as_array().unwrap().iter().map(|l| &l["alpha"]).collect();
    assert_eq!(
        alphas,
        [&serde_json::json!(2.0), &serde_json::json!(10.0), &serde_json::json!("inf")]
    );
    let names: std::collections::BTreeSet<String> = std::fs::read_dir(folder.path().join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let expected = [
        "ladder.csv",
        "ladder.json",
        "ladder.png",
        "ladder.svg",
        "voids.csv",
        "level-1-alpha-2.off",
        "level-1-alpha-2.ply",
        "level-2-alpha-10.off",
        "level-2-alpha-10.ply",
        "level-3-alpha-inf.off",
        "level-3-alpha-inf.ply",
    ];
    assert_eq!(names, expected.map(String::from).into());
    let read = |name: &str| std::fs::read(folder.path().join("out").join(name)).unwrap();
    // Weights frozen at 10 by default are those `shape` has at α = 10.
    common::ok(
        folder.path(),
        &[
            "shape",
            "sample:phantom@24",
            "--weights",
            "min-max",
            "--alpha",
            "10",
            "-o",
            "one.off",
            "-q",
        ],
    );
    assert!(read("level-2-alpha-10.off") == std::fs::read(folder.path().join("one.off")).unwrap());
    let json: serde_json::Value = serde_json::from_slice(&read("ladder.json")).unwrap();
    assert_eq!(json["levels"], made["levels"]);
    let csv = String::from_utf8(read("ladder.csv")).unwrap();
    assert_eq!(csv.lines().count(), 4);
    let voids: u64 =
        made["levels"].as_array().unwrap().iter().map(|l| l["betti"][2].as_u64().unwrap()).sum();
    assert_eq!(String::from_utf8(read("voids.csv")).unwrap().lines().count() as u64, 1 + voids);
}

#[test]
fn the_command_makes_levels_of_detail() {
    let folder = tempfile::tempdir().unwrap();
    let args = [
        "ladder",
        "sample:phantom@24",
        "--counts",
        "200,600",
        "--focus",
        "0:23,0:23,8:12",
        "-o",
        "out",
    ];
    let made = common::json(folder.path(), &args);
    let points: Vec<_> =
        made["levels"].as_array().unwrap().iter().map(|l| l["points"].as_u64().unwrap()).collect();
    let region = made["points_in_region"].as_u64().unwrap();
    assert!(points[0] > region && points[0] < points[1] && points[0] < region + 200, "{points:?}");
    for (level, name) in ["detail-200.ply", "detail-600.ply"].iter().enumerate() {
        let size = std::fs::metadata(folder.path().join("out").join(name)).unwrap().len();
        assert_eq!(made["levels"][level]["bytes"], size);
    }
    let made = common::json(
        folder.path(),
        &["ladder", "sample:phantom@24", "--epsilons", "100,1000", "-o", "eps"],
    );
    let epsilon = |k: usize| made["levels"][k]["epsilon"].as_f64().unwrap();
    assert!(epsilon(0) <= 100.0 && epsilon(1) > 100.0 && epsilon(1) <= 1000.0);
}

/// Levels of bone keep together, and about its volume: α follows from the spacing of each, and does not grow with the number of points.
#[test]
fn levels_of_detail_hold_together() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["ladder", "sample:ct", "--preset", "ct-bone", "-o", "out"];
    let made = common::json(
        folder.path(),
        &[&args[..], &["--counts", "20000,2000,51410,5000", "--mesh", "npz"]].concat(),
    );
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let full = number(&made["full"]["volume"]);
    let levels = made["levels"].as_array().unwrap();
    let [many, few, all, some] = &levels[..] else { panic!("{made}") };
    for level in levels {
        assert!(number(&level["largest_part"]) >= 0.95, "{level}");
        assert!((number(&level["volume"]) / full - 1.0).abs() < 0.2, "{level}");
    }
    assert!((number(&many["volume"]) / full - 1.0).abs() < 0.1, "{many}");
    let alpha = |level: &serde_json::Value| number(&level["alpha"]["squared"]);
    let away = |level: &serde_json::Value| number(&level["distance"]["mean"]);
    assert!(alpha(few) > alpha(some) && alpha(some) > alpha(many) && alpha(many) >= alpha(all));
    assert!(away(few) > away(some) && away(some) > away(many) && away(many) > 0.1, "{levels:?}");
    // Full detail is the shape itself.
    assert_eq!(
        (&all["points"], &all["volume"]),
        (&made["full"]["points"], &made["full"]["volume"])
    );
    assert_eq!(all["alpha"], made["alpha"]);
    assert!(away(all) < 1e-9 && number(&all["distance"]["max"]) < 1e-9, "{all}");
    let csv = std::fs::read_to_string(folder.path().join("out/detail.csv")).unwrap();
    let columns = ["alpha,largest_part,distance_mean,distance_max"];
    assert!(csv.lines().next().unwrap().ends_with(columns[0]), "{csv}");

    let given = [&args[..], &["--counts", "5000,20000", "--alpha", "60"]].concat();
    let made = common::json(folder.path(), &given);
    assert_eq!(
        (&made["alpha"]["squared"], &made["levels"][0]["alpha"]),
        (&serde_json::json!(60.0), &made["alpha"])
    );
    assert_eq!(made["levels"][1]["alpha"], made["alpha"]);
    let text = common::ok(folder.path(), &given);
    common::names(&text, &["full      51410 points", "largest", "farthest", "60.000"]);
}

/// The levels tell the same error as `interpolate` for the same number of points, for any values in the file.
#[test]
fn levels_of_detail_tell_the_error_of_the_interpolant() {
    let folder = tempfile::tempdir().unwrap();
    let scan = ["haar", "sample:phantom@20", "--rms", "0", "-o", "a.npy"];
    common::ok(folder.path(), &scan);
    let told = |args: &[&str]| common::json(folder.path(), args);
    // Beyond the count of the shape, levels have the samples of largest difference, too.
    let shared = ["--gray", "-50..300", "--alpha", "10"];
    let levels = ["ladder", "a.npy", "--counts", "300,900", "--count", "200", "-o", "out"];
    let levels = told(&[&levels[..], &shared].concat());
    for (level, count) in ["300", "900"].iter().enumerate() {
        let options = [&["--count", count, "--fill"][..], &shared].concat();
        let alone = told(&[&["interpolate", "a.npy"][..], &options[..]].concat());
        for (ours, theirs) in [("rmse_inside", "inside"), ("rmse_filled", "filled")] {
            let expected = &alone["interpolation"][theirs]["rmse"];
            assert!(expected.as_f64().unwrap() > 1.0);
            assert_eq!(&levels["levels"][level][ours], expected, "{ours} of {count}");
        }
    }
}

/// A grid of 1.5 × 6 × 9 mm, all of it in the shape.
#[test]
fn coverage_is_a_share_of_the_box_in_its_units() {
    let folder = tempfile::tempdir().unwrap();
    let header = "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementSpacing = 0.5 2 3\n\
        ElementType = MET_UCHAR\nElementDataFile = a.raw\n";
    std::fs::write(folder.path().join("a.mhd"), header).unwrap();
    let samples: Vec<u8> = (0..64).map(|i: u32| (i * (37 + 11 * i) % 251) as u8).collect();
    std::fs::write(folder.path().join("a.raw"), samples).unwrap();
    for levels in [&["--count", "64", "--alphas", "inf"][..], &["--counts", "64"]] {
        for (units, volume) in [("world", 81.0), ("voxel", 27.0)] {
            let options = ["--weights", "common=0", "--units", units, "-o", units];
            let args = [&["ladder", "a.mhd"][..], levels, &options].concat();
            let made = common::json(folder.path(), &args);
            assert_eq!(made["domain"]["volume"], volume, "{args:?}");
            assert_eq!(made["levels"][0]["volume"], volume, "{args:?}");
            assert_eq!(made["levels"][0]["coverage"], 1.0, "{args:?}");
        }
    }
}

/// A level of more points than those of full detail has them in the region, too.
#[test]
fn a_region_is_not_coarser_than_its_level() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["ladder", "sample:phantom@24", "--counts", "6000", "-o", "out"];
    let region = ["--focus", "4:19,4:19,8:12", "--count", "300"];
    let points =
        |args: &[&str]| common::json(folder.path(), args)["levels"][0]["points"].as_u64().unwrap();
    assert_eq!(points(&[&args[..], &region].concat()), points(&args));
}

#[test]
fn invalid_options_leave_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let phantom = "sample:phantom@16";
    for (args, code, word) in [
        (&["ladder", phantom, "-o", "out", "--alphas", "1,x"][..], 2, "--alphas"),
        (&["ladder", phantom, "-o", "out", "--mesh", "doc"], 2, "--mesh"),
        (&["ladder", phantom, "-o", "out.csv"], 2, "--output takes a folder"),
        (&["ladder", phantom, "-o", "out.GLB"], 2, "--output takes a folder"),
        (&["ladder", phantom, "-o", "out.laz"], 2, "--output takes a folder"),
        (&["ladder", phantom, "-o", "out.png"], 2, "--output takes a folder"),
        (&["ladder", phantom, "-o", "out", "--focus", "1:2,1:2,1:2"], 2, "--counts"),
        (
            &["ladder", phantom, "-o", "out", "--counts", "9", "--focus", "2:1,1:2,1:2"],
            2,
            "not a range",
        ),
        (
            &["ladder", phantom, "-o", "out", "--counts", "9", "--focus", "90:99,1:2,1:2"],
            1,
            "--focus",
        ),
        (&["ladder", phantom, "-o", "out", "--counts", "9", "--alphas", "1"], 2, "--counts"),
        (&["ladder", phantom, "-o", "out", "--counts", "9", "--alpha-ref", "1"], 2, "--alpha-ref"),
        (&["ladder", phantom, "-o", "out", "--alphas", "9", "--alpha", "1"], 2, "--alpha has no"),
    ] {
        let (got, _, stderr) = common::run(folder.path(), args);
        assert_eq!(got, code, "{stderr}");
        assert!(stderr.contains(word), "{stderr}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{args:?}");
    }
}
