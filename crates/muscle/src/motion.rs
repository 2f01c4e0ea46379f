//! How a recording moves: its channels smooth, with their rates, as effects see them.
//!
//! Values, rates and the acceleration come from parabolas, contraction and slide, which effects remember, from averages
//! that never overshoot: see [`crate::smoothing`].

use std::io;
use std::ops::Range;

use pam_recording::{CHUNK_ROWS, Recording};
use rayon::prelude::*;

use crate::direction::{Direction, Thresholds};
use crate::effects::{Moment, Seen};
use crate::force::ForceModel;
use crate::knees::Knees;
use crate::smoothing::{
    Average, HALF_VALUE_WINDOW_S, HALF_WINDOW_S, Onward, Parabola, Sliding, Window, period_between_s,
};

/// Deviations of the noise in a threshold of the direction.
const DEVIATIONS_PER_THRESHOLD: f64 = 5.0;
/// Six deviations of the noise, from peak to peak, over a threshold of the direction.
pub const NOISE_PER_THRESHOLD: f64 = 6.0 / DEVIATIONS_PER_THRESHOLD;

/// Rows of a segment that are looked at in one go, each go on a thread of its own.
const STRETCH_ROWS: usize = 1 << 15;
/// Rows to either side that are read beside them: more than the longest windows, rests, and the knees found in them reach.
const BESIDE: usize = 2048;

/// One row of a recording with everything that effects need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Row of the recording.
    pub row: usize,
    /// Instants as effects see them.
    pub moment: Moment,
    /// Force, in N; as recorded or smooth like the other channels.
    pub force_n: f64,
    /// Whether the speed changes at once just before it; never where channels are smooth.
    pub knee: bool,
    /// Whether the direction is certain, all through the window where channels are smooth.
    pub settled: bool,
}

/// Here and not beside [`Seen`], so that effects need not know how a recording is walked over.
impl Seen {
    /// Ranges that `instants` cover.
    pub fn of<'a>(instants: impl Iterator<Item = &'a Instant>) -> Self {
        const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
        let widened = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
        let start =
            Self { contraction_ratio: NOTHING, pressure_pa: NOTHING, force_n: NOTHING, duration_s: f64::NEG_INFINITY };
        instants.fold(start, |seen, instant| Self {
            contraction_ratio: widened(seen.contraction_ratio, instant.moment.contraction_ratio),
            pressure_pa: widened(seen.pressure_pa, instant.moment.pressure_pa),
            force_n: widened(seen.force_n, instant.force_n),
            duration_s: seen.duration_s.max(instant.moment.time_s),
        })
    }
}

/// Which values of the channels an instant carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// As recorded.
    Recorded,
    /// Smooth.
    Smooth,
}

/// Walks over every `stride`-th of the first `n_rows` rows of `recording`, in order, a segment at a time. `index` is the number of the
/// recording; `base` knows the muscle.
///
/// # Errors
/// Where the samples cannot be read back.
#[expect(clippy::too_many_arguments, reason = "what to walk over and how; every caller names them all")]
pub fn walk(
    recording: &Recording,
    direction: &Direction,
    thresholds: Thresholds,
    base: &ForceModel,
    index: usize,
    n_rows: usize,
    stride: usize,
    channels: Channels,
    visit: &mut dyn FnMut(Instant),
) -> io::Result<()> {
    let mut first_s = None;
    for segment in recording.segments.iter().filter(|segment| segment.start < n_rows) {
        let n_visited = segment.end.min(n_rows) - segment.start;
        let Some([begin_s, end_s]) = ends_s(recording, segment)? else { continue };
        let origin_s = *first_s.get_or_insert(begin_s);
        let view = View::over(recording, segment, [begin_s, end_s], thresholds, channels);
        let starts: Vec<usize> = (0..n_visited).step_by(STRETCH_ROWS).collect();
        let mut path = Followed::from_rest(&view, base);
        for starts in starts.chunks(rayon::current_num_threads()) {
            let stretches: io::Result<Vec<Vec<Local>>> = starts
                .par_iter()
                .map(|&start| {
                    let rows = start.next_multiple_of(stride)..(start + STRETCH_ROWS).min(n_visited);
                    view.locals(rows, stride, direction, base)
                })
                .collect();
            for local in stretches?.into_iter().flatten() {
                visit(path.on_to(&local, index, origin_s));
            }
        }
    }
    Ok(())
}

