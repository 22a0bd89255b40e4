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

    /// The depth maps of up to [`LANES`] directions.
    pub(crate) fn maps(&self, directions: &[V3]) -> Vec<DepthMap> {
        let mut maps: Vec<_> = directions.iter().map(|&d| DepthMap::new(self.space, d)).collect();
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

/// Draws the triangles of a mesh that face the light, which are those of the outermost surface of a solid, or all if both sides are seen.
fn draw_mesh(maps: &mut [DepthMap], mesh: &Mesh, places: &[[f32; 3]]) {
    let axes = [0, 1, 2].map(|axis| {
        let unit = |k: usize| lanes(|lane| maps[lane.min(maps.len() - 1)].unit(axis)[k] as f32);
        [unit(0), unit(1), unit(2)]
    });
    let two_sided = u32::from(mesh.two_sided);
    for corners in &mesh.triangles {
        let corners = corners.map(|c| &places[c as usize]);
        let faced = faced(&axes, corners, two_sided);
        if faced == [0; LANES] {
            continue;
        }
        for (k, map) in maps.iter_mut().enumerate().filter(|(k, _)| faced[*k] != 0) {
            let place = |p: &[f32; 3]| axes.each_ref().map(|axis| coordinate(axis, p, k));
            map.draw_triangle(corners.map(place));
        }
    }
}

#[inline(always)]
fn coordinate(axis: &[Lanes; 3], p: &[f32; 3], k: usize) -> f32 {
    p[0] * axis[0][k] + p[1] * axis[1][k] + p[2] * axis[2][k] + DepthMap::MIDDLE
}

/// For each map, 1 if a triangle faces the light (or has two sides) and may cover the centre of a texel. Where there is one such
/// centre, it does: most triangles of a large mesh lie between centres, and are done with here, without a branch.
#[inline(always)]
fn faced(axes: &[[Lanes; 3]; 3], [a, b, c]: [&[f32; 3]; 3], two_sided: u32) -> [u32; LANES] {
    // Adding this rounds to whole numbers.
    const WHOLE: f32 = (3 << 22) as f32;
    // The first texel whose centre is not below the triangle, and the first whose centre is above it.
    let texels = |a: f32, b: f32, c: f32| {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let low = if c < low { c } else { low };
        let high = if high < c { c } else { high };
        [low + WHOLE, high + WHOLE].map(|x| x - WHOLE)
    };
    // In a loop, not an array of closures, this becomes vector instructions.
    let mut faced = [0; LANES];
    for (k, faced) in faced.iter_mut().enumerate() {
        let [ax, bx, cx] = [a, b, c].map(|p| coordinate(&axes[0], p, k));
        let [ay, by, cy] = [a, b, c].map(|p| coordinate(&axes[1], p, k));
        let ([x0, x1], [y0, y1]) = (texels(ax, bx, cx), texels(ay, by, cy));
        let (abx, aby, acx, acy) = (bx - ax, by - ay, cx - ax, cy - ay);
        let up = abx * acy - aby * acx;
        let (px, py) = (x0 + 0.5 - ax, y0 + 0.5 - ay);
        let (s, t) = (up * (px * acy - py * acx), up * (py * abx - px * aby));
        let covers = u32::from(s >= 0.0) & u32::from(t >= 0.0) & u32::from(s + t <= up * up);
        let several = u32::from(x1 - x0 > 1.0) | u32::from(y1 - y0 > 1.0);
        let any = u32::from(x0 < x1) & u32::from(y0 < y1) & (covers | several);
        *faced = any & (u32::from(up > 0.0) | two_sided);
    }
    faced
}

/// The outermost surface seen from far away in one direction, in parallel projection. Lengths are in texels.
pub(crate) struct DepthMap {
    /// Two axes of the map, and one towards the viewer, for positions in the units of the scene.
    axes: [V3; 3],
    origin: V3,
    texel: f64,
    heights: Vec<f32>,
}

impl DepthMap {
    /// Texels along each side.
    const SIDE: usize = 512;
    /// The place of the origin along each axis.
    const MIDDLE: f32 = Self::SIDE as f32 / 2.0;

    /// The length of a side of a texel, in the units of the scene.
    fn texel(space: &Space) -> f64 {
        2.0 * space.radius / (Self::SIDE - 4) as f64
    }

    fn new(space: &Space, direction: V3) -> Self {
        let (u, v) = across(direction);
        let texel = Self::texel(space);
        let axes = [u, v, direction].map(|axis| scale(axis, 1.0 / texel));
        let heights = vec![f32::NEG_INFINITY; Self::SIDE * Self::SIDE];
        Self { axes, origin: space.centre, texel, heights }
    }

    /// The direction of an axis.
    fn unit(&self, axis: usize) -> V3 {
        scale(self.axes[axis], self.texel)
    }

    /// The place of a position in the map, and its height.
    fn place(&self, p: V3) -> V3 {
        let p = sub(p, self.origin);
        self.axes.map(|axis| dot(p, axis) + f64::from(Self::MIDDLE))
    }

    fn raise(&mut self, x: usize, y: usize, height: f32) {
        let texel = &mut self.heights[y * Self::SIDE + x];
        *texel = texel.max(height);
    }

    #[expect(
        clippy::needless_bitwise_bool,
        reason = "several texels are done at a time where there is no branch"
    )]
    fn draw_triangle(&mut self, [a, b, c]: [[f32; 3]; 3]) {
        let (x0, x1) = texels(a[0].min(b[0]).min(c[0]), a[0].max(b[0]).max(c[0]));
        let (y0, y1) = texels(a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
        let (ab, ac) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let area = ab[0] * ac[1] - ab[1] * ac[0];
        if x0 >= x1 || y0 >= y1 || area == 0.0 || !area.is_finite() {
            return;
        }
        let inverse = 1.0 / area;
        for y in y0..y1 {
            let py = y as f32 + 0.5 - a[1];
            let (sy, ty) = (py * ac[0], py * ab[0]);
            let row = &mut self.heights[y * Self::SIDE..][x0..x1];
            for (x, texel) in (x0 as i32..).zip(row) {
                let px = x as f32 + 0.5 - a[0];
                let s = (px * ac[1] - sy) * inverse;
                let t = (ty - px * ab[1]) * inverse;
                let is_inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0);
                let height = a[2] + s * ab[2] + t * ac[2];
                *texel = if is_inside & (height > *texel) { height } else { *texel };
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
                    self.raise(x, y, (centre[2] + left.sqrt()) as f32);
                }
            }
        }
    }

    /// The share of a receiver that is visible from this direction, 0 to 1, interpolated between the four texels around it.
    pub(crate) fn openness(&self, receiver: &Receiver) -> f64 {
        let [x, y, height] = self.place(along(receiver.place, 1.5 * self.texel, receiver.normal));
        let height = height + receiver.radius / self.texel + 1.5;
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (floor(x), floor(y));
        let (u, v) = (x - left, y - top);
        let open = |dx: usize, dy: usize| {
            let (x, y) = (left as usize + dx, top as usize + dy);
            let hidden = x < Self::SIDE
                && y < Self::SIDE
                && f64::from(self.heights[y * Self::SIDE + x]) > height;
            if hidden { 0.0 } else { 1.0 }
        };
        let upper = open(0, 0) * (1.0 - u) + open(1, 0) * u;
        let lower = open(0, 1) * (1.0 - u) + open(1, 1) * u;
        upper * (1.0 - v) + lower * v
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
