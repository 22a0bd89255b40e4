//! Points as `.wvm`: what is written comes back.

mod damaged;
mod kept;

use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use walpha_points::{
    ModelMetadata, Packing, PointOptions, PointWriter, SampleGrid, Units, WeightedPoints,
    read_model, read_points,
};
use walpha_shape::Alpha;
use walpha_volume::{Coordinates, Dims, Frame, GrayRange, LengthUnit, Space};

use crate::Told;

fn written(points: &WeightedPoints, facts: &ModelMetadata, packing: Packing) -> Vec<u8> {
    let mut bytes = Vec::new();
    let writer = PointWriter::of("m.wvm").unwrap();
    writer.write_model(points, &[], facts, &packing, &mut bytes).unwrap();
    bytes
}

fn save(folder: &Path, bytes: &[u8]) -> PathBuf {
    let path = folder.join("m.wvm");
    fs::write(&path, bytes).unwrap();
    path
}

/// The content of a file, without its last `level` layers.
fn back(bytes: &[u8], level: u32) -> (WeightedPoints, ModelMetadata) {
    let folder = tempfile::tempdir().unwrap();
    let (points, facts) =
        read_model(save(folder.path(), bytes), &PointOptions::default().level(level)).unwrap();
    let weighted = WeightedPoints::new(points.positions, points.weights.unwrap()).unwrap();
    (weighted.with_values(points.values).unwrap(), facts)
}

fn refused(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    read_points(save(folder.path(), bytes), None).unwrap_err().told()
}

/// Numbers that look like chance: those of which the kept files are made.
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}

/// Points on about one in `one_in` samples, in the order of the samples.
fn scattered(dims: [u32; 3], one_in: u64, value: impl Fn(&mut Chance) -> f64) -> WeightedPoints {
    let mut chance = Chance(7);
    let (mut positions, mut values) = (Vec::new(), Vec::new());
    for z in 0..dims[2] {
        for y in 0..dims[1] {
            for x in 0..dims[0] {
                if chance.below(one_in) == 0 {
                    positions.push([x, y, z].map(f64::from));
                    values.push(value(&mut chance));
                }
            }
        }
    }
    WeightedPoints::unweighted(positions).with_values(values).unwrap()
}

fn grid(dims: [u64; 3]) -> SampleGrid {
    let [x, y, z] = dims;
    let dims = Dims::new(x, y, z).unwrap();
    SampleGrid { dims, frame: Frame::VOXEL, units: Units::Voxel }
}

#[test]
fn recipes_of_any_length_are_kept() {
    let points = scattered([6, 6, 6], 5, |chance| chance.below(50) as f64);
    let with = |length: usize| {
        let facts = ModelMetadata::default().grid(grid([6, 6, 6]));
        let recipe: String = (0..length).map(|k| char::from(b'a' + (k % 26) as u8)).collect();
        (written(&points, &facts.recipe(Some(recipe.clone())), Packing::default()), recipe)
    };
    for length in [1, 40_000, usize::from(u16::MAX), 1_000_000] {
        let (bytes, recipe) = with(length);
        assert_eq!(bytes[8], 1, "{length}");
        let (again, facts) = back(&bytes, 0);
        assert!(facts.recipe == Some(recipe), "{length}");
        assert_eq!((again.positions(), again.values()), (points.positions(), points.values()));
    }
    let (bytes, _) = with(100_000);
    for end in [9, 12, 17, 18, 300, usize::from(u16::MAX)] {
        let error = refused(&bytes[..end]);
        assert!(error.contains("ends within"), "{end}: {error}");
    }
    let mut damaged = bytes.clone();
    damaged[40_000] ^= 1;
    assert!(refused(&damaged).contains("damaged"));
    let mut endless = bytes;
    endless[9..17].fill(u8::MAX);
    assert!(refused(&endless).contains("ends within"));
}

/// CRC-32 of IEEE 802.3, bit by bit.
fn checksum(bytes: &[u8]) -> [u8; 4] {
    let mut register = u32::MAX;
    for byte in bytes {
        register ^= u32::from(*byte);
        for _ in 0..8 {
            register = (register >> 1) ^ (0xEDB8_8320 * (register & 1));
        }
    }
    (!register).to_le_bytes()
}

