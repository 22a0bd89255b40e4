//! Pores of a periodic box: the spheres that fit between its points, and how far they get.
//!
//! The complement of the shape at α is the union of the interiors of the cells and facets that enter later, but for what the balls of the shape cover in them; it
//! has the homotopy type of what the balls of squared radius α + ω leave (Edelsbrunner 1995, doi:10.1007/BF02574053). So a sphere around a
//! place that no ball covers can move from one copy of that place to another if and only if a component of the complement winds round the box.

use std::cmp::Reverse;

use walpha_base::sort::sort_by_key;
use walpha_regular::internals::centre_shares;

use super::Ordered;
use crate::Alpha;
use crate::ladder::Filtration;
use crate::winding::{Directions, United, WindingSets};

/// A sphere orthogonal to points, which limits the spheres that fit between them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PoreSphere {
    /// Its squared radius: the distance from each of its points, squared, less the weight.
    pub alpha: f64,
    /// Its centre, in the box.
    pub center: [f64; 3],
    /// The input indices of its points: four, or three of the narrowest place of a way.
    pub points: Vec<u32>,
}

/// The largest spheres in the pores of a periodic box.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pores {
    /// The largest sphere that no point is in.
    pub included: PoreSphere,
    /// The narrowest place of the widest way from any place to another copy of it.
    pub free: PoreSphere,
    /// The same for ways that go round along each of the vectors of the box: they end at a copy that is moved by a multiple of this vector that is
    /// not 0, and by any multiples of the others.
    pub free_along: [PoreSphere; 3],
    /// The largest sphere on the widest way.
    pub included_along_free: PoreSphere,
}

/// A part of what balls leave of a periodic box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PorePart {
    /// The number of independent directions in which it winds round the box: 0 of a pocket without a way out, otherwise the dimension of a channel.
    pub dimension: usize,
    /// The number of its cells.
    pub cells: usize,
}

impl Ordered<'_> {
    /// The largest spheres between the points of a periodic box; `None` unless it repeats along all three vectors. O(n α(n)).
    #[expect(clippy::missing_panics_doc, reason = "an invariant")]
    pub fn pores(&self) -> Option<Pores> {
        let filtration = self.filtration();
        let torus = filtration.torus().filter(|torus| torus.dimension() == 3)?;
        let [_, _, of_facets, of_cells] = self.numbers.first;
        let included = self.order().iter().rev().find(|&&number| number >= of_cells);
        let included = self.pore_sphere(*included.expect("a torus has cells"));
        let mut sets = WindingSets::new(self.cells.len());
        // The largest cell of each set, by the number of its root.
        let mut largest: Vec<u32> = vec![0; self.cells.len()];
        (of_cells..).zip(&self.cell_rows).for_each(|(number, &row)| largest[row as usize] = number);
        let (mut free, mut along) = (None, [const { None }; 3]);
        let mut places = vec![0; self.len()];
        (0_u32..).zip(self.order()).for_each(|(place, &number)| places[number as usize] = place);
        for &number in self.order().iter().rev() {
            if !(of_facets..of_cells).contains(&number) {
                continue;
            }
            let facet = (number - of_facets) as usize;
            let [a, b] = filtration.incidence.facet_cells[facet];
            let of_both = [a, b].map(|side| largest[sets.find(side).0 as usize]);
            let greater = of_both.into_iter().max_by_key(|&cell| places[cell as usize]);
            let united = sets.unite(a, b, filtration.way_across(torus, facet));
            let root = sets.find(a).0;
            largest[root as usize] = greater.unwrap_or_default();
            if matches!(united, United::Already) || sets.rounds(root).is_none() {
                continue;
            }
            if free.is_none() {
                free = Some((number, largest[root as usize]));
            }
            let directions = sets.rounds(root).map(Directions::along);
            for (slot, is_along) in along.iter_mut().zip(directions.unwrap_or_default()) {
                if is_along && slot.is_none() {
                    *slot = Some(number);
                }
            }
            if along.iter().all(Option::is_some) {
                break;
            }
        }
        let (narrowest, on_way) = free.expect("the empty shape leaves the whole torus");
        Some(Pores {
            included,
            free: self.pore_sphere(narrowest),
            free_along: along.map(|number| self.pore_sphere(number.expect("as above"))),
            included_along_free: self.pore_sphere(on_way),
        })
    }

    /// The sphere of the Gabriel simplex with which a simplex enters.
    fn pore_sphere(&self, number: u32) -> PoreSphere {
        let filtration = self.filtration();
        let (whole, incidence) = (filtration.whole(), &filtration.incidence);
        let [_, _, of_facets, of_cells] = self.numbers.first;
        let mut own = number;
        // A facet that is not Gabriel enters with the first of its cells.
        if number < of_cells && !self.simplex(number).gabriel {
            let sides = incidence.facet_cells[(number - of_facets) as usize];
            let numbers = (of_cells..).zip(&self.cell_rows);
            let first = numbers.filter(|(_, row)| sides.contains(row)).map(|(number, _)| number);
            own = first.min_by_key(|&cell| self.simplex(cell).rank).unwrap_or(number);
        }
        let entry = self.simplex(own);
        let center = match *entry.vertices {
            [a, b, c] => filtration.center([a, b, c]),
            [a, b, c, d] => filtration.center([a, b, c, d]),
            _ => unreachable!("facets and cells have three or four vertices"),
        };
        let torus = filtration.torus();
        PoreSphere {
            alpha: entry.value,
            center: torus.map_or(center, |torus| torus.wrap(center)),
            points: entry.vertices.iter().map(|&v| whole.copied(v).0).collect(),
        }
    }
}

