//! LAS and LAZ against the crate that writes them.

use walpha::points::{PointOptions, is_point_file, read_model, read_points};

use crate::common::Told;
use crate::common::{alone, fails, json, largest, run};

/// Coordinates are whole numbers of thousandths, so that the format's scales keep them.
fn write(path: &std::path::Path, version: (u8, u8)) {
    let mut builder = las::Builder::from(version);
    builder.point_format.is_compressed = path.extension().is_some_and(|e| e == "laz");
    let transform = las::Transform { scale: 0.001, offset: 0.0 };
    builder.transforms = las::Vector { x: transform, y: transform, z: transform };
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    for k in 0..5u16 {
        let (x, y, z) = (f64::from(k), f64::from(2 * k), -f64::from(k));
        let classification = las::point::Classification::new([2, 2, 5, 6, 2][k as usize]).unwrap();
        let point =
            las::Point { x, y, z, intensity: 100 * k, classification, ..las::Point::default() };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
}

#[test]
fn clouds_of_scanners_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.las", "a.laz"] {
        let path = folder.path().join(name);
        write(&path, (1, 2));
        // The file is recognized by content, with any name.
        let other = folder.path().join("cloud.dat");
        std::fs::copy(&path, &other).unwrap();
        for path in [&path, &other] {
            assert!(is_point_file(path).unwrap(), "{name}");
            let points = read_points(path, None).unwrap();
            let expected: Vec<_> = (0..5).map(f64::from).map(|k| [k, 2.0 * k, -k]).collect();
            assert_eq!(points.positions, expected, "{name}");
            assert_eq!(points.values, Some(vec![0.0, 100.0, 200.0, 300.0, 400.0]), "{name}");
        }
        let bytes = std::fs::read(&path).unwrap();
        std::fs::write(&path, &bytes[..bytes.len() - 30]).unwrap();
        let error = read_points(&path, None).unwrap_err().told();
        assert!(error.contains(name), "{error}");
    }
}

/// Found by fuzzing: records of 58 369 bytes each, in a file of 230.
#[cfg(target_os = "linux")]
#[test]
fn long_records_take_no_more_than_their_share() {
    // The peak is that of the process.
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long.las");
        write(&path, (1, 2));
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[105..107].copy_from_slice(&58_369u16.to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        let peak = || {
            let status = std::fs::read_to_string("/proc/self/status").unwrap();
            let line = status.lines().find_map(|line| line.strip_prefix("VmPeak:")).unwrap();
            line.trim().trim_end_matches(" kB").parse::<u64>().unwrap()
        };
        let before = peak();
        assert!(read_points(&path, None).is_err());
        let more = peak() - before;
        assert!(more < 1 << 20, "{more} KiB more");
    });
}

/// Found by fuzzing: a number of points that, times the bytes of each, is more than 64 bits; and an extended
/// record of 2⁶² bytes.
#[test]
fn more_than_there_can_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.las");
    write(&path, (1, 4));
    assert_eq!(read_points(&path, None).unwrap().len(), 5);
    let whole = std::fs::read(&path).unwrap();
    let mut bytes = whole.clone();
    // The number of 32 bits of older versions goes before that of 64.
    bytes[107..111].fill(0);
    bytes[247..255].fill(0xff);
    std::fs::write(&path, &bytes).unwrap();
    let error = read_points(&path, None).unwrap_err().told();
    assert!(error.contains("more bytes of points than a number can count"), "{error}");
    let mut bytes = whole.clone();
    bytes[235..243].copy_from_slice(&(whole.len() as u64).to_le_bytes());
    bytes[243..247].copy_from_slice(&1u32.to_le_bytes());
    bytes.extend([0; 60]);
    bytes[whole.len() + 20..][..8].copy_from_slice(&(1u64 << 62).to_le_bytes());
    std::fs::write(&path, &bytes).unwrap();
    let error = read_points(&path, None).unwrap_err().told();
    assert!(error.contains("claims a record of 4611686018427387904 bytes"), "{error}");
}

/// Points of a class, and one in each cube: points 0, 1 and 4 are ground, and the first two share a cube of side 2.5.
#[test]
fn classes_and_thinning() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write(&f.join("a.laz"), (1, 2));
    let options = PointOptions::default().classes(Some(vec![2]));
    let values =
        |options: &PointOptions| read_model(f.join("a.laz"), options).unwrap().0.values.unwrap();
    assert_eq!(values(&options), [0.0, 100.0, 400.0]);
    assert_eq!(values(&options.thin(Some(2.5))), [0.0, 400.0]);
    assert_eq!(values(&PointOptions::default().thin(Some(2.0))), [0.0, 100.0, 200.0, 300.0, 400.0]);
    let selected = |options: &[&str]| {
        let made = json(f, &[&["points", "a.laz"][..], options].concat());
        made["points"]["selected"].as_u64().unwrap()
    };
    assert_eq!(selected(&["--class", "ground"]), 3);
    assert_eq!(selected(&["--class", "vegetation,6"]), 2);
    assert_eq!(selected(&["--class", "ground", "--thin", "2.5"]), 2);
    fails(f, 1, "points a.laz --class water", &["no points of class 9 (water)", "2 (ground)"]);
    fails(f, 2, "points a.laz --class trees", &["ground"]);
    fails(f, 2, "points sample:phantom@8 --thin 1", &["--thin", "a volume"]);
    std::fs::write(f.join("a.xyz"), "0 0 0\n1 0 0\n").unwrap();
    fails(f, 1, "points a.xyz --class ground", &["no classes"]);
}

