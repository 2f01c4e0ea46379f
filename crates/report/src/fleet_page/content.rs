//! Content of the page.

use pam_artifact::diagnosis::Verdict;

/// Everything that the page shows.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetPage {
    /// Title of the document.
    pub title: String,
    /// Campaigns in the order of muscle, rig and date.
    pub campaigns: Vec<FleetCampaign>,
    /// Campaigns that stand out, the weightiest first.
    pub standing: Vec<FleetStanding>,
    /// Findings that most muscles of a make share, in words.
    pub common: Vec<String>,
    /// Rigs and days that differ, the clearest first.
    pub shifts: Vec<FleetShift>,
    /// How many comparisons of rigs and days were made.
    pub n_shifts_weighed: usize,
    /// Quantities of a muscle that changed, the clearest first.
    pub changes: Vec<FleetChange>,
    /// How many such differences were looked at.
    pub n_changes_weighed: usize,
    /// Control charts.
    pub charts: Vec<FleetChart>,
    /// Campaigns that could not be used.
    pub refusals: Vec<FleetRefusal>,
}

/// Everything recorded of one muscle on one rig at one date.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetCampaign {
    /// Muscle.
    pub muscle: String,
    /// Rig.
    pub rig: String,
    /// Date, ISO 8601.
    pub date: String,
    /// Make; empty where there is one alone.
    pub make: String,
    /// How it ended: `accepted`, `rejected`, `refused`.
    pub outcome: &'static str,
    /// Verdict of its diagnosis; none where there is no diagnosis.
    pub verdict: Option<Verdict>,
    /// Missing physics by catalogue id, with the force that it explains, root mean square, in N.
    pub effects: Vec<(String, f64)>,
    /// Residual on the estimation recordings, in N; none where there is no model.
    pub rmse_n: Option<f64>,
    /// Residual on the held-out recordings, in N.
    pub holdout_rmse_n: Option<f64>,
    /// Noise floor, in N.
    pub noise_n: Option<f64>,
    /// Where the page of its diagnosis lies, seen from this one.
    pub link: Option<String>,
}

/// A campaign that is not like the others.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetStanding {
    /// Index of the campaign.
    pub campaign: usize,
    /// Reasons in words, the weightiest first.
    pub reasons: Vec<String>,
    /// How much the weightiest matters; 1 is the limit of a chart.
    pub weight: f64,
}

/// A rig or a day that differs.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetShift {
    /// Quantity, with the make where there are several.
    pub quantity: String,
    /// Rig.
    pub rig: String,
    /// Day; none where the rig differs as a whole.
    pub day: Option<String>,
    /// Shift in words, with its unit.
    pub shift: String,
    /// Shift over its standard error.
    pub distance: f64,
    /// The comparison in words.
    pub compared: String,
}

/// A quantity of a muscle at a date and at the date before.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetChange {
    /// Quantity.
    pub quantity: String,
    /// Index of the earlier campaign.
    pub from: usize,
    /// Index of the later campaign.
    pub to: usize,
    /// Value before, with its unit.
    pub before: String,
    /// Value after, with its unit.
    pub after: String,
    /// Difference over its standard error or usual scatter.
    pub distance: f64,
}

/// A control chart.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetChart {
    /// Quantity, with the make where there are several.
    pub title: String,
    /// Unit of the values; `1` where there is none.
    pub unit: String,
    /// Whether the axis is logarithmic.
    pub logarithmic: bool,
    /// Lower limit, center and upper limit; none where there are too few values for limits.
    pub limits: Option<[f64; 3]>,
    /// Distance that the limits stand for.
    pub limit: f64,
    /// Values in the order of the campaigns.
    pub points: Vec<FleetPoint>,
}

/// A value on a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FleetPoint {
    /// Index of the campaign.
    pub campaign: usize,
    /// Value.
    pub value: f64,
    /// Standard error; none where that is not known.
    pub stderr: Option<f64>,
    /// Distance from the center, in spreads.
    pub distance: f64,
    /// Whether that is outside the limits.
    pub outside: bool,
}

/// A step of a campaign that left no result.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetRefusal {
    /// Index of the campaign.
    pub campaign: usize,
    /// Program.
    pub step: String,
    /// Why, with the place and the remedy.
    pub reason: String,
}
