use walpha_base::vector::saturate;

/// A colour in sRGB: red, green, blue, 0 to 255 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub [u8; 3]);

impl Rgb {
    /// White.
    pub const WHITE: Self = Self([255; 3]);
    /// The light, warm gray of bare bone, which leaves room for light and shadow.
    pub const BONE: Self = Self([222, 212, 194]);

    /// Linear light, 0 to 1. The square replaces the sRGB curve (an exponent of about 2.2): its inverse is a square root, which
    /// every machine rounds equally.
    pub(crate) fn light(self) -> [f32; 3] {
        self.0.map(|c| {
            let c = f32::from(c) / 255.0;
            c * c
        })
    }

    /// Red, green and blue as `#rrggbb`.
    pub fn hex(self) -> String {
        let [r, g, b] = self.0;
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// Eight colours to distinguish classes, also with any common colour blindness: vermilion, blue,
/// bluish green, orange, sky blue, reddish purple, yellow, black (Okabe and Ito, "Color Universal
/// Design", 2002).
pub const PALETTE: [Rgb; 8] = [
    Rgb([213, 94, 0]),
    Rgb([0, 114, 178]),
    Rgb([0, 158, 115]),
    Rgb([230, 159, 0]),
    Rgb([86, 180, 233]),
    Rgb([204, 121, 167]),
    Rgb([240, 228, 66]),
    Rgb([0, 0, 0]),
];

/// A perceptually uniform map from values to colours: viridis (Smith and van der Walt, 2015) by its values at sixteen equal
/// steps, linear between them.
///
/// Equal steps of the value look equally far apart, and lightness alone orders them, so it
/// survives gray printing and colour blindness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourMap {
    low: f64,
    high: f64,
}

impl ColourMap {
    /// The map with dark violet at `low` and below and yellow at `high` and above. If the two are equal (or not finite), every
    /// value has the middle colour.
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// The map over the range of these values; 0 to 1 if there are none.
    pub fn over(values: &[f64]) -> Self {
        let ends = values
            .iter()
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
        if ends.0 <= ends.1 { Self::new(ends.0, ends.1) } else { Self::new(0.0, 1.0) }
    }

    /// The values at both ends.
    pub fn range(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// The colour of a value; NaN has the colour of the low end.
    pub fn colour(&self, value: f64) -> Rgb {
        let share =
            if self.high > self.low { (value - self.low) / (self.high - self.low) } else { 0.5 };
        let last = VIRIDIS.len() - 1;
        let at = saturate(share) * last as f64;
        let step = (at as usize).min(last - 1);
        let between = at - step as f64;
        let (a, b) = (VIRIDIS[step], VIRIDIS[step + 1]);
        Rgb([0, 1, 2].map(|k| {
            let (a, b) = (f64::from(a[k]), f64::from(b[k]));
            (a + (b - a) * between + 0.5) as u8
        }))
    }
}

const VIRIDIS: [[u8; 3]; 16] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x1a, 0x6c],
    [0x47, 0x2f, 0x7d],
    [0x41, 0x44, 0x87],
    [0x39, 0x56, 0x8c],
    [0x31, 0x68, 0x8e],
    [0x2a, 0x78, 0x8e],
    [0x23, 0x88, 0x8e],
    [0x1f, 0x98, 0x8b],
    [0x22, 0xa8, 0x84],
    [0x35, 0xb7, 0x79],
    [0x54, 0xc5, 0x68],
    [0x7a, 0xd1, 0x51],
    [0xa5, 0xdb, 0x36],
    [0xd2, 0xe2, 0x1b],
    [0xfd, 0xe7, 0x25],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE L*a*b* (D65) of an sRGB colour, by the defining formulas.
    fn lab(Rgb(c): Rgb) -> [f64; 3] {
        let [r, g, b] = c.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        let x = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
        let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089;
        let [fx, fy, fz] =
            [x, y, z].map(|t: f64| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
        [116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)]
    }

    #[test]
    fn lightness_grows_evenly_along_the_map() {
        let map = ColourMap::new(0.0, 1.0);
        let lightness: Vec<f64> =
            (0..=15).map(|k| lab(map.colour(f64::from(k) / 15.0))[0]).collect();
        let mean = (lightness[15] - lightness[0]) / 15.0;
        for pair in lightness.windows(2) {
            let step = pair[1] - pair[0];
            assert!((step - mean).abs() < 0.35 * mean, "a step of {step}, mean {mean}");
        }
    }

    #[test]
    fn the_ends_and_what_lies_beyond() {
        let map = ColourMap::new(10.0, 20.0);
        assert_eq!(map.colour(10.0), Rgb([0x44, 0x01, 0x54]));
        assert_eq!(map.colour(-5.0), map.colour(10.0));
        assert_eq!(map.colour(20.0), Rgb([0xfd, 0xe7, 0x25]));
        assert_eq!(map.colour(f64::INFINITY), map.colour(20.0));
        assert_eq!(map.colour(f64::NAN), map.colour(10.0));
        assert_eq!(ColourMap::new(3.0, 3.0).colour(3.0), ColourMap::new(0.0, 1.0).colour(0.5));
        assert_eq!(ColourMap::over(&[4.0, f64::NAN, -1.0]).range(), (-1.0, 4.0));
    }

    #[test]
    fn palette_colours_differ_clearly() {
        for (i, &a) in PALETTE.iter().enumerate() {
            for &b in &PALETTE[..i] {
                let (a, b) = (lab(a), lab(b));
                let distance = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
                assert!(distance > 20.0, "{a:?} and {b:?} are {distance} apart");
            }
        }
    }
}
