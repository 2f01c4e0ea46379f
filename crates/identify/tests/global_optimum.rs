//! Whatever the seed, the search ends at the least-squares optimum.

#![expect(clippy::print_stdout, clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use pam_identification::condense::{Condensed, condense};
use pam_identification::fit::{FitOptions, search};
use pam_identification::prepare::{direct, gate, thresholds};
use pam_identification::problem::ForceProblem;
use pam_identification::search_space::{Free, LATEX_RATIO, SearchSpace};
use pam_muscle::MuscleFile;
use pam_muscle::force::columns::ForceColumns;
use pam_muscle::force::{BaseParameters, Form, Parameter};
use pam_optim::polish::descend;
use pam_recording::{ReadOptions, read_recording};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

const SEEDS: u64 = 100;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The shipped estimation recordings, and all eight parameters free: the hardest search there is.
fn shipped() -> (Condensed, ForceColumns, SearchSpace) {
    let file = MuscleFile::read(&root().join("configs/muscle-nominal.toml")).unwrap();
    let recordings = ["isobaric-triangles", "isometric-ramps", "minor-loops", "length-steps"]
        .iter()
        .map(|name| {
            let path = root().join(format!("datasets/bench-nominal/{name}.csv"));
            read_recording(&path, &ReadOptions::default()).unwrap()
        })
        .collect();
    let gates = gate(recordings).unwrap();
    let largest = gates.iter().map(|gate| gate.quality.largest_pressure_length_n_per_m).fold(0.0, f64::max);
    let thresholds = thresholds(&gates, &file.muscle);
    let prepared = direct(gates, thresholds, Form::Corrected).unwrap();
    let columns = ForceColumns::new(&file.muscle, file.strand_modulus_pa, Form::Corrected, largest);
    let condensed = condense(&prepared, &columns, 1, None).unwrap();
    let free: Vec<Free> = Parameter::ALL.into_iter().map(Free::One).collect();
    let ranges = free
        .iter()
        .map(|free| {
            let (low, high) = free.ranges(file.strand_modulus_pa).search;
            let stiff = *free == Free::One(Parameter::StrandCompliance);
            (low, if stiff { high.min(columns.max_compliance_per_pa()) } else { high })
        })
        .collect();
    let held = BaseParameters { theta: [0.0; 8] };
    (condensed, columns, SearchSpace { free, ranges, held, bladder_ratio: LATEX_RATIO })
}

#[test]
fn every_seed_ends_at_the_optimum() {
    let (condensed, columns, space) = shipped();
    let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
    // The optimum by another way: descents from a thousand random places, no swarm.
    let mut generator = rand_pcg::Pcg64::seed_from_u64(42);
    let places: Vec<Vec<f64>> = (0..1000).map(|_| (0..8).map(|_| generator.random()).collect()).collect();
    let optimum = places.par_iter().map(|place| 2.0 * descend(&problem, place).cost).reduce(|| f64::INFINITY, f64::min);
    let results: Vec<(f64, f64)> = (1..=SEEDS)
        .into_par_iter()
        .map(|seed| {
            let options = FitOptions { n_starts: 1, seed, ..FitOptions::default() };
            let alone = search(&problem, &FitOptions { polish: false, ..options }, &|| {});
            let polished = search(&problem, &options, &|| {});
            (alone.mean_square / optimum - 1.0, polished.mean_square / optimum - 1.0)
        })
        .collect();
    let swarms = results.iter().filter(|(swarm, _)| *swarm <= 1e-2).count();
    let polished = results.iter().filter(|(_, polished)| *polished <= 1e-6).count();
    let worst_swarm = results.iter().map(|(swarm, _)| *swarm).fold(0.0, f64::max);
    let worst_polished = results.iter().map(|(_, polished)| *polished).fold(f64::NEG_INFINITY, f64::max);
    println!(
        "optimum {:.6} N RMSE; swarm alone within 1e-2: {swarms} of {SEEDS} (worst {worst_swarm:.1e}); polished within 1e-6: \
         {polished} of {SEEDS} (worst {worst_polished:.1e})",
        optimum.sqrt()
    );
    assert!(swarms >= 95, "swarm alone: {swarms} of {SEEDS}");
    assert_eq!(polished, SEEDS as usize);
}

#[test]
fn a_swarm_stops_once_it_has_settled_unless_no_descent_follows() {
    let (condensed, columns, space) = shipped();
    let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
    for polish in [true, false] {
        let n_observed = AtomicUsize::new(0);
        let options = FitOptions { polish, ..FitOptions::default() };
        let fit = search(&problem, &options, &|| {
            n_observed.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(n_observed.into_inner(), options.n_starts * options.n_iterations);
        for start in &fit.starts {
            assert_eq!(start.swarm.history.len() == options.n_iterations + 1, !polish);
        }
    }
}

#[test]
fn the_result_has_the_same_bytes_on_one_thread_and_on_three() {
    let (condensed, columns, space) = shipped();
    let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (condensed, columns, space) = shipped();
            let problem = ForceProblem { summary: &condensed.total, columns: &columns, space: &space, steps: &[] };
            search(&problem, &FitOptions::default(), &|| {}).x
        })
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one, three);
    assert_eq!(one, search(&problem, &FitOptions::default(), &|| {}).x);
}
