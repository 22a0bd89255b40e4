//! Pictures, their pixels, and the samples within a pixel.

use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::error::{MOST_PIXELS, RenderError};

/// The size of a picture in pixels, checked once: both sides are 1 to [`Size::MAX_SIDE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    width: u32,
    height: u32,
}

impl Size {
    /// 16384: a gigabyte of pixels, and well within the range of the fixed-point edges.
    pub const MAX_SIDE: u32 = MOST_PIXELS;

    /// Checks a width and a height.
    ///
    /// # Errors
    /// [`RenderError::Size`] if one is zero or above [`Size::MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, RenderError> {
        let fits = |side| (1..=Self::MAX_SIDE).contains(&side);
        if fits(width) && fits(height) {
            Ok(Self { width, height })
        } else {
            Err(RenderError::Size { width, height })
        }
    }

    /// Pixels along a row.
    pub fn width(self) -> u32 {
        self.width
    }

    /// Pixels along a column.
    pub fn height(self) -> u32 {
        self.height
    }
}

/// Pixels: red, green, blue and opacity, 8 bits each, row by row from the top left; colours are
/// not premultiplied by the opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: Size,
    pixels: Vec<[u8; 4]>,
}

impl Picture {
    pub(crate) fn new(size: Size, pixels: Vec<[u8; 4]>) -> Self {
        debug_assert_eq!(pixels.len() as u64, u64::from(size.width) * u64::from(size.height));
        Self { size, pixels }
    }

    /// Width and height.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// The pixel in column `x` and row `y`, counted from the top left.
    ///
    /// # Panics
    /// If there is no such pixel.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        assert!(x < self.size.width && y < self.size.height, "pixel ({x}, {y}) is outside");
        self.pixels[(y * self.size.width + x) as usize]
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// [`RenderError::Png`], if there is not enough memory for the file.
    pub fn to_png(&self) -> Result<Vec<u8>, RenderError> {
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
            .write_image(
                self.pixels.as_flattened(),
                self.size.width,
                self.size.height,
                image::ExtendedColorType::Rgba8,
            )?;
        Ok(bytes)
    }
}

/// Samples in a pixel.
pub(crate) const SAMPLES: usize = 16;

/// Fixed-point steps in a pixel: sample positions and snapped corners are multiples of 1/256.
pub(crate) const STEPS: i32 = 256;

/// Sample k of a pixel, (x, y) in 1/256 from its upper left corner. Cell (a, b) of the 4×4 grid
/// holds its sample moved by (b, a)/16, so that no two share a row or a column, and upright and
/// level edges are as smooth as slanted ones: 16 steps from white to black.
pub(crate) const SAMPLE: [[i32; 2]; SAMPLES] = {
    let mut all = [[0; 2]; SAMPLES];
    let mut k = 0;
    while k < SAMPLES {
        let (a, b) = ((k / 4) as i32, (k % 4) as i32);
        all[k] = [16 * (4 * a + b) + 8, 16 * (4 * b + a) + 8];
        k += 1;
    }
    all
};

/// The position of sample k of a pixel, in pixels.
pub(crate) fn sample_position(x: i32, y: i32, k: usize) -> [f64; 2] {
    let [dx, dy] = SAMPLE[k];
    let [dx, dy] = [dx, dy].map(|d| f64::from(d) / f64::from(STEPS));
    [f64::from(x) + dx, f64::from(y) + dy]
}

/// The middle of those samples of a pixel that a mask has, in pixels.
pub(crate) fn middle(x: i32, y: i32, mask: u16) -> [f64; 2] {
    let mut sum = [0; 2];
    for (k, place) in SAMPLE.iter().enumerate() {
        let is_in = i32::from(mask >> k & 1);
        sum = [sum[0] + is_in * place[0], sum[1] + is_in * place[1]];
    }
    let share = 1.0 / (f64::from(mask.count_ones()) * f64::from(STEPS));
    [f64::from(x) + f64::from(sum[0]) * share, f64::from(y) + f64::from(sum[1]) * share]
}

/// The largest whole number not above one that is far smaller than 2³¹: faster than a call of the library of the system.
pub(crate) fn floor(x: f64) -> i32 {
    let whole = x as i32;
    if f64::from(whole) > x { whole - 1 } else { whole }
}

/// Pixels x0 ≤ x < x1 and y0 ≤ y < y1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelBox {
    pub x0: i32,
    pub y0: i32,
    pub x1: i32,
    pub y1: i32,
}

impl PixelBox {
    /// The pixels that touch the rectangle between two positions, inside a picture of this size.
    pub(crate) fn around(low: [f64; 2], high: [f64; 2], size: Size) -> Self {
        // `as` saturates, and NaN becomes 0.
        let (width, height) = (size.width() as i32, size.height() as i32);
        Self {
            x0: (low[0].floor() as i32).clamp(0, width),
            y0: (low[1].floor() as i32).clamp(0, height),
            x1: (high[0].ceil() as i32).clamp(0, width),
            y1: (high[1].ceil() as i32).clamp(0, height),
        }
    }

    pub(crate) fn meet(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    pub(crate) fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }
}

/// The part of one pixel that one primitive covers: its samples as bits, and the nearness of each.
pub(crate) struct Patch {
    pub x: i32,
    pub y: i32,
    pub mask: u16,
    pub nearness: [f32; SAMPLES],
}
