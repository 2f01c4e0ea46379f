//! Which sentence foretells what was left out best: every word with a spline of few knots first, then the best with other curves
//! and better numbers.

use pam_muscle::effects::sentence::{Curve, Scale, Sentence};
use rayon::prelude::*;

use super::field::{Field, Products};
use super::lexicon::{knots, lexicon, stretched};
use crate::state::{Setting, State};

/// Knots of the first look.
const FIRST_KNOTS: usize = 6;
/// Knots of further looks at what has no memory: what acts in a small part of the range shows with many alone.
const FINE_KNOTS: [usize; 2] = [12, 24];
/// Knots that the best are tried with.
const KNOTS: [usize; 6] = [4, 6, 9, 14, 20, 30];
/// Sentences that are looked at again, each with another driver, memory or scale.
const LOOKED_AT_AGAIN: usize = 10;
/// Evidence that every degree of freedom has to bring.
const CHARGE: f64 = 0.15;
/// Evidence, and share of the evidence, that every step away from the plainest scale has to bring.
const SCALE_CHARGE: (f64, f64) = (0.15, 0.01);
/// Degrees of freedom of a curve that a person can say: a line, a saturation, a bump.
const PLAIN: usize = 3;
/// Share of the evidence of the best curve at which one of these is taken in its place; a further term has what it leaves.
const NEARLY: f64 = 0.85;
/// Rounds in which the numbers of a memory and of a bump are halved in on.
const ROUNDS: usize = 6;

/// A sentence with what it gains on held-out blocks.
#[derive(Debug, Clone)]
pub(super) struct Said {
    pub(super) sentence: Sentence,
    /// `Σ ln(without / with)` over held-out blocks, less what its degrees of freedom have to bring.
    pub(super) evidence: f64,
}

/// What a sentence that gains so much has to bring before it counts: the plainer of two that foretell as much is right.
fn charge(sentence: &Sentence, gained: f64) -> f64 {
    let freedom = (sentence.shape.n_parameters() + sentence.memory.n_parameters()) as f64;
    CHARGE * freedom + steps_from_plain(sentence.scale) * (SCALE_CHARGE.0 + SCALE_CHARGE.1 * gained.abs())
}

fn steps_from_plain(scale: Scale) -> f64 {
    match scale {
        Scale::One => 0.0,
        Scale::Direction | Scale::Contracting | Scale::Extending | Scale::Pressure => 1.0,
        Scale::Friction | Scale::GasForce | Scale::SlopeOverPressure | Scale::SlopeOverLength => 1.5,
        Scale::BladderForce => 3.0,
    }
}

impl Said {
    /// What its evidence was charged with.
    pub(super) fn charge(&self) -> f64 {
        charge(&self.sentence, self.evidence)
    }

    /// Whether `other` has the same driver, whatever it remembers of it.
    pub(super) fn has_driver_of(&self, other: &Self) -> bool {
        self.sentence.driver.name() == other.sentence.driver.name()
    }

    /// Whether `other` has the same driver and memory, whatever the numbers and the scale.
    pub(super) fn has_words_of(&self, other: &Self) -> bool {
        let words = |said: &Self| (said.sentence.driver.name(), said.sentence.memory.name());
        words(self) == words(other)
    }

    /// Whether `other` differs from it by numbers alone.
    pub(super) fn is_like(&self, other: &Sentence) -> bool {
        alike(&self.sentence, other)
    }
}

/// Whether two sentences have the same driver, memory and scale, whatever the numbers.
pub(super) fn alike(left: &Sentence, right: &Sentence) -> bool {
    left.driver.name() == right.driver.name() && left.memory.name() == right.memory.name() && left.scale == right.scale
}

/// The best sentences, each with another driver, memory or scale, best first.
pub(super) fn screen(field: &Field<'_>, setting: &Setting<'_>, state: &State) -> Vec<Said> {
    let first: Vec<Vec<Said>> = lexicon(setting, state)
        .into_par_iter()
        .map(|(driver, memory)| {
            let sentence = Sentence { driver, memory, scale: Scale::One, shape: Curve::Line, seen: [0.0, 1.0] };
            let arguments = field.arguments(&sentence);
            let sorted = field.sorted(&arguments);
            let fine: &[usize] = if memory.n_parameters() == 0 { &FINE_KNOTS } else { &[] };
            let numbers = std::iter::once(&FIRST_KNOTS).chain(fine);
            let mut of_scales: Vec<Vec<Said>> = vec![Vec::new(); Scale::ALL.len()];
            for shape in numbers.filter_map(|&n| spline(&sorted, n)) {
                let products = field.products_by(&arguments, &Scale::ALL, &shape);
                for ((scale, said), products) in Scale::ALL.into_iter().zip(&mut of_scales).zip(products) {
                    let sentence = Sentence { scale, shape: shape.clone(), ..sentence.clone() };
                    said.extend(products.and_then(|products| judged(field, &sentence, &arguments, &products)));
                }
            }
            of_scales.into_iter().filter_map(|said| best(said.into_iter())).collect()
        })
        .collect();
    let mut found: Vec<Said> = Vec::new();
    let mut all: Vec<Said> = first.into_iter().flatten().collect();
    all.sort_by(|left, right| right.evidence.total_cmp(&left.evidence));
    for said in all {
        if !found.iter().any(|known| known.is_like(&said.sentence)) {
            found.push(said);
        }
        if found.len() == LOOKED_AT_AGAIN {
            break;
        }
    }
    let mut again: Vec<Said> = found.into_par_iter().map(|said| bent(field, better_numbers(field, said))).collect();
    again.sort_by(|left, right| right.evidence.total_cmp(&left.evidence));
    again
}

