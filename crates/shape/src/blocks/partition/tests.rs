//! Cuts and halos, against every point.

use walpha_regular::Torus;

use super::*;

/// Points in a box of 4 by 8 by 2, on and between the places of a grid.
fn points() -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut draws = (0u64..).map(|i| (i * i * 7919 + i * 104_729) % 1009);
    let mut along = |most: u64| (draws.next().expect("endless") % most) as f64 / 4.0;
    let positions: Vec<_> = (0..300).map(|_| [along(16), along(32), along(8)]).collect();
    let weights = (0..300).map(|i| f64::from(i % 7) / 4.0 - 0.5).collect();
    (positions, weights)
}

/// The distance of a point from a box.
fn apart(at: [f64; 3], own: &[[f64; 3]]) -> f64 {
    let away = (0..3).map(|k| {
        let low = own.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = own.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        (low - at[k]).max(at[k] - high).max(0.0)
    });
    away.map(|x| x * x).sum::<f64>().sqrt()
}

/// A halo consists of exactly the points whose balls meet the box of the block.
#[test]
fn halos_are_the_points_within_reach() {
    let (positions, weights) = points();
    let torus = Torus::new([4.0, 8.0, 2.0]).unwrap();
    let periodic = Sites::on_torus(&positions, &weights, torus).unwrap();
    let sites = Sites::new(&positions, &weights).unwrap();
    for (sites, copies) in [(&sites, 0..=0), (&periodic, -3..=3)] {
        for blocks in [1, 5, 8] {
            let partition = Partition::new(sites, blocks);
            let reach = Reach::Balls(0.3);
            let mut largest = 0;
            for block in 0..blocks {
                let made = partition.block(sites, reach, block);
                largest = largest.max(made.input.len());
                let own: Vec<u32> = partition.own(sites, block).collect();
                assert_eq!(own.len(), made.own as usize);
                let places: Vec<_> =
                    own.iter().map(|&site| sites.positions()[site as usize]).collect();
                let heaviest = own.iter().map(|&site| sites.weights()[site as usize]);
                let heaviest = heaviest.fold(f64::NEG_INFINITY, f64::max);
                let mut halo = Vec::new();
                for (site, (&at, &weight)) in
                    (0..).zip(sites.positions().iter().zip(sites.weights()))
                {
                    for x in copies.clone() {
                        for y in copies.clone() {
                            for z in copies.clone() {
                                let at = [
                                    at[0] + 4.0 * f64::from(x),
                                    at[1] + 8.0 * f64::from(y),
                                    at[2] + 2.0 * f64::from(z),
                                ];
                                let far = apart(at, &places) > reach.distance(heaviest, weight);
                                let own = own.contains(&site) && [x, y, z] == [0; 3];
                                if !far && 0.3 + weight >= 0.0 && !own {
                                    halo.push((at.map(f64::to_bits), sites.input()[site as usize]));
                                }
                            }
                        }
                    }
                }
                let got = made.positions.iter().map(|at| at.map(f64::to_bits));
                let mut got: Vec<_> = got.zip(made.input).skip(own.len()).collect();
                halo.sort_unstable();
                got.sort_unstable();
                assert_eq!(got, halo, "block {block} of {blocks}");
            }
            assert_eq!(partition.largest(sites, reach), largest);
        }
    }
}

#[test]
fn blocks_are_cut_across_their_longest_side() {
    let (mut positions, weights) = points();
    positions.iter_mut().for_each(|position| position[0] += 100.0);
    let sites = Sites::new(&positions, &weights).unwrap();
    let partition = Partition::new(&sites, 2);
    let along =
        |block| partition.own(&sites, block).map(|site| sites.positions()[site as usize][1]);
    assert!(along(0).fold(0.0, f64::max) <= along(1).fold(8.0, f64::min));
}

/// √(3 + 1) + √(3 − 2) = 3 beyond the box.
#[test]
fn a_neighbourhood_holds_what_balls_reach() {
    let own = [([0.0; 3], 1.0), ([2.0, 0.0, 0.0], 0.0)];
    let near = Neighbourhood::of(own.into_iter(), 3.0);
    assert!(near.holds([5.0, 0.0, 0.0], -2.0) && !near.holds([5.1, 0.0, 0.0], -2.0));
    assert!(near.holds([1.0, -3.0, 0.0], -2.0) && !near.holds([1.0, 0.0, 0.0], -4.0));
}

/// Half of a diagonal of 13 is 6.5, whose square is 42.25.
#[test]
fn large_balls_of_a_torus_ask_for_all_of_it() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let torus = Torus::new([3.0, 4.0, 12.0]).unwrap();
    let periodic = Sites::on_torus(&positions, &[0.25; 4], torus).unwrap();
    assert_eq!(Reach::at(&periodic, 41.75, 0.25), Reach::Balls(41.75));
    assert_eq!(Reach::at(&periodic, 42.25, 0.25), Reach::whole(&periodic));
    assert!(matches!(Reach::whole(&periodic), Reach::Distance(most) if (most - 13.0).abs() < 1e-9));
    let sites = Sites::new(&positions, &[0.25; 4]).unwrap();
    assert_eq!(Reach::at(&sites, 42.25, 0.25), Reach::Balls(42.25));
    assert_eq!(Reach::whole(&sites), Reach::Distance(f64::INFINITY));
}

#[test]
fn balls_reach_as_far_as_both_their_radii() {
    assert_eq!(Reach::Balls(5.0).distance(4.0, 11.0), 7.0);
    assert_eq!(Reach::Balls(5.0).distance(-6.0, 11.0), 4.0);
    assert!(Reach::Balls(5.0).distance(4.0, -6.0).is_nan());
    assert_eq!(Reach::Distance(2.0).distance(4.0, -6.0), 2.0);
}
