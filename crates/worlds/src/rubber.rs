//! Strain energies of rubber, per reference volume, incompressible.
//!
//! ```text
//! Mooney–Rivlin  W = C10 (I1 − 3) + C01 (I2 − 3)
//! neo-Hookean    W = G/2 (I1 − 3)
//! Yeoh           W = C1 (I1 − 3) + C2 (I1 − 3)² + C3 (I1 − 3)³
//! Gent           W = −G Jm/2 ln(1 − (I1 − 3)/Jm)
//! Ogden          W = Σ μi/αi (λ1^αi + λ2^αi + λ3^αi − 3)
//! Arruda–Boyce   W = μ Σ Ci/N^(i−1) (I1^i − 3^i),   C = 1/2, 1/20, 11/1050, 19/7000, 519/673750
//! Gent–Gent      W = −C1 Jm ln(1 − (I1 − 3)/Jm) + C2 ln(I2/3)
//! Lopez-Pamies   W = Σ 3^(1−αi)/(2 αi) μi (I1^αi − 3^αi)
//! Carroll        W = A (I1 − 3) + B (I1⁴ − 81) + C (√I2 − √3)
//! Fung           W = G/(2 b) (exp(b (I1 − 3)) − 1)
//! ```
//!
//! `I1`, `I2`: invariants of the right Cauchy–Green tensor; `G` shear modulus, Pa; `Jm` limit of `I1 − 3`; `N` links of a chain.
//!
//! Sources: Mooney (1940), Rivlin (1948), Yeoh (1993), Gent (1996), Ogden (1972); Arruda and Boyce (1993); Pucci and Saccomandi
//! (2002), Gent's law with Gent and Thomas' second term; Lopez-Pamies (2010); Carroll (2011); Fung (1967).

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
    /// Pairs of `μ` and `α`, one of them negative.
    OgdenThree([(f64, f64); 3]),
    /// `μ` and the links `N` of a chain.
    ArrudaBoyce(f64, f64),
    /// `C1`, `C2` and limit of `I1 − 3`.
    GentGent(f64, f64, f64),
    /// Pairs of `μ` and `α`.
    LopezPamies([(f64, f64); 2]),
    /// `A`, `B`, `C`.
    Carroll(f64, f64, f64),
    /// Shear modulus and exponent.
    Fung(f64, f64),
}

