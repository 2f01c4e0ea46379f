//! End taper: the muscle narrows to its fittings instead of ending as a cylinder.
//!
//! Two cones from `D` down to `D₀` hold less gas than the cylinder they replace,
//!
//! ```text
//! V_lost = 2 π L_c [D² / 4 - (D² + D D₀ + D₀²) / 12],   L_c = (D - D₀) / (2 tan β)
//!        = π (D - D₀)² (2 D + D₀) / (12 tan β)
//! F = F_base + p dV_lost/dL = F_base + p (π / 2) D (D - D₀) (dD/dL) / tan β
//! ```
//!
//! and `dD/dL` is negative. Ends are no cones where the braid bulges over them: the slope `1/tan β` then changes with the
//! diameter, to first order as
//!
//! ```text
//! 1/tan β → 1/tan β + c (D - D₀) / D₀
//! ```

use std::f64::consts::FRAC_PI_2;

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::{Kinematics, Muscle};

/// The effect.
#[derive(Debug)]
pub(super) struct EndTaper;

impl Effect for EndTaper {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "cotangent_of_taper", symbol: "1/tan β", unit: "1", range: (-20.0, 20.0) },
            Amplitude { name: "bulge_of_taper", symbol: "c", unit: "1", range: (-40.0, 40.0) },
        ]
    }

    fn start(&self, muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { kinematics: Kinematics::of(muscle), fitting_m: 2.0 * muscle.rest_radius_m })
    }
}

struct State {
    kinematics: Kinematics,
    /// `D₀`.
    fitting_m: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        let diameter_m = self.kinematics.diameter_m(now.length_m);
        let slope = self.kinematics.diameter_slope(now.length_m, diameter_m);
        // A muscle narrower than its fittings does not taper towards them.
        let wider_m = (diameter_m - self.fitting_m).max(0.0);
        let cone_n = now.pressure_pa * FRAC_PI_2 * diameter_m * wider_m * slope;
        columns[0] = cone_n;
        columns[1] = cone_n * wider_m / self.fitting_m;
    }
}

static PAGE: Page = Page {
    id: "end-taper",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::State,
    name: "taper of the ends",
    summary: "At its fittings the muscle keeps its diameter at rest, so that a contracted muscle ends in two cones. They \
              hold less gas than a cylinder, and the muscle pulls less the more it has contracted.",
    equation: "F = F_base + p (π/2) D (D - D₀) (dD/dL) [1/tan β + c (D - D₀) / D₀]",
    symbols: &[
        Symbol { symbol: "1/tan β", unit: "1", meaning: "slope of the cones; 0.6 to 1.7 for β of 60° to 30°" },
        Symbol { symbol: "c", unit: "1", meaning: "how the slope changes with the diameter; 0 for cones" },
        Symbol { symbol: "D", unit: "m", meaning: "diameter of the cylinder between them" },
        Symbol { symbol: "D₀", unit: "m", meaning: "diameter at the fittings, that of the muscle at rest" },
    ],
    validity: "Two cones much shorter than the muscle; the strands in them keep the kinematics of a cylinder.",
    source: "Tondu and Lopez (2000), IEEE Control Systems 20(2), for k₂ as its stand-in; volume of two conical frusta",
    signature: "The residual is static, proportional to the pressure and grows with the contraction. The parameters k₁ \
                and k₂ take up nearly all of it: look whether k₂ is well above 1 rather than at the residual.",
    confused_with: &[
        Confusion {
            id: "series-compliance",
            because: "both are static and grow with the pressure",
            test: "a rod in the place of the muscle shows the fixture; a photograph of the muscle shows the cones",
        },
        Confusion {
            id: "braid-lockup",
            because: "both lower the force at large contraction",
            test: "free contraction at three pressures: a braid that locks stops at one contraction, a taper does not",
        },
        Confusion {
            id: "threshold-pressure",
            because: "without low pressures in the recording both only lower the force",
            test: "isometric ramps from a vented muscle: a taper is proportional to the pressure from zero on",
        },
    ],
    test: "photograph the muscle under pressure at several lengths; two muscles of different length with the same fittings",
    protocol: "isobaric-triangles",
    coordinate: Coordinate::Contraction,
    typical: Typical { shapes: &[&[]], amplitudes: &[1.0, 0.0] },
    regions: &[],
    drivers: &["contraction"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;
    use std::f64::consts::PI;

    /// Volume that cones of 45° lose against the cylinder.
    fn lost_m3(muscle: &Muscle, length_m: f64) -> f64 {
        let (d, d0) = (muscle.diameter_m(length_m), 2.0 * muscle.rest_radius_m);
        let cone_m = 0.5 * (d - d0);
        2.0 * PI * cone_m * (d * d / 4.0 - (d * d + d * d0 + d0 * d0) / 12.0)
    }

    #[test]
    fn force_is_pressure_times_slope_of_the_lost_volume() {
        let muscle = nominal();
        let mut memory = EndTaper.start(&muscle, &[]);
        for length_m in [0.266, 0.25, 0.22, 0.19] {
            let step_m = 1e-6;
            let slope_m2 = (lost_m3(&muscle, length_m + step_m) - lost_m3(&muscle, length_m - step_m)) / (2.0 * step_m);
            let now = Moment { length_m, ..still() };
            let column_n = pull(&mut *memory, &now, &base())[0];
            assert!((column_n - now.pressure_pa * slope_m2).abs() < 1e-5 * column_n.abs().max(1.0), "L = {length_m}");
            assert!(column_n < 0.0);
        }
    }

    #[test]
    fn at_rest_and_beyond_there_are_no_cones() {
        let mut memory = EndTaper.start(&nominal(), &[]);
        for length_m in [0.267, 0.27] {
            assert!(pull(&mut *memory, &Moment { length_m, ..still() }, &base())[0].abs() < 1e-9);
        }
    }
}
