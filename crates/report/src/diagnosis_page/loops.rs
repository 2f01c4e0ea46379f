//! Figure: one loop, measured and modelled, before and after.

use std::ops::Range;

use pam_muscle::Coordinate;

use super::coordinate::OnPage as _;
use super::course::{parabola, running_means};
use super::samples::{Samples, extent};
use crate::FigureError;
use crate::page::style::{AFTER, BEFORE};
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend, palette, thin};

/// Points of a line.
const POINTS: usize = 1500;

/// A stretch of a recording on which the effects tell.
#[derive(Debug)]
pub(super) struct Stretch<'a> {
    samples: &'a Samples,
    model_n: &'a [f64],
    rows: Range<usize>,
    coordinate: Coordinate,
    is_closed: bool,
}

impl<'a> Stretch<'a> {
    /// The closed loop that shows the effects best; where no loop is closed, the sixth of a recording.
    pub(super) fn most_telling(recordings: &'a [Samples]) -> Option<Self> {
        let closed = recordings.iter().flat_map(|samples| {
            let coordinate = coordinate(samples);
            closed_loops(samples, coordinate).into_iter().map(move |rows| (samples, coordinate, rows, true))
        });
        let sixths = recordings.iter().flat_map(|samples| {
            let n = samples.force_n.len();
            (0..6).map(move |part| (samples, coordinate(samples), part * n / 6..(part + 1) * n / 6, false))
        });
        Self::best(closed).or_else(|| Self::best(sixths))
    }

    /// Of the stretches whose mean square falls by much, the one in which that is most of what is to be seen: the less the
    /// force swings about its mean course, the larger the effects are drawn. A held-out one counts double.
    fn best(candidates: impl Iterator<Item = (&'a Samples, Coordinate, Range<usize>, bool)>) -> Option<Self> {
        let mut found: Vec<(f64, f64, Self)> = Vec::new();
        for (samples, coordinate, rows, is_closed) in candidates.filter(|(_, _, rows, _)| rows.len() >= 2) {
            let (Some(model_n), Some(after_n)) = (&samples.model_n, &samples.after_n) else { continue };
            let gain = rows.clone().map(|row| samples.before_n[row].powi(2) - after_n[row].powi(2)).sum::<f64>();
            let gain = gain / rows.len() as f64;
            let (x, force_n) = (&samples.column(coordinate)[rows.clone()], &samples.force_n[rows.clone()]);
            let course = parabola(x, force_n);
            let about: f64 = x.iter().zip(force_n).map(|(x, force_n)| (force_n - course.at(*x)).powi(2)).sum();
            let weight = if samples.held_out { 2.0 } else { 1.0 };
            let share = weight * gain / (about / rows.len() as f64).max(1e-9);
            found.push((gain, share, Self { samples, model_n, rows, coordinate, is_closed }));
        }
        let most = found.iter().map(|(gain, ..)| *gain).fold(f64::NEG_INFINITY, f64::max);
        let much = found.into_iter().filter(|(gain, ..)| *gain >= LEAST_GAIN * most);
        much.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(_, _, stretch)| stretch)
    }

    /// Whether it ends where it began.
    pub(super) fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Where it lies, in words.
    pub(super) fn words(&self) -> String {
        let time_s = self.samples.column(Coordinate::Time);
        let [from, to] = [time_s[self.rows.start], time_s[self.rows.end - 1]];
        let held_out = if self.samples.held_out { ", held out" } else { "" };
        format!("{}{held_out}, {}", self.samples.name, Coordinate::Time.interval(from, to))
    }

    fn column(&self, coordinate: Coordinate) -> &[f64] {
        &self.samples.column(coordinate)[self.rows.clone()]
    }
}

/// The coordinate that the force is drawn over: contraction, or pressure where the muscle hardly moves.
fn coordinate(samples: &Samples) -> Coordinate {
    let (lowest, highest) = extent(samples.column(Coordinate::Contraction).iter().copied());
    if highest - lowest > 1.0 { Coordinate::Contraction } else { Coordinate::Pressure }
}

/// Share of a recording's range by which both ends of a loop may differ, and that a turn has to come back by.
const CLOSED_WITHIN: f64 = 0.06;
/// Share of the range that a loop has to span: a small one shows little.
const LEAST_SPAN: f64 = 0.25;
/// Share of the largest gain that a stretch has to reach to be shown.
const LEAST_GAIN: f64 = 0.25;
/// Fewer samples are no loop.
const FEWEST: usize = 40;

