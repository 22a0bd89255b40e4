//! Measures unions of balls for scripts: `measure < balls.txt`.
//!
//! Each line of the input is a ball, `x y z s` with its squared radius s; an empty line ends a set. For each set a line of JSON is
//! printed: the dual complex, by the numbers of balls, and measures, each a pair of the value and its bound. Contacts are in the order of
//! the edges. Doubles are printed so that they can be read back exactly.

use std::error::Error;
use std::fmt::Write;
use std::io::{Read, stdin};

use walpha_balls::{BallUnion, Bounded};
use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};

fn main() -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    stdin().read_to_string(&mut text)?;
    for set in text.split("\n\n").filter(|set| !set.trim().is_empty()) {
        println!("{}", measured(set)?);
    }
    Ok(())
}

fn measured(set: &str) -> Result<String, Box<dyn Error>> {
    let (mut positions, mut weights) = (Vec::new(), Vec::new());
    for line in set.lines() {
        let numbers: Vec<f64> =
            line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        let &[x, y, z, squared] = numbers.as_slice() else {
            return Err(
                format!("{line:?} is not a ball: give x, y, z and the squared radius").into()
            );
        };
        positions.push([x, y, z]);
        weights.push(squared);
    }
    let points = WeightedPoints::new(positions, weights)?;
    let shape = alpha_shape(points, &ShapeOptions::new(Alpha::ZERO))?;
    let union = BallUnion::new(&shape)?;
    let mut line = format!("{{\"euler_characteristic\": {}", union.euler_characteristic());
    let totals = [
        ("volume", union.volume()),
        ("area", union.area()),
        ("mean_curvature", union.mean_curvature()),
        ("gaussian_curvature", union.gaussian_curvature()),
    ];
    for (name, number) in totals {
        write!(line, ", \"{name}\": {}", pair(number))?;
    }
    let contacts = union.contacts();
    for (name, column) in
        [("volumes", union.volumes()), ("areas", union.areas()), ("contacts", contacts.sizes)]
    {
        let numbers: Vec<String> = (0..column.len()).map(|row| pair(column.get(row))).collect();
        write!(line, ", \"{name}\": [{}]", numbers.join(", "))?;
    }
    let complex = shape.complex();
    write!(line, ", \"vertices\": {:?}", complex.vertices.rows())?;
    write!(line, ", \"edges\": {:?}", complex.edges.rows())?;
    write!(line, ", \"facets\": {:?}", complex.facets.rows())?;
    write!(line, ", \"cells\": {:?}}}", complex.cells.rows())?;
    Ok(line)
}

/// A value and its bound, `null` where it is infinite.
fn pair(Bounded { value, bound }: Bounded) -> String {
    if bound.is_finite() { format!("[{value:?}, {bound:?}]") } else { format!("[{value:?}, null]") }
}
