//! Answers put together, and the next question.

use pam_artifact::agreement::{AgreementArtifact, Begins, CutRecording, Hypothesis, JudgedLaw, LawBegins, Question};
use pam_artifact::model::{IdentifyConfig, StandstillFit};
use pam_artifact::summary::{Answer, Rows, StretchPart, SummaryArtifact, TallySums, Triangle};
use pam_muscle::direction::{Carried, Standstill, Thresholds};
use pam_optim::summary::Summary;
use pam_recording::Samples;
use pam_recording::quality::RecordingQuality;
use pam_recording::quality::recording::Rates;
use pam_recording::quality::stuck::StuckRuns;

use super::answer::Shared;
use super::conclude::{self, conclude};
use super::cut::{alike, recordings};
use super::error::ShardError;
use super::gather::{Found, find};
use super::tile::{recording_of, samples_of};
use super::triangle::{summary, triangle};
use crate::error::IdentifyError;
use crate::evaluate::Tally;
use crate::faults::{shaken, spikes};
use crate::identified::Identified;
use crate::request::Request;
use crate::standstill::{self, turning_of, turning_plays_m, turning_rows};

/// What follows from the answers of all shards.
#[derive(Debug)]
pub enum Step {
    /// Another question.
    Ask(Box<AgreementArtifact>),
    /// The fit, and its options as an artifact states them.
    Done(Box<Identified>, IdentifyConfig),
}

