//! Makes a mesh from a volume: `cargo run --release --example pipeline -- ct.nii.gz ct.ply`.

use walpha::export::Save;
use walpha::volume::{ReadOptions, open};
use walpha::{Alpha, Recipe, Weighting};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let input = std::env::args().nth(1).unwrap_or_else(|| "sample:phantom".into());
    let output = std::env::args().nth(2).unwrap_or_else(|| "shape.ply".into());
    let volume = open(&input, &ReadOptions::default())?;

    let recipe = Recipe::new().weighting(Weighting::MinMax).alpha(Alpha::from_squared(10.0)?);
    let model = recipe.run(volume)?;

    let shape = model.shape;
    shape.save(&output)?;
    println!("{} points, {}", shape.points().len(), model.parameter);
    println!("{output}: {:?}, volume {}", shape.betti(), shape.measures().volume);
    Ok(())
}
