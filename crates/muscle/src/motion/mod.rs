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

mod followed;
mod local;
mod path;

use followed::Followed;
use local::{Local, View};

/// Deviations of the noise in a threshold of the direction.
const DEVIATIONS_PER_THRESHOLD: f64 = 5.0;
/// Six deviations of the noise, from peak to peak, over a threshold of the direction.
pub const NOISE_PER_THRESHOLD: f64 = 6.0 / DEVIATIONS_PER_THRESHOLD;

/// Rows of a segment that are looked at in one go, each go on a thread of its own.
const STRETCH_ROWS: usize = 1 << 15;

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
        let start = Self {
            contraction_ratio: NOTHING,
            pressure_pa: NOTHING,
            force_n: NOTHING,
            warmth_k: NOTHING,
            duration_s: f64::NEG_INFINITY,
        };
        instants.fold(start, |seen, instant| Self {
            contraction_ratio: widened(seen.contraction_ratio, instant.moment.contraction_ratio),
            pressure_pa: widened(seen.pressure_pa, instant.moment.pressure_pa),
            force_n: widened(seen.force_n, instant.force_n),
            warmth_k: widened(seen.warmth_k, instant.moment.warmth_k),
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
