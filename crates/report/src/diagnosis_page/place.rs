//! Section: where model and recordings differ.

use pam_artifact::diagnosis::Region;

use super::DiagnosisPage;
use super::coordinate::OnPage as _;
use super::samples::Samples;
use super::{profiles, residual_maps};
use crate::number::probability;
use crate::page::html::{figure, heading, paragraph, percent, remark, table};
use crate::{FigureError, Table};

pub(super) fn place(page: &DiagnosisPage, recordings: &[Samples]) -> Result<String, FigureError> {
    let noise_n = page.estimation.noise_floor_n;
    let mut html = match page.regions.first() {
        None => paragraph("Nowhere: no stretch of any coordinate stands out of the noise."),
        Some(region) => paragraph(&format!(
            "{} of the excess over the noise floor lies at {} {}{}.",
            percent(region.share_of_excess),
            region.coordinate.words(),
            region.coordinate.interval(region.from, region.to),
            region.recording.as_ref().map_or(String::new(), |name| format!(", in {name}"))
        )),
    };
    if !page.regions.is_empty() {
        html.push_str(&table(&regions_table(&page.regions)));
    }
    if recordings.is_empty() {
        html.push_str(&remark("No samples were handed over to be drawn."));
        return Ok(html);
    }
    html.push_str(&heading("Against every coordinate"));
    html.push_str(&figure(
        &profiles::profiles(recordings, &page.regions, noise_n)?,
        "Residual, measured less modelled force, of all recordings against each coordinate. Read the width of a band as \
         well as its line: a residual that changes sign with the direction of motion has no mean but a wide band. Travel, \
         time since the last move and speed are drawn on logarithmic scales where they span more than a decade.",
    ));
    html.push_str(&heading("Over pressure and contraction"));
    html.push_str(&figure(
        &residual_maps::residual_maps(recordings, &page.regions, noise_n)?,
        if page.additions().is_none() {
            "Red: the muscle pulls more than the model says; blue: less. The size, root mean square, also shows residuals \
             that cancel in the mean. Cells without samples stay blank."
        } else {
            "Red: the muscle pulls more than the model says; blue: less. The size, root mean square, also shows residuals \
             that cancel in the mean. Maps before and after share one color scale; cells without samples stay blank."
        },
    ));
    Ok(html)
}

/// Regions as people read them.
pub(super) fn regions_table(regions: &[Region]) -> Table {
    let one_recording = regions.iter().any(|region| region.recording.is_some());
    let mut header = vec!["coordinate", "from–to", "share of the excess", "p"];
    if one_recording {
        header.push("recording");
    }
    let mut table = Table::new(header);
    for region in regions {
        let mut cells = vec![
            region.coordinate.words().to_owned(),
            region.coordinate.interval(region.from, region.to),
            percent(region.share_of_excess),
            probability(region.p_value),
        ];
        if one_recording {
            cells.push(region.recording.clone().unwrap_or_else(|| "all".to_owned()));
        }
        table.row(cells);
    }
    table
}
