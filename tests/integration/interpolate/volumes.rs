//! F of points of a volume, against the volume.

use walpha::interpolate::{Grid, Interpolant, fill};
use walpha::points::{difference, select, weigh};
use walpha::{Alpha, Selection, SelectionRule, Units, Weighting};

use super::{phantom, phantom_points, shape};

#[test]
fn differences_around_points_are_those_of_their_samples() {
    let volume = phantom(12);
    let made = shape(phantom_points(&volume, 150), 3.0);
    let whole = fill(&made, Some(&volume), Units::Voxel).unwrap();
    let interpolant = Interpolant::new(&whole).unwrap();
    let grid = Grid::of(&volume, Units::Voxel);
    let found = interpolant.local_deviations(&volume, &grid).unwrap();
    let mut sums = vec![(0.0, 0.0); whole.points().len()];
    for ((z, y, x), &sample) in volume.samples().indexed_iter() {
        let place = interpolant.locate([x, y, z].map(|i| i as f64)).expect("filled in");
        let shares = place.simplex.iter().zip(place.coordinates);
        let values = whole.points().values.as_ref().unwrap();
        let ours: f64 = shares.clone().map(|(&v, share)| share * values[v as usize]).sum();
        for (&v, share) in shares {
            sums[v as usize].0 += share * (ours - f64::from(sample)).powi(2);
            sums[v as usize].1 += share;
        }
    }
    assert_eq!(found.len(), sums.len());
    for (found, (squares, weights)) in found.iter().zip(sums) {
        let expected = if weights > 0.0 { f64::sqrt(squares / weights) } else { 0.0 };
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }
    assert!(found.iter().any(|&difference| difference > 10.0));
}

#[test]
fn filling_covers_the_grid_and_keeps_the_points() {
    let volume = phantom(16);
    let differences = difference(&volume);
    let selection = Selection::default().rule(SelectionRule::Count(300));
    let selected = select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap();
    for weighting in [Weighting::Common(0.0), Weighting::MinMax, Weighting::BarycentricN] {
        let shape = shape(
            weigh(selected.clone(), weighting, Alpha::from_squared(10.0).unwrap()).unwrap(),
            10.0,
        );
        let whole = fill(&shape, Some(&volume), Units::Voxel).unwrap();
        assert_eq!(whole.points().len(), 308);
        let grid = Grid::of(&volume, Units::Voxel);
        let resampled = Interpolant::new(&whole).unwrap().resample(&grid).unwrap();
        assert_eq!(resampled.covered(), volume.dims().samples());
        // Vertices have their values; hidden points need not.
        let mut vertices = 0;
        for &[v] in whole.complex().vertices.rows() {
            let [x, y, z] = whole.points().positions[v as usize].map(|c| c as usize);
            assert_eq!(resampled.volume().samples()[[z, y, x]], volume.samples()[[z, y, x]]);
            vertices += 1;
        }
        let hidden = whole.hidden().unwrap().len();
        assert_eq!(vertices + hidden, 308);
        assert_eq!(hidden > 0, weighting != Weighting::Common(0.0));
    }
}