#[test]
fn whole_values_come_back_bit_for_bit() {
    for (dims, one_in) in [([13, 9, 21], 3), ([40, 40, 40], 16), ([1, 1, 97], 5), ([5, 70, 1], 2)] {
        let points = scattered(dims, one_in, |chance| chance.below(256) as f64 - 20.0);
        assert!(points.len() > 10);
        let facts = ModelMetadata::default().grid(grid(dims.map(u64::from)));
        let bytes = written(&points, &facts, Packing::default());
        assert_eq!(back(&bytes, 0), (points.clone(), facts.clone()), "{dims:?}");
        assert!(bytes.len() < 2 * points.len() + 206, "{} of {}", bytes.len(), points.len());
        // Points at whole numbers need no grid that is told.
        let (again, told) =
            back(&written(&points, &ModelMetadata::default(), Packing::default()), 0);
        assert_eq!(again, points);
        assert!(told.grid.is_some());
    }
}

#[test]
fn everything_that_is_known_comes_back() {
    let mut points = scattered([9, 8, 7], 4, |chance| chance.below(1 << 40) as f64 / 7.0);
    let turned = [[0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [0.8, 0.0, -0.6]];
    let coordinates = Coordinates { space: Space::Lps, unit: LengthUnit::Millimetre };
    let frame = Frame {
        origin: [-31.7, 0.1, 1e4],
        spacing: [0.3, 0.7, 1.1],
        direction: turned,
        coordinates,
    };
    let grid = SampleGrid { frame, units: Units::World, ..grid([9, 8, 7]) };
    for position in points.positions_mut() {
        *position = grid.position(position.map(|x| x as u32));
    }
    for (k, weight) in points.weights_mut().iter_mut().enumerate() {
        *weight = (k as f64).sqrt() - 3.0;
    }
    let facts = ModelMetadata::default()
        .grid(grid)
        .coordinates(coordinates)
        .alpha(Alpha::from_squared(2.1).unwrap())
        .range(GrayRange { low: -1024.0, high: 3071.5 })
        .order(None);
    let on_grid = written(&points, &facts, Packing::default());
    assert_eq!(back(&on_grid, 0), (points.clone(), facts.clone()));
    // Off the grid, or twice at one place: in their order, and larger.
    for other in [[0.25, 0.0, 0.0], points.positions()[3]] {
        let mut moved = points.clone();
        moved.positions_mut()[0] = other;
        let bytes = written(&moved, &facts, Packing::default().value_error(0.5).layers(3));
        let (again, told) = back(&bytes, 0);
        assert_eq!((again, told.alpha, told.grid), (moved, facts.alpha, None));
        assert!(bytes.len() > on_grid.len());
    }
    let points = points.with_values(None).unwrap();
    assert_eq!(back(&written(&points, &facts, Packing::default()), 0).0, points);
}

#[test]
fn values_are_within_the_error_asked_for() {
    let points = scattered([30, 30, 30], 9, |chance| chance.below(1 << 20) as f64 / 4099.0 - 99.0);
    let mut last = usize::MAX;
    for error in [0.01, 0.5, 3.0, 40.0] {
        let packing = Packing::default().value_error(error);
        let bytes = written(&points, &ModelMetadata::default(), packing);
        let (again, _) = back(&bytes, 0);
        assert_eq!(again.positions(), points.positions());
        let pairs = points.values().into_iter().flatten().zip(again.values().into_iter().flatten());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= error * (1.0 + 1e-12) && worst > error / 2.0, "{worst} for {error}");
        assert!(bytes.len() < last);
        last = bytes.len();
    }
}

