//! What was found as an artifact has it, and in words.

use pam_artifact::change::{Change, ChangeCandidate, ChangeFit, ChangeKind, ChangeVerdict, Compared};
use pam_identification::search_space::Free;
use pam_muscle::force::Parameter;

use super::baseline::Baseline;
use super::candidate::parameters;
use super::changes::Changes;
use super::hypothesis::{Change as Moved, Later, Subject};
use super::point::Point;
use super::quantity::{Channel, Quantity};
use super::search::Found;
use crate::named::evidence;

/// Times what the model of then left of its own recordings, or the sensors leave, that may be left of later ones.
const LEFT: f64 = 1.5;
/// Share of the rise that what is named leaves at most.
const LEFT_OF_RISE: f64 = 0.5;
/// Candidates that are listed.
const CANDIDATES: usize = 12;
/// Standard errors within which a size is none.
const NOTHING: f64 = 2.0;

pub(super) fn written(later: &Later<'_>, then: &Point, known: &Baseline, found: &Found, fit: ChangeFit) -> Changes {
    let hypothesis = &found.now.hypothesis;
    let fit = ChangeFit {
        as_then_n: root_mean_square(later, then),
        within_errors_n: found.then.fit.mean_square.sqrt(),
        now_n: found.now.fit.mean_square.sqrt(),
        ..fit
    };
    let mut changes: Vec<Change> =
        (0..hypothesis.changes.len()).map(|index| change(later, then, found, index)).collect();
    changes.sort_by(|left, right| right.evidence.log_ratio.total_cmp(&left.evidence.log_ratio));
    let limit_n = LEFT * fit.then_n.max(fit.noise_floor_n);
    let rise = fit.within_errors_n.powi(2) - fit.then_n.min(fit.within_errors_n).powi(2);
    let left = fit.now_n.powi(2) - fit.then_n.min(fit.now_n).powi(2);
    let is_left = fit.now_n > limit_n && (changes.is_empty() || left > LEFT_OF_RISE * rise);
    let verdict = if is_left {
        ChangeVerdict::Unexplained
    } else if changes.is_empty() {
        ChangeVerdict::Unchanged
    } else if changes.iter().any(|change| !change.alternatives.is_empty()) {
        ChangeVerdict::Ambiguous
    } else {
        ChangeVerdict::Changed
    };
    let candidates = found.first.iter().take(CANDIDATES).map(|trial| ChangeCandidate {
        id: trial.subject.id(&trial.hypothesis.point),
        log_ratio: trial.evidence,
        rmse_n: trial.held_out.mean_square().sqrt(),
    });
    let mut warnings = Vec::new();
    if fit.share_compared < 0.95 {
        warnings.push(format!(
            "{:.0} % of the samples lie beyond the pressures or lengths of the baseline and are not compared",
            100.0 * (1.0 - fit.share_compared)
        ));
    }
    for change in changes.iter().filter(|change| !change.alternatives.is_empty()) {
        warnings.push(format!(
            "these recordings cannot distinguish a change of {} from one of {}",
            change.id,
            change.alternatives.join(" or ")
        ));
    }
    Changes {
        verdict,
        statement: super::words::statement(verdict, &changes, &fit),
        unchanged: unchanged(later, then, known, found),
        candidates: candidates.collect(),
        changes,
        fit,
        warnings,
        traces: super::traces::traces(later, then, found),
    }
}

/// What the model of then leaves as it is, in N.
fn root_mean_square(later: &Later<'_>, then: &Point) -> f64 {
    let force_n = then.force_n(later.track);
    let counted = (0..later.track.n()).filter(|&at| later.track.counted[at]);
    let (sum, n) =
        counted.fold((0.0, 0.0), |(sum, n), at| (sum + (later.measured_n[at] - force_n[at]).powi(2), n + 1.0));
    f64::sqrt(sum / f64::max(n, 1.0))
}

fn change(later: &Later<'_>, then: &Point, found: &Found, index: usize) -> Change {
    let hypothesis = &found.now.hypothesis;
    let Moved { subject, .. } = hypothesis.changes[index];
    let (without, alternatives) = &found.without[index];
    let differences = differences(later, then, found, index);
    let vanished = |term: usize| {
        let own = differences.iter().take(then.terms[term].amplitudes.len());
        let is_nothing =
            |compared: &Compared| compared.stderr.is_some_and(|stderr| compared.now.abs() < NOTHING * stderr);
        own.clone().count() > 0 && own.into_iter().all(is_nothing)
    };
    let (kind, name) = match subject {
        Subject::Channel(channel) => (ChangeKind::Channel, channel.name()),
        Subject::Base(free) => (ChangeKind::Parameter, parameter(free)),
        Subject::Gone(term) => (ChangeKind::EffectGone, then.terms[term].effect.page().name),
        Subject::Known(term) if vanished(term) => (ChangeKind::EffectGone, then.terms[term].effect.page().name),
        Subject::Known(term) => (ChangeKind::Effect, then.terms[term].effect.page().name),
        Subject::New(_, effect) => (ChangeKind::NewEffect, effect.page().name),
    };
    Change {
        id: subject.id(&hypothesis.point),
        kind,
        name: name.to_owned(),
        differences,
        evidence: evidence(without, &found.now.held_out, found.first.len()),
        alternatives: alternatives.clone(),
    }
}

