//! Effects of the rig that are known from elsewhere, taken off the recordings before anything is searched in them.
//!
//! What an effect changes of the channels is put right in every moment, and its pull is taken off the force; a search on such a
//! track finds what is left for the muscle, whatever it is. No value that muscles share is exactly right for each, and no effect
//! has exactly the form of its page: other forms of it stay in as nuisances ([`mod@crate::forms`]), so that what is left of the rig's
//! gets no name in a muscle. The augmented model has the same effects before those of the muscle,
//! in the same order, so that both say the same.

use pam_artifact::ModelArtifact;
use pam_artifact::model::{EffectEntry, ParameterEntry, ParameterStatus};
use pam_identification::error::IdentifyError;
use pam_identification::prepare::Prepared;
use pam_muscle::effects::{AugmentedModel, Base, Effect, Kind, Memory, Term};
use pam_muscle::force::ForceModel;
use pam_muscle::shift::shifted;

use crate::forms;
use crate::track::Track;

/// The lag of the tube, which the catalogue counts among the muscle's: on one rig all muscles hang on the same valve and tube.
const TUBE: &str = "pressure-lag";

/// Whether muscles on one rig share `effect`.
pub(crate) fn is_of_the_rig(effect: &dyn Effect) -> bool {
    matches!(effect.kind(), Kind::Instrument | Kind::Fixture) || effect.page().id == TUBE
}

/// The grid of `recordings` of the muscle of `model`, without what `rig` does there.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub(crate) fn track(recordings: &[Prepared], model: &ModelArtifact, rig: &[Term]) -> Result<Track, IdentifyError> {
    let force = model.force_model();
    Ok(without(Track::of(recordings, model.direction, &force)?, rig, &force))
}

/// `track` without what `rig` does there; `base` is what its pulls take of eq. 11.
fn without(mut track: Track, rig: &[Term], base: &ForceModel) -> Track {
    if rig.is_empty() {
        return track;
    }
    track.known_forms_n = forms::of_known_n(&track, base, rig);
    let delays_s = AugmentedModel::new(base.clone(), rig.to_vec()).delays_s();
    for range in track.recordings.clone() {
        let instants = &mut track.instants[range];
        let moments = shifted(instants, delays_s);
        let mut memories: Vec<Box<dyn Memory>> =
            rig.iter().map(|term| term.effect.start(base.muscle(), &term.shape)).collect();
        for (instant, mut now) in instants.iter_mut().zip(moments) {
            for memory in &mut memories {
                memory.sees(&mut now);
            }
            let here = Base::of(base, now.pressure_pa, now.length_m);
            for (term, memory) in rig.iter().zip(&mut memories) {
                let mut columns = vec![0.0; term.amplitudes.len()];
                memory.pulls(&now, &here, &mut columns);
                instant.force_n -=
                    columns.iter().zip(&term.amplitudes).map(|(column, amplitude)| column * amplitude).sum::<f64>();
            }
            instant.moment = now;
        }
    }
    track
}

/// `model` with what `rig` does on top of its base.
pub(crate) fn beside(rig: &[Term], model: &AugmentedModel) -> AugmentedModel {
    AugmentedModel::new(model.base().clone(), rig.iter().chain(model.terms()).cloned().collect())
}

/// `term` as a model artifact has it; its standard errors are those of the group that it was found in.
pub(crate) fn entry(term: &Term) -> EffectEntry {
    let shapes = term.effect.shape().iter().map(|shape| (shape.name, shape.unit));
    let amplitudes = term.effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit));
    let values = term.shape.iter().chain(&term.amplitudes);
    let parameters = shapes.chain(amplitudes).zip(values).map(|((name, unit), &value)| ParameterEntry {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        stderr: None,
        status: ParameterStatus::Fixed,
    });
    EffectEntry::new(term.effect.page().id, parameters.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hypothesis::CandidateEffect;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, search};
    use crate::state::Setting;

    use pam_muscle::effects::{CATALOGUE, effect};

    /// Largest difference of pressures and forces between two tracks of the same instants.
    fn apart(left: &Track, right: &Track) -> (f64, f64) {
        left.instants.iter().zip(&right.instants).fold((0.0, 0.0), |(pascals, newtons), (left, right)| {
            let pressure = (left.moment.pressure_pa - right.moment.pressure_pa).abs();
            (f64::max(pascals, pressure), f64::max(newtons, (left.force_n - right.force_n).abs()))
        })
    }

    #[test]
    fn a_pull_that_is_taken_off_leaves_the_force_of_the_muscle() {
        let term = |id: &str, shape: &[f64], amplitudes: &[f64]| {
            Term::new(effect(id).expect("an id"), shape.to_vec(), amplitudes.to_vec())
        };
        let plain = Given::of(&["multisine"], &[]);
        let heavy = Given::of(&["multisine"], &[("inertia", &[200.0], &[3.0])]);
        assert!(apart(&heavy.track, &plain.track).1 > 0.1);
        let relieved = without(heavy.track.clone(), &[term("inertia", &[200.0], &[3.0])], &heavy.model);
        assert!(apart(&relieved, &plain.track).1 < 1e-9);
    }

    #[test]
    fn what_is_left_of_a_value_that_is_not_exactly_right_gets_no_name() {
        let mut given =
            Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        let lag = Term::new(effect("pressure-lag").expect("an id"), vec![0.11, 0.0], Vec::new());
        let track = without(given.track.clone(), &[lag], &given.model);
        let of_the_rig = CATALOGUE.iter().filter(|effect| is_of_the_rig(**effect));
        let excluded = of_the_rig.map(|effect| effect.page().id.to_owned()).collect();
        let limits = Limits { excluded, ..Limits::of_test(3, 0.3) };
        let named = |track: &Track| -> Vec<&str> {
            let setting = Setting { track, floor_square: 0.09, ..given.setting() };
            let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
            found.best.state.guesses.iter().map(CandidateEffect::id).collect()
        };
        assert_eq!(named(&track), Vec::<&str>::new());
        assert!(!named(&Track { known_forms_n: Vec::new(), ..track }).is_empty());
    }

    #[test]
    fn nothing_known_leaves_the_track_as_it_is_and_a_lag_changes_its_pressures() {
        let given = Given::of(&["multisine"], &[]);
        let lag = Term::new(effect("pressure-lag").expect("an id"), vec![0.1, 0.0], Vec::new());
        assert_eq!(apart(&without(given.track.clone(), &[], &given.model), &given.track), (0.0, 0.0));
        assert!(apart(&without(given.track.clone(), &[lag], &given.model), &given.track).0 > 100.0);
    }

    #[test]
    fn delays_compliance_and_masses_are_the_rigs_and_friction_is_not() {
        let shared: Vec<&str> =
            CATALOGUE.iter().filter(|effect| is_of_the_rig(**effect)).map(|effect| effect.page().id).collect();
        assert_eq!(
            shared,
            [
                "channel-delay",
                "pressure-gauge-hysteresis",
                "force-drift",
                "series-compliance",
                "inertia",
                "pressure-lag"
            ]
        );
    }
}
