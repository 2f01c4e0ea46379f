//! Tables of a lift.

use pam_exo::artifact::{Quantiles, TrialMetrics};
use pam_exo::metrics::{SignalErrors, TrackingErrors};
use pam_exo::options::{CASES, Variant};
use pam_report::Table;
use pam_report::text::wrapped;

/// One signal of the errors of an arm.
type Pick = fn(&TrackingErrors) -> SignalErrors;

/// Errors of a lift, beside the paper's Table 2 where it is the paper's lift.
pub(crate) fn errors(left: &TrackingErrors, right: &TrackingErrors, paper: Option<&TrackingErrors>) -> String {
    let mut table = Table::new(["", "", "MAX", "MAE", "RMSE", "ITAE", "Σ t |e|"]);
    let signals: [(&str, Pick); 3] = [
        ("angle (rad)", |errors| errors.angle_rad),
        ("velocity (rad/s)", |errors| errors.velocity_rad_per_s),
        ("acceleration (rad/s²)", |errors| errors.acceleration_rad_per_s2),
    ];
    for (name, signal) in signals {
        let mut name = name;
        for (arm, errors) in [("left", Some(left)), ("right", Some(right)), ("paper", paper)] {
            let Some(errors) = errors else { continue };
            let of = signal(errors);
            let digits = [of.max, of.mae, of.rmse, of.itae].map(|value| format!("{value:.5}"));
            let [max, mae, rmse, itae] = digits;
            table.row([name.to_owned(), arm.to_owned(), max, mae, rmse, itae, format!("{:.4}", of.itae_sum)]);
            name = "";
        }
    }
    let heading = if paper.is_some() {
        "Tracking errors beside the paper's Table 2 (ITAE is the integral of t |e| dt, times s² to the signal's unit; \
         the paper prints the plain sum of t |e| over its samples as ITAE, which is 1/dt = 100 times as much)"
    } else {
        "Tracking errors (ITAE is the integral of t |e| dt, times s² to the signal's unit)"
    };
    format!("{}\n{}", wrapped(heading, ""), table.to_terminal())
}

/// Quantiles of a study.
pub(crate) fn trials(trials: &TrialMetrics) -> String {
    let mut table = Table::new(["angle error (rad)", "median", "90 %", "95 %", "99 %", "largest"]);
    let mut row = |name: &str, quantiles: &Quantiles| {
        let values = [quantiles.p50, quantiles.p90, quantiles.p95, quantiles.p99, quantiles.largest];
        table.row([name.to_owned()].into_iter().chain(values.map(|value| format!("{value:.5}"))));
    };
    row("MAX", &trials.max_rad);
    row("MAE", &trials.mae_rad);
    row("RMSE", &trials.rmse_rad);
    let share = |count: u64| {
        let percent = 100.0 * count as f64 / trials.n_trials as f64;
        format!("{count} ({percent:.2} %)")
    };
    let heading = format!(
        "{} trials, the worse arm of each: slack {}, saturated {}, given up {}",
        trials.n_trials,
        share(trials.n_slack),
        share(trials.n_saturated),
        share(trials.n_diverged)
    );
    format!("{}\n{}", wrapped(&heading, ""), table.to_terminal())
}

/// Worth of each option, in tables of a few cases that fit a terminal.
pub(crate) fn options(variants: &[Variant]) -> String {
    let heading = "What each option is worth: MAX / RMSE of the angle in mrad, over 5 seeds and both arms (! saturated, \
                    slack or given up)";
    let mut text = format!("{}\n", wrapped(heading, ""));
    for columns in [0..5, 5..CASES.len()] {
        let mut table = Table::new(["controller"].into_iter().chain(CASES[columns.clone()].iter().copied()));
        for variant in variants {
            let cells = variant.cases[columns.clone()].iter().map(|case| {
                let mark = if case.troubled { " !" } else { "" };
                format!("{:.2} / {:.2}{mark}", 1e3 * case.max_rad, 1e3 * case.rmse_rad)
            });
            table.row([variant.name.clone()].into_iter().chain(cells));
        }
        text += &table.to_terminal();
    }
    text
}
