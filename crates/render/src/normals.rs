use walpha_base::vector::{V3, add, along, cross, dot, length, scale, sub, unit};

/// Normals of the vertices of a triangle mesh: the unit normals of the triangles around each vertex, weighted by their angles
/// there, so that the division of a flat part into triangles does not matter (Thürmer and Wüthrich 1998,
/// doi:10.1080/10867651.1998.10487487). Of length 1, or 0 if there is no direction.
pub(crate) fn vertex_normals(positions: &[V3], triangles: &[[u32; 3]]) -> Vec<V3> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for corners in triangles {
        let p = corners.map(|c| positions[c as usize]);
        let Some(normal) = unit(cross(sub(p[1], p[0]), sub(p[2], p[0]))) else { continue };
        let sides = [0, 1, 2].map(|k| sub(p[(k + 1) % 3], p[k]));
        let lengths = sides.map(length);
        for k in 0..3 {
            let before = (k + 2) % 3;
            let angle = angle(-dot(sides[k], sides[before]), lengths[k] * lengths[before]);
            let sum = &mut sums[corners[k] as usize];
            *sum = along(*sum, angle, normal);
        }
    }
    sums.into_iter().map(|sum| unit(sum).unwrap_or([0.0; 3])).collect()
}

/// Normals of a surface made of lattice steps, as seen from farther away: each round blends every normal with those of its
/// neighbours along the triangles.
pub(crate) fn smoothed(mut normals: Vec<V3>, triangles: &[[u32; 3]], rounds: usize) -> Vec<V3> {
    for _ in 0..rounds {
        let mut sums: Vec<V3> = normals.iter().map(|&n| scale(n, 2.0)).collect();
        for corners in triangles {
            let n = corners.map(|c| normals[c as usize]);
            let around = add(add(n[0], n[1]), n[2]);
            for k in 0..3 {
                let sum = &mut sums[corners[k] as usize];
                *sum = add(*sum, sub(around, n[k]));
            }
        }
        for (normal, sum) in normals.iter_mut().zip(sums) {
            *normal = unit(sum).unwrap_or(*normal);
        }
    }
    normals
}

/// Turns triangles without an orientation so that neighbours agree: along the smoothest ways first, as Hoppe et al. orient the
/// normals of points (1992, doi:10.1145/133994.134011). So the two sides of a flat cell look the same way. What can be up is.
/// O(n log n).
pub(crate) fn orient(positions: &[V3], triangles: &mut [[u32; 3]]) {
    let crossed = |corners: &[u32; 3]| {
        let p = corners.map(|c| positions[c as usize]);
        cross(sub(p[1], p[0]), sub(p[2], p[0]))
    };
    let areas: Vec<V3> = triangles.iter().map(crossed).collect();
    let normals: Vec<V3> = areas.iter().map(|&area| unit(area).unwrap_or([0.0; 3])).collect();
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (number, corners) in (0..).zip(triangles.iter()) {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], number));
        }
    }
    sides.sort_unstable();
    let beside = |pair: &[([u32; 2], u32)]| {
        let [(side, a), (other, b)] = [pair[0], pair[1]];
        (side == other).then(|| (dot(normals[a as usize], normals[b as usize]), a, b))
    };
    let mut ways: Vec<(f64, u32, u32)> = sides.windows(2).filter_map(beside).collect();
    ways.sort_unstable_by(|a, b| b.0.abs().total_cmp(&a.0.abs()).then((a.1, a.2).cmp(&(b.1, b.2))));
    // Whether each is turned against the one above it in its tree.
    let mut above: Vec<(u32, bool)> = (0..triangles.len() as u32).map(|k| (k, false)).collect();
    let root = |above: &mut Vec<(u32, bool)>, mut at: u32| {
        let mut turned = false;
        while above[at as usize].0 != at {
            let (up, turn) = above[at as usize];
            let (over, more) = above[up as usize];
            above[at as usize] = (over, turn != more);
            turned ^= above[at as usize].1;
            at = above[at as usize].0;
        }
        (at, turned)
    };
    for (agreement, a, b) in ways {
        let (a, of_a) = root(&mut above, a);
        let (b, of_b) = root(&mut above, b);
        if a != b {
            above[b as usize] = (a, (agreement < 0.0) != (of_a != of_b));
        }
    }
    let roots: Vec<(u32, bool)> =
        (0..triangles.len() as u32).map(|k| root(&mut above, k)).collect();
    let mut ups = vec![0.0; triangles.len()];
    for (&(root, turned), area) in roots.iter().zip(&areas) {
        ups[root as usize] += if turned { -area[2] } else { area[2] };
    }
    for (corners, (root, turned)) in triangles.iter_mut().zip(roots) {
        if turned != (ups[root as usize] < 0.0) {
            corners.swap(1, 2);
        }
    }
}

