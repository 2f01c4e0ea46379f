//! Memory of rubber and braid: hysteresis of the rubber, relaxation, creep with pressure, Mullins' softening.

use std::f64::consts::PI;

use crate::draw::Dice;
use crate::forms::friction::rubber;
use crate::forms::memory::{Driver, branches, creep_size, shown_s};
use crate::forms::{Built, Setting, size};
use crate::friction::Element;
use crate::mechanism::{Mechanism, Moment};

/// Friction in rubber after Berg: from each reversal at `(x_s, z_s)` a hyperbola towards sliding,
/// `z = z_s + d (s − z_s)/(x₂ (1 − s z_s) + d)` with `d = |x − x_s|` and the direction `s`.
#[derive(Debug)]
struct Berg {
    /// Travel from the middle of the loop to half of sliding, m.
    half_m: f64,
    size_n: f64,
    last_m: Option<f64>,
    direction: f64,
    since_m: f64,
    turned_at: f64,
    state: f64,
}

impl Mechanism for Berg {
    fn begin(&mut self, _recording: usize, rested: bool) {
        self.last_m = None;
        if rested {
            (self.direction, self.since_m, self.turned_at, self.state) = (0.0, 0.0, 0.0, 0.0);
        }
    }

    fn added_n(&mut self, now: &Moment) -> f64 {
        let travel_m = self.last_m.map_or(0.0, |last_m| last_m - now.length_m);
        self.last_m = Some(now.length_m);
        if travel_m != 0.0 {
            if travel_m.signum() != self.direction {
                (self.direction, self.since_m, self.turned_at) = (travel_m.signum(), 0.0, self.state);
            }
            self.since_m += travel_m.abs();
            let left = 1.0 - self.direction * self.turned_at;
            let share = self.since_m / (self.half_m * left.max(1e-9) + self.since_m);
            self.state = self.turned_at + (self.direction - self.turned_at) * share;
        }
        -self.state * self.size_n
    }
}

/// Rubber hysteresis of constant size along Berg's hyperbolas (1998).
pub fn rubber_berg(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (half_m, size_n) = (dice.log_uniform(3e-4, 2e-3), size(u, 0.03, 0.20) * setting.bladder_n);
    Built::one(Berg { half_m, size_n, last_m: None, direction: 0.0, since_m: 0.0, turned_at: 0.0, state: 0.0 })
        .with("size_n", size_n)
        .with("half_mm", 1e3 * half_m)
}

/// Rubber hysteresis of a triboelastic solid: stress as the root of the strain since a reversal (Turner 1988).
pub fn rubber_triboelastic(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let longest_m = dice.log_uniform(3e-3, 1e-2);
    // Slip at reach r with a weight of √r per decade sums to a root: W(r) = −r f''(r) of f = √r.
    let reaches: Vec<f64> = (0..9).map(|index| longest_m * 2f64.powi(-index)).collect();
    let weights: Vec<f64> = reaches.iter().map(|reach_m| reach_m.sqrt()).collect();
    rubber(Element::slip(&reaches, &weights, 0.0), size(u, 0.03, 0.20) * setting.bladder_n, 0.0)
        .with("longest_mm", 1e3 * longest_m)
}

/// Relaxation as a stretched exponential `exp(−√(t/τ))` (Kohlrausch), whose spectrum is `√u e^(−u/4)/(2 √π)` at `u = s/τ`.
pub fn relaxation_stretched(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (together, constant_s) = (size(u, 0.03, 0.25), shown_s(dice, setting));
    branches(Driver::Bladder, &kohlrausch(together, constant_s), dice)
}

/// Weights and time constants, s, of a stretched exponential with exponent a half.
fn kohlrausch(together: f64, constant_s: f64) -> Vec<(f64, f64)> {
    let terms: Vec<(f64, f64)> = (0..12)
        .map(|index| {
            let u = 1e-3 * 2.5_f64.powi(index);
            (u.sqrt() * (-0.25 * u).exp() / (2.0 * PI.sqrt()), u * constant_s)
        })
        .collect();
    let sum: f64 = terms.iter().map(|term| term.0).sum();
    terms.into_iter().map(|(weight, s)| (together * weight / sum, s)).collect()
}

/// How a dashpot flows under the force on it.
#[derive(Debug, Clone, Copy)]
enum Flow {
    /// In proportion to a power of it.
    Power(f64),
    /// As its hyperbolic sine.
    Sinh,
}

/// One branch with a dashpot that is not linear: `F += g (f − q)`, `q̇ = (f − q)/τ · φ(|f − q|/f_r)`.
#[derive(Debug)]
struct Dashpot {
    driver: Driver,
    flow: Flow,
    weight: f64,
    constant_s: f64,
    reference_n: f64,
    /// State, N; none before the first step.
    state_n: Option<f64>,
    settled: f64,
}

