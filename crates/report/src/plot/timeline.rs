//! Drawing over time: lines that a gap interrupts, bands, stretches that a flag marks.
//!
//! The fit's residual, a prediction and the strips of the diagnosis page share it; other pages take it from here, as
//! `pam_report::plot::Timeline`.

use std::ops::Range;

use crate::plot::{Canvas, Color, Panel, Rect, thin};

/// Bins of a band, which more would not sharpen.
const BINS: usize = 700;
/// A step of the clock this many times the usual one is a gap.
const GAP: f64 = 5.0;

/// The clock of one recording.
#[derive(Debug, Clone, Copy)]
pub struct Timeline<'a> {
    /// Time of every sample, in s.
    pub time_s: &'a [f64],
}

impl Timeline<'_> {
    /// Stretches without a gap.
    pub fn segments(&self) -> Vec<Range<usize>> {
        let mut steps: Vec<f64> = self.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if steps.is_empty() {
            return std::iter::once(0..self.time_s.len()).filter(|all| !all.is_empty()).collect();
        }
        let middle = steps.len() / 2;
        let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let mut segments = Vec::new();
        let mut start = 0;
        for row in 1..=self.time_s.len() {
            let ends = row == self.time_s.len() || {
                let step = self.time_s[row] - self.time_s[row - 1];
                step > GAP * usual || step < 0.0
            };
            if ends {
                segments.push(start..row);
                start = row;
            }
        }
        segments
    }

    /// A line through `values`, at most about `points` of them, cut at the edges of the panel.
    pub fn line(
        &self,
        canvas: &mut Canvas<'_>,
        panel: &Panel,
        values: &[f64],
        (color, width): (Color, f64),
        points: usize,
    ) {
        for segment in self.segments() {
            let share = points * segment.len() / values.len().max(1);
            let kept = thin(&values[segment.clone()], share.max(8));
            let within = |value: f64| value.clamp(panel.y.from, panel.y.to);
            let at = |row: usize| (self.time_s[segment.start + row], within(values[segment.start + row]));
            panel.line(canvas, kept.into_iter().map(at), color, width);
        }
    }

    /// The area between `low` and `high`, the widest of each bin, cut at the edges of the panel.
    pub fn band(&self, canvas: &mut Canvas<'_>, panel: &Panel, [low, high]: [&[f64]; 2], color: Color) {
        for segment in self.segments() {
            let bins = (BINS * segment.len() / self.time_s.len().max(1)).clamp(1, segment.len());
            let (mut lower, mut upper) = (Vec::new(), Vec::new());
            for bin in 0..bins {
                let edge = |bin: usize| segment.start + bin * segment.len() / bins;
                let rows = edge(bin)..edge(bin + 1);
                let finite = |values: &[f64]| {
                    values[rows.clone()].iter().copied().filter(|value| value.is_finite()).collect::<Vec<_>>()
                };
                let least = finite(low).into_iter().fold(f64::INFINITY, f64::min);
                let most = finite(high).into_iter().fold(f64::NEG_INFINITY, f64::max);
                if least <= most {
                    let middle = 0.5 * (self.time_s[rows.start] + self.time_s[rows.end - 1]);
                    lower.push(panel.at(middle, least.clamp(panel.y.from, panel.y.to)));
                    upper.push(panel.at(middle, most.clamp(panel.y.from, panel.y.to)));
                }
            }
            canvas.area(upper.into_iter().chain(lower.into_iter().rev()), color);
        }
    }

    /// Marks the stretches where `flags` is set, each at least a pixel wide.
    pub fn shade(&self, canvas: &mut Canvas<'_>, panel: &Panel, flags: impl Fn(usize) -> bool, color: Color) {
        let x = |row: usize| panel.at(self.time_s[row], panel.y.from).0;
        let mut last = f64::NEG_INFINITY;
        for segment in self.segments() {
            for run in runs(segment, &flags) {
                let (left, right) = (x(run.start), x(run.end - 1));
                // Half a sample to either side, and never over what is marked already.
                let left = (left - 0.5).max(last).max(panel.frame.left);
                let right = (right + 0.5).max(left + 1.0).min(panel.frame.right);
                if left < right {
                    canvas.rect(Rect { left, right, ..panel.frame }, color);
                    last = right;
                }
            }
        }
    }
}

/// Stretches of `rows` where `flags` is set.
fn runs(rows: Range<usize>, flags: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for row in rows.filter(|&row| flags(row)) {
        match found.last_mut() {
            Some(run) if run.end == row => run.end += 1,
            _ => found.push(row..row + 1),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_ends_a_segment_and_a_stretch() {
        let time_s = [0.0, 0.1, 0.2, 5.0, 5.1, 5.2];
        assert_eq!(Timeline { time_s: &time_s }.segments(), [0..3, 3..6]);
        assert_eq!(Timeline { time_s: &[] }.segments(), []);
        assert_eq!(Timeline { time_s: &[1.0] }.segments(), std::iter::once(0..1).collect::<Vec<_>>());
        assert_eq!(runs(0..6, |row| row != 2), [0..2, 3..6]);
    }
}
