//! Figure: residual against each coordinate, as small multiples of one height.

use pam_artifact::diagnosis::Region;
use pam_muscle::Coordinate;

use super::coordinate::OnPage as _;
use super::samples::{Samples, extent};
use crate::FigureError;
use crate::page::style::{AFTER, BEFORE, MARKED, NOISE};
use crate::plot::{Anchor, Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, note, palette};
use crate::residual_cells::quantile;

/// Coordinates shown, row by row.
const SHOWN: [Coordinate; 7] = [
    Coordinate::TravelSinceReversal,
    Coordinate::TimeSinceLastMove,
    Coordinate::Speed,
    Coordinate::Cycle,
    Coordinate::Pressure,
    Coordinate::Contraction,
    Coordinate::Force,
];
const COLUMNS: usize = 4;
/// Size of a panel with its axis and title, in pixels.
const CELL: (f64, f64) = (204.0, 226.0);
/// Room for the common vertical axis.
const LEFT: f64 = 74.0;
/// Bins along a coordinate.
const BINS: usize = 28;
/// Fewer samples say nothing about a bin.
const FEWEST: f64 = 5.0;

/// Draws the panels.
pub(super) fn profiles(recordings: &[Samples], regions: &[Region], noise_n: f64) -> Result<String, FigureError> {
    let profiles: Vec<Profile> = SHOWN.iter().map(|coordinate| Profile::new(*coordinate, recordings)).collect();
    let ends = profiles.iter().flat_map(|profile| profile.before.iter().chain(&profile.after)).flatten();
    let sizes: Vec<f64> = ends.map(|bin| bin.mean.abs() + bin.spread).collect();
    let limit = 1.08 * quantile(&sizes, 0.995).max(1.2 * noise_n);
    let limit = if limit > 0.0 { limit } else { 1.0 };
    let rows = SHOWN.len().div_ceil(COLUMNS);
    let height = 34.0 + CELL.1 * rows as f64;
    Canvas::document(900, height as u32, "Residual against each coordinate", |canvas, sheet| {
        for (index, profile) in profiles.iter().enumerate() {
            let (row, column) = (index / COLUMNS, index % COLUMNS);
            let (left, top) = (LEFT + CELL.0 * column as f64, 34.0 + CELL.1 * row as f64);
            let frame = Rect { left, top: top + 30.0, right: left + CELL.0 - 32.0, bottom: top + CELL.1 - 48.0 };
            let y = Axis::exact(if column == 0 { "residual (N)" } else { "" }, -limit, limit, 5);
            let mut panel = Panel { frame, x: profile.axis.clone(), y, upward_labels: false };
            if column > 0 {
                panel.y.ticks.iter_mut().for_each(|(_, label)| label.clear());
            }
            profile.draw(canvas, &panel, regions, noise_n);
        }
        let mut keys = Vec::new();
        if profiles.iter().any(|profile| profile.after.iter().any(Option::is_some)) {
            keys.push(Key::new("before: mean, and one standard deviation around it", Mark::Line(2.2), BEFORE));
            keys.push(Key::new("after", Mark::Line(2.2), AFTER));
        } else {
            keys.push(Key::new("base model: mean, and one standard deviation around it", Mark::Line(2.2), BEFORE));
        }
        keys.push(Key::new("± noise floor", Mark::Patch, NOISE));
        if regions.iter().any(|region| SHOWN.contains(&region.coordinate)) {
            keys.push(Key::new("region that stands out", Mark::Patch, MARKED.faded(0.45)));
        }
        legend(canvas, &keys, sheet.right - 32.0, 16.0);
    })
}

/// Samples of one bin.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bin {
    at: f64,
    mean: f64,
    spread: f64,
}

struct Profile {
    coordinate: Coordinate,
    axis: Axis,
    before: Vec<Option<Bin>>,
    after: Vec<Option<Bin>>,
}

impl Profile {
    fn new(coordinate: Coordinate, recordings: &[Samples]) -> Self {
        let axis = axis(coordinate, recordings);
        let bins = |residual: fn(&Samples) -> Option<&[f64]>| {
            let n_bins = n_bins(coordinate, &axis);
            let mut sums = vec![(0.0, 0.0, 0.0, 0.0); n_bins];
            for samples in recordings {
                let Some(residual_n) = residual(samples) else { continue };
                for ((value, residual_n), settled) in
                    samples.column(coordinate).iter().zip(residual_n).zip(&samples.settled)
                {
                    let share = axis.fraction(value.max(axis.from));
                    if *settled && (0.0..=1.0).contains(&share) {
                        let bin = ((share * n_bins as f64) as usize).min(n_bins - 1);
                        let sum: &mut (f64, f64, f64, f64) = &mut sums[bin];
                        *sum = (sum.0 + 1.0, sum.1 + value, sum.2 + residual_n, sum.3 + residual_n * residual_n);
                    }
                }
            }
            let bin = |(n, at, sum, squares): (f64, f64, f64, f64)| {
                let mean = sum / n;
                let spread = f64::sqrt((squares / n - mean * mean).max(0.0));
                (n >= FEWEST).then_some(Bin { at: (at / n).max(axis.from), mean, spread })
            };
            sums.into_iter().map(bin).collect()
        };
        let before = bins(|samples| Some(&samples.before_n));
        let after = bins(|samples| samples.after_n.as_deref());
        Self { coordinate, before, after, axis }
    }

