//! Each stage alone: `cargo bench`. The front end on the phantom at 128³, the engines on the points
//! of the phantom at 64³. `cargo run --release -p walpha-benches` compares the engines on large sets,
//! `benches/race_wavelets.py` the front end with `PyWavelets`.

use divan::Bencher;
use walpha::haar::{HaarOptions, smooth};
use walpha::ladder::Filtration;
use walpha::points::{Selection, Units, difference, select, weigh};
use walpha::render::{Background, Projection, Scene, ShapeStyle, Size, View};
use walpha::shape::{Engine, ShapeOptions, claim};
use walpha::{
    Alpha, AlphaShape, Gray, Points, Volume, WeightedPoints, Weighting, alpha_shape, volume,
};

const WEIGHTINGS: [&str; 3] = ["common=0", "min-max", "barycentric"];

fn main() {
    divan::main();
}

fn phantom(size: usize) -> Volume {
    let phantom = volume::sample(&format!("sample:phantom@{size}")).expect("a sample");
    phantom.into_gray(Gray::Automatic).expect("gray levels").0
}

fn selected(size: usize) -> Points {
    let volume = phantom(size);
    let differences = difference(&volume);
    select(&volume, &volume, &differences, &Selection::default(), Units::Voxel).expect("points")
}

#[divan::bench]
fn haar(bencher: Bencher) {
    let volume = phantom(128);
    bencher.bench_local(|| smooth(&volume, &HaarOptions::default()));
}

#[divan::bench]
fn differences(bencher: Bencher) {
    let volume = phantom(128);
    bencher.bench_local(|| difference(&volume));
}

#[divan::bench]
fn selection(bencher: Bencher) {
    let volume = phantom(128);
    let differences = difference(&volume);
    let options = Selection::default();
    bencher.bench_local(|| select(&volume, &volume, &differences, &options, Units::Voxel));
}

#[divan::bench(args = WEIGHTINGS)]
fn weights(bencher: Bencher, weighting: &str) {
    let (points, weighting) = (selected(128), parsed(weighting));
    let alpha = Alpha::from_squared(10.0).expect("a number");
    bencher.bench_local(|| weigh(points.clone(), weighting, alpha));
}

/// The hull of points around a sphere as PNG, 1900×1300.
#[divan::bench(args = [25_000, 250_000])]
fn picture(bencher: Bencher, count: usize) {
    let place = |k: usize| {
        let z = 1.0 - 2.0 * (k as f64 + 0.5) / count as f64;
        // By the golden angle.
        let (flat, turn) = ((1.0 - z * z).sqrt(), 2.399_963_229_728_653 * k as f64);
        [flat * turn.cos(), flat * turn.sin(), z]
    };
    let points: Vec<[f64; 3]> = (0..count).map(place).collect();
    let shape = alpha_shape(points, &ShapeOptions::new(Alpha::INFINITE)).expect("a hull");
    let size = Size::new(1900, 1300).expect("a size");
    let style = ShapeStyle::default();
    bencher.bench_local(|| {
        let scene = Scene::of_shape(shape.points().positions(), shape.complex(), &style)?;
        let camera = scene.camera(View::Front, Projection::Perspective, size)?;
        scene.render(&camera, size, Background::White)?.to_png()
    });
}

#[divan::bench(args = WEIGHTINGS)]
fn cgal(bencher: Bencher, weighting: &str) {
    engine(bencher, Engine::Cgal, weighting);
}

#[divan::bench(args = WEIGHTINGS)]
fn native(bencher: Bencher, weighting: &str) {
    engine(bencher, Engine::Native, weighting);
}

fn engine(bencher: Bencher, engine: Engine, weighting: &str) {
    let alpha = Alpha::from_squared(10.0).expect("an alpha");
    let points = weigh(selected(64), parsed(weighting), alpha).expect("weights");
    let options = ShapeOptions::new(alpha).engine(engine);
    bencher
        .with_inputs(|| points.clone())
        .bench_local_values(|points| alpha_shape(points, &options));
}

/// Fifty levels of frozen weights, which should cost less than two whole shapes.
#[divan::bench]
fn ladder(bencher: Bencher) {
    let points = heavy();
    let squared = (0..50).map(|k| 0.25 * 1.17f64.powi(k));
    let alphas: Vec<_> =
        squared.map(|alpha| Alpha::from_squared(alpha).expect("a number")).collect();
    bencher.with_inputs(|| points.clone()).bench_local_values(|points| {
        Filtration::new(points).expect("a filtration").ladder(&alphas, 63f64.powi(3))
    });
}

/// A whole shape, with its exterior simplices.
#[divan::bench]
fn whole(bencher: Bencher) {
    let points = heavy();
    bencher.with_inputs(|| points.clone()).bench_local_values(whole_shape);
}

/// The cost of judging it.
#[divan::bench]
fn certify(bencher: Bencher) {
    let shape = whole_shape(heavy());
    bencher.bench_local(|| claim(&shape).findings());
}

/// The whole triangulation, as a shape.
fn whole_shape(points: WeightedPoints) -> AlphaShape {
    let options = ShapeOptions::new(Alpha::INFINITE).exterior(true).engine(Engine::Native);
    alpha_shape(points, &options).expect("a shape")
}

/// The points of the phantom at 64³ with min-max weights.
fn heavy() -> WeightedPoints {
    let alpha = Alpha::from_squared(10.0).expect("a number");
    weigh(selected(64), parsed("min-max"), alpha).expect("weights")
}

fn parsed(weighting: &str) -> Weighting {
    weighting.parse().expect("a weighting")
}
