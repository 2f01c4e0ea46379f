//! All of it in order: recordings and a model in, a diagnosis out.

use pam_core::artifact::ModelArtifact;
use pam_core::artifact::diagnosis::{
    Candidate, Coordinate, DiagnoseConfig, Empirical, EmpiricalTerm, Evidence, Implausible, Isolability, NamedEffect,
    NextExperiment, Region, Verdict,
};
use pam_core::artifact::model::{EffectEntry, ParameterEntry, ParameterStatus};
use pam_core::effects::sentence::EMPIRICAL;
use pam_core::effects::{AugmentedModel, Term};
use pam_core::force::ForceModel;
use pam_core::recording::Recording;
use pam_identification::evaluate::{evaluate, noise_floor_n};
use pam_identification::prepare::{Prepared, redirect};

use crate::check;
use crate::discover;
use crate::error::DiagnoseError;
use crate::given::Given;
use crate::isolability::isolability;
use crate::joint::HeldOut;
use crate::knocks::{self, Knocks};
use crate::laws;
use crate::next_experiment::{Setpoints, confirm_mass, next_experiment};
use crate::nuisance::MAP_ID;
use crate::plausible::implausible;
use crate::question::{Answer, Question};
use crate::regions::{Place, concentrated};
use crate::search::{Found, Limits, chance};
use crate::short;
use crate::stand_ins;
use crate::state::{Setting, State};
use crate::structure::Remainder;
use crate::track::Track;
use crate::uncertainty::{Uncertainty, correlated_instants, entries, shape_errors};
use crate::verdict::{Sizes, alternatives, verdict};
use crate::veto;

/// What to diagnose.
#[derive(Debug)]
pub struct Request {
    /// Recordings that effects are fitted to.
    pub estimation: Vec<Recording>,
    /// Recordings that nothing is fitted to.
    pub holdout: Vec<Recording>,
    /// The model that is in question; effects that it has already are not looked for again.
    pub model: ModelArtifact,
    /// Options.
    pub config: DiagnoseConfig,
    /// Go on where an instrument fault is suspected.
    pub accept_implausible: bool,
}

/// What was found.
#[derive(Debug)]
pub struct Diagnosis {
    /// The model that was in question.
    pub model: ModelArtifact,
    /// Options.
    pub config: DiagnoseConfig,
    /// What is to be believed.
    pub verdict: Verdict,
    /// The verdict in words; empty until [`weigh`](Diagnosis::weigh) has been called.
    pub statement: String,
    /// The model as it was given.
    pub given: Given,
    /// Where model and recordings differ.
    pub regions: Vec<Region>,
    /// Effects in order of evidence.
    pub effects: Vec<NamedEffect>,
    /// What models the part that has no name.
    pub empirical: Option<Empirical>,
    /// Names that the recordings are too short or too coarse for, in words.
    pub too_short: Vec<String>,
    /// Share of the mismatch that is left.
    pub unexplained_share: f64,
    /// Where structure is left.
    pub unexplained: Vec<Region>,
    /// Base parameters that no such muscle has.
    pub implausible: Vec<Implausible>,
    /// Everything that was weighed.
    pub candidates: Vec<Candidate>,
    /// What the recordings could tell apart at all.
    pub isolability: Isolability,
    /// What to record next, with a path for the rig.
    pub next_experiment: Option<(NextExperiment, Setpoints)>,
    /// Sizes that the verdict rests on.
    pub sizes: Sizes,
    /// Base model refitted to the estimation recordings.
    pub base: ForceModel,
    /// Base model and effects.
    pub augmented: AugmentedModel,
    /// Effects as a model artifact has them.
    pub entries: Vec<EffectEntry>,
    /// Standard errors of base and amplitudes.
    pub uncertainty: Uncertainty,
    /// What was free in the base.
    pub free: Vec<&'static str>,
    /// Which free base parameters press against their range.
    pub at_bound: Vec<bool>,
    /// Estimation recordings.
    pub estimation: Vec<Prepared>,
    /// Held-out recordings.
    pub holdout: Vec<Prepared>,
}

/// Times that another law of friction at standstill may be taken.
const MOST_LAWS: usize = 2;

/// Effects that may be named unless told otherwise.
pub const MAX_EFFECTS: usize = 4;

