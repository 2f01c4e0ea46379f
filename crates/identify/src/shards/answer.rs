//! What a place finds in its rows, for a question.

use std::io;
use std::ops::Range;

use pam_artifact::agreement::{AgreementArtifact, CutRecording, Hypothesis, Question};
use pam_artifact::summary::{Answer, Ends, Open, Rows, StretchPart, Triangle};
use pam_muscle::MuscleFile;
use pam_muscle::direction::{Carried, Direction, Standstill, Thresholds};
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_muscle::force::{BaseParameters, ForceModel, Form};
use pam_optim::gathered::Gathered;
use pam_recording::quality::parts::sampled_chunks;
use pam_recording::quality::stuck::StuckRuns;
use pam_recording::quality::{RecordingQuality, SensorEnds};
use pam_recording::{CHUNK_ROWS, Recording};
use rayon::prelude::*;

use super::error::ShardError;
use super::parts::{edges, parts};
use super::tile::{Tile, rows_of};
use super::triangle::{summary, triangle};
use crate::condense::{fold_rows, plan};
use crate::error::IdentifyError;
use crate::evaluate::{floor_stride, noise_squares, tally};
use crate::faults::{shaken, spikes};
use crate::prepare::Prepared;
use crate::standstill::{Counts, changes_pa, condensed, turning_laws};

/// What all places know.
pub(super) struct Shared<'a> {
    pub(super) agreement: &'a AgreementArtifact,
    pub(super) muscle: &'a MuscleFile,
    pub(super) columns: ForceColumns,
}

impl<'a> Shared<'a> {
    pub(super) fn of(agreement: &'a AgreementArtifact, muscle: &'a MuscleFile) -> Self {
        let (modulus_pa, largest_n_per_m) = (muscle.strand_modulus_pa, agreement.largest_pressure_length_n_per_m);
        let columns = ForceColumns::new(&muscle.muscle, modulus_pa, Form::Corrected, largest_n_per_m);
        Self { agreement, muscle, columns }
    }
}

/// Rows to hand over, and the answer of shard `shard` of recording `index` of the agreement, whose rows are those of `recording`,
/// to its question.
///
/// # Errors
/// [`ShardError::Identify`] where samples cannot be read back.
pub fn answer(
    agreement: &AgreementArtifact,
    muscle: &MuscleFile,
    (index, shard): (usize, usize),
    recording: &Recording,
) -> Result<(Vec<Rows>, Answer), ShardError> {
    let unreadable = |reason: io::Error| IdentifyError::Samples { path: recording.path.clone(), reason };
    let cut = &agreement.recordings[index];
    let [start, end] = cut.rows[shard];
    let handed: io::Result<Vec<Rows>> =
        edges(cut, shard).into_iter().map(|rows| rows_of(&recording.samples, start, rows)).collect();
    let handed = handed.map_err(unreadable)?;
    if matches!(agreement.question, Question::Sample {}) {
        return Ok((handed, sampled(cut, start..end, recording).map_err(unreadable)?));
    }
    let shared = Shared::of(agreement, muscle);
    let mut found = match parts(cut).into_iter().find(|part| part.shard == Some(shard)) {
        None => nothing(&agreement.question),
        Some(part) => {
            let samples =
                recording.samples.slice(part.held.start - start..part.held.end - start).map_err(unreadable)?;
            let tile = Tile::of(cut, &part, samples);
            let open = match &agreement.question {
                Question::Condense { open, .. } => open[index][shard].as_ref(),
                _ => None,
            };
            answer_of(&tile, &shared, index, &begins_of(&agreement.question, index, shard), open)?
        }
    };
    // What its gauge says of a sensor's range the shard alone knows.
    if let (Answer::Excluded { beyond, .. }, Some(quality)) = (&mut found, &cut.quality) {
        let qualities = agreement.recordings.iter().filter_map(|cut| cut.quality.as_ref());
        let reached = SensorEnds::of(qualities).reached_from(start, recording, quality).map_err(unreadable)?;
        *beyond = reached.into_iter().map(|rows| [rows.start, rows.end]).collect();
    }
    Ok((handed, found))
}

