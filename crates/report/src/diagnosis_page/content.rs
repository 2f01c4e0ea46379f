//! Content of the page, section by section.

use pam_muscle::Coordinate;

use super::{PageEmpirical, PageRecording};

/// Everything that the page shows. Texts are plain: whatever they contain is shown as written.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagnosisPage {
    /// Title of the document, such as the muscle's name.
    pub title: String,
    /// The verdict.
    pub verdict: PageVerdict,
    /// The verdict in one sentence.
    pub statement: String,
    /// Warnings to read before the diagnosis is used.
    pub warnings: Vec<String>,
    /// The model before it was refitted; none where that is not known.
    pub as_given: Option<PageGiven>,
    /// Residuals before and after, on the recordings that the effects were fitted to.
    pub estimation: PageFit,
    /// The same on recordings that nothing was fitted to.
    pub holdout: Option<PageFit>,
    /// Base parameters before and after.
    pub base_parameters: Vec<PageBaseParameter>,
    /// The samples.
    pub recordings: Vec<PageRecording>,
    /// Where model and recordings differ, the largest share first; empty where they agree.
    pub regions: Vec<PageRegion>,
    /// Effects that were left out, in order of evidence.
    pub effects: Vec<PageEffect>,
    /// Terms that model the part without a name.
    pub empirical: Option<PageEmpirical>,
    /// Whether the augmented model has a smooth static map.
    pub static_map: bool,
    /// Everything that was weighed.
    pub candidates: Vec<PageCandidate>,
    /// Open questions.
    pub unknown: PageUnknown,
    /// The recording to make next, where that would tell more.
    pub next_experiment: Option<PageExperiment>,
    /// Effects that the recordings can distinguish at all.
    pub isolability: Option<PageIsolability>,
    /// How the diagnosis came about.
    pub appendix: PageAppendix,
}

impl DiagnosisPage {
    /// Additions to the model in words; none where there are none.
    pub(super) fn additions(&self) -> Option<&'static str> {
        match (self.effects.is_empty(), self.empirical.is_none()) {
            (true, true) => self.static_map.then_some("a smooth static map"),
            (false, true) => Some("the named effects"),
            (true, false) => Some("the empirical terms"),
            (false, false) => Some("effects and empirical terms"),
        }
    }
}

/// The model as it was given, before it was refitted.
#[derive(Debug, Clone, PartialEq)]
pub struct PageGiven {
    /// Residual on the recordings used for fitting: over counted and over all samples, in N.
    pub rmse_n: [f64; 2],
    /// Residual on held-out recordings, likewise.
    pub holdout_rmse_n: Option<[f64; 2]>,
    /// Residual of the refitted model, in N.
    pub refitted_rmse_n: f64,
    /// Whether it misses the recordings by clearly more than the refitted model does.
    pub misses: bool,
    /// Fault of an instrument that would explain that, in words.
    pub instrument: Option<String>,
    /// Held-out recordings that are missed, in words.
    pub holdout_missed: Vec<String>,
    /// Free base parameters, the one that moved most first.
    pub shifts: Vec<PageShift>,
}

/// How far a refit moves a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct PageShift {
    /// Name.
    pub parameter: String,
    /// Value as given.
    pub given: f64,
    /// Value after the refit.
    pub refitted: f64,
    /// Unit of both.
    pub unit: String,
    /// Difference over its standard error; none where that is not known.
    pub standard_errors: Option<f64>,
}

/// A base parameter, composite or dimension before and after the effects were added.
#[derive(Debug, Clone, PartialEq)]
pub struct PageBaseParameter {
    /// Name in artifacts.
    pub name: String,
    /// Symbol in eq. 11; may be empty.
    pub symbol: String,
    /// Unit of both values; `1` where there is none.
    pub unit: String,
    /// As identified.
    pub before: PageEstimate,
    /// Refitted beside the effects.
    pub after: PageEstimate,
}

/// A value with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct PageEstimate {
    /// Value, SI.
    pub value: f64,
    /// Standard error, where there is one.
    pub stderr: Option<f64>,
    /// How the value came about, in words: `fitted`, `at its bound`; may be empty.
    pub status: String,
}

/// The verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PageVerdict {
    /// Model and recordings agree.
    Consistent,
    /// The named effects explain the mismatch.
    Explained,
    /// They explain part of it.
    ExplainedInPart,
    /// They do, and so do others.
    Ambiguous,
    /// Structure is left without a name.
    Unexplained,
}

/// Root mean squares of residuals. The mismatch of the page, wherever it is spoken of, is `rmse_before_n`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PageFit {
    /// Base model over counted samples, in N.
    pub rmse_before_n: f64,
    /// Base model and effects over counted samples, in N.
    pub rmse_after_n: f64,
    /// Base model over all samples, reversals included, in N.
    pub rmse_all_before_n: f64,
    /// Base model and effects over all samples, in N.
    pub rmse_all_after_n: f64,
    /// Noise floor of any model, in N.
    pub noise_floor_n: f64,
}

