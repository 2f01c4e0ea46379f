//! Files in, network out.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail, ensure};
use pam_artifact::{Input, InputRole, InverseArtifact, ModelArtifact, Tool};
use pam_cli::{Console, Output, Verdict, pretty_json, publish, read_recordings};
use pam_inverse_model::report::{Outcome, Prepared};
use pam_recording::{ReadOptions, Recording, first_shared};
use pam_report::PictureFormat;

use crate::args::{ActivationArg, Args};
use crate::{figure, tables};

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    check_numbers(args)?;
    let from_stdin = args.logs.iter().filter(|path| path.as_os_str() == "-").count();
    ensure!(from_stdin <= 1, "standard input can be read once only; name the other recordings as files");
    let inputs = || args.logs.iter().chain([&args.model]).chain(&args.read.channels);
    let open = |path: &Path| Output::open(path)?.apart_from(inputs());
    let out = args.out.as_deref().filter(|_| !args.run.check).map(open).transpose()?;
    let open_figure = |path: &Path| Output::open_figure(path)?.apart_from(inputs());
    let figure_out = args.figure.as_deref().filter(|_| !args.run.check).map(open_figure).transpose()?;

    let (model, sha256) = ModelArtifact::read(&args.model)?;
    pam_cli::for_the_muscle(&model.augmented_model(), &args.model, &console);
    let mut hashes = vec![Input { path: args.model.display().to_string(), sha256, role: InputRole::Model }];
    let read = args.read.resolve()?;
    hashes.extend(read.channels);
    let recordings = read_recordings(&args.logs, &ReadOptions { force_required: false, ..read.options }, &console)?;
    apart(&recordings)?;
    hashes.extend(recordings.iter().map(|recording| Input::recording(recording, InputRole::Training)));
    let config = args.config();
    let seed = args.run.seed;
    let prepared =
        Prepared::new(&model, &recordings, &config, seed).with_context(|| args.model.display().to_string())?;
    if prepared.n_rows_excluded() > 0 {
        console.warn(format!(
            "{} rows of the recordings are left out: outside the model's domain, or without an inverse",
            prepared.n_rows_excluded()
        ));
    }
    warn_of_another_muscle(&console, &model, &prepared);
    if args.run.check {
        console.note(format!("inputs are fine: {} points to train at (--check)", prepared.points().len()));
        return Ok(Verdict::Accepted);
    }
    let progress = console.progress("training", (config.n_starts * config.n_epochs) as u64);
    let start = Instant::now();
    let outcome = prepared.train(&config, seed, &|| progress.advance(1))?;
    let training_time = start.elapsed();
    drop(progress);
    let tool = Tool { name: "pam-train-inverse".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() };
    let artifact = outcome
        .artifact(&prepared, tool, hashes, config, seed)
        .context("no point of the domain can be judged; widen the domain")?;

    console.text(tables::training(&artifact, training_time));
    console.text(tables::errors(&artifact));
    console.text(tables::regions(&artifact));
    console.text(tables::inverses(&artifact, &time(&outcome, &prepared)));
    for warning in &artifact.warnings {
        console.warn(warning);
    }
    write(&console, &artifact, &outcome, &prepared, out, figure_out)?;
    let error = artifact.errors.pressure_rmse_percent;
    if error > args.max_error_percent {
        let limit = args.max_error_percent;
        console
            .warn(format!("rejected: RMSE {error:.3} % of the range of pressure is above --max-error-percent {limit}"));
        return Ok(Verdict::Rejected);
    }
    Ok(Verdict::Accepted)
}

/// Refuses recordings that share samples: points of what is there twice would weigh twice, and be trained at and judged at as well.
fn apart(recordings: &[Recording]) -> anyhow::Result<()> {
    let all: Vec<&Recording> = recordings.iter().collect();
    let shared = first_shared(&all).map_err(|(index, reason)| {
        anyhow!(
            "{}: cannot read the samples back from the temporary file: {reason}; set TMPDIR to a folder with room",
            recordings[index].path
        )
    })?;
    if let Some((first, second)) = shared {
        bail!(
            "{}: has the same samples as {}; a recording counts once: leave one of them out",
            recordings[second].path,
            recordings[first].path
        );
    }
    Ok(())
}

