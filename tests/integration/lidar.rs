//! Laser scans: what a file knows about its points, its columns, groups of points, and outlines on the Earth.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use walpha::points::{Attributes, PointOptions, read_model};

use crate::common::{fails, json as told, names, ok, run};

/// Two trees, cubes of 2 m with corners and centre, numbered 7 and 9 in the extra bytes; ground below, which has no number; in
/// UTM zone 32 with heights above sea level.
fn tile(path: &Path) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(7).unwrap();
    builder.point_format.extra_bytes = 4;
    builder.point_format.is_compressed = path.extension().is_some_and(|e| e == "laz");
    let transform = las::Transform { scale: 0.01, offset: 0.0 };
    builder.transforms = las::Vector { x: transform, y: transform, z: transform };
    builder.vlrs.push(las::Vlr {
        user_id: "LASF_Projection".into(),
        record_id: 34735,
        description: String::new(),
        data: [1, 1, 0, 4, 1024, 0, 1, 1, 3072, 0, 1, 25832, 3076, 0, 1, 9001, 4096, 0, 1, 5941]
            .iter()
            .flat_map(|key: &u16| key.to_le_bytes())
            .collect(),
    });
    let mut extra = vec![0; 192];
    (extra[2], extra[3]) = (6, 1);
    extra[4..10].copy_from_slice(b"treeID");
    extra[40..48].copy_from_slice(&(-1i64).to_le_bytes());
    builder.vlrs.push(las::Vlr {
        user_id: "LASF_Spec".into(),
        record_id: 4,
        description: String::new(),
        data: extra,
    });
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    let mut write = |[x, y, z]: [f64; 3], class: u8, tree: i32| {
        writer
            .write_point(las::Point {
                x: 500_000.0 + x,
                y: 5_500_000.0 + y,
                z,
                intensity: 40 * u16::from(class),
                classification: las::point::Classification::new(class).unwrap(),
                gps_time: Some(f64::from(tree)),
                color: Some(las::Color::new(0xff00, 256, 0)),
                is_overlap: class == 2,
                extra_bytes: tree.to_le_bytes().to_vec(),
                ..las::Point::default()
            })
            .unwrap();
    };
    for (tree, start) in [(9, 20.0), (7, 0.0)] {
        for k in 0..8u8 {
            let corner = [k & 1, k >> 1 & 1, k >> 2].map(|bit| 2.0 * f64::from(bit));
            write([start + corner[0], corner[1], 10.0 + corner[2]], 5, tree);
        }
        write([start + 1.0, 1.0, 11.0], 4, tree);
    }
    for k in 0..9u8 {
        write([f64::from(k % 3) * 10.0, f64::from(k / 3), 1.0], 2, -1);
    }
    writer.close().unwrap();
}

#[test]
fn info_tells_what_a_scan_knows() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for name in ["tile.las", "tile.laz"] {
        tile(&f.join(name));
        let made = told(f, &["info", name]);
        assert_eq!(made["crs"]["epsg"], 25832);
        assert_eq!(made["crs"]["name"], "ETRS89 / UTM zone 32N");
        assert_eq!(made["crs"]["vertical"]["epsg"], 5941);
        assert_eq!(made["unit"], "m");
        assert_eq!(made["classes"], json!({"2": 9, "4": 2, "5": 16}));
        assert_eq!(made["class_names"]["5"], "high vegetation");
        assert_eq!(made["point_format"], 7);
        assert_eq!(made["version"], "1.4");
        assert_eq!(made["compressed"], name == "tile.laz");
        assert_eq!(made["flags"]["overlap"], 9);
        assert_eq!(made["time"], json!([-1.0, 9.0]));
        let columns = &made["columns"];
        let tree = json!({"type": "int32", "min": 7.0, "max": 9.0, "missing": 9});
        assert_eq!(columns["treeID"], tree);
        assert_eq!(columns["intensity"]["max"], 200.0);
        let text = ok(f, &["info", name]);
        names(&text, &["ETRS89 / UTM zone 32N (EPSG:25832)", "5 (high vegetation): 16"]);
        names(&text, &["treeID: int32, 7 to 9, none for 9 points", "unit      m", "overlap 9"]);
    }
    let table = "x,y,z,label,species\n0,0,0,1,oak\n1,0,0,2,ash\n0,1,0,2,ash\n0,0,1,1,ash\n";
    fs::write(f.join("t.csv"), table).unwrap();
    let columns = &told(f, &["info", "t.csv"])["columns"];
    assert_eq!(columns.as_object().unwrap().keys().collect::<Vec<_>>(), ["label"]);
    assert_eq!(columns["label"]["max"], 2.0);
}

