//! NaN, infinities and unreasonable numbers, in everything that takes numbers: an error that names the point or the option.

use ndarray::Array3;
use walpha_base::random::Random;
use walpha_check::enumerate;
use walpha_check::schema::{ComplexFile, PlacedComplex};
use walpha_model::Recipe;
use walpha_model::interpolate::{Grid, Interpolant};
use walpha_model::pipeline::{AlphaRule, Choice, Goal, Parameter};
use walpha_points::haar::{HaarOptions, Tolerance};
use walpha_points::{ModelMetadata, Packing, PointWriter};
use walpha_points::{Points, Selection, SelectionRule, Units, Weighting};
use walpha_regular::{PowerDiagram, triangulate};
use walpha_shape::ladder::Filtration;
use walpha_shape::{Alpha, alpha_shape};
use walpha_shape::{Balls, Engine, Outline, ShapeOptions, Torus, WeightedPoints};
use walpha_volume::{Dims, Frame, GrayRange, LengthUnit, Volume};

const WRONG: [f64; 4] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308];
/// The point at fault.
const AT: usize = 7;

fn cloud() -> Vec<[f64; 3]> {
    let mut random = Random::new(6);
    (0..30).map(|_| [0; 3].map(|_| random.unit())).collect()
}

/// An error that names these words.
fn names<T>(result: Result<T, impl ToString>, words: &[&str], what: &str) {
    let text = result.err().unwrap_or_else(|| panic!("{what} was taken")).to_string();
    assert!(words.iter().all(|word| text.contains(word)), "{what}: {text}");
}

/// Everything that takes points, by position and weight.
#[test]
fn points_are_named() {
    for wrong in WRONG {
        let (mut positions, mut weights) = (cloud(), vec![0.0; 30]);
        positions[AT][1] = wrong;
        let place = "point 7 has y ";
        weights[AT] = wrong;
        for (positions, weights, word) in
            [(&positions, &vec![0.0; 30], place), (&cloud(), &weights, "point 7 has weight ")]
        {
            let points = || WeightedPoints::new(positions.clone(), weights.clone()).unwrap();
            let what = |name: &str| format!("{name} of {wrong}");
            for alpha in [Alpha::from_squared(0.1).unwrap(), Alpha::INFINITE] {
                let options = ShapeOptions::new(alpha);
                for engine in [Engine::Auto, Engine::Native] {
                    names(alpha_shape(points(), &options.engine(engine)), &[word], &what("shape"));
                }
                let torus = Torus::new([2.0; 3]).unwrap();
                names(alpha_shape(points(), &options.periodic(torus)), &[word], &what("torus"));
            }
            names(Filtration::new(points()), &[word], &what("filtration"));
            names(triangulate(positions, Some(weights)), &[word], &what("triangulation"));
            let unit = LengthUnit::default();
            names(Parameter::of_spacing(&points(), None, unit), &[word], &what("spacing"));
            for rule in [AlphaRule::Auto, AlphaRule::Connected, AlphaRule::Default] {
                let recipe = Recipe::new().alpha(rule);
                let given = Points::new(positions.clone()).with_weights(weights.clone()).unwrap();
                let word = if word == place { place } else { "point 7 is" };
                names(recipe.run_points(given).map(drop), &[&word[..7]], &what("run_points"));
            }
            // The checker is exact for all doubles.
            if !wrong.is_finite() {
                let checked = enumerate(positions, weights, Alpha::ZERO);
                names(checked.map(drop), &["7"], &what("enumerate"));
            }
        }
        let made = triangulate(&cloud(), None).unwrap();
        names(PowerDiagram::of(&made, Some(&weights)), &["point 7 has weight "], "power diagram");
        assert!(made.locate([0.5, wrong, 0.5]).is_none());
    }
}

#[test]
fn values_are_named() {
    for wrong in &WRONG[..3] {
        let mut values = vec![1.0; 30];
        values[AT] = *wrong;
        let points = WeightedPoints::unweighted(cloud()).with_values(values.clone()).unwrap();
        let options = ShapeOptions::new(Alpha::INFINITE);
        names(alpha_shape(points.clone(), &options), &["point 7 has value "], "shape");
        names(Filtration::new(points.clone()), &["point 7 has value "], "filtration");
        let given = Points::new(cloud()).with_values(values.clone()).unwrap();
        let recipe = Recipe::new();
        names(recipe.run_points(given.clone()).map(drop), &["point 7 has value "], "run_points");
        let weighted = recipe.alpha(Alpha::ZERO).weighting(Weighting::MinMax);
        names(weighted.run_points(given).map(drop), &["point"], "differences");
        let shape = alpha_shape(cloud(), &options).unwrap();
        names(Interpolant::with_values(&shape, &values), &["point 7"], "interpolant");
        for format in ["a.csv", "a.npy", "a.wvm"] {
            let written = PointWriter::of(format).unwrap().write(&points, &mut Vec::new());
            names(written, &["point 7"], format);
        }
    }
}

