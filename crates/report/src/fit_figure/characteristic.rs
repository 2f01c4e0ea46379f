//! Panels a and b: force against length and against pressure, in slow sweeps and at levels of the other channel; measured against
//! modelled force where a recording has neither.

use super::clean::{Clean, extent, mean, quantile};
use super::curve_labels::{label_within, labels};
use super::curves::{Mean, curves};
use super::sweeps::{Sweep, sweeps};
use super::{CONTRACTING, EXTENDING, Role};
use crate::number::significant;
use crate::plot::{Axis, Canvas, Key, Mark, Panel, Rect, density, legend, note, palette, round_levels, thin, title};

/// The channel along the horizontal axis; the other of the two tells curves apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Abscissa {
    /// Length; curves differ in pressure.
    Length,
    /// Pressure; curves differ in length.
    Pressure,
}

/// Points of measured and of modelled force in the panel, over all recordings.
const POINTS: usize = 12_000;
/// More turns than this in one recording are noise in its direction.
const MOST_RUNS: usize = 300;

impl Abscissa {
    pub(super) fn along(self, recording: &Clean) -> &[f64] {
        if self == Self::Length { &recording.length_mm } else { &recording.pressure_kpa }
    }

    pub(super) fn across(self, recording: &Clean) -> &[f64] {
        if self == Self::Length { &recording.pressure_kpa } else { &recording.length_mm }
    }

    /// Whether the channel stands still: a clamped muscle yields by less than half a percent, a regulated
    /// pressure stays within an eighth of the highest one.
    fn is_constant(self, recording: &Clean, recordings: &[Clean]) -> bool {
        let values = self.along(recording);
        let largest = extent(recordings.iter().flat_map(|other| self.along(other).iter().map(|value| value.abs()))).1;
        let share = if self == Self::Length { 0.005 } else { 0.12 };
        quantile(values, 0.98) - quantile(values, 0.02) <= share * largest
    }

    fn axis(self, lowest: f64, highest: f64) -> Axis {
        Axis::linear(if self == Self::Length { "length (mm)" } else { "pressure (kPa)" }, lowest, highest, 7)
    }

    /// A level of the other channel in words.
    pub(super) fn level_text(self, level: f64) -> String {
        if self == Self::Length {
            format!("{} kPa", significant(level, 3))
        } else {
            format!("{} mm", significant(level, 4).trim_end_matches(".0"))
        }
    }
}

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, (letter, abscissa): (&str, Abscissa), recordings: &[Clean]) {
    let still: Vec<&Clean> =
        recordings.iter().filter(|recording| abscissa.is_constant(recording, recordings)).collect();
    let sweeps = sweeps(abscissa, recordings);
    let levels = levels(abscissa, &still);
    let mut means: Vec<Mean> = still.iter().flat_map(|recording| means(abscissa, recording, &levels)).collect();
    // Levels of a single recording are dots one above the other, and no curve.
    let no_curve = curves(&means, 0.0).iter().all(|curve| curve.model.len() < 2);
    if no_curve {
        means.clear();
    }
    if sweeps.is_empty() && no_curve {
        agreement(canvas, cell, (letter, abscissa), recordings);
        return;
    }
    let along = extent(recordings.iter().flat_map(|recording| abscissa.along(recording).iter().copied()));
    let forces = |sweep: &Sweep<'_>| {
        let force_n = &sweep.recording.force_n[sweep.rows.clone()];
        let (lowest, highest) = extent(force_n.iter().chain(&sweep.recording.model_n[sweep.rows.clone()]).copied());
        [lowest, highest]
    };
    let force =
        extent(sweeps.iter().flat_map(forces).chain(means.iter().flat_map(|mean| [mean.force_n, mean.model_n])));
    let labels = labels(abscissa, &sweeps, &means, &levels, along);
    let right = if labels.is_empty() { 20.0 } else { 74.0 };
    let force_axis = Axis::linear("force (N)", force.0.min(0.0), force.1, 6);
    let panel = Panel::new(cell, abscissa.axis(along.0, along.1), force_axis, right);
    panel.draw_frame(canvas);
    draw_sweeps(canvas, &panel, abscissa, &sweeps);
    draw_means(canvas, &panel, &means);
    panel.label_right(canvas, &labels);
    label_within(canvas, &panel, (abscissa, along), &sweeps);
    draw_legend(canvas, cell, (letter, abscissa), (&sweeps, &means));
}

