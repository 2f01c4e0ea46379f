//! What the rows around one tell of it, a stretch of a segment at a time.

use std::io;
use std::ops::Range;

use pam_recording::Recording;

use super::path::{Path, Still};
use super::{Channels, DEVIATIONS_PER_THRESHOLD, Instant};
use crate::direction::{Direction, Thresholds};
use crate::effects::Moment;
use crate::force::ForceModel;
use crate::smoothing::{Average, HALF_VALUE_WINDOW_S, HALF_WINDOW_S, Sliding, Window, period_between_s};

/// Rows to either side of a stretch that are read beside it: more than the longest windows, rests, and the knees found in them reach.
const BESIDE: usize = 2048;

/// How a segment is looked at.
pub(super) struct View<'a> {
    recording: &'a Recording,
    segment: &'a Range<usize>,
    pub(super) thresholds: Thresholds,
    channels: Channels,
    near: Window,
    pub(super) window: Window,
    pub(super) average: Average,
}

/// What the rows around one tell of it. What it remembers of all rows before is still missing from the instant.
pub(super) struct Local {
    pub(super) instant: Instant,
    pub(super) average_pa: f64,
    pub(super) average_m: f64,
    /// Slide by a change of the pressure at this length, in m/Pa.
    pub(super) slide_m_per_pa: f64,
    /// Rates that start and stop when the drive does.
    pub(super) sharp_pa_per_s: f64,
    pub(super) sharp_m_per_s: f64,
    /// Whether the length stands still.
    pub(super) resting: bool,
}

impl<'a> View<'a> {
    pub(super) fn over(
        recording: &'a Recording,
        segment: &'a Range<usize>,
        ends_s: [f64; 2],
        thresholds: Thresholds,
        channels: Channels,
    ) -> Self {
        let period_s = period_between_s(segment.len(), ends_s);
        let [near, window] = [HALF_VALUE_WINDOW_S, HALF_WINDOW_S].map(|half_s| Window::every(period_s, half_s));
        Self { recording, segment, thresholds, channels, near, window, average: Average::every(period_s) }
    }

    /// Every `stride`-th of `rows` of the segment.
    pub(super) fn locals(
        &self,
        rows: Range<usize>,
        stride: usize,
        direction: &Direction,
        base: &ForceModel,
    ) -> io::Result<Vec<Local>> {
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let Self { segment, thresholds, near, window, average, .. } = self;
        // Rests are looked for at rows that do not depend on where a stretch begins.
        let from = rows.start.saturating_sub(BESIDE) / window.half * window.half;
        let read = segment.start + from..segment.end.min(segment.start + rows.end + BESIDE);
        let columns = Rows::read(self.recording, read)?;
        let windows = [near, window];
        let lengths = Path::of(columns.length_m, windows, thresholds.length_m / DEVIATIONS_PER_THRESHOLD);
        let pressures = Path::of(columns.pressure_pa, windows, thresholds.pressure_pa / DEVIATIONS_PER_THRESHOLD);
        let still = Still::of(&lengths, window, thresholds.length_m);
        let (mut sharp_pressures, mut sharp_lengths) = (pressures.sharp(windows), lengths.sharp(windows));
        let mut forces = Sliding::along(near, &columns.force_n);
        // Smooth forces are to be compared with equally smooth rates. What slides and remembers it starts and stops when the
        // drive does: a stop smeared over some rows would be a crawl.
        let recorded = self.channels == Channels::Recorded;
        let choose = |smooth_value: f64, recorded_value: f64| if recorded { recorded_value } else { smooth_value };
        let mut locals = Vec::with_capacity(rows.len().div_ceil(stride));
        for at in rows.step_by(stride) {
            let (row, at) = (segment.start + at, at - from);
            let (sharp_pressure, sharp_length) = (sharp_pressures.at(at), sharp_lengths.at(at));
            let [pressure, length] = if recorded {
                [sharp_pressure, sharp_length]
            } else {
                [
                    pressures.smooth_near_knee(windows, at).unwrap_or(sharp_pressure),
                    lengths.smooth_near_knee(windows, at).unwrap_or(sharp_length),
                ]
            };
            let smooth_force_n = forces.value(at);
            let average_m = lengths.average(average, at);
            locals.push(Local {
                instant: Instant {
                    row,
                    moment: Moment {
                        time_s: columns.time_s[at],
                        pressure_pa: choose(pressure.value, pressures.recorded(at)),
                        pressure_rate_pa_per_s: pressure.slope,
                        length_m: choose(length.value, lengths.recorded(at)),
                        speed_m_per_s: -length.slope,
                        acceleration_m_per_s2: -length.curvature,
                        direction: direction.sign(row),
                        force_n: smooth_force_n,
                        warmth_k: warmth_k(&columns.temperature_k, near, at),
                        ..Moment::default()
                    },
                    force_n: choose(smooth_force_n, columns.force_n.get(at).copied().unwrap_or(0.0)),
                    knee: recorded && lengths.knees.bend(at) != 0.0,
                    settled: direction.is_settled(row)
                        && (recorded || {
                            let first = row.saturating_sub(near.half).max(segment.start);
                            let last = (row + near.half).min(segment.end - 1);
                            direction.is_settled(first) && direction.is_settled(last)
                        }),
                },
                average_pa: pressures.average(average, at),
                average_m,
                slide_m_per_pa: base.slide_m_per_pa(average_m),
                sharp_pa_per_s: sharp_pressure.slope,
                sharp_m_per_s: sharp_length.slope,
                resting: still.at(at, sharp_length.slope),
            });
        }
        Ok(locals)
    }
}

/// 20 °C, which effects count a temperature from, in K.
const ROOM_K: f64 = 293.15;

/// Temperature above [`ROOM_K`] around row `at`, in K; zero where none was logged.
fn warmth_k(temperature_k: &[f64], near: &Window, at: usize) -> f64 {
    if temperature_k.is_empty() { 0.0 } else { near.parabola(temperature_k, at).value - ROOM_K }
}

/// Columns of a stretch of rows.
struct Rows {
    time_s: Vec<f64>,
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    /// Empty where none was recorded.
    force_n: Vec<f64>,
    /// Likewise.
    temperature_k: Vec<f64>,
}

impl Rows {
    fn read(recording: &Recording, rows: Range<usize>) -> io::Result<Self> {
        let column = |is_there: bool| Vec::with_capacity(if is_there { rows.len() } else { 0 });
        let samples = &recording.samples;
        let mut columns = Self {
            time_s: column(true),
            pressure_pa: column(true),
            length_m: column(true),
            force_n: column(samples.has_force()),
            temperature_k: column(samples.has_temperature()),
        };
        for part in samples.parts(rows) {
            let (chunk, range) = part?;
            columns.time_s.extend_from_slice(&chunk.time_s()[range.clone()]);
            columns.pressure_pa.extend_from_slice(&chunk.pressure_pa()[range.clone()]);
            columns.length_m.extend_from_slice(&chunk.length_m()[range.clone()]);
            if samples.has_force() {
                columns.force_n.extend_from_slice(&chunk.force_n()[range.clone()]);
            }
            if samples.has_temperature() {
                columns.temperature_k.extend_from_slice(&chunk.temperature_k()[range]);
            }
        }
        Ok(columns)
    }
}