#[test]
fn numbers_of_options_are_named() {
    let points = || WeightedPoints::unweighted(cloud());
    for wrong in WRONG {
        let what = format!("{wrong}");
        if wrong.is_nan() {
            assert!(Alpha::from_squared(wrong).is_err());
        }
        assert!(wrong == f64::INFINITY || Alpha::from_radius(wrong).is_err());
        for axis in 0..3 {
            let mut sides = [1.0; 3];
            sides[axis] = wrong;
            names(Torus::new(sides), &["along ", ["x", "y", "z"][axis]], &what);
        }
        let common = Recipe::new().weighting(Weighting::Common(wrong)).alpha(Alpha::ZERO);
        if wrong.is_finite() {
            names(common.run_points(Points::new(cloud())).map(drop), &["weight"], &what);
        } else {
            names(common.run_points(Points::new(cloud())).map(drop), &["point 0"], &what);
        }
        let dims = Dims::new(2, 2, 2).unwrap();
        let grid = Grid::spanning([0.0, wrong, 0.0], [1.0; 3], dims);
        names(grid, &["along y"], &what);
        let thinned = Points::new(cloud()).thin(wrong);
        assert_eq!(thinned.is_ok(), wrong == 1e308);
    }
    names(Points::new(cloud()).thin(0.0), &["cubes of side 0"], "thin");
    let radius = ShapeOptions::new(Alpha::INFINITE).balls(Balls::Radius);
    names(alpha_shape(points(), &radius), &["point 0", "radius"], "balls");
    let packing = Packing::default().value_error(f64::NAN);
    let with_values = points().with_values(vec![0.5; 30]).unwrap();
    let wvm = PointWriter::of("a.wvm").unwrap();
    let packed =
        wvm.write_model(&with_values, &[], &ModelMetadata::default(), &packing, &mut Vec::new());
    names(packed, &["error", "NaN"], "value_error");
    for wrong in [1e200, 1e-200] {
        names(Alpha::from_radius(wrong), &["square"], "radius");
    }
}

#[test]
fn numbers_of_volumes_are_named() {
    let mut random = Random::new(9);
    let samples = Array3::from_shape_simple_fn((5, 6, 7), || (255.0 * random.unit()) as f32);
    let volume = || Volume::new(samples.clone(), Frame::VOXEL).unwrap();
    let run = |recipe: Recipe| recipe.run(volume()).map(drop);
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let what = format!("{wrong}");
        let mut holed = samples.clone();
        holed[[1, 2, 3]] = wrong as f32;
        names(Volume::new(holed, Frame::VOXEL), &["3", "2", "1"], &what);
        for tolerance in [Tolerance::Rms(wrong), Tolerance::Epsilon(wrong)] {
            let haar = HaarOptions::default().tolerance(tolerance);
            // All coefficients may be dropped.
            if wrong != f64::INFINITY {
                names(run(Recipe::new().haar(haar)), &["tolerance", &what], &what);
            }
        }
        let selection = |rule| Choice::Difference(Selection::default().rule(rule));
        names(run(Recipe::new().choice(selection(SelectionRule::Ratio(wrong)))), &["ratio"], &what);
        let goal = |goal: Goal| Recipe::new().choice(Choice::Adaptive(goal));
        names(run(goal(Goal { ratio: Some(wrong), ..Goal::default() })), &["ratio"], &what);
        names(run(Recipe::new().gray(GrayRange { low: 0.0, high: wrong })), &["gray range"], &what);
        let placed = |frame: Frame| {
            Recipe::new()
                .units(Units::World)
                .run(Volume::new(samples.clone(), frame).unwrap())
                .map(drop)
        };
        let frame = Frame { origin: [0.0, wrong, 0.0], ..Frame::VOXEL };
        names(placed(frame), &["point 0 has y"], &what);
        let frame = Frame { spacing: [1.0, wrong, 1.0], ..Frame::VOXEL };
        assert!(placed(frame).is_err(), "{what}");
    }
    let nan = f64::NAN;
    let selection = |rule| Choice::Difference(Selection::default().rule(rule));
    names(
        run(Recipe::new().choice(selection(SelectionRule::Threshold(nan)))),
        &["threshold"],
        "NaN",
    );
    names(run(Recipe::new().value_min(Some(nan))), &["a least value of NaN"], "NaN");
    let goal = |goal: Goal| Recipe::new().choice(Choice::Adaptive(goal));
    names(run(goal(Goal { rmse: Some(nan), ..Goal::of_count(20) })), &["NaN"], "rmse");
    names(run(goal(Goal { max_error: Some(nan), ..Goal::of_count(20) })), &["NaN"], "max_error");
    // 10 h² beyond the doubles is not the convex hull.
    let frame = Frame { spacing: [1e160; 3], ..Frame::VOXEL };
    let huge = Recipe::new().units(Units::World).run(Volume::new(samples.clone(), frame).unwrap());
    names(huge.map(drop), &["square"], "spacing");
}

#[test]
fn what_others_made_is_judged_or_refused() {
    for wrong in WRONG {
        let mut positions = cloud();
        positions[AT][1] = wrong;
        names(Outline::check(&positions), &["point 7"], &format!("{wrong}"));
        if wrong.is_finite() {
            continue;
        }
        let mut file = ComplexFile::of_points(positions, Alpha::ZERO);
        file.vertices = Some((0..30).collect());
        let judged = PlacedComplex::try_from(file).map_err(|error| error.to_string());
        let judged = judged.and_then(|placed| placed.findings().map_err(|error| error.to_string()));
        names(judged, &["7"], &format!("{wrong}"));
    }
}
