//! The search: what explains the most is taken, until nothing more is gained.

use pam_identification::search_space::Free;
use pam_muscle::effects::Seen;
use rayon::prelude::*;

use super::candidate::{nearby, variants};
use super::hypothesis::{Hypothesis, Later, Settled, Subject};
use super::point::Point;
use crate::joint::HeldOut;
use crate::trial::is_degenerate;
use crate::uncertainty::correlated;

/// `Σ ln(without / with)` over blocks left out of the fit that a change must reach.
const LEAST_LOG_RATIO: f64 = 3.0;
/// The same for a further one.
const FURTHER_LOG_RATIO: f64 = 4.0;
/// Fall of `Σ residual² / variance` over independent instants that it must reach: five standard errors of one number.
const LEAST_CHI_SQUARE: f64 = 25.0;
/// Share of what the sensors leave (mean squares) that it must explain.
const LEAST_OF_FLOOR: f64 = 0.05;
/// Share of what the model of then missed of its own recordings (mean squares) that a static change must explain, beside a static map
/// as large; others must explain all of it.
const OF_MISSED_STATIC: f64 = 0.25;
/// Share of the evidence of what was named that another one reaches at least where these recordings cannot tell the two; beside
/// that it must fit as well, but for chance.
const RIVAL: f64 = 0.7;
/// Subjects whose shapes are refined.
const REFINED: usize = 8;
/// Factors by which shapes are refined, one after the other.
const FACTORS: [f64; 5] = [1.6, 1.3, 1.15, 1.07, 1.03];
/// Share of its evidence that a change keeps whose effect is at an end of the range of its shape.
const DEGENERATE: f64 = 0.2;
/// Share of its evidence that a change loses for each number beyond the first.
const FREEDOM: f64 = 0.02;

/// What the search goes by.
#[derive(Debug)]
pub(crate) struct Bounds<'a> {
    /// Base parameters that were free then.
    pub free: &'a [Free],
    /// Effects of then.
    pub n_then: usize,
    /// What the recordings cover.
    pub seen: Seen,
    /// Ids that are not considered.
    pub excluded: &'a [String],
    /// Most changes that may be named.
    pub most: usize,
    /// What the sensors leave, in N.
    pub floor_n: f64,
    /// How much the model of then missed its own recordings by beyond their noise, in N.
    pub missed_n: f64,
}

/// A candidate beside what was taken.
#[derive(Clone)]
pub(crate) struct Trial {
    pub subject: Subject,
    pub hypothesis: Hypothesis,
    pub held_out: HeldOut,
    /// With all charges.
    pub evidence: f64,
}

/// What was found.
pub(crate) struct Found {
    /// Nothing changed.
    pub then: Settled,
    /// What has.
    pub now: Settled,
    /// Every candidate alone, the best first.
    pub first: Vec<Trial>,
    /// For each change what is left without it, and ids of those that cannot be told from it.
    pub without: Vec<(HeldOut, Vec<String>)>,
    /// Variance of the residual times the instants that share one, in N².
    pub weight: f64,
}

