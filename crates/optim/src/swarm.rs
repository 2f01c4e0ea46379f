//! Particle swarm over a box, with constriction.
//!
//! Every particle `x` remembers its best place `b`, the swarm the best of all `g`, and with `χ = 0.7298`,
//! `φ = 2.05`
//!
//! ```text
//! v ← χ [v + φ r₁ ∘ (b - x) + φ r₂ ∘ (g - x)],   x ← x + v,   r₁, r₂ uniform in [0, 1) per coordinate
//! ```
//!
//! Drawing `r` per coordinate favors the axes, so that a swarm crawls along a narrow valley that runs
//! askew to them; parameters of a force model make just such valleys. The caller may therefore hand in
//! *axes* in which the cost is nearly round, and velocities are mixed along those. The box stays a box in
//! the original coordinates: a particle that leaves it is put back on its wall and loses that part of
//! its velocity.
//!
//! Every particle draws from a PCG-64 stream of its own, so that the result depends on the seed alone.
//!
//! Source: Clerc and Kennedy (2002), "The particle swarm: explosion, stability, and convergence in a
//! multidimensional complex space", IEEE Trans. Evolutionary Computation 6(1), for the constriction;
//! Hansen, Ros, Mauny, Schoenauer and Auger (2011), "Impacts of invariance in search", Applied Soft
//! Computing 11(8), for what axes do to a swarm.

use std::ops::ControlFlow;

use rand::RngExt;
use rand_pcg::Pcg64;

/// Constriction coefficient for `φ = φ₁ + φ₂ = 4.1`.
const CONSTRICTION: f64 = 0.729_843_788_128_357_6;
/// Pull towards either best place.
const ATTRACTION: f64 = 2.05;

/// Size and seed of a swarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwarmOptions {
    /// Particles.
    pub n_particles: usize,
    /// Moves of every particle.
    pub n_iterations: usize,
    /// Seed of every random draw.
    pub seed: u64,
    /// Which of several swarms with the same seed this is.
    pub start: u64,
}

/// Coordinates in which the cost is nearly round: `x = A u`, with both directions of the map.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// `A`, `n × n`, row-major.
    pub from_round: Vec<f64>,
    /// `A⁻¹`, `n × n`, row-major.
    pub to_round: Vec<f64>,
}

/// What a swarm found.
#[derive(Debug, Clone, PartialEq)]
pub struct SwarmResult {
    /// Best place, inside the unit box.
    pub best: Vec<f64>,
    /// Cost there.
    pub best_cost: f64,
    /// Best cost after every iteration; the first entry belongs to the initial places.
    pub history: Vec<f64>,
}

/// Searches the unit box `[0, 1]ⁿ` for the lowest `cost`. `observe` sees the iteration and the best cost
/// so far, and may end the search early. A cost that is not finite counts as worse than any other.
pub fn minimize(
    n_parameters: usize,
    axes: Option<&Axes>,
    options: &SwarmOptions,
    cost: &mut dyn FnMut(&[f64]) -> f64,
    observe: &mut dyn FnMut(usize, f64) -> ControlFlow<()>,
) -> SwarmResult {
    let mut particles: Vec<Particle> = (0..options.n_particles.max(1))
        .map(|index| Particle::place(n_parameters, generator(options, index as u64), cost))
        .collect();
    let mut leader = leader_of(&particles);
    let (mut best, mut best_cost) = (particles[leader].best.clone(), particles[leader].best_cost);
    let mut history = vec![best_cost];
    let mut scratch = vec![0.0; 3 * n_parameters];
    for iteration in 1..=options.n_iterations {
        for particle in &mut particles {
            particle.advance(&best, axes, &mut scratch);
            particle.judge(cost);
        }
        leader = leader_of(&particles);
        if particles[leader].best_cost < best_cost {
            best_cost = particles[leader].best_cost;
            best.copy_from_slice(&particles[leader].best);
        }
        history.push(best_cost);
        if observe(iteration, best_cost).is_break() {
            break;
        }
    }
    SwarmResult { best, best_cost, history }
}

/// The stream of one particle. State and increment both differ between particles: PCG streams that share
/// a state are correlated.
fn generator(options: &SwarmOptions, index: u64) -> Pcg64 {
    let stream = (u128::from(options.start) << 64) | u128::from(index);
    let state = u128::from(options.seed).wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835)
        ^ stream.wrapping_mul(0xda94_2042_e4dd_58b5_2360_ed05_1fc6_5da5);
    Pcg64::new(state, stream)
}

fn leader_of(particles: &[Particle]) -> usize {
    let mut leader = 0;
    for (index, particle) in particles.iter().enumerate() {
        if particle.best_cost < particles[leader].best_cost {
            leader = index;
        }
    }
    leader
}

struct Particle {
    generator: Pcg64,
    place: Vec<f64>,
    velocity: Vec<f64>,
    best: Vec<f64>,
    best_cost: f64,
}

impl Particle {
    fn place(n_parameters: usize, mut generator: Pcg64, cost: &mut dyn FnMut(&[f64]) -> f64) -> Self {
        let place: Vec<f64> = (0..n_parameters).map(|_| generator.random()).collect();
        // Half the way to another random place: Clerc's initialization.
        let velocity = place.iter().map(|&x| 0.5 * (generator.random::<f64>() - x)).collect();
        let best = place.clone();
        let mut particle = Self { generator, place, velocity, best, best_cost: f64::INFINITY };
        particle.judge(cost);
        particle
    }

    fn judge(&mut self, cost: &mut dyn FnMut(&[f64]) -> f64) {
        let cost = cost(&self.place);
        if cost < self.best_cost {
            self.best_cost = cost;
            self.best.copy_from_slice(&self.place);
        }
    }

    fn advance(&mut self, swarm_best: &[f64], axes: Option<&Axes>, scratch: &mut [f64]) {
        let n = self.place.len();
        let (own, rest) = scratch.split_at_mut(n);
        let (social, pull) = rest.split_at_mut(n);
        for index in 0..n {
            own[index] = self.best[index] - self.place[index];
            social[index] = swarm_best[index] - self.place[index];
        }
        if let Some(axes) = axes {
            for (pull, map) in pull.iter_mut().zip(axes.to_round.chunks_exact(n)) {
                let (mut to_own, mut to_social) = (0.0, 0.0);
                for ((entry, own), social) in map.iter().zip(&*own).zip(&*social) {
                    to_own += entry * own;
                    to_social += entry * social;
                }
                *pull = self.pull(to_own, to_social);
            }
            for (velocity, map) in self.velocity.iter_mut().zip(axes.from_round.chunks_exact(n)) {
                let along: f64 = map.iter().zip(&*pull).map(|(entry, value)| entry * value).sum();
                *velocity = CONSTRICTION * (*velocity + along);
            }
        } else {
            for index in 0..n {
                let pull = self.pull(own[index], social[index]);
                self.velocity[index] = CONSTRICTION * (self.velocity[index] + pull);
            }
        }
        for index in 0..n {
            let target = self.place[index] + self.velocity[index];
            let inside = target.clamp(0.0, 1.0);
            if inside != target {
                self.velocity[index] = 0.0;
            }
            self.place[index] = inside;
        }
    }

    fn pull(&mut self, own: f64, social: f64) -> f64 {
        ATTRACTION * (self.generator.random::<f64>() * own + self.generator.random::<f64>() * social)
    }
}

#[cfg(test)]
mod tests;
