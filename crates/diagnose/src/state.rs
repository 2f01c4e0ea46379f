//! A hypothesis fitted to the track.

use pam_core::effects::Role;
use pam_core::force::ForceModel;
use pam_core::force::columns::ForceColumns;
use pam_core::muscle::Muscle;
use pam_identification::search_space::SearchSpace;

use crate::hypothesis::{Guess, ranges};
use crate::joint::{HeldOut, Joint, JointFit};
use crate::normal::Normal;
use crate::sheet::{Ground, Sheet};
use crate::track::Track;

/// Rounds in which the samples that slack cuts off and the fit settle with one another, at most.
const CUT_ROUNDS: usize = 8;

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
}

/// A hypothesis with its joint fit.
#[derive(Debug, Clone)]
pub struct State {
    /// Effects with their shapes.
    pub guesses: Vec<Guess>,
    /// Moments and columns.
    pub sheet: Sheet,
    /// Normal equations.
    pub normal: Normal,
    /// Base and amplitudes.
    pub fit: JointFit,
    /// Eq. 11 with the parameters of the fit.
    pub model: ForceModel,
    /// Which instants count, those that slack cuts off included.
    pub cut: Vec<bool>,
}

impl<'a> Setting<'a> {
    /// The same over fewer instants, to find shapes with.
    pub fn sampled(&self) -> Self {
        Self { only: Some(&self.track.sampled), ..*self }
    }

    /// Instants that count.
    fn counted(&self) -> &[bool] {
        self.only.unwrap_or(&self.track.counted)
    }

