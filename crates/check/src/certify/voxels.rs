//! Judges the solid of labels: that its cells fill exactly the voxels of a region, face to face.
//!
//! Everything is judged in index space, where the corners of voxels are integers. Two further rules are that the position of a
//! point equals that of the corner to the last bit, and that cells are positively oriented at these positions.
//!
//! **Why the rules imply it.** The cells are positively oriented. A facet has one cell or two. Two cells lie on different sides,
//! and a single cell makes the facet half of a face between a voxel of the region and one outside, with the cell on the side of
//! the region. Each such face consists of two of these facets, which share its diagonal. So the chain of all cells has the same
//! boundary as the chain of the region's voxels. Their difference has no boundary, and in space only the empty chain has none. As
//! all cells count positively, each place of the region is in one cell, and no other place is in any. There is no rule for voxels
//! inside: the cells may cut them in any way.

use walpha_base::Monitor;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};

use super::certificate::{Certificate, CertifyError, NotJudged, Verdict};
use super::finding::Finding;
use super::geometry::{orientations, six_volumes};
use super::structure::{self, Points, Structure};
use crate::exact::{Exact, orientation};
use crate::index::NONE;
use crate::schema::PlacedComplex;
use crate::{Class, Complex, Voxels};

/// A place of the lattice of corners, or a voxel.
type Place = [u32; 3];

/// All broken rules, and the certificate.
pub(super) fn findings(
    placed: &PlacedComplex,
    voxels: &Voxels,
    monitor: &Monitor,
) -> Result<(Vec<Finding>, Certificate), CertifyError> {
    placed.claim().check()?;
    let complex = &placed.complex;
    let sites = structure::sites(&placed.positions, &placed.weights);
    let points = Points { sites: &sites };
    let mut found = structure::rows(complex, points.len());
    let mut six = Exact::default();
    let mut all_rules = false;
    if found.is_empty() {
        let (structure, broken) = Structure::new(complex, points, &monitor.part(0, 4, 10))?;
        found.extend(broken);
        found.extend(orientations(complex.cells.rows(), points, &monitor.part(4, 5, 10))?);
        found.extend(accounts(placed));
        let (corners, misplaced) = corners(&placed.positions, voxels);
        found.extend(misplaced);
        if found.is_empty() {
            let of_cells = six_volumes(complex.cells.rows(), points, &monitor.part(5, 7, 10))?;
            six = Exact::integer(of_cells.0, of_cells.1);
            found.extend(cells(complex, &corners, voxels));
            found.extend(facets(&structure, &corners, voxels));
            monitor.part(7, 9, 10).report(1, 1)?;
            found.extend(faces(&structure));
            all_rules = true;
        }
    }
    monitor.report(10, 10)?;
    let not_judged = if all_rules { Vec::new() } else { vec![NotJudged::AfterFindings] };
    let certificate = Certificate {
        verdict: Verdict::of(found.len(), 0),
        findings: found.len(),
        ties: 0,
        six_volumes: six,
        not_judged,
    };
    Ok((found, certificate))
}

/// Points that are listed in a role that a corner does not have, or that are not vertices of a cell.
pub(super) fn accounts(placed: &PlacedComplex) -> Vec<Finding> {
    let mut is_in_cell = vec![false; placed.positions.len()];
    for &v in placed.complex.cells.rows().as_flattened() {
        is_in_cell[v as usize] = true;
    }
    let alone = (0..).zip(is_in_cell).filter(|(_, there)| !there);
    let mut found: Vec<Finding> = alone.map(|(point, _)| Finding::Unaccounted { point }).collect();
    let hidden = placed.hidden.iter().flatten();
    found.extend(hidden.map(|&point| Finding::NotOnlyHidden { point }));
    let duplicates = placed.duplicates.iter().flatten();
    found.extend(duplicates.map(|&[point, kept]| Finding::Duplicate {
        point,
        given: Some(kept),
        expected: None,
    }));
    found
}

/// The corner at each point; findings for points that are not at a corner, and for several points at the same one.
fn corners(positions: &[[f64; 3]], voxels: &Voxels) -> (Vec<Place>, Vec<Finding>) {
    let [a, b, c] = voxels.axes;
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let inverse = [cross(b, c), cross(c, a), cross(a, b)];
    let corner = |position: &[f64; 3]| {
        let from = [0, 1, 2].map(|k| position[k] - voxels.origin[k]);
        // The approximate place; the position decides the exact one.
        let at = inverse.map(|row| {
            let index = (0..3).map(|k| row[k] * from[k]).sum::<f64>() / voxels.determinant();
            (index + 0.5).round() as u32
        });
        let inside = (0..3).all(|k| at[k] <= voxels.dims[k]);
        if inside && voxels.corner(at) == *position { Ok(at) } else { Err(at) }
    };
    let corners: Vec<_> = positions.par_iter().map(corner).collect();
    let mut order: Vec<u32> = (0..corners.len() as u32).collect();
    let place = |v: u32| corners[v as usize].unwrap_or_else(|at| at);
    order.par_sort_unstable_by_key(|&v| (place(v), v));
    let mut wrong: Vec<u32> = order
        .windows(2)
        .filter(|pair| place(pair[0]) == place(pair[1]))
        .map(|pair| pair[1])
        .chain((0..corners.len() as u32).filter(|&v| corners[v as usize].is_err()))
        .collect();
    wrong.sort_unstable();
    wrong.dedup();
    let places = (0..corners.len() as u32).map(place).collect();
    (places, wrong.into_iter().map(|point| Finding::NotACorner { point }).collect())
}

