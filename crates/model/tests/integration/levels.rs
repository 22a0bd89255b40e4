//! α of levels of detail, and of selections that the default α leaves in pieces.

use walpha_model::Recipe;
use walpha_model::pipeline::{AlphaRule, Choice, ParameterOrigin, Values};
use walpha_points::{Points, Selection, SelectionRule, Weighting};
use walpha_shape::{Alpha, AlphaShape, ShapeOptions, alpha_shape};

fn recipe(count: u64) -> Recipe {
    let selection = Selection::default().rule(SelectionRule::Count(count));
    Recipe::new().choice(Choice::Difference(selection))
}

/// The points of a phantom of 32³ voxels, so many of them, and the α of that level by a recipe.
fn level(recipe: &Recipe) -> (f64, ParameterOrigin) {
    let volume = walpha_volume::sample("sample:phantom@32").unwrap();
    let source = recipe.source(volume).unwrap();
    let weighed = recipe.weighed(&source, Values::Gray).unwrap();
    let points = Points::new(weighed.points.positions().to_vec())
        .with_differences(weighed.points.values().unwrap().to_vec())
        .unwrap();
    let parameter = recipe.level_parameter(&points, &source).unwrap();
    (parameter.alpha.squared(), parameter.origin)
}

/// The greater of 10 h² and α from the spacing, unless it is given.
#[test]
fn levels_have_an_alpha_of_their_own() {
    let (few, origin) = level(&recipe(40));
    assert!(few > 10.0 && origin == ParameterOrigin::AutoUnweighted, "{few}");
    assert_eq!(level(&recipe(40).alpha(AlphaRule::Auto)), (few, ParameterOrigin::Auto));
    assert_eq!(level(&recipe(2000)), (10.0, ParameterOrigin::Default));
    let (dense, _) = level(&recipe(2000).alpha(AlphaRule::Auto));
    assert!(dense < 10.0, "{dense}");
    let given = recipe(40).alpha(Alpha::from_squared(3.0).unwrap());
    assert_eq!(level(&given), (3.0, ParameterOrigin::Given));
    // Weights that do not depend on α are taken off where `auto` is asked for, as for any points.
    let weighted = recipe(40).alpha(AlphaRule::Auto).weighting(Weighting::Common(2.0));
    assert_eq!(level(&weighted), (few - 2.0, ParameterOrigin::Auto));
    let connected = level(&recipe(40).alpha(AlphaRule::Connected));
    assert!(connected.0 != few && connected.1 == ParameterOrigin::Connected, "{connected:?}");
}

/// The share of vertices in the largest component.
fn held(shape: &AlphaShape) -> f64 {
    let sizes = shape.components().into_iter().map(|component| component.vertices);
    sizes.max().unwrap() as f64 / shape.points_in_shape() as f64
}

/// At the α that is advised 95 % of the points are in one component, and just below it they are not.
#[test]
fn the_alpha_that_joins_is_the_least() {
    let volume = || walpha_volume::sample("sample:ct").unwrap();
    let bone = walpha_model::Settings::preset("ct-bone").unwrap().recipe().unwrap();
    let Choice::Difference(selection) = bone.choice else { panic!("by differences") };
    let few = bone.clone().choice(Choice::Difference(selection.rule(SelectionRule::Count(5000))));
    let model = few.run(volume()).unwrap();
    assert!(held(&model.shape) < 0.95);
    let alpha = model.joining_alpha().unwrap().expect("an α that joins");
    let at = |squared: f64| {
        let options = ShapeOptions::new(Alpha::from_squared(squared).unwrap());
        held(&alpha_shape(model.shape.points().clone(), &options).unwrap())
    };
    assert!(at(alpha.squared()) >= 0.95 && at(alpha.squared() * 0.998) < 0.95, "{alpha}");
    // Where nothing is in pieces, or α was given, none is advised.
    let whole = bone.run(volume()).unwrap();
    assert!(held(&whole.shape) >= 0.95 && whole.joining_alpha().unwrap().is_none());
    let given = few.alpha(model.parameter.alpha).run(volume()).unwrap();
    assert!(held(&given.shape) < 0.95 && given.joining_alpha().unwrap().is_none());
}
