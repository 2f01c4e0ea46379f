//! The inverse by root finding: the reference that a network is compared with.
//!
//! ```text
//! p with F(p, L, s) = F,   p in the branch that rises at (L, s)
//! ```
//!
//! `F` is the settled force: eq. 11, and of effects beyond it those of the muscle, as they are where it has long been
//! and where it came slowly.
//!
//! # Design
//! Whether the force rises everywhere is settled once, over the whole operating range with a margin for what lies between the
//! cells; then a query costs a handful of evaluations of the model. Otherwise every query searches its branch,
//! which costs about 150.

use pam_artifact::inverse::{InverseDomain, Reach};
use pam_muscle::effects::AugmentedModel;

use crate::branch::{longest, rising, slope_n_per_pa};
use crate::domain::InverseBox;
use crate::root::root;

/// Precision of a pressure, as a share of the range of pressure.
const PRECISION: f64 = 1e-11;
/// Lengths at which the reach is written down.
const N_REACH: usize = 65;
/// Cells per coordinate of the search for places where the force does not rise.
const CELLS: usize = 24;
/// By how much the slope must exceed the threshold for cells to vouch for what lies between them.
const MARGIN: f64 = 1.2;
/// Beyond this share of the range, a length or a force is outside and not merely rounded.
const SLACK: f64 = 1e-9;

/// Pressures and forces that belong to each other, both rising.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branch {
    /// Lowest and highest pressure, in Pa.
    pub pressure_pa: [f64; 2],
    /// Lowest and highest force, in N.
    pub force_n: [f64; 2],
}

/// Why no pressure gives a force.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoInverse {
    /// The length is outside the domain, or no number.
    #[error("length {:.2} mm is outside {:.2} to {:.2} mm", length_m * 1e3, range_m[0] * 1e3, range_m[1] * 1e3)]
    Length {
        /// Length asked for, in m.
        length_m: f64,
        /// Shortest and longest, in m.
        range_m: [f64; 2],
    },
    /// The direction is not between -1 and +1.
    #[error("direction {direction} is outside -1 to 1")]
    Direction {
        /// Direction asked for.
        direction: f64,
    },
    /// No pressure of the domain gives the force.
    #[error("force {force_n:.1} N is outside {:.1} to {:.1} N at {:.2} mm", range_n[0], range_n[1], length_m * 1e3)]
    Force {
        /// Force asked for, in N.
        force_n: f64,
        /// What the pressures of the domain give, in N.
        range_n: [f64; 2],
        /// Length, in m.
        length_m: f64,
    },
    /// The force grows too little with the pressure at any pressure of the domain.
    #[error("at {:.2} mm force does not grow with pressure", length_m * 1e3)]
    Flat {
        /// Length, in m.
        length_m: f64,
    },
}

/// The inverse of a muscle's settled force, by root finding on it.
#[derive(Debug, Clone)]
pub struct ExactInverse {
    model: AugmentedModel,
    inverse_box: InverseBox,
    min_slope_n_per_pa: f64,
    rises_everywhere: bool,
}

impl ExactInverse {
    /// The inverse of `model` inside an operating range, without its instruments, fixture and events; `min_slope_share` is the slope below which there is none, as a share
    /// of the range of force over the range of pressure.
    pub fn new(model: impl Into<AugmentedModel>, inverse_box: InverseBox, min_slope_share: f64) -> Self {
        let model = model.into().of_the_muscle();
        let min_slope_n_per_pa = min_slope_share * inverse_box.force_span_n() / inverse_box.pressure_span_pa();
        let mut inverse = Self { model, inverse_box, min_slope_n_per_pa, rises_everywhere: false };
        inverse.rises_everywhere = inverse.smallest_slope_n_per_pa() >= MARGIN * min_slope_n_per_pa;
        inverse
    }

    /// The smallest slope on a grid over the operating range, in N/Pa; negative infinity where a force is not finite.
    fn smallest_slope_n_per_pa(&self) -> f64 {
        let span_pa = self.inverse_box.pressure_span_pa();
        let share = |cell: usize| cell as f64 / CELLS as f64;
        let mut smallest = f64::INFINITY;
        for direction in [-1.0, 1.0] {
            for column in 0..=CELLS {
                let length_m = self.inverse_box.length_m[0] + share(column) * self.inverse_box.length_span_m();
                for row in 0..=CELLS {
                    let pressure_pa = self.inverse_box.pressure_pa[0] + share(row) * span_pa;
                    let slope = slope_n_per_pa(&self.model, pressure_pa, length_m, direction, span_pa);
                    smallest = if slope.is_finite() { smallest.min(slope) } else { f64::NEG_INFINITY };
                }
            }
        }
        smallest
    }

    /// Model that is inverted.
    pub fn model(&self) -> &AugmentedModel {
        &self.model
    }

