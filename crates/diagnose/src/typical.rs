//! What a model typically leaves of recordings, whatever is missed by far in a few stretches.
//!
//! A root mean square is mostly what is left beside turns and where a sensor is in doubt, in a healthy muscle as well: of 49 that were
//! looked at all but four were typically followed to within twice the noise, and of 21 mismatches that had been called consistent
//! twelve were not. A load cell that is tared before each recording says nothing of the muscle.

use pam_identification::error::IdentifyError;
use pam_identification::evaluate::noise_floor_n;
use pam_identification::prepare::Prepared;
use pam_identification::trace::Trace;
use pam_muscle::force::ForceModel;

use crate::coverage::Coverage;
use crate::nuisance::TARE_N;
use crate::turns;

/// Times the sensors' noise that is typically left of recordings, at most, of which nothing is missing: as much again as the noise
/// itself.
pub(crate) const FOLLOWED_WITHIN: f64 = 2.0;

/// Times the noise that may be left over all samples, where more than [`FOLLOWED_WITHIN`] is left of those that count, of the fitted
/// recordings or of the held-out ones. Of 212 looked-at healthy muscles that were `consistent` none leaves more of both, of 68 with
/// something concealed ten do, nine of them nameless; of 60 fresh healthy ones two do.
const ALL_WITHIN: f64 = 2.5;

/// Share of the largest force by which the tare of a load cell may differ from recording to recording. Of twenty healthy muscles of a
/// stranger's bench, fourteen of which have a tare of their own in each recording, of up to 0.5 % of the range and six times the noise,
/// six were not `consistent` with none; of eight of another one, whose tares are up to 1.5 % of it, two with half of this. None of 46
/// looked-at mismatches without a name is `consistent` by it.
const TARE_SHARE: f64 = 0.01;

/// What a model typically leaves, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Typical {
    /// Of what was fitted.
    pub(crate) fitted_n: f64,
    /// Of what was held out.
    pub(crate) held_n: f64,
    /// What the sensors leave of either.
    pub(crate) sensors_n: (f64, f64),
}

impl Typical {
    /// What `model` leaves of recordings that were fitted and of held-out ones where these have been, each with its traces.
    ///
    /// # Errors
    /// [`IdentifyError`] where samples cannot be read back.
    pub(crate) fn of(
        model: &ForceModel,
        (estimation, fitted): (&[Prepared], &[Trace]),
        (holdout, held): (&[Prepared], &[Trace]),
    ) -> Result<Self, IdentifyError> {
        let coverage = Coverage::of(fitted);
        let within: Vec<Trace> = held.iter().map(|trace| coverage.within(trace)).collect();
        Self::of_all(model, (estimation, fitted), (holdout, &within))
    }

    /// The same of held-out recordings wherever they have been.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub(crate) fn of_all(
        model: &ForceModel,
        (estimation, fitted): (&[Prepared], &[Trace]),
        (holdout, held): (&[Prepared], &[Trace]),
    ) -> Result<Self, IdentifyError> {
        let floor_n = |recordings: &[Prepared]| {
            if recordings.is_empty() { Ok(0.0) } else { noise_floor_n(recordings, model) }
        };
        Ok(Self {
            fitted_n: left_beside_tares_n(fitted),
            held_n: left_beside_tares_n(held),
            sensors_n: (floor_n(estimation)?, floor_n(holdout)?),
        })
    }

    /// Whether more is left of either than noise accounts for, and than `matters_n` beyond that, where the user said what matters.
    pub(crate) fn is_missed(&self, matters_n: Option<f64>) -> bool {
        self.fitted_is_missed(matters_n) || self.held_is_missed(matters_n)
    }

    /// The same of what was held out alone.
    pub(crate) fn held_is_missed(&self, matters_n: Option<f64>) -> bool {
        self.held_n > most_n(self.sensors_n.1, matters_n)
    }

    /// The same of what was fitted alone.
    pub(crate) fn fitted_is_missed(&self, matters_n: Option<f64>) -> bool {
        self.fitted_n > most_n(self.sensors_n.0, matters_n)
    }

    /// Whether neither the `fitted` recordings nor the `held` ones are followed, stretches that are missed by far included, a tare of each
    /// beside. Of a muscle that lacks nothing one of them is: turns at which the direction is in doubt spoil one alone.
    pub(crate) fn neither_is_followed(&self, fitted: &Tares, held: &Tares) -> bool {
        let is_missed = |of: &Tares, sensors_n: f64| {
            of.beside_n > FOLLOWED_WITHIN * sensors_n && of.beside_all_n > ALL_WITHIN * sensors_n
        };
        is_missed(fitted, self.sensors_n.0) && is_missed(held, self.sensors_n.1)
    }
}

/// What may typically be left where the sensors leave `sensors_n`, in N.
fn most_n(sensors_n: f64, matters_n: Option<f64>) -> f64 {
    matters_n.map_or(FOLLOWED_WITHIN * sensors_n, |limit_n| sensors_n.hypot(limit_n))
}

