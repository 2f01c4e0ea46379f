//! Terms without a name for a person: on the terminal and in the report.

use pam_artifact::DiagnosisArtifact;
use pam_artifact::diagnosis::{Empirical, EmpiricalTerm};
use pam_muscle::effects::Sentence;
use pam_muscle::effects::sentence::{Curve, Driver, Recall};
use pam_report::number::{engineering, engineering_with_stderr, significant};
use pam_report::text::hanging;
use pam_report::{PageEmpirical, PageTerm};

/// Terms, what they gain and how sure they are; none where nothing was found.
pub(crate) fn table(artifact: &DiagnosisArtifact) -> Option<String> {
    let empirical = artifact.empirical.as_ref()?;
    let mut text = "Unmodelled structure, as empirical terms\n".to_owned();
    let mut say = |words: &str| text.push_str(&format!("{}\n", hanging(words, " ", "   ")));
    for term in &empirical.terms {
        let (evidence, stability) = (&term.evidence, &term.stability);
        say(&term.equation);
        for (name, value) in rows(term) {
            say(&format!("  {name} = {value}"));
        }
        say(&format!(
            "Cross-validated RMSE {} → {} N; selected in {:.0} % of bootstrap resamples{}.",
            significant(evidence.rmse_without_n, 3),
            significant(evidence.rmse_with_n, 3),
            100.0 * stability.chosen,
            stability
                .others
                .iter()
                .take(2)
                .map(|other| format!(", instead of it in {:.0} %: {}", 100.0 * other.chosen, other.words))
                .collect::<String>()
        ));
        let nearest: Vec<String> = term
            .nearest
            .iter()
            .map(|near| format!("{} (leaves {} N)", near.id, significant(near.rmse_with_n, 3)))
            .collect();
        if !nearest.is_empty() {
            say(&format!("Nearest effects, none of which it is: {}.", nearest.join(", ")));
        }
    }
    if let Some(holdout) = empirical.holdout {
        say(&format!(
            "RMSE on held-out recordings: {} → {} N.",
            significant(holdout.rmse_without_n, 3),
            significant(holdout.rmse_with_n, 3)
        ));
    }
    Some(text)
}

/// Numbers of a term, and of its curve where it has few.
fn rows(term: &EmpiricalTerm) -> Vec<(String, String)> {
    let mut rows: Vec<(String, String)> =
        numbers(&term.sentence).into_iter().map(|(name, value, unit)| (name, engineering(value, &unit, 3))).collect();
    match &term.sentence.shape {
        Curve::Monotone { knots } | Curve::Spline { knots } => {
            rows.push(("f".to_owned(), format!("through {} values, see diagnosis.json", knots.len())));
        }
        Curve::Line | Curve::Saturation { .. } | Curve::Bump { .. } => {
            rows.extend(term.parameters.iter().map(|parameter| {
                let value = match parameter.stderr {
                    Some(stderr) => engineering_with_stderr(parameter.value, stderr, &parameter.unit),
                    None => engineering(parameter.value, &parameter.unit, 3),
                };
                ("a".to_owned(), value)
            }));
        }
    }
    rows
}

/// Numbers of a sentence under the symbols of its equation, SI.
fn numbers(sentence: &Sentence) -> Vec<(String, f64, String)> {
    let driver_unit = sentence.driver.unit().to_owned();
    let unit = sentence.memory.unit(&sentence.driver).to_owned();
    let number = |name: &str, value: f64, unit: &str| (name.to_owned(), value, unit.to_owned());
    let mut numbers = match sentence.memory {
        Recall::None | Recall::Largest | Recall::Travelled | Recall::Work => Vec::new(),
        Recall::Lag { time_constant_s } => vec![number("τ", time_constant_s, "s")],
        Recall::TwoLags { time_constants_s: [first, second] } => {
            vec![number("τ₁", first, "s"), number("τ₂", second, "s")]
        }
        Recall::Play { half_width } => vec![number("h", half_width, &driver_unit)],
        Recall::Dahl { distance } => vec![number("d", distance, &driver_unit)],
    };
    match sentence.shape {
        Curve::Saturation { from, over } => numbers.extend([number("u₁", from, &unit), number("u₀", over, &unit)]),
        Curve::Bump { center, width } => numbers.extend([number("c", center, &unit), number("w", width, &unit)]),
        Curve::Line | Curve::Monotone { .. } | Curve::Spline { .. } => {}
    }
    numbers
}

/// The same for the report.
pub(crate) fn page(empirical: &Empirical) -> PageEmpirical {
    let gain = empirical.holdout.unwrap_or(empirical.blocks);
    PageEmpirical {
        terms: empirical.terms.iter().map(term).collect(),
        left_n: [gain.rmse_without_n, gain.rmse_with_n],
        of_holdout: empirical.holdout.is_some(),
    }
}

fn term(term: &EmpiricalTerm) -> PageTerm {
    let (scale, label) = axis(&term.sentence, &term.curve.unit);
    let mut numbers = numbers(&term.sentence);
    if term.parameters.len() == 1 {
        numbers.extend(term.parameters.iter().map(|entry| ("a".to_owned(), entry.value, entry.unit.clone())));
    }
    PageTerm {
        words: term.words.clone(),
        equation: term.equation.clone(),
        numbers,
        argument_label: label,
        argument: term.curve.argument.iter().map(|value| scale * value).collect(),
        force_n: term.curve.force_n.clone(),
        low_n: term.curve.low_n.clone(),
        high_n: term.curve.high_n.clone(),
        chosen: term.stability.chosen,
        others: term.stability.others.iter().map(|other| (other.words.clone(), other.chosen)).collect(),
        nearest: term.nearest.iter().map(|near| (near.id.clone(), near.against.clone())).collect(),
    }
}

/// Factor to the unit that people use, and the title of an axis in it.
fn axis(sentence: &Sentence, unit: &str) -> (f64, String) {
    let name = match sentence.memory {
        Recall::None => sentence.driver.name().replace('-', " "),
        memory => format!("{} of {}", memory.name().replace('-', " "), sentence.driver.name().replace('-', " ")),
    };
    let (scale, unit) = match (unit, sentence.driver) {
        ("1", Driver::Contraction) if !matches!(sentence.memory, Recall::Dahl { .. }) => (1e2, "%"),
        ("Pa", _) => (1e-3, "kPa"),
        ("m", _) => (1e3, "mm"),
        ("m/s", _) => (1e3, "mm/s"),
        (unit, _) => (1.0, unit),
    };
    (scale, if unit == "1" { name } else { format!("{name} / {unit}") })
}