/// What a shard begins with, for every law or hypothesis of a question.
fn begins_of(question: &Question, index: usize, shard: usize) -> Vec<Carried> {
    match question {
        Question::Sample {} | Question::Travels { .. } => Vec::new(),
        Question::Exclude { laws, .. } => vec![Carried::UNKNOWN; laws.len()],
        Question::Laws { begins, .. } => begins.iter().map(|begins| begins.carried[index][shard]).collect(),
        Question::Condense { begins, .. } | Question::Tally { begins, .. } => vec![begins.carried[index][shard]],
    }
}

/// The answer of a shard that has no rows of its own to count.
fn nothing(question: &Question) -> Answer {
    use pam_artifact::summary::TallySums;
    use pam_recording::quality::recording::Rates;
    match question {
        Question::Sample {} => Answer::Extent {},
        Question::Exclude { .. } => Answer::Excluded {
            spikes: Default::default(),
            shaken: Vec::new(),
            beyond: Vec::new(),
            rates: Rates { length_m_per_s: 0.0, pressure_pa_per_s: 0.0 },
            ends: Vec::new(),
        },
        Question::Laws { .. } => Answer::Laws { triangles: Vec::new(), ends: Vec::new() },
        Question::Travels { .. } => Answer::Travels { triangles: Vec::new() },
        Question::Condense { .. } => Answer::Condensed { parts: Vec::new(), open: None, ends: Ends::UNKNOWN },
        Question::Tally { .. } => Answer::Tallied { sums: TallySums::default(), ends: Ends::UNKNOWN },
    }
}

/// Samples that noise and ranges are judged by, of `rows` of a recording.
fn sampled(cut: &CutRecording, rows: Range<usize>, recording: &Recording) -> io::Result<Answer> {
    let n_rows = cut.extent.n_rows;
    let mut sampled = Vec::new();
    for chunk in sampled_chunks(n_rows) {
        let here = rows.start.max(chunk * CHUNK_ROWS)..rows.end.min((chunk + 1) * CHUNK_ROWS);
        if here.start < here.end {
            sampled.push(rows_of(&recording.samples, rows.start, here)?);
        }
    }
    let stride = spikes::spread_stride(n_rows);
    let mut spread: [Vec<f64>; 3] = Default::default();
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        for here in 0..chunk.n_rows() {
            if ((rows.start + chunk.first_row() + here) % CHUNK_ROWS).is_multiple_of(stride) {
                spread.iter_mut().zip(spikes::values(&chunk, here)).for_each(|(spread, value)| spread.push(value));
            }
        }
    }
    Ok(Answer::Sampled { sampled, spread, stuck: StuckRuns::of(recording, &cut.extent)? })
}

/// What `tile` of recording `index` answers, where it begins with `begins` and in a stretch that is `open`.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub(super) fn answer_of(
    tile: &Tile<'_>,
    shared: &Shared<'_>,
    index: usize,
    begins: &[Carried],
    open: Option<&Open>,
) -> Result<Answer, IdentifyError> {
    let unreadable = |reason: io::Error| IdentifyError::Samples { path: tile.cut.name.clone(), reason };
    let Some(quality) = tile.quality() else { return Ok(nothing(&shared.agreement.question)) };
    match &shared.agreement.question {
        question @ Question::Sample {} => Ok(nothing(question)),
        Question::Exclude { thresholds, leaps_by, laws } => {
            excluded(tile, quality, *thresholds, &leaps_by[index], laws, begins).map_err(unreadable)
        }
        Question::Laws { thresholds, laws, begins: assumed, hypotheses, stride } => {
            let at_rest: Vec<bool> = assumed.iter().map(|assumed| assumed.at_rest[index]).collect();
            let beginning: Vec<(Carried, bool)> = begins.iter().copied().zip(at_rest).collect();
            judged(tile, quality, shared, *thresholds, laws, &beginning, hypotheses, *stride)
        }
        Question::Travels { thresholds, plays_m, first } => {
            turning(tile, quality, shared, *thresholds, plays_m, *first).map_err(unreadable)
        }
        Question::Condense { thresholds, begins: assumed, .. } => {
            let (direction, ends) =
                tile.direction(*thresholds, begins[0], assumed.at_rest[index]).map_err(unreadable)?;
            let prepared = tile.prepared(quality, direction);
            let (parts, open) = stretches(tile, &prepared, shared, index, open).map_err(unreadable)?;
            Ok(Answer::Condensed { parts, open, ends })
        }
        Question::Tally { thresholds, begins: assumed, theta } => {
            let (direction, ends) =
                tile.direction(*thresholds, begins[0], assumed.at_rest[index]).map_err(unreadable)?;
            let mut prepared = tile.prepared(quality, direction);
            let parameters = BaseParameters { theta: *theta };
            let muscle = shared.muscle;
            let model = ForceModel::new(&muscle.muscle, muscle.strand_modulus_pa, Form::Corrected, parameters);
            prepared.begin(&model, thresholds.standstill)?;
            let sums = tally(&prepared, &model, tile.owned.clone()).map_err(unreadable)?;
            let stride = floor_stride(tile.cut.extent.n_rows);
            let floor = noise_squares(&prepared, &model, stride, tile.strided(stride))?;
            Ok(Answer::Tallied { sums: sums.sums(floor), ends })
        }
    }
}

