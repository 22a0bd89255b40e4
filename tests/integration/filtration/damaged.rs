//! Damage, which the checker finds and names.

use walpha::Alpha;
use walpha::check::schema::FiltrationFile;
use walpha::check::{Bound, Exact, FiltrationFinding, certify_filtration, compare_filtrations};
use walpha::ladder::Filtration;
use walpha_base::random::Random;

use super::files::{file, findings};
use super::sets;

/// Another α.
fn moved(alpha: Alpha, to: fn(f64) -> f64) -> Alpha {
    Alpha::from_squared(to(alpha.squared())).unwrap()
}

fn one_pair(damaged: &FiltrationFile, rule: &dyn Fn(&FiltrationFinding) -> bool) {
    let found = findings(damaged);
    assert!(found.len() == 1 && rule(&found[0]), "{found:?}");
}

/// What is wrong is found, and named.
#[test]
fn the_checker_finds_what_is_wrong() {
    let mut random = Random::new(5);
    for points in sets(24, 30) {
        let filtration = Filtration::new(points).unwrap();
        let ordered = filtration.simplices().unwrap();
        let right = file(&ordered);
        let is_when = |wanted: Bound| move |found: &FiltrationFinding| matches!(found, FiltrationFinding::When { bound, .. } if *bound == wanted);
        let one = |damaged: &FiltrationFile, rule: &dyn Fn(&FiltrationFinding) -> bool| {
            let found = findings(damaged);
            assert!(found.len() == 1 && rule(&found[0]), "{found:?}");
            assert!(!compare_filtrations(&right, damaged).unwrap().is_equal());
        };
        let mut damage = right.clone();
        let at = random.below(damage.values.edges.len());
        damage.values.edges[at] = moved(damage.values.edges[at], f64::next_up);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let at = random.below(damage.values.cells.len());
        damage.values.cells[at] = moved(damage.values.cells[at], f64::next_down);
        one(&damage, &is_when(Bound::Value));
        let mut damage = right.clone();
        let facets = &mut damage.gabriel.as_mut().unwrap().facets;
        let at = random.below(facets.len());
        facets[at] = !facets[at];
        one(&damage, &|found| matches!(found, FiltrationFinding::Gabriel { .. }));
        let mut damage = right.clone();
        let edges = &mut damage.regular.as_mut().unwrap().edges;
        let at = random.below(edges.len());
        edges[at] = moved(edges[at], f64::next_down);
        one(&damage, &is_when(Bound::Regular));
        let mut damage = right.clone();
        let vertices = &mut damage.interior.as_mut().unwrap().vertices;
        let at = random.below(vertices.len());
        let other = |squared: f64| if squared == f64::INFINITY { 1.0 } else { f64::INFINITY };
        vertices[at] = moved(vertices[at], other);
        one(&damage, &is_when(Bound::Interior));
        let mut damage = right.clone();
        let at = random.below(damage.order.len() - 1);
        damage.order.swap(at, at + 1);
        let found = findings(&damage);
        assert!(!found.is_empty());
        assert!(found.iter().all(|found| matches!(found, FiltrationFinding::Order { .. })));
        let values = damage.values.vertices.iter().chain(&damage.values.edges);
        let values: Vec<_> =
            values.chain(&damage.values.facets).chain(&damage.values.cells).collect();
        let swapped = [at, at + 1].map(|at| values[damage.order[at] as usize].squared());
        assert!(found.iter().any(|found| {
            matches!(found, FiltrationFinding::Order { values, .. } if values.each_ref().map(Exact::nearest) == swapped)
        }), "{swapped:?} {found:?}");
        let is_pair = |wanted: usize, is: bool| move |found: &FiltrationFinding| matches!(found, FiltrationFinding::Pair { dimension, listed, .. } if *dimension == wanted && *listed == is);
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().components.pop().is_some() {
            one_pair(&damage, &is_pair(0, false));
        }
        let mut damage = right.clone();
        if damage.pairs.as_mut().unwrap().voids.pop().is_some() {
            one_pair(&damage, &is_pair(2, false));
        }
        let mut damage = right.clone();
        damage.pairs.as_mut().unwrap().voids.push([0, 1]);
        one_pair(&damage, &is_pair(2, true));
        let mut damage = right.clone();
        damage.pairs.as_mut().unwrap().lasting.push(u32::MAX);
        one_pair(&damage, &|found| matches!(found, FiltrationFinding::Lasting { .. }));
        let mut damage = right.clone();
        damage.order[0] = damage.order[1];
        let found = findings(&damage);
        assert!(matches!(
            found[..],
            [FiltrationFinding::Number { .. }, FiltrationFinding::Absent { .. }]
        ));
        let mut damage = right.clone();
        damage.edges.pop();
        damage.values.edges.pop();
        for bounds in [&mut damage.regular, &mut damage.interior] {
            bounds.as_mut().unwrap().edges.pop();
        }
        damage.gabriel.as_mut().unwrap().edges.pop();
        let found = findings(&damage);
        assert!(matches!(found[0], FiltrationFinding::Triangulation(_)), "{found:?}");
        let mut damage = right.clone();
        damage.values.facets.pop();
        assert!(certify_filtration(&damage).is_err());
    }
}
