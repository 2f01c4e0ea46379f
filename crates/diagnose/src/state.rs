//! A hypothesis fitted to the track.

use std::ops::Range;

use pam_identification::search_space::SearchSpace;
use pam_muscle::Muscle;
use pam_muscle::effects::{Effect, Kind, Memory, Role, Term};
use pam_muscle::force::ForceModel;
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};

use crate::design_matrix::{DesignMatrix, Regressors, events, rows_of};
use crate::hypothesis::{CandidateEffect, n_amplitudes, ranges};
use crate::joint::{HeldOut, Joint, JointFit};
use crate::normal::{Extended, Normal};
use crate::nuisance::{self, Nuisance};
use crate::track::{FOLDS, Track};

/// Rounds in which what slack leaves of the force and the fit settle with one another, at most.
const READ_ROUNDS: usize = 8;
/// A smaller slope is none.
const LEAST_SLOPE: f64 = 1e-6;
/// A slope that changes by more has not settled.
const SLOPE_MOVED: f64 = 0.1;

/// How often what a recording does may have gone before it, at most.
const LONGEST_BEFORE: f64 = 10.0;

/// Range of what went before a recording, for the largest amplitude of `guess`.
fn before(guess: &CandidateEffect) -> (f64, f64) {
    let largest = guess.amplitudes().iter().map(|amplitude| amplitude.range.1).fold(0.0, f64::max);
    (-LONGEST_BEFORE * largest, LONGEST_BEFORE * largest)
}

/// What every fit of a diagnosis shares.
#[derive(Debug)]
pub struct Setting<'a> {
    /// The recordings.
    pub track: &'a Track,
    /// Columns of eq. 11.
    pub columns: &'a ForceColumns,
    /// Base parameters that move, and their ranges.
    pub space: &'a SearchSpace,
    /// Dimensions of the muscle.
    pub muscle: &'a Muscle,
    /// Modulus that the contact between strands is computed with, in Pa.
    pub strand_modulus_pa: f64,
    /// Instants that fits look at; none where all that count do.
    pub only: Option<&'a [bool]>,
    /// Whether blocks are kept apart, to be held out.
    pub apart: bool,
    /// What is always in beside base and effects.
    pub nuisance: &'a Nuisance,
    /// What the sensors leave, in N².
    pub floor_square: f64,
    /// Effects that may be named: those of the catalogue, and a user's own.
    pub effects: &'a [&'static dyn Effect],
}

/// `rows`, those that `state` was fitted to, with one of `columns` (over all instants) after the other behind each, as much of them as
/// the cell reads; all of an event, which has one column.
fn beside_rows(state: &State, rows: Vec<f64>, columns: &[Vec<f64>], is_event: bool) -> Vec<f64> {
    let listed = state.normal.listed();
    let width = rows.len() / listed.len().max(1);
    let joined = if columns.is_empty() {
        rows
    } else {
        let mut joined = Vec::with_capacity(rows.len() + listed.len() * columns.len());
        for (row, &at) in listed.iter().enumerate() {
            joined.extend_from_slice(&rows[row * width..(row + 1) * width]);
            joined.extend(columns.iter().map(|column| column[at]));
        }
        joined
    };
    state.read.scaled(joined, width + columns.len(), listed, if is_event { &[0] } else { &[] })
}

/// A hypothesis with its joint fit.
#[derive(Debug, Clone)]
pub struct State {
    /// Effects with their shapes.
    pub guesses: Vec<CandidateEffect>,
    /// Moments and columns.
    pub sheet: DesignMatrix,
    /// Normal equations.
    pub normal: Normal,
    /// Base and amplitudes.
    pub fit: JointFit,
    /// Eq. 11 with the parameters of the fit.
    pub model: ForceModel,
    /// What the load cell reads, linear around the fit.
    pub read: Read,
    /// What nuisances add at every instant, in N.
    pub nuisance_n: Vec<f64>,
}

impl State {
    /// The effects with their values, as a model evaluates them.
    pub fn terms(&self) -> Vec<Term> {
        let mut values = self.fit.amplitudes.iter();
        let term = |guess: &CandidateEffect| {
            let amplitudes = guess.amplitudes();
            let pairs = amplitudes.iter().zip(values.by_ref());
            let sizes = pairs.map(|(amplitude, value)| value.clamp(amplitude.range.0, amplitude.range.1)).collect();
            Term { past: guess.beginning.past(), ..Term::new(guess.effect, guess.shape.clone(), sizes) }
        };
        self.guesses.iter().map(term).collect()
    }

