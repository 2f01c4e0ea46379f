//! A model along a recording, row by row.

use std::io;

use pam_artifact::ModelArtifact;
use pam_artifact::model::Domain;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{AugmentedModel, Moment};
use pam_muscle::force::ForceModel;
use pam_muscle::motion::{Channels, Instant, walk};
use pam_muscle::shift::shifted;
use pam_recording::{Chunk, Recording};

use crate::error::IdentifyError;
use crate::faults;
use crate::prepare::{Prepared, direct, gate};

/// A recording with the direction that the model's thresholds give it.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn prepare(recording: Recording, artifact: &ModelArtifact) -> Result<Prepared, IdentifyError> {
    let gates = gate(vec![recording])?;
    let mut prepared = direct(gates, artifact.direction, artifact.form)?;
    Ok(prepared.remove(0))
}

/// As [`prepare`], for a recording that must be one of the model's muscle, read by instruments that are in order.
///
/// # Errors
/// [`IdentifyError::Fault`] where it cannot be, [`IdentifyError::Samples`] where samples cannot be read back.
pub fn prepare_plausible(recording: Recording, artifact: &ModelArtifact) -> Result<Prepared, IdentifyError> {
    let gates = gate(vec![recording])?;
    let fault = faults::find(&gates, &artifact.geometry)
        .map_err(|reason| IdentifyError::Samples { path: gates[0].recording.path.clone(), reason })?;
    if let Some(fault) = fault {
        return Err(IdentifyError::Fault(fault));
    }
    let mut prepared = direct(gates, artifact.direction, artifact.form)?;
    Ok(prepared.remove(0))
}

/// Modelled force of every row of `chunk`, in N.
pub fn forces_n(prepared: &Prepared, model: &ForceModel, chunk: &Chunk) -> Vec<f64> {
    chunk
        .rows()
        .zip(chunk.pressure_pa())
        .zip(chunk.length_m())
        .map(|((row, &pressure_pa), &length_m)| model.force_n(pressure_pa, length_m, prepared.direction.sign(row)))
        .collect()
}

/// Walks over every row of a recording with an augmented model, in order: what was recorded, and the modelled force in
/// N. `index` is the number of the recording, `rest_length_m` that of the muscle.
///
/// Where no force was recorded, effects see the model's own of the row before.
///
/// # Errors
/// Where the samples cannot be read back.
pub fn walk_augmented(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
    index: usize,
    visit: &mut dyn FnMut(&Instant, f64),
) -> io::Result<()> {
    walk_moments(prepared, model, thresholds, index, &mut |instant, _, force_n| visit(instant, force_n))
}

/// As [`walk_augmented`], with the moment that the model's force was computed at as well: channels moved in time where the
/// model says that they are late, and the force that effects see.
///
/// # Errors
/// Where the samples cannot be read back.
pub fn walk_moments(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
    index: usize,
    visit: &mut dyn FnMut(&Instant, &Moment, f64),
) -> io::Result<()> {
    walk_rows(prepared, model, thresholds, index, prepared.recording.samples.n_rows(), visit)
}

/// As [`walk_moments`], over the first `n_rows` rows.
fn walk_rows(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
    index: usize,
    n_rows: usize,
    visit: &mut dyn FnMut(&Instant, &Moment, f64),
) -> io::Result<()> {
    let Prepared { recording, direction, .. } = prepared;
    let has_force = recording.samples.has_force();
    let mut memory = model.start_in(index);
    let mut before_n = None;
    let mut seen = |now: Moment| {
        let seen_n = if has_force {
            now.force_n
        } else {
            before_n.unwrap_or_else(|| model.settled_force_n(now.pressure_pa, now.length_m, now.direction))
        };
        let now = Moment { force_n: seen_n, ..now };
        let force_n = memory.force_n(model, now);
        before_n = Some(force_n);
        (now, force_n)
    };
    let walk = |visit: &mut dyn FnMut(Instant)| {
        walk(recording, direction, thresholds, model.base(), index, n_rows, 1, Channels::Recorded, visit)
    };
    let delays_s = model.delays_s();
    if delays_s == [0.0; 2] {
        return walk(&mut |instant| {
            let (moment, force_n) = seen(instant.moment);
            visit(&instant, &moment, force_n);
        });
    }
    let mut instants = Vec::new();
    walk(&mut |instant| instants.push(instant))?;
    for (instant, moment) in instants.iter().zip(shifted(&instants, delays_s)) {
        let (moment, force_n) = seen(moment);
        visit(instant, &moment, force_n);
    }
    Ok(())
}

/// Modelled force of every row of a recording in N, with what the model remembers from row to row.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn augmented_forces_n(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
) -> Result<Vec<f64>, IdentifyError> {
    let mut forces_n = Vec::with_capacity(prepared.recording.samples.n_rows());
    walk_augmented(prepared, model, thresholds, 0, &mut |_, force_n| forces_n.push(force_n))
        .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    Ok(forces_n)
}

/// Where a model is no extrapolation: what it was identified on, and a margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trusted {
    /// Lowest and highest gauge pressure, in Pa.
    pub pressure_pa: [f64; 2],
    /// Shortest and longest length, in m.
    pub length_m: [f64; 2],
}

