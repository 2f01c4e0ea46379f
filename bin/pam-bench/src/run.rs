//! From arguments to files.

use std::io::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow};
use pam_artifact::{Input, InputRole};
use pam_cli::{Console, Output, OutputError, Verdict, finish_all, nearest};
use pam_muscle::MuscleFile;
use pam_recording::sha256_hex;
use pam_virtual_bench::bench::BenchError;
use pam_virtual_bench::catalogue::EFFECTS;
use pam_virtual_bench::concealed::ConcealedError;
use pam_virtual_bench::parameters::ParameterError;
use pam_virtual_bench::protocol::{ALL, ProtocolError};
use pam_virtual_bench::sensors::Clock;
use pam_virtual_bench::{Bench, Options, Parameters, Protocol, TrueMuscle};

use crate::args::{self, Args};
use crate::muscle_file;
use crate::truth::Truth;

pub(crate) fn run(args: &Args) -> Result<Verdict> {
    let console = args.run.start()?;
    if args.list_protocols {
        list_protocols()?;
        return Ok(Verdict::Accepted);
    }
    if args.list_effects {
        list_effects()?;
        return Ok(Verdict::Accepted);
    }
    let (muscle, muscle_input) = muscle(args)?;
    let inputs = args.muscle.as_deref();
    let open = |path: &Path| -> Result<Output> { Ok(Output::open(path)?.apart_from(inputs)?) };
    let mut outputs = Vec::new();
    if let Some(path) = args.write_muscle.as_deref().filter(|_| !args.run.check) {
        let mut file = open(path)?;
        file.write_all(muscle_file::text(&muscle).as_bytes())?;
        outputs.push(file);
    }
    if let Some(name) = args.protocol.as_deref() {
        let protocol = protocol_named(name)?;
        let bench = bench(args, muscle, protocol)?;
        describe(&console, &bench);
        if args.run.check {
            return Ok(Verdict::Accepted);
        }
        let mut out = open(args.out.as_deref().context("--out is missing")?)?;
        let truth = args.truth.as_deref().map(open).transpose()?;
        bench.record(args.run.seed).write_csv(&mut out)?;
        outputs.push(out);
        if let Some(mut truth) = truth {
            let artifact = Truth::of(&bench, protocol, args, muscle_input);
            serde_json::to_writer_pretty(&mut truth, &artifact)?;
            writeln!(truth)?;
            outputs.push(truth);
        }
    }
    finish_all(outputs)?;
    Ok(Verdict::Accepted)
}

/// The table of protocols, on standard output.
fn list_protocols() -> Result<(), OutputError> {
    let lines: Vec<String> =
        ALL.into_iter().map(|Protocol { name, id, summary, .. }| format!("{name:<20}{id:<6}{summary}\n")).collect();
    pam_cli::write_file("-", lines.concat())
}

/// The table of effects, on standard output.
fn list_effects() -> Result<(), OutputError> {
    let lines: Vec<String> = EFFECTS.iter().map(|effect| format!("{:<28}{}\n", effect.id, effect.summary)).collect();
    pam_cli::write_file("-", lines.concat())
}

fn protocol_named(name: &str) -> Result<Protocol> {
    Protocol::named(name).map_err(|error| match nearest(name, ALL.map(|protocol| protocol.name)) {
        Some(nearest) => anyhow!("{error}; did you mean \"{nearest}\"?"),
        None => anyhow!("{error}; --list-protocols shows all"),
    })
}

/// The muscle: as in the file with nominal parameters, or at random; then as set. With the file that it is from.
fn muscle(args: &Args) -> Result<(TrueMuscle, Option<Input>)> {
    let mut input = None;
    let muscle = if let Some(seed) = args.random_muscle {
        TrueMuscle::random(seed)
    } else {
        let path = args.muscle.as_deref().context("--muscle is missing")?;
        let (file, text) = MuscleFile::read_with_text(path)?;
        let sha256 = sha256_hex(text.as_bytes());
        input = Some(Input { path: path.display().to_string(), sha256, role: InputRole::Muscle });
        let parameters = Parameters { strand_modulus_pa: file.strand_modulus_pa, ..Parameters::nominal() };
        TrueMuscle::new(file.muscle, file.strand_modulus_pa, parameters)
    };
    let parameters = parameters(args, muscle.parameters().clone())?;
    Ok((TrueMuscle::new(muscle.muscle().clone(), muscle.contact_modulus_pa(), parameters), input))
}