#[test]
fn a_grid_has_samples_where_they_are() {
    let grid = grid([3, 4, 5]);
    assert_eq!(grid.sample_at([2.0, 3.0, 4.0]), Some([2, 3, 4]));
    for off in [[3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [f64::NAN; 3]]
    {
        assert_eq!(grid.sample_at(off), None, "{off:?}");
    }
}

#[test]
fn degenerate_sets_come_back() {
    let full = |dims: [u32; 3], value: f64| scattered(dims, 1, |_| value);
    let mut far = vec![[0.0; 3], [1624.0; 3], [1624.0, 0.0, 1.0], [3.0, 1500.0, 1000.0]];
    far.sort_by(|a, b| [a[2], a[1], a[0]].partial_cmp(&[b[2], b[1], b[0]]).unwrap());
    let far = WeightedPoints::new(far, vec![2.5; 4]).unwrap();
    let far = far.with_values(vec![0.0, 4e9, 1.0, 4e9]).unwrap();
    let long = WeightedPoints::unweighted(vec![[7.0, 0.0, 0.0], [3_999_999_999.0, 0.0, 0.0]]);
    let one = full([1, 1, 1], -5.0);
    for points in [full([31, 17, 12], 3.0), full([64, 64, 64], 255.0), one, far, long] {
        let bytes = written(&points, &ModelMetadata::default(), Packing::default());
        assert_eq!(back(&bytes, 0).0, points);
        assert!(64 * bytes.len() >= points.len(), "a byte holds 64 points at most");
    }
    let empty = WeightedPoints::default();
    assert!(
        refused(&written(&empty, &ModelMetadata::default(), Packing::default()))
            .contains("no point")
    );
}

#[test]
fn the_first_layers_are_the_most_important_points() {
    let points = scattered([20, 21, 22], 7, |chance| chance.below(100) as f64);
    let count = points.len();
    // Every third point first, then the others.
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_by_key(|&k| (k % 3, k));
    let facts = ModelMetadata::default().order(order.clone());
    let bytes = written(&points, &facts, Packing::default().layers(3));
    assert_eq!(back(&bytes, 0).0, points);
    for (level, part) in [(1, 4), (2, 16)] {
        let mut wanted = order[..count / part].to_vec();
        wanted.sort_unstable();
        let of = |column: &[f64]| wanted.iter().map(|&k| column[k as usize]).collect();
        let positions = wanted.iter().map(|&k| points.positions()[k as usize]).collect();
        let expected = WeightedPoints::new(positions, of(points.weights())).unwrap();
        let expected = expected.with_values(of(points.values().unwrap())).unwrap();
        assert_eq!(back(&bytes, level).0, expected);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = save(folder.path(), &bytes);
    let error = read_model(&path, &PointOptions::default().level(3)).unwrap_err().told();
    assert!(error.contains("has 3 levels") && error.contains("from 0 to 2"), "{error}");
    // A file that ends within its last layer still has the others.
    let path = save(folder.path(), &bytes[..bytes.len() - 3]);
    let error = read_points(&path, None).unwrap_err().told();
    assert!(
        error.contains("2 of its 3 layers are whole") && error.contains("`level` 1"),
        "{error}"
    );
    assert_eq!(read_model(&path, &PointOptions::default().level(1)).unwrap().0.len(), count / 4);
    fs::write(folder.path().join("m.csv"), "x,y,z\n0,0,0\n").unwrap();
    let error = read_model(folder.path().join("m.csv"), &PointOptions::default().level(1))
        .unwrap_err()
        .told();
    assert!(error.contains("no layers") && error.contains("omit `level`"), "{error}");
}
proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn any_set_on_a_grid_comes_back(
        cells in prop::collection::btree_map([0u32..9, 0u32..13, 0u32..40], 0u32..3000, 1..200),
        layers in 1u8..4,
    ) {
        // A map sorts by its keys: z first.
        let positions = cells.keys().map(|&[z, y, x]| [x, y, z].map(f64::from)).collect();
        let values: Vec<f64> = cells.values().map(|&value| f64::from(value)).collect();
        let points = WeightedPoints::new(positions, vec![1.0; cells.len()]).unwrap();
        let points = points.with_values(values).unwrap();
        let order: Vec<u32> = (0..cells.len() as u32).rev().collect();
        let facts = ModelMetadata::default().order(order);
        let bytes = written(&points, &facts, Packing::default().layers(layers));
        prop_assert_eq!(back(&bytes, 0).0, points);
    }
}
