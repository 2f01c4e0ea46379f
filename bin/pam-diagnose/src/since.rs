//! Later recordings and a baseline in, what has changed out.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, ensure};
use pam_artifact::change::{Change, ChangeArtifact, ChangeConfig, ChangeVerdict, Compared, SCHEMA};
use pam_artifact::{ArtifactError, Input, InputRole, ModelArtifact, Tool, readable_json};
use pam_cli::{Console, Output, publish, read_recordings};
use pam_diagnosis::since::{LaterTrace, Request, changes, check, words};
use pam_report::number::{engineering, engineering_with_stderr, significant};
use pam_report::text::wrapped;
use pam_report::{ChangePage, PageAppendix, PageChange, PageCompared, PageInput, PageRecording, Table, change_page};

use crate::args::Args;
use crate::page::short_name;
use crate::provenance::Provenance;

pub(crate) fn since(args: &Args, console: &Console, path: &Path) -> anyhow::Result<pam_cli::Verdict> {
    let from_stdin = args.logs.iter().filter(|path| path.as_os_str() == "-").count();
    ensure!(from_stdin <= 1, "standard input can be read once only; name the other recordings as files");
    let inputs = || args.logs.iter().chain(&args.since).chain(&args.model).chain(&args.read.channels);
    let open = |path: &Option<PathBuf>| -> anyhow::Result<Option<Output>> {
        let path = path.as_deref().filter(|_| !args.run.check);
        path.map(|path| Ok(Output::open(path)?.apart_from(inputs())?)).transpose()
    };
    let (out, report) = (open(&args.out)?, open(&args.report)?);
    let (baseline, sha256) = ModelArtifact::read(path).map_err(|error| match error {
        ArtifactError::Schema { found, .. } if found.starts_with("pam-diagnosis/") => {
            anyhow!("{}: is a diagnosis; name the model that pam-diagnose --out-model wrote with it", path.display())
        }
        error => error.into(),
    })?;
    if let Some(model_path) = &args.model {
        same_muscle((path, &baseline), (model_path, &ModelArtifact::read(model_path)?.0))?;
    }
    let read = args.read.resolve()?;
    let recordings = read_recordings(&args.logs, &read.options, console)?;
    for recording in &recordings {
        ensure!(
            baseline.inputs.iter().all(|input| input.sha256 != recording.sha256),
            "{}: the baseline was made from this very recording; name recordings that were made later",
            recording.path
        );
    }
    let mut hashes = vec![Input { path: path.display().to_string(), sha256, role: InputRole::Model }];
    hashes.extend(read.channels);
    hashes.extend(recordings.iter().map(|recording| Input::recording(recording, InputRole::Estimation)));
    let diagnose = args.config();
    let config = ChangeConfig {
        max_changes: diagnose.max_effects,
        excluded: diagnose.excluded,
        accept_implausible: args.accept_implausible,
    };
    let title = baseline.muscle_title();
    let request = Request { recordings, baseline, config: config.clone() };
    if args.run.check {
        check(request)?;
        console.note("inputs are fine; nothing was compared (--check)");
        return Ok(pam_cli::Verdict::Accepted);
    }
    let found = changes(request)?;
    let artifact = ChangeArtifact {
        schema: SCHEMA.to_owned(),
        tool: Tool { name: "pam-diagnose".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
        inputs: hashes,
        config,
        seed: args.run.seed,
        verdict: found.verdict,
        statement: found.statement,
        changes: found.changes,
        unchanged: found.unchanged,
        fit: found.fit,
        candidates: found.candidates,
        warnings: found.warnings,
    };
    console.text(text(&artifact));
    for warning in &artifact.warnings {
        console.warn(warning);
    }
    let mut outputs = Vec::new();
    if let Some(output) = out {
        outputs.push((output, readable_json(&artifact)?));
    }
    if let Some(output) = report {
        let appendix = appendix(&artifact, &title, Provenance::of_this_run(args.logs.iter().map(PathBuf::as_path)));
        outputs.push((output, change_page(&page(&artifact, appendix, found.traces))?.into_bytes()));
    }
    publish(outputs, console)?;
    Ok(if artifact.verdict == ChangeVerdict::Unchanged {
        pam_cli::Verdict::Accepted
    } else {
        pam_cli::Verdict::Rejected
    })
}

/// Refuses a baseline of another muscle than that of `model`: by the digest of the muscle file where both have it, otherwise by
/// the dimensions.
fn same_muscle(
    (path, baseline): (&Path, &ModelArtifact),
    (model_path, model): (&Path, &ModelArtifact),
) -> anyhow::Result<()> {
    let file = |model: &ModelArtifact| {
        let input = model.inputs.iter().find(|input| input.role == InputRole::Muscle);
        input.map(|input| input.sha256.clone())
    };
    let same = match (file(baseline), file(model)) {
        (Some(left), Some(right)) => left == right,
        _ => baseline.geometry == model.geometry,
    };
    ensure!(
        same,
        "{}: is of another muscle (rest length {:.2} mm) than {} ({:.2} mm); name the baseline of this muscle",
        path.display(),
        1e3 * baseline.geometry.rest_length_m,
        model_path.display(),
        1e3 * model.geometry.rest_length_m
    );
    Ok(())
}

fn word(verdict: ChangeVerdict) -> &'static str {
    match verdict {
        ChangeVerdict::Unchanged => "Unchanged",
        ChangeVerdict::Changed => "Changed",
        ChangeVerdict::Ambiguous => "Changed, with more than one explanation",
        ChangeVerdict::Unexplained => "Changed, and not explained",
    }
}

