//! Sets of points on which programs fail: many ties, near ties, or coordinates at the limits of doubles.

use std::path::Path;

use walpha_base::advice::Advice;
use walpha_volume::near::nearest;

use super::{Points, PointsError};
use walpha_volume::VolumeError;

/// A set of points that is hard to triangulate. `walpha points hard:NAME -o points.csv` writes it, and all commands that take
/// points accept its name.
#[non_exhaustive]
pub struct HardSet {
    /// The name after `hard:`.
    pub name: &'static str,
    /// A description of the points, and what makes them hard.
    pub about: &'static str,
    make: fn() -> Points,
}

impl HardSet {
    /// The points. Those of `hidden`, `duplicates` and `radii` have weights.
    pub fn points(&self) -> Points {
        (self.make)()
    }
}

impl std::fmt::Debug for HardSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("HardSet").field("name", &self.name).finish_non_exhaustive()
    }
}

/// All sets. They contain no random numbers, so their doubles are identical on every platform.
pub static HARD_SETS: &[HardSet] = &[
    HardSet {
        name: "voxels",
        about: "9×9×9 points of a lattice: eight on every empty sphere",
        make: || Points::new(lattice([9; 3], [1.0; 3])),
    },
    HardSet {
        name: "ct-voxels",
        about: "12×12×12 samples, 0.4883×0.4883×0.625 mm apart: products round, so eight points are nearly on one sphere",
        make: || Points::new(lattice([12; 3], [0.4883, 0.4883, 0.625])),
    },
    HardSet {
        name: "ball",
        about: "the points of a lattice in a ball: ties with a hull of many flat pieces",
        make: || {
            let near = |p: &[f64; 3]| squared(centred(*p, 5.0)) <= 25.0;
            Points::new(lattice([11; 3], [1.0; 3]).into_iter().filter(near).collect())
        },
    },
    HardSet {
        name: "slab-18",
        about: "18 points, 3×3×2 of a lattice: few enough to check by hand",
        make: || Points::new(lattice([3, 3, 2], [1.0; 3])),
    },
    HardSet {
        name: "fcc",
        about: "face-centred cubic lattice: six points on the spheres of octahedra, exactly",
        make: || {
            let even = |p: &[f64; 3]| (p[0] + p[1] + p[2]) % 2.0 == 0.0;
            Points::new(lattice([9; 3], [1.0; 3]).into_iter().filter(even).collect())
        },
    },
    HardSet {
        name: "hexagonal",
        about: "hexagonal close packing, whose coordinates are irrational: every tie is broken by rounding, next to one that is not",
        make: || {
            let place = |[x, y, z]: [f64; 3]| {
                let shift = z % 2.0;
                let along = x + 0.5 * (y % 2.0) + 0.5 * shift;
                [along, (y + shift / 3.0) * 0.75_f64.sqrt(), z * (2.0_f64 / 3.0).sqrt()]
            };
            Points::new(lattice([8; 3], [1.0; 3]).into_iter().map(place).collect())
        },
    },
    HardSet {
        name: "sphere",
        about: "500 points of a sphere, rounded: all nearly on one sphere, most of them within it or beyond by an ulp",
        make: || Points::new((0..500).map(|k| on_sphere(k, 500)).collect()),
    },
    HardSet {
        name: "integer-sphere",
        about: "all integer points at a distance of √1105 from the origin: all on one sphere, exactly",
        make: || {
            let all = lattice([67; 3], [1.0; 3]).into_iter().map(|p| centred(p, 33.0));
            Points::new(all.filter(|&p| squared(p) == 1105.0).collect())
        },
    },
    HardSet {
        name: "rings",
        about: "the integer points of a circle of radius 65, at five heights: 36 on a circle, and each two circles on a sphere",
        make: || {
            let ring = lattice([131, 131, 5], [1.0; 3]).into_iter();
            let ring = ring.map(|[x, y, z]| [x - 65.0, y - 65.0, z]);
            Points::new(ring.filter(|[x, y, _]| x * x + y * y == 4225.0).collect())
        },
    },
    HardSet {
        name: "moment-curve",
        about: "(t, t², t³) for t from 1 to 60: all pairs are neighbours, so there are as many cells as pairs, and long ones",
        make: || Points::new((1..=60).map(f64::from).map(|t| [t, t * t, t * t * t]).collect()),
    },
    HardSet {
        name: "thin",
        about: "20×20 points of a plane, every second one higher by 2⁻⁴⁰: flat but for the last bits",
        make: || {
            let raised = |[x, y, _]: [f64; 3]| [x, y, (x + y) % 2.0 * 2.0_f64.powi(-40)];
            Points::new(lattice([20, 20, 1], [1.0; 3]).into_iter().map(raised).collect())
        },
    },
    HardSet {
        name: "one-ulp",
        about: "a lattice, and beside each of its points another that is greater by one ulp in x",
        make: || {
            let beside = |[x, y, z]: [f64; 3]| [[x + 1.0, y, z], [(x + 1.0).next_up(), y, z]];
            Points::new(lattice([6; 3], [1.0; 3]).into_iter().flat_map(beside).collect())
        },
    },
    HardSet {
        name: "duplicates",
        about: "a lattice three times, with weights 0, 1/4 and 1/4: two of three points are duplicates",
        make: || {
            let one = lattice([5; 3], [1.0; 3]);
            let count = one.len();
            let weights = (0..3 * count).map(|at| if at < count { 0.0 } else { 0.25 }).collect();
            weighted([&one[..], &one, &one].concat(), weights)
        },
    },
    HardSet {
        name: "hidden",
        about: "a lattice whose weights are multiples of 1/2: some points are hidden, others on the verge of it",
        make: || {
            let positions = lattice([8; 3], [1.0; 3]);
            // For neighbours along an axis, multiples modulo 4 put points on the verge of being hidden, and multiples modulo 5
            // hide them.
            let weight = |[x, y, z]: [f64; 3]| {
                0.5 * ((3.0 * x + 4.0 * y + 7.0 * z) % if x < 4.0 { 4.0 } else { 5.0 })
            };
            let weights = positions.iter().copied().map(weight).collect();
            weighted(positions, weights)
        },
    },
    HardSet {
        name: "radii",
        about: "weights that put the radius of every orthogonal sphere of a lattice's cells at 0",
        make: || {
            let positions = lattice([6; 3], [1.0; 3]);
            let weights = vec![0.75; positions.len()];
            weighted(positions, weights)
        },
    },
    HardSet {
        name: "small",
        about: "a lattice 10⁻⁷⁰ apart: products of five coordinates are below what a double holds",
        make: || Points::new(lattice([6; 3], [1e-70; 3])),
    },
    HardSet {
        name: "large",
        about: "a lattice 10⁷⁰ apart: products of five coordinates are beyond what a double holds",
        make: || Points::new(lattice([6; 3], [1e70; 3])),
    },
    HardSet {
        name: "far",
        about: "a lattice 2⁻²⁰ apart, 2³⁰ away from the origin: differences are exact, and products of coordinates are not",
        make: || {
            let away = |p: [f64; 3]| p.map(|x| 2.0_f64.powi(30) + x);
            Points::new(lattice([6; 3], [2.0_f64.powi(-20); 3]).into_iter().map(away).collect())
        },
    },
    HardSet {
        name: "oblique-plane",
        about: "integer points of the plane x + 2y + 3z = 0: flat, and parallel to no axis",
        make: || {
            let place = |[a, b, _]: [f64; 3]| [2.0 * a + 3.0 * b, -a, -b];
            Points::new(lattice([12, 12, 1], [1.0; 3]).into_iter().map(place).collect())
        },
    },
    HardSet {
        name: "line",
        about: "eleven points of a line: no triangle, no cell",
        make: || Points::new((0..11).map(|k| [1.0, 2.0, 3.0].map(|x| x * f64::from(k))).collect()),
    },
    HardSet {
        name: "periodic",
        about: "6×6×6 points of a lattice, for a box of side 6 (--periodic 6,6,6): every tie goes round it",
        make: || Points::new(lattice([6; 3], [1.0; 3])),
    },
];

