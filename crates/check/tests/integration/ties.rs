//! Other choices among ties and equal points: valid, and not exact; and what only looks like one.

use walpha_base::random::Random;
use walpha_check::schema::{ComplexFile, FiltrationFile, PlacedComplex};
use walpha_check::{
    Alpha, Class, Complex, Extent, FiltrationFinding, Finding, Verdict, certify_filtration,
};

use crate::base::findings;
use crate::common::{Answer, Case, closed, definition, drop_row, grid, shape_of};

/// The answer of another program: that of points whose axes are turned round and exchanged, so that
/// the perturbation orders them otherwise.
fn otherwise(case: &Case, turn: [usize; 3], signs: [f64; 3]) -> Answer {
    let turned = |p: &[f64; 3]| [0, 1, 2].map(|k| signs[k] * p[turn[k]]);
    let positions = case.positions.iter().map(turned).collect();
    let made = definition(&Case { positions, ..case.clone() }).unwrap();
    turned_back(case, made)
}

/// Turns cells and facets as in the case's own space.
fn turned_back(case: &Case, made: Answer) -> Answer {
    let placed = case.placed(&made.complex);
    let complex = PlacedComplex::try_from(ComplexFile::from(walpha_check::Claim::new(placed)))
        .unwrap()
        .complex;
    Answer { complex, ..made }
}

fn verdict(case: &Case, answer: &Answer, extent: Extent) -> Verdict {
    let found = findings(case, answer, extent);
    let verdict = case.claim(answer, extent).verdict().unwrap();
    assert_eq!(found.is_empty(), verdict == Verdict::Exact);
    verdict
}

/// Grids, lines of a grid, and weights of few values: ties everywhere, points hidden on the spheres too.
fn cases() -> Vec<Case> {
    let mut random = Random::new(14);
    let mut cases = Vec::new();
    for _ in 0..60 {
        let count = 8 + random.below(12);
        let mut positions: Vec<[f64; 3]> = grid(3);
        random.shuffle(&mut positions);
        positions.truncate(count);
        let levels = random.pick(&[&[0.0][..], &[0.0, 1.0], &[0.0, -0.0, 0.5, 1.0]]);
        let weights = positions.iter().map(|_| random.pick(levels)).collect();
        let alpha = random.pick(&[0.0, 0.25, 0.5, 0.75, 1.0, 1.5, f64::INFINITY]);
        cases.push(Case { positions, weights, alpha });
    }
    cases
}

#[test]
fn other_choices_are_valid() {
    let mut seen = [0; 2];
    for case in cases() {
        for (turn, signs) in [
            ([0, 1, 2], [1.0, 1.0, 1.0]),
            ([0, 1, 2], [-1.0, 1.0, 1.0]),
            ([2, 0, 1], [1.0, -1.0, 1.0]),
            ([1, 0, 2], [-1.0, -1.0, -1.0]),
        ] {
            let answer = otherwise(&case, turn, signs);
            let exact = answer.complex == definition(&case).unwrap().complex;
            for (answer, extent) in
                [(answer.clone(), Extent::Whole), (shape_of(&answer), Extent::Shape)]
            {
                let verdict = verdict(&case, &answer, extent);
                assert_ne!(
                    verdict,
                    Verdict::Wrong,
                    "{:?}\n{case:?}",
                    findings(&case, &answer, extent)
                );
                if exact {
                    assert_eq!(verdict, Verdict::Exact, "{case:?}");
                } else if extent == Extent::Whole {
                    assert_eq!(verdict, Verdict::Valid, "{case:?}");
                }
                seen[usize::from(verdict == Verdict::Valid)] += 1;
            }
        }
    }
    assert!(seen[0] > 50 && seen[1] > 100, "{seen:?}");
}

