//! Rate-dependent hysteresis: friction that grows with the logarithm of the speed.
//!
//! ```text
//! F = F_base - s f_r p π D L ln(1 + |v| / v₀)
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct RateDependentHysteresis;

impl Effect for RateDependentHysteresis {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape {
            name: "onset_speed_m_per_s",
            symbol: "v₀",
            unit: "m/s",
            range: (1e-5, 5e-2),
            grid: &[1e-4, 1e-3, 1e-2],
        }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "friction_per_e_fold", symbol: "f_r", unit: "1", range: (0.0, 0.01) }]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { onset_speed_m_per_s: shape[0] })
    }
}

struct State {
    onset_speed_m_per_s: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        let e_folds = (now.slide_speed_m_per_s.abs() / self.onset_speed_m_per_s).ln_1p();
        columns[0] = -now.direction * base.normal_n * e_folds;
    }
}

static PAGE: Page = Page {
    id: "rate-dependent-hysteresis",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "rate dependence of the hysteresis",
    summary: "The loop of force over length widens a little with every decade of speed, far less than in proportion. \
              Friction of polymers has this law over many decades.",
    equation: "F = F_base - s f_r p π D L ln(1 + |v| / v₀)",
    symbols: &[
        Symbol {
            symbol: "f_r",
            unit: "1",
            meaning: "friction per factor e of speed, in units of eq. 9; 0.02 to 0.15 times f'",
        },
        Symbol { symbol: "v₀", unit: "m/s", meaning: "speed where the growth sets in; 0.1 to 1 mm/s" },
        Symbol { symbol: "s", unit: "1", meaning: "direction of motion, kept at standstill" },
        Symbol { symbol: "v", unit: "m/s", meaning: "speed of contraction" },
    ],
    validity: "Two to three decades of speed; below v₀ it is proportional to the speed and small.",
    source: "Azuwan and Yamamoto (2019), Applied Sciences 9(12) 2538, for the dependence on the rate; the logarithm is \
             that of thermally activated friction, Prandtl (1928)",
    signature: "The residual is odd in the direction; half the width of isobaric loops rises in proportion to the \
                logarithm of the speed, and scales with the pressure.",
    confused_with: &[
        Confusion {
            id: "viscous-damping",
            because: "both widen the loop with the speed",
            test: "isobaric triangles over two decades of speed: the width rises by equal steps per decade, or tenfold",
        },
        Confusion {
            id: "viscoelastic-relaxation",
            because: "a broad spectrum of relaxation times widens loops by equal steps per decade as well",
            test: "hold after a step of the length: relaxation decays in the hold, friction does not; and the height of \
                   relaxation does not follow the pressure",
        },
        Confusion {
            id: "stribeck",
            because: "both change the width of the loop over the logarithm of the speed, with opposite slopes",
            test: "isobaric triangles at five speeds or more: the width rises, or it falls",
        },
    ],
    test: "isobaric triangles at five speeds from 0.5 to 50 mm/s and two pressures",
    protocol: "rate-ladder",
    coordinate: Coordinate::Speed,
    typical: Typical { shapes: &[&[3e-4]], amplitudes: &[1e-4] },
    regions: &[],
    drivers: &["speed"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn every_decade_far_above_the_onset_adds_the_same() {
        let mut memory = RateDependentHysteresis.start(&nominal(), &[1e-5]);
        let mut at = |slide_speed_m_per_s| pull(&mut *memory, &Moment { slide_speed_m_per_s, ..still() }, &base())[0];
        let [slow, faster, fast] = [at(1e-2), at(1e-1), at(1.0)];
        assert!((faster - slow - (fast - faster)).abs() < 1e-3 * slow.abs());
        assert!((fast - faster + base().normal_n * 10.0_f64.ln()).abs() < 1e-3 * fast.abs());
    }

    #[test]
    fn it_vanishes_at_rest_and_opposes_the_motion() {
        let mut memory = RateDependentHysteresis.start(&nominal(), &[1e-3]);
        assert_eq!(pull(&mut *memory, &still(), &base())[0], 0.0);
        let back = Moment { slide_speed_m_per_s: -1e-2, direction: -1.0, ..still() };
        assert!(pull(&mut *memory, &back, &base())[0] > 0.0);
    }
}
