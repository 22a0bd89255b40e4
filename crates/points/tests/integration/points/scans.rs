//! LAS, as other programs write it.

use std::path::Path;

use las::point::Format;
use las::{Builder, Point, Vlr, Writer};

use super::*;
use walpha_points::colours::scan_colours;

/// Three points with extra bytes: the names of floats that are described, and the floats of each point.
fn write<const N: usize>(path: &Path, names: &[&str], numbers: [[f32; N]; 3]) {
    const FLOAT: u8 = 9;
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(6).unwrap();
    builder.point_format.extra_bytes = 4 * N as u16;
    let mut data = vec![0; 192 * names.len()];
    for (one, name) in data.chunks_mut(192).zip(names) {
        one[2] = FLOAT;
        one[4..4 + name.len()].copy_from_slice(name.as_bytes());
    }
    let description = String::new();
    builder.vlrs.push(Vlr { user_id: "LASF_Spec".into(), record_id: 4, description, data });
    let mut writer = Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    for (k, numbers) in numbers.into_iter().enumerate() {
        let extra_bytes = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let (x, gps_time) = (k as f64, Some(0.0));
        writer
            .write_point(Point { x, gps_time, intensity: 7, extra_bytes, ..Point::default() })
            .unwrap();
    }
    writer.close().unwrap();
}

/// The rule of all formats: weights and radii by their names, in any letter case.
#[test]
fn extra_bytes_are_weights_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.las");
    let read = || {
        let options = PointOptions::default().attributes(Attributes::All);
        let points = read_model(&path, &options).unwrap().0;
        let names: Vec<String> = points.columns.iter().map(|column| column.name.clone()).collect();
        (points, names)
    };
    for (name, of_radii) in
        [("Weight", false), ("weight", false), ("radius", true), ("RADIUS", true)]
    {
        write(&path, &[name], [[1.0], [2.0], [3.0]]);
        let (points, names) = read();
        let expected = if of_radii { [1.0, 4.0, 9.0] } else { [1.0, 2.0, 3.0] };
        assert_eq!(
            (points.weights, points.of_radii),
            (Some(expected.to_vec()), of_radii),
            "{name}"
        );
        assert_eq!(points.values, Some(vec![7.0; 3]));
        assert!(
            names.iter().any(|name| name == "intensity")
                && !names.iter().any(|other| other == name)
        );
    }
    write(&path, &["radius", "weight"], [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0]]);
    assert_eq!(read().0.weights, Some(vec![5.0, 6.0, 7.0]));
    write(&path, &["Value", "height"], [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0]]);
    let (points, names) = read();
    assert_eq!((points.values, points.weights), (Some(vec![1.0, 2.0, 3.0]), None));
    assert!(names.iter().any(|name| name == "height"));
    assert_eq!(points.positions[2], [2.0, 0.0, 0.0]);
    write(&path, &["radius"], [[1.0], [-2.0], [3.0]]);
    let told = read_points(&path, None).unwrap_err().told();
    assert!(told.contains("row 1: radius is -2"), "{told}");
}

#[test]
fn descriptions_of_more_bytes_than_there_are_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.las");
    write(&path, &["a", "b"], [[1.0], [2.0], [3.0]]);
    let told = read_points(&path, None).unwrap_err().told();
    assert!(told.contains("describes 8 extra bytes of each point, but a point has 4"), "{told}");
}

/// LAS asks for 16 bits; what LAS has with 8 stays as it is.
#[test]
fn colours_of_8_bits_become_ones_of_16() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let all = PointOptions::default().attributes(Attributes::All);
    let convert = |from: &str, to: &str| {
        let (points, metadata) = read_model(path(from), &all).unwrap();
        let Points { positions, columns, .. } = points;
        let weights = vec![0.0; positions.len()];
        let points = WeightedPoints::new(positions, weights).unwrap();
        let mut file = std::fs::File::create(path(to)).unwrap();
        let writer = PointWriter::of(path(to)).unwrap();
        writer.write_model(&points, &columns, &metadata, &Packing::default(), &mut file).unwrap();
        read_model(path(to), &all).unwrap().0.columns
    };
    std::fs::write(path("a.csv"), "x,y,z,Red,Green,Blue\n0,0,0,255,0,1\n1,0,0,7,128,254\n")
        .unwrap();
    let wide = [[255, 0, 1], [7, 128, 254]];
    let columns = convert("a.csv", "a.las");
    let red = columns.iter().find(|column| column.name == "red").unwrap();
    assert_eq!(red.values, [65_535.0, 1799.0]);
    assert_eq!(scan_colours(&columns), Some(wide.to_vec()));
    let mut writer = Writer::from_path(path("narrow.las"), {
        let mut builder = Builder::from((1, 4));
        builder.point_format = Format::new(7).unwrap();
        builder.into_header().unwrap()
    })
    .unwrap();
    let color = Some(las::Color::new(255, 3, 0));
    writer.write_point(Point { gps_time: Some(0.0), color, ..Point::default() }).unwrap();
    writer.close().unwrap();
    assert_eq!(
        convert("narrow.las", "again.las"),
        read_model(path("narrow.las"), &all).unwrap().0.columns
    );
}

#[cfg(unix)]
#[test]
fn pipes_are_refused_for_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.las");
    write(&path, &["a"], [[1.0], [2.0], [3.0]]);
    let bytes = std::fs::read(&path).unwrap();
    let pipe = folder.path().join("pipe.laz");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let to = pipe.clone();
    // Nobody may read what is written.
    let writer = std::thread::spawn(move || drop(std::fs::write(to, bytes)));
    let told = read_points(&pipe, None).unwrap_err().told();
    writer.join().unwrap();
    assert!(told.contains("is not an ordinary file") && told.contains("LAZ"), "{told}");
}
