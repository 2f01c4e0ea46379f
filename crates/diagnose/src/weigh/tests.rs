use super::*;

use std::sync::OnceLock;

use pam_artifact::diagnosis::{NamedEffect, Periodic};
use pam_artifact::model::FitStatistics;

use crate::elsewhere::KeptToFitted;
use crate::given::tests::{STROKES, artifact, diagnosed, recorded};
use crate::joint::HeldOut;
use crate::pooled::Pooled;

/// The same strokes, begun a little later.
fn later(time_s: f64) -> (f64, f64) {
    STROKES(time_s + 4.0)
}

/// A diagnosis of the model's own muscle, in which nothing is missing, with what it says of the recordings; `change` makes of them
/// what is to be weighed.
fn weighed(change: impl FnOnce(&mut Diagnosis, &mut Agreement)) -> Diagnosis {
    static FOUND: OnceLock<Diagnosis> = OnceLock::new();
    let mut found = FOUND.get_or_init(|| diagnosed(vec![recorded("later.csv", later, &artifact(), 1.0)])).clone();
    let mut agreement = Agreement::of(&found).expect("agreement");
    change(&mut found, &mut agreement);
    found.weigh(&agreement).expect("a weighed diagnosis");
    found
}

/// `agreement` in which the base, and the model as it is written, leave `times` the noise floor of what was held out.
fn base_leaves(agreement: &mut Agreement, times: f64) {
    agreement.base_holdout.together.as_mut().expect("a hold-out").rmse_all_n = times * agreement.noise_floor_n;
    written_leaves(agreement, times);
}

/// The same of the model as it is written alone.
fn written_leaves(agreement: &mut Agreement, times: f64) {
    agreement.holdout.together.as_mut().expect("a hold-out").rmse_all_n = times * agreement.noise_floor_n;
}

/// A lag as it is named, without values.
fn lag() -> NamedEffect {
    let page = pam_muscle::effects::effect("pressure-lag").expect("an id").page();
    let without = HeldOut { blocks: vec![4.0; 8], counts: vec![10.0; 8], floor_square: 0.01 };
    let with = HeldOut { blocks: vec![1.0; 8], ..without.clone() };
    NamedEffect {
        id: page.id.to_owned(),
        name: page.name.to_owned(),
        equation: page.equation.to_owned(),
        parameters: Vec::new(),
        evidence: crate::named::evidence(&without, &with, 1),
        alternatives: Vec::new(),
        separating_test: page.test.to_owned(),
    }
}

#[test]
fn what_lacks_nothing_stays_consistent_and_says_so() {
    let found = weighed(|_, _| ());
    assert_eq!(found.verdict, Verdict::Consistent);
    assert!(!found.statement.is_empty() && !found.has_map());
}

#[test]
fn hold_outs_that_the_base_follows_make_what_is_unexplained_consistent() {
    let unexplained = |times: f64| {
        weighed(|found, agreement| {
            found.verdict = Verdict::Unexplained;
            base_leaves(agreement, times);
        })
    };
    assert_eq!(unexplained(1.9).verdict, Verdict::Consistent);
    assert_eq!(unexplained(2.1).verdict, Verdict::Unexplained);
    let nameless = weighed(|found, agreement| {
        found.verdict = Verdict::Unexplained;
        found.nameless = vec![("fatigue-wear", "a clamp that creeps under the load")];
        base_leaves(agreement, 1.9);
    });
    assert_eq!(nameless.verdict, Verdict::Unexplained, "a force without a name is there");
    assert!(nameless.statement.contains("acts more like a clamp that creeps under the load"), "{}", nameless.statement);
    let of_a_rig = weighed(|found, agreement| {
        (found.verdict, found.as_well) = (Verdict::Unexplained, vec![("presliding-hysteresis", &crate::nameless::RIG)]);
        base_leaves(agreement, 1.9);
    });
    assert_eq!(of_a_rig.verdict, Verdict::Unexplained, "the rig may give");
    assert!(of_a_rig.statement.contains("may as well be a rig that gives or has play"), "{}", of_a_rig.statement);
    let without = weighed(|found, agreement| {
        found.verdict = Verdict::Unexplained;
        (agreement.base_holdout.together, agreement.holdout.together) = (None, None);
    });
    assert_eq!(without.verdict, Verdict::Unexplained, "nothing was held out");
}

#[test]
fn a_fitted_recording_that_is_missed_by_far_matters_however_well_hold_outs_are_followed() {
    let one_leaves = |times: f64| {
        let found = weighed(|found, agreement| {
            found.verdict = Verdict::Unexplained;
            base_leaves(agreement, 1.0);
            agreement.estimation.each[1].rmse_n = times * agreement.noise_floor_n;
        });
        found.verdict
    };
    assert_eq!((one_leaves(9.9), one_leaves(10.1)), (Verdict::Consistent, Verdict::Unexplained));
}

#[test]
fn what_is_typically_missed_stays_unexplained_whatever_hold_outs_say() {
    let found = weighed(|found, agreement| {
        (found.verdict, found.typically_misses) = (Verdict::Unexplained, true);
        base_leaves(agreement, 1.0);
    });
    assert_eq!(found.verdict, Verdict::Unexplained);
}

