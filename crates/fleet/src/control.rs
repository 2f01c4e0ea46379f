//! Control charts: one quantity of all campaigns of a make, with the limits between which it is expected.
//!
//! A value counts as far from the center as `(x − median) / s`, where `s` joins the robust spread of the make and what the
//! value's own standard error has over the usual one: a parameter that a recording hardly determines stands out less.

use std::collections::BTreeMap;

use crate::record::{RESIDUALS, Record};
use crate::robust::{Location, limit, location, median};

/// Fewest values that limits are drawn from.
pub const FEWEST: usize = 5;
/// A quantity that never changes sign and spans more than this ratio is compared by its logarithm.
const DECADE: f64 = 10.0;

/// A value on a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Index of the record.
    pub record: usize,
    /// Value.
    pub value: f64,
    /// Standard error; none where that is not known.
    pub stderr: Option<f64>,
    /// Distance from the center, in spreads, sign included; zero where there are no limits.
    pub distance: f64,
}

/// One quantity of one make.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Make; empty where the table does not say.
    pub make: String,
    /// Quantity.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Whether distances are those of logarithms.
    pub logarithmic: bool,
    /// Values in the order of the records.
    pub points: Vec<Point>,
    /// Center and spread on the scale of the distances; none for fewer than [`FEWEST`] values, or where half of them are equal.
    pub location: Option<Location>,
    /// Distance above which a value is outside.
    pub limit: f64,
}

impl Chart {
    /// A value on the scale of the distances.
    pub fn scaled(&self, value: f64) -> f64 {
        if self.logarithmic { value.ln() } else { value }
    }

    /// The value at a distance from the center; none where there are no limits.
    pub fn at(&self, distance: f64) -> Option<f64> {
        let Location { center, spread, .. } = self.location?;
        let scaled = center + distance * spread;
        Some(if self.logarithmic { scaled.exp() } else { scaled })
    }

    /// Whether a point lies outside the limits.
    pub fn is_outside(&self, point: &Point) -> bool {
        self.location.is_some() && point.distance.abs() > self.limit
    }

    /// A standard error on the scale of the distances.
    pub fn scaled_stderr(&self, point: &Point) -> f64 {
        let stderr = point.stderr.unwrap_or(0.0);
        if self.logarithmic { stderr / point.value } else { stderr }
    }

    /// Measures every point's distance from a center of its own: `shifts` is what its rig adds, on the scale of the
    /// distances, zero for most.
    pub fn measure(&mut self, shifts: impl Fn(usize) -> f64) {
        let Some(Location { center, spread, .. }) = self.location else { return };
        let mut errors: Vec<f64> = self.points.iter().map(|point| self.scaled_stderr(point)).collect();
        let usual = median(&mut errors).unwrap_or(0.0);
        let distances: Vec<f64> = self
            .points
            .iter()
            .map(|point| {
                let error = self.scaled_stderr(point);
                let own = (error * error - usual * usual).max(0.0);
                (self.scaled(point.value) - center - shifts(point.record)) / (spread * spread + own).sqrt()
            })
            .collect();
        for (point, distance) in self.points.iter_mut().zip(distances) {
            point.distance = distance;
        }
    }
}

/// A chart for every quantity of every make, by make and in the order in which models list their quantities.
pub fn charts(records: &[Record]) -> Vec<Chart> {
    let mut order: Vec<&str> = Vec::new();
    let mut charts: BTreeMap<(&str, &str), Chart> = BTreeMap::new();
    for (index, record) in records.iter().enumerate() {
        let make = record.campaign.make.as_str();
        for quantity in record.identified.iter().flat_map(|identified| &identified.quantities) {
            if !order.contains(&quantity.name.as_str()) {
                order.push(&quantity.name);
            }
            let chart = charts.entry((make, &quantity.name)).or_insert_with(|| Chart {
                make: make.to_owned(),
                name: quantity.name.clone(),
                unit: quantity.unit.clone(),
                logarithmic: false,
                points: Vec::new(),
                location: None,
                limit: f64::INFINITY,
            });
            let (value, stderr) = (quantity.value, quantity.stderr.filter(|stderr| stderr.is_finite()));
            chart.points.push(Point { record: index, value, stderr, distance: 0.0 });
        }
    }
    let mut charts: Vec<Chart> = charts.into_values().collect();
    // Residuals come last, whatever the first model lacked.
    let place = |name: &str| (RESIDUALS.contains(&name), order.iter().position(|known| *known == name));
    charts.sort_by(|a, b| (&a.make, place(&a.name)).cmp(&(&b.make, place(&b.name))));
    let comparisons = charts.iter().map(|chart| chart.points.len()).sum();
    for chart in &mut charts {
        chart.logarithmic = is_logarithmic(chart);
        let values: Vec<f64> = chart.points.iter().map(|point| chart.scaled(point.value)).collect();
        let spread_of = |location: &Location| location.spread > 1e-12 * location.center.abs();
        chart.location = location(&values).filter(|found| found.n >= FEWEST && spread_of(found));
        chart.limit = limit(values.len(), comparisons);
        chart.measure(|_| 0.0);
    }
    charts
}

fn is_logarithmic(chart: &Chart) -> bool {
    let values = || chart.points.iter().map(|point| point.value);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    low > 0.0 && (RESIDUALS.contains(&chart.name.as_str()) || high > DECADE * low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::tests::fleet;

    #[test]
    fn one_value_among_many_is_outside_and_no_other() {
        let records = fleet(60, |index| if index == 17 { 9.0 } else { 1.0 + 0.01 * ((index * 37) % 60) as f64 });
        let charts = charts(&records);
        let chart = charts.iter().find(|chart| chart.name == "k1").expect("a chart");
        let outside: Vec<usize> =
            chart.points.iter().filter(|point| chart.is_outside(point)).map(|point| point.record).collect();
        assert_eq!(outside, [17]);
        assert!(!chart.logarithmic && chart.location.expect("limits").n == 60);
    }

    #[test]
    fn a_value_that_is_hardly_determined_stands_out_less() {
        let mut records = fleet(60, |index| if index == 17 { 9.0 } else { 1.0 + 0.01 * ((index * 37) % 60) as f64 });
        let identified = records[17].identified.as_mut().expect("a model");
        identified.quantities[0].stderr = Some(5.0);
        let charts = charts(&records);
        assert!(charts[0].points.iter().all(|point| !charts[0].is_outside(point)), "{:?}", charts[0].points[17]);
    }

    #[test]
    fn few_values_have_no_limits() {
        let records = fleet(4, |index| index as f64);
        assert!(charts(&records).iter().all(|chart| chart.location.is_none()));
    }
}
