use std::collections::{BTreeMap, BTreeSet};

use walpha_base::random::Random;
use walpha_complex::canonical::{outward_facets, smallest_even, sorted};
use walpha_regular::triangulate;

use super::*;
use crate::make::alpha_shape_by;
use crate::{Class, Complex, Simplices};

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The voxels for which `inside` holds, in a grid whose corners have their indices as positions.
fn voxels(dims: [u32; 3], inside: impl Fn([i64; 3]) -> bool) -> Voxels {
    let [x, y, z] = dims.map(u64::from);
    let mut voxels = Voxels { dims, origin: [0.5; 3], axes: UNIT, runs: Vec::new() };
    let chosen = (0..x * y * z).filter(|&voxel| inside(voxels.indices(voxel).map(i64::from)));
    voxels.runs = chosen.map(|voxel| [voxel, 1]).collect();
    voxels
}

fn shape(voxels: &Voxels) -> AlphaShape {
    voxel_shape(voxels.clone(), |at| f64::from(at[0])).unwrap()
}

/// A ball of radius r in voxels, with many deep ones.
fn ball(r: f64) -> Voxels {
    let side = 2 * r.ceil() as u32 + 1;
    let middle = f64::from(side - 1) / 2.0;
    voxels([side; 3], |at| at.iter().map(|&i| (i as f64 - middle).powi(2)).sum::<f64>() < r * r)
}

/// Regions with difficult boundaries: cavities, gaps and plates of one voxel, voxels that share an edge or a corner.
fn regions() -> Vec<Voxels> {
    let mut random = Random::new(5);
    let mut regions = vec![
        voxels([1, 1, 1], |_| true),
        voxels([3, 3, 3], |at| at != [1, 1, 1]),
        voxels([5, 5, 5], |at| at != [2, 2, 2]),
        voxels([7, 7, 7], |at| at != [3, 3, 3] && at != [3, 3, 5]),
        voxels([6, 5, 4], |at| at[0] != 3),
        voxels([6, 5, 1], |_| true),
        voxels([1, 6, 3], |at| at[1] != 2 || at[2] != 1),
        voxels([2, 2, 1], |at| at[0] == at[1]),
        voxels([2, 2, 2], |at| at == [0, 0, 0] || at == [1, 1, 1]),
        voxels([5, 5, 5], |at| (at[0] + at[1] + at[2]) % 2 == 0),
        voxels([6, 6, 6], |at| at.iter().filter(|i| **i % 5 == 0).count() > 0),
        voxels([70, 4, 5], |at| at[0] != 33),
        ball(4.2),
        ball(6.0),
    ];
    for share in [0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99] {
        let chosen: Vec<bool> = (0..7 * 6 * 8).map(|_| random.unit() < share).collect();
        regions.push(voxels([7, 6, 8], |at| chosen[(at[0] + 7 * (at[1] + 6 * at[2])) as usize]));
    }
    regions
}

