//! Runs a world along its paths: muscle, friction, concealed mechanisms, fixture.

use crate::draw::Dice;
use crate::forms::{Built, Compliance};
use crate::friction::Friction;
use crate::mechanism::{Mechanism, Moment};
use crate::muscle::{Parts, StaticForce};
use crate::protocol::Path;
use crate::region::Load;

/// What happened along one path, at its fine step.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Force as a perfect load cell reads it, N.
    pub force_n: Vec<f64>,
    /// Pressure as a gauge without noise shows it, Pa.
    pub pressure_pa: Vec<f64>,
    /// Length as an encoder without noise shows it, m.
    pub length_m: Vec<f64>,
    /// State of friction.
    pub state: Vec<f64>,
    /// Temperature, °C, where it is logged.
    pub temperature_c: Vec<f64>,
}

/// The parts of a world that a run needs.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// Static force.
    pub force: &'a StaticForce,
    /// Friction of the base.
    pub friction: Friction,
    /// Rest length, m.
    pub rest_m: f64,
    /// Whether one recording goes on where the last ended.
    pub continuous: bool,
    /// Seed of the friction's starting states.
    pub start_seed: u64,
}

/// Static force and sliding friction where the rig is, for steps in which a world adds nothing to pressure and length.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    parts: Parts,
    sliding_n: f64,
}

impl Subject<'_> {
    fn at(&self, pressure_pa: f64, length_m: f64) -> Known {
        let parts = self.force.parts(pressure_pa, length_m);
        Known { parts, sliding_n: self.friction.amplitude.sliding_n(pressure_pa, parts.radius_m, length_m) }
    }

    /// What holds along a path, so that runs with one effect after another need not find it anew.
    pub fn along(&self, path: &Path) -> Vec<Known> {
        path.pressure_pa.iter().zip(&path.length_m).map(|(&p, &l)| self.at(p, l)).collect()
    }
}

struct Run<'a> {
    subject: &'a Subject<'a>,
    friction: Friction,
    mechanisms: Vec<Box<dyn Mechanism>>,
    compliance: Option<Compliance>,
    time_s: f64,
    last: Option<Moment>,
    /// Force that mechanisms add beyond statics and friction in the last step, N.
    beyond_n: f64,
}

