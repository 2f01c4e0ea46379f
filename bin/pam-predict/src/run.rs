//! Recording and model in, recording with two more columns out.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, ensure};
use pam_artifact::model::FitStatistics;
use pam_artifact::{Input, InputRole, ModelArtifact, readable_json};
use pam_cli::{Output, OutputError, Verdict, for_any_recording, publish};
use pam_identification::band::PredictiveBand;
use pam_identification::evaluate::{NoForceAt, evaluate_augmented, noise_floor_n, without_force};
use pam_identification::faults::{noise, reading, spikes, twice};
use pam_identification::predict::{augmented_forces_n, forces_n, outside, prepare, prepare_plausible};
use pam_identification::prediction::{Prediction, predict};
use pam_identification::prepare::Prepared;
use pam_identification::report::out_of_range;
use pam_muscle::effects::AugmentedModel;
use pam_recording::ReadOptions;
use pam_report::PictureFormat;

use crate::args::Args;
use crate::{figure, metrics};

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    let inputs = || [&args.log, &args.model].into_iter().chain(&args.read.channels);
    let wanted = |path: &Option<PathBuf>, open: fn(&Path) -> Result<Output, OutputError>| {
        path.as_deref().filter(|_| !args.run.check).map(|path| open(path)?.apart_from(inputs())).transpose()
    };
    let out = wanted(&args.out, |path| Output::open(path))?;
    let metrics_out = wanted(&args.metrics, |path| Output::open(path))?;
    let figure_out = wanted(&args.figure, |path| Output::open_figure(path))?;
    let (artifact, model_sha256) = ModelArtifact::read(&args.model)?;
    let read = args.read.resolve()?;
    let options = ReadOptions { force_required: false, ..read.options };
    let recording = pam_cli::read_recording(&args.log, &options, &console)?;
    for note in recording.repairs.notes() {
        console.warn(format!("{}: {note}", recording.path));
    }
    for (limit, option) in [(args.max_rmse_n, "--max-rmse-n"), (args.max_rmse_all_n, "--max-rmse-all-n")] {
        ensure!(
            limit.is_none() || recording.samples.has_force(),
            "{}: no force was recorded, so {option} has nothing to judge",
            recording.path
        );
    }
    let input = Input::recording(&recording, InputRole::Validation);
    let mut prepared =
        if args.accept_implausible { prepare(recording, &artifact)? } else { prepare_plausible(recording, &artifact)? };
    if let Some(words) = spikes::warning(&prepared.recording, &prepared.quality)? {
        console.warn(words);
    }
    for words in twice::repeated(&[&prepared.recording])? {
        console.warn(words);
    }
    for words in out_of_range(|| std::iter::once(&prepared)) {
        console.warn(words);
    }
    for words in outside(&prepared, &artifact.domain) {
        console.warn(words);
    }
    let model = for_any_recording(&artifact.augmented_model(), &args.model, &console);
    prepared.begin_with(&model, artifact.direction, 0)?;
    // Before anything is written: a model that has no force for what was recorded leaves no file.
    let has_force = prepared.recording.samples.has_force();
    let evaluation = if has_force {
        Some(evaluate_augmented(std::slice::from_ref(&prepared), &model, artifact.direction)?)
    } else {
        None
    };
    // Before anything is written, as well: a band that cannot be drawn leaves no file.
    let followed = match (&metrics_out, &figure_out) {
        (None, None) => None,
        _ => Some(followed(&prepared, &model, &artifact, &args.model)?),
    };
    let mut outputs = Vec::new();
    if let Some(mut out) = out {
        let path = out.path().display().to_string();
        // Only effects remember, and only with them the forces are computed beforehand.
        let augmented_n =
            if model.is_plain() { None } else { Some(augmented_forces_n(&prepared, &model, artifact.direction)?) };
        let missing = write(&mut out, &prepared, &model, augmented_n.as_deref())
            .with_context(|| format!("cannot write {path}"))?;
        if let Some(at) = missing.first {
            let n_rows = prepared.recording.samples.n_rows();
            let said = without_force(prepared.recording.path.clone(), missing.n, n_rows, at, model.base());
            // Where a force was recorded, those that count have been judged.
            ensure!(has_force, said);
            console.warn(format!(
                "{}: the modelled force is no number in {} samples that are not counted, first at {:.3} s",
                prepared.recording.path, missing.n, at.time_s
            ));
        }
        outputs.push((out, Vec::new()));
    }
    let statistics = evaluation.map(|evaluation| evaluation.each[0]);
    let above = above(args, statistics.as_ref());
    if let Some(followed) = &followed {
        if let Some(output) = metrics_out {
            let model_input =
                Input { path: args.model.display().to_string(), sha256: model_sha256, role: InputRole::Model };
            let floor_n =
                has_force.then(|| noise_floor_n(std::slice::from_ref(&prepared), model.base())).transpose()?;
            let inputs = [Some(model_input), read.channels.clone(), Some(input)].into_iter().flatten().collect();
            let metrics = metrics::metrics(args, inputs, followed, (floor_n, above.is_empty()), &prepared);
            outputs.push((output, readable_json(&metrics)?));
        }
        if let Some(output) = figure_out {
            let format = PictureFormat::of_path(output.path());
            outputs.push((output, format.write(figure::svg(followed, &prepared)?)?));
        }
    }
    publish(outputs, &console)?;
    let Some(statistics) = statistics else { return Ok(Verdict::Accepted) };
    console.note(format!(
        "RMSE {:.3} N, largest {:.1} N, fit {:.2} % over {} counted samples; RMSE {:.3} N over all {}, reversals included",
        statistics.rmse_n,
        statistics.max_n,
        statistics.fit_percent,
        statistics.n_samples,
        statistics.rmse_all_n,
        statistics.n_samples + statistics.n_unsettled
    ));
    for words in noise::words(std::iter::once(&prepared), model.base(), Some(reading::own_n(&artifact)))? {
        console.warn(words);
    }
    if let Some(words) = reading::missed(&prepared, &artifact, &model, statistics.rmse_n)? {
        console.warn(words);
    }
    above.iter().for_each(|words| console.warn(words));
    Ok(if above.is_empty() { Verdict::Accepted } else { Verdict::Rejected })
}

