//! Draws of a world: everything about a case but what is concealed in it.

use serde::Serialize;

use crate::caliper::Caliper;
use crate::catalogue::{Form, Half};
use crate::draw::Dice;
use crate::friction::{Amplitude, Element, Friction};
use crate::lumped::LumpedMuscle;
use crate::muscle::{Muscle, StaticForce};
use crate::noise::Color;
use crate::plan::{self, Kinds};
use crate::protocol::{KINDS, Kind};
use crate::region::Region;
use crate::rubber::Rubber;
use crate::sealed;
use crate::sensors::{Sensor, Sensors};
use crate::slices::SlicedMuscle;
use crate::standstill::Standstill;

/// Bench that a case comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bench {
    /// One cylinder.
    Lumped,
    /// Slices in equilibrium.
    Slices,
}

/// Attributes of a world that outcomes are reported by.
#[derive(Debug, Clone, Serialize)]
pub struct Attributes {
    /// Bench.
    pub bench: Bench,
    /// Law of the rubber.
    pub rubber: &'static str,
    /// `thin`, `thick` or, for slices, their number.
    pub wall: String,
    /// Law at standstill.
    pub standstill: &'static str,
    /// Which term of friction is largest: `surface`, `contact`, or `mixed`.
    pub friction: &'static str,
    /// Whether the branches of friction differ by more than a tenth.
    pub branches: &'static str,
    /// Color of the load cell's noise.
    pub noise: &'static str,
    /// Noise of the load cell: `low`, `usual`, `high`.
    pub noise_level: &'static str,
    /// Bits of the log.
    pub bits: u32,
    /// Sampling rate: `slow`, `usual`, `fast`.
    pub rate: &'static str,
    /// `none`, `usual` or `double`; or how else the dimensions were measured.
    pub caliper: &'static str,
    /// Whether memory goes on from recording to recording.
    pub continuous: bool,
    /// Whether the channels are filtered.
    pub filtered: bool,
    /// Whether the clock jitters.
    pub jitter: bool,
    /// Whether the log has gaps.
    pub gaps: bool,
    /// What the best cylinder leaves of the force, beside the floor; known once a case is made.
    pub cylinder_misfit: &'static str,
    /// How friction turns over after a reversal, where that is not by a stop operator.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn: Option<&'static str>,
    /// Estimation recordings.
    pub recordings: usize,
    /// Kinds of the estimation recordings.
    pub protocols: Vec<Kind>,
}

/// Why a world was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unmade {
    /// A sliced muscle found no equilibrium.
    NoEquilibrium,
    /// The muscle stays taut over too short a stroke.
    NoStroke,
    /// The effect did not show within its range.
    NotSeen,
    /// The muscle went slack with the effect, however short the stroke.
    Slack,
    /// Keeping it taut took more work than a case may.
    Work,
    /// Two effects together, a spring and a damper, have no solution step by step.
    Diverged,
}

/// A world, drawn.
#[derive(Debug, Clone)]
pub struct World {
    /// Muscle as built.
    pub muscle: Muscle,
    /// Its static force.
    pub force: StaticForce,
    /// Friction of the base.
    pub friction: Friction,
    /// Sensors.
    pub sensors: Sensors,
    /// Where the rig may go.
    pub region: Region,
    /// Protocols and durations in s, estimation first.
    pub plan: Vec<(Kind, f64)>,
    /// Recordings for estimation.
    pub estimation: usize,
    /// Caliper.
    pub caliper: Caliper,
    /// Whether memory goes on from recording to recording.
    pub continuous: bool,
    /// For the truth.
    pub attributes: Attributes,
    /// Fine step, s.
    pub dt_s: f64,
}

/// What the concealed effects ask of a world.
#[derive(Debug, Clone, Default)]
pub struct Demands {
    /// Protocols of which at least one is in the plan.
    pub wants: Vec<Kind>,
    /// Whether only minutes show the effect.
    pub slow: bool,
    /// Whether the rig goes where the muscle is slack.
    pub slack: bool,
    /// Whether only fast motion shows the effect.
    pub fast: bool,
    /// Whether only quiet sensors show the effect.
    pub quiet: bool,
}