/// Factors of the series of Arruda and Boyce.
const CHAIN: [f64; 5] = [1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];

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

    /// Draws a law of the third part for a rubber of the given shear modulus.
    pub fn draw_sealed(dice: &mut Dice, shear_modulus_pa: f64) -> Self {
        let modulus = shear_modulus_pa;
        match dice.weighted(&[1.0; 6]) {
            0 => {
                let links = dice.uniform(6.0, 25.0);
                // Shear modulus of the series: twice its slope with I1 at rest.
                let slope: f64 = CHAIN.iter().zip(1..).map(|(c, i)| c * f64::from(i) * (3.0 / links).powi(i - 1)).sum();
                Self::ArrudaBoyce(modulus / (2.0 * slope), links)
            }
            1 => {
                let share = dice.uniform(0.6, 0.9);
                // G = 2 C1 + 2 C2/3.
                Self::GentGent(0.5 * modulus * share, 1.5 * modulus * (1.0 - share), dice.uniform(15.0, 60.0))
            }
            2 => {
                let share = dice.uniform(0.7, 0.95);
                let (slow, fast) = (dice.uniform(0.5, 0.9), dice.uniform(1.5, 2.8));
                Self::LopezPamies([(modulus * share, slow), (modulus * (1.0 - share), fast)])
            }
            3 => {
                let (stiffening, second) = (dice.uniform(0.01, 0.06), dice.uniform(0.1, 0.4));
                // G = 2 (A + 108 B) + C/√3.
                let b = 0.5 * modulus * stiffening / 108.0;
                let c = modulus * second * 3f64.sqrt();
                Self::Carroll(0.5 * modulus * (1.0 - stiffening - second), b, c)
            }
            4 => Self::Fung(modulus, dice.uniform(0.03, 0.15)),
            _ => {
                let (soft, stiff, other) = (dice.uniform(1.1, 1.6), dice.uniform(5.5, 7.5), -dice.uniform(1.5, 2.5));
                let (of_stiff, of_other) = (dice.uniform(0.01, 0.05), dice.uniform(0.03, 0.12));
                let part = |share: f64, alpha: f64| (2.0 * modulus * share / alpha, alpha);
                Self::OgdenThree([part(1.0 - of_stiff - of_other, soft), part(of_stiff, stiff), part(of_other, other)])
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
            Self::OgdenThree(..) => "ogden-three-terms",
            Self::ArrudaBoyce(..) => "arruda-boyce",
            Self::GentGent(..) => "gent-gent",
            Self::LopezPamies(..) => "lopez-pamies",
            Self::Carroll(..) => "carroll",
            Self::Fung(..) => "fung",
        }
    }

    /// Energy per reference volume, J/m³, at two principal stretches; the third follows from constant volume.
    pub fn energy_j_per_m3(&self, axial: f64, hoop: f64) -> f64 {
        let through = 1.0 / (axial * hoop);
        let first = axial * axial + hoop * hoop + through * through - 3.0;
        let ogden = |terms: &[(f64, f64)]| -> f64 {
            terms
                .iter()
                .map(|&(mu, alpha)| mu / alpha * (axial.powf(alpha) + hoop.powf(alpha) + through.powf(alpha) - 3.0))
                .sum()
        };
        let second = || axial.powi(-2) + hoop.powi(-2) + through.powi(-2);
        match *self {
            Self::MooneyRivlin(c10, c01) => {
                let second = axial.powi(-2) + hoop.powi(-2) + through.powi(-2) - 3.0;
                c10 * first + c01 * second
            }
            Self::NeoHookean(modulus) => 0.5 * modulus * first,
            Self::Yeoh(c1, c2, c3) => first * (c1 + first * (c2 + first * c3)),
            Self::Gent(modulus, limit) => -0.5 * modulus * limit * (1.0 - (first / limit).min(0.99)).ln(),
            Self::Ogden(terms) => ogden(&terms),
            Self::OgdenThree(terms) => ogden(&terms),
            Self::ArrudaBoyce(mu, links) => {
                let i1 = first + 3.0;
                let terms = CHAIN.iter().zip(1..);
                mu * terms.map(|(c, i)| c / links.powi(i - 1) * (i1.powi(i) - 3f64.powi(i))).sum::<f64>()
            }
            Self::GentGent(c1, c2, limit) => {
                -c1 * limit * (1.0 - (first / limit).min(0.99)).ln() + c2 * (second() / 3.0).ln()
            }
            Self::LopezPamies(terms) => terms
                .iter()
                .map(|&(mu, alpha)| {
                    3f64.powf(1.0 - alpha) / (2.0 * alpha) * mu * ((first + 3.0).powf(alpha) - 3f64.powf(alpha))
                })
                .sum(),
            Self::Carroll(a, b, c) => {
                a * first + b * ((first + 3.0).powi(4) - 81.0) + c * (second().sqrt() - 3f64.sqrt())
            }
            Self::Fung(modulus, exponent) => 0.5 * modulus / exponent * (exponent * first).exp_m1(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_has_the_shear_modulus_it_was_drawn_for() {
        let mut dice = Dice::new(4, 4);
        for draw in 0..100 {
            let law = if draw < 40 { Rubber::draw(&mut dice, 4e5) } else { Rubber::draw_sealed(&mut dice, 4e5) };
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
        for draw in 0..60 {
            let law = if draw < 20 { Rubber::draw(&mut dice, 4e5) } else { Rubber::draw_sealed(&mut dice, 4e5) };
            assert!(law.energy_j_per_m3(1.0, 1.0).abs() < 1e-6);
            let slope = (law.energy_j_per_m3(1.0 + 1e-5, 1.0) - law.energy_j_per_m3(1.0 - 1e-5, 1.0)) / 2e-5;
            assert!(slope.abs() < 1.0, "{law:?}: {slope}");
        }
    }
}
