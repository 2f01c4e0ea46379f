//! What a search is made with, and the search itself: on the grid, then for a mass or a step at rest, and then on the grid without them.

use pam_artifact::ModelArtifact;
use pam_identification::prepare::Prepared;
use pam_identification::search_space::SearchSpace;
use pam_muscle::effects::{AugmentedModel, CATALOGUE, Effect};
use pam_muscle::force::columns::ForceColumns;

use crate::base;
use crate::besides::Besides;
use crate::error::DiagnoseError;
use crate::mass::{self, MovingMass};
use crate::nuisance::{self, Nuisance};
use crate::resting_step::{self, RestingStep};
use crate::search::{Found, Limits, search};
use crate::state::{Setting, State};
use crate::track::Track;
use crate::turns;
use crate::verdict::Sizes;

/// What a search is made with, but for the track.
#[derive(Debug)]
pub struct DiagnosisProblem<'a> {
    /// Recordings that effects are fitted to.
    pub estimation: &'a [Prepared],
    /// The model that is in question.
    pub model: &'a ModelArtifact,
    /// Limits of the search.
    pub limits: Limits,
    /// Base parameters that move, and their ranges.
    pub space: SearchSpace,
    /// Columns of eq. 11.
    pub columns: ForceColumns,
    /// Effects that may be named: those of the catalogue, and a user's own.
    pub effects: Vec<&'static dyn Effect>,
}

/// What came out.
#[derive(Debug)]
pub struct SearchOutcome {
    /// The recordings without what was found beside the search; where a mass knocks, nothing counts.
    pub track: Track,
    /// What the search found on it.
    pub found: Found,
    /// What was found beside it.
    pub besides: Besides,
    /// Sizes that a verdict rests on.
    pub sizes: Sizes,
}

impl<'a> DiagnosisProblem<'a> {
    /// Whether `estimation` and `model` differ by effects within `limits`.
    pub fn new(estimation: &'a [Prepared], model: &'a ModelArtifact, limits: Limits) -> Self {
        let largest_n_per_m =
            estimation.iter().map(|prepared| prepared.quality.largest_pressure_length_n_per_m).fold(0.0, f64::max);
        let columns = ForceColumns::new(&model.geometry, model.strand_modulus_pa, model.form, largest_n_per_m);
        let space = base::search_space(model, &columns);
        let effects = CATALOGUE.iter().chain(&limits.own).copied().collect();
        Self { estimation, model, limits, space, columns, effects }
    }

    /// Of the recordings, in order.
    pub(crate) fn paths(&self) -> Vec<String> {
        self.estimation.iter().map(|prepared| prepared.recording.path.clone()).collect()
    }