/// Effects that are small, or that a static map absorbs almost entirely.
const QUIET: [&str; 4] = ["inertia", "load-dependent-friction", "end-taper", "rate-dependent-hysteresis"];

impl Demands {
    /// Of some forms together.
    pub fn of(forms: &[&Form]) -> Self {
        Self {
            wants: forms.iter().flat_map(|form| form.wants.iter().copied()).collect(),
            slow: forms.iter().any(|form| form.slow),
            slack: forms.iter().any(|form| form.id == "slack"),
            fast: forms.iter().any(|form| form.id == "inertia"),
            quiet: forms.iter().any(|form| form.slow || QUIET.contains(&form.id)),
        }
    }
}

fn draw_friction(dice: &mut Dice, muscle: &Muscle, force: &StaticForce) -> (Friction, &'static str) {
    let (pressure_pa, length_m) = (0.7 * muscle.highest_pressure_pa, 0.92 * muscle.rest_length_m);
    let parts = force.parts(pressure_pa, length_m);
    let together_n = (dice.log_uniform(0.015, 0.05) * parts.gas_n).max(1.0);
    let contact_share = dice.uniform(0.0, 1.0);
    let constant_n = if dice.chance(0.3) { together_n * dice.uniform(0.02, 0.12) } else { 0.0 };
    let asymmetry = if dice.chance(0.4) { dice.uniform(-0.3, 0.3) } else { 0.0 };
    let unit = |by_surface, by_contact| {
        Amplitude { by_surface, by_contact, constant_n: 0.0, asymmetry: 0.0 }.sliding_n(
            pressure_pa,
            parts.radius_m,
            length_m,
        )
    };
    let amplitude = Amplitude {
        by_surface: together_n * (1.0 - contact_share) / unit(1.0, 0.0),
        by_contact: together_n * contact_share / unit(0.0, 1.0),
        constant_n,
        asymmetry,
    };
    let element = Element::Stop { reach_m: dice.uniform(1e-5, 4e-5), state: 0.0 };
    let name = if contact_share < 0.25 {
        "surface"
    } else if contact_share > 0.75 {
        "contact"
    } else {
        "mixed"
    };
    (Friction { amplitude, element, standstill: Standstill::draw(dice) }, name)
}

/// Most contraction that keeps the muscle taut, over pressure.
fn taut(force: &StaticForce, friction: &Friction, muscle: &Muscle, margin_n: f64) -> Vec<f64> {
    (0..41)
        .map(|index| {
            let pressure_pa = muscle.highest_pressure_pa * f64::from(index) / 40.0;
            let pull_n = |contraction: f64| {
                let length_m = muscle.rest_length_m * (1.0 - contraction);
                let parts = force.parts(pressure_pa, length_m);
                let sliding_n = friction.amplitude.sliding_n(pressure_pa, parts.radius_m, length_m);
                parts.total_n() - 1.3 * sliding_n - margin_n
            };
            let (mut low, mut high) = (-0.02, muscle.contraction(muscle.span_m.0) - 0.01);
            if pull_n(low) <= 0.0 {
                return low;
            }
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if pull_n(middle) > 0.0 { low = middle } else { high = middle }
            }
            low
        })
        .collect()
}

