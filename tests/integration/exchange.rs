//! Points chosen on a triangulation that changes, held against triangulations made from the start.

use std::collections::{BTreeMap, HashSet};

use ndarray::Array3;
use proptest::prelude::*;
use walpha::interpolate::{
    Adaptive, Deviation, Grid, Interpolant, Refit, adaptive_voxels, exchange, refit,
};
use walpha::shape::{Class, Engine, ShapeOptions};
use walpha::volume;
use walpha::{Alpha, AlphaShape, Frame, Units, Volume, WeightedPoints, alpha_shape};

use crate::common::{has_skull, json, names, ok, run};

fn whole(volume: &Volume, voxels: &[u32], units: Units) -> AlphaShape {
    let positions = voxels.iter().map(|&v| units.position(volume, v)).collect();
    let values: Vec<f64> = voxels.iter().map(|&v| volume.as_slice()[v as usize].into()).collect();
    let points = WeightedPoints::unweighted(positions).with_values(values).unwrap();
    let options = ShapeOptions::new(Alpha::INFINITE).engine(Engine::Native);
    alpha_shape(points, &options).unwrap()
}

/// Samples in few gray levels, so that errors are often equal, in a frame that may be rounded, tilted and mirrored.
fn steps(seed: u32, spacing: [f64; 3], mirrored: bool) -> Volume {
    let samples = Array3::from_shape_fn((7, 8, 9), |(z, y, x)| {
        let mixed = ((x / 3 + 5 * (y / 3) + 17 * (z / 2)) as u32 ^ seed).wrapping_mul(0x9e37_79b9);
        ((mixed >> 20) % 8) as f32 * 16.0
    });
    let mut frame = Frame { spacing, origin: [0.7, -3.1, 0.2], ..Frame::VOXEL };
    if mirrored {
        frame.direction = [[0.8, 0.6, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, 1.0]];
    }
    Volume::new(samples, frame).unwrap()
}

/// The first cell that a sample lies in, by determinants of indices: in the world, coordinates are rounded.
fn cell_of(shape: &AlphaShape, volume: &Volume, voxels: &[u32], sample: u32) -> Option<[u32; 4]> {
    let [nx, ny, _] = volume.dims().xyz().map(|n| n as i64);
    let index = |v: u32| [i64::from(v) % nx, i64::from(v) / nx % ny, i64::from(v) / (nx * ny)];
    let place = index(sample);
    let holds = |cell: &&[u32; 4]| {
        let corners = cell.map(|vertex| index(voxels[vertex as usize]));
        let with = |k: usize| {
            let mut corners = corners;
            corners[k] = place;
            det(&corners)
        };
        // In a mirrored frame all of them are negative.
        let sign = det(&corners).signum();
        sign != 0 && (0..4).all(|k| sign * with(k) >= 0)
    };
    shape.complex().cells.of(Class::Interior).find(holds).copied()
}

/// Six times the volume of a simplex, with its sign.
fn det([a, rest @ ..]: &[[i64; 3]; 4]) -> i64 {
    let [u, v, w] = rest.map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
    u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)
}