/// Longitude and latitude are refused for a shape, and described by `info`.
#[test]
fn angles_are_described() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.las"));
    let mut bytes = fs::read(f.join("tile.las")).unwrap();
    let projected: Vec<u8> = [1024u16, 0, 1, 1, 3072, 0, 1, 25832].map(u16::to_le_bytes).concat();
    let place = bytes.windows(16).position(|at| at == projected).unwrap();
    let angles = [1024u16, 0, 1, 2, 2048, 0, 1, 4326].map(u16::to_le_bytes).concat();
    bytes[place..place + 16].copy_from_slice(&angles);
    fs::write(f.join("tile.las"), bytes).unwrap();
    let made = told(f, &["info", "tile.las"]);
    assert_eq!((&made["crs"]["epsg"], &made["unit"]), (&json!(4326), &json!("degree")));
    assert_eq!(made["crs"]["name"], "WGS 84");
    fails(f, 1, "shape tile.las", &["longitude and latitude"]);
}

#[test]
fn columns_are_read_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let attributes = Attributes::Named(vec!["treeid".into(), "class".into()]);
    let options = PointOptions::default().attributes(attributes).classes(Some(vec![4, 2]));
    let (points, _) = read_model(f.join("tile.laz"), &options).unwrap();
    assert_eq!(points.len(), 11);
    let trees = points.column("treeID").unwrap();
    assert_eq!(trees[..2], [9.0, 7.0]);
    assert!(trees[2..].iter().all(|tree| tree.is_nan()));
    assert_eq!(points.column("classification").unwrap()[1..3], [4.0, 2.0]);
    assert_eq!(points.columns.len(), 2);
    // F is the intensity, unless a column is named.
    let values = |value: &[&str]| {
        ok(f, &[&["points", "tile.laz", "-o", "-", "--output-format", "csv"], value].concat())
    };
    names(&values(&[]), &["500020,5500000,10,0,200"]);
    names(&values(&["--value", "height"]), &["500020,5500000,10,0,10"]);
    names(&values(&["--value", "red"]), &["500020,5500000,10,0,65280"]);
    fails(f, 1, "points tile.laz --value nope", &["no column nope", "treeID", "intensity"]);
    fails(f, 1, "points tile.laz --value treeID", &["must be a finite number"]);
    fails(f, 2, "points sample:phantom@8 --value height", &["--value", "a volume"]);
    let classes = ["class 6 (building)", "2 (ground), 4 (medium vegetation), 5 (high vegetation)"];
    fails(f, 1, "points tile.laz --class building", &classes);
}

/// Meshes carry the columns.
#[test]
fn meshes_carry_columns() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.las"));
    let class = ["shape", "tile.las", "--class", "4,5", "--alpha", "3"];
    ok(f, &[&class[..], &["-o", "t.ply", "t.vtu", "t.vtp", "--ascii"]].concat());
    let ply = fs::read_to_string(f.join("t.ply")).unwrap();
    names(&ply, &["property double treeID\n", "property double file_red\n"]);
    for name in ["t.vtu", "t.vtp"] {
        let bytes = fs::read(f.join(name)).unwrap();
        names(&String::from_utf8_lossy(&bytes), &["Name=\"treeID\"", "Name=\"classification\""]);
    }
    // The columns of a mesh are read like any others.
    for (name, red) in [("t.ply", "file_red"), ("t.vtu", "red")] {
        let columns = &told(f, &["info", name])["columns"];
        let tree = &columns["treeID"];
        assert_eq!((&tree["min"], &tree["max"]), (&json!(7.0), &json!(9.0)), "{name}");
        assert_eq!(columns[red]["min"], 65280.0);
    }
}

