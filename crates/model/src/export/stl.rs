use std::io::{self, Write};

use walpha_base::advice::{Advice, Setting, advice};

use super::exporter::{check_range, stated_offset};
use super::{ExportOptions, Exporter, Needs};
use walpha_shape::{AlphaShape, SinglePrecision};
use walpha_volume::annotation;

/// Writes binary STL: the regular facets, counter-clockwise seen from outside, with their normals. Coordinates are rounded to
/// `f32`; if that would move them by more than a thousandth of the shortest edge, a round number is subtracted first
/// ([`SinglePrecision`]), which the header states: `OFFSET=434000,5412000,0`. Singular facets, edges and vertices do not bound a
/// solid and are left out.
#[derive(Clone, Debug, Default)]
pub struct Stl(pub ExportOptions);

impl Exporter for Stl {
    fn encode(&self, shape: &AlphaShape, out: &mut dyn Write) -> io::Result<()> {
        let surface = self.0.surface(shape);
        let positions: Vec<_> = surface.positions(shape.points().positions()).collect();
        let single = self.0.single(&surface, shape.points().positions());
        out.write_all(&head(&about(shape, &single))?)?;
        facets(&positions, &surface.regular, &single, out)
    }

    fn needs(&self) -> Needs {
        Needs::RegularFacet
    }

    fn single_precision(&self, shape: &AlphaShape) -> Option<SinglePrecision> {
        Some(self.0.single_precision(shape))
    }

    fn remark(&self, shape: &AlphaShape) -> Option<Advice> {
        if shape.options().periodic.is_some() {
            return Some("the sides of the periodic box cut the boundary open".into());
        }
        let defects = self.0.surface(shape).manifold_defects();
        (!defects.is_empty()).then(|| {
            let what = format!(
                "the boundary is not manifold: edges on more than two facets: {}, other vertices where parts touch: {}; programs \
                 that want a solid may refuse it: ",
                defects.edges, defects.vertices
            );
            advice![what, Setting::Solid, " cuts it apart there"]
        })
    }
}

/// What the header says.
fn about(shape: &AlphaShape, single: &SinglePrecision) -> String {
    let stated = annotation::comment(shape.coordinates());
    // The header must not begin with "solid", as some readers would take the file for text.
    if let Some(offset) = stated_offset(single) {
        return format!("walpha {offset}{stated}");
    }
    let of = match (shape.voxels(), shape.isovalue()) {
        (Some(_), _) => "solid of labels",
        (None, Some(_)) => "solid inside an isosurface",
        (None, None) => "boundary of an alpha shape",
    };
    format!("walpha, {of}{stated}")
}

/// The header of 80 bytes.
///
/// # Errors
/// The numbers of an offset do not fit into the header.
pub(super) fn head(about: &str) -> io::Result<[u8; 80]> {
    let mut head = [b' '; 80];
    let room = head.get_mut(..about.len());
    let room = room.ok_or_else(|| {
        io::Error::other(
            "the offset of its coordinates has more digits than the header of an STL has room for",
        )
    })?;
    room.copy_from_slice(about.as_bytes());
    Ok(head)
}

/// Writes the number of facets, and each with its normal.
pub(super) fn facets(
    positions: &[[f64; 3]],
    facets: &[[u32; 3]],
    single: &SinglePrecision,
    out: &mut dyn Write,
) -> io::Result<()> {
    check_range(single)?;
    let count = u32::try_from(facets.len())
        .map_err(|_| io::Error::other("more facets than STL can count"))?;
    out.write_all(&count.to_le_bytes())?;
    for facet in facets {
        let corners = facet.map(|v| positions[v as usize]);
        let [a, b, c] = corners.map(|corner| single.round(corner));
        for component in [normal(corners).map(|x| x as f32), a, b, c].as_flattened() {
            out.write_all(&component.to_le_bytes())?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

/// The unit normal of a triangle; 0 if it has no area.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let from_a = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
    let (u, v) = (from_a(b), from_a(c));
    let cross = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j] * v[k] - u[k] * v[j]
    });
    let length = cross.iter().map(|n| n * n).sum::<f64>().sqrt();
    if length > 0.0 { cross.map(|n| n / length) } else { [0.0; 3] }
}