/// `domain` with a margin of six deviations of the recording's noise and a percent of the range.
pub fn trusted(prepared: &Prepared, domain: &Domain) -> Trusted {
    let widened = |name: &str, [low, high]: [f64; 2]| {
        let noise = prepared.quality.channel(name).map_or(0.0, |channel| channel.noise);
        let margin = 6.0 * noise + 0.01 * (high - low);
        [low - margin, high + margin]
    };
    Trusted { pressure_pa: widened("pressure", domain.pressure_pa), length_m: widened("length", domain.length_m) }
}

/// How far a recording leaves what the model was identified on, in words; empty where it stays inside.
pub fn outside(prepared: &Prepared, domain: &Domain) -> Vec<String> {
    let mut words = Vec::new();
    let trusted = trusted(prepared, domain);
    for (name, [low, high], [from, to], scale, unit) in [
        ("pressure", domain.pressure_pa, trusted.pressure_pa, 1e-3, "kPa"),
        ("length", domain.length_m, trusted.length_m, 1e3, "mm"),
    ] {
        let Some(channel) = prepared.quality.channel(name) else { continue };
        if channel.lowest < from || channel.highest > to {
            words.push(format!(
                "{}: {name} runs from {:.1} to {:.1} {unit}, but the model was identified on {:.1} to {:.1} {unit}: the \
                 force is extrapolated",
                prepared.recording.path,
                channel.lowest * scale,
                channel.highest * scale,
                low * scale,
                high * scale
            ));
        }
    }
    words
}

impl Prepared {
    /// Takes what friction was at the beginning of every segment from the force that was recorded there, as all of an augmented
    /// `model` has it, in recording `index` of those that it was fitted to or in another: what effects do is not taken for friction.
    /// Those samples stay unsettled, but where nothing moves at all.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn begin_with(
        &mut self,
        model: &AugmentedModel,
        thresholds: Thresholds,
        index: usize,
    ) -> Result<(), IdentifyError> {
        let unknown = self.direction.unknown_until().filter(|_| self.recording.samples.has_force());
        let Some(n_rows) = unknown else { return Ok(()) };
        self.direction.assume(0.0);
        let mut forces_n = Vec::with_capacity(n_rows);
        let mut contracting = model.start_in(index);
        walk_rows(self, model, thresholds, index, n_rows, &mut |instant, moment, neither_n| {
            let direction = if self.direction.is_known(instant.row) { moment.direction } else { 1.0 };
            forces_n.push([neither_n, contracting.force_n(model, Moment { direction, ..*moment })]);
        })
        .map_err(|reason| self.unreadable(reason))?;
        self.begin_where(thresholds.standstill, &|row, _, _| forces_n[row])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::effects::{Term, effect};

    use crate::prepare::tests::{HELD, held, moving, state};
    use crate::testing::model;

    /// The force that `model` has there in a state of friction.
    fn forces_n(model: &AugmentedModel, state: f64) -> Vec<f64> {
        let mut prepared = held(&[0.0; 300]);
        prepared.direction.assume(state);
        let mut forces_n = Vec::new();
        walk_augmented(&prepared, model, HELD, 0, &mut |_, force_n| forces_n.push(force_n)).unwrap();
        forces_n
    }

    #[test]
    fn what_effects_add_to_friction_at_rest_is_not_taken_for_more_of_it() {
        let stribeck = Term::new(effect("stribeck").unwrap(), vec![5e-3, 1.0, 0.0], vec![6e-4]);
        let augmented = AugmentedModel::new(model(), vec![stribeck]);
        let mut still = held(&forces_n(&augmented, 0.5));
        still.begin_with(&augmented, HELD, 0).unwrap();
        assert_eq!(state(&still), 0.5);
        still.begin_with(&AugmentedModel::from(model()), HELD, 0).unwrap();
        assert!(state(&still) > 0.5, "eq. 11 alone needs more: {}", state(&still));
    }

    #[test]
    fn what_effects_add_before_the_first_motion_is_not_taken_for_friction() {
        let stiff = Term::new(effect("threshold-pressure").unwrap(), vec![3e4], vec![]);
        let augmented = AugmentedModel::new(model(), vec![stiff]);
        let rows = || (0..300).map(f64::from);
        let time_s: Vec<f64> = rows().map(|row| 0.01 * row).collect();
        let pressure_pa: Vec<f64> = rows().map(|row| 2e5 + 100.0 * row).collect();
        let length_m: Vec<f64> = rows().map(|row| 0.25 - 1e-4 * f64::max(row - 200.0, 0.0)).collect();
        let with = |force_n: &[f64]| moving(&time_s, &pressure_pa, &length_m, force_n);
        let mut prepared = with(&[0.0; 300]);
        let unknown = prepared.direction.unknown_until().expect("a rest");
        prepared.direction.assume(-0.4);
        let forces_n = augmented_forces_n(&prepared, &augmented, HELD).unwrap();
        let begun = |model: &AugmentedModel| {
            let mut prepared = with(&forces_n);
            prepared.begin_with(model, HELD, 0).unwrap();
            (0..unknown).map(|row| prepared.direction.sign(row)).collect::<Vec<f64>>()
        };
        assert_eq!(begun(&augmented), vec![-0.4; unknown]);
        assert_ne!(
            begun(&AugmentedModel::from(model())),
            vec![-0.4; unknown],
            "eq. 11 alone takes the effect for friction"
        );
    }
}
