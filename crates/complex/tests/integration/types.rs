//! α, simplices and counts.

use std::cmp::Ordering;
use std::collections::HashSet;

use serde_json::json;
use walpha_complex::{Alpha, AlphaError, ByClass, Class, Complex, Simplices, SimplicesError};

#[test]
fn alpha_is_read_as_it_is_printed() {
    for text in ["0.75", "-3", "1e-300", "0", "inf", "-inf"] {
        let alpha: Alpha = text.parse().unwrap();
        assert_eq!(alpha.to_string().parse(), Ok(alpha));
        let json = serde_json::to_string(&alpha).unwrap();
        assert_eq!(serde_json::from_str::<Alpha>(&json).unwrap(), alpha, "{json}");
    }
    assert_eq!(serde_json::to_string(&Alpha::INFINITE).unwrap(), "\"inf\"");
    assert_eq!(serde_json::from_str::<Alpha>("3").unwrap().squared(), 3.0);
}

#[test]
fn alphas_are_ordered_and_hashed_as_numbers() {
    let alpha = |squared: f64| Alpha::from_squared(squared).unwrap();
    let mut alphas: Vec<Alpha> = ["inf", "0", "-3", "2", "-inf", "1e-300", "-0", "2"]
        .map(|text| text.parse().unwrap())
        .to_vec();
    alphas.sort_unstable();
    let squared: Vec<f64> = alphas.iter().map(|alpha| alpha.squared()).collect();
    assert_eq!(squared, [f64::NEG_INFINITY, -3.0, 0.0, 0.0, 1e-300, 2.0, 2.0, f64::INFINITY]);
    assert_eq!(alphas.iter().max(), Some(&Alpha::INFINITE));
    let distinct: HashSet<Alpha> = alphas.into_iter().collect();
    assert_eq!(distinct.len(), 6);
    assert_eq!((alpha(-0.0), alpha(-0.0).cmp(&Alpha::ZERO)), (Alpha::ZERO, Ordering::Equal));
}

#[test]
fn what_is_not_an_alpha_is_refused() {
    assert_eq!("nan".parse::<Alpha>(), Err(AlphaError::NaN));
    assert_eq!("big".parse::<Alpha>(), Err(AlphaError::Text("big".into())));
    assert_eq!(Alpha::from_radius(-1.0), Err(AlphaError::Radius(-1.0)));
    assert_eq!(Alpha::from_radius(3.0).unwrap().squared(), 9.0);
    assert_eq!(Alpha::from_radius(0.0).unwrap().radius(), Some(0.0));
    assert_eq!(Alpha::from_squared(9.0).unwrap().radius(), Some(3.0));
    assert_eq!(Alpha::from_squared(-9.0).unwrap().radius(), None);
    for json in ["\"big\"", "\"nan\"", "null", "[1]"] {
        let error = serde_json::from_str::<Alpha>(json).unwrap_err().to_string();
        assert!(error.contains("\"inf\" or \"-inf\""), "{json}: {error}");
    }
}

#[test]
fn simplices_have_a_class_each() {
    let error = Simplices::new(vec![[0, 1], [1, 2]], vec![Class::Regular]).unwrap_err();
    assert_eq!(error.to_string(), "2 simplices but 1 classes: each needs one");
    let SimplicesError { rows, classes, .. } = error;
    assert_eq!((rows, classes), (2, 1));
}

#[test]
fn the_shape_is_what_is_not_exterior() {
    let edges = [([0, 1], Class::Exterior), ([0, 2], Class::Singular), ([1, 2], Class::Regular)];
    let vertices = [0, 1, 2].map(|v| ([v], Class::Regular));
    let mut complex = Complex {
        edges: edges.into_iter().collect(),
        vertices: vertices.into_iter().collect(),
        ..Complex::default()
    };
    assert_eq!(complex.euler_characteristic(), 1);
    complex.retain_shape();
    assert_eq!(complex.edges.rows(), [[0, 2], [1, 2]]);
    assert_eq!(complex.edges.classes(), [Class::Singular, Class::Regular]);
    assert_eq!(complex.euler_characteristic(), 1);
}

#[test]
fn counts_by_class() {
    let classes = [Class::Exterior, Class::Interior, Class::Exterior, Class::Singular];
    let counts = classes.map(|class| ([7], class)).into_iter().collect::<Simplices<1>>().counts();
    assert_eq!(counts, ByClass { interior: 1, regular: 0, singular: 1, exterior: 2 });
    assert_eq!(counts.in_shape(), 2);
    let order: Vec<String> = counts.iter().map(|(class, n)| format!("{class} {n}")).collect();
    assert_eq!(order, ["interior 1", "regular 0", "singular 1", "exterior 2"]);
    assert!(counts.iter().all(|(class, n)| counts[class] == *n));
    // Compare values, because the order of fields is a feature of serde_json that other crates turn on.
    let whole = serde_json::to_value(counts).unwrap();
    assert_eq!(whole, json!({ "interior": 1, "regular": 0, "singular": 1, "exterior": 2 }));
    let shape = counts.serialize_shape(serde_json::value::Serializer).unwrap();
    assert_eq!(shape, json!({ "interior": 1, "regular": 0, "singular": 1 }));
}

/// The characteristic of a solid ball, a sphere, two of them, and the empty shape.
#[test]
fn the_euler_characteristic_is_that_of_the_shape() {
    let sphere = |from: u32, cell: Class| {
        let corners = [from, from + 1, from + 2, from + 3];
        let without = |k: usize| std::array::from_fn(|i| corners[i + usize::from(i >= k)]);
        let edges = (0..4).flat_map(|i| (i + 1..4).map(move |j| [corners[i], corners[j]]));
        Complex {
            cells: [(corners, cell)].into_iter().collect(),
            facets: (0..4).map(|k| (without(k), Class::Regular)).collect(),
            edges: edges.map(|edge| (edge, Class::Regular)).collect(),
            vertices: corners.into_iter().map(|v| ([v], Class::Regular)).collect(),
        }
    };
    assert_eq!(sphere(0, Class::Interior).euler_characteristic(), 1);
    assert_eq!(sphere(0, Class::Exterior).euler_characteristic(), 2);
    let (mut two, other) = (sphere(0, Class::Exterior), sphere(4, Class::Exterior));
    two.facets = two.facets.into_iter().chain(other.facets).collect();
    two.edges = two.edges.into_iter().chain(other.edges).collect();
    two.vertices = two.vertices.into_iter().chain(other.vertices).collect();
    assert_eq!(two.euler_characteristic(), 4);
    assert_eq!(Complex::default().euler_characteristic(), 0);
}
