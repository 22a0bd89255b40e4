//! Reorders the points of a claim so that points near each other are also close in memory.

use walpha_base::memory::afford;
use walpha_base::parallel::prelude::*;
use walpha_complex::canonical::{smallest_even, sorted};

use super::claim::Claim;
use super::structure::Structure;
use crate::index::{for_each_bucket, in_buckets, of_bucket};
use crate::schema::PlacedComplex;
use crate::{Class, Complex, Placed, Simplices};

/// Fewer points than this fit into a cache, in any order.
const FEW: usize = 1 << 16;
/// Number of cells whose spread is sampled.
const SAMPLE: usize = 1 << 10;
/// Parts in which rows are sorted: for a million points, each fits into a cache.
const PARTS: usize = 1 << 8;

/// The claim with its points numbered along a curve, if that is worth a copy: if points are in random order, all lookups for a
/// cell are cache misses. One claim has findings if and only if the other has; but if several points refute a simplex, another
/// one may be named.
pub(super) fn gathered(claim: &Claim) -> Option<PlacedComplex> {
    let Placed { positions, complex, .. } = claim.placed;
    let pays = is_scattered(complex.cells.rows(), positions.len());
    let fits = || afford(bytes(complex, positions.len()), || "a copy".into()).is_ok();
    (pays && fits()).then(|| renumbered(claim)).flatten()
}

/// The claim with its points numbered along a curve; `None` if it names points that do not exist.
fn renumbered(claim: &Claim) -> Option<PlacedComplex> {
    let Placed { positions, weights, alpha, complex } = claim.placed;
    let old = along_curve(positions);
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
        cells: sorted_anew(cells, &new)?,
        facets: sorted_anew(facets, &new)?,
        edges: sorted_anew(edges, &new)?,
        vertices: sorted_anew(vertices, &new)?,
    };
    Some(PlacedComplex {
        positions: old.iter().map(|&v| positions[v as usize]).collect(),
        weights: old.iter().map(|&v| weights[v as usize]).collect(),
        alpha,
        complex,
        hidden: hidden.flatten(),
        duplicates: duplicates.flatten(),
        periodic: None,
        lowest: claim.lowest,
        voxels: None,
        copies: 1,
        isovalue: None,
    })
}