/// The simplices that a shape lists may not be part of any one triangulation although each sphere is empty: half of one choice
/// with half of another.
#[test]
fn mixed_choices_are_wrong() {
    let mut wrong = 0;
    for case in cases() {
        let one = definition(&case).unwrap();
        let other = otherwise(&case, [2, 0, 1], [-1.0, 1.0, -1.0]);
        let [a, b] = [&one, &other].map(|answer| answer.complex.cells.rows());
        let only: Vec<_> = b.iter().filter(|cell| !a.contains(cell)).collect();
        if only.is_empty() {
            continue;
        }
        // One cell of the other choice together with those of the rule.
        let cells: Vec<_> = a.iter().chain(only.into_iter().take(1)).copied().collect();
        let whole = one.with(closed(&cells));
        assert_eq!(verdict(&case, &whole, Extent::Whole), Verdict::Wrong, "{case:?}");
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.weights = Some(case.weights.clone());
        let inside = |cell: &&[u32; 4]| {
            [&one, &other]
                .iter()
                .any(|answer| answer.complex.cells.of(Class::Interior).any(|c| c == *cell))
        };
        file.cells = Some(cells.iter().filter(inside).copied().collect());
        if file.cells.as_deref()
            == Some(&one.complex.cells.of(Class::Interior).copied().collect::<Vec<_>>())
        {
            continue;
        }
        let mixed = Answer { complex: PlacedComplex::try_from(file).unwrap().complex, ..one };
        assert_eq!(verdict(&case, &mixed, Extent::Shape), Verdict::Wrong, "{case:?}");
        wrong += 1;
    }
    assert!(wrong > 10, "{wrong}");
}

/// Two cubes side by side: where the one is cut otherwise than the other, their cells cross on the square
/// between them. Each cube by itself is a right choice.
#[test]
fn cubes_that_do_not_fit_are_wrong() {
    let positions: Vec<[f64; 3]> =
        (0..12).map(|i| [i % 3, i / 3 % 2, i / 6].map(f64::from)).collect();
    let case = Case { weights: vec![0.0; 12], alpha: 0.75, positions };
    let own = definition(&case).unwrap().complex;
    let mirrored = otherwise(&case, [0, 1, 2], [1.0, -1.0, 1.0]).complex;
    let of = |complex: &Complex, x: f64| -> Vec<[u32; 4]> {
        let beside = |v: &u32| (case.positions[*v as usize][0] - x).abs() < 0.75;
        complex.cells.rows().iter().filter(|cell| cell.iter().all(beside)).copied().collect()
    };
    let shape = |left: &Complex, right: &Complex| {
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.cells = Some([of(left, 0.5), of(right, 1.5)].concat());
        Answer::of(PlacedComplex::try_from(file).unwrap().complex)
    };
    assert_eq!(verdict(&case, &shape(&own, &own), Extent::Shape), Verdict::Exact);
    assert_eq!(verdict(&case, &shape(&mirrored, &mirrored), Extent::Shape), Verdict::Valid);
    let crossed = shape(&own, &mirrored);
    let found = findings(&case, &crossed, Extent::Shape);
    assert!(found.iter().any(|f| matches!(f, Finding::TiedFacets { .. })), "{found:?}");
    assert_eq!(verdict(&case, &crossed, Extent::Shape), Verdict::Wrong);
}

/// A square in the shape by itself: either diagonal will do, both or a half will not.
#[test]
fn a_square_is_cut_once() {
    let positions =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 9.0]];
    let case = Case { weights: vec![0.0; 5], alpha: 0.5, positions };
    let shape = |facets: &[[u32; 3]]| {
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.facets = Some(facets.to_vec());
        file.vertices = Some(vec![0, 1, 2, 3, 4]);
        Answer::of(PlacedComplex::try_from(file).unwrap().complex)
    };
    let own = shape_of(&definition(&case).unwrap());
    let facets: Vec<_> = own.complex.facets.rows().to_vec();
    assert_eq!(facets.len(), 2);
    let both = [[0, 1, 2], [1, 2, 3], [0, 1, 3], [0, 2, 3]];
    let other: Vec<_> = both.into_iter().filter(|facet| !facets.contains(facet)).collect();
    for (facets, expected) in [
        (&facets[..], Verdict::Exact),
        (&other[..], Verdict::Valid),
        (&both[..], Verdict::Wrong),
        (&both[..1], Verdict::Wrong),
    ] {
        assert_eq!(verdict(&case, &shape(facets), Extent::Shape), expected, "{facets:?}");
    }
}