    /// Box inside which it is inverted.
    pub fn inverse_box(&self) -> &InverseBox {
        &self.inverse_box
    }

    /// Slope below which there is no inverse, in N/Pa.
    pub fn min_slope_n_per_pa(&self) -> f64 {
        self.min_slope_n_per_pa
    }

    /// Whether the inverse exists at every pressure, length and direction of the operating range, but for the range of force.
    pub fn rises_everywhere(&self) -> bool {
        self.rises_everywhere
    }

    /// Ranges of pressure over which the force rises at a length and direction, in Pa.
    pub fn rising_pa(&self, length_m: f64, direction: f64) -> Vec<[f64; 2]> {
        rising(&self.model, length_m, direction, self.inverse_box.pressure_pa, self.min_slope_n_per_pa)
    }

    /// The branch that is inverted at a length and direction, cut to the range of force; none where no force in
    /// that range has a pressure.
    pub fn branch(&self, length_m: f64, direction: f64) -> Option<Branch> {
        let [mut low_pa, mut high_pa] = self.uncut_pa(length_m, direction)?;
        let [lowest_n, highest_n] = self.inverse_box.force_n;
        let force_n = |pressure_pa: f64| self.model.settled_force_n(pressure_pa, length_m, direction);
        let (mut low_n, mut high_n) = (force_n(low_pa), force_n(high_pa));
        if low_n > highest_n || high_n < lowest_n {
            return None;
        }
        if low_n < lowest_n {
            low_pa = self.solve(lowest_n, length_m, direction, [low_pa, high_pa]);
            low_n = lowest_n;
        }
        if high_n > highest_n {
            high_pa = self.solve(highest_n, length_m, direction, [low_pa, high_pa]);
            high_n = highest_n;
        }
        (low_pa < high_pa).then_some(Branch { pressure_pa: [low_pa, high_pa], force_n: [low_n, high_n] })
    }

    /// The branch without regard to the range of force.
    fn uncut_pa(&self, length_m: f64, direction: f64) -> Option<[f64; 2]> {
        if self.rises_everywhere {
            return Some(self.inverse_box.pressure_pa);
        }
        longest(&self.rising_pa(length_m, direction))
    }

    fn solve(&self, force_n: f64, length_m: f64, direction: f64, [low_pa, high_pa]: [f64; 2]) -> f64 {
        let excess_n = |pressure_pa: f64| self.model.settled_force_n(pressure_pa, length_m, direction) - force_n;
        root(excess_n, low_pa, high_pa, PRECISION * self.inverse_box.pressure_span_pa())
    }

    /// The pressure, in Pa, that gives `force_n` at a length, moving in a direction (+1 contracting, -1 extending).
    ///
    /// # Errors
    /// [`NoInverse`] says which coordinate leaves the domain, and what is possible.
    pub fn pressure_pa(&self, force_n: f64, length_m: f64, direction: f64) -> Result<f64, NoInverse> {
        let range_m = self.inverse_box.length_m;
        let slack_m = SLACK * self.inverse_box.length_span_m();
        if !(length_m >= range_m[0] - slack_m && length_m <= range_m[1] + slack_m) {
            return Err(NoInverse::Length { length_m, range_m });
        }
        if !(-1.0..=1.0).contains(&direction) {
            return Err(NoInverse::Direction { direction });
        }
        let Some(branch_pa) = self.uncut_pa(length_m, direction) else { return Err(NoInverse::Flat { length_m }) };
        let range_n = branch_pa.map(|pressure_pa| self.model.settled_force_n(pressure_pa, length_m, direction));
        let range_n = [range_n[0].max(self.inverse_box.force_n[0]), range_n[1].min(self.inverse_box.force_n[1])];
        let slack_n = SLACK * self.inverse_box.force_span_n();
        if !(force_n >= range_n[0] - slack_n && force_n <= range_n[1] + slack_n) {
            return Err(NoInverse::Force { force_n, range_n, length_m });
        }
        Ok(self.solve(force_n, length_m, direction, branch_pa))
    }

    /// The domain as an artifact writes it down.
    pub fn domain(&self) -> InverseDomain {
        let InverseBox { pressure_pa, length_m, force_n } = self.inverse_box;
        let step_m = self.inverse_box.length_span_m() / (N_REACH - 1) as f64;
        let reach = (0..N_REACH).map(|index| {
            // The last one is the end itself, not a sum that rounds past it.
            let length_m = if index == N_REACH - 1 { length_m[1] } else { length_m[0] + step_m * index as f64 };
            Reach {
                length_m,
                contracting_force_n: self.branch(length_m, 1.0).map(|branch| branch.force_n),
                extending_force_n: self.branch(length_m, -1.0).map(|branch| branch.force_n),
            }
        });
        InverseDomain {
            pressure_pa,
            length_m,
            force_n,
            min_slope_n_per_pa: self.min_slope_n_per_pa,
            reach: reach.collect(),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
