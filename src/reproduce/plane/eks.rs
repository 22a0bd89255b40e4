use walpha_base::advice::Advise;
use walpha_base::shown::number;
use walpha_regular::internals::Sites;

use super::PlaneError;
use super::contact::{self, Contacts, Diagram};
use super::exact::Exact;
use super::mesh::Mesh;

/// The parameter α of Edelsbrunner, Kirkpatrick and Seidel: the signed curvature, a reciprocal
/// **length**, of the boundary of a *generalised disc*.
///
/// The generalised disc of radius 1/α is a disc of that radius for α > 0, a half-plane for α = 0,
/// and the complement of an open disc of radius −1/α for α < 0; it always contains its boundary.
/// As α grows from −∞ the shape goes from single points by way of the convex hull (α = 0) to the
/// points that determine the smallest enclosing circle.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Curvature(f64);

impl Curvature {
    /// Straight: half-planes, the convex hull.
    pub const ZERO: Self = Self(0.0);
    /// The least and the greatest magnitude of an α that is not 0, 2^∓1000: beyond these, lengths near the radius
    /// are not doubles.
    pub const MAGNITUDE: [f64; 2] =
        [f64::from_bits((1023 - 1000) << 52), f64::from_bits((1023 + 1000) << 52)];

    /// α as a reciprocal length.
    ///
    /// # Errors
    /// [`NotACurvature`] for NaN and for magnitudes outside [`Curvature::MAGNITUDE`] that are
    /// not 0.
    pub fn new(alpha: f64) -> Result<Self, NotACurvature> {
        let [least, greatest] = Self::MAGNITUDE;
        if alpha == 0.0 || (least..=greatest).contains(&alpha.abs()) {
            Ok(Self(alpha))
        } else {
            Err(NotACurvature { given: alpha })
        }
    }

    /// α, a reciprocal length.
    pub fn value(self) -> f64 {
        self.0
    }

    /// The radius of the circles, 1/|α|, rounded; infinite for α = 0.
    pub fn radius(self) -> f64 {
        self.0.abs().recip()
    }
}

impl std::fmt::Display for Curvature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (alpha, radius) = (self.0, self.radius());
        if alpha > 0.0 {
            write!(f, "α = {alpha} (discs of radius {radius:.6})")
        } else if alpha < 0.0 {
            write!(f, "α = {alpha} (complements of discs of radius {radius:.6})")
        } else {
            write!(f, "α = 0 (half-planes)")
        }
    }
}

/// The number given as α is not a curvature.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "α cannot be {}: a generalised disc needs 0 or a finite reciprocal length of magnitude {least:e} to {greatest:e}",
    number(*given),
    least = Curvature::MAGNITUDE[0],
    greatest = Curvature::MAGNITUDE[1]
)]
pub struct NotACurvature {
    given: f64,
}

impl Advise for NotACurvature {}

/// The α-shape of a set of points in the plane after Edelsbrunner, Kirkpatrick and Seidel, "On the
/// shape of a set of points in the plane", 1983, doi:10.1109/TIT.1983.1056714.
#[derive(Clone, Debug, PartialEq)]
pub struct EksShape {
    pub(super) positions: Vec<[f64; 2]>,
    alpha: Curvature,
    edges: Vec<[u32; 2]>,
    extreme: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    duplicates: Vec<[u32; 2]>,
    no_disc: Option<NoDisc>,
    /// Candidates for the outline of the α-hull; see [`Contacts::arcs`].
    pub(super) arcs: Vec<[u32; 2]>,
}

/// Why a shape of positive α is empty: its discs are too small to contain all points.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the shape is empty: no disc of radius {radius:.6} (α = {}) contains all {points} points, whose smallest enclosing circle has the radius ρ = {enclosing:.6}; choose α ≤ 1/ρ = {most:.6}",
    number(*alpha),
    most = enclosing.recip()
)]
pub struct NoDisc {
    /// α.
    pub alpha: f64,
    /// 1/α, a length.
    pub radius: f64,
    /// ρ, a length, rounded.
    pub enclosing: f64,
    /// Number of distinct positions in the input.
    pub points: usize,
}

impl Advise for NoDisc {}