/// Checks the recordings without fitting anything.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn check(request: Request) -> Result<(), DiagnoseError> {
    let Request { estimation, holdout, model, config, accept_implausible } = request;
    let (estimation, holdout) = check::prepare(estimation, holdout, &model, accept_implausible)?;
    let track = Track::of(&estimation, model.direction, &model.force_model())?;
    check::long_enough(&track, &estimation)?;
    let limits = limits(&config, &model, &estimation, false)?;
    given(&Question::new(&estimation, &model, limits), &holdout, accept_implausible).map(|_| ())
}

/// The model as given; recordings of clearly another muscle are refused unless they are to be accepted.
fn given(question: &Question<'_>, holdout: &[Prepared], accept_implausible: bool) -> Result<Given, DiagnoseError> {
    let given = Given::of(question, holdout)?;
    if !accept_implausible {
        given.refuse_another_muscle(question.estimation)?;
    }
    Ok(given)
}

/// The floor is that of the sensors that made `estimation`, which need not be those that the model was identified with.
fn limits(
    config: &DiagnoseConfig,
    model: &ModelArtifact,
    estimation: &[Prepared],
    confirmed: bool,
) -> Result<Limits, DiagnoseError> {
    Ok(Limits {
        max_effects: config.max_effects,
        excluded: config.excluded.clone(),
        matters_above_n: config.matters_above_n,
        sensor_floor_n: noise_floor_n(estimation, &model.force_model())?,
        confirmed,
    })
}

/// Diagnoses.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn diagnose(request: Request) -> Result<Diagnosis, DiagnoseError> {
    diagnose_observed(request, &|_, _| {})
}

