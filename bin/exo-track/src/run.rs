//! Files in, track, metrics and figures out.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use pam_artifact::{Input, InputRole, InverseArtifact, ModelArtifact, Tool};
use pam_cli::{Console, Output, OutputError, Verdict, for_the_muscle, pretty_json, publish, write_example};
use pam_exo::artifact::{ArmMetrics, MetricsArtifact, SCHEMA, TrialMetrics, is_the_papers, paper};
use pam_exo::config::{LiftConfig, LiftPlan};
use pam_exo::inverse::{ExactInverse, Inverse};
use pam_exo::lift::{Instant, Outcome};
use pam_exo::options::compare_options;
use pam_exo::reach::{check_reach, help};
use pam_exo::simulation::Simulation;
use pam_exo::study::{Study, run_study};
use pam_exo::uncertainty::Uncertainty;
use pam_inverse_model::InverseNetwork;
use pam_muscle::Muscle;
use pam_muscle::effects::AugmentedModel;
use pam_recording::sha256_hex;
use pam_report::PictureFormat;

use crate::args::Args;
use crate::network::Network;
use crate::{figure, tables, track};

/// The file that `--example` writes.
const EXAMPLE: &str = include_str!("../../../configs/lift.toml");

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    if args.example {
        write_example(EXAMPLE, args.out.as_deref(), &args.run, &console)?;
        return Ok(Verdict::Accepted);
    }
    let config_path = args.config.as_deref().context("--config is missing")?;
    let model_path = args.model.as_deref().context("--model is missing")?;
    let outputs = Outputs::open(args)?;
    let (config, plan, config_input) = read_config(config_path)?;
    let (model, model_input) = read_model(model_path, InputRole::Model)?;
    let mut inputs = vec![config_input, model_input];
    let plant = args.plant.as_deref().map(|path| read_model(path, InputRole::Plant)).transpose()?;
    let force = for_the_muscle(&model.augmented_model(), model_path, &console);
    let inverse = read_inverse(args, &plan, &force, &mut inputs)?;
    if let (Some(path), Some((artifact, _))) = (&args.plant, &plant) {
        note_plant(&console, [model_path, path], &model, artifact);
    }
    let plant_artifact = plant.as_ref().map_or(&model, |(artifact, _)| artifact);
    let plant_force = match (&args.plant, &plant) {
        (Some(path), Some((artifact, _))) => for_the_muscle(&artifact.augmented_model(), path, &console),
        _ => force.clone(),
    };
    inputs.extend(plant.iter().map(|(_, input)| input.clone()));
    let simulation = Simulation { plan: &plan, model: &force, inverse: inverse.as_ref(), plant: &plant_force };
    let reach = check_reach(&simulation, &model.domain).with_context(|| config_path.display().to_string())?;
    let uncertainty = match args.trials {
        Some(_) if plan.spreads.model_parameters => {
            let path = args.plant.as_deref().unwrap_or(model_path);
            let uncertainty = Uncertainty::new(plant_artifact).with_context(|| path.display().to_string())?;
            note_held(&console, path, uncertainty.held());
            Some(uncertainty)
        }
        _ => None,
    };
    if args.run.check {
        warn_beyond(&console, &model, reach.pressure_pa, reach.length_m);
        console.note("inputs are fine and the reference is within reach; nothing was simulated (--check)");
        return Ok(Verdict::Accepted);
    }

    let mut arms: [Vec<Instant>; 2] = Default::default();
    let outcomes = simulation.run_nominal(args.run.seed, |arm, instant| arms[arm].push(*instant));
    if !outcomes.iter().all(|outcome| outcome.began) {
        // No lift, no errors of it, and no files that say otherwise.
        warn_beyond(&console, &model, reach.pressure_pa, reach.length_m);
        let verdict = verdict(&console, &outcomes);
        console.warn(format!("there was no lift, and nothing is written; {}", help(&simulation, &model.domain)));
        return Ok(verdict);
    }
    warn_outside(&console, &model, &arms);
    if args.inverse.is_some() && outcomes.iter().any(|outcome| outcome.outside) {
        console.warn(
            "the inverse was asked for forces or lengths that it was not trained on, and gave the nearest pressure that it \
             knows; identify the model on recordings of the lift's lengths and forces",
        );
    }
    let [left, right] = outcomes.map(|outcome| ArmMetrics::of(&outcome));
    let beside = is_the_papers(&plan).then(paper);
    console.text(tables::errors(&left.errors, &right.errors, beside.as_ref()));
    if args.compare_options {
        let progress = console.progress("comparing options", 1);
        let variants = compare_options(&simulation, args.run.seed, |done, all| progress.set_of(done, all));
        drop(progress);
        console.text(tables::options(&variants));
    }
    let study = args.trials.map(|n_trials| {
        let progress = console.progress("lifting", n_trials);
        run_study(&simulation, uncertainty.as_ref(), n_trials, args.run.seed, |steps| progress.advance(steps))
    });
    let trials = study.as_ref().map(TrialMetrics::of);
    if let Some(trials) = &trials {
        console.text(tables::trials(trials));
    }
    let artifact = MetricsArtifact {
        schema: SCHEMA.to_owned(),
        tool: Tool { name: "exo-track".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
        inputs,
        config,
        seed: args.run.seed,
        left,
        right,
        paper: paper(),
        trials,
    };
    outputs.write(&console, &arms, &artifact, &plan, study.as_ref())?;
    Ok(verdict(&console, &outcomes))
}

