//! Forms of friction: pre-sliding, hysteresis of the rubber, Stribeck, damping, rate and load dependence.

use super::{Built, Setting, size};
use crate::draw::Dice;
use crate::friction::Element;
use crate::mechanism::{Mechanism, Moment};

/// Pre-sliding distance, m: 0.2 to 5 mm (Vo-Minh et al. 2011; Lin et al. 2015).
fn reach_m(u: f64) -> f64 {
    size(u, 2e-4, 5e-3)
}

pub(crate) fn presliding(element: Element, reach_m: f64) -> Built {
    Built { element: Some(element), ..Built::default() }.with("reach_mm", 1e3 * reach_m).at(
        "travel_mm",
        0.0,
        2.5e3 * reach_m,
    )
}

/// Pre-sliding of Dahl.
pub fn presliding_dahl(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let reach_m = reach_m(u);
    presliding(Element::Dahl { reach_m, state: 0.0 }, reach_m)
}

/// Pre-sliding of LuGre: Dahl's bristles, damped.
pub fn presliding_lugre(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let reach_m = reach_m(u);
    let damping_s = dice.log_uniform(5e-4, 5e-3);
    presliding(Element::LuGre { reach_m, damping_s, state: 0.0, rate: 0.0 }, reach_m)
}

/// Pre-sliding of three to six elements that slip one after another.
pub fn presliding_maxwell_slip(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let reach_m = reach_m(u);
    let count = dice.between(3, 6);
    let ratio = dice.uniform(2.0, 3.0);
    let middle = 0.5 * (count as f64 - 1.0);
    let reaches: Vec<f64> = (0..count).map(|index| reach_m * ratio.powf(index as f64 - middle)).collect();
    let weights: Vec<f64> = (0..count).map(|_| dice.uniform(0.3, 1.0)).collect();
    presliding(Element::slip(&reaches, &weights, 0.0), reach_m)
}

/// Pre-sliding of Bouc and Wen.
pub fn presliding_bouc_wen(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let reach_m = reach_m(u);
    let (exponent, beta) = (dice.uniform(0.8, 2.0), dice.uniform(0.4, 0.7));
    presliding(Element::BoucWen { reach_m, exponent, beta, state: 0.0 }, reach_m)
}

/// Pre-sliding of Iwan: slip distances spread evenly.
pub fn presliding_iwan(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let reach_m = reach_m(u);
    let reaches: Vec<f64> = (0..12).map(|index| reach_m * 2.0 * (f64::from(index) + 0.5) / 12.0).collect();
    presliding(Element::slip(&reaches, &[1.0; 12], 0.0), reach_m)
}

/// Hysteresis of the rubber: an element on travel, of constant size or in proportion to the bladder's pull.
#[derive(Debug)]
struct RubberLoop {
    element: Element,
    last_m: Option<f64>,
    constant_n: f64,
    of_bladder: f64,
}

impl Mechanism for RubberLoop {
    fn begin(&mut self, _recording: usize, rested: bool) {
        self.last_m = None;
        if rested {
            self.element.set(0.0);
        }
    }

    fn added_n(&mut self, now: &Moment) -> f64 {
        let travel_m = self.last_m.map_or(0.0, |last_m| last_m - now.length_m);
        self.last_m = Some(now.length_m);
        self.element.step(travel_m, now.dt_s);
        -self.element.state() * (self.constant_n + self.of_bladder * now.bladder_n.abs())
    }
}

pub(crate) fn rubber(element: Element, constant_n: f64, of_bladder: f64) -> Built {
    Built::one(RubberLoop { element, last_m: None, constant_n, of_bladder })
        .with("size_n", constant_n)
        .with("share_of_bladder", of_bladder)
}

/// Rubber hysteresis: a Dahl loop of constant size.
pub fn rubber_dahl(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let element = Element::Dahl { reach_m: dice.log_uniform(4e-4, 4e-3), state: 0.0 };
    rubber(element, size(u, 0.02, 0.15) * setting.bladder_n, 0.0)
}