/// What follows from `summaries` of all shards, which answer `agreement`, or begin without one; the agreement's head (tool,
/// inputs, options) is left empty. `request` has no recordings; its muscle, laws and options are those of the fit.
///
/// # Errors
/// [`ShardError`] where the summaries do not go together, or what they show is refused.
pub fn advance(
    request: Request,
    agreement: Option<AgreementArtifact>,
    summaries: &[SummaryArtifact],
    observe: &(dyn Fn() + Sync),
) -> Result<Step, ShardError> {
    let (cuts, places) = recordings(summaries)?;
    let asked = agreement.as_ref().map_or(1, |agreement| agreement.pass);
    for summary in summaries {
        let known = |cut: &CutRecording| cut.shards.contains(&summary.shard);
        let n_known =
            |agreement: &AgreementArtifact| agreement.recordings.iter().map(|cut| cut.shards.len()).sum::<usize>();
        if let Some(agreement) = &agreement
            && (!agreement.recordings.iter().any(known) || summaries.len() != n_known(agreement))
        {
            return Err(ShardError::Unknown { path: summary.shard.path.clone() });
        }
        if summary.pass != asked {
            return Err(ShardError::Pass { path: summary.shard.path.clone(), found: summary.pass, asked });
        }
        alike(summary, &summaries[0])?;
    }
    let Some(mut agreement) = agreement else {
        return Ok(Step::Ask(Box::new(first(cuts, summaries))));
    };
    agreement.pass += 1;
    // The agreement may name the recordings in another order.
    let order: Vec<Vec<usize>> = agreement
        .recordings
        .iter()
        .map(|cut| cuts.iter().position(|other| other.name == cut.name).map_or(Vec::new(), |at| places[at].clone()))
        .collect();
    if matches!(agreement.question, Question::Sample {}) {
        return judge_samples(request, agreement, summaries, &order);
    }
    let found = {
        let shared = Shared::of(&agreement, &request.muscle);
        find(&shared, summaries, &order)?
    };
    match agreement.question.clone() {
        Question::Sample {} => unreachable!("it was judged before"),
        Question::Exclude { thresholds, laws, .. } => {
            exclude(&mut agreement, summaries, &order, &found);
            agreement.begins = laws
                .iter()
                .enumerate()
                .map(|(law, &standstill)| LawBegins { standstill, begins: found.begins(law) })
                .collect();
            let checked = conclude::checked(request, &agreement)?;
            match checked.assumed.standstill {
                Some(standstill) => {
                    ask_travels(&mut agreement, &checked, Thresholds { standstill, ..thresholds });
                }
                None => {
                    let firsts = [standstill::laws(), standstill::few_laws()].concat();
                    ask_laws(&mut agreement, thresholds, firsts.into_iter().map(|law| (law, false)).collect());
                }
            }
            Ok(Step::Ask(Box::new(agreement)))
        }
        Question::Laws { thresholds, laws, begins, hypotheses, stride } => {
            let now: Vec<Begins> = (0..laws.len()).map(|law| found.begins(law)).collect();
            for (&standstill, begins) in laws.iter().zip(&now) {
                agreement.begins.retain(|known| known.standstill != standstill);
                agreement.begins.push(LawBegins { standstill, begins: begins.clone() });
            }
            if now != begins {
                agreement.question = Question::Laws { thresholds, laws, begins: now, hypotheses, stride };
                return Ok(Step::Ask(Box::new(agreement)));
            }
            let left = merged(&found, hypotheses.len())?;
            for (hypothesis, total) in hypotheses.iter().zip(&left) {
                let fit = StandstillFit { standstill: laws[hypothesis.law], rmse_n: mean_square(total).sqrt() };
                agreement.laws.push(JudgedLaw { fit, late: hypothesis.late });
            }
            let checked = conclude::checked(request, &agreement)?;
            match conclude::judged(&agreement) {
                Ok(judged) => {
                    let standstill = judged[0].standstill;
                    ask_travels(&mut agreement, &checked, Thresholds { standstill, ..thresholds });
                }
                Err(missing) => ask_laws(&mut agreement, thresholds, missing),
            }
            Ok(Step::Ask(Box::new(agreement)))
        }
        Question::Travels { thresholds, plays_m, .. } => {
            let left = merged(&found, plays_m.len() * standstill::turning_laws(thresholds).len())?;
            let left: Vec<f64> = left.iter().map(mean_square).collect();
            let checked = conclude::checked(request, &agreement)?;
            let (_, finest_m) = checked.thresholds();
            let thresholds = turning_of(&left, thresholds, finest_m);
            let begins = guess(&agreement, thresholds.standstill);
            let open = agreement.recordings.iter().map(|cut| vec![None; cut.shards.len()]).collect();
            agreement.question = Question::Condense { thresholds, begins, open };
            Ok(Step::Ask(Box::new(agreement)))
        }
        Question::Condense { thresholds, begins, open } => {
            let now = found.begins(0);
            if now != begins || found.open != open {
                agreement.question = Question::Condense { thresholds, begins: now, open: found.open };
                return Ok(Step::Ask(Box::new(agreement)));
            }
            agreement.condensed = stretches(&found);
            let checked = conclude::checked(request, &agreement)?;
            let theta = conclude::theta(&checked, &agreement, observe)?;
            agreement.question = Question::Tally { thresholds, begins, theta };
            Ok(Step::Ask(Box::new(agreement)))
        }
        Question::Tally { thresholds, begins, .. } => {
            debug_assert_eq!(found.begins(0), begins, "directions were agreed on");
            let tallies: Vec<(Tally, [f64; 2])> = found.answers.iter().map(|answers| tallied(answers)).collect();
            let checked = conclude::checked(request, &agreement)?;
            let config = checked.config();
            Ok(Step::Done(Box::new(conclude(checked, &agreement, thresholds, &tallies, observe)?), config))
        }
    }
}

/// The first agreement: how many rows there are, and where.
fn first(recordings: Vec<CutRecording>, summaries: &[SummaryArtifact]) -> AgreementArtifact {
    let largest = recordings.iter().map(|cut| cut.extent.largest_pressure_length_n_per_m).fold(0.0, f64::max);
    AgreementArtifact {
        schema: pam_artifact::agreement::SCHEMA.to_owned(),
        tool: summaries[0].tool.clone(),
        inputs: Vec::new(),
        reading_sha256: summaries[0].reading_sha256.clone(),
        options_sha256: String::new(),
        pass: 2,
        recordings,
        largest_pressure_length_n_per_m: largest,
        question: Question::Sample {},
        laws: Vec::new(),
        begins: Vec::new(),
        condensed: Vec::new(),
    }
}

