//! A fleet as a whole: charts, rigs, changes, effects, and who stands out for which reasons.

use std::collections::BTreeMap;
use std::path::Path;

use pam_core::artifact::diagnosis::Verdict;
use rayon::prelude::*;

use crate::change::{Change, changes};
use crate::control::{Chart, charts};
use crate::groups::{GroupShift, groups};
use crate::plan::FleetPlan;
use crate::record::{RESIDUALS, Record, verdict_word};

/// What at least this share of a make has says nothing of one muscle of it.
const COMMON: f64 = 0.5;
/// Residuals that are at most this often the sensors' noise are explained, as a diagnosis takes it: no reason to stand out.
const MUCH: f64 = 1.5;
/// Fewest muscles of a make of which anything is common.
const FEWEST: usize = 5;
/// Campaigns read at a time: what a machine's threads work on, and all of its artifacts that are ever in memory at once.
const AT_ONCE: usize = 64;

/// Why a campaign stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct Reason {
    /// The same in words.
    pub words: String,
    /// How much it matters: 1 is the limit of a chart.
    pub weight: f64,
}

/// A campaign that is not like the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// Index of the record.
    pub record: usize,
    /// Reasons, the weightiest first.
    pub reasons: Vec<Reason>,
}

impl Standing {
    /// Weight of the weightiest reason.
    pub fn weight(&self) -> f64 {
        self.reasons.first().map_or(0.0, |reason| reason.weight)
    }
}

/// A fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Campaigns in the order of the plan.
    pub records: Vec<Record>,
    /// Control charts.
    pub charts: Vec<Chart>,
    /// Comparisons of rigs and days.
    pub groups: Vec<GroupShift>,
    /// Comparisons of muscles with themselves.
    pub changes: Vec<Change>,
    /// Campaigns that stand out, the weightiest first.
    pub standing: Vec<Standing>,
    /// Findings that most of a make shares, each with make and number of campaigns.
    pub common: Vec<(String, String, usize)>,
}

impl Survey {
    /// Reads the results of a plan and compares them; `seen` is told how many campaigns have been read.
    pub fn new(plan: FleetPlan, results: &Path, seen: &mut dyn FnMut(usize)) -> Self {
        let mut records = Vec::with_capacity(plan.campaigns.len());
        let mut campaigns = plan.campaigns.into_iter();
        loop {
            let some: Vec<_> = campaigns.by_ref().take(AT_ONCE).collect();
            if some.is_empty() {
                return Self::of_records(records);
            }
            records.par_extend(some.into_par_iter().map(|campaign| Record::read(results, campaign)));
            seen(records.len());
        }
    }

    /// Compares campaigns.
    pub fn of_records(records: Vec<Record>) -> Self {
        let mut charts = charts(&records);
        let groups = groups(&records, &charts);
        // What a rig adds is the rig's: its muscles are compared with one another.
        for (index, chart) in charts.iter_mut().enumerate() {
            let of_rigs = groups.iter().filter(|group| group.chart == index && group.day.is_none() && group.differs());
            let shifts: BTreeMap<&str, f64> = of_rigs.map(|group| (group.rig.as_str(), group.shift)).collect();
            if !shifts.is_empty() {
                chart.measure(|record| shifts.get(records[record].campaign.rig.as_str()).copied().unwrap_or(0.0));
            }
        }
        let changes = changes(&records, &charts);
        let common = common(&records);
        let standing = standing(&records, &charts, &changes, &common);
        Self { records, charts, groups, changes, standing, common }
    }

    /// Whether every campaign is there, accepted by the programs that judge their results.
    pub fn is_complete(&self) -> bool {
        self.records.iter().all(|record| record.refusals().next().is_none() && record.rejections().next().is_none())
    }
}

