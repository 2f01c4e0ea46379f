//! The search: several swarms, each followed by a descent.

use std::ops::ControlFlow;

use pam_optim::polish::{Polished, Residuals, descend};
use pam_optim::swarm::{SwarmOptions, SwarmResult, minimize};
use rayon::prelude::*;

use crate::problem::ForceProblem;

/// Size of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FitOptions {
    /// Particles of each swarm.
    pub n_particles: usize,
    /// Most moves of each particle; where a descent follows, a swarm that no longer gains stops before.
    pub n_iterations: usize,
    /// Swarms.
    pub n_starts: usize,
    /// Seed of every random draw.
    pub seed: u64,
    /// Whether Levenberg–Marquardt follows.
    pub polish: bool,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self { n_particles: 60, n_iterations: 200, n_starts: 4, seed: 1, polish: true }
    }
}

/// One swarm and what followed it.
#[derive(Debug, Clone)]
pub struct Start {
    /// What the swarm found; its costs are mean squares, in N².
    pub swarm: SwarmResult,
    /// Where the descent ended; its cost is half a mean square.
    pub polished: Option<Polished>,
}

impl Start {
    /// Mean square at the end, in N².
    pub fn mean_square(&self) -> f64 {
        self.polished.as_ref().map_or(self.swarm.best_cost, |polished| 2.0 * polished.cost)
    }
}

/// Outcome of a search.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Best point of the unit box.
    pub x: Vec<f64>,
    /// Coordinates that press against the box.
    pub at_bound: Vec<bool>,
    /// Mean square there, in N².
    pub mean_square: f64,
    /// Whether the best start converged; a pure swarm never claims to.
    pub converged: bool,
    /// Every start, in order.
    pub starts: Vec<Start>,
}

/// Tells when a swarm that a descent follows has done its work: it has found the valley, and the descent finds its
/// bottom in a handful of steps.
struct Patience {
    /// No parameters do better than this.
    floor: f64,
    lowest_cost: f64,
    moves_since: usize,
}

impl Patience {
    /// Moves without a gain
    const MOVES: usize = 20;
    /// of this share of the cost.
    const GAIN: f64 = 1e-3;
    /// Cost over the floor at which no other valley can be deeper by more than a hundredth.
    const NEAR_FLOOR: f64 = 1.01;

    fn new(floor: f64) -> Self {
        Self { floor, lowest_cost: f64::INFINITY, moves_since: 0 }
    }

    /// Whether it ends after a move that left the best cost at `cost`.
    fn ends(&mut self, cost: f64) -> bool {
        if cost < (1.0 - Self::GAIN) * self.lowest_cost {
            (self.lowest_cost, self.moves_since) = (cost, 0);
        } else {
            self.moves_since += 1;
        }
        self.moves_since >= Self::MOVES || cost <= Self::NEAR_FLOOR * self.floor
    }
}

/// Searches the space of `problem`. Starts run in parallel, each with its own streams; `observe` is called for every
/// move of a swarm, and for those that a swarm does not make because it has settled.
pub fn search(problem: &ForceProblem<'_>, options: &FitOptions, observe: &(dyn Fn() + Sync)) -> Fit {
    let axes = problem.round_axes(&vec![0.5; problem.n_parameters()]);
    let starts: Vec<Start> = (0..options.n_starts.max(1) as u64)
        .into_par_iter()
        .map(|start| {
            let swarm_options = SwarmOptions {
                n_particles: options.n_particles,
                n_iterations: options.n_iterations,
                seed: options.seed,
                start,
            };
            let mut patience = Patience::new(problem.floor_mean_square());
            let swarm = minimize(
                problem.n_parameters(),
                axes.as_ref(),
                &swarm_options,
                &mut problem.mean_squares(),
                &mut |_, cost| {
                    observe();
                    if options.polish && patience.ends(cost) {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                },
            );
            // The moves that were not needed.
            (swarm.history.len()..=options.n_iterations).for_each(|_| observe());
            let polished = options.polish.then(|| descend(problem, &swarm.best));
            Start { swarm, polished }
        })
        .collect();
    let mut best = 0;
    for (index, start) in starts.iter().enumerate() {
        if start.mean_square() < starts[best].mean_square() {
            best = index;
        }
    }
    let winner = &starts[best];
    let (x, at_bound, converged) = match &winner.polished {
        Some(polished) => (polished.x.clone(), polished.at_bound.clone(), polished.termination.converged()),
        None => {
            let wall = |value: &f64| *value <= 0.0 || *value >= 1.0;
            (winner.swarm.best.clone(), winner.swarm.best.iter().map(wall).collect(), false)
        }
    };
    Fit { x, at_bound, mean_square: winner.mean_square(), converged, starts }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patience_outlasts_gains_and_ends_without_them() {
        let mut patience = Patience::new(0.0);
        // 1 % less with every tenth move.
        let cost = |index: i32| 0.99_f64.powi(index / 10);
        assert!((0..200).all(|index| !patience.ends(cost(index))));
        // Nine moves since the last gain.
        assert_eq!((1..).find(|_| patience.ends(cost(199))), Some(Patience::MOVES - 9));
    }

    #[test]
    fn patience_ends_where_nothing_can_be_gained() {
        let mut patience = Patience::new(0.5);
        assert!(!patience.ends(0.51));
        assert!(patience.ends(0.504));
    }
}
