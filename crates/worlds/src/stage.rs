//! A world that has been recorded once with nothing concealed, ready to be recorded again with something.

use std::cell::Cell;

use crate::case::SEVERITIES;
use crate::catalogue::Form;
use crate::draw::Dice;
use crate::forms::{Built, Setting};
use crate::protocol::{Path, path};
use crate::sensors::Log;
use crate::severity::{Scales, residuals, rms_difference};
use crate::simulate::{Known, Subject, Trace, run};
use crate::world::World;

/// A world, what is recorded in it, and how that looks with nothing concealed.
pub(crate) struct Stage<'a> {
    world: &'a World,
    paths: Vec<Path>,
    subject: Subject<'a>,
    /// Static force along the estimation recordings.
    known: Vec<Vec<Known>>,
    log_seed: u64,
    /// What forms are built for.
    pub(crate) setting: Setting,
    /// Recordings with nothing concealed.
    pub(crate) plain: Vec<Log>,
    plain_residuals: Vec<f64>,
    pub(crate) scales: Scales,
    /// What noise leaves, root mean square, in N.
    pub(crate) floor_n: f64,
    /// Steps simulated so far.
    pub(crate) work: Cell<usize>,
}

fn log_all(
    world: &World,
    paths: &[Path],
    traces: &[Trace],
    built: &[Option<crate::forms::Delay>],
    seed: u64,
    noisy: bool,
) -> Vec<Log> {
    let delay = built.iter().copied().flatten().next();
    traces
        .iter()
        .enumerate()
        .map(|(recording, trace)| {
            let mut dice = Dice::new(seed, 500 + recording as u64);
            world.sensors.log(trace, paths[recording].dt_s, delay, &world.force, noisy, &mut dice)
        })
        .collect()
}

fn steps(paths: &[Path]) -> usize {
    paths.iter().map(|path| path.length_m.len()).sum()
}

impl<'a> Stage<'a> {
    /// Records `world` once, with protocols from `dice`.
    pub(crate) fn new(world: &'a World, dice: &mut Dice) -> Self {
        let mut path_dice = dice.fork();
        let paths: Vec<Path> = world
            .plan
            .iter()
            .map(|&(kind, duration_s)| path(kind, duration_s, world.dt_s, &mut path_dice, &world.region))
            .collect();
        let subject = Subject {
            force: &world.force,
            friction: world.friction.clone(),
            rest_m: world.muscle.rest_length_m,
            continuous: world.continuous,
            start_seed: dice.between(0, 1 << 40) as u64,
        };
        let log_seed = dice.between(0, 1 << 40) as u64;
        let estimation = world.estimation;
        let known: Vec<Vec<Known>> = paths[..estimation].iter().map(|path| subject.along(path)).collect();
        let work = 2 * steps(&paths[..estimation]) + steps(&paths);
        let traces = run(&subject, &paths[..estimation], &known, Vec::new());
        let plain = log_all(world, &paths, &traces, &[], log_seed, true);
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        let lengths = range(&mut paths[..estimation].iter().flat_map(|path| path.length_m.iter().copied()));
        let pressures_pa = range(&mut paths[..estimation].iter().flat_map(|path| path.pressure_pa.iter().copied()));
        let forces_n = range(&mut plain.iter().flat_map(|log| log.true_force_n.iter().copied()));
        let travel_m = paths[..estimation]
            .iter()
            .map(|path| path.length_m.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>())
            .sum();
        let contraction = |length_m| world.muscle.contraction(length_m);
        let bladder_n = -world.force.parts(0.5 * world.muscle.highest_pressure_pa, lengths.0).bladder_n;
        let setting = Setting {
            muscle: world.muscle.clone(),
            contractions: (contraction(lengths.1), contraction(lengths.0)),
            pressures_pa,
            forces_n,
            travel_m,
            durations_s: world.plan.iter().map(|part| part.1).collect(),
            estimation,
            bladder_n: bladder_n.max(5.0),
            period_s: 1.0 / world.sensors.rate_hz,
        };
        let half = |(low, high): (f64, f64), least: f64| (0.5 * (low + high), (0.5 * (high - low)).max(least));
        let scales = Scales { pressure: half(pressures_pa, 2e4), length: half(lengths, 2e-3) };
        let plain_residuals = residuals(&plain, &plain, scales);
        let count: usize = plain.iter().map(|log| log.time_s.len()).sum();
        let sum: f64 = plain.iter().map(|log| log.floor_n2 * log.time_s.len() as f64).sum();
        let floor_n = (sum / count as f64).sqrt();
        Self {
            world,
            paths,
            subject,
            known,
            log_seed,
            setting,
            plain,
            plain_residuals,
            scales,
            floor_n,
            work: Cell::new(work),
        }
    }

    /// Logs of the first recordings with something concealed; without noise where only the truth is of interest.
    pub(crate) fn seen(&self, built: Vec<Built>, recordings: usize, noisy: bool) -> Vec<Log> {
        // The root behind a spring takes many looks at the muscle.
        let looks = if built.iter().any(|one| one.compliance.is_some()) { 12 } else { 1 };
        self.work.set(self.work.get() + looks * steps(&self.paths[..recordings]));
        let delays: Vec<Option<crate::forms::Delay>> = built.iter().map(|one| one.delay).collect();
        let traces = run(&self.subject, &self.paths[..recordings], &self.known, built);
        log_all(self.world, &self.paths, &traces, &delays, self.log_seed, noisy)
    }

    fn severity(&self, logs: &[Log]) -> f64 {
        let estimation = self.world.estimation;
        let with = residuals(&logs[..estimation], &self.plain, self.scales);
        rms_difference(&with, &self.plain_residuals) / self.floor_n
    }

    /// `form` at a place of its published range, 0…1.
    pub(crate) fn build(&self, form: &Form, form_dice: &Dice, u: f64) -> Built {
        (form.build)(&mut form_dice.clone(), u, &self.setting)
    }

    /// Severity of a form alone at a place of its published range, 0…1.
    pub(crate) fn severity_at(&self, form: &Form, form_dice: &Dice, u: f64) -> f64 {
        self.severity(&self.seen(vec![self.build(form, form_dice, u)], self.world.estimation, false))
    }

    /// Place in the published range, 0…1, at which a form alone reaches about the severity aimed at; `top` is what it
    /// reaches at the end of the range.
    pub(crate) fn search(&self, form: &Form, form_dice: &Dice, aim: f64, top: f64) -> Option<(f64, f64)> {
        let severity = |u: f64| self.severity_at(form, form_dice, u);
        if top <= aim {
            return Some((1.0, top));
        }
        let bottom = severity(0.0);
        if bottom >= aim {
            return Some((0.0, bottom));
        }
        let (mut low, mut high) = ((0.0, bottom.max(1e-6)), (1.0, top));
        let mut best = high;
        for _ in 0..3 {
            let share = (aim / low.1).ln() / (high.1 / low.1).ln();
            let u = low.0 + (high.0 - low.0) * share.clamp(0.1, 0.9);
            let at = severity(u);
            best =
                if (at / aim).ln().abs() < (best.1 / aim).ln().abs() || best.1 < SEVERITIES.0 { (u, at) } else { best };
            if (at / aim).ln().abs() < 0.3 {
                break;
            }
            if at < aim { low = (u, at.max(1e-6)) } else { high = (u, at) }
        }
        (best.1 >= SEVERITIES.0).then_some(best)
    }
}
