//! How a recording moves: its channels smooth, with their rates, as effects see them.
//!
//! Values, rates and the acceleration come from parabolas, contraction and slide, which effects remember, from averages
//! that never overshoot: see [`crate::smoothing`].

use std::io;

use pam_recording::Recording;

use crate::direction::{Direction, Thresholds};
use crate::effects::{Moment, Seen};
use crate::force::ForceModel;
use crate::knees::Knees;
use crate::smoothing::{Average, HALF_VALUE_WINDOW_S, HALF_WINDOW_S, Onward, Parabola, Sliding, Window};

/// Deviations of the noise in a threshold of the direction.
const DEVIATIONS_PER_THRESHOLD: f64 = 5.0;
/// Six deviations of the noise, from peak to peak, over a threshold of the direction.
pub const NOISE_PER_THRESHOLD: f64 = 6.0 / DEVIATIONS_PER_THRESHOLD;

/// Rows beyond the last one that a walk visits which it reads: more than the longest windows and the knees found in them reach.
const BEYOND: usize = 512;

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
    let rest_length_m = base.muscle().rest_length_m;
    let rest_slide_m_per_pa = base.slide_m_per_pa(rest_length_m);
    let mut first_s = None;
    for segment in recording.segments.iter().filter(|segment| segment.start < n_rows) {
        // What lies within the windows of the last row counts.
        let seen = segment.start..segment.end.min(n_rows.saturating_add(BEYOND));
        let rows = Rows::read(recording, seen)?;
        let n_visited = rows.time_s.len().min(n_rows - segment.start);
        let Some(&begin_s) = rows.time_s.first() else { continue };
        let origin_s = *first_s.get_or_insert(begin_s);
        let window = Window::over(&rows.time_s, HALF_WINDOW_S);
        let near = Window::over(&rows.time_s, HALF_VALUE_WINDOW_S);
        let average = Average::over(&rows.time_s);
        let windows = [&near, &window];
        let lengths = Path::of(rows.length_m, windows, thresholds.length_m / DEVIATIONS_PER_THRESHOLD);
        let pressures = Path::of(rows.pressure_pa, windows, thresholds.pressure_pa / DEVIATIONS_PER_THRESHOLD);
        let still = Still::of(&lengths, &window, thresholds.length_m);
        let (mut sharp_pressures, mut sharp_lengths) = (pressures.sharp(windows), lengths.sharp(windows));
        let mut forces = Sliding::along(&near, &rows.force_n);
        // Smooth forces are to be compared with equally smooth rates. What slides and remembers it starts and stops when the
        // drive does: a stop smeared over some rows would be a crawl.
        let recorded = channels == Channels::Recorded;
        let choose = |smooth_value: f64, recorded_value: f64| if recorded { recorded_value } else { smooth_value };
        let mut last: Option<(f64, f64)> = None;
        let noise = average.share_of_noise() * NOISE_PER_THRESHOLD;
        let within_s = window.width_s();
        let mut contraction = Onward::new(noise * thresholds.length_m, within_s);
        let mut slide =
            Onward::new(noise * (thresholds.length_m + rest_slide_m_per_pa * thresholds.pressure_pa), within_s);
        let mut rest_slide = Onward::new(noise * rest_slide_m_per_pa * thresholds.pressure_pa, within_s);
        let mut by_pressure_m = 0.0;
        let mut at = 0;
        while at < n_visited {
            let row = segment.start + at;
            let (sharp_pressure, sharp_length) = (sharp_pressures.at(at), sharp_lengths.at(at));
            let [pressure, length] = if recorded {
                [sharp_pressure, sharp_length]
            } else {
                [
                    pressures.smooth_near_knee(windows, at).unwrap_or(sharp_pressure),
                    lengths.smooth_near_knee(windows, at).unwrap_or(sharp_length),
                ]
            };
            let smooth_force_n = forces.parabola(at).value;
            let (average_m, average_pa) = (lengths.average(&average, at), pressures.average(&average, at));
            let (step_s, pressure_step_pa) =
                last.map_or((0.0, 0.0), |(time_s, pressure_pa)| (rows.time_s[at] - time_s, average_pa - pressure_pa));
            let slide_m_per_pa = base.slide_m_per_pa(average_m);
            let resting = still.at(at, sharp_length.slope);
            if resting {
                by_pressure_m += slide_m_per_pa * pressure_step_pa;
            }
            last = Some((rows.time_s[at], average_pa));
            let shortened_m = rest_length_m - average_m;
            let slide_speed_m_per_s = if resting { slide_m_per_pa * sharp_pressure.slope } else { -sharp_length.slope };
            let contraction_m = contraction.follow(shortened_m, -sharp_length.slope);
            let slide_m = slide.follow(shortened_m + by_pressure_m, slide_speed_m_per_s);
            let rest_slide_m =
                rest_slide.follow(by_pressure_m, if resting { slide_m_per_pa * sharp_pressure.slope } else { 0.0 });
            visit(Instant {
                row,
                moment: Moment {
                    recording: index,
                    time_s: rows.time_s[at] - origin_s,
                    step_s,
                    pressure_pa: choose(pressure.value, pressures.recorded(at)),
                    pressure_rate_pa_per_s: pressure.slope,
                    length_m: choose(length.value, lengths.recorded(at)),
                    contraction_ratio: contraction_m / rest_length_m,
                    speed_m_per_s: -length.slope,
                    slide_speed_m_per_s,
                    acceleration_m_per_s2: -length.curvature,
                    direction: direction.sign(row),
                    came: false,
                    slide_m,
                    rest_slide_m,
                    force_n: smooth_force_n,
                    warmth_k: warmth_k(&rows.temperature_k, &near, at),
                },
                force_n: choose(smooth_force_n, rows.force_n.get(at).copied().unwrap_or(0.0)),
                knee: recorded && lengths.knees.bend(at) != 0.0,
                settled: if !recorded {
                    let (from, to) = (at.saturating_sub(near.half), (at + near.half).min(rows.time_s.len() - 1));
                    direction.is_settled(segment.start + from)
                        && direction.is_settled(row)
                        && direction.is_settled(segment.start + to)
                } else {
                    direction.is_settled(row)
                },
            });
            at += stride;
        }
    }
    Ok(())
}

