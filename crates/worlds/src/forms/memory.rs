//! Forms of memory in the rubber and the braid: relaxation, creep with pressure, Mullins' softening.

use super::{Built, Setting, size};
use crate::draw::Dice;
use crate::mechanism::{Mechanism, Moment};

/// What is remembered.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Driver {
    Bladder,
    Gas,
}

/// Branches of Maxwell: `F += Σ gᵢ (f − qᵢ)`, `q̇ᵢ = (f − qᵢ)/τᵢ`, each step exact for an `f` that is constant within it.
#[derive(Debug)]
struct Branches {
    driver: Driver,
    /// Weight, time constant in s, state in N.
    branches: Vec<(f64, f64, f64)>,
    started: bool,
    /// How far the branches have settled when a rested muscle is taken to where it starts.
    settled: f64,
}

impl Mechanism for Branches {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.started = false;
        }
    }

    fn added_n(&mut self, now: &Moment) -> f64 {
        let force_n = match self.driver {
            Driver::Bladder => now.bladder_n,
            Driver::Gas => now.gas_n,
        };
        if !self.started {
            self.branches.iter_mut().for_each(|branch| branch.2 = self.settled * force_n);
            self.started = true;
        }
        let mut sum_n = 0.0;
        for (weight, constant_s, state_n) in &mut self.branches {
            *state_n += (force_n - *state_n) * (1.0 - (-now.dt_s / *constant_s).exp());
            sum_n += *weight * (force_n - *state_n);
        }
        sum_n
    }
}

pub(crate) fn branches(driver: Driver, terms: &[(f64, f64)], dice: &mut Dice) -> Built {
    let settled = if dice.chance(0.5) { 1.0 } else { dice.uniform(0.3, 1.0) };
    let branches: Vec<(f64, f64, f64)> = terms.iter().map(|&(weight, constant_s)| (weight, constant_s, 0.0)).collect();
    let built = Built::one(Branches { driver, branches, started: false, settled });
    built.with("weights_together", terms.iter().map(|term| term.0).sum()).with("first_time_s", terms[0].1)
}

/// A time constant that the recordings can show, s.
pub(crate) fn shown_s(dice: &mut Dice, setting: &Setting) -> f64 {
    let longest_s = setting.durations_s.iter().copied().fold(0.0, f64::max);
    dice.log_uniform(0.5, (0.3 * longest_s).clamp(2.0, 60.0))
}

/// Equal weights over the decades, as a logarithm of time or a small fractional power needs.
fn spectrum(together: f64, tilt: f64) -> Vec<(f64, f64)> {
    let terms: Vec<(f64, f64)> =
        (-2..=6).map(|half| 10f64.powf(0.5 * f64::from(half))).map(|s| (s.powf(-tilt), s)).collect();
    let sum: f64 = terms.iter().map(|term| term.0).sum();
    terms.into_iter().map(|(weight, s)| (together * weight / sum, s)).collect()
}

/// Relaxation of one branch (Zener's standard linear solid).
pub fn relaxation_zener(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let constant_s = shown_s(dice, setting);
    branches(Driver::Bladder, &[(size(u, 0.03, 0.25), constant_s)], dice)
}

/// Relaxation of two branches.
pub fn relaxation_two_branches(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let together = size(u, 0.03, 0.25);
    let share = dice.uniform(0.35, 0.65);
    let first_s = dice.log_uniform(0.3, 2.0);
    let second_s = shown_s(dice, setting).max(5.0 * first_s);
    branches(Driver::Bladder, &[(together * share, first_s), (together * (1.0 - share), second_s)], dice)
}

/// Relaxation as a fractional power of time.
pub fn relaxation_fractional(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let tilt = dice.uniform(0.0, 0.15);
    branches(Driver::Bladder, &spectrum(size(u, 0.03, 0.25), tilt), dice)
}

/// Relaxation of Burgers' body: a branch, and a flow that goes on beyond the recording.
pub fn relaxation_burgers(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let together = size(u, 0.03, 0.25);
    let first_s = shown_s(dice, setting);
    branches(Driver::Bladder, &[(0.65 * together, first_s), (0.35 * together, 25.0 * first_s)], dice)
}

pub(crate) fn creep_size(dice: &mut Dice, u: f64) -> f64 {
    dice.sign() * size(u, 0.01, 0.05)
}

/// Creep with pressure, one exponential, of either sign.
pub fn creep_exponential(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let weight = creep_size(dice, u);
    let constant_s = shown_s(dice, setting);
    branches(Driver::Gas, &[(weight, constant_s)], dice)
}

/// Creep with pressure, with the logarithm of time, of either sign.
pub fn creep_logarithmic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let weight = creep_size(dice, u);
    branches(Driver::Gas, &spectrum(weight, 0.0), dice)
}

