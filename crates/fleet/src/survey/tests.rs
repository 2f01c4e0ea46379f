use super::*;
use crate::plan::Campaign;
use crate::record::{Diagnosed, Identified, NamedEffect, Quantity};
use crate::step::Outcome;

/// `n` muscles on four rigs that take turns, with the values of `k1`; the verdict on each is `consistent`.
pub(crate) fn fleet(n: usize, k1: impl Fn(usize) -> f64) -> Vec<Record> {
    let record = |index: usize| Record {
        campaign: Campaign {
            id: format!("m{index}"),
            muscle: format!("m{index:03}"),
            rig: format!("rig-{}", index % 4),
            date: "2026-03-01".to_owned(),
            make: String::new(),
            dimensions: "m.toml".to_owned(),
            estimation: vec!["a.csv".to_owned()],
            holdout: Vec::new(),
        },
        outcomes: [const { Outcome::Accepted }; 4],
        identified: Some(Identified {
            quantities: vec![Quantity {
                name: "k1".to_owned(),
                unit: "1".to_owned(),
                value: k1(index),
                stderr: Some(0.01),
            }],
            rmse_n: 1.0,
            holdout_rmse_n: None,
            noise_n: 1.0,
            isolated: Vec::new(),
        }),
        diagnosed: Some(Diagnosed {
            verdict: Verdict::Consistent,
            statement: String::new(),
            effects: Vec::new(),
            rmse_after_n: 1.0,
            implausible: Vec::new(),
        }),
        has_report: false,
    };
    (0..n).map(record).collect()
}

fn with_effect(record: &mut Record, id: &str) {
    let diagnosed = record.diagnosed.as_mut().expect("a diagnosis");
    diagnosed.verdict = Verdict::Explained;
    diagnosed.effects.push(NamedEffect { id: id.to_owned(), worth_n: 3.0, alternatives: Vec::new() });
}

#[test]
fn what_most_muscles_share_is_said_once_and_of_none_of_them() {
    let mut records = fleet(20, |index| index as f64);
    records[..15].iter_mut().for_each(|record| with_effect(record, "slack"));
    with_effect(&mut records[3], "stribeck");
    let survey = Survey::of_records(records);
    assert_eq!(survey.common, [(String::new(), "slack".to_owned(), 15)]);
    let standing: Vec<(usize, &str)> =
        survey.standing.iter().map(|standing| (standing.record, standing.reasons[0].words.as_str())).collect();
    assert_eq!(standing, [(3, "missing physics: stribeck")]);
}

#[test]
fn a_rig_at_fault_makes_no_muscle_of_it_stand_out() {
    let value = |index: usize| 1.0 + 0.001 * ((index * 37) % 101) as f64 + if index % 4 == 2 { 3.0 } else { 0.0 };
    let survey = Survey::of_records(fleet(200, value));
    assert!(survey.groups.iter().any(|group| group.differs() && group.rig == "rig-2"));
    assert_eq!(survey.standing, []);
}

#[test]
fn a_refusal_leaves_a_fleet_incomplete() {
    let mut records = fleet(6, |index| index as f64);
    assert!(Survey::of_records(records.clone()).is_complete());
    records[2].outcomes[0] = Outcome::Refused("a.csv:1:1: no".to_owned());
    assert!(!Survey::of_records(records).is_complete());
}

#[test]
fn a_residual_that_few_samples_leave_is_no_reason() {
    let mut records = fleet(40, |_| 1.0);
    for (index, record) in records.iter_mut().enumerate() {
        let value = if index < 2 { 4.0 } else { 1.0 + 0.001 * ((index * 37) % 40) as f64 };
        let identified = record.identified.as_mut().expect("a model");
        identified.quantities.push(Quantity {
            name: RESIDUALS[1].to_owned(),
            unit: "1".to_owned(),
            value,
            stderr: None,
        });
    }
    records[0].identified.as_mut().expect("a model").isolated.push(RESIDUALS[1]);
    let survey = Survey::of_records(records);
    assert_eq!(survey.standing.iter().map(|standing| standing.record).collect::<Vec<usize>>(), [1]);
}
