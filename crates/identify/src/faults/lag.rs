//! A channel that lags the others.
//!
//! Force is compared with columns made from pressure (or length) a little earlier or later; the shift that
//! leaves the least unexplained is the lag. Weights are free, so that no parameter has to be known, and the
//! direction of motion stays in place, so that hysteresis, which does not depend on the rate, is not taken
//! for a lag. Only stretches that move fast take part: the others cannot tell. A first look at every fourth row
//! decides whether there is anything to look for.

use pam_core::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::summary::{BLOCK_ROWS, Summary};
use rayon::prelude::*;

use crate::prepare::Prepared;

/// Largest lag looked for, in s.
const LARGEST_LAG_S: f64 = 0.06;
/// Rows of a stretch, and stretches that take part.
const WINDOW_ROWS: usize = 256;
const WINDOWS: usize = 12;
/// Share of the unexplained mean square that the shift must explain to be worth a word.
const WORTH: f64 = 0.15;
/// Every so-many-th row takes part in the first look, which must find half of what is worth a word.
const SKIMMED: usize = 4;

/// A channel that the force lags behind (or runs ahead of, if negative).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// `pressure` or `length`.
    pub channel: &'static str,
    /// By how much the force comes later, in s.
    pub force_later_s: f64,
    /// Unexplained RMSE over the fast stretches without and with the shift, in N.
    pub rmse_n: (f64, f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shifted {
    Pressure,
    Length,
}

struct Window {
    time_s: Vec<f64>,
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    force_n: Vec<f64>,
    direction: Vec<f64>,
}

/// Lags between the force and the other channels, where the recordings are fast enough to show them.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(recordings: &[Prepared], columns: &ForceColumns) -> std::io::Result<Vec<Lag>> {
    let lags: std::io::Result<Vec<Option<Lag>>> = [Shifted::Pressure, Shifted::Length]
        .into_par_iter()
        .map(|shifted| {
            let windows = fast_windows(recordings, shifted)?;
            Ok(find_one(&windows, columns, shifted, SKIMMED, 0.5 * WORTH)
                .and_then(|_| find_one(&windows, columns, shifted, 1, WORTH)))
        })
        .collect();
    Ok(lags?.into_iter().flatten().collect())
}

/// The windows in which the channel changes most, over all recordings.
fn fast_windows(recordings: &[Prepared], shifted: Shifted) -> std::io::Result<Vec<Window>> {
    let mut found: Vec<(f64, usize, usize)> = Vec::new();
    for (index, prepared) in recordings.iter().enumerate() {
        let samples = &prepared.recording.samples;
        // Sixteen chunks say enough of a long recording.
        let stride = samples.n_chunks().div_ceil(16).max(1);
        for chunk_index in (0..samples.n_chunks()).step_by(stride) {
            let chunk = samples.chunk(chunk_index)?;
            let values = if shifted == Shifted::Pressure { chunk.pressure_pa() } else { chunk.length_m() };
            for start in (0..chunk.n_rows().saturating_sub(WINDOW_ROWS)).step_by(WINDOW_ROWS) {
                let rows = chunk.first_row() + start..chunk.first_row() + start + WINDOW_ROWS;
                // A gap inside a window would be taken for a fast change.
                if !prepared
                    .recording
                    .segments
                    .iter()
                    .any(|segment| segment.start <= rows.start && rows.end <= segment.end)
                {
                    continue;
                }
                let window = &values[start..start + WINDOW_ROWS];
                let (low, high) = window
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
                found.push((high - low, index, rows.start));
            }
        }
    }
    // Largest change first; ties in order of place.
    found.sort_by(|left, right| right.0.total_cmp(&left.0).then(left.1.cmp(&right.1)).then(left.2.cmp(&right.2)));
    found.truncate(WINDOWS);
    found.retain(|window| window.0 > 0.0);
    found
        .into_iter()
        .map(|(_, index, start)| {
            let prepared = &recordings[index];
            let chunk = prepared.recording.samples.chunk(start / pam_core::recording::CHUNK_ROWS)?;
            let here = start - chunk.first_row()..start - chunk.first_row() + WINDOW_ROWS;
            Ok(Window {
                time_s: chunk.time_s()[here.clone()].to_vec(),
                pressure_pa: chunk.pressure_pa()[here.clone()].to_vec(),
                length_m: chunk.length_m()[here.clone()].to_vec(),
                force_n: chunk.force_n()[here].to_vec(),
                direction: (start..start + WINDOW_ROWS).map(|row| prepared.direction.sign(row)).collect(),
            })
        })
        .collect()
}

/// The lag over every `stride`-th row, where the shift explains more than the share `worth`.
fn find_one(windows: &[Window], columns: &ForceColumns, shifted: Shifted, stride: usize, worth: f64) -> Option<Lag> {
    if windows.len() < 3 {
        return None;
    }
    let unexplained = |lag_s: f64| unexplained_rmse_n(windows, columns, shifted, stride, lag_s);
    let steps = 4_i32;
    let pitch_s = LARGEST_LAG_S / f64::from(steps);
    let scan: Vec<(f64, f64)> =
        (-steps..=steps).map(|step| f64::from(step) * pitch_s).map(|lag_s| (lag_s, unexplained(lag_s))).collect();
    let middle = scan[steps as usize].1;
    let mut best = scan[steps as usize];
    for &candidate in &scan {
        if candidate.1 < best.1 {
            best = candidate;
        }
    }
    // Two parabolas through three points find the bottom to a fraction of the pitch.
    let mut pitch_s = pitch_s;
    for _ in 0..2 {
        let (left, right) = (unexplained(best.0 - pitch_s).powi(2), unexplained(best.0 + pitch_s).powi(2));
        let here = best.1.powi(2);
        let bend = left - 2.0 * here + right;
        if bend > 0.0 {
            let candidate_s = best.0 + (0.5 * pitch_s * (left - right) / bend).clamp(-pitch_s, pitch_s);
            let value = unexplained(candidate_s);
            if value < best.1 {
                best = (candidate_s, value);
            }
        }
        pitch_s *= 0.25;
    }
    let explained = 1.0 - (best.1 / middle).powi(2);
    let period_s = (windows[0].time_s[WINDOW_ROWS - 1] - windows[0].time_s[0]) / (WINDOW_ROWS - 1) as f64;
    let channel = if shifted == Shifted::Pressure { "pressure" } else { "length" };
    (explained > worth && best.0.abs() > 0.5 * period_s.max(2e-3)).then_some(Lag {
        channel,
        force_later_s: best.0,
        rmse_n: (middle, best.1),
    })
}

