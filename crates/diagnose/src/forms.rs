//! Other forms of the effects that were named: how each could differ from what its page says.
//!
//! An effect in nature hardly ever has exactly the form of its page: a bristle is no exponential, two branches are no three.
//! What that leaves must not be taken for another effect. So before anything else is named, every effect bends: its shape
//! to either side, and its size with pressure, with contraction and with the direction of friction.

use pam_muscle::Coordinate;
use pam_muscle::effects::static_map::legendre;
use pam_muscle::effects::{AugmentedModel, Base, Effect, Kind, Moment, Term};
use pam_muscle::force::ForceModel;

use crate::coordinates::Coordinates;
use crate::hypothesis::CandidateEffect;
use crate::nuisance::{Nuisance, over_range};
use crate::state::{Setting, State};
use crate::track::Track;

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
    let bent_n = |shape: &[f64]| {
        let mut guesses = state.guesses.clone();
        guesses[place].shape = shape.to_vec();
        force_n(setting, state, &guesses)
    };
    let friction = setting.track.instants.iter().zip(&state.sheet.base);
    Bending {
        track: setting.track,
        coordinates,
        effect: guess.effect,
        shape: &guess.shape,
        own_n: whole_n.iter().zip(&rest_n).map(|(whole, rest)| whole - rest).collect(),
        whole_n,
        friction_n: friction.map(|(instant, base)| instant.moment.direction * base.normal_n).collect(),
    }
    .forms_n(&bent_n)
}

/// Other forms of `terms`, which are known and whose sizes no fit moves, beside `base`, in N at every instant of `track`: the size
/// of each as well, and a shape that is zero to either side of it.
pub(crate) fn of_known_n(track: &Track, base: &ForceModel, terms: &[Term]) -> Vec<Vec<f64>> {
    let coordinates = Coordinates::of(track);
    let with_n = |terms: Vec<Term>| track.modelled_n(&AugmentedModel::new(base.clone(), terms));
    let whole_n = with_n(terms.to_vec());
    let friction = track.instants.iter().map(|instant| {
        let Moment { pressure_pa, length_m, direction, .. } = instant.moment;
        direction * Base::of(base, pressure_pa, length_m).normal_n
    });
    let friction_n: Vec<f64> = friction.collect();
    let mut columns = Vec::new();
    for (place, term) in terms.iter().enumerate() {
        let mut others = terms.to_vec();
        others.remove(place);
        let own_n: Vec<f64> = whole_n.iter().zip(with_n(others)).map(|(whole, rest)| whole - rest).collect();
        let bent_n = |shape: &[f64]| {
            let mut bent = terms.to_vec();
            bent[place].shape = shape.to_vec();
            with_n(bent)
        };
        let bending = Bending {
            track,
            coordinates: &coordinates,
            effect: term.effect,
            shape: &term.shape,
            own_n: own_n.clone(),
            whole_n: whole_n.clone(),
            friction_n: friction_n.clone(),
        };
        columns.push(own_n);
        columns.extend(bending.beside_zero_n(&bent_n));
        columns.extend(bending.forms_n(&bent_n));
    }
    columns
}

/// An effect that bends.
struct Bending<'a> {
    track: &'a Track,
    coordinates: &'a Coordinates,
    effect: &'static dyn Effect,
    shape: &'a [f64],
    /// Force with it, in N at every instant.
    whole_n: Vec<f64>,
    /// What it adds to that, in N.
    own_n: Vec<f64>,
    /// Friction of a unit coefficient with its sign, in N.
    friction_n: Vec<f64>,
}

impl Bending<'_> {
    /// Its other forms; `bent_n` is the whole force with another shape.
    fn forms_n(&self, bent_n: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
        let mut forms = Vec::new();
        for (parameter, &value) in self.shape.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            forms.extend(FACTORS.map(|factor| self.bent_n(parameter, factor * value, bent_n)));
        }
        let (track, own_n) = (self.track, &self.own_n);
        for kind in [Coordinate::Pressure, Coordinate::Contraction] {
            let over = over_range(self.coordinates.of_kind(kind), &track.counted);
            forms.push(own_n.iter().zip(&over).map(|(own, over)| own * over).collect());
        }
        forms.push(own_n.iter().zip(&track.instants).map(|(own, instant)| own * instant.moment.direction).collect());
        let own = self.effect.page().coordinate;
        if !matches!(own, Coordinate::Time | Coordinate::Cycle) {
            let over = over_quantiles(self.coordinates.of_kind(own), &track.counted);
            for degree in 1..=LIVES {
                for force_n in [own_n, &self.friction_n] {
                    forms
                        .push(force_n.iter().zip(&over).map(|(force, over)| force * legendre(degree, *over)).collect());
                }
            }
        }
        forms
    }

    /// The same to either side of every shape that is zero, as far as the smallest that a grid has.
    fn beside_zero_n(&self, bent_n: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
        let zeros = self.shape.iter().zip(self.effect.shape()).enumerate().filter(|(_, (value, _))| **value == 0.0);
        let smallest = |grid: &[f64]| grid.iter().copied().filter(|&value| value > 0.0).reduce(f64::min);
        let sides = zeros.filter_map(|(parameter, (_, shape))| Some((parameter, smallest(shape.grid)?)));
        sides.flat_map(|(parameter, side)| [-side, side].map(|side| self.bent_n(parameter, side, bent_n))).collect()
    }

    /// What changes with another value of shape `parameter`, in N.
    fn bent_n(&self, parameter: usize, value: f64, bent_n: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        let (low, high) = self.effect.shape()[parameter].range;
        let mut shape = self.shape.to_vec();
        shape[parameter] = value.clamp(low, high);
        bent_n(&shape).iter().zip(&self.whole_n).map(|(bent, whole)| bent - whole).collect()
    }
}

/// Highest degree of what is left in the coordinate that an effect lives in.
const LIVES: usize = 3;

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
    let from = pam_muscle::force::columns::N_COLUMNS + first;
    weights.drain(from..from + n);
    (0..setting.track.n()).map(|at| sheet.force_n(at, &weights)).collect()
}

#[cfg(test)]
mod tests;