/// Whether the axes of the grid are left-handed.
fn is_mirrored(voxels: &Voxels) -> bool {
    let [a, b, c] = voxels.axes;
    orientation(a, b, c, [0.0; 3]).is_gt()
}

/// Judges that cells are in the shape, and positively oriented in index space.
fn cells(complex: &Complex, corners: &[Place], voxels: &Voxels) -> Vec<Finding> {
    let mirrored = is_mirrored(voxels);
    let judge = |(cell, class): (&[u32; 4], &Class)| {
        let [a, b, c, d] = cell.map(|v| corners[v as usize].map(i128::from));
        let [u, v, w] = [b, c, d].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
        let volume = u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1);
        let volume = if mirrored { -volume } else { volume };
        let flat = (volume <= 0).then(|| Finding::Orientation {
            cell: (*cell).into(),
            six_volumes: Exact::integer(volume.into(), 0),
        });
        let outside = wrong_class(*cell, *class, Class::Interior);
        flat.into_iter().chain(outside)
    };
    complex.cells.rows().par_iter().zip(complex.cells.classes()).flat_map_iter(judge).collect()
}

/// The finding for a class, if it is not the expected one.
pub(super) fn wrong_class<const N: usize>(
    row: [u32; N],
    given: Class,
    expected: Class,
) -> Option<Finding> {
    (given != expected).then(|| Finding::Class {
        simplex: row.into(),
        given,
        expected,
        radius_squared: None,
        refuted_by: None,
    })
}

/// Half of a face of a voxel: the face, by its corner of the least indices and the axis across it, and the corner of the face that it
/// leaves out, as two bits.
type Half = (Place, usize, usize);

/// Judges facets: their classes, their orientation, and that those with one cell cover the border of the region.
fn facets(structure: &Structure, corners: &[Place], voxels: &Voxels) -> Vec<Finding> {
    let facets = &structure.complex.facets;
    let judge = |row: usize| {
        let (facet, class) = (facets.rows()[row], facets.classes()[row]);
        let mut halves = structure.halves(row);
        match (halves.next(), halves.next()) {
            (None, _) => (None, Some(Finding::Stray { simplex: facet.into() })),
            (Some(one), Some(other)) => {
                let [a, b] = [one, other].map(|half| smallest_even(structure.outward(half)));
                if a == b {
                    let cells = structure.complex.cells.rows();
                    let cells = [cells[one.cell].into(), cells[other.cell].into()];
                    return (None, Some(Finding::Overlap { facet: facet.into(), cells }));
                }
                (None, wrong_class(facet, class, Class::Interior))
            }
            (Some(half), None) => {
                let outward = structure.outward(half);
                let Some(border) = border(outward, corners, voxels) else {
                    return (None, Some(Finding::NotABorder { facet: facet.into() }));
                };
                let behind = structure.apex(half);
                let winding = (facet != smallest_even(outward))
                    .then(|| Finding::Winding { facet: facet.into(), behind });
                (Some((border, row)), wrong_class(facet, class, Class::Regular).or(winding))
            }
        }
    };
    let judged: Vec<_> = (0..facets.len()).into_par_iter().map(judge).collect();
    let (borders, found): (Vec<_>, Vec<_>) = judged.into_iter().unzip();
    let mut found: Vec<Finding> = found.into_iter().flatten().collect();
    let mut borders: Vec<(Half, usize)> = borders.into_iter().flatten().collect();
    borders.par_sort_unstable();
    for of_face in borders.chunk_by(|a, b| (a.0.0, a.0.1) == (b.0.0, b.0.1)) {
        let is_whole = matches!(of_face, [((.., one), _), ((.., other), _)] if *one == 3 - *other);
        if !is_whole {
            let facet = |&(_, row): &(Half, usize)| facets.rows()[row].into();
            found.extend(of_face.iter().map(|half| Finding::NotABorder { facet: facet(half) }));
        }
    }
    let is_covered = |corner: Place, axis: usize| {
        borders.binary_search_by(|((at, across, _), _)| (*at, *across).cmp(&(corner, axis))).is_ok()
    };
    let unfilled = voxels.runs.par_iter().flat_map_iter(|&[first, count]| {
        (first..first + count).flat_map(|number| {
            let voxel = voxels.indices(number);
            let sides = [-3, -2, -1, 1, 2, 3].into_iter();
            sides
                .filter(move |&side| {
                    let axis = usize::from(side_axis(side));
                    let (mut corner, mut beyond) = (voxel, voxel.map(i64::from));
                    corner[axis] += u32::from(side > 0);
                    beyond[axis] += i64::from(side.signum());
                    !holds(voxels, beyond) && !is_covered(corner, axis)
                })
                .map(move |side| Finding::Unfilled { voxel, side })
        })
    });
    found.par_extend(unfilled);
    found
}