/// Tares of a load cell, one in each of some recordings, and what is left beside them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tares {
    /// The largest, in N.
    pub(crate) largest_n: f64,
    /// Root mean square of what is left of the counted samples, in N.
    pub(crate) left_n: f64,
    /// The same beside the tares.
    pub(crate) beside_n: f64,
    /// And of all samples.
    beside_all_n: f64,
}

impl Tares {
    /// Of what models leave of `traces`.
    pub(crate) fn of(traces: &[Trace]) -> Self {
        let (mut largest_n, mut n_counted, mut n) = (0.0_f64, 0_usize, 0_usize);
        let [mut left, mut beside, mut beside_all] = [0.0; 3];
        for trace in traces {
            let tare_n = tare_n(trace);
            largest_n = largest_n.max(tare_n.abs());
            for ((force_n, model_n), settled) in trace.force_n.iter().zip(&trace.model_n).zip(&trace.settled) {
                let left_n = force_n - model_n;
                let square = (left_n - tare_n).powi(2);
                (beside_all, n) = (beside_all + square, n + 1);
                if *settled {
                    (left, beside, n_counted) = (left + left_n * left_n, beside + square, n_counted + 1);
                }
            }
        }
        let rmse_n = |square: f64, n: usize| (square / n.max(1) as f64).sqrt();
        Self {
            largest_n,
            left_n: rmse_n(left, n_counted),
            beside_n: rmse_n(beside, n_counted),
            beside_all_n: rmse_n(beside_all, n),
        }
    }

    /// In words, where they are most of what is left.
    pub(crate) fn words(self) -> Option<String> {
        (self.beside_n.powi(2) < 0.5 * self.left_n.powi(2)).then(|| {
            format!(
                " Most of that is a tare of each recording, of up to {:.2} N: beside it {:.2} N are left.",
                self.largest_n, self.beside_n
            )
        })
    }
}

/// What models typically leave of the counted samples of `traces`, in N; nothing where none counts.
pub(crate) fn left_n(traces: &[Trace]) -> f64 {
    turns::typical_n(traces.iter().flat_map(counted_n)).unwrap_or(0.0)
}

/// The same beside a tare of each.
fn left_beside_tares_n(traces: &[Trace]) -> f64 {
    let left = traces.iter().flat_map(|trace| {
        let tare_n = tare_n(trace);
        counted_n(trace).map(move |left_n| left_n - tare_n)
    });
    turns::typical_n(left).unwrap_or(0.0)
}

/// What the model of `trace` leaves of each of its counted samples, in N.
fn counted_n(trace: &Trace) -> impl Iterator<Item = f64> {
    let settled = trace.settled.iter().enumerate().filter(|(_, settled)| **settled);
    settled.map(|(at, _)| trace.force_n[at] - trace.model_n[at])
}

/// The middle of what is left of `trace`, in N, as far as it may be the tare of a load cell.
fn tare_n(trace: &Trace) -> f64 {
    let mut left_n: Vec<f64> = counted_n(trace).collect();
    if left_n.is_empty() {
        return 0.0;
    }
    let middle = left_n.len() / 2;
    let middle_n = *left_n.select_nth_unstable_by(middle, f64::total_cmp).1;
    let most_n = most_tare_n(trace, 1.0);
    middle_n.clamp(-most_n, most_n)
}