fn draw_sensors(dice: &mut Dice, demands: &Demands, muscle: &Muscle, force: &StaticForce) -> Sensors {
    let usual = dice.chance(0.85);
    let mut rate_hz: f64 = if demands.slow {
        dice.log_uniform(20.0, 150.0)
    } else if demands.fast {
        dice.log_uniform(150.0, 1000.0)
    } else if usual {
        dice.log_uniform(50.0, 500.0)
    } else {
        dice.log_uniform(20.0, 2000.0)
    };
    rate_hz = if rate_hz > 100.0 { (rate_hz / 50.0).round() * 50.0 } else { (rate_hz / 5.0).round() * 5.0 };
    let bits = [8, 10, 12, 14, 16][dice.weighted(&[0.02, 0.06, 0.32, 0.2, 0.4])];
    let level =
        |dice: &mut Dice| if dice.chance(0.85) { dice.log_uniform(3e-4, 2e-3) } else { dice.log_uniform(2e-4, 2e-2) };
    let color = match dice.weighted(&[0.45, 0.2, 0.15, 0.2]) {
        0 => Color::White,
        1 => Color::Ar1(dice.uniform(0.6, 0.9)),
        2 => Color::OneOverF,
        _ => Color::Hum(dice.uniform(0.2, 0.7)),
    };
    let other_color = if dice.chance(0.5) { color } else { Color::White };
    let filtered = dice.chance(0.4);
    let filter_s = |dice: &mut Dice| if filtered { dice.log_uniform(3e-4, 2.5e-3) } else { 0.0 };
    let most_n = force.parts(muscle.highest_pressure_pa, muscle.rest_length_m).total_n() * 1.15;
    let force_scale_n = [200.0, 500.0, 1000.0, 2000.0].into_iter().find(|&scale| scale > most_n).unwrap_or(2000.0);
    let stroke_m = 0.3 * muscle.rest_length_m;
    let length_scale_m = [0.05, 0.1, 0.2].into_iter().find(|&scale| scale > stroke_m).unwrap_or(0.2);
    let gain = |dice: &mut Dice| 1.0 + 0.004 * dice.normal().clamp(-2.5, 2.5);
    let pressure = Sensor {
        full_scale: *dice.pick(&[6e5, 7e5, 1e6]),
        noise: 0.0,
        color: other_color,
        gain: gain(dice),
        pivot: 0.0,
        zero: dice.sign() * dice.uniform(0.0, 2000.0),
        bits,
        filter_s: filter_s(dice),
        filter_order: 1,
        bow: 0.0,
    };
    let length = Sensor {
        full_scale: length_scale_m,
        noise: 0.0,
        color: other_color,
        gain: gain(dice),
        pivot: muscle.rest_length_m,
        zero: 0.0,
        // Encoders and lasers resolve better than the converter of the log.
        bits: bits.max(12),
        filter_s: filter_s(dice),
        filter_order: 1,
        bow: 0.0,
    };
    let cell = Sensor {
        full_scale: force_scale_n,
        noise: level(dice) * force_scale_n,
        color,
        gain: gain(dice),
        pivot: 0.0,
        zero: 0.0,
        bits,
        filter_s: filter_s(dice),
        filter_order: 1,
        bow: 0.0,
    };
    let pressure = Sensor { noise: 0.5 * level(dice) * pressure.full_scale, ..pressure };
    let length = Sensor { noise: 0.3 * level(dice) * length.full_scale, ..length };
    Sensors {
        rate_hz,
        pressure,
        length,
        force: cell,
        tare_n: if dice.chance(0.6) { dice.uniform(0.05, 0.5) } else { 0.0 },
        jitter: if dice.chance(0.3) { dice.uniform(0.01, 0.1) } else { 0.0 },
        stamps_show_jitter: dice.chance(0.5),
        gaps: if dice.chance(0.15) { dice.between(1, 3) } else { 0 },
        lost: 0.0,
        stamp_step_s: 0.0,
    }
}

fn draw_plan(dice: &mut Dice, demands: &Demands, rate_hz: f64) -> (Vec<(Kind, f64)>, usize) {
    let kinds = Kinds {
        telling: [&[Kind::Isobaric, Kind::Multisine], &[Kind::IsometricRamps, Kind::PressureSteps, Kind::Multisine]],
        any: |dice| *dice.pick(&KINDS),
        held_out: |_| Kind::Multisine,
        longest_s: 600.0,
    };
    plan::draw(dice, demands, rate_hz, &kinds)
}

