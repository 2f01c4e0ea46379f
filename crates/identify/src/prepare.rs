//! Recordings made ready for a fit: quality gate and direction of motion beside each.

use pam_muscle::Muscle;
use pam_muscle::direction::{Direction, Driver, Standstill, Thresholds};
use pam_muscle::force::{ForceModel, Form};
use pam_recording::Recording;
use pam_recording::quality::channel::PLAY;
use pam_recording::quality::{RecordingQuality, SensorEnds};
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::faults;

/// A recording with its quality gate, before a direction is known.
#[derive(Debug, Clone)]
pub struct Gated {
    /// The recording.
    pub recording: Recording,
    /// Its appearance.
    pub quality: RecordingQuality,
}

/// A recording ready for a fit.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The recording.
    pub recording: Recording,
    /// Its appearance.
    pub quality: RecordingQuality,
    /// Direction of motion of every row.
    pub direction: Direction,
}

impl Prepared {
    /// Takes what friction was at the beginning of every segment from the force that was recorded there, as `model` has it:
    /// nothing else tells. Those samples stay unsettled.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn begin(&mut self, model: &ForceModel, standstill: Standstill) -> Result<(), IdentifyError> {
        let force_n = |pressure_pa: f64, length_m: f64, state: f64| model.force_n(pressure_pa, length_m, state);
        let begun = self.direction.begun(&self.recording, standstill, &force_n);
        if let Some(begun) =
            begun.map_err(|reason| IdentifyError::Samples { path: self.recording.path.clone(), reason })?
        {
            self.direction = begun;
        }
        Ok(())
    }
}

/// Looks at every recording, in parallel.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn gate(recordings: Vec<Recording>) -> Result<Vec<Gated>, IdentifyError> {
    recordings
        .into_par_iter()
        .map(|recording| match RecordingQuality::of(&recording) {
            Ok(quality) => Ok(Gated { recording, quality }),
            Err(reason) => Err(IdentifyError::Samples { path: recording.path, reason }),
        })
        .collect()
}

/// Share of the rest length below which a flip of the direction means nothing.
const LEAST_PLAY: f64 = 1e-4;

/// Play of the length that the white noise of all of `gates` allows, in m.
pub fn finest_length_play_m(gates: &[Gated], muscle: &Muscle) -> f64 {
    let noises = gates.iter().filter_map(|gate| gate.quality.channel("length")).map(|channel| PLAY * channel.noise);
    noises.fold(LEAST_PLAY * muscle.rest_length_m, f64::max)
}

/// Thresholds of the direction that fit all of `gates`: five times the worst noise, for the length what it wanders within while
/// it rests, and never less than [`LEAST_PLAY`] of the rest length or 1e-3 of the highest pressure, below which a flip means nothing.
pub fn thresholds(gates: &[Gated], muscle: &Muscle) -> Thresholds {
    let worst = |name: &str| {
        gates
            .iter()
            .filter_map(|gate| gate.quality.channel(name))
            .map(|channel| channel.play_threshold())
            .fold(0.0, f64::max)
    };
    let highest_pa = gates
        .iter()
        .filter_map(|gate| gate.quality.channel("pressure"))
        .map(|channel| channel.highest)
        .fold(0.0, f64::max);
    // A recording that moves slowly all the time shows more.
    let rests = gates.iter().filter_map(|gate| gate.quality.channel("length")?.wanders_within()).reduce(f64::min);
    Thresholds {
        length_m: worst("length").max(rests.unwrap_or(0.0)).max(LEAST_PLAY * muscle.rest_length_m),
        pressure_pa: worst("pressure").max(1e-3 * highest_pa),
        held_m: 0.0,
        turn_m: 0.0,
        standstill: Standstill::AT_ONCE,
    }
}

/// Finds the direction of motion of every recording, in parallel, and leaves out what lies beyond a sensor's range.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn direct(gates: Vec<Gated>, thresholds: Thresholds, form: Form) -> Result<Vec<Prepared>, IdentifyError> {
    let ends = SensorEnds::of(gates.iter().map(|gate| &gate.quality));
    gates
        .into_par_iter()
        .map(|Gated { recording, quality }| match directed(&recording, &quality, &ends, thresholds, form) {
            Ok(direction) => Ok(Prepared { recording, quality, direction }),
            Err(reason) => Err(IdentifyError::Samples { path: recording.path, reason }),
        })
        .collect()
}

/// Finds the directions of `recordings` anew under other `thresholds`.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn redirect(recordings: &mut [Prepared], thresholds: Thresholds, form: Form) -> Result<(), IdentifyError> {
    let ends = SensorEnds::of(recordings.iter().map(|prepared| &prepared.quality));
    recordings.par_iter_mut().try_for_each(|prepared| {
        prepared.direction = directed(&prepared.recording, &prepared.quality, &ends, thresholds, form)
            .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
        Ok(())
    })
}

fn directed(
    recording: &Recording,
    quality: &RecordingQuality,
    ends: &SensorEnds,
    thresholds: Thresholds,
    form: Form,
) -> std::io::Result<Direction> {
    let driver = if form == Form::AsPrinted { Driver::Pressure } else { Driver::Motion };
    let mut direction = Direction::of(recording, thresholds, driver)?;
    ends.reached(recording, quality)?.into_iter().for_each(|rows| direction.leave_out(rows));
    faults::spikes::rows(recording, quality)?.into_iter().for_each(|row| direction.leave_out(row..row + 1));
    faults::shaken::rows(recording, quality)?.into_iter().for_each(|rows| direction.leave_out(rows));
    Ok(direction)
}
