//! Small multiples: where each of the worst campaigns lies in every quantity at once.

use super::{FleetChart, FleetPage, FleetStanding};
use crate::FigureError;
use crate::escape::escaped;
use crate::page::style::{AFTER, BEFORE, NOISE};
use crate::plot::{Anchor, Canvas, Rect, palette};

/// Campaigns that get a figure.
const WORST: usize = 24;
/// Height of a quantity's row, in pixels.
const ROW: f64 = 15.0;
/// Limits that fit between the middle and the edge; what lies beyond stands at the edge.
const REACH: f64 = 2.5;
/// Longest name of a quantity that is written whole.
const LETTERS: usize = 17;

/// A figure for each of the worst; a chart's limits are the shaded band.
pub(super) fn multiples(page: &FleetPage) -> Result<String, FigureError> {
    // A figure shows charts; findings of a diagnosis alone have no place on one.
    let shown: Vec<&FleetStanding> = page.standing.iter().take(WORST).collect();
    let figures: Result<String, FigureError> = shown.iter().map(|standing| multiple(page, standing)).collect();
    let what = match page.standing.len() {
        n if n > WORST => format!("The {WORST} weightiest of {n}"),
        _ => "All of them".to_owned(),
    };
    Ok(format!(
        "<div class=\"multiples\">\n{}</div>\n<p class=\"remark\">{what}: where each lies in every quantity, the shaded band being \
         the limits between which it is expected. A dot at the edge lies further out.</p>\n",
        figures?
    ))
}

fn multiple(page: &FleetPage, standing: &FleetStanding) -> Result<String, FigureError> {
    let campaign = &page.campaigns[standing.campaign];
    let values: Vec<(&FleetChart, f64, bool)> = page
        .charts
        .iter()
        .filter(|chart| chart.limits.is_some())
        .filter_map(|chart| {
            let at = chart.points.binary_search_by_key(&standing.campaign, |point| point.campaign).ok()?;
            Some((chart, chart.points[at].distance / chart.limit, chart.points[at].outside))
        })
        .collect();
    let title = format!("{} on {}, {}", campaign.muscle, campaign.rig, campaign.date);
    let height = (ROW * values.len().max(1) as f64 + 8.0) as u32;
    let svg = Canvas::document(250, height, &title, |canvas, sheet| {
        let frame = Rect { left: 112.0, top: 2.0, right: sheet.right - 6.0, bottom: sheet.bottom - 4.0 };
        let at = |share: f64| frame.left + frame.width() * (0.5 + 0.5 * (share / REACH).clamp(-1.0, 1.0));
        if values.is_empty() {
            canvas.text("no chart has limits", (8.0, 0.5 * sheet.bottom), Anchor::Start, 10.5, palette::GRAY);
            return;
        }
        canvas.rect(Rect { left: at(-1.0), right: at(1.0), ..frame }, NOISE);
        canvas.line([(at(0.0), frame.top), (at(0.0), frame.bottom)], palette::SILVER, 0.8);
        for (index, (chart, share, outside)) in values.iter().enumerate() {
            let y = frame.top + ROW * (index as f64 + 0.5);
            let mut name: String = chart.title.chars().take(LETTERS).collect();
            if chart.title.chars().nth(LETTERS).is_some() {
                name.push('…');
            }
            let color = if *outside { palette::INK } else { palette::GRAY };
            canvas.text(&name, (frame.left - 8.0, y), Anchor::End, 10.5, color);
            canvas.line([(frame.left, y), (frame.right, y)], palette::MIST, 0.6);
            let color = if *outside { BEFORE } else { AFTER };
            canvas.dot((at(*share), y), if *outside { 4.0 } else { 2.8 }, color);
        }
    })?;
    let reason = standing.reasons.first().map_or("", String::as_str);
    Ok(format!(
        "<div class=\"multiple\"><p><b>{}</b> {} {}</p>\n{svg}<p class=\"remark\">{}</p></div>\n",
        escaped(&campaign.muscle),
        escaped(&campaign.rig),
        escaped(&campaign.date),
        escaped(reason)
    ))
}
