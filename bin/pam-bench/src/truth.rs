//! `pam-bench-truth/1`: what stands behind a log of the bench and no logger sees.

use pam_artifact::{Input, Tool};
use pam_muscle::Muscle;
use pam_virtual_bench::draw::{DrawnParameter, Place};
use pam_virtual_bench::sensors::{Channel, Clock, Sensors};
use pam_virtual_bench::{Bench, ConcealedEffect, Parameters, Protocol};
#[cfg(test)]
use schemars::JsonSchema;
use serde::Serialize;

use crate::args::Args;

/// Schema name and version.
const SCHEMA: &str = "pam-bench-truth/1";

/// The truth behind a log.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct Truth {
    /// `pam-bench-truth/1`.
    #[cfg_attr(test, schemars(extend("const" = SCHEMA)))]
    schema: &'static str,
    /// Program that wrote it.
    tool: Tool,
    /// The muscle file, if there is one.
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
    /// What is concealed.
    effects: Vec<EffectEntry>,
    /// Sensors of the rig.
    sensors: Vec<SensorEntry>,
}

/// Options that the bench was run with.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
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
    /// Seed from which the muscle was drawn; none where it comes from a file.
    random_muscle: Option<u64>,
    /// Seed of the inner parameters of effects and misfit.
    effect_seed: u64,
    /// Smooth error of the form, root mean square over all pressures and contractions of the protocols, in N.
    smooth_misfit_n: f64,
    /// Sampling rate, in Hz.
    rate_hz: f64,
    /// Clock of the logger: `ideal` or `ms`.
    clock: &'static str,
}

/// A parameter of the muscle.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
struct TrueParameter {
    /// Name, as in a model.
    name: &'static str,
    /// Value.
    value: f64,
    /// Unit; `1` where it has none.
    unit: &'static str,
}

/// A concealed effect.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
struct EffectEntry {
    /// Id, as a diagnosis names it.
    id: &'static str,
    /// How strong; 1 is typical.
    severity: f64,
    /// Inner parameters as drawn, in SI.
    parameters: Vec<TrueParameter>,
    /// Where it shows, if it lives in a region.
    place: Option<PlaceEntry>,
}

/// A region.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
struct PlaceEntry {
    /// `time`, `pressure`, `contraction`, `speed`, `travel_since_reversal`, `time_since_last_move`, `cycle` or `force`.
    coordinate: &'static str,
    /// Where it begins, in SI.
    from: f64,
    /// Where it ends, in SI.
    to: f64,
    /// Unit; `1` where it has none.
    unit: &'static str,
}

impl EffectEntry {
    fn of(effect: &ConcealedEffect) -> Self {
        let ConcealedEffect { id, severity, parameters, place } = effect;
        Self {
            id,
            severity: *severity,
            parameters: parameters
                .iter()
                .map(|DrawnParameter { name, value, unit }| TrueParameter { name, value: *value, unit })
                .collect(),
            place: place.as_ref().map(|Place { coordinate, from, to, unit }| PlaceEntry {
                coordinate,
                from: *from,
                to: *to,
                unit,
            }),
        }
    }
}

/// One channel of the logger.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
struct SensorEntry {
    /// Column of the log.
    column: &'static str,
    /// Standard deviation of the noise, in the unit of the column.
    noise_rms: f64,
    /// Share of the colored noise that remains after 5 ms.
    noise_correlation: f64,
    /// Share of the variance that is colored.
    colored_share: f64,
    /// Step of the converter.
    step: f64,
    /// Lowest value that the converter can tell.
    lowest: f64,
    /// Highest value that the converter can tell.
    highest: f64,
}

impl SensorEntry {
    fn of(column: &'static str, channel: &Channel) -> Self {
        let Channel { noise_rms, noise_correlation, colored_share, lowest, highest, .. } = *channel;
        Self { column, noise_rms, noise_correlation, colored_share, step: channel.step(), lowest, highest }
    }
}

impl Truth {
    /// The truth behind what `bench` records; `muscle_file` where the muscle is from one.
    pub(crate) fn of(bench: &Bench, protocol: Protocol, args: &Args, muscle_file: Option<Input>) -> Self {
        let muscle = bench.muscle();
        let Sensors { pressure_kpa, length_mm, force_n, clock } = bench.sensors();
        let parameters = Parameters::NAMES.into_iter().zip(muscle.parameters().values());
        Self {
            schema: SCHEMA,
            tool: Tool { name: env!("CARGO_PKG_NAME").to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
            inputs: muscle_file.into_iter().collect(),
            config: BenchConfig {
                protocol: protocol.name,
                protocol_id: protocol.id,
                duration_scale: args.duration_scale,
                highest_pressure_pa: args.highest_pressure * 1e3,
                lowest_tension_n: Some(args.lowest_tension).filter(|tension| tension.is_finite()),
                random_muscle: args.random_muscle,
                effect_seed: bench.effect_seed(),
                smooth_misfit_n: bench.smooth_misfit_n(),
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
            effects: bench.effects().iter().map(EffectEntry::of).collect(),
            sensors: vec![
                SensorEntry::of("pressure_kPa", pressure_kpa),
                SensorEntry::of("length_mm", length_mm),
                SensorEntry::of("force_N", force_n),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_artifact::schemas;

    #[test]
    fn the_published_schema_is_that_of_the_truth() {
        let text = format!("{:#}\n", schemars::schema_for!(Truth).to_value());
        if std::env::var_os("PAM_WRITE_SCHEMAS").is_some() {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../crates/artifact/schemas/");
            std::fs::write(format!("{folder}pam-bench-truth-1.json"), text).expect("a writable folder");
        } else {
            assert!(schemas::BENCH_TRUTH == text, "the published schema is stale; run scripts/schemas");
        }
    }
}