/// What a base parameter is, in words.
fn parameter(free: Free) -> &'static str {
    match free {
        Free::One(Parameter::K1) => "factor of the gas force",
        Free::One(Parameter::K2) => "factor of the contraction",
        Free::One(Parameter::K3) => "constant force",
        Free::One(Parameter::C10 | Parameter::C01) | Free::BladderSum => "stiffness of the bladder",
        Free::One(Parameter::StrandCompliance) => "modulus of the strands",
        Free::One(Parameter::RubberFriction) => "friction of the bladder on the braid",
        Free::One(Parameter::StrandFriction) => "friction between strands",
    }
}

/// Numbers of change `index`: those that the fit moved, then the shapes of its effect.
fn differences(later: &Later<'_>, then: &Point, found: &Found, index: usize) -> Vec<Compared> {
    let hypothesis = &found.now.hypothesis;
    let own = &hypothesis.changes[index];
    let mut wide = hypothesis.clone();
    let first: usize = hypothesis.changes[..index].iter().map(|change| change.moved.len()).sum();
    let (term, is_new) = match own.subject {
        Subject::Known(term) => (Some(term), false),
        Subject::New(term, _) => (Some(term), true),
        Subject::Channel(_) | Subject::Base(_) | Subject::Gone(_) => (None, false),
    };
    if let Some(term) = term {
        for at in 0..hypothesis.point.terms[term].shape.len() {
            let quantity = Quantity::Shape { term, index: at };
            let other = !is_new && quantity.of(&hypothesis.point) == quantity.of(then);
            if !other {
                wide.changes[index].ranges.push(quantity.range(&hypothesis.point));
                wide.changes[index].moved.push(quantity);
            }
        }
    }
    let fit = later.linear(&wide, found.weight, false).map(|(fit, _)| fit);
    let stderr = |at: usize| {
        let variance = fit.as_ref()?.covariance[(at, at)];
        let range = wide.changes[index].ranges[at - first];
        // As wide as its range is no knowledge.
        Some(variance.sqrt()).filter(|stderr| *stderr > 0.0 && *stderr < range.1 - range.0)
    };
    let moved = wide.changes[index].moved.iter().enumerate();
    moved
        .map(|(at, &quantity)| {
            let was = (!is_new).then(|| quantity.of(then));
            compared(quantity, &hypothesis.point, was, quantity.of(&hypothesis.point), stderr(first + at))
        })
        .collect()
}

/// A number as people read it.
fn compared(quantity: Quantity, point: &Point, then: Option<f64>, now: f64, stderr: Option<f64>) -> Compared {
    let of_term = |term: usize, name: &str| format!("{}.{name}", point.terms[term].effect.page().id);
    let (name, unit, inverse) = match quantity {
        Quantity::Base(free) => {
            let parameter = match free {
                Free::One(parameter) => parameter,
                Free::BladderSum => Parameter::C10,
            };
            (free.name().to_owned(), parameter.unit(), parameter == Parameter::StrandCompliance)
        }
        Quantity::Channel(channel) => (channel.id().to_owned(), channel.unit(), false),
        Quantity::Amplitude { term, index } => {
            let amplitude = point.terms[term].effect.amplitudes()[index];
            (of_term(term, amplitude.name), amplitude.unit, false)
        }
        Quantity::Shape { term, index } => {
            let shape = point.terms[term].effect.shape()[index];
            (of_term(term, shape.name), shape.unit, false)
        }
    };
    let difference = now - then.unwrap_or(0.0);
    let sign = if inverse { -1.0 } else { 1.0 };
    let (read, scale) = if inverse {
        (f64::recip as fn(f64) -> f64, (now * then.unwrap_or(now)).recip())
    } else {
        ((|value| value) as fn(f64) -> f64, 1.0)
    };
    Compared {
        name,
        unit: unit.to_owned(),
        then: then.map(read),
        now: read(now),
        stderr: stderr.map(|stderr| scale * stderr),
        standard_errors: stderr.map(|stderr| sign * difference / stderr),
    }
}

/// Everything that is not named, each alone beside what is.
fn unchanged(later: &Later<'_>, then: &Point, known: &Baseline, found: &Found) -> Vec<Compared> {
    let hypothesis = &found.now.hypothesis;
    let channels = Channel::ALL.into_iter().map(Quantity::Channel);
    let base = parameters(&known.free).into_iter().map(Quantity::Base);
    let of_terms = known.of_terms.iter().map(|(quantity, _)| *quantity);
    let there = |quantity: &Quantity| match quantity {
        Quantity::Amplitude { term, .. } | Quantity::Shape { term, .. } => hypothesis.point.present[*term],
        Quantity::Base(_) | Quantity::Channel(_) => true,
    };
    channels
        .chain(base)
        .chain(of_terms)
        .filter(|quantity| hypothesis.moved().all(|(moved, _)| moved != *quantity) && there(quantity))
        .filter_map(|quantity| {
            let mut wide = hypothesis.clone();
            let change = Moved {
                subject: Subject::Channel(Channel::ForceZero),
                moved: vec![quantity],
                ranges: vec![(f64::NEG_INFINITY, f64::INFINITY)],
                brings: None,
            };
            wide.changes.insert(0, change);
            let (fit, _) = later.linear(&wide, found.weight, false)?;
            let stderr = fit.covariance[(0, 0)].sqrt();
            let was = quantity.of(then);
            (stderr > 0.0).then(|| compared(quantity, then, Some(was), was + fit.free[0], Some(stderr)))
        })
        .collect()
}
