//! The error of a whole model along held-out recordings, and what it says of a term: with it and without it.

use pam_identification::prepare::Prepared;
use pam_identification::trace::trace_augmented;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::AugmentedModel;
use rayon::prelude::*;

use crate::track::Track;

/// Share of the error (mean square over all instants) of held-out recordings that a term must take away to be written.
const LEAST_GAIN: f64 = 0.05;
/// Times what is left without something beyond which held-out recordings are followed worse with it: more than rounding.
pub(crate) const WORSE: f64 = 1.01;
/// Times the error, root mean square, to which it may raise that of one held-out recording.
const MOST_HARM: f64 = 1.05;
/// Pieces that a recording is cut into, which stand for independent ones.
const PIECES: usize = 8;
/// Standard errors that a sure gain lies beyond zero. What acts in a few places gains in a few pieces alone: at 1.5, terms that leave
/// half of the error were lost.
const SURELY: f64 = 1.0;

/// Root mean squares of what a model leaves of held-out recordings, in N.
#[derive(Debug, Clone)]
pub(crate) struct Left {
    /// Of every recording, with the number of its instants.
    each: Vec<(f64, f64)>,
    /// Sum of squares over every piece of the recordings, in N².
    pieces: Vec<f64>,
    /// The same over the counted instants of the piece.
    counted: Vec<f64>,
    /// Number of the counted instants of all.
    n_counted: usize,
}

impl Left {
    /// Of `model`, without what happened once.
    pub(crate) fn of(model: &AugmentedModel, held: &Track) -> Self {
        let modelled_n = held.modelled_n(&model.elsewhere());
        let missed_n = |at: usize| (held.instants[at].force_n - modelled_n[at], held.counted[at]);
        let is_recorded = |at: &usize| held.instants[*at].force_n.is_finite();
        Self::of_each(held.recordings.iter().map(|range| range.clone().filter(is_recorded).map(missed_n).collect()))
    }

    /// The same at the rate of the recordings, as programs evaluate it: what counts turns or adds up travel sees more of both there.
    /// None where the model has no force for one of them.
    pub(crate) fn at_full_rate(model: &AugmentedModel, held: &[Prepared], direction: Thresholds) -> Option<Self> {
        let model = model.elsewhere();
        let missed_n = |(index, prepared): (usize, &Prepared)| {
            let mut prepared = prepared.clone();
            prepared.begin_with(&model, direction, index).ok()?;
            let trace = trace_augmented(&prepared, &model, direction, index).ok()?;
            let samples = trace.force_n.iter().zip(&trace.model_n).zip(&trace.settled);
            let recorded = samples.filter(|((force_n, _), _)| force_n.is_finite());
            Some(recorded.map(|((force_n, model_n), &settled)| (force_n - model_n, settled)).collect())
        };
        let each: Option<Vec<Vec<(f64, bool)>>> = held.par_iter().enumerate().map(missed_n).collect();
        Some(Self::of_each(each?.into_iter()))
    }

    /// Of a model that has no force for what was held out.
    pub(crate) fn endless() -> Self {
        Self { each: vec![(f64::INFINITY, 1.0)], pieces: Vec::new(), counted: Vec::new(), n_counted: 0 }
    }

    /// Of what is missed of every recording, in N, and whether that counts.
    pub(crate) fn of_each(recordings: impl Iterator<Item = Vec<(f64, bool)>>) -> Self {
        let mut left = Self { each: Vec::new(), pieces: Vec::new(), counted: Vec::new(), n_counted: 0 };
        let sum = |missed_n: &[(f64, bool)]| missed_n.iter().map(|missed| missed.0.powi(2)).sum::<f64>();
        for missed_n in recordings {
            let n = missed_n.len() as f64;
            left.each.push((f64::sqrt(sum(&missed_n) / n.max(1.0)), n));
            left.n_counted += missed_n.iter().filter(|missed| missed.1).count();
            for piece in missed_n.chunks(missed_n.len().div_ceil(PIECES).max(1)) {
                left.pieces.push(sum(piece));
                left.counted.push(piece.iter().filter(|missed| missed.1).map(|missed| missed.0.powi(2)).sum());
            }
        }
        left
    }

    /// Over all instants, in N.
    pub(crate) fn together_n(&self) -> f64 {
        let (squares, count) = self
            .each
            .iter()
            .fold((0.0, 0.0), |(squares, count), (left_n, n)| (squares + left_n * left_n * n, count + n));
        f64::sqrt(squares / f64::max(count, 1.0))
    }

    /// Mean squares, in N²: over all instants, and over the counted ones.
    pub(crate) fn mean_squares(&self) -> [f64; 2] {
        [self.together_n().powi(2), self.counted.iter().sum::<f64>() / self.n_counted.max(1) as f64]
    }