/// The whole triangulation of points, in which a cell is interior if its corners say so, and all else follows by definition.
pub(crate) fn by_definition(
    points: &[[f64; 3]],
    is_inside: impl Fn([[f64; 3]; 4]) -> bool,
) -> Complex {
    let triangulation = triangulate(points, None).unwrap();
    let mut cells = Vec::new();
    let mut cofaces: BTreeMap<Vec<u32>, Vec<(Class, [u32; 3])>> = BTreeMap::new();
    for (_, cell) in triangulation.finite_cells() {
        let cell = smallest_even(cell);
        let inside = is_inside(cell.map(|v| points[v as usize]));
        let class = if inside { Class::Interior } else { Class::Exterior };
        cells.push((cell, class));
        for facet in outward_facets(cell) {
            let side = (class, smallest_even(facet));
            let [a, b, c] = sorted(facet);
            cofaces.entry(vec![a, b, c]).or_default().push(side);
            for face in [vec![a, b], vec![a, c], vec![b, c], vec![a], vec![b], vec![c]] {
                cofaces.entry(face).or_default().push(side);
            }
        }
    }
    // On the hull the space outside is another exterior cell.
    let facets = cofaces.iter().filter(|(face, of)| face.len() == 3 && of.len() == 1);
    let hull: BTreeSet<Vec<u32>> = facets
        .flat_map(|(f, _)| {
            [[0, 1, 2], [0, 1, 1], [0, 2, 2], [1, 2, 2], [0, 0, 0], [1, 1, 1], [2, 2, 2]].map(
                |of| of.map(|i| f[i]).into_iter().collect::<BTreeSet<_>>().into_iter().collect(),
            )
        })
        .collect();
    let class = |face: &[u32]| {
        let of = &cofaces[face];
        let inside = of.iter().filter(|(class, _)| *class == Class::Interior).count();
        match inside {
            0 => Class::Exterior,
            n if n == of.len() && !hull.contains(face) => Class::Interior,
            _ => Class::Regular,
        }
    };
    fn rows<const N: usize>(cofaces: &BTreeMap<Vec<u32>, Vec<(Class, [u32; 3])>>) -> Vec<[u32; N]> {
        cofaces.keys().filter_map(|face| face[..].try_into().ok()).collect()
    }
    let facets = rows::<3>(&cofaces).into_iter().map(|row| match class(&row) {
        Class::Regular => {
            let of = cofaces[&row[..]].iter().find(|(class, _)| *class == Class::Interior);
            (of.unwrap().1, Class::Regular)
        }
        class => (row, class),
    });
    let mut complex = Complex {
        cells: cells.into_iter().collect(),
        facets: facets.collect(),
        edges: rows(&cofaces).into_iter().map(|row: [u32; 2]| (row, class(&row))).collect(),
        vertices: rows(&cofaces).into_iter().map(|row: [u32; 1]| (row, class(&row))).collect(),
    };
    walpha_complex::canonical::sort(&mut complex);
    complex
}

/// The voxel that the centroid of a cell is in.
fn voxel_of(corners: [[f64; 3]; 4]) -> [i64; 3] {
    [0, 1, 2].map(|k| (corners.iter().map(|corner| corner[k]).sum::<f64>() / 4.0).floor() as i64)
}

/// Whether a voxel is in a region.
fn holds(voxels: &Voxels, at: [i64; 3]) -> bool {
    let dims = voxels.dims.map(i64::from);
    let number = (at[0] + dims[0] * (at[1] + dims[1] * at[2])) as u64;
    let in_grid = (0..3).all(|k| (0..dims[k]).contains(&at[k]));
    in_grid && voxels.runs.iter().any(|&[first, count]| (first..first + count).contains(&number))
}

/// The complex, sheets and Betti numbers are those that follow from the whole triangulation of the points.
#[test]
fn the_solid_is_that_of_the_definition() {
    for voxels in regions() {
        let found = shape(&voxels);
        assert_eq!(found.measures().volume, voxels.count() as f64, "{voxels:?}");
        let points = found.points().clone();
        let positions = points.positions().to_vec();
        let expected = alpha_shape_by(
            points,
            &ShapeOptions::new(Alpha::INFINITE),
            |_, _| Ok(by_definition(&positions, |corners| holds(&voxels, voxel_of(corners)))),
            &Monitor::noop(),
        )
        .unwrap();
        assert_eq!(found.complex(), expected.complex(), "{voxels:?}");
        assert_eq!(found.sheets(), expected.sheets(), "{voxels:?}");
        assert_eq!(found.betti(), expected.betti(), "{voxels:?}");
    }
}

/// The numbers of connected parts of a set of voxels, which join across this many differing indices.
fn parts(set: &BTreeSet<[i64; 3]>, differing: usize) -> usize {
    let mut left = set.clone();
    let mut count = 0;
    while let Some(first) = left.pop_first() {
        count += 1;
        let mut next = vec![first];
        while let Some(at) = next.pop() {
            for step in 0..27 {
                let step = [step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1];
                let there = [0, 1, 2].map(|k| at[k] + step[k]);
                if step.iter().filter(|d| **d != 0).count() <= differing && left.remove(&there) {
                    next.push(there);
                }
            }
        }
    }
    count
}

/// Components are those of 26 neighbours, and voids those of the 6 neighbours in the space outside. Solids are the parts of 6
/// neighbours, each with one boundary surface and one more for each of its own cavities.
#[test]
fn components_and_voids_are_those_of_the_voxels() {
    for voxels in regions() {
        let found = shape(&voxels);
        let dims = voxels.dims.map(i64::from);
        let all = (-1..=dims[2])
            .flat_map(|z| (-1..=dims[1]).flat_map(move |y| (-1..=dims[0]).map(move |x| [x, y, z])));
        let (inside, outside): (BTreeSet<_>, BTreeSet<_>) = all.partition(|&at| holds(&voxels, at));
        let betti = found.betti().unwrap();
        assert_eq!(betti.b0, parts(&inside, 3) as u64, "{voxels:?}");
        assert_eq!(betti.b2, parts(&outside, 1) as u64 - 1, "{voxels:?}");
        assert_eq!(found.components().len() as u64, betti.b0);
        let (solid, _) = found.solid();
        assert!(solid.manifold_defects().is_empty(), "{voxels:?}");
    }
}

