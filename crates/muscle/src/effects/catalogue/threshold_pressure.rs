//! Threshold pressure: the bladder takes some pressure before it presses on the braid.
//!
//! ```text
//! p_e = h(p) - h(0),   h(p) = ½ [(p - p_th) + √((p - p_th)² + w²)],   w = 10 kPa
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// `w`: over what pressure the bladder comes to lie on the braid, in Pa.
const WIDTH_PA: f64 = 1e4;

/// The effect.
#[derive(Debug)]
pub(super) struct ThresholdPressure;

impl Effect for ThresholdPressure {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape {
            name: "threshold_pa",
            symbol: "p_th",
            unit: "Pa",
            range: (1e3, 2e5),
            grid: &[5e3, 1e4, 2e4, 3.5e4, 5e4, 7e4, 9e4],
        }]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { threshold_pa: shape[0], vented_pa: hinge_pa(-shape[0]) })
    }
}

/// Nothing far below zero, its argument far above.
fn hinge_pa(excess_pa: f64) -> f64 {
    let root_pa = excess_pa.hypot(WIDTH_PA);
    // The product of the two roots is -w² / 4: no digits lost far below zero.
    if excess_pa < 0.0 { 0.5 * WIDTH_PA * WIDTH_PA / (root_pa - excess_pa) } else { 0.5 * (excess_pa + root_pa) }
}

struct State {
    threshold_pa: f64,
    /// `h(0)`: a vented muscle sees no pressure.
    vented_pa: f64,
}

impl Memory for State {
    fn sees(&mut self, now: &mut Moment) {
        now.pressure_pa = hinge_pa(now.pressure_pa - self.threshold_pa) - self.vented_pa;
    }
}

static PAGE: Page = Page {
    id: "threshold-pressure",
    role: Role::Sees,
    kind: Kind::Muscle,
    dependence: Dependence::PartOfState,
    name: "threshold pressure of the bladder",
    summary: "A bladder that is narrower than its braid must be inflated to it before the gas pulls at all. Below the \
              threshold the muscle gives no force, above it works as with so much less pressure.",
    equation: "F = F_base(p_e, L),  p_e = h(p) - h(0),  h(p) = ((p - p_th) + √((p - p_th)² + w²)) / 2,  w = 10 kPa",
    symbols: &[
        Symbol {
            symbol: "p_th",
            unit: "Pa",
            meaning: "threshold; up to 20 kPa for a bladder that fills its braid, 60 to 100 kPa for a loose one",
        },
        Symbol { symbol: "w", unit: "Pa", meaning: "pressure over which it comes to lie on the braid, 10 kPa" },
        Symbol { symbol: "p_e", unit: "Pa", meaning: "pressure on the braid" },
    ],
    validity: "A threshold that does not depend on the length; no hysteresis of the contact.",
    source: "Tsagarakis and Caldwell (2000), ICRA, for the radial loss; Chou and Hannaford (1996), IEEE Trans. Robotics \
             and Automation 12(1), for its size; smoothed here",
    signature: "The residual is static and sits below twice the threshold, where the model pulls and the muscle does not \
                yet; above it only a shift of the pressure is left, which the parameters of eq. 11 take up.",
    confused_with: &[
        Confusion {
            id: "slack",
            because: "both leave no force at low pressure",
            test: "isometric ramps from zero at several lengths: the threshold is the same at all of them, slack ends \
                   where the model's force becomes positive",
        },
        Confusion {
            id: "series-compliance",
            because: "without low pressures in the recording both are static and bend the force over the pressure",
            test: "isometric ramps from a vented muscle, slowly up to 120 kPa",
        },
        Confusion {
            id: "end-taper",
            because: "without low pressures in the recording both only lower the force",
            test: "isometric ramps from a vented muscle: a taper is proportional to the pressure from zero on",
        },
    ],
    test: "isometric ramps from a vented muscle at five lengths, 10 kPa/s below 120 kPa; the gauge's zero while vented",
    protocol: "isometric-ramps",
    coordinate: Coordinate::Pressure,
    typical: Typical { shapes: &[&[3e4]], amplitudes: &[] },
    regions: &[Coordinate::Pressure],
    drivers: &["pressure"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::still;
    use crate::geometry::tests::nominal;

    fn seen_pa(threshold_pa: f64, pressure_pa: f64) -> f64 {
        let mut now = Moment { pressure_pa, ..still() };
        ThresholdPressure.start(&nominal(), &[threshold_pa]).sees(&mut now);
        now.pressure_pa
    }

    #[test]
    fn far_above_it_is_a_shift_and_vented_it_is_nothing() {
        for threshold_pa in [5e3, 3.5e4, 9e4] {
            assert!(seen_pa(threshold_pa, 0.0).abs() < 1e-9);
            let shift_pa = threshold_pa + hinge_pa(-threshold_pa);
            // w² / 4 (p - p_th) is left of the bend.
            assert!((seen_pa(threshold_pa, 5e5) - (5e5 - shift_pa)).abs() < 70.0);
        }
        assert!(seen_pa(5e4, 2e4) < 0.02 * 5e4);
    }

    #[test]
    fn more_pressure_is_never_less() {
        let seen: Vec<f64> = (-10..400).map(|index| seen_pa(2e4, 1e3 * f64::from(index))).collect();
        assert!(seen.windows(2).all(|pair| pair[1] > pair[0]));
    }
}