    /// Its effects and one more behind them.
    pub fn guesses_with(&self, guess: &CandidateEffect) -> Vec<CandidateEffect> {
        self.guesses.iter().chain([guess]).cloned().collect()
    }

    /// Whether the muscle may hang slack in it.
    pub fn hangs_slack(&self) -> bool {
        self.guesses.iter().any(|guess| guess.effect.role() == Role::Reads)
    }
}

/// What the load cell reads of a force `F` at every instant: `slope F + offset_n`.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// In [0, 1].
    pub slopes: Vec<f64>,
    offsets_n: Vec<f64>,
}

impl Read {
    /// A cell that reads what there is.
    fn plain(n: usize) -> Self {
        Self { slopes: vec![1.0; n], offsets_n: vec![0.0; n] }
    }

    /// A first guess: what stands near what the cell reads of a slack muscle is slack.
    fn near_floor(memory: &mut dyn Memory, force_n: &[f64]) -> Self {
        let highest_n = force_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let floor_n = memory.reads(f64::NEG_INFINITY);
        let near_n = floor_n + 0.02 * (highest_n - floor_n);
        let is_slack = |force_n: &f64| *force_n < near_n;
        Self {
            slopes: force_n.iter().map(|force_n| if is_slack(force_n) { 0.0 } else { 1.0 }).collect(),
            offsets_n: force_n.iter().map(|force_n| if is_slack(force_n) { floor_n } else { 0.0 }).collect(),
        }
    }

    /// Linear around `forces_n`, those that a fit gives the instants `listed`; the number of those whose slope changes by more
    /// than a little.
    fn move_to(&mut self, memory: &mut dyn Memory, listed: &[usize], forces_n: impl Iterator<Item = f64>) -> usize {
        let mut moved = 0;
        for (&at, force_n) in listed.iter().zip(forces_n) {
            let slope = memory.slope(force_n);
            // What hardly shows is nothing: rows next to zero are none that a decomposition can be made of.
            let slope = if slope > LEAST_SLOPE { slope } else { 0.0 };
            moved += usize::from((slope - self.slopes[at]).abs() > SLOPE_MOVED);
            self.slopes[at] = slope;
            self.offsets_n[at] = memory.reads(force_n) - slope * force_n;
        }
        moved
    }

    /// As much of `rows`, `width` columns for each of the instants `listed`, as the cell reads; all of the columns `unread`, which
    /// come on top of what it reads.
    fn scaled(&self, mut rows: Vec<f64>, width: usize, listed: &[usize], unread: &[usize]) -> Vec<f64> {
        for (row, &at) in rows.chunks_exact_mut(width.max(1)).zip(listed) {
            let slope = self.slopes[at];
            if slope != 1.0 {
                let read = row.iter_mut().enumerate().filter(|(index, _)| !unread.contains(index));
                read.for_each(|(_, column)| *column *= slope);
            }
        }
        rows
    }
}

/// Rows that a fit looks at.
struct Rows {
    /// Their instants.
    listed: Vec<usize>,
    /// Those of each block.
    blocks: Vec<Range<usize>>,
    /// Columns of eq. 11 and of the effects, row-major.
    columns: Vec<f64>,
    width: usize,
    /// Columns of events, which come on top of what the cell reads.
    events: Vec<usize>,
}

impl<'a> Setting<'a> {
    /// The same over fewer instants, to find shapes with: no block of theirs is held out.
    pub fn sampled(&self) -> Self {
        Self { apart: false, ..self.sampled_in_blocks() }
    }

    /// The same over fewer instants.
    pub fn sampled_in_blocks(&self) -> Self {
        Self { only: Some(&self.track.sampled), ..*self }
    }

    /// The same beside other nuisances.
    pub fn beside<'b>(&'b self, nuisance: &'b Nuisance) -> Setting<'b> {
        Setting { nuisance, ..*self }
    }

    /// Instants that count.
    fn counted(&self) -> &[bool] {
        self.only.unwrap_or(&self.track.counted)
    }

