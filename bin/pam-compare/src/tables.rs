//! Tables and messages for the terminal.

use pam_artifact::ComparisonArtifact;
use pam_artifact::comparison::{ComparedParameter, Difference, Outcome};
use pam_comparison::blocks::FEWEST_BLOCKS;
use pam_report::Table;
use pam_report::number::{engineering, engineering_with_stderr, probability, significant};
use pam_report::text::{told_apart, wrapped};

/// Columns of a recording's name.
const NAME: usize = 22;

/// The statement, errors of both models, and their parameters.
pub(crate) fn all(artifact: &ComparisonArtifact) -> String {
    format!("{}\n{}\n{}", wrapped(&statement(artifact), ""), errors(artifact), parameters(artifact))
}

fn statement(artifact: &ComparisonArtifact) -> String {
    let Difference { rmse_a_n, rmse_b_n, difference_n, interval_n, p_value, n_blocks, block_s, .. } =
        artifact.together.counted;
    let errors = format!("RMSE {} N with A, {} N with B", significant(rmse_a_n, 3), significant(rmse_b_n, 3));
    let (Some([low_n, high_n]), Some(p)) = (interval_n, p_value) else {
        return format!(
            "Too short to judge: {errors}; their errors make {n_blocks} independent blocks of up to {} s, and a judgment needs \
             {FEWEST_BLOCKS}: record for longer.",
            significant(block_s, 2)
        );
    };
    let said = format!(
        "{errors}; B less A {} N, from {} to {} N with 95 % confidence, p = {}, over {n_blocks} blocks of up to {} s.",
        significant(difference_n, 2),
        significant(low_n, 2),
        significant(high_n, 2),
        probability(p),
        significant(block_s, 2)
    );
    match artifact.outcome {
        Outcome::B => format!("B is better: {said}"),
        Outcome::A => format!("A is better: {said}"),
        Outcome::NoDifference => format!("No difference beyond chance: {said}"),
    }
}

fn errors(artifact: &ComparisonArtifact) -> String {
    let mut table = Table::new(["recording", "samples", "A, N", "B, N", "B less A, 95 %, N", "p", "fitted by"]);
    let mut add = |name: String, fitted: &str, difference: &Difference, samples: &str| {
        let interval = match difference.interval_n {
            Some([low_n, high_n]) => format!("{} to {}", significant(low_n, 2), significant(high_n, 2)),
            None => "too few blocks".to_owned(),
        };
        table.row([
            name,
            samples.to_owned(),
            significant(difference.rmse_a_n, 3),
            significant(difference.rmse_b_n, 3),
            interval,
            difference.p_value.map_or_else(String::new, probability),
            fitted.to_owned(),
        ]);
    };
    let names: Vec<&str> = artifact
        .recordings
        .iter()
        .map(|recording| recording.path.rsplit('/').next().unwrap_or(&recording.path))
        .collect();
    for (recording, name) in artifact.recordings.iter().zip(told_apart(&names, NAME)) {
        let fitted = match (recording.fitted_by_a, recording.fitted_by_b) {
            (true, true) => "both",
            (true, false) => "A",
            (false, true) => "B",
            (false, false) => "",
        };
        add(name, fitted, &recording.errors.counted, "counted");
        add(String::new(), "", &recording.errors.all, "all");
    }
    if artifact.recordings.len() > 1 {
        add("together".to_owned(), "", &artifact.together.counted, "counted");
        add(String::new(), "", &artifact.together.all, "all");
    }
    format!("RMSE\n{}", table.to_terminal())
}

fn parameters(artifact: &ComparisonArtifact) -> String {
    let mut table = Table::new(["parameter", "A", "B", "std errors"]);
    for parameter in &artifact.parameters {
        let ComparedParameter { name, unit, a, stderr_a, b, stderr_b, standard_errors } = parameter;
        let value = |value: &Option<f64>, stderr: &Option<f64>| match (value, stderr) {
            (Some(value), Some(stderr)) => engineering_with_stderr(*value, *stderr, unit),
            (Some(value), None) => engineering(*value, unit, 3),
            (None, _) => "-".to_owned(),
        };
        let moved = standard_errors.map_or_else(|| "-".to_owned(), |errors| significant(errors, 2));
        table.row([name.clone(), value(a, stderr_a), value(b, stderr_b), moved]);
    }
    let mut effects: Vec<&String> = artifact.effects_a.iter().collect();
    effects.extend(artifact.effects_b.iter().filter(|id| !artifact.effects_a.contains(id)));
    for id in effects {
        let there = |ids: &[String]| if ids.contains(id) { "yes" } else { "-" };
        table.row([id.as_str(), there(&artifact.effects_a), there(&artifact.effects_b), "-"]);
    }
    format!("Parameters and effects\n{}", table.to_terminal())
}

/// Warnings to read before the numbers are believed.
pub(crate) fn warnings(artifact: &ComparisonArtifact) -> Vec<String> {
    let unfair: Vec<&str> = artifact
        .recordings
        .iter()
        .filter(|recording| recording.fitted_by_a != recording.fitted_by_b)
        .map(|recording| recording.path.as_str())
        .collect();
    match unfair.as_slice() {
        [] => Vec::new(),
        [one] => {
            vec![format!("{one}: only one of the models was fitted to it, which favors that one; compare on others")]
        }
        [first, others @ ..] => vec![format!(
            "{first} and {} others: only one of the models was fitted to them, which favors that one; compare on others",
            others.len()
        )],
    }
}