#[test]
fn a_swing_that_matters_is_neither_consistent_nor_explained_and_a_small_one_is_noticed() {
    let swings = |verdict, times: f64| {
        weighed(|found, agreement| {
            let amplitude_n = times * found.sizes.sensors_n * std::f64::consts::SQRT_2;
            found.periodic = Some(Periodic { frequency_hz: 3.5, amplitude_n, n_recordings: 3, n_looked_at: 4 });
            found.verdict = verdict;
            base_leaves(agreement, 1.0);
        })
    };
    let found = swings(Verdict::Unexplained, 1.1);
    assert_eq!(found.verdict, Verdict::Unexplained);
    assert!(found.statement.contains("at 3.5 Hz") && found.noticed.iter().all(|words| !words.contains("3.5 Hz")));
    let small = swings(Verdict::Unexplained, 0.9);
    assert_eq!(small.verdict, Verdict::Consistent);
    assert!(!small.statement.contains("3.5 Hz") && small.noticed.iter().any(|words| words.contains("at 3.5 Hz")));
    assert_eq!(swings(Verdict::Explained, 1.1).verdict, Verdict::ExplainedInPart);
}

#[test]
fn a_smooth_map_follows_hold_outs_for_a_muscle_until_it_takes_more_than_any_muscle_has() {
    let unexplained = |static_n| {
        weighed(|found, agreement| {
            (found.verdict, found.sizes.static_n) = (Verdict::Unexplained, static_n);
            base_leaves(agreement, 4.0);
            written_leaves(agreement, 1.9);
        })
        .verdict
    };
    assert_eq!(unexplained(None), Verdict::Consistent);
    assert_eq!(unexplained(Some(20.0)), Verdict::Unexplained);
}

#[test]
fn what_leaves_half_as_much_again_as_the_sensors_is_explained_in_part() {
    let explained = |times: f64| {
        weighed(|found, agreement| {
            found.verdict = Verdict::Explained;
            let left = agreement.estimation.together.as_mut().expect("recordings");
            left.rmse_all_n = times * found.sizes.sensors_n;
        })
    };
    assert_eq!(explained(1.4).verdict, Verdict::Explained);
    let part = explained(1.6);
    assert_eq!(part.verdict, Verdict::ExplainedInPart);
    assert!(part.statement.contains("Over all samples, reversals included"), "{}", part.statement);
}

#[test]
fn what_raises_the_error_of_what_was_held_out_is_explained_in_part_and_the_statement_says_so() {
    let explained = |names: bool, times: f64| {
        weighed(|found, agreement| {
            found.verdict = Verdict::Explained;
            if names {
                found.effects.push(lag());
            }
            base_leaves(agreement, 1.0);
            written_leaves(agreement, times);
        })
    };
    assert_eq!(explained(true, 1.0).verdict, Verdict::Explained);
    let raised = explained(true, 1.1);
    assert_eq!(raised.verdict, Verdict::ExplainedInPart);
    assert!(raised.statement.contains("held-out recordings are followed worse"), "{}", raised.statement);
    assert_eq!(explained(false, 1.1).verdict, Verdict::Explained, "nothing is named");
}

#[test]
fn a_name_that_is_kept_to_the_fitted_recordings_explains_in_part_and_a_map_takes_nothing_away() {
    let kept = |id| {
        weighed(|found, agreement| {
            found.verdict = Verdict::Explained;
            found.effects.push(lag());
            found.kept_to_fitted = Some(KeptToFitted { ids: vec![id], everywhere: found.augmented.clone() });
            base_leaves(agreement, 1.0);
            let with = FitStatistics { rmse_all_n: 6.22, ..agreement.holdout.together.expect("a hold-out") };
            agreement.holdout_everywhere = Some(with);
        })
    };
    let lag = kept("pressure-lag");
    assert_eq!(lag.verdict, Verdict::ExplainedInPart);
    assert!(lag.statement.contains("6.22 N are left with it"), "{}", lag.statement);
    assert_eq!(kept(MAP_ID).verdict, Verdict::Explained);
}

#[test]
fn a_model_that_is_missed_as_given_is_never_consistent_nor_explained() {
    let missed = |verdict| {
        weighed(|found, agreement| {
            (found.verdict, found.given.misses) = (verdict, true);
            base_leaves(agreement, 9.0);
        })
        .verdict
    };
    assert_eq!(missed(Verdict::Consistent), Verdict::Unexplained);
    assert_eq!(missed(Verdict::Unexplained), Verdict::Unexplained);
    for verdict in [Verdict::Explained, Verdict::Ambiguous, Verdict::ExplainedInPart] {
        assert_eq!(missed(verdict), Verdict::ExplainedInPart);
    }
}

#[test]
fn a_static_map_is_seen_among_what_is_written() {
    let with_map = weighed(|found, _| {
        let map = pam_muscle::effects::Term::new(
            pam_muscle::effects::effect(MAP_ID).expect("the map"),
            vec![0.0, 5e5, 0.0, 0.2],
            Vec::new(),
        );
        found.entries.push(crate::named::nameless_entry(&map));
    });
    assert!(with_map.has_map());
    let with_another = weighed(|found, _| {
        let lag = pam_artifact::model::EffectEntry::new("pressure-lag", Vec::new());
        found.entries.push(lag);
    });
    assert!(!with_another.has_map());
}

#[test]
fn what_parameters_alone_leave_open_is_said_where_nothing_is_missing() {
    let said = |verdict| {
        let weighed = weighed(|found, agreement| {
            found.verdict = verdict;
            let held = agreement.holdout.each.clone();
            found.pooled = Some(Pooled { held, typically_n: Some([2.0, 0.5, 0.6]) });
            found.typically_misses = verdict == Verdict::Unexplained;
        });
        weighed.statement.contains("leave parameters open")
    };
    assert!(said(Verdict::Consistent) && !said(Verdict::Unexplained));
}
