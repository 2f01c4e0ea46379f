//! Two real muscles: eq. 11 alone, eq. 11 with what the diagnosis names, and a black box as the ceiling.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, bail, ensure};
use pam_artifact::{DiagnosisArtifact, ModelArtifact};
use pam_report::Table;

use crate::worlds::ceiling::{Beside, trees_n};

/// A muscle with what is to be reached on its held-out recordings, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RealMuscle {
    /// Length that it was cut to, as in file names.
    pub cut: &'static str,
    /// To be reached.
    pub target_n: f64,
    /// To be aimed at.
    pub aim_n: f64,
}

/// Both muscles.
pub const MUSCLES: [RealMuscle; 2] =
    [RealMuscle { cut: "30cm", target_n: 3.0, aim_n: 2.8 }, RealMuscle { cut: "20cm", target_n: 3.3, aim_n: 3.2 }];

/// What came of a muscle.
#[derive(Debug, Clone, PartialEq)]
pub struct RealResult {
    /// The muscle.
    pub muscle: RealMuscle,
    /// Held-out RMSE of eq. 11 alone, over all samples, in N.
    pub base_n: f64,
    /// Held-out RMSE with what was named, over all samples, in N.
    pub diagnosed_n: f64,
    /// Verdict in a sentence.
    pub statement: String,
    /// Effects in order of evidence.
    pub effects: Vec<String>,
    /// Held-out RMSE of boosted trees; none where Python lacks what they need.
    pub trees_n: Option<f64>,
}

/// Recordings of a muscle: `test9` to fit, `test10` to hold out.
fn files(folder: &Path, cut: &str, repeat: u32) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    let (start, end) = (format!("bpa10_L{cut}_"), format!("_test{repeat}.csv"));
    let is_wanted = |name: &str| name.starts_with(&start) && name.ends_with(&end);
    files.retain(|path| path.file_name().is_some_and(|name| is_wanted(&name.to_string_lossy())));
    files.sort();
    ensure!(
        !files.is_empty(),
        "{}: no recordings of the {cut} muscle; fetch them with make recordings",
        folder.display()
    );
    Ok(files.into_iter().map(|path| std::path::absolute(&path).unwrap_or(path)).collect())
}

/// Identifies and diagnoses a muscle with the programs in `bin`; `root` is the repository.
///
/// # Errors
/// Where recordings are missing or a program fails.
pub fn prove(muscle: RealMuscle, recordings: &Path, bin: &Path, root: &Path) -> Result<RealResult> {
    let scratch = tempfile::tempdir()?;
    let (fitted, held) = (files(recordings, muscle.cut, 9)?, files(recordings, muscle.cut, 10)?);
    let with_files = |program: &str| {
        let mut command = Command::new(bin.join(program));
        command.args(&fitted);
        for file in &held {
            command.arg("--holdout").arg(file);
        }
        command.current_dir(scratch.path()).arg("--quiet");
        command
    };
    let mut identify = with_files("pam-identify");
    // No option but names of files: as a stranger would run it.
    identify.args(["--out", "model.json"]);
    identify.arg("--muscle").arg(root.join(format!("configs/muscle-festo-10mm-{}.toml", muscle.cut)));
    run(&mut identify)?;
    run(with_files("pam-diagnose").args([
        "--model",
        "model.json",
        "--out",
        "diagnosis.json",
        "--out-model",
        "augmented.json",
    ]))?;
    let (model, _) = ModelArtifact::read(&scratch.path().join("model.json"))?;
    let (augmented, _) = ModelArtifact::read(&scratch.path().join("augmented.json"))?;
    let (diagnosis, _) = DiagnosisArtifact::read(&scratch.path().join("diagnosis.json"))?;
    let held_out_n = |model: ModelArtifact| {
        model.fit.validation.map(|validation| validation.rmse_all_n).context("a model states no held-out error")
    };
    Ok(RealResult {
        muscle,
        base_n: held_out_n(model)?,
        diagnosed_n: held_out_n(augmented)?,
        statement: diagnosis.statement,
        effects: diagnosis.effects.into_iter().map(|effect| effect.id).collect(),
        trees_n: trees_n(&root.join("scripts/proof/boosted-trees.py"), &fitted, &held, Beside::Nothing),
    })
}

fn run(command: &mut Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("cannot run {name}"))?;
    if !matches!(output.status.code(), Some(0 | 1)) {
        let said = String::from_utf8_lossy(&output.stderr);
        bail!("{name} ended with {}: {}", output.status, said.lines().last().unwrap_or("it said nothing"));
    }
    Ok(())
}

/// The table of both muscles.
pub fn table(results: &[RealResult]) -> Table {
    let titles = ["muscle", "eq. 11 alone, N", "diagnosed, N", "target", "aim", "", "boosted trees, N", "named"];
    let mut table = Table::new(titles);
    for result in results {
        let RealMuscle { cut, target_n, aim_n } = result.muscle;
        table.row([
            format!("Festo 10 mm, cut {cut}"),
            format!("{:.2}", result.base_n),
            format!("{:.2}", result.diagnosed_n),
            format!("≤ {target_n}"),
            format!("{aim_n}"),
            if result.diagnosed_n <= target_n { "pass" } else { "short" }.to_owned(),
            result
                .trees_n
                .map_or("skipped: needs python3 with scikit-learn".to_owned(), |rmse_n| format!("{rmse_n:.2}")),
            result.effects.join(", "),
        ]);
    }
    table
}

/// What is written into `RESULTS-REAL.md`.
pub fn markdown(results: &[RealResult]) -> String {
    let statements: Vec<String> =
        results.iter().map(|result| format!("- {}: {}\n", result.muscle.cut, result.statement)).collect();
    format!(
        "# Two real muscles, diagnosed\n\nWritten by `make prove-real`. Fitted to the four `test9` recordings of each muscle, \
         judged on all samples of its four `test10` recordings, which also choose how freely the static map bends; parameters within \
         physical bounds, the same settings for both. Boosted trees see the same signals and their past, and know no physics: they are the ceiling.\n\n{}\n{}",
        table(results).to_markdown(),
        statements.concat()
    )
}
