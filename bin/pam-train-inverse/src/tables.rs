//! Tables and messages for the terminal.

use std::time::Duration;

use pam_artifact::InverseArtifact;
use pam_artifact::inverse::{Ended, ErrorStatistics, RegionErrors};
use pam_report::Table;
use pam_report::number::significant;
use pam_report::text::wrapped;

use crate::run::Timing;

/// Every start.
pub(crate) fn training(artifact: &InverseArtifact, time: Duration) -> String {
    let report = &artifact.training;
    let mut table = Table::new(["start", "validation RMSE kPa", "epochs", "best epoch", "ended"]);
    for (index, start) in report.starts.iter().enumerate() {
        table.row([
            (index + 1).to_string(),
            significant(start.validation_rmse_pa * 1e-3, 3),
            start.n_epochs.to_string(),
            start.best_epoch.to_string(),
            format!("{}{}", ended(start.ended), if index == report.chosen { "; chosen" } else { "" }),
        ]);
    }
    let layers: Vec<String> = artifact.layers.iter().map(ToString::to_string).collect();
    let heading = format!(
        "Training of a {} network on {} points, {} more to decide when to stop, in {} s",
        layers.join("-"),
        report.n_training,
        report.n_validation,
        significant(time.as_secs_f64(), 3)
    );
    format!("{}\n{}", wrapped(&heading, ""), table.to_terminal())
}

fn ended(ended: Ended) -> &'static str {
    match ended {
        Ended::GoalReached => "goal reached",
        Ended::Converged => "no lower cost found",
        Ended::NoBetterValidation => "validation stalled",
        Ended::EpochsUsedUp => "epochs used up",
        Ended::Diverged => "weights ran away",
    }
}

/// Errors on unseen points, in unit and in percent of full scale.
pub(crate) fn errors(artifact: &InverseArtifact) -> String {
    let errors = &artifact.errors;
    let domain = &artifact.domain;
    let mut table = Table::new(["unseen points", "RMSE", "% of range", "95 %", "largest"]);
    let mut row = |name: &str, statistics: &ErrorStatistics, scale: f64, unit: &str, range: [f64; 2]| {
        let number = |value: f64| format!("{} {unit}", significant(value * scale, 3));
        table.row([
            name.to_owned(),
            number(statistics.rmse),
            significant(100.0 * statistics.rmse / (range[1] - range[0]), 2),
            number(statistics.p95),
            number(statistics.max),
        ]);
    };
    row("pressure → force → pressure", &errors.pressure_pa, 1e-3, "kPa", domain.pressure_pa);
    row("force → pressure → force", &errors.force_n, 1.0, "N", domain.force_n);
    format!("Accuracy on {} points that the training never saw\n{}", errors.pressure_pa.n, table.to_terminal())
}

/// Pressure errors by region, and the share of the operating range that has no inverse.
pub(crate) fn regions(artifact: &InverseArtifact) -> String {
    let errors = &artifact.errors;
    let mut table = Table::new(["where", "RMSE kPa", "95 % kPa", "largest kPa", "points"]);
    for region in &errors.regions {
        let name = region_name(region);
        match &region.pressure_pa {
            Some(found) => table.row([
                name,
                significant(found.rmse * 1e-3, 3),
                significant(found.p95 * 1e-3, 3),
                significant(found.max * 1e-3, 3),
                found.n.to_string(),
            ]),
            None => table.row([name, "–".to_owned(), "–".to_owned(), "–".to_owned(), "0".to_owned()]),
        };
    }
    let shares = &errors.coverage;
    let parts = [
        (shares.slack_percent, "the force is below the domain's (slack)"),
        (shares.beyond_percent, "the force is above the domain's"),
        (shares.flat_percent, "the force does not grow with pressure"),
        (shares.ambiguous_percent, "another pressure gives the same force"),
    ];
    let missing: Vec<String> = parts
        .into_iter()
        .filter(|(percent, _)| *percent > 0.0)
        .map(|(percent, why)| format!("in {percent:.1} % {why}"))
        .collect();
    let missing = if missing.is_empty() { String::new() } else { format!("; {}", missing.join(", ")) };
    let heading = format!(
        "Where the errors are. The inverse exists in {:.1} % of the operating range of pressures and lengths{missing}",
        shares.invertible_percent
    );
    format!("{}\n{}", wrapped(&heading, ""), table.to_terminal())
}

/// Name of a region.
pub(crate) fn region_name(region: &RegionErrors) -> String {
    let between = |scale: f64, decimals: usize, unit: &str| {
        // A little below zero rounds to zero, and is written as that.
        let power = 10f64.powi(decimals as i32);
        let [from, to] = [region.from, region.to].map(|end| (end * scale * power).round() / power + 0.0);
        format!("{from:.decimals$} to {to:.decimals$} {unit}")
    };
    match region.coordinate.as_str() {
        "pressure_pa" => format!("pressure {}", between(1e-3, 0, "kPa")),
        "length_m" => format!("length {}", between(1e3, 1, "mm")),
        _ if region.to > 0.5 => "contracting".to_owned(),
        _ => "extending".to_owned(),
    }
}

/// The network beside the numerical inverse.
pub(crate) fn inverses(artifact: &InverseArtifact, timing: &Timing) -> String {
    let mut table = Table::new(["inverse", "time", "RMSE kPa", "largest kPa"]);
    let time = |duration: Duration| format!("{} ns", duration.as_nanos());
    table.row([
        "network".to_owned(),
        time(timing.network),
        significant(artifact.errors.pressure_pa.rmse * 1e-3, 3),
        significant(artifact.errors.pressure_pa.max * 1e-3, 3),
    ]);
    let exact = significant(timing.exact_max_pa * 1e-3, 1);
    table.row(["numerical inverse".to_owned(), time(timing.exact), "–".to_owned(), exact]);
    format!("Network and exact inverse\n{}", table.to_terminal())
}
