//! Common jobs, each in at most three lines: `cargo run --release --example jobs`.

use std::error::Error;
use std::path::Path;

use walpha::export::Save;
use walpha::ladder::{Filtration, Interval};
use walpha::shape::ShapeOptions;
use walpha::triangulation::{Triangulation, TriangulationError, triangulate};
use walpha::volume::{ReadOptions, open};
use walpha::{Alpha, Complex, Recipe, WeightedPoints, alpha_shape};

/// A volume to the mesh of its shape, whose format is that of the extension.
fn mesh_of_volume(input: &str, output: &Path) -> Result<(), Box<dyn Error>> {
    let recipe = Recipe::new().alpha(Alpha::from_squared(10.0)?);
    let model = recipe.run(open(input, &ReadOptions::default())?)?;
    Ok(model.shape.save(output)?)
}

/// Points to the mesh of their shape: without weights and with a ball of this radius, which may pass between them.
fn mesh_of_points(points: &[[f64; 3]], radius: f64, output: &Path) -> Result<(), Box<dyn Error>> {
    let options = ShapeOptions::new(Alpha::from_radius(radius)?);
    Ok(alpha_shape(points, &options)?.save(output)?)
}

/// Points with their own weights, squared lengths, to the simplices of their shape and their classes.
fn complex(points: &[[f64; 3]], weights: &[f64], alpha: Alpha) -> Result<Complex, Box<dyn Error>> {
    let points = WeightedPoints::try_from((points, weights))?;
    Ok(alpha_shape(points, &ShapeOptions::new(alpha))?.complex().clone())
}

/// Points to their Delaunay triangulation.
fn delaunay(points: &[[f64; 3]]) -> Result<Triangulation, TriangulationError> {
    triangulate(points, None)
}

/// Points to the births and deaths of a dimension: 0 for components, 1 for tunnels, 2 for voids.
fn persistence(points: &[[f64; 3]], dimension: usize) -> Result<Vec<Interval>, Box<dyn Error>> {
    let filtration = Filtration::new(points)?;
    Ok(filtration.simplices()?.persistence(dimension)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    mesh_of_volume("sample:phantom@24", &folder.path().join("phantom.ply"))?;

    // A cube of 4³ points, with a heavy one.
    let points: Vec<[f64; 3]> =
        (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    let mut weights = [0.0; 64];
    weights[21] = 0.5;
    mesh_of_points(&points, 1.0, &folder.path().join("cube.stl"))?;
    println!("{} cells", complex(&points, &weights, Alpha::from_squared(1.0)?)?.cells.len());
    println!("{} facets of the hull", delaunay(&points)?.hull_facets().count());
    println!(
        "{} components, {} voids",
        persistence(&points, 0)?.len(),
        persistence(&points, 2)?.len()
    );
    Ok(())
}

#[test]
fn jobs_are_done() {
    main().expect("all of them");
}
