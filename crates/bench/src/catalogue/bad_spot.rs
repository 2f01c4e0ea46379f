//! The load cell is off over part of its range.
//!
//! ```text
//! F_read = F + A ½ [1 + cos(2π (F - F_m) / (F_b - F_a))]   for F_a < F < F_b,   F_m = (F_a + F_b) / 2
//! ```
//!
//! | symbol     | code               | unit | meaning                      |
//! |------------|--------------------|------|------------------------------|
//! | `A`        | `height_n`         | N    | how far it is off at most    |
//! | `F_a, F_b` | `from_n`, `to_n`   | N    | part of the range            |
//!
//! Source: none; a converter with a damaged segment.

use std::f64::consts::TAU;

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// A bump in the reading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BadSpot {
    height_n: f64,
    from_n: f64,
    to_n: f64,
}

impl BadSpot {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let scale = draw.force_scale();
        let middle_n = draw.ratio("middle", 130.0 * scale, 300.0 * scale, "N");
        let width_n = draw.ratio("width", 50.0 * scale, 100.0 * scale, "N");
        let sign = draw.sign();
        let height_n = draw.severe("height", 6.0 * scale * sign, 10.0 * scale * sign, "N");
        let (from_n, to_n) = (middle_n - 0.5 * width_n, middle_n + 0.5 * width_n);
        draw.at("force", from_n, to_n, "N");
        Self { height_n, from_n, to_n }
    }
}

impl Mechanism for BadSpot {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let share = (now.reading.force_n - self.from_n) / (self.to_n - self.from_n);
        if (0.0..=1.0).contains(&share) {
            now.reading.force_n += self.height_n * 0.5 * (1.0 - (TAU * share).cos());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::run;
    use crate::mechanism::{PassiveTension, Readout};

    #[test]
    fn only_readings_inside_the_spot_are_off_and_the_tension_is_not() {
        let spot = BadSpot { height_n: 8.0, from_n: 150.0, to_n: 250.0 };
        let path: Vec<(f64, f64)> = (0..500).map(|step| (f64::from(step) * 1e3, 0.25)).collect();
        let moments = run(vec![Box::new(PassiveTension), Box::new(Readout), Box::new(spot)], &path);
        let mut largest_n = 0.0_f64;
        for now in &moments {
            let (true_n, off_n) = (now.tension.total_n(), now.reading.force_n - now.tension.total_n());
            assert_eq!(off_n != 0.0, (150.0..250.0).contains(&true_n), "{true_n} {off_n}");
            largest_n = largest_n.max(off_n);
        }
        assert!((largest_n - 8.0).abs() < 0.01);
    }
}
