//! Section: a control chart for every quantity, campaigns side by side by rig and date.

use super::{FleetChart, FleetPage, FleetPoint};
use crate::FigureError;
use crate::page::html::{figure, paragraph};
use crate::page::style::{AFTER, BEFORE, NOISE};
use crate::plot::{Anchor, Axis, Canvas, Panel, Rect, palette, text_width};

/// Points beyond which standard errors are left out, for they would cover one another.
const WITH_ERRORS: usize = 150;
/// Points outside the limits that are named.
const NAMED: usize = 14;
/// Width and height of a chart, in pixels; its letters are legible on a page 800 pixels wide.
const WIDTH: u32 = 780;
const HEIGHT: u32 = 230;
/// Points up to which a chart takes half of the page, and its width then, in pixels.
const NARROW: usize = 120;
const NARROW_WIDTH: u32 = 540;

pub(super) fn charts(page: &FleetPage) -> Result<String, FigureError> {
    if page.charts.is_empty() {
        return Ok(paragraph("No campaign has a model."));
    }
    let mut html = paragraph(
        "A dot is a campaign; rigs stand side by side, dates run from left to right within each. The shaded band holds what is \
         expected of the make: median and robust spread, as wide as the number of values on this page asks for, so that chance \
         alone puts a value outside in one of twenty fleets. Values outside are orange; what a whole rig shares does not count \
         against its muscles, and a value with a larger standard error than usual has wider limits of its own.",
    );
    let narrow = page.charts.iter().all(|chart| chart.points.len() <= NARROW);
    html.push_str(if narrow { "<div class=\"charts\">\n" } else { "<div>\n" });
    for chart in &page.charts {
        let caption = match chart.limits {
            Some(_) => {
                let outside = chart.points.iter().filter(|point| point.outside).count();
                format!("{}: {outside} of {} outside ±{:.1} spreads.", chart.title, chart.points.len(), chart.limit)
            }
            None => format!("{}: no limits, since values are too few or mostly equal.", chart.title),
        };
        let width = if narrow { NARROW_WIDTH } else { WIDTH };
        html.push_str(&figure(&drawn(page, chart, width)?, &caption));
    }
    html.push_str("</div>\n");
    Ok(html)
}

/// `chart` in the unit that keeps its values between 1 and 1,000, or near, and that unit.
fn in_a_handy_unit(chart: &FleetChart) -> (FleetChart, &str) {
    let largest = chart.points.iter().map(|point| point.value.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let (factor, unit) = match chart.unit.as_str() {
        "Pa" if largest >= 1e9 => (1e-9, "GPa"),
        "Pa" if largest >= 1e6 => (1e-6, "MPa"),
        "Pa" if largest >= 1e3 => (1e-3, "kPa"),
        "m^2" => (1e6, "mm²"),
        unit => (1.0, unit),
    };
    let scaled = |point: &FleetPoint| FleetPoint {
        value: factor * point.value,
        stderr: point.stderr.map(|stderr| factor * stderr),
        ..*point
    };
    let chart = FleetChart {
        points: chart.points.iter().map(scaled).collect(),
        limits: chart.limits.map(|limits| limits.map(|limit| factor * limit)),
        ..chart.clone()
    };
    (chart, unit)
}

/// Points by rig and date.
fn in_order<'a>(page: &FleetPage, chart: &'a FleetChart) -> Vec<&'a FleetPoint> {
    let mut points: Vec<&FleetPoint> = chart.points.iter().collect();
    let key = |point: &FleetPoint| {
        let campaign = &page.campaigns[point.campaign];
        (campaign.rig.as_str(), campaign.date.as_str(), point.campaign)
    };
    points.sort_by(|a, b| key(a).cmp(&key(b)));
    points
}

fn drawn(page: &FleetPage, chart: &FleetChart, width: u32) -> Result<String, FigureError> {
    let (chart, unit) = in_a_handy_unit(chart);
    let points = in_order(page, &chart);
    let (low, high) = extent(&chart);
    let unit = if unit == "1" { String::new() } else { format!(" ({unit})") };
    let title = format!("{}{unit}", chart.title);
    Canvas::document(width, HEIGHT, &title, |canvas, sheet| {
        let y = if chart.logarithmic { Axis::logarithmic("", low, high) } else { Axis::linear("", low, high, 4) };
        // Names of rigs take the place of ticks.
        let mut x = Axis::exact("", -0.7, points.len() as f64 - 0.3, 1);
        x.ticks.clear();
        let panel = Panel {
            frame: Rect { left: 84.0, top: 34.0, right: sheet.right - 10.0, bottom: sheet.bottom - 28.0 },
            x,
            y,
            upward_labels: false,
        };
        panel.draw_frame(canvas);
        canvas.bold(&title, (panel.frame.left, 16.0), Anchor::Start, 14.0, palette::INK);
        if let Some([lower, center, upper]) = chart.limits {
            panel.band(canvas, lower, upper, NOISE);
            panel.level(canvas, center, palette::GRAY, 1.0);
        }
        rigs(page, &points, &panel, canvas);
        let radius = match points.len() {
            0..=60 => 3.6,
            61..=300 => 2.4,
            _ => 1.4,
        };
        for (place, point) in points.iter().enumerate() {
            let color = if point.outside { BEFORE } else { AFTER };
            if let Some(stderr) = point.stderr.filter(|_| points.len() <= WITH_ERRORS) {
                let ends = [point.value - stderr, point.value + stderr];
                canvas.line(ends.map(|value| spot(&panel, place, value)), color, 1.0);
            }
            let radius = if point.outside { 1.6 * radius } else { radius };
            canvas.dot(spot(&panel, place, point.value), radius, color);
        }
        names(page, &points, &panel, canvas);
    })
}

