//! Answers of all places, in order of their rows.

use std::ops::Range;

use pam_artifact::agreement::{Begins, CutRecording, Question};
use pam_artifact::summary::{Answer, Ends, Open, Rows, SummaryArtifact};
use pam_muscle::direction::Carried;
use pam_recording::Samples;

use super::answer::{Shared, answer_of};
use super::error::ShardError;
use super::parts::{Part, parts};
use super::tile::{Tile, samples_of};

/// Answers of all places in a recording, in order of their rows: the rows that are counted, and what was found in them.
pub(super) struct Found {
    pub(super) answers: Vec<Vec<Answer>>,
    /// What every shard should have begun with, by law, recording and shard.
    carried: Vec<Vec<Vec<Carried>>>,
    /// By law and recording.
    at_rest: Vec<Vec<bool>>,
    /// The stretch that every shard should have gone on with, by recording and shard.
    pub(super) open: Vec<Vec<Option<Open>>>,
}

/// Answers of shards and of what cuts divide, in order of the rows.
pub(super) fn find(
    shared: &Shared<'_>,
    summaries: &[SummaryArtifact],
    order: &[Vec<usize>],
) -> Result<Found, ShardError> {
    let question = &shared.agreement.question;
    let n_laws = match question {
        Question::Sample {} | Question::Travels { .. } => 0,
        Question::Exclude { laws, .. } | Question::Laws { laws, .. } => laws.len(),
        Question::Condense { .. } | Question::Tally { .. } => 1,
    };
    let n_recordings = shared.agreement.recordings.len();
    let mut found = Found {
        answers: Vec::new(),
        carried: vec![Vec::new(); n_laws],
        at_rest: vec![vec![false; n_recordings]; n_laws],
        open: Vec::new(),
    };
    for (index, cut) in shared.agreement.recordings.iter().enumerate() {
        let mut begins = vec![Carried::UNKNOWN; n_laws];
        let mut moves = vec![false; n_laws];
        let (mut answers, mut open) = (Vec::new(), None);
        found.open.push(vec![None; cut.shards.len()]);
        found.carried.iter_mut().for_each(|law| law.push(vec![Carried::UNKNOWN; cut.shards.len()]));
        for part in parts(cut) {
            let answer = match part.shard {
                Some(shard) => {
                    // At the beginning of a segment nothing is carried.
                    let goes_on = cut.segments.iter().all(|segment| segment[0] != part.owned.start);
                    for (law, begin) in found.carried.iter_mut().zip(&begins) {
                        law[index][shard] = if goes_on { *begin } else { Carried::UNKNOWN };
                    }
                    found.open[index][shard] = open;
                    summaries[order[index][shard]].answer.clone()
                }
                None => {
                    let samples = divided(&part, cut, summaries, &order[index])?;
                    answer_of(&Tile::of(cut, &part, samples), shared, index, &begins, open.as_ref())?
                }
            };
            open = if let Answer::Condensed { open, .. } = &answer { open.clone() } else { None };
            let ends = ends_of(&answer);
            if ends.len() != n_laws {
                let path = part.shard.map_or_else(|| cut.name.clone(), |shard| cut.shards[shard].path.clone());
                return Err(ShardError::Lacks { path, pass: shared.agreement.pass - 1 });
            }
            for (law, ends) in ends.iter().enumerate() {
                begins[law] = ends.carried;
                moves[law] |= ends.moves;
            }
            answers.push(answer);
        }
        for (at_rest, moves) in found.at_rest.iter_mut().zip(&moves) {
            at_rest[index] = !moves;
        }
        found.answers.push(answers);
    }
    Ok(found)
}

impl Found {
    /// What every shard should have begun with under a law.
    pub(super) fn begins(&self, law: usize) -> Begins {
        Begins { carried: self.carried[law].clone(), at_rest: self.at_rest[law].clone() }
    }
}

/// Where an answer says that the direction ends, law by law.
fn ends_of(answer: &Answer) -> Vec<Ends> {
    match answer {
        Answer::Extent {} | Answer::Sampled { .. } | Answer::Travels { .. } => Vec::new(),
        Answer::Excluded { ends, .. } | Answer::Laws { ends, .. } => ends.clone(),
        Answer::Condensed { ends, .. } | Answer::Tallied { ends, .. } => vec![*ends],
    }
}

/// The rows of a part that a cut divides, from both sides of it.
fn divided(
    part: &Part,
    cut: &CutRecording,
    summaries: &[SummaryArtifact],
    order: &[usize],
) -> Result<Samples, ShardError> {
    let mut handed: Vec<&Rows> = Vec::new();
    for (shard, &[start, end]) in cut.rows.iter().enumerate() {
        let rows: Range<usize> = part.held.start.max(start)..part.held.end.min(end);
        if rows.start >= rows.end {
            continue;
        }
        let summary = &summaries[order[shard]];
        let is_it = |edge: &&Rows| edge.first_row == rows.start && edge.time_s.len() == rows.len();
        let Some(edge) = summary.edges.iter().find(is_it) else {
            return Err(ShardError::Lacks { path: summary.shard.path.clone(), pass: summary.pass });
        };
        handed.push(edge);
    }
    Ok(samples_of(&handed))
}
