//! Hysteresis of the pressure gauge: what it shows depends on where the pressure came from.
//!
//! ```text
//! p_m = p + b z,   z = Maxwell slip over r on p,   F = F_base + b z ∂F/∂p
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::slip::Follower;
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PressureGaugeHysteresis;

impl Effect for PressureGaugeHysteresis {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn uses_slopes(&self) -> bool {
        true
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape { name: "slip_pressure_pa", symbol: "r", unit: "Pa", range: (2e2, 3e4), grid: &[1e3, 3e3, 1e4, 2e4] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "width_pa", symbol: "b", unit: "Pa", range: (0.0, 3e4) }]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State(Follower::new(shape[0])))
    }
}

struct State(Follower);

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        // Where the pressure came from at first is not known, and the direction of motion does not tell.
        columns[0] = base.slope_n_per_pa * self.0.follow(now, now.pressure_pa, 0.0);
    }
}

static PAGE: Page = Page {
    id: "pressure-gauge-hysteresis",
    role: Role::Pulls,
    kind: Kind::Instrument,
    dependence: Dependence::Past,
    name: "hysteresis of the pressure gauge",
    summary: "A membrane that follows late shows less on the way up than on the way down, so the pressure in the muscle \
              is higher than recorded while it rises and lower while it falls, however slowly.",
    equation: "F = F_base + b z ∂F_base/∂p,  z = Σ w_i z_i,  z_i ← clamp(z_i + Δp / r_i, -1, 1),  r_i = r (0.15 … 4.5)",
    symbols: &[
        Symbol {
            symbol: "b",
            unit: "Pa",
            meaning: "half the height of the loop; 0.1 to 0.5 % of full scale, 0.5 to 5 kPa",
        },
        Symbol { symbol: "r", unit: "Pa", meaning: "pressure over which 63 % of it build up; 1 to 30 kPa" },
        Symbol { symbol: "z", unit: "1", meaning: "share of the full height, in [-1, 1]; 0 at the start" },
    ],
    validity: "b small against the pressures used, where the force is linear in it; no dependence on the rate. What sticks in \
               the path of the load, such as a swivel, looks alike: a second gauge shows nothing of that.",
    source: "IEC 61298-2 for hysteresis of gauges; Al-Bender, Lampaert and Swevers (2005), IEEE Trans. Automatic Control \
             50(11), for the operator",
    signature: "The residual is odd in the direction of the pressure in isometric recordings, at every rate alike, in \
                proportion to ∂F/∂p; isobaric recordings show nothing of it.",
    confused_with: &[
        Confusion {
            id: "pressure-lag",
            because: "both open the isometric loop",
            test: "isometric ramps at two rates: a lag opens the loop in proportion to the rate, a gauge does not care",
        },
        Confusion {
            id: "presliding-hysteresis",
            because: "friction of the braid opens the isometric loop as well, the other way round",
            test: "isobaric triangles: friction opens those loops, a gauge does not; or a second gauge",
        },
        Confusion {
            id: "channel-delay",
            because: "in isometric ramps of one rate a late force opens the same loop",
            test: "isometric ramps at two rates: a delay opens the loop in proportion to the rate",
        },
    ],
    test: "slow isometric ramps up and down at two rates; a second gauge of another make in parallel",
    protocol: "isometric-ramps",
    coordinate: Coordinate::TravelSinceReversal,
    typical: Typical { shapes: &[&[1e4]], amplitudes: &[2e3] },
    regions: &[],
    drivers: &["pressure"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    fn at(pressure_pa: f64) -> Moment {
        Moment { step_s: 0.1, pressure_pa, ..still() }
    }

    #[test]
    fn rising_pressure_shows_too_low_and_falling_too_high() {
        let mut memory = PressureGaugeHysteresis.start(&nominal(), &[3e3]);
        assert!(pull(&mut *memory, &still(), &base())[0].abs() < 1e-15);
        let up_n = pull(&mut *memory, &at(5e5), &base())[0];
        let down_n = pull(&mut *memory, &at(1e5), &base())[0];
        assert!((up_n - base().slope_n_per_pa).abs() < 1e-12 && (down_n + base().slope_n_per_pa).abs() < 1e-12);
    }

    #[test]
    fn at_constant_pressure_motion_does_not_matter() {
        let mut memory = PressureGaugeHysteresis.start(&nominal(), &[3e3]);
        pull(&mut *memory, &still(), &base());
        let moving = Moment { speed_m_per_s: 0.05, slide_m: 0.05, direction: -1.0, ..at(3e5) };
        assert!(pull(&mut *memory, &moving, &base())[0].abs() < 1e-15);
    }
}
