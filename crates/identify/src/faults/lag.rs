//! A channel that lags the others.
//!
//! Force is compared with columns made from pressure (or length) a little earlier or later; the shift that
//! leaves the least unexplained is the lag. Weights are free, so that no parameter has to be known, and the
//! direction of motion stays in place, so that hysteresis, which does not depend on the rate, is not taken
//! for a lag. Only stretches that move fast take part: the others cannot tell. A first look at every fourth row
//! decides whether there is anything to look for.
//!
//! # Design
//! A shift takes the row that is nearest in time, and never a mean of two: interpolation averages the noise of the channel,
//! so that every shift but none explained more of a clean recording, up to 14 ms of it. What lies between two rows is read
//! off a parabola. A window lasts long enough that every shift sees the same rows, at every rate.

use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::gathered::Gathered;
use pam_recording::CHUNK_ROWS;
use rayon::prelude::*;

use crate::prepare::Prepared;

/// Largest lag looked for, in s, and what a window has to spare on either side for it.
const LARGEST_LAG_S: f64 = 0.06;
const MARGIN_S: f64 = 1.25 * LARGEST_LAG_S;
/// Rows of a window that are looked at, about; how long it lasts at least, in s; and windows that take part.
const WINDOW_ROWS: usize = 256;
const WINDOW_S: f64 = 0.5;
const WINDOWS: usize = 12;
/// Share of the unexplained mean square that the shift must explain to be worth a word.
const WORTH: f64 = 0.15;
/// Every so-many-th row takes part in the first look, which must find half of what is worth a word.
const SKIMMED: usize = 4;

/// How often the play of the finest length that of the coarsest may be.
const COARSER: f64 = 8.0;

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
    /// From one row that is looked at to the next.
    stride: usize,
}

impl Window {
    fn period_s(&self) -> f64 {
        let n = self.time_s.len();
        (self.time_s[n - 1] - self.time_s[0]) / (n - 1) as f64
    }
}

/// Lags between the force and the other channels, where the recordings are fast enough to show them.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(recordings: &[Prepared], columns: &ForceColumns) -> std::io::Result<Vec<Lag>> {
    // One threshold of the direction holds for all: where one recording is so much coarser than another that directions come
    // late by it in the other, that would be taken for a lag.
    let plays = || recordings.iter().filter_map(|prepared| Some(prepared.quality.channel("length")?.play_threshold()));
    let finest_m = plays().filter(|play_m| *play_m > 0.0).fold(f64::INFINITY, f64::min);
    if plays().any(|play_m| play_m > COARSER * finest_m) {
        return Ok(Vec::new());
    }
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

/// Rows of a window of a recording.
fn window_rows(prepared: &Prepared) -> usize {
    let by_time = (WINDOW_S / prepared.quality.period_s.max(f64::MIN_POSITIVE)).ceil();
    (by_time as usize).clamp(WINDOW_ROWS, CHUNK_ROWS)
}

