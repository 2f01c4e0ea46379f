//! The page of a diagnosis: one self-contained HTML document that is read from top to bottom.

mod content;
mod coordinate;
mod recording;

pub use content::{
    DiagnosisPage, PageAlternative, PageAppendix, PageCandidate, PageEffect, PageEvidence, PageExperiment, PageFit,
    PageImplausible, PageInput, PageIsolability, PageParameter, PageRegion, PageUnknown, PageVerdict,
};
pub use coordinate::PageCoordinate;
pub use recording::PageRecording;

use crate::FigureError;

/// Writes the page, as an HTML document.
///
/// # Errors
/// [`FigureError`] if columns of a recording differ in length.
pub fn diagnosis_page(page: &DiagnosisPage) -> Result<String, FigureError> {
    Ok(format!("<!DOCTYPE html>\n<title>{}</title>\n", page.title))
}
