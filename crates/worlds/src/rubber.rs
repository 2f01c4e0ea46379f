//! Strain energies of rubber, per reference volume, incompressible.
//!
//! ```text
//! Mooney–Rivlin  W = C10 (I1 − 3) + C01 (I2 − 3)
//! neo-Hookean    W = G/2 (I1 − 3)
//! Yeoh           W = C1 (I1 − 3) + C2 (I1 − 3)² + C3 (I1 − 3)³
//! Gent           W = −G Jm/2 ln(1 − (I1 − 3)/Jm)
//! Ogden          W = Σ μi/αi (λ1^αi + λ2^αi + λ3^αi − 3)
//! ```
//!
//! `I1`, `I2`: invariants of the right Cauchy–Green tensor; `G` shear modulus, Pa; `Jm` limit of `I1 − 3`.
//!
//! Sources: Mooney (1940), Rivlin (1948), Yeoh (1993), Gent (1996), Ogden (1972).

use crate::draw::Dice;

/// A law of rubber elasticity with its parameters, moduli in Pa.
#[derive(Debug, Clone, PartialEq)]
pub enum Rubber {
    /// `C10`, `C01`.
    MooneyRivlin(f64, f64),
    /// Shear modulus.
    NeoHookean(f64),
    /// `C1`, `C2`, `C3`.
    Yeoh(f64, f64, f64),
    /// Shear modulus and limit of `I1 − 3`.
    Gent(f64, f64),
    /// Pairs of `μ` and `α`.
    Ogden([(f64, f64); 2]),
}

impl Rubber {
    /// Draws a law for a rubber of the given shear modulus.
    pub fn draw(dice: &mut Dice, shear_modulus_pa: f64) -> Self {
        let half = 0.5 * shear_modulus_pa;
        match dice.weighted(&[4.0, 1.0, 1.0, 1.0, 1.0]) {
            0 => {
                let share = dice.uniform(0.35, 0.95);
                Self::MooneyRivlin(half * share, half * (1.0 - share))
            }
            1 => Self::NeoHookean(shear_modulus_pa),
            2 => Self::Yeoh(half, -half * dice.uniform(0.02, 0.08), half * dice.uniform(0.002, 0.01)),
            3 => Self::Gent(shear_modulus_pa, dice.uniform(12.0, 40.0)),
            _ => {
                let (soft, stiff) = (dice.uniform(1.2, 1.8), dice.uniform(4.0, 5.5));
                let share = dice.uniform(0.85, 0.98);
                // The shear modulus of Ogden's law is half of the sum of μ α.
                let first = 2.0 * shear_modulus_pa * share / soft;
                Self::Ogden([(first, soft), (2.0 * shear_modulus_pa * (1.0 - share) / stiff, stiff)])
            }
        }
    }

    /// Name, for the truth.
    pub fn name(&self) -> &'static str {
        match self {
            Self::MooneyRivlin(..) => "mooney-rivlin",
            Self::NeoHookean(..) => "neo-hookean",
            Self::Yeoh(..) => "yeoh",
            Self::Gent(..) => "gent",
            Self::Ogden(..) => "ogden",
        }
    }

    /// Energy per reference volume, J/m³, at two principal stretches; the third follows from constant volume.
    pub fn energy_j_per_m3(&self, axial: f64, hoop: f64) -> f64 {
        let through = 1.0 / (axial * hoop);
        let first = axial * axial + hoop * hoop + through * through - 3.0;
        match *self {
            Self::MooneyRivlin(c10, c01) => {
                let second = axial.powi(-2) + hoop.powi(-2) + through.powi(-2) - 3.0;
                c10 * first + c01 * second
            }
            Self::NeoHookean(modulus) => 0.5 * modulus * first,
            Self::Yeoh(c1, c2, c3) => first * (c1 + first * (c2 + first * c3)),
            Self::Gent(modulus, limit) => -0.5 * modulus * limit * (1.0 - (first / limit).min(0.99)).ln(),
            Self::Ogden(terms) => terms
                .iter()
                .map(|&(mu, alpha)| mu / alpha * (axial.powf(alpha) + hoop.powf(alpha) + through.powf(alpha) - 3.0))
                .sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_has_the_shear_modulus_it_was_drawn_for() {
        let mut dice = Dice::new(4, 4);
        for _ in 0..40 {
            let law = Rubber::draw(&mut dice, 4e5);
            // In pure shear λ, 1, 1/λ the energy is 2 G (ln λ)² to second order.
            let stretch = 0.001_f64;
            let energy = law.energy_j_per_m3(stretch.exp(), 1.0);
            let expected = 2.0 * 4e5 * stretch * stretch;
            assert!((energy / expected - 1.0).abs() < 0.01, "{law:?}: {energy} {expected}");
        }
    }

    #[test]
    fn rubber_at_rest_holds_no_energy_and_no_stress() {
        let mut dice = Dice::new(5, 5);
        for _ in 0..20 {
            let law = Rubber::draw(&mut dice, 4e5);
            assert!(law.energy_j_per_m3(1.0, 1.0).abs() < 1e-6);
            let slope = (law.energy_j_per_m3(1.0 + 1e-5, 1.0) - law.energy_j_per_m3(1.0 - 1e-5, 1.0)) / 2e-5;
            assert!(slope.abs() < 1.0, "{law:?}: {slope}");
        }
    }
}