impl Mechanism for Dashpot {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.state_n = None;
        }
    }

    fn added_n(&mut self, now: &Moment) -> f64 {
        let force_n = match self.driver {
            Driver::Bladder => now.bladder_n,
            Driver::Gas => now.gas_n,
        };
        let state_n = self.state_n.unwrap_or(self.settled * force_n);
        let load = ((force_n - state_n) / self.reference_n).abs();
        let faster = match self.flow {
            Flow::Power(exponent) => load.powf(exponent - 1.0),
            Flow::Sinh => {
                let load = load.clamp(1e-6, 6.0);
                load.sinh() / load
            }
        };
        let next_n = state_n + (force_n - state_n) * (1.0 - (-now.dt_s / self.constant_s * faster).exp());
        self.state_n = Some(next_n);
        self.weight * (force_n - next_n)
    }
}

fn dashpot(driver: Driver, flow: Flow, weight: f64, reference_n: f64, dice: &mut Dice, setting: &Setting) -> Built {
    let constant_s = shown_s(dice, setting);
    let settled = if dice.chance(0.5) { 1.0 } else { dice.uniform(0.3, 1.0) };
    Built::one(Dashpot { driver, flow, weight, constant_s, reference_n, state_n: None, settled })
        .with("weight", weight)
        .with("time_s", constant_s)
        .with("reference_n", reference_n)
}

/// Relaxation of a branch whose chains creep by a power of the overstress (Bergström and Boyce 1998).
pub fn relaxation_power_flow(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (exponent, share) = (dice.uniform(2.0, 4.0), dice.uniform(0.2, 0.5));
    let weight = size(u, 0.03, 0.25);
    dashpot(Driver::Bladder, Flow::Power(exponent), weight, share * setting.bladder_n, dice, setting)
        .with("exponent", exponent)
}

/// Creep with pressure after Andrade: a cubic root of time, of either sign.
pub fn creep_andrade(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let weight = creep_size(dice, u);
    let terms: Vec<(f64, f64)> =
        (-2..=6).map(|half| 10f64.powf(0.5 * f64::from(half))).map(|s| (s.cbrt(), s)).collect();
    let sum: f64 = terms.iter().map(|term| term.0).sum();
    let terms: Vec<(f64, f64)> = terms.into_iter().map(|(part, s)| (weight * part / sum, s)).collect();
    branches(Driver::Gas, &terms, dice)
}

/// Creep with pressure of an activated flow (Krausz and Eyring 1975): faster after large steps; of either sign.
pub fn creep_activated(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let weight = creep_size(dice, u);
    let reference_n = dice.uniform(0.08, 0.25) * setting.forces_n.1.max(50.0);
    dashpot(Driver::Gas, Flow::Sinh, weight, reference_n, dice, setting)
}

/// Softening by the largest energy of the past.
#[derive(Debug, Clone, Copy)]
enum Damage {
    /// Simo (1987): `1 − d (1 − (1 − e^(−x))/x)`, `x = √(W_m/W_r)/α`.
    Simo { depth: f64, alpha: f64 },
    /// Dorfmann and Ogden (2003): `1 − tanh((W_m − W)/(m W_r))/r`.
    Tanh { inverse_r: f64, m: f64 },
}

/// The bladder's energy is the work that its length has done on it; `W_r` is that at the most contraction of the plan.
#[derive(Debug)]
struct Softening {
    law: Damage,
    reference_j: f64,
    energy_j: f64,
    most_j: f64,
    last: Option<(f64, f64)>,
}

impl Mechanism for Softening {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.last = None;
        }
    }

    fn bladder_factor(&mut self, now: &Moment) -> f64 {
        self.energy_j = match self.last {
            Some((length_m, bladder_n)) => {
                self.energy_j + 0.5 * (bladder_n + now.bladder_n) * (now.length_m - length_m)
            }
            // As a spring would hold it.
            None => 0.5 * (now.bladder_n * now.contraction * now.length_m / (1.0 - now.contraction)).abs(),
        };
        self.last = Some((now.length_m, now.bladder_n));
        self.most_j = self.most_j.max(self.energy_j);
        match self.law {
            Damage::Simo { depth, alpha } => {
                let x = (self.most_j / self.reference_j).max(1e-12).sqrt() / alpha;
                1.0 - depth * (1.0 + (-x).exp_m1() / x)
            }
            Damage::Tanh { inverse_r, m } => {
                1.0 - inverse_r * ((self.most_j - self.energy_j).max(0.0) / (m * self.reference_j)).tanh()
            }
        }
    }
}

fn softening(law: Damage, depth: f64, setting: &Setting) -> Built {
    let stroke_m = (setting.contractions.1 - setting.contractions.0) * setting.muscle.rest_length_m;
    let reference_j = 0.5 * setting.bladder_n * stroke_m;
    Built::one(Softening { law, reference_j, energy_j: 0.0, most_j: 0.0, last: None }).with("depth", depth)
}

/// Mullins' softening as a damage of the largest energy.
pub fn mullins_simo(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let depth = size(u, 0.03, 0.40);
    softening(Damage::Simo { depth, alpha: dice.uniform(0.25, 0.6) }, depth, setting)
}

/// Mullins' softening that unloads along a hyperbolic tangent.
pub fn mullins_tanh(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let inverse_r = size(u, 0.03, 0.40);
    softening(Damage::Tanh { inverse_r, m: dice.uniform(0.15, 0.5) }, inverse_r, setting)
}

#[cfg(test)]
mod tests;
