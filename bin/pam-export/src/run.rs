//! Model and inverse in, files for other programs out.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use pam_artifact::model::Domain;
use pam_artifact::{Input, InputRole, InverseArtifact, ModelArtifact};
use pam_cli::{Console, Output, Verdict, ensure_inverse_of, publish};
use pam_deployment::grid::Grid;
use pam_deployment::vectors::{self, Vector};
use pam_deployment::{c, mujoco, simulink};
use pam_identification::predict::{prepare, prepare_plausible};
use pam_inverse_model::InverseNetwork;
use pam_muscle::effects::{AugmentedModel, Role};
use pam_recording::ReadOptions;

use crate::args::Args;

/// The module that `--python` writes.
const PYTHON: &str = include_str!("../../../scripts/python/pam_muscle.py");

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    let outputs = Outputs::open(args)?;
    let (artifact, sha256) = ModelArtifact::read(&args.model)?;
    let known = Input { path: args.model.display().to_string(), sha256, role: InputRole::Model };
    let mut origin = vec![of_file(&known)];
    let inverse = match &args.inverse {
        Some(path) => {
            let (artifact, sha256) = InverseArtifact::read(path)?;
            ensure_inverse_of(path, &artifact, &known)?;
            origin.push(of_file(&Input { path: path.display().to_string(), sha256, role: InputRole::Inverse }));
            Some(InverseNetwork::from_artifact(&artifact))
        }
        None => None,
    };
    let export = Export { model: wanted(args, &artifact, &console), artifact, inverse, origin };
    ensure_force(&export.model, &export.artifact.domain).with_context(|| known.path.clone())?;
    let along = args.log.as_deref().map(|log| export.along(args, log, &console)).transpose()?;
    if args.run.check {
        console.note("inputs are fine (--check)");
        return Ok(Verdict::Accepted);
    }
    publish(outputs.filled(&export, along.as_deref(), &console).with_context(|| known.path.clone())?, &console)?;
    Ok(Verdict::Accepted)
}

/// More than any muscle pulls, in N.
const BEYOND_MUSCLES_N: f64 = 1e6;
/// Pressures, and lengths, of the operating range that the force is looked at.
const LOOKS: u32 = 5;

/// Refuses a model that no muscle has: what drives a rig must not begin with it.
fn ensure_force(model: &AugmentedModel, domain: &Domain) -> anyhow::Result<()> {
    let between = |[low, high]: [f64; 2], look: u32| low + (high - low) * f64::from(look) / f64::from(LOOKS - 1);
    for (pressure, length) in (0..LOOKS).flat_map(|pressure| (0..LOOKS).map(move |length| (pressure, length))) {
        let (pressure_pa, length_m) = (between(domain.pressure_pa, pressure), between(domain.length_m, length));
        let force_n = model.settled_force_n(pressure_pa, length_m, 1.0);
        ensure!(
            force_n.is_nan() || force_n.abs() < BEYOND_MUSCLES_N,
            "the modelled force is {force_n:.1e} N at {:.1} kPa and {:.1} mm, which no muscle has; identify the model anew",
            1e-3 * pressure_pa,
            1e3 * length_m
        );
    }
    Ok(())
}

/// A line for the top of a file; a line break in a path would end its comment.
fn of_file(input: &Input) -> String {
    let path: String = input.path.chars().map(|letter| if letter.is_control() { '?' } else { letter }).collect();
    format!("Written by pam-export {} from {path} (SHA-256 {}).", env!("CARGO_PKG_VERSION"), input.sha256)
}

/// The model with the effects that are wanted.
fn wanted(args: &Args, artifact: &ModelArtifact, console: &Console) -> AugmentedModel {
    let model = artifact.augmented_model();
    if args.muscle_only {
        return pam_cli::for_the_muscle(&model, &args.model, console);
    }
    pam_cli::for_any_recording(&model, &args.model, console)
}

/// The export.
struct Export {
    artifact: ModelArtifact,
    model: AugmentedModel,
    inverse: Option<InverseNetwork>,
    origin: Vec<String>,
}

impl Export {
    /// Test vectors along a recording, as `pam-predict` sees it.
    fn along(&self, args: &Args, log: &Path, console: &Console) -> anyhow::Result<Vec<Vector>> {
        let options = ReadOptions { force_required: false, ..args.read.resolve()?.options };
        let recording = pam_cli::read_recording(log, &options, console)?;
        for note in recording.repairs.notes() {
            console.warn(format!("{}: {note}", recording.path));
        }
        let mut prepared = if args.accept_implausible {
            prepare(recording, &self.artifact)?
        } else {
            prepare_plausible(recording, &self.artifact)?
        };
        prepared.begin_with(&self.model, self.artifact.direction, 0)?;
        Ok(vectors::along(&prepared, &self.model, self.artifact.direction)?)
    }