/// A point inside the spheres of cells is named, and no tie, though others lie on them.
#[test]
fn a_point_inside_is_no_tie() {
    let cube = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 1.0 };
    let whole = otherwise(&cube, [0, 1, 2], [-1.0, 1.0, 1.0]);
    let shape = shape_of(&whole);
    assert_eq!(verdict(&cube, &shape, Extent::Shape), Verdict::Valid);
    for inside in [[0.5; 3], [0.5, 0.5, 1.25], [0.5, -0.25, 0.5], [1.25, 0.5, 0.5]] {
        let mut case = cube.clone();
        case.positions.push(inside);
        case.weights.push(0.0);
        let found = findings(&case, &shape, Extent::Shape);
        let wrong = found.iter().filter(|f| !f.is_tie());
        let refuters = wrong.filter_map(|f| match f {
            Finding::NotRegular { point, .. } => Some(*point),
            _ => None,
        });
        let cells = shape.complex.cells.len();
        assert_eq!(refuters.collect::<Vec<_>>(), vec![8; cells], "{found:?}");
        // Nor is it hidden in a whole triangulation.
        assert_eq!(verdict(&case, &whole, Extent::Whole), Verdict::Wrong);
    }
}

/// Of the cells on one sphere, all or none must be listed: a part of a valid choice is not valid.
#[test]
fn a_part_of_a_choice_is_wrong() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let other = otherwise(&case, [0, 1, 2], [-1.0, 1.0, 1.0]);
    let mut tied = 0;
    for &cell in other.complex.cells.rows() {
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.cells = Some(vec![cell]);
        file.vertices = Some((0..8).collect());
        let part = Answer::of(PlacedComplex::try_from(file).unwrap().complex);
        let found = findings(&case, &part, Extent::Shape);
        // If the rule contains this cell, the missing ones cannot be noticed.
        if !found.is_empty() {
            let wrong: Vec<_> = found.iter().filter(|f| !f.is_tie()).collect();
            assert!(matches!(wrong[..], [Finding::TiedSphere { listed: 1, .. }]), "{found:?}");
            tied += 1;
        }
    }
    assert!(tied > 0);
}

/// If further points lie on the sphere of an isolated simplex and outside its span, a larger simplex is in the shape, too.
#[test]
fn what_spans_a_tied_sphere_is_listed() {
    let check = |positions: &[[f64; 3]],
                 weights: &[f64],
                 alpha: f64,
                 facets: &[[u32; 3]],
                 edges: &[[u32; 2]]| {
        let case = Case { positions: positions.to_vec(), weights: weights.to_vec(), alpha };
        let own = shape_of(&definition(&case).unwrap());
        assert_eq!(verdict(&case, &own, Extent::Shape), Verdict::Exact);
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.weights = Some(case.weights.clone());
        file.facets = Some(facets.to_vec());
        // The edges of facets are derived.
        file.edges = (!edges.is_empty()).then(|| edges.to_vec());
        file.vertices = Some((0..positions.len() as u32).collect());
        let less = Answer::of(PlacedComplex::try_from(file).unwrap().complex);
        let found = findings(&case, &less, Extent::Shape);
        assert!(matches!(found[..], [Finding::SpannedSphere { .. }]), "{found:?}");
    };
    // A vertex whose sphere, a point, is on that of a heavier one.
    check(
        &[[0.0; 3], [1.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]],
        &[0.0, 1.0, 0.0, 0.0, 0.0],
        0.0,
        &[],
        &[],
    );
    // The diagonal of a square.
    check(
        &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 9.0]],
        &[0.0; 5],
        0.5,
        &[],
        &[[0, 3]],
    );
    // A triangle around the middle of its sphere, and a fourth point above it.
    check(
        &[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        &[0.0; 4],
        1.0,
        &[[0, 1, 2]],
        &[],
    );
}

