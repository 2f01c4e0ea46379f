//! Section: which effects were left out of the model.

use pam_artifact::diagnosis::{Evidence, Verdict};

use super::{DiagnosisPage, PageAlternative, PageCandidate, PageEffect, PageParameter};
use crate::escape::escaped;
use crate::number::{engineering, engineering_with_stderr, probability, significant};
use crate::page::html::{equation, heading, newtons, paragraph, remark, symbol_table, symbols, table};
use crate::{Table, number};

pub(super) fn named(page: &DiagnosisPage) -> String {
    let mut html = match page.effects.len() {
        0 if page.verdict == Verdict::Consistent => paragraph("Nothing that matters in these recordings."),
        0 => paragraph("No effect of the catalogue explains the mismatch."),
        1 => paragraph("One effect that the model leaves out is named."),
        n => paragraph(&format!(
            "{n} effects that the model leaves out are named, the one with the largest log predictive ratio first."
        )),
    };
    html.extend(page.effects.iter().map(effect));
    if !page.candidates.is_empty() {
        html.push_str(&heading("Candidates"));
        let (telling, rest): (Vec<&PageCandidate>, Vec<&PageCandidate>) =
            page.candidates.iter().partition(|candidate| tells(candidate));
        if telling.is_empty() {
            html.push_str(&paragraph("No candidate of the catalogue explains anything by itself."));
        } else {
            let (shown, more): (Vec<_>, Vec<_>) = telling
                .iter()
                .enumerate()
                .map(|(rank, candidate)| (rank, *candidate))
                .partition(|(rank, candidate)| *rank < SHOWN || candidate.outcome == "named");
            html.push_str(&table(&candidates(&shown.into_iter().map(|(_, candidate)| candidate).collect::<Vec<_>>())));
            let more: Vec<&PageCandidate> = more.into_iter().map(|(_, candidate)| candidate).collect();
            html.push_str(&folded(&more, "that were not named"));
        }
        html.push_str(&remark(
            "Each candidate alone, fitted jointly with the base model to all blocks but one and judged on that one, in \
             turn. The log predictive ratio is the sum over the blocks of ln(mean square without / mean square with).",
        ));
        html.push_str(&folded(&rest, "that explain nothing"));
    }
    html
}

/// Candidates that are listed whether they were named or not.
const SHOWN: usize = 6;

/// Candidates folded below a line to click on; nothing where there are none.
fn folded(rest: &[&PageCandidate], words: &str) -> String {
    if rest.is_empty() {
        return String::new();
    }
    let n = rest.len();
    format!("<details>\n<summary>{n} more {words}</summary>\n{}</details>\n", table(&candidates(rest)))
}

/// Whether a candidate was named, or explains at least something by itself.
fn tells(candidate: &PageCandidate) -> bool {
    candidate.outcome == "named" || candidate.explains >= LEAST_EXPLAINED
}

/// Share of the mean square below which a candidate is folded away.
const LEAST_EXPLAINED: f64 = 0.02;

fn effect(effect: &PageEffect) -> String {
    let (name, id) = (escaped(&capitalized(&effect.name)), escaped(&effect.id));
    let mut html = format!("<article class=\"effect\">\n<h3>{name}<code class=\"id\">{id}</code></h3>\n");
    html.push_str(&paragraph(&effect.summary));
    html.push_str(&equation(&effect.equation));
    if !effect.symbols.is_empty() {
        html.push_str(&symbols(&effect.symbols));
    }
    if !effect.validity.is_empty() {
        html.push_str(&remark(&format!("Assumptions: {}", effect.validity)));
    }
    if !effect.source.is_empty() {
        html.push_str(&remark(&format!("Source: {}", effect.source)));
    }
    if !effect.parameters.is_empty() {
        html.push_str("<h4>Parameters</h4>\n");
        html.push_str(&symbol_table(&parameters(&effect.parameters)));
    }
    html.push_str("<h4>Why it is believed</h4>\n");
    html.push_str(&paragraph(&evidence(&effect.evidence)));
    if !effect.signature.is_empty() {
        html.push_str(&format!("<p><strong>Signature:</strong> {}</p>\n", escaped(&effect.signature)));
    }
    html.push_str("<h4>Confused with</h4>\n");
    if effect.alternatives.is_empty() {
        html.push_str(&paragraph("These recordings distinguish it from every other effect of the catalogue."));
    } else {
        html.extend(effect.alternatives.iter().map(alternative));
    }
    if !effect.look_alikes.is_empty() {
        html.push_str(&paragraph("Other recordings may not distinguish it from:"));
        html.extend(effect.look_alikes.iter().map(alternative));
    }
    if !effect.separating_test.is_empty() {
        let test = escaped(&effect.separating_test);
        html.push_str(&format!("<p><strong>Test that decides:</strong> {test}</p>\n"));
    }
    html.push_str("</article>\n");
    html
}

