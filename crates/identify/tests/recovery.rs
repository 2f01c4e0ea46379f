//! Known parameters come back from the virtual bench within their stated uncertainty.
//!
//! The bench integrates ten times finer than it logs and computes forces from stored energies, so that
//! nothing but the physics is shared with the fit.

#![expect(clippy::print_stdout, clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use pam_artifact::Tool;
use pam_artifact::model::{Assumed, BladderLaw, FrictionLaw, ModelArtifact};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_identification::search_space::LATEX_RATIO;
use pam_muscle::MuscleFile;
use pam_recording::{Recording, Repairs, Samples};
use pam_virtual_bench::{Bench, Options, Parameters, TrueMuscle, command};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Runs at each of two noise levels.
const RUNS: u64 = 100;
/// Runs with each load cell of few bits.
const RUNS_OF_FEW_BITS: u64 = 40;

/// Times the usual noise of every channel, and bits of the load cell.
type Sensing = (f64, u32);

fn random_muscle(seed: u64) -> TrueMuscle {
    let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut draw = |low: f64, high: f64| generator.random_range(low..high);
    let nominal = TrueMuscle::nominal();
    let bladder_pa = draw(120e3, 350e3);
    let parameters = Parameters {
        k1: draw(0.78, 1.02),
        k2: draw(1.0, 1.22),
        k3_n: draw(-4.0, 4.0),
        c10_pa: bladder_pa / (1.0 + LATEX_RATIO),
        c01_pa: bladder_pa * LATEX_RATIO / (1.0 + LATEX_RATIO),
        strand_modulus_pa: draw(2e9, 6e9),
        rubber_friction: draw(0.7e-3, 3e-3),
        strand_friction: 0.0,
    };
    TrueMuscle::new(nominal.muscle().clone(), nominal.contact_modulus_pa(), parameters)
}

fn record(
    muscle: &TrueMuscle,
    protocol: &str,
    duration_scale: f64,
    seed: u64,
    (noise, force_bits): Sensing,
) -> Recording {
    let options = Options { duration_scale, seed, ..Options::default() };
    let command = command(protocol, muscle, &options).unwrap();
    let bench = Bench::new(muscle.clone(), command).at_rate(100.0).unwrap();
    let mut sensors = bench.sensors().clone().with_noise_times(noise);
    sensors.force_n.bits = force_bits;
    let log = bench.with_sensors(sensors).unwrap().record(seed);
    let period_s = log.time_s[1] - log.time_s[0];
    let mut segments = Vec::new();
    let mut start = 0;
    for row in 1..log.time_s.len() {
        if log.time_s[row] - log.time_s[row - 1] > 10.0 * period_s {
            segments.push(start..row);
            start = row;
        }
    }
    segments.push(start..log.time_s.len());
    Recording {
        path: protocol.to_owned(),
        sha256: String::new(),
        samples: Samples::from_columns(&log.time_s, &log.pressure_pa, &log.length_m, &log.force_n),
        segments,
        repairs: Repairs::default(),
        ignored_columns: Vec::new(),
    }
}

fn identify(muscle: &TrueMuscle, seed: u64, sensing: Sensing) -> ModelArtifact {
    // Short, but with loops that a logger of 100 Hz still resolves.
    let protocols = [("isobaric-triangles", 0.12), ("isometric-ramps", 0.12), ("minor-loops", 0.7)];
    let estimation = protocols
        .iter()
        .zip(0..)
        .map(|(&(name, scale), n)| record(muscle, name, scale, 10 * seed + n, sensing))
        .collect();
    let file = MuscleFile {
        name: None,
        muscle: muscle.muscle().clone(),
        fit: Vec::new(),
        strand_modulus_pa: muscle.contact_modulus_pa(),
    };
    let options = FitOptions { n_starts: 1, seed, ..FitOptions::default() };
    let checked = check(Request {
        // The bench's muscles have rubber of one share and one friction; what is free beside would share their errors.
        assumed: Assumed { bladder: Some(BladderLaw::Shared), friction: Some(FrictionLaw::Rubber), standstill: None },
        ..Request::of(estimation, file, options)
    })
    .unwrap();
    let config = checked.config();
    let tool = Tool { name: "test".to_owned(), version: String::new() };
    checked.identify().unwrap().artifact(tool, Vec::new(), config, seed)
}