/// Tables and messages for the terminal.
fn text(artifact: &ChangeArtifact) -> String {
    let mut text = wrapped(&format!("{}: {}", word(artifact.verdict), artifact.statement), "");
    text.push('\n');
    if !artifact.changes.is_empty() {
        let mut table = Table::new(["change", "then", "now", "standard errors", "RMSE N"]);
        for change in &artifact.changes {
            let evidence = &change.evidence;
            let gain =
                format!("{} → {}", significant(evidence.rmse_without_n, 3), significant(evidence.rmse_with_n, 3));
            table.row([change.id.clone(), String::new(), String::new(), String::new(), gain]);
            for compared in &change.differences {
                let [then, now, errors] = cells(compared);
                table.row([format!("  {}", own_name(&compared.name, &change.id)), then, now, errors]);
            }
            for other in &change.alternatives {
                table.row([format!("  or {other}")]);
            }
        }
        text.push_str(&format!("\nWhat has changed\n{}", table.to_terminal()));
    }
    let mut table = Table::new(["not changed", "then", "now, if alone", "standard errors"]);
    for compared in &artifact.unchanged {
        let [then, now, errors] = cells(compared);
        table.row([compared.name.clone(), then, now, errors]);
    }
    text.push_str(&format!("\n{}", table.to_terminal()));
    let fit = &artifact.fit;
    let mut table = Table::new(["RMSE", "N"]);
    for (name, value) in [
        ("baseline, on its own recordings", fit.then_n),
        ("baseline, on these", fit.as_then_n),
        ("baseline, within its standard errors", fit.within_errors_n),
        ("with the changes", fit.now_n),
        ("noise", fit.noise_floor_n),
    ] {
        table.row([name.to_owned(), significant(value, 3)]);
    }
    text.push_str(&format!("\n{}", table.to_terminal()));
    text
}

/// The name of a number without the effect that it is of, which is named above it.
fn own_name<'a>(name: &'a str, effect: &str) -> &'a str {
    name.strip_prefix(effect).and_then(|name| name.strip_prefix('.')).unwrap_or(name)
}

/// Then, now with the standard error of the difference, and the difference over it.
fn cells(compared: &Compared) -> [String; 3] {
    let unit = &compared.unit;
    let now = match compared.stderr {
        Some(stderr) => engineering_with_stderr(compared.now, stderr, unit),
        None => engineering(compared.now, unit, 3),
    };
    let errors = compared.standard_errors.map_or("–".to_owned(), |errors| format!("{errors:+.1}"));
    [compared.then.map_or("–".to_owned(), |then| engineering(then, unit, 3)), now, errors]
}

fn page(artifact: &ChangeArtifact, appendix: PageAppendix, traces: Vec<LaterTrace>) -> ChangePage {
    let compared = |compared: &Compared| {
        let [then, now, errors] = cells(compared);
        PageCompared { name: compared.name.clone(), then, now, standard_errors: errors }
    };
    let change = |change: &Change| PageChange {
        said: words::titled(change),
        numbers: change
            .differences
            .iter()
            .map(|difference| PageCompared {
                name: own_name(&difference.name, &change.id).to_owned(),
                ..compared(difference)
            })
            .collect(),
        rmse_n: [change.evidence.rmse_without_n, change.evidence.rmse_with_n],
        alternatives: change.alternatives.clone(),
    };
    let later = artifact.inputs.iter().filter(|input| input.role == InputRole::Estimation);
    let recording = |(input, trace): (&Input, LaterTrace)| {
        let LaterTrace { time_s, force_n, baseline_n, changed_n, counted } = trace;
        PageRecording::over_time(short_name(&input.path), [time_s, force_n, baseline_n, changed_n], counted)
    };
    let fit = &artifact.fit;
    ChangePage {
        title: artifact.inputs.first().map_or(String::new(), |input| format!("Changes since {}", input.path)),
        class: match artifact.verdict {
            ChangeVerdict::Unchanged => "consistent",
            ChangeVerdict::Changed => "explained",
            ChangeVerdict::Ambiguous => "ambiguous",
            ChangeVerdict::Unexplained => "unexplained",
        },
        verdict: word(artifact.verdict).to_owned(),
        statement: artifact.statement.clone(),
        changes: artifact.changes.iter().map(change).collect(),
        unchanged: artifact.unchanged.iter().map(compared).collect(),
        rmse_n: [fit.then_n, fit.as_then_n, fit.now_n],
        noise_floor_n: fit.noise_floor_n,
        share_compared: fit.share_compared,
        names: if artifact.changes.is_empty() {
            ["baseline", "within its standard errors"]
        } else {
            ["baseline", "with the changes"]
        },
        recordings: later.zip(traces).map(recording).collect(),
        candidates: artifact
            .candidates
            .iter()
            .map(|candidate| (candidate.id.clone(), candidate.log_ratio, candidate.rmse_n))
            .collect(),
        appendix,
        warnings: artifact.warnings.clone(),
    }
}

fn appendix(artifact: &ChangeArtifact, muscle: &str, provenance: Provenance) -> PageAppendix {
    let input = |input: &Input| PageInput {
        role: match input.role {
            InputRole::Model => "baseline",
            InputRole::Estimation => "later",
            _ => "channels",
        }
        .to_owned(),
        path: input.path.clone(),
        sha256: input.sha256.clone(),
    };
    let excluded = &artifact.config.excluded;
    let excluded = if excluded.is_empty() { "none".to_owned() } else { excluded.join(", ") };
    PageAppendix {
        tool: format!("{} {}", artifact.tool.name, artifact.tool.version),
        muscle: muscle.to_owned(),
        command: provenance.command,
        date: provenance.date,
        inputs: artifact.inputs.iter().map(input).collect(),
        options: vec![
            ("most changes".to_owned(), artifact.config.max_changes.to_string()),
            ("effects not considered".to_owned(), excluded),
            ("seed".to_owned(), artifact.seed.to_string()),
        ],
    }
}
