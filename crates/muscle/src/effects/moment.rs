//! The muscle at one instant, as effects see it.

use crate::force::rubber_friction::normal_force_n;
use crate::force::{ForceModel, Parameter, Terms};
use crate::geometry::Muscle;

/// Channels and what follows from them at one instant, in SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moment {
    /// Which recording; a simulation is recording 0.
    pub recording: usize,
    /// Time since the recording began.
    pub time_s: f64,
    /// Time since the moment before; zero at the first and after a gap.
    pub step_s: f64,
    /// Gauge pressure.
    pub pressure_pa: f64,
    /// Its smooth rate of change.
    pub pressure_rate_pa_per_s: f64,
    /// Length.
    pub length_m: f64,
    /// Contraction ratio of a smooth length.
    pub contraction_ratio: f64,
    /// Speed of contraction, `-dL/dt`, smooth.
    pub speed_m_per_s: f64,
    /// Speed at which the braid slides: that of contraction, and where the length stands still
    /// [`ForceModel::slide_m_per_pa`] times the rate of the pressure.
    pub slide_speed_m_per_s: f64,
    /// Acceleration of contraction, smooth.
    pub acceleration_m_per_s2: f64,
    /// Direction of motion: +1 contracting, -1 extending, 0 where nothing ever moved.
    pub direction: f64,
    /// Whether the muscle is known to have come in that direction to where it is. The beginning of a recording does not say.
    pub came: bool,
    /// How far the braid has slid, rising while it contracts: the smooth contraction in metres, and where the length stands
    /// still [`ForceModel::slide_m_per_pa`] times the pressure.
    pub slide_m: f64,
    /// The part of it that pressure has made where the length stood still, in m.
    pub rest_slide_m: f64,
    /// Force as measured, smooth, where it was measured; as the model had it a moment ago elsewhere.
    pub force_n: f64,
    /// Logged temperature above 20 °C, in K; zero where none was logged.
    pub warmth_k: f64,
}

/// Force of eq. 11 at the same instant, at the pressure and length that the muscle sees.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Base {
    /// Gas on the braid, in N.
    pub gas_n: f64,
    /// Bladder, with its sign (negative where it resists contraction), in N.
    pub bladder_n: f64,
    /// Bladder per pascal of `C₁₀` and of `C₀₁` together, shared as in the model; the shape of the bladder's force
    /// even where its parameters are zero, in N per Pa. Negative where rubber resists contraction, however eq. 11
    /// is written.
    pub bladder_n_per_pa: f64,
    /// `p π D L`: what presses bladder and strands together, in N.
    pub normal_n: f64,
    /// Force without friction, in N.
    pub static_force_n: f64,
    /// Its derivative by pressure, in N/Pa.
    pub slope_n_per_pa: f64,
    /// Its derivative by length, in N/m.
    pub slope_n_per_m: f64,
}

/// `C₁₀ + C₀₁` of latex, in Pa, for effects that need a bladder where the parameters of eq. 11 may be zero.
///
/// Source: Klute and Hannaford (2000), "Accounting for elastic energy storage in McKibben artificial muscle
/// actuators", J. Dynamic Systems, Measurement, and Control 122(2): 118.4 and 105.7 kPa.
pub const LATEX_PA: f64 = 2.2e5;

/// Share of `C₁₀` in the same.
pub const LATEX_C10_SHARE: f64 = 118.4 / (118.4 + 105.7);

/// Steps of central differences, in Pa and in m: far above rounding, far below any bend of eq. 11.
const STEP_PA: f64 = 100.0;
const STEP_M: f64 = 1e-5;

impl Moment {
    /// A muscle that has long been there and came slowly in `direction`; no force is known yet.
    pub fn settled(muscle: &Muscle, pressure_pa: f64, length_m: f64, direction: f64) -> Self {
        Self {
            recording: 0,
            time_s: 0.0,
            step_s: 0.0,
            pressure_pa,
            pressure_rate_pa_per_s: 0.0,
            length_m,
            contraction_ratio: muscle.contraction_ratio(length_m),
            speed_m_per_s: 0.0,
            slide_speed_m_per_s: 0.0,
            acceleration_m_per_s2: 0.0,
            direction,
            came: true,
            slide_m: muscle.rest_length_m - length_m,
            rest_slide_m: 0.0,
            force_n: 0.0,
            warmth_k: 0.0,
        }
    }
}

impl Base {
    /// Force of `model` at a gauge pressure and a length.
    pub fn of(model: &ForceModel, pressure_pa: f64, length_m: f64) -> Self {
        let static_n = |pressure_pa, length_m| model.force_n(pressure_pa, length_m, 0.0);
        let base = Self::from_terms(model, pressure_pa, length_m, &model.terms(pressure_pa, length_m, 0.0));
        Self {
            slope_n_per_pa: (static_n(pressure_pa + STEP_PA, length_m) - static_n(pressure_pa - STEP_PA, length_m))
                / (2.0 * STEP_PA),
            slope_n_per_m: (static_n(pressure_pa, length_m + STEP_M) - static_n(pressure_pa, length_m - STEP_M))
                / (2.0 * STEP_M),
            ..base
        }
    }