impl Run<'_> {
    /// Length of the muscle behind a spring: the root of `L + x(F(L)) = L_encoder`, by the Illinois rule.
    fn length_behind_spring_m(
        &self,
        spring: Compliance,
        pressure_pa: f64,
        encoder_m: f64,
        last: Option<&Moment>,
        dt_s: f64,
    ) -> f64 {
        let excess_m = |length_m: f64| {
            let parts = self.subject.force.parts(pressure_pa, length_m);
            let sliding_n = self.friction.amplitude.sliding_n(pressure_pa, parts.radius_m, length_m);
            let state = last.map_or_else(
                || self.friction.element.state(),
                |last| {
                    let mut friction = self.friction.clone();
                    friction.step(last.length_m - length_m, pressure_pa - last.pressure_pa, dt_s);
                    friction.element.state()
                },
            );
            let force_n = parts.total_n() - state * sliding_n * self.friction.amplitude.branch(state) + self.beyond_n;
            length_m + spring.extension_m(force_n) - encoder_m
        };
        let (mut low_m, mut high_m) = (encoder_m - 4e-2, encoder_m + 2e-3);
        let (mut low, mut high) = (excess_m(low_m), excess_m(high_m));
        if let Some(last) = last {
            // The last extension brackets the root closely most of the time.
            let guess_m = encoder_m - (last.encoder_m - last.length_m);
            let at = excess_m(guess_m);
            if at > 0.0 {
                (high_m, high) = (guess_m, at);
                let near_m = guess_m - 2.0 * at - 1e-7;
                let below = excess_m(near_m);
                if below < 0.0 {
                    (low_m, low) = (near_m, below);
                }
            } else {
                (low_m, low) = (guess_m, at);
                let near_m = guess_m - 2.0 * at + 1e-7;
                let above = excess_m(near_m);
                if above > 0.0 {
                    (high_m, high) = (near_m, above);
                }
            }
        }
        for _ in 0..40 {
            if high_m - low_m < 2e-9 {
                break;
            }
            let next_m = (low_m * high - high_m * low) / (high - low);
            let value = excess_m(next_m);
            if value.abs() < 1e-9 {
                return next_m;
            }
            if value > 0.0 {
                (high_m, high) = (next_m, value);
                low *= 0.5;
            } else {
                (low_m, low) = (next_m, value);
                high *= 0.5;
            }
        }
        0.5 * (low_m + high_m)
    }

    fn step(
        &mut self,
        gauge_pa: f64,
        encoder_m: f64,
        dt_s: f64,
        recording: usize,
        recording_time_s: f64,
        known: Option<&Known>,
    ) -> (f64, f64, f64) {
        let last = self.last;
        self.time_s += dt_s;
        let mut now = Moment {
            time_s: self.time_s,
            recording_time_s,
            recording,
            dt_s,
            gauge_pa,
            gauge_rate_pa_per_s: last.map_or(0.0, |last| (gauge_pa - last.gauge_pa) / dt_s),
            encoder_m,
            force_n: last.map_or(0.0, |last| last.force_n),
            radius_m: last.map_or(0.0, |last| last.radius_m),
            speed_m_per_s: last.map_or(0.0, |last| last.speed_m_per_s),
            contraction: 1.0 - encoder_m / self.subject.rest_m,
            ..Moment::default()
        };
        now.pressure_pa = gauge_pa;
        for mechanism in &mut self.mechanisms {
            now.pressure_pa = mechanism.pressure(&now, now.pressure_pa);
        }
        now.length_m = encoder_m;
        for mechanism in &mut self.mechanisms {
            now.length_m = mechanism.length(&now, now.length_m);
        }
        if let Some(spring) = self.compliance {
            now.length_m = self.length_behind_spring_m(spring, now.pressure_pa, now.length_m, last.as_ref(), dt_s);
        }
        now.contraction = 1.0 - now.length_m / self.subject.rest_m;
        now.speed_m_per_s = last.map_or(0.0, |last| (last.length_m - now.length_m) / dt_s);
        now.acceleration_m_per_s2 = last.map_or(0.0, |last| (now.speed_m_per_s - last.speed_m_per_s) / dt_s);
        let Known { parts, sliding_n } = match known {
            Some(known) if now.pressure_pa == gauge_pa && now.length_m == encoder_m => *known,
            _ => self.subject.at(now.pressure_pa, now.length_m),
        };
        (now.radius_m, now.gas_n, now.bladder_n) = (parts.radius_m, parts.gas_n, parts.bladder_n);
        now.sliding_n = sliding_n;
        if let Some(last) = last {
            self.friction.step(last.length_m - now.length_m, now.pressure_pa - last.pressure_pa, dt_s);
        }
        now.state = self.friction.element.state();
        let (mut gas, mut bladder, mut rub) = (1.0, 1.0, 1.0);
        for mechanism in &mut self.mechanisms {
            gas *= mechanism.gas_factor(&now);
            bladder *= mechanism.bladder_factor(&now);
            rub *= mechanism.friction_factor(&now);
        }
        let branch = self.friction.amplitude.branch(now.state);
        let plain_n = parts.total_n() - now.state * now.sliding_n * branch;
        now.force_n = gas * parts.gas_n + bladder * parts.bladder_n - now.state * now.sliding_n * branch * rub;
        for mechanism in &mut self.mechanisms {
            now.force_n += mechanism.added_n(&now);
        }
        for mechanism in &mut self.mechanisms {
            now.force_n = mechanism.limited_n(&now, now.force_n);
        }
        self.beyond_n = now.force_n - plain_n;
        self.last = Some(now);
        let mut read_n = now.force_n;
        let (mut shown_pa, mut shown_m) = (gauge_pa, encoder_m);
        for mechanism in &mut self.mechanisms {
            read_n = mechanism.cell_n(&now, read_n);
            shown_pa = mechanism.shown_pressure(&now, shown_pa);
            shown_m = mechanism.shown_length(&now, shown_m);
        }
        (read_n, shown_pa, shown_m)
    }
}

/// Steps of the way from where one recording ended to where the next begins.
const BRIDGE_STEPS: usize = 400;
/// Duration of that way, s, and of a rest.
const BRIDGE_S: f64 = 2.0;
const REST_S: f64 = 20.0;

