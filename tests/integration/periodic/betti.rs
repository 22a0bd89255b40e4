//! Betti numbers against homology by matrices: voids, lattices, and things that go round.

use walpha::shape::Betti;

use super::oracle::homology;
use super::{BCC, CUBIC, FCC, alpha_shape, crystal, options, sets, shape, unweighted};

#[test]
fn voids_that_lie_across_the_sides_of_the_box() {
    // A hollow about the corner of the box, another in its middle, and a pore along z.
    let all = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from));
    let near = |p: [f64; 3], q: [f64; 3], r: f64| {
        let away = |k: usize| (p[k] - q[k]).abs().min(10.0 - (p[k] - q[k]).abs());
        (0..3).map(|k| away(k) * away(k)).sum::<f64>() <= r * r
    };
    let keep = |p: &[f64; 3]| {
        !near(*p, [0.0; 3], 1.0) && *p != [5.0; 3] && !near([p[0], p[1], 0.0], [7.0, 2.0, 0.0], 1.0)
    };
    let points = unweighted(all.filter(keep).collect());
    let options = options([10.0; 3], 0.75).exterior(true);
    let shape = alpha_shape(points, &options).unwrap();
    let voids = shape.voids().unwrap();
    let [corner, middle] = voids[..] else { panic!("{voids:?}") };
    assert_eq!((middle.low, middle.high), ([4.0; 3], [6.0; 3]));
    assert_eq!((0..3).map(|k| corner.high[k] - corner.low[k]).collect::<Vec<_>>(), [4.0; 3]);
    assert!((middle.volume - 4.0 / 3.0).abs() < 1e-12 && corner.volume > 8.0, "{voids:?}");
    // Two voids and the pore are three parts of the complement, and the pore goes round once.
    let betti = shape.betti().unwrap();
    assert_eq!((betti.b2, betti.b3), (3 + 2 - 1, Some(0)));
    assert_eq!(<Vec<u64>>::from(betti), homology(&shape));
}

#[test]
fn betti_numbers_are_those_of_homology() {
    let mut seen = std::collections::BTreeSet::new();
    for (k, (points, sides)) in sets(200).enumerate() {
        for squared in [0.25, 0.5, 0.75, 1.0, 1.5, 2.25, 4.0] {
            let Ok(shape) = shape(&points, sides, squared) else { continue };
            let Betti { b0, b1, b2, b3 } = shape.betti().unwrap();
            let found = [b0, b1, b2, b3.unwrap()];
            assert_eq!(found, homology(&shape), "set {k}, α = {squared}");
            seen.insert(found);
        }
    }
    assert!(seen.len() > 100 && seen.contains(&[1, 3, 3, 1]), "{}", seen.len());
}

#[test]
fn a_lattice_covers_the_torus() {
    for (basis, full, almost) in
        [(&CUBIC[..], 0.75, 0.5), (&BCC, 0.3125, 0.28125), (&FCC, 0.25, 0.1875)]
    {
        let points = crystal([4, 5, 6], basis);
        let whole = shape(&points, [4.0, 5.0, 6.0], full).unwrap();
        assert_eq!(whole.betti(), Some(Betti { b0: 1, b1: 3, b2: 3, b3: Some(1) }));
        assert_eq!(whole.measures().volume, 120.0);
        assert_eq!((whole.measures().area, whole.complex().euler_characteristic()), (0.0, 0));
        let open = shape(&points, [4.0, 5.0, 6.0], almost).unwrap();
        let Betti { b0, b1, b2, b3 } = open.betti().unwrap();
        assert_eq!([b0, b1, b2, b3.unwrap()], homology(&open));
        assert_eq!(b3, Some(0));
        // The holes of FCC are octahedra, four in each cell, which touch at vertices and edges.
        if basis.len() == 4 {
            assert_eq!(b2, 4 * 120 + 2);
        }
    }
}

/// What goes round has no end along that axis.
#[test]
fn boxes_of_rods_and_slabs_span_the_torus() {
    let box_of = |keep: fn(&[f64; 3]) -> bool| {
        let all = (0..480).map(|i| [i % 8, i / 8 % 10, i / 80].map(f64::from));
        let shape = shape(&unweighted(all.filter(keep).collect()), [8.0, 10.0, 6.0], 0.75).unwrap();
        let parts = shape.components();
        assert_eq!(parts.len(), 1);
        (parts[0].low, parts[0].high)
    };
    assert_eq!(box_of(|p| p[1] == 1.0 && p[2] == 5.0), ([0.0, 1.0, 5.0], [8.0, 1.0, 5.0]));
    assert_eq!(box_of(|p| p[1] == 3.0), ([0.0, 3.0, 0.0], [8.0, 3.0, 6.0]));
    assert_eq!(box_of(|_| true), ([0.0; 3], [8.0, 10.0, 6.0]));
    assert_eq!(
        box_of(|p| p[0] < 3.0 && p[2] == 0.0 && p[1] == 4.0),
        ([0.0, 4.0, 0.0], [2.0, 4.0, 0.0])
    );
}

#[test]
fn things_that_go_round() {
    let betti = |positions: Vec<[f64; 3]>, squared| {
        let shape = shape(&unweighted(positions), [8.0; 3], squared).unwrap();
        assert_eq!(<Vec<u64>>::from(shape.betti().unwrap()), homology(&shape));
        let mut rounds: Vec<_> =
            shape.components().iter().map(|part| part.rounds.unwrap()).collect();
        rounds.sort_unstable();
        (homology(&shape), rounds)
    };
    let all = || (0..512).map(|i| [i % 8, i / 8 % 8, i / 64].map(f64::from));
    // A rod, a slab of one layer, three rods across each other, two slabs, and the torus less a ball.
    let rod = all().filter(|p| p[1] == 1.0 && p[2] == 7.0).collect();
    assert_eq!(betti(rod, 0.75), ([1, 1, 0, 0], vec![1]));
    let slab = all().filter(|p| p[2] == 0.0).collect();
    assert_eq!(betti(slab, 0.75), ([1, 2, 1, 0], vec![2]));
    let rods = all().filter(|p| p.iter().filter(|&&x| x == 0.0).count() >= 2).collect();
    assert_eq!(betti(rods, 0.75), ([1, 3, 0, 0], vec![3]));
    let slabs = all().filter(|p| p[0] == 2.0 || p[0] == 5.0 || *p == [0.0; 3]).collect();
    assert_eq!(betti(slabs, 0.75), ([3, 4, 2, 0], vec![0, 2, 2]));
    let hole = all().filter(|p| *p != [0.0, 3.0, 7.0]).collect();
    assert_eq!(betti(hole, 0.75), ([1, 3, 3, 0], vec![3]));
    // A staircase that goes round in all directions at once is one loop.
    let stairs = (0..24).map(|i| [(i + 2) / 3, (i + 1) / 3, i / 3].map(f64::from)).collect();
    assert_eq!(betti(stairs, 0.25), ([1, 1, 0, 0], vec![1]));
}