/// The windows in which the channel changes most, over all recordings.
fn fast_windows(recordings: &[Prepared], shifted: Shifted) -> std::io::Result<Vec<Window>> {
    let mut found: Vec<(f64, usize, usize)> = Vec::new();
    for (index, prepared) in recordings.iter().enumerate() {
        let samples = &prepared.recording.samples;
        let n_rows = window_rows(prepared);
        // Sixteen chunks say enough of a long recording.
        let stride = samples.n_chunks().div_ceil(16).max(1);
        for chunk_index in (0..samples.n_chunks()).step_by(stride) {
            let chunk = samples.chunk(chunk_index)?;
            let values = if shifted == Shifted::Pressure { chunk.pressure_pa() } else { chunk.length_m() };
            for start in (0..(chunk.n_rows() + 1).saturating_sub(n_rows)).step_by(n_rows) {
                let rows = chunk.first_row() + start..chunk.first_row() + start + n_rows;
                let lasts_s = chunk.time_s()[start + n_rows - 1] - chunk.time_s()[start];
                // A gap inside a window would be taken for a fast change.
                if lasts_s <= 3.0 * MARGIN_S
                    || !prepared
                        .recording
                        .segments
                        .iter()
                        .any(|segment| segment.start <= rows.start && rows.end <= segment.end)
                {
                    continue;
                }
                let window = &values[start..start + n_rows];
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
            let n_rows = window_rows(prepared);
            let chunk = prepared.recording.samples.chunk(start / CHUNK_ROWS)?;
            let here = start - chunk.first_row()..start - chunk.first_row() + n_rows;
            Ok(Window {
                time_s: chunk.time_s()[here.clone()].to_vec(),
                pressure_pa: chunk.pressure_pa()[here.clone()].to_vec(),
                length_m: chunk.length_m()[here.clone()].to_vec(),
                force_n: chunk.force_n()[here].to_vec(),
                direction: (start..start + n_rows).map(|row| prepared.direction.sign(row)).collect(),
                stride: n_rows / WINDOW_ROWS,
            })
        })
        .collect()
}

/// The lag over every `stride`-th of the rows that are looked at, where the shift explains more than the share `worth`.
fn find_one(windows: &[Window], columns: &ForceColumns, shifted: Shifted, stride: usize, worth: f64) -> Option<Lag> {
    if windows.len() < 3 {
        return None;
    }
    let unexplained = |lag_s: f64| unexplained_rmse_n(windows, columns, shifted, stride, lag_s);
    // Shifts are whole rows of the recording that changes most.
    let period_s = windows[0].period_s();
    let most = (LARGEST_LAG_S / period_s).floor() as i64;
    if most == 0 {
        return None;
    }
    let at = |rows: i64| unexplained(rows as f64 * period_s);
    let mut pitch = (most / 4).max(1);
    let middle = at(0);
    let mut best = (0, middle);
    for step in (-4..=4_i64).filter(|step| *step != 0 && (step * pitch).abs() <= most) {
        let candidate = (step * pitch, at(step * pitch));
        if candidate.1 < best.1 {
            best = candidate;
        }
    }
    // Halved until it is one row.
    while pitch > 1 {
        pitch = (pitch + 1) / 2;
        for rows in [best.0 - pitch, best.0 + pitch] {
            let candidate = (rows, if rows.abs() <= most { at(rows) } else { f64::INFINITY });
            if candidate.1 < best.1 {
                best = candidate;
            }
        }
    }
    let explained = 1.0 - (best.1 / middle).powi(2);
    if best.0 == 0 || explained.is_nan() || explained <= worth {
        return None;
    }
    // Between rows, by a parabola through three of them.
    let (left, here, right) = (at(best.0 - 1).powi(2), best.1.powi(2), at(best.0 + 1).powi(2));
    let bend = left - 2.0 * here + right;
    let between = if bend > 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    let lag_s = (best.0 as f64 + between) * period_s;
    let channel = if shifted == Shifted::Pressure { "pressure" } else { "length" };
    (lag_s.abs() > 1e-3).then_some(Lag { channel, force_later_s: lag_s, rmse_n: (middle, best.1) })
}

/// Residual that free weights leave of every `stride`-th row, with the channel taken `lag_s` earlier.
fn unexplained_rmse_n(windows: &[Window], columns: &ForceColumns, shifted: Shifted, stride: usize, lag_s: f64) -> f64 {
    let mut gathered = Gathered::new(N_COLUMNS);
    for window in windows {
        let n = window.time_s.len();
        let (first_s, last_s) = (window.time_s[0], window.time_s[n - 1]);
        let mut after = 0;
        for index in (0..n).step_by(stride * window.stride) {
            let time_s = window.time_s[index];
            // The same rows for every lag, or the comparison is not fair.
            if time_s - first_s < MARGIN_S || last_s - time_s < MARGIN_S {
                continue;
            }
            let (mut pressure_pa, mut length_m) = (window.pressure_pa[index], window.length_m[index]);
            if lag_s != 0.0 {
                let (values, value) = match shifted {
                    Shifted::Pressure => (&window.pressure_pa, &mut pressure_pa),
                    Shifted::Length => (&window.length_m, &mut length_m),
                };
                *value = values[nearest_row(&window.time_s, time_s - lag_s, &mut after)];
            }
            let row = columns.row(pressure_pa, length_m, window.direction[index]);
            let force_n = window.force_n[index];
            if row.iter().all(|value| value.is_finite()) && force_n.is_finite() {
                gathered.push(row.into_iter().chain([force_n]));
            }
        }
    }
    let summary = gathered.summary();
    (summary.residual_floor_square_sum() / (summary.n_rows().max(1)) as f64).sqrt()
}

/// The row nearest to a time. `after`, the first row that is not before that time, is kept from one time to the next, later
/// one.
fn nearest_row(time_s: &[f64], at_s: f64, after: &mut usize) -> usize {
    while *after + 1 < time_s.len() && time_s[*after] < at_s {
        *after += 1;
    }
    let before = after.saturating_sub(1);
    if at_s - time_s[before] < time_s[*after] - at_s { before } else { *after }
}

#[cfg(test)]
mod tests;