/// The same, telling `observer` how many steps of how many are behind it.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_observed(request: Request, observer: &dyn Fn(u64, u64)) -> Result<Diagnosis, DiagnoseError> {
    let Request { estimation, holdout, mut model, config, accept_implausible } = request;
    let (mut estimation, mut holdout) = check::prepare(estimation, holdout, &model, accept_implausible)?;
    let mut track = Track::of(&estimation, model.direction, &model.force_model())?;
    check::long_enough(&track, &estimation)?;
    let limits = limits(&config, &model, &estimation, !holdout.is_empty())?;
    let mut given = given(&Question::new(&estimation, &model, limits.clone()), &holdout, accept_implausible)?;
    // Reading the channels, each look, and what is said of the outcome; a search may end early.
    let (steps, done) = (config.max_effects as u64 + 3, std::cell::Cell::new(1));
    let advance = || {
        done.set((done.get() + 1).min(steps));
        observer(done.get(), steps);
    };
    observer(done.get(), steps);
    let mut answer = Question::new(&estimation, &model, limits.clone()).answer(track, &advance)?;
    for _ in 0..MOST_LAWS {
        let question = Question::new(&estimation, &model, limits.clone());
        let Some(standstill) = laws::better(&question, &answer.track, &answer.found, model.direction)? else { break };
        let before = model.direction.standstill;
        model.direction.standstill = standstill;
        redirect(&mut estimation, model.direction, model.form)?;
        redirect(&mut holdout, model.direction, model.form)?;
        track = Track::of(&estimation, model.direction, &model.force_model())?;
        let other = Question::new(&estimation, &model, limits.clone()).answer(track, &advance)?;
        let left = |answer: &Answer| answer.found.best.held_out.mean_square();
        if left(&other) >= left(&answer) {
            model.direction.standstill = before;
            redirect(&mut estimation, model.direction, model.form)?;
            redirect(&mut holdout, model.direction, model.form)?;
            break;
        }
        answer = other;
    }
    let question = Question::new(&estimation, &model, limits);
    let Answer { track, mut found, knocks, mut sizes } = answer;
    let held = (!holdout.is_empty()).then(|| Track::of(&holdout, model.direction, &model.force_model())).transpose()?;
    if let Some(held) = held.as_ref().filter(|_| knocks.is_none()) {
        found = veto::confirmed(&question, &track, found, held);
        sizes = Sizes::of(&found, &question.limits);
    }
    let paths: Vec<String> = estimation.iter().map(|prepared| prepared.recording.path.clone()).collect();
    let nuisance = found.nuisance.clone();
    let setting = question.setting(&track, &nuisance);
    let is_doubtful =
        verdict(&found, &sizes, false) == Verdict::Unexplained || stand_ins::leaves_too_much(&found, &sizes);
    if knocks.is_none() && is_doubtful {
        let places = structured(&setting, &found.best.state, &found, &paths);
        let left_over = telling(places, &[]).first().map(|region| region.coordinate);
        sizes = stand_ins::let_go(&setting, &mut found, &sizes, &question.limits, left_over);
    }
    let lasts_s = estimation.iter().map(|prepared| prepared.quality.duration_s).sum();
    let too_short = short::let_go(&setting, &mut found, &question.limits, lasts_s);
    if !too_short.is_empty() && knocks.is_none() {
        sizes = Sizes::of(&found, &question.limits);
    }
    given.beside_effects(&question, &track, &found);
    let space = &question.space;
    observer(steps - 1, steps);
    let verdict = verdict(&found, &sizes, knocks.is_some());
    let discovery = discover::discover(&setting, &found, &sizes, verdict, held.as_ref());
    let verdict = discovery.as_ref().map_or(verdict, |discovery| discovery.verdict(verdict));
    let (state, nuisance) = match &discovery {
        Some(discovery) => (&discovery.best.state, &discovery.nuisance),
        None => (&found.best.state, &found.nuisance),
    };
    let whole = question.setting(&track, nuisance);
    let undetermined = || DiagnoseError::Undetermined { path: estimation[0].recording.path.clone() };
    let folds = whole.fold_fits(state).ok_or_else(undetermined)?;
    let uncertainty = Uncertainty::of(&folds, space);

    let correlated = correlated_instants(&whole, &whole.residuals_n(state));
    let (effects, mut entries) = named(&whole, &found, state, &uncertainty, correlated, knocks.as_ref());
    let empirical = discovery.as_ref().map(|discovery| discovery.written(&whole, &found, &folds));
    entries.extend(empirical.iter().flat_map(|empirical| &empirical.terms).map(term_entry));
    let mut regions = if verdict == Verdict::Consistent { Vec::new() } else { regions(&setting, &found, &paths) };
    let mut terms = state.terms();
    if let Some(map) = nuisance.map_term(&state.fit.nuisances, &track, &found.coordinates) {
        entries.push(map_entry(&map));
        terms.push(map);
    }
    terms.extend(discovery.iter().flat_map(discover::Discovery::terms));
    if let Some(knocks) = &knocks {
        terms.push(knocks.term());
        regions.insert(if effects[0].id == knocks::ID { 0 } else { regions.len() }, knocks.region(sizes.mismatch_n));
    }
    let unexplained = if verdict == Verdict::Unexplained {
        telling(structured(&setting, &found.best.state, &found, &paths), &[])
    } else {
        Vec::new()
    };
    let isolability =
        isolability(&setting, &found.base.state, sizes.floor_n, track.n_counted() as f64 / correlated.max(1.0));
    // Where the mass that knocks is all there is to confirm.
    let mass = || {
        let knocks = knocks.as_ref().filter(|_| verdict == Verdict::Explained)?;
        confirm_mass(Knocks::effect(), knocks.mass_kg(), state, &model.domain)
    };
    let next_experiment = next_experiment(&setting, &found, verdict, &unexplained, &sizes, &model.domain).or_else(mass);
    let (implausible, candidates) = (implausible(&setting, &found.best.state), candidates(&found, knocks.is_some()));
    let free = space.free.iter().map(|free| free.name()).collect();
    let at_bound = state.fit.at_bound[..space.free.len()].to_vec();
    let augmented = AugmentedModel::new(state.model.clone(), terms);
    for prepared in estimation.iter_mut().chain(&mut holdout) {
        prepared.begin(augmented.base(), model.direction.standstill)?;
    }
    let diagnosis = Diagnosis {
        verdict,
        // Said once the models are compared at the rate of the recordings.
        statement: String::new(),
        given,
        regions,
        effects,
        empirical,
        too_short,
        unexplained_share: sizes.share_left(),
        unexplained,
        implausible,
        candidates,
        isolability,
        next_experiment,
        sizes,
        base: better_base(&estimation, &model, &found.base.state.model)?,
        augmented,
        entries,
        uncertainty,
        free,
        at_bound,
        estimation,
        holdout,
        model,
        config,
    };
    Ok(diagnosis)
}

/// The static map as a model artifact has it; its terms have no standard errors of their own.
fn map_entry(map: &Term) -> EffectEntry {
    let shapes = map.effect.shape().iter().map(|shape| (shape.name, shape.unit));
    let amplitudes = map.effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit));
    let parameters =
        shapes.chain(amplitudes).zip(map.shape.iter().chain(&map.amplitudes)).map(|((name, unit), &value)| {
            let status = ParameterStatus::Fitted;
            ParameterEntry { name: name.to_owned(), value, unit: unit.to_owned(), stderr: None, status }
        });
    EffectEntry { id: MAP_ID.to_owned(), sentence: None, parameters: parameters.collect() }
}

