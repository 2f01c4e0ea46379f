use super::*;

use pam_artifact::diagnosis::DiagnoseConfig;
use pam_identification::prepare::{direct, gate};
use pam_recording::{Recording, Repairs, Samples};

use crate::diagnose::{Diagnosis, Request, diagnose};
use crate::search::Limits;

/// A model as pam-identify wrote it.
pub(crate) fn artifact() -> ModelArtifact {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scripts/fuzz/seeds/model/plain.json");
    ModelArtifact::read(std::path::Path::new(path)).expect("a model").0
}

/// The model with stiffer rubber and a gas force that narrows sooner: another muscle.
pub(crate) fn another() -> ModelArtifact {
    let mut model = artifact();
    for entry in &mut model.parameters {
        match entry.name.as_str() {
            "k2" => entry.value *= 1.12,
            "c10" | "c01" => entry.value *= 1.8,
            _ => (),
        }
    }
    model
}

/// Pressure, in Pa, and length, in m, at a time, in s.
pub(crate) type Path = fn(f64) -> (f64, f64);

/// Up and down between 0 and 1 in a period.
fn triangle(time_s: f64, period_s: f64) -> f64 {
    let share = (time_s / period_s).fract();
    1.0 - (2.0 * share - 1.0).abs()
}

/// Strokes of 30 mm at pressures that climb.
pub(crate) const STROKES: Path = |time_s| {
    let (stroke, share) = ((time_s / 15.0).floor(), (time_s / 15.0).fract());
    (1e5 + 1e5 * (stroke + (5.0 * share).min(1.0)).min(4.0), 0.262 - 0.03 * triangle(time_s, 15.0))
};

/// Ramps of the pressure at lengths that shorten.
pub(crate) const RAMPS: Path = |time_s| {
    let (ramp, share) = ((time_s / 15.0).floor(), (time_s / 15.0).fract());
    (2e4 + 4.5e5 * triangle(time_s, 15.0), 0.262 - 0.01 * (ramp + (5.0 * share - 4.0).max(0.0)).min(3.0))
};

/// A minute along `path` of the muscle of `model`, at 50 Hz, whose load cell reads `gain` times the force, with noise
/// of up to half a newton.
pub(crate) fn recorded(name: &str, path: Path, model: &ModelArtifact, gain: f64) -> Prepared {
    knocked(name, path, model, gain, 0.0)
}

/// Bits of a number, well mixed, as one between -0.5 and 0.5.
fn mixed(number: u32) -> f64 {
    f64::from(number.wrapping_mul(0x9e37_79b1).rotate_left(15).wrapping_mul(0x85eb_ca6b) >> 8) / f64::from(1 << 24)
        - 0.5
}

/// The same, knocked by `knock_n` one way or the other for a third of a second, in one of twelve such times.
pub(crate) fn knocked(name: &str, path: Path, model: &ModelArtifact, gain: f64, knock_n: f64) -> Prepared {
    let rows = 0..3000_u32;
    let time_s: Vec<f64> = rows.clone().map(|row| 0.02 * f64::from(row)).collect();
    let (pressure_pa, length_m): (Vec<f64>, Vec<f64>) = time_s.iter().map(|&time_s| path(time_s)).unzip();
    let prepare = |force_n: &[f64]| {
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, force_n);
        let recording = Recording {
            path: name.to_owned(),
            sha256: String::new(),
            segments: std::iter::once(0..samples.n_rows()).collect(),
            samples,
            repairs: Repairs::default(),
            ignored_columns: Vec::new(),
        };
        direct(gate(vec![recording]).expect("samples"), model.direction, model.form).expect("directions").remove(0)
    };
    // The direction as it will be found: what is tried is the force.
    let still = prepare(&vec![0.0; time_s.len()]);
    let trace = pam_identification::trace::trace(&still, &model.force_model()).expect("a trace");
    let of_knock_n = |row: u32| {
        let at = mixed(row / 16);
        if at.abs() < 1.0 / 24.0 { knock_n.copysign(at) } else { 0.0 }
    };
    let reads_n = |(force_n, row): (&f64, u32)| gain * (force_n + mixed(row) + of_knock_n(row));
    let force_n: Vec<f64> = trace.model_n.iter().zip(rows).map(reads_n).collect();
    prepare(&force_n)
}

/// A diagnosis of strokes and ramps of the model's own muscle, which names one effect at most.
pub(crate) fn diagnosed(holdout: Vec<Prepared>) -> Diagnosis {
    diagnosed_knocked(0.0, holdout)
}

