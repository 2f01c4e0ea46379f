//! Panel c: residual over time, one recording after the other.

use super::clean::{Clean, extent, mean, quantile};
use super::{ESTIMATION, Role, VALIDATION};
use crate::number::significant;
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, Timeline, legend, palette, text_width, title};

/// Size of the recordings' names, in pixels.
const NAME_SIZE: f64 = 11.0;
/// Least gap between two names.
const GAP: f64 = 10.0;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, recordings: &[Clean], noise_n: Option<f64>) {
    let slots = slots(recordings);
    let end_s = slots.last().map_or(1.0, |slot| slot.1);
    let (residual, cut) = limits(recordings, noise_n);
    let mut panel = Panel {
        frame: cell.inset(64.0, 52.0, 20.0, 46.0),
        x: Axis::exact("time, recordings one after the other (s)", 0.0, end_s, 12),
        y: Axis::linear("residual (N)", residual.0, residual.1, 5),
        upward_labels: false,
    };
    let names = Names::new(&panel, recordings, &slots);
    if names.two_rows {
        panel.frame.top += 13.0;
    }
    for (recording, (from, to)) in recordings.iter().zip(&slots) {
        if recording.role == Role::Validation {
            let (left, right) = (panel.at(*from, 0.0).0, panel.at(*to, 0.0).0);
            canvas.rect(Rect { left, right, ..panel.frame }, VALIDATION.faded(0.1));
        }
    }
    if let Some(noise_n) = noise_n {
        panel.band(canvas, -2.0 * noise_n, 2.0 * noise_n, palette::ORANGE.faded(0.28));
    }
    panel.draw_frame(canvas);
    for (recording, (from, to)) in recordings.iter().zip(&slots) {
        let pixels = panel.at(*to, 0.0).0 - panel.at(*from, 0.0).0;
        let start_s = recording.time_s[0];
        let color = if recording.role == Role::Estimation { ESTIMATION } else { VALIDATION };
        let shifted: Vec<f64> =
            recording.time_s.iter().map(|time_s| (from + time_s - start_s).clamp(*from, *to)).collect();
        let points = ((2.0 * pixels) as usize).clamp(16, 2000);
        let line = Timeline { time_s: &shifted };
        line.line(canvas, &panel, &recording.residual_n, (color.toward(palette::INK, 0.2), 1.0), points);
    }
    panel.line(canvas, [(0.0, 0.0), (end_s, 0.0)], palette::INK.faded(0.5), 0.75);
    names.draw(canvas, &panel, recordings);

    let (y, _) = title(canvas, cell, "c", "Residual over time");
    let mut keys = vec![Key::new("estimation", Mark::Line(1.6), ESTIMATION.toward(palette::INK, 0.2))];
    if recordings.iter().any(|recording| recording.role == Role::Validation) {
        keys.push(Key::new("validation", Mark::Line(1.6), VALIDATION.toward(palette::INK, 0.2)));
    }
    if noise_n.is_some() {
        keys.push(Key::new("±2 standard deviations of the noise", Mark::Patch, palette::ORANGE.faded(0.4)));
    }
    if cut {
        keys.push(Key::new("cut at the edge: single samples beyond", Mark::Line(1.0), palette::WHITE));
    }
    legend(canvas, &keys, panel.frame.right, y);
}

/// Where each recording begins and ends on the common axis, in s. One that takes no time, or hardly any,
/// gets a sliver.
fn slots(recordings: &[Clean]) -> Vec<(f64, f64)> {
    let spans: Vec<f64> = recordings
        .iter()
        .map(|recording| {
            let (first, last) = extent(recording.time_s.iter().copied());
            last - first
        })
        .collect();
    let total: f64 = spans.iter().sum();
    let sliver = if total > 0.0 { 0.02 * total / recordings.len() as f64 } else { 1.0 };
    let mut end = 0.0;
    spans
        .into_iter()
        .map(|span| {
            let start = end;
            end += span.max(sliver);
            (start, end)
        })
        .collect()
}

