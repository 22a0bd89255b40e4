//! Cells that are not listed although all their faces are.

use walpha_base::parallel::prelude::*;
use walpha_base::{Cancelled, Monitor};
use walpha_complex::canonical::{outward_facets, smallest_even, sort, sorted};

use super::emptiness::Emptiness;
use super::finding::Finding;
use super::structure::{NONE, Points, Structure};
use crate::exact::{Side, orientation, radius, radius_value, side};
use crate::index::{for_each_bucket, in_buckets, of_bucket};
use crate::parallel::of_each;
use crate::{Alpha, Class, Complex};

/// The cells that belong in gaps between four listed facets, positively oriented, with their classes.
///
/// A gap is bounded by facets that lack a cell on its side. In a whole triangulation, no vertex of a neighbour may be inside the
/// sphere of its cell; in a shape alone, the sphere must fit α, and no point nearby may be inside. If further points are on the
/// sphere, their cells are listed, or the gap is a missing cell.
pub(super) fn missing_cells(
    structure: &Structure,
    points: Points,
    alpha: Alpha,
    emptiness: Option<&Emptiness>,
    monitor: &Monitor,
) -> Result<Vec<([u32; 4], Class)>, Cancelled> {
    let facets = structure.complex.facets.rows();
    let open = |facet: u32| facet != NONE && structure.sides[facet as usize][1] == NONE;
    let open_rows: Vec<u32> =
        (0..facets.len() as u32).into_par_iter().filter(|&facet| open(facet)).collect();
    // The open facets by their two smaller vertices, because each gap is found from the facet without its largest vertex.
    let entries = || {
        open_rows.iter().map(|&facet| {
            let [a, b, c] = sorted(facets[facet as usize]);
            (a, [b, c])
        })
    };
    let (starts, mut around) = in_buckets(points.len(), rayon::current_num_threads(), &entries);
    for_each_bucket(&mut around, &starts, &|bucket| bucket.sort_unstable());
    let apexes = |[a, b]: [u32; 2]| {
        let around = &around[of_bucket(&starts, a)];
        let from = around.partition_point(|[other, _]| *other < b);
        &around[from..][..around[from..].partition_point(|[other, _]| *other == b)]
    };
    let gaps = |i: usize| {
        let facet = open_rows[i];
        let [a, b, c] = sorted(facets[facet as usize]);
        let sides = [[a, b], [a, c], [b, c]].map(apexes);
        let fewest = sides.into_iter().min_by_key(|apexes| apexes.len()).expect("three edges");
        fewest.iter().filter(move |[_, d]| *d > c).filter_map(move |&[_, d]| {
            let others = [[a, b, d], [a, c, d], [b, c, d]].map(|facet| structure.facets.row(facet));
            let gap = others.into_iter().all(open) && structure.cells.row([a, b, c, d]) == NONE;
            let rows = [facet, others[0], others[1], others[2]];
            gap.then(|| judge(structure, points, alpha, emptiness, [a, b, c, d], rows)).flatten()
        })
    };
    of_each(open_rows.len(), monitor, gaps)
}

/// The cell of a gap and its class, if the definition has it.
fn judge(
    structure: &Structure,
    points: Points,
    alpha: Alpha,
    emptiness: Option<&Emptiness>,
    [a, b, c, d]: [u32; 4],
    facets: [u32; 4],
) -> Option<([u32; 4], Class)> {
    let [p, q, r, s] = points.positions_of([a, b, c, d]);
    let cell = match orientation(p, q, r, s) {
        std::cmp::Ordering::Greater => [a, b, c, d],
        std::cmp::Ordering::Less => [a, b, d, c],
        std::cmp::Ordering::Equal => return None,
    };
    let corners = points.corners(cell);
    let sides = outward_facets(cell).map(|facet| (sorted(facet), smallest_even(facet)));
    for half in facets.iter().flat_map(|&facet| structure.halves(facet as usize)) {
        let outward = structure.outward(half);
        let same_side = sides.contains(&(sorted(outward), smallest_even(outward)));
        let apex = points.get(structure.apex(half));
        if same_side || side(corners.each_ref(), &apex) == Side::Inside {
            return None;
        }
    }
    let fits = radius(corners.each_ref(), alpha).is_le();
    let missing = emptiness.is_none_or(|near| fits && near.refuter(cell).is_none());
    missing.then_some((cell, if fits { Class::Interior } else { Class::Exterior }))
}

/// The missing cells of a shape alone that the tie rule makes.
pub(super) fn by_rule(
    missing: &[([u32; 4], Class)],
    emptiness: Option<&Emptiness>,
) -> Vec<([u32; 4], Class)> {
    let is_made =
        |(cell, _): &&_| emptiness.is_some_and(|near| near.refuter_of_cell(*cell).is_none());
    missing.iter().filter(is_made).copied().collect()
}

/// The complex with these cells.
pub(super) fn filled(complex: &Complex, missing: &[([u32; 4], Class)]) -> Complex {
    let mut filled = complex.clone();
    for &(cell, class) in missing {
        filled.cells.push(smallest_even(cell), class);
    }
    sort(&mut filled);
    filled
}

/// One finding for each missing cell.
pub(super) fn findings(missing: &[([u32; 4], Class)], points: Points) -> Vec<Finding> {
    let finding = |&(cell, class): &([u32; 4], Class)| Finding::MissingCell {
        cell: smallest_even(cell).into(),
        class,
        radius_squared: radius_value(points.corners(cell).each_ref()),
    };
    missing.iter().map(finding).collect()
}
