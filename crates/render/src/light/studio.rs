use walpha_base::vector::{V3, add, dot, scale, sub, unit};

use crate::scene::{Lens, Projection};

/// The lamps, fixed to the camera as in a photographer's studio, so that every panel of a figure
/// is lit alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Studio {
    /// Towards the main lamp: upper left, before the subject.
    pub key: V3,
    /// Towards the weak lamp that keeps the shadow side readable.
    fill: V3,
    /// Up in the picture, where the sky is brighter.
    pub up: V3,
    eye: V3,
    back: V3,
    projection: Projection,
}

/// Shares of light. White in full light, key and sky, is close to 1.
const SKY: f64 = 0.42;
const KEY: f64 = 0.66;
const FILL: f64 = 0.09;
const RIM: f64 = 0.10;
const GLOSS: f64 = 0.035;
/// The share of the key that reaches its own shadow, by reflections.
const SHADOW: f64 = 0.05;

impl Studio {
    pub(crate) fn new(lens: &Lens) -> Self {
        let lamp = |right, up, back| {
            unit(lens.world_direction(right, up, back)).expect("lamps have a direction")
        };
        Self {
            key: lamp(-0.70, 0.72, 0.50),
            fill: lamp(0.80, 0.05, 0.60),
            up: lens.up,
            eye: lens.eye,
            back: scale(lens.forward, -1.0),
            projection: lens.projection,
        }
    }

    /// The unit vector from a place to the eye.
    pub(crate) fn towards_eye(&self, place: V3) -> V3 {
        match self.projection {
            Projection::Perspective => unit(sub(self.eye, place)).unwrap_or(self.back),
            Projection::Orthographic => self.back,
        }
    }

    /// The light that a matt surface with a little gloss sends to the eye.
    ///
    /// `sky` is the sky light that reaches it, `key` the share of the main lamp, both 1 in the
    /// open.
    pub(crate) fn shade(
        &self,
        albedo: [f32; 3],
        normal: V3,
        to_eye: V3,
        sky: f64,
        key: f64,
    ) -> [f32; 3] {
        let sky = sky.max(0.0);
        let open = sky.min(1.0);
        let lit = SHADOW + (1.0 - SHADOW) * key;
        let key_light = KEY * lit * dot(normal, self.key).max(0.0);
        let fill_light = FILL * (0.3 + 0.7 * open) * dot(normal, self.fill).max(0.0);
        // Light that enters a hollow is also lost between its walls.
        let matt = SKY * sky * (0.4 + 0.6 * open) + key_light + fill_light;
        let graze = 1.0 - dot(normal, to_eye).clamp(0.0, 1.0);
        let rim = RIM * open * graze * graze * graze * graze;
        let half = unit(add(self.key, to_eye)).unwrap_or(to_eye);
        let gloss = [(); 5].iter().fold(dot(normal, half).max(0.0), |g, ()| g * g);
        let extra = rim + GLOSS * lit * gloss;
        albedo.map(|a| (f64::from(a) * (matt + rim) + extra * 0.5) as f32)
    }
}
