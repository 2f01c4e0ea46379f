use super::*;

use pam_recording::{Repairs, Samples};

fn runs(values: &[f64]) -> Option<(f64, usize, usize)> {
    let (lowest, highest) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
    let mut runs = Runs { lowest, highest, value: f64::NAN, ..Runs::default() };
    values.iter().enumerate().for_each(|(row, &value)| runs.push(row, value));
    runs.close();
    runs.frozen()
}

fn noisy(row: usize) -> f64 {
    300.0 * (0.01 * row as f64).sin() + (row * 7919 % 101) as f64 * 0.1
}

#[test]
fn a_channel_that_flickers_and_then_stands_is_frozen_and_one_that_rests_is_not() {
    let frozen: Vec<f64> = (0..2000).map(|row| noisy(row.min(1200))).collect();
    assert_eq!(runs(&frozen), Some((noisy(1200), 1200, 800)));
    let alive: Vec<f64> = (0..2000).map(noisy).collect();
    assert_eq!(runs(&alive), None);
    // At the end of the range it is a sensor out of range.
    let clipped: Vec<f64> = (0..2000).map(|row| noisy(row).min(200.0)).collect();
    assert_eq!(runs(&clipped), None);
    // A path without noise may rest, and so may a channel with coarse steps.
    let smooth: Vec<f64> = (0..2000).map(|row| (0.003 * row.clamp(300, 900) as f64).sin()).collect();
    assert_eq!(runs(&smooth), None);
    let coarse: Vec<f64> = (0..2000).map(|row| (noisy(row.min(500)) / 40.0).round()).collect();
    assert_eq!(runs(&coarse), None);
}

/// A muscle pulled slowly to and fro at a pressure that a valve changes and then leaves; one channel shows one value along
/// `stands`.
fn shaken(channel: usize, stands: &Range<usize>) -> Recording {
    let model = crate::testing::model();
    let time_s: Vec<f64> = (0..8000).map(|row| 0.01 * f64::from(row)).collect();
    let rested_pa = |t: f64| if (50.0..54.0).contains(&t) { 2.5e5 } else { 2.5e5 + 1e5 * (1.1 * t).sin() };
    let mut columns = [time_s.iter().map(|t| rested_pa(*t)).collect::<Vec<f64>>(), Vec::new(), Vec::new()];
    columns[1] = time_s.iter().map(|t| 0.24 + 0.015 * (0.7 * t).sin()).collect();
    columns[2] = (0..time_s.len())
        .map(|row| {
            let direction = if (0.7 * time_s[row]).cos() > 0.0 { -1.0 } else { 1.0 };
            model.force_n(columns[0][row], columns[1][row], direction)
        })
        .collect();
    let flicker = [3e3, 1e-4, 3.0];
    for (column, flicker) in columns.iter_mut().zip(flicker) {
        column.iter_mut().enumerate().for_each(|(row, value)| *value += flicker * (row * 7919 % 101) as f64 / 101.0);
    }
    let value = columns[channel][stands.start];
    columns[channel][stands.clone()].fill(value);
    let samples = Samples::from_columns(&time_s, &columns[0], &columns[1], &columns[2]);
    let segments = vec![0..samples.n_rows(); 1];
    let (sha256, repairs) = (String::new(), Repairs::default());
    Recording { path: "shaken.csv".to_owned(), sha256, samples, segments, repairs, ignored_columns: Vec::new() }
}

#[test]
fn a_valve_that_rests_did_not_freeze_and_a_channel_that_the_others_leave_behind_did() {
    // The pressure does stand still for a while, and its gauge shows it.
    let rests = find(&shaken(0, &(5000..5400))).unwrap();
    assert!(rests.is_none(), "{rests:?}");
    for (channel, name) in ["pressure", "length", "force"].into_iter().enumerate() {
        for stands in [2000..2300, 4000..8000] {
            let Some(Fault::Frozen { channel: found, rows, .. }) = find(&shaken(channel, &stands)).unwrap() else {
                panic!("{name} along {stands:?}");
            };
            assert_eq!((found, rows), (name, stands.len()));
        }
    }
}

#[test]
fn a_load_cell_whose_plug_came_off_reads_zero_and_a_slack_muscle_does_so_too() {
    let model = crate::testing::model();
    // Pulled to and fro and now and then vented; from `off` on the load cell shows zero, which is also where slack is.
    let pulled = |off: usize, vented: bool| {
        let time_s: Vec<f64> = (0..8000).map(|row| 0.01 * f64::from(row)).collect();
        let flicker = |row: usize| (row * 7919 % 101) as f64 / 101.0;
        let vent = |t: f64| vented && (30.0..45.0).contains(&t);
        let pressure_pa: Vec<f64> = time_s
            .iter()
            .enumerate()
            .map(|(row, &t)| if vent(t) { 0.0 } else { 2.5e5 + 1e5 * (1.1 * t).sin() + 3e3 * flicker(row) })
            .collect();
        let length_m: Vec<f64> =
            time_s.iter().enumerate().map(|(row, t)| 0.24 + 0.015 * (0.7 * t).sin() + 1e-4 * flicker(row)).collect();
        let force_n: Vec<f64> = (0..time_s.len())
            .map(|row| {
                let direction = if (0.7 * time_s[row]).cos() > 0.0 { -1.0 } else { 1.0 };
                let pulls_n = model.force_n(pressure_pa[row], length_m[row], direction);
                if row >= off || vent(time_s[row]) { 0.0 } else { (pulls_n + 3.0 * flicker(row)).max(0.0) }
            })
            .collect();
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        let segments = vec![0..samples.n_rows(); 1];
        let (sha256, repairs) = (String::new(), Repairs::default());
        let path = "pulled.csv".to_owned();
        find(&Recording { path, sha256, samples, segments, repairs, ignored_columns: Vec::new() }).unwrap()
    };
    assert!(matches!(pulled(6000, false), Some(Fault::Frozen { channel: "force", rows: 2000, .. })));
    assert_eq!(pulled(8000, true), None, "vented and slack");
}
