use super::*;
use std::path::Path;

use pam_muscle::MuscleFile;
use pam_muscle::direction::{Standstill, Thresholds};
use pam_muscle::force::{BaseParameters, ForceModel, Form};
use pam_recording::{Recording, Repairs, Samples};
use rand::{RngExt, SeedableRng};

use crate::prepare::{direct, gate};

/// A muscle shaken at 1 Hz whose force comes later than its pressure, by rows of 5 ms.
fn late_by(n_rows: usize) -> (Vec<Prepared>, ForceColumns) {
    shaken(n_rows, 0.005, 0.0)
}

/// The same with rows of `period_s` and a gauge with noise of up to `noise_pa`.
fn shaken(n_rows: usize, period_s: f64, noise_pa: f64) -> (Vec<Prepared>, ForceColumns) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs/muscle-nominal.toml");
    let muscle = MuscleFile::read(&path).unwrap().muscle;
    let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
    let model = ForceModel::new(&muscle, 3e9, Form::Corrected, parameters);
    let mut generator = rand_pcg::Pcg64::seed_from_u64(2);
    let time_s: Vec<f64> = (0..(20.0 / period_s) as usize).map(|row| period_s * row as f64).collect();
    let pressure_pa: Vec<f64> = time_s.iter().map(|t| 2.5e5 + 1e5 * (std::f64::consts::TAU * t).sin()).collect();
    let length_m: Vec<f64> = time_s.iter().map(|t| 0.24 + 0.01 * (0.7 * std::f64::consts::TAU * t).sin()).collect();
    let force_n: Vec<f64> = (0..time_s.len())
        .map(|row| {
            let noise_n = generator.random_range(-1.0..1.0);
            model.force_n(pressure_pa[row.saturating_sub(n_rows)], length_m[row], 0.0) + noise_n
        })
        .collect();
    let read_pa = if noise_pa > 0.0 { noise_pa } else { f64::MIN_POSITIVE };
    let pressure_pa: Vec<f64> =
        pressure_pa.iter().map(|pressure_pa| pressure_pa + generator.random_range(-read_pa..read_pa)).collect();
    let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
    let segments = vec![0..samples.n_rows(); 1];
    let (sha256, repairs) = (String::new(), Repairs::default());
    let recording =
        Recording { path: "shaken.csv".to_owned(), sha256, samples, segments, repairs, ignored_columns: Vec::new() };
    let thresholds =
        Thresholds { length_m: 1e-4, pressure_pa: 1e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };
    let prepared = direct(gate(vec![recording]).unwrap(), thresholds, Form::Corrected).unwrap();
    (prepared, ForceColumns::new(&muscle, 3e9, Form::Corrected, 3.5e5 * 0.25))
}

#[test]
fn a_force_that_comes_later_is_found_and_one_that_does_not_is_left_alone() {
    let (recordings, columns) = late_by(0);
    assert_eq!(find(&recordings, &columns).unwrap(), []);
    let (recordings, columns) = late_by(3);
    let lags = find(&recordings, &columns).unwrap();
    let pressure = lags.iter().find(|lag| lag.channel == "pressure").unwrap();
    assert!((pressure.force_later_s - 0.015).abs() < 5e-4, "{pressure:?}");
}

#[test]
fn the_first_look_decides_nothing_but_whether_there_is_a_second() {
    for n_rows in [0, 1, 2, 5, 9] {
        let (recordings, columns) = late_by(n_rows);
        let windows = fast_windows(&recordings, Shifted::Pressure).unwrap();
        let all_rows = find_one(&windows, &columns, Shifted::Pressure, 1, WORTH);
        let found = find(&recordings, &columns).unwrap().into_iter().find(|lag| lag.channel == "pressure");
        assert_eq!(found, all_rows, "{n_rows} rows later");
        assert_eq!(found.is_some(), n_rows > 0);
    }
}

#[test]
fn noise_of_the_gauge_is_no_lag() {
    // The noise of the gauge is most of what is not explained, and a mean of two samples has half of it.
    for period_s in [0.02, 0.01, 0.004] {
        let (recordings, columns) = shaken(0, period_s, 4e3);
        assert_eq!(find(&recordings, &columns).unwrap(), [], "{period_s} s");
    }
}

#[test]
fn a_fast_logger_is_late_by_what_it_is_late() {
    for (n_rows, period_s) in [(0, 2e-4), (75, 2e-4), (0, 5e-5), (300, 5e-5)] {
        let (recordings, columns) = shaken(n_rows, period_s, 100.0);
        let lags = find(&recordings, &columns).unwrap();
        let late_s = lags.iter().find(|lag| lag.channel == "pressure").map_or(0.0, |lag| lag.force_later_s);
        assert!((late_s - n_rows as f64 * period_s).abs() < 5e-4, "{n_rows} {period_s}: {lags:?}");
    }
}
