//! Recordings made ready for a fit: quality gate and direction of motion beside each.

use std::borrow::Cow;

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
    /// nothing else tells. Those samples stay unsettled. Where nothing moves at all, see [`begin_at_rest`].
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn begin(&mut self, model: &ForceModel, standstill: Standstill) -> Result<(), IdentifyError> {
        if self.direction.knows() { self.begin_as(model, standstill) } else { Ok(()) }
    }

    fn begin_as(&mut self, model: &ForceModel, standstill: Standstill) -> Result<(), IdentifyError> {
        let forces_n = |_: usize, pressure_pa: f64, length_m: f64| {
            [0.0, 1.0].map(|state| model.force_n(pressure_pa, length_m, state))
        };
        self.begin_where(standstill, &forces_n)
    }

    /// The same wherever nothing is known, where `forces_n` of row, pressure and length are the forces in states 0 and 1 of friction.
    pub(crate) fn begin_where(
        &mut self,
        standstill: Standstill,
        forces_n: &dyn Fn(usize, f64, f64) -> [f64; 2],
    ) -> Result<(), IdentifyError> {
        let begun = self.direction.begun(&self.recording, standstill, forces_n);
        if let Some(begun) = begun.map_err(|reason| self.unreadable(reason))? {
            self.direction = begun;
        }
        Ok(())
    }

    pub(crate) fn unreadable(&self, reason: std::io::Error) -> IdentifyError {
        IdentifyError::Samples { path: self.recording.path.clone(), reason }
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

/// [`Prepared::begin`] for those of `recordings` in which nothing moves, of which every sample counts: what friction is in them nothing
/// but the force tells. Not for a fit, which would take any fault for friction.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn begin_at_rest(
    recordings: &mut [Prepared],
    model: &ForceModel,
    standstill: Standstill,
) -> Result<(), IdentifyError> {
    let mut resting = recordings.iter_mut().filter(|prepared| !prepared.direction.knows());
    resting.try_for_each(|prepared| prepared.begin_as(model, standstill))
}

/// `recordings` as [`begin_at_rest`] leaves them.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn begun_at_rest<'a>(
    recordings: &'a [Prepared],
    model: &ForceModel,
    standstill: Standstill,
) -> Result<Cow<'a, [Prepared]>, IdentifyError> {
    if recordings.iter().all(|prepared| prepared.direction.knows()) {
        return Ok(Cow::Borrowed(recordings));
    }
    let mut begun = recordings.to_vec();
    begin_at_rest(&mut begun, model, standstill)?;
    Ok(Cow::Owned(begun))
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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    use pam_recording::Samples;

    use crate::testing::{THRESHOLDS, model, recording};

    pub(crate) const HELD: Thresholds = Thresholds { standstill: Standstill::Held, ..THRESHOLDS };
    const LENGTH_M: [f64; 300] = [0.25; 300];

    fn pressures_pa() -> Vec<f64> {
        (0..300).map(|row| 2e5 + 1e5 * (0.04 * f64::from(row)).sin()).collect()
    }

    /// A muscle held at one length while its pressure rises and falls, with a force.
    pub(crate) fn held(force_n: &[f64]) -> Prepared {
        let time_s: Vec<f64> = (0..300).map(|row| 0.01 * f64::from(row)).collect();
        moving(&time_s, &pressures_pa(), &LENGTH_M, force_n)
    }

    /// A muscle with these columns, whose friction is held at standstill.
    pub(crate) fn moving(time_s: &[f64], pressure_pa: &[f64], length_m: &[f64], force_n: &[f64]) -> Prepared {
        let samples = Samples::from_columns(time_s, pressure_pa, length_m, force_n);
        direct(gate(vec![recording("held.csv", samples)]).unwrap(), HELD, Form::Corrected).unwrap().remove(0)
    }

    /// The state of friction in all of `prepared`.
    pub(crate) fn state(prepared: &Prepared) -> f64 {
        let states: Vec<f64> = (0..300).map(|row| prepared.direction.sign(row)).collect();
        assert!(states.iter().all(|state| *state == states[0]), "one state while nothing moves");
        assert!((0..300).all(|row| prepared.direction.is_settled(row)), "every sample counts");
        states[0]
    }

    #[test]
    fn friction_of_a_muscle_that_never_moves_is_what_its_force_says() {
        for friction in [-0.6, 0.0, 1.0] {
            let forces_n: Vec<f64> =
                pressures_pa().iter().map(|pressure_pa| model().force_n(*pressure_pa, LENGTH_M[0], friction)).collect();
            let mut still = [held(&forces_n)];
            assert_eq!(state(&still[0]), 0.0, "nothing is known before a model is asked");
            begin_at_rest(&mut still, &model(), Standstill::Held).unwrap();
            assert_eq!(state(&still[0]), friction);
        }
    }

    #[test]
    fn a_recording_in_which_something_moves_is_left_as_it_is() {
        let length_m: Vec<f64> = (0..300).map(|row| 0.26 - 1e-4 * f64::from(row)).collect();
        let time_s: Vec<f64> = (0..300).map(|row| 0.01 * f64::from(row)).collect();
        let samples = Samples::from_columns(&time_s, &[2e5; 300], &length_m, &[300.0; 300]);
        let gates = gate(vec![recording("ramp.csv", samples)]).unwrap();
        let moving = direct(gates, HELD, Form::Corrected).unwrap();
        assert!(matches!(begun_at_rest(&moving, &model(), Standstill::Held), Ok(Cow::Borrowed(_))));
        let mut begun = moving.clone();
        begin_at_rest(&mut begun, &model(), Standstill::Held).unwrap();
        assert_eq!(begun[0].direction, moving[0].direction);
    }
}
