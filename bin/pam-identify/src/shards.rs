//! Recordings whose rows are in several places: a summary of some of them, and what follows from the summaries of all.

use std::path::Path;

use anyhow::{Context as _, ensure};
use pam_artifact::summary::Shard;
use pam_artifact::{AgreementArtifact, Input, InputRole, SummaryArtifact};
use pam_cli::{Console, Output, Verdict, publish, read_recordings};
use pam_identification::shards::{Head, Step, advance, summarize};
use pam_muscle::MuscleFile;
use pam_muscle::force::Form;
use pam_recording::sha256_hex;

use crate::args::{Args, FormArg, LossArg};
use crate::run::{read_muscle, request, tool, verdict};
use crate::tables;

/// Passes that are needed as a rule.
const PASSES: u32 = 7;

/// Refuses what needs the rows of all shards at once.
fn check(args: &Args, muscle: &MuscleFile) -> anyhow::Result<()> {
    ensure!(
        args.form == FormArg::Corrected,
        "shards are fitted in the corrected form alone; identify in one for --form"
    );
    ensure!(args.loss == LossArg::Square, "--loss huber weighs every row anew; identify in one for it");
    ensure!(
        muscle.fit.is_empty(),
        "the muscle file frees dimensions, for which every row is looked at anew; identify in one, or leave fit empty"
    );
    Ok(())
}

/// Reads an agreement, which is not there before the first pass.
fn agreement(args: &Args) -> anyhow::Result<Option<AgreementArtifact>> {
    let path = args.shards.agreement.as_deref().filter(|path| path.exists());
    Ok(path.map(AgreementArtifact::read).transpose()?)
}

/// SHA-256 of options as they are written down.
fn digest(options: &impl std::fmt::Debug) -> String {
    sha256_hex(format!("{options:?}").as_bytes())
}

/// Writes the summary of one recording.
pub(crate) fn summary(args: &Args, console: &Console, muscle_path: &Path) -> anyhow::Result<Verdict> {
    ensure!(args.logs.len() == 1, "--summary-only takes one recording; every file is a shard of its own");
    let inputs = || args.logs.iter().chain(&args.muscle).chain(&args.read.channels).chain(&args.shards.agreement);
    let out = args.out.as_deref().context("--out is missing")?;
    let out = (!args.run.check).then(|| Output::open(out)?.apart_from(inputs())).transpose()?;
    let (muscle, muscle_input) = read_muscle(muscle_path)?;
    check(args, &muscle)?;
    let agreement = agreement(args)?;
    let read = args.read.resolve()?;
    let recording = read_recordings(&args.logs, &read.options, console)?.remove(0);
    let mut inputs = vec![muscle_input];
    inputs.extend(read.channels);
    inputs.push(Input::recording(&recording, InputRole::Estimation));
    let (path, sha256) = (recording.path.clone(), recording.sha256.clone());
    let shard = match &args.shards.shard {
        Some(place) => Shard { recording: place.recording.clone(), number: place.number, of: place.of, path, sha256 },
        None => Shard { recording: path.clone(), number: 1, of: 1, path, sha256 },
    };
    let head = Head { tool: tool(), inputs, reading_sha256: digest(&read.options) };
    let summary = summarize(&recording, shard, &muscle, agreement.as_ref(), head)?;
    let handed: usize = summary.edges.iter().map(|rows| rows.time_s.len()).sum();
    console.note(format!(
        "pass {}: {} rows, of which {handed} near cuts are handed over as they are",
        summary.pass, summary.extent.n_rows
    ));
    let outputs = out.map(|out| Ok::<_, anyhow::Error>((out, summary.json()?))).transpose()?;
    publish(outputs.into_iter().collect(), console)?;
    Ok(Verdict::Accepted)
}

/// Merges summaries: asks the next question, or writes the model.
pub(crate) fn merge(args: &Args, console: &Console, muscle_path: &Path) -> anyhow::Result<Verdict> {
    let agreed_path = args.shards.agreement.as_deref().context("--agreement is missing")?;
    let inputs = || args.shards.from_summaries.iter().chain(&args.muscle);
    let out = args.out.as_deref().context("--out is missing")?;
    let open = |path: &Path| Output::open(path)?.apart_from(inputs());
    let (agreed_out, out) = (open(agreed_path)?, open(out)?.apart_from([agreed_path])?);
    let (muscle, muscle_input) = read_muscle(muscle_path)?;
    check(args, &muscle)?;
    let summaries: Result<Vec<SummaryArtifact>, _> =
        args.shards.from_summaries.iter().map(|path| SummaryArtifact::read(path)).collect();
    let summaries = summaries?;
    for summary in &summaries {
        ensure!(
            summary.tool == tool(),
            "{}: its summary is by {} {}; write it anew with this program, {}",
            summary.shard.path,
            summary.tool.name,
            summary.tool.version,
            tool().version
        );
    }
    let of_shards = summaries[0].inputs.iter().find(|input| input.role == InputRole::Muscle);
    ensure!(
        of_shards.is_some_and(|input| input.sha256 == muscle_input.sha256),
        "{}: was made with another muscle file than {}; write the summaries anew, or name theirs",
        summaries[0].shard.path,
        muscle_path.display()
    );
    let request = request(args, Form::Corrected, muscle.clone(), Vec::new(), Vec::new());
    let options_sha256 = digest(&request);
    let agreement = agreement(args)?;
    if let Some(agreement) = &agreement {
        ensure!(
            agreement.options_sha256 == options_sha256,
            "{}: was begun with other options of the fit; repeat those, or begin anew without it",
            agreed_path.display()
        );
    }
    let mut hashes = vec![muscle_input];
    for input in summaries.iter().flat_map(|summary| &summary.inputs) {
        if !hashes.contains(input) && input.role != InputRole::Muscle {
            hashes.push(input.clone());
        }
    }
    let progress = console.progress("searching", u64::from(args.starts) * u64::from(args.iterations));
    let step = advance(request, agreement, &summaries, &|| progress.advance(1))?;
    drop(progress);
    match step {
        Step::Ask(mut asked) => {
            (asked.tool, asked.inputs, asked.options_sha256) = (tool(), hashes, options_sha256);
            console.note(format!(
                "pass {} of {} as a rule: run every shard again with --agreement {}, and then this",
                asked.pass,
                PASSES.max(asked.pass),
                agreed_path.display()
            ));
            publish(vec![(agreed_out, asked.json()?)], console)?;
            Ok(Verdict::Accepted)
        }
        Step::Done(found, config) => {
            let mut artifact = found.artifact(tool(), hashes, config, args.run.seed);
            artifact.muscle_name = muscle.name.clone();
            console.text(tables::parameters(&artifact));
            if let Some(words) = tables::friction(&artifact) {
                console.note(words);
            }
            console.text(tables::agreement(&artifact));
            for warning in &artifact.warnings {
                console.warn(warning);
            }
            publish(vec![(out, artifact.json()?)], console)?;
            Ok(verdict(args, console, &found, &artifact, None))
        }
    }
}