/// A square that cells have on one side, and facets of the other diagonal by themselves.
#[test]
fn a_face_is_cut_as_its_cells_are() {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    let own = shape_of(&definition(&case).unwrap()).complex;
    let cells = own.cells.rows().to_vec();
    for square in
        [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]]
    {
        let [a, b, c, d] = square;
        let cut = |facet: &[u32; 3]| own.facets.rows().iter().any(|row| sorted(*row) == *facet);
        let other: Vec<_> = [[a, b, c], [b, c, d], [a, b, d], [a, c, d]]
            .into_iter()
            .filter(|facet| !cut(facet))
            .collect();
        assert_eq!(other.len(), 2);
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.cells = Some(cells.clone());
        let own: Vec<_> = own.facets.rows().iter().map(|row| sorted(*row)).collect();
        file.facets = Some([&own[..], &other].concat());
        let crossed = Answer::of(PlacedComplex::try_from(file).unwrap().complex);
        let found = findings(&case, &crossed, Extent::Shape);
        assert!(found.iter().any(|f| matches!(f, Finding::TiedFacets { .. })), "{found:?}");
    }
}

/// Either of two points with the same place and weight may stay, but not both, and not a lighter one.
#[test]
fn either_of_equal_points_stays() {
    let mut case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: 0.75 };
    case.positions.push(case.positions[3]);
    case.weights.push(-0.0);
    let own = definition(&case).unwrap();
    assert_eq!(own.duplicates, [[8, 3]]);
    assert_eq!(verdict(&case, &own, Extent::Whole), Verdict::Exact);
    let instead = |row: &mut u32| *row = if *row == 3 { 8 } else { *row };
    let renumbered = |case: &Case, mut other: Answer| {
        other.complex.cells.rows_mut().as_flattened_mut().iter_mut().for_each(instead);
        other.complex.facets.rows_mut().as_flattened_mut().iter_mut().for_each(instead);
        other.complex.edges.rows_mut().as_flattened_mut().iter_mut().for_each(instead);
        other.complex.vertices.rows_mut().as_flattened_mut().iter_mut().for_each(instead);
        other.duplicates = vec![[3, 8]];
        turned_back(case, other)
    };
    let other = renumbered(&case, own.clone());
    let found = findings(&case, &other, Extent::Whole);
    assert_eq!(found, [Finding::EqualPoint { point: 8, first: 3 }]);
    assert_eq!(verdict(&case, &shape_of(&other), Extent::Shape), Verdict::Valid);
    // A program that has no word for duplicates lists them as hidden, or not at all.
    for hidden in [vec![3], vec![]] {
        let claim =
            case.claim(&other, Extent::Whole).with_duplicates(None).with_hidden(&hidden[..]);
        assert_eq!(claim.verdict().unwrap(), Verdict::Valid, "{hidden:?}");
    }
    // The result that would be right without the heavier point.
    let mut light = Case { weights: vec![0.0; 8], positions: grid(2), alpha: 0.75 };
    light.weights[3] = -0.25;
    let lighter = Case { weights: [&[0.0; 8][..], &[-0.25]].concat(), ..case.clone() };
    let other = renumbered(&lighter, definition(&light).unwrap());
    assert_eq!(verdict(&lighter, &other, Extent::Whole), Verdict::Wrong);
    let mut both = own;
    both.complex.vertices.push([8], Class::Regular);
    assert_eq!(verdict(&case, &both, Extent::Whole), Verdict::Wrong);
}

/// −0 and 0 are one weight: the first of the two stays.
#[test]
fn minus_zero_is_zero() {
    for weights in [[-0.0, 0.0], [0.0, -0.0]] {
        let mut case = Case { positions: grid(2), weights: vec![weights[0]; 8], alpha: 0.75 };
        case.positions.push([0.0; 3]);
        case.weights.push(weights[1]);
        let answer = definition(&case).unwrap();
        assert_eq!(answer.duplicates, [[8, 0]]);
        assert_eq!(verdict(&case, &answer, Extent::Whole), Verdict::Exact, "{weights:?}");
    }
}