    /// What fits to `track` share, beside `nuisance`.
    pub fn setting<'b>(&'b self, track: &'b Track, nuisance: &'b Nuisance) -> Setting<'b> {
        Setting {
            track,
            columns: &self.columns,
            space: &self.space,
            muscle: &self.model.geometry,
            strand_modulus_pa: self.model.strand_modulus_pa,
            only: None,
            nuisance,
            floor_square: self.limits.sensor_floor_n.powi(2),
            apart: true,
            effects: &self.effects,
        }
    }

    /// Searches `track`; calls `looked` behind every look at the catalogue.
    ///
    /// # Errors
    /// [`DiagnoseError::Undetermined`] where the samples do not determine a fit; where they cannot be read back.
    pub fn answer(&self, track: &Track, looked: &dyn Fn()) -> Result<SearchOutcome, DiagnoseError> {
        let track = self.without_mistaken(track);
        let (found, sizes) = self.search(&track, looked)?;
        let explained = Self::beside_mass(&found);
        let limits = &self.limits;
        let first = MovingMass::that_matters(self.estimation, &explained, self.model, limits, &sizes)?;
        let Some(first) = first else {
            return self.beside_step(SearchOutcome { track, found, besides: Besides::default(), sizes }, looked);
        };
        // What a mass leaves on the grid would hide the rest, and would be taken for something else. The mass itself is known better
        // from where it knocks, or from what is fast, than from all that is there.
        let track = track.without(&first);
        let first_look = found.first;
        let mut others = self.without([mass::ID]);
        others.limits.max_effects -= 1;
        let (mut found, sizes) = others.search(&track, looked)?;
        found.first = first_look;
        let mass = first.again(self.estimation, &Self::beside_mass(&found), self.model, &sizes)?;
        let sizes = sizes.with(mass.all_rows_n);
        let knocks = mass.knocks();
        let besides = Besides { mass: Some(mass), step: None };
        let outcome = SearchOutcome { track, found, besides, sizes };
        if knocks { Ok(outcome) } else { others.beside_step(outcome, looked) }
    }

    /// Base and effects that were `found`, without a mass.
    fn beside_mass(found: &Found) -> AugmentedModel {
        let state = &found.best.state;
        let others = state.terms().into_iter().filter(|term| term.effect.page().id != mass::ID).collect();
        AugmentedModel::new(state.model.clone(), others)
    }

    /// `outcome`, or the same beside a step of the force at rest where one is there that matters, and no more is left than it may leave.
    fn beside_step(&self, outcome: SearchOutcome, looked: &dyn Fn()) -> Result<SearchOutcome, DiagnoseError> {
        let is_excluded = self.limits.excluded.iter().any(|id| id == resting_step::ID);
        if is_excluded || self.limits.max_effects == 0 {
            return Ok(outcome);
        }
        let muscle = &self.model.geometry;
        let mut beside = self.without([resting_step::ID]);
        beside.limits.max_effects -= 1;
        let left = |found: &Found| found.best.held_out.mean_square();
        let before = left(&outcome.found);
        let mut least = f64::INFINITY;
        let mut best: Option<SearchOutcome> = None;
        let matters_n = outcome.sizes.beyond_noise_n();
        let direction = self.model.direction;
        let without = &outcome.found.best.held_out;
        let steps = RestingStep::all(self.estimation, &outcome.track, direction, muscle, without)?;
        let named = outcome.found.best.state.terms();
        let is_one = |step: &RestingStep| step.all_instants_n > matters_n && self.goes_on(step, &outcome);
        for step in steps.into_iter().filter(is_one) {
            let track = step.taken_off(outcome.track.clone(), muscle);
            let (found, sizes) = beside.search(&track, looked)?;
            let is_possible = !step.is_spoken_against(&found.best.held_out);
            if is_possible && left(&found) < least.min(step.may_leave(before, &named)) {
                least = left(&found);
                let step = step.compared(&found.best.held_out);
                let besides = Besides { step: Some(step), ..outcome.besides.clone() };
                let sizes = sizes.with(besides.size_n());
                best = Some(SearchOutcome { track, found, besides, sizes });
            }
        }
        Ok(match best {
            Some(best) => SearchOutcome { found: Found { first: outcome.found.first, ..best.found }, ..best },
            None => outcome,
        })
    }

    /// Whether all that follows `step` in the recordings of `outcome` is off by as much as the force jumps, beside the base as given, the
    /// refitted one, or that and what was found.
    fn goes_on(&self, step: &RestingStep, outcome: &SearchOutcome) -> bool {
        let SearchOutcome { track, found, .. } = outcome;
        let setting = self.setting(track, &found.nuisance);
        let beside_given = setting.terms_beside(&[step.guess()], &self.model.force_model());
        let beside_given_n = beside_given.and_then(|terms| terms[0].amplitudes.first().copied());
        let size_n = |state: &State| {
            let mut guesses = state.guesses.clone();
            guesses.retain(|guess| guess.id() != resting_step::ID);
            guesses.push(step.guess());
            setting.fit_near(guesses, state)?.fit.amplitudes.last().copied()
        };
        let sizes_n = [beside_given_n, size_n(&found.base.state), size_n(&found.best.state)];
        sizes_n.into_iter().flatten().any(|size_n| step.lasts(size_n))
    }

    /// `track` without instants beside turns whose direction is mistaken.
    pub(crate) fn without_mistaken(&self, track: &Track) -> Track {
        let start = base::coordinates(self.model, &self.space);
        let setting = self.setting(track, &nuisance::NONE);
        turns::without_mistaken(&setting, &start, &self.model.force_model(), self.limits.sensor_floor_n)
    }

    /// The same question, asked without the effects `excluded`.
    pub(crate) fn without(&self, excluded: impl IntoIterator<Item = &'static str>) -> Self {
        let mut limits = self.limits.clone();
        limits.excluded.extend(excluded.into_iter().map(str::to_owned));
        Self::new(self.estimation, self.model, limits)
    }

    /// The search on `track` alone, without the effects `excluded`.
    ///
    /// # Errors
    /// [`DiagnoseError::Undetermined`] where the samples do not determine a fit.
    pub(crate) fn search_without(&self, track: &Track, excluded: &[&'static str]) -> Result<Found, DiagnoseError> {
        Ok(self.without(excluded.iter().copied()).search(track, &|| {})?.0)
    }

    /// The same, considering the effect `id` alone.
    pub(crate) fn of_one(&self, id: &'static str) -> Self {
        Self::new(self.estimation, self.model, Limits { only: Some(id), ..self.limits.clone() })
    }

    /// Searches `track`, for nothing beside what the search finds.
    ///
    /// # Errors
    /// As [`DiagnosisProblem::answer`].
    pub(crate) fn answer_alone(&self, track: &Track) -> Result<SearchOutcome, DiagnoseError> {
        let (found, sizes) = self.search(track, &|| {})?;
        Ok(SearchOutcome { track: track.clone(), found, besides: Besides::default(), sizes })
    }

    fn search(&self, track: &Track, looked: &dyn Fn()) -> Result<(Found, Sizes), DiagnoseError> {
        let start = base::coordinates(self.model, &self.space);
        let found =
            search(&self.setting(track, &nuisance::NONE), &start, &self.model.force_model(), &self.limits, looked)
                .ok_or_else(|| DiagnoseError::Undetermined { path: self.estimation[0].recording.path.clone() })?;
        let sizes = Sizes::of(&found, &self.limits);
        Ok((found, sizes))
    }
}