/// The set with this name, such as `hard:voxels`; `None` if the name does not begin with `hard:`.
///
/// # Errors
/// [`VolumeError::UnknownSample`], which lists the known names.
pub fn hard(name: impl AsRef<Path>) -> Result<Option<Points>, PointsError> {
    let Some(name) = name.as_ref().to_str().and_then(|name| name.strip_prefix("hard:")) else {
        return Ok(None);
    };
    let known = || HARD_SETS.iter().map(|set| set.name);
    let found = HARD_SETS.iter().find(|set| set.name == name).map(HardSet::points);
    found.map(Some).ok_or_else(|| {
        let meant = nearest(name, known()).map(|near| format!("did you mean hard:{near}?").into());
        let advice: Advice = meant.unwrap_or_else(|| "name one of these".into());
        let known = known().map(|name| format!("hard:{name}")).collect::<Vec<_>>().join(", ");
        PointsError::from(VolumeError::UnknownSample {
            name: format!("hard:{name}"),
            known,
            advice,
        })
    })
}

/// The points of a lattice, x fastest, from the origin.
fn lattice(counts: [usize; 3], step: [f64; 3]) -> Vec<[f64; 3]> {
    let [x, y, z] = counts;
    let index = |k: usize| [k % x, k / x % y, k / (x * y)];
    let place = |k: usize| {
        let at = index(k);
        [0, 1, 2].map(|axis| at[axis] as f64 * step[axis])
    };
    (0..x * y * z).map(place).collect()
}

fn centred(p: [f64; 3], centre: f64) -> [f64; 3] {
    p.map(|x| x - centre)
}

fn squared(p: [f64; 3]) -> f64 {
    p.iter().map(|x| x * x).sum()
}

/// The k-th point of a spiral from pole to pole of the unit sphere. Its angle is computed with rational numbers, so that no
/// trigonometric function of a library decides the last bits.
fn on_sphere(k: u32, of: u32) -> [f64; 3] {
    let z = (2.0 * f64::from(k) + 1.0) / f64::from(of) - 1.0;
    // This is a rational parametrisation of the whole circle.
    let turn = (f64::from(k) * 0.618_033_988_75).fract() * 4.0;
    let t = turn.fract() * 2.0 - 1.0;
    let (c, s) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
    let [c, s] = match turn as u32 {
        0 => [c, s],
        1 => [-s, c],
        2 => [-c, -s],
        _ => [s, -c],
    };
    let radius = (1.0 - z * z).sqrt();
    [radius * c, radius * s, z]
}

fn weighted(positions: Vec<[f64; 3]>, weights: Vec<f64>) -> Points {
    Points { weights: Some(weights), ..Points::new(positions) }
}
