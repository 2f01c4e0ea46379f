//! A clamp that creeps under the load, or a cable that slips on its drum: the muscle is shorter than the encoder says, by more and more.
//!
//! ```text
//! F = F_base + A ln(1 + q / q₀) ∂F/∂L,  q = ∫ max(F, 0) dt
//! ```
//!
//! To first order in the creep; `A` is below zero where the clamp lets the muscle go. It goes on from recording to recording, as wear
//! does, but goes with the stiffness and not with the gas.

use pam_muscle::effects::page::{Page, Symbol, Typical};
use pam_muscle::effects::{Amplitude, Base, Dependence, Effect, Kept, Kind, Memory, Moment, Role, Shape};
use pam_muscle::{Coordinate, Muscle};

/// The force.
#[derive(Debug)]
pub(super) struct CreepingClamp;

impl Effect for CreepingClamp {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape { name: "load_n_s", symbol: "q₀", unit: "N s", range: (1.0, 1e7), grid: &[1e3, 1e4, 1e5] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "creep_m", symbol: "A", unit: "m", range: (-0.01, 0.01) }]
    }

    fn keeps(&self) -> &'static [Kept] {
        &[Kept { name: "past_load_n_s", unit: "N s", range: (0.0, 1e9), fresh: 0.0 }]
    }

    fn uses_slopes(&self) -> bool {
        true
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { scale_n_s: shape[0], load_n_s: 0.0 })
    }
}

struct State {
    scale_n_s: f64,
    load_n_s: f64,
}

impl Memory for State {
    fn past(&self) -> Vec<f64> {
        vec![self.load_n_s]
    }

    fn go_on(&mut self, past: &[f64]) {
        if let &[load_n_s] = past {
            self.load_n_s = load_n_s;
        }
    }

    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        self.load_n_s += now.step_s * now.force_n.max(0.0);
        columns[0] = base.slope_n_per_m * (self.load_n_s / self.scale_n_s).ln_1p();
    }
}

static PAGE: Page = Page {
    id: "creeping-clamp",
    role: Role::Pulls,
    kind: Kind::Fixture,
    dependence: Dependence::Past,
    name: "a clamp that creeps under the load",
    summary: "A clamp lets the muscle go, or a cable slips on its drum, by more the longer and the harder the muscle pulls. The encoder \
              does not see it.",
    equation: "F = F_base + A ln(1 + q / q₀) ∂F/∂L,  q = ∫ max(F, 0) dt",
    symbols: &[
        Symbol {
            symbol: "A",
            unit: "m",
            meaning: "length that it creeps while the load so far grows e-fold; below zero where it lets go",
        },
        Symbol { symbol: "q₀", unit: "N s", meaning: "load so far from which on it slows down" },
        Symbol { symbol: "q", unit: "N s", meaning: "force over time since the first recording began" },
    ],
    validity: "Creep that is small against the length.",
    source: "logarithmic creep of a clamped joint",
    signature: "The residual goes with the stiffness of the muscle, the more the longer it has pulled, and never returns.",
    confused_with: &[],
    test: "read the length of the muscle itself before and after",
    protocol: "isobaric-triangles",
    coordinate: Coordinate::Time,
    typical: Typical::UNKNOWN,
    regions: &[],
    drivers: &[],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_creeps_on_under_load_and_goes_on_in_the_next_recording() {
        let muscle = Muscle::nominal();
        let mut clamp = CreepingClamp.start(&muscle, &[100.0]);
        let base = Base { slope_n_per_m: 2e3, ..Base::default() };
        let at = |force_n: f64| Moment { step_s: 1.0, force_n, ..Moment::settled(&muscle, 2e5, 0.25, 1.0) };
        let mut column = [0.0];
        clamp.pulls(&at(100.0), &base, &mut column);
        assert!((column[0] - 2e3 * 2.0_f64.ln()).abs() < 1e-9, "{column:?}");
        clamp.pulls(&at(-50.0), &base, &mut column);
        assert!((column[0] - 2e3 * 2.0_f64.ln()).abs() < 1e-9, "a clamp does not creep back");
        let mut next = CreepingClamp.start(&muscle, &[100.0]);
        next.go_on(&clamp.past());
        next.pulls(&at(200.0), &base, &mut column);
        assert!((column[0] - 2e3 * 4.0_f64.ln()).abs() < 1e-9, "{column:?}");
    }
}