/// What free weights leave of every `stride`-th row, with the channel taken `lag_s` earlier.
fn unexplained_rmse_n(windows: &[Window], columns: &ForceColumns, shifted: Shifted, stride: usize, lag_s: f64) -> f64 {
    let width = N_COLUMNS + 1;
    let mut summary = Summary::new(N_COLUMNS);
    let mut block = vec![0.0; BLOCK_ROWS * width];
    let mut filled = 0;
    for window in windows {
        let n = window.time_s.len();
        let (first_s, last_s) = (window.time_s[0], window.time_s[n - 1]);
        let margin_s = 1.25 * LARGEST_LAG_S;
        let has_margin = last_s - first_s > 3.0 * margin_s;
        let mut after = 0;
        for index in (0..n).step_by(stride) {
            let time_s = window.time_s[index];
            // The same rows for every lag, or the comparison is not fair.
            if has_margin && (time_s - first_s < margin_s || last_s - time_s < margin_s) {
                continue;
            }
            let (mut pressure_pa, mut length_m) = (window.pressure_pa[index], window.length_m[index]);
            if lag_s != 0.0 {
                let (values, value) = match shifted {
                    Shifted::Pressure => (&window.pressure_pa, &mut pressure_pa),
                    Shifted::Length => (&window.length_m, &mut length_m),
                };
                let Some(earlier) = value_at(&window.time_s, values, time_s - lag_s, &mut after) else { continue };
                *value = earlier;
            }
            let row = columns.row(pressure_pa, length_m, window.direction[index]);
            let force_n = window.force_n[index];
            if row.iter().all(|value| value.is_finite()) && force_n.is_finite() {
                for (column, value) in row.into_iter().chain([force_n]).enumerate() {
                    block[column * BLOCK_ROWS + filled] = value;
                }
                filled += 1;
                if filled == BLOCK_ROWS {
                    summary.fold(&mut block, filled);
                    filled = 0;
                }
            }
        }
    }
    summary.fold_part(&mut block, filled);
    (summary.residual_floor_square_sum() / (summary.n_rows().max(1)) as f64).sqrt()
}

/// Value at a time, on the straight line between its neighbors; none outside the window. `after`, the first row that is
/// not before that time, is kept from one time to the next, later one.
fn value_at(time_s: &[f64], values: &[f64], at_s: f64, after: &mut usize) -> Option<f64> {
    while *after < time_s.len() && time_s[*after] < at_s {
        *after += 1;
    }
    if *after == 0 || *after == time_s.len() {
        return None;
    }
    let (before, after) = (*after - 1, *after);
    let span_s = time_s[after] - time_s[before];
    let share = if span_s > 0.0 { (at_s - time_s[before]) / span_s } else { 1.0 };
    Some(values[before] + share * (values[after] - values[before]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    use pam_core::direction::{Standstill, Thresholds};
    use pam_core::force::{BaseParameters, ForceModel, Form};
    use pam_core::muscle::MuscleFile;
    use pam_core::recording::{Recording, Repairs, Samples};
    use rand::{RngExt, SeedableRng};

    use crate::prepare::{direct, gate};

    /// A muscle shaken at 1 Hz whose force comes later than its pressure, by rows of 5 ms.
    fn late_by(n_rows: usize) -> (Vec<Prepared>, ForceColumns) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs/muscle-nominal.toml");
        let muscle = MuscleFile::read(&path).unwrap().muscle;
        let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
        let model = ForceModel::new(&muscle, 3e9, Form::Corrected, parameters);
        let mut generator = rand_pcg::Pcg64::seed_from_u64(2);
        let time_s: Vec<f64> = (0..4000).map(|row| 0.005 * f64::from(row)).collect();
        let pressure_pa: Vec<f64> = time_s.iter().map(|t| 2.5e5 + 1e5 * (std::f64::consts::TAU * t).sin()).collect();
        let length_m: Vec<f64> = time_s.iter().map(|t| 0.24 + 0.01 * (0.7 * std::f64::consts::TAU * t).sin()).collect();
        let force_n: Vec<f64> = (0..time_s.len())
            .map(|row| {
                let noise_n = generator.random_range(-1.0..1.0);
                model.force_n(pressure_pa[row.saturating_sub(n_rows)], length_m[row], 0.0) + noise_n
            })
            .collect();
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        let segments = vec![0..samples.n_rows(); 1];
        let (sha256, repairs) = (String::new(), Repairs::default());
        let recording = Recording {
            path: "shaken.csv".to_owned(),
            sha256,
            samples,
            segments,
            repairs,
            ignored_columns: Vec::new(),
        };
        let thresholds = Thresholds { length_m: 1e-4, pressure_pa: 1e3, standstill: Standstill::AT_ONCE };
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
}