/// What comes in goes out: all columns, the coordinate system, scales and offsets, whether compressed or not, and twice.
#[test]
fn scans_are_written_as_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    ok(f, &["points", "tile.laz", "-o", "a.las"]);
    ok(f, &["points", "a.las", "-o", "b.laz"]);
    ok(f, &["points", "b.laz", "-o", "c.las"]);
    assert_eq!(fs::read(f.join("a.las")).unwrap(), fs::read(f.join("c.las")).unwrap());
    let facts = |name: &str| {
        let mut made = told(f, &["info", name]);
        let object = made.as_object_mut().unwrap();
        for of_file in ["input", "bytes", "compressed", "seconds"] {
            object.remove(of_file);
        }
        made
    };
    for name in ["a.las", "b.laz"] {
        assert_eq!(facts(name), facts("tile.laz"), "{name}");
        let read = |name: &str| {
            let options = PointOptions::default().attributes(Attributes::All);
            read_model(f.join(name), &options).unwrap().0
        };
        // As text, in which points without a number are alike.
        assert!(format!("{:?}", read(name)) == format!("{:?}", read("tile.laz")), "{name}");
    }
    let header = |name: &str| las::Reader::from_path(f.join(name)).unwrap().header().clone();
    let (first, second) = (header("tile.laz"), header("b.laz"));
    assert_eq!(first.transforms(), second.transforms());
    assert_eq!(first.point_format(), second.point_format());
    assert_eq!(first.bounds(), second.bounds());
    // A part has all columns, too.
    ok(f, &["points", "b.laz", "--class", "ground", "-o", "ground.laz"]);
    assert_eq!(told(f, &["info", "ground.laz"])["columns"]["treeID"]["missing"], 9);
    assert_eq!(told(f, &["info", "ground.laz"])["flags"]["overlap"], 9);
}

/// A table becomes a scan: columns have the fields of their names, or are extra bytes; and a scan becomes a table.
#[test]
fn tables_become_scans_and_scans_become_tables() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let rows = "x,y,z,weight,value,class,treeID,species,dbh\n0.25,1,5000000.5,0,1.5,2,7,oak,0.31\n1,1,5,2,2.5,5,8,ash,nan\n";
    fs::write(f.join("t.csv"), rows).unwrap();
    ok(f, &["points", "t.csv", "-o", "t.laz"]);
    let made = told(f, &["info", "t.laz"]);
    assert_eq!(made["classes"], json!({"2": 1, "5": 1}));
    assert_eq!(made["columns"]["treeID"]["type"], "float64");
    assert_eq!(made["columns"]["dbh"]["missing"], 1);
    ok(f, &["points", "t.laz", "-o", "back.csv"]);
    let back = fs::read_to_string(f.join("back.csv")).unwrap();
    let lines: Vec<&str> = back.lines().collect();
    names(lines[0], &["x,y,z,weight,value,intensity,", ",classification,", ",treeID,dbh"]);
    names(lines[1], &["0.25,1,5000000.5,0,1.5,", ",7,0.31"]);
    names(lines[2], &["1,1,5,2,2.5,", ",8,nan"]);
    // NPY has them, too, and what is read again is written again.
    ok(f, &["points", "back.csv", "-o", "t.npy"]);
    ok(f, &["points", "t.npy", "-o", "again.csv"]);
    assert_eq!(fs::read_to_string(f.join("again.csv")).unwrap(), back);
    // Values that can be intensities are.
    fs::write(f.join("i.csv"), "x,y,z,intensity\n0,0,0,9\n1,0,0,65535\n").unwrap();
    ok(f, &["points", "i.csv", "-o", "i.las"]);
    assert_eq!(told(f, &["info", "i.las"])["columns"]["intensity"]["max"], 65535.0);
    fs::write(f.join("c.csv"), "x,y,z,class\n0,0,0,9\n1,0,0,256\n").unwrap();
    fails(f, 1, "points c.csv -o c.las", &["point 1: classification is 256", "uint8"]);
    assert!(!f.join("c.las").exists());
    // What no scale stores exactly is rounded, and said.
    fs::write(f.join("r.csv"), "x,y,z\n0.333333333333,0,0\n1000,0,0\n").unwrap();
    let (code, _, said) = run(f, &["points", "r.csv", "-o", "r.las"]);
    assert_eq!(code, 0, "{said}");
    names(&said, &["multiples of 0.000001, 1, 1", "moves points by 3.3"]);
    // The coordinate system of the built-in tile is carried on.
    ok(f, &["points", "sample:tile", "-o", "tile.laz"]);
    let made = told(f, &["info", "tile.laz"]);
    assert_eq!((&made["crs"]["epsg"], &made["unit"]), (&json!(25832), &json!("m")));
    // Most points are of no tree, and only doubles can say so.
    let trees = &made["columns"]["treeID"];
    assert_eq!((&trees["type"], &trees["missing"]), (&json!("float64"), &json!(9000)));
}

