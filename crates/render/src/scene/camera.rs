use walpha_base::vector::{V3, add, cross, dot, length, scale, sub, unit};

use crate::error::RenderError;
use crate::pixels::Size;

/// Perspective or parallel projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Lines of sight meet in the eye.
    Perspective,
    /// Lines of sight are parallel: lengths can be compared anywhere, and nothing is clipped.
    Orthographic,
}

/// A view of a subject whose face points to −y and whose crown points to +z, as in the CT convention of the sample head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum View {
    /// Seen from −y.
    Front,
    /// Seen from +y.
    Back,
    /// Seen from +x, the subject's own left.
    Left,
    /// Seen from −x, the subject's own right.
    Right,
    /// Seen from +z, with the face down in the picture.
    Top,
    /// Seen from −z, with the face up in the picture.
    Bottom,
    /// Seen from the front, 22° to the subject's left and 11° above: the portrait of a solid.
    ThreeQuarter,
}

impl View {
    /// The direction from the subject to the eye (not of length 1), and the direction that is up in the picture.
    pub fn direction_and_up(self) -> ([f64; 3], [f64; 3]) {
        const UP: V3 = [0.0, 0.0, 1.0];
        match self {
            Self::Front => ([0.0, -1.0, 0.0], UP),
            Self::Back => ([0.0, 1.0, 0.0], UP),
            Self::Left => ([1.0, 0.0, 0.0], UP),
            Self::Right => ([-1.0, 0.0, 0.0], UP),
            Self::Top => ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
            Self::Bottom => ([0.0, 0.0, -1.0], [0.0, -1.0, 0.0]),
            Self::ThreeQuarter => ([58.0, -142.0, 30.0], UP),
        }
    }
}

/// The position of the eye and its field of view.
///
/// The opening is given by the height of the visible part at the target, not by an angle, so that
/// both projections show the target at the same size, and no tangent has to be rounded. A vertical
/// field of view φ at distance d is a height of 2·d·tan(φ/2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The position of the eye, (x, y, z).
    pub eye: [f64; 3],
    /// The point in the middle of the picture.
    pub target: [f64; 3],
    /// A direction that points up in the picture; any length, not along the line of sight.
    pub up: [f64; 3],
    /// The height of the scene that fills the picture at the target's distance.
    pub height: f64,
    /// Perspective or orthographic.
    pub projection: Projection,
}

impl Camera {
    /// The power of two by which a scene is scaled to be drawn, if the lengths in view are far from 1: depths are single precision.
    pub(crate) fn rescaling(&self) -> Option<f64> {
        /// Heights that need no scaling.
        const USUAL: std::ops::RangeInclusive<f64> = 1e-9..=1e9;
        let is_sound = self.height > 0.0 && self.height < 1e100;
        (is_sound && !USUAL.contains(&self.height))
            .then(|| 2f64.powi(-(self.height.log2().round() as i32)))
    }

    /// This camera with other units of length.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let place = |p: [f64; 3]| p.map(|x| x * factor);
        let (eye, target) = (place(self.eye), place(self.target));
        Self { eye, target, height: self.height * factor, ..*self }
    }

    /// Height over distance of a fitted perspective camera: a field of view of 23°, which shows a
    /// solid with little distortion.
    const FITTED_OPENING: f64 = 0.4;
    /// The share of the picture that a fitted box may fill, so that it keeps a margin.
    const FITTED_SHARE: f64 = 0.94;

    /// 2·tan(15°): height over distance of a field of view of 30°.
    const PORTRAIT_OPENING: f64 = 0.535_898_384_862_245_4;

    /// The perspective camera at a position that looks at a target, with a vertical field of view of 30° and +z up (+y, if it
    /// looks along z).
    pub fn portrait(eye: [f64; 3], target: [f64; 3]) -> Self {
        let sight = sub(target, eye);
        let vertical = sight[0] == 0.0 && sight[1] == 0.0;
        let up = if vertical { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let height = length(sight) * Self::PORTRAIT_OPENING;
        Self { eye, target, up, height, projection: Projection::Perspective }
    }

    /// The camera that sees balls, (centre, radius), from the direction of a view so that they just fit into a picture of this
    /// size, and are in its middle. Of no balls, or a point, it sees a height of 1. O(n).
    pub(super) fn fit(
        balls: impl IntoIterator<Item = (V3, f64)>,
        view: View,
        projection: Projection,
        size: Size,
    ) -> Self {
        let (direction, up) = view.direction_and_up();
        // Views have a direction, and their up is another direction.
        let back = unit(direction).unwrap_or(direction);
        let right = unit(cross(up, back)).unwrap_or(up);
        let top = cross(back, right);
        let aspect = f64::from(size.width()) / f64::from(size.height());
        // A plane at the side of what a perspective camera sees is x + slope·z = constant, z towards the eye.
        let slope = match projection {
            Projection::Perspective => Self::FITTED_OPENING / 2.0 * Self::FITTED_SHARE,
            Projection::Orthographic => 0.0,
        };
        let slopes = [slope * aspect, slope];
        let mut balls = balls.into_iter().peekable();
        // Far from the origin, differences have more digits.
        let origin = balls.peek().map_or([0.0; 3], |&(centre, _)| centre);
        let mut sides = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut depth = [f64::INFINITY, f64::NEG_INFINITY];
        for (centre, radius) in balls {
            let p = sub(centre, origin);
            let z = dot(p, back);
            depth = [depth[0].min(z - radius), depth[1].max(z + radius)];
            for (k, axis) in [right, top].into_iter().enumerate() {
                let (at, slope) = (dot(p, axis), slopes[k]);
                // By a square root alone, which is the same on all machines.
                let reach = radius * (1.0 + slope * slope).sqrt();
                sides[k][0] = sides[k][0].min(at - slope * z - reach);
                sides[k][1] = sides[k][1].max(at + slope * z + reach);
            }
        }
        let [width, height] = sides.map(|[low, high]| (high - low).max(0.0));
        let [depth, deep] = [f64::midpoint(depth[0], depth[1]), depth[1] - depth[0]];
        let (mut distance, mut height) = match projection {
            Projection::Perspective => {
                let eye = (width / slopes[0]).max(height / slopes[1]) / 2.0;
                (eye - depth, (eye - depth) * Self::FITTED_OPENING)
            }
            Projection::Orthographic => {
                (width.max(height).max(deep), height.max(width / aspect) / Self::FITTED_SHARE)
            }
        };
        // Without balls it is not finite.
        if !(height > 0.0 && height.is_finite()) {
            (height, distance) = (1.0, 1.0 / Self::FITTED_OPENING);
        }
        let middle = sides.map(|[low, high]| f64::midpoint(low, high));
        let [x, y, z] = [middle[0], middle[1], depth].map(|x| if x.is_finite() { x } else { 0.0 });
        let target = add(origin, add(add(scale(right, x), scale(top, y)), scale(back, z)));
        let eye = add(target, scale(back, distance));
        Self { eye, target, up, height, projection }
    }
}

