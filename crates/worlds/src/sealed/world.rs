//! Worlds of the third part: what is drawn otherwise than in the two halves.

use crate::caliper::Caliper;
use crate::draw::Dice;
use crate::friction::{Element, Friction};
use crate::muscle::{Muscle, StaticForce};
use crate::noise::Color;
use crate::plan::{self, Kinds};
use crate::protocol::{KINDS as USUAL_KINDS, Kind};
use crate::region::{Load, Region, Regulator};
use crate::sensors::{Sensor, Sensors};
use crate::shape::Shape;
use crate::standstill::Standstill;
use crate::world::Demands;

use super::protocol::KINDS;

/// Other laws of friction after a reversal and at standstill; returns the name of the first.
///
/// The base turns over within some tens of micrometers, far below the 0.2 mm at which pre-sliding begins.
pub fn redraw_friction(dice: &mut Dice, friction: &mut Friction) -> &'static str {
    friction.standstill = Standstill::draw_sealed(dice);
    let reach_m = dice.log_uniform(8e-6, 2.5e-5);
    let (element, name) = match dice.weighted(&[1.0, 1.0, 1.0]) {
        0 => (Element::Dahl { reach_m, state: 0.0 }, "exponential"),
        1 => (Element::slip(&[0.5 * reach_m, reach_m, 2.5 * reach_m], &[1.0, 1.0, 0.6], 0.0), "slip-by-slip"),
        _ => (Element::Shaped { shape: Shape::ElastoPlastic(0.5), reach_m, state: 0.0 }, "elasto-plastic"),
    };
    friction.element = element;
    name
}

/// Rates at which loggers sample, Hz.
const RATES_HZ: [f64; 12] = [25.0, 40.0, 60.0, 64.0, 90.0, 120.0, 128.0, 240.0, 256.0, 333.0, 480.0, 512.0];

/// Other sensors: rates of loggers, line encoders, colors of noise, one filter for all channels, a bow of load cell and
/// gauge, stamps to the millisecond, and samples that are lost one by one.
pub fn redraw_sensors(dice: &mut Dice, demands: &Demands, sensors: &mut Sensors) {
    let rates: Vec<f64> = RATES_HZ
        .into_iter()
        .filter(|&hz| if demands.slow { hz <= 130.0 } else { hz >= if demands.fast { 200.0 } else { 40.0 } })
        .collect();
    sensors.rate_hz = *dice.pick(&rates);
    let color = match dice.weighted(&[1.0, 1.0, 1.0, 0.7]) {
        0 => Color::Heavy,
        1 => Color::Ringing(dice.uniform(8.0, 40.0), dice.uniform(0.02, 0.15)),
        2 => Color::Harmonics(dice.uniform(0.2, 0.7)),
        _ => Color::Ar1(dice.uniform(0.3, 0.55)),
    };
    sensors.force.color = color;
    for channel in [&mut sensors.pressure, &mut sensors.length] {
        channel.color = if dice.chance(0.5) { Color::Heavy } else { Color::White };
    }
    // One filter card for all channels.
    let filter_s = if dice.chance(0.5) { dice.log_uniform(5e-4, 3e-3) } else { 0.0 };
    for channel in [&mut sensors.pressure, &mut sensors.length, &mut sensors.force] {
        (channel.filter_s, channel.filter_order) = (filter_s, 2);
    }
    if demands.quiet {
        for channel in [&mut sensors.pressure, &mut sensors.length, &mut sensors.force] {
            channel.noise = channel.noise.min(channel.full_scale * dice.log_uniform(1e-4, 5e-4));
            channel.bits = channel.bits.max(14);
        }
    }
    sensors.force.bow = dice.sign() * dice.uniform(0.0, 5e-4);
    sensors.pressure.bow = dice.sign() * dice.uniform(0.0, 1e-3);
    if dice.chance(0.4) {
        read_lines(&mut sensors.length, *dice.pick(&[1e-6, 2e-6, 5e-6, 1e-5]));
    }
    sensors.stamp_step_s = if sensors.rate_hz < 400.0 && dice.chance(0.4) { 1e-3 } else { 0.0 };
    sensors.lost = if dice.chance(0.25) { dice.log_uniform(5e-4, 1e-2) } else { 0.0 };
    sensors.tare_n = if dice.chance(0.6) { dice.log_uniform(0.03, 0.6) } else { 0.0 };
}

/// Makes a sensor one that counts lines this far apart, m; what is left of noise is the shake of its mount.
fn read_lines(sensor: &mut Sensor, apart_m: f64) {
    sensor.full_scale = apart_m * f64::from(2u32.pow(sensor.bits));
    sensor.noise = sensor.noise.min(2.0 * apart_m);
}