/// Two hulls that share an edge with a third point on it: one has the whole edge, the other both halves.
#[test]
fn an_edge_is_cut_once() {
    let [a, b, m] = [0, 1, 2];
    let case = Case {
        positions: vec![
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0; 3],
            [0.0, 1.25, 0.5],
            [0.0, 1.25, -0.5],
            [0.0, -1.25, 0.5],
            [0.0, -1.25, -0.5],
        ],
        weights: vec![0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
        alpha: 1.25,
    };
    let shape = |cells: &[[u32; 4]], facets: &[[u32; 3]]| {
        let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
        file.weights = Some(case.weights.clone());
        file.cells = Some(cells.to_vec());
        file.facets = Some(facets.to_vec());
        verdict(&case, &Answer::of(PlacedComplex::try_from(file).unwrap().complex), Extent::Shape)
    };
    let faces = |cells: &[[u32; 4]]| {
        let rows = closed(cells).facets;
        rows.rows().to_vec()
    };
    let (halves, other) = ([[a, m, 3, 4], [b, m, 3, 4]], [[a, b, 5, 6]]);
    let other_halves = [[a, m, 5, 6], [b, m, 5, 6]];
    let cells = [&halves[..], &other].concat();
    assert_eq!(shape(&cells, &faces(&cells)), Verdict::Wrong);
    let cells = [&halves[..], &other_halves].concat();
    assert_ne!(shape(&cells, &faces(&cells)), Verdict::Wrong);
}