impl World {
    /// Draws a world, or says why there is none.
    pub fn draw(dice: &mut Dice, bench: Bench, demands: &Demands, half: Half) -> Result<Self, Unmade> {
        let is_sealed = half == Half::Sealed;
        let mut muscle = Muscle::draw(dice);
        if is_sealed {
            muscle.rubber = Rubber::draw_sealed(dice, muscle.shear_modulus_pa);
        }
        let (force, wall) = match bench {
            Bench::Lumped => {
                let wall = if muscle.thick_wall { "thick" } else { "thin" };
                (StaticForce::Lumped(LumpedMuscle::new(&muscle)), wall.to_owned())
            }
            Bench::Slices => {
                let sliced = SlicedMuscle::new(&muscle, dice).ok_or(Unmade::NoEquilibrium)?;
                let wall = if sliced.count < 28 { "coarse-slices" } else { "fine-slices" };
                (StaticForce::Slices(sliced), wall.to_owned())
            }
        };
        let (mut friction, friction_name) = draw_friction(dice, &muscle, &force);
        let turn = is_sealed.then(|| sealed::world::redraw_friction(dice, &mut friction));
        let mut sensors = draw_sensors(dice, demands, &muscle, &force);
        let (plan, estimation) = if is_sealed {
            sealed::world::redraw_sensors(dice, demands, &mut sensors);
            sealed::world::draw_plan(dice, demands, sensors.rate_hz)
        } else {
            draw_plan(dice, demands, sensors.rate_hz)
        };
        let margin_n = if demands.slack { -35.0 } else { dice.uniform(8.0, 20.0) };
        let fastest_m_per_s = if demands.slow { dice.uniform(0.06, 0.1) } else { dice.uniform(0.03, 0.1) };
        let taut = taut(&force, &friction, &muscle, margin_n);
        let deepest = taut.iter().copied().fold(0.0, f64::max);
        let mut region = Region {
            least: taut[0].clamp(-0.008, -0.001),
            most: (deepest * dice.uniform(0.8, 0.97)).min(0.27),
            taut,
            cycling: demands.slow && dice.chance(0.8),
            highest_pa: muscle.highest_pressure_pa,
            rest_m: muscle.rest_length_m,
            fastest_m_per_s,
            highest_hz: if demands.fast { dice.uniform(4.0, 9.0) } else { dice.log_uniform(1.0, 8.0) },
            bandwidths_hz: (dice.uniform(6.0, 20.0), dice.uniform(2.5, 10.0)),
            regulator: None,
            hang: None,
        };
        if region.most < 0.06 {
            return Err(Unmade::NoStroke);
        }
        if is_sealed {
            region.regulator = sealed::world::draw_regulator(dice);
            let load = sealed::world::draw_load(dice, &force, &muscle, &region);
            let lifted = self::taut(&force, &friction, &muscle, load.weight_n);
            region.hang = Some((load, lifted));
        }
        let caliper = if is_sealed {
            sealed::world::draw_caliper(dice)
        } else {
            Caliper::Normal([0.0, 1.0, 2.0][dice.weighted(&[0.15, 0.65, 0.2])])
        };
        let continuous = dice.chance(0.6);
        let relative = sensors.force.noise / sensors.force.full_scale;
        let attributes = Attributes {
            bench,
            rubber: muscle.rubber.name(),
            wall,
            standstill: friction.standstill.name(),
            friction: friction_name,
            branches: if friction.amplitude.asymmetry.abs() > 0.1 { "unequal" } else { "alike" },
            noise: sensors.force.color.name(),
            noise_level: match relative {
                low if low < 3e-4 => "low",
                usual if usual < 2e-3 => "usual",
                _ => "high",
            },
            bits: sensors.force.bits,
            rate: match sensors.rate_hz {
                slow if slow < 50.0 => "slow",
                usual if usual <= 500.0 => "usual",
                _ => "fast",
            },
            caliper: caliper.name(),
            continuous,
            filtered: sensors.force.filter_s > 0.0,
            jitter: sensors.jitter > 0.0,
            gaps: sensors.gaps > 0,
            cylinder_misfit: "unknown",
            turn,
            recordings: estimation,
            protocols: plan[..estimation].iter().map(|part| part.0).collect(),
        };
        // At least four steps a sample, or 2 kHz where that is coarser.
        let over = if sensors.rate_hz >= 2000.0 { 1.0 } else { (2000.0 / sensors.rate_hz).ceil().min(4.0) };
        let over = if sensors.rate_hz < 100.0 { (200.0 / sensors.rate_hz).ceil().max(4.0) } else { over };
        let dt_s = 1.0 / (sensors.rate_hz * over);
        Ok(Self { muscle, force, friction, sensors, region, plan, estimation, caliper, continuous, attributes, dt_s })
    }
}