/// The angle between two vectors in radians, to 10⁻⁴, by + − × ÷ √ only, from their inner product and the product of their lengths.
fn angle(product: f64, lengths: f64) -> f64 {
    if lengths <= 0.0 {
        return 0.0;
    }
    let cosine = (product / lengths).clamp(-1.0, 1.0);
    // Abramowitz and Stegun 4.4.45: arccos x = √(1 − x) · polynomial for x ≥ 0.
    let x = cosine.abs();
    let polynomial = ((-0.0187293 * x + 0.0742610) * x - 0.2121144) * x + 1.5707288;
    let acute = (1.0 - x).sqrt() * polynomial;
    if cosine < 0.0 { std::f64::consts::PI - acute } else { acute }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_agree_with_the_library() {
        for k in 0..=360 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let expected = cos.acos();
            let (a, b) = ([3.0, 0.0, 0.0], [0.5 * cos, 0.5 * sin, 0.0]);
            let got = angle(dot(a, b), length(a) * length(b));
            assert!((got - expected).abs() < 1e-4, "{k}°: {got}, not {expected}");
        }
    }

    #[test]
    fn a_corner_of_a_cube_looks_along_its_diagonal_however_it_is_cut() {
        // Three squares meet in vertex 0; one of them is cut into two triangles there.
        let p = vec![
            [0.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, -1.0],
            [-1.0, -1.0, 0.0],
        ];
        let triangles = [[0, 1, 4], [0, 4, 2], [0, 2, 3], [0, 3, 1]];
        let normal = vertex_normals(&p, &triangles)[0];
        let expected = 1.0 / 3.0_f64.sqrt();
        for component in normal {
            assert!((component - expected).abs() < 1e-3, "{normal:?}");
        }
    }

    #[test]
    fn neighbours_agree_and_look_up() {
        // A bent strip, and the other side of one of its triangles, which a flat cell has.
        let p: Vec<V3> = (0..12)
            .map(|k| [f64::from(k / 2), f64::from(k % 2), 0.1 * f64::from(k / 2 * (k / 2))])
            .chain([[1.4, 0.4, 0.2]])
            .collect();
        let mut random = walpha_base::random::Random::new(3);
        let mut triangles: Vec<[u32; 3]> = (0..10).map(|k| [k, k + 1, k + 2]).collect();
        triangles.extend([[2, 3, 12], [3, 4, 12], [2, 4, 12]]);
        for _ in 0..20 {
            for corners in &mut triangles {
                if random.below(2) == 1 {
                    corners.swap(0, 1);
                }
            }
            orient(&p, &mut triangles);
            for corners in &triangles {
                let [a, b, c] = corners.map(|k| p[k as usize]);
                assert!(cross(sub(b, a), sub(c, a))[2] > 0.0, "{corners:?}");
            }
        }
    }

    #[test]
    fn a_vertex_without_area_has_no_normal_and_harms_no_other() {
        let p = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let normals = vertex_normals(&p, &[[0, 1, 2], [0, 0, 1]]);
        assert_eq!(normals, [[0.0; 3]; 3]);
        assert_eq!(smoothed(normals, &[[0, 1, 2]], 2), [[0.0; 3]; 3]);
    }
}
