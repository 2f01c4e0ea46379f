//! All of it in order: recordings and a model in, a diagnosis out.

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::{
    Candidate, DiagnoseConfig, Empirical, Implausible, Isolability, NamedEffect, NextExperiment, Periodic, Region,
    Verdict,
};
use pam_artifact::model::EffectEntry;
use pam_identification::along::Along;
use pam_identification::evaluate::{Evaluation, evaluate, noise_floor_n};
use pam_identification::prepare::{Prepared, begun_at_rest};
use pam_muscle::effects::{AugmentedModel, Effect, Term};
use pam_muscle::force::ForceModel;
use pam_recording::Recording;
use rayon::prelude::*;

use crate::best_law::Recordings;
use crate::carried;
use crate::check;
use crate::discover;
use crate::elsewhere::KeptToFitted;
use crate::error::DiagnoseError;
use crate::given::Given;
use crate::held;
use crate::held_error::Left;
use crate::isolability::isolability;
use crate::mass::{self, MovingMass};
use crate::named::candidates;
use crate::nameless::Other;
use crate::next_experiment::{Setpoints, confirm_mass, next_experiment};
use crate::nuisance::ENDS_ID;
use crate::periodic;
use crate::places::regions;
use crate::plausible::implausible;
use crate::pooled::Pooled;
use crate::problem::DiagnosisProblem;
use crate::rig;
use crate::search::{Limits, ends};
use crate::standing::{Standing, unexplained};
use crate::typical::{Tares, Typical};
use crate::uncertainty::{Uncertainty, correlated_instants};
use crate::verdict::Sizes;
use crate::written::{Fit, Written};

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
    /// Effects of a user's own, considered beside those of the catalogue.
    pub effects: Vec<&'static dyn Effect>,
    /// Effects of the rig that are known from elsewhere: they are in, and not looked for again.
    pub rig: Vec<Term>,
    /// Go on where an instrument fault is suspected.
    pub accept_implausible: bool,
}

/// What was found.
#[derive(Debug, Clone)]
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
    /// Base, effects and map without the empirical terms; none where there are no terms, or no effect beside them.
    pub without_terms: Option<AugmentedModel>,
    /// Names that the recordings are too short or too coarse for, in words.
    pub too_short: Vec<String>,
    /// What was noticed of the recordings themselves, in words.
    pub noticed: Vec<String>,
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
    /// Whether, where nothing is named, what is written typically leaves more of what was fitted or held out than noise accounts for.
    pub typically_misses: bool,
    /// Tares in what was fitted.
    pub(crate) tares: Tares,
    /// Where what was fitted is followed and what was held out is not: what one model of both leaves, if that follows all.
    pub pooled: Option<Pooled>,
    /// Names that are none, by id, each with the force without a name that explains more.
    pub nameless: Vec<(&'static str, &'static str)>,
    /// Names that are none, by id, each with what may be there as well.
    pub as_well: Vec<(&'static str, &'static Other)>,
    /// What the force does at one frequency while no drive does.
    pub periodic: Option<Periodic>,
    /// Base model refitted to the estimation recordings.
    pub base: ForceModel,
    /// How well it agrees with them.
    pub base_fitted: Evaluation,
    /// Base model and effects.
    pub augmented: AugmentedModel,
    /// What of it acts in the estimation recordings alone, since held-out ones are followed worse with it.
    pub kept_to_fitted: Option<KeptToFitted>,
    /// Effects as a model artifact has them.
    pub entries: Vec<EffectEntry>,
    /// What is left of the fitted recording that the others foretell worst, root mean square in N; nothing where there is only one.
    pub worst_foretold_n: f64,
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
    /// What is written, along the estimation recordings.
    pub fitted: Along,
    /// The same along held-out recordings, without what acts in the fitted ones alone.
    pub held: Along,
}

/// Effects that may be named unless told otherwise.
pub const MAX_EFFECTS: usize = 4;