/// Limits that are not met, in words.
fn above(args: &Args, statistics: Option<&FitStatistics>) -> Vec<String> {
    let Some(statistics) = statistics else { return Vec::new() };
    let limits = [
        ("RMSE", statistics.rmse_n, "--max-rmse-n", args.max_rmse_n),
        ("RMSE over all samples,", statistics.rmse_all_n, "--max-rmse-all-n", args.max_rmse_all_n),
    ];
    let words = limits.into_iter().filter_map(|(name, rmse_n, option, limit)| {
        let limit = limit.filter(|&limit| rmse_n > limit)?;
        Some(format!("rejected: {name} {rmse_n:.3} N is above {option} {limit}"))
    });
    words.collect()
}

/// Samples of the figure, at most.
const FIGURE_SAMPLES: usize = 40_000;

/// The recording along the model, with the interval around it.
fn followed(
    prepared: &Prepared,
    model: &AugmentedModel,
    artifact: &ModelArtifact,
    path: &Path,
) -> anyhow::Result<Prediction> {
    let band = PredictiveBand::of(artifact).map_err(|error| anyhow!("{}: {error}", path.display()))?;
    Ok(predict(prepared, model, artifact, &band, FIGURE_SAMPLES)?)
}

/// Rows for which the model has no force.
#[derive(Debug, Clone, Copy, Default)]
struct Missing {
    n: usize,
    first: Option<NoForceAt>,
}

/// Decimals are those of a good sensor: 1 µs, 0.1 Pa, 0.1 µm, 0.1 mN.
///
/// `augmented_n` are the forces of all rows where the model has effects.
fn write(
    out: &mut Output,
    prepared: &Prepared,
    model: &AugmentedModel,
    augmented_n: Option<&[f64]>,
) -> std::io::Result<Missing> {
    let mut missing = Missing::default();
    let samples = &prepared.recording.samples;
    let (has_force, has_temperature) = (samples.has_force(), samples.has_temperature());
    let mut table = csv::Writer::from_writer(out);
    let mut names = vec!["time_s", "pressure_kPa", "length_mm"];
    if has_force {
        names.push("force_N");
    }
    if has_temperature {
        names.push("temperature_C");
    }
    names.push("force_model_N");
    if has_force {
        names.push("residual_N");
    }
    table.write_record(names).map_err(io_error)?;
    let mut record = csv::ByteRecord::new();
    for chunk in samples.chunks() {
        let chunk = chunk?;
        let model_n = match augmented_n {
            Some(all_n) => all_n[chunk.rows()].to_vec(),
            None => forces_n(prepared, model.base(), &chunk),
        };
        for (row, &model_n) in model_n.iter().enumerate() {
            if !model_n.is_finite() {
                missing.n += 1;
                missing.first.get_or_insert_with(|| NoForceAt {
                    time_s: chunk.time_s()[row],
                    pressure_pa: chunk.pressure_pa()[row],
                    length_m: chunk.length_m()[row],
                });
            }
            record.clear();
            let mut field = |value: f64, decimals: usize| {
                record.push_field(format!("{value:.decimals$}").as_bytes());
            };
            field(chunk.time_s()[row], 6);
            field(chunk.pressure_pa()[row] * 1e-3, 4);
            field(chunk.length_m()[row] * 1e3, 4);
            if has_force {
                field(chunk.force_n()[row], 4);
            }
            if has_temperature {
                field(chunk.temperature_k()[row] - 273.15, 3);
            }
            field(model_n, 4);
            if has_force {
                field(chunk.force_n()[row] - model_n, 4);
            }
            table.write_byte_record(&record).map_err(io_error)?;
        }
    }
    table.flush()?;
    Ok(missing)
}

/// The writer's own error, which knows the file and whether its reader has gone.
fn io_error(error: csv::Error) -> std::io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        kind => std::io::Error::other(format!("{kind:?}")),
    }
}
