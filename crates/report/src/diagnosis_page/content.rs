//! Content of the page, section by section.

use pam_artifact::diagnosis::{
    AsGiven, BeforeAfter, Evidence, Implausible, Isolability, NextExperiment, Region, Verdict,
};
use pam_muscle::effects::Symbol;

use super::{PageEmpirical, PageRecording};

/// Everything that the page shows. Texts are plain: whatever they contain is shown as written.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagnosisPage {
    /// Title of the document, such as the muscle's name.
    pub title: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in one sentence.
    pub statement: String,
    /// Warnings to read before the diagnosis is used.
    pub warnings: Vec<String>,
    /// The model before it was refitted; none where that is not known.
    pub as_given: Option<AsGiven>,
    /// Residuals before and after, on the recordings that the effects were fitted to.
    pub estimation: BeforeAfter,
    /// The same on recordings that nothing was fitted to.
    pub holdout: Option<BeforeAfter>,
    /// Base parameters before and after.
    pub base_parameters: Vec<PageBaseParameter>,
    /// The samples.
    pub recordings: Vec<PageRecording>,
    /// Where model and recordings differ, the largest share first; empty where they agree.
    pub regions: Vec<Region>,
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
    pub next_experiment: Option<NextExperiment>,
    /// Effects that the recordings can distinguish at all.
    pub isolability: Option<Isolability>,
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
    pub symbols: Vec<Symbol>,
    /// When it holds; may be empty.
    pub validity: String,
    /// Where the equation comes from.
    pub source: String,
    /// Its parameters.
    pub parameters: Vec<PageParameter>,
    /// Why it is believed.
    pub evidence: Evidence,
    /// Effects that these recordings cannot tell from it.
    pub alternatives: Vec<PageAlternative>,
    /// Effects that other recordings may not tell from it.
    pub look_alikes: Vec<PageAlternative>,
    /// The test that distinguishes them, or confirms the effect.
    pub separating_test: String,
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
    pub evidence: Evidence,
    /// Share of the mean square over blocks left out of the fit that it takes away alone, in [0, 1].
    pub explains: f64,
    /// Its outcome in words.
    pub outcome: String,
}

/// Open questions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageUnknown {
    /// Where structure is left.
    pub regions: Vec<Region>,
    /// Base parameters that no such muscle has.
    pub implausible: Vec<Implausible>,
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
