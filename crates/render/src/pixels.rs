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
    /// 16384: a gigabyte of pixels, and far inside the range of the fixed-point edges.
    pub const MAX_SIDE: u32 = MOST_PIXELS;

    /// Checks a width and a height.
    ///
    /// # Errors
    /// [`RenderError::Size`] when one is zero or above [`Size::MAX_SIDE`].
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
    /// When there is no such pixel.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        assert!(x < self.size.width && y < self.size.height, "pixel ({x}, {y}) is outside");
        self.pixels[(y * self.size.width + x) as usize]
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// [`RenderError::Png`], when there is not enough memory for the file.
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
