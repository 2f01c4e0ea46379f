//! Muscle, protocol and sensors together: a run of the bench.
//!
//! The bench simulates several steps for each row that it logs, so that a reversal falls between rows as
//! it does on a real rig. While the logger is off it goes on with one step per row.

use crate::catalogue::{self, Effect};
use crate::chain::assemble;
use crate::concealed::{Concealed, ConcealedEffect, ConcealedError, draw, draw_all};
use crate::mechanism::{Mechanism, Moment, Reading, SmoothMisfit};
use crate::path::{Command, Knot};
use crate::reach::REFERENCE_PRESSURE_PA;
use crate::recording::{BenchRecording, Decimals};
use crate::sensors::{Channel, Sensors, Stream};
use crate::true_muscle::TrueMuscle;

/// Sampling rate of the logger unless told otherwise.
pub const DEFAULT_RATE_HZ: f64 = 200.0;

/// Steps of the simulation for each row of the log.
pub const DEFAULT_OVERSAMPLING: u32 = 10;

/// Rows that a recording may have at most; two days at 200 Hz.
const MOST_ROWS: f64 = 35e6;

/// A muscle on the rig, with a protocol to run and sensors to log it.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    muscle: TrueMuscle,
    command: Command,
    sensors: Sensors,
    rate_hz: f64,
    oversampling: u32,
    effects: Vec<ConcealedEffect>,
    effect_seed: u64,
    smooth_misfit_n: f64,
}

/// Why a run cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BenchError {
    /// A sampling rate that no logger has.
    #[error("sampling rate {value_hz} Hz is outside 1 to 100000 Hz")]
    Rate {
        /// Rate asked for.
        value_hz: f64,
    },
    /// Noise that is not one.
    #[error("noise of the {channel} channel is {value}; it must be a number from 0 up, and 0 switches it off")]
    Noise {
        /// Which channel.
        channel: &'static str,
        /// Standard deviation asked for, in the unit of the channel.
        value: f64,
    },
    /// A correlation of noise that is not one.
    #[error("correlation of the {channel} noise is {value}; it must be at least 0, which is white, and below 1")]
    Correlation {
        /// Which channel.
        channel: &'static str,
        /// Correlation asked for.
        value: f64,
    },
    /// A share of colored noise that is none.
    #[error("share of colored noise of the {channel} channel is {value}; it must be from 0, all white, to 1")]
    ColoredShare {
        /// Which channel.
        channel: &'static str,
        /// Share asked for.
        value: f64,
    },
    /// A recording longer than anybody wants.
    #[error("{rows:.0} rows are more than {MOST_ROWS:.0}; lower the sampling rate or shorten the protocol")]
    Rows {
        /// Rows that the run would have.
        rows: f64,
    },
}

impl Bench {
    /// A bench with sensors suited to the muscle, the same for every protocol up to 500 kPa, at 200 Hz.
    pub fn new(muscle: TrueMuscle, command: Command) -> Self {
        let highest_pressure_pa = command.pressure_range_pa().1.max(REFERENCE_PRESSURE_PA);
        let sensors = Sensors::suited_to(&muscle, highest_pressure_pa);
        Self {
            muscle,
            command,
            sensors,
            rate_hz: DEFAULT_RATE_HZ,
            oversampling: DEFAULT_OVERSAMPLING,
            effects: Vec::new(),
            effect_seed: 0,
            smooth_misfit_n: 0.0,
        }
    }

    /// The same with effects that act in secret. Their inner parameters are drawn from `effect_seed` and the muscle
    /// alone, so that recordings under different protocols that share it conceal the same.
    ///
    /// # Errors
    /// [`ConcealedError`] but for its misfit.
    pub fn with_effects(self, concealed: &[Concealed], effect_seed: u64) -> Result<Self, ConcealedError> {
        let effects = draw_all(concealed, effect_seed, &self.muscle, &self.command)?;
        Ok(Self { effects, effect_seed, ..self })
    }

    /// The same with a smooth static error of the form, of so many newtons root mean square over the reach of the
    /// muscle; drawn from the seed of the effects, which is to be set before or after.
    ///
    /// # Errors
    /// [`ConcealedError::Misfit`].
    pub fn with_smooth_misfit(self, rms_n: f64) -> Result<Self, ConcealedError> {
        if !(0.0..=1000.0).contains(&rms_n) {
            return Err(ConcealedError::Misfit { value: rms_n });
        }
        Ok(Self { smooth_misfit_n: rms_n, ..self })
    }

