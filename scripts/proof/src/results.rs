//! What is printed and written: tables, misses, figure.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};
use pam_report::Table;
use serde_json::json;

use crate::case::{Kind, NAMELESS, catalogue};
use crate::confusion::Confusion;
use crate::criteria::{Criterion, criteria};
use crate::misses;
use crate::score::{Outcome, Score};
use crate::statistics::quantile;

/// All that came of a proof.
#[derive(Debug, Clone)]
pub struct Results {
    /// Seed of the proof.
    pub seed: u64,
    /// SHA-256 of the truth, made known before anything was diagnosed.
    pub hash: String,
    /// Every case.
    pub scores: Vec<Score>,
    /// Cases that could not be drawn, in words.
    pub dropped: Vec<String>,
}

impl Results {
    /// The table of criteria.
    pub fn table(&self) -> Table {
        let mut table = Table::new(["asked", "target", "reached", "95 % interval", "cases", "", "white", "colored"]);
        for criterion in criteria(&self.scores) {
            table.row(criterion_row(&criterion));
        }
        table
    }

    /// Whether every target is reached.
    pub fn passes(&self) -> bool {
        criteria(&self.scores).iter().all(|criterion| criterion.passes() != Some(false))
    }

    /// In how many cases a program failed, and what the first one said; none where every program did its work. They are
    /// misses as well, but a proof of programs that do not run proves nothing.
    pub fn failures(&self) -> Option<String> {
        let said = |score: &Score| match &score.outcome {
            Outcome::Failed(said) => Some(format!("{}: {said}", score.case.name)),
            Outcome::Diagnosed(_) => None,
        };
        let failed: Vec<String> = self.scores.iter().filter_map(said).collect();
        let first = failed.first()?;
        Some(format!("a program failed in {} of {} cases, first in {first}", failed.len(), self.scores.len()))
    }

    /// A row per concealed effect: how its singles fared.
    pub fn by_effect(&self) -> Table {
        let mut table = Table::new([
            "concealed alone",
            "cases",
            "first",
            "class",
            "held out, median",
            "redraws",
            "severity, median",
        ]);
        for id in catalogue().into_iter().chain(NAMELESS) {
            let alone: Vec<&Score> = self.scores.iter().filter(|score| score.truth() == [id]).collect();
            if alone.is_empty() {
                continue;
            }
            let count = |hit: fn(&Score) -> bool| alone.iter().filter(|score| hit(score)).count().to_string();
            let ratios: Vec<f64> =
                alone.iter().filter_map(|score| score.heldout).map(|heldout| heldout.ratio()).collect();
            let severities: Vec<f64> = alone.iter().map(|score| score.case.concealed[0].severity).collect();
            table.row([
                id.to_owned(),
                alone.len().to_string(),
                count(Score::first_is_right),
                count(Score::class_is_right),
                quantile(&ratios, 0.5).map_or(String::new(), |ratio| percent(ratio, 0)),
                alone.iter().map(|score| score.case.redraws).sum::<u32>().to_string(),
                quantile(&severities, 0.5).map_or(String::new(), |severity| format!("{severity:.2}")),
            ]);
        }
        table
    }

    /// Cases that missed.
    pub fn misses(&self) -> Table {
        let mut table = Table::new(misses::TITLES);
        for row in misses::rows(&self.scores) {
            table.row(row);
        }
        table
    }

    /// What was drawn and how long it took, in a few lines.
    pub fn summary(&self) -> String {
        let count = |kind: Kind| self.scores.iter().filter(|score| score.case.kind == kind).count();
        let redraws: u32 = self.scores.iter().map(|score| score.case.redraws).sum();
        let times = |of: fn(&Score) -> f64| {
            let times: Vec<f64> = self.scores.iter().map(of).filter(|time| *time > 0.0).collect();
            let at = |share| quantile(&times, share).unwrap_or(0.0);
            format!("{:.2} s in the median, {:.2} s at most", at(0.5), at(1.0))
        };
        let mut text = format!(
            "{} cases from seed {}: {} with one effect, {} with nothing, {} with two, {} with three, {} nameless; half with \
             colored noise and a smooth misfit.\nThe truth was sealed before anything was diagnosed: SHA-256 {}.\n{redraws} \
             draws were thrown away because the effect could not be made as strong as drawn",
            self.scores.len(),
            self.seed,
            count(Kind::Single),
            count(Kind::Nothing),
            count(Kind::Pair),
            count(Kind::Triple),
            count(Kind::Nameless),
            self.hash,
        );
        let _ = writeln!(text, "; {} cases were given up.", self.dropped.len());
        for dropped in &self.dropped {
            let _ = writeln!(text, "Given up: {dropped}");
        }
        // Cases that were generated before come with their models.
        if self.scores.iter().any(|score| score.identify_s > 0.0) {
            let _ = writeln!(text, "One thread each: pam-identify {}.", times(|score| score.identify_s));
        }
        let _ = writeln!(text, "One thread each: pam-diagnose {}.", times(|score| score.diagnose_s));
        text
    }