/// The stretches of recording `index` that end in `tile`, and the one that goes on after it; the first one may be `open`.
fn stretches(
    tile: &Tile<'_>,
    prepared: &Prepared,
    shared: &Shared<'_>,
    index: usize,
    open: Option<&Open>,
) -> io::Result<(Vec<StretchPart>, Option<Open>)> {
    let n_rows: Vec<usize> = shared.agreement.recordings.iter().map(|cut| cut.extent.n_rows).collect();
    let owned = tile.first_row + tile.owned.start..tile.first_row + tile.owned.end;
    let of_recording = plan(&n_rows).into_iter().filter(|(recording, _)| *recording == index).enumerate();
    let here = of_recording.map(|(stretch, (_, rows))| (stretch, rows));
    let here: Vec<(usize, Range<usize>)> =
        here.filter(|(_, rows)| rows.start < owned.end && owned.start < rows.end).collect();
    let folded: io::Result<Vec<Gathered>> = here
        .par_iter()
        .map(|(_, rows)| {
            let begun = open.filter(|_| rows.start < owned.start);
            let begun = begun.and_then(|open| Some(Gathered::after(summary(&open.triangle)?, &open.waiting)));
            let mut gathered = begun.unwrap_or_else(|| Gathered::new(N_COLUMNS));
            let within = rows.start.max(owned.start) - tile.first_row..rows.end.min(owned.end) - tile.first_row;
            fold_rows(&mut gathered, prepared, within, &shared.columns, 1, None)?;
            Ok(gathered)
        })
        .collect();
    let (mut parts, mut goes_on) = (Vec::new(), None);
    for ((stretch, rows), gathered) in here.into_iter().zip(folded?) {
        if rows.end <= owned.end {
            parts.push(StretchPart { stretch, triangle: triangle(&gathered.summary()) });
        } else {
            let (folded, waiting) = gathered.open();
            goes_on = Some(Open { triangle: triangle(folded), waiting });
        }
    }
    Ok((parts, goes_on))
}

/// Samples that no fit may count, rates, and where every law ends.
fn excluded(
    tile: &Tile<'_>,
    quality: &RecordingQuality,
    thresholds: Thresholds,
    leaps_by: &[Option<f64>; 3],
    laws: &[Standstill],
    begins: &[Carried],
) -> io::Result<Answer> {
    let mut spikes: [Vec<usize>; 3] = Default::default();
    for chunk in tile.recording.samples.chunks() {
        let chunk = chunk?;
        let first_row = tile.first_row + chunk.first_row();
        for (spikes, rows) in spikes.iter_mut().zip(spikes::leaping(&chunk, leaps_by)) {
            spikes.extend(rows.into_iter().map(|row| first_row + row));
        }
    }
    let windows = shaken::windows(&tile.recording, quality)?;
    let ends: io::Result<Vec<Ends>> = laws
        .par_iter()
        .zip(begins)
        .map(|(&standstill, &begin)| Ok(tile.direction(Thresholds { standstill, ..thresholds }, begin, false)?.1))
        .collect();
    Ok(Answer::Excluded {
        spikes,
        shaken: windows.into_iter().map(|start| tile.first_row + start).collect(),
        beyond: Vec::new(),
        rates: quality.fastest(&tile.recording)?,
        ends: ends?,
    })
}

