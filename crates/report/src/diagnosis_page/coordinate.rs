//! Coordinates of a residual, in the units that people use.

use pam_muscle::Coordinate;

use crate::number::significant;

/// A coordinate as people read it.
pub(super) trait OnPage {
    /// Name in words.
    fn words(self) -> &'static str;

    /// Unit that people use; empty where there is none.
    fn shown_unit(self) -> &'static str;

    /// Title of an axis, with unit.
    fn axis_title(self) -> String;

    /// An SI value in [`shown_unit`](Self::shown_unit).
    fn of_si(self, value: f64) -> f64;

    /// An interval of SI values as people write it: `0–1.2 mm`.
    fn interval(self, from: f64, to: f64) -> String;
}

impl OnPage for Coordinate {
    fn words(self) -> &'static str {
        match self {
            Self::TravelSinceReversal => "travel since reversal",
            Self::TimeSinceLastMove => "time since last move",
            Self::Time | Self::Pressure | Self::Contraction | Self::Speed | Self::Cycle | Self::Force => self.name(),
        }
    }

    fn shown_unit(self) -> &'static str {
        match self {
            Self::Time | Self::TimeSinceLastMove => "s",
            Self::Pressure => "kPa",
            Self::Contraction => "%",
            Self::Speed => "mm/s",
            Self::TravelSinceReversal => "mm",
            Self::Cycle => "",
            Self::Force => "N",
        }
    }

    fn axis_title(self) -> String {
        let (words, unit) = (self.words(), self.shown_unit());
        if unit.is_empty() { words.to_owned() } else { format!("{words} ({unit})") }
    }

    fn of_si(self, value: f64) -> f64 {
        match self {
            Self::Time | Self::TimeSinceLastMove | Self::Cycle | Self::Force => value,
            Self::Pressure => 1e-3 * value,
            Self::Contraction => 100.0 * value,
            Self::Speed | Self::TravelSinceReversal => 1e3 * value,
        }
    }

    fn interval(self, from: f64, to: f64) -> String {
        let (from, to) = (self.of_si(from), self.of_si(to));
        let text = format!("{} to {} {}", rounded(from, to - from), rounded(to, to - from), self.shown_unit());
        text.trim_end().to_owned()
    }
}

/// `value` as an end of an interval `span` wide.
fn rounded(value: f64, span: f64) -> String {
    if !(value.is_finite() && span.is_finite() && span > 0.0) {
        return significant(value, 3);
    }
    // Two digits of the span, and of a small end that is not nothing beside it.
    let smaller = if value.abs() > 1e-2 * span { value.abs().min(span) } else { span };
    let decimals = (1.0 - smaller.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    crate::number::with_minus(text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_written_in_units_that_people_use() {
        assert_eq!(Coordinate::Pressure.interval(100e3, 250e3), "100 to 250 kPa");
        assert_eq!(Coordinate::TravelSinceReversal.interval(0.0, 1.234e-3), "0 to 1.2 mm");
        assert_eq!(Coordinate::TravelSinceReversal.interval(5e-5, 1.6e-3), "0.05 to 1.6 mm");
        assert_eq!(Coordinate::Contraction.interval(-0.01, 0.213), "−1 to 21 %");
        assert_eq!(Coordinate::Cycle.interval(1.0, 3.0), "1 to 3");
    }
}
