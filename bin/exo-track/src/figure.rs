//! The figures, from what was simulated.

use pam_exo::artifact::{MetricsArtifact, TrialMetrics, paper};
use pam_exo::config::LiftPlan;
use pam_exo::lift::Instant;
use pam_exo::study::{Study, Trial};
use pam_report::{EnvelopeFigure, LiftArm, LiftFigure, envelope_figure, lift_figure};

/// Shares of the trials that the envelope shows.
const SHARES: [f64; 7] = [0.005, 0.05, 0.25, 0.5, 0.75, 0.95, 0.995];

/// The figure of a lift, as SVG.
pub(crate) fn lift(arms: &[Vec<Instant>; 2], artifact: &MetricsArtifact) -> anyhow::Result<String> {
    let longest = if arms[0].len() >= arms[1].len() { &arms[0] } else { &arms[1] };
    let column = |value: fn(&Instant) -> f64| longest.iter().map(value).collect();
    let mrad = |value: f64| format!("{:.2}", 1e3 * value);
    let (left, right) = (artifact.left.errors.angle_rad, artifact.right.errors.angle_rad);
    let table = paper().angle_rad;
    let subtitle = format!(
        "Angle error in mrad, left / right (paper):\u{2003}MAX {} / {} ({})\u{2003}·\u{2003}MAE {} / {} ({})\u{2003}·\u{2003}\
         RMSE {} / {} ({})",
        mrad(left.max),
        mrad(right.max),
        mrad(table.max),
        mrad(left.mae),
        mrad(right.mae),
        mrad(table.mae),
        mrad(left.rmse),
        mrad(right.rmse),
        mrad(table.rmse)
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
    let start_m = track.first().map_or(0.0, |instant| instant.length_m);
    LiftArm {
        angle_rad: column(|i| i.state.q_rad),
        velocity_rad_per_s: column(|i| i.state.dq_rad_per_s),
        acceleration_rad_per_s2: column(|i| i.state.ddq_rad_per_s2),
        load_torque_n_m: column(|i| i.load_torque_n_m),
        muscle_torque_n_m: column(|i| i.muscle_torque_n_m),
        pressure_kpa: column(|i| 1e-3 * i.pressure_pa),
        command_kpa: column(|i| 1e-3 * i.command.pressure_pa),
        force_n: column(|i| i.muscle_force_n),
        command_force_n: column(|i| i.command.force_n),
        deformation_mm: track.iter().map(|i| 1e3 * (i.length_m - start_m)).collect(),
        length_rate_mm_per_s: column(|i| 1e3 * i.length_rate_m_per_s),
        length_acceleration_mm_per_s2: column(|i| 1e3 * i.length_acceleration_m_per_s2),
    }
}

/// The figure of a study, as SVG.
pub(crate) fn envelope(study: &Study, trials: &TrialMetrics, plan: &LiftPlan) -> anyhow::Result<String> {
    let column = |value: fn(&Trial) -> f64| study.trials.iter().map(value).collect();
    let spreads = &plan.spreads;
    let percent = |share: f64| format!("±{:.0} %", 100.0 * share);
    let table = paper().angle_rad;
    Ok(envelope_figure(&EnvelopeFigure {
        title: format!("{} lifts with what nobody knows exactly", trials.n_trials),
        subtitle: format!(
            "Load {}, friction {}, valve lag {}, geometry {}, sensor noise {}{}\u{2003}·\u{2003}slack {}, saturated {}, \
             given up {}",
            percent(spreads.payload),
            percent(spreads.friction),
            percent(spreads.lag),
            percent(spreads.geometry),
            percent(spreads.noise),
            if spreads.model_parameters { ", parameters of the model from their covariance" } else { "" },
            trials.n_slack,
            trials.n_saturated,
            trials.n_diverged
        ),
        envelope: study.envelope.quantiles_rad(plan.control.period_s, SHARES),
        errors_rad: [column(|trial| trial.max_rad), column(|trial| trial.mae_rad), column(|trial| trial.rmse_rad)],
        paper_rad: [table.max, table.mae, table.rmse],
    })?)
}