/// A term without a name as a model artifact has it.
fn term_entry(term: &EmpiricalTerm) -> EffectEntry {
    let (id, sentence) = (EMPIRICAL.to_owned(), Some(term.sentence.clone()));
    EffectEntry { id, sentence, parameters: term.parameters.clone() }
}

/// The mass behind `knocks`.
fn knocking(knocks: &Knocks) -> NamedEffect {
    let page = Knocks::effect().page();
    NamedEffect {
        id: page.id.to_owned(),
        name: page.name.to_owned(),
        equation: page.equation.to_owned(),
        parameters: knocks.entries(),
        evidence: evidence(&knocks.without, &knocks.with, 1),
        alternatives: Vec::new(),
        separating_test: page.test.to_owned(),
    }
}

/// The base model that leaves less on the recordings at their full rate: as it was identified, if that was on these, or as
/// refitted on the grid. What effects buy is never measured against the worse one.
fn better_base(
    estimation: &[Prepared],
    model: &ModelArtifact,
    refitted: &ForceModel,
) -> Result<ForceModel, DiagnoseError> {
    let identified = model.force_model();
    let rmse_n = |model: &ForceModel| -> Result<f64, DiagnoseError> {
        Ok(evaluate(estimation, model)?.together.map_or(f64::INFINITY, |together| together.rmse_n))
    };
    Ok(if rmse_n(&identified)? <= rmse_n(refitted)? { identified } else { refitted.clone() })
}

pub(crate) fn evidence(without: &HeldOut, with: &HeldOut, looks: usize) -> Evidence {
    let improved = without.log_ratios(with).filter(|&ratio| ratio > 0.0).count();
    Evidence {
        log_ratio: without.log_ratio(with),
        rmse_without_n: without.mean_square().sqrt(),
        rmse_with_n: with.mean_square().sqrt(),
        blocks_improved: improved,
        n_blocks: without.blocks.len(),
        p_value: (chance(without, with) * looks as f64).min(1.0),
    }
}

/// The effects that were taken and the mass behind `knocks`, in order of evidence, and in that in which a model has them;
/// `correlated` instants of the residual stand for one; `state` is what was found, with terms without a name beside it.
fn named(
    setting: &Setting<'_>,
    found: &Found,
    state: &State,
    uncertainty: &Uncertainty,
    correlated: f64,
    knocks: Option<&Knocks>,
) -> (Vec<NamedEffect>, Vec<EffectEntry>) {
    let mut named = Vec::new();
    let mut first = 0;
    for (index, guess) in state.guesses.iter().enumerate() {
        let page = guess.effect.page();
        let errors = shape_errors(setting, state, index, correlated);
        let parameters = entries(state, index, first, &errors, uncertainty);
        first += guess.amplitudes().len();
        let alternatives = alternatives(found, index);
        let separating_test = alternatives
            .iter()
            .find_map(|id| page.confused_with.iter().find(|confusion| confusion.id == *id))
            .map_or(page.test, |confusion| confusion.test);
        let evidence = found.taken.get(index).map_or_else(
            || evidence(&found.base.held_out, &found.best.held_out, found.first.len()),
            |taken| evidence(&taken.without, &taken.with, found.first.len()),
        );
        named.push(NamedEffect {
            id: page.id.to_owned(),
            name: page.name.to_owned(),
            equation: page.equation.to_owned(),
            parameters,
            evidence,
            alternatives: alternatives.into_iter().map(str::to_owned).collect(),
            separating_test: separating_test.to_owned(),
        });
    }
    named.extend(knocks.map(knocking));
    let entry = |named: &NamedEffect| EffectEntry {
        id: named.id.clone(),
        sentence: None,
        parameters: named.parameters.clone(),
    };
    let list = named.iter().map(entry).collect();
    named.sort_by(|left, right| right.evidence.log_ratio.total_cmp(&left.evidence.log_ratio));
    (named, list)
}

