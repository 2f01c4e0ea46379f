//! Why a diagnosis cannot be made.

use pam_identification::error::IdentifyError;

/// Why a diagnosis cannot be made; every message names the place and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum DiagnoseError {
    /// A recording is not what an identification could use either.
    #[error(transparent)]
    Recording(#[from] IdentifyError),
    /// Too little to tell structure from noise.
    #[error(
        "{path}: {have_s:.1} s of motion in all is too short to judge by; record at least {more_s:.0} s more (blocks of some \
         seconds are held out in turn)"
    )]
    TooShort {
        /// First recording.
        path: String,
        /// What there is, in s.
        have_s: f64,
        /// What is missing, in s.
        more_s: f64,
    },
    /// Something about the instruments is wrong before any physics is.
    // A diagnosis knows the muscle from its model, a fit from the muscle file.
    #[error("{}", .0.to_string().replace("muscle file", "model"))]
    Fault(pam_identification::faults::Fault),
    /// Parameters that are those of another muscle.
    #[error(
        "{path}: the model as given misses the recordings by {given_n:.1} N, refitted by {refitted_n:.1} N{shifted}: {reason}; \
         identify a model from them with pam-identify, set the instrument right, or go on with --accept-implausible"
    )]
    AnotherMuscle {
        /// First recording.
        path: String,
        /// RMSE of the model as given, in N.
        given_n: f64,
        /// RMSE of the refitted model, in N.
        refitted_n: f64,
        /// Parameters that moved, in words.
        shifted: String,
        /// What would explain it, in words.
        reason: String,
    },
    /// Later recordings that the model of then does not follow at all.
    #[error(
        "{path}: the baseline explains {explained:.0} % of the force and misses it by {left_n:.1} N, by {now_n:.1} N with all that may \
         have changed: it is of another muscle; name the baseline of this one, or go on with --accept-implausible"
    )]
    NotOfThen {
        /// First recording.
        path: String,
        /// RMSE of the model of then, in N.
        left_n: f64,
        /// The same with what changes explain, in N.
        now_n: f64,
        /// Share of the variance that it explains, in percent.
        explained: f64,
    },
    /// Later recordings where the model of then was never asked.
    #[error(
        "{path}: hardly anything lies within the pressures ({low:.0} to {high:.0} kPa) and lengths ({short:.1} to {long:.1} mm) of \
         the baseline; record within them, or diagnose the recordings by themselves"
    )]
    Elsewhere {
        /// First recording.
        path: String,
        /// Lowest pressure, in kPa.
        low: f64,
        /// Highest pressure, in kPa.
        high: f64,
        /// Shortest length, in mm.
        short: f64,
        /// Longest length, in mm.
        long: f64,
    },
    /// A channel that should vary does not.
    #[error("{path}: {channel} stays at {value} {unit} throughout; check its wiring, or leave the recording out")]
    Constant {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// Where it stays.
        value: f64,
        /// Unit.
        unit: &'static str,
    },
    /// A channel at the end of its range.
    #[error(
        "{path}: {channel} stands at {value:.1} {unit}, the end of its range, in {percent:.0} % of the samples; the sensor is \
         saturated: leave the recording out, or take a sensor with more range"
    )]
    Saturated {
        /// Recording.
        path: String,
        /// Channel.
        channel: &'static str,
        /// Where it stands.
        value: f64,
        /// Unit.
        unit: &'static str,
        /// Share of the samples, in percent.
        percent: f64,
    },
    /// The recordings do not determine even the base model.
    #[error("{path}: the recordings do not determine the base model; add one in which pressure and length both change")]
    Undetermined {
        /// First recording.
        path: String,
    },
}
