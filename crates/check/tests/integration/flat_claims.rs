//! Complexes and filtrations of points in one plane, on one line, or of one alone.

use walpha_base::random::Random;
use walpha_check::schema::{Below, ComplexFile, FiltrationFile, PlacedComplex};
use walpha_check::{Alpha, Claim, Class, Extent, Finding, Verdict, certify_filtration, enumerate};

use crate::base::findings;
use crate::common::{Answer, Case, definition, drop_row, shape_of};

/// Grids in tilted planes and on lines, full of ties, with duplicates and hidden points; single points.
fn cases() -> Vec<Case> {
    let mut random = Random::new(7);
    let planes: [[[f64; 3]; 2]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.0, 1.0, 1.0], [1.0, 0.0, 0.0]],
        [[1.0, 2.0, -1.0], [3.0, -1.0, 1.0]],
        [[0.5, 0.0, 0.25], [0.0; 3]],
    ];
    let mut cases = Vec::new();
    for round in 0..160 {
        let [u, v] = planes[round % 4];
        let count = if round < 8 { 1 + round / 4 } else { 3 + random.below(9) };
        let mut place = || {
            let [s, t] = [0, 0].map(|_| random.below(4) as f64);
            [0, 1, 2].map(|k| s * u[k] + t * v[k] - 0.5)
        };
        let positions: Vec<_> = (0..count).map(|_| place()).collect();
        let levels = random.pick(&[&[0.0][..], &[0.0, -0.0, 1.0], &[0.0, 0.5, 1.0, 3.0]]);
        let weights = positions.iter().map(|_| random.pick(levels)).collect();
        let alpha = random.pick(&[-1.0, 0.0, 0.25, 0.5, 1.0, 2.5, 7.0, f64::INFINITY]);
        cases.push(Case { positions, weights, alpha });
    }
    cases
}

fn verdict(case: &Case, answer: &Answer, extent: Extent) -> Verdict {
    findings(case, answer, extent);
    case.claim(answer, extent).verdict().unwrap()
}

#[test]
fn what_the_definition_makes_is_exact() {
    let mut dimensions = [0; 3];
    for case in cases() {
        let answer = definition(&case).unwrap();
        let complex = &answer.complex;
        assert!(complex.cells.is_empty());
        dimensions
            [usize::from(!complex.edges.is_empty()) + usize::from(!complex.facets.is_empty())] += 1;
        let found = findings(&case, &answer, Extent::Whole);
        assert!(found.is_empty(), "{case:?}\n{found:?}");
        let found = findings(&case, &shape_of(&answer), Extent::Shape);
        assert!(found.is_empty(), "{case:?}\n{found:?}");
    }
    assert!(dimensions.iter().all(|&count| count > 2), "{dimensions:?}");
}

/// The choice that the perturbation makes with the axes turned round.
#[test]
fn other_choices_are_valid() {
    let mut seen = [0; 2];
    for case in cases() {
        let positions = case.positions.iter().map(|p| [-p[0], p[1], p[2]]).collect();
        let other = definition(&Case { positions, ..case.clone() }).unwrap();
        let same = other.complex == definition(&case).unwrap().complex;
        let found = verdict(&case, &other, Extent::Whole);
        assert_eq!(found, if same { Verdict::Exact } else { Verdict::Valid }, "{case:?}");
        let shape = verdict(&case, &shape_of(&other), Extent::Shape);
        assert!(shape <= found, "{case:?}");
        seen[usize::from(found == Verdict::Valid)] += 1;
    }
    assert!(seen[1] > 10, "{seen:?}");
}

/// Any dropped row and any changed class is found.
#[test]
fn damage_is_found() {
    for case in cases().into_iter().step_by(3) {
        let answer = definition(&case).unwrap();
        let complex = &answer.complex;
        let damaged = |what: &str, change: &dyn Fn(&mut Answer)| {
            let mut wrong = answer.clone();
            change(&mut wrong);
            let verdict = verdict(&case, &wrong, Extent::Whole);
            assert_eq!(verdict, Verdict::Wrong, "{what}\n{case:?}\n{wrong:?}");
        };
        for row in 0..complex.facets.len() {
            damaged("facet", &|a| _ = drop_row(&mut a.complex.facets, row));
            damaged("class of a facet", &|a| {
                let class = &mut a.complex.facets.classes_mut()[row];
                *class = if *class == Class::Singular { Class::Exterior } else { Class::Singular };
            });
        }
        for row in 0..complex.edges.len() {
            damaged("edge", &|a| _ = drop_row(&mut a.complex.edges, row));
            damaged("class of an edge", &|a| a.complex.edges.classes_mut()[row] = Class::Interior);
        }
        for row in 0..complex.vertices.len() {
            damaged("vertex", &|a| _ = drop_row(&mut a.complex.vertices, row));
        }
        if let Some(&hidden) = answer.hidden.first() {
            damaged("hidden", &|a| a.complex.vertices.push([hidden], Class::Exterior));
        }
        damaged("all", &|a| a.complex = walpha_check::Complex::default());
        damaged("cell", &|a| a.complex.cells.push([0, 1, 2, 3], Class::Exterior));
    }
}

