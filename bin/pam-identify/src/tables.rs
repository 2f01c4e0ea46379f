//! Tables and messages for the terminal.

use pam_artifact::ModelArtifact;
use pam_artifact::model::{FitStatistics, ParameterEntry, ParameterStatus, StandstillFit};
use pam_identification::prepare::Gated;
use pam_recording::quality::{ChannelQuality, RecordingQuality};
use pam_report::Table;
use pam_report::number::{engineering, significant, with_stderr};
use pam_report::text::{told_apart, wrapped};

/// The quality gate: a row per channel of a single recording; of several, a row each with what is odd.
pub(crate) fn gate(gates: &[Gated]) -> String {
    let table = match gates {
        [one] => channels(&one.quality),
        many => overview(many),
    };
    format!("Recordings\n{}", table.to_terminal())
}

/// One recording, channel by channel.
fn channels(quality: &RecordingQuality) -> Table {
    let mut table = Table::new(["channel", "range", "noise", "step", "stuck", "fastest"]);
    for channel in &quality.channels {
        let fastest = match channel.name.as_str() {
            "pressure" => engineering(quality.pressure_rate_pa_per_s, "Pa/s", 3),
            "length" => engineering(quality.length_rate_m_per_s, "m/s", 3),
            _ => String::new(),
        };
        table.row([
            channel.name.clone(),
            range(channel),
            engineering(channel.noise, &channel.unit, 2),
            channel.quantization_step.map_or_else(|| "-".to_owned(), |step| engineering(step, &channel.unit, 3)),
            stuck(channel),
            fastest,
        ]);
    }
    let rate = significant(1.0 / quality.period_s.max(1e-12), 4);
    let gaps = gaps(quality).map_or(String::new(), |gaps| format!(", {gaps}"));
    table.row(["clock".to_owned(), format!("{} rows, {rate} Hz{gaps}", quality.n_rows)]);
    table
}

/// Columns of a recording's name among many.
const NAME: usize = 22;

/// Many recordings, a row each: noise of the channels, and what is odd.
fn overview(gates: &[Gated]) -> Table {
    let mut table = Table::new(["recording", "rows", "Hz", "noise of p", "of L", "of F", "odd"]);
    let names: Vec<&str> = gates.iter().map(|gated| short_name(&gated.quality.path)).collect();
    for (Gated { quality, .. }, name) in gates.iter().zip(told_apart(&names, NAME)) {
        let noise = |name: &str| {
            let channel = quality.channel(name);
            channel.map_or("-".to_owned(), |channel| engineering(channel.noise, &channel.unit, 2))
        };
        let mut odd = odd(quality).into_iter();
        table.row([
            name,
            quality.n_rows.to_string(),
            significant(1.0 / quality.period_s.max(1e-12), 3),
            noise("pressure"),
            noise("length"),
            noise("force"),
            odd.next().unwrap_or_default(),
        ]);
        for more in odd {
            table.row(["", "", "", "", "", "", &more]);
        }
    }
    table
}

/// Remarks for a person, in few words each.
fn odd(quality: &RecordingQuality) -> Vec<String> {
    let mut odd: Vec<String> = gaps(quality).into_iter().collect();
    for channel in &quality.channels {
        let name = match channel.name.as_str() {
            "pressure" => "p",
            "length" => "L",
            "force" => "F",
            other => other,
        };
        let share = channel.clipped_low_share + channel.clipped_high_share;
        if share > STUCK {
            odd.push(format!("{name} stuck {:.1} %", 100.0 * share));
        }
        if channel.highest <= channel.lowest {
            odd.push(format!("{name} constant"));
        }
    }
    odd
}

/// Share of samples at an end of a range that is worth a word.
const STUCK: f64 = 0.001;

fn gaps(quality: &RecordingQuality) -> Option<String> {
    match quality.repairs.gaps {
        0 => None,
        1 => Some("1 gap".to_owned()),
        gaps => Some(format!("{gaps} gaps")),
    }
}

/// File name without its folders, which repeat on every row.
fn short_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
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

/// What friction does where no motion tells its direction, with what the least of the other laws leaves; none where one was assumed.
pub(crate) fn friction(artifact: &ModelArtifact) -> Option<String> {
    let [taken, others @ ..] = artifact.standstill_laws.as_slice() else { return None };
    let compared = compared(taken, others)?;
    let [held_um, turn_um] = [artifact.direction.held_m, artifact.direction.turn_m].map(|travel_m| travel_m * 1e6);
    let turns = match (held_um > 0.0, turn_um > 0.0) {
        (false, false) => "at once after a reversal".to_owned(),
        (true, false) => format!("{held_um:.0} µm after a reversal"),
        (_, true) => format!("between {held_um:.0} and {:.0} µm after a reversal", held_um + turn_um),
    };
    Some(format!("{}, and turns over {turns}; {compared}", taken.standstill.words()))
}