/// A region and thinning while a scan is read give what they give of a table that is read whole.
#[test]
fn parts_of_scans_are_those_of_tables() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for name in ["tile.las", "tile.laz", "tile.csv"] {
        ok(f, &["points", "sample:tile", "-o", name]);
    }
    let options: [&[&str]; 3] = [
        &["--roi", "691000.5:691030,5334010:,:523.25"],
        &["--thin", "1.5"],
        &["--roi", ":691030.125,:,521:", "--thin", "2", "--value", "height"],
    ];
    for option in options {
        let rows = |name: &str| {
            let args = [&["points", name, "-o", "-", "--output-format", "csv"], option].concat();
            let text = ok(f, &args);
            let places = text.lines().map(|line| {
                let fields: Vec<&str> = line.split(',').take(5).collect();
                fields.join(",")
            });
            places.collect::<Vec<_>>()
        };
        let wanted = rows("sample:tile");
        assert!(wanted.len() > 50, "{option:?}: {}", wanted.len());
        for name in ["tile.las", "tile.laz", "tile.csv"] {
            assert!(rows(name) == wanted, "{name} {option:?}");
        }
    }
    let nowhere = "points tile.laz --roi 0:1,0:1,:";
    fails(f, 1, nowhere, &["has no point in 0:1,0:1", "--roi", "691000"]);
    fails(f, 1, "points sample:phantom@8 --roi 0.5:2,:,:", &["region of places", "--roi"]);
}

/// Of COPC, cells outside of the region are not decompressed: damage there is not noticed, and no point inside is missing.
#[test]
fn cells_of_copc_outside_a_region_are_skipped() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let place = copc(&f.join("t.copc.laz"));
    let rows = |roi: &str| {
        ok(f, &["points", "t.copc.laz", "--roi", roi, "-o", "-", "--output-format", "csv"])
    };
    let (all, half) = (rows(":,:,:"), rows("10:,:,:"));
    assert_eq!((all.lines().count(), half.lines().count()), (201, 101));
    let mut bytes = fs::read(f.join("t.copc.laz")).unwrap();
    bytes[place..place + 40].fill(0x55);
    fs::write(f.join("t.copc.laz"), bytes).unwrap();
    assert_eq!(rows("10:,:,:"), half);
    assert_ne!(run(f, &["points", "t.copc.laz", "-o", "-", "--output-format", "csv"]).1, all);
}

/// 100 points near x = 4 and 100 near x = 12, each in a cell of an octree of its own. Returns a place within the layers of the
/// first cell.
fn copc(path: &Path) -> usize {
    use std::io::{Cursor, Seek, SeekFrom, Write};
    let mut random = 1u32;
    let mut points = Vec::new();
    for k in 0..200 {
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(random >> 20) / 1000.0
        };
        let x = if k < 100 { 1.0 } else { 11.0 } + next();
        points.push([x, 2.0 + next(), 2.0 + next()]);
    }
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).unwrap();
    builder.point_format.is_compressed = true;
    // The record must come first; the library puts that of the compression behind it.
    let record = |user: &str, number: u16, data: Vec<u8>| las::Vlr {
        user_id: user.into(),
        record_id: number,
        description: String::new(),
        data,
    };
    builder.vlrs.push(record("copc", 1, vec![0; 160]));
    builder.evlrs.push(record("copc", 1000, vec![0; 64]));
    // Two chunks: the library of points writes one, so each half is a file of its own, whose chunk is taken.
    let file = |points: &[[f64; 3]]| {
        let header = builder.clone().into_header().unwrap();
        let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
        for &[x, y, z] in points {
            let point = las::Point { x, y, z, gps_time: Some(x), ..las::Point::default() };
            writer.write_point(point).unwrap();
        }
        writer.into_inner().unwrap().into_inner()
    };
    let number =
        |bytes: &[u8], at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    let data = |bytes: &[u8]| u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
    let chunk = |bytes: &[u8]| {
        let start = data(bytes) + 8;
        let table = number(bytes, data(bytes)) as usize;
        bytes[start..table].to_vec()
    };
    let (whole, second) = (file(&points), chunk(&file(&points[100..])));
    let first = chunk(&file(&points[..100]));
    let start = data(&whole);
    let mut out = Cursor::new(whole[..start].to_vec());
    out.seek(SeekFrom::End(0)).unwrap();
    let table = start + 8 + first.len() + second.len();
    out.write_all(&(table as u64).to_le_bytes()).unwrap();
    out.write_all(&first).unwrap();
    out.write_all(&second).unwrap();
    // A table of chunks that is not read, as each chunk says how many points it has.
    out.write_all(&[0; 8]).unwrap();
    let records = out.position();
    let entry = |x: i32, offset: usize, size: usize| -> Vec<u8> {
        let key = [1, x, 0, 0].map(i32::to_le_bytes).concat();
        let rest = [size as i32, 100].map(i32::to_le_bytes).concat();
        [key, (offset as u64).to_le_bytes().to_vec(), rest].concat()
    };
    let page = [entry(0, start + 8, first.len()), entry(1, start + 8 + first.len(), second.len())];
    let mut head = vec![0u8; 60];
    head[2..6].copy_from_slice(b"copc");
    head[18..20].copy_from_slice(&1000u16.to_le_bytes());
    head[20..28].copy_from_slice(&64u64.to_le_bytes());
    out.write_all(&head).unwrap();
    out.write_all(&page.concat()).unwrap();
    let mut bytes = out.into_inner();
    bytes[235..243].copy_from_slice(&records.to_le_bytes());
    // The octree: its centre, half of its side, the spacing, and where its entries are.
    let info = bytes.windows(4).position(|at| at == b"copc").unwrap() - 2 + 54;
    for (k, number) in [8.0f64, 8.0, 8.0, 8.0, 1.0].into_iter().enumerate() {
        bytes[info + 8 * k..info + 8 * k + 8].copy_from_slice(&number.to_le_bytes());
    }
    bytes[info + 40..info + 48].copy_from_slice(&(records + 60).to_le_bytes());
    bytes[info + 48..info + 56].copy_from_slice(&64u64.to_le_bytes());
    fs::write(path, bytes).unwrap();
    start + 8 + first.len() / 2
}

