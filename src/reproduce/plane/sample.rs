use std::f64::consts::PI;

/// 60 points (x, y) for Figures 2 and 3, about 11 across around the origin: a thick letter C, open
/// to the right, with a denser cluster in its mouth. Always the same; multiples of 1/64.
///
/// The shape is points and a few edges at α = −2, the letter and the cluster at −1, one ring at −0.5,
/// and the convex hull at 0; for α > 0 it loses its corners until 1/ρ.
pub fn sample_points() -> Vec<[f64; 2]> {
    let mut random = Random(1);
    let mut points = Vec::with_capacity(60);
    scatter(&mut points, 48, || {
        let [u, v] = [random.next(), random.next()];
        // Roots of uniform squares spread points evenly over the area.
        polar([0.0, 0.0], (8.0 + 22.0 * u).sqrt(), PI * (0.25 + 1.5 * v))
    });
    scatter(&mut points, 12, || {
        let [u, v] = [random.next(), random.next()];
        polar([4.25, 0.0], 1.25 * u.sqrt(), 2.0 * PI * v)
    });
    points
}

/// 14 points (x, y) with weights for Figure 4, at α = 1: a ring of discs around a hole, shaded
/// triangles, edges without triangles, a disc alone, and a point that is hidden. Always the same.
pub fn sample_discs() -> (Vec<[f64; 2]>, Vec<f64>) {
    const DISCS: [([f64; 2], f64); 14] = [
        ([0.0, 0.0], 1.25),
        ([1.75, 0.5], 0.5),
        ([1.0, 2.0], 0.75),
        ([2.75, 2.25], 0.0),
        ([-1.25, 2.5], 2.0),
        ([-0.5, 4.75], 0.5),
        ([1.5, 5.25], 1.0),
        ([3.5, 4.25], 0.75),
        ([-1.0, 2.25], -0.5),
        ([5.5, 5.0], 0.5),
        ([6.75, 3.5], 1.0),
        ([6.5, 0.75], 1.5),
        ([4.75, 0.0], 0.25),
        ([8.75, 5.75], 0.0),
    ];
    DISCS.into_iter().unzip()
}

/// Adds well-spaced points: each time, of 32 candidates, the one farthest from all points before it.
fn scatter(points: &mut Vec<[f64; 2]>, count: usize, mut candidate: impl FnMut() -> [f64; 2]) {
    for _ in 0..count {
        let clearance = |place: &[f64; 2]| {
            let squares =
                points.iter().map(|p| (p[0] - place[0]).powi(2) + (p[1] - place[1]).powi(2));
            squares.fold(f64::INFINITY, f64::min)
        };
        let candidates = (0..32).map(|_| candidate());
        points.extend(candidates.max_by(|a, b| clearance(a).total_cmp(&clearance(b))));
    }
}

/// A multiplicative generator, after L'Ecuyer 1999, doi:10.1090/S0025-5718-99-00996-5.
struct Random(u64);

impl Random {
    /// The next number of [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_181_783_497_276_652_981);
        (self.0 >> 32) as f64 / 2f64.powi(32)
    }
}

/// Rounded to 1/64: sines differ in the last digit between systems.
fn polar([x, y]: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [x + radius * angle.cos(), y + radius * angle.sin()].map(|v| (v * 64.0).round() / 64.0)
}
