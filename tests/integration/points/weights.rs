//! Weights.

use super::*;

fn points(differences: &[f64]) -> Points {
    let positions = (0..differences.len()).map(|i| [i as f64, 0.0, 0.0]).collect();
    Points::new(positions).with_differences(differences.to_vec()).unwrap()
}

#[test]
fn weights_follow_their_equations() {
    let four = points(&[1.0, 2.0, 2.0, 5.0]);
    let of = |weighting| {
        weigh(four.clone(), weighting, Alpha::from_squared(8.0).unwrap()).unwrap().weights
    };
    assert_eq!(of(Weighting::Common(3.0)), [3.0; 4]);
    assert_eq!(of(Weighting::MinMax), [0.0, 2.0, 2.0, 8.0]);
    assert_eq!(of(Weighting::Barycentric), [0.8, 1.6, 1.6, 4.0]);
    let n =
        weigh(four.clone(), Weighting::BarycentricN, Alpha::from_squared(8.0).unwrap()).unwrap();
    assert_eq!((n.len(), n.is_empty()), (4, false));
    assert_eq!(n.weights, [3.2, 6.4, 6.4, 16.0]);
    assert_eq!(n.summary(), WeightSummary { min: 3.2, mean: 8.0, max: 16.0 });
}

#[test]
fn equal_differences_weigh_nothing_by_min_max() {
    assert_eq!(
        weigh(points(&[2.0; 3]), Weighting::MinMax, Alpha::from_squared(9.0).unwrap())
            .unwrap()
            .weights,
        [0.0; 3]
    );
    for weighting in [Weighting::MinMax, Weighting::Barycentric, Weighting::BarycentricN] {
        assert_eq!(
            weigh(points(&[0.0; 3]), weighting, Alpha::from_squared(9.0).unwrap()).unwrap().weights,
            [0.0; 3]
        );
    }
}

#[test]
fn weights_that_cannot_be_are_refused() {
    let here = points(&[1.0, 2.0]);
    for weighting in [Weighting::MinMax, Weighting::Barycentric, Weighting::BarycentricN] {
        let text = weigh(here.clone(), weighting, Alpha::INFINITE).unwrap_err().told();
        assert!(text.contains("finite α"), "{text}");
        let scattered = Points::new(here.positions.clone());
        let text = weigh(scattered.clone(), weighting, Alpha::from_squared(1.0).unwrap())
            .unwrap_err()
            .told();
        assert!(text.contains("column") && text.contains("common=C"), "{text}");
    }
    assert!(weigh(here.clone(), Weighting::Common(1.0), Alpha::INFINITE).is_ok());
    assert!(matches!(
        weigh(here.clone(), Weighting::Column, Alpha::from_squared(1.0).unwrap()),
        Err(PointsError::NoColumn)
    ));
    let error = weigh(here.clone(), Weighting::Common(f64::NAN), Alpha::from_squared(1.0).unwrap())
        .unwrap_err();
    assert!(matches!(error, PointsError::Weight { index: 0, .. }));
}

#[test]
fn weightings_are_read_as_they_are_written() {
    use Weighting::*;
    for weighting in [Common(10.0), Common(-0.5), MinMax, Barycentric, BarycentricN, Column] {
        assert_eq!(weighting.to_string().parse(), Ok(weighting));
    }
    for text in ["common", "common=", "common=nan", "common=inf", "minmax", ""] {
        assert!(text.parse::<Weighting>().unwrap_err().told().contains("min-max"), "{text}");
    }
}
