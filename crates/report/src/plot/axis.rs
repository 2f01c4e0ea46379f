//! Axes: round limits, ticks on round numbers, a position for every value.

use crate::number::with_minus;

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Title with unit, `pressure (kPa)`.
    pub title: String,
    /// Value at the lower end.
    pub from: f64,
    /// Value at the upper end.
    pub to: f64,
    /// Ticks and what is written at them.
    pub ticks: Vec<(f64, String)>,
    logarithmic: bool,
}

impl Axis {
    /// A linear axis that covers `lowest` to `highest`, widened to round numbers, with about `ticks` ticks.
    /// Bounds that are not finite or equal give an axis around them.
    pub fn linear(title: impl Into<String>, lowest: f64, highest: f64, ticks: usize) -> Self {
        let (lowest, highest) = widened(lowest, highest);
        let step = round_step((highest - lowest) / ticks.max(1) as f64);
        // A fifth of a step is round enough for an end and leaves less of the panel empty than a whole one.
        let end = 0.2 * step;
        let from = (lowest / end + 1e-9).floor() * end;
        let to = (highest / end - 1e-9).ceil() * end;
        Self { title: title.into(), from, to, ticks: linear_ticks(from, to, step), logarithmic: false }
    }

    /// A linear axis with exactly these ends.
    pub fn exact(title: impl Into<String>, from: f64, to: f64, ticks: usize) -> Self {
        let (from, to) = if from < to { (from, to) } else { widened(from, to) };
        let step = round_step((to - from) / ticks.max(1) as f64);
        Self { title: title.into(), from, to, ticks: linear_ticks(from, to, step), logarithmic: false }
    }

    /// A logarithmic axis that covers `lowest` to `highest`, both positive.
    pub fn logarithmic(title: impl Into<String>, lowest: f64, highest: f64) -> Self {
        let lowest = if lowest.is_finite() && lowest > 0.0 { lowest } else { 1.0 };
        let highest = if highest.is_finite() && highest > lowest { highest } else { lowest };
        let decades = (highest / lowest).log10();
        if decades < 0.9 {
            // Within a decade the ticks of a linear axis read better than 1, 2, 5.
            let margin = if decades < 0.02 { 0.05 } else { 0.01 };
            let linear = Self::linear(title, lowest * (1.0 - margin), highest * (1.0 + margin), 5);
            let from = if linear.from > 0.0 { linear.from } else { lowest * 0.9 };
            let ticks = linear.ticks.into_iter().filter(|(value, _)| *value >= from).collect();
            return Self { from, ticks, logarithmic: true, ..linear };
        }
        let mantissas: &[f64] = if decades < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let ends = [1.0, 2.0, 5.0];
        let all = |mantissas: &[f64]| -> Vec<f64> {
            let (first, last) = (lowest.log10().floor() as i32, highest.log10().ceil() as i32);
            (first..=last).flat_map(|decade| mantissas.iter().map(move |m| m * 10f64.powi(decade))).collect()
        };
        let from = all(&ends).into_iter().rfind(|value| *value <= lowest * 1.000_001).unwrap_or(lowest);
        let to = all(&ends).into_iter().find(|value| *value >= highest * 0.999_999).unwrap_or(highest);
        // Every decade while they fit, then every other or third one.
        let every = (decades / 7.0).ceil().max(1.0) as i32;
        let ticks = all(mantissas)
            .into_iter()
            .filter(|value| *value >= from * 0.999_999 && *value <= to * 1.000_001)
            .filter(|value| every == 1 || (value.log10().round() as i32).rem_euclid(every) == 0)
            .map(|value| (value, power_label(value)))
            .collect();
        Self { title: title.into(), from, to, ticks, logarithmic: true }
    }

    /// Ticks whose labels find room side by side: all of them, or else powers of ten where the axis has three or more, or
    /// else every second, third, … of them.
    pub(crate) fn labelled(&self, at: impl Fn(f64) -> f64, width: impl Fn(&str) -> f64) -> Vec<usize> {
        let is_decade = |value: f64| self.logarithmic && (value.log10() - value.log10().round()).abs() < 1e-9;
        let ends = |index: usize| {
            let (value, label) = &self.ticks[index];
            (at(*value) - 0.5 * width(label), at(*value) + 0.5 * width(label))
        };
        let roomy = |ticks: &[usize]| ticks.windows(2).all(|pair| ends(pair[0]).1 <= ends(pair[1]).0);
        let all: Vec<usize> = (0..self.ticks.len()).collect();
        let decades: Vec<usize> = all.iter().copied().filter(|index| is_decade(self.ticks[*index].0)).collect();
        if roomy(&all) {
            return all;
        }
        if decades.len() > 2 && roomy(&decades) {
            return decades;
        }
        let every = |n: usize| -> Vec<usize> { all.iter().copied().step_by(n).collect() };
        (2..=all.len()).map(every).find(|ticks| roomy(ticks)).unwrap_or_default()
    }

    /// Where `value` lies, 0 at the lower and 1 at the upper end.
    pub fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.from).ln() / (self.to / self.from).ln()
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }
}

