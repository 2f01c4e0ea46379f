//! What recordings could tell apart at all, before anything is blamed.
//!
//! Every effect of the catalogue is put into the fitted model at a typical size, and what a refit of the base parameters
//! absorbs of its force is taken away. How much is left says whether the recordings show the effect; the cosine between
//! what two effects leave says whether they tell them apart. An effect that comes in several forms (a delay of the pressure
//! or of the length, damping with or without pressure, a short or a long memory) counts with the form that is most like the
//! other effect: near 1 there is a form of each that cannot be told from one of the other.
//!
//! Typical sizes are those of the effects' pages ([`Page::typical`](pam_muscle::effects::Page)).

use std::ops::Range;

use pam_artifact::diagnosis::Isolability;
use pam_muscle::effects::{AugmentedModel, Effect, Term};
use rayon::prelude::*;

use crate::design_matrix::Regressors;
use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::state::{Setting, State};
use crate::tangent::{Tangent, dot, norm};

/// Means over time that are compared, about; memories run over all instants.
const MOST_ROWS: usize = 6000;
/// Instants that each is the mean of, at least: what a delay or a lag makes of the noise of the channels, which looks like
/// nothing, goes in the mean.
const LEAST_GROUP: usize = 4;
/// Standard errors that a residual must reach to be seen.
const STANDARD_ERRORS: f64 = 3.0;
/// Share of the noise that it must reach besides: nothing smaller is worth a name, and the noise of the channels in the
/// columns of an effect reaches this by itself where the effect has nothing to act on.
const LEAST_SHARE_OF_NOISE: f64 = 0.2;

/// What the recordings of `setting` could tell apart on top of `state`, where noise of `noise_n` (root mean square)
/// amounts to `n_independent` instants.
pub fn isolability(setting: &Setting<'_>, state: &State, noise_n: f64, n_independent: f64) -> Isolability {
    let rows = groups(setting, state).into_iter().map(|group| (group.clone(), group.len() as f64)).collect();
    let tangent = Tangent::of(setting, state, &state.sheet, rows);
    let jobs: Vec<(usize, CandidateEffect)> = setting
        .effects
        .iter()
        .enumerate()
        .flat_map(|(index, &effect)| {
            shapes(setting, effect).into_iter().map(move |shape| {
                (index, CandidateEffect { effect, shape, sign: Sign::Any, beginning: Beginning::Fresh })
            })
        })
        .collect();
    // Each form with what is left of it, in the order of the catalogue.
    let forms: Vec<(usize, Vec<f64>)> = jobs
        .par_iter()
        .flat_map_iter(|(index, guess)| {
            left_of_forms(setting, state, &tangent, guess).into_iter().map(move |left| (*index, left))
        })
        .collect();
    let sizes: Vec<f64> = forms.iter().map(|(_, left)| norm(left)).collect();
    let limit_n = noise_n * (STANDARD_ERRORS / n_independent.max(1.0).sqrt()).max(LEAST_SHARE_OF_NOISE);
    let n = setting.effects.len();
    let mut visible_n = vec![0.0; n];
    let mut cosine = vec![vec![0.0; n]; n];
    for ((index, _), size) in forms.iter().zip(&sizes) {
        visible_n[*index] = f64::max(visible_n[*index], *size);
    }
    let seen: Vec<usize> = (0..forms.len()).filter(|&form| sizes[form] > limit_n).collect();
    let pairs: Vec<(usize, usize)> = seen
        .iter()
        .enumerate()
        .flat_map(|(position, &left)| seen[position + 1..].iter().map(move |&right| (left, right)))
        .filter(|&(left, right)| forms[left].0 != forms[right].0)
        .collect();
    let cosines: Vec<f64> = pairs
        .par_iter()
        .map(|&(left, right)| (dot(&forms[left].1, &forms[right].1) / (sizes[left] * sizes[right])).abs().min(1.0))
        .collect();
    for ((left, right), found) in pairs.into_iter().zip(cosines) {
        let (i, j) = (forms[left].0, forms[right].0);
        cosine[i][j] = f64::max(cosine[i][j], found);
        cosine[j][i] = cosine[i][j];
    }
    for (index, row) in cosine.iter_mut().enumerate() {
        row[index] = 1.0;
    }
    Isolability { ids: setting.effects.iter().map(|effect| effect.page().id.to_owned()).collect(), visible_n, cosine }
}

/// Runs of instants that count.
fn groups(setting: &Setting<'_>, state: &State) -> Vec<Range<usize>> {
    let track = setting.track;
    let size = track.n().div_ceil(MOST_ROWS).max(LEAST_GROUP);
    let mut groups: Vec<Range<usize>> = Vec::new();
    for range in &track.recordings {
        let mut open = false;
        for at in range.clone() {
            if !track.counted[at] || state.read.slopes[at] < 0.5 {
                open = false;
                continue;
            }
            match groups.last_mut().filter(|group| open && group.len() < size) {
                Some(group) => group.end = at + 1,
                None => groups.push(at..at + 1),
            }
            open = true;
        }
    }
    groups
}

/// Typical shapes of an effect.
fn shapes(setting: &Setting<'_>, effect: &'static dyn Effect) -> Vec<Vec<f64>> {
    if effect.page().id == "force-step" {
        // Halfway through the longest recording.
        let end_s =
            |range: &Range<usize>| range.clone().last().map_or(0.0, |at| setting.track.instants[at].moment.time_s);
        let longest = setting
            .track
            .recordings
            .iter()
            .enumerate()
            .max_by(|left, right| end_s(left.1).total_cmp(&end_s(right.1)).then(right.0.cmp(&left.0)));
        return longest.map(|(index, range)| vec![index as f64, 0.5 * end_s(range)]).into_iter().collect();
    }
    match effect.page().typical.shapes {
        [] => vec![effect.shape().iter().map(|shape| shape.grid[shape.grid.len() / 2]).collect()],
        shapes => shapes.iter().map(|shape| shape.to_vec()).collect(),
    }
}

/// What a refit leaves of each form of `guess`.
fn left_of_forms(setting: &Setting<'_>, state: &State, tangent: &Tangent, guess: &CandidateEffect) -> Vec<Vec<f64>> {
    if guess.only_adds() {
        let ground = Regressors { track: setting.track, columns: setting.columns, only: None, slopes: true };
        let k = guess.amplitudes().len();
        let every: Vec<usize> = (0..setting.track.n()).collect();
        let columns = ground.more_columns(&state.sheet, guess, &state.model, &every);
        let sizes = guess.effect.page().typical.amplitudes;
        return (0..k)
            .map(|column| {
                let size = sizes.get(column).copied().unwrap_or(guess.amplitudes()[column].range.1);
                tangent.left_of(|row| size * columns[row * k + column])
            })
            .collect();
    }
    let mut terms = state.terms();
    let before_n = setting.track.modelled_n(&AugmentedModel::new(state.model.clone(), terms.clone()));
    terms.push(Term::new(guess.effect, guess.shape.clone(), Vec::new()));
    let after_n = setting.track.modelled_n(&AugmentedModel::new(state.model.clone(), terms));
    vec![tangent.left_of(|row| after_n[row] - before_n[row])]
}

#[cfg(test)]
mod tests;
