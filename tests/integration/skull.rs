//! The paper's volume, against numbers measured with other programs.

use walpha::points::{Selection, SelectionRule, Units, difference, select, weigh};
use walpha::shape::ShapeOptions;
use walpha::{Alpha, AlphaShape, Gray, Points, Weighting, alpha_shape, volume};

use crate::common::{has_skull, json};

fn points() -> Points {
    let volume = volume::sample("sample:skull").unwrap();
    let (volume, _) = volume.into_gray(Gray::Automatic).unwrap();
    let selection = Selection::default().rule(SelectionRule::Count(15956));
    let differences = difference(&volume);
    select(&volume, &volume, &differences, &selection, Units::Voxel).unwrap()
}

fn shape(points: &Points, weighting: Weighting, alpha: f64) -> AlphaShape {
    let points = weigh(points.clone(), weighting, Alpha::from_squared(alpha).unwrap()).unwrap();
    alpha_shape(points, &ShapeOptions::new(Alpha::from_squared(alpha).unwrap())).unwrap()
}

/// Counts of plain CGAL over points selected by `NumPy`.
#[test]
fn plain_cgal_counts_the_same() {
    if !has_skull() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let args = "shape sample:skull --rms 0 --count 15956 --weights common=0 --alpha 10 --hidden";
    let report = json(folder.path(), &args.split(' ').collect::<Vec<_>>());
    assert_eq!(report["shape"]["cells"]["interior"], 80756);
    assert_eq!(report["shape"]["facets"]["regular"], 13188);
    assert_eq!(report["shape"]["facets"]["singular"], 50);
    assert_eq!(report["points"]["selected"], 15956);
    assert_eq!(report["points"]["hidden"], 0);
}

/// The exact checker on the whole triangulation, and on what two blocks say.
#[test]
fn the_checker_certifies_both_engines() {
    if !has_skull() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for engine in ["--engine=native", "--engine=cgal", "--blocks=2"] {
        let args = ["check", "sample:skull", "--weights", "min-max", "--alpha", "10", engine];
        let report = json(folder.path(), &args);
        assert_eq!(report["valid"], true, "{report:#}");
        let extent = if engine == "--blocks=2" { "shape" } else { "whole" };
        assert_eq!(report["extent"], extent);
    }
}

#[test]
fn the_cut_lies_where_numpy_finds_it() {
    if !has_skull() {
        return;
    }
    let differences = points().differences.unwrap();
    let least = differences.iter().copied().fold(f64::INFINITY, f64::min);
    // Gray levels are single precision here; the next sample has L = 20.36070.
    assert!((least - 20.36094).abs() < 2e-5, "{least}");
}

#[test]
fn equal_weights_are_a_shift_of_alpha() {
    if !has_skull() {
        return;
    }
    let points = points();
    let weighted = shape(&points, Weighting::Common(10.0), 10.0);
    let plain = shape(&points, Weighting::Common(0.0), 20.0);
    assert_eq!(weighted.complex(), plain.complex());
    assert_eq!(weighted.betti(), plain.betti());
}

/// Literal barycentric weights average 0.0006, and show in nothing that can be counted.
#[test]
fn literal_barycentric_weights_change_nothing_visible() {
    if !has_skull() {
        return;
    }
    let points = points();
    let plain = shape(&points, Weighting::Common(0.0), 10.0);
    let barycentric = shape(&points, Weighting::Barycentric, 10.0);
    let surface = |shape: &AlphaShape| {
        let facets = shape.complex().facets.counts();
        [facets.regular, facets.singular]
    };
    assert_eq!(surface(&plain), surface(&barycentric));
    assert_eq!(plain.betti(), barycentric.betti());
    let (a, b) = (plain.measures().volume, barycentric.measures().volume);
    assert!((a - b).abs() < 1e-6 * a, "{a} {b}");
}