/// Two voxels that share an edge or a corner are one component, and two solids.
#[test]
fn solids_are_the_parts_that_share_faces() {
    for diagonal in [
        voxels([2, 2, 1], |at| at[0] == at[1]),
        voxels([2; 3], |at| at[0] == at[1] && at[1] == at[2]),
    ] {
        let found = shape(&diagonal);
        assert_eq!((found.betti().unwrap().b0, found.measures().volume), (1, 2.0));
        let (solid, cuts) = found.solid();
        assert_eq!((solid.vertices.len(), solid.regular.len(), cuts.midpoints), (16, 24, 0));
    }
}

/// Deep voxels have no corners of their own.
#[test]
fn points_are_those_of_the_surface() {
    let block = voxels([40, 40, 40], |_| true);
    let found = shape(&block);
    // Two layers of corners: 41³ − 37³.
    assert_eq!(found.points().len(), 41 * 41 * 41 - 37 * 37 * 37);
    assert_eq!(found.measures().volume, 64_000.0);
    assert_eq!(found.complex().facets.counts().regular, 2 * 6 * 1600);
}

/// A mirrored, an oblique grid: the same cells turned over, positively oriented, and the volume of the voxels.
#[test]
fn grids_lie_anywhere_in_the_world() {
    let plain = ball(4.2);
    for (axes, volume) in [
        ([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -0.5]], 1.0),
        ([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.25, 1.0]], 1.0),
        ([[1.5, 0.5, 0.0], [0.0, 2.0, 0.0], [0.25, 0.25, 1.0]], 3.0),
    ] {
        let voxels = Voxels { axes, origin: [100.0, -20.0, 3.0], ..plain.clone() };
        let found = shape(&voxels);
        assert_eq!(found.measures().volume, volume * plain.count() as f64);
        let is_positive = |cell: &[u32; 4]| crate::six_volumes(found.corners(*cell)) > 0.0;
        assert!(found.complex().cells.rows().iter().all(is_positive));
        assert_eq!(found.complex().cells.len(), shape(&plain).complex().cells.len());
        assert_eq!(found.points().positions()[7], voxels.corner(corner_of(&found, 7)));
    }
    fn corner_of(found: &AlphaShape, v: usize) -> [u32; 3] {
        let voxels = found.voxels().unwrap();
        let [x, y, z] = voxels.dims;
        let all = (0..=z).flat_map(|k| (0..=y).flat_map(move |j| (0..=x).map(move |i| [i, j, k])));
        let place = found.points().positions()[v];
        all.into_iter().find(|&at| voxels.corner(at) == place).expect("a corner of the grid")
    }
}

#[test]
fn what_has_no_solid_is_refused() {
    let solid = |voxels: Voxels| voxel_shape(voxels, |_| 0.0).unwrap_err();
    assert_eq!(solid(voxels([3; 3], |_| false)), VoxelsError::Empty.into());
    let one = voxels([3; 3], |at| at == [1; 3]);
    assert_eq!(solid(Voxels { runs: vec![[26, 2]], ..one.clone() }), VoxelsError::Runs.into());
    let far = solid(Voxels { origin: [1e16, 0.0, 0.0], ..one.clone() });
    assert!(matches!(far, ShapeError::Voxels(VoxelsError::Rounded { .. })), "{far}");
    let flat = solid(Voxels { axes: [[1.0; 3]; 3], ..one });
    assert!(matches!(flat, ShapeError::Voxels(VoxelsError::Rounded { .. })), "{flat}");
}

/// The result does not depend on how runs are cut.
#[test]
fn runs_may_span_rows() {
    let block = voxels([4, 3, 5], |_| true);
    let whole = Voxels { runs: vec![[0, 60]], ..block.clone() };
    assert_eq!(shape(&block).complex(), shape(&whole).complex());
    let rows: Simplices<3> = shape(&whole).complex().facets.clone();
    assert!(rows.rows().is_sorted());
}