impl Later<'_> {
    /// Searches, from the model of `then`.
    pub(crate) fn search(&self, then: &Point, bounds: &Bounds<'_>) -> Option<Found> {
        let nothing = Hypothesis { point: then.clone(), changes: Vec::new() };
        let (start, mut weight) = self.settle_downwards(nothing)?;
        let mut best = start.clone();
        let mut first: Vec<Trial> = Vec::new();
        while best.hypothesis.changes.len() < bounds.most {
            let trials = self.trials(&best, bounds, weight, None);
            if first.is_empty() {
                first.clone_from(&trials);
            }
            let worthy = trials.iter().filter(|trial| is_worth(trial, &best, bounds));
            let Some(next) = worthy.take(3).find_map(|trial| self.taken(trial, &best, weight)) else { break };
            (best, weight) = next;
        }
        let mut index = 0;
        while index < best.hypothesis.changes.len() {
            let rest = self.settle(without(&best.hypothesis, index, then), weight)?;
            if self.chi_square(&rest, &best, weight) < LEAST_CHI_SQUARE {
                best = rest;
                index = 0;
            } else {
                index += 1;
            }
        }
        let without = (0..best.hypothesis.changes.len())
            .map(|index| {
                let (rest, its_weight) = self.settle_downwards(without(&best.hypothesis, index, then))?;
                let rivals = self.rivals(&rest, &best, index, &first, bounds, (its_weight, weight));
                Some((rest.held_out, rivals))
            })
            .collect::<Option<Vec<_>>>()?;
        Some(Found { then: start, now: best, first, without, weight })
    }

    /// Variance of what is left times the instants that share one.
    fn weight(&self, settled: &Settled) -> f64 {
        let force_n = settled.hypothesis.point.force_n(self.track);
        let nuisance_n = self.rows.force_n(&settled.fit.nuisances);
        let left_n: Vec<f64> =
            (0..self.track.n()).map(|at| self.measured_n[at] - force_n[at] - nuisance_n[at]).collect();
        settled.fit.mean_square.max(1e-12) * correlated(self.track, &left_n)
    }

    /// `hypothesis` fitted, and the weight of what it leaves. Where a change is left, nuisances that are free enough take some
    /// of it, the weight falls, and they take more: so the weight comes down from one under which they take nothing.
    fn settle_downwards(&self, hypothesis: Hypothesis) -> Option<(Settled, f64)> {
        let mut weight = self.measured_n.iter().map(|force_n| force_n * force_n).sum::<f64>().max(1.0);
        for _ in 0..2 {
            weight = self.weight(&self.settle(hypothesis.clone(), weight)?);
        }
        Some((self.settle(hypothesis, weight)?, weight))
    }

    /// Fall of `Σ residual² / variance` over independent instants, priors counted, from `without` to `with`.
    fn chi_square(&self, without: &Settled, with: &Settled, weight: f64) -> f64 {
        self.rows.n() as f64 * (without.fit.cost - with.fit.cost) / weight
    }

    /// Every subject that `only` lets through beside `best`, in its best variant; the most convincing first.
    fn trials(&self, best: &Settled, bounds: &Bounds<'_>, weight: f64, only: Option<&[Subject]>) -> Vec<Trial> {
        let wanted = |subject: Subject| only.is_none_or(|only| only.iter().any(|other| other.is(subject)));
        let all: Vec<(Subject, Hypothesis)> =
            variants(&best.hypothesis, bounds.free, bounds.n_then, &bounds.seen, bounds.excluded)
                .into_iter()
                .filter(|(subject, _)| wanted(*subject))
                .collect();
        let cost = |hypothesis: &Hypothesis| Some(self.linear(hypothesis, weight, false)?.0.cost);
        let costs: Vec<Option<f64>> = all.par_iter().map(|(_, hypothesis)| cost(hypothesis)).collect();
        let mut chosen: Vec<(f64, Subject, Hypothesis)> = Vec::new();
        for ((subject, hypothesis), cost) in all.into_iter().zip(costs) {
            let Some(cost) = cost.filter(|cost| cost.is_finite()) else { continue };
            match chosen.iter_mut().find(|(_, other, _)| other.is(subject)) {
                Some(slot) if slot.0 > cost => *slot = (cost, subject, hypothesis),
                Some(_) => {}
                None => chosen.push((cost, subject, hypothesis)),
            }
        }
        chosen.sort_by(|left, right| left.0.total_cmp(&right.0));
        let refined = chosen.into_par_iter().enumerate().filter_map(|(rank, (mut cost_here, subject, mut here))| {
            for factor in FACTORS.into_iter().filter(|_| rank < REFINED) {
                for next in nearby(&here, factor) {
                    if let Some(cost) = cost(&next)
                        && cost < cost_here
                    {
                        (cost_here, here) = (cost, next);
                    }
                }
            }
            let (_, held_out) = self.linear(&here, weight, true)?;
            let held_out = held_out?;
            let evidence = best.held_out.log_ratio(&held_out) * charge(subject, &here, self.track.recordings.len());
            Some(Trial { subject, hypothesis: here, held_out, evidence })
        });
        let mut trials: Vec<Trial> = refined.collect();
        trials.sort_by(|left, right| right.evidence.total_cmp(&left.evidence));
        trials
    }

    /// `trial` with its numbers where they fit best, and the weight of what it leaves; none where that gains too little beside
    /// `best`. What is left without it is as large and as slow as the change itself, and no measure of chance.
    fn taken(&self, trial: &Trial, best: &Settled, weight: f64) -> Option<(Settled, f64)> {
        let settled = self.settle(trial.hypothesis.clone(), weight)?;
        let weight = self.weight(&settled);
        let settled = self.settle(settled.hypothesis, weight)?;
        let gains = best.held_out.log_ratio(&settled.held_out) > LEAST_LOG_RATIO;
        (gains && self.chi_square(best, &settled, weight) > LEAST_CHI_SQUARE).then_some((settled, weight))
    }

    /// Ids of what explains nearly as much in the place of change `index` of `best`; `rest` is without it.
    fn rivals(
        &self,
        rest: &Settled,
        best: &Settled,
        index: usize,
        first: &[Trial],
        bounds: &Bounds<'_>,
        (its_weight, weight): (f64, f64),
    ) -> Vec<String> {
        let own = rest.held_out.log_ratio(&best.held_out);
        let named = best.hypothesis.changes[index].subject;
        let highest = first.first().map_or(0.0, |trial| trial.evidence);
        let promising: Vec<Subject> = first
            .iter()
            .filter(|trial| trial.evidence > 0.3 * highest.min(own) && !trial.subject.is(named))
            .map(|trial| trial.subject)
            .collect();
        let trials = self.trials(rest, bounds, its_weight, Some(&promising));
        trials
            .iter()
            .filter(|trial| trial.evidence > RIVAL * own)
            .filter(|trial| {
                let settled = self.settle(trial.hypothesis.clone(), weight);
                settled.is_some_and(|settled| self.chi_square(&settled, best, weight) < LEAST_CHI_SQUARE)
            })
            .map(|trial| trial.subject.id(&trial.hypothesis.point))
            .collect()
    }
}