/// Limits of the residual, and whether single samples lie beyond: a spike must not flatten all the rest.
fn limits(recordings: &[Clean], noise_n: Option<f64>) -> ((f64, f64), bool) {
    let (lowest, highest) = extent(recordings.iter().flat_map(|recording| recording.residual_n.iter().copied()));
    let (low, high) = recordings.iter().fold((0.0_f64, 0.0_f64), |(low, high), recording| {
        let residual = &recording.residual_n;
        (low.min(quantile(residual, 0.001)), high.max(quantile(residual, 0.999)))
    });
    let band = 2.5 * noise_n.unwrap_or(0.0);
    let cut = highest - lowest > 3.0 * (high - low).max(band) && high > low;
    let (from, to) = if cut { (1.2 * low, 1.2 * high) } else { (lowest, highest) };
    ((from.min(-band), to.max(band)), cut)
}

/// Names of the recordings above the frame: in one row, or in two in turn where that is too narrow.
struct Names<'a> {
    names: Vec<&'a str>,
    /// Left and right end of each recording, in pixels.
    edges: Vec<(f64, f64)>,
    two_rows: bool,
}

impl<'a> Names<'a> {
    fn new(panel: &Panel, recordings: &'a [Clean], slots: &[(f64, f64)]) -> Self {
        let edges: Vec<(f64, f64)> =
            slots.iter().map(|(from, to)| (panel.at(*from, 0.0).0, panel.at(*to, 0.0).0)).collect();
        let fits = |names: &[&str]| {
            names.iter().zip(&edges).all(|(name, edge)| text_width(name, NAME_SIZE) <= edge.1 - edge.0 - GAP)
        };
        let full: Vec<&str> = recordings.iter().map(|recording| recording.name.as_str()).collect();
        let names = if fits(&full) { full } else { distinctive(&full) };
        let two_rows = !fits(&names);
        Self { names, edges, two_rows }
    }

    /// Draws boundaries and names, with the RMSE where there is room left.
    fn draw(&self, canvas: &mut Canvas<'_>, panel: &Panel, recordings: &[Clean]) {
        let top = panel.frame.top;
        // Where the last name of the lower and of the raised row ends.
        let mut row_end = [panel.frame.left; 2];
        for (index, (name, recording)) in self.names.iter().zip(recordings).enumerate() {
            let raised = self.two_rows && index % 2 == 0;
            let (left, right) = self.edges[index];
            if index > 0 {
                // A raised boundary leaves out the lower row, whose names run across it.
                let rise = if raised { 0.0 } else { 14.0 };
                canvas.line([(left, top - rise), (left, panel.frame.bottom)], palette::SILVER, 0.75);
                if raised {
                    canvas.line([(left, top - 27.0), (left, top - 15.0)], palette::SILVER, 0.75);
                }
            }
            // In two rows, up to where the next name in the same row begins.
            let end = if self.two_rows { self.edges.get(index + 1).map_or(right, |next| next.1) } else { right };
            let width = end - left - GAP;
            let with_rmse = format!("{name}, RMSE {} N", significant(rmse_n(recording), 3));
            let estimation = recording.role == Role::Estimation;
            let color = if estimation { palette::GRAY } else { VALIDATION.toward(palette::INK, 0.3) };
            let y = top - if raised { 21.0 } else { 8.0 };
            let fits = |text: &str, width: f64| text_width(text, NAME_SIZE) <= width;
            let row = usize::from(raised);
            // The last name of a row may begin further left, where the name before it has ended.
            let room = panel.frame.right + 8.0 - row_end[row] - GAP;
            let is_last = end >= panel.frame.right - 1.0;
            let back = [&with_rmse, *name].into_iter().find(|text| is_last && !fits(name, width) && fits(text, room));
            if let Some(text) = back {
                canvas.text(text, (panel.frame.right + 8.0, y), Anchor::End, NAME_SIZE, color);
                continue;
            }
            let text = if fits(&with_rmse, width) { with_rmse } else { shortened(name, width) };
            // Three letters say nothing.
            if text.chars().count() < name.chars().count().min(6) {
                continue;
            }
            row_end[row] = left + 4.0 + text_width(&text, NAME_SIZE);
            canvas.text(&text, (left + 4.0, y), Anchor::Start, NAME_SIZE, color);
        }
    }
}

