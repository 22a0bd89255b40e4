//! Depth maps of a scene, and what is visible in them.

use std::collections::HashMap;

use walpha_base::vector::{V3, add, along, dot, length, scale, sub};

use crate::light::across;
use crate::pixels::floor;
use crate::scene::{Mesh, Scene};

/// A position whose light is measured. It is raised a little along `normal`, so that neither its own surface nor anything within
/// `radius` of it hides it.
pub(crate) struct Receiver {
    pub place: V3,
    pub normal: V3,
    pub radius: f64,
}

/// A ball around the scene.
pub(crate) struct Space {
    centre: V3,
    radius: f64,
}

impl Space {
    /// `None` if the scene has no extent, so that nothing hides anything.
    pub(crate) fn around(scene: &Scene) -> Option<Self> {
        let [low, high] = scene.bounds()?;
        let radius = length(sub(high, low)) / 2.0;
        let centre = scale(add(low, high), 0.5);
        (radius > 0.0 && radius.is_finite()).then_some(Self { centre, radius })
    }
}

/// What hides the sky and the lamp: opaque meshes, and balls.
pub(crate) struct Occluders<'a> {
    scene: &'a Scene,
    space: &'a Space,
    /// The opaque meshes, without details that no map shows.
    meshes: Vec<Occluder>,
}

/// A mesh in a depth map.
struct Occluder {
    /// The vertices, in texels from the centre of the space.
    places: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    two_sided: bool,
}

impl Occluder {
    /// The side of the cubes whose vertices become one, in texels: as far as receivers are raised.
    const CUBE: f32 = 3.0;

    /// A mesh whose vertices in each cube of a grid are moved to their mean, without the triangles that have no area then (Rossignac and
    /// Borrel 1993, doi:10.1007/978-3-642-78114-8_29). Vertices that are alone in their cube stay where they are. O(n).
    fn of(mesh: &Mesh, space: &Space) -> Self {
        let texel = DepthMap::texel(space);
        let mut numbers: HashMap<[i16; 3], u32> = HashMap::new();
        let mut sums: Vec<([f32; 3], f32)> = Vec::new();
        let number = |&p: &V3| {
            let p = scale(sub(p, space.centre), 1.0 / texel).map(|x| x as f32);
            let cube = p.map(|x| (x / Self::CUBE).floor() as i16);
            let number = *numbers.entry(cube).or_insert(sums.len() as u32);
            if number as usize == sums.len() {
                sums.push(([0.0; 3], 0.0));
            }
            let (sum, count) = &mut sums[number as usize];
            *sum = [sum[0] + p[0], sum[1] + p[1], sum[2] + p[2]];
            *count += 1.0;
            number
        };
        let numbers: Vec<u32> = mesh.positions.iter().map(number).collect();
        let moved = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|c| numbers[c as usize]);
            (a != b && b != c && c != a).then_some([a, b, c])
        };
        Self {
            places: sums.iter().map(|(sum, count)| sum.map(|x| x / count)).collect(),
            triangles: mesh.triangles.iter().filter_map(moved).collect(),
            two_sided: mesh.two_sided,
        }
    }
}

impl<'a> Occluders<'a> {
    pub(crate) fn new(scene: &'a Scene, space: &'a Space) -> Self {
        let opaque = scene.meshes.iter().filter(|mesh| mesh.opacity >= 1.0);
        Self { scene, space, meshes: opaque.map(|mesh| Occluder::of(mesh, space)).collect() }
    }

    /// The depth map of a light.
    pub(crate) fn map(&self, light: Directions) -> DepthMap {
        let mut map = DepthMap::new(self.space, light);
        for mesh in &self.meshes {
            map.draw_mesh(mesh);
        }
        for ball in &self.scene.balls {
            map.draw_ball(map.place(ball.centre), ball.radius);
        }
        map
    }
}

/// The directions that light comes from, of one depth map.
#[derive(Clone, Copy)]
pub(crate) enum Directions {
    /// One direction.
    One(V3),
    /// A direction, and the opposite one: they share the places of all triangles in the map.
    Opposite(V3),
}

impl Directions {
    /// The direction, or the first of the two.
    pub(crate) fn first(self) -> V3 {
        let (Self::One(direction) | Self::Opposite(direction)) = self;
        direction
    }

    /// The number of directions.
    fn count(self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Opposite(_) => 2,
        }
    }
}

/// The outermost surface seen from far away in one direction, or in two opposite ones, in parallel projection. Lengths are in texels.
pub(crate) struct DepthMap {
    /// Two axes of the map, and one towards the viewer, for positions in the units of the scene.
    axes: [V3; 3],
    origin: V3,
    texel: f64,
    /// The heights towards the viewer, and those towards the opposite one.
    sides: Vec<Vec<f32>>,
}