/// Where the direction ends under a law, and what its hypotheses leave, each with its index.
type OfLaw = (Ends, Vec<(usize, Triangle)>);

/// What hypotheses of friction at standstill leave.
#[expect(clippy::too_many_arguments, reason = "all of them are parts of one question")]
fn judged(
    tile: &Tile<'_>,
    quality: &RecordingQuality,
    shared: &Shared<'_>,
    thresholds: Thresholds,
    laws: &[Standstill],
    begins: &[(Carried, bool)],
    hypotheses: &[Hypothesis],
    stride: usize,
) -> Result<Answer, IdentifyError> {
    let unreadable = |reason: io::Error| IdentifyError::Samples { path: tile.cut.name.clone(), reason };
    let direction = |law: usize| {
        let (begin, at_rest) = begins[law];
        tile.direction(Thresholds { standstill: laws[law], ..thresholds }, begin, at_rest)
    };
    let prepared = tile.prepared(quality, direction(0).map_err(unreadable)?.0);
    let late = if hypotheses.iter().any(|hypothesis| hypothesis.late) { changes_pa(&prepared)? } else { Vec::new() };
    // One direction after the other, as each is as long as the recording.
    let found: io::Result<Vec<OfLaw>> = (0..laws.len())
        .into_par_iter()
        .map(|law| {
            let (direction, ends) = direction(law)?;
            let of_law = hypotheses.iter().enumerate().filter(|(_, hypothesis)| hypothesis.law == law);
            let triangles = of_law.map(|(index, hypothesis)| {
                let change_pa = hypothesis.late.then_some(late.as_slice());
                let counts = Counts::Settled(stride);
                let rows = tile.strided(stride);
                Ok((index, triangle(&condensed(&prepared, rows, &shared.columns, &direction, counts, change_pa)?)))
            });
            Ok((ends, triangles.collect::<io::Result<Vec<(usize, Triangle)>>>()?))
        })
        .collect();
    let (ends, triangles): (Vec<Ends>, Vec<Vec<(usize, Triangle)>>) = found.map_err(unreadable)?.into_iter().unzip();
    let mut triangles = triangles.concat();
    triangles.sort_by_key(|(index, _)| *index);
    Ok(Answer::Laws { triangles: triangles.into_iter().map(|(_, triangle)| triangle).collect(), ends })
}

/// What travels of turning leave in the first rows of a recording.
fn turning(
    tile: &Tile<'_>,
    quality: &RecordingQuality,
    shared: &Shared<'_>,
    thresholds: Thresholds,
    plays_m: &[f64],
    first: usize,
) -> io::Result<Answer> {
    let until = first.min(tile.cut.extent.n_rows).saturating_sub(tile.first_row).min(tile.owned.end);
    let mut triangles = Vec::new();
    if until <= tile.owned.start {
        return Ok(Answer::Travels { triangles });
    }
    let mut excluded = Direction::nothing(tile.recording.samples.n_rows());
    tile.leave_out(&mut excluded);
    let prepared = tile.prepared(quality, excluded);
    for &length_m in plays_m {
        let found =
            tile.directions(Thresholds { length_m, ..thresholds }, Carried::UNKNOWN, &turning_laws(thresholds), until)?;
        let of_laws: io::Result<Vec<Triangle>> = found
            .par_iter()
            .map(|(direction, _)| {
                let rows = tile.owned.start..until;
                let counts = Counts::First(first);
                Ok(triangle(&condensed(&prepared, rows, &shared.columns, direction, counts, None)?))
            })
            .collect();
        triangles.extend(of_laws?);
    }
    Ok(Answer::Travels { triangles })
}
