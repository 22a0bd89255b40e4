//! Volume, area and curvatures of the union, of each ball and of each contact.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use walpha_base::parallel::prelude::*;
use walpha_base::{Monitor, memory};
use walpha_shape::ladder::Covering;
use walpha_shape::{AlphaShape, Class, Complex, FacetSides};

use crate::BallsError;
use crate::points::Points;
use crate::quick::Quick;
use crate::real::{Bounded, Double, Real, Single};
use crate::scatter::{Records, ranges, scatter};
use crate::simplex::{Circle, Edge, Limits, Open, Side, Triangle};

/// Numbers with bounds, as two columns: of row i, the true number is within `bounds[i]` of `values[i]`.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// The values.
    pub values: Vec<f64>,
    /// The bounds on their errors, in the same unit.
    pub bounds: Vec<f64>,
}

impl Measured {
    /// The number of rows.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// A row.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn get(&self, row: usize) -> Bounded {
        Bounded { value: self.values[row], bound: self.bounds[row] }
    }

    /// The sum of some rows.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn sum(&self, rows: impl IntoIterator<Item = usize>) -> Bounded {
        let mut sum = Double::default();
        for row in rows {
            sum += Single { value: self.values[row], error: self.bounds[row] };
        }
        sum.rounded().bounded()
    }

    fn with_capacity(rows: usize, what: &'static str) -> Result<Self, BallsError> {
        let column = || memory::try_with_capacity(rows, || what.into());
        Ok(Self { values: column()?, bounds: column()? })
    }

    fn push(&mut self, Bounded { value, bound }: Bounded) {
        self.values.push(value);
        self.bounds.push(bound);
    }

    pub(crate) fn collect(
        rows: usize,
        what: &'static str,
        row: impl Fn(usize) -> Bounded + Sync,
    ) -> Result<Self, BallsError> {
        let Self { mut values, mut bounds } = Self::with_capacity(rows, what)?;
        let number = |i| {
            let Bounded { value, bound } = row(i);
            (value, bound)
        };
        (0..rows).into_par_iter().map(number).unzip_into_vecs(&mut values, &mut bounds);
        Ok(Self { values, bounds })
    }
}

/// The union of the balls of a classified α-complex: a point with weight ω is a ball of squared radius α + ω.
///
/// The complex is exact, so it is the dual complex of the union: a simplex belongs if and only if the balls of its vertices have a common
/// point within their power cells. Volume and area follow by inclusion and exclusion over its simplices (Edelsbrunner 1995,
/// doi:10.1007/BF02574053), here with angles as coefficients, so that nothing cancels but what is small. Every number comes with a bound
/// on its error, for the balls whose centres and squared radii are exactly those of the input doubles. `docs/balls.md` has the formulas, and
/// the proof of the bounds.
///
/// Removed duplicates and hidden points have no part in the union: their parts are 0.
///
/// ```
/// use walpha_balls::BallUnion;
/// use walpha_shape::{Alpha, ShapeOptions, WeightedPoints, alpha_shape};
///
/// // Two balls of radius 1, whose centres are 1 apart. The weight of a ball is its squared radius, at α = 0.
/// let points = WeightedPoints::new(vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![1.0; 2])?;
/// let shape = alpha_shape(points, &ShapeOptions::new(Alpha::ZERO))?;
/// let union = BallUnion::new(&shape)?;
/// let volume = union.volume();
/// assert!(volume.contains(9.0 / 4.0 * std::f64::consts::PI) && volume.bound < 1e-13);
/// assert!(union.area().contains(6.0 * std::f64::consts::PI));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct BallUnion<'a> {
    pub(crate) shape: &'a AlphaShape,
    /// The simplices of the shape alone.
    pub(crate) complex: Cow<'a, Complex>,
    pub(crate) points: Points<'a>,
    pub(crate) sides: FacetSides,
    /// For each edge, the angle of its circle that no ball covers.
    pub(crate) arcs: Vec<Single>,
    contacts: Measured,
    volumes: Measured,
    areas: Measured,
    totals: Totals,
    /// The contacts of the balls of a box, if this is the union of several copies of it.
    of_box: Option<OfBox>,
}

