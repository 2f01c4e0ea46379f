//! Forms of geometry: threshold of pressure, ends that are no cylinder, strands that lock, a cable that goes slack.

use std::f64::consts::PI;

use super::{Built, Setting, size};
use crate::curve::Curve;
use crate::draw::Dice;
use crate::mechanism::{Mechanism, Moment};

/// Pressure that is lost before the bladder presses on the braid.
#[derive(Debug)]
enum Threshold {
    Hard(f64),
    /// `w ln(1 + exp((p − p_t)/w))`.
    Soft(f64, f64),
    /// `½ (p − p_t + √((p − p_t)² + w²))`.
    Hyperbola(f64, f64),
    /// `p_b = s · 2 (t/R)(G/2)(1 − λ⁻⁴)` of a thin tube that widens by `λ`.
    Bladder {
        scale_pa: f64,
        radius: Curve,
        rest_radius_m: f64,
    },
}

/// `w ln(1 + exp(x/w))` without overflow.
pub fn softplus(x: f64, width: f64) -> f64 {
    let ratio = x / width;
    if ratio > 30.0 { x } else { width * ratio.exp().ln_1p() }
}

impl Mechanism for Threshold {
    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        match self {
            Self::Hard(threshold_pa) => (pressure_pa - *threshold_pa).max(0.0),
            Self::Soft(threshold_pa, width_pa) => softplus(pressure_pa - *threshold_pa, *width_pa),
            Self::Hyperbola(threshold_pa, width_pa) => {
                let above_pa = pressure_pa - *threshold_pa;
                0.5 * (above_pa + above_pa.hypot(*width_pa))
            }
            Self::Bladder { scale_pa, radius, rest_radius_m } => {
                let widening = (radius.at(now.encoder_m) / *rest_radius_m).max(1.0);
                softplus(pressure_pa - *scale_pa * (1.0 - widening.powi(-4)), 1000.0)
            }
        }
    }
}

fn threshold(mechanism: Threshold, threshold_pa: f64, width_pa: f64) -> Built {
    Built::one(mechanism).with("threshold_kpa", 1e-3 * threshold_pa).at(
        "pressure_kPa",
        0.0,
        1e-3 * (threshold_pa + 2.0 * width_pa),
    )
}

/// Threshold with a soft edge.
pub fn threshold_soft(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (threshold_pa, width_pa) = (size(u, 1e4, 1e5), dice.uniform(5e3, 1.5e4));
    threshold(Threshold::Soft(threshold_pa, width_pa), threshold_pa, width_pa)
}

/// Threshold as a dead band.
pub fn threshold_hard(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let threshold_pa = size(u, 1e4, 1e5);
    threshold(Threshold::Hard(threshold_pa), threshold_pa, 5e3)
}

/// Threshold along a hyperbola.
pub fn threshold_hyperbola(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (threshold_pa, width_pa) = (size(u, 1e4, 1e5), dice.uniform(5e3, 2e4));
    threshold(Threshold::Hyperbola(threshold_pa, width_pa), threshold_pa, width_pa)
}

/// Pressure that the bladder itself takes as it widens.
pub fn threshold_bladder(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let muscle = setting.muscle.clone();
    let own_pa = muscle.wall_m / muscle.rest_radius_m * muscle.shear_modulus_pa;
    let scale_pa = (own_pa * size(u, 0.4, 2.5)).min(1e5);
    let rest_radius_m = muscle.rest_radius_m;
    let radius = Curve::new(muscle.span_m.0, muscle.span_m.1, 12, |length_m| muscle.cylinder_radius_m(length_m));
    threshold(Threshold::Bladder { scale_pa, radius, rest_radius_m }, scale_pa, 1e3)
}

/// Volume that the ends lose, as the force `p dV_lost/dL`.
#[derive(Debug)]
struct Ends {
    slope_m2: Curve,
}

impl Mechanism for Ends {
    fn added_n(&mut self, now: &Moment) -> f64 {
        now.pressure_pa * self.slope_m2.at(now.length_m)
    }
}

fn ends(setting: &Setting, scale: f64, lost_m3: impl Fn(f64, f64) -> f64) -> Built {
    let muscle = &setting.muscle;
    let lost = |length_m: f64| lost_m3(2.0 * muscle.cylinder_radius_m(length_m), 2.0 * muscle.rest_radius_m);
    let step_m = 1e-5 * muscle.rest_length_m;
    let slope = |length_m: f64| (lost(length_m + step_m) - lost(length_m - step_m)) / (2.0 * step_m);
    Built::one(Ends { slope_m2: Curve::new(muscle.span_m.0, muscle.span_m.1, 24, slope) }).with("size", scale)
}

/// Conical ends: each loses the ring between the cylinder and a cone of half angle `β`.
pub fn taper_conical(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let per_tangent = size(u, 1.0 / 60f64.to_radians().tan(), 1.0 / 22f64.to_radians().tan());
    ends(setting, per_tangent, |wide_m, narrow_m| {
        let cone_m = 0.5 * (wide_m - narrow_m) * per_tangent;
        2.0 * PI * cone_m * (wide_m.powi(2) / 4.0 - (wide_m.powi(2) + wide_m * narrow_m + narrow_m.powi(2)) / 12.0)
    })
}

/// Ends rounded like part of a hemisphere.
pub fn taper_caps(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let share = size(u, 0.2, 1.0);
    ends(setting, share, |wide_m, _| share * PI / 12.0 * wide_m.powi(3))
}

/// A part of the length at the ends that does not work.
#[derive(Debug)]
struct Inactive {
    rest_m: f64,
    factor: f64,
}

