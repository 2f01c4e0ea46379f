//! Friction: pre-sliding, Stribeck, damping, rate and load dependence.

use crate::draw::Dice;
use crate::forms::friction::presliding;
use crate::forms::{Built, Setting, size};
use crate::friction::Element;
use crate::mechanism::{Mechanism, Moment};
use crate::shape::Shape;

fn shaped(u: f64, shape: Shape) -> Built {
    let reach_m = size(u, 2e-4, 5e-3);
    presliding(Element::Shaped { shape, reach_m, state: 0.0 }, reach_m)
}

/// Pre-sliding by Valanis' endochronic law, with a sharper knee than Dahl's.
pub fn presliding_endochronic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let kappa = dice.uniform(0.4, 0.85);
    shaped(u, Shape::Endochronic(kappa)).with("kappa", kappa)
}

/// Pre-sliding that is elastic up to a breakaway (Dupont et al. 2002).
pub fn presliding_elasto_plastic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let breakaway = dice.uniform(0.3, 0.8);
    shaped(u, Shape::ElastoPlastic(breakaway)).with("breakaway", breakaway)
}

/// Pre-sliding by Dahl's law with an exponent: brittle below 1, ductile above.
pub fn presliding_power(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let exponent = if dice.chance(0.5) { dice.uniform(0.4, 0.7) } else { dice.uniform(1.4, 1.9) };
    shaped(u, Shape::Power(exponent)).with("exponent", exponent)
}

/// How friction grows towards rest, as a share of its excess.
#[derive(Debug, Clone, Copy)]
enum Towards {
    /// `1/cosh(v/v_s)`.
    Secant,
    /// `exp(−(v/v_s)^δ)` with `δ` below 1.
    Stretched(f64),
    /// `exp(−(w/v_s)²)` of a speed `w` that follows with this time constant, s.
    Lagged(f64),
}

#[derive(Debug)]
struct Stribeck {
    law: Towards,
    excess: f64,
    speed_m_per_s: f64,
    followed_m_per_s: f64,
}

impl Mechanism for Stribeck {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s.abs();
        let share = match self.law {
            Towards::Secant => 1.0 / (speed / self.speed_m_per_s).min(300.0).cosh(),
            Towards::Stretched(exponent) => (-(speed / self.speed_m_per_s).powf(exponent)).exp(),
            Towards::Lagged(constant_s) => {
                self.followed_m_per_s += (speed - self.followed_m_per_s) * (1.0 - (-now.dt_s / constant_s).exp());
                (-(self.followed_m_per_s / self.speed_m_per_s).powi(2)).exp()
            }
        };
        1.0 + self.excess * share
    }
}

fn stribeck(law: Towards, dice: &mut Dice, u: f64) -> Built {
    let excess = size(u, 0.1, 1.0);
    let speed_m_per_s = dice.log_uniform(1e-3, 2e-2);
    // Where a fifth of the excess is left.
    let reach = match law {
        Towards::Secant => 5f64.acosh(),
        Towards::Stretched(exponent) => 5f64.ln().powf(1.0 / exponent),
        Towards::Lagged(_) => 5f64.ln().sqrt(),
    };
    Built::one(Stribeck { law, excess, speed_m_per_s, followed_m_per_s: 0.0 })
        .with("excess", excess)
        .with("speed_mm_per_s", 1e3 * speed_m_per_s)
        .at("speed_mm_per_s", 0.0, 1e3 * reach * speed_m_per_s)
}

/// Stribeck's rise as a hyperbolic secant.
pub fn stribeck_secant(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    stribeck(Towards::Secant, dice, u)
}

/// Stribeck's rise as a stretched exponential (Bo and Pavelescu 1982), whose exponent is a half to 1.
pub fn stribeck_stretched(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let exponent = dice.uniform(0.5, 0.75);
    stribeck(Towards::Stretched(exponent), dice, u).with("exponent", exponent)
}

/// Stribeck's rise by a speed that is some milliseconds old (frictional memory: Hess and Soom 1990; Armstrong-Hélouvry 1991).
pub fn stribeck_lagged(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let constant_s = dice.log_uniform(0.004, 0.04);
    stribeck(Towards::Lagged(constant_s), dice, u).with("memory_s", constant_s)
}

/// Damping with a coefficient that falls with speed, or grows as the wall shortens.
#[derive(Debug)]
struct Damping {
    n_s_per_m: f64,
    /// Speed in m/s and exponent of Carreau's law; none for a Newtonian wall.
    thinning: Option<(f64, f64)>,
    rest_m: f64,
}

