use std::io::{self, Write};

use super::Exporter;
use walpha_check::schema::{BoxVectors, ComplexFile, SchemaError};
use walpha_shape::AlphaShape;

use super::claim;

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
        let mut file = ComplexFile::from(claim(shape));
        file.periodic = shape.options().periodic.map(|torus| BoxVectors(torus.vectors()));
        file.voxels = shape.voxels().cloned();
        file.isovalue = shape.isovalue();
        file.info = Some(serde_json::json!({
            "program": concat!("walpha ", env!("CARGO_PKG_VERSION")),
            "balls": shape.options().balls,
            "coordinates": shape.coordinates(),
            "values": shape.points().values(),
        }));
        file.write_json(out).map_err(|error| match error {
            SchemaError::Io(error) => error,
            other => io::Error::other(other),
        })
    }
}