/// A tetrahedron cut around points in it that are on its sphere: a part that is missing is found although
/// the whole of it could be missing, too.
#[test]
fn a_part_of_a_cell_that_could_be_one_is_missing() {
    let positions: Vec<[f64; 3]> = [
        [12, 12, 12],
        [12, -12, -12],
        [-12, 12, -12],
        [-12, -12, 12],
        [0, -2, 4],
        [3, -7, -7],
        [4, -4, 1],
        [-2, -1, -5],
        [-5, 1, -2],
        [2, -3, -6],
    ]
    .iter()
    .map(|p: &[i32; 3]| p.map(f64::from))
    .collect();
    // All points are on the sphere around the origin through the corners.
    let weights = positions.iter().map(|p| p.iter().map(|x| x * x).sum::<f64>() - 432.0).collect();
    let case = Case { positions, weights, alpha: 432.0 };
    let around = [[0, 2, 4, 6], [0, 3, 4, 6], [2, 3, 4, 8]];
    let own = definition(&case).unwrap().complex;
    let listed = |cell: [u32; 4]| own.cells.rows().iter().any(|row| sorted(*row) == cell);
    assert!(around.into_iter().chain([[0, 2, 3, 4]]).all(listed));
    let mut file = ComplexFile::of_points(case.positions.clone(), case.alpha());
    file.weights = Some(case.weights.clone());
    file.cells = Some(around.to_vec());
    let facets = closed(&around).facets;
    file.facets = Some([facets.rows(), &[[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].concat());
    let found = PlacedComplex::try_from(file).unwrap().findings().unwrap().0;
    let missing = |f: &Finding| matches!(f, Finding::MissingCell { cell, .. } if sorted::<4>(cell.vertices().try_into().unwrap()) == [0, 2, 3, 4]);
    // The rest of what is on the sphere is missing, too.
    let rest =
        |f: &Finding| matches!(f, Finding::MissingSimplex { points, .. } if points.len() == 10);
    assert!(matches!(&found[..], [f, g] if missing(f) && rest(g)), "{found:?}");
}

/// A cell that is missing is missing in a valid complex, too.
#[test]
fn a_valid_complex_without_a_cell_is_wrong() {
    let case = Case { positions: grid(3), weights: vec![0.0; 27], alpha: 0.75 };
    let answer = otherwise(&case, [1, 2, 0], [-1.0, 1.0, -1.0]);
    for extent in [Extent::Whole, Extent::Shape] {
        assert_eq!(verdict(&case, &answer, extent), Verdict::Valid);
        let mut less = answer.clone();
        drop_row(&mut less.complex.cells, 20);
        let found = findings(&case, &less, extent);
        let wrong: Vec<_> = found.iter().filter(|f| !f.is_tie()).collect();
        assert!(matches!(wrong[..], [Finding::MissingCell { .. }]), "{wrong:?}");
    }
}

/// The filtration of a unit cube, cut along the diagonals of its mirror image.
pub(crate) fn mirrored_cube() -> FiltrationFile {
    let case = Case { positions: grid(2), weights: vec![0.0; 8], alpha: f64::INFINITY };
    let complex = otherwise(&case, [0, 1, 2], [-1.0, 1.0, 1.0]).complex;
    assert_ne!(complex, definition(&case).unwrap().complex);
    let apart = |a: u32, b: u32| f64::from((a ^ b).count_ones());
    let value = |row: &[u32]| {
        let pairs =
            row.iter().enumerate().flat_map(|(i, &a)| row[..i].iter().map(move |&b| (a, b)));
        let squares: Vec<f64> = pairs.map(|(a, b)| apart(a, b)).collect();
        let longest = squares.iter().copied().fold(0.0, f64::max);
        // The sphere of an equilateral triangle of diagonals holds the corner that it cuts off.
        let attached = row.len() == 3 && squares == [2.0; 3];
        let squared = if row.len() == 4 || attached { 0.75 } else { longest / 4.0 };
        Alpha::from_squared(squared).unwrap()
    };
    let mut file = FiltrationFile {
        points: case.positions.clone(),
        vertices: complex.vertices.rows().as_flattened().to_vec(),
        edges: complex.edges.rows().to_vec(),
        facets: complex.facets.rows().iter().map(|&row| sorted(row)).collect(),
        cells: complex.cells.rows().iter().map(|&row| sorted(row)).collect(),
        ..FiltrationFile::default()
    };
    file.values.vertices = file.vertices.iter().map(|&v| value(&[v])).collect();
    file.values.edges = file.edges.iter().map(|row| value(row)).collect();
    file.values.facets = file.facets.iter().map(|row| value(row)).collect();
    file.values.cells = file.cells.iter().map(|row| value(row)).collect();
    let rows = file.vertices.iter().map(|&v| vec![v]);
    let rows = rows.chain(file.edges.iter().map(|row| row.to_vec()));
    let rows = rows.chain(file.facets.iter().map(|row| row.to_vec()));
    let rows = rows.chain(file.cells.iter().map(|row| row.to_vec()));
    let mut order: Vec<_> =
        (0..).zip(rows).map(|(i, row): (u32, Vec<u32>)| (value(&row), row.len(), row, i)).collect();
    order.sort_by(|a, b| a.partial_cmp(b).unwrap());
    file.order = order.into_iter().map(|(.., number)| number).collect();
    file
}

/// Values and order are judged as of the other choice.
#[test]
fn a_filtration_with_another_choice_is_valid() {
    let mut file = mirrored_cube();
    let (found, certificate) = certify_filtration(&file).unwrap();
    assert_eq!(certificate.verdict, Verdict::Valid, "{found:?}");
    assert!(!found.is_empty() && found.iter().all(FiltrationFinding::is_tie), "{found:?}");
    assert!(certificate.values > 0);
    file.values.edges[0] = Alpha::from_squared(0.3).unwrap();
    let (found, certificate) = certify_filtration(&file).unwrap();
    assert_eq!(certificate.verdict, Verdict::Wrong);
    assert_eq!(found.iter().filter(|finding| !finding.is_tie()).count(), 1, "{found:?}");
}

fn sorted<const N: usize>(mut row: [u32; N]) -> [u32; N] {
    row.sort_unstable();
    row
}
