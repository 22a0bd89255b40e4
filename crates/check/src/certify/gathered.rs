//! The same claim with its points in another order, in which those that are near are beside each other in memory.

use rayon::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};

use super::claim::Claim;
use super::grid::Grid;
use super::structure::{Points, Structure, sites};
use crate::index::{for_each_bucket, in_buckets};
use crate::schema::PlacedComplex;
use crate::{Class, Complex, Placed, Simplices};

/// Fewer points than this fit into a cache, in whatever order they are.
const FEW: usize = 1 << 16;
/// Cells whose spread is looked at.
const SAMPLE: usize = 1 << 10;

/// The claim with its points numbered box by box, if that is worth a copy: where points are in random order, everything that is
/// looked up of a cell is a cache miss. Nothing is found of one claim if and only if nothing is found of the other; but of several
/// points that refute a simplex another may be named.
pub(super) fn gathered(claim: &Claim) -> Option<PlacedComplex> {
    let Placed { positions, complex, .. } = claim.placed;
    let pays = is_scattered(complex.cells.rows(), positions.len());
    let fits = || Vec::<u8>::new().try_reserve_exact(bytes(complex, positions.len())).is_ok();
    (pays && fits()).then(|| in_boxes(claim)).flatten()
}

/// The claim with its points numbered box by box; `None` if it names points that do not exist.
fn in_boxes(claim: &Claim) -> Option<PlacedComplex> {
    let Placed { positions, weights, alpha, complex } = claim.placed;
    let old = {
        let sites = sites(positions, weights);
        let all = (0..positions.len() as u32).collect();
        // In each box as they were, so that of equal points the first stays the first.
        Grid::new(Points { sites: &sites }, all).into_points()
    };
    let mut new = vec![0; old.len()];
    (0..).zip(&old).for_each(|(new_number, &old)| new[old as usize] = new_number);
    let list = |numbers: &[u32]| numbers.iter().map(|&v| new.get(v as usize).copied()).collect();
    let pairs = |pairs: &[[u32; 2]]| {
        let numbers: Option<Vec<u32>> = list(pairs.as_flattened());
        numbers.map(|numbers| numbers.as_chunks::<2>().0.to_vec())
    };
    let hidden = claim.hidden.map(list);
    let duplicates = claim.duplicates.map(pairs);
    if hidden == Some(None) || duplicates == Some(None) {
        return None;
    }
    let Complex { cells, facets, edges, vertices } = complex;
    let complex = Complex {
        cells: renumbered(cells, &new)?,
        facets: renumbered(facets, &new)?,
        edges: renumbered(edges, &new)?,
        vertices: renumbered(vertices, &new)?,
    };
    Some(PlacedComplex {
        positions: old.iter().map(|&v| positions[v as usize]).collect(),
        weights: old.iter().map(|&v| weights[v as usize]).collect(),
        alpha,
        complex,
        hidden: hidden.flatten(),
        duplicates: duplicates.flatten(),
        periodic: None,
    })
}

/// Whether the numbers of a cell's vertices usually differ by more than an eighth of all points.
fn is_scattered(cells: &[[u32; 4]], points: usize) -> bool {
    let sample = cells.iter().step_by(cells.len() / SAMPLE + 1);
    let spread = |cell: &[u32; 4]| {
        let ends = cell.iter().max().zip(cell.iter().min());
        ends.map_or(0, |(last, first)| (last - first) as usize)
    };
    let far = sample.clone().filter(|cell| spread(cell) > points / 8).count();
    points >= FEW && 2 * far > sample.count()
}

/// Bytes that the copy takes while it is made, or later with what is linked to it, whichever is more.
fn bytes(complex: &Complex, points: usize) -> usize {
    fn row<const N: usize>(simplices: &Simplices<N>) -> [usize; 2] {
        let sorted = 2 * size_of::<Numbered<N>>();
        [sorted, size_of::<([u32; N], Class)>()].map(|bytes| bytes * simplices.len())
    }
    let Complex { cells, facets, edges, vertices } = complex;
    let rows = [row(cells), row(facets), row(edges), row(vertices)];
    let sorted = rows.iter().map(|[sorted, _]| *sorted).max().expect("four dimensions");
    let kept = rows.iter().map(|[_, kept]| kept).sum::<usize>();
    // Points with their weights twice, four boxes each, and numbers.
    kept + sorted.max(Structure::bytes(complex)) + 100 * points
}

/// A row with its vertices sorted, whether its winding is theirs, and its class.
type Numbered<const N: usize> = ([u32; N], bool, Class);

