//! The model as it is written: on which base, with which terms, and where these act.

use pam_artifact::diagnosis::{Empirical, NamedEffect};
use pam_artifact::model::EffectEntry;
use pam_muscle::effects::sentence::Sentence;
use pam_muscle::effects::{AugmentedModel, Kind, Term};
use pam_muscle::force::ForceModel;

use crate::besides::Besides;
use crate::discover::{Discovery, HeldAgainst};
use crate::elsewhere::{KeptToFitted, keep_to_fitted};
use crate::joint::JointFit;
use crate::named::{named, nameless_entry, term_entry};
use crate::own;
use crate::search::Found;
use crate::state::{Setting, State};
use crate::uncertainty::{self, Uncertainty};

/// Share of what is left of the fitted recordings beside the base as given, mean square, below which the refitted one leaves far less.
/// Of five looked-at steps that the base as given makes next to nothing of (0.3 to 1.9 N) one is 6.4 N so, 10 when it was concealed;
/// the refitted bases of the other four leave 0.98 to 1.7 times as much.
const FAR_BETTER: f64 = 0.5;

/// What a model is written from.
pub(crate) struct Fit<'a> {
    /// What the state was fitted in.
    pub(crate) setting: &'a Setting<'a>,
    /// Base and names.
    pub(crate) state: &'a State,
    /// What the search found.
    pub(crate) found: &'a Found,
    /// Terms without a name beside it.
    pub(crate) discovery: Option<&'a Discovery>,
    /// What was found beside the search.
    pub(crate) besides: &'a Besides,
    /// The same fit with each fold left out.
    pub(crate) folds: &'a [JointFit],
    /// Standard errors.
    pub(crate) uncertainty: &'a Uncertainty,
    /// Instants of the residual that stand for one.
    pub(crate) correlated: f64,
}

impl Fit<'_> {
    /// The names with their sizes beside `base` as it is; none where there is more than names and a static map, or the samples do not
    /// determine them.
    fn names_beside(&self, base: &ForceModel, sentences: &[Option<Sentence>]) -> Option<Vec<Term>> {
        let guesses = &self.state.guesses;
        if self.discovery.is_some() || !self.besides.is_empty() {
            return None;
        }
        if guesses.is_empty() {
            return Some(Vec::new());
        }
        Some(own::terms(self.setting.terms_beside(guesses, base)?, sentences))
    }
}

/// A model on its way into a file; what the rig is known to do comes on top of it.
#[derive(Debug)]
pub(crate) struct Written {
    /// Eq. 11.
    pub(crate) base: ForceModel,
    /// What comes on top of it: the names first.
    pub(crate) terms: Vec<Term>,
    /// The same as a model artifact has it: the names first, in the order of the terms.
    pub(crate) entries: Vec<EffectEntry>,
    /// The names, in order of evidence.
    pub(crate) effects: Vec<NamedEffect>,
    /// Terms without a name.
    pub(crate) empirical: Option<Empirical>,
    /// What acts in the fitted recordings alone.
    pub(crate) kept: Option<KeptToFitted>,
    /// Sentences of a user's own effects among the names.
    sentences: Vec<Option<Sentence>>,
}

impl Written {
    /// All that was fitted, in every recording.
    pub(crate) fn of(fit: &Fit<'_>) -> Self {
        let Fit { setting, state, found, discovery, besides, folds, .. } = *fit;
        let sentences = own::sentences(setting, state);
        let (effects, mut entries) =
            named(setting, found, state, fit.uncertainty, fit.correlated, &sentences, besides.named());
        let mut terms = own::terms(state.terms(), &sentences);
        let empirical = discovery.map(|discovery| discovery.written(setting, found, folds));
        entries.extend(empirical.iter().flat_map(|empirical| &empirical.terms).map(term_entry));
        let nameless = setting.nuisance.carried(&state.fit.nuisances, setting.track, &found.coordinates);
        entries.extend(nameless.iter().map(nameless_entry));
        terms.extend(nameless);
        terms.extend(discovery.iter().flat_map(|discovery| discovery.terms()));
        terms.extend(besides.terms());
        Self { base: state.model.clone(), terms, entries, effects, empirical, kept: None, sentences }
    }

