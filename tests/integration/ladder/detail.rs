//! Levels of detail with a region of full detail.

use std::collections::{BTreeMap, BTreeSet};

use walpha::points::{Region, focus};
use walpha::points::{Selection, SelectionRule, Units, difference, select};
use walpha::shape::Engine;
use walpha::{Class, WeightedPoints};

use super::{alpha, one_by_one};

/// Full detail in a region and few points elsewhere are one triangulation: no crack at the border.
#[test]
fn a_region_of_full_detail_leaves_no_crack() {
    let volume = walpha::volume::sample("sample:phantom@32").unwrap();
    let (volume, _) = volume.into_gray(walpha::Gray::Automatic).unwrap();
    let differences = difference(&volume);
    let points = |count| {
        let selection = Selection::default().rule(SelectionRule::Count(count));
        select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap()
    };
    let (fine, coarse) = (points(4000), points(900));
    let region = Region { low: [0.0, 8.0, 10.0], high: [31.0, 31.0, 20.0] };
    let both = focus(&fine, &coarse, &region);

    let key = |p: [f64; 3]| [2, 1, 0].map(|k| p[k] as i64);
    let inside = fine.positions.iter().filter(|p| region.contains(**p));
    let outside = coarse.positions.iter().filter(|p| !region.contains(**p));
    let union: BTreeSet<[i64; 3]> = inside.chain(outside).map(|&p| key(p)).collect();
    assert!(union.len() > 1000 && union.len() < 4000, "{}", union.len());
    assert!(both.positions.iter().map(|&p| key(p)).eq(union.iter().copied()));

    let alpha = alpha(10.0);
    let of = |positions: Vec<[f64; 3]>| {
        let weights = vec![0.0; positions.len()];
        one_by_one(&WeightedPoints::new(positions, weights).unwrap(), alpha, false, Engine::Native)
    };
    let shape = of(both.positions.clone());
    let plain = of(union.iter().map(|&[z, y, x]| [x, y, z].map(|k| k as f64)).collect());
    assert_eq!(shape.complex(), plain.complex());
    // Cells reach across the border, and the boundary of the solid has no end there or anywhere.
    let within = |v: &u32| region.contains(both.positions[*v as usize]);
    let mut cells = shape.complex().cells.of(Class::Interior);
    assert!(cells.any(|cell| cell.iter().any(within) && !cell.iter().all(within)));
    let mut sides = BTreeMap::<[u32; 2], usize>::new();
    for &[a, b, c] in shape.complex().facets.of(Class::Regular) {
        for [a, b] in [[a, b], [b, c], [a, c]] {
            *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    assert!(sides.values().all(|count| count % 2 == 0));
}