/// The points along a Z-order curve through boxes, 1024 along the longest axis. In each box they keep their order, so that the
/// first of equal points stays the first.
fn along_curve(positions: &[[f64; 3]]) -> Vec<u32> {
    let ends = |k: usize| {
        let coordinates = positions.iter().map(|position| position[k]);
        let low = coordinates.clone().fold(f64::INFINITY, f64::min);
        (low, coordinates.fold(f64::NEG_INFINITY, f64::max))
    };
    let ends = [0, 1, 2].map(ends);
    let longest = ends.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    let place = |position: &[f64; 3]| {
        let bits = |k: usize| {
            // Points without extent, or with more extent than a double can hold, share a box: the conversion turns NaN into 0.
            let number = ((position[k] - ends[k].0) / longest * 1023.0) as u64;
            (0..10).fold(0, |bits, i| bits | (number >> i & 1) << (3 * i + k))
        };
        bits(0) | bits(1) | bits(2)
    };
    let numbered = positions.par_iter().enumerate();
    let mut places: Vec<u64> =
        numbered.map(|(number, position)| place(position) << 32 | number as u64).collect();
    places.par_sort_unstable();
    places.into_iter().map(|place| place as u32).collect()
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

/// The number of bytes of the copy while it is made, or later with the data that is linked to it, whichever is larger.
fn bytes(complex: &Complex, points: usize) -> usize {
    fn row<const N: usize>(simplices: &Simplices<N>) -> [usize; 2] {
        [size_of::<Numbered<N>>(), size_of::<([u32; N], Class)>()]
            .map(|bytes| bytes * simplices.len())
    }
    let Complex { cells, facets, edges, vertices } = complex;
    let rows = [row(cells), row(facets), row(edges), row(vertices)];
    let in_parts = rows.iter().map(|[in_parts, _]| *in_parts).max().expect("four dimensions");
    let kept = rows.iter().map(|[_, kept]| kept).sum::<usize>();
    // Points with their weights, places on the curve, and numbers.
    kept + in_parts.max(Structure::bytes(complex)) + 60 * points
}

/// A row with its vertices sorted, whether its winding is that of the sorted vertices, and its class.
type Numbered<const N: usize> = ([u32; N], bool, Class);

/// The rows with new numbers, sorted up to their windings; `None` if one has a vertex that does not exist.
///
/// They are first distributed by parts of the numbers, and then sorted part by part: inserting a row at its place among all rows
/// would cause a cache miss.
fn sorted_anew<const N: usize>(simplices: &Simplices<N>, new: &[u32]) -> Option<Simplices<N>> {
    let (rows, classes) = (simplices.rows(), simplices.classes());
    if rows.as_flattened().par_iter().any(|&v| v as usize >= new.len()) {
        return None;
    }
    let shift = new.len().div_ceil(PARTS).next_power_of_two().trailing_zeros();
    let range = rows.len().div_ceil(rayon::current_num_threads()).max(1);
    // Windings are stored separately, so that rows compare by their sorted vertices.
    let in_parts = |(rows, classes): (&[[u32; N]], &[Class])| {
        let entries = || {
            rows.iter().zip(classes).map(|(row, &class)| {
                let row = row.map(|v| new[v as usize]);
                let sorted = sorted(row);
                (sorted[0] >> shift, (sorted, smallest_even(row) == sorted, class))
            })
        };
        in_buckets(PARTS, 1, &entries)
    };
    let ranges = rows.par_chunks(range).zip(classes.par_chunks(range));
    let ranges: Vec<(Vec<u32>, Vec<Numbered<N>>)> = ranges.map(in_parts).collect();
    let of_part =
        |part: u32| ranges.iter().map(move |(starts, entries)| &entries[of_bucket(starts, part)]);

    let mut rows = vec![[0; N]; rows.len()];
    let mut classes = vec![Class::Exterior; rows.len()];
    let (mut rows_left, mut classes_left) = (&mut rows[..], &mut classes[..]);
    let mut parts = Vec::with_capacity(PARTS);
    for part in 0..PARTS as u32 {
        let length = of_part(part).map(<[_]>::len).sum();
        let (of_rows, of_classes);
        (of_rows, rows_left) = rows_left.split_at_mut(length);
        (of_classes, classes_left) = classes_left.split_at_mut(length);
        parts.push((part, of_rows, of_classes));
    }
    parts.into_par_iter().for_each(|(part, rows, classes)| {
        let first = part << shift;
        let entries = || of_part(part).flatten().map(|entry| (entry.0[0] - first, *entry));
        let (starts, mut entries) = in_buckets(1 << shift, 1, &entries);
        for_each_bucket(&mut entries, &starts, &|bucket| {
            bucket.sort_unstable_by_key(|(row, ..)| *row);
        });
        for ((row, class), (sorted, even, given)) in rows.iter_mut().zip(classes).zip(entries) {
            (*row, *class) = (sorted, given);
            if !even {
                row.swap(N - 2, N - 1);
            }
        }
    });
    Some(Simplices::new(rows, classes).expect("as many classes as rows"))
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

    /// Each point occurs once, and equal ones are in their order; the curve passes one half after the other.
    #[test]
    fn a_curve_takes_each_point_once() {
        let mut random = Random::new(10);
        let side = f64::from(1 << 10);
        let positions: Vec<[f64; 3]> =
            (0..3000).map(|_| [0; 3].map(|_| side * random.whole(0, 9))).collect();
        let curve = along_curve(&positions);
        let mut all = curve.clone();
        all.sort_unstable();
        assert_eq!(all, (0..3000).collect::<Vec<_>>());
        let of_curve = || curve.iter().map(|&v| (positions[v as usize], v));
        let mut last = std::collections::HashMap::new();
        for (position, v) in of_curve() {
            let before = last.insert(position.map(f64::to_bits), v);
            assert!(before.is_none_or(|before| before < v));
        }
        assert!(last.len() < 2000, "{}", last.len());
        let upper = of_curve().map(|(position, _)| position[2] > 4.5 * side);
        assert!(upper.is_sorted());
        for positions in [[[1.0; 3]; 4], [[f64::MIN; 3], [f64::MAX; 3], [0.0; 3], [1.0; 3]]] {
            assert_eq!(along_curve(&positions), [0, 1, 2, 3]);
        }
    }

    /// Rows are sorted as in a single sort, with their windings and classes.
    #[test]
    fn rows_are_sorted_anew() {
        let mut random = Random::new(11);
        for points in [4, PARTS, 20 * PARTS + 7] {
            let mut new: Vec<u32> = (0..points as u32).collect();
            random.shuffle(&mut new);
            let mut rows: Vec<([u32; 4], Class)> = Vec::new();
            while rows.len() < 20_000 {
                let row = [0; 4].map(|_| random.below(points) as u32);
                let class = random.pick(&[Class::Interior, Class::Regular, Class::Singular]);
                if (1..4).all(|i| !row[..i].contains(&row[i])) {
                    rows.push((row, class));
                }
            }
            let given: Simplices<4> = rows.iter().copied().collect();
            let mut expected: Vec<([u32; 4], Class)> =
                rows.iter().map(|&(row, class)| (row.map(|v| new[v as usize]), class)).collect();
            for (row, _) in &mut expected {
                *row = smallest_even(*row);
            }
            let key = |&(row, class): &([u32; 4], Class)| (sorted(row), row, class as u8);
            expected.sort_unstable_by_key(key);
            let mut found: Vec<([u32; 4], Class)> =
                sorted_anew(&given, &new).unwrap().into_iter().collect();
            assert!(found.is_sorted_by_key(|(row, _)| sorted(*row)));
            // Rows that are repeated are in any order.
            found.sort_unstable_by_key(key);
            assert_eq!(found, expected, "{points}");
            rows[0].0[3] = points as u32;
            assert_eq!(sorted_anew(&rows.into_iter().collect::<Simplices<4>>(), &new), None);
        }
    }

    /// The verdict equals that of the original claim, for a correct claim and for one with a wrong class, list or simplex.
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
            let gathered = renumbered(&claim).expect("all points exist");
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

    /// Removes one cell or facet.
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
