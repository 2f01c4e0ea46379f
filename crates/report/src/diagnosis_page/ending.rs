//! Sections at the end: improvement, what is unknown, the next recording, provenance.

use pam_artifact::diagnosis::NextExperiment;

use super::headline::share_explained;
use super::loops::{Stretch, loops};
use super::place::regions_table;
use super::samples::Samples;
use super::{DiagnosisPage, PageAppendix, PageBaseParameter, PageEstimate, whiteness};
use crate::escape::escaped;
use crate::number::{engineering, engineering_with_stderr, significant};
use crate::page::html::{figure, heading, list, newtons, paragraph, percent, remark, symbol_table, table};
use crate::{FigureError, Table};

/// Section: what the effects buy.
pub(super) fn gain(page: &DiagnosisPage, recordings: &[Samples]) -> Result<String, FigureError> {
    let Some(additions) = page.additions() else {
        return Ok(paragraph("Nothing was added to the model, so nothing changes."));
    };
    let mut html = match page.holdout {
        Some(fit) => {
            let gone = share_explained(fit)
                .map_or(String::new(), |share| format!(", {} of the excess over the noise floor", percent(share)));
            let falls = if fit.rmse_after_n < fit.rmse_before_n { "falls" } else { "rises" };
            paragraph(&format!(
                "With {additions}, the RMSE on recordings that nothing was fitted to {falls} from {} to {}{gone}; the noise \
                 floor is {}.",
                newtons(fit.rmse_before_n),
                newtons(fit.rmse_after_n),
                newtons(fit.noise_floor_n)
            ))
        }
        None => paragraph(
            "No recording was held out, so the gain is known on the recordings used for fitting alone. Hold one out to \
             see what the effects are worth on data that they have not seen.",
        ),
    };
    if !page.base_parameters.is_empty() {
        html.push_str(&heading("Base parameters before and after"));
        html.push_str(&symbol_table(&base_parameters(&page.base_parameters)));
        html.push_str(&remark(
            "Before: as identified. After: fitted together with what was added. Each ± is one standard error, and \
             says how well the recordings determine a value if the model is right.",
        ));
    }
    if let Some(stretch) = Stretch::most_telling(recordings) {
        html.push_str(&heading("A loop before and after"));
        let which = if stretch.is_closed() { "The closed loop" } else { "The stretch" };
        let caption = format!(
            "{which} that shows the effects best: {}. On the right a parabola through the measured force is taken off all three, \
             so that the loop opens; lines are running means.",
            stretch.words()
        );
        html.push_str(&figure(&loops(&stretch)?, &caption));
    }
    Ok(html)
}

/// Section: what is still unknown.
pub(super) fn unknown(page: &DiagnosisPage, recordings: &[Samples]) -> Result<String, FigureError> {
    let unknown = &page.unknown;
    let mut html = match share_explained(page.estimation) {
        _ if page.regions.is_empty() && page.effects.is_empty() => paragraph(
            "The base model leaves no excess over the noise floor that matters, so there is nothing to explain.",
        ),
        Some(share) => {
            let left = if page.effects.is_empty() { 1.0 } else { 1.0 - share };
            paragraph(&format!(
                "{} of the excess over the noise floor (mean squares, counted samples) is left without an explanation.",
                percent(left)
            ))
        }
        None => paragraph("The residual does not exceed the noise floor."),
    };
    html.push_str(&whiteness::whiteness(recordings)?);
    if unknown.regions.is_empty() {
        html.push_str(&paragraph("No structure is left that would stand out of the noise."));
    } else {
        html.push_str(&heading("Unmodelled structure"));
        html.push_str(&table(&regions_table(&unknown.regions)));
    }
    let open: Vec<String> = page
        .effects
        .iter()
        .filter(|effect| !effect.alternatives.is_empty())
        .map(|effect| {
            let ids: Vec<&str> = effect.alternatives.iter().map(|alternative| alternative.id.as_str()).collect();
            format!("{} may be {} instead.", effect.id, ids.join(" or "))
        })
        .collect();
    if !open.is_empty() {
        html.push_str(&heading("Not distinguishable by these recordings"));
        html.push_str(&list(&open));
    }
    if !unknown.implausible.is_empty() {
        html.push_str(&heading("Base parameters that no such muscle has"));
        let mut rows = Table::new(["parameter", "value", "plausible", "likely cause"]);
        for entry in &unknown.implausible {
            let [from, to] = entry.plausible.map(|value| engineering(value, &entry.unit, 3));
            let value = engineering(entry.value, &entry.unit, 3);
            rows.row([entry.parameter.clone(), value, format!("{from} to {to}"), entry.likely_cause.clone()]);
        }
        html.push_str(&table(&rows));
    }
    Ok(html)
}

