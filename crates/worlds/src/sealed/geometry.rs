//! Geometry: threshold of pressure, ends that are no cylinder, strands that lock, a cable that goes slack.

use std::f64::consts::PI;

use crate::draw::Dice;
use crate::forms::geometry::softplus;
use crate::forms::memory::error_function;
use crate::forms::{Built, Setting, size};
use crate::mechanism::{Mechanism, Moment};
use crate::muscle::Muscle;

/// A bladder that meets the braid in more and more places as the pressure `p` grows: the share `H(p)` of the braid carries what
/// is added, so that `p_eff = ∫ H dp`.
#[derive(Debug, Clone, Copy)]
enum Contact {
    /// `H = 1 − exp(−(p/s)²)`: `p − s (√π/2) erf(p/s)`.
    Rayleigh(f64),
    /// `H = 1 − exp(−p/s)`: `p − s (1 − exp(−p/s))`.
    Exponential(f64),
}

impl Mechanism for Contact {
    fn pressure(&mut self, _now: &Moment, pressure_pa: f64) -> f64 {
        let pressure_pa = pressure_pa.max(0.0);
        match *self {
            Self::Rayleigh(scale_pa) => {
                (pressure_pa - 0.5 * PI.sqrt() * scale_pa * error_function(pressure_pa / scale_pa)).max(0.0)
            }
            Self::Exponential(scale_pa) => pressure_pa + scale_pa * (-pressure_pa / scale_pa).exp_m1(),
        }
    }
}

fn contact(mechanism: Contact, threshold_pa: f64, to_pa: f64) -> Built {
    Built::one(mechanism).with("threshold_kpa", 1e-3 * threshold_pa).at("pressure_kPa", 0.0, 1e-3 * to_pa)
}

/// Threshold of a bladder that meets the braid in places whose pressures follow Rayleigh's distribution; the region ends
/// where nine tenths have met it.
pub fn threshold_rayleigh(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let threshold_pa = size(u, 1e4, 1e5);
    let scale_pa = threshold_pa / (0.5 * PI.sqrt());
    contact(Contact::Rayleigh(scale_pa), threshold_pa, scale_pa * 10f64.ln().sqrt())
}

/// Threshold of a bladder that meets the braid in places whose pressures are spread exponentially; region as above.
pub fn threshold_exponential(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let threshold_pa = size(u, 1e4, 1e5);
    contact(Contact::Exponential(threshold_pa), threshold_pa, threshold_pa * 10f64.ln())
}

/// Ends that taper over a fixed axial length once the muscle is wider than its ferrules: `ΔF = p dV_lost/dL`.
#[derive(Debug)]
struct Ferrules {
    muscle: Muscle,
    cone_m: f64,
    /// Diameter of the ferrules, and the width of the edge, m.
    ferrule_m: f64,
    edge_m: f64,
}

impl Ferrules {
    /// Volume that is lost at a length, m³.
    fn lost_m3(&self, length_m: f64) -> f64 {
        let wide_m = 2.0 * self.muscle.cylinder_radius_m(length_m);
        lost_m3(self.cone_m, self.ferrule_m + softplus(wide_m - self.ferrule_m, self.edge_m), self.ferrule_m)
    }
}

impl Mechanism for Ferrules {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let step_m = 1e-5;
        let slope_m2 = (self.lost_m3(now.length_m + step_m) - self.lost_m3(now.length_m - step_m)) / (2.0 * step_m);
        now.pressure_pa * slope_m2
    }
}

/// Ends of 3 to 12 mm each that taper from ferrules which are wider than the muscle at rest.
pub fn taper_ferrules(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let muscle = setting.muscle.clone();
    let cone_m = size(u, 3e-3, 12e-3);
    let from = setting.contraction_at(dice.uniform(0.3, 0.65));
    let ferrule_m = 2.0 * muscle.cylinder_radius_m(muscle.rest_length_m * (1.0 - from));
    let edge_m = dice.uniform(1e-4, 3e-4);
    Built::one(Ferrules { muscle, cone_m, ferrule_m, edge_m })
        .with("cone_mm", 1e3 * cone_m)
        .with("ferrule_mm", 1e3 * ferrule_m)
        .with("from_contraction", from)
}

/// Volume between a cylinder and two cones of one axial length, m³.
fn lost_m3(cone_m: f64, wide_m: f64, narrow_m: f64) -> f64 {
    2.0 * PI * cone_m * (wide_m.powi(2) / 4.0 - (wide_m.powi(2) + wide_m * narrow_m + narrow_m.powi(2)) / 12.0)
}

