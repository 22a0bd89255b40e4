/// Round numbers within a range, about `count` of them: multiples of 1, 2 or 5 times a power of
/// ten, written as short as possible. None for a range that is empty or not finite.
pub(super) fn ticks(low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
    let rough = (high - low) / count.max(1) as f64;
    if !(rough > 0.0 && rough.is_finite() && rough > low.abs().max(high.abs()) * 1e-12) {
        return Vec::new();
    }
    // The power of ten by formatting and parsing, which are exact where a logarithm may be off by one.
    let scientific = format!("{rough:e}");
    let exponent: i32 = scientific.split('e').nth(1).and_then(|e| e.parse().ok()).unwrap_or(0);
    let power: f64 = format!("1e{exponent}").parse().unwrap_or(1.0);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= rough).unwrap_or(10.0);
    let step = factor * power;
    let decimals = if factor == 10.0 { -exponent - 1 } else { -exponent }.max(0) as usize;
    let slack = step * 1e-9;
    let first = ((low - slack) / step).ceil();
    (0..=2 * count)
        .map(|k| (first + k as f64) * step)
        .take_while(|&v| v <= high + slack)
        .map(|v| if v.abs() < slack { 0.0 } else { v })
        .map(|v| (v, label(v, decimals)))
        .collect()
}

fn label(value: f64, decimals: usize) -> String {
    let text = if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) {
        format!("{:e}", format!("{value:.9e}").parse::<f64>().unwrap_or(value))
    } else {
        format!("{value:.decimals$}")
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, count: usize) -> String {
        let all: Vec<String> = ticks(low, high, count).into_iter().map(|(_, l)| l).collect();
        all.join(" ")
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels(0.0, 255.0, 5), "0 100 200");
        assert_eq!(labels(0.0, 1.0, 5), "0.0 0.2 0.4 0.6 0.8 1.0");
        assert_eq!(labels(-0.3, 0.3, 6), "−0.3 −0.2 −0.1 0.0 0.1 0.2 0.3");
        assert_eq!(labels(17.0, 41.0, 4), "20 30 40");
        assert_eq!(labels(0.0, 0.095, 1), "0.0");
        assert_eq!(labels(0.0, 3e7, 3), "0 1e7 2e7 3e7");
    }

    #[test]
    fn a_range_without_length_has_none() {
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert!(ticks(low, high, 5).is_empty());
        }
    }
}
