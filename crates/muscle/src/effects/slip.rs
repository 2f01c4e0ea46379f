//! Maxwell slip: friction that remembers where it turned.
//!
//! Springs in parallel, each of which slips at its own force. In units of the full force
//!
//! ```text
//! z_i ← clamp(z_i + Δx / r_i, -1, 1),   z = Σ w_i z_i
//! ```
//!
//! with the distances `r_i` after which an element slips. Unlike a differential law (Dahl, Bouc–Wen) it has exact
//! return-point memory: noise around a resting point changes nothing.
//!
//! Source: Al-Bender, Lampaert and Swevers (2005), "The generalized Maxwell-slip model", IEEE Trans.
//! Automatic Control 50(11).

use super::Moment;

/// Slip distances of the elements in units of the characteristic distance: one decade and a half.
const DISTANCES: [f64; 6] = [0.15, 0.35, 0.7, 1.3, 2.3, 4.5];
/// Weights that make the virgin curve `1 - exp(-x/δ)` at those distances, nearly.
const WEIGHTS: [f64; 6] = [0.14, 0.17, 0.22, 0.21, 0.17, 0.09];

/// Elements in parallel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    distance: f64,
    states: [f64; 6],
    last: f64,
}

impl Slip {
    /// All elements slipped in `direction` at `position`; `distance` is the characteristic distance, in the unit of
    /// the position.
    pub fn settled(distance: f64, position: f64, direction: f64) -> Self {
        Self { distance, states: [direction; 6], last: position }
    }

    /// Turns every element over by `by`, wherever it is: something else than travel moves them.
    fn turn(&mut self, by: f64) {
        self.states.iter_mut().for_each(|state| *state = (*state + by).clamp(-1.0, 1.0));
    }

    /// Moves to `position`; the share of the full force, in [-1, 1].
    pub fn move_to(&mut self, position: f64) -> f64 {
        let step = (position - self.last) / self.distance;
        self.last = position;
        let mut sum = 0.0;
        for ((state, distance), weight) in self.states.iter_mut().zip(DISTANCES).zip(WEIGHTS) {
            *state = (*state + step / distance).clamp(-1.0, 1.0);
            sum += weight * *state;
        }
        sum
    }
}

/// Slip along the recordings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Follower {
    distance: f64,
    /// The recording it is in.
    slip: Option<(usize, Slip)>,
}

impl Follower {
    /// With the characteristic distance.
    pub(super) fn new(distance: f64) -> Self {
        Self { distance, slip: None }
    }

    /// Turns every element over by `by`, from -1 to 1 by 2, in the recording that it is in.
    pub(super) fn turn(&mut self, now: &Moment, by: f64) {
        if let Some((recording, slip)) = &mut self.slip
            && *recording == now.recording
        {
            slip.turn(by);
        }
    }

    /// The share of the full force, in [-1, 1], where `position` has been reached `now`. The muscle came
    /// in `direction`, or from nowhere in particular; a gap in a recording is crossed straight.
    pub(super) fn follow(&mut self, now: &Moment, position: f64, direction: f64) -> f64 {
        let mut slip = match self.slip {
            Some((recording, slip)) if recording == now.recording => slip,
            _ => Slip::settled(self.distance, position, if now.came { direction } else { 0.0 }),
        };
        let share = slip.move_to(position);
        self.slip = Some((now.recording, slip));
        share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_share_the_whole() {
        assert!((WEIGHTS.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_loop_that_returns_closes_where_it_began() {
        let mut slip = Slip::settled(1e-3, 0.0, 0.0);
        let before = slip.move_to(2e-3);
        slip.move_to(1.2e-3);
        slip.move_to(1.7e-3);
        let after = slip.move_to(2e-3);
        assert!((before - after).abs() < 1e-12);
    }

    #[test]
    fn far_travel_slips_everything() {
        let mut slip = Slip::settled(1e-3, 0.0, -1.0);
        assert!((slip.move_to(2e-2) - 1.0).abs() < 1e-12);
    }
}
