//! Viscoelastic relaxation: rubber that is stretched pulls harder at first.
//!
//! ```text
//! F = F_base + Σ g_i (f - q_i),   τ_i dq_i/dt = f - q_i,   f = V_r dW/dL of latex,   τ_i = τ, 10 τ, 100 τ
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::prony::Overstress;
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct ViscoelasticRelaxation;

impl Effect for ViscoelasticRelaxation {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape {
            name: "time_constant_s", symbol: "τ", unit: "s", range: (0.02, 300.0), grid: &[0.03, 0.2, 1.0, 6.0]
        }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "overstress", symbol: "g₁", unit: "1", range: (0.0, 2.0) },
            Amplitude { name: "slow_overstress", symbol: "g₂", unit: "1", range: (0.0, 2.0) },
            Amplitude { name: "slowest_overstress", symbol: "g₃", unit: "1", range: (0.0, 2.0) },
        ]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State(Overstress::new(shape[0])))
    }
}

struct State(Overstress);

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        columns.copy_from_slice(&self.0.follow(now, base.latex_n()));
    }
}

static PAGE: Page = Page {
    id: "viscoelastic-relaxation",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "viscoelastic relaxation of the bladder",
    summary: "After a change of the length the rubber pulls against the change by more than it does in the end, and \
              the surplus dies away over seconds to minutes. Pressure alone, at a fixed length, does not excite it.",
    equation: "F = F_base + Σ g_i (f - q_i),  τ_i dq_i/dt = f - q_i,  τ_i = τ, 10 τ, 100 τ",
    symbols: &[
        Symbol {
            symbol: "f",
            unit: "N",
            meaning: "force of a bladder of latex, C₁₀ + C₀₁ = 0.22 MPa, whatever the fitted bladder is",
        },
        Symbol { symbol: "τ", unit: "s", meaning: "shortest time constant; 0.03 to 10 s" },
        Symbol { symbol: "g₁", unit: "1", meaning: "overstress that decays with τ; 0.03 to 0.25 of the bladder" },
        Symbol { symbol: "g₂", unit: "1", meaning: "overstress that decays with 10 τ; likewise" },
        Symbol { symbol: "g₃", unit: "1", meaning: "overstress that decays with 100 τ; likewise" },
        Symbol { symbol: "q_i", unit: "N", meaning: "what the bladder has got used to" },
    ],
    validity: "Linear viscoelasticity over three decades of time from τ on; a muscle that has rested before it starts.",
    source: "Prony series of a generalized Maxwell body (Wiechert 1893); Bennington and others (2023), arXiv \
             2301.04684, for muscles as standard linear solids",
    signature: "In holds after a step of the length the residual decays, against the step and in proportion to it, and \
                starts anew with each step; in holds after a step of the pressure there is nothing.",
    confused_with: &[
        Confusion {
            id: "pressure-creep",
            because: "both decay in the holds after a step of the length",
            test: "steps of the pressure at fixed length: only creep that inflation drives shows there",
        },
        Confusion {
            id: "mullins-softening",
            because: "both make the first cycle differ from the later ones",
            test: "rest for ten minutes and repeat the first cycle: relaxation comes back, softening does not",
        },
        Confusion {
            id: "force-drift",
            because: "a single long hold shows one slow decay, which a drifting load cell makes as well",
            test: "steps up and down with holds of a minute: relaxation changes its sign with the step, drift does not",
        },
    ],
    test: "isobaric steps of the length up and down, with holds of a minute and one of half an hour",
    protocol: "length-steps",
    coordinate: Coordinate::TimeSinceLastMove,
    typical: Typical { shapes: &[&[3.0]], amplitudes: &[0.1, 0.1, 0.1] },
    regions: &[],
    drivers: &["contraction", "time-since-last-move"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn a_step_of_the_length_is_resisted_and_forgotten() {
        let mut memory = ViscoelasticRelaxation.start(&nominal(), &[1.0]);
        let relaxed = Base { bladder_n_per_pa: 0.0, ..base() };
        assert_eq!(pull(&mut *memory, &still(), &relaxed), [0.0; 3]);
        // Contraction turns the bladder's force from zero to negative: it resists by more than that at first.
        let now = |time_s, step_s| Moment { time_s, step_s, ..still() };
        let stepped = pull(&mut *memory, &now(1e-6, 1e-6), &base());
        assert!((stepped[0] - base().latex_n()).abs() < 1e-3);
        let held = pull(&mut *memory, &now(1.0, 1.0), &base());
        assert!((held[0] / stepped[0] - (-1.0_f64).exp()).abs() < 1e-6);
        assert!((held[1] / stepped[1] - (-0.1_f64).exp()).abs() < 1e-6);
    }

    #[test]
    fn pressure_alone_does_not_excite_it() {
        let mut memory = ViscoelasticRelaxation.start(&nominal(), &[1.0]);
        pull(&mut *memory, &still(), &base());
        let inflated = Moment { step_s: 0.1, time_s: 0.1, pressure_pa: 5e5, ..still() };
        assert_eq!(pull(&mut *memory, &inflated, &Base { gas_n: 700.0, ..base() }), [0.0; 3]);
    }
}
