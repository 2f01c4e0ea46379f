//! The page of a fleet, from its survey.

use pam_fleet_survey::change::Change;
use pam_fleet_survey::control::Chart;
use pam_fleet_survey::groups::GroupShift;
use pam_fleet_survey::record::Record;
use pam_fleet_survey::survey::Survey;
use pam_report::number::{engineering, engineering_with_stderr, significant};
use pam_report::{
    FleetCampaign, FleetChange, FleetChart, FleetPage, FleetPoint, FleetRefusal, FleetShift, FleetStanding,
};

/// Everything that the page shows; `folder` is the way from the page to the folders of the campaigns, and none where there
/// is no such way.
pub(crate) fn page(survey: &Survey, folder: Option<&str>) -> FleetPage {
    let several_makes = survey.records.windows(2).any(|pair| pair[0].campaign.make != pair[1].campaign.make);
    let title = |chart: &Chart| match chart.make.as_str() {
        make if several_makes && !make.is_empty() => format!("{} of {make}", chart.name.replace("^2", "²")),
        _ => chart.name.replace("^2", "²"),
    };
    let mut shifts: Vec<&GroupShift> = survey.groups.iter().filter(|group| group.differs()).collect();
    shifts.sort_by(|a, b| b.distance.abs().total_cmp(&a.distance.abs()));
    let mut changes: Vec<&Change> = survey.changes.iter().filter(|change| change.is_change()).collect();
    changes.sort_by(|a, b| b.distance.abs().total_cmp(&a.distance.abs()));
    FleetPage {
        title: "Report of a fleet of muscles".to_owned(),
        campaigns: survey.records.iter().map(|record| campaign(record, folder)).collect(),
        standing: survey
            .standing
            .iter()
            .map(|standing| FleetStanding {
                campaign: standing.record,
                reasons: standing.reasons.iter().map(|reason| reason.words.clone()).collect(),
                weight: standing.weight(),
            })
            .collect(),
        common: survey.common.iter().map(|(make, what, n)| common(make, what, *n)).collect(),
        shifts: shifts
            .into_iter()
            .map(|shift| group(shift, &survey.charts[shift.chart], title(&survey.charts[shift.chart])))
            .collect(),
        n_shifts_weighed: survey.groups.len(),
        changes: changes
            .into_iter()
            .map(|one| change(one, &survey.charts[one.chart], title(&survey.charts[one.chart])))
            .collect(),
        n_changes_weighed: survey.changes.len(),
        charts: survey.charts.iter().map(|found| chart(found, title(found))).collect(),
        refusals: refusals(survey),
    }
}

fn common(make: &str, what: &str, n: usize) -> String {
    let of_make = if make.is_empty() { String::new() } else { format!(" of {make}") };
    match what {
        "unexplained" => format!("unmodelled structure is left in {n} campaigns{of_make}"),
        "explained-in-part" => format!("named effects explain part of the mismatch in {n} campaigns{of_make}"),
        _ => format!("missing physics: {what}, in {n} campaigns{of_make}"),
    }
}

fn campaign(record: &Record, folder: Option<&str>) -> FleetCampaign {
    let identified = record.identified.as_ref();
    let diagnosed = record.diagnosed.as_ref();
    FleetCampaign {
        muscle: record.campaign.muscle.clone(),
        rig: record.campaign.rig.clone(),
        date: record.campaign.date.clone(),
        make: record.campaign.make.clone(),
        outcome: match () {
            () if record.refusals().next().is_some() => "refused",
            () if record.rejections().next().is_some() => "rejected",
            () => "accepted",
        },
        verdict: diagnosed.map(|diagnosed| diagnosed.verdict),
        effects: diagnosed.map_or(Vec::new(), |diagnosed| {
            diagnosed.effects.iter().map(|effect| (effect.id.clone(), effect.worth_n)).collect()
        }),
        rmse_n: identified.map(|identified| identified.rmse_n),
        holdout_rmse_n: identified.and_then(|identified| identified.holdout_rmse_n),
        noise_n: identified.map(|identified| identified.noise_n),
        link: folder.filter(|_| record.has_report).map(|folder| format!("{folder}{}/report.html", record.campaign.id)),
    }
}

fn group(shift: &GroupShift, chart: &Chart, quantity: String) -> FleetShift {
    let size = if chart.logarithmic {
        let percent = 100.0 * (shift.shift.exp() - 1.0);
        format!("{}{} %", if percent > 0.0 { "+" } else { "" }, significant(percent, 3))
    } else {
        let stderr = (shift.shift / shift.distance).abs();
        engineering_with_stderr(shift.shift, stderr, &chart.unit)
    };
    let others = if shift.day.is_some() { "its other days" } else { "the other rigs" };
    FleetShift {
        quantity,
        rig: shift.rig.clone(),
        day: shift.day.clone(),
        shift: size,
        distance: shift.distance,
        compared: match shift.paired {
            Some(n) => format!("{others}, {n} muscles each with itself"),
            None => format!("{others}, other muscles"),
        },
    }
}

fn change(change: &Change, chart: &Chart, quantity: String) -> FleetChange {
    let [before, after] = change.values.map(|value| engineering(value, &chart.unit, 4));
    FleetChange { quantity, from: change.from, to: change.to, before, after, distance: change.distance }
}

fn chart(chart: &Chart, title: String) -> FleetChart {
    let at = |distance: f64| chart.at(distance);
    FleetChart {
        title,
        unit: chart.unit.clone(),
        logarithmic: chart.logarithmic,
        limits: at(-chart.limit).zip(at(0.0)).zip(at(chart.limit)).map(|((low, center), high)| [low, center, high]),
        limit: chart.limit,
        points: chart
            .points
            .iter()
            .map(|point| FleetPoint {
                campaign: point.record,
                value: point.value,
                stderr: point.stderr,
                distance: point.distance,
                outside: chart.is_outside(point),
            })
            .collect(),
    }
}

/// Refusals first, rejections after them; each in the order of the campaigns.
fn refusals(survey: &Survey) -> Vec<FleetRefusal> {
    let of = |rejected: bool| {
        survey.records.iter().enumerate().flat_map(move |(campaign, record)| {
            let some: Vec<_> = if rejected { record.rejections().collect() } else { record.refusals().collect() };
            let word = if rejected { "rejected: " } else { "" };
            some.into_iter().map(move |(step, reason)| FleetRefusal {
                campaign,
                step: step.name().to_owned(),
                reason: format!("{word}{reason}"),
            })
        })
    };
    of(false).chain(of(true)).collect()
}
