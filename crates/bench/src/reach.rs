//! Where a muscle can be taken: not slack, not past its braid, not over pressure.
//!
//! The protocols are written in the numbers of a 267 mm muscle at up to 500 kPa whose braid locks at 36 %
//! contraction; another muscle gets them scaled.

use crate::true_muscle::TrueMuscle;

/// Rest length for which speeds and strokes of the protocols are written.
pub const REFERENCE_LENGTH_M: f64 = 0.267;

/// Pressure for which the protocols are written.
pub const REFERENCE_PRESSURE_PA: f64 = 500e3;

/// Largest contraction that the protocols ask for.
const REFERENCE_CONTRACTION: f64 = 0.21;

/// Share of the maximum contraction of the ideal braid that the protocols stay within.
const SHARE_OF_MAX_CONTRACTION: f64 = 0.8;

/// Stretch beyond the rest length with which triangles begin.
const REFERENCE_STRETCH: f64 = 0.005;

/// Share of the way from rest length to straight strands that a protocol may stretch a muscle.
const SHARE_OF_STRETCH: f64 = 0.2;

/// Scales protocols to a muscle and keeps them where it is taut.
#[derive(Debug, Clone, Copy)]
pub struct Reach<'a> {
    muscle: &'a TrueMuscle,
    highest_pressure_pa: f64,
    lowest_tension_n: f64,
    scale: f64,
    force_scale: f64,
}

impl<'a> Reach<'a> {
    /// Reach of `muscle` up to a pressure, with at least `lowest_tension_n` while it contracts;
    /// `-∞` lets it go slack.
    pub fn new(muscle: &'a TrueMuscle, highest_pressure_pa: f64, lowest_tension_n: f64) -> Self {
        let scale =
            (SHARE_OF_MAX_CONTRACTION * muscle.muscle().max_contraction_ratio() / REFERENCE_CONTRACTION).min(1.0);
        let nominal = TrueMuscle::nominal();
        let force_scale = muscle.force_n(highest_pressure_pa, muscle.muscle().rest_length_m, 0.0)
            / nominal.force_n(REFERENCE_PRESSURE_PA, nominal.muscle().rest_length_m, 0.0);
        Self { muscle, highest_pressure_pa, lowest_tension_n, scale, force_scale }
    }