/// What the tare of a load cell may be in a recording like that of `trace`, in N: that of `cells` cells that are zeroed, or a share of
/// the largest force.
pub(crate) fn most_tare_n(trace: &Trace, cells: f64) -> f64 {
    let largest_n = trace.force_n.iter().copied().map(f64::abs).fold(0.0, f64::max);
    (cells * TARE_N).max(TARE_SHARE * largest_n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::given::tests::{STROKES, artifact, diagnosed_knocked, knocked, recorded};
    use pam_artifact::diagnosis::Verdict;
    use pam_identification::along::Along;
    use pam_muscle::effects::AugmentedModel;

    fn typical(fitted_n: f64, held_n: f64) -> Typical {
        Typical { fitted_n, held_n, sensors_n: (0.5, 1.0) }
    }

    #[test]
    fn what_is_typically_left_of_either_counts_against_the_noise_of_its_own_sensors() {
        assert!(!typical(0.9, 1.9).is_missed(None));
        assert!(typical(1.1, 0.0).is_missed(None));
        assert!(typical(0.0, 2.1).is_missed(None));
    }

    #[test]
    fn what_a_user_says_that_matters_takes_the_place_of_as_much_again_as_the_noise() {
        assert!(!typical(1.9, 2.1).is_missed(Some(2.0)) && typical(2.2, 0.0).is_missed(Some(2.0)));
    }

    #[test]
    fn neither_is_followed_where_both_are_missed_in_what_counts_and_over_all_samples() {
        // Two of three samples count, and there is no tare.
        let left = |counted_n: f64, all_n: f64| {
            let other_n = (3.0 * all_n * all_n - 2.0 * counted_n * counted_n).sqrt();
            let left_n = |at: usize| {
                let swing = [1.5_f64.sqrt(), 0.0, -(1.5_f64.sqrt())][at / 3 % 3];
                swing * if at.is_multiple_of(3) { other_n } else { counted_n }
            };
            let (force_n, model_n) = ((0..900).map(left_n).collect(), vec![0.0; 900]);
            [Trace {
                force_n,
                model_n,
                settled: (0..900).map(|at: usize| !at.is_multiple_of(3)).collect(),
                ..Trace::default()
            }]
        };
        // Half a newton of noise in what was fitted, twice that in what was held out.
        let typical = typical(0.9, 1.9);
        let neither =
            |fitted: &[Trace], held: &[Trace]| typical.neither_is_followed(&Tares::of(fitted), &Tares::of(held));
        assert!(neither(&left(1.1, 1.3), &left(2.1, 2.6)));
        assert!(!neither(&left(0.9, 4.0), &left(2.1, 2.6)), "reversals alone are missed");
        assert!(!neither(&left(1.1, 1.2), &left(2.1, 2.6)), "as a healthy muscle is");
        assert!(!neither(&left(1.1, 1.3), &left(1.9, 2.6)), "what nothing was fitted to is followed");
        assert!(!neither(&left(1.1, 1.3), &left(2.1, 2.4)));
        assert!(!neither(&left(1.1, 1.3), &[]));
    }

    #[test]
    fn nothing_is_consistent_where_fitted_and_held_out_recordings_are_knocked_alike() {
        let verdict = |knock_n: f64, held_knock_n: f64| {
            let later = knocked("later.csv", |time_s| STROKES(time_s + 4.0), &artifact(), 1.0, held_knock_n);
            diagnosed_knocked(knock_n, vec![later]).verdict
        };
        assert_eq!(verdict(6.0, 6.0), Verdict::Unexplained);
        assert_eq!([verdict(6.0, 0.0), verdict(0.0, 6.0)], [Verdict::Consistent; 2]);
    }

    #[test]
    fn a_hold_out_of_which_the_model_misses_some_newtons_everywhere_is_missed() {
        let model = artifact();
        let written = AugmentedModel::new(model.force_model(), Vec::new());
        let is_missed = |gain: f64| {
            let [fitted, held] = [1.0, gain].map(|gain| {
                let prepared = [recorded("strokes.csv", STROKES, &model, gain)];
                let along = Along::of(&prepared, &written, model.direction).expect("an evaluation");
                let traces = along.traces(&prepared, &written).expect("traces");
                (prepared, traces)
            });
            let typical = Typical::of(written.base(), (&fitted.0, &fitted.1), (&held.0, &held.1));
            typical.expect("residuals").is_missed(None)
        };
        assert!(!is_missed(1.0) && is_missed(1.05));
    }

    #[test]
    fn a_few_samples_that_are_missed_by_far_change_nothing_and_those_that_do_not_count_are_not_asked() {
        let trace = |missed_n: &dyn Fn(usize) -> f64| Trace {
            force_n: (0..100).map(missed_n).collect(),
            model_n: vec![0.0; 100],
            settled: (0..100).map(|at| at % 4 != 0).collect(),
            ..Trace::default()
        };
        let plain = left_n(&[trace(&|_| 1.0)]);
        assert!(plain > 1.4 && plain < 1.5);
        assert_eq!(left_n(&[trace(&|at| if at < 30 { 50.0 } else { 1.0 })]).to_bits(), plain.to_bits());
        assert_eq!(left_n(&[trace(&|at| if at % 4 == 0 { 50.0 } else { 1.0 })]).to_bits(), plain.to_bits());
        assert_eq!(left_n(&[]), 0.0);
    }

    #[test]
    fn a_tare_of_each_recording_is_none_of_what_is_typically_left_up_to_a_percent_of_the_force() {
        let trace = |tare_n: f64| {
            let swings_n = |at: usize| if at.is_multiple_of(2) { 0.1 } else { -0.1 };
            Trace {
                force_n: (0..101).map(|at| 400.0 + tare_n + swings_n(at)).collect(),
                model_n: vec![400.0; 101],
                settled: vec![true; 101],
                ..Trace::default()
            }
        };
        let left_n = |tares_n: [f64; 2]| left_beside_tares_n(&tares_n.map(trace));
        assert!(left_n([3.9, -3.9]) < 0.3);
        assert!((left_n([7.0, 7.0]) / left_n([7.5, 7.5]) - 3.0 / 3.5).abs() < 0.05, "beyond that it is left");
        assert_eq!(tare_n(&Trace::default()), 0.0);
        let tares = Tares::of(&[3.9, -2.0].map(trace));
        assert!((3.7..4.1).contains(&tares.largest_n) && tares.beside_n < 0.2 && tares.left_n > 2.9, "{tares:?}");
        assert!(tares.words().is_some_and(|words| words.contains("up to 4.00 N")));
        assert_eq!(Tares::of(&[0.0, 0.05].map(trace)).words(), None);
    }
}
