//! Sets of points that are timed.

use walpha_base::random::Random;

/// Weighted points.
pub(crate) type Set = Vec<([f64; 3], f64)>;

/// Makes a set of this many points.
pub(crate) type Make = fn(&mut Random, usize) -> Set;

/// Sets of a given number of points, each with a squared α.
pub(crate) const SETS: [(&str, f64, Make); 4] = [
    // A point in each unit of volume.
    ("random", 1.0, |random, count| {
        let side = (count as f64).cbrt();
        let mut along = || side * random.unit();
        (0..count).map(|_| ([along(), along(), along()], 0.0)).collect()
    }),
    // Samples of a grid on both sides of a surface, weighted as gray differences weigh them.
    ("grid", 10.0, |random, count| {
        samples(count).map(|place| (place, f64::floor(10.0 * random.unit()))).collect()
    }),
    // Points without weights, in the millimetres of a scanner: coordinates are rounded.
    ("millimetres", 1.0, |_, count| {
        let place = |[x, y, z]: [f64; 3]| [0.4883 * x - 111.1, 0.4883 * y - 76.86, 0.625 * z];
        samples(count).map(|index| (place(index), 0.0)).collect()
    }),
    // The samples of a tilted scan.
    ("tilted", 10.0, |_, count| {
        let place = |[x, y, z]: [f64; 3]| {
            let (y, z) = (1.75 * y, 3.0 * z);
            [1.75 * x - 111.1, 0.96 * y - 0.28 * z - 76.86, 0.28 * y + 0.96 * z]
        };
        samples(count).map(|index| (place(index), 0.0)).collect()
    }),
];

/// Indices of samples on both sides of a surface, in about six layers.
fn samples(count: usize) -> impl Iterator<Item = [f64; 3]> {
    let size = (count as f64 / 6.0).sqrt().ceil() as usize;
    (0..count).map(move |i| {
        let (layer, at) = (i / (size * size), i % (size * size));
        let (x, y) = ((at % size) as f64, (at / size) as f64);
        let surface = 0.05 * size as f64 * ((x / 40.0).sin() + (y / 30.0).cos());
        [x, y, surface.round() + layer as f64]
    })
}