    /// Names of the effects that remember, or that depend on the speed: a table has them as they settle.
    fn settling(&self, kept: &[&str]) -> Vec<&'static str> {
        let terms = self.model.terms().iter().filter(|term| !term.effect.is_static());
        terms.map(|term| term.effect.page().id).filter(|id| !kept.contains(id)).collect()
    }
}

/// Files to write, opened before anything is read.
struct Outputs {
    /// The header with its path, and its program where it is a file.
    header: Option<(Output, PathBuf)>,
    program: Option<(Output, PathBuf)>,
    python: Option<Output>,
    simulink: Option<(Output, PathBuf)>,
    mujoco: Option<(Output, PathBuf)>,
    vectors: Option<Output>,
}

impl Outputs {
    fn open(args: &Args) -> anyhow::Result<Self> {
        let asked = [&args.c, &args.python, &args.simulink, &args.mujoco, &args.vectors];
        ensure!(
            args.run.check || asked.iter().any(|path| path.is_some()),
            "nothing to write: name --c, --python, --simulink, --mujoco or --vectors"
        );
        let inputs = || {
            [Some(&args.model), args.inverse.as_ref(), args.log.as_ref(), args.read.channels.as_ref()]
                .into_iter()
                .flatten()
        };
        let open = |path: Option<&Path>| -> anyhow::Result<Option<(Output, PathBuf)>> {
            match path.filter(|_| !args.run.check) {
                Some(path) => Ok(Some((Output::open(path)?.apart_from(inputs())?, path.to_owned()))),
                None => Ok(None),
            }
        };
        // Names before anything is opened: a file whose name gives none for what is in it is refused with or without --check.
        for path in [&args.c, &args.simulink, &args.mujoco].into_iter().flatten() {
            c::prefix(path)?;
        }
        let program = args.c.as_deref().filter(|path| path.as_os_str() != "-").map(beside);
        Ok(Self {
            header: open(args.c.as_deref())?,
            program: open(program.as_deref())?,
            python: open(args.python.as_deref())?.map(|(output, _)| output),
            simulink: open(args.simulink.as_deref())?,
            mujoco: open(args.mujoco.as_deref())?,
            vectors: open(args.vectors.as_deref())?.map(|(output, _)| output),
        })
    }

    /// Every file with what belongs into it.
    fn filled(
        self,
        export: &Export,
        along: Option<&[Vector]>,
        console: &Console,
    ) -> anyhow::Result<Vec<(Output, Vec<u8>)>> {
        let Export { artifact, model, inverse, origin } = export;
        let (domain, inverse) = (&artifact.domain, inverse.as_ref());
        let mut filled: Vec<(Output, String)> = Vec::new();
        if let Some((output, path)) = self.header {
            filled.push((output, c::header(&path, &c::Header { artifact, model, inverse, origin })?));
            if let Some((output, program)) = self.program {
                let vectors = vectors::synthetic(model, domain)?;
                filled.push((output, c::check_program(&path, &program, &vectors, inverse)?));
            }
        }
        filled.extend(self.python.map(|output| (output, PYTHON.to_owned())));
        let needs_grid = self.simulink.is_some() || self.mujoco.is_some();
        let grid = if needs_grid { Some(Grid::of(model, domain)?) } else { None };
        if let (Some((output, path)), Some(grid)) = (self.simulink, &grid) {
            console.note(format!(
                "{}: {} × {} × 3 forces, interpolation off by {:.3} N at most",
                path.display(),
                grid.pressure_pa.len(),
                grid.length_m.len(),
                grid.interpolation_error_n
            ));
            filled.push((output, simulink::script(&path, grid, inverse, origin, &export.settling(&[]))?));
        }
        if let (Some((output, path)), Some(grid)) = (self.mujoco, &grid) {
            let actuator = mujoco::Actuator::of(model, grid)?;
            let [rms_n, most_n] = actuator.error_n;
            console.note(format!(
                "{}: actuator and springs are {rms_n:.1} N (RMS) and at most {most_n:.1} N from the settled force",
                path.display()
            ));
            let settling = export.settling(&["viscous-damping", "pressure-lag"]);
            filled.push((output, mujoco::scene(&path, &actuator, domain, origin, &settling)?));
        }
        if let Some(output) = self.vectors {
            let text = match along {
                Some(vectors) => vectors::csv(vectors),
                None => vectors::csv(&vectors::synthetic(model, domain)?),
            };
            filled.push((output, text));
        }
        if model.terms().iter().any(|term| term.effect.role() == Role::Shift) {
            console.note("the delay between the channels is not in a step: hand it channels that are moved by as much");
        }
        Ok(filled.into_iter().map(|(output, text)| (output, text.into_bytes())).collect())
    }
}

/// The program beside a header: `muscle_check.c` for `muscle.h`.
fn beside(header: &Path) -> PathBuf {
    let stem = header.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    header.with_file_name(format!("{stem}_check.c"))
}
