//! `auto:connected`, which is `Filtration::one_region`, against `find_optimal_alpha` and numbers of solid components.
//!
//! Both look for an α at which every vertex is in a cell of the shape, and the cells are at most so many solid components. Ours is the
//! **least double** with this property. CGAL's is an exact number, and one with this property, but CGAL bisects: it is the least one
//! where the number of components does not rise again from the α on at which all vertices are in cells. So
//!
//! - at ours CGAL finds the property, and at no smaller double;
//! - CGAL's is not below ours, and has the property;
//! - where numbers of components do not rise, CGAL's is the least critical value with the property.

use std::num::{NonZeroU64, NonZeroUsize};
use std::sync::atomic::{AtomicUsize, Ordering};

use walpha::cgal::{AlphaShape3, Mode};
use walpha::ladder::Filtration;
use walpha::{Alpha, Class};

use super::on_all_sets;

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).unwrap()
}

#[test]
fn the_connected_alpha_is_the_least_with_the_property() {
    let (monotone, rising) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let compared = on_all_sets(600, |points| {
        let shapes = |mode| AlphaShape3::new(points.positions(), Some(points.weights()), mode);
        let Ok(theirs) = shapes(Mode::Regularized) else { return false };
        let filtration = Filtration::new(points.clone()).unwrap();
        assert_eq!(filtration.one_region(), filtration.optimal_alpha(NonZeroU64::MIN));

        // CGAL's find_alpha_solid: from here on every vertex is in a cell.
        let all_points = theirs.vertices().spans.iter().map(|span| span.mid.rank).max().unwrap();
        let last = theirs.values().len() as u32;
        let components: Vec<usize> =
            (0..last).map(|rank| theirs.number_of_solid_components_at(rank).unwrap()).collect();
        for most in 1..=3 {
            let fits = |alpha: Alpha| {
                let loose = theirs.complex(alpha).unwrap().vertices.counts()[Class::Exterior];
                loose == 0 && theirs.number_of_solid_components(alpha).unwrap() <= most
            };
            let ours = filtration.optimal_alpha(NonZeroU64::new(most as u64).unwrap());
            assert!(fits(ours), "{ours:?}");
            assert!(!fits(alpha(ours.squared().next_down())), "{ours:?}");
            // Doubles at and just above each value: between them nothing changes.
            let below = theirs.values()[all_points as usize..].iter().copied();
            let below = below.flat_map(|value| [value, value.next_up()]).map(alpha);
            for less in below.filter(|&less| less < ours) {
                assert!(!fits(less), "{less:?} < {ours:?}");
            }

            let number = NonZeroUsize::new(most).unwrap();
            let found = theirs.find_optimal_alpha(number).unwrap();
            assert!(found.rank >= all_points && components[found.rank as usize] <= most);
            assert!(found.nearest >= ours.squared().next_down(), "{found:?} {ours:?}");
            let from_there = &components[all_points as usize..];
            if from_there.is_sorted_by(|now, next| now >= next) {
                let least = from_there.iter().position(|&count| count <= most).unwrap();
                assert_eq!(found.rank, all_points + least as u32);
                monotone.fetch_add(1, Ordering::Relaxed);
            } else {
                rising.fetch_add(1, Ordering::Relaxed);
            }
            // The other mode has more values, but the same cells.
            let general = shapes(Mode::General).unwrap();
            let same = general.find_optimal_alpha(number).unwrap();
            assert!(fits(alpha(same.nearest)) || fits(alpha(same.nearest.next_up())));
        }
        true
    });
    assert!(compared > 300, "{compared}");
    let [monotone, rising] = [monotone, rising].map(AtomicUsize::into_inner);
    assert!(monotone > 1000 && rising > 3, "{monotone} {rising}");
}

#[test]
fn solid_components_are_those_of_the_curve() {
    let compared = on_all_sets(600, |points| {
        let general = AlphaShape3::new(points.positions(), Some(points.weights()), Mode::General);
        let Ok(theirs) = general else { return false };
        let curve = Filtration::new(points.clone()).unwrap().curve();
        for (squared, &ours) in curve.alphas().zip(&curve.solid_components) {
            let theirs = theirs.number_of_solid_components(alpha(squared)).unwrap();
            assert_eq!(ours, theirs as u64, "{squared}");
        }
        assert_eq!(theirs.number_of_solid_components(Alpha::INFINITE).unwrap(), 1);
        assert_eq!(theirs.number_of_solid_components(alpha(f64::NEG_INFINITY)).unwrap(), 0);
        true
    });
    assert!(compared > 300, "{compared}");
}
