//! Figure: one loop, measured and modelled, before and after.

use pam_core::artifact::diagnosis::Coordinate;

use std::ops::Range;

use super::coordinate::OnPage as _;
use super::samples::{Samples, extent};
use crate::FigureError;
use crate::page::style::{AFTER, BEFORE};
use crate::plot::{Anchor, Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, palette, thin};

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
    /// The closed loop, of held-out recordings where there are any, whose mean square falls the most; where no loop is closed,
    /// the sixth of a recording.
    pub(super) fn most_telling(recordings: &'a [Samples]) -> Option<Self> {
        let held_out = recordings.iter().any(|samples| samples.held_out && samples.model_n.is_some());
        let chosen = || recordings.iter().filter(|samples| samples.held_out == held_out);
        let closed = chosen().flat_map(|samples| {
            let coordinate = coordinate(samples);
            closed_loops(samples, coordinate).into_iter().map(move |rows| (samples, coordinate, rows, true))
        });
        let sixths = chosen().flat_map(|samples| {
            let n = samples.force_n.len();
            (0..6).map(move |part| (samples, coordinate(samples), part * n / 6..(part + 1) * n / 6, false))
        });
        Self::best(closed).or_else(|| Self::best(sixths))
    }

    fn best(candidates: impl Iterator<Item = (&'a Samples, Coordinate, Range<usize>, bool)>) -> Option<Self> {
        let mut best: Option<(f64, Self)> = None;
        for (samples, coordinate, rows, is_closed) in candidates.filter(|(_, _, rows, _)| rows.len() >= 2) {
            let (Some(model_n), Some(after_n)) = (&samples.model_n, &samples.after_n) else { continue };
            let gain = rows.clone().map(|row| samples.before_n[row].powi(2) - after_n[row].powi(2)).sum::<f64>();
            let gain = gain / rows.len() as f64;
            if best.as_ref().is_none_or(|(most, _)| gain > *most) {
                best = Some((gain, Self { samples, model_n, rows, coordinate, is_closed }));
            }
        }
        best.map(|(_, stretch)| stretch)
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
    let x = stretch.column(coordinate);
    let rows = stretch.rows.clone();
    let lines: [(&[f64], Color, f64); 3] = [
        (&stretch.samples.force_n[rows.clone()], palette::SILVER, 4.0),
        (&stretch.samples.base_n[rows.clone()], BEFORE, 1.6),
        (&stretch.model_n[rows], AFTER, 1.6),
    ];
    let course = parabola(x, lines[0].0);
    let without: Vec<Vec<f64>> = lines
        .iter()
        .map(|(force_n, _, _)| force_n.iter().zip(x).map(|(force_n, x)| force_n - course.at(*x)).collect())
        .collect();
    Canvas::document(900, 400, "A loop before and after", |canvas, sheet| {
        let [left, right] = sheet.inset(0.0, 28.0, 0.0, 0.0).columns([1.0, 1.0], 12.0);
        let mut draw = |cell: Rect, title: &str, y_title: &str, lines: &[(&[f64], Color, f64)]| {
            let (lowest, highest) = extent(lines.iter().flat_map(|(force_n, _, _)| force_n.iter().copied()));
            let (from, to) = extent(x.iter().copied());
            let x_axis = Axis::linear(coordinate.axis_title(), from, to, 6);
            let panel = Panel::new(cell, x_axis, Axis::linear(y_title, lowest, highest, 6), 16.0);
            panel.draw_frame(canvas);
            for (force_n, color, width) in lines {
                let kept = thin(force_n, POINTS);
                panel.line(canvas, kept.into_iter().map(|row| (x[row], force_n[row])), *color, *width);
            }
            canvas.bold(title, (panel.frame.left, cell.top + 18.0), Anchor::Start, 14.0, palette::INK);
        };
        draw(left, "Force", "force (N)", &lines);
        let without = [0, 1, 2].map(|line| (without[line].as_slice(), lines[line].1, lines[line].2));
        draw(right, "Less the mean course of the measured force", "difference (N)", &without);
        let keys = [
            Key::new("measured", Mark::Line(4.0), palette::SILVER),
            Key::new("base model", Mark::Line(2.0), BEFORE),
            Key::new("augmented model", Mark::Line(2.0), AFTER),
        ];
        legend(canvas, &keys, sheet.right - 16.0, 14.0);
    })
}

/// `a + b u + c u²` with `u = (x - middle) / span`.
struct Parabola {
    middle: f64,
    span: f64,
    weights: [f64; 3],
}

impl Parabola {
    fn at(&self, x: f64) -> f64 {
        let u = (x - self.middle) / self.span;
        self.weights[0] + u * (self.weights[1] + u * self.weights[2])
    }
}

/// Least squares by Gram–Schmidt on 1, u, u²; a column without anything of its own gets no weight.
fn parabola(x: &[f64], y: &[f64]) -> Parabola {
    let (lowest, highest) = extent(x.iter().copied());
    let (middle, span) = (0.5 * (lowest + highest), (0.5 * (highest - lowest)).max(1e-9));
    let u: Vec<f64> = x.iter().map(|x| (x - middle) / span).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Each column with what it is in terms of the powers of u.
    let mut basis: Vec<(Vec<f64>, [f64; 3])> = Vec::new();
    for power in 0..3 {
        let mut column: Vec<f64> = u.iter().map(|u| u.powi(power as i32)).collect();
        let mut terms = [0.0; 3];
        terms[power] = 1.0;
        for (earlier, earlier_terms) in &basis {
            let share = dot(&column, earlier) / dot(earlier, earlier);
            column.iter_mut().zip(earlier).for_each(|(value, earlier)| *value -= share * earlier);
            terms.iter_mut().zip(earlier_terms).for_each(|(term, earlier)| *term -= share * earlier);
        }
        if dot(&column, &column) > 1e-9 * x.len() as f64 {
            basis.push((column, terms));
        }
    }
    let mut weights = [0.0; 3];
    for (column, terms) in &basis {
        let share = dot(column, y) / dot(column, column);
        weights.iter_mut().zip(terms).for_each(|(weight, term)| *weight += share * term);
    }
    Parabola { middle, span, weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_again() {
        let x: Vec<f64> = (0..50).map(|index| 3.0 + 0.1 * f64::from(index)).collect();
        let y: Vec<f64> = x.iter().map(|x| 2.0 - x + 0.5 * x * x).collect();
        let course = parabola(&x, &y);
        assert!(x.iter().zip(&y).all(|(x, y)| (course.at(*x) - y).abs() < 1e-9));
    }

    #[test]
    fn turns_are_extremes_and_small_wiggles_are_none() {
        let x: Vec<f64> = (0..400).map(|row| (0.05 * f64::from(row)).sin() + 0.01 * f64::from(row % 2)).collect();
        let found = turns(&x, 0.1);
        // At the start, and at π/2, 3π/2, … of 0.05 rad each.
        let expected = [0, 31, 94, 157, 220, 283, 346, 399];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(found, expected)| found.abs_diff(expected) <= 2), "{found:?}");
    }

    #[test]
    fn a_channel_that_stands_still_has_a_mean_course() {
        let course = parabola(&[2.0; 4], &[1.0, 2.0, 3.0, 4.0]);
        assert!((course.at(2.0) - 2.5).abs() < 1e-12);
    }
}
