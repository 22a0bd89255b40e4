//! Depth maps of a scene, and what is visible in them.

use walpha_base::parallel::prelude::*;
use walpha_base::vector::{V3, add, along, dot, length, scale, sub};

use crate::light::across;
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
    /// The vertices of each opaque mesh, in texels from the centre of the space.
    meshes: Vec<(&'a Mesh, Vec<[f32; 3]>)>,
}

/// Depth maps that are made in one pass over all triangles: as many as a vector register of every processor holds numbers.
pub(crate) const LANES: usize = 4;

/// A number for each of the maps of a pass.
type Lanes = [f32; LANES];

fn lanes(of: impl FnMut(usize) -> f32) -> Lanes {
    std::array::from_fn(of)
}

impl<'a> Occluders<'a> {
    pub(crate) fn new(scene: &'a Scene, space: &'a Space) -> Self {
        let texel = DepthMap::texel(space);
        let place = |&p: &V3| scale(sub(p, space.centre), 1.0 / texel).map(|x| x as f32);
        let opaque = scene.meshes.iter().filter(|mesh| mesh.opacity >= 1.0);
        let placed = |mesh: &'a Mesh| (mesh, mesh.positions.par_iter().map(place).collect());
        Self { scene, space, meshes: opaque.map(placed).collect() }
    }