/// Quality of every recording, and with it thresholds and what a spike is.
fn judge_samples(
    request: Request,
    mut agreement: AgreementArtifact,
    summaries: &[SummaryArtifact],
    order: &[Vec<usize>],
) -> Result<Step, ShardError> {
    let mut leaps_by = Vec::new();
    for (cut, order) in agreement.recordings.iter_mut().zip(order) {
        let mut all_rows: Vec<&Rows> = Vec::new();
        let mut spreads: [Vec<f64>; 3] = Default::default();
        let mut runs: [StuckRuns; 3] = Default::default();
        for &place in order {
            let summary = &summaries[place];
            let Answer::Sampled { sampled, spread, stuck } = &summary.answer else {
                return Err(ShardError::Lacks { path: summary.shard.path.clone(), pass: summary.pass });
            };
            all_rows.extend(sampled);
            spreads.iter_mut().zip(spread).for_each(|(all, some)| all.extend(some));
            for (index, (runs, next)) in runs.iter_mut().zip(stuck).enumerate() {
                runs.join(next, cut.extent.lowest[index], cut.extent.highest[index]);
            }
        }
        let nowhere = recording_of(cut, Samples::from_columns(&[], &[], &[], &[]), Vec::new());
        let samples = samples_of(&all_rows);
        let quality = RecordingQuality::of_elsewhere(&nowhere, &cut.extent, &samples, &runs)
            .map_err(|reason| IdentifyError::Samples { path: cut.name.clone(), reason })?;
        let mut noises = spikes::noises(&quality).into_iter();
        leaps_by.push(spreads.map(|spread| {
            let leap = spikes::Leap::of(spread, noises.next().unwrap_or(0.0));
            leap.map(|leap| leap.least)
        }));
        cut.quality = Some(quality);
    }
    let checked = conclude::checked(request, &agreement)?;
    let (thresholds, _) = checked.thresholds();
    let laws = match checked.assumed.standstill {
        Some(standstill) => vec![standstill],
        None => [standstill::laws(), standstill::few_laws()].concat(),
    };
    agreement.question = Question::Exclude { thresholds, leaps_by, laws };
    Ok(Step::Ask(Box::new(agreement)))
}

/// What shards most likely begin with under a law.
fn guess(agreement: &AgreementArtifact, standstill: Standstill) -> Begins {
    let same = agreement.begins.iter().find(|known| known.standstill == standstill);
    if let Some(known) = same.or(agreement.begins.first()) {
        return known.begins.clone();
    }
    let carried = agreement.recordings.iter().map(|cut| vec![Carried::UNKNOWN; cut.shards.len()]).collect();
    Begins { carried, at_rest: vec![false; agreement.recordings.len()] }
}

/// Asks what laws leave, each alone or beside a late pressure.
fn ask_laws(agreement: &mut AgreementArtifact, thresholds: Thresholds, wanted: Vec<(Standstill, bool)>) {
    // The law that follows the pressure at once says which samples count.
    let mut laws = vec![Standstill::AT_ONCE];
    let mut hypotheses = Vec::new();
    for (standstill, late) in wanted {
        let law = laws.iter().position(|law| *law == standstill).unwrap_or_else(|| {
            laws.push(standstill);
            laws.len() - 1
        });
        hypotheses.push(Hypothesis { law, late });
    }
    let begins = laws.iter().map(|&law| guess(agreement, law)).collect();
    let stride = standstill::stride(agreement.recordings.iter().map(|cut| cut.extent.n_rows).sum());
    agreement.question = Question::Laws { thresholds, laws, begins, hypotheses, stride };
}

fn ask_travels(agreement: &mut AgreementArtifact, checked: &crate::identify::Checked, thresholds: Thresholds) {
    let (_, finest_m) = checked.thresholds();
    agreement.question = Question::Travels {
        thresholds,
        plays_m: turning_plays_m(thresholds, finest_m),
        first: turning_rows(agreement.recordings.len()),
    };
}

