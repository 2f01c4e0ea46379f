use super::*;
use crate::{Repairs, Samples};
use rand::{RngExt, SeedableRng};

/// A run of a bench: the same path, with noise of its own.
fn run(seed: u64, noise: f64) -> [Vec<f64>; 4] {
    let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut noisy = |value: f64, size: f64| value + noise * size * generator.random_range(-1.0..1.0);
    let time_s: Vec<f64> = (0..20_000).map(|row| 0.005 * f64::from(row)).collect();
    let pressure_pa = time_s.iter().map(|t| noisy(2.5e5 + 2e5 * (0.5 * t).sin(), 500.0)).collect();
    let length_m = time_s.iter().map(|t| noisy(0.24 + 0.02 * (0.3 * t).sin(), 3e-5)).collect();
    let force_n = time_s.iter().map(|t| noisy(400.0 + 300.0 * (0.5 * t).sin(), 0.5)).collect();
    [time_s, pressure_pa, length_m, force_n]
}

/// Those of its rows that `keep` keeps, as they come back from a file with so many digits of bar, inch and pound.
fn recording(columns: &[Vec<f64>; 4], keep: impl Fn(usize) -> bool, printed: bool) -> Recording {
    let through = |value: f64, unit: f64, digit: f64| {
        if printed { (value / unit / digit).round() * digit * unit } else { value }
    };
    let units = [(1.0, 1e-3), (1e5, 1e-3), (0.0254, 1e-3), (4.448_221_615, 1e-2)];
    let columns: Vec<Vec<f64>> = columns
        .iter()
        .zip(units)
        .map(|(column, (unit, digit))| {
            let kept = column.iter().enumerate().filter(|(row, _)| keep(*row));
            kept.map(|(_, &value)| through(value, unit, digit)).collect()
        })
        .collect();
    let samples = Samples::from_columns(&columns[0], &columns[1], &columns[2], &columns[3]);
    Recording {
        path: "r.csv".to_owned(),
        sha256: String::new(),
        segments: std::iter::once(0..samples.n_rows()).collect(),
        samples,
        repairs: Repairs::default(),
        ignored_columns: Vec::new(),
    }
}

fn shared(left: &Recording, right: &Recording) -> bool {
    let both = [share_samples(left, right).expect("in memory"), share_samples(right, left).expect("in memory")];
    assert_eq!(both[0], both[1], "the order says nothing");
    both[0]
}

#[test]
fn a_recording_is_known_in_other_units_cut_and_thinned_out() {
    let columns = run(1, 1.0);
    let whole = recording(&columns, |_| true, false);
    assert!(shared(&whole, &recording(&columns, |_| true, false)));
    assert!(shared(&whole, &recording(&columns, |_| true, true)), "units");
    assert!(shared(&whole, &recording(&columns, |row| (3_000..9_000).contains(&row), false)), "cut");
    assert!(shared(&whole, &recording(&columns, |row| row > 7_000, true)), "cut, units");
    assert!(shared(&whole, &recording(&columns, |row| row % 5 == 2, false)), "thinned out");
    assert!(shared(&whole, &recording(&columns, |row| row < 400, false)), "a short cut");
    let (early, late) = (recording(&columns, |row| row < 12_000, false), recording(&columns, |row| row > 8_000, false));
    assert!(shared(&early, &late), "two cuts that overlap");
}

#[test]
fn two_runs_that_stand_still_with_a_spike_now_and_then_are_two() {
    let still = |seed: u64| {
        let [time_s, pressure_pa, length_m, _] = run(1, 0.0);
        let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
        let force_n = pressure_pa.iter().map(|_| if generator.random_bool(0.1) { -8.0 } else { -8.7 }).collect();
        let [pressure_pa, length_m] = [pressure_pa, length_m].map(|column| vec![column[0]; column.len()]);
        recording(&[time_s, pressure_pa, length_m, force_n], |_| true, false)
    };
    assert!(!shared(&still(1), &still(2)));
}

#[test]
fn a_stretch_that_was_pasted_in_again_is_found_and_a_path_that_is_run_again_is_not() {
    let columns = run(1, 1.0);
    let again = |rows: std::ops::Range<usize>, at: usize| {
        let mut pasted = columns.clone();
        for (column, whole) in pasted.iter_mut().zip(&columns).skip(1) {
            column.splice(at..at, whole[rows.clone()].iter().copied());
        }
        pasted[0] = (0..pasted[1].len()).map(|row| 0.005 * row as f64).collect();
        repeats_itself(&recording(&pasted, |_| true, false)).unwrap()
    };
    let whole = again(0..20_000, 20_000).expect("appended once more");
    assert_eq!(whole.again - whole.row, 20_000);
    let part = again(4_000..9_000, 15_000).expect("pasted in");
    assert_eq!(part.again - part.row, 11_000, "the distance of the two places");
    assert_eq!(repeats_itself(&recording(&columns, |_| true, false)).unwrap(), None, "as it is");
    // Two cycles of 25 s, sampled at the same phases: with noise they are two, and without it nobody can tell.
    for noise in [0.0, 0.3] {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
        let mut cycles = run(2, 0.0);
        let turn = std::f64::consts::TAU / 5_000.0;
        let [_, pressure_pa, length_m, force_n] = &mut cycles;
        for (row, ((pressure_pa, length_m), force_n)) in pressure_pa.iter_mut().zip(length_m).zip(force_n).enumerate() {
            let phase = turn * (row % 5_000) as f64;
            let mut noisy = |value: f64, size: f64| value + noise * size * generator.random_range(-1.0..1.0);
            *pressure_pa = noisy(2.5e5 + 2e5 * phase.sin(), 500.0);
            *length_m = noisy(0.24 + 0.02 * phase.cos(), 3e-5);
            *force_n = noisy(400.0 + 300.0 * phase.sin(), 0.5);
        }
        assert_eq!(repeats_itself(&recording(&cycles, |_| true, false)).unwrap(), None, "noise {noise}");
    }
}

#[test]
fn another_run_of_the_same_path_shares_nothing() {
    for noise in [1.0, 0.1, 0.01] {
        let (one, other) = (run(1, noise), run(2, noise));
        assert!(!shared(&recording(&one, |_| true, false), &recording(&other, |_| true, false)), "{noise}");
        assert!(!shared(&recording(&one, |_| true, false), &recording(&other, |row| row < 5_000, true)), "{noise}");
    }
    let columns = run(1, 1.0);
    let halves = [recording(&columns, |row| row < 10_000, false), recording(&columns, |row| row >= 10_000, false)];
    assert!(!shared(&halves[0], &halves[1]), "two halves are two recordings");
}