/// Round numbers in `[lowest, highest]`, about `count` of them.
pub(crate) fn round_levels(lowest: f64, highest: f64, count: usize) -> Vec<f64> {
    let (lowest, highest) = widened(lowest, highest);
    let step = round_step((highest - lowest) / count.max(1) as f64);
    linear_ticks(lowest, highest, step).into_iter().map(|(value, _)| value).collect()
}

fn widened(lowest: f64, highest: f64) -> (f64, f64) {
    let (lowest, highest) = match (lowest.is_finite(), highest.is_finite()) {
        (true, true) => (lowest.min(highest), lowest.max(highest)),
        (true, false) => (lowest, lowest),
        (false, true) => (highest, highest),
        (false, false) => (0.0, 1.0),
    };
    // Far enough from overflow for differences.
    let (lowest, highest) = (lowest.clamp(-1e300, 1e300), highest.clamp(-1e300, 1e300));
    let size = lowest.abs().max(highest.abs());
    if highest - lowest > 1e-9 * size {
        return (lowest, highest);
    }
    let margin = if size > 0.0 { 0.05 * size } else { 1.0 };
    (lowest - margin, highest + margin)
}

/// The smallest of 1, 2, 2.5 and 5 times a power of ten that is at least `step`.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let mantissas = [1.0, 2.0, 2.5, 5.0, 10.0];
    mantissas.into_iter().map(|mantissa| mantissa * power).find(|round| *round >= step * 0.999).unwrap_or(step)
}

fn linear_ticks(from: f64, to: f64, step: f64) -> Vec<(f64, String)> {
    let decimals = (0..9).find(|decimals| {
        let scaled = step * 10f64.powi(*decimals);
        (scaled - scaled.round()).abs() < 1e-6 * scaled
    });
    let decimals = decimals.unwrap_or(9) as usize;
    let (first, last) = ((from / step - 1e-6).ceil(), (to / step + 1e-6).floor());
    // A handful by construction; the limit is for a step lost in rounding.
    let count = ((last - first).max(0.0) as usize + 1).min(50);
    let value = |index: usize| (first + index as f64) * step;
    let label = |value: f64| {
        let size = from.abs().max(to.abs());
        if (1e-6..1e7).contains(&size) { format!("{value:.decimals$}") } else { format!("{value:.1e}") }
    };
    (0..count).map(|index| (value(index), with_minus(label(value(index))))).collect()
}

fn power_label(value: f64) -> String {
    if (1e-3..1e5).contains(&value) { format!("{}", (value * 1e6).round() / 1e6) } else { format!("{value:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn limits_and_ticks_are_round() {
        let axis = Axis::linear("force (N)", -8.7, 212.0, 6);
        assert_eq!((axis.from, axis.to), (-10.0, 220.0));
        assert_eq!(labels(&axis), ["0", "50", "100", "150", "200"]);
        let axis = Axis::linear("x", 0.12, 0.19, 5);
        assert_eq!(labels(&axis), ["0.12", "0.14", "0.16", "0.18"]);
    }

    #[test]
    fn degenerate_limits_still_make_an_axis() {
        for (lowest, highest) in [(3.0, 3.0), (0.0, 0.0), (f64::NAN, 2.0), (f64::NAN, f64::NAN), (1e300, 1e300)] {
            let axis = Axis::linear("x", lowest, highest, 5);
            assert!(axis.from < axis.to, "{lowest} {highest}");
            assert!(axis.ticks.len() > 1, "{lowest} {highest}: {axis:?}");
        }
        assert!(Axis::logarithmic("x", -1.0, f64::NAN).ticks.len() > 1);
    }

    #[test]
    fn labels_that_would_touch_give_way_to_powers_of_ten() {
        let axis = Axis::logarithmic("x", 0.05, 20.0);
        let shown = |pixels: f64| -> Vec<&str> {
            let kept = axis.labelled(|value| pixels * axis.fraction(value), |label| 8.0 * label.len() as f64);
            kept.into_iter().map(|index| axis.ticks[index].1.as_str()).collect()
        };
        assert_eq!(shown(1000.0), ["0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(shown(120.0), ["0.1", "1", "10"]);
        let narrow = Axis::linear("x", 0.0, 100.0, 5);
        let kept = narrow.labelled(|value| narrow.fraction(value) * 60.0, |label| 8.0 * label.len() as f64);
        assert_eq!(kept, [0, 2, 4]);
    }

    #[test]
    fn a_logarithmic_axis_has_equal_decades() {
        let axis = Axis::logarithmic("x", 0.9, 120.0);
        assert_eq!((axis.from, axis.to), (0.5, 200.0));
        assert!((axis.fraction(10.0) - axis.fraction(1.0) - axis.fraction(100.0) + axis.fraction(10.0)).abs() < 1e-12);
        assert_eq!(labels(&axis), ["0.5", "1", "2", "5", "10", "20", "50", "100", "200"]);
        let axis = Axis::logarithmic("x", 2.1, 3.9);
        assert!(axis.ticks.len() > 2 && axis.from > 0.0, "{axis:?}");
    }
}