/// Outputs of the run.
struct Outputs {
    track: Option<Output>,
    metrics: Option<Output>,
    figure: Option<Output>,
    trials_figure: Option<Output>,
}

impl Outputs {
    /// Opens every output before anything is computed.
    fn open(args: &Args) -> anyhow::Result<Self> {
        let inputs = [&args.config, &args.model, &args.inverse, &args.plant];
        let open_as = |path: &Option<PathBuf>, open: fn(&Path) -> Result<Output, OutputError>| {
            path.as_deref()
                .filter(|_| !args.run.check)
                .map(|path| open(path)?.apart_from(inputs.into_iter().flatten()))
                .transpose()
        };
        let open = |path: &Option<PathBuf>| open_as(path, |path| Output::open(path));
        let open_figure = |path: &Option<PathBuf>| open_as(path, |path| Output::open_figure(path));
        Ok(Self {
            track: open(&args.out)?,
            metrics: open(&args.metrics)?,
            figure: open_figure(&args.figure)?,
            trials_figure: open_figure(&args.trials_figure)?,
        })
    }

    /// Publishes everything together.
    fn write(
        self,
        console: &Console,
        arms: &[Vec<Instant>; 2],
        artifact: &MetricsArtifact,
        plan: &LiftPlan,
        study: Option<&Study>,
    ) -> anyhow::Result<()> {
        let beside = is_the_papers(plan).then(paper);
        let mut outputs = Vec::new();
        if let Some(output) = self.track {
            outputs.push((output, track::csv(arms)?));
        }
        if let Some(output) = self.metrics {
            outputs.push((output, pretty_json(artifact)?));
        }
        if let Some(output) = self.figure {
            let format = PictureFormat::of_path(output.path());
            outputs.push((output, format.write(figure::lift(arms, artifact, beside.as_ref())?)?));
        }
        if let (Some(output), Some(study), Some(trials)) = (self.trials_figure, study, &artifact.trials) {
            let format = PictureFormat::of_path(output.path());
            outputs.push((output, format.write(figure::envelope(study, trials, plan, beside.as_ref())?)?));
        }
        Ok(publish(outputs, console)?)
    }
}

fn read_config(path: &Path) -> anyhow::Result<(LiftConfig, LiftPlan, Input)> {
    let (config, plan, text) = LiftConfig::read(path)?;
    let input =
        Input { path: path.display().to_string(), sha256: sha256_hex(text.as_bytes()), role: InputRole::Configuration };
    Ok((config, plan, input))
}

fn read_model(path: &Path, role: InputRole) -> anyhow::Result<(ModelArtifact, Input)> {
    let (artifact, sha256) = ModelArtifact::read(path)?;
    check_model(path, &artifact)?;
    Ok((artifact, Input { path: path.display().to_string(), sha256, role }))
}

/// Refuses a model that no lift can be computed with.
fn check_model(path: &Path, model: &ModelArtifact) -> anyhow::Result<()> {
    let path = path.display();
    for entry in model.parameters.iter().filter(|entry| entry.name.ends_with("_friction")) {
        let (name, value) = (&entry.name, entry.value);
        ensure!(value >= 0.0, "{path}: {name} is {value:e}, a friction that drives; identify the model anew");
    }
    for (name, unit, scale, [from, to]) in
        [("pressure", "kPa", 1e-3, model.domain.pressure_pa), ("length", "mm", 1e3, model.domain.length_m)]
    {
        let (from, to) = (scale * from, scale * to);
        ensure!(
            from <= to && from.abs() < MOST_WRITTEN && to.abs() < MOST_WRITTEN,
            "{path}: its domain runs from a {name} of {from:e} to {to:e} {unit}; identify the model anew"
        );
    }
    Ok(())
}

