use std::io::{self, Write};

use super::Exporter;
use walpha_check::schema::SchemaError;
use walpha_shape::AlphaShape;

use super::claim::complex_file;

/// Writes JSON: the complex with its points, power weights and α, in the [`schema`](walpha_check::schema) that `walpha check` and
/// `walpha compare` read. α and the weights are those that classify the simplices: for [`Balls::Radius`](walpha_shape::Balls) the
/// weights are (α + ω)², and α is 0.
#[derive(Clone, Copy, Debug)]
pub struct Json;

impl Exporter for Json {
    fn knows_torus(&self) -> bool {
        true
    }

    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let mut file = complex_file(shape);
        file.info = Some(serde_json::json!({
            "program": concat!("walpha ", env!("CARGO_PKG_VERSION")),
            "balls": shape.options().balls,
            "coordinates": shape.coordinates(),
            "values": shape.points().values().map(|values| &values[..file.points.len()]),
        }));
        file.write_json(out).map_err(|error| match error {
            SchemaError::Io(error) => error,
            other => io::Error::other(other),
        })
    }
}
