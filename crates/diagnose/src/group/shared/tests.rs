use super::*;

use crate::hypothesis::Sign;

fn mass() -> CandidateEffect {
    let effect = pam_muscle::effects::effect("inertia").expect("an id");
    CandidateEffect { effect, shape: vec![200.0], sign: Sign::Any, beginning: Beginning::Fresh }
}

fn estimate(mass_kg: f64, error_kg: f64) -> Estimate {
    Estimate { values: vec![200.0, mass_kg], errors: vec![None, Some(error_kg)] }
}

#[test]
fn shapes_that_make_up_for_one_another_are_found_both() {
    let effect = pam_muscle::effects::effect("channel-delay").expect("an id");
    let start = CandidateEffect { effect, shape: vec![0.005, 0.02], sign: Sign::Any, beginning: Beginning::Fresh };
    // A valley along the sum, which steps along one shape at a time do not get out of.
    let gains = |guess: &CandidateEffect| {
        let (pressure_s, length_s) = (guess.shape[0], guess.shape[1] - 0.025);
        Some(-((pressure_s + length_s) / 1e-4).powi(2) - ((pressure_s - length_s) / 0.02).powi(2))
    };
    let found = descended(start.clone(), gains(&start).expect("a gain"), 1.0, ROUNDS, &gains);
    assert!(found.shape[0].abs() < 5e-4 && (found.shape[1] - 0.025).abs() < 5e-4, "{found:?}");
}

#[test]
fn amplitudes_are_averaged_by_what_each_muscle_knows_of_them() {
    let (sure, unsure) = (estimate(2.0, 0.1), estimate(5.0, 1.0));
    let shared = pooled(&mass(), &[&sure, &unsure], &[0.0]);
    assert!((shared.values[1] - (2.0 + 5.0 / 100.0) / 1.01).abs() < 1e-12);
    assert!(shared.errors[0].is_none());
    // They agree less than they claim to.
    assert!(shared.errors[1].is_some_and(|error| error > 1.0));
    let alike = pooled(&mass(), &[&sure, &estimate(2.01, 0.1)], &[0.0]);
    assert!(alike.errors[1].is_some_and(|error| (error - 0.1 / 2.0_f64.sqrt()).abs() < 1e-9));
}

#[test]
fn a_value_is_apart_where_neither_chance_nor_size_excuses_it() {
    let shared = estimate(2.0, 0.05);
    assert!(is_apart(&mass(), &estimate(3.5, 0.2), &shared));
    assert!(!is_apart(&mass(), &estimate(3.5, 0.6), &shared));
    assert!(!is_apart(&mass(), &estimate(2.4, 0.01), &shared));
}
