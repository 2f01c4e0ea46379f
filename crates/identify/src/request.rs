//! What is asked of an identification.

use pam_artifact::model::{Assumed, Loss};
use pam_muscle::MuscleFile;
use pam_muscle::force::{Form, Parameter};
use pam_recording::Recording;

use crate::fit::FitOptions;

/// What to fit to what.
#[derive(Debug)]
pub struct Request {
    /// Recordings that parameters are fitted to.
    pub estimation: Vec<Recording>,
    /// Recordings that are held out.
    pub validation: Vec<Recording>,
    /// The muscle as measured.
    pub muscle: MuscleFile,
    /// How eq. 11 is written.
    pub form: Form,
    /// Size of the search.
    pub options: FitOptions,
    /// Cost of a residual.
    pub loss: Loss,
    /// Parameters fitted on their own that are otherwise one share of a composite: `C₀₁`, `f_ss`.
    pub free: Vec<Parameter>,
    /// Parameters held at a value, in SI.
    pub fix: Vec<(Parameter, f64)>,
    /// By how much the length turns back before the direction flips, in m; from the noise if not given.
    pub length_play_m: Option<f64>,
    /// Likewise for the pressure, in Pa.
    pub pressure_play_pa: Option<f64>,
    /// What is assumed of bladder, friction and standstill; what is left open is judged by the recordings.
    pub assumed: Assumed,
    /// Go on where an instrument fault is suspected.
    pub accept_implausible: bool,
    /// Show what the columns reach without bounds.
    pub unbounded: bool,
}

impl Request {
    /// A search of the size of `options` for the corrected eq. 11 of `muscle` in `estimation`, with nothing else asked or assumed.
    pub fn of(estimation: Vec<Recording>, muscle: MuscleFile, options: FitOptions) -> Self {
        Self {
            estimation,
            validation: Vec::new(),
            muscle,
            form: Form::Corrected,
            options,
            loss: Loss::Square,
            free: Vec::new(),
            fix: Vec::new(),
            length_play_m: None,
            pressure_play_pa: None,
            assumed: Assumed::default(),
            accept_implausible: false,
            unbounded: false,
        }
    }
}