/// Three points as laszip packs them: in chunks (LAS 1.2, format 1), and in layers (LAS 1.4, format 6).
fn packed(path: &std::path::Path, version: (u8, u8), format: u8) -> Vec<u8> {
    let mut builder = las::Builder::from(version);
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = true;
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    for k in 0..3 {
        let gps_time = Some(f64::from(k));
        let x = f64::from(k);
        writer.write_point(las::Point { x, gps_time, ..las::Point::default() }).unwrap();
    }
    writer.close().unwrap();
    std::fs::read(path).unwrap()
}

/// In version 1.4 the 64-bit number counts, also for chunks of layers.
#[test]
fn the_number_of_64_bits_holds_where_an_old_one_differs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.laz");
    let whole = packed(&path, (1, 4), 6);
    for old in [0u32, 2, 9] {
        let mut bytes = whole.clone();
        bytes[107..111].copy_from_slice(&old.to_le_bytes());
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(read_points(&path, None).unwrap().len(), 3, "{old}");
        let told = json(folder.path(), &["info", "a.laz"]);
        let said = told["warnings"].to_string().contains("3 in its own field: 3 are read");
        assert_eq!(said, old > 0, "{old}: {told}");
    }
}

/// No change of a byte panics or requests more memory than a file of this size can need: for items that make no point, for more
/// chunks than there are bytes, for longer layers than the file.
#[test]
fn damaged_compression_is_an_error() {
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        for (version, format) in [((1, 2), 1), ((1, 4), 6)] {
            let path = folder.path().join(format!("{format}.laz"));
            let whole = packed(&path, version, format);
            assert_eq!(read_points(&path, None).unwrap().len(), 3);
            let mut refused = 0;
            for place in 0..whole.len() {
                for value in [0, 0xff, whole[place] ^ 1] {
                    let mut bytes = whole.clone();
                    bytes[place] = value;
                    std::fs::write(&path, &bytes).unwrap();
                    refused += usize::from(read_points(&path, None).is_err());
                }
            }
            assert!(refused > 100, "{refused}");
            // Layers that are not announced, and the reverse; with more bytes than the file where layers would be.
            let user = b"laszip encoded";
            let compressor = whole.windows(user.len()).position(|at| at == user).unwrap() + 52;
            let layers = usize::from(u16::from_le_bytes([whole[105], whole[106]])) + 12;
            let data = u32::from_le_bytes(whole[96..100].try_into().unwrap()) as usize + layers;
            let mut bytes = whole.clone();
            bytes[compressor] ^= 1;
            bytes[data + 3] = 0x7f;
            std::fs::write(&path, &bytes).unwrap();
            let refused = read_points(&path, None).unwrap_err().to_string();
            assert!(refused.contains("is not one of points of format"), "{refused}");
        }
        // A batch of points, and no table of chunks.
        assert!(largest() < 64 << 20, "{} bytes at once", largest());
    });
}

/// The header has the box of the points as they are stored, and columns keep names that differ.
#[test]
fn headers_and_names_hold_what_is_stored() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows = "434000.03,5412000.71,100.5,1,2\n434007.27,5412009.13,199.98,3,4\n";
    let long = "a_very_long_column_name_that_exceeds_";
    std::fs::write(f.join("a.csv"), format!("x,y,z,b,{long}1\n{rows}")).unwrap();
    for name in ["a.las", "a.laz"] {
        let (code, _, stderr) = run(f, &["points", "a.csv", "-o", name]);
        assert!(code == 0 && stderr.contains("LAS holds 32 bytes of a name"), "{stderr}");
        let bytes = std::fs::read(f.join(name)).unwrap();
        let number =
            |k: usize| f64::from_le_bytes(bytes[179 + 8 * k..187 + 8 * k].try_into().unwrap());
        let points = read_points(f.join(name), None).unwrap();
        for axis in 0..3 {
            let [a, b] = [0, 1].map(|k| points.positions[k][axis]);
            assert_eq!([number(2 * axis), number(2 * axis + 1)], [b, a], "{name}, {axis}");
        }
    }
    std::fs::write(f.join("b.csv"), format!("x,y,z,{long}1,{long}2\n{rows}")).unwrap();
    fails(f, 1, "points b.csv -o b.las", &["agree in the first 32 bytes", "rename one"]);
    assert!(!f.join("b.las").exists());
}

/// Weights, radii and values of compressed layers are those of each point, also where no other column is read.
#[test]
fn weights_of_compressed_layers_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (column, list) in
        [("weight", "/weights"), ("radius", "/weights"), ("value", "/info/values")]
    {
        let row = |i: u32| {
            format!("{},{},{},{}\n", i % 5, i / 5 % 5, i / 25, 0.25 * f64::from(i % 7) + 0.3)
        };
        let rows: String = (0..125).map(row).collect();
        std::fs::write(f.join("a.csv"), format!("x,y,z,{column}\n{rows}")).unwrap();
        for name in ["a.las", "a.laz"] {
            crate::common::ok(f, &["points", "a.csv", "-o", name]);
        }
        let of = |name: &str| {
            let shape = ["shape", name, "--alpha", "0.8", "-o", "s.json"];
            crate::common::ok(f, &shape);
            let written: serde_json::Value =
                serde_json::from_slice(&std::fs::read(f.join("s.json")).unwrap()).unwrap();
            let numbers =
                written.pointer(list).and_then(|list| list.as_array()).expect("numbers").clone();
            assert_eq!(numbers.len(), 125);
            numbers
        };
        let expected = of("a.csv");
        assert_ne!(expected[0], expected[1]);
        for name in ["a.las", "a.laz"] {
            assert_eq!(of(name), expected, "{column} of {name}");
        }
    }
}
