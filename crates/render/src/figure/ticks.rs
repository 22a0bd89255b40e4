//! Scales of axes, and where their ticks are.

/// How the numbers along an axis become coordinates of a drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Scale {
    /// A number is its coordinate.
    #[default]
    Linear,
    /// The coordinate is the decimal logarithm.
    Log {
        /// The coordinate of 0 and of what is less, if there is such a number.
        zero: Option<f64>,
    },
    /// Of counts: the coordinate is the decimal logarithm of one more, so that 0 has its place.
    LogOfOneMore,
}

impl Scale {
    /// The coordinate of a number.
    pub fn place(self, number: f64) -> f64 {
        match self {
            Self::Linear => number,
            Self::Log { zero: Some(zero) } if number <= 0.0 => zero,
            Self::Log { .. } => number.log10(),
            Self::LogOfOneMore => (1.0 + number).log10(),
        }
    }

    /// The coordinates and labels of ticks between two coordinates, about `count` of them.
    pub(super) fn ticks(self, low: f64, high: f64, count: usize) -> Vec<(f64, String)> {
        let zero = match self {
            Self::Linear => return ticks(low, high, count),
            Self::Log { zero } => zero,
            Self::LogOfOneMore => Some(0.0),
        };
        if !(high > low && (high - low).is_finite()) {
            return Vec::new();
        }
        let slack = (high - low) * 1e-9;
        // Powers of ten, some of them if there are many, and also 2 and 5 times these if there are few.
        let decades = high - low;
        let step = (decades / count.max(1) as f64).ceil().max(1.0) as i32;
        let factors: &[u32] = if 3.0 * decades <= count as f64 { &[1, 2, 5] } else { &[1] };
        let first = if self == Self::LogOfOneMore { 0 } else { low.floor() as i32 };
        let powers = (first..=high.ceil() as i32).step_by(step as usize);
        let numbers = powers.flat_map(|power| {
            factors.iter().filter_map(move |factor| format!("{factor}e{power}").parse().ok())
        });
        // The label of 0 needs room.
        let room = if self == Self::LogOfOneMore { 0.0 } else { 0.4 };
        let is_shown = |at: &f64| {
            *at >= low - slack && *at <= high + slack && zero.is_none_or(|zero| *at > zero + room)
        };
        let mut logarithmic: Vec<(f64, String)> = numbers
            .map(|number: f64| (self.place(number), shortest(label(number, 6))))
            .filter(|(at, _)| is_shown(at))
            .collect();
        // A part of a decade may have no such number, or one.
        if logarithmic.len() < 2 && self != Self::LogOfOneMore {
            let [low, high] = [low, high].map(|at| 10f64.powf(at));
            let round = ticks(low, high, count).into_iter().filter_map(|(_, text)| {
                let number: f64 = text.parse().ok()?;
                (number > 0.0).then(|| (self.place(number), shortest(text)))
            });
            logarithmic = round.filter(|(at, _)| is_shown(at)).collect();
        }
        let zero = zero.filter(|zero| *zero >= low - slack).map(|zero| (zero, "0".to_owned()));
        zero.into_iter().chain(logarithmic).collect()
    }
}

/// A number without the zeros at its end.
fn shortest(text: String) -> String {
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

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
    fn ticks_of_logarithms_are_powers_of_ten() {
        let labels = |scale: Scale, low: f64, high: f64, count: usize| {
            let all = scale.ticks(low, high, count);
            for (at, text) in &all {
                let number: f64 = text.replace('−', "-").parse().unwrap();
                assert_eq!(scale.place(number), *at);
            }
            all.into_iter().map(|(_, text)| text).collect::<Vec<_>>().join(" ")
        };
        let log = Scale::Log { zero: None };
        assert_eq!(labels(log, -2.1, 3.0, 6), "0.01 0.1 1 10 100 1000");
        assert_eq!(labels(log, -1.0, 1.0, 9), "0.1 0.2 0.5 1 2 5 10");
        assert_eq!(labels(log, -12.0, 12.0, 6), "1e−12 1e−8 0.0001 1 10000 1e8 1e12");
        assert_eq!(labels(Scale::Log { zero: Some(-2.5) }, -3.0, 0.0, 5), "0 0.01 0.1 1");
        assert_eq!(labels(Scale::Log { zero: Some(-1.1) }, -1.2, 1.0, 5), "0 1 10");
        assert_eq!(labels(Scale::LogOfOneMore, 0.0, 3.1, 4), "0 1 10 100 1000");
        assert!(labels(log, 1.0, 1.0, 4).is_empty());
        // Less than a decade.
        assert_eq!(labels(log, 0.06, 0.12, 4), "1.15 1.2 1.25 1.3");
        assert_eq!(labels(Scale::Log { zero: Some(-0.02) }, -0.03, 0.49, 5), "0 2.5 3");
    }

    #[test]
    fn an_empty_range_has_no_ticks() {
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert!(ticks(low, high, 5).is_empty());
        }
    }
}
