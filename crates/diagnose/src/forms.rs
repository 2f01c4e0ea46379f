//! Other forms of the effects that were named: how each could differ from what its page says.
//!
//! An effect in nature hardly ever has exactly the form of its page: a bristle is no exponential, two branches are no three.
//! What that leaves must not be taken for another effect. So before anything else is named, every effect bends: its shape
//! to either side, and its size with pressure, with contraction and with the direction of friction.

use pam_core::artifact::diagnosis::Coordinate;
use pam_core::effects::Kind;
use pam_core::effects::static_map::legendre;

use crate::coordinates::Coordinates;
use crate::hypothesis::CandidateEffect;
use crate::nuisance::{Nuisance, over_range};
use crate::state::{Setting, State};

/// By how much a shape bends to either side.
const FACTORS: [f64; 2] = [0.5, 2.0];

/// Other forms of everything that was named in a state, worked out once for every set of nuisances beside which they stand.
pub struct Forms {
    /// One set of columns for each effect that bends.
    columns_n: Vec<Vec<Vec<f64>>>,
}

impl Forms {
    /// Of what was named in `state`.
    pub fn of(setting: &Setting<'_>, state: &State, coordinates: &Coordinates) -> Self {
        let bends = |place: &usize| state.guesses[*place].effect.kind() != Kind::Event;
        let places = (0..state.guesses.len()).filter(bends);
        Self { columns_n: places.map(|place| forms_n(setting, state, coordinates, place)).collect() }
    }

    /// `nuisance` with them.
    pub fn beside(&self, nuisance: &Nuisance, counted: &[bool]) -> Nuisance {
        self.columns_n.iter().fold(nuisance.clone(), |out, columns| out.with_forms(columns.clone(), counted))
    }
}

/// Force of the other forms of the effect at `place`, each less what it adds as it is named, in N at every instant.
fn forms_n(setting: &Setting<'_>, state: &State, coordinates: &Coordinates, place: usize) -> Vec<Vec<f64>> {
    let whole_n = force_n(setting, state, &state.guesses);
    let guess = &state.guesses[place];
    let mut without = state.guesses.clone();
    without.remove(place);
    let n_before: usize = state.guesses[..place].iter().map(|guess| guess.amplitudes().len()).sum();
    let rest_n = partial_n(setting, state, &without, n_before, guess.amplitudes().len());
    let own_n: Vec<f64> = whole_n.iter().zip(&rest_n).map(|(whole, rest)| whole - rest).collect();
    let mut forms = Vec::new();
    for (parameter, shape) in guess.effect.shape().iter().enumerate() {
        for factor in FACTORS {
            let mut guesses = state.guesses.clone();
            let value = guess.shape[parameter];
            let bent = if value == 0.0 { continue } else { factor * value };
            guesses[place].shape[parameter] = bent.clamp(shape.range.0, shape.range.1);
            let bent_n = force_n(setting, state, &guesses);
            forms.push(bent_n.iter().zip(&whole_n).map(|(bent, whole)| bent - whole).collect());
        }
    }
    let track = setting.track;
    for kind in [Coordinate::Pressure, Coordinate::Contraction] {
        let over = over_range(coordinates.of_kind(kind), &track.counted);
        forms.push(own_n.iter().zip(&over).map(|(own, over)| own * over).collect());
    }
    forms.push(own_n.iter().zip(&track.instants).map(|(own, instant)| own * instant.moment.direction).collect());
    let own = guess.effect.page().coordinate;
    if !matches!(own, Coordinate::Time | Coordinate::Cycle) {
        let over = over_quantiles(coordinates.of_kind(own), &track.counted);
        for degree in 1..=LIVES {
            forms.push(own_n.iter().zip(&over).map(|(own, over)| own * legendre(degree, *over)).collect());
            forms.push(
                friction_n(setting, state).zip(&over).map(|(sign, over)| sign * legendre(degree, *over)).collect(),
            );
        }
    }
    forms
}

/// Highest degree of what is left in the coordinate that an effect lives in.
const LIVES: usize = 3;

/// Friction of a unit coefficient with its sign, at every instant.
fn friction_n<'a>(setting: &'a Setting<'_>, state: &'a State) -> impl Iterator<Item = f64> + 'a {
    setting.track.instants.iter().zip(&state.sheet.base).map(|(instant, base)| instant.moment.direction * base.normal_n)
}

/// Ranks of `values` among those that count, from -1 to 1: what is seldom reached is no lever.
fn over_quantiles(values: &[f64], counted: &[bool]) -> Vec<f64> {
    let kept = values.iter().zip(counted).filter(|(value, counted)| **counted && value.is_finite());
    let mut sorted: Vec<f64> = kept.map(|(value, _)| *value).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = sorted.len().max(1) as f64;
    values.iter().map(|value| 2.0 * sorted.partition_point(|other| other < value) as f64 / n - 1.0).collect()
}

/// Force of `guesses` with the weights of `state`, in N at every instant.
fn force_n(setting: &Setting<'_>, state: &State, guesses: &[CandidateEffect]) -> Vec<f64> {
    let sheet = setting.ground().sheet(guesses, &state.model);
    (0..setting.track.n()).map(|at| sheet.force_n(at, &state.fit.weights)).collect()
}

/// The same without `n` amplitudes from position `first` on.
fn partial_n(setting: &Setting<'_>, state: &State, guesses: &[CandidateEffect], first: usize, n: usize) -> Vec<f64> {
    let sheet = setting.ground().sheet(guesses, &state.model);
    let mut weights = state.fit.weights.clone();
    let from = pam_core::force::columns::N_COLUMNS + first;
    weights.drain(from..from + n);
    (0..setting.track.n()).map(|at| sheet.force_n(at, &weights)).collect()
}
