//! What a person reads on the terminal.

use pam_core::artifact::ModelArtifact;
use pam_core::artifact::model::{ParameterEntry, ParameterStatus};
use pam_core::quality::ChannelQuality;
use pam_identification::prepare::Gated;
use pam_report::Table;
use pam_report::number::{engineering, significant, with_stderr};

/// The quality gate: one row per channel.
pub(crate) fn gate(gates: &[Gated]) -> String {
    let mut table = Table::new(["recording", "channel", "range", "noise", "step", "stuck", "fastest", "clock"]);
    for gate in gates {
        let quality = &gate.quality;
        let clock = format!("{} rows, {} Hz", quality.n_rows, significant(1.0 / quality.period_s.max(1e-12), 4));
        let breaks = match quality.repairs.gaps {
            0 => String::new(),
            1 => "1 gap".to_owned(),
            gaps => format!("{gaps} gaps"),
        };
        for (index, channel) in quality.channels.iter().enumerate() {
            let fastest = match channel.name.as_str() {
                "pressure" => engineering(quality.pressure_rate_pa_per_s, "Pa/s", 3),
                "length" => engineering(quality.length_rate_m_per_s, "m/s", 3),
                _ => String::new(),
            };
            table.row([
                if index == 0 { short_name(&quality.path) } else { String::new() },
                channel.name.clone(),
                range(channel),
                engineering(channel.noise, &channel.unit, 2),
                channel.quantization_step.map_or_else(|| "-".to_owned(), |step| engineering(step, &channel.unit, 3)),
                stuck(channel),
                fastest,
                match index {
                    0 => clock.clone(),
                    1 => breaks.clone(),
                    _ => String::new(),
                },
            ]);
        }
    }
    format!("Recordings\n{}", table.to_terminal())
}

/// File name without its folders, which repeat on every row.
fn short_name(path: &str) -> String {
    path.rsplit('/').next().unwrap_or(path).to_owned()
}

fn range(channel: &ChannelQuality) -> String {
    let (scale, unit) = match channel.name.as_str() {
        "pressure" => (1e-3, "kPa"),
        "length" => (1e3, "mm"),
        _ => (1.0, "N"),
    };
    if channel.highest > channel.lowest {
        format!("{:.1} to {:.1} {unit}", channel.lowest * scale, channel.highest * scale)
    } else {
        format!("{:.2} {unit}", channel.lowest * scale)
    }
}

fn stuck(channel: &ChannelQuality) -> String {
    let share = channel.clipped_low_share + channel.clipped_high_share;
    if share > 0.0 { format!("{:.1} %", 100.0 * share) } else { "-".to_owned() }
}

/// What friction does where no motion tells its direction, with what the second best law leaves; none where one was assumed.
pub(crate) fn friction(artifact: &ModelArtifact) -> Option<String> {
    let [best, second, ..] = artifact.standstill_laws.as_slice() else { return None };
    let [held_um, turn_um] = [artifact.direction.held_m, artifact.direction.turn_m].map(|travel_m| travel_m * 1e6);
    let turns = match (held_um > 0.0, turn_um > 0.0) {
        (false, false) => "at once after a reversal".to_owned(),
        (true, false) => format!("{held_um:.0} µm after a reversal"),
        (_, true) => format!("between {held_um:.0} and {:.0} µm after a reversal", held_um + turn_um),
    };
    Some(format!(
        "{}, and turns over {turns}; eq. 11 with free weights then leaves {:.3} N, and {:.3} N where {}",
        best.standstill.words(),
        best.rmse_n,
        second.rmse_n,
        second.standstill.words()
    ))
}

/// Parameters with standard errors and status, composites after them.
pub(crate) fn parameters(artifact: &ModelArtifact) -> String {
    let mut table = Table::new(["parameter", "value", "status"]);
    for entry in &artifact.parameters {
        table.row([entry.name.clone(), value(entry), status(entry.status).to_owned()]);
    }
    for entry in &artifact.composites {
        let value = scaled(entry.value, entry.stderr, &entry.unit);
        table.row([entry.name.clone(), value, "what the data tell".to_owned()]);
    }
    format!("Parameters\n{}", table.to_terminal())
}

fn value(entry: &ParameterEntry) -> String {
    scaled(entry.value, entry.stderr, &entry.unit)
}

