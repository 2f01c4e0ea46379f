//! Rigs and days: what all campaigns of a group have that others have not.
//!
//! A rig is compared with the other rigs, a day of a rig with its other days. Where muscles were on several rigs (or
//! days), each is compared with itself, which says more; otherwise medians of different muscles are compared.

use std::collections::BTreeMap;

use crate::control::Chart;
use crate::record::Record;
use crate::robust::{MEDIAN_PENALTY, limit, location};

/// Fewest campaigns of a group, and of those that it is compared with.
const FEWEST: usize = 4;

/// How far a group lies from the others.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupShift {
    /// Index of the chart.
    pub chart: usize,
    /// Rig.
    pub rig: String,
    /// Day, where one day of a rig is compared with its others.
    pub day: Option<String>,
    /// Shift on the scale of the chart's distances: a difference, or the logarithm of a ratio.
    pub shift: f64,
    /// Shift over its standard error.
    pub distance: f64,
    /// Distance above which a group differs.
    pub limit: f64,
    /// Muscles that were compared with themselves; none where medians of different muscles were compared.
    pub paired: Option<usize>,
}

impl GroupShift {
    /// Whether the group differs from the others.
    pub fn differs(&self) -> bool {
        self.distance.abs() > self.limit
    }
}

/// Day of a date, without its time.
pub fn day(date: &str) -> &str {
    date.get(..10).unwrap_or(date)
}

/// A value with the muscle and the group that it belongs to.
struct Grouped<'a> {
    muscle: &'a str,
    group: (&'a str, &'a str),
    value: f64,
}

/// Every comparison of a rig with the others and of a day with the others of its rig.
pub fn groups(records: &[Record], charts: &[Chart]) -> Vec<GroupShift> {
    let mut found = Vec::new();
    for (index, chart) in charts.iter().enumerate().filter(|(_, chart)| chart.location.is_some()) {
        let grouped = |by_day: bool| -> Vec<Grouped<'_>> {
            let group = |point: &crate::control::Point| {
                let campaign = &records[point.record].campaign;
                let of_day = if by_day { day(&campaign.date) } else { "" };
                let group = (campaign.rig.as_str(), of_day);
                Grouped { muscle: &campaign.muscle, group, value: chart.scaled(point.value) }
            };
            chart.points.iter().map(group).collect()
        };
        let of_rigs = grouped(false);
        found.extend(compare(index, &of_rigs, |_, _| true));
        let of_days = grouped(true);
        found.extend(compare(index, &of_days, |one, other| one.0 == other.0));
    }
    let comparisons = found.len();
    for shift in &mut found {
        // `limit` held the number of values until all comparisons were known.
        shift.limit = limit(shift.limit as usize, comparisons);
    }
    found
}

/// Compares each group with those others that `comparable` allows; `limit` is the number of values behind the spread.
fn compare(
    chart: usize,
    values: &[Grouped<'_>],
    comparable: impl Fn((&str, &str), (&str, &str)) -> bool,
) -> Vec<GroupShift> {
    let mut groups: Vec<(&str, &str)> = values.iter().map(|value| value.group).collect();
    groups.sort_unstable();
    groups.dedup();
    let mut found = Vec::new();
    for group in groups {
        let (inside, outside): (Vec<&Grouped<'_>>, Vec<&Grouped<'_>>) =
            values.iter().filter(|value| comparable(group, value.group)).partition(|value| value.group == group);
        let Some((shift, stderr, n, paired)) = paired(&inside, &outside).or_else(|| apart(&inside, &outside)) else {
            continue;
        };
        let day = (!group.1.is_empty()).then(|| group.1.to_owned());
        let distance = shift / stderr;
        found.push(GroupShift { chart, rig: group.0.to_owned(), day, shift, distance, limit: n as f64, paired });
    }
    found
}

/// Shift, its standard error, values behind it, and muscles that were compared with themselves.
type Compared = (f64, f64, usize, Option<usize>);

/// Each muscle with itself.
fn paired(inside: &[&Grouped<'_>], outside: &[&Grouped<'_>]) -> Option<Compared> {
    let mut means: BTreeMap<&str, [(f64, f64); 2]> = BTreeMap::new();
    for (side, values) in [inside, outside].into_iter().enumerate() {
        for value in values {
            let (sum, n) = &mut means.entry(value.muscle).or_default()[side];
            *sum += value.value;
            *n += 1.0;
        }
    }
    let both = means.values().filter(|[one, other]| one.1 > 0.0 && other.1 > 0.0);
    let differences: Vec<f64> = both.map(|[one, other]| one.0 / one.1 - other.0 / other.1).collect();
    let found = location(&differences).filter(|found| found.n >= FEWEST && found.spread > 0.0)?;
    Some((found.center, MEDIAN_PENALTY * found.spread / (found.n as f64).sqrt(), found.n, Some(found.n)))
}

/// Medians of different muscles.
fn apart(inside: &[&Grouped<'_>], outside: &[&Grouped<'_>]) -> Option<Compared> {
    let of = |values: &[&Grouped<'_>]| {
        let values: Vec<f64> = values.iter().map(|value| value.value).collect();
        location(&values).filter(|found| found.n >= FEWEST && found.spread > 0.0)
    };
    let (one, other) = (of(inside)?, of(outside)?);
    let variance = |found: &crate::robust::Location| found.spread * found.spread / found.n as f64;
    let stderr = MEDIAN_PENALTY * (variance(&one) + variance(&other)).sqrt();
    Some((one.center - other.center, stderr, one.n, None))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::charts;
    use crate::survey::tests::fleet;

    fn differing(records: &[Record]) -> Vec<GroupShift> {
        groups(records, &charts(records)).into_iter().filter(GroupShift::differs).collect()
    }

    #[test]
    fn a_rig_that_reads_otherwise_is_found_and_no_other() {
        // Rigs take turns, `index % 4`.
        let value = |index: usize| 1.0 + 0.01 * ((index * 37) % 101) as f64;
        assert_eq!(differing(&fleet(200, value)), []);
        let found = differing(&fleet(200, |index| value(index) + if index % 4 == 2 { 1.0 } else { 0.0 }));
        assert!(
            found.iter().any(|shift| shift.rig == "rig-2" && shift.day.is_none() && shift.shift > 0.5),
            "{found:?}"
        );
        assert!(found.iter().all(|shift| shift.rig == "rig-2" || shift.distance < 0.0), "{found:?}");
    }

    #[test]
    fn muscles_that_were_on_several_rigs_are_compared_with_themselves() {
        // Muscles differ by far more than the rigs do; each is on both rigs.
        let mut records = fleet(40, |index| {
            let muscle = index / 2;
            200.0
                + (muscle * muscle % 97) as f64
                + if index % 2 == 0 { 0.1 } else { 0.0 }
                + 0.001 * ((index * 7) % 11) as f64
        });
        for (index, record) in records.iter_mut().enumerate() {
            record.campaign.muscle = format!("m{}", index / 2);
            record.campaign.rig = format!("rig-{}", index % 2);
        }
        let found = differing(&records);
        let one = found.iter().find(|shift| shift.rig == "rig-0").expect("a shift");
        assert!((one.shift - 0.1).abs() < 0.01 && one.paired == Some(20), "{one:?}");
    }
}
