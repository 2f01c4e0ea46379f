//! Recording and model in, recording with two more columns out.

use std::io::Write as _;

use anyhow::{Context as _, ensure};
use pam_cli::{Output, Verdict};
use pam_core::artifact::ModelArtifact;
use pam_core::recording::{ReadOptions, read_recording};
use pam_identification::evaluate::evaluate;
use pam_identification::predict::{forces_n, outside, prepare};
use pam_identification::prepare::Prepared;

use crate::args::Args;

pub(crate) fn run(args: &Args) -> anyhow::Result<Verdict> {
    let console = args.run.start()?;
    let inputs = [&args.log, &args.model];
    let out = match args.out.as_deref().filter(|_| !args.run.check) {
        Some(path) => Some(Output::open(path)?.apart_from(inputs)?),
        None => None,
    };
    let (artifact, _) = ModelArtifact::read(&args.model)?;
    let options = ReadOptions { force_required: false, ..args.read.options() };
    let recording = read_recording(&args.log, &options)?;
    for note in recording.repairs.notes() {
        console.warn(format!("{}: {note}", recording.path));
    }
    ensure!(
        args.max_rmse_n.is_none() || recording.samples.has_force(),
        "{}: no force was recorded, so --max-rmse-n has nothing to judge",
        recording.path
    );
    let prepared = prepare(recording, &artifact)?;
    for words in outside(&prepared, &artifact.domain) {
        console.warn(words);
    }
    let model = artifact.force_model();
    if let Some(mut out) = out {
        let path = out.path().display().to_string();
        write(&mut out, &prepared, &model).with_context(|| format!("cannot write {path}"))?;
        out.finish()?;
        if path != "-" {
            console.note(format!("wrote {path}"));
        }
    }
    if !prepared.recording.samples.has_force() {
        return Ok(Verdict::Accepted);
    }
    let evaluation = evaluate(std::slice::from_ref(&prepared), &model)?;
    let statistics = evaluation.each[0];
    console.note(format!(
        "RMSE {:.3} N, largest {:.1} N, fit {:.2} % over {} samples ({} at reversals left out)",
        statistics.rmse_n, statistics.max_n, statistics.fit_percent, statistics.n_samples, statistics.n_unsettled
    ));
    if let Some(limit) = args.max_rmse_n.filter(|&limit| statistics.rmse_n > limit) {
        console.warn(format!("rejected: RMSE {:.3} N is above --max-rmse-n {limit}", statistics.rmse_n));
        return Ok(Verdict::Rejected);
    }
    Ok(Verdict::Accepted)
}

/// Decimals are those of a good sensor: 1 µs, 0.1 Pa, 0.1 µm, 0.1 mN.
fn write(out: &mut Output, prepared: &Prepared, model: &pam_core::force::ForceModel) -> anyhow::Result<()> {
    let samples = &prepared.recording.samples;
    let mut header = "time_s,pressure_kPa,length_mm".to_owned();
    if samples.has_force() {
        header.push_str(",force_N");
    }
    if samples.has_temperature() {
        header.push_str(",temperature_C");
    }
    header.push_str(if samples.has_force() { ",force_model_N,residual_N" } else { ",force_model_N" });
    writeln!(out, "{header}")?;
    for chunk in samples.chunks() {
        let chunk = chunk?;
        let model_n = forces_n(prepared, model, &chunk);
        for (row, &model_n) in model_n.iter().enumerate() {
            let (time_s, pressure_kpa, length_mm) =
                (chunk.time_s()[row], chunk.pressure_pa()[row] * 1e-3, chunk.length_m()[row] * 1e3);
            write!(out, "{time_s:.6},{pressure_kpa:.4},{length_mm:.4}")?;
            if samples.has_force() {
                write!(out, ",{:.4}", chunk.force_n()[row])?;
            }
            if samples.has_temperature() {
                write!(out, ",{:.3}", chunk.temperature_k()[row] - 273.15)?;
            }
            write!(out, ",{model_n:.4}")?;
            if samples.has_force() {
                write!(out, ",{:.4}", chunk.force_n()[row] - model_n)?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