/// Longest step in which a hanging weight moves, s: the braid turns over within some micrometers.
const HANG_STEP_S: f64 = 4e-4;

impl Run<'_> {
    /// Moves a hanging weight for the time of a step and tells what the sensors see at its end.
    fn hang(&mut self, load: &Load, to_pa: f64, dt_s: f64, recording: usize, end_s: f64) -> (f64, f64, f64) {
        let parts = (dt_s / HANG_STEP_S).ceil().max(1.0);
        let part_s = dt_s / parts;
        let from_pa = self.last.map_or(to_pa, |last| last.gauge_pa);
        let mut seen = (0.0, 0.0, 0.0);
        for part in 1..=parts as usize {
            let share = part as f64 / parts;
            let (length_m, force_n) =
                self.last.map_or((load.stops_m.1, load.weight_n), |last| (last.encoder_m, last.force_n));
            let speed_m_per_s = (load.weight_n - force_n) / load.dashpot_n_s_per_m;
            let length_m = (length_m + speed_m_per_s * part_s).clamp(load.stops_m.0, load.stops_m.1);
            let time_s = end_s - dt_s * (1.0 - share);
            seen = self.step(from_pa + (to_pa - from_pa) * share, length_m, part_s, recording, time_s, None);
        }
        seen
    }
}

/// Runs along all paths in order; `known` holds, for the first of them, what [`Subject::along`] found.
pub fn run(subject: &Subject, paths: &[Path], known: &[Vec<Known>], built: Vec<Built>) -> Vec<Trace> {
    let mut friction = subject.friction.clone();
    let mut compliance = None;
    let mut mechanisms = Vec::new();
    for one in built {
        mechanisms.extend(one.mechanisms);
        compliance = one.compliance.or(compliance);
        if let Some(element) = one.element {
            friction.element = element;
        }
    }
    let mut starts = Dice::new(subject.start_seed, 77);
    let mut run = Run { subject, friction, mechanisms, compliance, time_s: 0.0, last: None, beyond_n: 0.0 };
    let mut traces = Vec::new();
    for (recording, path) in paths.iter().enumerate() {
        let start = starts.uniform(-1.0, 1.0);
        let rested = recording == 0 || !subject.continuous;
        for mechanism in &mut run.mechanisms {
            mechanism.begin(recording, rested);
        }
        if rested {
            run.last = None;
            run.friction.element.set(start);
            run.time_s += if recording == 0 { 0.0 } else { REST_S };
        } else if let Some(last) = run.last {
            // The rig drives to the next start; nothing of this is recorded.
            let dt_s = BRIDGE_S / BRIDGE_STEPS as f64;
            for step in 1..=BRIDGE_STEPS {
                let share = step as f64 / BRIDGE_STEPS as f64;
                let gauge_pa = last.gauge_pa + (path.pressure_pa[0] - last.gauge_pa) * share;
                let encoder_m = last.encoder_m + (path.length_m[0] - last.encoder_m) * share;
                run.step(gauge_pa, encoder_m, dt_s, recording, -1.0, None);
            }
        }
        let count = path.length_m.len();
        let mut trace = Trace {
            force_n: Vec::with_capacity(count),
            pressure_pa: Vec::with_capacity(count),
            length_m: Vec::with_capacity(count),
            state: Vec::with_capacity(count),
            temperature_c: Vec::new(),
        };
        for index in 0..count {
            let time_s = index as f64 * path.dt_s;
            let known = known.get(recording).map(|known| &known[index]);
            let gauge_pa = path.pressure_pa[index];
            let (force_n, pressure_pa, length_m) = match &path.load {
                Some(load) if index > 0 => run.hang(load, gauge_pa, path.dt_s, recording, time_s),
                _ => run.step(gauge_pa, path.length_m[index], path.dt_s, recording, time_s, known),
            };
            trace.force_n.push(force_n);
            trace.pressure_pa.push(pressure_pa);
            trace.length_m.push(length_m);
            trace.state.push(run.friction.element.state());
            if let Some(celsius) = run.mechanisms.iter().find_map(|mechanism| mechanism.temperature_c()) {
                trace.temperature_c.push(celsius);
            }
        }
        traces.push(trace);
    }
    traces
}
