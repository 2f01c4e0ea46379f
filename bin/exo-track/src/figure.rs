//! The figures, from what was simulated.

use pam_exo::artifact::{MetricsArtifact, TrialMetrics};
use pam_exo::config::LiftPlan;
use pam_exo::lift::Instant;
use pam_exo::metrics::{SignalErrors, TrackingErrors};
use pam_exo::study::{Study, Trial};
use pam_report::{EnvelopeFigure, LiftArm, LiftFigure, envelope_figure, lift_figure};

/// Shares of the trials that the envelope shows.
const SHARES: [f64; 7] = [0.005, 0.05, 0.25, 0.5, 0.75, 0.95, 0.995];

/// The figure of a lift, as SVG; `paper` where it is the paper's.
pub(crate) fn lift(
    arms: &[Vec<Instant>; 2],
    artifact: &MetricsArtifact,
    paper: Option<&TrackingErrors>,
) -> anyhow::Result<String> {
    let longest = if arms[0].len() >= arms[1].len() { &arms[0] } else { &arms[1] };
    let column = |value: fn(&Instant) -> f64| longest.iter().map(value).collect();
    let errors = |name: &str, of: fn(&SignalErrors) -> f64| {
        let mrad = |errors: &TrackingErrors| format!("{:.2}", 1e3 * of(&errors.angle_rad));
        let beside = paper.map_or(String::new(), |paper| format!(" ({})", mrad(paper)));
        format!("{name} {} / {}{beside}", mrad(&artifact.left.errors), mrad(&artifact.right.errors))
    };
    let subtitle = format!(
        "Tracking error of the angle in mrad, left / right{}:\u{2003}{}",
        if paper.is_some() { " (paper)" } else { "" },
        [errors("MAX", |of| of.max), errors("MAE", |of| of.mae), errors("RMSE", |of| of.rmse)]
            .join("\u{2003}·\u{2003}")
    );
    Ok(lift_figure(&LiftFigure {
        title: "Lift with an elbow exoskeleton".to_owned(),
        subtitle,
        time_s: column(|i| i.time_s),
        reference: [
            column(|i| i.reference.q_rad),
            column(|i| i.reference.dq_rad_per_s),
            column(|i| i.reference.ddq_rad_per_s2),
        ],
        arms: [arm(&arms[0]), arm(&arms[1])],
    })?)
}

fn arm(track: &[Instant]) -> LiftArm {
    let column = |value: fn(&Instant) -> f64| track.iter().map(value).collect();
    LiftArm {
        angle_rad: column(|i| i.state.q_rad),
        velocity_rad_per_s: column(|i| i.state.dq_rad_per_s),
        acceleration_rad_per_s2: column(|i| i.state.ddq_rad_per_s2),
        pressure_kpa: column(|i| 1e-3 * i.pressure_pa),
        command_kpa: column(|i| 1e-3 * i.command.pressure_pa),
        force_n: column(|i| i.muscle_force_n),
        command_force_n: column(|i| i.command.force_n),
    }
}

/// The figure of a study, as SVG.
pub(crate) fn envelope(
    study: &Study,
    trials: &TrialMetrics,
    plan: &LiftPlan,
    paper: Option<&TrackingErrors>,
) -> anyhow::Result<String> {
    let column = |value: fn(&Trial) -> f64| study.trials.iter().map(value).collect();
    let spreads = &plan.spreads;
    let percent = |share: f64| format!("±{:.0} %", 100.0 * share);
    Ok(envelope_figure(&EnvelopeFigure {
        title: format!("Robustness of the lift: {} trials", trials.n_trials),
        subtitle: format!(
            "Load {}, friction {}, valve lag {}, geometry {}, noise {}{}\u{2003}·\u{2003}{} slack, {} saturated, \
             {} given up",
            percent(spreads.payload),
            percent(spreads.friction),
            percent(spreads.lag),
            percent(spreads.geometry),
            percent(spreads.noise),
            if spreads.model_parameters { ", parameters from their covariance" } else { "" },
            trials.n_slack,
            trials.n_saturated,
            trials.n_diverged
        ),
        envelope: study.envelope.quantiles_rad(plan.control.period_s, SHARES),
        errors_rad: [column(|trial| trial.max_rad), column(|trial| trial.mae_rad), column(|trial| trial.rmse_rad)],
        paper_rad: paper.map(|paper| [paper.angle_rad.max, paper.angle_rad.mae, paper.angle_rad.rmse]),
    })?)
}
