//! Compares our alpha shape with GUDHI's: `cargo run --release --example compare_with_gudhi`.
//!
//! Needs Python with GUDHI (`pip install gudhi numpy`). docs/cross-checking.md does the same with
//! commands, and describes the file that any program can write.

use std::io::Write;
use std::process::{Command, Stdio};

use walpha::check::schema::{ComplexFile, PlacedComplex};
use walpha::check::{Placed, compare};
use walpha::points::{Points, Weighting, weigh};
use walpha::shape::{Alpha, ShapeOptions, alpha_shape};

/// Reads points and α, and answers with the complex in the schema of `walpha check`.
const GUDHI: &str = r#"
import json, sys
import gudhi

given = json.load(sys.stdin)
tree = gudhi.AlphaComplex(points=given["points"], precision="exact").create_simplex_tree()
rows = {1: [], 2: [], 3: [], 4: []}
for simplex, squared_radius in tree.get_filtration():
    if squared_radius <= given["alpha"]:
        rows[len(simplex)].append(simplex)
json.dump({**given, "cells": rows[4], "facets": rows[3], "edges": rows[2],
           "vertices": [v for [v] in rows[1]]}, sys.stdout)
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A grid is full of ties, where programs differ if they decide by rounded numbers.
    let place = |i: usize| [i % 5, i / 5 % 5, i / 25].map(|c| c as f64);
    let positions: Vec<[f64; 3]> = (0..125).map(place).collect();
    let alpha = Alpha::from_squared(0.75)?;

    let points = Points::new(positions.clone());
    let weighted = weigh(points, Weighting::Common(0.0), alpha)?;
    let shape = alpha_shape(weighted, &ShapeOptions::new(alpha))?;

    let given = serde_json::json!({ "points": positions, "alpha": alpha });
    let mut python = Command::new("python3")
        .args(["-c", GUDHI])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    python.stdin.take().ok_or("no pipe")?.write_all(given.to_string().as_bytes())?;
    let answer = python.wait_with_output()?;
    if !answer.status.success() {
        return Err("GUDHI did not answer: pip install gudhi numpy".into());
    }
    let theirs = PlacedComplex::try_from(ComplexFile::read_json(&answer.stdout[..])?)?;

    let ours = Placed::new(&positions, shape.power_weights(), shape.power_alpha(), shape.complex());
    let comparison = compare(ours, theirs.placed())?;
    for (name, d) in ["vertices", "edges", "facets", "cells"].iter().zip(&comparison.dimensions) {
        println!(
            "{name:<9}{:>5} equal, {} only ours, {} only GUDHI's",
            d.equal,
            d.only_a.len(),
            d.only_b.len()
        );
    }
    println!("{}", comparison.domain);
    Ok(())
}