/// Rubber hysteresis: stop operators of Prandtl and Ishlinskii, of constant size.
pub fn rubber_prandtl(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let finest_m = dice.log_uniform(2e-4, 1e-3);
    let reaches: Vec<f64> = (0..5).map(|index| finest_m * 2.2_f64.powi(index)).collect();
    let weights: Vec<f64> = (0..5).map(|_| dice.uniform(0.3, 1.0)).collect();
    rubber(Element::slip(&reaches, &weights, 0.0), size(u, 0.02, 0.15) * setting.bladder_n, 0.0)
}

/// Rubber hysteresis in proportion to the bladder's own pull.
pub fn rubber_of_bladder(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let element = Element::Dahl { reach_m: dice.log_uniform(4e-4, 4e-3), state: 0.0 };
    rubber(element, 0.0, size(u, 0.03, 0.20))
}

/// How friction grows towards rest.
#[derive(Debug, Clone, Copy)]
enum Towards {
    Gaussian,
    Exponential,
    Rational,
    Aging,
}

#[derive(Debug)]
struct Stribeck {
    law: Towards,
    excess: f64,
    speed_m_per_s: f64,
    age_s: f64,
}

impl Mechanism for Stribeck {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        let ratio = now.speed_m_per_s.abs() / self.speed_m_per_s;
        let share = match self.law {
            Towards::Gaussian => (-ratio * ratio).exp(),
            Towards::Exponential => (-ratio).exp(),
            Towards::Rational => 1.0 / (1.0 + ratio * ratio),
            Towards::Aging => {
                // Contacts that rest grow stronger with the logarithm of their age; motion renews them.
                let renewed_s = 0.5 / (1.0 + 50.0 * ratio);
                self.age_s += now.dt_s - self.age_s * (1.0 - (-now.dt_s / renewed_s.max(1e-3)).exp()) * ratio.min(1.0);
                (-ratio * ratio).exp() * (0.6 + 0.4 * (1.0 + self.age_s).ln() / 11f64.ln()).min(1.4)
            }
        };
        1.0 + self.excess * share
    }
}

fn stribeck(law: Towards, dice: &mut Dice, u: f64) -> Built {
    let excess = size(u, 0.1, 1.0);
    let speed_m_per_s = dice.log_uniform(1e-3, 2e-2);
    Built::one(Stribeck { law, excess, speed_m_per_s, age_s: 0.0 })
        .with("excess", excess)
        .with("speed_mm_per_s", 1e3 * speed_m_per_s)
        .at("speed_mm_per_s", 0.0, 1.5e3 * speed_m_per_s)
}

/// Stribeck's rise, Gaussian.
pub fn stribeck_gaussian(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    stribeck(Towards::Gaussian, dice, u)
}

/// Stribeck's rise, exponential (Tondu and Lopez 2000).
pub fn stribeck_exponential(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    stribeck(Towards::Exponential, dice, u)
}

/// Stribeck's rise, rational (Hess and Soom 1990).
pub fn stribeck_rational(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    stribeck(Towards::Rational, dice, u)
}

/// Stribeck's rise with contacts that age at rest (Dieterich 1972).
pub fn stribeck_aging(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    stribeck(Towards::Aging, dice, u)
}

/// Damping: `c₊` contracting, `c₋` extending, as a power of speed, in part with pressure.
#[derive(Debug)]
struct Damping {
    contracting_n_s_per_m: f64,
    extending_n_s_per_m: f64,
    exponent: f64,
    /// Pressure at which the pressure-dependent damping has its nominal size; infinite for none.
    nominal_pa: f64,
}

/// Speed at which a power law has the force of the linear one, m/s.
const DAMPING_SPEED_M_PER_S: f64 = 0.02;