    pub(crate) fn ground(&self) -> Regressors<'_> {
        Regressors { track: self.track, columns: self.columns, only: self.only, slopes: true }
    }

    fn joint<'b>(&'b self, ranges: &'b [(f64, f64)]) -> Joint<'b> {
        Joint { columns: self.columns, space: self.space, ranges, floor_square: self.floor_square }
    }

    fn model(&self, fit: &JointFit) -> ForceModel {
        ForceModel::new(self.muscle, self.strand_modulus_pa, self.columns.form(), fit.parameters)
    }

    /// Fits `guesses` and the base; `near` is where the search starts and `model` what effects take of the base. None where
    /// the rows do not determine a fit.
    pub fn fit(&self, guesses: Vec<CandidateEffect>, near: &[f64], model: &ForceModel) -> Option<State> {
        self.fit_from(guesses, near, model, None)
    }

    /// Fits `guesses` and the base, starting from `state`.
    pub fn fit_near(&self, guesses: Vec<CandidateEffect>, state: &State) -> Option<State> {
        let near = &state.fit.x[..self.space.free.len()];
        self.fit_from(guesses, near, &state.model, state.hangs_slack().then_some(&state.read))
    }

    /// Fits `state` without its effect `index`.
    pub fn fit_without(&self, state: &State, index: usize) -> Option<State> {
        let mut others = state.guesses.clone();
        others.remove(index);
        self.fit_near(others, state)
    }

    /// Terms of `guesses` with their sizes beside `base` as it is, and no nuisances; none where the rows do not determine them.
    pub(crate) fn terms_beside(&self, guesses: &[CandidateEffect], base: &ForceModel) -> Option<Vec<Term>> {
        let space = self.space.clone();
        let held = SearchSpace { free: Vec::new(), ranges: Vec::new(), held: *base.parameters(), ..space };
        let fixed = Setting { space: &held, nuisance: &nuisance::NONE, ..*self };
        Some(fixed.fit(guesses.to_vec(), &[], base)?.terms())
    }

    fn fit_from(
        &self,
        guesses: Vec<CandidateEffect>,
        near: &[f64],
        model: &ForceModel,
        was: Option<&Read>,
    ) -> Option<State> {
        let sheet = self.ground().sheet(&guesses, model);
        let (listed, blocks) = self.listed();
        let width = sheet.width;
        let columns = rows_of(&sheet.columns, width, &listed);
        let rows = Rows { columns, listed, blocks, width, events: sheet.events.clone() };
        let (normal, fit, read) = self.settled(&guesses, rows, near, model, was)?;
        let model = self.model(&fit);
        let nuisance_n = self.nuisance.force_n(&fit.nuisances, self.track.n());
        Some(State { guesses, sheet, normal, fit, model, read, nuisance_n })
    }

    /// Mean square of the fit of `guesses` and the base, starting from `state`.
    pub fn left_near(&self, guesses: &[CandidateEffect], state: &State) -> Option<f64> {
        let (listed, blocks) = self.listed();
        let ground = Regressors { slopes: false, ..self.ground() };
        let columns = ground.columns_at(guesses, &state.model, &listed);
        let width = N_COLUMNS + n_amplitudes(guesses);
        let rows = Rows { listed, blocks, columns, width, events: events(guesses) };
        let near = &state.fit.x[..self.space.free.len()];
        let was = state.hangs_slack().then_some(&state.read);
        Some(self.settled(guesses, rows, near, &state.model, was)?.1.mean_square)
    }

    /// Instants that count, and those of each block that is kept apart.
    fn listed(&self) -> (Vec<usize>, Vec<Range<usize>>) {
        let counted = self.counted();
        let all = 0..self.track.n();
        let mut listed: Vec<usize> = Vec::new();
        let blocks = if self.apart { &self.track.blocks } else { std::slice::from_ref(&all) };
        let ranges = blocks.iter().map(|block| {
            let first = listed.len();
            listed.extend(block.clone().filter(|&at| counted[at]));
            first..listed.len()
        });
        let ranges = ranges.collect();
        (listed, ranges)
    }

    /// The fit of `rows`, with its normal equations and what the load cell reads: that has to settle where the muscle may hang slack.
    fn settled(
        &self,
        guesses: &[CandidateEffect],
        rows: Rows,
        near: &[f64],
        model: &ForceModel,
        was: Option<&Read>,
    ) -> Option<(Normal, JointFit, Read)> {
        let Rows { listed, blocks, columns, width, events } = rows;
        let limits = ranges(guesses);
        let measured_n = |at: usize| self.track.instants[at].force_n;
        let reads = guesses.iter().find(|guess| guess.effect.role() == Role::Reads);
        let Some(mut memory) = reads.map(|guess| guess.effect.start(self.muscle, &guess.shape)) else {
            let read = Read::plain(self.track.n());
            let forces_n: Vec<f64> = listed.iter().map(|&at| measured_n(at)).collect();
            let reference = self.reference(model, width);
            let normal = Normal::new(listed, blocks, &columns, &forces_n, reference, self.nuisance, &read.slopes);
            let fit = self.joint(&limits).fit_all(&normal.alone(), near)?;
            return Some((normal, fit, read));
        };
        let mut read = match was {
            Some(was) => was.clone(),
            None => {
                let forces_n: Vec<f64> = self.track.instants.iter().map(|instant| instant.force_n).collect();
                Read::near_floor(&mut *memory, &forces_n)
            }
        };
        let mut reference = self.reference(model, width);
        let mut start = near.to_vec();
        let mut rounds_left = READ_ROUNDS;
        loop {
            let seen = read.scaled(columns.clone(), width, &listed, &events);
            let forces_n: Vec<f64> = listed.iter().map(|&at| measured_n(at) - read.offsets_n[at]).collect();
            let (own, blocks) = (listed.clone(), blocks.clone());
            let normal = Normal::new(own, blocks, &seen, &forces_n, reference.clone(), self.nuisance, &read.slopes);
            let fit = self.joint(&limits).fit_all(&normal.alone(), &start)?;
            // The last readings have not settled: this fit is under them.
            if rounds_left == 0 {
                return Some((normal, fit, read));
            }
            let forces_n = columns.chunks_exact(width).zip(&listed).map(|(row, &at)| {
                let is_event = |column: &usize| events.contains(column);
                let pulls = row.iter().zip(&fit.weights).enumerate().filter(|(column, _)| !is_event(column));
                let force_n: f64 = pulls.map(|(_, (column, weight))| column * weight).sum();
                force_n + self.nuisance.force_at_n(at, &fit.nuisances)
            });
            if read.move_to(&mut *memory, &listed, forces_n) * 2000 <= self.track.n() {
                return Some((normal, fit, read));
            }
            start.clone_from(&fit.x);
            reference.clone_from(&fit.weights);
            rounds_left -= 1;
        }
    }

    /// Weights that residuals are taken from before a fit: those of `model`, effects at zero.
    fn reference(&self, model: &ForceModel, width: usize) -> Vec<f64> {
        let mut reference = self.columns.weights(model.parameters()).to_vec();
        reference.resize(width, 0.0);
        reference
    }

    /// Fits of `state` that each leave one fold out.
    pub fn fold_fits(&self, state: &State) -> Option<Vec<JointFit>> {
        let limits = ranges(&state.guesses);
        let rows = state.normal.alone();
        self.joint(&limits).fold_fits(&rows, &state.fit.x, &self.track.fold_of_block)
    }

    /// Mean squares of `state` over held-out blocks.
    pub fn hold_out(&self, state: &State) -> Option<HeldOut> {
        let limits = ranges(&state.guesses);
        self.joint(&limits).hold_out(&state.normal.alone(), &state.fit.x, &self.track.fold_of_block)
    }

    /// What is left of the recording that `state`, fitted to the others, foretells worst, root mean square in N; nothing where there
    /// is only one. Of many recordings a few are left out together.
    pub fn worst_foretold_n(&self, state: &State) -> f64 {
        if self.track.recordings.len() < 2 {
            return 0.0;
        }
        let fold_of_block: Vec<usize> =
            self.track.recording_of_block.iter().map(|recording| recording % FOLDS).collect();
        let limits = ranges(&state.guesses);
        let held_out = self.joint(&limits).hold_out(&state.normal.alone(), &state.fit.x, &fold_of_block);
        let Some(HeldOut { blocks, counts, .. }) = held_out else { return 0.0 };
        let of_recording = |recording: usize| {
            let own = (0..blocks.len()).filter(|&block| self.track.recording_of_block[block] == recording);
            let (squares, n) =
                own.fold((0.0, 0.0), |(squares, n), at| (squares + blocks[at] * counts[at], n + counts[at]));
            f64::sqrt(squares / f64::max(n, 1.0))
        };
        (0..self.track.recordings.len()).map(of_recording).fold(0.0, f64::max)
    }

    /// Joint fit of `state` and one more guess that only adds.
    pub fn fit_more(&self, state: &State, guess: &CandidateEffect) -> Option<JointFit> {
        let (rows, limits) = self.more(state, guess);
        self.joint(&limits).fit_all(&rows, &state.fit.x)
    }

    /// Joint fit of `state` and one more guess that only adds, and its mean squares over held-out blocks.
    pub fn weigh_more(&self, state: &State, guess: &CandidateEffect) -> Option<(JointFit, HeldOut)> {
        let (rows, limits) = self.more(state, guess);
        let joint = self.joint(&limits);
        let held_out = joint.hold_out(&rows, &state.fit.x, &self.track.fold_of_block)?;
        Some((joint.fit_all(&rows, &state.fit.x)?, held_out))
    }

    /// Mean squares of `state` over held-out blocks with what `guess` leaves of what went before every recording, but without
    /// the guess itself.
    pub fn weigh_beginnings(&self, state: &State, guess: &CandidateEffect) -> Option<HeldOut> {
        let beginnings = self.beginnings(state, guess);
        let mut limits = ranges(&state.guesses);
        limits.extend(beginnings.iter().map(|_| before(guess)));
        let rows = beside_rows(state, Vec::new(), &beginnings, false);
        let rows = state.normal.extend(&rows, beginnings.len(), 0);
        self.joint(&limits).hold_out(&rows, &state.fit.x, &self.track.fold_of_block)
    }

    /// `state` with the columns of one more guess, as much of them as the cell reads, and the ranges of all amplitudes; where it is
    /// carried, what it begins with in every recording stands behind them.
    fn more<'b>(&self, state: &'b State, guess: &CandidateEffect) -> (Extended<'b>, Vec<(f64, f64)>) {
        let rows = self.ground().more_columns(&state.sheet, guess, &state.model, state.normal.listed());
        let mut limits = ranges(&state.guesses);
        limits.extend(guess.ranges());
        let beginnings = if guess.has_own_beginnings() { self.beginnings(state, guess) } else { Vec::new() };
        limits.extend(beginnings.iter().map(|_| before(guess)));
        let firm = guess.amplitudes().len();
        let rows = beside_rows(state, rows, &beginnings, guess.effect.kind() == Kind::Event);
        (state.normal.extend(&rows, firm + beginnings.len(), firm), limits)
    }

    /// What `guess` leaves in every recording of what went before it: a column for each recording and amplitude, in which
    /// what went before was the same recording.
    pub(crate) fn beginnings(&self, state: &State, guess: &CandidateEffect) -> Vec<Vec<f64>> {
        self.ground().beginnings(&state.sheet, guess, &state.model)
    }

    /// `nuisance` with what `guess` leaves in every recording of what went before it.
    pub(crate) fn begun(&self, nuisance: &Nuisance, state: &State, guess: &CandidateEffect) -> Nuisance {
        nuisance.with_beginnings(self.beginnings(state, guess), &self.track.counted)
    }

    /// Residual of every instant, measured less modelled, in N.
    pub fn residuals_n(&self, state: &State) -> Vec<f64> {
        let read = &state.read;
        self.track
            .instants
            .iter()
            .enumerate()
            .map(|(at, instant)| {
                let events_n = state.sheet.events_n(at, &state.fit.weights);
                let model_n = state.sheet.force_n(at, &state.fit.weights) - events_n + state.nuisance_n[at];
                instant.force_n - read.slopes[at] * model_n - read.offsets_n[at] - events_n
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::rehearsal::tests::Given;

    #[test]
    fn what_a_fit_leaves_is_the_same_with_and_without_its_state() {
        let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        given.disturb();
        assert!(given.track.counted.iter().any(|counted| !counted));
        let whole = given.setting();
        let state = whole.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        for setting in [given.setting(), given.setting().sampled(), given.setting().sampled_in_blocks()] {
            for guess in [given.guess("pressure-lag", &[0.2, 0.0]), given.guess("slack", &[0.0, 0.0])] {
                let guesses = vec![guess];
                let left = setting.left_near(&guesses, &state).expect("a fit");
                let fitted = setting.fit_near(guesses, &state).expect("a fit").fit.mean_square;
                assert!((left / fitted - 1.0).abs() < 1e-9, "{left} {fitted}");
            }
        }
        // In blocks or not, the instants are the same.
        let [one, other] = [whole.sampled(), whole.sampled_in_blocks()]
            .map(|setting| setting.fit(Vec::new(), &given.start, &given.model).expect("a fit").fit.mean_square);
        assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    }

    #[test]
    fn a_recording_that_differs_from_the_others_is_foretold_worst_and_a_single_one_is_not_foretold() {
        let worst_n = |given: &Given| {
            let state = given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit");
            given.setting().worst_foretold_n(&state)
        };
        let protocols = ["isobaric-triangles", "isometric-ramps", "multisine"];
        let alike = Given::of(&protocols, &[]);
        let mut other = Given::of(&protocols, &[]);
        let last = other.track.recordings.last().expect("recordings").clone();
        other.track.instants[last].iter_mut().for_each(|instant| instant.force_n += 20.0);
        assert!(worst_n(&alike) < 0.5 && worst_n(&other) > 5.0, "{} {}", worst_n(&alike), worst_n(&other));
        assert!(worst_n(&Given::of(&protocols[..1], &[])).abs() < 1.0);
    }
}