/// A flip of a diagonal that is not a tie, a hull with a corner cut off, a point that is not hidden.
#[test]
fn rules_of_the_plane() {
    let flat = |facets: &[[u32; 3]], weight: f64| {
        let positions =
            vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [5.0, 5.0, 0.0], [1.0, 1.0, 0.0]];
        let mut file = ComplexFile::of_points(positions, Alpha::INFINITE);
        file.weights = Some(vec![0.0, 0.0, 0.0, 0.0, weight]);
        file.facets = Some(facets.to_vec());
        PlacedComplex::try_from(file).unwrap().findings().unwrap().0
    };
    assert_eq!(flat(&[[0, 1, 2], [1, 2, 3]], -20.0), []);
    let found = flat(&[[0, 1, 3], [0, 2, 3]], -20.0);
    assert!(
        found
            .iter()
            .any(|f| matches!(f, Finding::NotRegular { cell, .. } if cell.vertices().len() == 3 && !f.is_tie())),
        "{found:?}"
    );
    let found = flat(&[[0, 1, 2], [1, 2, 3]], 0.0);
    assert!(found.iter().any(|f| matches!(f, Finding::NotHidden { point: 4, cell, .. } if cell.vertices() == [0, 1, 2] && !f.is_tie())), "{found:?}");
    let found = flat(&[[0, 1, 2]], -20.0);
    assert!(found.iter().any(|f| matches!(f, Finding::OutsideHull { point: 3, .. })), "{found:?}");
    let found = flat(&[[0, 1, 4], [0, 2, 4], [1, 3, 4], [2, 3, 4]], 0.0);
    assert_eq!(found, []);
    let found = flat(&[[0, 1, 4], [0, 2, 4], [1, 3, 4]], 0.0);
    assert!(found.iter().any(|f| matches!(f, Finding::HullBends { .. })), "{found:?}");
    let found = flat(&[[0, 1, 2], [0, 1, 4], [1, 2, 3]], 0.0);
    assert!(found.iter().any(|f| !f.is_tie()), "{found:?}");
}

/// The filtration of a flat set, straight from the definition: each simplex at the least of all critical
/// values at which it is in the shape.
fn filtration(case: &Case) -> FiltrationFile {
    let whole = definition(&Case { alpha: f64::INFINITY, ..case.clone() }).unwrap();
    let mut values = std::collections::BTreeMap::<Vec<u32>, f64>::new();
    // All squared radii of triangles on such a grid are multiples of this step.
    let steps = (0..200).map(|step| f64::from(step) / 16.0);
    for alpha in steps {
        let alpha = Alpha::from_squared(alpha).unwrap();
        let made = enumerate(&case.positions, &case.weights, alpha).unwrap().complex;
        let all = made.vertices.iter().map(|(row, class)| (row.to_vec(), class));
        let all = all.chain(made.edges.iter().map(|(row, class)| (row.to_vec(), class)));
        let all = all.chain(made.facets.iter().map(|(row, class)| (row.to_vec(), class)));
        for (row, _) in all.filter(|(_, class)| *class != Class::Exterior) {
            values.entry(row).or_insert(alpha.squared());
        }
    }
    let value = |row: &[u32]| Alpha::from_squared(values[row]).unwrap();
    let complex = whole.complex;
    let mut file = FiltrationFile {
        points: case.positions.clone(),
        weights: Some(case.weights.clone()),
        vertices: complex.vertices.rows().as_flattened().to_vec(),
        edges: complex.edges.rows().to_vec(),
        facets: complex.facets.rows().to_vec(),
        hidden: Some(whole.hidden),
        duplicates: Some(whole.duplicates),
        ..FiltrationFile::default()
    };
    file.values.vertices = file.vertices.iter().map(|&v| value(&[v])).collect();
    file.values.edges = file.edges.iter().map(|row| value(row)).collect();
    file.values.facets = file.facets.iter().map(|row| value(row)).collect();
    let rows = file.vertices.iter().map(|&v| vec![v]);
    let rows = rows.chain(file.edges.iter().map(|row| row.to_vec()));
    let rows = rows.chain(file.facets.iter().map(|row| row.to_vec()));
    let mut order: Vec<(Alpha, usize, Vec<u32>, u32)> =
        (0..).zip(rows).map(|(i, row)| (value(&row), row.len(), row, i)).collect();
    order.sort_by(|a, b| a.partial_cmp(b).unwrap());
    file.order = order.into_iter().map(|(.., number)| number).collect();
    file
}

