//! Tables and messages for the terminal.

use pam_artifact::DiagnosisArtifact;
use pam_artifact::diagnosis::{BeforeAfter, Evidence, Region, Residual, Verdict};
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_diagnosis::words;
use pam_report::Table;
use pam_report::number::{engineering, engineering_with_stderr, probability, significant};
use pam_report::text::{shortened, wrapped};

use crate::{empirical, page};

/// Candidates that are listed.
const CANDIDATES: usize = 5;
/// Regions that are listed.
const REGIONS: usize = 3;

/// Verdict and everything that it rests on.
pub(crate) fn all(artifact: &DiagnosisArtifact) -> String {
    let mut text = wrapped(&format!("{}: {}", word(artifact.verdict), artifact.statement), "");
    text.push('\n');
    let left = unexplained(artifact);
    let parts = [
        effects(artifact),
        empirical::table(artifact),
        Some(fit(artifact)),
        regions(artifact),
        left,
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

/// Excluded candidates, with values.
fn effects(artifact: &DiagnosisArtifact) -> Option<String> {
    if artifact.effects.is_empty() {
        return None;
    }
    let mut table = Table::new(["effect", "value", "validation RMSE N", "p"]);
    for effect in &artifact.effects {
        let evidence = &effect.evidence;
        table.row([effect.id.clone(), String::new(), gain(evidence), probability(evidence.p_value)]);
        for parameter in &effect.parameters {
            table.row([format!("  {}", parameter.name), value(parameter)]);
        }
        for other in &effect.alternatives {
            table.row([format!("  or {other}")]);
        }
    }
    Some(format!("Missing physics\n{}", table.to_terminal()))
}

/// RMSE over blocks left out of the fit, without and with an effect.
fn gain(evidence: &Evidence) -> String {
    format!("{} → {}", significant(evidence.rmse_without_n, 3), significant(evidence.rmse_with_n, 3))
}

fn value(entry: &ParameterEntry) -> String {
    // At a bound a standard error says nothing, and would make the table wider than a terminal.
    let value = match entry.stderr.filter(|_| entry.status != ParameterStatus::AtBound) {
        Some(stderr) => engineering_with_stderr(entry.value, stderr, &entry.unit),
        None => engineering(entry.value, &entry.unit, 3),
    };
    match entry.status {
        ParameterStatus::AtBound => format!("{value}, at its bound"),
        ParameterStatus::Fixed if page::is_past(entry) => format!("{value}, at the end"),
        ParameterStatus::Fixed => format!("{value}, not seen"),
        ParameterStatus::Fitted | ParameterStatus::Composite => value,
    }
}

/// Residuals before and after, over counted and over all samples.
fn fit(artifact: &DiagnosisArtifact) -> String {
    let mut table = Table::new(["RMSE", "samples", "as given N", "refitted N", "augmented N", "noise N"]);
    let with_effects = page::has_additions(artifact);
    let mut rows = |name: &str, given: Option<Residual>, fit: &BeforeAfter| {
        let counted = [given.map(|given| given.rmse_n), Some(fit.rmse_before_n), Some(fit.rmse_after_n)];
        let all = [given.map(|given| given.rmse_all_n), Some(fit.rmse_all_before_n), Some(fit.rmse_all_after_n)];
        let floor = significant(fit.noise_floor_n, 3);
        for (name, samples, [given, before, after], floor) in
            [(name, "counted", counted, floor), ("", "all", all, String::new())]
        {
            let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| significant(value, 3));
            let after = number(after.filter(|_| with_effects));
            table.row([name.to_owned(), samples.to_owned(), number(given), number(before), after, floor]);
        }
    };
    let given = artifact.as_given.as_ref();
    rows("estimation", given.map(|given| given.estimation), &artifact.fit.estimation);
    if let Some(holdout) = &artifact.fit.holdout {
        rows("held out", given.and_then(|given| given.holdout), holdout);
    }
    table.to_terminal()
}

/// Where the mismatch lies.
fn regions(artifact: &DiagnosisArtifact) -> Option<String> {
    // Where nothing is named, what is left is all there is.
    let repeats = artifact.effects.is_empty() && !artifact.unexplained_where.is_empty();
    (!repeats).then(|| places("where the mismatch lies", &artifact.regions)).flatten()
}

/// Where what is left lies.
fn unexplained(artifact: &DiagnosisArtifact) -> Option<String> {
    places("where unmodelled structure is left", &artifact.unexplained_where)
}

fn places(title: &str, regions: &[Region]) -> Option<String> {
    let mut table = Table::new([title, "share", "p"]);
    for region in page::significant(regions).take(REGIONS) {
        let name = region.recording.as_deref().map(page::short_name);
        let recording = name.map_or(String::new(), |name| format!(", {}", shortened(&name, 12)));
        table.row([
            format!("{}{recording}", words::place(region)),
            format!("{:.0} %", 100.0 * region.share_of_excess),
            probability(region.p_value),
        ]);
    }
    (!regions.is_empty()).then(|| table.to_terminal())
}

/// Candidates, the best first.
fn candidates(artifact: &DiagnosisArtifact) -> Option<String> {
    if artifact.candidates.is_empty() {
        return None;
    }
    let mut table = Table::new(["candidate, alone", "validation RMSE N", "outcome"]);
    for candidate in artifact.candidates.iter().take(CANDIDATES) {
        let gain = gain(&candidate.evidence);
        table.row([candidate.id.clone(), gain, candidate.outcome.clone()]);
    }
    Some(table.to_terminal())
}

/// The recording to make next.
fn next(artifact: &DiagnosisArtifact) -> Option<String> {
    if let Some(next) = &artifact.next_experiment {
        return Some(format!("{}\n", wrapped(&format!("What to record next: {}", next.instruction), "")));
    }
    let lines: Vec<String> = artifact
        .effects
        .iter()
        .map(|effect| {
            format!("{}\n", wrapped(&format!("Test that decides on {}: {}", effect.id, effect.separating_test), ""))
        })
        .collect();
    (!lines.is_empty()).then(|| lines.concat())
}

/// Cosines of which less is said.
const FAINT: f64 = 0.3;

/// Rivals that are listed beside an effect.
const RIVALS: usize = 2;

/// Which effects the recordings could tell apart: each with those that it looks most like.
pub(crate) fn isolability(artifact: &DiagnosisArtifact) -> String {
    let found = &artifact.isolability;
    // Hidden effects are compared with nothing.
    let compared =
        |index: &usize| found.cosine[*index].iter().enumerate().any(|(at, &cosine)| at != *index && cosine > 0.0);
    let (shown, hidden): (Vec<usize>, Vec<usize>) = (0..found.ids.len()).partition(compared);
    let mut table = Table::new(["effect", "leaves N", "most similar", "cosine"]);
    for &row in &shown {
        let mut others: Vec<usize> = shown.iter().copied().filter(|other| *other != row).collect();
        others.sort_by(|&a, &b| found.cosine[row][b].abs().total_cmp(&found.cosine[row][a].abs()));
        let mut name = found.ids[row].clone();
        let mut leaves = significant(found.visible_n[row], 2);
        let rivals = others.into_iter().filter(|&other| found.cosine[row][other].abs() >= FAINT).take(RIVALS);
        let mut rivals: Vec<(String, String)> =
            rivals.map(|other| (found.ids[other].clone(), format!("{:.2}", found.cosine[row][other].abs()))).collect();
        if rivals.is_empty() {
            rivals.push(("nothing else".to_owned(), String::new()));
        }
        for (rival, cosine) in rivals {
            table.row([std::mem::take(&mut name), std::mem::take(&mut leaves), rival, cosine]);
        }
    }
    let hidden: Vec<&str> = hidden.into_iter().map(|index| found.ids[index].as_str()).collect();
    let hidden = if hidden.is_empty() {
        String::new()
    } else {
        wrapped(&format!("Hidden in the noise at a typical size: {}", hidden.join(", ")), "") + "\n"
    };
    let heading = wrapped(
        &format!(
            "Distinguishability: what each effect leaves at a typical size after a refit of the base, and the effects whose \
             residuals are most similar (a cosine of 1 is the same, below {FAINT:.1} is left out; the report has the matrix)"
        ),
        "",
    );
    format!("{heading}\n{}{hidden}", table.to_terminal())
}
