//! Files in, diagnosis out.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use pam_artifact::diagnosis::Verdict;
use pam_artifact::{DiagnosisArtifact, Input, InputRole, ModelArtifact, Tool};
use pam_cli::{Console, Output, pretty_json, publish, read_recordings};
use pam_diagnosis::artifact::{Agreement, Head};
use pam_diagnosis::diagnose::{Diagnosis, Request, check, diagnose_observed};
use pam_diagnosis::traces::traces;

use crate::args::Args;
use crate::own::OwnEffects;
use crate::provenance::Provenance;
use crate::{explain, group, page, since, tables};

/// Samples of each recording that the report draws, at most.
const REPORT_SAMPLES: usize = 20_000;

pub(crate) fn run(args: &Args) -> anyhow::Result<pam_cli::Verdict> {
    let console = args.run.start()?;
    let own = OwnEffects::read(args.effects.as_deref())?;
    for id in &args.exclude {
        own.known(id).context("--exclude")?;
    }
    if let Some(id) = &args.explain {
        return explain::explain(args, &own, &console, id);
    }
    // A requirement on the command line would not hold: what --explain excludes is there.
    ensure!(
        args.figure.is_none(),
        "--figure draws an effect; name it with --explain (figures of a diagnosis are in --report)"
    );
    group::refuse_with_group(args)?;
    if let Some(limit) = args.matters_above_n {
        ensure!(
            limit >= 0.0 && limit.is_finite(),
            "--matters-above-n {limit} is no size of a force; give newtons from 0 up"
        );
    }
    if let Some(path) = &args.group {
        return group::group(args, &own, &console, path);
    }
    if let Some(baseline) = &args.since {
        return since::since(args, &console, baseline);
    }
    let model_path = args.model.as_deref().context("--model is missing")?;
    let from_stdin = args.logs.iter().chain(&args.holdout).filter(|path| path.as_os_str() == "-").count();
    ensure!(from_stdin <= 1, "standard input can be read once only; name the other recordings as files");
    for held_out in &args.holdout {
        ensure!(
            !args.logs.contains(held_out),
            "{}: is fitted and held out as well; hold out a recording that the diagnosis does not see",
            held_out.display()
        );
    }
    let inputs =
        || args.logs.iter().chain(&args.holdout).chain(&args.model).chain(&args.read.channels).chain(&args.effects);
    let open = |path: &Option<PathBuf>| -> anyhow::Result<Option<Output>> {
        let path = path.as_deref().filter(|_| !args.run.check);
        path.map(|path| Ok(Output::open(path)?.apart_from(inputs())?)).transpose()
    };
    let outputs = Outputs {
        out: open(&args.out)?,
        model: open(&args.out_model)?,
        report: open(&args.report)?,
        next: open(&args.next_experiment)?,
    };
    let to_stdout = outputs.paths().any(|path| path.as_os_str() == "-");

    let (model, model_sha256) = ModelArtifact::read(model_path)?;
    let read = args.read.resolve()?;
    let estimation = read_recordings(&args.logs, &read.options, &console)?;
    let holdout = read_recordings(&args.holdout, &read.options, &console)?;
    let mut hashes =
        vec![Input { path: model_path.display().to_string(), sha256: model_sha256, role: InputRole::Model }];
    hashes.extend(read.channels);
    hashes.extend(own.input.clone());
    hashes.extend(estimation.iter().map(|recording| Input::recording(recording, InputRole::Estimation)));
    hashes.extend(holdout.iter().map(|recording| Input::recording(recording, InputRole::Validation)));
    let request = Request {
        estimation,
        holdout,
        model,
        config: args.config(),
        effects: own.effects.clone(),
        rig: Vec::new(),
        accept_implausible: args.accept_implausible,
    };
    if args.run.check {
        check(request)?;
        console.note("inputs are fine; nothing was diagnosed (--check)");
        return Ok(pam_cli::Verdict::Accepted);
    }
    let progress = console.progress("diagnosing", 1);
    let mut found = diagnose_observed(request, &|done, all| progress.set_of(done, all))?;
    drop(progress);
    let agreement = Agreement::of(&found)?;
    found.weigh(&agreement)?;
    let tool = Tool { name: "pam-diagnose".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() };
    let head = Head { tool, inputs: hashes, seed: args.run.seed };
    let artifact = found.artifact(head.clone(), &agreement);

    console.text(tables::all(&artifact));
    for warning in &artifact.warnings {
        console.warn(warning);
    }
    if args.isolability {
        let matrix = tables::isolability(&artifact);
        if to_stdout { console.text(matrix) } else { pam_cli::write_file("-", matrix)? }
    }
    let wanted = outputs.model.is_some() || outputs.report.is_some();
    let augmented = wanted.then(|| found.model_artifact(head, &agreement));
    let provenance = Provenance::of_this_run(args.logs.iter().chain(&args.holdout).map(PathBuf::as_path));
    outputs.write(&console, &found, &artifact, &own, (augmented.as_ref(), provenance))?;
    Ok(match artifact.verdict {
        Verdict::Consistent | Verdict::Explained | Verdict::Ambiguous => pam_cli::Verdict::Accepted,
        Verdict::ExplainedInPart | Verdict::Unexplained => pam_cli::Verdict::Rejected,
    })
}

/// Requested outputs, opened before any work.
struct Outputs {
    out: Option<Output>,
    model: Option<Output>,
    report: Option<Output>,
    next: Option<Output>,
}

impl Outputs {
    fn paths(&self) -> impl Iterator<Item = &Path> {
        [&self.out, &self.model, &self.report, &self.next].into_iter().flatten().map(Output::path)
    }

    /// Publishes everything together.
    fn write(
        self,
        console: &Console,
        found: &Diagnosis,
        artifact: &DiagnosisArtifact,
        own: &OwnEffects,
        (augmented, provenance): (Option<&ModelArtifact>, Provenance),
    ) -> anyhow::Result<()> {
        let mut outputs = Vec::new();
        if let Some(output) = self.out {
            outputs.push((output, pretty_json(artifact)?));
        }
        if let (Some(output), Some(model)) = (self.model, augmented) {
            outputs.push((output, pretty_json(model)?));
        }
        if let (Some(output), Some(augmented)) = (self.report, augmented) {
            let page = page::page(artifact, [&found.model, augmented], own, traces(found, REPORT_SAMPLES), provenance);
            outputs.push((output, pam_report::diagnosis_page(&page)?.into_bytes()));
        }
        let mut earlier = None;
        match (self.next, &found.next_experiment) {
            (Some(output), Some((_, setpoints))) => {
                let mut csv = Vec::new();
                setpoints.write_csv(&mut csv)?;
                outputs.push((output, csv));
            }
            (Some(output), None) => {
                let path = output.path().to_owned();
                // Of an earlier diagnosis: whoever plays it on the rig would record what nobody asks for any more.
                let stands = path.symlink_metadata().is_ok_and(|found| found.is_file());
                let what = if stands { "was removed, as it was of an earlier diagnosis" } else { "was not written" };
                console
                    .note(format!("{} {what}: nothing is in question that a recording would decide", path.display()));
                earlier = stands.then_some(path);
            }
            (None, _) => {}
        }
        publish(outputs, console)?;
        if let Some(path) = earlier {
            std::fs::remove_file(&path).with_context(|| format!("cannot remove {}", path.display()))?;
        }
        Ok(())
    }
}