    /// The same without the slopes, which stay zero, from terms that are known already.
    pub fn from_terms(model: &ForceModel, pressure_pa: f64, length_m: f64, terms: &Terms) -> Self {
        let parameters = model.parameters();
        let (c10_pa, c01_pa) = (parameters.of(Parameter::C10), parameters.of(Parameter::C01));
        let sum_pa = c10_pa + c01_pa;
        let share = if sum_pa > 0.0 { c10_pa / sum_pa } else { LATEX_C10_SHARE };
        let [by_c10, by_c01] = model.bladder().columns_n_per_pa(length_m);
        Self {
            gas_n: terms.gas_n,
            bladder_n: terms.bladder_n,
            bladder_n_per_pa: share * by_c10 + (1.0 - share) * by_c01,
            normal_n: normal_force_n(pressure_pa, model.kinematics().diameter_m(length_m), length_m),
            static_force_n: terms.gas_n + terms.offset_n + terms.bladder_n + terms.braid_n,
            slope_n_per_pa: 0.0,
            slope_n_per_m: 0.0,
        }
    }

    /// Force of a bladder of latex, in N: negative where it resists contraction.
    pub fn latex_n(&self) -> f64 {
        self.bladder_n_per_pa * LATEX_PA
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Memory;
    use super::*;
    use crate::force::{BaseParameters, Form};
    use crate::geometry::tests::nominal;

    /// At rest under 0.3 MPa, 27 mm contracted, having come that way.
    pub(in super::super) fn still() -> Moment {
        Moment {
            recording: 0,
            time_s: 0.0,
            step_s: 0.0,
            pressure_pa: 3e5,
            pressure_rate_pa_per_s: 0.0,
            length_m: 0.24,
            contraction_ratio: 0.027 / 0.267,
            speed_m_per_s: 0.0,
            slide_speed_m_per_s: 0.0,
            acceleration_m_per_s2: 0.0,
            direction: 1.0,
            came: true,
            slide_m: 0.027,
            rest_slide_m: 0.0,
            force_n: 350.0,
            warmth_k: 0.0,
        }
    }

    /// Force of eq. 11 of the nominal muscle there, nearly.
    pub(in super::super) fn base() -> Base {
        Base {
            gas_n: 461.0,
            bladder_n: -67.0,
            bladder_n_per_pa: -3e-4,
            normal_n: 6e3,
            static_force_n: 368.0,
            slope_n_per_pa: 1.35e-3,
            slope_n_per_m: 8e3,
        }
    }

    /// Columns of a pull, zero where the effect has fewer.
    pub(in super::super) fn pull(memory: &mut dyn Memory, now: &Moment, base: &Base) -> [f64; 3] {
        let mut columns = [0.0; 3];
        memory.pulls(now, base, &mut columns);
        columns
    }

    fn model(c10_pa: f64, c01_pa: f64) -> ForceModel {
        let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, c10_pa, c01_pa, 1.0 / 3e9, 1.2e-3, 0.0] };
        ForceModel::new(&nominal(), 3e9, Form::Corrected, parameters)
    }

    #[test]
    fn base_is_eq_11_without_friction() {
        let model = model(118.4e3, 105.7e3);
        let base = Base::of(&model, 3e5, 0.24);
        assert!((base.static_force_n - model.force_n(3e5, 0.24, 0.0)).abs() < 1e-9);
        let friction_n = model.force_n(3e5, 0.24, -1.0) - base.static_force_n;
        assert!((1.2e-3 * base.normal_n - friction_n).abs() < 1e-9);
        assert!((base.bladder_n_per_pa * 224.1e3 - base.bladder_n).abs() < 1e-9);
        // The published 1.35 N/kPa and 8 N/mm at a contraction of 0.1 and 0.3 MPa.
        assert!((base.slope_n_per_pa - 1.35e-3).abs() < 0.05e-3, "{}", base.slope_n_per_pa);
        assert!((base.slope_n_per_m - 8e3).abs() < 1e3, "{}", base.slope_n_per_m);
    }

    #[test]
    fn a_bladder_has_a_shape_even_where_eq_11_has_none() {
        let without = Base::of(&model(0.0, 0.0), 3e5, 0.24);
        let with = Base::of(&model(118.4e3, 105.7e3), 3e5, 0.24);
        assert_eq!(without.bladder_n, 0.0);
        assert!((without.bladder_n_per_pa / with.bladder_n_per_pa - 1.0).abs() < 1e-12);
        assert!(with.latex_n() < 0.0);
    }
}
