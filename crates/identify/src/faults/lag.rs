//! A channel that lags the others.
//!
//! Force is compared with columns made from pressure (or length) a little earlier or later; the shift that
//! leaves the least unexplained is the lag. Weights are free, so that no parameter has to be known, and the
//! direction of motion stays in place, so that hysteresis, which does not depend on the rate, is not taken
//! for a lag. Only stretches that move fast take part: the others cannot tell.

use pam_core::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::summary::Summary;
use rayon::prelude::*;

use crate::prepare::Prepared;

/// Largest lag looked for, in s.
const LARGEST_LAG_S: f64 = 0.06;
/// Rows of a stretch, and stretches that take part.
const WINDOW_ROWS: usize = 256;
const WINDOWS: usize = 12;
/// Share of the unexplained mean square that the shift must explain to be worth a word.
const WORTH: f64 = 0.15;

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
        .map(|shifted| Ok(find_one(&fast_windows(recordings, shifted)?, columns, shifted)))
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

fn find_one(windows: &[Window], columns: &ForceColumns, shifted: Shifted) -> Option<Lag> {
    if windows.len() < 3 {
        return None;
    }
    let unexplained = |lag_s: f64| unexplained_rmse_n(windows, columns, shifted, lag_s);
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
    (explained > WORTH && best.0.abs() > 0.5 * period_s.max(2e-3)).then_some(Lag {
        channel,
        force_later_s: best.0,
        rmse_n: (middle, best.1),
    })
}

/// What free weights leave, with the channel taken `lag_s` earlier.
fn unexplained_rmse_n(windows: &[Window], columns: &ForceColumns, shifted: Shifted, lag_s: f64) -> f64 {
    let mut summary = Summary::new(N_COLUMNS);
    let width = N_COLUMNS + 1;
    for window in windows {
        let n = window.time_s.len();
        let earlier = |values: &[f64], index: usize| {
            if lag_s == 0.0 {
                Some(values[index])
            } else {
                value_at(&window.time_s, values, window.time_s[index] - lag_s)
            }
        };
        let mut rows: Vec<[f64; N_COLUMNS + 1]> = Vec::with_capacity(n);
        for index in 0..n {
            // The same rows for every lag, or the comparison is not fair.
            let span_s = window.time_s[n - 1] - window.time_s[0];
            let since_s = window.time_s[index] - window.time_s[0];
            let margin_s = 1.25 * LARGEST_LAG_S;
            if span_s > 3.0 * margin_s && (since_s < margin_s || span_s - since_s < margin_s) {
                continue;
            }
            let (pressure_pa, length_m) = match shifted {
                Shifted::Pressure => (earlier(&window.pressure_pa, index), Some(window.length_m[index])),
                Shifted::Length => (Some(window.pressure_pa[index]), earlier(&window.length_m, index)),
            };
            let (Some(pressure_pa), Some(length_m)) = (pressure_pa, length_m) else { continue };
            let mut row = [0.0; N_COLUMNS + 1];
            row[..N_COLUMNS].copy_from_slice(&columns.row(pressure_pa, length_m, window.direction[index]));
            row[N_COLUMNS] = window.force_n[index];
            if row.iter().all(|value| value.is_finite()) {
                rows.push(row);
            }
        }
        let mut block = vec![0.0; rows.len() * width];
        for (index, row) in rows.iter().enumerate() {
            for (column, value) in row.iter().enumerate() {
                block[column * rows.len() + index] = *value;
            }
        }
        summary.fold(&mut block, rows.len());
    }
    (summary.residual_floor_square_sum() / (summary.n_rows().max(1)) as f64).sqrt()
}

/// Value at a time, on the straight line between its neighbors; none outside the window.
fn value_at(time_s: &[f64], values: &[f64], at_s: f64) -> Option<f64> {
    let after = time_s.partition_point(|&time| time < at_s);
    if after == 0 || after == time_s.len() {
        return None;
    }
    let span_s = time_s[after] - time_s[after - 1];
    let share = if span_s > 0.0 { (at_s - time_s[after - 1]) / span_s } else { 1.0 };
    Some(values[after - 1] + share * (values[after] - values[after - 1]))
}
