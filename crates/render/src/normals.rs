use walpha_base::vector::{V3, add, along, cross, dot, length, scale, sub, unit};

/// Normals of the vertices of a triangle mesh: the unit normals of the triangles around each vertex, weighted by their angles
/// there, so that the division of a flat part into triangles does not matter (Thürmer and Wüthrich 1998,
/// doi:10.1080/10867651.1998.10487487). Of length 1, or 0 if there is no direction.
pub(crate) fn vertex_normals(positions: &[V3], triangles: &[[u32; 3]]) -> Vec<V3> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for corners in triangles {
        let p = corners.map(|c| positions[c as usize]);
        let Some(normal) = unit(cross(sub(p[1], p[0]), sub(p[2], p[0]))) else { continue };
        for k in 0..3 {
            let (a, b) = (sub(p[(k + 1) % 3], p[k]), sub(p[(k + 2) % 3], p[k]));
            let sum = &mut sums[corners[k] as usize];
            *sum = along(*sum, angle(a, b), normal);
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

/// The angle between two vectors in radians, to 10⁻⁴, by + − × ÷ √ only.
fn angle(a: V3, b: V3) -> f64 {
    let lengths = length(a) * length(b);
    if lengths <= 0.0 {
        return 0.0;
    }
    let cosine = (dot(a, b) / lengths).clamp(-1.0, 1.0);
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
            let got = angle([3.0, 0.0, 0.0], [0.5 * cos, 0.5 * sin, 0.0]);
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
    fn a_vertex_without_area_has_no_normal_and_harms_no_other() {
        let p = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let normals = vertex_normals(&p, &[[0, 1, 2], [0, 0, 1]]);
        assert_eq!(normals, [[0.0; 3]; 3]);
        assert_eq!(smoothed(normals, &[[0, 1, 2]], 2), [[0.0; 3]; 3]);
    }
}
