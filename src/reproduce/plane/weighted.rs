use walpha_regular::internals::Sites;

use super::PlaneError;
use super::exact::Exact;
use super::mesh::{Edge, Mesh};
use crate::shape::{Alpha, Class, Simplices};
use walpha_base::UnionFind;

/// The weighted α-shape of points in the plane: discs of squared radius α + ω, and the complex
/// dual to their union (Edelsbrunner 1992).
#[derive(Clone, Debug, PartialEq)]
pub struct WeightedPlaneShape {
    pub(super) positions: Vec<[f64; 2]>,
    pub(super) weights: Vec<f64>,
    pub(super) alpha: Alpha,
    complex: PlaneComplex,
    /// Edges of the whole regular triangulation: pairs whose power cells may meet.
    pub(super) neighbours: Vec<[u32; 2]>,
    /// Vertices of the whole regular triangulation, ascending.
    pub(super) vertices: Vec<u32>,
    hidden: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
}

/// The simplices of a shape in the plane, by input index, with their classes; no exterior ones.
/// Triangles are counter-clockwise from the smallest index, edges ascend, rows are sorted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlaneComplex {
    /// Triangles, all of them interior: the shaded part.
    pub triangles: Simplices<3>,
    /// Edges: interior between two triangles of the shape, regular at one, singular at none.
    pub edges: Simplices<2>,
    /// Vertices: singular ones are isolated, interior ones have triangles of the shape all around.
    pub vertices: Simplices<1>,
}

/// The weighted α-shape of points (x, y) with power weights, which are squared lengths like α.
///
/// A simplex of the regular triangulation (CGAL's `Regular_triangulation_2`) belongs if its
/// smallest orthogonal circle has a squared radius of at most α and no point lies strictly inside
/// it, or if it is a face of one that belongs; both are decided exactly. It is the nerve of the
/// discs clipped to their power cells, so the shape has the homotopy type of the union of discs.
///
/// Expected O(n log n).
///
/// # Errors
/// No point; lists of different lengths; NaN, infinities or magnitudes out of range; an infinite α.
pub fn weighted_plane_shape(
    points: &[[f64; 2]],
    weights: &[f64],
    alpha: Alpha,
) -> Result<WeightedPlaneShape, PlaneError> {
    if alpha.squared().is_infinite() {
        return Err(PlaneError::InfiniteAlpha { given: alpha.squared() });
    }
    let sites = Sites::in_plane(points, weights)?;
    let mesh = Mesh::closest(&sites)?;
    let exact = Exact::weighted(sites.positions(), sites.weights(), alpha.squared());
    let input = |site: u32| sites.input()[site as usize];
    let mut vertices = mesh.vertices.iter().peekable();
    let all = 0..sites.positions().len() as u32;
    let hidden = all.filter(|site| vertices.next_if_eq(&site).is_none()).map(input).collect();
    Ok(WeightedPlaneShape {
        positions: points.to_vec(),
        weights: weights.to_vec(),
        alpha,
        complex: classify(&mesh, &exact).renumbered(input),
        neighbours: mesh.edges.iter().map(|edge| edge.ends.map(input)).collect(),
        vertices: mesh.vertices.iter().copied().map(input).collect(),
        hidden,
        duplicates: sites.duplicates().to_vec(),
    })
}

