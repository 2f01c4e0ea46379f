//! What a person reads on the terminal.

use pam_core::artifact::DiagnosisArtifact;
use pam_core::artifact::diagnosis::{BeforeAfter, Residual, Verdict};
use pam_core::artifact::model::{ParameterEntry, ParameterStatus};
use pam_diagnosis::words;
use pam_report::Table;
use pam_report::number::{engineering, engineering_with_stderr, probability, significant};

use crate::{empirical, page};

/// Candidates that are listed.
const CANDIDATES: usize = 5;
/// Regions that are listed.
const REGIONS: usize = 3;

/// Verdict and everything that it rests on.
pub(crate) fn all(artifact: &DiagnosisArtifact) -> String {
    let mut text = format!("{}: {}\n", word(artifact.verdict), artifact.statement);
    let parts = [
        effects(artifact),
        empirical::table(artifact),
        Some(fit(artifact)),
        regions(artifact),
        candidates(artifact),
        next(artifact),
    ];
    for part in parts.into_iter().flatten() {
        text.push('\n');
        text.push_str(&part);
    }
    text
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Consistent => "Consistent",
        Verdict::Explained => "Explained",
        Verdict::ExplainedInPart => "Explained in part",
        Verdict::Ambiguous => "Ambiguous",
        Verdict::Unexplained => "Unexplained",
    }
}

/// What was left out, with values.
fn effects(artifact: &DiagnosisArtifact) -> Option<String> {
    if artifact.effects.is_empty() {
        return None;
    }
    let mut table = Table::new(["effect", "parameter", "value", "held-out blocks N", "improved", "p"]);
    for effect in &artifact.effects {
        let evidence = &effect.evidence;
        let mut once = [
            format!("{} → {}", significant(evidence.rmse_without_n, 3), significant(evidence.rmse_with_n, 3)),
            format!("{} of {}", evidence.blocks_improved, evidence.n_blocks),
            probability(evidence.p_value),
        ];
        let mut name = effect.id.clone();
        for parameter in &effect.parameters {
            let [gain, blocks, p] = std::mem::take(&mut once);
            table.row([std::mem::take(&mut name), parameter.name.clone(), value(parameter), gain, blocks, p]);
        }
        for other in &effect.alternatives {
            table.row([format!("  or {other}")]);
        }
    }
    Some(format!("What was left out\n{}", table.to_terminal()))
}

fn value(entry: &ParameterEntry) -> String {
    let value = match entry.stderr {
        Some(stderr) => engineering_with_stderr(entry.value, stderr, &entry.unit),
        None => engineering(entry.value, &entry.unit, 3),
    };
    match entry.status {
        ParameterStatus::AtBound => format!("{value}, at its bound"),
        ParameterStatus::Fixed => format!("{value}, not seen"),
        ParameterStatus::Fitted | ParameterStatus::Composite => value,
    }
}

/// Residuals before and after.
fn fit(artifact: &DiagnosisArtifact) -> String {
    let mut table = Table::new(["residual, rms", "as given N", "base N", "with effects N", "noise floor N"]);
    let mut row = |name: &str, given: Option<Residual>, fit: &BeforeAfter| {
        let given = given.map_or("-".to_owned(), |given| significant(given.rmse_n, 3));
        let after = if artifact.effects.is_empty() && artifact.empirical.is_none() {
            "-".to_owned()
        } else {
            significant(fit.rmse_after_n, 3)
        };
        let (before, floor) = (significant(fit.rmse_before_n, 3), significant(fit.noise_floor_n, 3));
        table.row([name.to_owned(), given, before, after, floor]);
    };
    let given = artifact.as_given.as_ref();
    row("estimation", given.map(|given| given.estimation), &artifact.fit.estimation);
    if let Some(holdout) = &artifact.fit.holdout {
        row("held out", given.and_then(|given| given.holdout), holdout);
    }
    table.to_terminal()
}