impl Filtration {
    /// The centre of the smallest orthogonal sphere.
    fn center<const N: usize>(&self, simplex: [u32; N]) -> [f64; 3] {
        let corners = self.whole.corners(simplex);
        let shares = centre_shares(corners, simplex.map(|v| self.points().weights[v as usize]));
        let sum = |k: usize| (0..N).map(|i| shares[i].share * corners[i][k]).sum();
        [sum(0), sum(1), sum(2)]
    }

    /// The parts of a periodic box that balls of squared radius α + ω leave, those that wind round in most directions first, then those of most cells;
    /// `None` unless it repeats along all three vectors. O(n log n).
    pub fn pore_parts(&self, alpha: Alpha) -> Option<Vec<PorePart>> {
        let torus = self.torus().filter(|torus| torus.dimension() == 3)?;
        let levels = self.levels(&[alpha]);
        let is_out = |level: u32| level > 0;
        let mut sets = WindingSets::new(levels.cells.len());
        for (facet, _) in levels.facets.iter().enumerate().filter(|(_, span)| is_out(span.first)) {
            let [a, b] = self.incidence.facet_cells[facet];
            sets.unite(a, b, self.way_across(torus, facet));
        }
        let mut counts = vec![0; levels.cells.len()];
        for (cell, _) in (0..).zip(&levels.cells).filter(|&(_, &level)| is_out(level)) {
            counts[sets.find(cell).0 as usize] += 1;
        }
        let roots = (0..).zip(counts).filter(|&(_, count)| count > 0);
        let part = |(root, cells): (u32, usize)| PorePart {
            dimension: sets.rounds(root).map_or(0, Directions::rank),
            cells,
        };
        let mut parts: Vec<PorePart> = roots.map(part).collect();
        sort_by_key(&mut parts, |part| (Reverse(part.dimension), Reverse(part.cells)));
        Some(parts)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BinaryHeap;

    use walpha_base::random::Random;
    use walpha_regular::Torus;

    use super::*;

    fn pores(vectors: [[f64; 3]; 3], positions: &[[f64; 3]]) -> Pores {
        let torus = Torus::of_vectors(vectors).unwrap();
        let filtration = Filtration::on(Some(torus), positions).unwrap();
        filtration.simplices().unwrap().pores().unwrap()
    }

    #[test]
    fn spheres_between_the_points_of_lattices() {
        let brick = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]];
        let Pores { included, free, free_along, included_along_free } = pores(brick, &[[0.25; 3]]);
        // The half diagonals of the brick and of its sides.
        assert_eq!((included.alpha, free.alpha), (2.75, 2.5));
        assert_eq!(free_along.map(|sphere| sphere.alpha), [2.5, 2.5, 0.5]);
        assert_eq!((included_along_free.alpha, included.center), (2.75, [0.75, 0.75, 1.75]));
        assert_eq!(included.points, [0; 4]);
    }

    /// Channels and a pocket between walls of points.
    #[test]
    fn parts_wind_round_or_do_not() {
        let all = || (0..8 * 8 * 8).map(|i| [i % 8, i / 8 % 8, i / 64].map(f64::from));
        let torus = Torus::new([8.0; 3]).unwrap();
        let parts = |keep: &dyn Fn([f64; 3]) -> bool| {
            let positions: Vec<_> = all().filter(|&p| keep(p)).collect();
            let filtration = Filtration::on(Some(torus), positions).unwrap();
            let parts = filtration.pore_parts(Alpha::from_squared(0.8).unwrap()).unwrap();
            parts.into_iter().map(|part| part.dimension).collect::<Vec<_>>()
        };
        let inside = |x: f64| (2.0..6.0).contains(&x);
        assert_eq!(parts(&|_| true), [] as [usize; 0]);
        assert_eq!(parts(&|[x, y, z]| !(inside(x) && inside(y) && inside(z))), [0]);
        assert_eq!(parts(&|[x, y, _]| !(inside(x) && inside(y))), [1]);
        assert_eq!(parts(&|[x, _, _]| !inside(x)), [2]);
        assert_eq!(parts(&|[x, y, z]| [x, y, z].contains(&0.0) && y + z == 0.0), [3]);
        assert!(Filtration::new(&[[0.0; 3], [1.0; 3]]).unwrap().pore_parts(Alpha::ZERO).is_none());
    }

    /// The distance from the nearest point, at the places of a grid, and the widest ways along the grid.
    #[test]
    fn spheres_are_those_of_a_grid() {
        const STEPS: i32 = 20;
        let mut random = Random::new(7);
        for k in 0..4 {
            let vectors = [[4.0, 0.0, 0.0], [1.0, 3.5, 0.0], [-0.5, 0.75, 5.0]];
            let torus = Torus::of_vectors(vectors).unwrap();
            let positions: Vec<[f64; 3]> =
                (0..3 + 2 * k).map(|_| [0; 3].map(|_| 4.0 * random.unit())).collect();
            let found = pores(vectors, &positions);
            let vectors = torus.vectors();
            let count = (STEPS * STEPS * STEPS) as usize;
            let copies = (0..125).map(|i| [i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2]);
            let copies: Vec<[f64; 3]> = copies
                .flat_map(|by| positions.iter().map(move |&p| torus.moved(torus.wrap(p), by)))
                .collect();
            let square = |place: [f64; 3]| {
                let of = |p: &[f64; 3]| (0..3).map(|x| (p[x] - place[x]).powi(2)).sum::<f64>();
                copies.iter().map(of).fold(f64::INFINITY, f64::min)
            };
            let steps = |i: i32| [i % STEPS, i / STEPS % STEPS, i / STEPS / STEPS];
            let distance = |i: i32| {
                let parts = steps(i).map(|n| f64::from(n) / f64::from(STEPS));
                let place =
                    [0, 1, 2].map(|x| (0..3).map(|k| parts[k] * vectors[k][x]).sum::<f64>());
                square(place).sqrt()
            };
            let distances: Vec<f64> = (0..count as i32).map(distance).collect();
            let mut order: BinaryHeap<(u64, u32)> =
                (0..).zip(&distances).map(|(i, d)| (d.to_bits(), i)).collect();
            let (mut sets, mut is_in) = (WindingSets::new(count), vec![false; count]);
            let (mut free, mut along) = (None, [None; 3]);
            while let Some((bits, i)) = order.pop() {
                is_in[i as usize] = true;
                for (k, to) in (0..3).flat_map(|k| [(k, 1), (k, -1)]) {
                    let mut at = steps(i as i32);
                    at[k] += to;
                    let mut round = [0; 3];
                    round[k] = at[k].div_euclid(STEPS);
                    at[k] = at[k].rem_euclid(STEPS);
                    let other = (at[0] + STEPS * (at[1] + STEPS * at[2])) as u32;
                    if is_in[other as usize] {
                        sets.unite(i, other, round);
                    }
                }
                let root = sets.find(i).0;
                let Some(rounds) = sets.rounds(root) else { continue };
                free = free.or(Some(f64::from_bits(bits)));
                for (slot, is_along) in along.iter_mut().zip(rounds.along()) {
                    *slot = slot.or(is_along.then(|| f64::from_bits(bits)));
                }
                if along.iter().all(Option::is_some) {
                    break;
                }
            }
            let largest = distances.iter().fold(0.0, |most: f64, d| most.max(*d));
            // Half of the longest diagonal of a cell of the grid.
            let near = |exact: f64, of_grid: f64| {
                assert!((exact.sqrt() - of_grid).abs() < 0.22, "{} {of_grid}", exact.sqrt());
            };
            near(found.included.alpha, largest);
            near(found.free.alpha, free.unwrap());
            for (sphere, of_grid) in found.free_along.iter().zip(along) {
                near(sphere.alpha, of_grid.unwrap());
            }
            for sphere in [&found.included, &found.free, &found.included_along_free] {
                let nearest = square(sphere.center);
                assert!((nearest - sphere.alpha).abs() < 1e-9, "{nearest} {sphere:?}");
            }
        }
    }
}