    fn ground(&self) -> Ground<'_> {
        Ground { track: self.track, columns: self.columns, only: self.only }
    }

    fn joint<'b>(&'b self, ranges: &'b [(f64, f64)]) -> Joint<'b> {
        Joint { columns: self.columns, space: self.space, ranges }
    }

    fn model(&self, fit: &JointFit) -> ForceModel {
        ForceModel::new(self.muscle, self.strand_modulus_pa, self.columns.form(), fit.parameters)
    }

    /// Fits `guesses` and the base; `near` is where the search starts and `model` what effects take of the base. None where
    /// the rows do not determine a fit.
    pub fn fit(&self, guesses: Vec<Guess>, near: &[f64], model: &ForceModel) -> Option<State> {
        self.fit_from(guesses, near, model, None)
    }

    /// Fits `guesses` and the base, starting from `state`.
    pub fn fit_near(&self, guesses: Vec<Guess>, state: &State) -> Option<State> {
        let was_cut = state.guesses.iter().any(|guess| guess.effect.role() == Role::Reads);
        let near = &state.fit.x[..self.space.free.len()];
        self.fit_from(guesses, near, &state.model, was_cut.then_some(&state.cut))
    }

    /// Fits `state` without its effect `index`.
    pub fn fit_without(&self, state: &State, index: usize) -> Option<State> {
        let mut others = state.guesses.clone();
        others.remove(index);
        self.fit_near(others, state)
    }

    fn fit_from(
        &self,
        guesses: Vec<Guess>,
        near: &[f64],
        model: &ForceModel,
        was_cut: Option<&Vec<bool>>,
    ) -> Option<State> {
        let sheet = self.ground().sheet(&guesses, model);
        let limits = ranges(&guesses);
        let force_n: Vec<f64> = self.track.instants.iter().map(|instant| instant.force_n).collect();
        let reads = guesses.iter().find(|guess| guess.effect.role() == Role::Reads);
        let mut cut = vec![false; self.track.n()];
        let mut reference = self.columns.weights(model.parameters()).to_vec();
        reference.resize(sheet.width, 0.0);
        if let (Some(_), Some(was_cut)) = (reads, was_cut) {
            cut.clone_from(was_cut);
        } else if let Some(reads) = reads {
            // Where the load cell stands near what it reads of a slack muscle.
            let highest_n = force_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let mut memory = reads.effect.start(self.muscle, &reads.shape);
            let floor_n = memory.reads(f64::NEG_INFINITY);
            let near_n = floor_n + 0.02 * (highest_n - floor_n);
            for (cut, force_n) in cut.iter_mut().zip(&force_n) {
                *cut = *force_n < near_n;
            }
        }
        let mut start = near.to_vec();
        for _ in 0..CUT_ROUNDS {
            let (columns, forces);
            let (rows, measured) = match reads {
                None => (&sheet.columns, &force_n),
                Some(reads) => {
                    (columns, forces) = self.cut_off(&sheet, &force_n, &cut, reads);
                    (&columns, &forces)
                }
            };
            let normal = Normal::new(self.track, rows, sheet.width, measured, self.counted(), reference.clone());
            let rows = normal.extend(self.track, &[], 0);
            let fit = self.joint(&limits).fit_all(&rows, &start)?;
            let model = self.model(&fit);
            let settled = match reads {
                None => true,
                Some(reads) => {
                    let mut memory = reads.effect.start(self.muscle, &reads.shape);
                    let mut changed = 0;
                    for (at, cut) in cut.iter_mut().enumerate().filter(|(at, _)| self.counted()[*at]) {
                        let row = &sheet.columns[at * sheet.width..(at + 1) * sheet.width];
                        let force_n: f64 = row.iter().zip(&fit.weights).map(|(column, weight)| column * weight).sum();
                        let now = memory.cuts(force_n);
                        changed += usize::from(now != *cut);
                        let _ = memory.reads(force_n);
                        *cut = now;
                    }
                    changed * 2000 <= self.track.n()
                }
            };
            if settled {
                return Some(State { guesses, sheet, normal, fit, model, cut });
            }
            start.clone_from(&fit.x);
            reference.clone_from(&fit.weights);
        }
        // The last mask has not settled: fit once more under it.
        let reads = reads?;
        let (rows, measured) = self.cut_off(&sheet, &force_n, &cut, reads);
        let normal = Normal::new(self.track, &rows, sheet.width, &measured, self.counted(), reference);
        let fit = self.joint(&limits).fit_all(&normal.extend(self.track, &[], 0), &start)?;
        let model = self.model(&fit);
        Some(State { guesses, sheet, normal, fit, model, cut })
    }

    /// Rows and forces in which what slack cuts off has no slope: its residual is the force less the floor.
    fn cut_off(&self, sheet: &Sheet, force_n: &[f64], cut: &[bool], reads: &Guess) -> (Vec<f64>, Vec<f64>) {
        let floor_n = reads.effect.start(self.muscle, &reads.shape).reads(f64::NEG_INFINITY);
        let mut columns = sheet.columns.clone();
        let mut forces = force_n.to_vec();
        for (at, _) in cut.iter().enumerate().filter(|(_, cut)| **cut) {
            columns[at * sheet.width..(at + 1) * sheet.width].fill(0.0);
            forces[at] -= floor_n;
        }
        (columns, forces)
    }

    /// Fits of `state` that each leave one fold out.
    pub fn fold_fits(&self, state: &State) -> Option<Vec<JointFit>> {
        let limits = ranges(&state.guesses);
        let rows = state.normal.extend(self.track, &[], 0);
        self.joint(&limits).fold_fits(&rows, &state.fit.x, &self.track.fold_of_block)
    }

    /// Mean squares of `state` over held-out blocks.
    pub fn hold_out(&self, state: &State) -> Option<HeldOut> {
        let limits = ranges(&state.guesses);
        self.joint(&limits).hold_out(&state.normal.extend(self.track, &[], 0), &state.fit.x, &self.track.fold_of_block)
    }

    /// Joint fit of `state` and one more guess that only adds.
    pub fn fit_more(&self, state: &State, guess: &Guess) -> Option<JointFit> {
        let (rows, limits) = self.more(state, guess);
        self.joint(&limits).fit_all(&state.normal.extend(self.track, &rows, guess.amplitudes().len()), &state.fit.x)
    }

    /// Joint fit of `state` and one more guess that only adds, and its mean squares over held-out blocks.
    pub fn weigh_more(&self, state: &State, guess: &Guess) -> Option<(JointFit, HeldOut)> {
        let (rows, limits) = self.more(state, guess);
        let rows = state.normal.extend(self.track, &rows, guess.amplitudes().len());
        let joint = self.joint(&limits);
        let held_out = joint.hold_out(&rows, &state.fit.x, &self.track.fold_of_block)?;
        Some((joint.fit_all(&rows, &state.fit.x)?, held_out))
    }

    /// Columns of one more guess, zero where slack cuts off, and the ranges of all amplitudes.
    fn more(&self, state: &State, guess: &Guess) -> (Vec<f64>, Vec<(f64, f64)>) {
        let mut rows = self.ground().more_columns(&state.sheet, guess, &state.model);
        let k = guess.amplitudes().len();
        for (at, _) in state.cut.iter().enumerate().filter(|(_, cut)| **cut) {
            rows[at * k..(at + 1) * k].fill(0.0);
        }
        let mut limits = ranges(&state.guesses);
        limits.extend(guess.amplitudes().iter().map(|amplitude| amplitude.range));
        (rows, limits)
    }

    /// Residual of every instant, measured less modelled, in N.
    pub fn residuals_n(&self, state: &State) -> Vec<f64> {
        let width = state.sheet.width;
        let floor_n = state
            .guesses
            .iter()
            .find(|guess| guess.effect.role() == Role::Reads)
            .map(|guess| guess.effect.start(self.muscle, &guess.shape).reads(f64::NEG_INFINITY));
        self.track
            .instants
            .iter()
            .enumerate()
            .map(|(at, instant)| {
                if state.cut[at] {
                    return instant.force_n - floor_n.unwrap_or(0.0);
                }
                let row = &state.sheet.columns[at * width..(at + 1) * width];
                let model_n: f64 = row.iter().zip(&state.fit.weights).map(|(column, weight)| column * weight).sum();
                instant.force_n - model_n
            })
            .collect()
    }
}
