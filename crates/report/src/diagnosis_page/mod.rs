//! The page of a diagnosis: one self-contained HTML document that is read from top to bottom.
//!
//! | section            | says                                                                             |
//! |--------------------|----------------------------------------------------------------------------------|
//! | top                | verdict, statement, residuals before and after, noise floor                      |
//! | mismatch           | whether there is one, and how the model as given compares with its refit         |
//! | over time          | measured and modelled force, residual before and after, recording by recording   |
//! | where              | regions; residual against each coordinate, over pressure and contraction, time   |
//! | what               | effects with equation, parameters, evidence, rivals; everything that was weighed |
//! |                    | what models the part without a name: equation, curve with its band, rivals       |
//! | what it buys       | held-out recordings before and after; a loop before and after                    |
//! | what is unknown    | whether what is left is white, and where; what cannot be decided                 |
//! | what to record     | the recording that would tell more                                               |
//! | what can be told   | which effects these recordings could tell apart at all                           |
//! | appendix           | inputs with digests, options                                                     |
//!
//! The page loads nothing, follows the reader's preference for light or dark, and prints. A script lets the reader zoom into
//! the forces, read values off and hide lines; without it everything is there but that.

mod content;
mod coordinate;
mod correlation;
mod course;
mod empirical;
pub(crate) mod ending;
mod fit_bars;
mod given;
mod headline;
mod loops;
mod named;
pub(crate) mod over_time;
mod place;
mod profiles;
mod recording;
mod residual_maps;
pub(crate) mod samples;
mod strip;
mod telling_apart;
mod whiteness;

pub use content::{
    DiagnosisPage, PageAlternative, PageAppendix, PageBaseParameter, PageCandidate, PageEffect, PageEstimate,
    PageInput, PageParameter, PageUnknown,
};
pub use empirical::{PageEmpirical, PageTerm};
pub use recording::PageRecording;

use pam_artifact::diagnosis::{BeforeAfter, Verdict};

use crate::page::html::{self, compact_figure, newtons, paragraph};
use crate::page::{Section, document};
use crate::{FigureError, Table};
use samples::Samples;

/// Writes the page, as an HTML document.
///
/// # Errors
/// [`FigureError`] if columns of a recording differ in length.
pub fn diagnosis_page(page: &DiagnosisPage) -> Result<String, FigureError> {
    let mut recordings = page.recordings.iter().map(Samples::new).collect::<Result<Vec<_>, _>>()?;
    recordings.retain(|samples| !samples.force_n.is_empty());
    let noise_n = page.estimation.noise_floor_n;
    let floor = |samples: &Samples| match page.holdout {
        Some(fit) if samples.held_out => fit.noise_floor_n,
        _ => page.estimation.noise_floor_n,
    };
    let sections: [Section; 9] = [
        ("mismatch", "Is there a mismatch?", mismatch(page)?),
        ("time", "Measured and modelled force over time", over_time::over_time(&recordings, floor, over_time::NAMES)?),
        ("where", "Where do model and recordings differ?", place::place(page, &recordings)?),
        ("what", "Which physics is missing?", named::named(page) + &empirical::empirical(page.empirical.as_ref())?),
        ("gain", "What improves on held-out recordings?", ending::gain(page, &recordings)?),
        ("unknown", "What is still unknown?", ending::unknown(page, &recordings)?),
        ("next", "Which recording next?", ending::next(page.next_experiment.as_ref())),
        ("apart", "Which effects can these recordings distinguish?", {
            telling_apart::telling_apart(page.isolability.as_ref(), noise_n)?
        }),
        ("appendix", "Appendix: provenance", ending::appendix(&page.appendix)),
    ];
    Ok(document(&page.title, &headline::headline(page), &sections, "", over_time::SCRIPT))
}

/// Section: whether there is a mismatch.
fn mismatch(page: &DiagnosisPage) -> Result<String, FigureError> {
    let BeforeAfter { rmse_before_n, noise_floor_n, .. } = page.estimation;
    let factor = rmse_before_n / noise_floor_n;
    let times = if factor.is_finite() {
        format!(", {factor:.1} times the noise floor of {}", newtons(noise_floor_n))
    } else {
        String::new()
    };
    // Where only the model as given misses the recordings, its refit follows them.
    let refit_follows = page.regions.is_empty() && page.effects.is_empty() && page.unknown.regions.is_empty();
    let verdict = match page.verdict {
        Verdict::Unexplained if refit_follows => "The verdict is that of the model as given and of what was held out.",
        Verdict::Consistent => {
            "That is within what noise, the uncertainty of the parameters or the limit of what matters allow."
        }
        Verdict::Explained | Verdict::ExplainedInPart | Verdict::Ambiguous | Verdict::Unexplained => {
            "More than noise and the uncertainty of the parameters allow."
        }
    };
    let text =
        format!("Refitted to these recordings, the base model leaves {}{times}. {verdict}", newtons(rmse_before_n));
    let mut fits = vec![("estimation recordings", page.estimation)];
    fits.extend(page.holdout.map(|fit| ("held-out recordings", fit)));
    let svg = fit_bars::fit_bars("Residual before and after", &fits, page.additions())?;
    let caption = "RMSE over counted samples. Samples around reversals, where noise hides the direction of friction, and beyond \
                   a sensor's range are not counted; the table has both.";
    let given = page.as_given.as_ref().map_or(String::new(), given::given);
    Ok(paragraph(&text) + &compact_figure(&svg, caption) + &html::table(&side_by_side(page)) + &given)
}

/// RMSE over counted and over all samples, side by side.
fn side_by_side(page: &DiagnosisPage) -> Table {
    let with = page.additions().map(|additions| format!("with {additions}"));
    let after = with.is_some();
    let mut header = vec!["RMSE", "samples"];
    header.extend(page.as_given.as_ref().map(|_| "as given"));
    header.push("refitted");
    header.extend(with.as_deref());
    header.push("noise floor");
    let mut table = Table::new(header);
    let given = page.as_given.as_ref();
    let fits = [
        ("estimation", Some(page.estimation), given.map(|given| given.estimation)),
        ("held out", page.holdout, given.and_then(|given| given.holdout)),
    ];
    for (name, fit, left) in fits {
        let Some(fit) = fit else { continue };
        let rows = [
            (
                name,
                "counted",
                left.map(|left| left.rmse_n),
                fit.rmse_before_n,
                fit.rmse_after_n,
                newtons(fit.noise_floor_n),
            ),
            ("", "all", left.map(|left| left.rmse_all_n), fit.rmse_all_before_n, fit.rmse_all_after_n, String::new()),
        ];
        for (name, samples, given_n, before_n, after_n, floor) in rows {
            let mut cells = vec![name.to_owned(), samples.to_owned()];
            cells.extend(given.map(|_| given_n.map_or("–".to_owned(), newtons)));
            cells.push(newtons(before_n));
            cells.extend(after.then(|| newtons(after_n)));
            cells.push(floor);
            table.row(cells);
        }
    }
    table
}