/// Writes down which samples no fit may count, and the rates.
fn exclude(agreement: &mut AgreementArtifact, summaries: &[SummaryArtifact], order: &[Vec<usize>], found: &Found) {
    for ((cut, answers), order) in agreement.recordings.iter_mut().zip(&found.answers).zip(order) {
        let Some(quality) = &mut cut.quality else { continue };
        let (mut leaping, mut windows): ([Vec<usize>; 3], Vec<usize>) = Default::default();
        let mut fastest = Rates { length_m_per_s: 0.0, pressure_pa_per_s: 0.0 };
        for answer in answers {
            if let Answer::Excluded { spikes, shaken, rates, .. } = answer {
                leaping.iter_mut().zip(spikes).for_each(|(all, some)| all.extend(some));
                windows.extend(shaken);
                fastest.length_m_per_s = fastest.length_m_per_s.max(rates.length_m_per_s);
                fastest.pressure_pa_per_s = fastest.pressure_pa_per_s.max(rates.pressure_pa_per_s);
            }
        }
        (quality.length_rate_m_per_s, quality.pressure_rate_pa_per_s) =
            (fastest.length_m_per_s, fastest.pressure_pa_per_s);
        let mut excluded: Vec<[usize; 2]> = Vec::new();
        // Places that share a chunk find the same there.
        for rows in &mut leaping {
            rows.sort_unstable();
            rows.dedup();
            if !spikes::are_many(rows.len(), quality.n_rows) {
                excluded.extend(rows.iter().map(|&row| [row, row + 1]));
            }
        }
        windows.sort_unstable();
        windows.dedup();
        excluded.extend(shaken::in_a_row(&windows, quality).into_iter().map(|rows| [rows.start, rows.end]));
        for &place in order {
            if let Answer::Excluded { beyond, .. } = &summaries[place].answer {
                excluded.extend(beyond);
            }
        }
        excluded.sort_unstable();
        cut.excluded = excluded;
    }
}

/// What each of `n` hypotheses leaves of all recordings.
fn merged(found: &Found, n: usize) -> Result<Vec<Summary>, ShardError> {
    let mut totals: Vec<Option<Summary>> = vec![None; n];
    for answers in &found.answers {
        let mut of_recording: Vec<Option<Summary>> = vec![None; n];
        for answer in answers {
            let (Answer::Laws { triangles, .. } | Answer::Travels { triangles }) = answer else { continue };
            // A place that has none of the rows that are looked at has nothing to say.
            for (total, triangle) in of_recording.iter_mut().zip(triangles) {
                add(total, triangle)?;
            }
        }
        for (total, part) in totals.iter_mut().zip(of_recording) {
            if let Some(part) = part {
                add(total, &triangle(&part))?;
            }
        }
    }
    let none = || ShardError::Lacks { path: "a summary".to_owned(), pass: 0 };
    totals.into_iter().map(|total| total.ok_or_else(none)).collect()
}

fn add(total: &mut Option<Summary>, part: &Triangle) -> Result<(), ShardError> {
    let part = summary(part).ok_or_else(|| ShardError::Lacks { path: "a summary".to_owned(), pass: 0 })?;
    match total {
        None => *total = Some(part),
        Some(total) => total.merge(&part),
    }
    Ok(())
}

fn mean_square(total: &Summary) -> f64 {
    total.residual_floor_square_sum() / total.n_rows().max(1) as f64
}

/// The stretches of every recording, each from the place where it ends.
fn stretches(found: &Found) -> Vec<Vec<StretchPart>> {
    let of_recording = |answers: &Vec<Answer>| {
        let parts = answers.iter().filter_map(|answer| match answer {
            Answer::Condensed { parts, .. } => Some(parts),
            _ => None,
        });
        parts.flatten().cloned().collect()
    };
    found.answers.iter().map(of_recording).collect()
}

fn tallied(answers: &[Answer]) -> (Tally, [f64; 2]) {
    let (mut tally, mut floor) = (Tally::default(), [0.0; 2]);
    for answer in answers {
        let Answer::Tallied { sums, .. } = answer else { continue };
        let TallySums { noise_floor, .. } = sums;
        tally.merge(&Tally::of_sums(sums));
        floor = [floor[0] + noise_floor[0], floor[1] + noise_floor[1]];
    }
    (tally, floor)
}