/// The complex by site index.
fn classify(mesh: &Mesh, exact: &Exact) -> PlaneComplex {
    let triangles: Vec<bool> = mesh.triangles.iter().map(|&t| exact.triangle_fits(t)).collect();
    let edges: Vec<Class> =
        mesh.edges.iter().map(|edge| edge_class(edge, exact, &triangles)).collect();

    let end = mesh.vertices.last().map_or(0, |&last| last as usize + 1);
    let mut around = vec![Around::default(); end];
    for (edge, &class) in mesh.edges.iter().zip(&edges) {
        let [p, q] = edge.ends;
        for (v, other) in [(p, q), (q, p)] {
            let around = &mut around[v as usize];
            around.any_edge |= class != Class::Exterior;
            around.other |= class != Class::Interior;
            around.attached |= exact.inside_vertex(v, other);
        }
    }
    let vertices = mesh.vertices.iter().map(|&v| {
        let class = match around[v as usize] {
            Around { any_edge: true, other: false, .. } => Class::Interior,
            Around { any_edge: true, .. } => Class::Regular,
            Around { attached: false, .. } if exact.vertex_fits(v) => Class::Singular,
            _ => Class::Exterior,
        };
        ([v], class)
    });
    let rows = mesh.edges.iter().map(|edge| edge.ends).zip(edges);
    let interior = |fits| if fits { Class::Interior } else { Class::Exterior };
    PlaneComplex {
        triangles: of_shape(
            mesh.triangles.iter().copied().zip(triangles.into_iter().map(interior)),
        ),
        edges: of_shape(rows),
        vertices: of_shape(vertices),
    }
}

/// The edges around a vertex.
#[derive(Clone, Copy, Default)]
struct Around {
    /// An edge belongs to the shape.
    any_edge: bool,
    /// An edge is not interior.
    other: bool,
    /// A point lies strictly inside the vertex's own circle.
    attached: bool,
}

fn edge_class(edge: &Edge, exact: &Exact, triangles: &[bool]) -> Class {
    let [p, q] = edge.ends;
    match edge.sides().filter(|side| triangles[side.triangle]).count() {
        2 => Class::Interior,
        1 => Class::Regular,
        // If any point lies inside the edge's circle, an apex next to it does.
        _ if exact.edge_fits(p, q)
            && !edge.sides().any(|side| exact.inside_edge(p, q, side.apex)) =>
        {
            Class::Singular
        }
        _ => Class::Exterior,
    }
}

fn of_shape<const N: usize>(rows: impl Iterator<Item = ([u32; N], Class)>) -> Simplices<N> {
    rows.filter(|&(_, class)| class != Class::Exterior).collect()
}

impl PlaneComplex {
    /// Betti numbers [b0, b1]: components, and holes by the Euler characteristic. The union of the
    /// discs has the same. O(n log n).
    #[expect(clippy::missing_panics_doc, reason = "an invariant, never broken")]
    pub fn betti(&self) -> [u64; 2] {
        let number = |v: u32| {
            self.vertices.rows().binary_search(&[v]).expect("ends of edges are vertices") as u32
        };
        let sets = UnionFind::new(self.vertices.len());
        let edges = self.edges.rows().iter();
        let united = edges.filter(|row| sets.unite(number(row[0]), number(row[1]))).count();
        // b1 = b0 − χ = (V − united) − (V − E + T)
        let loops = self.edges.len() - united - self.triangles.len();
        [(self.vertices.len() - united) as u64, loops as u64]
    }

    /// Renumbers the vertices; `number` keeps their order, so rows stay canonical.
    fn renumbered(mut self, number: impl Fn(u32) -> u32) -> Self {
        let rows = self.triangles.rows_mut().as_flattened_mut().iter_mut();
        let rows = rows.chain(self.edges.rows_mut().as_flattened_mut());
        rows.chain(self.vertices.rows_mut().as_flattened_mut()).for_each(|v| *v = number(*v));
        self
    }
}

impl WeightedPlaneShape {
    /// The points as they were given.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }

    /// Their power weights.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The parameter α.
    pub fn alpha(&self) -> Alpha {
        self.alpha
    }

    /// The radius √(α + ω) of each point's disc, by input index; `None` where α + ω < 0.
    pub fn radii(&self) -> Vec<Option<f64>> {
        let squared = self.weights.iter().map(|weight| self.alpha.squared() + weight);
        squared.map(|squared| (squared >= 0.0).then(|| squared.sqrt())).collect()
    }

    /// The simplices of the shape: the dual complex of the discs.
    pub fn complex(&self) -> &PlaneComplex {
        &self.complex
    }

    /// Points with an empty power cell, ascending: they are in no shape, and other discs cover
    /// theirs at every α.
    pub fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    /// Pairs of input indices: a point that was dropped, and the one kept at the same position.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }
}
