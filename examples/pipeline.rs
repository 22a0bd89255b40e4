//! From a volume to a mesh in twenty lines: `cargo run --release --example pipeline`.

use std::path::Path;

use walpha::export::{ExportOptions, Format, Target};
use walpha::haar::smooth;
use walpha::points::{difference, select, weigh};
use walpha::volume::{ReadOptions, open};
use walpha::{
    Alpha, Gray, HaarOptions, Selection, Units, Weighting, alpha_shape, shape::ShapeOptions,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let input = std::env::args().nth(1).unwrap_or_else(|| "sample:phantom".into());
    let output = std::env::args().nth(2).unwrap_or_else(|| "shape.ply".into());
    let (volume, _) = open(&input, &ReadOptions::default())?.into_gray(Gray::Automatic)?;

    let (smoothed, truncation) = smooth(&volume, &HaarOptions::default())?;
    let differences = difference(&smoothed);
    let points = select(&volume, &smoothed, &differences, &Selection::default(), Units::Voxel)?;
    let alpha = Alpha::from_squared(10.0)?;
    let weighted = weigh(&points, Weighting::MinMax, alpha.squared())?;
    let shape = alpha_shape(weighted, &ShapeOptions::new(alpha))?;

    let exporter = Format::of(Path::new(&output))?.exporter(&ExportOptions::default());
    Target::open(Path::new(&output))?.write(|out| exporter.write(&shape, out))?;
    println!("{} of {} coefficients, {} points", truncation.kept, truncation.total, points.len());
    println!("{output}: {:?}, volume {}", shape.betti(), shape.measures().volume);
    Ok(())
}