fn parameters(parameters: &[PageParameter]) -> Table {
    let any = |of: fn(&PageParameter) -> &str| parameters.iter().any(|parameter| !of(parameter).is_empty());
    let (meaning, status) = (any(|parameter| &parameter.meaning), any(|parameter| &parameter.status));
    let row = |[symbol, name]: [&str; 2], value: String, status_text: &str, meaning_text: &str| {
        let mut cells = vec![symbol.to_owned(), name.to_owned(), value];
        cells.extend(status.then(|| status_text.to_owned()));
        cells.extend(meaning.then(|| meaning_text.to_owned()));
        cells
    };
    let mut table = Table::new(row(["symbol", "parameter"], "value".to_owned(), "status", "meaning"));
    for parameter in parameters {
        let value = match parameter.stderr {
            Some(stderr) => engineering_with_stderr(parameter.value, stderr, &parameter.unit),
            None => engineering(parameter.value, &parameter.unit, 3),
        };
        table.row(row([&parameter.symbol, &parameter.name], value, &parameter.status, &parameter.meaning));
    }
    table
}

fn evidence(evidence: &Evidence) -> String {
    let Evidence { log_ratio, rmse_without_n, rmse_with_n, blocks_improved, n_blocks, p_value } = *evidence;
    format!(
        "Fitted to all blocks of the recordings but one and judged on that one, in turn, it lowers the residual in \
         {blocks_improved} of {n_blocks} blocks, from {} without it (everything else refitted) to {} with it. The \
         log predictive ratio, Σ ln(mean square without / with), is {}; the probability of such an improvement by chance, \
         corrected for multiple comparisons, is {}.",
        newtons(rmse_without_n),
        newtons(rmse_with_n),
        significant(log_ratio, 3),
        probability(p_value).trim_start_matches("< ").to_owned() + if p_value < 1e-15 { " or less" } else { "" }
    )
}

fn alternative(alternative: &PageAlternative) -> String {
    let PageAlternative { id, name, because, test } = alternative;
    let name = if name.is_empty() { id.clone() } else { capitalized(name) };
    let mut html = format!("<p><strong>{}</strong><code class=\"id\">{}</code>", escaped(&name), escaped(id));
    if !because.is_empty() {
        html.push_str(&format!("<br>\nAlike because {}.", escaped(because.trim_end_matches('.'))));
    }
    if !test.is_empty() {
        html.push_str(&format!(" To tell them apart: {}.", escaped(test.trim_end_matches('.'))));
    }
    html.push_str("</p>\n");
    html
}

fn candidates(candidates: &[&PageCandidate]) -> Table {
    let mut table =
        Table::new(["candidate", "cross-validated RMSE", "log predictive ratio", "blocks improved", "p", "outcome"]);
    for candidate in candidates {
        let evidence = &candidate.evidence;
        table.row([
            if candidate.name.is_empty() { candidate.id.clone() } else { candidate.name.clone() },
            format!("{} → {}", newtons(evidence.rmse_without_n), newtons(evidence.rmse_with_n)),
            number::with_minus(format!("{:.1}", evidence.log_ratio)),
            format!("{} of {}", evidence.blocks_improved, evidence.n_blocks),
            probability(evidence.p_value),
            candidate.outcome.clone(),
        ]);
    }
    table
}

fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or(String::new(), |first| first.to_uppercase().chain(characters).collect())
}
