//! The sheets of the boundary of a region of voxels.

use walpha_base::UnionFind;
use walpha_base::parallel::prelude::*;

use crate::bits::Bits;
use crate::{Class, Complex, Sheets};

/// The sheets: the boundary facets that are seen from one part of the space outside. Around a corner the space outside consists
/// of octants, each in a voxel. Two that share a face are in one part of it, and so are those that a facet has at its three
/// corners.
pub(super) fn sheets(complex: &Complex, corners: &[[u32; 3]], region: &Bits) -> Sheets {
    // Octant o of corner v is 8 v + o. Bit k of o says whether it is after the corner along axis k.
    let octants = UnionFind::new(8 * corners.len());
    let place = |v: u32| corners[v as usize].map(i64::from);
    let is_outside = |at: [i64; 3], octant: u32| {
        !region.has([0, 1, 2].map(|k| at[k] - i64::from(octant >> k & 1 == 0)))
    };
    let at_boundary = complex.vertices.rows().par_iter().zip(complex.vertices.classes());
    at_boundary.filter(|(_, class)| **class == Class::Regular).for_each(|(&[v], _)| {
        for octant in (0..8).filter(|&octant| is_outside(place(v), octant)) {
            let next = (0..3).map(|k| octant | 1 << k).filter(|&next| next != octant);
            next.filter(|&next| is_outside(place(v), next)).for_each(|next| {
                octants.unite(8 * v + octant, 8 * v + next);
            });
        }
    });
    let seen_from = |&facet: &[u32; 3]| {
        let places = facet.map(place);
        let least = [0, 1, 2].map(|k| places.iter().map(|place| place[k]).fold(i64::MAX, i64::min));
        let is_flat = |&k: &usize| places.iter().all(|place| place[k] == least[k]);
        let across = (0..3).find(is_flat).expect("a boundary facet is half of a face of a voxel");
        let mut outside = least;
        if region.has(outside) {
            outside[across] -= 1;
        }
        facet.map(|v| {
            let after = |k: usize| u32::from(outside[k] == place(v)[k]) << k;
            8 * v + after(0) + after(1) + after(2)
        })
    };
    let facets: Vec<_> = complex.facets.of(Class::Regular).collect();
    let seen: Vec<u32> = facets
        .par_iter()
        .map(|facet| {
            let [a, b, c] = seen_from(facet);
            octants.unite(a, b);
            octants.unite(a, c);
            a
        })
        .collect();
    let names: Vec<u32> = seen.par_iter().map(|&octant| octants.find(octant)).collect();
    Sheets::numbered(complex, &names, &[])
}