    /// The same with other sensors.
    ///
    /// # Errors
    /// [`BenchError::Noise`], [`BenchError::Correlation`], [`BenchError::ColoredShare`].
    pub fn with_sensors(self, sensors: Sensors) -> Result<Self, BenchError> {
        let Sensors { pressure_kpa, length_mm, force_n, .. } = &sensors;
        for (channel, Channel { noise_rms, noise_correlation, colored_share, .. }) in
            [("pressure", pressure_kpa), ("length", length_mm), ("force", force_n)]
        {
            if !(noise_rms.is_finite() && *noise_rms >= 0.0) {
                return Err(BenchError::Noise { channel, value: *noise_rms });
            }
            if !(0.0..1.0).contains(noise_correlation) {
                return Err(BenchError::Correlation { channel, value: *noise_correlation });
            }
            if !(0.0..=1.0).contains(colored_share) {
                return Err(BenchError::ColoredShare { channel, value: *colored_share });
            }
        }
        Ok(Self { sensors, ..self })
    }

    /// The same at another sampling rate.
    ///
    /// # Errors
    /// [`BenchError::Rate`], [`BenchError::Rows`].
    pub fn at_rate(self, rate_hz: f64) -> Result<Self, BenchError> {
        if !(1.0..=1e5).contains(&rate_hz) {
            return Err(BenchError::Rate { value_hz: rate_hz });
        }
        let rows = self.command.duration_s() * rate_hz;
        if rows > MOST_ROWS {
            return Err(BenchError::Rows { rows });
        }
        Ok(Self { rate_hz, ..self })
    }

    /// The same with another number of simulation steps for each row, at least one.
    #[must_use]
    pub fn with_oversampling(self, oversampling: u32) -> Self {
        Self { oversampling: oversampling.max(1), ..self }
    }

    /// What is concealed, as drawn.
    pub fn effects(&self) -> &[ConcealedEffect] {
        &self.effects
    }

    /// Seed of what is concealed.
    pub fn effect_seed(&self) -> u64 {
        self.effect_seed
    }

    /// Root mean square of the smooth error of the form over the reach of the muscle, in N.
    pub fn smooth_misfit_n(&self) -> f64 {
        self.smooth_misfit_n
    }

    /// The sensors.
    pub fn sensors(&self) -> &Sensors {
        &self.sensors
    }

    /// The protocol as made for the muscle.
    pub fn command(&self) -> &Command {
        &self.command
    }

    /// The muscle.
    pub fn muscle(&self) -> &TrueMuscle {
        &self.muscle
    }

    /// Sampling rate, in Hz.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Runs the protocol and logs it. Equal benches and seeds give equal recordings.
    pub fn record(&self, seed: u64) -> BenchRecording {
        let rows = self.simulate(seed);
        let Sensors { pressure_kpa, length_mm, force_n, clock } = &self.sensors;
        let read = |channel: &Channel, stream: Stream, truth: fn(&Row) -> f64| {
            channel.read(rows.iter().map(truth), self.rate_hz, &mut stream.random(seed))
        };
        let in_si = |readings: Vec<f64>, units: f64| readings.into_iter().map(|value| value / units).collect();
        BenchRecording {
            time_s: rows.iter().map(|row| clock.stamp_s(row.index, self.rate_hz)).collect(),
            pressure_pa: in_si(read(pressure_kpa, Stream::Pressure, |row| row.ideal.pressure_pa * 1e-3), 1e-3),
            length_m: in_si(read(length_mm, Stream::Length, |row| row.ideal.length_m * 1e3), 1e3),
            force_n: read(force_n, Stream::Force, |row| row.ideal.force_n),
            true_pressure_pa: rows.iter().map(|row| row.pressure_pa).collect(),
            true_length_m: rows.iter().map(|row| row.length_m).collect(),
            true_force_n: rows.iter().map(|row| row.force_n).collect(),
            ideal_pressure_pa: rows.iter().map(|row| row.ideal.pressure_pa).collect(),
            ideal_length_m: rows.iter().map(|row| row.ideal.length_m).collect(),
            ideal_force_n: rows.iter().map(|row| row.ideal.force_n).collect(),
            true_direction: rows.iter().map(|row| row.direction).collect(),
            decimals: Decimals {
                time_s: clock.decimals(self.rate_hz),
                pressure_kpa: pressure_kpa.decimals(),
                length_mm: length_mm.decimals(),
                force_n: force_n.decimals(),
            },
        }
    }