/// More kPa or mm than any recording has.
const MOST_WRITTEN: f64 = 1e9;

/// Says that the muscle of the lift is another than the controller knows: that is the experiment, or a mistake.
fn note_plant(console: &Console, [model_path, plant_path]: [&Path; 2], model: &ModelArtifact, plant: &ModelArtifact) {
    let (model_path, plant_path) = (model_path.display(), plant_path.display());
    if plant == model {
        console.note(format!("--plant {plant_path} is the model that the controller knows"));
        return;
    }
    let (known, real) = (&model.geometry, &plant.geometry);
    let differs = |of: fn(&Muscle) -> f64| (of(known) - of(real)).abs() > 1e-3 * of(known).abs();
    let sizes = [
        ("rest length", differs(|muscle| muscle.rest_length_m), known.rest_length_m, real.rest_length_m),
        ("rest radius", differs(|muscle| muscle.rest_radius_m), known.rest_radius_m, real.rest_radius_m),
    ];
    let other: Vec<String> = sizes
        .iter()
        .filter(|(_, differs, ..)| *differs)
        .map(|(name, _, known_m, real_m)| format!("{name} {:.1} mm, not {:.1} mm", 1e3 * real_m, 1e3 * known_m))
        .collect();
    let muscle = if other.is_empty() { String::new() } else { format!(", of other dimensions ({})", other.join("; ")) };
    console.note(format!("the muscle of the lift is {plant_path}{muscle}; the controller knows {model_path}"));
}

/// Says which parameters the trials do not vary although the configuration asks for it.
fn note_held(console: &Console, path: &Path, held: &[String]) {
    if !held.is_empty() {
        console.note(format!(
            "{}: held at their values in the trials, for want of a standard error (as at a bound): {}",
            path.display(),
            held.join(", ")
        ));
    }
}

/// The inverse in a file, or that by root finding.
fn read_inverse(
    args: &Args,
    plan: &LiftPlan,
    force: &AugmentedModel,
    inputs: &mut Vec<Input>,
) -> anyhow::Result<Box<dyn Inverse>> {
    let Some(path) = &args.inverse else {
        let [lowest_pa, highest_pa] = plan.control.pressure_limits_pa;
        return Ok(Box::new(ExactInverse::new(force.clone(), lowest_pa, highest_pa)));
    };
    let (artifact, sha256) = InverseArtifact::read(path)?;
    let known = inputs.iter().find(|input| input.role == InputRole::Model).context("--model is missing")?;
    pam_cli::ensure_inverse_of(path, &artifact, known)?;
    inputs.push(Input { path: path.display().to_string(), sha256, role: InputRole::Inverse });
    Ok(Box::new(Network(InverseNetwork::from_artifact(&artifact))))
}

/// Says where the lift leaves what the model was identified on.
fn warn_outside(console: &Console, model: &ModelArtifact, arms: &[Vec<Instant>; 2]) {
    let range = |value: fn(&Instant) -> f64| {
        let values = || arms.iter().flatten().map(value);
        [values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max)]
    };
    warn_beyond(console, model, range(|instant| instant.pressure_pa), range(|instant| instant.length_m));
}

/// Says where a lift between these pressures and lengths leaves what the model was identified on.
fn warn_beyond(console: &Console, model: &ModelArtifact, pressure_pa: [f64; 2], length_m: [f64; 2]) {
    let check = |name: &str, unit: &str, scale: f64, domain: [f64; 2], [lowest, highest]: [f64; 2]| {
        if lowest < domain[0] || highest > domain[1] {
            console.warn(format!(
                "the lift uses a {name} of {:.1} to {:.1} {unit}, and the model was identified on {:.1} to {:.1} {unit}: \
                 it extrapolates; record bench data there",
                scale * lowest,
                scale * highest,
                scale * domain[0],
                scale * domain[1]
            ));
        }
    };
    check("pressure", "kPa", 1e-3, model.domain.pressure_pa, pressure_pa);
    check("length", "mm", 1e3, model.domain.length_m, length_m);
}

fn verdict(console: &Console, outcomes: &[Outcome; 2]) -> Verdict {
    let mut verdict = Verdict::Accepted;
    for (arm, outcome) in ["left", "right"].iter().zip(outcomes) {
        for trouble in outcome.troubles.iter().flatten() {
            console.warn(format!("rejected: {arm} arm {trouble}"));
            verdict = Verdict::Rejected;
        }
    }
    verdict
}