impl Mechanism for Damping {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s;
        let factor = match self.thinning {
            Some((speed_m_per_s, exponent)) => (1.0 + (speed / speed_m_per_s).powi(2)).powf(0.5 * (exponent - 1.0)),
            None => (self.rest_m / now.length_m).powi(2),
        };
        -self.n_s_per_m * factor * speed
    }
}

fn damping(u: f64, thinning: Option<(f64, f64)>, setting: &Setting) -> Built {
    let n_s_per_m = size(u, 20.0, 500.0);
    Built::one(Damping { n_s_per_m, thinning, rest_m: setting.muscle.rest_length_m })
        .with("damping_n_s_per_m", n_s_per_m)
}

/// Damping of a film that thins under shear (Carreau 1972).
pub fn viscous_carreau(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (speed_m_per_s, exponent) = (dice.log_uniform(8e-3, 4e-2), dice.uniform(0.3, 0.7));
    damping(u, Some((speed_m_per_s, exponent)), setting)
        .with("exponent", exponent)
        .with("speed_mm_per_s", 1e3 * speed_m_per_s)
}

/// Damping of a Newtonian wall of constant volume `V`: `3 η V v/L²` (Trouton 1906).
pub fn viscous_wall(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    damping(u, None, setting)
}

/// Friction with a rate and a state that follows over slip: `1 + a y − b y_s`, `y = ln(1 + v/v₀)`, `dy_s/dx = (y − y_s)/D`.
#[derive(Debug)]
struct RateState {
    rate: f64,
    state_share: f64,
    speed_m_per_s: f64,
    slip_m: f64,
    followed: f64,
}

impl Mechanism for RateState {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s.abs();
        let y = (speed / self.speed_m_per_s).ln_1p();
        self.followed += (y - self.followed) * (1.0 - (-speed * now.dt_s / self.slip_m).exp());
        1.0 + self.rate * (y - self.state_share * self.followed)
    }
}

/// Friction of rate and state by the slip law (Ruina 1983), which strengthens by 2 to 15 % per factor e.
pub fn rate_state(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let together = size(u, 0.02, 0.15);
    let state_share = dice.uniform(0.2, 0.5);
    let (speed_m_per_s, slip_m) = (dice.log_uniform(1e-4, 1e-3), dice.log_uniform(1e-4, 1e-3));
    let rate = together / (1.0 - state_share);
    Built::one(RateState { rate, state_share, speed_m_per_s, slip_m, followed: 0.0 })
        .with("per_e_fold", together)
        .with("speed_mm_per_s", 1e3 * speed_m_per_s)
        .with("slip_mm", 1e3 * slip_m)
}

/// Friction that grows with the rate until it saturates: `1 + s v/(v + v_h)`.
#[derive(Debug)]
struct Saturating {
    gain: f64,
    half_m_per_s: f64,
}

impl Mechanism for Saturating {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s.abs();
        1.0 + self.gain * speed / (speed + self.half_m_per_s)
    }
}

/// Rate dependence that saturates: loops 10 to 40 % wider over two decades (Azuwan and Yamamoto 2019).
pub fn rate_saturating(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (gain, half_m_per_s) = (size(u, 0.1, 0.45), dice.log_uniform(1e-3, 6e-3));
    Built::one(Saturating { gain, half_m_per_s }).with("gain", gain).with("half_mm_per_s", 1e3 * half_m_per_s)
}

/// Friction by the pull: a power of it, or a rope that is wound further as the muscle contracts.
#[derive(Debug)]
enum Load {
    /// Coefficient and reference force, N.
    Contacts(f64, f64),
    /// Coefficient times angle, least and most contraction.
    Wound(f64, (f64, f64)),
}

impl Mechanism for Load {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let pull_n = now.force_n.max(0.0);
        match *self {
            Self::Contacts(coefficient, reference_n) => {
                -coefficient * reference_n * (pull_n / reference_n).powf(2.0 / 3.0) * now.state
            }
            Self::Wound(most, (from, to)) => {
                let share = ((now.contraction - from) / (to - from)).clamp(0.0, 1.0);
                pull_n * (-most * (0.25 + 0.75 * share) * now.state).exp_m1()
            }
        }
    }
}

/// Load-dependent friction of elastic contacts: the power 2/3 of the pull (Hertz; Schallamach 1958).
pub fn load_contacts(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let coefficient = size(u, 0.01, 0.06);
    Built::one(Load::Contacts(coefficient, setting.forces_n.1.max(50.0))).with("coefficient", coefficient)
}

/// Load-dependent friction of a cable that a lever winds on: the angle of Euler and Eytelwein grows with contraction.
pub fn load_wound(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let most = size(u, 0.015, 0.20);
    Built::one(Load::Wound(most, setting.contractions)).with("friction_times_angle", most)
}

#[cfg(test)]
mod tests;