fn best(said: impl Iterator<Item = Said>) -> Option<Said> {
    said.max_by(|left, right| left.evidence.total_cmp(&right.evidence))
}

fn spline(sorted: &[f64], n: usize) -> Option<Curve> {
    let knots = knots(sorted, n);
    (knots.len() > 2).then_some(Curve::Spline { knots })
}

/// `sentence` over `arguments`, judged, with the range that it is seen in.
fn said(field: &Field<'_>, sentence: &Sentence, arguments: &[f64]) -> Option<Said> {
    let products = field.products(arguments, sentence.scale, &sentence.shape)?;
    judged(field, sentence, arguments, &products)
}

fn judged(field: &Field<'_>, sentence: &Sentence, arguments: &[f64], products: &Products) -> Option<Said> {
    let held_out = field.held_out(products)?;
    let gained = field.nothing.log_ratio(&held_out);
    let evidence = gained - charge(sentence, gained);
    let (low, high) = arguments
        .iter()
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
    let sentence = Sentence { seen: [low, high], ..sentence.clone() };
    (low < high && evidence.is_finite()).then_some(Said { sentence, evidence })
}

/// The same with better numbers of its memory.
fn better_numbers(field: &Field<'_>, said_first: Said) -> Said {
    if said_first.sentence.memory.n_parameters() == 0 {
        return said_first;
    }
    let mut found = said_first;
    let mut factor = 1.6_f64;
    for _ in 0..ROUNDS {
        let tried = [factor, 1.0 / factor].into_iter().filter_map(|factor| {
            let memory = stretched(found.sentence.memory, factor);
            let sentence = Sentence { memory, ..found.sentence.clone() };
            let arguments = field.arguments(&sentence);
            let shape = spline(&field.sorted(&arguments), FIRST_KNOTS)?;
            said(field, &Sentence { shape, ..sentence }, &arguments)
        });
        if let Some(better) = best(tried).filter(|tried| tried.evidence > found.evidence) {
            found = better;
        } else {
            factor = factor.sqrt();
        }
    }
    found
}

/// The same with the curve that says most for its degrees of freedom.
fn bent(field: &Field<'_>, found: Said) -> Said {
    let sentence = found.sentence.clone();
    let arguments = field.arguments(&sentence);
    let sorted = field.sorted(&arguments);
    let try_curve = |shape: Curve| said(field, &Sentence { shape, ..sentence.clone() }, &arguments);
    let splines: Vec<Said> = KNOTS.iter().filter_map(|&n| try_curve(spline(&sorted, n)?)).collect();
    let finest = best(splines.iter().cloned()).unwrap_or_else(|| found.clone());
    let bump = bump(field, &finest, &arguments, &try_curve);
    let others = [try_curve(Curve::Line), saturation(&sorted, &try_curve), bump];
    let all: Vec<Said> =
        splines.into_iter().chain(others.into_iter().flatten()).chain(std::iter::once(found)).collect();
    let most = best(all.iter().cloned()).unwrap_or(finest);
    let is_plain = |said: &&Said| said.sentence.shape.n_parameters() <= PLAIN && said.evidence > NEARLY * most.evidence;
    best(all.iter().filter(is_plain).cloned()).unwrap_or(most)
}

fn saturation(sorted: &[f64], try_curve: &dyn Fn(Curve) -> Option<Said>) -> Option<Said> {
    let (&low, &high) = (sorted.first()?, sorted.last()?);
    let from = if low < 0.0 && high > 0.0 { 0.0 } else { low };
    let shares = [0.03, 0.1, 0.3, 1.0];
    best(shares.iter().filter_map(|share| try_curve(Curve::Saturation { from, over: share * (high - low) })))
}

/// A bump where `finest`, a spline, lies furthest from its mean.
fn bump(
    field: &Field<'_>,
    finest: &Said,
    arguments: &[f64],
    try_curve: &dyn Fn(Curve) -> Option<Said>,
) -> Option<Said> {
    let Sentence { scale, shape, .. } = &finest.sentence;
    let Curve::Spline { knots, .. } = shape else { return None };
    let values = field.amplitudes(&field.products(arguments, *scale, shape)?)?;
    let mut sorted = values.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted[sorted.len() / 2];
    let far = |index: &usize| (values[*index] - middle).abs();
    let at = (0..values.len()).max_by(|left, right| far(left).total_cmp(&far(right)))?;
    let span = knots[knots.len() - 1] - knots[0];
    let (mut center, mut step) = (knots[at], 0.5 * span / knots.len() as f64);
    let widths = [0.02, 0.05, 0.1, 0.2, 0.4];
    let mut found = best(widths.iter().filter_map(|share| try_curve(Curve::Bump { center, width: share * span })))?;
    let mut factor = 1.4_f64;
    for _ in 0..ROUNDS {
        let Curve::Bump { width, .. } = found.sentence.shape else { break };
        let near = [(center - step, width), (center + step, width), (center, width * factor), (center, width / factor)];
        let tried = near.into_iter().filter_map(|(center, width)| try_curve(Curve::Bump { center, width }));
        match best(tried).filter(|tried| tried.evidence > found.evidence) {
            Some(better) => {
                found = better;
                if let Curve::Bump { center: moved, .. } = found.sentence.shape {
                    center = moved;
                }
            }
            None => (step, factor) = (0.5 * step, factor.sqrt()),
        }
    }
    Some(found)
}