    /// For the terminal.
    pub fn to_terminal(&self) -> String {
        let mut text = format!("{}\n{}\n", self.summary(), self.table().to_terminal());
        let mistakes = Confusion::of(&self.scores).mistakes();
        if !mistakes.is_empty() {
            let _ = write!(text, "Named wrongly:\n  {}\n\n", mistakes.join("\n  "));
        }
        let misses = misses::rows(&self.scores);
        if !misses.is_empty() {
            let _ = writeln!(text, "Misses:\n{}", self.misses().to_terminal());
        }
        text
    }

    /// Writes `RESULTS.md`, `results.json` and `confusion.svg` into `folder`.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn record(&self, folder: &Path) -> Result<()> {
        let write = |name: &str, text: String| {
            let path = folder.join(name);
            std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
        };
        let confusion = Confusion::of(&self.scores);
        write("confusion.svg", confusion.figure()?)?;
        write("RESULTS.md", self.markdown(&confusion))?;
        write("results.json", self.json(&confusion)?)
    }

    fn markdown(&self, confusion: &Confusion) -> String {
        let mistakes: Vec<String> = confusion.mistakes().into_iter().map(|line| format!("- {line}\n")).collect();
        format!(
            "# Concealed physics, diagnosed\n\nWritten by `make prove SEED={}`; see [`src/lib.rs`](src/lib.rs) for how.\n\n{}\n\
             {}\n![what was concealed, and what was named first](confusion.svg)\n\n## Effect by effect\n\n{}\n\
             ## Named wrongly\n\n{}\n## Misses\n\n{}",
            self.seed,
            self.summary().replace('\n', "\n\n"),
            self.table().to_markdown(),
            self.by_effect().to_markdown(),
            mistakes.concat(),
            self.misses().to_markdown(),
        )
    }

    /// A line per case, so that two runs can be compared by eye.
    fn json(&self, confusion: &Confusion) -> Result<String> {
        let head = json!({
            "seed": self.seed,
            "truth_sha256": self.hash,
            "criteria": criteria(&self.scores),
            "confusion": confusion,
            "dropped": self.dropped,
        });
        let lines: Result<Vec<String>, _> = self
            .scores
            .iter()
            .map(|score| {
                let mut score = score.clone();
                // The seed makes them again.
                score.case.estimation.clear();
                score.case.holdout.clear();
                serde_json::to_string(&score)
            })
            .collect();
        Ok(format!("{{\"summary\": {head},\n\"cases\": [\n{}\n]}}\n", lines?.join(",\n")))
    }
}

fn criterion_row(criterion: &Criterion) -> [String; 8] {
    let share = |value: Option<f64>| value.map_or("–".to_owned(), |value| percent(value, 1));
    let sign = if criterion.at_least { "≥" } else { "≤" };
    [
        criterion.asks.clone(),
        criterion.target.map_or("–".to_owned(), |target| format!("{sign} {}", percent(target, 0))),
        share(criterion.reached),
        criterion
            .interval
            .map_or("–".to_owned(), |(low, high)| format!("{} to {}", percent(low, 1), percent(high, 1))),
        criterion.n.to_string(),
        match criterion.passes() {
            Some(true) => "pass",
            Some(false) => "short",
            None => "",
        }
        .to_owned(),
        share(criterion.white),
        share(criterion.colored),
    ]
}

fn percent(share: f64, decimals: usize) -> String {
    if share.is_finite() { format!("{:.decimals$} %", 100.0 * share) } else { "∞".to_owned() }
}