/// Checks the recordings without fitting anything.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn check(request: Request) -> Result<(), DiagnoseError> {
    let Request { estimation, holdout, model, config, effects, rig, accept_implausible } = request;
    let (estimation, holdout) = check::prepare(estimation, holdout, &model, accept_implausible)?;
    let track = rig::track(&estimation, &model, &rig)?;
    check::long_enough(&track, &estimation)?;
    let limits = limits(&config, effects, &model, &estimation, false)?;
    given(&DiagnosisProblem::new(&estimation, &model, limits), &holdout, accept_implausible).map(|_| ())
}

/// The model as given; recordings of clearly another muscle are refused unless they are to be accepted.
fn given(
    question: &DiagnosisProblem<'_>,
    holdout: &[Prepared],
    accept_implausible: bool,
) -> Result<Given, DiagnoseError> {
    let given = Given::of(question, holdout)?;
    if !accept_implausible {
        given.refuse_another_muscle(question.estimation)?;
    }
    Ok(given)
}

/// The floor is that of the sensors that made `estimation`, which need not be those that the model was identified with.
pub(crate) fn limits(
    config: &DiagnoseConfig,
    own: Vec<&'static dyn Effect>,
    model: &ModelArtifact,
    estimation: &[Prepared],
    confirmed: bool,
) -> Result<Limits, DiagnoseError> {
    Ok(Limits {
        max_effects: config.max_effects,
        excluded: config.excluded.clone(),
        own,
        matters_above_n: config.matters_above_n,
        sensor_floor_n: noise_floor_n(estimation, &model.force_model())?,
        confirmed,
        only: None,
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
    let Request { estimation, holdout, mut model, config, effects: own, rig, accept_implausible } = request;
    let (estimation, holdout) = check::prepare(estimation, holdout, &model, accept_implausible)?;
    let track = rig::track(&estimation, &model, &rig)?;
    check::long_enough(&track, &estimation)?;
    let limits = limits(&config, own, &model, &estimation, !holdout.is_empty())?;
    let mut given = given(&DiagnosisProblem::new(&estimation, &model, limits.clone()), &holdout, accept_implausible)?;
    // Reading the channels, each look, and what is said of the outcome; a search may end early.
    let (steps, done) = (config.max_effects as u64 + 3, std::cell::Cell::new(1));
    let advance = || {
        done.set((done.get() + 1).min(steps));
        observer(done.get(), steps);
    };
    observer(done.get(), steps);
    let mut recordings = Recordings { estimation, holdout, rig };
    let outcome = recordings.under_best_law(&mut model, &limits, track, &advance)?;
    let Recordings { estimation, holdout, rig } = recordings;
    let question = DiagnosisProblem::new(&estimation, &model, limits);
    let held = (!holdout.is_empty()).then(|| rig::track(&holdout, &model, &rig)).transpose()?;
    let held = held.map(|held| question.without_mistaken(&held));
    // A mass that swings does so in all recordings; where one knocks was looked for in the fitted ones alone.
    let held = held.map(|held| match &outcome.besides.mass {
        Some(mass) if !mass.knocks() => held.without(mass),
        _ => held,
    });
    let Standing { track, mut found, besides, mut sizes, too_short } = Standing::of(&question, outcome, held.as_ref())?;
    let nuisance = found.nuisance.clone();
    let setting = question.setting(&track, &nuisance);
    let (as_given, direction) = (model.force_model(), model.direction);
    // At the rate of the recordings, as programs will evaluate what is written.
    let held_left = |model: &AugmentedModel| {
        Left::at_full_rate(&rig::beside(&rig, model), &holdout, direction).unwrap_or_else(Left::endless)
    };
    let against = held.as_ref().map(|_| discover::HeldAgainst { left: &held_left, given: &as_given });
    let space = &question.space;
    observer(steps - 1, steps);
    let (verdict, discovery) =
        discover::beside_names(&setting, &mut found, &mut sizes, &question.limits, !besides.is_empty(), against);
    let verdict = discovery.as_ref().map_or(verdict, |discovery| discovery.verdict(verdict));
    // Beside the names that stay.
    given.beside_effects(&question, &track, &found, !rig.is_empty());
    let carried = match &discovery {
        Some(_) => None,
        None => carried::leaves_least(&setting, &found, held.as_ref()),
    };
    let (state, nuisance) = match (&discovery, &carried) {
        (Some(discovery), _) => (&discovery.best.state, &discovery.nuisance),
        (None, Some((state, nuisance))) => (state, nuisance),
        (None, None) => (&found.best.state, &found.nuisance),
    };
    let whole = question.setting(&track, nuisance);
    let undetermined = || DiagnoseError::Undetermined { path: estimation[0].recording.path.clone() };
    let folds = whole.fold_fits(state).ok_or_else(undetermined)?;
    let uncertainty = Uncertainty::of(&folds, space);

    let worst_foretold_n = whole.worst_foretold_n(state);
    let correlated = correlated_instants(&whole, &whole.residuals_n(state));
    let fit = Fit {
        setting: &whole,
        state,
        found: &found,
        discovery: discovery.as_ref(),
        besides: &besides,
        folds: &folds,
        uncertainty: &uncertainty,
        correlated,
    };
    let mut written = Written::of(&fit);
    if let Some(held) = against {
        written.settle(&fit, held);
    }
    // Where nothing is named, terms are compared with the base model.
    let without_terms =
        discovery.as_ref().filter(|_| !written.effects.is_empty()).map(|discovery| discovery.without_terms.clone());
    let augmented = rig::beside(&rig, &written.model());
    let elsewhere = augmented.elsewhere();
    // Each begins as all of the model has it.
    let (mut begun, mut holdout_begun) = (estimation.clone(), holdout.clone());
    let begin = |(index, prepared): (usize, &mut Prepared)| prepared.begin_with(&augmented, direction, index);
    begun.par_iter_mut().enumerate().try_for_each(begin)?;
    holdout_begun.par_iter_mut().try_for_each(|prepared| prepared.begin_with(&elsewhere, direction, 0))?;
    let fitted = Along::of(&begun, &augmented, direction)?;
    let held = Along::of(&holdout_begun, &elsewhere, direction)?;
    let fitted_traces = fitted.traces(&begun, &augmented)?;
    let held_traces = held.traces(&holdout_begun, &elsewhere)?;
    let typical = || {
        let (fitted, held) = ((&*begun, &*fitted_traces), (&*holdout_begun, &*held_traces));
        Typical::of(augmented.base(), fitted, held)
    };
    let typical = written.effects.is_empty().then(typical).transpose()?;
    let matters_above_n = question.limits.matters_above_n;
    let [tares, held_tares] = [&fitted_traces, &held_traces].map(|traces| Tares::of(traces));
    let neither_is_followed =
        typical.is_some_and(|typical| matters_above_n.is_none() && typical.neither_is_followed(&tares, &held_tares));
    let is_missed = typical.is_some_and(|typical| typical.is_missed(matters_above_n));
    // Where hold-outs alone speak against a model that nothing is missing in.
    let in_question = typical
        .filter(|typical| verdict == Verdict::Consistent && !typical.fitted_is_missed(matters_above_n))
        .filter(|_| is_missed || held::misses_any(&fitted.evaluation, &held.evaluation));
    let pooled =
        in_question.and_then(|alone| Pooled::of(&estimation, &holdout, &model, &question.limits, &rig, &alone));
    let typically_misses = is_missed && pooled.is_none();
    let periodic = periodic::periodic(fitted_traces.par_iter().chain(&held_traces));
    let swings = periodic.is_some_and(|periodic| periodic::matters(&periodic, sizes.beyond_noise_n()));
    let is_in_doubt = typically_misses || neither_is_followed || swings;
    let verdict = if verdict == Verdict::Consistent && is_in_doubt { Verdict::Unexplained } else { verdict };
    let mut regions =
        if verdict == Verdict::Consistent { Vec::new() } else { regions(&setting, &found, &question.paths()) };
    if let Some(region) = besides.mass.as_ref().and_then(|mass| mass.region(sizes.mismatch_n)) {
        let at = if written.effects[0].id == mass::ID { 0 } else { regions.len() };
        regions.insert(at, region);
    }
    regions.extend(besides.step.as_ref().map(|step| step.region(sizes.mismatch_n, &question.paths())));
    let unexplained =
        if verdict == Verdict::Unexplained { unexplained(&question, &setting, &found) } else { Vec::new() };
    let isolability =
        isolability(&setting, &found.base.state, sizes.floor_n, track.n_counted() as f64 / correlated.max(1.0));
    // Where the mass is all there is to confirm.
    let confirmed = || {
        let mass = besides.mass.as_ref().filter(|_| verdict == Verdict::Explained)?;
        confirm_mass(MovingMass::effect(), mass.mass_kg(), state, &model.domain)
    };
    let next_experiment =
        next_experiment(&setting, &found, verdict, &unexplained, &sizes, &model.domain).or_else(confirmed);
    let (implausible, candidates) =
        (implausible(&setting, &found.best.state), candidates(&found, &besides.ids().collect::<Vec<&str>>()));
    let free = space.free.iter().map(|free| free.name()).collect();
    let at_bound = state.fit.at_bound[..space.free.len()].to_vec();
    let Written { mut entries, effects, empirical, kept, .. } = written;
    let kept_to_fitted = kept.map(|kept| KeptToFitted { everywhere: rig::beside(&rig, &kept.everywhere), ..kept });
    entries.splice(0..0, rig.iter().map(rig::entry));
    let (estimation, holdout) = (begun, holdout_begun);
    let mut noticed = check::noticed(&estimation, &holdout, &found.base.state.model, &model)?;
    let has_ends = entries.iter().any(|entry| entry.id == ENDS_ID);
    noticed.extend(has_ends.then(|| ends::words(&whole, state)).flatten());
    let (base, base_fitted) = better_base(&estimation, &model, &found.base.state.model)?;
    let diagnosis = Diagnosis {
        verdict,
        // Said once the models are compared at the rate of the recordings.
        statement: String::new(),
        given,
        regions,
        effects,
        empirical,
        without_terms,
        too_short,
        noticed,
        unexplained_share: sizes.share_left(),
        unexplained,
        implausible,
        candidates,
        isolability,
        next_experiment,
        sizes,
        typically_misses,
        tares,
        pooled,
        nameless: found.nameless.clone(),
        as_well: found.as_well.clone(),
        periodic,
        base,
        base_fitted,
        augmented,
        kept_to_fitted,
        entries,
        worst_foretold_n,
        uncertainty,
        free,
        at_bound,
        estimation,
        holdout,
        fitted,
        held,
        model,
        config,
    };
    Ok(diagnosis)
}

/// The base model that leaves less on the recordings at their full rate: as it was identified, if that was on these, or as
/// refitted on the grid, and how well it agrees with them. What effects buy is never measured against the worse one.
fn better_base(
    estimation: &[Prepared],
    model: &ModelArtifact,
    refitted: &ForceModel,
) -> Result<(ForceModel, Evaluation), DiagnoseError> {
    let evaluated = |base: ForceModel| -> Result<(ForceModel, Evaluation), DiagnoseError> {
        let begun = begun_at_rest(estimation, &base, model.direction.standstill)?;
        let evaluation = evaluate(&begun, &base)?;
        Ok((base, evaluation))
    };
    let rmse_n = |evaluation: &Evaluation| evaluation.together.map_or(f64::INFINITY, |together| together.rmse_n);
    let (identified, refitted) = (evaluated(model.force_model())?, evaluated(refitted.clone())?);
    Ok(if rmse_n(&identified.1) <= rmse_n(&refitted.1) { identified } else { refitted })
}