/// The axis across a side.
fn side_axis(side: i8) -> u8 {
    side.unsigned_abs() - 1
}

/// The half of a face that a facet is, if it lies between a voxel of the region and one outside of it, towards which it turns.
fn border(outward: [u32; 3], corners: &[Place], voxels: &Voxels) -> Option<Half> {
    let places = outward.map(|v| corners[v as usize]);
    let least = [0, 1, 2].map(|k| places.iter().map(|place| place[k]).min().unwrap_or_default());
    let most = [0, 1, 2].map(|k| places.iter().map(|place| place[k]).max().unwrap_or_default());
    let mut flat = (0..3).filter(|&k| least[k] == most[k]);
    let (Some(across), None) = (flat.next(), flat.next()) else { return None };
    let along = [(across + 1) % 3, (across + 2) % 3];
    if along.iter().any(|&k| most[k] - least[k] != 1) {
        return None;
    }
    // Encodes each corner of the face in two bits; their exclusive or is the corner that is left out.
    let bits = places.map(|place| {
        (place[along[0]] - least[along[0]]) as usize
            | ((place[along[1]] - least[along[1]]) as usize) << 1
    });
    let out = bits[0] ^ bits[1] ^ bits[2];
    // In the plane of the next two axes it turns counter-clockwise, as seen from the side of larger indices.
    let [u, v] = [1, 2].map(|i| along.map(|k| i64::from(places[i][k]) - i64::from(places[0][k])));
    let turns_up = (u[0] * v[1] - u[1] * v[0] > 0) != is_mirrored(voxels);
    let behind = least.map(i64::from);
    let mut before = behind;
    before[across] -= 1;
    let (inside, outside) = if turns_up { (before, behind) } else { (behind, before) };
    (holds(voxels, inside) && !holds(voxels, outside)).then_some((least, across, out))
}

/// Whether a voxel is in the region.
fn holds(voxels: &Voxels, at: [i64; 3]) -> bool {
    let dims = voxels.dims.map(i64::from);
    if (0..3).any(|k| !(0..dims[k]).contains(&at[k])) {
        return false;
    }
    let [x, y, z] = at.map(|i| i as u64);
    let number = x + dims[0] as u64 * (y + dims[1] as u64 * z);
    let after = voxels.runs.partition_point(|&[first, _]| first <= number);
    after.checked_sub(1).is_some_and(|at| number - voxels.runs[at][0] < voxels.runs[at][1])
}

/// Judges edges and vertices: that exactly those of facets are listed, and that they are on the boundary if a facet with one cell
/// is at them.
pub(super) fn faces(structure: &Structure) -> Vec<Finding> {
    let Complex { facets, edges, vertices, .. } = structure.complex;
    let (mut of_edges, mut of_vertices) = (vec![None; edges.len()], vec![None; vertices.len()]);
    let mut found = Vec::new();
    for (row, &facet) in facets.rows().iter().enumerate() {
        let class =
            if structure.halves(row).count() == 1 { Class::Regular } else { Class::Interior };
        let [a, b, c] = facet;
        for edge in [[a, b], [a, c], [b, c]].map(sorted) {
            match structure.edges.row(edge) {
                NONE => found.push(Finding::MissingFace { face: edge.into(), of: facet.into() }),
                at => of_edges[at as usize] = of_edges[at as usize].max(Some(class)),
            }
        }
        for vertex in facet {
            match structure.vertices.row([vertex]) {
                NONE => {
                    let face = [vertex].into();
                    found.push(Finding::MissingFace { face, of: facet.into() });
                }
                at => of_vertices[at as usize] = of_vertices[at as usize].max(Some(class)),
            }
        }
    }
    found.extend(
        edges
            .iter()
            .zip(of_edges)
            .filter_map(|((&row, given), expected)| judged(row, given, expected)),
    );
    found.extend(
        vertices
            .iter()
            .zip(of_vertices)
            .filter_map(|((&row, given), expected)| judged(row, given, expected)),
    );
    found
}

/// The finding for a simplex to which facets give a class, or none.
fn judged<const N: usize>(row: [u32; N], given: Class, expected: Option<Class>) -> Option<Finding> {
    match expected {
        None => Some(Finding::Stray { simplex: row.into() }),
        Some(expected) => wrong_class(row, given, expected),
    }
}