/// Protocols and durations in s, estimation first, and how many are for estimation.
pub fn draw_plan(dice: &mut Dice, demands: &Demands, rate_hz: f64) -> (Vec<(Kind, f64)>, usize) {
    let kinds = Kinds {
        telling: [&[Kind::GrowingSpiral, Kind::QuickRelease], &[Kind::Staircase, Kind::RandomSteps]],
        any: |dice| if dice.chance(0.2) { *dice.pick(&USUAL_KINDS) } else { *dice.pick(&KINDS) },
        held_out: |dice| *dice.pick(&[Kind::RandomSteps, Kind::GrowingSpiral]),
        longest_s: 400.0,
    };
    plan::draw(dice, demands, rate_hz, &kinds)
}

/// A regulator that holds whatever comes, or one that sags by some kilopascals while the muscle contracts.
pub fn draw_regulator(dice: &mut Dice) -> Option<Regulator> {
    dice.chance(0.7).then(|| Regulator { share: dice.uniform(0.3, 1.2), recovery_s: dice.log_uniform(0.01, 0.06) })
}

/// A weight that the muscle lifts at a part of its highest pressure, in a dashpot that damps it well.
pub fn draw_load(dice: &mut Dice, force: &StaticForce, muscle: &Muscle, region: &Region) -> Load {
    let middle_m = region.rest_m * (1.0 - 0.5 * (region.least + region.most));
    let most_n = force.parts(0.75 * muscle.highest_pressure_pa, middle_m).total_n();
    Load {
        weight_n: (most_n * dice.uniform(0.25, 0.8)).max(15.0),
        dashpot_n_s_per_m: dice.log_uniform(4000.0, 9000.0),
        stops_m: (region.rest_m * (1.0 - region.most), region.rest_m * (1.0 - region.least)),
    }
}

/// How the dimensions were measured.
pub fn draw_caliper(dice: &mut Dice) -> Caliper {
    match dice.weighted(&[0.3, 0.25, 0.25, 0.2]) {
        0 => Caliper::Rounded,
        1 => Caliper::Squeezed,
        2 => Caliper::Photographed,
        _ => Caliper::Normal(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Half;
    use crate::protocol::path;
    use crate::simulate::{Subject, run};
    use crate::world::{Bench, World};

    #[test]
    fn a_plan_has_what_an_effect_wants_and_something_held_out() {
        let mut dice = Dice::new(8, 8);
        let demands = Demands { wants: vec![Kind::Staircase], ..Demands::default() };
        for _ in 0..100 {
            let (plan, estimation) = draw_plan(&mut dice, &demands, 240.0);
            assert!((1..=6).contains(&estimation) && plan.len() > estimation && plan.len() <= estimation + 2);
            assert!(plan[..estimation].iter().any(|part| part.0 == Kind::Staircase));
            assert!(plan.iter().all(|part| (10.0..=400.0).contains(&part.1)));
        }
    }

    #[test]
    fn a_hanging_weight_is_carried_when_it_rests_and_moves_without_chatter() {
        let mut dice = Dice::new(21, 4);
        let demands = Demands { wants: vec![Kind::LoadedHang], ..Demands::default() };
        for _ in 0..6 {
            let Ok(world) = World::draw(&mut dice, Bench::Lumped, &demands, Half::Sealed) else { continue };
            let mut path = path(Kind::LoadedHang, 20.0, 1e-3, &mut dice, &world.region);
            let weight_n = path.load.expect("a weight").weight_n;
            // Five seconds at the last pressure.
            let count = path.pressure_pa.len();
            let still_pa = path.pressure_pa[count - 5001];
            path.pressure_pa[count - 5000..].fill(still_pa);
            let subject = Subject {
                force: &world.force,
                friction: world.friction.clone(),
                rest_m: world.muscle.rest_length_m,
                continuous: true,
                start_seed: 1,
            };
            let trace = &run(&subject, &[path], &[], Vec::new())[0];
            let rests_n = trace.force_n[count - 1];
            let rests_at = world.muscle.contraction(trace.length_m[count - 1]);
            let at_stop = (world.region.most - rests_at).min(rests_at - world.region.least) < 1e-3;
            // A stiff dashpot and a soft muscle take some seconds to settle.
            assert!(at_stop || (rests_n - weight_n).abs() < 0.5 + 0.03 * weight_n, "{rests_n} {weight_n}");
            for lengths_m in trace.length_m.windows(3) {
                let turned = (lengths_m[2] - lengths_m[1]) * (lengths_m[1] - lengths_m[0]);
                assert!(turned > -1e-13, "{lengths_m:?}");
            }
        }
    }

    #[test]
    fn lines_are_as_far_apart_as_asked() {
        let sensor = Sensor {
            full_scale: 0.1,
            noise: 1e-4,
            color: Color::White,
            gain: 1.0,
            pivot: 0.0,
            zero: 0.0,
            bits: 14,
            filter_s: 0.0,
            filter_order: 1,
            bow: 0.0,
        };
        let mut lines = sensor;
        read_lines(&mut lines, 5e-6);
        assert!((lines.full_scale / f64::from(2u32.pow(lines.bits)) - 5e-6).abs() < 1e-18);
        assert!(lines.noise <= 1e-5);
    }
}