impl Mechanism for Damping {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s;
        let coefficient = if speed > 0.0 { self.contracting_n_s_per_m } else { self.extending_n_s_per_m };
        let by_pressure = if self.nominal_pa.is_finite() { now.pressure_pa.max(0.0) / self.nominal_pa } else { 1.0 };
        let shape = DAMPING_SPEED_M_PER_S * (speed.abs() / DAMPING_SPEED_M_PER_S).powf(self.exponent);
        -coefficient * by_pressure * shape * speed.signum()
    }
}

fn damping(dice: &mut Dice, u: f64, exponent: f64, symmetric: bool, nominal_pa: f64) -> Built {
    let c = size(u, 20.0, 500.0);
    let ratio = if symmetric { 1.0 } else { dice.uniform(0.2, 0.6) };
    Built::one(Damping { contracting_n_s_per_m: c, extending_n_s_per_m: c * ratio, exponent, nominal_pa })
        .with("damping_n_s_per_m", c)
        .with("exponent", exponent)
        .with("extending_over_contracting", ratio)
}

/// Damping, linear.
pub fn viscous_linear(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    damping(dice, u, 1.0, true, f64::INFINITY)
}

/// Damping, a power 0.5 to 0.8 of speed.
pub fn viscous_power(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let exponent = dice.uniform(0.5, 0.8);
    damping(dice, u, exponent, true, f64::INFINITY)
}

/// Damping that is weaker when extending (Reynolds et al. 2003).
pub fn viscous_asymmetric(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    damping(dice, u, 1.0, false, f64::INFINITY)
}

/// Damping in proportion to pressure.
pub fn viscous_by_pressure(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    damping(dice, u, 1.0, true, 0.5 * setting.muscle.highest_pressure_pa)
}

/// Friction that grows slowly with the rate.
#[derive(Debug)]
struct RateLaw {
    kind: u8,
    strength: f64,
    speed_m_per_s: f64,
}

impl Mechanism for RateLaw {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        let ratio = now.speed_m_per_s.abs() / self.speed_m_per_s;
        match self.kind {
            0 => 1.0 + self.strength * ratio.ln_1p(),
            1 => (1.0 + ratio).powf(self.strength),
            _ => 1.0 + self.strength * ratio.asinh(),
        }
    }
}

fn rate(kind: u8, dice: &mut Dice, u: f64) -> Built {
    let strength = size(u, 0.02, 0.15);
    let speed_m_per_s = dice.log_uniform(1e-4, 1e-3);
    Built::one(RateLaw { kind, strength, speed_m_per_s })
        .with("per_e_fold", strength)
        .with("speed_mm_per_s", 1e3 * speed_m_per_s)
}

/// Rate dependence, logarithmic.
pub fn rate_logarithmic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    rate(0, dice, u)
}

/// Rate dependence, a small power.
pub fn rate_power(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    rate(1, dice, u)
}

/// Rate dependence of thermally activated contacts (Eyring): the inverse hyperbolic sine.
pub fn rate_eyring(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    rate(2, dice, u)
}

/// Friction in proportion to the pull.
#[derive(Debug)]
struct LoadFriction {
    capstan: bool,
    strength: f64,
}

impl Mechanism for LoadFriction {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let pull_n = now.force_n.max(0.0);
        if self.capstan { pull_n * (-self.strength * now.state).exp_m1() } else { -self.strength * pull_n * now.state }
    }
}

/// Load-dependent friction of Amontons: `μ F`.
pub fn load_amontons(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let strength = size(u, 0.01, 0.06);
    Built::one(LoadFriction { capstan: false, strength }).with("coefficient", strength)
}

/// Load-dependent friction of a rope around a bollard: `F exp(−μΘ z)` (Euler and Eytelwein).
pub fn load_capstan(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let strength = size(u, 0.015, 0.20);
    Built::one(LoadFriction { capstan: true, strength }).with("friction_times_angle", strength)
}