/// The contacts of the balls of a small box.
#[derive(Debug)]
struct OfBox {
    pairs: Vec<[u32; 2]>,
    sizes: Measured,
    copies: usize,
}

/// The four intrinsic volumes of the union, but for factors.
#[derive(Clone, Copy, Debug)]
struct Totals {
    volume: Bounded,
    area: Bounded,
    mean_curvature: Bounded,
    gaussian_curvature: Bounded,
}

impl Totals {
    fn each(&mut self) -> [&mut Bounded; 4] {
        let Self { volume, area, mean_curvature, gaussian_curvature } = self;
        [volume, area, mean_curvature, gaussian_curvature]
    }
}

/// The contacts of balls, one for each edge of the dual complex: the part of its disc that is in the power cells of both balls. In the plane,
/// those of discs.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Contacts<'a> {
    /// Input indices of the two balls, in lexicographic order. In a periodic box two balls may meet several times, and a ball copies of itself.
    pub pairs: &'a [[u32; 2]],
    /// The size of each: an area, or in the plane a length.
    pub sizes: &'a Measured,
}

impl<'a> BallUnion<'a> {
    /// Measures the union of the balls of a shape. Expected O(n), on all threads of the current rayon pool; the result does not depend on
    /// their number.
    ///
    /// # Errors
    /// α is infinite, or the shape is [of labels](AlphaShape::voxels) or [unwrapped](AlphaShape::unwrapped); out of memory; cancelled by a
    /// [`Monitor`] that watches.
    pub fn new(shape: &'a AlphaShape) -> Result<Self, BallsError> {
        let monitor = &*Monitor::current();
        if let Some(covering) = monitor.watch(|| shape.covering())? {
            return Self::of_small_box(shape, &covering, monitor);
        }
        Self::of(shape, complex_of_balls(shape)?, Points::of(shape), monitor)
    }

    fn of(
        shape: &'a AlphaShape,
        complex: Cow<'a, Complex>,
        points: Points<'a>,
        monitor: &Monitor,
    ) -> Result<Self, BallsError> {
        memory::afford(bytes(&complex, points.len()), || {
            format!("the union of {} balls", complex.vertices.len())
        })?;
        let sides = FacetSides::apexes(&complex, &points.positions);
        let passes = Work::new(&complex, &points, &sides)?.run(monitor)?;
        let Passes { arcs, contacts, volumes, areas, totals } = passes;
        let of_box = None;
        Ok(Self { shape, complex, points, sides, arcs, contacts, volumes, areas, totals, of_box })
    }

    /// The union of balls that meet copies of themselves: the union in several copies of the box, divided by their number.
    fn of_small_box(
        shape: &'a AlphaShape,
        covering: &Covering,
        monitor: &Monitor,
    ) -> Result<Self, BallsError> {
        let complex = Cow::Owned(complex_of_balls(&covering.shape)?.into_owned());
        let points = Points::of(&covering.shape).into_owned();
        let mut union = Self::of(shape, complex, points, monitor)?;
        let copies = covering.copies();
        for total in union.totals.each() {
            let Bounded { value, bound } = *total;
            *total = (Single { value, error: bound } / Single::exact(copies as f64)).bounded();
        }
        for column in [&mut union.volumes, &mut union.areas] {
            column.values.truncate(shape.own_points());
            column.bounds.truncate(shape.own_points());
        }
        let edges = shape.complex().edges.iter().filter(|(_, class)| *class != Class::Exterior);
        let edges: Vec<[u32; 2]> = edges.map(|(&edge, _)| edge).collect();
        let size = |at: usize| {
            let mut row = covering.row(shape, edges[at]);
            row.sort_unstable();
            let row = union.complex.edges.rows().binary_search(&row);
            union.contacts.get(row.expect("a translate of each edge"))
        };
        let sizes = Measured::collect(edges.len(), "contacts", size)?;
        let pairs = edges.iter().map(|edge| edge.map(|v| shape.copied(v).0)).collect();
        union.of_box = Some(OfBox { pairs, sizes, copies });
        Ok(union)
    }

