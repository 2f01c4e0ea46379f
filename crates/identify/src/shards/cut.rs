//! Shards put together into recordings.

use pam_artifact::agreement::CutRecording;
use pam_artifact::summary::{Shard, SummaryArtifact};
use pam_recording::Repairs;

use super::error::ShardError;

/// Rows of either end of a shard by which a gap at a cut is told.
pub const TIMES: usize = 64;

/// Steps, and times the shorter of its neighbors, that a gap between two shards is longer than: as within a recording that is read.
const GAP_STEPS: f64 = 20.0;
/// See [`GAP_STEPS`].
const GAP_NEIGHBORS: f64 = 5.0;

/// The recordings that shards make, in the order in which the first shard of each is named, and of every shard of theirs the
/// place among `summaries`.
///
/// # Errors
/// [`ShardError`] where they do not go together.
pub fn recordings(summaries: &[SummaryArtifact]) -> Result<(Vec<CutRecording>, Vec<Vec<usize>>), ShardError> {
    for (index, summary) in summaries.iter().enumerate() {
        alike(summary, &summaries[0])?;
        let same = |other: &&SummaryArtifact| {
            let (one, other) = (&summary.shard, &other.shard);
            one.sha256 == other.sha256 || (&one.recording, one.number) == (&other.recording, other.number)
        };
        if let Some(other) = summaries[..index].iter().find(same) {
            let (as_one, as_other) = (said(&other.shard), said(&summary.shard));
            return Err(ShardError::Twice { path: summary.shard.path.clone(), as_one, as_other });
        }
    }
    let mut names: Vec<&str> = Vec::new();
    for summary in summaries {
        if !names.contains(&summary.shard.recording.as_str()) {
            names.push(&summary.shard.recording);
        }
    }
    let mut places: Vec<Vec<usize>> = Vec::new();
    let mut found = Vec::new();
    for name in names {
        let mut of: Vec<usize> =
            (0..summaries.len()).filter(|&index| summaries[index].shard.recording == name).collect();
        of.sort_by_key(|&index| summaries[index].shard.number);
        found.push(together(name, &of.iter().map(|&index| &summaries[index]).collect::<Vec<_>>())?);
        places.push(of);
    }
    Ok((found, places))
}

/// Refuses summaries that were made otherwise.
pub(super) fn alike(one: &SummaryArtifact, other: &SummaryArtifact) -> Result<(), ShardError> {
    use pam_artifact::InputRole;
    let muscle = |summary: &SummaryArtifact| {
        let muscle = summary.inputs.iter().find(|input| input.role == InputRole::Muscle);
        muscle.map(|input| input.sha256.clone())
    };
    let what = if one.tool != other.tool {
        "version of the program"
    } else if muscle(one) != muscle(other) {
        "muscle file"
    } else if one.reading_sha256 != other.reading_sha256 {
        "set of options of reading"
    } else {
        return Ok(());
    };
    Err(ShardError::Differs { path: one.shard.path.clone(), what, other: other.shard.path.clone() })
}

fn said(shard: &Shard) -> String {
    format!("{}:{}/{}", shard.recording, shard.number, shard.of)
}

/// One recording from its shards in order.
fn together(name: &str, shards: &[&SummaryArtifact]) -> Result<CutRecording, ShardError> {
    let recording = || name.to_owned();
    let of = shards[0].shard.of;
    for (index, summary) in shards.iter().enumerate() {
        if summary.shard.of != of {
            return Err(ShardError::Count { recording: recording(), one: of, other: summary.shard.of });
        }
        if summary.shard.number != index + 1 {
            return Err(ShardError::Missing { recording: recording(), number: index + 1, of });
        }
    }
    if shards.len() < of {
        return Err(ShardError::Missing { recording: recording(), number: shards.len() + 1, of });
    }
    let mut cut = CutRecording {
        name: recording(),
        shards: shards.iter().map(|summary| summary.shard.clone()).collect(),
        rows: vec![[0, shards[0].extent.n_rows]],
        extent: shards[0].extent.clone(),
        segments: shards[0].segments.clone(),
        repairs: shards[0].repairs.clone(),
        quality: None,
        excluded: Vec::new(),
    };
    for pair in shards.windows(2) {
        let (before, after) = (pair[0], pair[1]);
        let gap_s = after.extent.first_s - before.extent.last_s;
        if gap_s <= 0.0 {
            return Err(ShardError::Overlap {
                recording: recording(),
                number: after.shard.number,
                begins_s: after.extent.first_s,
                before: before.shard.number,
                ends_s: before.extent.last_s,
            });
        }
        let first_row = cut.extent.n_rows;
        let mut segments = after.segments.iter().map(|&[start, end]| [first_row + start, first_row + end]);
        join_repairs(&mut cut.repairs, &after.repairs);
        if is_gap(gap_s, &before.last_times_s, &after.first_times_s) {
            cut.repairs.gaps += 1;
            cut.repairs.longest_gap_s = cut.repairs.longest_gap_s.max(gap_s);
        } else if let Some((last, [_, end])) = cut.segments.last_mut().zip(segments.next()) {
            last[1] = end;
        }
        cut.segments.extend(segments);
        cut.extent = cut.extent.joined(&after.extent);
        cut.rows.push([first_row, cut.extent.n_rows]);
    }
    let rate_hz = {
        let times_s = &shards[0].first_times_s;
        (times_s.len().max(2) - 1) as f64 / (times_s.last().unwrap_or(&1.0) - times_s.first().unwrap_or(&0.0))
    };
    if of > 1 && 0.04 * rate_hz > super::parts::BESIDE_ROWS as f64 {
        return Err(ShardError::TooFast { recording: recording(), rate_hz });
    }
    Ok(cut)
}

fn join_repairs(repairs: &mut Repairs, next: &Repairs) {
    repairs.repeated_stamps_spread += next.repeated_stamps_spread;
    repairs.rows_skipped += next.rows_skipped;
    repairs.first_skipped.extend(next.first_skipped.iter().cloned());
    repairs.gaps += next.gaps;
    repairs.longest_gap_s = repairs.longest_gap_s.max(next.longest_gap_s);
    repairs.blank_lines += next.blank_lines;
}

/// Whether rows are missing between two shards, `gap_s` apart, that end and begin at these times.
fn is_gap(gap_s: f64, before_s: &[f64], after_s: &[f64]) -> bool {
    let steps = |times_s: &[f64]| times_s.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    let (before_s, after_s) = (steps(before_s), steps(after_s));
    let neighbor_s = before_s.last().copied().unwrap_or(f64::INFINITY);
    let neighbor_s = neighbor_s.min(after_s.first().copied().unwrap_or(f64::INFINITY));
    let mut steps_s = [before_s, after_s].concat();
    if steps_s.is_empty() {
        return false;
    }
    let middle = (steps_s.len() - 1) / 2;
    let step_s = *steps_s.select_nth_unstable_by(middle, f64::total_cmp).1;
    gap_s - step_s > GAP_STEPS * step_s && gap_s > GAP_NEIGHBORS * neighbor_s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_between_two_shards_is_no_gap_and_a_second_is() {
        let times = |from_s: f64| (0..40).map(|row| from_s + 0.005 * f64::from(row)).collect::<Vec<f64>>();
        let before = times(0.0);
        assert!(!is_gap(0.005, &before, &times(0.2)) && !is_gap(0.09, &before, &times(0.285)));
        assert!(is_gap(1.0, &before, &times(1.195)));
    }
}
