//! Section: force and residual of each recording over time.
//!
//! # Design
//! Each strip is a figure that needs no script, and carries its samples as whole numbers of 16 bits, so that a script can draw
//! it anew between any two instants. Fifty thousand samples are 550 kB, which leaves the page below 1.5 MB: with many
//! recordings each is thinned.

use std::fmt::Write as _;

use super::samples::Samples;
use super::strip::{Strip, strip};
use crate::FigureError;
use crate::escape::escaped;
use crate::page::html::{paragraph, remark};
use crate::plot::{Canvas, Rect};

/// Strips; more would not be looked at.
const STRIPS: usize = 12;
/// Strips that are open from the start.
const OPEN: usize = 4;
/// Samples that all strips carry together.
const SAMPLES: usize = 50_000;

/// Script for zooming, reading values off and hiding lines. Other pages with strips like these take it from here.
pub(crate) const SCRIPT: &str = include_str!("over_time.js");

/// Names of the base model and of the augmented one beside one another.
pub(super) const NAMES: [&str; 2] = ["before", "after"];

/// Strips of `recordings`; `floor` is the noise floor of one in N, `names` those of the two models.
pub(crate) fn over_time(
    recordings: &[Samples],
    floor: impl Fn(&Samples) -> f64,
    names: [&str; 2],
) -> Result<String, FigureError> {
    if recordings.is_empty() {
        return Ok(remark("No samples were handed over to be drawn."));
    }
    let mut shown: Vec<&Samples> = recordings.iter().collect();
    let mut html = paragraph(
        "Where a residual leaves the band of the noise, the model is wrong by more than the sensors. Shaded samples are not counted. \
         Drag across a figure to zoom in, double-click to see all of it again.",
    );
    if shown.len() > STRIPS {
        let worst = |samples: &&Samples| samples.rms(&samples.before_n);
        let mut ranked = shown.clone();
        ranked.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
        let least = worst(&ranked[STRIPS - 1]);
        shown.retain(|samples| worst(samples) >= least);
        shown.truncate(STRIPS);
        html.push_str(&remark(&format!("The {STRIPS} of {} recordings that differ most.", recordings.len())));
    }
    let each = SAMPLES / shown.len();
    let mut folded = String::new();
    for (index, samples) in shown.iter().enumerate() {
        let figure = figure(samples, &strip(samples, floor(samples), names)?, (each, names));
        if index < OPEN { html.push_str(&figure) } else { folded.push_str(&figure) }
    }
    if shown.len() > OPEN {
        let more = shown.len() - OPEN;
        let _ = write!(html, "<details>\n<summary>{more} more</summary>\n{folded}</details>\n");
    }
    Ok(html)
}

/// A strip with its samples, at most `most` of them.
fn figure(samples: &Samples, strip: &Strip, (most, names): (usize, [&str; 2])) -> String {
    let every = samples.force_n.len().div_ceil(most.max(1)).max(1);
    let rows: Vec<usize> = (0..samples.force_n.len()).step_by(every).collect();
    let [from_s, to_s] = strip.time_s;
    let lines: Vec<&[f64]> = [Some(&samples.force_n), Some(&samples.base_n), samples.model_n.as_ref()]
        .into_iter()
        .flatten()
        .map(|n| &n[..])
        .collect();
    let (low, high) = super::samples::extent(lines.iter().flat_map(|line| line.iter().copied()));
    let frame = |rect: &Rect| {
        let [x, y] = [rect.left, rect.top].map(|value| value * Canvas::UNITS);
        let [width, height] = [rect.width(), rect.height()].map(|value| value * Canvas::UNITS);
        format!("[{x},{y},{width},{height}]")
    };
    let layout = format!(
        "{{\"frames\":[{},{}],\"residual\":[{},{}],\"time\":[{from_s},{to_s}],\"force\":[{low},{high}],\"lines\":{},\"labels\":[\"measured\",\"{}\",\"{}\"]}}",
        frame(&strip.frames[0]),
        frame(&strip.frames[1]),
        strip.ends_n[1][0],
        strip.ends_n[1][1],
        lines.len(),
        names[0],
        names[1]
    );
    let mut bytes = Vec::with_capacity(rows.len() * 9);
    let word = |value: f64, from: f64, to: f64| {
        let share = if to > from { (value - from) / (to - from) } else { 0.0 };
        ((share.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16).to_le_bytes()
    };
    bytes.extend(rows.iter().flat_map(|&row| word(samples.time_s()[row], from_s, to_s)));
    for line in &lines {
        bytes.extend(rows.iter().flat_map(|&row| word(line[row], low, high)));
    }
    format!(
        "<figure class=\"strip\" data-layout=\"{}\">\n{}<script type=\"text/plain\">{}</script>\n</figure>\n",
        escaped(&layout).replace('"', "&quot;"),
        strip.svg,
        base64(&bytes)
    )
}

/// Bytes as letters (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0_u32, |word, at| word << 8 | u32::from(three.get(at).copied().unwrap_or(0)));
        for at in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * at)) as usize & 63];
            text.push(if at <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validates_against_the_vectors_of_rfc_4648() {
        let vectors = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(vectors, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }
}
