//! Recordings on the grid that a diagnosis works on.
//!
//! Channels are smooth and thinned to [`PERIOD_S`], which keeps what a muscle does and leaves out most of the white
//! noise. Every recording is cut into blocks of consecutive instants: what is fitted on some blocks is judged on others.

use std::ops::Range;

use pam_identification::error::IdentifyError;
use pam_identification::prepare::Prepared;
use pam_muscle::direction::{Direction, Thresholds};
use pam_muscle::effects::{AugmentedModel, Moment, Seen};
use pam_muscle::force::ForceModel;
use pam_muscle::motion::{Channels, Instant, walk};
use pam_muscle::shift::shifted;
use rayon::prelude::*;

use crate::mass::MovingMass;

/// Time between instants, in s, as long as there are fewer than [`MOST_INSTANTS`].
const PERIOD_S: f64 = 0.02;
/// Instants of all recordings together, at most; longer recordings are thinned further.
const MOST_INSTANTS: usize = 60_000;
/// Blocks that the recordings together are cut into, about.
const BLOCKS: usize = 32;

/// Instants that a search for the best shape looks at, at least, where there are as many.
const LEAST_SAMPLED: usize = 3000;
/// It looks at one instant in so many, at most.
const MOST_SPARSE: usize = 20;

/// Groups of blocks that are held out in turn.
pub const FOLDS: usize = 8;

/// The instants of all recordings, one after the other.
#[derive(Debug, Clone, Default)]
pub struct Track {
    /// The instants.
    pub instants: Vec<Instant>,
    /// Instants of each recording.
    pub recordings: Vec<Range<usize>>,
    /// Instants of each block; a block lies within one recording.
    pub blocks: Vec<Range<usize>>,
    /// Recording of each block.
    pub recording_of_block: Vec<usize>,
    /// Fold of each block: those that are held out together.
    pub fold_of_block: Vec<usize>,
    /// Whether an instant counts: its direction is settled and its values are finite.
    pub counted: Vec<bool>,
    /// Those of them that a search for the best shape looks at.
    pub sampled: Vec<bool>,
    /// Other forms of effects that are known and taken off, in N at every instant.
    pub known_forms_n: Vec<Vec<f64>>,
}