/// Distance of each identifiable parameter or composite from the truth, in standard errors.
fn distances(artifact: &ModelArtifact, truth: &Parameters) -> Vec<(&'static str, f64)> {
    let entry = |name: &str| {
        let entry = artifact.parameters.iter().find(|entry| entry.name == name).unwrap();
        (entry.value, entry.stderr)
    };
    let composite = |name: &str| {
        let entry = artifact.composites.iter().find(|entry| entry.name.starts_with(name)).unwrap();
        (entry.value, entry.stderr)
    };
    let distance = |(value, stderr): (f64, Option<f64>), truth: f64| (value - truth) / stderr.unwrap();
    vec![
        ("k1", distance(entry("k1"), truth.k1)),
        ("k2", distance(entry("k2"), truth.k2)),
        ("k3", distance(entry("k3"), truth.k3_n)),
        ("c10 + c01", distance(composite("c10 + c01"), truth.c10_pa + truth.c01_pa)),
        ("strand_modulus", distance(entry("strand_modulus"), truth.strand_modulus_pa)),
        ("rubber_friction", distance(composite("rubber_friction"), truth.rubber_friction)),
    ]
}

/// Distances of every parameter over `n_runs`, and the RMSE over the noise floor of the run in which it is largest.
fn runs(n_runs: u64, sensing: Sensing) -> (Vec<(&'static str, Vec<f64>)>, f64) {
    let runs: Vec<(Vec<(&'static str, f64)>, f64)> = (1..=n_runs)
        .into_par_iter()
        .map(|seed| {
            let muscle = random_muscle(seed);
            let artifact = identify(&muscle, seed, sensing);
            let ratio = artifact.fit.estimation.rmse_n / artifact.fit.noise_floor_n;
            (distances(&artifact, muscle.parameters()), ratio)
        })
        .collect();
    let each = (0..runs[0].0.len())
        .map(|index| (runs[0].0[index].0, runs.iter().map(|(distances, _)| distances[index].1).collect()))
        .collect();
    (each, runs.iter().map(|(_, ratio)| *ratio).fold(0.0, f64::max))
}

fn within_three_standard_errors(n_runs: u64, sensing: Sensing, most_over_floor: f64) {
    let (noise, bits) = sensing;
    let (each, worst) = runs(n_runs, sensing);
    for (name, values) in each {
        let within = values.iter().filter(|distance| distance.abs() <= 3.0).count();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let spread = (values.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt();
        println!(
            "noise x {noise}, {bits} bits, {name}: within 3 s.e. {within} of {n_runs}; mean {mean:.2}, spread {spread:.2}"
        );
        assert!(within as f64 >= 0.97 * n, "{name} at noise x {noise}, {bits} bits: {within} of {n_runs}");
    }
    println!("noise x {noise}, {bits} bits: RMSE at most {worst:.3} times the noise floor");
    assert!(worst <= most_over_floor, "RMSE {worst} times the noise floor");
}

#[test]
fn known_parameters_come_back_within_three_standard_errors() {
    for noise in [0.5, 1.0] {
        within_three_standard_errors(RUNS, (noise, 16), 1.05);
    }
}

/// A step of some newtons is several times what the load cell's own noise is; printed in whole newtons it is not their
/// multiple, and the rounding of what is printed comes on top of a step of two newtons.
#[test]
fn the_steps_of_a_load_cell_of_few_bits_are_in_floor_and_standard_errors() {
    for bits in [8, 9, 10] {
        within_three_standard_errors(RUNS_OF_FEW_BITS, (0.5, bits), 1.1);
    }
}