/// A camera for pictures of one size: from the world to pixels, and from pixels to lines of sight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    pub eye: V3,
    pub right: V3,
    pub up: V3,
    pub forward: V3,
    pub projection: Projection,
    /// Pixels for each unit of x/z (perspective) or x (orthographic).
    pub focal: f64,
    /// The middle of the picture in pixels.
    pub centre: [f64; 2],
    /// The distance within which nothing is drawn.
    pub near: f64,
}

impl Lens {
    pub(crate) fn new(camera: &Camera, size: Size) -> Result<Self, RenderError> {
        let all = [camera.eye, camera.target, camera.up];
        if !all.as_flattened().iter().all(|v| v.abs() < 1e100) {
            return Err(RenderError::Camera("eye, target and up must be finite and below 1e100"));
        }
        if !(camera.height > 0.0 && camera.height < 1e100) {
            return Err(RenderError::Camera("the height it sees must be positive and finite"));
        }
        let sight = sub(camera.target, camera.eye);
        let forward =
            unit(sight).ok_or(RenderError::Camera("eye and target are the same point"))?;
        let up = unit(camera.up).ok_or(RenderError::Camera("up has no direction"))?;
        let right = cross(forward, up);
        if length(right) < 1e-9 {
            return Err(RenderError::Camera("up points along the line of sight; turn it"));
        }
        let right = unit(right).expect("just measured");
        let distance = length(sight);
        let (width, height) = (f64::from(size.width()), f64::from(size.height()));
        let (focal, near) = match camera.projection {
            Projection::Perspective => (height * distance / camera.height, distance * 1e-3),
            Projection::Orthographic => (height / camera.height, f64::NEG_INFINITY),
        };
        Ok(Self {
            eye: camera.eye,
            right,
            up: cross(right, forward),
            forward,
            projection: camera.projection,
            focal,
            centre: [width / 2.0, height / 2.0],
            near,
        })
    }

    /// Into the eye's own axes: right, up, forward.
    pub(crate) fn view(&self, p: V3) -> V3 {
        let p = sub(p, self.eye);
        [dot(p, self.right), dot(p, self.up), dot(p, self.forward)]
    }

    /// The pixel position (x right, y down) of a point in the eye's axes, in front of the eye.
    pub(crate) fn pixel(&self, v: V3) -> [f64; 2] {
        let s = match self.projection {
            Projection::Perspective => self.focal / v[2],
            Projection::Orthographic => self.focal,
        };
        [self.centre[0] + v[0] * s, self.centre[1] - v[1] * s]
    }

    /// The line of sight through a pixel position, in the eye's axes: origin and direction, the
    /// direction's forward part being 1 so that the parameter along it is the depth.
    pub(crate) fn ray(&self, x: f64, y: f64) -> (V3, V3) {
        let slope = [(x - self.centre[0]) / self.focal, (self.centre[1] - y) / self.focal];
        match self.projection {
            Projection::Perspective => ([0.0; 3], [slope[0], slope[1], 1.0]),
            Projection::Orthographic => ([slope[0], slope[1], 0.0], [0.0, 0.0, 1.0]),
        }
    }

    /// A number that grows towards the eye and is linear over the picture on every plane.
    pub(crate) fn nearness(&self, depth: f64) -> f64 {
        match self.projection {
            Projection::Perspective => 1.0 / depth,
            Projection::Orthographic => -depth,
        }
    }

    /// A direction given along right, up and towards the eye, in world axes.
    pub(crate) fn world_direction(&self, right: f64, up: f64, back: f64) -> V3 {
        let d = add(scale(self.right, right), scale(self.up, up));
        add(d, scale(self.forward, -back))
    }
}