fn rmse_n(recording: &Clean) -> f64 {
    let squares: Vec<f64> = recording.residual_n.iter().map(|residual_n| residual_n * residual_n).collect();
    mean(&squares).sqrt()
}

/// Names without what all of them begin and end with, cut at word boundaries.
fn distinctive<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let Some((first, rest)) = names.split_first() else { return Vec::new() };
    if rest.is_empty() || rest.iter().all(|name| name == first) {
        return names.to_vec();
    }
    let boundary = |character: char| !character.is_alphanumeric() && character != '.';
    let common = |text: &str, shared: fn(&str, &str) -> usize| rest.iter().map(|name| shared(text, name)).min();
    let start = common(first, |a, b| {
        a.char_indices()
            .zip(b.chars())
            .take_while(|((_, x), y)| x == y)
            .last()
            .map_or(0, |((at, x), _)| at + x.len_utf8())
    });
    let start = first[..start.unwrap_or(0)]
        .rfind(boundary)
        .map_or(0, |at| at + first[at..].chars().next().map_or(1, char::len_utf8));
    let tails: Vec<&str> = names.iter().map(|name| &name[start..]).collect();
    let end = tails[1..]
        .iter()
        .map(|name| {
            let pairs = tails[0].chars().rev().zip(name.chars().rev());
            pairs.take_while(|(x, y)| x == y).map(|(x, _)| x.len_utf8()).sum::<usize>()
        })
        .min()
        .unwrap_or(0);
    // The common ending starts at a boundary or at an extension's point.
    let ending = &tails[0][tails[0].len() - end..];
    let end = ending.find(|character: char| boundary(character) || character == '.').map_or(0, |at| end - at);
    tails.iter().map(|name| &name[..name.len() - end]).collect()
}

/// As much of the beginning and of the end of `name` as fits into `width` pixels.
fn shortened(name: &str, width: f64) -> String {
    if text_width(name, NAME_SIZE) <= width {
        return name.to_owned();
    }
    let characters: Vec<char> = name.chars().collect();
    let mut shorter = String::new();
    for kept in 2..characters.len() {
        let (head, tail) = (&characters[..kept.div_ceil(2)], &characters[characters.len() - kept / 2..]);
        let text: String = head.iter().chain(&['…']).chain(tail).collect();
        if text_width(&text, NAME_SIZE) > width {
            break;
        }
        shorter = text;
    }
    shorter
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_what_they_share() {
        let names = ["rig/len159.5mm_test10.csv", "rig/len159.5mm_test9.csv", "rig/len167.0mm_test9.csv"];
        assert_eq!(distinctive(&names), ["len159.5mm_test10", "len159.5mm_test9", "len167.0mm_test9"]);
        assert_eq!(distinctive(&["a_1.csv", "a_2.csv"]), ["1", "2"]);
        assert_eq!(distinctive(&["same", "same"]), ["same", "same"]);
        assert_eq!(distinctive(&["µ–a", "µ–b"]), ["a", "b"]);
        assert_eq!(distinctive(&["a", "a_b"]), ["a", "a_b"]);
    }

    #[test]
    fn a_name_is_cut_to_its_room() {
        assert_eq!(shortened("short", 100.0), "short");
        assert_eq!(shortened("a name far too long", 60.0), "a na…long");
        assert_eq!(shortened("name", 5.0), "");
    }
}
