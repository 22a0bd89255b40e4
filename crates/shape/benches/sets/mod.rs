//! Sets of points that are timed.

use walpha_base::random::Random;

/// Weighted points.
pub(crate) type Set = Vec<([f64; 3], f64)>;

/// Makes a set of so many points.
pub(crate) type Make = fn(&mut Random, usize) -> Set;

/// Sets of so many points, each with a squared α.
pub(crate) const SETS: [(&str, f64, Make); 2] = [
    // A point in each unit of volume.
    ("random", 1.0, |random, count| {
        let side = (count as f64).cbrt();
        let mut along = || side * random.unit();
        (0..count).map(|_| ([along(), along(), along()], 0.0)).collect()
    }),
    // Samples of a grid on both sides of a surface, weighted as gray differences weigh them.
    ("grid", 10.0, |random, count| {
        // About six layers of samples.
        let size = (count as f64 / 6.0).sqrt().ceil() as usize;
        let mut set = Vec::with_capacity(count);
        for i in 0..count {
            let (layer, at) = (i / (size * size), i % (size * size));
            let (x, y) = ((at % size) as f64, (at / size) as f64);
            let surface = 0.05 * size as f64 * ((x / 40.0).sin() + (y / 30.0).cos());
            set.push(([x, y, surface.round() + layer as f64], f64::floor(10.0 * random.unit())));
        }
        set
    }),
];