/// Points that do not fit in memory are refused, with the figure and what to do.
#[test]
fn too_many_points_are_refused_with_the_figure() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let mut header = las::Builder::from((1, 2));
    header.point_format.is_compressed = true;
    let mut writer =
        las::Writer::from_path(f.join("old.laz"), header.into_header().unwrap()).unwrap();
    for k in 0..9 {
        writer.write_point(las::Point { x: f64::from(k), ..las::Point::default() }).unwrap();
    }
    writer.close().unwrap();
    let mut bytes = fs::read(f.join("old.laz")).unwrap();
    bytes[107..111].copy_from_slice(&u32::MAX.to_le_bytes());
    fs::write(f.join("old.laz"), bytes).unwrap();
    // 4 billion points take 128 GiB, which few machines have.
    let (code, _, said) = run(f, &["points", "old.laz"]);
    assert!(
        code != 0
            && (said.contains("--roi") && said.contains("131071 MiB")
                || said.contains("truncated")),
        "{said}"
    );
}

/// A shape for each tree, at one α: a table, crowns on the Earth, and meshes.
#[test]
fn each_value_of_a_column_has_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let by = ["shape", "tile.laz", "--by", "treeID", "--alpha-radius", "2"];
    let outputs = ["-o", "trees.csv", "crowns.geojson", "crowns.gpkg", "trees"];
    let made = told(f, &[&by[..], &outputs].concat());
    assert_eq!((&made["points"], &made["left_out"]), (&json!(27), &json!(9)));
    assert_eq!((&made["volume"], &made["alpha"]["squared"]), (&json!(16.0), &json!(4.0)));
    let table = fs::read_to_string(f.join("trees.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "treeID,points,alpha,volume,area,height,outline_area,outline_perimeter,xmin,ymin,zmin,xmax,ymax,zmax"
    );
    assert_eq!(
        lines[1],
        "7,9,4.0,8.0,24.0,2.0,4.0,8.0,500000.0,5500000.0,10.0,500002.0,5500002.0,12.0"
    );
    assert!(lines[2].starts_with("9,9,4.0,8.0,24.0,2.0,4.0,8.0,500020.0"), "{table}");
    assert_eq!(lines.len(), 3);
    let crowns: Value =
        serde_json::from_slice(&fs::read(f.join("crowns.geojson")).unwrap()).unwrap();
    let [first, second] = crowns["features"].as_array().unwrap().as_slice() else { panic!() };
    assert_eq!(
        (&first["properties"]["treeID"], &first["properties"]["volume"]),
        (&json!(7), &json!(8.0))
    );
    assert_eq!(first["geometry"]["type"], "MultiPolygon");
    // Zone 32 has its central meridian at 9°, where x is 500 km; the latitude is PROJ's.
    let place = first["geometry"]["coordinates"][0][0][0].as_array().unwrap();
    let [x, y] = [0, 1].map(|k| place[k].as_f64().unwrap());
    assert!((x - 9.0).abs() < 1e-9 && (y - 49.652_542_923_6).abs() < 1e-9, "{x} {y}");
    assert_eq!(second["properties"]["treeID"], 9);
    let package = package(&f.join("crowns.gpkg"));
    let crowns = package.prepare("SELECT treeID, volume, outline_area, unit, geom FROM outlines");
    let rows: Vec<(i64, f64, f64, String, Vec<u8>)> = crowns
        .unwrap()
        .query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?)))
        .unwrap()
        .map(Result::unwrap)
        .collect();
    assert_eq!(rows[0].0, 7);
    assert_eq!((rows[1].1, rows[1].2, rows[1].3.as_str()), (8.0, 4.0, "m"));
    let box_of: Vec<f64> =
        rows[1].4[8..40].as_chunks().0.iter().map(|&end| f64::from_le_bytes(end)).collect();
    assert_eq!(box_of, [500_020.0, 500_022.0, 5_500_000.0, 5_500_002.0]);
    let of = |sql: &str| package.query_row(sql, [], |row| row.get::<_, String>(0)).unwrap();
    names(
        &of("SELECT definition FROM gpkg_spatial_ref_sys WHERE srs_id = 25832"),
        &["UTM zone 32N"],
    );
    assert_eq!(
        of("SELECT srs_id || geometry_type_name FROM gpkg_geometry_columns"),
        "25832MULTIPOLYGON"
    );
    for name in ["treeID-7.stl", "treeID-9.stl"] {
        assert!(f.join("trees").join(name).exists(), "{name}");
    }
    names(&ok(f, &by), &["group     7: 9 points, 8 m³", "9 have no treeID", "the same for all"]);
    // Without an α, that of all points; classes are groups, too, and so are columns of a table.
    let found = told(f, &["shape", "tile.laz", "--by", "class"]);
    assert_eq!(found["groups"].as_array().unwrap().len(), 3);
    assert_eq!(found["alpha"]["origin"], "auto");
    let rows = "x,y,z,label,size\n0,0,0,1,.5\n1,0,0,1,2\n0,1,0,1,2\n0,0,1,1,2\n5,5,5,2,2\n";
    fs::write(f.join("t.csv"), rows).unwrap();
    let table = told(f, &["shape", "t.csv", "--by", "label", "--alpha", "inf"]);
    assert_eq!(table["groups"][0]["volume"], json!(1.0 / 6.0));
    assert_eq!(
        (&table["groups"][1]["points"], &table["groups"][1]["volume"]),
        (&json!(1), &json!(0.0))
    );
    // What is kept of a group is all that is told of it: here a tetrahedron, of two of different sizes.
    let corners = |x: f64, size: f64| {
        format!("{x},0,0,1\n{},0,0,1\n{x},{size},0,1\n{x},0,{size},1\n", x + size)
    };
    fs::write(f.join("two.csv"), format!("x,y,z,id\n{}{}", corners(0.0, 1.0), corners(9.0, 2.0)))
        .unwrap();
    let of = |keep: &[&str]| {
        let by = ["shape", "two.csv", "--by", "id", "--alpha", "4", "-o", "two.geojson"];
        told(f, &[&by[..], keep].concat())["groups"][0].clone()
    };
    let whole = of(&[]);
    assert_eq!((&whole["points"], &whole["outline_area"]), (&8.into(), &2.5.into()));
    let kept = of(&["--keep", "1"]);
    assert_eq!((&kept["points"], &kept["outline_area"]), (&4.into(), &2.0.into()));
    assert_eq!((&kept["low"][0], &kept["height"]), (&9.0.into(), &2.0.into()));
    let nothing = of(&["--min-volume", "5"]);
    assert_eq!((&nothing["points"], &nothing["outline_area"]), (&0.into(), &0.0.into()));
    fails(f, 2, "shape two.csv --by id --exterior -o two.csv.csv", &["--exterior has no effect"]);
    fails(f, 1, "shape t.csv --by nope", &["no column nope", "x, y, z, label, size"]);
    fails(f, 1, "shape t.csv --by size", &["has 0.5 at point 0, and 1 numbers"]);
    fails(f, 2, "shape t.csv --by label -o t.ply", &["makes a shape for each value", ".geojson"]);
    fails(f, 2, "shape t.csv --by label --mesh ply -o t2.csv", &["--mesh has no effect"]);
    fails(f, 2, "shape sample:phantom@8 --by label", &["holds a volume", "--each-label"]);
    fails(f, 2, "shape t.csv --by label --each-label -o x", &["--each-label"]);
}