/// The same, knocked by `knock_n`.
pub(crate) fn diagnosed_knocked(knock_n: f64, holdout: Vec<Prepared>) -> Diagnosis {
    let model = artifact();
    let own = |name, path| knocked(name, path, &model, 1.0, knock_n).recording;
    diagnose(Request {
        estimation: vec![own("strokes.csv", STROKES), own("ramps.csv", RAMPS)],
        holdout: holdout.into_iter().map(|prepared| prepared.recording).collect(),
        model,
        config: DiagnoseConfig { matters_above_n: None, max_effects: 1, excluded: Vec::new() },
        effects: Vec::new(),
        rig: Vec::new(),
        accept_implausible: true,
    })
    .expect("a diagnosis")
}

/// The model against recordings whose load cell reads `gain` times the force.
fn given(gain: f64) -> Given {
    let model = artifact();
    let estimation =
        [("strokes.csv", STROKES), ("ramps.csv", RAMPS)].map(|(name, path)| recorded(name, path, &model, gain));
    let question = DiagnosisProblem::new(&estimation, &model, Limits::of_test(3, 0.6));
    Given::of(&question, &[]).expect("a comparison")
}

/// A model that leaves 10 N of a force of which it explains `r2`, where a refit leaves `refitted_n`.
fn missing(r2: f64, refitted_n: f64) -> Given {
    let fit = |rmse_n: f64| FitStatistics {
        rmse_n,
        rmse_all_n: rmse_n,
        max_n: 2.0 * rmse_n,
        r2,
        fit_percent: 50.0,
        n_samples: 100,
        n_unsettled: 0,
    };
    Given {
        estimation: Evaluation { together: Some(fit(10.0)), each: vec![fit(10.0)] },
        holdout: Evaluation { together: None, each: Vec::new() },
        refitted: fit(refitted_n),
        shifts: Vec::new(),
        misses: true,
        instrument: None,
        holdout_missed: Vec::new(),
    }
}

fn shifts(standard_errors: &[(&str, Option<f64>)]) -> Vec<Shift> {
    let shift = |(name, errors): &(&str, Option<f64>)| Shift {
        parameter: (*name).to_owned(),
        given: 1.0,
        refitted: 2.0,
        unit: "1".to_owned(),
        stderr: errors.map(|errors| 1.0 / errors),
        standard_errors: *errors,
    };
    standard_errors.iter().map(shift).collect()
}

#[test]
fn a_model_follows_recordings_of_its_own_muscle() {
    let given = given(1.0);
    assert!(!given.misses, "{:?}", given.estimation);
    assert_eq!(given.instrument, None);
    assert!((together(&given.estimation).rmse_n - given.refitted.rmse_n).abs() < 0.2);
}

#[test]
fn a_load_cell_that_reads_a_fifth_too_much_is_missed_and_named() {
    let given = given(1.2);
    assert!(given.misses);
    let instrument = given.instrument.as_deref().expect("a fault");
    assert!(instrument.contains("force"), "{instrument}");
    assert!(given.shifted().is_some());
    // The one that moved most stands first.
    let errors: Vec<f64> = given.shifts.iter().filter_map(|shift| Some(shift.standard_errors?.abs())).collect();
    assert!(errors.is_sorted_by(|left, right| left >= right), "{errors:?}");
}

#[test]
fn recordings_are_of_another_muscle_where_little_is_explained_and_a_refit_halves_it() {
    let model = artifact();
    let recordings = [recorded("strokes.csv", STROKES, &model, 1.0)];
    let refused = |given: &Given| given.refuse_another_muscle(&recordings).is_err();
    assert!(refused(&missing(0.8, 2.0)));
    assert!(!refused(&missing(0.95, 2.0)), "most is explained");
    assert!(!refused(&missing(0.8, 6.0)), "a refit helps little");
    assert!(!refused(&Given { misses: false, ..missing(0.8, 2.0) }), "nothing is missed");
    let instrument = Some("the force reads 1.2 times too much".to_owned());
    let said = Given { instrument, ..missing(0.8, 2.0) }.refuse_another_muscle(&recordings).unwrap_err().to_string();
    assert!(
        said.contains("strokes.csv") && said.contains("reads 1.2 times too much, or they are of another muscle"),
        "{said}"
    );
}