/// Names of rigs below, and lines between them.
fn rigs(page: &FleetPage, points: &[&FleetPoint], panel: &Panel, canvas: &mut Canvas<'_>) {
    let rig = |point: &&FleetPoint| page.campaigns[point.campaign].rig.as_str();
    let mut from = 0;
    for group in points.chunk_by(|a, b| rig(a) == rig(b)) {
        let to = from + group.len();
        let at = |place: f64| panel.at(place, panel.y.from).0;
        let (left, right) = (at(from as f64 - 0.5), at(to as f64 - 0.5));
        if from > 0 {
            canvas.line([(left, panel.frame.top), (left, panel.frame.bottom)], palette::SILVER, 1.0);
        }
        let name = rig(&group[0]);
        if text_width(name, 12.5) < right - left {
            let below = (0.5 * (left + right), panel.frame.bottom + 13.0);
            canvas.text(name, below, Anchor::Middle, 12.5, palette::GRAY);
        }
        from = to;
    }
}

/// Names of muscles outside the limits, the farthest first, where there is room.
fn names(page: &FleetPage, points: &[&FleetPoint], panel: &Panel, canvas: &mut Canvas<'_>) {
    let mut outside: Vec<(usize, &FleetPoint)> =
        points.iter().enumerate().filter(|(_, point)| point.outside).map(|(place, point)| (place, *point)).collect();
    outside.sort_by(|a, b| b.1.distance.abs().total_cmp(&a.1.distance.abs()));
    // A name covers no dot outside the limits, be it its own or another.
    let dots = outside.iter().map(|(place, point)| spot(panel, *place, point.value));
    let mut taken: Vec<Rect> =
        dots.map(|(x, y)| Rect { left: x - 3.0, top: y - 3.0, right: x + 3.0, bottom: y + 3.0 }).collect();
    let most = taken.len() + NAMED;
    for (place, point) in outside {
        let name = &page.campaigns[point.campaign].muscle;
        let (x, y) = spot(panel, place, point.value);
        let width = text_width(name, 12.0);
        // Beside the dot, on the side where the frame has room.
        let right = x + 8.0 + width < panel.frame.right;
        let left = if right { x + 6.0 } else { x - 6.0 - width };
        let rect = Rect { left, top: y - 6.0, right: left + width, bottom: y + 6.0 };
        let free = taken.iter().all(|other| {
            rect.left > other.right || rect.right < other.left || rect.top > other.bottom || rect.bottom < other.top
        });
        if free && taken.len() < most {
            canvas.text(name, (left, y), Anchor::Start, 12.0, palette::INK);
            taken.push(rect);
        }
    }
}

/// Where a value stands on the panel: one beyond its ends a little before them.
fn spot(panel: &Panel, place: usize, value: f64) -> (f64, f64) {
    const EDGE: f64 = 6.0;
    let (x, y) = panel.at(place as f64, value);
    (x, y.clamp(panel.frame.top + EDGE, panel.frame.bottom - EDGE))
}

/// Extent of the vertical axis: the limits and most values; one far outside stands at the edge.
fn extent(chart: &FleetChart) -> (f64, f64) {
    let scaled = |value: f64| if chart.logarithmic { value.ln() } else { value };
    let values = || chart.points.iter().map(|point| scaled(point.value)).filter(|value| value.is_finite());
    let (mut low, mut high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    if let Some([lower, center, upper]) = chart.limits.map(|limits| limits.map(scaled)) {
        // The band takes a third of the height at least, and no more of it is shown than values need.
        let room = 0.3 * (high - low);
        low = if low > lower { lower.max(low - room) } else { low.max(center - 3.0 * (center - lower)) };
        high = if high < upper { upper.min(high + room) } else { high.min(center + 3.0 * (upper - center)) };
    }
    // Dots at an edge, and names beside them, keep off the frame.
    let margin = 0.06 * (high - low);
    (low, high) = (low - margin, high + margin);
    if chart.logarithmic { (low.exp(), high.exp()) } else { (low, high) }
}
