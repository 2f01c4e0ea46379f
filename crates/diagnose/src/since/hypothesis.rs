//! What is said to have changed, and its fit.

use pam_identification::search_space::Free;
use pam_muscle::effects::Effect;

use super::nuisances::{by_recording, slope_n};
use super::point::Point;
use super::quantity::{Channel, Quantity};
use super::rows::{Fit, Rows};
use crate::joint::HeldOut;
use crate::track::Track;

/// What has changed.
#[derive(Clone, Copy)]
pub(crate) enum Subject {
    /// Zero or gain of a channel.
    Channel(Channel),
    /// A base parameter.
    Base(Free),
    /// Size or shape of an effect that was there.
    Known(usize),
    /// An effect that was there and is no longer.
    Gone(usize),
    /// An effect that was not there; its place among the terms.
    New(usize, &'static dyn Effect),
}

/// A change with the numbers that it moves.
#[derive(Clone)]
pub(crate) struct Change {
    pub subject: Subject,
    /// Numbers that the fit moves.
    pub moved: Vec<Quantity>,
    /// Lowest and highest value of each.
    pub ranges: Vec<(f64, f64)>,
    /// Effect that brings a memory of its own into every recording.
    pub brings: Option<usize>,
}

/// The model of then with what has changed.
#[derive(Clone)]
pub(crate) struct Hypothesis {
    pub point: Point,
    pub changes: Vec<Change>,
}

/// A hypothesis with its fit.
#[derive(Clone)]
pub(crate) struct Settled {
    pub hypothesis: Hypothesis,
    pub fit: Fit,
    pub held_out: HeldOut,
}

/// What hypotheses are fitted to.
#[derive(Debug)]
pub(crate) struct Later<'a> {
    pub track: &'a Track,
    pub rows: Rows<'a>,
    /// Force as recorded, in N.
    pub measured_n: Vec<f64>,
}

/// Steps of a fit, at most.
const STEPS: usize = 12;
/// Share of the cost below which a step is the last one.
const SETTLED: f64 = 1e-7;

impl Hypothesis {
    /// Numbers that move, with their ranges.
    pub(crate) fn moved(&self) -> impl Iterator<Item = (Quantity, (f64, f64))> + '_ {
        self.changes.iter().flat_map(|change| change.moved.iter().copied().zip(change.ranges.iter().copied()))
    }

    fn brought(&self, track: &Track) -> Vec<Vec<f64>> {
        let brings = self.changes.iter().filter_map(|change| change.brings);
        brings
            .flat_map(|term| {
                let mut point = self.point.clone();
                // Of a size that is not nothing; the fit finds how much of it there is.
                for (index, amplitude) in point.terms[term].effect.amplitudes().iter().enumerate() {
                    let (low, high) = amplitude.range;
                    point.terms[term].amplitudes[index] = 0.1 * if high > 0.0 { high.min(1e9) } else { low.max(-1e9) };
                }
                by_recording(&point.brought_by_n(term, track), track).collect::<Vec<_>>()
            })
            .collect()
    }
}

impl Later<'_> {
    fn left_n(&self, force_n: &[f64]) -> Vec<f64> {
        self.measured_n.iter().zip(force_n).map(|(measured_n, force_n)| measured_n - force_n).collect()
    }

    /// One linear fit around the values that `hypothesis` has; what would leave its range is held. With the mean squares of
    /// blocks left out where `judge` asks for them.
    pub(crate) fn linear(&self, hypothesis: &Hypothesis, weight: f64, judge: bool) -> Option<(Fit, Option<HeldOut>)> {
        let force_n = hypothesis.point.force_n(self.track);
        let slope = |(quantity, _)| slope_n(&hypothesis.point, quantity, &force_n, self.track);
        let mut columns: Vec<Vec<f64>> = hypothesis.moved().map(slope).collect();
        columns.extend(hypothesis.brought(self.track));
        let sums = self.rows.sums(&columns, &self.left_n(&force_n))?;
        let mut held = vec![false; columns.len()];
        loop {
            let fit = sums.fit(weight, &held)?;
            let mut leaves = hypothesis.moved().enumerate().map(|(index, (quantity, (low, high)))| {
                let (value, slack) = (quantity.of(&hypothesis.point), 1e-9 * (high - low));
                let next = value + fit.free[index];
                // A step that ends beyond is cut short; one that cannot begin is none.
                let stuck = (next < low && value <= low + slack) || (next > high && value >= high - slack);
                stuck && !held[index]
            });
            match leaves.position(|leaves| leaves) {
                Some(index) => held[index] = true,
                None => {
                    let held_out = if judge { Some(sums.hold_out(weight, &held)?) } else { None };
                    return Some((fit, held_out));
                }
            }
        }
    }

    /// Cost of `hypothesis` with the values that it has, nuisances fitted.
    fn cost(&self, hypothesis: &Hypothesis, weight: f64) -> Option<f64> {
        let force_n = hypothesis.point.force_n(self.track);
        let brought = hypothesis.brought(self.track);
        let sums = self.rows.sums(&brought, &self.left_n(&force_n))?;
        Some(sums.fit(weight, &vec![false; brought.len()])?.cost)
    }

    /// Moves the numbers of `hypothesis` to where they fit best.
    pub(crate) fn settle(&self, mut hypothesis: Hypothesis, weight: f64) -> Option<Settled> {
        let mut cost = self.cost(&hypothesis, weight)?;
        for _ in 0..STEPS {
            let (fit, _) = self.linear(&hypothesis, weight, false)?;
            let better = [1.0, 0.5, 0.25, 0.06].into_iter().find_map(|share| {
                let mut next = hypothesis.clone();
                for (index, (quantity, (low, high))) in hypothesis.moved().enumerate() {
                    let value = quantity.of(&hypothesis.point) + share * fit.free[index];
                    quantity.set(&mut next.point, value.clamp(low, high));
                }
                let next_cost = self.cost(&next, weight)?;
                (next_cost < cost).then_some((next, next_cost))
            });
            let Some((next, next_cost)) = better else { break };
            hypothesis = next;
            let gained = (cost - next_cost) / cost.max(f64::MIN_POSITIVE);
            cost = next_cost;
            if gained < SETTLED {
                break;
            }
        }
        let (fit, held_out) = self.linear(&hypothesis, weight, true)?;
        Some(Settled { hypothesis, fit, held_out: held_out? })
    }
}
