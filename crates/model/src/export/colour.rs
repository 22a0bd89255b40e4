//! Colours for values, in formats that support them.

/// Five colours of the colour map "viridis": red, green and blue in linear light.
const COLOURS: [[f64; 3]; 5] = [
    [0.0578, 0.0003, 0.0887],
    [0.0437, 0.0844, 0.2582],
    [0.0152, 0.2831, 0.2623],
    [0.1119, 0.5841, 0.1221],
    [0.9823, 0.7991, 0.0185],
];

/// The colour of each value, from dark blue (least) through green to yellow (most), in linear light.
pub(super) fn linear(values: &[f64]) -> Vec<[f64; 3]> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let steps = COLOURS.len() - 1;
    let colour = |value: &f64| {
        let share = if high > low { (value - low) / (high - low) } else { 0.0 };
        let place = share * steps as f64;
        let from = (place as usize).min(steps - 1);
        let part = place - from as f64;
        [0, 1, 2].map(|c| COLOURS[from][c] + part * (COLOURS[from + 1][c] - COLOURS[from][c]))
    };
    values.iter().map(colour).collect()
}

/// The colour of each value as sRGB bytes; the colours are those of [`linear`].
pub(super) fn bytes(values: &[f64]) -> Vec<[u8; 3]> {
    let screen = |c: f64| {
        let c = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (255.0 * c).round() as u8
    };
    linear(values).into_iter().map(|colour| colour.map(screen)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_and_most_are_dark_and_light() {
        assert_eq!(bytes(&[3.0, 7.0]), [[68, 1, 84], [253, 231, 37]], "the ends of viridis");
        assert_eq!(bytes(&[5.0, 5.0]), [[68, 1, 84]; 2], "nothing to tell apart");
    }
}
