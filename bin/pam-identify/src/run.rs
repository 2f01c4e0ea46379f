//! Files in, model out.

use std::path::Path;

use anyhow::{Context as _, ensure};
use pam_artifact::model::Assumed;
use pam_artifact::{Input, InputRole, ModelArtifact, Tool};
use pam_cli::{Console, Output, Verdict, publish, read_recordings, write_example};
use pam_identification::faults::apart::{self, Apart};
use pam_identification::faults::{dead_band, disagree, noise, reading, shaken, spikes, twice, zero};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Identified, Request, check};
use pam_identification::report::implausible;
use pam_muscle::MuscleFile;
use pam_muscle::force::Form;
use pam_recording::{Recording, sha256_hex};
use pam_report::PictureFormat;

use crate::args::{Args, BladderArg, Example, FormArg, FrictionArg};
use crate::{figure, shards, tables};

/// The file that `--example` writes.
const MUSCLE: &str = include_str!("../../../configs/muscle-nominal.toml");
const CHANNELS: &str = include_str!("../../../configs/bench.toml");

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    if let Some(example) = args.example {
        let text = match example {
            Example::Muscle => MUSCLE,
            Example::Channels => CHANNELS,
        };
        write_example(text, args.out.as_deref(), &args.run, &console)?;
        return Ok(Verdict::Accepted);
    }
    let muscle_path = args.muscle.as_deref().context("--muscle is missing")?;
    for (name, value) in [("--length-play-mm", args.length_play_mm), ("--pressure-play-kpa", args.pressure_play_kpa)] {
        if let Some(value) = value {
            ensure!(
                value >= 0.0 && value.is_finite(),
                "{name} {value} is no length or pressure to turn back by; give 0 or more"
            );
        }
    }
    args.check_parameters()?;
    if args.shards.summary_only {
        return shards::summary(args, &console, muscle_path);
    }
    if !args.shards.from_summaries.is_empty() {
        return shards::merge(args, &console, muscle_path);
    }
    ensure!(args.shards.agreement.is_none(), "--agreement is for --summary-only or --from-summaries");
    let from_stdin = args.logs.iter().chain(&args.holdout).filter(|path| path.as_os_str() == "-").count();
    ensure!(from_stdin <= 1, "standard input can be read once only; name the other recordings as files");
    for held_out in &args.holdout {
        ensure!(
            !args.logs.contains(held_out),
            "{}: is fitted and held out as well; hold out a recording that the fit does not see",
            held_out.display()
        );
    }
    let inputs = || args.logs.iter().chain(&args.holdout).chain(&args.muscle).chain(&args.read.channels);
    let open = |path: &Path| Output::open(path)?.apart_from(inputs());
    let out = args.out.as_deref().filter(|_| !args.run.check).map(open).transpose()?;
    let open_figure = |path: &Path| Output::open_figure(path)?.apart_from(inputs());
    let figure_out = args.figure.as_deref().filter(|_| !args.run.check).map(open_figure).transpose()?;

    let (muscle, muscle_input) = read_muscle(muscle_path)?;
    let read = args.read.resolve()?;
    let estimation = read_recordings(&args.logs, &read.options, &console)?;
    let validation = read_recordings(&args.holdout, &read.options, &console)?;
    twice::check(&estimation, &validation)?;
    let mut hashes = vec![muscle_input];
    hashes.extend(read.channels);
    hashes.extend(estimation.iter().map(|recording| Input::recording(recording, InputRole::Estimation)));
    hashes.extend(validation.iter().map(|recording| Input::recording(recording, InputRole::Validation)));

    // Recordings are read once and fitted twice: a pipe is empty after the first time.
    let for_comparison = (args.compare_forms && !args.run.check).then(|| (estimation.clone(), validation.clone()));
    let checked = check(request(args, args.form.form(), muscle.clone(), estimation, validation))?;
    console.text(tables::gate(checked.gates()));
    if args.run.check {
        console.note("inputs are fine; nothing was fitted (--check)");
        return Ok(Verdict::Accepted);
    }
    let config = checked.config();
    let progress = console.progress("searching", u64::from(args.starts) * u64::from(args.iterations));
    let found = checked.identify_observed(&|| progress.advance(1))?;
    drop(progress);
    let mut artifact = found.artifact(tool(), hashes, config, args.run.seed);
    artifact.muscle_name = muscle.name.clone();
    for prepared in found.estimation.iter().chain(&found.validation) {
        artifact.warnings.extend(spikes::warning(&prepared.recording, &prepared.quality)?);
        artifact.warnings.extend(shaken::warning(&prepared.recording, &prepared.quality)?);
    }
    let prepared = found.estimation.iter().chain(&found.validation);
    let recordings: Vec<_> = prepared.map(|prepared| (&prepared.recording, &prepared.quality)).collect();
    artifact.warnings.extend(disagree::notes(&recordings, &found.muscle)?);
    artifact.warnings.extend(noise::words(found.estimation.iter().chain(&found.validation), &found.model, None)?);
    let alone: Vec<_> = recordings.iter().map(|(recording, _)| *recording).collect();
    artifact.warnings.extend(twice::repeated(&alone)?);
    artifact.warnings.extend(dead_band::words(recordings.iter().copied()));
    let apart = apart::find(&found)?;
    artifact.warnings.extend(apart.as_ref().map(Apart::words));
    // Instruments are suspected where a fit ends at no muscle; what they explain is searched for then.
    if implausible(&found).is_some() {
        artifact.warnings.extend(zero::explain(&found)?);
    }

    let of_held_out = artifact.fit.recordings.len().saturating_sub(found.validation.len());
    let model = artifact.augmented_model();
    for (index, prepared) in found.validation.iter().enumerate() {
        let rmse_n = artifact.fit.recordings[of_held_out + index].statistics.rmse_n;
        artifact.warnings.extend(reading::missed(prepared, &artifact, &model, rmse_n)?);
    }

    console.text(tables::parameters(&artifact));
    if let Some(words) = tables::friction(&artifact) {
        console.note(words);
    }
    console.text(tables::agreement(&artifact));
    if let Some(table) = tables::unbounded(&artifact) {
        console.text(table);
    } else if args.unbounded {
        console.warn("--unbounded: these recordings are too far from any muscle's for weights without bounds");
    }
    if let Some((estimation, validation)) = for_comparison {
        let other = if args.form == FormArg::Corrected { Form::AsPrinted } else { Form::Corrected };
        let request = request(args, other, muscle.clone(), estimation, validation);
        console.text(compare_forms(request, &console, &artifact)?);
    }
    for warning in &artifact.warnings {
        console.warn(warning);
    }
    write(&console, &found, &artifact, out, figure_out)?;
    Ok(verdict(args, &console, &found, &artifact, apart.as_ref()))
}

