//! How a recording moves: its channels smooth, with their rates, as effects see them.
//!
//! Values, rates and the acceleration come from parabolas, contraction and slide, which effects remember, from averages
//! that never overshoot: see [`crate::smoothing`].

use std::io;

use crate::direction::{Direction, Thresholds};
use crate::effects::Moment;
use crate::effects::moment::SLIDE_M_PER_PA;
use crate::knees::Knees;
use crate::recording::Recording;
use crate::smoothing::{Average, HALF_VALUE_WINDOW_S, HALF_WINDOW_S, Onward, Parabola, Window};

/// Deviations of the noise in a threshold of the direction.
const DEVIATIONS_PER_THRESHOLD: f64 = 5.0;
/// Six deviations of the noise, from peak to peak, over a threshold of the direction.
const NOISE_PER_THRESHOLD: f64 = 6.0 / DEVIATIONS_PER_THRESHOLD;

/// One row of a recording with everything that effects need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Row of the recording.
    pub row: usize,
    /// What effects see.
    pub moment: Moment,
    /// Force, in N; as recorded or smooth like the other channels.
    pub force_n: f64,
    /// Whether the speed changes at once just before it; never where channels are smooth.
    pub knee: bool,
    /// Whether the direction is certain, all through the window where channels are smooth.
    pub settled: bool,
}

/// Which values of the channels an instant carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// As recorded.
    Recorded,
    /// Smooth.
    Smooth,
}

/// Walks over every `stride`-th row of `recording`, in order, a segment at a time. `index` is the number of the recording,
/// `rest_length_m` that of the muscle.
///
/// # Errors
/// Where the samples cannot be read back.
#[expect(clippy::too_many_arguments, reason = "what to walk over and how; every caller names them all")]
pub fn walk(
    recording: &Recording,
    direction: &Direction,
    thresholds: Thresholds,
    rest_length_m: f64,
    index: usize,
    stride: usize,
    channels: Channels,
    visit: &mut dyn FnMut(Instant),
) -> io::Result<()> {
    let mut first_s = None;
    for segment in &recording.segments {
        let rows = Rows::read(recording, segment.clone())?;
        let Some(&begin_s) = rows.time_s.first() else { continue };
        let origin_s = *first_s.get_or_insert(begin_s);
        let window = Window::over(&rows.time_s, HALF_WINDOW_S);
        let near = Window::over(&rows.time_s, HALF_VALUE_WINDOW_S);
        let average = Average::over(&rows.time_s);
        let still = Still::of(&rows, &window, thresholds.length_m);
        // Smooth forces are to be compared with equally smooth rates.
        let recorded = channels == Channels::Recorded;
        let knees = recorded
            .then(|| Knees::of(&rows.length_m, [&window, &near], thresholds.length_m / DEVIATIONS_PER_THRESHOLD));
        let path_m = knees.as_ref().map_or(&rows.length_m, |knees| &knees.rest);
        let mut last: Option<(f64, f64)> = None;
        let noise = average.share_of_noise() * NOISE_PER_THRESHOLD;
        let mut contraction = Onward::new(noise * thresholds.length_m);
        let mut slide = Onward::new(noise * (thresholds.length_m + SLIDE_M_PER_PA * thresholds.pressure_pa));
        let mut by_pressure_m = 0.0;
        let mut at = 0;
        while at < rows.time_s.len() {
            let [pressure, mut length, force] = [&rows.pressure_pa, path_m, &rows.force_n].map(|channel| {
                let Parabola { value, curvature, .. } = near.parabola(channel, at);
                Parabola { value, curvature, ..window.parabola(channel, at) }
            });
            // A move that has ended does not go on for the rows that it is averaged over.
            let mut average_m = average.at(path_m, at);
            if let Some(Knees { rest, rates, bends }) = &knees {
                let added_m = rows.length_m[at] - rest[at];
                average_m += added_m;
                length.value += added_m;
                length.slope += rates[at];
                length.curvature += bends[at];
            }
            let row = segment.start + at;
            let average_pa = average.at(&rows.pressure_pa, at);
            let (step_s, pressure_step_pa) =
                last.map_or((0.0, 0.0), |(time_s, pressure_pa)| (rows.time_s[at] - time_s, average_pa - pressure_pa));
            let resting = still.at(at);
            if resting {
                by_pressure_m += SLIDE_M_PER_PA * pressure_step_pa;
            }
            last = Some((rows.time_s[at], average_pa));
            let shortened_m = rest_length_m - average_m;
            let contraction_m = contraction.follow(shortened_m);
            let slide_m = slide.follow(shortened_m + by_pressure_m);
            let choose = |smooth_value: f64, recorded_value: f64| if recorded { recorded_value } else { smooth_value };
            let force_n = choose(force.value, rows.force_n.get(at).copied().unwrap_or(0.0));
            visit(Instant {
                row,
                moment: Moment {
                    recording: index,
                    time_s: rows.time_s[at] - origin_s,
                    step_s,
                    pressure_pa: choose(pressure.value, rows.pressure_pa[at]),
                    pressure_rate_pa_per_s: pressure.slope,
                    length_m: choose(length.value, rows.length_m[at]),
                    contraction_ratio: contraction_m / rest_length_m,
                    speed_m_per_s: -length.slope,
                    slide_speed_m_per_s: if resting { SLIDE_M_PER_PA * pressure.slope } else { -length.slope },
                    acceleration_m_per_s2: -length.curvature,
                    direction: direction.sign(row),
                    came: false,
                    slide_m,
                    force_n: force.value,
                },
                force_n,
                knee: knees.as_ref().is_some_and(|knees| knees.bends[at] != 0.0),
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

/// Columns of one segment.
struct Rows {
    time_s: Vec<f64>,
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    /// Empty where none was recorded.
    force_n: Vec<f64>,
}

impl Rows {
    fn read(recording: &Recording, segment: std::ops::Range<usize>) -> io::Result<Self> {
        let mut rows = Self { time_s: Vec::new(), pressure_pa: Vec::new(), length_m: Vec::new(), force_n: Vec::new() };
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
                rows.force_n.extend_from_slice(&chunk.force_n()[range]);
            }
        }
        Ok(rows)
    }
}

/// Time to either side in which a length that stands still does not move, in s. The direction waits for longer, because it is
/// wrong for long where it is wrong; what slides under pressure slides at once.
const STILL_S: f64 = 0.1;

/// Where the length stands still: it moves by less than a threshold within the time around.
struct Still {
    /// Smooth lengths at every `every` rows.
    lengths: Vec<f64>,
    every: usize,
    /// Lengths to either side that are compared.
    reach: usize,
    threshold_m: f64,
}

impl Still {
    fn of(rows: &Rows, window: &Window, threshold_m: f64) -> Self {
        let every = window.half;
        let lengths =
            (0..rows.length_m.len()).step_by(every).map(|at| window.parabola(&rows.length_m, at).value).collect();
        let reach = ((STILL_S / (every as f64 * window.period_s)).ceil() as usize).clamp(1, 20);
        Self { lengths, every, reach, threshold_m }
    }

    fn at(&self, row: usize) -> bool {
        let center = (row / self.every).min(self.lengths.len().saturating_sub(1));
        let around =
            &self.lengths[center.saturating_sub(self.reach)..(center + self.reach + 1).min(self.lengths.len())];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &length in around {
            low = low.min(length);
            high = high.max(length);
        }
        high - low <= self.threshold_m
    }
}