/// A contraction that counts `k(p) = a exp(−p/p₀) + b` times: `ΔF = π r₀² p 3/tan²α₀ ((1 − k ε)² − (1 − ε)²)`.
#[derive(Debug)]
struct Factor {
    at_vent: f64,
    always: f64,
    scale_pa: f64,
    lead_m2: f64,
}

impl Mechanism for Factor {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let pressure_pa = now.pressure_pa.max(0.0);
        let k = self.at_vent * (-pressure_pa / self.scale_pa).exp() + self.always;
        let epsilon = now.contraction;
        self.lead_m2 * pressure_pa * ((1.0 - k * epsilon).powi(2) - (1.0 - epsilon).powi(2))
    }
}

/// Ends that matter less at higher pressure: the factor `k(p)` of Tondu and Lopez (2000), 1 to 1.25 above its limit.
pub fn taper_factor(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let muscle = &setting.muscle;
    let (at_vent, always) = (size(u, 0.02, 0.25), dice.uniform(1.0, 1.03));
    let scale_pa = dice.uniform(6e4, 2e5);
    let lead_m2 = PI * muscle.rest_radius_m.powi(2) * 3.0 / muscle.braid_angle_rad.tan().powi(2);
    Built::one(Factor { at_vent, always, scale_pa, lead_m2 })
        .with("at_vent", at_vent)
        .with("always", always)
        .with("scale_kpa", 1e-3 * scale_pa)
}

/// Resistance of strands that touch beyond a contraction, over that at the most contraction of the plan.
#[derive(Debug)]
struct LockUp {
    from: f64,
    to: f64,
    size_n: f64,
    /// Pressure that jams the strands by its own amount, Pa; none where they meet as solids.
    jam_pa: Option<f64>,
}

impl Mechanism for LockUp {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let beyond = ((now.contraction - self.from) / (self.to - self.from)).clamp(0.0, 1.3);
        let shape = match self.jam_pa {
            None => beyond.powf(1.5),
            Some(jam_pa) => (PI / 3.0 * beyond).tan() / 3f64.sqrt() * (now.pressure_pa / jam_pa).max(0.0),
        };
        -self.size_n * shape
    }
}

fn lock_up(dice: &mut Dice, u: f64, setting: &Setting, jam_pa: Option<f64>) -> Built {
    let (_, most) = setting.contractions;
    let span = (most * dice.uniform(0.15, 0.35)).min(0.07);
    let size_n = size(u, 3.0, 80.0);
    Built::one(LockUp { from: most - span, to: most, size_n, jam_pa })
        .with("size_n", size_n)
        .with("from_contraction", most - span)
        .at("contraction", most - span, most)
}

/// Lock-up of round strands that meet: the power 3/2 of Hertz.
pub fn lock_up_contact(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(dice, u, setting, None)
}

/// Lock-up in proportion to the pressure that jams the strands.
pub fn lock_up_pressed(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    lock_up(dice, u, setting, Some(setting.muscle.highest_pressure_pa))
}

/// A cable that hangs when it is slack.
#[derive(Debug)]
struct Slack {
    /// Edge of the limit, N: `½ (F + √(F² + w²))`.
    width_n: f64,
    /// Chord that a hanging cable lacks, m, and the pull that leaves half of it, N.
    hanging: Option<(f64, f64)>,
    lacking_m: f64,
}

impl Mechanism for Slack {
    fn length(&mut self, now: &Moment, length_m: f64) -> f64 {
        if let Some((hanging_m, half_n)) = self.hanging {
            let lacks_m = hanging_m / (1.0 + (now.force_n.max(0.0) / half_n).powi(2));
            // A cable swings into place within some milliseconds.
            self.lacking_m += (lacks_m - self.lacking_m) * (1.0 - (-now.dt_s / 0.02).exp());
        }
        length_m - self.lacking_m
    }

    fn limited_n(&mut self, _now: &Moment, force_n: f64) -> f64 {
        0.5 * (force_n + force_n.hypot(self.width_n))
    }
}

/// Slack along a hyperbola.
pub fn slack_hyperbola(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let width_n = size(u, 0.6, 3.0);
    Built::one(Slack { width_n, hanging: None, lacking_m: 0.0 }).with("width_n", width_n).at("force_N", -5.0, width_n)
}

/// Slack of a cable that sags by its weight: what its chord lacks falls with the square of the pull (Irvine 1981).
pub fn slack_sagging(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (hanging_m, half_n) = (size(u, 5e-4, 3e-3), dice.uniform(2.0, 6.0));
    Built::one(Slack { width_n: 0.3, hanging: Some((hanging_m, half_n)), lacking_m: 0.0 })
        .with("hanging_mm", 1e3 * hanging_m)
        .with("half_n", half_n)
        .at("force_N", -5.0, 2.0 * half_n)
}

#[cfg(test)]
mod tests;
