//! The summary of a shard.

use pam_artifact::agreement::AgreementArtifact;
use pam_artifact::summary::{Answer, SCHEMA, Shard, SummaryArtifact};
use pam_artifact::{Input, Tool};
use pam_muscle::MuscleFile;
use pam_recording::quality::parts::Extent;
use pam_recording::{CHUNK_ROWS, Recording};

use super::answer::answer;
use super::cut::TIMES;
use super::error::ShardError;
use crate::error::IdentifyError;

/// What a summary begins with.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Program that writes it.
    pub tool: Tool,
    /// Files that go into it.
    pub inputs: Vec<Input>,
    /// SHA-256 of the options that the recording was read with, hexadecimal.
    pub reading_sha256: String,
}

/// The summary of `recording`, which is `shard`: how many rows it has, or its answer to `agreement`.
///
/// # Errors
/// [`ShardError`] where it has no force, where the agreement is of other shards, or samples cannot be read back.
pub fn summarize(
    recording: &Recording,
    shard: Shard,
    muscle: &MuscleFile,
    agreement: Option<&AgreementArtifact>,
    head: Head,
) -> Result<SummaryArtifact, ShardError> {
    let unreadable = |reason: std::io::Error| IdentifyError::Samples { path: recording.path.clone(), reason };
    if !recording.samples.has_force() {
        return Err(IdentifyError::NoForce { path: recording.path.clone() }.into());
    }
    let (pass, edges, answer) = match agreement {
        None => (1, Vec::new(), Answer::Extent {}),
        Some(agreement) => {
            let place = agreement
                .recordings
                .iter()
                .enumerate()
                .find_map(|(index, cut)| Some((index, cut.shards.iter().position(|known| *known == shard)?)));
            let place = place.ok_or_else(|| ShardError::Unknown { path: shard.path.clone() })?;
            if head.reading_sha256 != agreement.reading_sha256 {
                let other = agreement.recordings[0].shards[0].path.clone();
                return Err(ShardError::Differs { path: shard.path, what: "set of options of reading", other });
            }
            let (edges, answer) = answer(agreement, muscle, place, recording)?;
            (agreement.pass, edges, answer)
        }
    };
    let samples = &recording.samples;
    let (mut first_times_s, mut last_times_s) = (Vec::new(), Vec::new());
    if samples.n_rows() > 0 {
        first_times_s.extend(samples.chunk(0).map_err(unreadable)?.time_s().iter().take(TIMES));
        let from = samples.n_rows().saturating_sub(TIMES);
        for index in from / CHUNK_ROWS..samples.n_chunks() {
            let chunk = samples.chunk(index).map_err(unreadable)?;
            last_times_s.extend_from_slice(&chunk.time_s()[from.saturating_sub(chunk.first_row())..]);
        }
    }
    Ok(SummaryArtifact {
        schema: SCHEMA.to_owned(),
        tool: head.tool,
        inputs: head.inputs,
        shard,
        reading_sha256: head.reading_sha256,
        extent: Extent::of(recording).map_err(unreadable)?,
        segments: recording.segments.iter().map(|rows| [rows.start, rows.end]).collect(),
        repairs: recording.repairs.clone(),
        first_times_s,
        last_times_s,
        edges,
        pass,
        answer,
    })
}
