//! The sets of points.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use ndarray_npy::write_npy;
use walpha::ndarray::Array2;
use walpha::points::{Points, Selection, Units, difference, select, weigh};
use walpha::{Alpha, Frame, Gray, Volume, WeightedPoints, Weighting, volume};
use walpha_base::random::Random;

use super::Result;

/// A set of points with weights.
pub(super) struct Set {
    kind: Kind,
    size: usize,
    weighting: Weighting,
}

#[derive(Clone, Copy)]
enum Kind {
    /// The points of the skull, upsampled to this number of samples along each axis.
    Skull,
    /// The points of the skull in the millimetres of a tilted scan, where coordinates are rounded.
    Scan,
    /// This number of random points in a cube, one in each unit of volume.
    Random,
    /// This number of points of a hilly ground, as a laser scanner sees it from above.
    Terrain,
    /// So many balls as dense as the atoms of a protein, of radii 1.2 to 1.9, and each 1.4 larger: their solvent-accessible surface.
    Atoms,
    /// This number of random points on a sphere: all spheres through four of them are nearly equal.
    Sphere,
}

const KINDS: [(&str, Kind); 6] = [
    ("skull", Kind::Skull),
    ("scan", Kind::Scan),
    ("random", Kind::Random),
    ("terrain", Kind::Terrain),
    ("atoms", Kind::Atoms),
    ("sphere", Kind::Sphere),
];

impl FromStr for Set {
    type Err = Box<dyn std::error::Error + Send + Sync>;

    fn from_str(text: &str) -> Result<Self> {
        let (set, weighting) = text.split_once(':').unwrap_or((text, "common=0"));
        let (name, size) = set.split_once('@').ok_or(super::USAGE)?;
        let (_, kind) = KINDS.iter().find(|(known, _)| *known == name).ok_or(super::USAGE)?;
        Ok(Self { kind: *kind, size: size.parse()?, weighting: weighting.parse()? })
    }
}

impl fmt::Display for Set {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, _) = KINDS[self.kind as usize];
        write!(f, "{name}@{}, weights {}", self.size, self.weighting)
    }
}

impl Set {
    /// α of its shapes: the paper's for the skull, in square voxels, and a few times the squared spacing of others.
    pub(super) fn alpha(&self) -> f64 {
        match self.kind {
            Kind::Skull => 10.0,
            Kind::Scan => 10.0 * SCAN.spacing[0] * SCAN.spacing[0],
            Kind::Random | Kind::Terrain => 1.0,
            Kind::Atoms => 0.0,
            Kind::Sphere => 40.0 / self.size as f64,
        }
    }

    pub(super) fn has_weights(&self) -> bool {
        self.weighting != Weighting::Common(0.0)
    }

    fn points(&self) -> Result<Points> {
        let mut random = Random::new(1);
        let side = match self.kind {
            Kind::Skull => return skull(self.size, Frame::VOXEL),
            Kind::Scan => return skull(self.size, SCAN),
            Kind::Random => (self.size as f64).cbrt(),
            Kind::Terrain => (self.size as f64).sqrt(),
            Kind::Atoms => (self.size as f64).cbrt().ceil(),
            Kind::Sphere => 0.0,
        };
        let point = |i: usize| {
            let [x, y, z] = [(); 3].map(|()| random.unit());
            match self.kind {
                // On average 0.057 in a cubic ångström, and none too near to another.
                Kind::Atoms => {
                    let n = side as usize;
                    let [i, j, k] = [i % n, i / n % n, i / n / n].map(|cell| cell as f64);
                    [i + 0.7 * x, j + 0.7 * y, k + 0.7 * z].map(|x| 2.6 * x)
                }
                Kind::Skull | Kind::Scan | Kind::Random => [x, y, z].map(|x| x * side),
                Kind::Terrain => {
                    let [x, y] = [x * side, y * side];
                    [x, y, 40.0 * ((x / 90.0).sin() + (y / 70.0).cos()) + z]
                }
                Kind::Sphere => {
                    let (height, turn) = (2.0 * x - 1.0, std::f64::consts::TAU * y);
                    let radius = (1.0 - height * height).sqrt();
                    [radius * turn.cos(), radius * turn.sin(), height]
                }
            }
        };
        Ok(Points::new((0..self.size).map(point).collect()))
    }
}

/// Writes a set as plain CGAL reads it, and as NPY for the command; returns the number of points.
pub(super) fn write(set: &Set, path: &Path) -> Result<usize> {
    let points = match set.kind {
        Kind::Atoms => atoms(set.points()?.positions, path)?,
        _ => weigh(set.points()?, set.weighting, Alpha::from_squared(set.alpha())?)?,
    };
    let rows = points.positions().iter().zip(points.weights());
    let numbers: Vec<f64> = rows.flat_map(|(p, w)| [p[0], p[1], p[2], *w]).collect();
    std::fs::write(path, numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())?;
    let count = points.positions().len();
    write_npy(path.with_extension("npy"), &Array2::from_shape_vec((count, 4), numbers)?)?;
    Ok(count)
}

/// Atoms with their radii, written as XYZR for programs that add the probe themselves.
fn atoms(positions: Vec<[f64; 3]>, path: &Path) -> Result<WeightedPoints> {
    const PROBE: f64 = 1.4;
    let mut random = Random::new(2);
    let radii: Vec<f64> = positions.iter().map(|_| 1.2 + 0.7 * random.unit()).collect();
    let mut text = String::new();
    for ([x, y, z], r) in positions.iter().zip(&radii) {
        text += &format!("{x:?} {y:?} {z:?} {r:?}\n");
    }
    std::fs::write(path.with_extension("xyzr"), text)?;
    let weights = radii.iter().map(|r| (r + PROBE).powi(2)).collect();
    Ok(WeightedPoints::new(positions, weights)?)
}

const SCAN: Frame = Frame {
    spacing: [0.4883, 0.4883, 0.625],
    origin: [-62.5, -47.1, 1204.3],
    direction: [[1.0, 0.0, 0.0], [0.0, 0.96, -0.28], [0.0, 0.28, 0.96]],
    ..Frame::VOXEL
};

fn skull(size: usize, frame: Frame) -> Result<Points> {
    let (skull, _) = volume::sample("sample:skull")?.into_gray(Gray::Automatic)?;
    let skull = upsampled(&skull, size, frame)?;
    let selection = Selection::default();
    Ok(select(&skull, &skull, &difference(&skull), &selection, Units::World)?)
}

/// Trilinear, the first and last samples of each axis staying where they are.
fn upsampled(volume: &Volume, size: usize, frame: Frame) -> Result<Volume> {
    let samples = volume.samples();
    let place = |i: usize, n: usize| {
        let at = i as f64 * (n - 1) as f64 / (size - 1) as f64;
        let low = (at as usize).min(n - 2);
        (low, at - low as f64)
    };
    let [nx, ny, nz] = volume.dims().xyz();
    let upsampled = ndarray::Array3::from_shape_fn((size, size, size), |(z, y, x)| {
        let ((z, fz), (y, fy), (x, fx)) = (place(z, nz), place(y, ny), place(x, nx));
        let mut sum = 0.0;
        for (dz, wz) in [(0, 1.0 - fz), (1, fz)] {
            for (dy, wy) in [(0, 1.0 - fy), (1, fy)] {
                for (dx, wx) in [(0, 1.0 - fx), (1, fx)] {
                    sum += wz * wy * wx * f64::from(samples[[z + dz, y + dy, x + dx]]);
                }
            }
        }
        sum as f32
    });
    Ok(Volume::new(upsampled, frame)?.with_gray_levels())
}
