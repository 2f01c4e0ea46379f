//! Creep of the braid under pressure: the gas force of a fresh inflation fades with the logarithm of time.
//!
//! ```text
//! F_c = (dF_gas/dp) ∫ (dp/dt') B [ln(t_∞ / t_0) - ln(1 + (t - t') / t_0)] dt'
//! ln(1 + t / t_0) = ∫ (1 - e^{-t/τ}) e^{-t_0/τ} d(ln τ)
//! ```
//!
//! | symbol      | code               | unit | meaning                                          |
//! |-------------|--------------------|------|--------------------------------------------------|
//! | `dF_gas/dp` | `gas_n_per_pa()`   | N/Pa | force that one pascal makes at the length        |
//! | `B`         | `per_e_fold`       | 1    | share that is lost with each e-fold of time      |
//! | `t_0`       | `onset_s`          | s    | time after which creep is logarithmic            |
//! | `t_∞`       | `LONGEST_S`        | s    | time after which it has ended                    |
//!
//! The second line turns the kernel into a ladder of times whose weights are `B e^{-t_0/τ}`. Driven by the pressure
//! alone: a step of length leaves it.
//!
//! Source: Findley, Lai and Onaran (1976), "Creep and Relaxation of Nonlinear Viscoelastic Materials", for
//! hereditary integrals.

use crate::draw::Draw;
use crate::mechanism::spectrum::Spectrum;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Longest time of the ladder.
const LONGEST_S: f64 = 3000.0;

/// Shortest time of the ladder over the onset; below it the weights vanish.
const SHORTEST: f64 = 0.1;

/// Fading of the gas force after an inflation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PressureCreep {
    fresh_pa: Spectrum,
}

impl PressureCreep {
    pub(crate) fn new(per_e_fold: f64, onset_s: f64) -> Self {
        let weight = |time_s: f64| per_e_fold * Spectrum::log_width() * (-onset_s / time_s).exp();
        Self { fresh_pa: Spectrum::new(SHORTEST * onset_s, LONGEST_S, weight) }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let per_e_fold = draw.severe("loss_per_e_fold", 0.005, 0.009, "1");
        let onset_s = draw.ratio("onset", 0.1, 0.6, "s");
        draw.at("time_since_last_move", 0.0, 60.0, "s");
        Self::new(per_e_fold, onset_s)
    }
}

impl Mechanism for PressureCreep {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let fresh_pa = self.fresh_pa.follow(now.muscle_pressure_pa, now.step_s);
        now.tension.beside_n += fresh_pa * muscle.gas_n_per_pa(now.muscle_length_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    #[test]
    fn an_inflation_fades_as_the_logarithm_of_time() {
        let mut path = vec![(1e5, 0.25)];
        go(&mut path, 4e5, 0.25, 1);
        go(&mut path, 4e5, 0.25, 64_000);
        let moments = drive(PressureCreep::new(0.006, 0.1), &path);
        let at = |time_s: f64| moments[(time_s * 1e3) as usize].tension.beside_n;
        let step_n = 3e5 * TrueMuscle::nominal().gas_n_per_pa(0.25);
        let fourfold_n = 0.006 * 4.0_f64.ln() * step_n;
        assert!(((at(4.0) - at(16.0)) / fourfold_n - 1.0).abs() < 0.04);
        assert!(((at(16.0) - at(64.0)) / fourfold_n - 1.0).abs() < 0.04);
    }

    #[test]
    fn a_deflation_recovers_with_the_other_sign_and_a_step_of_length_leaves_it() {
        let mut path = vec![(4e5, 0.25)];
        go(&mut path, 1e5, 0.25, 1);
        go(&mut path, 1e5, 0.25, 100);
        assert!(drive(PressureCreep::new(0.006, 0.1), &path)[100].tension.beside_n < 0.0);
        let mut path = vec![(4e5, 0.25)];
        go(&mut path, 4e5, 0.24, 10);
        assert!(drive(PressureCreep::new(0.006, 0.1), &path).iter().all(|now| now.tension.beside_n == 0.0));
    }
}
