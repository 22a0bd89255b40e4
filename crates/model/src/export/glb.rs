use std::f64::consts::FRAC_1_SQRT_2;
use std::io::{self, Write};

use serde_json::{Value, json};

use super::exporter::check_range;
use super::{ExportOptions, Exporter, Needs, colour};
use walpha_shape::{AlphaShape, SinglePrecision, Surface};

/// Writes GLB, glTF 2.0 in one binary file: the boundary as triangles, singular edges as lines and singular vertices as points.
/// If F is known, vertices are coloured by it, from dark blue (least) through green to yellow (most). Coordinates are rounded to
/// `f32`; if that would move them by more than a thousandth of the shortest edge, a round number is subtracted first
/// ([`SinglePrecision`]), and the node is translated by it. The scene rotates it so that z becomes glTF's y, which points up.
#[derive(Clone, Debug, Default)]
pub struct Glb(pub ExportOptions);

/// A quarter turn about x, as a quaternion: z becomes y, and y becomes −z.
const UPRIGHT: [f64; 4] = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];

/// The codes of glTF: component types, buffer targets, primitive modes.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;

impl Exporter for Glb {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = self.0.surface(shape);
        let mut file = File::default();
        let mut document = json!({
            "asset": {
                "version": "2.0",
                "generator": "walpha",
                "extras": { "coordinates": shape.coordinates() },
            },
            "scene": 0,
            "scenes": [{}],
        });
        // glTF does not allow empty meshes.
        if surface.vertex_count() > 0 {
            let single = self.0.single(&surface, shape.points().positions());
            check_range(&single)?;
            let primitives = file.primitives(shape, &surface, &single);
            document["scenes"][0] = json!({ "nodes": [0] });
            document["nodes"] = json!([{ "mesh": 0, "rotation": UPRIGHT }]);
            if single.has_offset() {
                // The node is rotated before it is translated.
                let [x, y, z] = single.offset;
                document["nodes"][0]["translation"] = json!([x, z, 0.0 - y]);
            }
            document["meshes"] = json!([{ "primitives": primitives }]);
            let material = |double: bool| {
                json!({
                    "doubleSided": double,
                    "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.8 },
                })
            };
            document["materials"] = json!([material(false), material(true)]);
            document["accessors"] = file.accessors.into();
            document["bufferViews"] = file.views.into();
            document["buffers"] = json!([{ "byteLength": file.data.len() }]);
        }
        let mut text = serde_json::to_vec(&document)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut chunks: Vec<(&[u8; 4], &[u8])> = vec![(b"JSON", &text)];
        if !file.data.is_empty() {
            chunks.push((b"BIN\0", &file.data));
        }
        let length = 12 + chunks.iter().map(|(_, chunk)| 8 + chunk.len()).sum::<usize>();
        let too_long = |_| io::Error::other("the shape exceeds the 4 GiB that a GLB file can hold");
        out.write_all(b"glTF")?;
        out.write_all(&2u32.to_le_bytes())?;
        out.write_all(&u32::try_from(length).map_err(too_long)?.to_le_bytes())?;
        for (kind, chunk) in chunks {
            out.write_all(&(chunk.len() as u32).to_le_bytes())?;
            out.write_all(kind)?;
            out.write_all(chunk)?;
        }
        Ok(())
    }

    fn needs(&self) -> Needs {
        self.0.needs(Needs::FacetOrLine)
    }

    fn single_precision(&self, shape: &AlphaShape) -> Option<SinglePrecision> {
        Some(self.0.single_precision(shape))
    }
}

/// The binary chunk, and the views and accessors that refer to it. All numbers have 4 bytes, so all are aligned.
#[derive(Default)]
struct File {
    data: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    fn primitives(
        &mut self,
        shape: &AlphaShape,
        surface: &Surface,
        single: &SinglePrecision,
    ) -> Vec<Value> {
        let points = shape.points();
        let places = surface.positions(points.positions());
        let positions: Vec<[f32; 3]> = places.map(|place| single.round(place)).collect();
        let bound = |pick: fn(f32, f32) -> f32| {
            [0, 1, 2].map(|axis| positions.iter().map(|p| p[axis]).reduce(pick))
        };
        let bounds = json!({ "min": bound(f32::min), "max": bound(f32::max) });
        let mut attributes = json!({ "POSITION": self.vectors(&positions, bounds) });
        if let Some(values) = points.values() {
            let values: Vec<f64> = surface.numbers(values).collect();
            let colours: Vec<_> = colour::linear(&values)
                .into_iter()
                .map(|colour| colour.map(|c| c as f32))
                .collect();
            attributes["COLOR_0"] = self.vectors(&colours, json!({})).into();
        }
        let lists: [(&[u32], u32, u32); 4] = [
            (surface.regular.as_flattened(), TRIANGLES, 0),
            (surface.singular.as_flattened(), TRIANGLES, 1),
            (surface.edges.as_flattened(), LINES, 1),
            (&surface.points, POINTS, 1),
        ];
        let mut primitives = Vec::new();
        for (indices, mode, material) in
            lists.into_iter().filter(|(indices, ..)| !indices.is_empty())
        {
            let bytes = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
            let (count, target) = (indices.len(), ELEMENT_ARRAY_BUFFER);
            let accessor =
                json!({ "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" });
            let indices = self.accessor(bytes, target, accessor);
            primitives.push(json!({
                "attributes": attributes,
                "indices": indices,
                "mode": mode,
                "material": material,
            }));
        }
        primitives
    }

    fn vectors(&mut self, rows: &[[f32; 3]], mut accessor: Value) -> usize {
        accessor["componentType"] = FLOAT.into();
        accessor["count"] = rows.len().into();
        accessor["type"] = "VEC3".into();
        let bytes = rows.as_flattened().iter().flat_map(|c| c.to_le_bytes()).collect();
        self.accessor(bytes, ARRAY_BUFFER, accessor)
    }

    fn accessor(&mut self, bytes: Vec<u8>, target: u32, mut accessor: Value) -> usize {
        accessor["bufferView"] = self.views.len().into();
        let (offset, length) = (self.data.len(), bytes.len());
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": offset,
            "byteLength": length,
            "target": target,
        }));
        self.data.extend(bytes);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
