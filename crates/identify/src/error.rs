//! Why a fit cannot be done.

use std::io;

/// Why a fit cannot be done; every message names the place and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum IdentifyError {
    /// The samples of a recording cannot be read back.
    #[error("{path}: cannot read the samples back from the temporary file: {reason}; set TMPDIR to a folder with room")]
    Samples {
        /// Recording.
        path: String,
        /// Message of the system.
        reason: io::Error,
    },
    /// A recording has no force, which a fit needs.
    #[error("{path}: no force was recorded, and there is nothing to fit to; name the column with --map")]
    NoForce {
        /// Recording.
        path: String,
    },
    /// Pressure is the same throughout.
    #[error(
        "{path}: pressure stays at {pressure_kpa:.1} kPa in every estimation recording, which cannot tell the \
         gas from the rubber; add a recording at another pressure"
    )]
    ConstantPressure {
        /// First estimation recording.
        path: String,
        /// Where it stays.
        pressure_kpa: f64,
    },
    /// Fewer samples than a fit can use.
    #[error(
        "{path}: {n_samples} samples for {n_parameters} parameters; at least {needed} are needed, record for longer"
    )]
    TooFewSamples {
        /// First estimation recording.
        path: String,
        /// Samples whose direction of motion is certain.
        n_samples: usize,
        /// Parameters.
        n_parameters: usize,
        /// Samples that would do.
        needed: usize,
    },
    /// Something about the instruments is wrong before any physics is.
    #[error("{0}")]
    Fault(crate::faults::Fault),
    /// A length at which the braid or the bladder does not exist.
    #[error(
        "{path}: length reaches {length_mm:.2} mm, where a braid with strands of {strand_mm:.2} mm is stretched \
         straight; check rest_length_mm and braid_angle_deg in the muscle file"
    )]
    LengthBeyondStrand {
        /// Recording.
        path: String,
        /// Longest length.
        length_mm: f64,
        /// Length of a strand.
        strand_mm: f64,
    },
    /// A model that has no force for samples that count.
    #[error(
        "{path}: the modelled force is no number in {n} of {n_counted} counted samples, first at {time_s:.3} s \
         ({pressure_kpa:.1} kPa, {length_mm:.2} mm); {reason}"
    )]
    WithoutForce {
        /// Recording.
        path: String,
        /// Samples without a modelled force.
        n: usize,
        /// Samples that count.
        n_counted: usize,
        /// When the first of them was recorded, in s.
        time_s: f64,
        /// Its gauge pressure, in kPa.
        pressure_kpa: f64,
        /// Its length, in mm.
        length_mm: f64,
        /// Why, and what to do.
        reason: String,
    },
    /// A recording of which no sample counts.
    #[error(
        "{path}: none of its {n_rows} samples counts, since all lie around reversals, before the first motion or beyond \
         a sensor's range; record for longer"
    )]
    NothingCounted {
        /// Recording.
        path: String,
        /// Its samples.
        n_rows: usize,
    },
    /// Every parameter is held by the user.
    #[error("every parameter is held with --fix, and nothing is left to fit; leave one of them out")]
    EverythingFixed,
    /// Recordings that say nothing of any parameter.
    #[error(
        "{path}: these recordings can identify none of {names}; record several pressures at several lengths, with motion \
         both ways"
    )]
    NothingIdentifiable {
        /// First estimation recording.
        path: String,
        /// The parameters.
        names: String,
    },
    /// A recording that is fitted twice, so that its samples count twice.
    #[error(
        "{path}: has the same samples as {other}, which is fitted as well; a recording counts once, or standard errors are \
         too small: leave one of them out"
    )]
    FittedTwice {
        /// The recording.
        path: String,
        /// The one before it.
        other: String,
    },
    /// A recording that is fitted and held out.
    #[error(
        "{path}: has the same samples as {other}, which is fitted; a hold-out must be a recording that nothing was fitted to"
    )]
    HeldOutAndFitted {
        /// Held-out recording.
        path: String,
        /// Estimation recording.
        other: String,
    },
    /// A recording that is held out twice.
    #[error("{path}: has the same samples as {other}, which is held out as well; leave one of them out")]
    HeldOutTwice {
        /// The recording.
        path: String,
        /// The one before it.
        other: String,
    },
}