    /// The depth maps of up to [`LANES`] lights.
    pub(crate) fn maps(&self, lights: &[Directions]) -> Vec<DepthMap> {
        let mut maps: Vec<_> =
            lights.iter().map(|&light| DepthMap::new(self.space, light)).collect();
        for (mesh, places) in &self.meshes {
            draw_mesh(&mut maps, mesh, places);
        }
        for map in &mut maps {
            for ball in &self.scene.balls {
                map.draw_ball(map.place(ball.centre), ball.radius);
            }
        }
        maps
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

/// Draws the triangles of a mesh that face the light, which are those of the outermost surface of a solid, or all if both sides are seen.
fn draw_mesh(maps: &mut [DepthMap], mesh: &Mesh, places: &[[f32; 3]]) {
    let axes = [0, 1, 2].map(|axis| {
        let unit = |k: usize| lanes(|lane| maps[lane.min(maps.len() - 1)].unit(axis)[k] as f32);
        [unit(0), unit(1), unit(2)]
    });
    // As bits.
    let two_sided = if mesh.two_sided { 3 } else { 0 };
    let all_sides = if maps.iter().any(|map| map.sides.len() == 2) { 3 } else { 1 };
    for corners in &mesh.triangles {
        let corners = corners.map(|c| &places[c as usize]);
        let faced = faced(&axes, corners, two_sided, all_sides);
        if faced.sides == [0; LANES] {
            continue;
        }
        for (k, map) in maps.iter_mut().enumerate().filter(|(k, _)| faced.sides[*k] != 0) {
            let [x, y, height] = axes.each_ref();
            let heights = corners.map(|p| along_axis(height, p, k));
            if faced.several[k] == 0 {
                let (texel, height) = faced.texel(k, heights);
                for (side, map) in map.sides.iter_mut().enumerate() {
                    if faced.sides[k] >> side & 1 == 1 {
                        map[texel] = map[texel].max(signed(height, side));
                    }
                }
                continue;
            }
            let places = corners.map(|p| [across_map(x, p, k), across_map(y, p, k)]);
            for (side, map) in map.sides.iter_mut().enumerate() {
                if faced.sides[k] >> side & 1 == 1 {
                    draw_triangle(map, places, heights.map(|height| signed(height, side)));
                }
            }
        }
    }
}

/// The coordinate of a place along an axis of map k, 0 in the middle.
#[inline(always)]
fn along_axis(axis: &[Lanes; 3], p: &[f32; 3], k: usize) -> f32 {
    p[0] * axis[0][k] + p[1] * axis[1][k] + p[2] * axis[2][k]
}

/// The same from the first texel on.
#[inline(always)]
fn across_map(axis: &[Lanes; 3], p: &[f32; 3], k: usize) -> f32 {
    along_axis(axis, p, k) + DepthMap::MIDDLE
}

/// A triangle in each map of a pass.
struct Faced {
    /// The sides on which it is drawn, as bits: where it faces the light (or has two sides) and may cover the centre of a texel.
    sides: [u32; LANES],
    /// Whether there are several such centres, which it need not cover. Otherwise it covers the one.
    several: [u32; LANES],
    /// The first texel.
    x: Lanes,
    y: Lanes,
    /// The place of its centre in the triangle, times the square of the area.
    s: Lanes,
    t: Lanes,
    /// Twice the area, above 0 where it faces the first direction.
    up: Lanes,
}

impl Faced {
    /// The texel of map k that the triangle covers, if there is one, and its height there, of the heights of its corners.
    #[inline(always)]
    fn texel(&self, k: usize, [a, b, c]: [f32; 3]) -> (usize, f32) {
        let inverse = 1.0 / (self.up[k] * self.up[k]);
        let height = a + (self.s[k] * (b - a) + self.t[k] * (c - a)) * inverse;
        (self.y[k] as i32 as usize * DepthMap::SIDE + self.x[k] as i32 as usize, height)
    }
}

/// Where a triangle is in each map of a pass. Most triangles of a large mesh lie between centres of texels, and are done with here, without
/// a branch.
#[inline(always)]
fn faced(
    axes: &[[Lanes; 3]; 3],
    [a, b, c]: [&[f32; 3]; 3],
    two_sided: u32,
    all_sides: u32,
) -> Faced {
    // Adding this rounds to whole numbers.
    const WHOLE: f32 = (3 << 22) as f32;
    // The first texel whose centre is not below the triangle, and the first whose centre is above it.
    let texels = |a: f32, b: f32, c: f32| {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let low = if c < low { c } else { low };
        let high = if high < c { c } else { high };
        [low + WHOLE, high + WHOLE].map(|x| x - WHOLE)
    };
    let (zero, none) = ([0.0; LANES], [0; LANES]);
    let mut faced =
        Faced { sides: none, several: none, x: zero, y: zero, s: zero, t: zero, up: zero };
    // In a loop, not an array of closures, this becomes vector instructions.
    for k in 0..LANES {
        let [ax, bx, cx] = [a, b, c].map(|p| across_map(&axes[0], p, k));
        let [ay, by, cy] = [a, b, c].map(|p| across_map(&axes[1], p, k));
        let ([x0, x1], [y0, y1]) = (texels(ax, bx, cx), texels(ay, by, cy));
        let (abx, aby, acx, acy) = (bx - ax, by - ay, cx - ax, cy - ay);
        let up = abx * acy - aby * acx;
        let (px, py) = (x0 + 0.5 - ax, y0 + 0.5 - ay);
        let (s, t) = (up * (px * acy - py * acx), up * (py * abx - px * aby));
        let covers = u32::from(s >= 0.0) & u32::from(t >= 0.0) & u32::from(s + t <= up * up);
        let several = u32::from(x1 - x0 > 1.0) | u32::from(y1 - y0 > 1.0);
        let any = u32::from(x0 < x1) & u32::from(y0 < y1) & (covers | several);
        let sides = (u32::from(up > 0.0) | u32::from(up < 0.0) << 1 | two_sided) & all_sides;
        faced.sides[k] = sides * any;
        faced.several[k] = several;
        (faced.x[k], faced.y[k]) = (x0, y0);
        (faced.s[k], faced.t[k], faced.up[k]) = (s, t, up);
    }
    faced
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
        let heights = || vec![f32::NEG_INFINITY; Self::SIDE * Self::SIDE];
        let sides = (0..light.count()).map(|_| heights()).collect();
        Self { axes, origin: space.centre, texel, sides }
    }

    /// The direction of an axis.
    fn unit(&self, axis: usize) -> V3 {
        scale(self.axes[axis], self.texel)
    }

    /// The place of a position in the map, and its height.
    fn place(&self, p: V3) -> V3 {
        let p = sub(p, self.origin);
        let [x, y, height] = self.axes.map(|axis| dot(p, axis));
        [x + f64::from(Self::MIDDLE), y + f64::from(Self::MIDDLE), height]
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
        let (u, v) = (x - left, y - top);
        let (column, row) = (left as usize, top as usize);
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

#[expect(
    clippy::needless_bitwise_bool,
    reason = "several texels are done at a time where there is no branch"
)]
fn draw_triangle(map: &mut [f32], [a, b, c]: [[f32; 2]; 3], heights: [f32; 3]) {
    let (x0, x1) = texels(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
    let (y0, y1) = texels(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let area = ab[0] * ac[1] - ab[1] * ac[0];
    if x0 >= x1 || y0 >= y1 || area == 0.0 || !area.is_finite() {
        return;
    }
    let inverse = 1.0 / area;
    for y in y0..y1 {
        let py = y as f32 + 0.5 - a[1];
        let (sy, ty) = (py * ac[0], py * ab[0]);
        let row = &mut map[y * DepthMap::SIDE..][x0..x1];
        for (x, texel) in (x0 as i32..).zip(row) {
            let px = x as f32 + 0.5 - a[0];
            let s = (px * ac[1] - sy) * inverse;
            let t = (ty - px * ab[1]) * inverse;
            let is_inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0);
            let height = heights[0] + s * (heights[1] - heights[0]) + t * (heights[2] - heights[0]);
            *texel = if is_inside & (height > *texel) { height } else { *texel };
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

/// The largest whole number not above one that is far smaller than 2³¹: faster than a call of the library of the system.
fn floor(x: f64) -> f64 {
    let whole = f64::from(x as i32);
    if whole > x { whole - 1.0 } else { whole }
}