    /// An error if balls meet copies of themselves.
    pub(crate) fn refuse_small_box(&self, what: &'static str) -> Result<(), BallsError> {
        if self.of_box.is_some() { Err(BallsError::SmallBox { what }) } else { Ok(()) }
    }

    /// The volume of the union, in cubed units of the points; on a torus, of one box.
    pub fn volume(&self) -> Bounded {
        self.totals.volume
    }

    /// The area of its boundary, in squared units of the points; that of voids included.
    pub fn area(&self) -> Bounded {
        self.totals.area
    }

    /// The integrated mean curvature of the boundary, in units of the points: 4πr for a ball. Where two balls meet, the boundary turns inwards,
    /// which counts as negative: half the length of the arc times the angle between the normals. So it is additive: a union has the sum
    /// of its two parts less that of what they share.
    pub fn mean_curvature(&self) -> Bounded {
        self.totals.mean_curvature
    }

    /// The integrated Gaussian curvature of the boundary, summed from angles. By the theorem of Gauss and Bonnet it is 4π times the
    /// [Euler characteristic](Self::euler_characteristic), which is exact: it is a check of the angles. Where three balls meet in the
    /// very point in which two of them touch, the angles there are not determined, and the bound is wide.
    pub fn gaussian_curvature(&self) -> Bounded {
        self.totals.gaussian_curvature
    }

    /// The Euler characteristic of the union, which is that of its dual complex. Exact.
    pub fn euler_characteristic(&self) -> i64 {
        let copies = self.of_box.as_ref().map_or(1, |of_box| of_box.copies as i64);
        self.complex.euler_characteristic() / copies
    }

    /// In a periodic box that repeats along all three vectors, the part of it that the balls fill.
    pub fn box_fraction(&self) -> Option<Bounded> {
        let torus = self.shape.options().periodic.filter(|torus| torus.dimension() == 3)?;
        let [a, b, c] = torus.vectors();
        let signed = Single::triple(Single::cross(a, b), c);
        let volume = if signed.value < 0.0 { -signed } else { signed };
        let Bounded { value, bound } = self.totals.volume;
        Some((Single { value, error: bound } / volume).bounded())
    }

    /// For each input point the volume of the union in its power cell.
    pub fn volumes(&self) -> &Measured {
        &self.volumes
    }

    /// For each input point the area of the boundary on its sphere.
    pub fn areas(&self) -> &Measured {
        &self.areas
    }

    /// The contacts of balls, one for each edge of the dual complex.
    pub fn contacts(&self) -> Contacts<'_> {
        match &self.of_box {
            None => Contacts { pairs: self.complex.edges.rows(), sizes: &self.contacts },
            Some(OfBox { pairs, sizes, .. }) => Contacts { pairs, sizes },
        }
    }

    /// The sizes of contacts, one for each edge of the complex that was measured.
    pub(crate) fn contact_sizes(&self) -> &Measured {
        &self.contacts
    }
}

/// About the most bytes that the union of the balls of a complex takes at once.
fn bytes(complex: &Complex, points: usize) -> usize {
    let facet = size_of::<[u32; 5]>();
    let edge = size_of::<[Single; 2]>() + size_of::<EdgeAngles>() + size_of::<Bounded>();
    let point = size_of::<[Single; 2]>() + size_of::<VertexRim>() + size_of::<Part>();
    facet * complex.facets.len() + edge * complex.edges.len() + point * points
}

