use super::*;

use pam_artifact::model::FitStatistics;
use pam_identification::prepare::Prepared;

use crate::coverage::tests::trace_of;
use crate::given::tests::{STROKES, another, artifact, diagnosed, recorded};
use crate::pooled::Pooled;

/// The same strokes, begun a little later.
fn later(time_s: f64) -> (f64, f64) {
    STROKES(time_s + 4.0)
}

/// The same strokes at pressures that no other recording has.
fn high(time_s: f64) -> (f64, f64) {
    let (pressure_pa, length_m) = STROKES(time_s);
    (pressure_pa + 5e5, length_m)
}

/// What is said of recordings that were held out of a diagnosis of the model's own muscle.
fn held(holdout: Vec<Prepared>) -> Held {
    let found = diagnosed(holdout);
    let agreement = Agreement::of(&found).expect("agreement");
    judge(&found, &agreement).expect("a judgment")
}

#[test]
fn what_is_left_is_a_root_mean_square_over_what_counts() {
    let trace = trace_of([1e5; 4], [3.0, -4.0, 0.0, 1e3]);
    assert!((rmse_n(&trace) - (25.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    let nothing = Trace { settled: vec![false; 4], ..trace };
    assert_eq!(rmse_n(&nothing), 0.0);
}

#[test]
fn another_muscle_is_missed_by_far_more_than_others_and_wherever_it_goes() {
    assert!(is_of_another(5.0, 2.0, 1.0, 2.0));
    assert!(!is_of_another(3.9, 2.0, 1.0, 1.0), "by no more than a memory that goes on");
    assert!(!is_of_another(5.0, 2.0, 1.0, 2.6), "by no more than others");
    assert!(!is_of_another(5.0, 1.4, 1.0, 2.0), "at a few stretches");
    assert!(is_of_another(11.0, 1.4, 1.0, 2.0), "at a few stretches, by far");
}

#[test]
fn a_hold_out_of_the_same_muscle_is_not_missed() {
    let held = held(vec![recorded("again.csv", later, &artifact(), 1.0)]);
    assert!(held.missed.is_empty() && held.noticed.is_empty() && held.unjudged.is_empty(), "{held:?}");
}

#[test]
fn a_load_cell_that_reads_too_much_is_the_reason_where_it_explains_a_hold_out() {
    let held = held(vec![recorded("gain.csv", STROKES, &artifact(), 1.15)]);
    let [missed] = &held.missed[..] else { panic!("{held:?}") };
    assert!(missed.starts_with("gain.csv is missed by") && missed.contains("force"), "{missed}");
    assert!(!missed.contains("another muscle"), "{missed}");
}

#[test]
fn a_zero_of_the_force_within_what_a_tare_may_be_is_one_and_nothing_else_is() {
    let reading = |channel, wrong| Reading { channel, wrong, left_n: 0.3 };
    let zero = |newtons| is_tare(&reading("force", Wrong::Zero(newtons)), 1.0);
    assert!(zero(0.9) && zero(-0.9) && !zero(1.1) && !zero(-1.1));
    let never = [reading("pressure", Wrong::Zero(0.5)), reading("force", Wrong::Gain(0.99))];
    assert!(never.iter().all(|reading| !is_tare(reading, 1.0)));
}

#[test]
fn a_hold_out_of_another_muscle_is_said_to_be_one() {
    let held = held(vec![recorded("other.csv", STROKES, &another(), 1.0)]);
    let [missed] = &held.missed[..] else { panic!("{held:?}") };
    assert!(missed.starts_with("other.csv is missed by"), "{missed}");
}

#[test]
fn a_hold_out_far_from_every_fitted_recording_says_nothing_of_the_muscle() {
    let held = held(vec![recorded("high.csv", high, &another(), 1.0)]);
    assert!(held.noticed.iter().any(|said| said.starts_with("high.csv is at pressures and lengths")), "{held:?}");
    assert!(held.missed.iter().all(|said| !said.contains("another muscle")), "{held:?}");
}

#[test]
fn a_hold_out_that_one_model_follows_with_the_others_is_of_no_other_muscle() {
    let mut found = diagnosed(vec![recorded("other.csv", STROKES, &another(), 1.0)]);
    let agreement = Agreement::of(&found).expect("agreement");
    let mut is_missed = |pooled_n: f64| {
        let held = agreement.holdout.each.iter().map(|each| FitStatistics { rmse_n: pooled_n, ..*each }).collect();
        found.pooled = Some(Pooled { held, typically_n: None });
        let Held { missed, followed, .. } = judge(&found, &agreement).expect("a judgment");
        assert_eq!(missed.len() + followed.len(), 1);
        !missed.is_empty()
    };
    assert!(!is_missed(0.3) && is_missed(3.0));
}

#[test]
fn one_recording_that_is_followed_worse_than_the_fitted_ones_is_seen_among_others() {
    let found = diagnosed(vec![recorded("later.csv", later, &artifact(), 1.0)]);
    let agreement = Agreement::of(&found).expect("agreement");
    let (fitted, mut held) = (&agreement.estimation, agreement.holdout.clone());
    assert!(!misses_any(fitted, &held));
    held.each.push(FitStatistics { rmse_n: 2.0 * fitted.together.expect("samples").rmse_n, ..held.each[0] });
    assert!(misses_any(fitted, &held));
}
