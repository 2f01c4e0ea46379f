//! The page of a fleet: one self-contained HTML document about any number of muscles.
//!
//! | section   | says                                                                                     |
//! |-----------|------------------------------------------------------------------------------------------|
//! | top       | how many muscles, who stands out, which rigs differ, what was refused                    |
//! | standing  | campaigns that are not like the others, with reasons; small multiples of the worst       |
//! | rigs      | rigs and days that differ from the others                                                |
//! | changes   | quantities of a muscle that changed from one date to the next                            |
//! | charts    | a control chart for every quantity, campaigns by rig and date                            |
//! | effects   | missing physics, campaign by campaign                                                    |
//! | refusals  | what could not be used, and why                                                          |
//! | campaigns | everything, one row each                                                                 |
//!
//! # Design
//! The page loads nothing. Every table is complete and in the order that matters most as it is written; the script adds
//! sorting and filtering, and a reader without it misses nothing else. Texts are plain: whatever they contain is shown as
//! written.

mod campaigns;
mod charts;
mod content;
mod effects;
mod headline;
mod multiples;
mod shifts;
mod standing;

pub use content::{
    FleetCampaign, FleetChange, FleetChart, FleetPage, FleetPoint, FleetRefusal, FleetShift, FleetStanding,
};

use crate::FigureError;
use crate::page::document;

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// Writes the page, as an HTML document.
///
/// # Errors
/// [`FigureError`] if the drawing library gives up.
pub fn fleet_page(page: &FleetPage) -> Result<String, FigureError> {
    let sections = [
        ("standing", "Which muscles are not like the others?", standing::standing(page)?),
        ("rigs", "Which rig, which day differs?", shifts::rigs(page)),
        ("changes", "What has changed?", shifts::changes(page)),
        ("charts", "Control charts", charts::charts(page)?),
        ("effects", "What physics is missing where?", effects::effects(page)),
        ("refusals", "What could not be used?", campaigns::refusals(page)),
        ("campaigns", "Every campaign", campaigns::campaigns(page)),
    ];
    Ok(document(&page.title, &headline::headline(page), &sections, STYLE, SCRIPT))
}