/// An interval of one coordinate in which the residual exceeds the noise floor.
#[derive(Debug, Clone, PartialEq)]
pub struct PageRegion {
    /// Coordinate.
    pub coordinate: Coordinate,
    /// Lower end, SI as in the artifact; the page converts it to the unit that people use.
    pub from: f64,
    /// Upper end, SI as in the artifact.
    pub to: f64,
    /// Share of the excess that lies inside, in [0, 1].
    pub share_of_excess: f64,
    /// Probability by chance.
    pub p_value: f64,
    /// Name of the recording that it lies in, where it lies in one.
    pub recording: Option<String>,
}

/// An effect that was left out of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct PageEffect {
    /// Catalogue id.
    pub id: String,
    /// Name in words.
    pub name: String,
    /// The mechanism in a few sentences.
    pub summary: String,
    /// Its mark in a residual.
    pub signature: String,
    /// The equation that was fitted.
    pub equation: String,
    /// Its symbols.
    pub symbols: Vec<PageSymbol>,
    /// When it holds; may be empty.
    pub validity: String,
    /// Where the equation comes from.
    pub source: String,
    /// Its parameters.
    pub parameters: Vec<PageParameter>,
    /// Why it is believed.
    pub evidence: PageEvidence,
    /// Effects that these recordings cannot tell from it.
    pub alternatives: Vec<PageAlternative>,
    /// Effects that other recordings may not tell from it.
    pub look_alikes: Vec<PageAlternative>,
    /// The test that distinguishes them, or confirms the effect.
    pub separating_test: String,
}

/// A symbol of an equation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageSymbol {
    /// As in the equation.
    pub symbol: String,
    /// Unit; `1` where it has none.
    pub unit: String,
    /// Meaning, and the usual range of a parameter.
    pub meaning: String,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct PageParameter {
    /// Name.
    pub name: String,
    /// Symbol in the equation; may be empty.
    pub symbol: String,
    /// Meaning; may be empty.
    pub meaning: String,
    /// Value, SI; shown with the prefix that reads best.
    pub value: f64,
    /// SI unit; `1` where it has none.
    pub unit: String,
    /// Standard error, in the same unit.
    pub stderr: Option<f64>,
    /// How the value came about, in words: `fitted`, `at the end of its range`; may be empty.
    pub status: String,
}

/// Evidence from held-out blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PageEvidence {
    /// Sum over held-out blocks of `ln(mean square without / mean square with)`.
    pub log_ratio: f64,
    /// Held-out RMSE without it, in N.
    pub rmse_without_n: f64,
    /// Held-out RMSE with it, in N.
    pub rmse_with_n: f64,
    /// Held-out blocks that it improves.
    pub blocks_improved: usize,
    /// Held-out blocks.
    pub n_blocks: usize,
    /// Probability by chance.
    pub p_value: f64,
}

/// An effect that looks alike.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageAlternative {
    /// Catalogue id.
    pub id: String,
    /// Name in words; may be empty.
    pub name: String,
    /// Why the two look alike; may be empty.
    pub because: String,
    /// The test that distinguishes them; may be empty.
    pub test: String,
}

/// An effect that was weighed.
#[derive(Debug, Clone, PartialEq)]
pub struct PageCandidate {
    /// Catalogue id.
    pub id: String,
    /// Name in words; may be empty.
    pub name: String,
    /// Evidence alone, against the base model.
    pub evidence: PageEvidence,
    /// Share of the mean square over blocks left out of the fit that it takes away alone, in [0, 1].
    pub explains: f64,
    /// Its outcome in words.
    pub outcome: String,
}

/// Open questions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageUnknown {
    /// Where structure is left.
    pub regions: Vec<PageRegion>,
    /// Base parameters that no such muscle has.
    pub implausible: Vec<PageImplausible>,
}

/// A base parameter that no such muscle has.
#[derive(Debug, Clone, PartialEq)]
pub struct PageImplausible {
    /// Parameter or composite.
    pub parameter: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Lowest and highest plausible value.
    pub plausible: [f64; 2],
    /// The usual cause.
    pub likely_cause: String,
}

/// A recording that would tell more.
#[derive(Debug, Clone, PartialEq)]
pub struct PageExperiment {
    /// Protocol.
    pub protocol: String,
    /// Hypotheses that it would decide between.
    pub separates: Vec<String>,
    /// How far apart it would drive them, in N.
    pub separation_n: f64,
    /// How to do it.
    pub instruction: String,
}

/// Effects that recordings can distinguish.
#[derive(Debug, Clone, PartialEq)]
pub struct PageIsolability {
    /// Catalogue ids.
    pub ids: Vec<String>,
    /// Residual that each effect would leave at a typical size, in N.
    pub visible_n: Vec<f64>,
    /// Cosine between the residuals of each pair, row by row.
    pub cosine: Vec<Vec<f64>>,
}

/// How the diagnosis came about.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PageAppendix {
    /// Program and version.
    pub tool: String,
    /// The muscle.
    pub muscle: String,
    /// Command that wrote it, as typed; may be empty.
    pub command: String,
    /// Date, year first, and what it is the date of; may be empty.
    pub date: String,
    /// Files that went into it.
    pub inputs: Vec<PageInput>,
    /// Options as resolved, name and value.
    pub options: Vec<(String, String)>,
}

/// A file that went into a diagnosis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageInput {
    /// Its use: `model`, `estimation`, `held out`.
    pub role: String,
    /// Path as given.
    pub path: String,
    /// SHA-256, hexadecimal.
    pub sha256: String,
}
