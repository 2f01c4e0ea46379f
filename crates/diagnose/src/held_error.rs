//! The error of a whole model along held-out recordings, and what it says of a term: with it and without it.

use pam_core::effects::AugmentedModel;

use crate::track::Track;
use crate::veto::force_n;

/// Share of the error (mean square over all instants) of held-out recordings that a term must take away to be written.
const LEAST_GAIN: f64 = 0.05;
/// Times the error, root mean square, to which it may raise that of one held-out recording.
const MOST_HARM: f64 = 1.05;

/// Root mean squares of what a model leaves of held-out recordings, in N.
#[derive(Debug, Clone)]
pub(crate) struct Left {
    /// Of every recording, with the number of its instants.
    each: Vec<(f64, f64)>,
}

impl Left {
    /// Of `model`, without what happened once.
    pub(crate) fn of(model: &AugmentedModel, held: &Track) -> Self {
        let modelled_n = force_n(held, &model.elsewhere());
        let each = held.recordings.iter().map(|range| {
            let (mut squares, mut count) = (0.0, 0.0);
            for at in range.clone().filter(|&at| held.instants[at].force_n.is_finite()) {
                squares += (held.instants[at].force_n - modelled_n[at]).powi(2);
                count += 1.0;
            }
            (f64::sqrt(squares / f64::max(count, 1.0)), count)
        });
        Self { each: each.collect() }
    }

    /// Over all instants, in N.
    pub(crate) fn together_n(&self) -> f64 {
        let (squares, count) = self
            .each
            .iter()
            .fold((0.0, 0.0), |(squares, count), (left_n, n)| (squares + left_n * left_n * n, count + n));
        f64::sqrt(squares / f64::max(count, 1.0))
    }

    /// Whether the held-out recordings confirm what leaves `with` of them.
    pub(crate) fn is_bettered_by(&self, with: &Self) -> bool {
        let harmed = self.each.iter().zip(&with.each).any(|(before, after)| after.0 > MOST_HARM * before.0);
        !harmed && with.together_n().powi(2) < (1.0 - LEAST_GAIN) * self.together_n().powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_on_one_recording_is_no_license_to_harm_another() {
        let left = |each: [f64; 2]| Left { each: each.map(|left_n| (left_n, 100.0)).to_vec() };
        assert!(left([4.0, 1.0]).is_bettered_by(&left([2.0, 1.0])));
        assert!(!left([4.0, 1.0]).is_bettered_by(&left([2.0, 1.2])));
        assert!(!left([4.0, 1.0]).is_bettered_by(&left([3.95, 1.0])));
        assert!((left([3.0, 4.0]).together_n() - 12.5_f64.sqrt()).abs() < 1e-12);
    }
}
