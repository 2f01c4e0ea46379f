use super::*;

use pam_artifact::ModelArtifact;
use pam_identification::prepare::{direct, gate};
use pam_identification::trace::trace;
use pam_recording::Samples;

use crate::given::tests::{Path, RAMPS, STROKES, artifact, recorded};
use crate::search::Limits;

/// Recordings of a muscle whose friction at standstill follows `law`, with directions found under the law of `model`.
fn made_under(law: Standstill, model: &ModelArtifact) -> Vec<Prepared> {
    let mut maker = model.clone();
    maker.direction.standstill = law;
    let made = |(name, path): (&str, Path)| {
        let prepared = recorded(name, path, &maker, 1.0);
        let of_maker = trace(&prepared, &maker.force_model()).expect("a trace");
        let samples =
            Samples::from_columns(&of_maker.time_s, &of_maker.pressure_pa, &of_maker.length_m, &of_maker.force_n);
        let mut recording = prepared.recording;
        recording.samples = samples;
        direct(gate(vec![recording]).expect("samples"), model.direction, model.form).expect("directions").remove(0)
    };
    [("strokes.csv", STROKES), ("ramps.csv", RAMPS)].map(made).into()
}

/// The law that is taken for recordings made under `law` by a model that assumes `assumed`.
fn taken(law: Standstill, assumed: Standstill, change: impl Fn(&mut ModelArtifact)) -> Option<Standstill> {
    let mut model = artifact();
    model.direction.standstill = assumed;
    change(&mut model);
    let estimation = made_under(law, &model);
    // Nothing is looked for: the base alone.
    let question = DiagnosisProblem::new(&estimation, &model, Limits::of_test(0, 0.6));
    let track = crate::rig::track(&estimation, &model, &[]).expect("a track");
    let outcome = question.answer(&track, &|| {}).expect("a search");
    better(&question, &track, &outcome.found, model.direction).expect("directions")
}

#[test]
fn friction_that_turns_with_the_pressure_at_once_is_found_where_it_was_thought_to_be_held() {
    assert_eq!(taken(Standstill::AT_ONCE, Standstill::Held, |_| ()), Some(Standstill::AT_ONCE));
}

#[test]
fn friction_that_is_held_is_found_where_it_was_thought_to_turn() {
    assert_eq!(taken(Standstill::Held, Standstill::AT_ONCE, |_| ()), Some(Standstill::Held));
}

#[test]
fn friction_that_relaxes_within_seconds_is_found_and_is_none_that_is_held() {
    let relaxes = |law: Option<Standstill>| matches!(law, Some(Standstill::Relaxes { .. }));
    // Within less than a second, on ramps of 15 s, it is friction that sticks: hardly any is left of it.
    for (time_constant_s, to) in [(2.0, 0.5), (1.5, 0.3), (4.0, 0.7), (20.0, 0.0)] {
        let law = Standstill::Relaxes { time_constant_s, to };
        let taken = taken(law, Standstill::Held, |_| ());
        assert!(relaxes(taken), "{law:?}: {taken:?}");
    }
    let assumed = Standstill::Relaxes { time_constant_s: 2.0, to: 0.5 };
    assert_eq!(taken(Standstill::Held, assumed, |_| ()), Some(Standstill::Held));
}

#[test]
fn the_law_that_the_recordings_were_made_under_is_kept() {
    for law in [Standstill::Held, Standstill::AT_ONCE] {
        assert_eq!(taken(law, law, |_| ()), None, "{law:?}");
    }
}

#[test]
fn a_law_that_the_user_has_chosen_is_not_judged_again() {
    let chosen = |model: &mut ModelArtifact| model.config.assumed.standstill = Some(Standstill::Held);
    assert_eq!(taken(Standstill::AT_ONCE, Standstill::Held, chosen), None);
}