/// What became of every candidate of the first look.
fn candidates(found: &Found, knocks: bool) -> Vec<Candidate> {
    let base = found.whole.held_out.mean_square();
    let mismatch = (base - found.floor_square).max(f64::MIN_POSITIVE);
    let taken: Vec<&str> = found.best.state.guesses.iter().map(crate::hypothesis::Guess::id).collect();
    let rivals: Vec<&str> = (0..taken.len()).flat_map(|index| alternatives(found, index)).collect();
    found
        .first
        .iter()
        .map(|trial| {
            let id = trial.guess.id();
            let explains = ((base - trial.held_out.mean_square()) / mismatch).clamp(0.0, 1.0);
            let outcome = if taken.contains(&id) || (knocks && id == knocks::ID) {
                "named".to_owned()
            } else if rivals.contains(&id) {
                "cannot be distinguished from one named".to_owned()
            } else if found.stand_ins.contains(&id) {
                "gains something, and leaves far more than it explains".to_owned()
            } else if explains < 0.02 {
                "explains nothing".to_owned()
            } else if taken.is_empty() {
                "gains too little to be named".to_owned()
            } else {
                "redundant given the selected effects".to_owned()
            };
            Candidate {
                id: id.to_owned(),
                evidence: evidence(&found.whole.held_out, &trial.held_out, found.first.len()),
                explains,
                outcome,
            }
        })
        .collect()
}

/// Where the mismatch lies: what each effect explains over its own coordinate, then what the residual says by itself.
fn regions(setting: &Setting<'_>, found: &Found, paths: &[String]) -> Vec<Region> {
    let mut regions: Vec<(f64, Region)> = Vec::new();
    let state = &found.best.state;
    let after = setting.residuals_n(state);
    for (index, guess) in state.guesses.iter().enumerate() {
        let Some(rest) = setting.fit_without(state, index) else { continue };
        let before = setting.residuals_n(&rest);
        let excess: Vec<f64> =
            before.iter().zip(&after).map(|(before, after)| before * before - after * after).collect();
        let coordinate = guess.effect.page().coordinate;
        let (log_ratio, p_value) = found.taken.get(index).map_or((0.0, 1.0), |taken| {
            (
                taken.without.log_ratio(&taken.with),
                (chance(&taken.without, &taken.with) * found.first.len() as f64).min(1.0),
            )
        });
        if let Some(place) = concentrated(setting, &found.coordinates, coordinate, &excess, p_value, paths) {
            regions.push((log_ratio, place.region));
        }
    }
    regions.sort_by(|left, right| right.0.total_cmp(&left.0));
    let mut out: Vec<Region> = regions.into_iter().map(|(_, region)| region).collect();
    let known: Vec<Coordinate> = out.iter().map(|region| region.coordinate).collect();
    out.extend(telling(structured(setting, &found.whole.state, found, paths), &known));
    out
}

/// Those of `places`, the most telling first, over none of the coordinates `known`; what is everywhere only where there is
/// nothing before it.
fn telling(places: Vec<Place>, known: &[Coordinate]) -> Vec<Region> {
    let news = places.into_iter().filter(|place| !known.contains(&place.region.coordinate)).enumerate();
    news.filter(|(index, place)| !place.is_everywhere || (*index == 0 && known.is_empty()))
        .map(|(_, place)| place.region)
        .collect()
}

/// Coordinates over which the residual of a state is structured, the most telling first.
fn structured(setting: &Setting<'_>, state: &State, found: &Found, paths: &[String]) -> Vec<Place> {
    let remainder = Remainder::of(setting, state);
    let Some(nothing) = remainder.structure(&[]) else { return Vec::new() };
    let mut places: Vec<(f64, Place)> = Vec::new();
    for coordinate in Coordinate::ALL {
        let best = found
            .features
            .iter()
            .filter(|feature| feature.coordinate == coordinate && !feature.plane)
            .filter_map(|feature| Some((feature, remainder.structure(&[feature])?)))
            .map(|(feature, structure)| (nothing.held_out.log_ratio(&structure.held_out), feature, structure))
            .max_by(|left, right| left.0.total_cmp(&right.0));
        let Some((gain, feature, structure)) = best.filter(|(gain, ..)| *gain > 0.5) else { continue };
        // Every recording has a time of its own.
        let structure =
            if coordinate == Coordinate::Time { None } else { remainder.narrowest(feature) }.unwrap_or(structure);
        let excess: Vec<f64> = structure.values_n.iter().map(|value| value * value).collect();
        let looks = found.features.len() as f64;
        let p_value = (chance(&nothing.held_out, &structure.held_out) * looks).min(1.0);
        if let Some(place) = concentrated(setting, &found.coordinates, coordinate, &excess, p_value, paths) {
            places.push((gain, place));
        }
    }
    places.sort_by(|left, right| right.0.total_cmp(&left.0));
    places.into_iter().map(|(_, place)| place).collect()
}
