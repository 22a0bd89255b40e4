use super::*;
use crate::triangulate;
use proptest::prelude::*;

/// Cells as the positions of their corners; corners and cells sorted.
fn cells(rows: impl Iterator<Item = [u32; 4]>, positions: &[[f64; 3]]) -> Vec<[[u64; 3]; 4]> {
    let mut cells: Vec<_> = rows
        .map(|row| {
            let mut corners = row.map(|v| position_bits(positions[v as usize]));
            corners.sort_unstable();
            corners
        })
        .collect();
    cells.sort_unstable();
    cells
}

fn from_the_start(positions: &[[f64; 3]]) -> Vec<[[u64; 3]; 4]> {
    let made = triangulate(positions, None).unwrap();
    cells(made.finite_cells().map(|(_, corners)| corners), positions)
}

fn agree(growing: &Growing, when: &str) {
    let there: Vec<[f64; 3]> = (Growing::FIRST..growing.positions().len() as u32)
        .filter(|&v| growing.is_vertex(v))
        .map(|v| growing.positions()[v as usize])
        .collect();
    let finite = (0..growing.cells().len() as u32).filter(|&cell| growing.is_cell(cell));
    let rows = finite.map(|cell| growing.cells()[cell as usize].corners);
    assert!(cells(rows, growing.positions()) == from_the_start(&there), "{when}: {there:?}");
}

/// The corners of a box, and points in it, on its sides and on its edges.
fn in_a_box() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let inside = prop::collection::btree_set([0..5u8, 0..5u8, 0..5u8], 20..70);
    (inside, prop_oneof![Just(1.0), Just(0.1)]).prop_map(|(inside, step)| {
        let corners = (0..8u8).map(|i| [4 * (i & 1), 4 * (i >> 1 & 1), 4 * (i >> 2)]);
        let mut all: Vec<[u8; 3]> = corners.collect();
        all.extend(inside.into_iter().filter(|p| p.iter().any(|x| x % 4 != 0)));
        all.into_iter().map(|p| p.map(|x| step * f64::from(x))).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn it_depends_on_the_points_in_it_alone(
        points in in_a_box(), cut in 8..20usize,
        leave in prop::collection::vec(any::<prop::sample::Index>(), 1..30),
    ) {
        let mut growing = Growing::new(&points[..cut]).unwrap();
        agree(&growing, "of the first");
        let rest: Vec<u32> = growing.register(&points[cut..], &vec![0.0; points.len() - cut]).collect();
        growing.insert(&rest).unwrap();
        agree(&growing, "with more");
        let inner = points.len() - 8;
        let mut leave: Vec<u32> =
            leave.iter().map(|i| Growing::FIRST + 8 + i.index(inner) as u32).collect();
        leave.sort_unstable();
        leave.dedup();
        prop_assert_eq!(growing.remove(&leave).unwrap(), leave.len());
        agree(&growing, "without some");
        let gone: Vec<u32> = leave.into_iter().filter(|&v| !growing.is_vertex(v)).collect();
        growing.insert(&gone).unwrap();
        agree(&growing, "with them again");
    }

    #[test]
    fn insertions_and_holes_are_foreseen(points in in_a_box(), pick in any::<prop::sample::Index>()) {
        let mut growing = Growing::new(&points[..points.len() - 1]).unwrap();
        let [v] = growing.register(&points[points.len() - 1..], &[0.0]).collect::<Vec<_>>()[..] else {
            panic!("one point");
        };
        growing.take_new_cells();
        let insertions: Vec<Insertion> = {
            let predicates = growing.predicates();
            let screen = Growing::screen(&predicates).unwrap();
            let holds = |cell: &u32| {
                let cell = growing.cells()[*cell as usize].corners;
                (0..4).all(|k| {
                    let mut moved = cell;
                    moved[k] = v;
                    screen.orientation(moved).is_ge()
                })
            };
            let finite = (0..growing.cells().len() as u32).filter(|&cell| growing.is_cell(cell));
            finite.filter(holds).map(|cell| growing.insertion(&screen, v, cell)).collect()
        };
        growing.insert(&[v]).unwrap();
        let new = growing.take_new_cells();
        let rows = new.iter().map(|&cell| growing.cells()[cell as usize].corners);
        let come = cells(rows, growing.positions());
        for insertion in &insertions {
            let foreseen = cells(insertion.cells.iter().copied(), growing.positions());
            prop_assert_eq!(&foreseen, &come);
        }
        let leaves = Growing::FIRST + 8 + pick.index(points.len() - 8) as u32;
        let foreseen = {
            let predicates = growing.predicates();
            let screen = Growing::screen(&predicates).unwrap();
            let mut workspace = Workspace::new(growing.positions().len()).unwrap();
            let hole = growing.hole(&screen, leaves, &mut workspace).unwrap();
            hole.map(|hole| {
                let rows = hole.filling.iter().map(|cell| cell.corners);
                cells(rows.filter(|row| !row.contains(&AT_INFINITY)), growing.positions())
            })
        };
        if let Some(foreseen) = foreseen {
            growing.remove(&[leaves]).unwrap();
            let new = growing.take_new_cells();
            let rows = new.iter().map(|&cell| growing.cells()[cell as usize].corners);
            prop_assert_eq!(foreseen, cells(rows, growing.positions()));
        }
    }
}