/// This program.
pub(crate) fn tool() -> Tool {
    Tool { name: "pam-identify".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() }
}

/// Publishes model and figure together.
fn write(
    console: &Console,
    found: &Identified,
    artifact: &ModelArtifact,
    out: Option<Output>,
    figure_out: Option<Output>,
) -> anyhow::Result<()> {
    let mut outputs = Vec::new();
    if let Some(output) = out {
        outputs.push((output, artifact.json()?));
    }
    if let Some(output) = figure_out {
        let format = PictureFormat::of_path(output.path());
        outputs.push((output, format.write(figure::svg(found, artifact)?)?));
    }
    Ok(publish(outputs, console)?)
}

pub(crate) fn verdict(
    args: &Args,
    console: &Console,
    found: &Identified,
    artifact: &ModelArtifact,
    apart: Option<&Apart>,
) -> Verdict {
    let judged = artifact.fit.validation.unwrap_or(artifact.fit.estimation);
    if let Some(limit) = args.max_rmse_n.filter(|&limit| judged.rmse_n > limit) {
        console.warn(format!("rejected: RMSE {:.3} N is above --max-rmse-n {limit}", judged.rmse_n));
        return Verdict::Rejected;
    }
    if !artifact.search.converged && !args.no_polish {
        console.warn("rejected: the search did not converge; try more --starts or --iterations");
        return Verdict::Rejected;
    }
    if apart.is_some_and(|apart| !apart.is_tare()) && !args.accept_implausible {
        console.warn(
            "rejected: one model cannot follow recordings that contradict one another; set the instrument right or leave the \
             recording out, or take the model as it is with --accept-implausible",
        );
        return Verdict::Rejected;
    }
    if let Some(reason) = implausible(found).filter(|_| !args.accept_implausible) {
        console.warn(format!(
            "rejected: these are not the parameters of a muscle as eq. 11 describes it, {reason}; look for the cause in \
             instruments and muscle file, or take the model as it is with --accept-implausible"
        ));
        return Verdict::Rejected;
    }
    Verdict::Accepted
}

pub(crate) fn request(
    args: &Args,
    form: Form,
    muscle: MuscleFile,
    estimation: Vec<Recording>,
    validation: Vec<Recording>,
) -> Request {
    Request {
        estimation,
        validation,
        muscle,
        form,
        options: FitOptions {
            n_particles: args.particles as usize,
            n_iterations: args.iterations as usize,
            n_starts: args.starts as usize,
            seed: args.run.seed,
            polish: !args.no_polish,
        },
        loss: args.loss.loss(),
        free: args.free.clone(),
        fix: args.fix.clone(),
        length_play_m: args.length_play_mm.map(|play_mm| play_mm * 1e-3),
        pressure_play_pa: args.pressure_play_kpa.map(|play_kpa| play_kpa * 1e3),
        assumed: Assumed {
            bladder: args.bladder.map(BladderArg::law),
            friction: args.friction.map(FrictionArg::law),
            standstill: args.standstill,
        },
        accept_implausible: args.accept_implausible,
        unbounded: args.unbounded,
    }
}

/// Fits the other form of eq. 11 to the same recordings, for the table alone.
fn compare_forms(request: Request, console: &Console, artifact: &ModelArtifact) -> anyhow::Result<String> {
    let checked = check(request)?;
    let config = checked.config();
    let tool = artifact.tool.clone();
    let second = checked.identify()?.artifact(tool, artifact.inputs.clone(), config, artifact.seed);
    if console.is_quiet() { Ok(String::new()) } else { Ok(tables::forms(artifact, &second)) }
}

pub(crate) fn read_muscle(path: &Path) -> anyhow::Result<(MuscleFile, Input)> {
    let (muscle, text) = MuscleFile::read_with_text(path)?;
    let sha256 = sha256_hex(text.as_bytes());
    Ok((muscle, Input { path: path.display().to_string(), sha256, role: InputRole::Muscle }))
}