impl Track {
    /// The grid of `recordings`.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn of(recordings: &[Prepared], thresholds: Thresholds, base: &ForceModel) -> Result<Self, IdentifyError> {
        let n_rows: usize = recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).sum();
        let thinned = n_rows.div_ceil(MOST_INSTANTS);
        let walked: Result<Vec<Vec<Instant>>, IdentifyError> = recordings
            .par_iter()
            .enumerate()
            .map(|(index, prepared)| {
                let stride = ((PERIOD_S / prepared.quality.period_s).round() as usize).max(thinned).max(1);
                let mut instants = Vec::new();
                walk(
                    &prepared.recording,
                    &prepared.direction,
                    thresholds,
                    base,
                    index,
                    prepared.recording.samples.n_rows(),
                    stride,
                    Channels::Smooth,
                    &mut |instant| instants.push(instant),
                )
                .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
                Ok(instants)
            })
            .collect();
        let walked = walked?;
        let n: usize = walked.iter().map(Vec::len).sum();
        let per_block = (n / BLOCKS).max(1);
        let mut track = Self { instants: Vec::with_capacity(n), ..Self::default() };
        // What was recorded decides which blocks go together, not the order or the names of the files.
        let mut by_content: Vec<usize> = (0..recordings.len()).collect();
        by_content.sort_by_key(|&index| &recordings[index].recording.sha256);
        for (index, instants) in walked.into_iter().enumerate() {
            let rank = by_content.iter().position(|&other| other == index).unwrap_or(index);
            let first = track.instants.len();
            let rows = instants.len();
            let pieces = ((rows as f64 / per_block as f64).round() as usize).clamp(2, rows.max(2));
            for piece in 0..pieces {
                track.blocks.push(first + piece * rows / pieces..first + (piece + 1) * rows / pieces);
                track.recording_of_block.push(index);
                // Another part of each recording, so that no fold takes the same part of every protocol away.
                track.fold_of_block.push((piece + 3 * rank) % FOLDS);
            }
            track.recordings.push(first..first + rows);
            track.instants.extend(instants);
        }
        let counts = |instant: &Instant| {
            instant.settled && instant.force_n.is_finite() && instant.moment.pressure_pa.is_finite()
        };
        track.counted = track.instants.iter().map(counts).collect();
        track.sample();
        Ok(track)
    }

    /// Force that `model` predicts at every instant, in N, with what it carries from recording to recording.
    pub(crate) fn modelled_n(&self, model: &AugmentedModel) -> Vec<f64> {
        let delays_s = model.delays_s();
        let mut forces_n = Vec::with_capacity(self.n());
        for (recording, range) in self.recordings.iter().enumerate() {
            let instants = &self.instants[range.clone()];
            let moments: Vec<Moment> = if delays_s == [0.0; 2] {
                instants.iter().map(|instant| instant.moment).collect()
            } else {
                shifted(instants, delays_s)
            };
            let mut memory = model.start_in(recording);
            forces_n.extend(moments.into_iter().map(|moment| memory.force_n(model, moment)));
        }
        forces_n
    }

    /// What `model` leaves of the counted instants: mean square, in N².
    pub(crate) fn left_square(&self, model: &AugmentedModel) -> f64 {
        let modelled_n = self.modelled_n(model);
        let missed = self.instants.iter().zip(modelled_n).zip(&self.counted).filter(|(_, counted)| **counted);
        let square: f64 = missed.map(|((instant, modelled_n), _)| (instant.force_n - modelled_n).powi(2)).sum();
        square / self.n_counted().max(1) as f64
    }

    /// The same instants with other `directions` of their recordings.
    #[must_use]
    pub fn redirected(&self, directions: &[Direction]) -> Self {
        let mut other = self.clone();
        for (range, direction) in self.recordings.iter().zip(directions) {
            for (instant, counted) in other.instants[range.clone()].iter_mut().zip(&mut other.counted[range.clone()]) {
                instant.moment.direction = direction.sign(instant.row);
                instant.settled = direction.is_settled(instant.row);
                *counted = instant.settled && instant.force_n.is_finite() && instant.moment.pressure_pa.is_finite();
            }
        }
        other.sample();
        other
    }

    /// Thins out what counts.
    pub(crate) fn sample(&mut self) {
        let stride = (self.n_counted() / LEAST_SAMPLED).clamp(1, MOST_SPARSE);
        self.sampled = self.counted.clone();
        for range in &self.recordings {
            for at in range.clone().filter(|at| (at - range.start) % stride != 0) {
                self.sampled[at] = false;
            }
        }
    }

    /// The same without the pull of `mass`; where it knocks, nothing counts.
    #[must_use]
    pub fn without(mut self, mass: &MovingMass) -> Self {
        for range in &self.recordings {
            let mut mount = mass.mount();
            for instant in &mut self.instants[range.clone()] {
                let behind = mount.follow(instant.moment.acceleration_m_per_s2, instant.moment.step_s);
                instant.force_n += mass.mass_kg() * behind;
            }
        }
        for (recording, rows) in mass.touched() {
            let range = self.recordings[*recording].clone();
            let within = &self.instants[range.clone()];
            let first = within.partition_point(|instant| instant.row < rows.start);
            let last = within.partition_point(|instant| instant.row < rows.end);
            self.counted[range.start + first..range.start + last].fill(false);
        }
        self.sample();
        self
    }

    /// Instants.
    pub fn n(&self) -> usize {
        self.instants.len()
    }

    /// What the instants that count have been through.
    pub(crate) fn seen(&self) -> Seen {
        Seen::of(self.instants.iter().zip(&self.counted).filter(|(_, counted)| **counted).map(|(at, _)| at))
    }

    /// Instants that count.
    pub fn n_counted(&self) -> usize {
        self.counted.iter().filter(|&&counted| counted).count()
    }
}