/// Stretches from a turn of `coordinate` to the next one to the same side, cut where the two are level; pressure and
/// contraction both end where they began.
fn closed_loops(samples: &Samples, coordinate: Coordinate) -> Vec<Range<usize>> {
    let x = samples.column(coordinate);
    let range = |values: &[f64]| {
        let (lowest, highest) = extent(values.iter().copied());
        highest - lowest
    };
    let span = range(x);
    let turns = turns(x, CLOSED_WITHIN * span);
    let channels = [Coordinate::Pressure, Coordinate::Contraction].map(|channel| samples.column(channel));
    let mut loops = Vec::new();
    for three in turns.windows(3) {
        let [first, middle, last] = [three[0], three[1], three[2]];
        let is_peak = x[first] > x[middle];
        // The lower of two peaks, or the higher of two valleys, is where both ends can be.
        let level = if is_peak { x[first].min(x[last]) } else { x[first].max(x[last]) };
        let reached = |row: &usize| if is_peak { x[*row] <= level } else { x[*row] >= level };
        let (Some(start), Some(end)) = ((first..middle).find(&reached), (middle..=last).rev().find(reached)) else {
            continue;
        };
        let rows = start..end + 1;
        let is_closed = channels.iter().all(|channel| {
            let whole = range(channel);
            // A channel that stands still all through moves by its noise alone.
            (channel[start] - channel[end]).abs() <= CLOSED_WITHIN * whole.max(1e-9)
                || range(&channel[rows.clone()]) <= CLOSED_WITHIN * whole
        });
        if is_closed && rows.len() >= FEWEST && range(&x[rows.clone()]) >= LEAST_SPAN * span {
            loops.push(rows);
        }
    }
    loops
}

/// Rows where `x` turns: extremes that it comes back from by more than `least`.
fn turns(x: &[f64], least: f64) -> Vec<usize> {
    let mut turns = Vec::new();
    let (mut low, mut high, mut rising) = (0, 0, None);
    for row in 0..x.len() {
        if !x[row].is_finite() {
            continue;
        }
        low = if x[row] < x[low] { row } else { low };
        high = if x[row] > x[high] { row } else { high };
        if rising != Some(true) && x[row] - x[low] > least {
            turns.push(low);
            (rising, high) = (Some(true), row);
        } else if rising != Some(false) && x[high] - x[row] > least {
            turns.push(high);
            (rising, low) = (Some(false), row);
        }
    }
    // Where the recording ends it may have just come back.
    turns.extend(rising.map(|rising| if rising { high } else { low }));
    turns
}

/// Draws the loop as it is, and without its mean course.
pub(super) fn loops(stretch: &Stretch<'_>) -> Result<String, FigureError> {
    let coordinate = stretch.coordinate;
    let rows = stretch.rows.clone();
    // A model follows the noise of the gauge: running means let the loop be seen.
    let window = 1 + rows.len() / 120;
    let x = running_means(stretch.column(coordinate), window);
    let forces: [&[f64]; 3] = [&stretch.samples.force_n, &stretch.samples.base_n, stretch.model_n];
    let forces = forces.map(|force_n| running_means(&force_n[rows.clone()], window));
    let colors = [(palette::SILVER, 4.0), (BEFORE, 1.6), (AFTER, 1.6)];
    let course = parabola(&x, &forces[0]);
    let without = forces
        .each_ref()
        .map(|force_n| -> Vec<f64> { force_n.iter().zip(&x).map(|(force_n, x)| force_n - course.at(*x)).collect() });
    Canvas::document(900, 400, "A loop before and after", |canvas, sheet| {
        let [left, right] = sheet.inset(0.0, 28.0, 0.0, 0.0).columns([1.0, 1.0], 12.0);
        let mut draw = |cell: Rect, title: &str, y_title: &str, lines: &[Vec<f64>; 3]| {
            let (lowest, highest) = extent(lines.iter().flat_map(|force_n| force_n.iter().copied()));
            let (from, to) = extent(x.iter().copied());
            let x_axis = Axis::linear(coordinate.axis_title(), from, to, 6);
            let panel = Panel::new(cell, x_axis, Axis::linear(y_title, lowest, highest, 6), 16.0);
            panel.draw_frame(canvas);
            for (force_n, (color, width)) in lines.iter().zip(colors) {
                let kept = thin(force_n, POINTS);
                panel.line(canvas, kept.into_iter().map(|row| (x[row], force_n[row])), color, width);
            }
            canvas.bold(title, (panel.frame.left, cell.top + 18.0), Anchor::Start, 14.0, palette::INK);
        };
        draw(left, "Force", "force (N)", &forces);
        draw(right, "Less the mean course of the measured force", "difference (N)", &without);
        let keys = [
            Key::new("measured", Mark::Line(4.0), palette::SILVER),
            Key::new("base model", Mark::Line(2.0), BEFORE),
            Key::new("augmented model", Mark::Line(2.0), AFTER),
        ];
        legend(canvas, &keys, sheet.right - 16.0, 14.0);
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_extremes_and_small_wiggles_are_none() {
        let x: Vec<f64> = (0..400).map(|row| (0.05 * f64::from(row)).sin() + 0.01 * f64::from(row % 2)).collect();
        let found = turns(&x, 0.1);
        // At the start, and at π/2, 3π/2, … of 0.05 rad each.
        let expected = [0, 31, 94, 157, 220, 283, 346, 399];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(found, expected)| found.abs_diff(expected) <= 2), "{found:?}");
    }
}