/// The rows with new numbers, sorted up to their windings; `None` if one has a vertex that does not exist.
fn renumbered<const N: usize>(simplices: &Simplices<N>, new: &[u32]) -> Option<Simplices<N>> {
    if simplices.rows().as_flattened().par_iter().any(|&v| v as usize >= new.len()) {
        return None;
    }
    let rows = simplices.rows().par_iter().zip(simplices.classes());
    // Windings are kept apart, so that rows compare by their sorted vertices.
    let renumbered = rows.map(|(row, &class)| {
        let row = row.map(|v| new[v as usize]);
        (sorted(row), smallest_even(row) == sorted(row), class)
    });
    let renumbered: Vec<Numbered<N>> = renumbered.collect();
    let entries = || renumbered.iter().map(|entry| (entry.0[0], *entry));
    let (starts, mut rows) = in_buckets(new.len(), &entries);
    drop(renumbered);
    for_each_bucket(&mut rows, &starts, &|bucket| bucket.sort_unstable_by_key(|(row, ..)| *row));
    let wound = rows.par_iter().map(|&(mut row, even, _)| {
        if !even {
            row.swap(N - 2, N - 1);
        }
        row
    });
    let classes = rows.par_iter().map(|&(.., class)| class);
    Some(Simplices::new(wound.collect(), classes.collect()).expect("as many classes as rows"))
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;
    use crate::{Alpha, enumerate};

    #[test]
    fn points_in_random_order_are_scattered() {
        let mut random = Random::new(8);
        let near: Vec<[u32; 4]> = (0..FEW as u32 - 4).map(|v| [v, v + 1, v + 2, v + 3]).collect();
        let far: Vec<[u32; 4]> =
            near.iter().map(|_| [0; 4].map(|_| random.below(FEW) as u32)).collect();
        assert!(is_scattered(&far, FEW));
        assert!(!is_scattered(&near, FEW));
        assert!(!is_scattered(&far, FEW - 1));
        assert!(!is_scattered(&[], FEW));
    }

    /// The verdict is that of the claim as it is: where it is right, and where a class, a list or a simplex is wrong.
    #[test]
    fn verdicts_do_not_depend_on_the_order_of_points() {
        let mut random = Random::new(9);
        let (mut right, mut tied, mut wrong) = (0, 0, 0);
        for round in 0..600 {
            let side = random.pick(&[1, 2, 50]);
            let positions: Vec<[f64; 3]> =
                (0..11).map(|_| [0; 3].map(|_| random.whole(0, side))).collect();
            let weights: Vec<f64> = positions.iter().map(|_| random.whole(0, 1)).collect();
            let alpha = Alpha::from_squared(random.whole(0, 2 * side * side)).unwrap();
            let Ok(made) = enumerate(&positions, &weights, alpha) else { continue };
            let mut complex = made.complex;
            let (mut hidden, mut duplicates) = (made.hidden, made.duplicates);
            if round % 2 == 0 {
                complex.retain_shape();
            }
            match random.below(8) {
                0 => complex = without_one(&complex, &mut random),
                1 => _ = hidden.pop(),
                2 => _ = duplicates.pop(),
                3 => duplicates.iter_mut().for_each(|pair| pair.swap(0, 1)),
                4 => hidden.push(random.below(11) as u32),
                _ => {}
            }
            let claim = Claim::new(Placed::new(&positions, &weights, alpha, &complex))
                .with_hidden(&hidden[..])
                .with_duplicates(&duplicates[..]);
            let (findings, certificate) = claim.findings().unwrap();
            let gathered = in_boxes(&claim).expect("all points exist");
            let (others, other) = gathered.claim().with_extent(claim.extent).findings().unwrap();
            assert_eq!(other.verdict, certificate.verdict, "{findings:?} {others:?}");
            if findings.is_empty() {
                assert_eq!(other, certificate);
            }
            match certificate.findings {
                0 => right += 1,
                all if all == certificate.ties => tied += 1,
                _ => wrong += 1,
            }
        }
        assert!(right > 100 && wrong > 100, "{right} {tied} {wrong}");
    }

    /// Without one cell or facet.
    fn without_one(complex: &Complex, random: &mut Random) -> Complex {
        fn but<const N: usize>(simplices: &Simplices<N>, row: usize) -> Simplices<N> {
            let rows = simplices.iter().enumerate().filter(|(i, _)| *i != row);
            rows.map(|(_, (row, class))| (*row, class))
                .collect::<Vec<([u32; N], Class)>>()
                .into_iter()
                .collect()
        }
        let mut complex = complex.clone();
        if random.below(2) == 0 && !complex.cells.is_empty() {
            complex.cells = but(&complex.cells, random.below(complex.cells.len()));
        } else if !complex.facets.is_empty() {
            complex.facets = but(&complex.facets, random.below(complex.facets.len()));
        }
        complex
    }
}
