//! A small laser scan of our own: ground, a roof and trees, with what a file of a scanner knows about them.

use std::collections::BTreeMap;
use std::path::Path;

use walpha_base::advice::Setting;
use walpha_volume::{Coordinates, LengthUnit, Reason};

use super::read::format;
use super::{
    Column, ColumnSummary, Crs, Flags, ModelMetadata, PointOptions, Points, PointsError,
    ScanSummary,
};

/// Its name.
pub(crate) const TILE: &str = "sample:tile";

/// The side of the tile, in metres, and its corner in UTM zone 32.
const SIDE: f64 = 60.0;
const CORNER: [f64; 2] = [691_000.0, 5_334_000.0];
/// The corners of the roof.
const ROOF: [[f64; 2]; 2] = [[8.0, 10.0], [26.0, 22.0]];
/// The places of the trees, and their radii.
const TREES: [([f64; 2], f64); 5] = [
    ([44.0, 12.0], 5.0),
    ([50.0, 26.0], 4.0),
    ([38.0, 44.0], 6.0),
    ([16.0, 40.0], 3.0),
    ([8.0, 52.0], 4.0),
];
/// The codes of the classes.
const GROUND: f64 = 2.0;
const TREE: f64 = 5.0;
const BUILDING: f64 = 6.0;

/// A point, its class, the number of its tree, and its intensity.
type Row = ([f64; 3], f64, f64, f64);

/// 60 m × 60 m: ground with two hollows and no points below the roof of a house (class 6), and the crowns of five trees (class 5,
/// numbered by `treeID`). Coordinates are metres in ETRS89 / UTM zone 32N, rounded to millimetres as scanners do.
pub(crate) fn tile(options: &PointOptions) -> Result<(Points, ModelMetadata), PointsError> {
    let all = rows();
    let mut classes: BTreeMap<u8, u64> = BTreeMap::new();
    all.iter().for_each(|(_, class, ..)| *classes.entry(*class as u8).or_default() += 1);
    let is_read = |class: f64| {
        options.classes.as_ref().is_none_or(|classes| classes.contains(&(class as u8)))
    };
    let rows: Vec<&Row> = all.iter().filter(|(_, class, ..)| is_read(*class)).collect();
    if rows.is_empty() {
        let what = "has no points of these classes; it has points of 2 (ground), 5 (high vegetation), 6 (building)";
        return Err(format(
            Path::new(TILE),
            Reason::choice(
                Setting::Class,
                what.to_owned(),
                "choose among these, or read all".into(),
            ),
        ));
    }
    let column = |name: &str, pick: fn(&Row) -> f64| Column {
        name: name.to_owned(),
        values: rows.iter().map(|row| pick(row)).collect(),
    };
    let columns = vec![
        column("intensity", |row| row.3),
        column("classification", |row| row.1),
        column("treeID", |row| row.2),
    ];
    let kinds = ["uint16", "uint8", "int32"];
    let summaries: Vec<ColumnSummary> =
        columns.iter().zip(kinds).map(|(column, kind)| column.summary(kind)).collect();
    let scan = ScanSummary {
        version: "1.4".into(),
        point_format: 6,
        compressed: false,
        returns: BTreeMap::from([(1, all.len() as u64)]),
        classes,
        flags: Flags::default(),
        time: None,
        time_of: "GPS week",
    };
    let crs = Crs {
        epsg: Some(25832),
        name: Some("ETRS89 / UTM zone 32N".into()),
        unit: Some("metre".into()),
        length: LengthUnit::Metre,
        ..Crs::default()
    };
    let points = Points {
        positions: rows.iter().map(|row| row.0).collect(),
        values: Some(rows.iter().map(|row| row.3).collect()),
        columns,
        ..Points::default()
    };
    let metadata = ModelMetadata::default()
        .coordinates(Coordinates { unit: LengthUnit::Metre, ..Coordinates::default() })
        .crs(Some(crs))
        .scan(Some(scan))
        .columns(summaries);
    Ok((points, metadata))
}

/// All points: ground and roof, then tree by tree.
fn rows() -> Vec<Row> {
    let place = |x: f64, y: f64, z: f64| {
        let rounded = |x: f64| (x * 1000.0).round() / 1000.0;
        [CORNER[0] + x, CORNER[1] + y, 520.0 + z].map(rounded)
    };
    let height = |x: f64, y: f64| {
        let hollow = |t: f64| 4.0 * t * (1.0 - t);
        2.0 * hollow(x / SIDE) - 3.0 * hollow(y / SIDE) * (x / SIDE - 0.5)
    };
    let mut rows = Vec::new();
    for k in 0..9000 {
        let [x, y, _] = spread(k).map(|t| SIDE * t);
        let [low, high] = ROOF;
        if low[0] < x && x < high[0] && low[1] < y && y < high[1] {
            let slope = (y - f64::midpoint(low[1], high[1])).abs();
            rows.push((place(x, y, 9.0 - slope / 2.0), BUILDING, f64::NAN, 300.0));
        } else {
            rows.push((place(x, y, height(x, y)), GROUND, f64::NAN, 120.0));
        }
    }
    for (number, ([x, y], radius)) in (1u8..).zip(TREES) {
        let base = height(x, y) + 2.0;
        for k in 0..(40.0 * radius * radius) as u32 {
            let ball = spread(k).map(|t| 2.0 * t - 1.0);
            if ball.iter().map(|t| t * t).sum::<f64>() <= 1.0 {
                let [dx, dy, dz] = ball.map(|t| radius * t);
                let high = place(x + dx, y + dy, base + radius + dz);
                rows.push((high, TREE, f64::from(number), 60.0 + 20.0 * f64::from(number)));
            }
        }
    }
    rows
}

/// Point k of a sequence that fills a cube evenly: multiples of the powers of 1/φ₃, where φ₃⁴ = φ₃ + 1 (M. Roberts, 2018).
fn spread(k: u32) -> [f64; 3] {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let step = [1.0 / ROOT, 1.0 / (ROOT * ROOT), 1.0 / (ROOT * ROOT * ROOT)];
    step.map(|step| (0.5 + step * f64::from(k + 1)).fract())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Attributes;

    #[test]
    fn the_tile_is_a_scan() {
        let (points, facts) = tile(&PointOptions::default()).unwrap();
        let scan = facts.scan.unwrap();
        assert_eq!(scan.classes.values().sum::<u64>(), points.len() as u64);
        assert_eq!(scan.classes.keys().collect::<Vec<_>>(), [&2, &5, &6]);
        let trees = points.column("treeID").unwrap();
        assert_eq!(
            trees.iter().filter(|tree| !tree.is_nan()).fold(0.0, |a: f64, &b| a.max(b)),
            5.0
        );
        let options = PointOptions::default().classes(Some(vec![5]));
        let (crowns, _) = tile(&options).unwrap();
        assert_eq!(crowns.len() as u64, scan.classes[&5]);
        assert!(tile(&PointOptions::default().classes(Some(vec![9]))).is_err());
        // By its name, only the columns that are asked for.
        let named = Attributes::Named(vec!["class".into()]);
        let (points, _) = options.attributes(named).made(TILE).unwrap().unwrap();
        assert_eq!(points.columns.len(), 1);
        assert!(points.column("class").unwrap().iter().all(|&class| class == 5.0));
    }
}
