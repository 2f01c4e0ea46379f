//! The phases of an identification: `cargo bench -p pam-identification`.

use std::ops::ControlFlow;

use divan::{Bencher, black_box};
use pam_identification::condense::condense;
use pam_identification::fit::{FitOptions, search};
use pam_identification::prepare::{Prepared, direct, gate, thresholds};
use pam_identification::problem::ForceProblem;
use pam_identification::search_space::{Free, LATEX_RATIO, SearchSpace};
use pam_muscle::MuscleFile;
use pam_muscle::force::columns::ForceColumns;
use pam_muscle::force::{BaseParameters, Form, Parameter};
use pam_optim::swarm::{SwarmOptions, minimize};
use pam_recording::{Recording, Repairs, Samples};
use pam_virtual_bench::{Bench, Options, TrueMuscle, command};

fn main() {
    divan::main();
}

struct Setting {
    prepared: Vec<Prepared>,
    columns: ForceColumns,
    space: SearchSpace,
}

/// A multisine of `rows` rows and all eight parameters free.
fn setting(rows: usize) -> Setting {
    let muscle = TrueMuscle::nominal();
    let command = command("multisine", &muscle, &Options::default()).expect("a protocol of the bench");
    let rate_hz = rows as f64 / command.duration_s();
    let log = Bench::new(muscle.clone(), command).at_rate(rate_hz).expect("a rate").record(1);
    let recording = Recording {
        path: "multisine".to_owned(),
        sha256: String::new(),
        samples: Samples::from_columns(&log.time_s, &log.pressure_pa, &log.length_m, &log.force_n),
        segments: std::iter::once(0..log.time_s.len()).collect(),
        repairs: Repairs::default(),
        ignored_columns: Vec::new(),
    };
    let file = MuscleFile {
        name: None,
        muscle: muscle.muscle().clone(),
        fit: Vec::new(),
        strand_modulus_pa: muscle.contact_modulus_pa(),
    };
    let gates = gate(vec![recording]).expect("samples in memory");
    let largest = gates[0].quality.largest_pressure_length_n_per_m;
    let thresholds = thresholds(&gates, &file.muscle);
    let prepared = direct(gates, thresholds, Form::Corrected).expect("samples in memory");
    let columns = ForceColumns::new(&file.muscle, file.strand_modulus_pa, Form::Corrected, largest);
    let free: Vec<Free> = Parameter::ALL.into_iter().map(Free::One).collect();
    let ranges = free.iter().map(|free| free.ranges(file.strand_modulus_pa).search).collect();
    let held = BaseParameters { theta: [0.0; 8] };
    Setting { prepared, columns, space: SearchSpace { free, ranges, held, bladder_ratio: LATEX_RATIO } }
}

/// 60 particles, 200 moves, eight parameters: one swarm, no polish.
#[divan::bench(args = [20_000, 200_000])]
fn swarm_of_60_by_200(bencher: Bencher<'_, '_>, rows: usize) {
    let setting = setting(rows);
    let condensed = condense(&setting.prepared, &setting.columns, 1, None).expect("samples in memory");
    let problem =
        ForceProblem { summary: &condensed.total, columns: &setting.columns, space: &setting.space, steps: &[] };
    let axes = problem.round_axes(&[0.5; 8]);
    let options = SwarmOptions { n_particles: 60, n_iterations: 200, seed: 1, start: 0 };
    bencher.bench_local(|| {
        minimize(8, axes.as_ref(), &options, &mut |x| problem.mean_square(x), &mut |_, _| ControlFlow::Continue(()))
    });
}

/// Four swarms with their polish, as the program runs them.
#[divan::bench]
fn search_of_four_starts(bencher: Bencher<'_, '_>) {
    let setting = setting(20_000);
    let condensed = condense(&setting.prepared, &setting.columns, 1, None).expect("samples in memory");
    let problem =
        ForceProblem { summary: &condensed.total, columns: &setting.columns, space: &setting.space, steps: &[] };
    bencher.bench_local(|| search(black_box(&problem), &FitOptions::default(), &|| {}));
}

/// The one pass over the rows.
#[divan::bench(args = [20_000, 200_000])]
fn condense_rows(bencher: Bencher<'_, '_>, rows: usize) {
    let setting = setting(rows);
    bencher.bench_local(|| condense(&setting.prepared, &setting.columns, 1, None));
}