/// Where there is no sweep: measured against modelled force, what was fitted on the left and what was held out on the right.
fn agreement(canvas: &mut Canvas<'_>, cell: Rect, (letter, abscissa): (&str, Abscissa), recordings: &[Clean]) {
    let has = |role: Role| recordings.iter().any(|recording| recording.role == role);
    let (role, what) = match abscissa {
        Abscissa::Length => (Role::Estimation, "Measured against modelled, estimation"),
        Abscissa::Pressure => (Role::Validation, "Measured against modelled, validation"),
    };
    title(canvas, cell, letter, what);
    if !has(role) {
        note(canvas, cell, "no such recording");
        return;
    }
    let chosen = || recordings.iter().filter(|recording| recording.role == role);
    let ends = extent(chosen().flat_map(|recording| recording.force_n.iter().copied()));
    let points =
        chosen().flat_map(|recording| recording.model_n.iter().copied().zip(recording.force_n.iter().copied()));
    let axis = |name: &str| Axis::linear(name, ends.0, ends.1, 6);
    let panel = density(canvas, cell, points, [axis("modelled force (N)"), axis("measured force (N)")]);
    let (low, high) = (panel.x.from, panel.x.to);
    panel.line(canvas, [(low, low), (high, high)], palette::VERMILION, 1.2);
}

/// Round levels of the other channel, for recordings in which this one stands still.
fn levels(abscissa: Abscissa, still: &[&Clean]) -> Vec<f64> {
    if still.is_empty() {
        return Vec::new();
    }
    let ends = still.iter().map(|recording| {
        let across = abscissa.across(recording);
        (quantile(across, 0.01), quantile(across, 0.99))
    });
    let (lowest, highest) = ends.fold((f64::NAN, f64::NAN), |(low, high), end| (low.min(end.0), high.max(end.1)));
    round_levels(lowest, highest, 6)
}

/// Means of a recording near each level.
fn means(abscissa: Abscissa, recording: &Clean, levels: &[f64]) -> Vec<Mean> {
    let step = if levels.len() > 1 { levels[1] - levels[0] } else { f64::INFINITY };
    // Narrow enough that force hardly changes within, wide enough for a handful of samples in passing.
    let near = 0.08 * step;
    let mut sums = vec![[(0.0, 0.0, 0.0); 2]; levels.len()];
    for (row, across) in abscissa.across(recording).iter().enumerate() {
        let level = if step.is_finite() { ((across - levels[0]) / step).round() } else { 0.0 };
        if level < 0.0 || level as usize >= levels.len() || (across - levels[level as usize]).abs() > near {
            continue;
        }
        let sum = &mut sums[level as usize][usize::from(recording.contracting[row])];
        *sum = (sum.0 + 1.0, sum.1 + recording.force_n[row], sum.2 + recording.model_n[row]);
    }
    let at = mean(abscissa.along(recording));
    let mut means = Vec::new();
    for (level, directions) in sums.into_iter().enumerate() {
        for (direction, (count, force_n, model_n)) in directions.into_iter().enumerate() {
            if count > 0.0 {
                let (force_n, model_n) = (force_n / count, model_n / count);
                means.push(Mean { level, contracting: direction == 1, at, force_n, model_n, role: recording.role });
            }
        }
    }
    means
}