/// The simplices of a shape alone, if they are the dual complex of balls.
pub(crate) fn complex_of_balls(shape: &AlphaShape) -> Result<Cow<'_, Complex>, BallsError> {
    if shape.voxels().is_some() {
        return Err(BallsError::Labels);
    }
    if !shape.copies().is_empty() && shape.options().periodic.is_none() {
        return Err(BallsError::Unwrapped);
    }
    if shape.power_alpha().squared() == f64::INFINITY {
        return Err(BallsError::Infinite);
    }
    let listed = shape.complex();
    if !listed.lists_exterior() {
        return Ok(Cow::Borrowed(listed));
    }
    let mut complex = listed.clone();
    complex.retain_shape();
    Ok(Cow::Owned(complex))
}

/// Angles at an edge, summed over tetrahedra.
#[derive(Clone, Copy, Debug, Default)]
struct EdgeAngles {
    /// Of the complex,
    closed: Single,
    /// and with a point of the boundary as apex.
    open: Single,
}

/// Sums over the edges at a vertex on the boundary.
#[derive(Clone, Copy, Debug, Default)]
struct VertexRim {
    /// The angles of the tetrahedra of the complex,
    closed: Single,
    /// and the angle of the circle that no ball covers, times the height of the cap beyond its plane.
    caps: Single,
}

struct Passes {
    arcs: Vec<Single>,
    contacts: Measured,
    volumes: Measured,
    areas: Measured,
    totals: Totals,
}

/// The totals, as they are summed.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// Divided last.
    six_volumes: Double,
    area: Double,
    mean: Double,
    gaussian: Double,
}

impl Sums {
    fn join(&mut self, other: &Self) {
        self.six_volumes += other.six_volumes;
        self.area += other.area;
        self.mean += other.mean;
        self.gaussian += other.gaussian;
    }
}

struct Work<'a> {
    complex: &'a Complex,
    points: &'a Points<'a>,
    sides: &'a FacetSides,
    /// For each edge that is not interior, its place among them.
    slots: Vec<u32>,
}

/// What the triangles of some vertices add.
#[derive(Default)]
struct OfTriangles {
    /// For edges, twice the length times the part of the power facet in a tetrahedron;
    kites: Records<Single>,
    /// if they are not interior, angles;
    angles: Records<EdgeAngles>,
    /// for vertices, solid angles of tetrahedra with a point of the boundary as apex.
    solids: Records<Single>,
    sums: Sums,
}

/// What some edges add, and their own numbers.
#[derive(Default)]
struct OfEdges {
    arcs: Vec<Single>,
    contacts: Vec<Bounded>,
    /// For vertices, the contact area times the distance of its plane;
    cones: Records<Single>,
    /// if they are not interior, what is at the rim.
    rims: Records<VertexRim>,
    sums: Sums,
}

/// What triangles have added to edges, and the classes of vertices.
#[derive(Clone, Copy)]
struct OnEdges<'a> {
    kites: &'a [Single],
    /// By slot.
    angles: &'a [EdgeAngles],
    classes: &'a [Option<Class>],
}

/// Vertices whose triangles are one piece of work, and pieces that are summed at a time.
const VERTICES: usize = 1 << 6;
const PIECES: usize = 1 << 6;
/// Edges, or vertices, that are one piece of work.
const ROWS: usize = 1 << 11;

impl<'a> Work<'a> {
    fn new(
        complex: &'a Complex,
        points: &'a Points<'a>,
        sides: &'a FacetSides,
    ) -> Result<Self, BallsError> {
        let mut slots =
            memory::try_with_capacity(complex.edges.len(), || "the edges of balls".into())?;
        let mut next = 0;
        for &class in complex.edges.classes() {
            slots.push(next);
            next += u32::from(class != Class::Interior);
        }
        Ok(Self { complex, points, sides, slots })
    }