/// The α-shape of points (x, y): which of them, and which pairs, lie on the boundary of one
/// generalised disc of radius 1/α that contains all points.
///
/// For α < 0 it is found in the closest-point Delaunay triangulation, where −1/α is the radius
/// that CGAL's `Alpha_shape_2` knows as the square root of *its* α; for α > 0 in the
/// farthest-point one. α beyond 1/ρ, with ρ the radius of the smallest enclosing circle, gives an
/// empty shape, and [`EksShape::no_disc`] says why. Every decision is exact for α and the coordinates as
/// the doubles that they are.
///
/// Expected O(n log n), unless many points lie on one touching circle or line: all their pairs
/// are edges.
///
/// # Errors
/// No point; NaN, infinities or magnitudes out of range.
pub fn eks_shape(points: &[[f64; 2]], alpha: Curvature) -> Result<EksShape, PlaneError> {
    let unweighted = vec![0.0; points.len()];
    let sites = Sites::in_plane(points, &unweighted)?;
    let value = alpha.value();
    let mesh = if value > 0.0 { Mesh::farthest(&sites)? } else { Mesh::closest(&sites)? };
    let exact = Exact::new(sites.positions());
    let contacts = if value > 0.0 {
        contact::of_discs(&mesh, &exact, &exact.curve(value), Diagram::Farthest)
    } else if value < 0.0 {
        contact::of_discs(&mesh, &exact, &exact.curve(value), Diagram::Closest)
    } else {
        contact::of_half_planes(&mesh, &exact)
    };
    let extreme = extreme(&mesh, &contacts, value);
    let no_disc = extreme.is_empty().then(|| NoDisc {
        alpha: value,
        radius: alpha.radius(),
        enclosing: enclosing_radius(&mesh, &exact),
        points: sites.positions().len(),
    });
    let input = |site: u32| sites.input()[site as usize];
    Ok(EksShape {
        positions: points.to_vec(),
        alpha,
        // Sites ascend with their input indices, so sorted rows stay sorted.
        edges: contacts.edges.into_iter().map(|row| row.map(input)).collect(),
        extreme: extreme.into_iter().map(input).collect(),
        triangles: contacts.inside.into_iter().map(|row| row.map(input)).collect(),
        arcs: contacts.arcs.into_iter().map(|row| row.map(input)).collect(),
        duplicates: sites.duplicates().to_vec(),
        no_disc,
    })
}

/// Points on the boundary of some disc: ends of edges, and points that a disc can roll around without
/// touching another. The latter are a point on its own or, for α < 0, points whose Voronoi cell is not
/// within one radius of them, as it is at the vertices of inside triangles.
fn extreme(mesh: &Mesh, contacts: &Contacts, alpha: f64) -> Vec<u32> {
    let end = mesh.vertices.last().map_or(0, |&last| last as usize + 1);
    let (mut at_edge, mut inside) = (vec![false; end], vec![false; end]);
    contacts.edges.as_flattened().iter().for_each(|&v| at_edge[v as usize] = true);
    contacts.inside.as_flattened().iter().for_each(|&v| inside[v as usize] = true);
    let rolls = alpha < 0.0 || mesh.vertices.len() == 1;
    let extreme = |&v: &u32| at_edge[v as usize] || rolls && !inside[v as usize];
    mesh.vertices.iter().copied().filter(extreme).collect()
}

/// The radius of the smallest enclosing circle, from the farthest-point triangulation: the least
/// radius of a circle through the ends of an edge that contains all points.
fn enclosing_radius(mesh: &Mesh, exact: &Exact) -> f64 {
    let radii = mesh.edges.iter().map(|edge| {
        let [p, q] = edge.ends;
        let outside = edge.sides().any(|side| exact.apex(p, q, side.apex).is_gt());
        let circles = edge.sides().map(|side| mesh.triangles[side.triangle]);
        if outside {
            circles.map(|t| exact.length(&exact.circumradius(t))).fold(f64::INFINITY, f64::min)
        } else {
            exact.length(&exact.half_distance(p, q))
        }
    });
    radii.fold(f64::INFINITY, f64::min)
}

impl EksShape {
    /// The points as they were given.
    pub fn positions(&self) -> &[[f64; 2]] {
        &self.positions
    }

    /// The parameter α.
    pub fn alpha(&self) -> Curvature {
        self.alpha
    }

    /// α-neighbours: pairs of points on the boundary of one generalised disc that contains all
    /// points. Each pair ascends, rows are sorted.
    ///
    /// This is the definition to the letter. Where one disc touches more than two points, at a
    /// critical α or along a side of the convex hull (α = 0), *all* their pairs are neighbours;
    /// drawn, they cross or cover each other. [`EksShape::hull`] has each side once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// α-extreme points: those on the boundary of a generalised disc that contains all points.
    /// Ascending.
    pub fn extreme(&self) -> &[u32] {
        &self.extreme
    }

    /// Triangles of the inside, counter-clockwise from the smallest index, sorted: the part to shade.
    /// For α ≤ 0 Delaunay triangles with a circumradius *below* −1/α: at −1/α exactly the disc
    /// around the triangle is empty, and takes it away, while CGAL's α-complex, which is closed,
    /// keeps it. For α > 0 farthest-point triangles with a circumradius of at most 1/α.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Pairs of input indices: a point that was dropped, and the one kept at the same position.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// Why the shape is empty, if it is.
    pub fn no_disc(&self) -> Option<&NoDisc> {
        self.no_disc.as_ref()
    }
}