/// What eq. 11 leaves under the law `taken`, and under the one of `others` that leaves least; none where there is no other.
fn compared(taken: &StandstillFit, others: &[StandstillFit]) -> Option<String> {
    let least = others.iter().min_by(|one, other| one.rmse_n.total_cmp(&other.rmse_n))?;
    // The order in which they stand is one of preference: a law at an end gives way to one in the middle that leaves about the same.
    let too_little = if least.rmse_n < taken.rmse_n { ", too little less to tell" } else { "" };
    Some(format!(
        "eq. 11 with free weights then leaves {:.3} N, and {:.3} N where {}{too_little}",
        taken.rmse_n,
        least.rmse_n,
        least.standstill.words()
    ))
}

/// Parameters with standard errors and status, composites after them.
pub(crate) fn parameters(artifact: &ModelArtifact) -> String {
    let mut table = Table::new(["parameter", "value", "status"]);
    for entry in &artifact.parameters {
        table.row([entry.name.clone(), value(entry), status(entry.status).to_owned()]);
    }
    let mut text = format!("Parameters\n{}", table.to_terminal());
    if !artifact.composites.is_empty() {
        let mut table = Table::new(["identifiable combination", "value"]);
        for entry in &artifact.composites {
            table.row([entry.name.clone(), scaled(entry.value, entry.stderr, &entry.unit)]);
        }
        text.push_str(&format!("\n{}", table.to_terminal()));
    }
    text
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
        ParameterStatus::Composite => "not separately identifiable",
        ParameterStatus::AtBound => "at its bound",
    }
}

/// How well the model agrees with every recording.
pub(crate) fn agreement(artifact: &ModelArtifact) -> String {
    let mut table = Table::new(["recording", "RMSE N", "all samples N", "max N", "R²", "fit %", "counted"]);
    let mut row = |name: String, statistics: &FitStatistics| {
        table.row([
            name,
            significant(statistics.rmse_n, 4),
            significant(statistics.rmse_all_n, 4),
            significant(statistics.max_n, 3),
            share(statistics.r2, 5),
            share(statistics.fit_percent, 2),
            counted(statistics),
        ]);
    };
    let recordings = &artifact.fit.recordings;
    let names: Vec<&str> = recordings.iter().map(|recording| short_name(&recording.path)).collect();
    for (recording, name) in recordings.iter().zip(told_apart(&names, NAME)) {
        row(name, &recording.statistics);
    }
    row("estimation, all".to_owned(), &artifact.fit.estimation);
    if let Some(validation) = &artifact.fit.validation {
        row("validation, all".to_owned(), validation);
    }
    let heading = format!(
        "Agreement. Noise of the sensors alone would leave {} N; effective sample size {}. Samples around reversals, where noise \
         hides the direction of friction, and beyond a sensor's range count in \"all samples\" only.",
        significant(artifact.fit.noise_floor_n, 3),
        significant(artifact.fit.effective_samples, 3)
    );
    format!("{}\n{}", wrapped(&heading, ""), table.to_terminal())
}

/// With so many decimals, or three digits where the model is worse than the mean of the force.
fn share(value: f64, decimals: usize) -> String {
    if value < 0.0 { significant(value, 3) } else { format!("{value:.decimals$}") }
}

/// Share of samples that count.
fn counted(statistics: &FitStatistics) -> String {
    let all = statistics.n_samples + statistics.n_unsettled;
    let percent = 100.0 * statistics.n_samples as f64 / all.max(1) as f64;
    format!("{percent:.1} %")
}

/// Residual of the columns without bounds.
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
                pam_muscle::force::Form::Corrected => "corrected".to_owned(),
                pam_muscle::force::Form::AsPrinted => "as printed".to_owned(),
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

#[cfg(test)]
mod tests {
    use super::*;
    use pam_muscle::direction::Standstill;

    fn law(standstill: Standstill, rmse_n: f64) -> StandstillFit {
        StandstillFit { standstill, rmse_n }
    }

    #[test]
    fn the_law_taken_stands_beside_the_one_that_leaves_least_of_the_others_whatever_their_order() {
        let taken = law(Standstill::Slides { over_pa: 4e4, share: 1.0 }, 9.7);
        let (next, least) = (law(Standstill::Held, 9.9), law(Standstill::AT_ONCE, 9.8));
        let words = compared(&taken, &[next, least]).expect("two others");
        assert!(words.contains("9.700 N, and 9.800 N") && words.ends_with(&Standstill::AT_ONCE.words()), "{words}");
        let words = compared(&taken, &[next, StandstillFit { rmse_n: 9.69, ..least }]).expect("two others");
        assert!(words.contains("9.690 N") && words.ends_with("too little less to tell"), "{words}");
        assert_eq!(compared(&taken, &[]), None);
    }
}
