use std::collections::HashMap;

use ndarray::Array3;
use walpha_base::random::Random;

use super::*;

fn ball(side: usize, radius: f64) -> Array3<f32> {
    let middle = (side - 1) as f64 / 2.0;
    Array3::from_shape_fn((side, side, side), |(z, y, x)| {
        let d = [x, y, z].map(|k| k as f64 - middle);
        (radius - length(d)) as f32
    })
}

/// The number of occurrences of each directed edge.
fn directed_edges(surface: &Isosurface) -> HashMap<(u32, u32), usize> {
    let mut count = HashMap::new();
    for t in &surface.triangles {
        for k in 0..3 {
            *count.entry((t[k], t[(k + 1) % 3])).or_default() += 1;
        }
    }
    count
}

/// Every edge has one triangle on each side, except for edges in the border of the grid.
fn assert_watertight(surface: &Isosurface, dims: [usize; 3]) {
    let count = directed_edges(surface);
    for (&(a, b), &times) in &count {
        assert_eq!(times, 1, "edge {a}-{b} has {times} triangles on one side");
        let [p, q] = [a, b].map(|k| surface.positions[k as usize]);
        let in_border =
            (0..3).any(|k| p[k] == q[k] && (p[k] == 0.0 || p[k] == (dims[k] - 1) as f64));
        assert!(count.contains_key(&(b, a)) || in_border, "edge {p:?}-{q:?} is open");
    }
}

#[test]
fn a_ball_has_its_area_volume_and_genus() {
    let surface = Isosurface::new(ball(40, 15.3).view(), 0.0).unwrap();
    assert_watertight(&surface, [40; 3]);
    let edges = directed_edges(&surface).len() / 2;
    let (v, f) = (surface.positions.len() as i64, surface.triangles.len() as i64);
    assert_eq!(v - edges as i64 + f, 2);
    let pi = std::f64::consts::PI;
    let area = 4.0 * pi * 15.3 * 15.3;
    assert!((surface.area() / area - 1.0).abs() < 0.01, "{} for {area}", surface.area());
    let volume: f64 = surface
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|k| surface.positions[k as usize]);
            (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0
        })
        .sum();
    // Positive: triangles turn counter-clockwise for an eye outside, where values are lower.
    let expected = 4.0 / 3.0 * pi * 15.3_f64.powi(3);
    assert!((volume / expected - 1.0).abs() < 0.01, "{volume} for {expected}");
    assert_eq!(surface.samples_read, 64000);
    assert!(surface.samples_at_surface > surface.positions.len() / 3);
    assert!(surface.samples_at_surface < 16000);
}

#[test]
fn a_plane_lies_where_it_should() {
    let field = Array3::from_shape_fn((4, 5, 6), |(_, _, x)| x as f32);
    let surface = Isosurface::new(field.view(), 2.25).unwrap();
    assert!(surface.positions.iter().all(|p| p[0] == 2.25));
    assert_eq!(surface.area(), 12.0);
    assert_eq!(surface.samples_at_surface, 2 * 4 * 5);
    let [a, b, c] = surface.triangles[0].map(|k| surface.positions[k as usize]);
    assert!(cross(sub(b, a), sub(c, a))[0] < 0.0, "outside is where values are lower");
}

#[test]
fn every_case_meets_every_neighbour_without_a_crack() {
    // Each of the 256 patterns together with each pattern that fits its face, along every axis.
    for case in 0..256_usize {
        for other in 0..16_usize {
            for axis in 0..3 {
                let mut dims = [2; 3];
                dims[axis] = 3;
                let [nx, ny, nz] = dims;
                let field = Array3::from_shape_fn((nz, ny, nx), |(z, y, x)| {
                    let mut at = [x, y, z];
                    let bit = if at[axis] == 2 {
                        let (u, v) = (at[(axis + 1) % 3], at[(axis + 2) % 3]);
                        other >> (u | v << 1)
                    } else {
                        at[axis] = at[axis].min(1);
                        case >> (at[0] | at[1] << 1 | at[2] << 2)
                    };
                    (bit & 1) as f32
                });
                let surface = Isosurface::new(field.view(), 0.5).unwrap();
                assert_watertight(&surface, dims);
            }
        }
    }
}

#[test]
fn noise_gives_a_closed_manifold() {
    for seed in 1..20 {
        let mut random = Random::new(seed);
        let mut field = Array3::from_elem((9, 8, 7), -1.0_f32);
        field.slice_mut(s![1..8, 1..7, 1..6]).mapv_inplace(|_| random.unit() as f32);
        let surface = Isosurface::new(field.view(), 0.5).unwrap();
        let count = directed_edges(&surface);
        assert!(!count.is_empty());
        for (&(a, b), &times) in &count {
            assert_eq!((times, count.get(&(b, a))), (1, Some(&1)));
        }
    }
}