    fn run(&self, monitor: &Monitor) -> Result<Passes, BallsError> {
        let Self { complex, points, .. } = *self;
        let on_boundary = complex.edges.len() - complex.edges.counts().interior;
        let count = complex.edges.len();
        let steps = monitor.units(points.len() as u64 + count as u64);
        let classes = self.classes()?;
        let mut kites: Vec<Single> = zeros(count, "the contacts of balls")?;
        let mut angles: Vec<EdgeAngles> = zeros(on_boundary, "the angles of the dual complex")?;
        let mut solids: Vec<Single> = zeros(points.len(), "the solid angles of balls")?;
        let mut sums = Sums::default();
        let groups: Vec<&[u32]> = self.sides.groups(VERTICES).collect();
        let mut found: Vec<OfTriangles> = Vec::new();
        found.resize_with(PIECES.min(groups.len()), OfTriangles::default);
        for groups in groups.chunks(PIECES) {
            let found = &mut found[..groups.len()];
            found.par_iter_mut().zip(groups).for_each(|(of, group)| self.triangles(group, of));
            scatter(found, |of| &of.kites, &mut kites, |sum, &more| *sum += more);
            scatter(
                found,
                |of| &of.angles,
                &mut angles,
                |sum, more| {
                    sum.closed += more.closed;
                    sum.open += more.open;
                },
            );
            scatter(found, |of| &of.solids, &mut solids, |sum, &more| *sum += more);
            found.iter().for_each(|of| sums.join(&of.sums));
            steps.add(groups.iter().map(|group| group.len() as u64).sum())?;
        }
        drop(found);
        let mut cones: Vec<Single> = zeros(points.len(), "the volumes of balls")?;
        let mut rims: Vec<VertexRim> = zeros(points.len(), "the areas of balls")?;
        let mut arcs = memory::try_with_capacity(count, || "the arcs of balls".into())?;
        let mut contacts = Measured::with_capacity(count, "the contacts of balls")?;
        let mut found: Vec<OfEdges> = Vec::new();
        found.resize_with(PIECES.min(count.div_ceil(ROWS)), OfEdges::default);
        for window in ranges(0..count, ROWS * PIECES) {
            let pieces: Vec<Range<usize>> = ranges(window.clone(), ROWS).collect();
            let found = &mut found[..pieces.len()];
            let on_edges = OnEdges { kites: &kites, angles: &angles, classes: &classes };
            found.par_iter_mut().zip(pieces).for_each(|(of, rows)| self.edges(rows, on_edges, of));
            scatter(found, |of| &of.cones, &mut cones, |sum, &more| *sum += more);
            scatter(
                found,
                |of| &of.rims,
                &mut rims,
                |sum, more| {
                    sum.closed += more.closed;
                    sum.caps += more.caps;
                },
            );
            for of in found {
                arcs.extend_from_slice(&of.arcs);
                of.contacts.iter().for_each(|&contact| contacts.push(contact));
                sums.join(&of.sums);
            }
            steps.add(window.len() as u64)?;
        }
        drop(found);
        drop((kites, angles));
        let parts = self.parts(&classes, &solids, &cones, &rims)?;
        let of_balls =
            ranges(0..parts.len(), ROWS).collect::<Vec<_>>().into_par_iter().map(|rows| {
                let mut sums = Sums::default();
                parts[rows].iter().for_each(|part| sums.add_ball(part));
                sums
            });
        of_balls.collect::<Vec<_>>().iter().for_each(|of| sums.join(of));
        let column = |what, power, of: fn(&Part) -> Single| {
            Measured::collect(parts.len(), what, |v| points.bounded(of(&parts[v]), power))
        };
        let total = |sum: Double, power| points.bounded(sum.rounded(), power);
        Ok(Passes {
            arcs,
            contacts,
            volumes: column("the volumes of balls", 3, |part| part.volume)?,
            areas: column("the areas of balls", 2, |part| part.area)?,
            totals: Totals {
                volume: points.bounded(sums.six_volumes.sixth(), 3),
                area: total(sums.area, 2),
                mean_curvature: total(sums.mean, 1),
                gaussian_curvature: total(sums.gaussian, 0),
            },
        })
    }