#[test]
fn filtrations_are_judged_in_their_plane() {
    let mut random = Random::new(3);
    let mut damaged = 0;
    for round in 0..24 {
        let line = f64::from(u8::from(round % 4 != 0));
        let count = if round < 2 { 1 } else { 4 + random.below(5) };
        let mut place = || [random.below(3) as f64, line * 2.0 * random.below(2) as f64, 1.0];
        let positions: Vec<_> = (0..count).map(|_| place()).collect();
        let case = Case { weights: vec![0.0; positions.len()], alpha: f64::INFINITY, positions };
        let file = filtration(&case);
        let (found, certificate) = certify_filtration(&file).unwrap();
        assert_eq!(found, [], "{case:?}\n{file:?}");
        assert_eq!(certificate.verdict, Verdict::Exact);
        for i in 0..file.values.edges.len() {
            let mut wrong = file.clone();
            wrong.values.edges[i] =
                Alpha::from_squared(wrong.values.edges[i].squared() + 0.25).unwrap();
            let (found, certificate) = certify_filtration(&wrong).unwrap();
            assert!(!found.is_empty(), "{case:?}");
            assert_eq!(certificate.verdict, Verdict::Wrong);
            damaged += 1;
        }
    }
    assert!(damaged > 50, "{damaged}");
}

/// The points of a line or a single point are never surrounded, at any value of α.
#[test]
fn nothing_on_a_line_is_interior() {
    let value = |x: f64| Alpha::from_squared(x).unwrap();
    let (zero, never) = (value(0.0), Alpha::INFINITE);
    let mut line = FiltrationFile {
        points: [0.0, 1.0, 3.0].map(|x| [x, 0.0, 0.0]).to_vec(),
        vertices: vec![0, 1, 2],
        edges: vec![[0, 1], [1, 2]],
        order: vec![0, 1, 2, 3, 4],
        ..FiltrationFile::default()
    };
    line.values.vertices = vec![zero; 3];
    line.values.edges = vec![value(0.25), value(1.0)];
    let mut point = FiltrationFile {
        points: vec![[0.0; 3]],
        vertices: vec![0],
        order: vec![0],
        ..FiltrationFile::default()
    };
    point.values.vertices = vec![zero];
    for file in [line, point] {
        let intervals = |interior| {
            let mut file = file.clone();
            file.regular = Some(Below {
                vertices: match file.edges.len() {
                    0 => vec![never],
                    _ => vec![value(0.25), value(0.25), value(1.0)],
                },
                edges: vec![never; file.edges.len()],
                facets: Vec::new(),
            });
            file.interior = Some(Below {
                vertices: vec![interior; file.vertices.len()],
                edges: vec![interior; file.edges.len()],
                facets: Vec::new(),
            });
            certify_filtration(&file).unwrap().0
        };
        assert_eq!(intervals(never), []);
        assert_eq!(intervals(zero).len(), file.order.len());
    }
}

/// No simplices of the dimension that the points span are listed.
#[test]
fn a_plane_needs_facets() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let complex = walpha_check::Complex {
        vertices: [0, 1, 2].map(|v| ([v], Class::Interior)).into_iter().collect(),
        ..Default::default()
    };
    let placed = walpha_check::Placed::new(&positions, &[0.0; 3], Alpha::INFINITE, &complex);
    let (found, _) = Claim::new(placed).findings().unwrap();
    assert_eq!(found, [Finding::NoCells]);
    assert!(found[0].to_string().contains("facets"), "{}", found[0]);
}
