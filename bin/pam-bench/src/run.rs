//! Runs `pam-bench`.

use std::io::Write;
use std::process::ExitCode;

use anyhow::{Context, Result};
use pam_core::muscle::MuscleFile;
use pam_virtual_bench::sensors::Clock;
use pam_virtual_bench::parameters::Parameters;
use pam_virtual_bench::{Bench, Options, TrueMuscle, command, protocol};

use crate::args::{self, Args};

pub(crate) fn main(args: &Args) -> ExitCode {
    match run(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<()> {
    if args.list_protocols {
        for protocol in protocol::ALL {
            writeln!(std::io::stdout(), "{:<20}{:<6}{}", protocol.name, protocol.id, protocol.summary)?;
        }
        return Ok(());
    }
    let file = MuscleFile::read(args.muscle.as_deref().context("no muscle")?)?;
    let mut parameters = Parameters { strand_modulus_pa: file.strand_modulus_pa, ..Parameters::nominal() };
    for setting in &args.set {
        let (name, value) = setting.split_once('=').context("--set takes NAME=VALUE")?;
        parameters.set(name, value.parse().with_context(|| format!("--set {setting}"))?)?;
    }
    let muscle = TrueMuscle::new(file.muscle, file.strand_modulus_pa, parameters);
    let options = Options { seed: args.seed, duration_scale: args.duration_scale, ..Options::default() };
    let name = args.protocol.as_deref().context("no protocol")?;
    let bench = Bench::new(muscle.clone(), command(name, &muscle, &options)?);
    let mut sensors = bench.sensors().clone().with_noise_times(args.noise);
    if matches!(args.clock, args::Clock::Ms) {
        sensors.clock = Clock::Milliseconds;
    }
    let recording = bench.with_sensors(sensors)?.at_rate(args.rate)?.record(args.seed);
    let mut bytes = Vec::new();
    recording.write_csv(&mut bytes)?;
    let out = args.out.as_deref().context("no output")?;
    if out.as_os_str() == "-" {
        std::io::stdout().write_all(&bytes)?;
    } else {
        std::fs::write(out, bytes).with_context(|| format!("cannot write {}", out.display()))?;
    }
    Ok(())
}