    /// The muscle.
    pub fn muscle(&self) -> &'a TrueMuscle {
        self.muscle
    }

    /// The pressure that corresponds to `kilopascal` on the reference muscle, in Pa.
    pub fn pressure_pa(&self, kilopascal: f64) -> f64 {
        kilopascal * 1e3 * self.highest_pressure_pa / REFERENCE_PRESSURE_PA
    }

    /// The distance, or per second the speed, that corresponds to `millimeters` on the reference muscle, in m.
    pub fn distance_m(&self, millimeters: f64) -> f64 {
        millimeters * 1e-3 * self.muscle.muscle().rest_length_m / REFERENCE_LENGTH_M
    }

    /// The force that corresponds to `newtons` on the reference muscle.
    pub fn force_n(&self, newtons: f64) -> f64 {
        newtons * self.force_scale
    }

    /// The length that corresponds to a contraction of the reference muscle; stretch is kept well
    /// short of straight strands.
    pub fn length_m(&self, reference_contraction: f64) -> f64 {
        let muscle = self.muscle.muscle();
        let room = SHARE_OF_STRETCH * (muscle.strand_length_m() / muscle.rest_length_m - 1.0);
        muscle.length_m((self.scale * reference_contraction).max(-room))
    }

    /// Length at which triangles begin, slightly stretched.
    pub fn longest_m(&self) -> f64 {
        self.length_m(-REFERENCE_STRETCH)
    }

    /// Whether the muscle is taut while contracting through a state.
    pub fn is_taut(&self, pressure_pa: f64, length_m: f64) -> bool {
        self.muscle.force_n(pressure_pa, length_m, 1.0) >= self.lowest_tension_n
    }

    /// The length nearest to that of a contraction at which the muscle is still taut; none if it is slack
    /// at any.
    pub fn taut_length_m(&self, pressure_pa: f64, reference_contraction: f64) -> Option<f64> {
        let wanted_m = self.length_m(reference_contraction);
        if self.is_taut(pressure_pa, wanted_m) {
            return Some(wanted_m);
        }
        let (mut slack_m, mut taut_m) = (wanted_m, self.longest_m());
        if !self.is_taut(pressure_pa, taut_m) {
            return None;
        }
        while taut_m - slack_m > 1e-6 {
            let middle_m = 0.5 * (taut_m + slack_m);
            if self.is_taut(pressure_pa, middle_m) { taut_m = middle_m } else { slack_m = middle_m }
        }
        Some(taut_m)
    }

    /// The lowest pressure at which the muscle is taut at a length; none if it is slack at any.
    pub fn taut_pressure_pa(&self, length_m: f64) -> Option<f64> {
        if self.is_taut(0.0, length_m) {
            return Some(0.0);
        }
        let (mut slack_pa, mut taut_pa) = (0.0, self.highest_pressure_pa);
        if !self.is_taut(taut_pa, length_m) {
            return None;
        }
        while taut_pa - slack_pa > 1.0 {
            let middle_pa = 0.5 * (taut_pa + slack_pa);
            if self.is_taut(middle_pa, length_m) { taut_pa = middle_pa } else { slack_pa = middle_pa }
        }
        Some(taut_pa)
    }

    /// Highest pressure of the protocols.
    pub fn highest_pressure_pa(&self) -> f64 {
        self.highest_pressure_pa
    }
}

/// Where a rising function crosses zero between `low` and `high`, by false position after Illinois;
/// the nearer end if it does not.
pub(crate) fn rising_root(function: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut below, mut above) = (function(low), function(high));
    if below >= 0.0 {
        return low;
    }
    if above <= 0.0 {
        return high;
    }
    let mut last_side = 0;
    for _ in 0..100 {
        let middle = (low * above - high * below) / (above - below);
        let value = function(middle);
        if value.abs() < 1e-9 || high - low < 1e-12 * high.abs() {
            return middle;
        }
        if value < 0.0 {
            (low, below) = (middle, value);
            if last_side == -1 {
                above *= 0.5;
            }
            last_side = -1;
        } else {
            (high, above) = (middle, value);
            if last_side == 1 {
                below *= 0.5;
            }
            last_side = 1;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_muscle_gets_the_numbers_as_written() {
        let muscle = TrueMuscle::nominal();
        let reach = Reach::new(&muscle, REFERENCE_PRESSURE_PA, 5.0);
        assert!((reach.length_m(0.2) - 0.8 * 0.267).abs() < 1e-12);
        assert!((reach.distance_m(5.0) - 5e-3).abs() < 1e-15);
        assert!((reach.pressure_pa(300.0) - 300e3).abs() < 1e-9);
        assert!((reach.force_n(20.0) - 20.0).abs() < 1e-9);
    }

    #[test]
    fn the_edge_of_tautness_has_the_lowest_tension() {
        let muscle = TrueMuscle::nominal();
        let reach = Reach::new(&muscle, REFERENCE_PRESSURE_PA, 5.0);
        let pressure_pa = reach.taut_pressure_pa(0.24).unwrap();
        assert!((muscle.force_n(pressure_pa, 0.24, 1.0) - 5.0).abs() < 0.01);
        let length_m = reach.taut_length_m(60e3, 0.21).unwrap();
        assert!((muscle.force_n(60e3, length_m, 1.0) - 5.0).abs() < 0.01);
    }

    #[test]
    fn a_root_is_found_to_rounding() {
        let root = rising_root(|x| x * x * x - 2.0, 0.0, 5.0);
        assert!((root - 2.0_f64.cbrt()).abs() < 1e-9);
    }
}
