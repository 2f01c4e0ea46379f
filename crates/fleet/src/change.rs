//! The same muscle later: what has changed between one campaign and the next.

use std::collections::BTreeMap;

use crate::control::{Chart, Point};
use crate::groups::day;
use crate::record::Record;
use crate::robust::{limit, location};

/// Fewest differences from which their usual scatter is taken.
const FEWEST: usize = 8;

/// A quantity of a muscle at a date and at the date before.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Index of the chart.
    pub chart: usize,
    /// Index of the earlier record.
    pub from: usize,
    /// Index of the later record.
    pub to: usize,
    /// Values at both.
    pub values: [f64; 2],
    /// Difference less that of the other muscles meanwhile, over its standard error or the scatter of such differences,
    /// whichever is larger.
    pub distance: f64,
    /// Distance above which it has changed.
    pub limit: f64,
}

impl Change {
    /// Whether the quantity has changed.
    pub fn is_change(&self) -> bool {
        self.distance.abs() > self.limit
    }
}

/// Every difference between two successive dates of a muscle, on whatever rig, where a standard error or other muscles
/// tell how much it may be by chance.
pub fn changes(records: &[Record], charts: &[Chart]) -> Vec<Change> {
    let mut found = Vec::new();
    for (index, chart) in charts.iter().enumerate() {
        let mut of_muscle: BTreeMap<&str, Vec<&Point>> = BTreeMap::new();
        for point in &chart.points {
            of_muscle.entry(&records[point.record].campaign.muscle).or_default().push(point);
        }
        let date = |point: &Point| records[point.record].campaign.date.as_str();
        let mut pairs: Vec<[&Point; 2]> = Vec::new();
        for points in of_muscle.values_mut() {
            points.sort_by(|a, b| (date(a), a.record).cmp(&(date(b), b.record)));
            let later = points.windows(2).filter(|pair| day(date(pair[0])) != day(date(pair[1])));
            pairs.extend(later.map(|pair| [pair[0], pair[1]]));
        }
        let difference = |[from, to]: &[&Point; 2]| chart.scaled(to.value) - chart.scaled(from.value);
        let differences: Vec<f64> = pairs.iter().map(difference).collect();
        let usual = location(&differences).filter(|usual| usual.n >= FEWEST);
        let (center, spread) = usual.map_or((0.0, 0.0), |usual| (usual.center, usual.spread));
        for pair in &pairs {
            let error = chart.scaled_stderr(pair[0]).hypot(chart.scaled_stderr(pair[1]));
            let scale = error.max(spread);
            if scale > 0.0 {
                found.push(Change {
                    chart: index,
                    from: pair[0].record,
                    to: pair[1].record,
                    values: pair.map(|point| point.value),
                    distance: (difference(pair) - center) / scale,
                    limit: usual.map_or(f64::INFINITY, |usual| usual.n as f64),
                });
            }
        }
    }
    let comparisons = found.len();
    for change in &mut found {
        // `limit` held the number of differences until all comparisons were known; standard errors alone are taken as known.
        let n = if change.limit.is_finite() { change.limit as usize } else { usize::MAX };
        change.limit = limit(n.min(1_000_000), comparisons);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::charts;
    use crate::survey::tests::fleet;

    #[test]
    fn a_muscle_that_changed_is_found_and_no_other() {
        let mut records = fleet(60, |index| {
            let (muscle, later) = (index / 2, index % 2);
            40.0 + muscle as f64
                + 0.02 * ((index * index * 37) % 11) as f64
                + if (muscle, later) == (12, 1) { 3.0 } else { 0.0 }
        });
        for (index, record) in records.iter_mut().enumerate() {
            record.campaign.muscle = format!("m{}", index / 2);
            record.campaign.date = format!("2026-0{}-01", 3 + index % 2);
        }
        let found: Vec<Change> = changes(&records, &charts(&records)).into_iter().filter(Change::is_change).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!((found[0].from, found[0].to), (24, 25));
    }

    #[test]
    fn two_campaigns_of_one_day_are_no_change() {
        let mut records = fleet(2, |index| 100.0 * index as f64);
        records[1].campaign.muscle = records[0].campaign.muscle.clone();
        records[1].campaign.date = format!("{}T18:00", records[0].campaign.date);
        assert_eq!(changes(&records, &charts(&records)), []);
    }
}