    /// The class of each point, if it is in the shape.
    fn classes(&self) -> Result<Vec<Option<Class>>, BallsError> {
        let mut classes = zeros(self.points.len(), "the classes of balls")?;
        for (&[v], class) in self.complex.vertices.iter() {
            classes[v as usize] = Some(class);
        }
        Ok(classes)
    }

    /// Finds what the triangles of a group of vertices add.
    fn triangles(&self, group: &[u32], found: &mut OfTriangles) {
        let OfTriangles { kites, angles, solids, sums } = found;
        kites.clear();
        angles.clear();
        solids.clear();
        *sums = Sums::default();
        for &v in group {
            for (row, edges) in self.sides.facets_and_edges(self.complex, v) {
                self.triangle(row, edges, found);
            }
        }
    }

    fn triangle(&self, row: usize, edges: [u32; 3], found: &mut OfTriangles) {
        let corners = self.sides.facets()[row];
        let apexes = self.sides.sides(row);
        let balls = self.points.balls(corners);
        let limits = Limits::of(&balls, self.points.alpha);
        let on_boundary =
            edges.map(|edge| self.complex.edges.classes()[edge as usize] != Class::Interior);
        if !on_boundary.contains(&true) {
            // So there are cells on both sides.
            let at = apexes.map(|apex| self.points.near(balls[0].centre, apex));
            if let Some(Quick { kites, dets }) = Quick::of(balls, at, limits) {
                for (apex, det) in apexes.into_iter().zip(dets) {
                    if corners[2] < apex {
                        found.sums.six_volumes += det;
                    }
                }
                found.kites.extend(edges.into_iter().zip(kites));
                return;
            }
        }
        let triangle = Triangle::<Single>::of(balls);
        let mut kites = [Single::ZERO; 3];
        let mut angles = [EdgeAngles::default(); 3];
        for apex in apexes.into_iter().filter(|&apex| apex != FacetSides::OPEN) {
            let ball = self.points.near(balls[0].centre, apex);
            // An angle is found in both triangles at its edge, and taken from the one whose own corner is the smaller.
            let asked = [0, 1, 2].map(|k| on_boundary[k] && corners[k] < apex);
            let side = triangle.with(ball, asked);
            let (side, more) = side
                .checked(&triangle, limits)
                .unwrap_or_else(|| Side::closely(balls, ball, asked, self.points.alpha));
            for k in 0..3 {
                kites[k] += more[k];
                angles[k].closed += side.angles[k].unwrap_or(Single::ZERO);
            }
            // Each cell once, from the triangle of its three smaller corners, as above.
            if corners[2] < apex {
                found.sums.six_volumes += side.det;
            }
        }
        let open = apexes.into_iter().filter(|&apex| apex == FacetSides::OPEN).count();
        if open > 0 {
            let (of, more) = Open::measured(&triangle, balls, self.points.alpha, limits);
            for _ in 0..open {
                for k in 0..3 {
                    kites[k] += more[k];
                    angles[k].open += of.angles[k];
                    found.solids.push((corners[k], of.corners[k]));
                }
                found.sums.six_volumes += of.det;
                found.sums.gaussian += of.apex;
            }
        }
        found.kites.extend(edges.into_iter().zip(kites));
        for k in (0..3).filter(|&k| on_boundary[k]) {
            found.angles.push((self.slots[edges[k] as usize], angles[k]));
        }
    }

