//! Files that were kept: reader and writer share what they expect of the next number, so a change to it
//! comes back right from a file of the same day, and wrong from all those in people's folders.

use std::path::Path;

use walpha_points::{ModelMetadata, Packing, WeightedPoints};
use walpha_shape::Alpha;
use walpha_volume::GrayRange;

use super::{Chance, back, grid, scattered, written};

/// Points of a volume that is dark outside of a ball and brighter along x, with some noise.
fn ball() -> WeightedPoints {
    let points = scattered([24, 20, 18], 3, |_| 0.0);
    let mut noise = Chance(11);
    let value = |[x, y, z]: [f64; 3]| {
        let inside = (x - 11.0).powi(2) + (y - 9.0).powi(2) + (z - 8.0).powi(2) < 60.0;
        (if inside { 120.0 + 4.0 * x } else { 0.0 }) + noise.below(5) as f64
    };
    let values: Vec<f64> = points.positions().iter().copied().map(value).collect();
    points.with_values(values).unwrap()
}

/// A file, what is in it, and how that was packed.
fn kept() -> [(&'static str, WeightedPoints, ModelMetadata, Packing); 3] {
    let facts = || ModelMetadata::default().grid(grid([24, 20, 18]));
    let all = ball();
    let mut layered = ball();
    for (k, weight) in layered.weights_mut().iter_mut().enumerate() {
        *weight = f64::from(k as u32 % 19) / 4.0 - 1.0;
    }
    let mut order: Vec<u32> = (0..layered.len() as u32).collect();
    order.sort_by_key(|&k| (k % 5, k));
    let of_layers = facts()
        .order(order)
        .alpha(Alpha::from_squared(2.25).unwrap())
        .range(GrayRange { low: 0.0, high: 255.0 });
    let mut rough = scattered([9, 30, 14], 5, |chance| chance.below(1 << 20) as f64 / 4096.0);
    rough.values_mut().unwrap().sort_by(f64::total_cmp);
    [
        ("whole.wvm", all, facts(), Packing::default()),
        ("layers.wvm", layered, of_layers, Packing::default().layers(3)),
        ("rough.wvm", rough, ModelMetadata::default(), Packing::default().value_error(0.5)),
    ]
}

#[test]
fn files_that_were_kept_are_read_and_written_as_ever() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/integration/wvm/kept");
    for (name, points, facts, packing) in kept() {
        let file = std::fs::read(folder.join(name)).unwrap();
        let (found, told) = back(&file, 0);
        assert_eq!((found.positions(), found.weights()), (points.positions(), points.weights()));
        if name == "rough.wvm" {
            let values =
                found.values().into_iter().flatten().zip(points.values().into_iter().flatten());
            assert!(values.into_iter().all(|(a, b)| (a - b).abs() <= 0.5), "{name}");
            // The second writing stores the middle of each step.
            assert_eq!(written(&found, &facts, packing), file, "{name}");
        } else {
            let known = (points.values(), &facts.clone().order(None));
            assert_eq!((found.values(), &told), known, "{name}");
        }
        let again = written(&points, &facts, packing);
        if name == "layers.wvm" {
            // Its weights are deflated, which another library does in other bytes.
            let (same, told_again) = back(&again, 0);
            assert_eq!((same.positions(), same.weights()), (found.positions(), found.weights()));
            assert_eq!((same.values(), told_again), (found.values(), told), "{name}");
        } else {
            assert_eq!(again, file, "{name}");
        }
    }
}