/// The adaptive selection of the documentation, triangulating from the start in each batch.
fn by_definition(volume: &Volume, goal: &Adaptive, units: Units) -> Vec<u32> {
    let [nx, ny, nz] = volume.dims().xyz();
    let at = |x: usize, y: usize, z: usize| (x + nx * (y + ny * z)) as u32;
    let ends = |n: usize| [0, n - 1];
    let mut voxels: Vec<u32> = ends(nz)
        .into_iter()
        .flat_map(|z| ends(ny).into_iter().flat_map(move |y| ends(nx).map(|x| at(x, y, z))))
        .collect();
    let grid = Grid::of(volume, units);
    loop {
        let shape = whole(volume, &voxels, units);
        let interpolant = Interpolant::new(&shape).unwrap();
        let resampled = interpolant.resample(&grid).unwrap();
        let deviation = Deviation::of(volume, &resampled);
        let (rmse, max) = (deviation.rmse.unwrap(), deviation.max.unwrap());
        let room = goal.count as usize - voxels.len();
        let batch = ((voxels.len() as f64 * 0.2).ceil() as usize).max(32).min(room);
        if rmse <= goal.rmse || goal.max_error.is_some_and(|b| max <= b) || batch == 0 {
            return voxels;
        }
        // For each cell, the squared error of its samples, and its worst sample.
        let mut cells: BTreeMap<[u32; 4], (u64, f32, u32)> = BTreeMap::new();
        for voxel in 0..volume.dims().samples() as u32 {
            let f = volume.as_slice()[voxel as usize];
            let error = (f - resampled.volume().as_slice()[voxel as usize]).abs();
            let Some(cell) = cell_of(&shape, volume, &voxels, voxel) else { continue };
            if error <= 0.0 || goal.max_error.is_some_and(|b| f64::from(error) <= b) {
                continue;
            }
            let cell = cells.entry(cell).or_insert((0, 0.0, 0));
            if goal.max_error.is_none() {
                cell.0 += ((f64::from(error) / max).powi(2) * 2f64.powi(31)) as u64;
            }
            if error > cell.1 {
                (cell.1, cell.2) = (error, voxel);
            }
        }
        let mut ranked: Vec<(u64, f32, u32)> = cells.into_values().collect();
        ranked.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
        let mut joining: Vec<u32> = Vec::new();
        let index = |v: u32| [v as usize % nx, v as usize / nx % ny, v as usize / (nx * ny)];
        for (_, _, voxel) in ranked {
            let near = |&other: &u32| (0..3).all(|k| index(other)[k].abs_diff(index(voxel)[k]) < 2);
            if joining.len() < batch && !joining.iter().any(near) {
                joining.push(voxel);
            }
        }
        voxels.extend(&joining);
        if joining.is_empty() || voxels.len() as u64 == goal.count {
            return voxels;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn growing_chooses_what_starting_again_chooses(
        seed in 0..1000u32, world in any::<bool>(), bound in prop::option::of(5.0..40.0f64),
        spacing in prop_oneof![Just([1.0, 1.0, 1.0]), Just([0.5, 2.0, 0.25]), Just([0.3, 0.7, 1.1])],
        mirrored in any::<bool>(),
    ) {
        let volume = steps(seed, spacing, mirrored);
        let units = if world { Units::World } else { Units::Voxel };
        let goal = Adaptive::new(200).max_error(bound);
        let ours = adaptive_voxels(&volume, &goal, units).unwrap();
        prop_assert_eq!(ours, by_definition(&volume, &goal, units));
    }
}

fn error_of(volume: &Volume, voxels: &[u32]) -> f64 {
    let shape = whole(volume, voxels, Units::Voxel);
    let fitted = refit(&shape, volume, Units::Voxel, Refit::Whole).unwrap();
    let interpolant = Interpolant::with_values(&shape, &fitted.values).unwrap();
    let resampled = interpolant.resample(&Grid::of(volume, Units::Voxel)).unwrap();
    Deviation::of(volume, &resampled).rmse.unwrap()
}

#[test]
fn exchanged_points_are_as_many_and_better() {
    let volume = volume::phantom(24).unwrap();
    let goal = Adaptive::new(500);
    let chosen = adaptive_voxels(&volume, &goal, Units::Voxel).unwrap();
    let exchanged = exchange(&volume, &chosen, Units::Voxel).unwrap();
    let set: HashSet<u32> = exchanged.iter().copied().collect();
    assert_eq!((set.len(), exchanged.len()), (500, 500));
    let corner = |i: usize| (23 * (i & 1) + 24 * 23 * (i >> 1 & 1) + 576 * 23 * (i >> 2)) as u32;
    assert!((0..8).all(|i| set.contains(&corner(i))));
    let [before, after] = [&chosen, &exchanged].map(|voxels| error_of(&volume, voxels));
    assert!(after < 0.95 * before, "{before} {after}");
    // The voxels that stay come first, in their order.
    let kept = exchanged.iter().take_while(|voxel| chosen.contains(voxel)).count();
    let mut in_order = chosen.iter();
    assert!(exchanged[..kept].iter().all(|voxel| in_order.any(|v| v == voxel)), "{kept}");
    assert!((200..500).contains(&kept), "{kept}");
    let pool = rayon_pool(1);
    assert_eq!(pool.install(|| exchange(&volume, &chosen, Units::Voxel).unwrap()), exchanged);
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

#[test]
fn nothing_is_exchanged_where_nothing_is_gained() {
    let samples = Array3::from_shape_fn((6, 7, 8), |(z, y, x)| (x + 2 * y + 4 * z) as f32);
    let volume = Volume::new(samples, Frame::VOXEL).unwrap();
    let corners: Vec<u32> =
        (0..8).map(|i| (7 * (i & 1) + 8 * 6 * (i >> 1 & 1) + 56 * 5 * (i >> 2)) as u32).collect();
    assert_eq!(exchange(&volume, &corners, Units::Voxel).unwrap(), corners);
    let all: Vec<u32> = (0..336).collect();
    assert_eq!(exchange(&volume, &all, Units::Voxel).unwrap(), all);
}

#[test]
fn a_bound_on_the_error_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    let args = "interpolate sample:phantom@20 --select adaptive --fill --max-error";
    let args: Vec<&str> = args.split(' ').collect();
    let mut points = Vec::new();
    for bound in [60.0, 20.0] {
        let told = json(f, &[&args[..], &[&bound.to_string()]].concat());
        let filled = &told["interpolation"]["filled"];
        assert!(filled["max"].as_f64().unwrap() <= bound, "{filled}");
        points.push(told["points"]["selected"].as_u64().unwrap());
    }
    assert!(points[0] < points[1] && points[1] < 20 * 20 * 20, "{points:?}");
    let args = "points sample:phantom@20 --select adaptive --count 3000 --max-error 60";
    let told = ok(f, &args.split(' ').collect::<Vec<_>>());
    names(&told, &["fewer than 3000", "further than 60 gray levels"]);
    for (args, word) in [
        ("points sample:phantom@9 --max-error 9", "--select adaptive"),
        ("points sample:phantom@9 --exchange", "--select adaptive"),
        ("points sample:phantom@9 --select adaptive --max-error=-1", "from 0 up"),
        ("points sample:phantom@9 --select adaptive --max-error 9 --exchange", "--exchange"),
        (
            "points sample:phantom@9 --select adaptive --max-error 9 --target-rmse 1",
            "--target-rmse",
        ),
    ] {
        let (code, _, stderr) = run(f, &args.split(' ').collect::<Vec<_>>());
        assert!(code == 2 && stderr.contains(word), "{args}: {code}\n{stderr}");
    }
}

/// The command's own way: points of the command, exchanged and fitted.
#[test]
fn exchanged_points_stand_for_the_skull() {
    if !has_skull() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let args = "interpolate sample:skull --select adaptive --exchange --refit --fill --count";
    let args: Vec<&str> = args.split(' ').collect();
    for (count, most) in [("5035", 3.0), ("15956", 1.5)] {
        let told = json(folder.path(), &[&args[..], &[count]].concat());
        assert_eq!(told["points"]["selected"].to_string(), count);
        let rmse = told["interpolation"]["filled"]["rmse"].as_f64().unwrap();
        assert!(rmse <= most, "{rmse} with {count} points");
    }
}