impl Mechanism for Inactive {
    fn length(&mut self, _now: &Moment, length_m: f64) -> f64 {
        self.rest_m - (self.rest_m - length_m) * self.factor
    }
}

/// Inactive length at the ends.
pub fn taper_inactive(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let rest_m = setting.muscle.rest_length_m;
    let inactive_m = size(u, 0.02, 0.18) * rest_m;
    Built::one(Inactive { rest_m, factor: rest_m / (rest_m - inactive_m) }).with("inactive_mm", 1e3 * inactive_m)
}

/// Resistance of strands that touch, beyond a contraction.
#[derive(Debug)]
struct LockUp {
    kind: u8,
    from: f64,
    width: f64,
    /// Contraction at which the resistance has its nominal size.
    to: f64,
    size_n: f64,
}

impl Mechanism for LockUp {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let beyond = now.contraction - self.from;
        let span = self.to - self.from;
        let shape = match self.kind {
            0 => softplus(beyond, self.width) / softplus(span, self.width),
            1 => (beyond.max(0.0) / self.width).exp_m1() / (span / self.width).exp_m1(),
            2 => (beyond.max(0.0) / span).powi(3),
            _ => {
                let x = (beyond.max(0.0) / span).min(1.2);
                0.3 * x * x / (1.3 - x)
            }
        };
        -self.size_n * shape
    }
}

fn lock_up(kind: u8, dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (_, most) = setting.contractions;
    let span = (most * dice.uniform(0.15, 0.35)).min(0.07);
    let (from, width) = (most - span, span * dice.uniform(0.12, 0.35));
    let size_n = size(u, 3.0, 80.0);
    Built::one(LockUp { kind, from, width, to: most, size_n }).with("size_n", size_n).with("from_contraction", from).at(
        "contraction",
        from - if kind == 0 { 2.0 * width } else { 0.0 },
        most,
    )
}

/// Lock-up along a softplus.
pub fn lock_up_soft(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(0, dice, u, setting)
}

/// Lock-up, exponential.
pub fn lock_up_exponential(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(1, dice, u, setting)
}

/// Lock-up, cubic.
pub fn lock_up_cubic(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(2, dice, u, setting)
}

/// Lock-up of strands that jam: the resistance grows without bound.
pub fn lock_up_jam(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(3, dice, u, setting)
}

/// A cable that cannot push.
#[derive(Debug)]
struct Slack {
    /// Width of the edge, N; zero for a hard clamp.
    width_n: f64,
    /// Length that is taken up before the cable is straight, and the force that takes up most of it.
    dead_m: f64,
    straight_n: f64,
    taken_m: f64,
}

impl Mechanism for Slack {
    fn length(&mut self, now: &Moment, length_m: f64) -> f64 {
        if self.dead_m > 0.0 {
            let target_m = self.dead_m * (-now.force_n.max(0.0) / self.straight_n).exp();
            self.taken_m += (target_m - self.taken_m) * 0.15;
        }
        length_m - self.taken_m
    }

    fn limited_n(&mut self, _now: &Moment, force_n: f64) -> f64 {
        if self.width_n > 0.0 { softplus(force_n, self.width_n) } else { force_n.max(0.0) }
    }
}

fn slack(width_n: f64, dead_m: f64, straight_n: f64) -> Built {
    Built::one(Slack { width_n, dead_m, straight_n, taken_m: 0.0 }).with("width_n", width_n).at(
        "force_N",
        -5.0,
        (2.0 * width_n).max(1.0).max(if dead_m > 0.0 { 2.0 * straight_n } else { 0.0 }),
    )
}

/// Slack with a soft edge.
pub fn slack_soft(_: &mut Dice, u: f64, _: &Setting) -> Built {
    slack(size(u, 0.5, 1.5), 0.0, 1.0)
}

/// Slack as a hard clamp.
pub fn slack_hard(_: &mut Dice, _: f64, _: &Setting) -> Built {
    slack(0.0, 0.0, 1.0)
}

/// Slack with a dead length that the first newtons take up.
pub fn slack_dead_length(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    slack(0.0, size(u, 5e-4, 3e-3), dice.uniform(4.0, 10.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn above_the_threshold_pressure_is_only_shifted() {
        let now = Moment::default();
        for mut law in [Threshold::Hard(3e4), Threshold::Soft(3e4, 8e3), Threshold::Hyperbola(3e4, 8e3)] {
            assert!((law.pressure(&now, 4e5) - 3.7e5).abs() < 100.0, "{law:?}");
            assert!(law.pressure(&now, 0.0) < 2e3, "{law:?}");
        }
    }

    #[test]
    fn a_slack_cable_never_pushes() {
        for width_n in [0.0, 1.0] {
            let mut slack = Slack { width_n, dead_m: 0.0, straight_n: 1.0, taken_m: 0.0 };
            let now = Moment::default();
            assert!(slack.limited_n(&now, -40.0).abs() < 1e-9);
            assert!((slack.limited_n(&now, 40.0) - 40.0).abs() < 1e-9);
        }
    }

    #[test]
    fn strands_resist_only_beyond_their_limit() {
        for kind in 1..4 {
            let mut lock = LockUp { kind, from: 0.2, width: 0.01, to: 0.25, size_n: 20.0 };
            let mut at = |contraction| lock.added_n(&Moment { contraction, ..Moment::default() });
            assert_eq!(at(0.15), 0.0);
            assert!((at(0.25) + 20.0).abs() < 1e-6, "{kind}: {}", at(0.25));
        }
    }
}
