//! A model along recordings: one walk over each says how well it agrees, and leaves samples for figures and for what looks at a residual.

use pam_muscle::direction::Thresholds;
use pam_muscle::effects::AugmentedModel;
use pam_muscle::motion::Instant;
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::evaluate::{Evaluation, evaluate, tally_augmented};
use crate::prepare::Prepared;
use crate::trace::{Trace, trace, trace_stride};

/// What a model says along recordings.
#[derive(Debug, Clone)]
pub struct Along {
    /// How well it agrees, over every row.
    pub evaluation: Evaluation,
    /// Rows of each recording with the modelled force in N, thinned out evenly to those of its trace. The step in time of the first one
    /// behind a gap is zero.
    pub samples: Vec<Vec<(Instant, f64)>>,
}

impl Along {
    /// Of `model` along `recordings`, each numbered by its place among them; `thresholds` are those of the direction.
    ///
    /// # Errors
    /// As [`evaluate`].
    pub fn of(recordings: &[Prepared], model: &AugmentedModel, thresholds: Thresholds) -> Result<Self, IdentifyError> {
        let walked = |(index, prepared): (usize, &Prepared)| {
            let stride = trace_stride(prepared);
            let mut samples = Vec::with_capacity(prepared.recording.samples.n_rows().div_ceil(stride));
            let mut thinning = Thinning::to_every(stride);
            let tally = tally_augmented(prepared, model, thresholds, index, &mut |instant, model_n| {
                samples.extend(thinning.kept(instant.row, instant).map(|instant| (instant, model_n)));
            })?;
            Ok((tally, samples))
        };
        let walked: Result<Vec<_>, IdentifyError> = recordings.par_iter().enumerate().map(walked).collect();
        let (tallies, samples): (Vec<_>, Vec<_>) = walked?.into_iter().unzip();
        let evaluation = if model.is_plain() { evaluate(recordings, model.base())? } else { Evaluation::of(&tallies) };
        Ok(Self { evaluation, samples })
    }

    /// At most `most` samples of each recording, thinned out as they are.
    pub fn thinned(&self, most: usize) -> Vec<Vec<(Instant, f64)>> {
        let of_one = |samples: &Vec<(Instant, f64)>| {
            let mut thinning = Thinning::to_every(samples.len().div_ceil(most.max(1)).max(1));
            let kept =
                |(at, (instant, model_n)): (usize, &(Instant, f64))| Some((thinning.kept(at, instant)?, *model_n));
            samples.iter().enumerate().filter_map(kept).collect()
        };
        self.samples.iter().map(of_one).collect()
    }

    /// The samples as traces of the `recordings` that they are of.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn traces(&self, recordings: &[Prepared], model: &AugmentedModel) -> Result<Vec<Trace>, IdentifyError> {
        let each = recordings.iter().zip(&self.samples);
        each.map(|(prepared, samples)| {
            let model_n = samples.iter().map(|(_, model_n)| *model_n).collect();
            Ok(Trace { model_n, ..trace(prepared, model.base())? })
        })
        .collect()
    }

    /// What is left of the samples of each recording, in N; zero where they are not counted.
    pub fn residuals_n(&self) -> Vec<Vec<f64>> {
        let left_n =
            |(instant, model_n): &(Instant, f64)| if instant.settled { instant.force_n - model_n } else { 0.0 };
        self.samples.iter().map(|samples| samples.iter().map(left_n).collect()).collect()
    }
}

/// Keeps rows evenly. The first behind a gap need not be one of them; the next that is says so in its place.
struct Thinning {
    stride: usize,
    gap: bool,
}

impl Thinning {
    fn to_every(stride: usize) -> Self {
        Self { stride, gap: false }
    }

    /// `instant`, number `at` in its recording, where it is kept.
    fn kept(&mut self, at: usize, instant: &Instant) -> Option<Instant> {
        self.gap |= instant.moment.step_s == 0.0;
        at.is_multiple_of(self.stride).then(|| {
            let mut instant = *instant;
            if std::mem::take(&mut self.gap) {
                instant.moment.step_s = 0.0;
            }
            instant
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::effects::{Term, effect};

    use crate::evaluate::evaluate_augmented;
    use crate::prepare::tests::{HELD, moving};
    use crate::testing::model;
    use crate::trace::trace_augmented;

    /// A muscle that shortens for so many rows, every tenth of a second, with a gap before row `gap`.
    fn shortening(n_rows: usize, gap: usize) -> Prepared {
        let rows = || (0..n_rows).map(|row| row as f64 / n_rows as f64);
        let time_s: Vec<f64> = (0..n_rows).map(|row| 0.001 * row as f64 + if row < gap { 0.0 } else { 9.0 }).collect();
        let length_m: Vec<f64> = rows().map(|part| 0.26 - 0.03 * part).collect();
        let force_n: Vec<f64> = rows().map(|part| 300.0 - 200.0 * part).collect();
        let mut prepared = moving(&time_s, &vec![2e5; n_rows], &length_m, &force_n);
        prepared.recording.segments = vec![0..gap, gap..n_rows];
        prepared
    }

    #[test]
    fn one_walk_says_what_an_evaluation_and_a_trace_say() {
        let recordings = [shortening(90_001, 30_001), shortening(500, 250)];
        let stiff = Term::new(effect("threshold-pressure").unwrap(), vec![3e4], vec![]);
        for model in [AugmentedModel::new(model(), vec![stiff]), AugmentedModel::from(model())] {
            let along = Along::of(&recordings, &model, HELD).unwrap();
            assert_eq!(along.evaluation.together, evaluate_augmented(&recordings, &model, HELD).unwrap().together);
            let traces = along.traces(&recordings, &model).unwrap();
            for (index, prepared) in recordings.iter().enumerate() {
                let trace = trace_augmented(prepared, &model, HELD, index).unwrap();
                assert_eq!((&traces[index].model_n, &traces[index].time_s), (&trace.model_n, &trace.time_s));
                assert_eq!(along.residuals_n()[index].len(), trace.time_s.len());
                let begins = along.samples[index].iter().filter(|(instant, _)| instant.moment.step_s == 0.0);
                assert_eq!(begins.count(), 2, "of the recording and behind the gap");
                let thinned = &along.thinned(70)[index];
                let begins = thinned.iter().filter(|(instant, _)| instant.moment.step_s == 0.0);
                assert_eq!((begins.count(), thinned.len() <= 70), (2, true));
            }
        }
    }
}
