//! The page of a diagnosis: one self-contained HTML document that is read from top to bottom.
//!
//! | section            | says                                                                             |
//! |--------------------|----------------------------------------------------------------------------------|
//! | top                | verdict, statement, residuals before and after, noise floor                      |
//! | mismatch           | whether there is one, and how the model as given compares with its refit         |
//! | where              | regions; residual against each coordinate, over pressure and contraction, time   |
//! | what               | effects with equation, parameters, evidence, rivals; everything that was weighed |
//! | what it buys       | held-out recordings before and after; a loop before and after                    |
//! | what is unknown    | what is left, and where; what cannot be decided; implausible parameters          |
//! | what to record     | the recording that would tell more                                               |
//! | what can be told   | which effects these recordings could tell apart at all                           |
//! | appendix           | inputs with digests, options                                                     |
//!
//! The page loads nothing and runs nothing; it follows the reader's preference for light or dark, and prints.

mod content;
mod coordinate;
mod ending;
mod fit_bars;
mod given;
mod headline;
mod loops;
mod named;
mod place;
mod profiles;
mod recording;
mod residual_maps;
mod samples;
mod telling_apart;
mod time_lines;

pub use content::{
    DiagnosisPage, PageAlternative, PageAppendix, PageCandidate, PageEffect, PageEvidence, PageExperiment, PageFit,
    PageGiven, PageImplausible, PageInput, PageIsolability, PageParameter, PageRegion, PageShift, PageSymbol,
    PageUnknown, PageVerdict,
};
pub use coordinate::PageCoordinate;
pub use recording::PageRecording;

use crate::FigureError;
use crate::page::document;
use crate::page::html::{figure, newtons, paragraph};
use samples::Samples;

/// Writes the page, as an HTML document.
///
/// # Errors
/// [`FigureError`] if columns of a recording differ in length.
pub fn diagnosis_page(page: &DiagnosisPage) -> Result<String, FigureError> {
    let mut recordings = page.recordings.iter().map(Samples::new).collect::<Result<Vec<_>, _>>()?;
    recordings.retain(|samples| !samples.force_n.is_empty());
    let noise_n = page.estimation.noise_floor_n;
    let sections = [
        ("mismatch", "Is there a mismatch?", mismatch(page)?),
        ("where", "Where do model and recordings differ?", place::place(page, &recordings)?),
        ("what", "What was left out?", named::named(page)),
        ("gain", "What does it buy?", ending::gain(page, &recordings)?),
        ("unknown", "What is still unknown?", ending::unknown(page)),
        ("next", "What to record next", ending::next(page.next_experiment.as_ref())),
        ("apart", "What could these recordings tell apart at all?", {
            telling_apart::telling_apart(page.isolability.as_ref(), noise_n)?
        }),
        ("appendix", "Appendix: how this came about", ending::appendix(&page.appendix)),
    ];
    Ok(document(&page.title, &headline::headline(page), &sections, "", ""))
}

/// Section: whether there is a mismatch.
fn mismatch(page: &DiagnosisPage) -> Result<String, FigureError> {
    let PageFit { rmse_before_n, noise_floor_n, .. } = page.estimation;
    let factor = rmse_before_n / noise_floor_n;
    let times = if factor.is_finite() {
        format!(", {factor:.1} times the noise floor of {}", newtons(noise_floor_n))
    } else {
        String::new()
    };
    // Where only the model as given misses the recordings, its refit follows them.
    let refit_follows = page.regions.is_empty() && page.effects.is_empty() && page.unknown.regions.is_empty();
    let verdict = match page.verdict {
        PageVerdict::Unexplained if refit_follows => {
            "The verdict is that of the model as given and of what was held out."
        }
        PageVerdict::Consistent => {
            "That is within what noise, the uncertainty of the parameters or the limit of what matters allow."
        }
        PageVerdict::Explained | PageVerdict::ExplainedInPart | PageVerdict::Ambiguous | PageVerdict::Unexplained => {
            "More than noise and the uncertainty of the parameters allow."
        }
    };
    let text =
        format!("Refitted to these recordings, the base model leaves {}{times}. {verdict}", newtons(rmse_before_n));
    let mut fits = vec![("estimation recordings", page.estimation)];
    fits.extend(page.holdout.map(|fit| ("held-out recordings", fit)));
    let svg = fit_bars::fit_bars("Residual before and after", &fits, !page.effects.is_empty())?;
    let caption = "Residual, root mean square over samples whose direction of motion is settled. No model comes below \
                   the noise floor but by fitting noise.";
    let given = page.as_given.as_ref().map_or(String::new(), given::given);
    Ok(paragraph(&text) + &figure(&svg, caption) + &given)
}
