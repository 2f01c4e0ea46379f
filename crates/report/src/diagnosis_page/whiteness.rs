//! Whether the residual is white, and whether it still follows the channels.

use pam_muscle::Coordinate;

use super::correlation::{Correlation, autocorrelation, cross_correlation};
use super::samples::Samples;
use crate::FigureError;
use crate::number::significant;
use crate::page::html::{figure, heading, paragraph};
use crate::page::style::{AFTER, BEFORE, NOISE};
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend, note, palette};

/// A panel: title, correlation before, correlation after.
type Shown = (&'static str, Option<Correlation>, Option<Correlation>);

/// Heading, sentence and figure; nothing where there are no samples.
pub(super) fn whiteness(recordings: &[Samples]) -> Result<String, FigureError> {
    if recordings.is_empty() {
        return Ok(String::new());
    }
    // Held-out recordings tell more: nothing was fitted to them.
    let held_out = recordings.iter().any(|samples| samples.held_out);
    let chosen = || recordings.iter().filter(|samples| samples.held_out == held_out);
    let after = chosen().all(|samples| samples.after_n.is_some());
    let before_n: fn(&Samples) -> &[f64] = |samples| &samples.before_n;
    let cross = |channel: fn(&Samples) -> &[f64]| {
        (
            cross_correlation(chosen(), before_n, channel),
            after.then(|| cross_correlation(chosen(), Samples::last_n, channel)).flatten(),
        )
    };
    let pressure = cross(|samples| samples.column(Coordinate::Pressure));
    let length = cross(|samples| samples.column(Coordinate::Contraction));
    let auto_after = after.then(|| autocorrelation(chosen(), Samples::last_n)).flatten();
    let panels: [Shown; 3] = [
        ("Residual with itself", autocorrelation(chosen(), before_n), auto_after),
        ("Pressure with residual", pressure.0, pressure.1),
        ("Contraction with residual", length.0, length.1),
    ];
    let which = if held_out { "held-out recordings" } else { "the recordings used for fitting" };
    let mut html = heading("Is the residual white?");
    html.push_str(&paragraph(&words(&panels, which)));
    html.push_str(&figure(
        &drawn(&panels)?,
        "Autocorrelation of the residual, and its cross-correlation with pressure and contraction (length), over the lag by which \
         the residual follows. A residual that is white, or independent of the channel, stays inside the band at 99 of 100 lags. Counted \
         samples only.",
    ));
    Ok(html)
}

fn words(panels: &[Shown; 3], which: &str) -> String {
    let last = |shown: &Shown| shown.2.clone().or_else(|| shown.1.clone());
    let Some(auto) = last(&panels[0]) else { return format!("The samples of {which} are too few to tell.") };
    let outside = auto.value[1..].iter().filter(|value| value.abs() > auto.band).count();
    let mut text = if 20 * outside <= auto.value.len() {
        format!(
            "On {which} the residual is white as far as {} s tell.",
            significant(auto.lag_s[auto.lag_s.len() - 1], 2)
        )
    } else {
        let fades = auto.lag_s.iter().zip(&auto.value).find(|(_, value)| **value < 0.5).map(|(lag_s, _)| *lag_s);
        let half = fades.map_or("stays above one half over all lags".to_owned(), |lag_s| {
            format!("falls below one half within {} s", significant(lag_s, 2))
        });
        format!("On {which} the residual is not white: its autocorrelation {half}.")
    };
    for shown in &panels[1..] {
        let Some(cross) = last(shown) else { continue };
        let (lag_s, value) = cross.largest(false);
        let channel = if shown.0.starts_with('P') { "pressure" } else { "contraction" };
        let verdict = if value.abs() > cross.band { "outside the band of" } else { "within the band of" };
        text.push_str(&format!(
            " Its largest correlation with {channel}, {} at a lag of {} s, lies {verdict} ±{}.",
            significant(value, 2),
            significant(lag_s, 2),
            significant(cross.band, 2)
        ));
    }
    text
}

fn drawn(panels: &[Shown; 3]) -> Result<String, FigureError> {
    Canvas::document(900, 270, "Correlation of the residual", |canvas, sheet| {
        for (index, (cell, (title, before, after))) in
            sheet.inset(0.0, 26.0, 0.0, 0.0).columns([1.0, 1.0, 1.0], 10.0).into_iter().zip(panels).enumerate()
        {
            let shown = || [before, after].into_iter().flatten();
            let longest = shown().flat_map(|correlation| correlation.lag_s.last()).fold(1e-9, |a: f64, b| a.max(*b));
            let largest =
                shown().map(|correlation| correlation.largest(index == 0).1.abs().max(1.5 * correlation.band));
            let limit = largest.filter(|size| size.is_finite()).fold(0.1, f64::max).min(1.0);
            let low = if index == 0 {
                shown().flat_map(|c| c.value.iter().copied()).fold(-1.5 * limit.min(0.2), f64::min)
            } else {
                -1.1 * limit
            };
            let high = if index == 0 { 1.0 } else { 1.1 * limit };
            let x = Axis::exact("lag (s)", if index == 0 { 0.0 } else { -longest }, longest, 5);
            let panel = Panel::new(cell, x, Axis::exact("correlation", low, high, 5), 14.0);
            panel.draw_frame(canvas);
            canvas.bold(title, (panel.frame.left, cell.top + 20.0), Anchor::Start, 13.5, palette::INK);
            let Some(band) = shown().last().map(|correlation| correlation.band) else {
                note(canvas, panel.frame, "does not vary");
                continue;
            };
            panel.band(canvas, -band, band, NOISE);
            panel.level(canvas, 0.0, palette::SILVER, 1.0);
            canvas.clipped(panel.frame, &[], |canvas| {
                for (correlation, color) in [(before, BEFORE), (after, AFTER)] {
                    if let Some(correlation) = correlation {
                        let pairs = correlation.lag_s.iter().copied().zip(correlation.value.iter().copied());
                        panel.line(canvas, pairs, color, 1.6);
                    }
                }
            });
        }
        let mut keys = vec![Key::new("before", Mark::Line(2.0), BEFORE)];
        if panels.iter().any(|shown| shown.2.is_some()) {
            keys.push(Key::new("after", Mark::Line(2.0), AFTER));
        }
        keys.push(Key::new("99 % band", Mark::Patch, NOISE));
        let Rect { right, .. } = sheet;
        legend(canvas, &keys, right - 14.0, 14.0);
    })
}