/// `hypothesis` without change `index`.
fn without(hypothesis: &Hypothesis, index: usize, then: &Point) -> Hypothesis {
    let mut rest = hypothesis.clone();
    let change = rest.changes.remove(index);
    for quantity in change.moved.into_iter().filter(|_| !matches!(change.subject, Subject::New(..))) {
        quantity.set(&mut rest.point, quantity.of(then));
    }
    match change.subject {
        Subject::New(term, _) => rest.point.present[term] = false,
        Subject::Gone(term) => rest.point.present[term] = true,
        Subject::Known(term) => rest.point.terms[term].shape.clone_from(&then.terms[term].shape),
        Subject::Channel(_) | Subject::Base(_) => {}
    }
    rest
}

/// Whether a trial gains more than chance and more than what does not matter.
fn is_worth(trial: &Trial, best: &Settled, bounds: &Bounds<'_>) -> bool {
    let least = if best.hypothesis.changes.is_empty() { LEAST_LOG_RATIO } else { FURTHER_LOG_RATIO };
    let gained = best.held_out.mean_square() - trial.held_out.mean_square();
    // What went without a name then may be what shows now.
    let missed = match trial.subject {
        Subject::Channel(_) | Subject::Base(_) => OF_MISSED_STATIC,
        Subject::Known(_) | Subject::Gone(_) | Subject::New(..) => 1.0,
    };
    let least_gained = (LEAST_OF_FLOOR * bounds.floor_n.powi(2)).max(missed * bounds.missed_n.powi(2));
    trial.evidence > least && gained > least_gained
}

/// Share of its evidence that a change keeps.
fn charge(subject: Subject, hypothesis: &Hypothesis, n_recordings: usize) -> f64 {
    let Some(change) = hypothesis.changes.last() else { return 1.0 };
    let mut n = change.moved.len() + change.brings.map_or(0, |_| n_recordings);
    let mut degenerate = 1.0;
    if let Subject::New(term, effect) = subject {
        n += effect.shape().len();
        if is_degenerate(effect, &hypothesis.point.terms[term].shape) {
            degenerate = DEGENERATE;
        }
    }
    degenerate * subject.plausibility() * (1.0 - FREEDOM * n.saturating_sub(1) as f64).max(0.1)
}