    /// The chain with what is concealed, each link as at the start.
    fn chain(&self, seed: u64) -> Vec<Box<dyn Mechanism>> {
        let (muscle, command) = (&self.muscle, &self.command);
        // In the order of the catalogue, in whatever order the effects were given.
        let made = catalogue::EFFECTS.iter().filter_map(|effect: &Effect| {
            let concealed = self.effects.iter().find(|concealed| concealed.id == effect.id)?;
            Some(draw(effect, concealed.severity, self.effect_seed, muscle, command).1)
        });
        let misfit = (self.smooth_misfit_n > 0.0)
            .then(|| SmoothMisfit::draw(self.smooth_misfit_n, self.effect_seed, muscle, command));
        let mut chain = assemble(made.collect(), misfit);
        chain.iter_mut().for_each(|link| link.begin(seed));
        chain
    }

    /// The truth at every row of the log.
    fn simulate(&self, seed: u64) -> Vec<Row> {
        let mut rows = Vec::with_capacity((self.command.logged_s() * self.rate_hz) as usize + self.command.takes.len());
        let mut chain = self.chain(seed);
        let mut before_s = 0.0;
        let mut step = 0;
        for leg in legs(&self.command) {
            let mut at = 0;
            loop {
                let time_s = step as f64 / (self.rate_hz * f64::from(self.oversampling));
                if time_s > leg.end_s {
                    break;
                }
                let is_row = step % u64::from(self.oversampling) == 0;
                if leg.is_logged || is_row {
                    let (pressure_pa, length_m) = leg.state(time_s, &mut at);
                    let mut now = Moment::at(time_s, time_s - before_s, pressure_pa, length_m);
                    for mechanism in &mut chain {
                        mechanism.act(&self.muscle, &mut now);
                    }
                    before_s = time_s;
                    if leg.is_logged && is_row {
                        rows.push(Row::of(&now, step / u64::from(self.oversampling)));
                    }
                }
                step += 1;
            }
        }
        rows
    }
}

/// The truth at one row.
struct Row {
    index: u64,
    pressure_pa: f64,
    length_m: f64,
    force_n: f64,
    direction: f64,
    ideal: Reading,
}

impl Row {
    fn of(now: &Moment, index: u64) -> Self {
        Self {
            index,
            pressure_pa: now.gauge_pressure_pa,
            length_m: now.drive_length_m,
            force_n: now.tension.total_n(),
            direction: now.direction,
            ideal: now.reading,
        }
    }
}

/// A take, or the way to its start.
struct Leg {
    start_s: f64,
    end_s: f64,
    knots: Vec<Knot>,
    is_logged: bool,
}

impl Leg {
    /// Pressure and length at a time; `at` is the knot before it, which only moves on.
    fn state(&self, time_s: f64, at: &mut usize) -> (f64, f64) {
        let time_s = time_s - self.start_s;
        while *at + 2 < self.knots.len() && self.knots[*at + 1].time_s < time_s {
            *at += 1;
        }
        let (from, to) = (&self.knots[*at], &self.knots[(*at + 1).min(self.knots.len() - 1)]);
        let span_s = to.time_s - from.time_s;
        let share = if span_s > 0.0 { ((time_s - from.time_s) / span_s).clamp(0.0, 1.0) } else { 1.0 };
        let between = |from: f64, to: f64| if from == to { from } else { from + share * (to - from) };
        (between(from.pressure_pa, to.pressure_pa), between(from.length_m, to.length_m))
    }
}

/// The whole run: takes with the ways between them.
fn legs(command: &Command) -> Vec<Leg> {
    let mut legs: Vec<Leg> = Vec::new();
    let mut time_s = 0.0;
    for take in &command.takes {
        let before = legs.last().and_then(|leg| leg.knots.last()).copied();
        if let (Some(from), Some(to)) = (before, take.knots.first()) {
            let duration_s = take.pause_before_s;
            let knots = vec![Knot { time_s: 0.0, ..from }, Knot { time_s: duration_s, ..*to }];
            legs.push(Leg { start_s: time_s, end_s: time_s + duration_s, knots, is_logged: false });
            time_s += duration_s;
        }
        legs.push(Leg {
            start_s: time_s,
            end_s: time_s + take.duration_s(),
            knots: take.knots.clone(),
            is_logged: true,
        });
        time_s += take.duration_s();
    }
    legs
}