/// Value and standard error in a unit that a person thinks in.
fn scaled(value: f64, stderr: Option<f64>, unit: &str) -> String {
    let (scale, name) = match unit {
        "Pa" if value.abs() >= 1e8 => (1e-9, " GPa"),
        "Pa" => (1e-3, " kPa"),
        "m" => (1e3, " mm"),
        "m^2" => (1e6, " mm²"),
        "rad" => (180.0 / std::f64::consts::PI, "°"),
        "1" => (1.0, ""),
        "N" => (1.0, " N"),
        other => return format!("{} {other}", significant(value, 4)),
    };
    match stderr {
        Some(stderr) => format!("{}{name}", with_stderr(value * scale, stderr * scale)),
        None => format!("{}{name}", significant(value * scale, 4)),
    }
}

fn status(status: ParameterStatus) -> &'static str {
    match status {
        ParameterStatus::Fitted => "fitted",
        ParameterStatus::Fixed => "fixed",
        ParameterStatus::Composite => "share of a composite",
        ParameterStatus::AtBound => "at its bound",
    }
}

/// How well the model agrees with every recording.
pub(crate) fn agreement(artifact: &ModelArtifact) -> String {
    let mut table = Table::new(["recording", "RMSE N", "all N", "max N", "R²", "fit %", "samples", "left out"]);
    let mut row = |name: String, statistics: &pam_core::artifact::model::FitStatistics| {
        table.row([
            name,
            significant(statistics.rmse_n, 4),
            significant(statistics.rmse_all_n, 4),
            significant(statistics.max_n, 3),
            format!("{:.5}", statistics.r2),
            format!("{:.2}", statistics.fit_percent),
            statistics.n_samples.to_string(),
            statistics.n_unsettled.to_string(),
        ]);
    };
    for recording in &artifact.fit.recordings {
        row(short_name(&recording.path), &recording.statistics);
    }
    row("estimation, all".to_owned(), &artifact.fit.estimation);
    if let Some(validation) = &artifact.fit.validation {
        row("validation, all".to_owned(), validation);
    }
    format!(
        "Agreement (sensor noise alone would leave {} N; the samples are worth {} independent ones; samples \
         around reversals, where noise hides the direction of friction, and beyond a sensor's range count in \"all\" only)\n{}",
        significant(artifact.fit.noise_floor_n, 3),
        significant(artifact.fit.effective_samples, 3),
        table.to_terminal()
    )
}

/// What the columns reach without bounds.
pub(crate) fn unbounded(artifact: &ModelArtifact) -> Option<String> {
    let unbounded = artifact.unbounded.as_ref()?;
    let mut table = Table::new(["implied by free weights", "value", ""]);
    for entry in &unbounded.implied {
        let verdict = if entry.physical { "" } else { "unphysical" };
        table.row([entry.name.clone(), scaled(entry.value, None, &entry.unit), verdict.to_owned()]);
    }
    let validation = unbounded
        .validation_rmse_n
        .map(|rmse_n| format!(", {} N on validation", significant(rmse_n, 4)))
        .unwrap_or_default();
    Some(format!(
        "Without bounds: RMSE {} N on estimation{validation}\n{}",
        significant(unbounded.estimation_rmse_n, 4),
        table.to_terminal()
    ))
}

/// Both forms of eq. 11 on the same data.
pub(crate) fn forms(first: &ModelArtifact, second: &ModelArtifact) -> String {
    let mut table = Table::new(["eq. 11", "RMSE N", "validation N", "c10 + c01", "k3", "at a bound"]);
    for artifact in [first, second] {
        let value =
            |name: &str| artifact.parameters.iter().find(|entry| entry.name == name).map_or(f64::NAN, |e| e.value);
        let pressed: Vec<&str> = artifact
            .parameters
            .iter()
            .filter(|entry| entry.status == ParameterStatus::AtBound)
            .map(|entry| entry.name.as_str())
            .collect();
        table.row([
            match artifact.form {
                pam_core::force::Form::Corrected => "corrected".to_owned(),
                pam_core::force::Form::AsPrinted => "as printed".to_owned(),
            },
            significant(artifact.fit.estimation.rmse_n, 4),
            artifact.fit.validation.map_or_else(|| "-".to_owned(), |statistics| significant(statistics.rmse_n, 4)),
            scaled(value("c10") + value("c01"), None, "Pa"),
            scaled(value("k3"), None, "N"),
            if pressed.is_empty() { "-".to_owned() } else { pressed.join(", ") },
        ]);
    }
    format!("What the misprints cost\n{}", table.to_terminal())
}
