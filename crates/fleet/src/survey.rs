//! A fleet as a whole: charts, rigs, changes, effects, and who stands out for which reasons.

use std::collections::BTreeMap;
use std::path::Path;

use pam_artifact::diagnosis::Verdict;
use rayon::prelude::*;

use crate::change::{Change, changes};
use crate::control::{Chart, charts};
use crate::groups::{GroupShift, groups};
use crate::plan::FleetPlan;
use crate::record::{Identified, RESIDUALS, Record, verdict_word};

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
            let is_isolated = |identified: &Identified| identified.isolated.contains(&chart.name.as_str());
            let few = of_residual && records[point.record].identified.as_ref().is_some_and(is_isolated);
            if of_residual && (is_named[point.record] || point.value < MUCH) || few {
                continue;
            }
            let side = if point.distance > 0.0 { "high" } else { "low" };
            let distance = point.distance.abs();
            // Beyond a hundred spreads a decimal says nothing.
            let decimals = usize::from(distance < 100.0);
            let words = format!("{} is {side}: {distance:.decimals$} spreads from the others", chart.name);
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
            .map(|(step, reason)| (step.name(), reason.trim_start_matches("rejected: ")))
            .map(|(step, reason)| Reason { words: format!("{step} rejected: {reason}"), weight: 2.0 }),
    );
    let implausible = record.diagnosed.iter().flat_map(|diagnosed| &diagnosed.implausible);
    reasons.extend(implausible.map(|words| Reason { words: words.clone(), weight: 1.0 }));
    reasons
}

#[cfg(test)]
pub(crate) mod tests;
