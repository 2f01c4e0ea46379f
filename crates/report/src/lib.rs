//! Tables and figures, as text for whoever writes it.
//!
//! Nothing here prints, opens a file or evaluates a model: figures take plain columns and give an SVG document, tables take cells and
//! give lines, and pages draw what artifacts have, in the artifacts' own types. Equal input gives equal bytes.
//!
//! In reading order: [`number`] (how numbers are written), [`Table`], [`text`] (what fits a terminal), [`plot`] (what figures are made of),
//! [`fit_figure()`] (the figure of a fit), [`prediction_figure()`] (of a prediction), [`inverse_figure()`] (of an inverse), [`lift_figure()`] (of a lift),
//! [`envelope_figure()`] (of many lifts), [`diagnosis_page()`] (the page of a diagnosis), [`fleet_page()`] (of many muscles), [`change_page()`] (of one muscle then and
//! now), [`signature_figure()`] (what
//! an effect looks like), [`confusion_figure()`] (what was concealed and what was named).

mod change_page;
mod confusion_figure;
mod diagnosis_page;
mod envelope_figure;
mod error;
mod escape;
mod fit_figure;
mod fleet_page;
mod inverse_figure;
mod lift_figure;
pub mod number;
mod page;
mod picture;
pub mod plot;
mod prediction_figure;
mod residual_cells;
mod signature_figure;
mod table;
pub mod text;

pub use change_page::{ChangePage, PageChange, PageCompared, change_page};
pub use confusion_figure::{ConfusionFigure, confusion_figure};
pub use diagnosis_page::{
    DiagnosisPage, PageAlternative, PageAppendix, PageBaseParameter, PageCandidate, PageEffect, PageEmpirical,
    PageEstimate, PageInput, PageParameter, PageRecording, PageTerm, PageUnknown, diagnosis_page,
};
pub use envelope_figure::{EnvelopeFigure, envelope_figure};
pub use error::FigureError;
pub use fit_figure::{FitFigure, FitRecording, Role, SwarmStart, fit_figure};
pub use fleet_page::{
    FleetCampaign, FleetChange, FleetChart, FleetPage, FleetPoint, FleetRefusal, FleetShift, FleetStanding, fleet_page,
};
pub use inverse_figure::{InverseCell, InverseFigure, InverseMap, RegionBar, SlopeCell, SlopeMap, inverse_figure};
pub use lift_figure::{LiftArm, LiftFigure, lift_figure};
pub use picture::PictureFormat;
pub use prediction_figure::{PredictionFigure, prediction_figure};
pub use signature_figure::{SignatureFigure, SignaturePanel, SignatureSeries, signature_figure};
pub use table::Table;