/// Parameters of the muscle, as set.
fn parameters(args: &Args, mut parameters: Parameters) -> Result<Parameters> {
    for (name, value) in &args.set {
        parameters.set(name, *value).map_err(|error| match &error {
            ParameterError::Unknown { name } => {
                let known = Parameters::NAMES.map(|(name, _)| name);
                match nearest(name, known) {
                    Some(nearest) => anyhow!("--set: {error}; did you mean \"{nearest}\"?"),
                    None => anyhow!("--set: {error}; it has {}", known.join(", ")),
                }
            }
            ParameterError::OutOfRange { .. } => anyhow!("--set: {error}"),
        })?;
    }
    Ok(parameters)
}

fn bench(args: &Args, muscle: TrueMuscle, protocol: Protocol) -> Result<Bench> {
    let options = Options {
        seed: args.run.seed,
        duration_scale: args.duration_scale,
        highest_pressure_pa: args.highest_pressure * 1e3,
        lowest_tension_n: args.lowest_tension,
    };
    let command = protocol.command(&muscle, &options).map_err(|error| {
        let option = match &error {
            ProtocolError::DurationScale { .. } => "--duration-scale: ",
            ProtocolError::HighestPressure { .. } => "--highest-pressure: ",
            _ => "",
        };
        anyhow!("{option}{error}")
    })?;
    let bench = Bench::new(muscle, command)
        .with_effects(&args.effect, args.effect_seed.unwrap_or(args.run.seed))
        .map_err(|error| match &error {
            ConcealedError::Unknown { id } => match nearest(id, EFFECTS.iter().map(|effect| effect.id)) {
                Some(nearest) => anyhow!("--effect: {error}; did you mean \"{nearest}\"?"),
                None => anyhow!("--effect: {error}; --list-effects shows all"),
            },
            _ => anyhow!("--effect: {error}"),
        })?
        .with_smooth_misfit(args.smooth_misfit_n)
        .map_err(|error| anyhow!("--smooth-misfit-n: {error}"))?;
    let mut sensors = bench.sensors().clone().with_noise_times(args.noise);
    sensors.force_n.noise_correlation = args.force_noise_correlation;
    if let Some(noise_rms) = args.force_noise_n {
        sensors.force_n.noise_rms = noise_rms;
    }
    sensors.clock = match args.clock {
        args::Clock::Ideal => Clock::Ideal,
        args::Clock::Ms => Clock::Milliseconds,
    };
    let run = bench.with_sensors(sensors).and_then(|bench| bench.at_rate(args.rate));
    run.map_err(|error| match &error {
        BenchError::Noise { channel: "force", .. } if args.force_noise_n.is_some() => {
            anyhow!("--force-noise-n: {error}")
        }
        BenchError::ColoredShare { .. } => anyhow!("{error}"),
        BenchError::Noise { .. } => anyhow!("--noise {}: {error}", args.noise),
        BenchError::Correlation { .. } => anyhow!("--force-noise-correlation: {error}"),
        BenchError::Rate { .. } | BenchError::Rows { .. } => anyhow!("--rate: {error}"),
    })
}

/// One line: what will be recorded.
fn describe(console: &Console, bench: &Bench) {
    let (lowest_pa, highest_pa) = bench.command().pressure_range_pa();
    let (shortest_m, longest_m) = bench.command().length_range_m();
    let logged_s = bench.command().logged_s();
    console.note(format!(
        "{}: {:.0} s, about {:.0} rows, {:.0} to {:.0} kPa, {:.1} to {:.1} mm",
        bench.command().protocol,
        logged_s,
        logged_s * bench.rate_hz(),
        lowest_pa * 1e-3,
        highest_pa * 1e-3,
        shortest_m * 1e3,
        longest_m * 1e3,
    ));
}