    fn draw(&self, canvas: &mut Canvas<'_>, panel: &Panel, regions: &[Region], noise_n: f64) {
        let words = self.coordinate.words();
        let title: String = words.chars().take(1).flat_map(char::to_uppercase).chain(words.chars().skip(1)).collect();
        panel.draw_frame(canvas);
        panel.band(canvas, -noise_n, noise_n, NOISE);
        for region in regions.iter().filter(|region| region.coordinate == self.coordinate) {
            let [left, right] = [region.from, region.to].map(|value| {
                let value = self.coordinate.of_si(value).max(panel.x.from);
                panel.frame.left + panel.x.fraction(value).clamp(0.0, 1.0) * panel.frame.width()
            });
            let right = right.max(left + 2.0);
            canvas.rect(Rect { left, right, ..panel.frame }, MARKED);
            canvas.rect(Rect { left, right, top: panel.frame.top - 4.0, bottom: panel.frame.top }, palette::ORANGE);
        }
        canvas.bold(&title, (panel.frame.left, panel.frame.top - 15.0), Anchor::Start, 13.0, palette::INK);
        let filled = self.before.iter().flatten().count();
        if filled < 2 {
            note(canvas, panel.frame, if filled == 0 { "no samples" } else { "does not vary" });
            return;
        }
        draw_bins(canvas, panel, &self.before, BEFORE);
        draw_bins(canvas, panel, &self.after, AFTER);
    }
}

fn draw_bins(canvas: &mut Canvas<'_>, panel: &Panel, bins: &[Option<Bin>], color: Color) {
    // Across empty bins nothing is drawn.
    for run in bins.split(Option::is_none) {
        let run: Vec<Bin> = run.iter().flatten().copied().collect();
        let at = |bin: &Bin, value: f64| panel.at(bin.at, value.clamp(panel.y.from, panel.y.to));
        if let [bin] = run[..] {
            canvas.line([at(&bin, bin.mean - bin.spread), at(&bin, bin.mean + bin.spread)], color.faded(0.4), 2.0);
        }
        let upper = run.iter().map(|bin| at(bin, bin.mean + bin.spread));
        let lower = run.iter().rev().map(|bin| at(bin, bin.mean - bin.spread));
        if run.len() > 1 {
            canvas.area(upper.chain(lower), color.faded(0.2));
        }
        canvas.line(run.iter().map(|bin| at(bin, bin.mean)), color, 2.2);
        if run.len() < 12 {
            for bin in &run {
                canvas.dot(at(bin, bin.mean), 2.6, color);
            }
        }
    }
}

/// One bin per cycle, where they are few.
fn n_bins(coordinate: Coordinate, axis: &Axis) -> usize {
    let span = axis.to - axis.from;
    if coordinate == Coordinate::Cycle && span <= 40.0 { (span.round() as usize).max(1) } else { BINS }
}

fn axis(coordinate: Coordinate, recordings: &[Samples]) -> Axis {
    let title = coordinate.shown_unit().to_owned();
    let title = if title.is_empty() { "number".to_owned() } else { title };
    let values: Vec<f64> = recordings
        .iter()
        .flat_map(|samples| samples.column(coordinate).iter().zip(&samples.settled))
        .filter(|(value, settled)| **settled && value.is_finite())
        .map(|(value, _)| *value)
        .collect();
    let (lowest, highest) = extent(values.iter().copied());
    if coordinate == Coordinate::Cycle {
        return Axis::exact(title, lowest.floor() - 0.5, highest.floor() + 0.5, 5);
    }
    let skewed =
        matches!(coordinate, Coordinate::TravelSinceReversal | Coordinate::TimeSinceLastMove | Coordinate::Speed);
    if skewed {
        // The small values matter: after the reversal, right after the stop.
        let positive: Vec<f64> = values.iter().copied().filter(|value| *value > 0.0).collect();
        let (low, high) = (quantile(&positive, 0.02), quantile(&positive, 0.999));
        if high > 20.0 * low {
            return Axis::logarithmic(title, low.max(1e-3 * high), high);
        }
    }
    Axis::linear(title, lowest, highest, 4)
}