    /// Settles its base, and where its terms act, by what was `held` out.
    ///
    /// The base stays as it was given where nothing that is written acts elsewhere, unless held-out recordings are surely followed
    /// better by the refitted one, or no worse while the fitted ones are followed far better: what happened once is told from what
    /// it was before, and the base as given has taken up a part of it. Names that these are followed worse with are kept to the fitted
    /// recordings; where the refitted base leaves more there than the one as given, all of them, on that one.
    pub(crate) fn settle(&mut self, fit: &Fit<'_>, held: HeldAgainst<'_>) {
        let everywhere = self.model();
        if fit.state.guesses.iter().all(|guess| guess.effect.kind() == Kind::Event)
            && let Some(events) = fit.names_beside(held.given, &self.sentences)
        {
            let (as_given, refitted) = (held.left_as_given(), (held.left)(&everywhere));
            let left_square = |model: &AugmentedModel| fit.setting.track.left_square(model);
            let is_told_by_refit = || {
                let beside_given = AugmentedModel::new(held.given.clone(), events.clone());
                !refitted.is_worse_than(&as_given) && left_square(&everywhere) < FAR_BETTER * left_square(&beside_given)
            };
            if !as_given.is_surely_bettered_by(&refitted) && (self.effects.is_empty() || !is_told_by_refit()) {
                return self.put_on(held.given, events);
            }
        }
        if self.effects.is_empty() {
            return;
        }
        let given = AugmentedModel::from(held.given.clone());
        let mut model = everywhere.clone();
        let (mut ids, is_worse) = keep_to_fitted(&mut model, &given, held.left);
        let beside_given = is_worse.then(|| fit.names_beside(held.given, &self.sentences));
        match beside_given.flatten() {
            Some(mut terms) => {
                ids.clear();
                for (term, guess) in terms.iter_mut().zip(&fit.state.guesses).filter(|(term, _)| term.acts_elsewhere())
                {
                    term.only_as_fitted = true;
                    // A user's own effect is written without its name.
                    ids.push(guess.id());
                }
                self.put_on(held.given, terms);
            }
            None => {
                self.terms = model.terms().to_vec();
                self.entries.iter_mut().for_each(|entry| entry.only_as_fitted = ids.contains(&entry.id.as_str()));
            }
        }
        self.kept = (!ids.is_empty()).then_some(KeptToFitted { ids, everywhere });
    }

    /// All of it.
    pub(crate) fn model(&self) -> AugmentedModel {
        AugmentedModel::new(self.base.clone(), self.terms.clone())
    }

    /// Puts `terms`, the names and nothing else, on `base`, and gives entries and names their sizes.
    fn put_on(&mut self, base: &ForceModel, terms: Vec<Term>) {
        self.entries.truncate(terms.len());
        for (entry, term) in self.entries.iter_mut().zip(&terms) {
            entry.only_as_fitted = term.only_as_fitted;
            let ranges = term.effect.amplitudes().iter().map(|amplitude| amplitude.range);
            let sizes = entry.parameters.iter_mut().skip(term.shape.len());
            for (parameter, (&size, range)) in sizes.zip(term.amplitudes.iter().zip(ranges)) {
                *parameter = uncertainty::entry(&parameter.name, &parameter.unit, size, range, parameter.stderr);
            }
            for effect in self.effects.iter_mut().filter(|effect| effect.id == entry.id) {
                effect.parameters.clone_from(&entry.parameters);
            }
        }
        (self.base, self.terms) = (base.clone(), terms);
    }
}

#[cfg(test)]
mod tests;
