//! A smooth error of the form, which has no name: what any model leaves of a real muscle.
//!
//! ```text
//! F_m = Σ a_ij P_i(p̂) P_j(ε̂)  +  b cos(ω (p̂ cos φ + ε̂ sin φ) + ψ),   2 ≤ i + j ≤ 3
//! ```
//!
//! | symbol | code        | unit | meaning                                                           |
//! |--------|-------------|------|-------------------------------------------------------------------|
//! | `p̂, ε̂` | `p`, `e`    | 1    | pressure and contraction, from -1 to 1 over the reach of a muscle |
//! | `P_i`  | `legendre()`| 1    | Legendre polynomials                                              |
//! | `ω`    | `turn_rad`  | rad  | half a turn to a whole one from middle to edge                    |
//!
//! Coefficients are drawn, and scaled to a root mean square over the reach, so that all recordings of a muscle have the same error.

use std::f64::consts::PI;

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::path::Command;
use crate::reach::REFERENCE_PRESSURE_PA;
use crate::true_muscle::TrueMuscle;

/// Points of the grid in each direction over which the mean is taken.
const GRID: usize = 41;

/// A smooth function of pressure and contraction.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SmoothMisfit {
    reached: f64,
    polynomial_n: Vec<(usize, usize, f64)>,
    wave_n: f64,
    turn_rad: f64,
    heading_rad: f64,
    phase_rad: f64,
}

impl SmoothMisfit {
    pub(crate) fn draw(rms_n: f64, seed: u64, muscle: &TrueMuscle, command: &Command) -> Self {
        let mut draw = Draw::new("smooth-misfit", 1.0, seed, muscle, command);
        let mut polynomial_n = Vec::new();
        for i in 0..=3 {
            for j in (0..=3 - i).filter(|j| i + j >= 2) {
                polynomial_n.push((i, j, draw.normal()));
            }
        }
        let mut misfit = Self {
            reached: draw.reached_contraction(),
            polynomial_n,
            wave_n: 1.5 * draw.normal(),
            turn_rad: draw.even("turn", PI, 2.0 * PI, "rad"),
            heading_rad: draw.even("heading", 0.0, PI, "rad"),
            phase_rad: draw.even("phase", 0.0, 2.0 * PI, "rad"),
        };
        let scale = rms_n / misfit.rms_n();
        misfit.polynomial_n.iter_mut().for_each(|(_, _, amplitude_n)| *amplitude_n *= scale);
        misfit.wave_n *= scale;
        misfit
    }

    /// Root mean square over the reach.
    fn rms_n(&self) -> f64 {
        let at = |index: usize| 2.0 * index as f64 / (GRID - 1) as f64 - 1.0;
        let points = (0..GRID * GRID).map(|index| self.force_n(at(index / GRID), at(index % GRID)));
        (points.map(|force_n| force_n * force_n).sum::<f64>() / (GRID * GRID) as f64).sqrt()
    }

    fn force_n(&self, p: f64, e: f64) -> f64 {
        let polynomial_n: f64 =
            self.polynomial_n.iter().map(|(i, j, amplitude_n)| amplitude_n * legendre(*i, p) * legendre(*j, e)).sum();
        let along = p * self.heading_rad.cos() + e * self.heading_rad.sin();
        polynomial_n + self.wave_n * (self.turn_rad * along + self.phase_rad).cos()
    }
}

/// `P_i(x)`, up to the third.
fn legendre(order: usize, x: f64) -> f64 {
    match order {
        0 => 1.0,
        1 => x,
        2 => 1.5 * x * x - 0.5,
        _ => 2.5 * x * x * x - 1.5 * x,
    }
}

impl Mechanism for SmoothMisfit {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let p = 2.0 * now.muscle_pressure_pa / REFERENCE_PRESSURE_PA - 1.0;
        let e = 2.0 * muscle.muscle().contraction_ratio(now.muscle_length_m) / self.reached - 1.0;
        now.tension.beside_n += self.force_n(p, e);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{Options, command};

    fn misfit(rms_n: f64, protocol: &str, seed: u64) -> SmoothMisfit {
        let muscle = TrueMuscle::nominal();
        let command = command(protocol, &muscle, &Options::default()).unwrap();
        SmoothMisfit::draw(rms_n, seed, &muscle, &command)
    }

    #[test]
    fn it_is_as_large_as_asked_for_and_the_same_in_every_protocol() {
        assert!((misfit(0.4, "lift", 3).rms_n() - 0.4).abs() < 1e-12);
        assert_eq!(misfit(0.4, "lift", 3), misfit(0.4, "multisine", 3));
        assert_ne!(misfit(0.4, "lift", 3), misfit(0.4, "lift", 4));
    }
}
