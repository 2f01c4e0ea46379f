//! `pam-summary/1`: what a shard of the recordings answers to what all shards have to agree on.
//!
//! A shard is some consecutive rows of a recording, or a whole one. Its summary holds what its rows condense to, and, where the
//! recording goes on in another shard, the rows themselves near the cut: the direction of motion remembers nothing across the
//! borders of stretches of [`STRETCH_ROWS`](pam_muscle::direction::STRETCH_ROWS) rows, counted from the last gap, so that these borders
//! are where the work can be divided. The stretch that a cut divides is put together from the rows on either side.

use std::path::Path;

use pam_muscle::direction::Carried;
use pam_recording::Repairs;
use pam_recording::quality::parts::Extent;
use pam_recording::quality::recording::Rates;
use pam_recording::quality::stuck::StuckRuns;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ArtifactError;
use super::origin::{Input, Tool};

/// Schema name and version.
pub const SCHEMA: &str = "pam-summary/1";

/// A shard, and its answer to the question of an agreement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SummaryArtifact {
    /// `pam-summary/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it: muscle, channels, recording.
    pub inputs: Vec<Input>,
    /// Which rows it stands for.
    pub shard: Shard,
    /// SHA-256 of the options that the recording was read with, hexadecimal.
    pub reading_sha256: String,
    /// What lies in it.
    pub extent: Extent,
    /// Stretches without a gap, as rows of the shard.
    pub segments: Vec<[usize; 2]>,
    /// What was repaired or left out while reading.
    pub repairs: Repairs,
    /// Times of its first rows, in s.
    pub first_times_s: Vec<f64>,
    /// Times of its last rows, in s.
    pub last_times_s: Vec<f64>,
    /// Rows near its cuts, as they are.
    pub edges: Vec<Rows>,
    /// Pass that it answers, from 1.
    pub pass: u32,
    /// The answer.
    pub answer: Answer,
}

/// Which rows of which recording a shard has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Name of the recording; where it was not cut, the path.
    pub recording: String,
    /// Number of the shard within it, from 1.
    pub number: usize,
    /// Shards that it was cut into.
    pub of: usize,
    /// Path of the shard's file as given.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// Consecutive rows of a recording, in SI.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rows {
    /// Index in the recording of the first.
    pub first_row: usize,
    /// Times, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressures, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Lengths, in m.
    pub length_m: Vec<f64>,
    /// Tensions, in N.
    pub force_n: Vec<f64>,
}

/// What rows of columns and force condense to: the triangle R of their QR factorization.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// Columns beside the force.
    pub n_columns: usize,
    /// Rows that it stands for.
    pub n_rows: u64,
    /// Its rows, each from its diagonal on, one after the other.
    pub upper: Vec<f64>,
}

/// Where the direction ends after some rows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Ends {
    /// The state that the next row begins with.
    pub carried: Carried,
    /// Whether anything has moved.
    pub moves: bool,
}

/// One of the stretches that standard errors are judged by, which ends in these rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StretchPart {
    /// Number of the stretch within its recording.
    pub stretch: usize,
    /// What all of its rows condense to.
    pub triangle: Triangle,
}

/// A stretch that goes on in the next rows: to continue as if there were no border takes no more than this.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Open {
    /// What has been folded so far, in whole blocks.
    pub triangle: Triangle,
    /// Rows of columns and force that wait for their block to be full, one after the other.
    pub waiting: Vec<f64>,
}

/// Sums over samples beside a model.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TallySums {
    /// Counted samples.
    pub n_samples: usize,
    /// Excluded ones.
    pub n_unsettled: usize,
    /// Samples that the model has no force for.
    pub n_without_force: usize,
    /// Time, pressure and length of the first of these, in SI.
    pub first_without_force: Option<[f64; 3]>,
    /// Residuals of counted samples, in N.
    pub residuals: f64,
    /// Their squares, in N².
    pub residual_squares: f64,
    /// Squares of the residuals of excluded samples, in N².
    pub unsettled_squares: f64,
    /// Largest residual of a counted sample, in N.
    pub largest: f64,
    /// Force of the first counted sample, in N.
    pub first_force_n: f64,
    /// Forces less that, in N.
    pub forces: f64,
    /// Their squares, in N².
    pub force_squares: f64,
    /// What noise does to the residual of a perfect model: squares in N², and samples that they were taken at.
    pub noise_floor: [f64; 2],
}

/// What a shard answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Answer {
    /// Nothing but what lies in it.
    Extent {},
    /// What noise, quantization and ranges are judged by.
    Sampled {
        /// Its part of the rows that noise is estimated on.
        sampled: Vec<Rows>,
        /// Values spread over force, pressure and length, in SI.
        spread: [Vec<f64>; 3],
        /// Runs of equal values of pressure, length and force.
        stuck: [StuckRuns; 3],
    },
    /// Samples that no fit may count, as rows of the recording, and rates.
    Excluded {
        /// Rows at which force, pressure and length leap.
        spikes: [Vec<usize>; 3],
        /// First rows of windows in which the muscle is shaken.
        shaken: Vec<usize>,
        /// Rows beyond a sensor's range.
        beyond: Vec<[usize; 2]>,
        /// Fastest changes.
        rates: Rates,
        /// Where the direction ends under every law, if nothing is known of what comes before.
        ends: Vec<Ends>,
    },
    /// What hypotheses of friction at standstill leave.
    Laws {
        /// For every hypothesis.
        triangles: Vec<Triangle>,
        /// For every law.
        ends: Vec<Ends>,
    },
    /// What travels of turning leave, for every play and every travel.
    Travels {
        /// The triangles.
        triangles: Vec<Triangle>,
    },
    /// What eq. 11 is fitted to.
    Condensed {
        /// The stretches that end in its rows.
        parts: Vec<StretchPart>,
        /// The stretch that goes on after them.
        open: Option<Open>,
        /// Where the direction ends.
        ends: Ends,
    },
    /// How the model agrees.
    Tallied {
        /// Sums.
        sums: TallySums,
        /// Where the direction ends.
        ends: Ends,
    },
}

impl SummaryArtifact {
    /// The file, on one line.
    ///
    /// # Errors
    /// [`ArtifactError::Unreadable`] where it is no JSON.
    pub fn json(&self) -> Result<Vec<u8>, ArtifactError> {
        super::json::line_json(self)
    }

    /// Reads a summary.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    pub fn read(path: &Path) -> Result<Self, ArtifactError> {
        Ok(super::json::read::<Self>(path, SCHEMA, "pam-identify --summary-only")?.0)
    }
}