/// Values before and after, with how far each moved.
fn base_parameters(parameters: &[PageBaseParameter]) -> Table {
    let mut rows = Table::new(["symbol", "parameter", "before", "after", "change / standard error"]);
    for entry in parameters {
        let value = |estimate: &PageEstimate| {
            let value = match estimate.stderr {
                Some(stderr) => engineering_with_stderr(estimate.value, stderr, &entry.unit),
                None => engineering(estimate.value, &entry.unit, 3),
            };
            if estimate.status.is_empty() { value } else { format!("{value}, {}", estimate.status) }
        };
        let known = entry.before.stderr.is_some() && entry.after.stderr.is_some();
        let errors: f64 =
            [&entry.before, &entry.after].iter().filter_map(|estimate| estimate.stderr).map(|e| e * e).sum();
        let change = (entry.after.value - entry.before.value) / errors.sqrt();
        rows.row([
            entry.symbol.clone(),
            entry.name.clone(),
            value(&entry.before),
            value(&entry.after),
            if known && change.is_finite() { significant(change, 2) } else { "–".to_owned() },
        ]);
    }
    rows
}

/// Section: what to record next.
pub(super) fn next(experiment: Option<&NextExperiment>) -> String {
    let Some(experiment) = experiment else {
        return paragraph("Nothing: nothing is in question that another recording would decide.");
    };
    let (protocol, instruction) = (escaped(&experiment.protocol), escaped(&experiment.instruction));
    let mut html = format!("<p><strong>{protocol}</strong></p>\n<p>{instruction}</p>\n");
    if !experiment.separates.is_empty() {
        let apart = experiment.separation_n;
        let apart = if apart.is_finite() {
            format!(" It would drive them {} apart, root mean square.", newtons(apart))
        } else {
            String::new()
        };
        let decides = match &experiment.separates[..] {
            [one] => format!("It decides on {one}."),
            [first @ .., last] => format!("It decides between {} and {last}.{apart}", first.join(", ")),
            [] => String::new(),
        };
        html.push_str(&paragraph(&decides));
    }
    html
}

/// Section: how the diagnosis came about.
pub(crate) fn appendix(appendix: &PageAppendix) -> String {
    let mut html = String::new();
    let facts = [("muscle", &appendix.muscle), ("date", &appendix.date), ("written by", &appendix.tool)];
    let mut rows = Table::new(["", ""]);
    for (name, value) in facts.into_iter().filter(|(_, value)| !value.is_empty()) {
        rows.row([name, value.as_str()]);
    }
    if facts.iter().any(|(_, value)| !value.is_empty()) {
        html.push_str(&table(&rows));
    }
    if !appendix.command.is_empty() {
        html.push_str(&format!("<pre class=\"command\">{}</pre>\n", escaped(&appendix.command)));
    }
    if !appendix.inputs.is_empty() {
        let mut rows = Table::new(["input", "file", "SHA-256"]);
        for input in &appendix.inputs {
            rows.row([input.role.clone(), input.path.clone(), input.sha256.clone()]);
        }
        html.push_str(&format!("<div class=\"scroll hash\">\n{}</div>\n", rows.to_html()));
    }
    if !appendix.options.is_empty() {
        let mut rows = Table::new(["option", "value"]);
        for (name, value) in &appendix.options {
            rows.row([name.clone(), value.clone()]);
        }
        html.push_str(&table(&rows));
    }
    html
}
