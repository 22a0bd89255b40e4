use std::f64::consts::PI;

/// 60 points (x, y) for Figures 2 and 3, in the square of side 12 around the origin: a thick
/// letter C, open to the right, with a cluster in its mouth. Always the same.
pub fn sample_points() -> Vec<[f64; 2]> {
    let bow = (0..48).map(|k| {
        let [u, v] = spread(k);
        polar([0.0, 0.0], 3.0 + 2.5 * u, PI * (0.25 + 1.5 * v))
    });
    let cluster = (48..60).map(|k| {
        let [u, v] = spread(k);
        // The root spreads the points evenly over the disc.
        polar([3.75, 0.25], 1.25 * u.sqrt(), 2.0 * PI * v)
    });
    bow.chain(cluster).collect()
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

/// The k-th place of a sequence that fills the unit square evenly: multiples of 1/g and 1/g² modulo
/// 1, where g³ = g + 1 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
fn spread(k: u32) -> [f64; 2] {
    const G: f64 = 1.324_717_957_244_746;
    [1.0 / G, 1.0 / (G * G)].map(|step| (0.5 + f64::from(k) * step).fract())
}

fn polar([x, y]: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [x + radius * angle.cos(), y + radius * angle.sin()]
}
