//! What may have changed.

use pam_identification::search_space::Free;
use pam_muscle::effects::{CATALOGUE, Effect, Kind, Role, Seen, Term};
use pam_muscle::force::Parameter;

use super::hypothesis::{Change, Hypothesis, Subject};
use super::point::Point;
use super::quantity::{Channel, Quantity};
use crate::hypothesis::{Beginning, CandidateEffect, Sign};

/// Factors to a shape of then that a later one is looked for at first.
const OTHER_SHAPES: [f64; 6] = [0.25, 0.5, 0.75, 1.33, 2.0, 4.0];

impl Subject {
    /// Id in artifacts.
    pub(crate) fn id(self, point: &Point) -> String {
        match self {
            Self::Channel(channel) => channel.id().to_owned(),
            Self::Base(free) => free.name().to_owned(),
            Self::Known(term) | Self::Gone(term) => point.terms[term].effect.page().id.to_owned(),
            Self::New(_, effect) => effect.page().id.to_owned(),
        }
    }

    /// Share of its evidence that it keeps beside others that explain as much: what hardly ever changes is the last to be named.
    pub(crate) fn plausibility(self) -> f64 {
        match self {
            Self::Base(Free::One(Parameter::K2 | Parameter::StrandCompliance)) => 0.9,
            Self::New(..) => 0.97,
            Self::Channel(_) | Self::Base(_) | Self::Known(_) | Self::Gone(_) => 1.0,
        }
    }

    /// Whether both are about the same thing.
    pub(crate) fn is(self, other: Self) -> bool {
        match (self, other) {
            (Self::Channel(left), Self::Channel(right)) => left == right,
            (Self::Base(left), Self::Base(right)) => left == right,
            (Self::Known(left) | Self::Gone(left), Self::Known(right) | Self::Gone(right)) => left == right,
            (Self::New(_, left), Self::New(_, right)) => left.page().id == right.page().id,
            _ => false,
        }
    }
}

/// Everything that may have changed beside `hypothesis`, each in several variants; `free` are the base parameters that were
/// free then, and `n_then` the effects of then.
pub(crate) fn variants(
    hypothesis: &Hypothesis,
    free: &[Free],
    n_then: usize,
    seen: &Seen,
    excluded: &[String],
) -> Vec<(Subject, Hypothesis)> {
    let mut all = Vec::new();
    let mut add = |subject: Subject, point: Point, moved: Vec<Quantity>, ranges: Vec<(f64, f64)>, brings| {
        if hypothesis.changes.iter().any(|change| change.subject.is(subject)) || excluded.contains(&subject.id(&point))
        {
            return;
        }
        let mut next = Hypothesis { point, changes: hypothesis.changes.clone() };
        next.changes.push(Change { subject, moved, ranges, brings });
        all.push((subject, next));
    };
    let point = &hypothesis.point;
    for channel in Channel::ALL {
        let quantity = Quantity::Channel(channel);
        add(Subject::Channel(channel), point.clone(), vec![quantity], vec![quantity.range(point)], None);
    }
    for free in parameters(free) {
        let quantity = Quantity::Base(free);
        add(Subject::Base(free), point.clone(), vec![quantity], vec![quantity.range(point)], None);
    }
    let named = |effect: &dyn Effect| CATALOGUE.iter().any(|known| known.page().id == effect.page().id);
    for (index, term) in point.terms[..n_then].iter().enumerate().filter(|(_, term)| named(term.effect)) {
        let moved: Vec<Quantity> =
            (0..term.amplitudes.len()).map(|at| Quantity::Amplitude { term: index, index: at }).collect();
        let ranges: Vec<(f64, f64)> = moved.iter().map(|quantity| quantity.range(point)).collect();
        if moved.is_empty() {
            add(Subject::Gone(index), point.clone().without(index), Vec::new(), Vec::new(), None);
        } else {
            add(Subject::Known(index), point.clone(), moved.clone(), ranges.clone(), None);
        }
        for (at, shape) in term.effect.shape().iter().enumerate() {
            for factor in OTHER_SHAPES {
                let mut other = point.clone();
                let value = (factor * term.shape[at]).clamp(shape.range.0, shape.range.1);
                other.terms[index].shape[at] = value;
                if value != term.shape[at] {
                    add(Subject::Known(index), other, moved.clone(), ranges.clone(), None);
                }
            }
        }
    }
    let is_new = |effect: &&&'static dyn Effect| {
        effect.kind() != Kind::Event && point.terms.iter().all(|term| term.effect.page().id != effect.page().id)
    };
    for &effect in CATALOGUE.iter().filter(is_new) {
        let term = point.terms.len();
        for shape in effect.first_shapes(seen) {
            for &sign in CandidateEffect::signs(effect) {
                // What was there before the change is not known to be rested.
                for carried in [false, true].into_iter().take(1 + usize::from(effect.outlasts())) {
                    let beginning = if carried { Beginning::Own } else { Beginning::Fresh };
                    let guess = CandidateEffect { effect, shape: shape.clone(), sign, beginning };
                    let (moved, ranges) = amplitudes(&guess, term);
                    let values = ranges.iter().map(|(low, high)| 0.0_f64.clamp(*low, *high)).collect();
                    let with = point.clone().with(Term::new(effect, shape.clone(), values));
                    add(Subject::New(term, effect), with, moved, ranges, carried.then_some(term));
                }
            }
        }
    }
    all
}

/// Base parameters that may change, where those in `free` were free. The constant of eq. 11 is what the load cell's zero is, and
/// rubber that gets softer does so in both of its coefficients.
pub(crate) fn parameters(free: &[Free]) -> Vec<Free> {
    let bladder = [Parameter::C10, Parameter::C01].map(Free::One);
    let both = bladder.iter().all(|one| free.contains(one));
    let own = free.iter().copied().filter(|one| *one != Free::One(Parameter::K3) && !(both && bladder.contains(one)));
    own.chain(both.then_some(Free::BladderSum)).collect()
}

fn amplitudes(guess: &CandidateEffect, term: usize) -> (Vec<Quantity>, Vec<(f64, f64)>) {
    let moved = (0..guess.amplitudes().len()).map(|index| Quantity::Amplitude { term, index }).collect();
    debug_assert!(guess.effect.role() == Role::Pulls || guess.amplitudes().is_empty());
    debug_assert!(guess.sign == Sign::Any || guess.effect.has_one_sign());
    (moved, guess.ranges().collect())
}

/// The same with the shapes of its last change a little larger and smaller, one after the other.
pub(crate) fn nearby(hypothesis: &Hypothesis, factor: f64) -> Vec<Hypothesis> {
    let term = match hypothesis.changes.last().map(|change| change.subject) {
        Some(Subject::Known(term) | Subject::New(term, _)) => term,
        _ => return Vec::new(),
    };
    let shapes = hypothesis.point.terms[term].effect.shape();
    let mut all = Vec::new();
    for (index, shape) in shapes.iter().enumerate() {
        for factor in [factor, 1.0 / factor] {
            let mut next = hypothesis.clone();
            let value = &mut next.point.terms[term].shape[index];
            let was = *value;
            *value = (factor * was).clamp(shape.range.0, shape.range.1);
            if *value != was {
                all.push(next);
            }
        }
    }
    all
}
