//! The strands jam as the braid gets flat: no pull is left for further contraction.
//!
//! ```text
//! F_l = -F_r [(ε - ε_l) / (ε_r - ε_l)]^m   for ε > ε_l,   else 0
//! ```
//!
//! | symbol | code          | unit | meaning                                       |
//! |--------|---------------|------|-----------------------------------------------|
//! | `ε_l`  | `onset`       | 1    | contraction at which strands begin to touch   |
//! | `ε_r`  | `reached`     | 1    | largest contraction of the protocols          |
//! | `F_r`  | `reached_n`   | N    | force lost there                              |
//! | `m`    | `exponent`    | 1    | yarns that are pressed flat stiffen as they go|
//!
//! Contact of strands, not of gas: it does not depend on pressure.
//!
//! Source: Davis and Caldwell (2006), International J. Robotics Research 25(4), for the limit that strand on strand
//! sets to the contraction; the power is that of compacted fibers (van Wyk, 1946).

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Resistance of jammed strands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BraidLockup {
    onset: f64,
    reached: f64,
    reached_n: f64,
    exponent: f64,
}

impl BraidLockup {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let (force, reached) = (draw.force_scale(), draw.reached_contraction());
        let onset = draw.even("onset_contraction", 0.6 * reached, 0.8 * reached, "1");
        let reached_n = draw.severe("force_at_reached_contraction", 45.0 * force, 80.0 * force, "N");
        let exponent = draw.even("exponent", 1.6, 2.6, "1");
        draw.at("contraction", onset, reached, "1");
        Self { onset, reached, reached_n, exponent }
    }
}

impl Mechanism for BraidLockup {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let beyond = muscle.muscle().contraction_ratio(now.muscle_length_m) - self.onset;
        if beyond > 0.0 {
            now.tension.beside_n -= self.reached_n * (beyond / (self.reached - self.onset)).powf(self.exponent);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::drive;

    #[test]
    fn nothing_before_the_onset_then_ever_stiffer_at_any_pressure() {
        let lockup = BraidLockup { onset: 0.15, reached: 0.21, reached_n: 60.0, exponent: 2.0 };
        let force_n = |contraction_ratio: f64, pressure_pa: f64| {
            drive(lockup.clone(), &[(pressure_pa, 0.267 * (1.0 - contraction_ratio))])[0].tension.beside_n
        };
        assert_eq!(force_n(0.149, 3e5), 0.0);
        assert!((force_n(0.21, 3e5) + 60.0).abs() < 1e-9);
        assert!((force_n(0.18, 3e5) + 15.0).abs() < 1e-9);
        assert_eq!(force_n(0.18, 0.0), force_n(0.18, 4e5));
    }
}
