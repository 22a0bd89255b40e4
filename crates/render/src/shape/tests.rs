use super::*;

fn simplices<const N: usize>(rows: Vec<[u32; N]>, classes: Vec<Class>) -> Simplices<N> {
    Simplices::new(rows, classes).unwrap()
}

/// A tetrahedron, a singular triangle, a singular edge and a lone vertex, far apart.
fn shape() -> (Vec<[f64; 3]>, Complex) {
    let positions = (0..12).map(|k| [f64::from(k % 3), f64::from(k / 3), f64::from(k * k % 5)]);
    let complex = Complex {
        facets: simplices(
            vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [4, 5, 6], [6, 7, 8]],
            [vec![Class::Regular; 4], vec![Class::Singular, Class::Exterior]].concat(),
        ),
        edges: simplices(vec![[0, 1], [7, 8]], vec![Class::Regular, Class::Singular]),
        vertices: simplices(vec![[0], [9]], vec![Class::Regular, Class::Singular]),
        ..Complex::default()
    };
    (positions.collect(), complex)
}

#[test]
fn each_class_becomes_what_it_should() {
    let (positions, complex) = shape();
    let style = ShapeStyle { colouring: Colouring::Classes, ..ShapeStyle::default() };
    let scene = Scene::of_shape(&positions, &complex, &style).unwrap();
    let [regular, singular] = &scene.meshes[..] else { panic!("{} meshes", scene.meshes.len()) };
    assert_eq!(regular.triangles, complex.facets.rows()[..4]);
    assert_eq!(regular.positions, positions[..4]);
    assert!(!regular.two_sided && singular.two_sided);
    assert_eq!(singular.triangles, [[0, 1, 2]]);
    assert_eq!(singular.positions, positions[4..7]);
    let [facets, singular_facets, edges, vertices] = class_colours().map(|(_, colour)| colour);
    assert_eq!(regular.colours, Colours::Uniform(facets));
    assert_eq!(singular.colours, Colours::Uniform(singular_facets));
    let [tube] = scene.tubes[..] else { panic!("{} tubes", scene.tubes.len()) };
    assert_eq!((tube.ends, tube.colour), ([positions[7], positions[8]], edges));
    let [ball] = scene.balls[..] else { panic!("{} balls", scene.balls.len()) };
    assert_eq!((ball.centre, ball.colour), (positions[9], vertices));
}

#[test]
fn values_colour_the_points_they_belong_to() {
    let (positions, complex) = shape();
    let values: Vec<f64> = (0..12).map(f64::from).collect();
    let map = ColourMap::over(&values);
    let colouring = Colouring::Values(&values, map);
    let style = ShapeStyle { colouring, opacity: 0.5, edge_radius: 0.0, ..ShapeStyle::default() };
    let scene = Scene::of_shape(&positions, &complex, &style).unwrap();
    let expected = [4.0, 5.0, 6.0].map(|v| map.colour(v)).to_vec();
    assert_eq!(scene.meshes[1].colours, Colours::Vertex(expected));
    assert!(scene.meshes.iter().all(|m| m.two_sided && m.opacity == 0.5));
    assert!(scene.tubes.is_empty() && scene.balls.is_empty());
}

#[test]
fn empty_shapes_are_empty_scenes_and_wrong_points_are_refused() {
    let style = ShapeStyle::default();
    let empty = Scene::of_shape(&[], &Complex::default(), &style).unwrap();
    assert_eq!(empty, Scene::default());
    let (positions, complex) = shape();
    let error = Scene::of_shape(&positions[..5], &complex, &style).unwrap_err();
    assert!(matches!(error, RenderError::Point { vertex: 9, points: 5 }), "{error}");
    let colouring = Colouring::Values(&[1.0], ColourMap::new(0.0, 1.0));
    let style = ShapeStyle { colouring, ..style };
    let error = Scene::of_shape(&positions, &complex, &style).unwrap_err();
    assert!(matches!(error, RenderError::Values { got: 1, points: 12 }), "{error}");
}