/// The database of a `GeoPackage`.
fn package(path: &Path) -> rusqlite::Connection {
    let package = rusqlite::Connection::open(path).unwrap();
    let number: i64 = package.query_row("PRAGMA application_id", [], |row| row.get(0)).unwrap();
    assert_eq!(number, i64::from(u32::from_be_bytes(*b"GPKG")));
    let wrong: String = package.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
    assert_eq!(wrong, "ok");
    package
}

/// Each polygon is a feature, in longitude and latitude, and points of space are seen from above.
#[test]
fn outlines_lie_on_the_earth() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let args = ["shape", "tile.laz", "--class", "4,5", "--flat", "--alpha-radius", "2", "-o"];
    let (code, _, said) = run(f, &[&args[..], &["a.geojson", "a.wkt"]].concat());
    assert_eq!(code, 0, "{said}");
    assert!(!said.contains("coordinates are those"), "{said}");
    let made: Value = serde_json::from_slice(&fs::read(f.join("a.geojson")).unwrap()).unwrap();
    let [first, second] = made["features"].as_array().unwrap().as_slice() else { panic!("{made}") };
    for feature in [first, second] {
        assert_eq!(feature["geometry"]["type"], "Polygon");
        let properties = &feature["properties"];
        assert_eq!((&properties["area"], &properties["perimeter"]), (&json!(4.0), &json!(8.0)));
        assert_eq!(properties["unit"], "m");
        assert_eq!(feature["geometry"]["coordinates"][0][0].as_array().unwrap().len(), 2);
    }
    names(&fs::read_to_string(f.join("a.wkt")).unwrap(), &["500020 5500000"]);
    fs::write(f.join("t.csv"), "x,y\n0,0\n1,0\n0,1\n").unwrap();
    let (_, _, said) = run(f, &["shape", "t.csv", "--alpha", "inf", "-o", "t.geojson"]);
    names(&said, &["coordinates are those of the points, as their coordinate system is not known"]);
    let (_, _, said) = run(f, &["shape", "t.csv", "--alpha", "inf", "-o", "t.gpkg"]);
    names(&said, &["the coordinate system of the points is not known"]);
    let areas = package(&f.join("t.gpkg"));
    let (area, system): (f64, i32) = areas
        .query_row("SELECT area, srs_id FROM polygons, gpkg_contents", [], |row| {
            Ok((row.get(0)?, row.get(1)?))
        })
        .unwrap();
    assert_eq!((area, system), (0.5, -1));
    fails(f, 2, "shape sample:phantom@8 --flat -o a.svg", &["--flat has no effect"]);
}

/// Scans are coloured by class, tables are plain.
#[test]
#[cfg(feature = "render")]
fn pictures_of_scans_have_colours() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    tile(&f.join("tile.laz"));
    let picture = |colour: &[&str]| {
        let args = ["shape", "tile.laz", "--alpha", "9", "--size", "80x60", "-o", "a.png"];
        ok(f, &[&args[..], colour].concat());
        let picture = image::open(f.join("a.png")).unwrap().to_rgb8();
        picture.pixels().map(|pixel| pixel.0).collect::<Vec<_>>()
    };
    let default = picture(&[]);
    assert_eq!(default, picture(&["--colour", "asprs"]));
    // High vegetation is green, and the scan is red.
    assert!(default.iter().any(|[r, g, b]| *g > r + 30 && *g > b + 30));
    assert!(picture(&["--colour", "rgb"]).iter().any(|[r, g, b]| *r > g + 60 && *r > b + 60));
    assert_ne!(picture(&["--colour", "height"]), picture(&["--colour", "plain"]));
    fs::write(f.join("t.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n").unwrap();
    fails(f, 1, "shape t.csv --colour rgb -o t.png", &["no column red"]);
}