/// A finding of a diagnosis, as it is counted and as it is said.
fn findings(record: &Record) -> Vec<(String, f64)> {
    let (Some(identified), Some(diagnosed)) = (&record.identified, &record.diagnosed) else { return Vec::new() };
    let over_noise = |force_n: f64| force_n / identified.noise_n.max(f64::MIN_POSITIVE);
    let mut found: Vec<(String, f64)> =
        diagnosed.effects.iter().map(|effect| (effect.id.clone(), 1.0 + over_noise(effect.worth_n))).collect();
    match diagnosed.verdict {
        Verdict::Consistent | Verdict::Explained | Verdict::Ambiguous => {}
        // What effects leave is said beside them; what has no name at all stands alone.
        Verdict::ExplainedInPart | Verdict::Unexplained => {
            found.push((verdict_word(diagnosed.verdict).to_owned(), over_noise(diagnosed.rmse_after_n).max(1.0)));
        }
    }
    found
}

/// Findings that at least half of a make has.
fn common(records: &[Record]) -> Vec<(String, String, usize)> {
    let mut counts: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let mut of_make: BTreeMap<&str, usize> = BTreeMap::new();
    for record in records.iter().filter(|record| record.diagnosed.is_some()) {
        let make = record.campaign.make.as_str();
        *of_make.entry(make).or_default() += 1;
        for (what, _) in findings(record) {
            *counts.entry((make, what)).or_default() += 1;
        }
    }
    let is_common = |make: &str, n: usize| of_make[make] >= FEWEST && n as f64 >= COMMON * of_make[make] as f64;
    let common = counts.into_iter().filter(|((make, _), n)| is_common(make, *n));
    common.map(|((make, what), n)| (make.to_owned(), what, n)).collect()
}

fn standing(
    records: &[Record],
    charts: &[Chart],
    changes: &[Change],
    common: &[(String, String, usize)],
) -> Vec<Standing> {
    let mut reasons: Vec<Vec<Reason>> = records.iter().map(|record| own_reasons(record, common)).collect();
    // A residual that physics was named for is said by its name.
    let is_named: Vec<bool> =
        records.iter().map(|record| record.diagnosed.as_ref().is_some_and(|found| !found.effects.is_empty())).collect();
    for chart in charts {
        let of_residual = RESIDUALS.contains(&chart.name.as_str());
        for point in chart.points.iter().filter(|point| chart.is_outside(point)) {
            if of_residual && (is_named[point.record] || point.value < MUCH) {
                continue;
            }
            let side = if point.distance > 0.0 { "high" } else { "low" };
            let words = format!("{} is {side}: {:.1} spreads from the others", chart.name, point.distance.abs());
            reasons[point.record].push(Reason { words, weight: point.distance.abs() / chart.limit });
        }
    }
    for change in changes.iter().filter(|change| change.is_change()) {
        let since = &records[change.from].campaign.date;
        let words = format!("{} has changed since {since}", charts[change.chart].name);
        reasons[change.to].push(Reason { words, weight: change.distance.abs() / change.limit });
    }
    let mut standing: Vec<Standing> = reasons
        .into_iter()
        .enumerate()
        .filter(|(_, reasons)| !reasons.is_empty())
        .map(|(record, mut reasons)| {
            reasons.sort_by(|a, b| b.weight.total_cmp(&a.weight));
            Standing { record, reasons }
        })
        .collect();
    // Equal weights stay in the order of the plan.
    standing.sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    standing
}

/// What a campaign's own programs found.
fn own_reasons(record: &Record, common: &[(String, String, usize)]) -> Vec<Reason> {
    let is_common = |what: &str| common.iter().any(|(make, known, _)| *make == record.campaign.make && known == what);
    let words = |what: String| match what.as_str() {
        "unexplained" => "unmodelled structure is left".to_owned(),
        "explained-in-part" => "the named effects explain part of the mismatch".to_owned(),
        _ => format!("missing physics: {what}"),
    };
    let found = findings(record).into_iter().filter(|(what, _)| !is_common(what));
    let mut reasons: Vec<Reason> = found.map(|(what, weight)| Reason { words: words(what), weight }).collect();
    reasons.extend(
        record
            .rejections()
            .map(|(step, reason)| Reason { words: format!("{} rejected: {reason}", step.name()), weight: 2.0 }),
    );
    let implausible = record.diagnosed.iter().flat_map(|diagnosed| &diagnosed.implausible);
    reasons.extend(implausible.map(|words| Reason { words: words.clone(), weight: 1.0 }));
    reasons
}

#[cfg(test)]
pub(crate) mod tests {
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
}