/// Error of a model on a recording of its own muscle, as a share of its range of force and as a multiple of its error on
/// the recordings that it was identified on: a muscle that is beyond both is another one, or the model is none of it.
const OTHER_MUSCLE: (f64, f64) = (0.05, 4.0);

/// Says where recorded forces are not those of the model; the network is trained on the model's all the same.
fn warn_of_another_muscle(console: &Console, model: &ModelArtifact, prepared: &Prepared) {
    let Some(error_n) = prepared.force_rmse_n() else { return };
    let [lowest_n, highest_n] = model.domain.force_n;
    let fitted_n = model.fit.estimation.rmse_n;
    if error_n > OTHER_MUSCLE.0 * (highest_n - lowest_n) && error_n > OTHER_MUSCLE.1 * fitted_n {
        console.warn(format!(
            "the recorded forces are {error_n:.1} N from the model's, which left {fitted_n:.1} N where it was identified: \
             are these recordings of its muscle? Their forces are not used"
        ));
    }
}

fn check_numbers(args: &Args) -> anyhow::Result<()> {
    let share = args.validation_share;
    ensure!(share > 0.0 && share <= 0.9, "--validation-share {share} is outside 0 to 0.9");
    for (name, value) in [("--max-error-percent", args.max_error_percent), ("--learning-rate", args.learning_rate)] {
        ensure!(value > 0.0 && value.is_finite(), "{name} {value} is not a positive number");
    }
    let goal = args.goal_percent;
    ensure!(goal >= 0.0 && goal.is_finite(), "--goal-percent {goal} is negative");
    ensure!(args.activation != ActivationArg::Linear, "--activation linear makes no network; take tanh or sigmoid");
    ensure!(args.points > 0 || !args.logs.is_empty(), "--points 0 leaves nothing to train at; name a recording");
    Ok(())
}

/// The reference of the network, over points that were judged.
pub(crate) struct Timing {
    /// One evaluation of the network.
    pub(crate) network: Duration,
    /// One root found on the model.
    pub(crate) exact: Duration,
    /// Largest error of the root, in Pa.
    pub(crate) exact_max_pa: f64,
}

/// Points that both inverses are timed on: some ten milliseconds.
const TIMED: usize = 2000;

/// Times both inverses on points that were judged.
fn time(outcome: &Outcome, prepared: &Prepared) -> Timing {
    let points = || outcome.judged.iter().map(|judged| judged.point).take(TIMED);
    let n = u32::try_from(points().count()).unwrap_or(u32::MAX).max(1);
    let start = Instant::now();
    let mut sum = 0.0;
    for point in points() {
        sum += outcome.network.pressure_pa(point.force_n, point.length_m, point.direction).pressure_pa;
    }
    std::hint::black_box(sum);
    let network = start.elapsed() / n;
    let start = Instant::now();
    let mut exact_max_pa = 0.0_f64;
    for point in points() {
        if let Ok(pressure_pa) = prepared.exact().pressure_pa(point.force_n, point.length_m, point.direction) {
            exact_max_pa = exact_max_pa.max((pressure_pa - point.pressure_pa).abs());
        }
    }
    Timing { network, exact: start.elapsed() / n, exact_max_pa }
}

/// Publishes network and figure together.
fn write(
    console: &Console,
    artifact: &InverseArtifact,
    outcome: &Outcome,
    prepared: &Prepared,
    out: Option<Output>,
    figure_out: Option<Output>,
) -> anyhow::Result<()> {
    let mut outputs = Vec::new();
    if let Some(output) = out {
        outputs.push((output, pretty_json(artifact)?));
    }
    if let Some(output) = figure_out {
        let format = PictureFormat::of_path(output.path());
        outputs.push((output, format.write(figure::svg(artifact, outcome, prepared)?)?));
    }
    Ok(publish(outputs, console)?)
}