/// Times of the first and the last row of a segment, in s; none where it has no rows.
fn ends_s(recording: &Recording, segment: &Range<usize>) -> io::Result<Option<[f64; 2]>> {
    if segment.is_empty() {
        return Ok(None);
    }
    let time_s = |row: usize| -> io::Result<f64> {
        let chunk = recording.samples.chunk(row / CHUNK_ROWS)?;
        Ok(chunk.time_s()[row - chunk.first_row()])
    };
    Ok(Some([time_s(segment.start)?, time_s(segment.end - 1)?]))
}

/// How a segment is looked at.
struct View<'a> {
    recording: &'a Recording,
    segment: &'a Range<usize>,
    thresholds: Thresholds,
    channels: Channels,
    near: Window,
    window: Window,
    average: Average,
}

/// What the rows around one tell of it. What it remembers of all rows before is still missing from the instant.
struct Local {
    instant: Instant,
    average_pa: f64,
    average_m: f64,
    /// Slide by a change of the pressure at this length, in m/Pa.
    slide_m_per_pa: f64,
    /// Rates that start and stop when the drive does.
    sharp_pa_per_s: f64,
    sharp_m_per_s: f64,
    /// Whether the length stands still.
    resting: bool,
}

impl<'a> View<'a> {
    fn over(
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
    fn locals(
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

/// What a segment remembers of its way so far.
struct Followed {
    rest_length_m: f64,
    contraction: Onward,
    slide: Onward,
    rest_slide: Onward,
    by_pressure_m: f64,
    /// Time and pressure of the row before.
    last: Option<(f64, f64)>,
}

impl Followed {
    fn from_rest(view: &View<'_>, base: &ForceModel) -> Self {
        let rest_length_m = base.muscle().rest_length_m;
        let slid_m = base.slide_m_per_pa(rest_length_m) * view.thresholds.pressure_pa;
        let noise = view.average.share_of_noise() * NOISE_PER_THRESHOLD;
        let onward = |threshold_m: f64| Onward::new(noise * threshold_m, view.window.width_s());
        Self {
            rest_length_m,
            contraction: onward(view.thresholds.length_m),
            slide: onward(view.thresholds.length_m + slid_m),
            rest_slide: onward(slid_m),
            by_pressure_m: 0.0,
            last: None,
        }
    }

    /// The instant of the next row of recording `index`, which began at `origin_s`.
    fn on_to(&mut self, local: &Local, index: usize, origin_s: f64) -> Instant {
        let Local { instant, average_pa, average_m, slide_m_per_pa, sharp_pa_per_s, sharp_m_per_s, resting } = *local;
        let time_s = instant.moment.time_s;
        let (step_s, pressure_step_pa) =
            self.last.map_or((0.0, 0.0), |(last_s, last_pa)| (time_s - last_s, average_pa - last_pa));
        self.last = Some((time_s, average_pa));
        let by_pressure_m_per_s = if resting { slide_m_per_pa * sharp_pa_per_s } else { 0.0 };
        if resting {
            self.by_pressure_m += slide_m_per_pa * pressure_step_pa;
        }
        let shortened_m = self.rest_length_m - average_m;
        let slide_speed_m_per_s = if resting { by_pressure_m_per_s } else { -sharp_m_per_s };
        let contraction_m = self.contraction.follow(shortened_m, -sharp_m_per_s);
        let slide_m = self.slide.follow(shortened_m + self.by_pressure_m, slide_speed_m_per_s);
        let rest_slide_m = self.rest_slide.follow(self.by_pressure_m, by_pressure_m_per_s);
        Instant {
            moment: Moment {
                recording: index,
                time_s: time_s - origin_s,
                step_s,
                contraction_ratio: contraction_m / self.rest_length_m,
                slide_speed_m_per_s,
                slide_m,
                rest_slide_m,
                ..instant.moment
            },
            ..instant
        }
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
        for index in rows.start / CHUNK_ROWS..rows.end.div_ceil(CHUNK_ROWS) {
            let chunk = samples.chunk(index)?;
            let (first, n) = (chunk.first_row(), chunk.n_rows());
            let range = rows.start.max(first) - first..rows.end.min(first + n) - first;
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

/// A channel of a stretch of rows.
struct Path {
    /// Straight on where it has a knee.
    rest: Vec<f64>,
    knees: Knees,
}

impl Path {
    /// `channel`, whose white noise has the deviation `noise`.
    fn of(mut channel: Vec<f64>, [near, window]: [&Window; 2], noise: f64) -> Self {
        let knees = Knees::take_from(&mut channel, [window, near], noise);
        Self { rest: channel, knees }
    }

    fn recorded(&self, at: usize) -> f64 {
        self.rest[at] + self.knees.added(at)
    }

    /// The average around row `at`, in which a move that has ended does not go on.
    fn average(&self, average: &Average, at: usize) -> f64 {
        average.at(&self.rest, at) + self.knees.added(at)
    }

    /// Value and curvature by the first of the windows, slope by the second; what knees change changes at once.
    fn sharp<'a>(&'a self, windows: [&'a Window; 2]) -> Sharp<'a> {
        Sharp { path: self, windows: windows.map(|window| Sliding::along(window, &self.rest)) }
    }

    /// The same where knees are as smooth as all else; none where there is no knee to smooth.
    fn smooth_near_knee(&self, [near, window]: [&Window; 2], at: usize) -> Option<Parabola> {
        let around = window.around(at, self.rest.len());
        if !self.knees.any_within(&around) {
            return None;
        }
        let recorded: Vec<f64> = around.clone().map(|row| self.recorded(row)).collect();
        let Parabola { value, curvature, .. } = near.parabola(&recorded, at - around.start);
        Some(Parabola { value, curvature, ..window.parabola(&recorded, at - around.start) })
    }
}

/// A channel as it is read from row to row, with its knees.
struct Sharp<'a> {
    path: &'a Path,
    windows: [Sliding<'a>; 2],
}

impl Sharp<'_> {
    fn at(&mut self, at: usize) -> Parabola {
        let [near, window] = &mut self.windows;
        let knees = &self.path.knees;
        Parabola {
            value: near.value(at) + knees.added(at),
            slope: window.slope(at) + knees.rate(at),
            curvature: near.curvature(at) + knees.bend(at),
        }
    }
}

/// Time to either side in which a length that stands still does not move, in s. The direction waits for longer, because it is
/// wrong for long where it is wrong; what slides under pressure slides at once.
const STILL_S: f64 = 0.1;

/// Where the length stands still: it has no speed and moves by less than a threshold within the time around, but for what it
/// did before it stopped or does after its start at a knee.
struct Still<'a> {
    path: &'a Path,
    /// Smooth lengths at every `every` rows.
    lengths: Vec<f64>,
    every: usize,
    /// Rows to either side that are compared.
    reach: usize,
    threshold_m: f64,
    /// Speed at which it passes the threshold while it is averaged, in m/s.
    speed_m_per_s: f64,
}

impl<'a> Still<'a> {
    fn of(path: &'a Path, window: &Window, threshold_m: f64) -> Self {
        let every = window.half;
        let rows = (0..path.rest.len()).step_by(every);
        Self {
            path,
            lengths: rows.map(|at| window.parabola(&path.rest, at).value + path.knees.added(at)).collect(),
            every,
            reach: every * ((STILL_S / (every as f64 * window.period_s)).ceil() as usize).clamp(1, 20),
            threshold_m,
            speed_m_per_s: threshold_m / window.width_s(),
        }
    }

    fn at(&self, row: usize, speed_m_per_s: f64) -> bool {
        if speed_m_per_s.abs() > self.speed_m_per_s {
            return false;
        }
        let (stop, start) = self.path.knees.around(row);
        let from = row.saturating_sub(self.reach).max(stop).div_ceil(self.every);
        let to = ((row + self.reach).min(start) / self.every + 1).min(self.lengths.len());
        let range = |(low, high): (f64, f64), &length: &f64| (low.min(length), high.max(length));
        let lengths = self.lengths.get(from..to).unwrap_or_default();
        let (low, high) = lengths.iter().fold((f64::INFINITY, f64::NEG_INFINITY), range);
        high - low <= self.threshold_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::{Driver, Standstill};
    use crate::force::{BaseParameters, Form};
    use crate::geometry::tests::nominal;
    use pam_recording::{ReadOptions, Repairs, Samples, read_recording};
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use std::fmt::Write as _;

    const THRESHOLDS: Thresholds =
        Thresholds { length_m: 1.5e-4, pressure_pa: 2.5e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };

    fn base() -> ForceModel {
        ForceModel::new(&nominal(), 3e9, Form::Corrected, BaseParameters { theta: [0.0; 8] })
    }

    /// A noisy path of (pressure, length) over five seconds.
    fn walked(channels: Channels, stride: usize, at: impl Fn(f64) -> (f64, f64)) -> Vec<Instant> {
        walked_first(1000, channels, stride, at)
    }

    /// The first `n_rows` of one.
    fn walked_first(n_rows: usize, channels: Channels, stride: usize, at: impl Fn(f64) -> (f64, f64)) -> Vec<Instant> {
        let normal = Normal::new(0.0, 1.0).unwrap();
        let mut generator = rand_pcg::Pcg64::seed_from_u64(5);
        let mut noise = |deviation: f64| deviation * normal.sample(&mut generator);
        let mut csv = String::from("time_s,pressure_kPa,length_mm,force_N\n");
        for row in 0..1000 {
            let time_s = f64::from(row) * 0.005;
            let (pressure_pa, length_m) = at(time_s);
            let (pressure_kpa, length_mm) = (pressure_pa * 1e-3 + noise(0.5), length_m * 1e3 + noise(0.03));
            writeln!(csv, "{time_s:.3},{pressure_kpa:.3},{length_mm:.4},{:.2}", 100.0 + noise(1.0)).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, csv).unwrap();
        let recording = read_recording(&path, &ReadOptions::default()).unwrap();
        let direction = Direction::of(&recording, THRESHOLDS, Driver::Motion).unwrap();
        let mut instants = Vec::new();
        let mut visit = |instant| instants.push(instant);
        walk(&recording, &direction, THRESHOLDS, &base(), 0, n_rows, stride, channels, &mut visit).unwrap();
        instants
    }

    #[test]
    fn the_first_rows_are_what_they_are_in_all_of_a_recording() {
        // Knees at half a second and at one and a half, on either side of the last row.
        let path = |t: f64| (3e5 + 1e5 * (t - 0.5).clamp(0.0, 1.0), 0.27 - 0.05 * (t - 0.5).clamp(0.0, 1.0));
        let (whole, first) = (walked(Channels::Recorded, 1, path), walked_first(200, Channels::Recorded, 1, path));
        assert_eq!(first.len(), 200);
        for (first, whole) in first.iter().zip(&whole) {
            let near = |first: f64, whole: f64, unit: f64| (first - whole).abs() < 1e-9 * unit;
            let (first, whole) = (&first.moment, &whole.moment);
            assert!(near(first.length_m, whole.length_m, 1.0) && near(first.speed_m_per_s, whole.speed_m_per_s, 1.0));
            assert!(near(first.slide_m, whole.slide_m, 1.0) && near(first.pressure_pa, whole.pressure_pa, 1e5));
        }
    }

    #[test]
    fn where_a_stretch_ends_changes_nothing_of_what_is_seen() {
        // Strokes of a second with half a second of rest, at 1 kHz.
        let normal = Normal::new(0.0, 1.0).unwrap();
        let mut generator = rand_pcg::Pcg64::seed_from_u64(7);
        let rows: Vec<[f64; 3]> = (0..40_000)
            .map(|row| {
                let t = 1e-3 * f64::from(row);
                // A stretch ends eight rows behind a start, or behind an end.
                let since = (t + 0.24) % 3.0;
                let stroke = since.min(1.0) - (since - 1.5).clamp(0.0, 1.0);
                let pressure_pa = 3e5 + 2e4 * (t % 1.5) + 500.0 * normal.sample(&mut generator);
                [t, pressure_pa, 0.27 - 0.02 * stroke + 3e-5 * normal.sample(&mut generator)]
            })
            .collect();
        let from = |first: usize| {
            let [time_s, pressure_pa, length_m] = [0, 1, 2].map(|at| rows[first..].iter().map(|row| row[at]).collect());
            let time_s: Vec<f64> = time_s;
            let (pressure_pa, length_m): (Vec<f64>, Vec<f64>) = (pressure_pa, length_m);
            let n_rows = time_s.len();
            let recording = Recording {
                path: "strokes.csv".to_owned(),
                sha256: String::new(),
                samples: Samples::from_columns(&time_s, &pressure_pa, &length_m, &vec![100.0; n_rows]),
                segments: vec![0..n_rows; 1],
                repairs: Repairs::default(),
                ignored_columns: Vec::new(),
            };
            let direction = Direction::nothing(n_rows);
            let mut instants = Vec::new();
            let mut visit = |instant| instants.push(instant);
            walk(&recording, &direction, THRESHOLDS, &base(), 0, n_rows, 1, Channels::Recorded, &mut visit).unwrap();
            instants
        };
        let (whole, late) = (from(0), from(4000));
        let mut knees = 0;
        for (late, whole) in late.iter().zip(&whole[4000..]).take(35_900).skip(100) {
            knees += usize::from(whole.knee);
            assert_eq!(late.knee, whole.knee, "row {}", whole.row);
            let near = |late: f64, whole: f64, unit: f64| (late - whole).abs() < 1e-9 * unit;
            let (late, whole) = (&late.moment, &whole.moment);
            assert!(near(late.speed_m_per_s, whole.speed_m_per_s, 1.0));
            assert!(near(late.acceleration_m_per_s2, whole.acceleration_m_per_s2, 1e3));
            assert!(near(late.pressure_rate_pa_per_s, whole.pressure_rate_pa_per_s, 1e5));
            // Where the length rests, that of the pressure.
            assert!(near(late.slide_speed_m_per_s, whole.slide_speed_m_per_s, 1.0));
        }
        assert!(knees > 20, "{knees}");
    }

    #[test]
    fn a_slide_that_stops_does_not_crawl_on() {
        // A shortening by 50 mm/s that stops at 2 s.
        for (channels, stride) in [(Channels::Recorded, 1), (Channels::Smooth, 4)] {
            let instants = walked(channels, stride, |t| (3e5, 0.27 - 0.05 * (t - 1.0).clamp(0.0, 1.0)));
            let moment = |time_s: f64| instants[(time_s / 0.005) as usize / stride].moment;
            assert!((moment(1.96).slide_speed_m_per_s - 0.05).abs() < 3e-3);
            assert!(moment(2.02).slide_speed_m_per_s.abs() < 3e-3);
            let crept_m = moment(4.9).slide_m - moment(2.02).slide_m;
            assert!(crept_m.abs() < 2e-5, "{crept_m}");
        }
    }

    #[test]
    fn a_held_braid_slides_with_the_pressure() {
        let instants = walked(Channels::Recorded, 1, |t| (1e5 + 2e5 * (t - 2.0).clamp(0.0, 1.0), 0.25));
        let moment = |time_s: f64| instants[(time_s / 0.005) as usize].moment;
        let slid_m = moment(4.0).slide_m - moment(1.0).slide_m;
        assert!((slid_m - 2e5 * base().slide_m_per_pa(0.25)).abs() < 5e-5, "{slid_m}");
        assert!((moment(2.5).slide_speed_m_per_s - slid_m).abs() < 0.1 * slid_m);
    }
}