/// Measured force as a broad pale line, modelled force as a thin dark one that leaves it in sight.
fn draw_sweeps(canvas: &mut Canvas<'_>, panel: &Panel, abscissa: Abscissa, sweeps: &[Sweep<'_>]) {
    let budget = POINTS / sweeps.len().max(1);
    for modelled in [false, true] {
        for Sweep { recording, rows, .. } in sweeps {
            let along = &abscissa.along(recording)[rows.clone()];
            let force = if modelled { &recording.model_n } else { &recording.force_n };
            let force = &force[rows.clone()];
            let contracting = &recording.contracting[rows.clone()];
            let mut runs = runs(contracting);
            let told_apart = runs.len() <= MOST_RUNS;
            if !told_apart {
                runs = std::iter::once(0..along.len()).collect();
            }
            for run in runs {
                let color = match (told_apart, contracting[run.start]) {
                    (false, _) => palette::GRAY,
                    (true, true) => CONTRACTING,
                    (true, false) => EXTENDING,
                };
                // One sample of the next run closes the gap between the two.
                let run = run.start..(run.end + 1).min(along.len());
                let limit = (budget * run.len() / along.len()).clamp(12, 1500);
                let kept = thin(&force[run.clone()], limit);
                let values = kept.into_iter().map(|row| (along[run.start + row], force[run.start + row]));
                if modelled {
                    panel.line(canvas, values, palette::INK, 1.0);
                } else {
                    panel.line(canvas, values, color.faded(0.45), 3.4);
                }
            }
        }
    }
}

/// Stretches of one direction.
fn runs(contracting: &[bool]) -> Vec<std::ops::Range<usize>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for row in 1..=contracting.len() {
        if row == contracting.len() || contracting[row] != contracting[start] {
            runs.push(start..row);
            start = row;
        }
    }
    runs
}

/// Measured means as dots, modelled ones as lines from recording to recording.
fn draw_means(canvas: &mut Canvas<'_>, panel: &Panel, means: &[Mean]) {
    let color = |contracting: bool| if contracting { CONTRACTING } else { EXTENDING };
    let same = 0.01 * (panel.x.to - panel.x.from);
    for curve in curves(means, same) {
        let (level, contracting) = (curve.level, curve.contracting);
        let dark = color(contracting).toward(palette::INK, 0.15);
        if let [(x, y)] = curve.model[..] {
            panel.line(canvas, [(x - 2.0 * same, y), (x + 2.0 * same, y)], dark, 1.6);
        }
        panel.line(canvas, curve.model, dark, 1.6);
        for mean in means.iter().filter(|mean| mean.level == level && mean.contracting == contracting) {
            let center = panel.at(mean.at, mean.force_n);
            if mean.role == Role::Estimation {
                canvas.dot(center, 3.5, color(contracting).faded(0.75));
            } else {
                // Wide enough that a dot at the same place shows inside.
                canvas.ring(center, 4.75, color(contracting), 1.5);
            }
        }
    }
}

fn draw_legend(
    canvas: &mut Canvas<'_>,
    cell: Rect,
    (letter, abscissa): (&str, Abscissa),
    (sweeps, means): (&[Sweep<'_>], &[Mean]),
) {
    let what = match (abscissa, means.is_empty()) {
        (Abscissa::Length, true) => "Force against length, slow sweeps",
        (Abscissa::Length, false) => "Force against length, at levels of pressure",
        (Abscissa::Pressure, true) => "Force against pressure, slow sweeps",
        (Abscissa::Pressure, false) => "Force against pressure, at levels of length",
    };
    let (y, _) = title(canvas, cell, letter, what);
    let mut keys =
        vec![Key::new("contracting", Mark::Patch, CONTRACTING), Key::new("extending", Mark::Patch, EXTENDING)];
    if !sweeps.is_empty() {
        keys.push(Key::new("measured", Mark::Line(4.0), palette::GRAY.faded(0.5)));
    }
    if !means.is_empty() {
        let text = if sweeps.is_empty() { "measured" } else { "mean" };
        keys.push(Key::new(text, Mark::Dot, palette::GRAY));
    }
    if means.iter().any(|mean| mean.role == Role::Validation) {
        keys.push(Key::new("validation", Mark::Ring, palette::GRAY));
    }
    keys.push(Key::new("model", Mark::Line(1.2), palette::INK));
    legend(canvas, &keys, cell.right - 12.0, y + 17.0);
}