    /// Whether it is more than `base` leaves, by more than rounding.
    pub(crate) fn is_worse_than(&self, base: &Self) -> bool {
        self.together_n() > WORSE * base.together_n()
    }

    /// Whether the held-out recordings confirm what leaves `with` of them.
    pub(crate) fn is_bettered_by(&self, with: &Self) -> bool {
        !self.is_harmed_by(with) && with.together_n().powi(2) < (1.0 - LEAST_GAIN) * self.together_n().powi(2)
    }

    /// Whether `with` leaves more of one recording than may be.
    fn is_harmed_by(&self, with: &Self) -> bool {
        self.each.iter().zip(&with.each).any(|(before, after)| after.0 > MOST_HARM * before.0)
    }

    /// Whether they confirm it and that is no chance: the gain lies beyond its standard error over pieces of the recordings. What is
    /// left beside turns may hide the gain of a term that is right; then that of the counted instants is as good, as long as nothing
    /// is lost over all.
    pub(crate) fn is_surely_bettered_by(&self, with: &Self) -> bool {
        !self.is_harmed_by(with)
            && with.together_n() <= self.together_n()
            && (is_sure_gain(&self.pieces, &with.pieces) || is_sure_gain(&self.counted, &with.counted))
    }
}

/// Whether the sums of squares of pieces become less by more than [`LEAST_GAIN`], and by [`SURELY`] standard errors.
fn is_sure_gain(before: &[f64], after: &[f64]) -> bool {
    let gains: Vec<f64> = before.iter().zip(after).map(|(before, after)| before - after).collect();
    let n = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / n;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
    n * mean > LEAST_GAIN * before.iter().sum::<f64>() && mean > SURELY * (variance / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_on_one_recording_is_no_license_to_harm_another() {
        let left = |each: [f64; 2]| Left::of_each(each.into_iter().map(|left_n| vec![(left_n, true); 100]));
        assert!(left([4.0, 1.0]).is_bettered_by(&left([2.0, 1.0])));
        assert!(!left([4.0, 1.0]).is_bettered_by(&left([2.0, 1.2])));
        assert!(!left([4.0, 1.0]).is_bettered_by(&left([3.95, 1.0])));
        assert!((left([3.0, 4.0]).together_n() - 12.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn mean_squares_are_over_all_instants_and_over_those_that_count() {
        let left = Left::of_each([vec![(3.0, true), (5.0, false)], vec![(1.0, true), (1.0, false)]].into_iter());
        let [all, counted] = left.mean_squares();
        assert!((all - 9.0).abs() < 1e-12 && (counted - 5.0).abs() < 1e-12, "{all} {counted}");
    }

    #[test]
    fn what_leaves_more_than_rounding_more_is_worse() {
        let left = |left_n: f64| Left::of_each(std::iter::once(vec![(left_n, true); 80]));
        let base = left(10.0);
        assert!(
            left(10.2).is_worse_than(&base) && !left(10.05).is_worse_than(&base) && !left(9.8).is_worse_than(&base)
        );
    }

    #[test]
    fn a_gain_here_and_a_loss_there_is_chance_and_a_gain_in_every_piece_is_not() {
        let left =
            |each: [f64; 2]| Left::of_each(std::iter::once((0..80).map(|at| (each[at / 10 % 2], true)).collect()));
        let before = left([1.0, 1.0]);
        assert!(before.is_surely_bettered_by(&left([0.9, 0.8])));
        assert!(before.is_bettered_by(&left([0.3, 1.3])) && !before.is_surely_bettered_by(&left([0.3, 1.3])));
        // What is left of a few places where nearly everything was missed.
        assert!(left([0.1, 5.0]).is_surely_bettered_by(&left([0.1, 1.0])));
        assert!(!before.is_surely_bettered_by(&Left::endless()) && !Left::endless().is_surely_bettered_by(&before));
    }

    #[test]
    fn what_counts_may_gain_alone_as_long_as_nothing_is_lost_over_all() {
        // Of a hundred samples twenty are beside turns.
        let left = |counted_n: f64, turning_n: f64| {
            let sample = |at| if at % 5 == 0 { (turning_n, false) } else { (counted_n, true) };
            Left::of_each(std::iter::once((0..100).map(sample).collect()))
        };
        assert!(left(1.0, 9.0).is_surely_bettered_by(&left(0.5, 9.0)));
        assert!(!left(1.0, 9.0).is_bettered_by(&left(0.5, 9.0)));
        assert!(!left(1.0, 9.0).is_surely_bettered_by(&left(0.5, 9.3)));
        assert!(!left(1.0, 9.0).is_surely_bettered_by(&left(1.0, 9.0)));
    }
}