    /// Finds what some edges add, and their own numbers.
    fn edges(&self, rows: Range<usize>, on: OnEdges<'_>, found: &mut OfEdges) {
        let OfEdges { arcs, contacts, cones, rims, sums } = found;
        arcs.clear();
        contacts.clear();
        cones.clear();
        rims.clear();
        *sums = Sums::default();
        for row in rows {
            let ends = self.complex.edges.rows()[row];
            let balls = self.points.balls(ends);
            let Edge { distance, heights } = Edge::measured(balls, self.points.alpha);
            let turn = Single::pi().times(2.0);
            let mut twice = on.kites[row] / distance;
            let (mut closed, mut arc, mut caps) = (turn, Single::ZERO, [Single::ZERO; 2]);
            if self.complex.edges.classes()[row] != Class::Interior {
                let angles = &on.angles[self.slots[row] as usize];
                closed = angles.closed;
                arc = turn - closed - angles.open;
                let circle = Circle::measured(balls, self.points.alpha);
                let disc = arc * circle.squared;
                twice += disc;
                caps = circle.caps.map(|cap| arc * cap);
                found.sums.six_volumes += disc * distance;
                found.sums.mean += -(arc * circle.bend).half();
                found.sums.gaussian += -arc.times(2.0);
            }
            let contact = twice.half();
            for k in 0..2 {
                found.cones.push((ends[k], contact * heights[k]));
                if on.classes[ends[k] as usize] != Some(Class::Interior) {
                    found.rims.push((ends[k], VertexRim { closed, caps: caps[k] }));
                }
            }
            found.arcs.push(arc);
            found.contacts.push(self.points.bounded(contact, 2));
        }
    }

    /// The part of each ball.
    fn parts(
        &self,
        classes: &[Option<Class>],
        solids: &[Single],
        cones: &[Single],
        rims: &[VertexRim],
    ) -> Result<Vec<Part>, BallsError> {
        let Self { complex, points, .. } = self;
        let cells: Vec<AtomicU32> = (0..points.len()).map(|_| AtomicU32::new(0)).collect();
        complex.cells.rows().as_flattened().par_iter().for_each(|&v| {
            if classes[v as usize] != Some(Class::Interior) {
                cells[v as usize].fetch_add(1, Ordering::Relaxed);
            }
        });
        let part = |v: usize| match classes[v] {
            None => Part::default(),
            Some(Class::Interior) => Part { volume: third(cones[v]), ..Part::default() },
            _ => {
                // The solid angle of a cell at v is the sum of the angles at its edges, less π.
                let cells = Single::exact(f64::from(cells[v].load(Ordering::Relaxed)));
                let four = Single::exact(4.0);
                let solid = Single::pi() * (cells + four) - rims[v].closed - solids[v];
                let radius = points.squared_radius::<Single>(v as u32).sqrt();
                let mean = radius * solid - rims[v].caps;
                let area = radius * mean;
                let cone = radius * area;
                Part { solid, mean, area, cone, volume: third(cone + cones[v]) }
            }
        };
        let mut parts = memory::try_with_capacity(points.len(), || "the parts of balls".into())?;
        (0..points.len()).into_par_iter().map(part).collect_into_vec(&mut parts);
        Ok(parts)
    }
}

/// The part of a ball in the union.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    /// 4π less the solid angles of all tetrahedra.
    solid: Single,
    /// The area on its sphere, divided by the radius.
    mean: Single,
    /// That area,
    area: Single,
    /// and three times the volume below it.
    cone: Single,
    volume: Single,
}

impl Sums {
    fn add_ball(&mut self, part: &Part) {
        self.six_volumes += part.cone.times(2.0);
        self.area += part.area;
        self.mean += part.mean;
        self.gaussian += part.solid;
    }
}

fn third(number: Single) -> Single {
    number / Single::exact(3.0)
}

/// For each of so many points whether it is in a shape.
pub(crate) fn in_shape(
    complex: &Complex,
    points: usize,
    what: &'static str,
) -> Result<Vec<bool>, BallsError> {
    let mut in_shape = zeros(points, what)?;
    complex.vertices.rows().iter().for_each(|&[v]| in_shape[v as usize] = true);
    Ok(in_shape)
}

pub(crate) fn zeros<T: Clone + Default>(
    count: usize,
    what: &'static str,
) -> Result<Vec<T>, BallsError> {
    let mut items = memory::try_with_capacity(count, || what.into())?;
    items.resize(count, T::default());
    Ok(items)
}