/// Where the mismatch lies, and where what is left does.
fn regions(artifact: &DiagnosisArtifact) -> Option<String> {
    let mut table = Table::new(["where", "share", "p", ""]);
    let left = page::significant(&artifact.unexplained_where).map(|region| (region, "left without a name"));
    // Where nothing is named, what is left is all there is.
    let of_all = if artifact.effects.is_empty() && !artifact.unexplained_where.is_empty() { 0 } else { REGIONS };
    let of_all = page::significant(&artifact.regions).take(of_all).map(|region| (region, ""));
    for (region, remark) in of_all.chain(left.take(REGIONS)) {
        let recording =
            region.recording.as_deref().map_or(String::new(), |path| format!(", {}", page::short_name(path)));
        table.row([
            format!("{}{recording}", words::place(region)),
            format!("{:.0} %", 100.0 * region.share_of_excess),
            probability(region.p_value),
            remark.to_owned(),
        ]);
    }
    let empty = artifact.regions.is_empty() && artifact.unexplained_where.is_empty();
    (!empty).then(|| table.to_terminal())
}

/// What was weighed, the best first.
fn candidates(artifact: &DiagnosisArtifact) -> Option<String> {
    if artifact.candidates.is_empty() {
        return None;
    }
    let mut table = Table::new(["candidate, alone", "explains", "evidence", "outcome"]);
    for candidate in artifact.candidates.iter().take(CANDIDATES) {
        table.row([
            candidate.id.clone(),
            format!("{:.0} %", 100.0 * candidate.explains),
            format!("{:.1}", candidate.evidence.log_ratio),
            candidate.outcome.clone(),
        ]);
    }
    Some(table.to_terminal())
}

/// What to record next.
fn next(artifact: &DiagnosisArtifact) -> Option<String> {
    if let Some(next) = &artifact.next_experiment {
        return Some(format!("What to record next: {}\n", next.instruction));
    }
    let lines: Vec<String> = artifact
        .effects
        .iter()
        .map(|effect| format!("Test that decides on {}: {}\n", effect.id, effect.separating_test))
        .collect();
    (!lines.is_empty()).then(|| lines.concat())
}

/// Cosines of which less is said.
const FAINT: f64 = 0.3;

/// Which effects the recordings could tell apart: a matrix of those that they would show.
pub(crate) fn isolability(artifact: &DiagnosisArtifact) -> String {
    let found = &artifact.isolability;
    // What stays hidden is compared with nothing.
    let compared =
        |index: &usize| found.cosine[*index].iter().enumerate().any(|(at, &cosine)| at != *index && cosine > 0.0);
    let (shown, hidden): (Vec<usize>, Vec<usize>) = (0..found.ids.len()).partition(compared);
    let mut header = vec!["".to_owned(), "effect".to_owned(), "leaves N".to_owned()];
    header.extend((1..=shown.len()).map(|number| number.to_string()));
    let mut table = Table::new(header);
    for (number, &row) in shown.iter().enumerate() {
        let mut cells = vec![(number + 1).to_string(), found.ids[row].clone(), significant(found.visible_n[row], 2)];
        cells.extend(shown.iter().map(|&column| {
            let cosine = found.cosine[row][column].abs();
            if row == column {
                "-".to_owned()
            } else if cosine < FAINT {
                String::new()
            } else {
                format!("{:.0}", 100.0 * cosine)
            }
        }));
        table.row(cells);
    }
    let hidden: Vec<&str> = hidden.into_iter().map(|index| found.ids[index].as_str()).collect();
    let hidden = if hidden.is_empty() {
        String::new()
    } else {
        format!("Hidden in the noise at a typical size: {}\n", hidden.join(", "))
    };
    format!(
        "What these recordings could tell apart: residual of each effect at a typical size after a refit of the base, and \
         100 times the cosine between the residuals of two (100 looks the same, blank is below {:.0})\n{}{hidden}",
        100.0 * FAINT,
        table.to_terminal()
    )
}