/// Creep with pressure, two exponentials, of either sign.
pub fn creep_two_exponentials(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let weight = creep_size(dice, u);
    let first_s = dice.log_uniform(0.3, 2.0);
    let second_s = shown_s(dice, setting).max(5.0 * first_s);
    branches(Driver::Gas, &[(0.4 * weight, first_s), (0.6 * weight, second_s)], dice)
}

/// Softening by the largest stretch of the past.
#[derive(Debug, Clone, Copy)]
enum Softening {
    /// `1 − d (1 − exp(−ε_m/ε_c))` of the largest contraction `ε_m`.
    Exponential { depth: f64, scale: f64 },
    /// `1 − erf((W_m − W)/(m + β W_m))/r`, energies over a reference.
    OgdenRoxburgh { inverse_r: f64, m: f64, beta: f64 },
    /// `1 + A exp(−N/N₀)` with the number of cycles `N`.
    Settling { excess: f64, cycles: f64 },
}

#[derive(Debug)]
struct Mullins {
    law: Softening,
    most: f64,
    /// Turning point and direction, from which cycles are counted.
    turn: f64,
    rising: bool,
    half_cycles: f64,
}

/// Contraction by which a motion must turn back to count as a reversal.
const CYCLE_TURN: f64 = 0.01;

impl Mechanism for Mullins {
    fn bladder_factor(&mut self, now: &Moment) -> f64 {
        let contraction = now.contraction.max(0.0);
        self.most = self.most.max(contraction);
        if self.rising {
            self.turn = self.turn.max(contraction);
        } else {
            self.turn = self.turn.min(contraction);
        }
        if (contraction - self.turn).abs() > CYCLE_TURN {
            self.rising = !self.rising;
            self.turn = contraction;
            self.half_cycles += 1.0;
        }
        match self.law {
            Softening::Exponential { depth, scale } => 1.0 - depth * (1.0 - (-self.most / scale).exp()),
            Softening::OgdenRoxburgh { inverse_r, m, beta } => {
                // Energy of the bladder to lowest order, over that at a contraction of a tenth.
                let (past, here) = ((self.most / 0.1).powi(2), (contraction / 0.1).powi(2));
                1.0 - inverse_r * error_function((past - here) / (m + beta * past))
            }
            Softening::Settling { excess, cycles } => 1.0 + excess * (-0.5 * self.half_cycles / cycles).exp(),
        }
    }
}

/// Error function to 1.5e-7 (Abramowitz and Stegun 7.1.26).
pub(crate) fn error_function(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let series =
        t * (0.254_829_592 + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    x.signum() * (1.0 - series * (-x * x).exp())
}

fn mullins(law: Softening, size: f64) -> Built {
    Built::one(Mullins { law, most: 0.0, turn: 0.0, rising: true, half_cycles: 0.0 }).with("depth", size)
}

/// Mullins' softening, exponential in the largest contraction.
pub fn mullins_exponential(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let depth = size(u, 0.02, 0.30);
    mullins(Softening::Exponential { depth, scale: dice.uniform(0.03, 0.10) }, depth)
}

/// Mullins' softening of Ogden and Roxburgh (1999).
pub fn mullins_ogden_roxburgh(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let inverse_r = size(u, 0.03, 0.40);
    let law = Softening::OgdenRoxburgh { inverse_r, m: dice.uniform(0.2, 0.8), beta: dice.uniform(0.0, 0.4) };
    mullins(law, inverse_r)
}

/// Softening that settles over cycles.
pub fn mullins_settling(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let excess = size(u, 0.02, 0.30);
    mullins(Softening::Settling { excess, cycles: dice.uniform(2.0, 8.0) }, excess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_branch_relaxes_to_nothing_when_held() {
        let mut branch =
            Branches { driver: Driver::Bladder, branches: vec![(0.2, 1.0, 0.0)], started: true, settled: 1.0 };
        let now = Moment { bladder_n: -50.0, dt_s: 0.01, ..Moment::default() };
        let first_n = branch.added_n(&now);
        assert!((first_n + 10.0).abs() < 0.2, "{first_n}");
        for _ in 0..2000 {
            branch.added_n(&now);
        }
        assert!(branch.added_n(&now).abs() < 1e-6);
    }

    #[test]
    fn softened_rubber_does_not_recover() {
        let law = Softening::Exponential { depth: 0.2, scale: 0.05 };
        let mut mullins = Mullins { law, most: 0.0, turn: 0.0, rising: true, half_cycles: 0.0 };
        let mut at = |contraction| mullins.bladder_factor(&Moment { contraction, ..Moment::default() });
        let virgin = at(0.05);
        at(0.15);
        assert!(at(0.05) < virgin - 0.02);
    }

    #[test]
    fn the_error_function_meets_its_table() {
        assert!((error_function(0.5) - 0.520_499_877_8).abs() < 2e-7);
        assert!((error_function(-1.0) + 0.842_700_792_9).abs() < 2e-7);
    }
}