#[test]
fn samples_equal_to_the_isovalue_and_thin_grids_are_harmless() {
    let field = Array3::from_shape_fn((5, 5, 5), |(z, y, x)| ((x + y + z) % 3) as f32);
    assert_watertight(&Isosurface::new(field.view(), 1.0).unwrap(), [5; 3]);
    for shape in [(0, 3, 3), (1, 3, 3), (3, 1, 3), (3, 3, 1)] {
        let field = Array3::from_shape_fn(shape, |(z, y, x)| (x + y + z) as f32);
        let surface = Isosurface::new(field.view(), 1.5).unwrap();
        assert!(surface.triangles.is_empty());
        assert_eq!(surface.samples_at_surface, 0);
    }
}

#[test]
fn what_is_no_number_is_refused() {
    let mut field = ball(4, 1.0);
    assert!(matches!(Isosurface::new(field.view(), f64::NAN), Err(RenderError::Isosurface(_))));
    field[[1, 2, 3]] = f32::INFINITY;
    assert!(matches!(Isosurface::new(field.view(), 0.0), Err(RenderError::Isosurface(_))));
}

/// A field in the form that the `isosurface` crate reads: on the unit cube, negative inside.
struct Published<'a>(&'a Array3<f32>);

impl isosurface::source::ScalarSource for Published<'_> {
    fn sample_scalar(&self, p: isosurface::math::Vec3) -> isosurface::distance::Signed {
        let cells = (self.0.dim().0 - 1) as f32;
        let at = [p.z, p.y, p.x].map(|c| (c * cells).round() as usize);
        // The other crate reads one slice beyond the grid, where nothing is inside.
        isosurface::distance::Signed(self.0.get(at).map_or(1.0, |v| -v))
    }
}

#[test]
fn a_published_implementation_finds_the_same_surface() {
    use isosurface::extractor::IndexedVertices;
    use isosurface::sampler::Sampler;

    // A power of two, so that places on the unit cube are exact.
    const CELLS: usize = 32;
    let torus = |d: [f64; 3]| {
        let ring = (d[0] * d[0] + d[1] * d[1]).sqrt() - 9.3;
        3.7 - (ring * ring + d[2] * d[2]).sqrt()
    };
    let blobs = |d: [f64; 3]| {
        let near = |c: [f64; 3]| 1.0 / (1.0 + 0.05 * length(sub(d, c)).powi(2));
        near([4.1, 0.3, -2.2]) + near([-5.3, 1.7, 3.1]) + near([0.9, -6.4, 5.8]) - 0.62
    };
    let wave = |d: [f64; 3]| {
        let [x, y, z] = d.map(|k| k * 0.41);
        let gyroid = x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos();
        (0.3 - gyroid.abs()).min(13.0 - length(d))
    };
    type Field<'a> = &'a dyn Fn([f64; 3]) -> f64;
    let fields: [(&str, Option<i64>, Field); 3] =
        [("torus", Some(0), &torus), ("blobs", Some(2), &blobs), ("gyroid", None, &wave)];
    for (name, euler, field) in fields {
        let samples = Array3::from_shape_fn([CELLS + 1; 3], |(z, y, x)| {
            field([x, y, z].map(|k| k as f64 - CELLS as f64 / 2.0)) as f32
        });
        let ours = Isosurface::new(samples.view(), 0.0).unwrap();
        assert_watertight(&ours, [CELLS + 1; 3]);
        let (mut flat, mut indices) = (Vec::new(), Vec::new());
        let source = Published(&samples);
        isosurface::MarchingCubes::<isosurface::distance::Signed>::new(CELLS + 1)
            .extract(&Sampler::new(&source), &mut IndexedVertices::new(&mut flat, &mut indices));
        let (vertices, corners) = (flat.as_chunks::<3>().0, indices.as_chunks::<3>().0);
        let theirs = Isosurface {
            positions: vertices.iter().map(|p| p.map(|c| f64::from(c) * CELLS as f64)).collect(),
            triangles: corners.to_vec(),
            ..ours.clone()
        };
        assert!(theirs.triangles.len() > 500, "{name}");
        assert_eq!(ours.positions.len(), theirs.positions.len(), "{name}: vertices");
        assert_eq!(ours.triangles.len(), theirs.triangles.len(), "{name}: triangles");
        let sorted = |surface: &Isosurface| {
            let mut all: Vec<[i64; 3]> =
                surface.positions.iter().map(|p| p.map(|c| (c * 1000.0).round() as i64)).collect();
            all.sort_unstable();
            all
        };
        for (a, b) in sorted(&ours).iter().zip(sorted(&theirs)) {
            assert!((0..3).all(|k| (a[k] - b[k]).abs() <= 1), "{name}: {a:?} is not {b:?}");
        }
        // Loops of more than three vertices may be cut along other diagonals.
        let ratio = ours.area() / theirs.area();
        assert!((ratio - 1.0).abs() < 2e-3, "{name}: the areas' ratio is {ratio}");
        if let Some(euler) = euler {
            let edges = directed_edges(&ours).len() as i64 / 2;
            let got = ours.positions.len() as i64 - edges + ours.triangles.len() as i64;
            assert_eq!(got, euler, "{name}: Euler characteristic");
        }
    }
}
