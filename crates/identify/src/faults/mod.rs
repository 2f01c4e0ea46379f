//! Instrument faults, looked for before any physics is.
//!
//! [`ranges`] finds units under the wrong name and recordings of another muscle from ranges alone;
//! [`spikes`] and [`frozen`] find samples that no muscle makes, [`shaken`] those at which a hand shakes it; [`scale`] finds units that ranges do not show, [`zero`], after a fit,
//! a gauge whose zero is elsewhere;
//! [`channels`] finds swapped channels and a force of the wrong sign; [`disagree`] finds recordings that contradict one another, [`stood`] those that do because a channel stands at a wrong value;
//! [`apart`], after a fit, one recording of several whose instrument reads otherwise; [`twice`] finds a recording that is there twice; [`dead_band`] says where a gauge stands still; [`noise`] says where noise hides everything; [`lag`] finds a channel that lags the others; [`reading`] says what an
//! instrument would have to read wrong where a model that is known misses a recording. All but the last two, [`dead_band`] and [`apart`] refuse the recording,
//! because a fit would absorb the fault in its parameters.

pub mod apart;
pub mod channels;
pub mod dead_band;
pub mod disagree;
pub mod frozen;
pub mod lag;
pub mod noise;
pub mod ranges;
pub mod reading;
pub mod scale;
pub mod shaken;
mod smooth_map;
pub mod spikes;
pub mod stood;
pub mod twice;
pub mod zero;

use crate::prepare::Gated;
use pam_muscle::Muscle;

/// How many more recordings a warning holds for.
pub(crate) fn and_others(n: usize) -> String {
    match n {
        0 => String::new(),
        1 => " and another".to_owned(),
        n => format!(" and {n} others"),
    }
}

