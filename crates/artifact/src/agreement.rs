//! `pam-agreement/1`: what shards have agreed on so far, and what each is asked next.
//!
//! Nodes of the search, noise, plays, excluded samples, the law at standstill and the travels of turning depend on all rows. Each
//! pass over the shards settles one of them, and the next builds on it.

use std::path::Path;

use pam_muscle::direction::{Carried, Standstill, Thresholds};
use pam_recording::Repairs;
use pam_recording::quality::RecordingQuality;
use pam_recording::quality::parts::Extent;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ArtifactError;
use super::identify_config::StandstillFit;
use super::origin::{Input, Tool};
use super::summary::{Ends, Open, Shard, StretchPart};

/// Schema name and version.
pub const SCHEMA: &str = "pam-agreement/1";

/// What is agreed on, and the next question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AgreementArtifact {
    /// `pam-agreement/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Muscle and files of the shards.
    pub inputs: Vec<Input>,
    /// SHA-256 of the options that recordings were read with, hexadecimal.
    pub reading_sha256: String,
    /// SHA-256 of the options of the fit, hexadecimal.
    pub options_sha256: String,
    /// Pass that is asked for, from 2.
    pub pass: u32,
    /// Recordings and how they were cut.
    pub recordings: Vec<CutRecording>,
    /// Largest product of pressure and length, in N/m: the contact of the strands is interpolated up to there.
    pub largest_pressure_length_n_per_m: f64,
    /// What is asked.
    pub question: Question,
    /// Laws that have been compared.
    pub laws: Vec<JudgedLaw>,
    /// Where the direction ended under each of them: by recording, every shard's beginning; whether nothing moves.
    pub begins: Vec<LawBegins>,
    /// What the recordings condense to, once that is known: the stretches of each.
    pub condensed: Vec<Vec<StretchPart>>,
}

/// A recording and its shards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CutRecording {
    /// Its name.
    pub name: String,
    /// Its shards, in order.
    pub shards: Vec<Shard>,
    /// Their rows.
    pub rows: Vec<[usize; 2]>,
    /// What lies in it.
    pub extent: Extent,
    /// Stretches without a gap.
    pub segments: Vec<[usize; 2]>,
    /// What was repaired while reading.
    pub repairs: Repairs,
    /// What it looks like, once that is known.
    pub quality: Option<RecordingQuality>,
    /// Rows that no fit counts, ascending.
    pub excluded: Vec<[usize; 2]>,
}

/// A law of friction at standstill, and what it leaves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JudgedLaw {
    /// The law and its RMSE.
    pub fit: StandstillFit,
    /// Whether beside a pressure that is late.
    pub late: bool,
}

/// How the shards begin under a law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawBegins {
    /// The law.
    pub standstill: Standstill,
    /// With what.
    pub begins: Begins,
}

/// With what the direction begins in every shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Begins {
    /// By recording and shard.
    pub carried: Vec<Vec<Carried>>,
    /// By recording: nothing moves in it.
    pub at_rest: Vec<bool>,
}

/// A law, and whether a late pressure stands beside it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Hypothesis {
    /// Index of the law.
    pub law: usize,
    /// Whether beside a pressure that is late.
    pub late: bool,
}

/// What every shard is asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Question {
    /// Samples of every channel.
    Sample {},
    /// Samples that no fit may count.
    Exclude {
        /// Thresholds of the direction.
        thresholds: Thresholds,
        /// By recording, how far force, pressure and length leap at a spike, in SI; none where there cannot be any.
        leaps_by: Vec<[Option<f64>; 3]>,
        /// Laws of friction at standstill.
        laws: Vec<Standstill>,
    },
    /// What laws of friction at standstill leave.
    Laws {
        /// Thresholds of the direction.
        thresholds: Thresholds,
        /// The laws; the first one settles which samples count.
        laws: Vec<Standstill>,
        /// How the shards begin under each of them.
        begins: Vec<Begins>,
        /// What is compared.
        hypotheses: Vec<Hypothesis>,
        /// Every how many rows of a recording are looked at.
        stride: usize,
    },
    /// What travels of turning leave.
    Travels {
        /// Thresholds of the direction.
        thresholds: Thresholds,
        /// Plays of the length, in m.
        plays_m: Vec<f64>,
        /// Rows of every recording that are looked at, its first ones.
        first: usize,
    },
    /// What eq. 11 is fitted to.
    Condense {
        /// Thresholds of the direction.
        thresholds: Thresholds,
        /// How the shards begin.
        begins: Begins,
        /// By recording and shard: the stretch that began before it.
        open: Vec<Vec<Option<Open>>>,
    },
    /// How the model agrees.
    Tally {
        /// Thresholds of the direction.
        thresholds: Thresholds,
        /// How the shards begin.
        begins: Begins,
        /// The eight parameters of eq. 11, in SI.
        theta: [f64; 8],
    },
}

impl Ends {
    /// Nothing is known, and nothing moves.
    pub const UNKNOWN: Self = Self { carried: Carried::UNKNOWN, moves: false };
}

impl AgreementArtifact {
    /// The file, on one line.
    ///
    /// # Errors
    /// [`ArtifactError::Unreadable`] where it is no JSON.
    pub fn json(&self) -> Result<Vec<u8>, ArtifactError> {
        super::json::line_json(self)
    }

    /// Reads an agreement.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    pub fn read(path: &Path) -> Result<Self, ArtifactError> {
        Ok(super::json::read::<Self>(path, SCHEMA, "pam-identify --from-summaries")?.0)
    }
}
