//! Further steps of the force beside one. What slips once slips again, and a loose contact comes and goes: one step of several explains
//! little, beside a drift or a wear that runs through all of them, so they are judged together.

use rayon::prelude::*;

use crate::events;
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::state::{Setting, State};
use crate::steps;

/// Share of the mean square that is left which one more must take away. Half or double of it changes no name in 18 looked-at cases with
/// steps or drifts.
const LEAST_GAIN: f64 = 0.04;
/// Steps beside the first, at most, for each recording.
const PER_RECORDING: usize = 2;

/// Steps that `first` has beside it, on top of `state`, each of which jumps as `first` does; the largest first.
pub(crate) fn beside(setting: &Setting<'_>, state: &State, first: &CandidateEffect) -> Vec<CandidateEffect> {
    let mut further: Vec<CandidateEffect> = Vec::new();
    let Some(mut now) = setting.fit_near(state.guesses_with(first), state) else { return further };
    while further.len() < PER_RECORDING * setting.track.recordings.len() {
        let residuals_n = setting.residuals_n(&now);
        let left = |shape: &Vec<f64>| {
            let is_told = first.beginning.is_told(shape[0] as usize, setting.track);
            let beginning = if is_told { first.beginning.clone() } else { Beginning::Fresh };
            let guess = CandidateEffect { shape: shape.clone(), beginning, ..first.clone() };
            let fit = setting.fit_more(&now, &guess)?;
            let gained = 1.0 - fit.mean_square / now.fit.mean_square;
            let is_one = gained > LEAST_GAIN
                && steps::is_sudden(setting, &residuals_n, shape, *fit.amplitudes.last()?, gained)
                && events::is_even(setting, &now, &guess);
            is_one.then_some((fit.mean_square, guess))
        };
        let shapes = steps::shapes(setting, &now);
        let every: Vec<(f64, CandidateEffect)> = shapes.par_iter().filter_map(left).collect();
        let Some((_, next)) = every.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)) else { break };
        let Some(fitted) = setting.fit_near(now.guesses_with(&next), &now) else { break };
        further.push(next);
        now = fitted;
    }
    further
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::judged;

    /// Recordings whose force jumps by so many newtons in each, at so much of its time.
    fn jumped(jumps: &[(f64, f64)]) -> Given {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[]);
        given.disturb();
        for (range, (share, jump_n)) in given.track.recordings.clone().into_iter().zip(jumps) {
            let from = range.start + (share * range.len() as f64) as usize;
            given.track.instants[from..range.end].iter_mut().for_each(|instant| instant.force_n += jump_n);
        }
        given
    }

    /// Recordings with a step beside the first one of `given`.
    fn recordings(given: &Given) -> Vec<usize> {
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let base =
            judged(&setting, setting.fit(Vec::new(), &given.start, &given.model).expect("a fit")).expect("folds");
        let shapes = steps::shapes(&setting, &base.state);
        let first = shapes.into_iter().find(|shape| shape[0] == 0.0).expect("an instant of the first");
        let further = beside(&setting, &base.state, &given.guess("force-step", &first));
        let mut recordings: Vec<usize> = further.iter().map(|guess| guess.shape[0] as usize).collect();
        recordings.sort_unstable();
        recordings
    }

    #[test]
    fn every_recording_that_jumps_has_its_step() {
        assert_eq!(recordings(&jumped(&[(0.43, 12.0), (0.57, -9.0), (0.37, 10.0)])), [1, 2]);
    }

    #[test]
    fn where_one_jumps_alone_there_are_no_others() {
        assert_eq!(recordings(&jumped(&[(0.43, 12.0)])), Vec::<usize>::new());
    }
}