/// A fault that makes a fit pointless.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A channel is a known factor away from what a muscle has.
    #[error(
        "{path}: {channel} reaches {reached}, {factor} times too {direction}; {guess}; name the unit of the column \
         with --map, or go on with --accept-implausible"
    )]
    UnitSlip {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// Extreme value with its unit.
        reached: String,
        /// How far off, as a power or ratio of units.
        factor: String,
        /// `high` or `low`.
        direction: &'static str,
        /// Which units may have been mixed up.
        guess: &'static str,
    },
    /// Samples that leap from their neighbors and back.
    #[error(
        "{path}: {channel} leaps from its neighbors and back: {rows}; a plug or the logger does this, no muscle: delete the \
         rows, or go on with --accept-implausible"
    )]
    Spikes {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// The first of them, and how many more.
        rows: String,
    },
    /// A channel that stops half way.
    #[error(
        "{path}: {channel} stands at {value} from {from_s:.2} to {to_s:.2} s ({rows} rows), and flickers elsewhere: it froze; \
         cut that part off, or go on with --accept-implausible"
    )]
    Frozen {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// Where it stands, with its unit.
        value: String,
        /// From when, in s.
        from_s: f64,
        /// Until when, in s.
        to_s: f64,
        /// For how many rows.
        rows: usize,
    },
    /// A channel that never moves, at a value that the force denies.
    #[error(
        "{path}: {channel} is {value} in every row, and the force does not belong there: a smooth map of pressure and length \
         leaves {here_n:.3} N of it, and {others_n:.3} N of the other recordings; the sensor was not connected or stood, or the \
         value is not the one that was set: correct the column, leave the recording out, or go on with --accept-implausible"
    )]
    Stood {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// Where it stands, with its unit.
        value: String,
        /// Root mean square that the map leaves of this recording, in N.
        here_n: f64,
        /// And of the others, without this one, in N.
        others_n: f64,
    },
    /// A gain that no muscle has, and units that explain it.
    #[error(
        "{path}: the force is {gain:.2} times what gas makes in this muscle; {guesses}; name the unit of the column with \
         --map, check the muscle file, or go on with --accept-implausible"
    )]
    Gain {
        /// First recording.
        path: String,
        /// Force over what it should be.
        gain: f64,
        /// Which units may have been mixed up.
        guesses: String,
    },
    /// A gauge that falls below the pressure of a vented muscle.
    #[error(
        "{path}: pressure falls to {lowest_kpa:.1} kPa, where a vented muscle has 0: the zero of the gauge is off; add \
         --calibrate 'pressure_kPa = 1 * pressure_kPa + {shift_kpa:.1}', or go on with --accept-implausible"
    )]
    GaugeZero {
        /// Recording.
        path: String,
        /// Lowest pressure.
        lowest_kpa: f64,
        /// By how much it is off.
        shift_kpa: f64,
    },
    /// Lengths that the muscle of the muscle file cannot have.
    #[error(
        "{path}: length runs from {shortest_mm:.1} to {longest_mm:.1} mm, which a muscle of rest length \
         {rest_mm:.1} mm cannot have ({reason}); check that the recording and the muscle file belong together, or go \
         on with --accept-implausible"
    )]
    AnotherMuscle {
        /// Recording.
        path: String,
        /// Shortest length.
        shortest_mm: f64,
        /// Longest length.
        longest_mm: f64,
        /// Rest length of the muscle file.
        rest_mm: f64,
        /// The impossibility.
        reason: &'static str,
    },
    /// Force falls as pressure rises.
    #[error(
        "{path}: force falls as pressure rises (correlation {correlation:.2}), so its sign is turned; tension is \
         positive: add --calibrate '{remedy}', or go on with --accept-implausible"
    )]
    WrongSign {
        /// Recording.
        path: String,
        /// Correlation between force and what an ideal muscle does.
        correlation: f64,
        /// Calibration that turns it.
        remedy: &'static str,
    },
    /// Two channels fit a muscle better the other way round.
    #[error(
        "{path}: {first} and {second} look swapped (correlation with an ideal muscle {as_is:.2} as they are, \
         {swapped:.2} the other way round); exchange their names with --map, or go on with --accept-implausible"
    )]
    Swapped {
        /// Recording.
        path: String,
        /// One channel.
        first: &'static str,
        /// The other.
        second: &'static str,
        /// Correlation as recorded.
        as_is: f64,
        /// Correlation the other way round.
        swapped: f64,
    },
    /// Two recordings that cannot be of one muscle on one bench.
    #[error(
        "{path}: at equal pressure and length the force is {ratio:.2} times that of {other}; they are of different \
         muscles, or a gain changed between them: identify them apart, or go on with --accept-implausible"
    )]
    Disagree {
        /// Recording.
        path: String,
        /// The one that it disagrees with.
        other: String,
        /// Median ratio of forces.
        ratio: f64,
    },
}

/// Looks for faults that make a fit pointless; the first is returned.
///
/// # Errors
/// [`std::io::Error`] where samples cannot be read back.
pub fn find(gates: &[Gated], muscle: &Muscle) -> std::io::Result<Option<Fault>> {
    for gate in gates {
        if let Some(fault) = spikes::find(gate)? {
            return Ok(Some(fault));
        }
        // Without a force only ranges can be judged.
        if !gate.recording.samples.has_force() {
            if let Some(fault) = ranges::check(gate, muscle) {
                return Ok(Some(fault));
            }
            continue;
        }
        let looks = channels::Look::at(&gate.recording)?;
        // Swapped channels have implausible ranges, too, and are the better explanation.
        let fault = channels::swapped(gate, &looks, muscle)
            .or_else(|| ranges::check(gate, muscle))
            .or_else(|| channels::wrong_sign(gate, &looks, muscle));
        if fault.is_some() {
            return Ok(fault);
        }
        if let Some(fault) = frozen::find(&gate.recording)? {
            return Ok(Some(fault));
        }
        if let Some(fault) = scale::find(gate, &looks, muscle) {
            return Ok(Some(fault));
        }
    }
    // Before the gain: what stands at a wrong value contradicts the others, too, and is the better explanation.
    if let Some(fault) = stood::find(gates)? {
        return Ok(Some(fault));
    }
    disagree::find(gates, muscle)
}