impl DepthMap {
    /// Texels along each side.
    const SIDE: usize = 512;
    /// The place of the origin along both axes of the map.
    const MIDDLE: f32 = Self::SIDE as f32 / 2.0;

    /// The length of a side of a texel, in the units of the scene.
    fn texel(space: &Space) -> f64 {
        2.0 * space.radius / (Self::SIDE - 4) as f64
    }

    fn new(space: &Space, light: Directions) -> Self {
        let (u, v) = across(light.first());
        let texel = Self::texel(space);
        let axes = [u, v, light.first()].map(|axis| scale(axis, 1.0 / texel));
        let heights = || vec![f32::NEG_INFINITY; Self::SIDE * Self::SIDE + LANES];
        let sides = (0..light.count()).map(|_| heights()).collect();
        Self { axes, origin: space.centre, texel, sides }
    }

    /// The place of a position in the map, and its height.
    fn place(&self, p: V3) -> V3 {
        let p = sub(p, self.origin);
        let [x, y, height] = self.axes.map(|axis| dot(p, axis));
        [x + f64::from(Self::MIDDLE), y + f64::from(Self::MIDDLE), height]
    }

    /// Draws the triangles that face the light, which are those of the outermost surface of a solid, or all if both sides are seen.
    fn draw_mesh(&mut self, mesh: &Occluder) {
        let axes = [0, 1, 2].map(|axis| scale(self.axes[axis], self.texel).map(|x| x as f32));
        let along = |axis: [f32; 3], p: [f32; 3]| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
        let place = |&p: &[f32; 3]| {
            let [x, y, height] = axes.map(|axis| along(axis, p));
            [x + Self::MIDDLE, y + Self::MIDDLE, height]
        };
        let places: Vec<[f32; 3]> = mesh.places.iter().map(place).collect();
        for corners in &mesh.triangles {
            let corners = corners.map(|c| places[c as usize]);
            let [a, b, c] = corners;
            let side =
                usize::from((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0.0);
            let facing = if mesh.two_sided { 0..2 } else { side..side + 1 };
            for side in facing {
                // Not a branch, where the map has both sides: it could not be predicted.
                if let Some(heights) = self.sides.get_mut(side) {
                    draw_triangle(heights, corners, signed(1.0, side));
                }
            }
        }
    }

    fn draw_ball(&mut self, centre: V3, radius: f64) {
        let reach = radius / self.texel;
        let (x0, x1) = texels((centre[0] - reach) as f32, (centre[0] + reach) as f32);
        let (y0, y1) = texels((centre[1] - reach) as f32, (centre[1] + reach) as f32);
        for y in y0..y1 {
            for x in x0..x1 {
                let (dx, dy) = (x as f64 + 0.5 - centre[0], y as f64 + 0.5 - centre[1]);
                let left = reach * reach - dx * dx - dy * dy;
                if left >= 0.0 {
                    for (side, heights) in self.sides.iter_mut().enumerate() {
                        let height = signed(centre[2], side) + left.sqrt();
                        let texel = &mut heights[y * Self::SIDE + x];
                        *texel = texel.max(height as f32);
                    }
                }
            }
        }
    }

    /// The share of a receiver that is visible from the map's direction, 0 to 1, interpolated between the four texels around it; and
    /// from the opposite direction, if the map has it, or else 1.
    pub(crate) fn openness(&self, receiver: &Receiver) -> [f64; 2] {
        let [x, y, height] = self.place(along(receiver.place, 1.5 * self.texel, receiver.normal));
        let raised = receiver.radius / self.texel + 1.5;
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (floor(x), floor(y));
        let (u, v) = (x - f64::from(left), y - f64::from(top));
        let (column, row) = (left.max(0) as usize, top.max(0) as usize);
        let mut openness = [1.0; 2];
        for (side, (heights, openness)) in self.sides.iter().zip(&mut openness).enumerate() {
            let height = signed(height, side) + raised;
            let open = |dx: usize, dy: usize| {
                let (x, y) = (column + dx, row + dy);
                let hidden = x < Self::SIDE
                    && y < Self::SIDE
                    && f64::from(heights[y * Self::SIDE + x]) > height;
                if hidden { 0.0 } else { 1.0 }
            };
            let upper = open(0, 0) * (1.0 - u) + open(1, 0) * u;
            let lower = open(0, 1) * (1.0 - u) + open(1, 1) * u;
            *openness = upper * (1.0 - v) + lower * v;
        }
        openness
    }
}

/// A height as the map's own direction (0) or the opposite one (1) sees it.
#[inline(always)]
fn signed<T: std::ops::Neg<Output = T>>(height: T, side: usize) -> T {
    if side == 0 { height } else { -height }
}

/// Texels of a row that are done at a time: as many as a vector register of every processor holds numbers.
const LANES: usize = 4;

#[expect(
    clippy::needless_bitwise_bool,
    reason = "several texels are done at a time where there is no branch"
)]
fn draw_triangle(map: &mut [f32], [a, b, c]: [[f32; 3]; 3], up: f32) {
    let (x0, x1) = texels(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
    let (y0, y1) = texels(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let area = ab[0] * ac[1] - ab[1] * ac[0];
    if x0 >= x1 || y0 >= y1 || area == 0.0 || !area.is_finite() {
        return;
    }
    let heights = [a, b, c].map(|p| p[2] * up);
    let inverse = 1.0 / area;
    for y in y0..y1 {
        let py = y as f32 + 0.5 - a[1];
        let (sy, ty) = (py * ac[0], py * ab[0]);
        let row = &mut map[y * DepthMap::SIDE + x0..][..(x1 - x0).max(LANES)];
        let draw = |first: usize, texels: &mut [f32]| {
            for (k, texel) in texels.iter_mut().enumerate() {
                let px = (first + k) as i32 as f32 + 0.5 - a[0];
                let s = (px * ac[1] - sy) * inverse;
                let t = (ty - px * ab[1]) * inverse;
                let is_inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0);
                let height =
                    heights[0] + s * (heights[1] - heights[0]) + t * (heights[2] - heights[0]);
                *texel = if is_inside & (height > *texel) { height } else { *texel };
            }
        };
        // Most triangles of a large mesh are not wider.
        if let Ok(four) = <&mut [f32; LANES]>::try_from(&mut *row) {
            draw(x0, four);
        } else {
            draw(x0, row);
        }
    }
}

/// Texels whose centre may lie between two positions.
fn texels(low: f32, high: f32) -> (usize, usize) {
    let low = (low - 0.5).max(0.0);
    let whole = low as i32;
    let first = whole + i32::from((whole as f32) < low);
    (first as usize, ((high + 0.5).max(0.0) as i32 as usize).min(DepthMap::SIDE))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of many triangles, as a grid of angles.
    fn ball(sides: u32) -> Mesh {
        let circle =
            |k: u32, of: u32| (f64::from(k) / f64::from(of) * std::f64::consts::TAU).sin_cos();
        let place = |k: u32| {
            let ((a, b), (c, d)) = (circle(k % sides, sides), circle(k / sides, 2 * sides));
            [c * a, c * b, d]
        };
        let square = |k: u32| {
            let right = k / sides * sides + (k + 1) % sides;
            [[k, right, k + sides], [right, right + sides, k + sides]]
        };
        let positions = (0..sides * (sides + 1)).map(place).collect();
        Mesh::new(positions, (0..sides * sides).flat_map(square).collect())
    }

    #[test]
    fn details_that_no_map_shows_are_left_out() {
        let mut scene = Scene { meshes: vec![ball(1000)], ..Scene::default() };
        let space = Space::around(&scene).unwrap();
        let fine = Occluder::of(&scene.meshes[0], &space);
        // A ball of radius r has 4π·r² texels, of which a cube takes a square, and half as many vertices as triangles.
        let radius = 1.0 / DepthMap::texel(&space);
        let cubes = 4.0 * std::f64::consts::PI * (radius / f64::from(Occluder::CUBE)).powi(2);
        let count = fine.triangles.len() as f64;
        assert!((cubes..4.0 * cubes).contains(&count), "{count} triangles, {cubes} cubes");
        for place in &fine.places {
            let [x, y, z] = place.map(f64::from);
            let off = (x * x + y * y + z * z).sqrt() - radius;
            assert!(off.abs() < 0.1, "a vertex is {off} texels above the ball");
        }
        // What has room stays where it is.
        let corners = vec![[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [0.5, 1.5, 0.5], [0.5, 0.5, 2.5]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        scene.meshes[0] = Mesh::new(corners, triangles);
        let space = Space::around(&scene).unwrap();
        let coarse = Occluder::of(&scene.meshes[0], &space);
        assert_eq!(coarse.triangles, scene.meshes[0].triangles);
        for (place, p) in coarse.places.iter().zip(&scene.meshes[0].positions) {
            let expected = scale(sub(*p, space.centre), 1.0 / DepthMap::texel(&space));
            assert_eq!(*place, expected.map(|x| x as f32));
        }
    }
}