/// 20 °C, which effects count a temperature from, in K.
const ROOM_K: f64 = 293.15;

/// Temperature above [`ROOM_K`] around row `at`, in K; zero where none was logged.
fn warmth_k(temperature_k: &[f64], near: &Window, at: usize) -> f64 {
    if temperature_k.is_empty() { 0.0 } else { near.parabola(temperature_k, at).value - ROOM_K }
}

/// Columns of one segment.
#[derive(Default)]
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
    fn read(recording: &Recording, segment: std::ops::Range<usize>) -> io::Result<Self> {
        let mut rows = Self::default();
        for index in 0..recording.samples.n_chunks() {
            let here = recording.samples.chunk_rows(index);
            let (from, to) = (segment.start.max(here.start), segment.end.min(here.end));
            if from >= to {
                continue;
            }
            let chunk = recording.samples.chunk(index)?;
            let range = from - here.start..to - here.start;
            rows.time_s.extend_from_slice(&chunk.time_s()[range.clone()]);
            rows.pressure_pa.extend_from_slice(&chunk.pressure_pa()[range.clone()]);
            rows.length_m.extend_from_slice(&chunk.length_m()[range.clone()]);
            if recording.samples.has_force() {
                rows.force_n.extend_from_slice(&chunk.force_n()[range.clone()]);
            }
            if recording.samples.has_temperature() {
                rows.temperature_k.extend_from_slice(&chunk.temperature_k()[range]);
            }
        }
        Ok(rows)
    }
}

/// A channel of one segment.
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
        let Parabola { value, curvature, .. } = near.parabola(at);
        let knees = &self.path.knees;
        Parabola {
            value: value + knees.added(at),
            slope: window.parabola(at).slope + knees.rate(at),
            curvature: curvature + knees.bend(at),
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
    use pam_recording::{ReadOptions, read_recording};
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