#[test]
fn no_more_than_three_parameters_are_said_to_have_moved_and_none_by_less_than_two_errors() {
    let said = |errors: &[(&str, Option<f64>)]| Given { shifts: shifts(errors), ..missing(0.8, 2.0) }.shifted();
    let many = [("k1", Some(-9.0)), ("k2", Some(7.0)), ("k3", Some(5.0)), ("c10", Some(4.0))];
    assert_eq!(said(&many).as_deref(), Some("k1 shifted by 9 standard errors, k2 by 7, k3 by 5"));
    assert_eq!(said(&[("k1", Some(1.9)), ("k2", None)]), None);
    assert_eq!(said(&[("k1", None), ("k2", Some(2.0))]).as_deref(), Some("k2 shifted by 2 standard errors"));
}

#[test]
fn a_shift_counts_the_errors_of_both_values() {
    let model = artifact();
    let own = model.parameters.iter().find(|entry| entry.name == "k1").expect("k1");
    let (value, known) = (own.value, own.stderr.expect("an error"));
    let k1 = |stderr| shift(&model, Free::One(Parameter::K1), value + 0.01, stderr);
    assert!((k1(None).stderr.unwrap() / known - 1.0).abs() < 1e-12);
    let both = k1(Some(known));
    assert!((both.stderr.unwrap() / (2.0_f64.sqrt() * known) - 1.0).abs() < 1e-12);
    assert!((both.standard_errors.unwrap() * both.stderr.unwrap() - 0.01).abs() < 1e-12);
    // An error that is none says nothing.
    assert_eq!(k1(Some(f64::NAN)).stderr, k1(None).stderr);
}

#[test]
fn a_shift_of_the_modulus_is_one_of_the_modulus_and_not_of_its_inverse() {
    let model = artifact();
    let own = model.parameters.iter().find(|entry| entry.name == "strand_modulus").expect("a modulus");
    let twice = shift(&model, Free::One(Parameter::StrandCompliance), 0.5 / own.value, None);
    assert_eq!(twice.unit, "Pa");
    assert!((twice.given / own.value - 1.0).abs() < 1e-9 && (twice.refitted / own.value - 2.0).abs() < 1e-9);
    // δE = E² δ(1/E), between the two values E and 2 E.
    assert!((twice.stderr.unwrap() / own.stderr.unwrap() - 2.0).abs() < 1e-9);
    assert!(twice.standard_errors.unwrap() > 0.0);
}

#[test]
fn effects_that_explain_what_the_parameters_as_given_miss_take_it_back() {
    let model = artifact();
    let mut strokes = recorded("strokes.csv", STROKES, &model, 1.0);
    let ramps = recorded("ramps.csv", RAMPS, &model, 1.0);
    // The same parameters, recorded by a rig whose gauge lags by 0.4 s: nothing that eq. 11 has follows that.
    let lag = pam_muscle::effects::effect("pressure-lag").expect("an id");
    let lagging =
        AugmentedModel::new(model.force_model(), vec![pam_muscle::effects::Term::new(lag, vec![0.4, 0.0], vec![])]);
    let estimation = {
        let as_modelled = |prepared: &Prepared| {
            let trace = trace_augmented(prepared, &lagging, model.direction, 0).expect("a trace");
            let samples = Samples::from_columns(&trace.time_s, &trace.pressure_pa, &trace.length_m, &trace.model_n);
            let mut recording = prepared.recording.clone();
            recording.samples = samples;
            direct(gate(vec![recording]).expect("samples"), model.direction, model.form).expect("directions").remove(0)
        };
        strokes = as_modelled(&strokes);
        [strokes, as_modelled(&ramps)]
    };
    let question = DiagnosisProblem::new(&estimation, &model, Limits::of_test(3, 0.6));
    let mut given = Given::of(&question, &[]).expect("a comparison");
    given.misses = true;
    let track = crate::rig::track(&estimation, &model, &[]).expect("a track");
    let mut outcome = question.answer(&track, &|| {}).expect("a search");
    let found = &mut outcome.found;
    let names: Vec<&str> = found.best.state.guesses.iter().map(|guess| guess.id()).collect();
    assert_eq!(names, ["pressure-lag"]);
    given.beside_effects(&question, &track, found, false);
    assert!(!given.misses);
    // Where nothing was found, it stays as it is.
    given.misses = true;
    found.best.state.guesses.clear();
    given.beside_effects(&question, &track, found, false);
    assert!(given.misses);
}
