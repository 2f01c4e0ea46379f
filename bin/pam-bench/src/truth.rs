//! `pam-bench-truth/1`: what stands behind a log of the bench and no logger sees.

use std::path::Path;

use anyhow::Result;
use pam_core::artifact::{Input, InputRole, Tool, sha256_hex};
use pam_core::muscle::Muscle;
use pam_virtual_bench::sensors::{Channel, Clock, Sensors};
use pam_virtual_bench::{Bench, Parameters, Protocol};
use schemars::JsonSchema;
use serde::Serialize;

use crate::args::Args;

/// Schema name and version.
const SCHEMA: &str = "pam-bench-truth/1";

/// The truth behind a log.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Truth {
    /// `pam-bench-truth/1`.
    schema: &'static str,
    /// Program that wrote it.
    tool: Tool,
    /// The muscle file.
    inputs: Vec<Input>,
    /// Options as resolved.
    config: BenchConfig,
    /// Seed of noise and random phases.
    seed: u64,
    /// Dimensions of the muscle.
    geometry: Muscle,
    /// Modulus of the strands where they press on each other, in Pa.
    strand_modulus_pa: f64,
    /// Parameters of the muscle.
    parameters: Vec<TrueParameter>,
    /// Sensors of the rig.
    sensors: Vec<SensorEntry>,
}

/// Options that the bench was run with.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BenchConfig {
    /// Name of the protocol.
    protocol: &'static str,
    /// Its number in the catalogue of bench protocols.
    protocol_id: &'static str,
    /// Duration relative to the catalogue.
    duration_scale: f64,
    /// Highest pressure, in Pa.
    highest_pressure_pa: f64,
    /// Lowest tension that the contracting muscle was taken to, in N; none where it may hang slack.
    lowest_tension_n: Option<f64>,
    /// Sampling rate, in Hz.
    rate_hz: f64,
    /// Clock of the logger: `ideal` or `ms`.
    clock: &'static str,
}

/// A parameter of the muscle.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TrueParameter {
    /// Name, as in a model.
    name: &'static str,
    /// Value.
    value: f64,
    /// Unit; `1` where it has none.
    unit: &'static str,
}

/// One channel of the logger.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SensorEntry {
    /// Column of the log.
    column: &'static str,
    /// Standard deviation of the noise, in the unit of the column.
    noise_rms: f64,
    /// Share of the noise that remains after 5 ms.
    noise_correlation: f64,
    /// Step of the converter.
    step: f64,
    /// Lowest value that the converter can tell.
    lowest: f64,
    /// Highest value that the converter can tell.
    highest: f64,
}

impl SensorEntry {
    fn of(column: &'static str, channel: &Channel) -> Self {
        let Channel { noise_rms, noise_correlation, lowest, highest, .. } = *channel;
        Self { column, noise_rms, noise_correlation, step: channel.step(), lowest, highest }
    }
}

impl Truth {
    /// The truth behind what `bench` records.
    pub(crate) fn of(bench: &Bench, protocol: Protocol, args: &Args, muscle_file: &Path) -> Result<Self> {
        let muscle = bench.muscle();
        let Sensors { pressure_kpa, length_mm, force_n, clock } = bench.sensors();
        let parameters = Parameters::NAMES.into_iter().zip(muscle.parameters().values());
        Ok(Self {
            schema: SCHEMA,
            tool: Tool { name: env!("CARGO_PKG_NAME").to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
            inputs: vec![Input {
                path: muscle_file.display().to_string(),
                sha256: sha256_hex(&std::fs::read(muscle_file)?),
                role: InputRole::Muscle,
            }],
            config: BenchConfig {
                protocol: protocol.name,
                protocol_id: protocol.id,
                duration_scale: args.duration_scale,
                highest_pressure_pa: args.highest_pressure * 1e3,
                lowest_tension_n: Some(args.lowest_tension).filter(|tension| tension.is_finite()),
                rate_hz: args.rate,
                clock: match clock {
                    Clock::Ideal => "ideal",
                    Clock::Milliseconds => "ms",
                },
            },
            seed: args.run.seed,
            geometry: muscle.muscle().clone(),
            strand_modulus_pa: muscle.contact_modulus_pa(),
            parameters: parameters.map(|((name, unit), value)| TrueParameter { name, value, unit }).collect(),
            sensors: vec![
                SensorEntry::of("pressure_kPa", pressure_kpa),
                SensorEntry::of("length_mm", length_mm),
                SensorEntry::of("force_N", force_n),
            ],
        })
    }
}
