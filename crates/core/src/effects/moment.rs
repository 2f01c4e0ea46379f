//! The muscle at one instant, as effects see it.

use crate::force::ForceModel;

/// Channels and what follows from them at one instant, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Which recording; a simulation is recording 0.
    pub recording: usize,
    /// Time since the recording began.
    pub time_s: f64,
    /// Time since the moment before; zero at the first and behind a gap.
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
    /// Acceleration of contraction, smooth.
    pub acceleration_m_per_s2: f64,
    /// Direction of motion: +1 contracting, -1 extending, 0 where nothing ever moved.
    pub direction: f64,
    /// How far the braid has slid, rising while it contracts: the smooth contraction in metres, and where the length stands
    /// still [`SLIDE_M_PER_PA`] times the pressure.
    pub slide_m: f64,
    /// Force as measured, smooth, where it was measured; as the model had it a moment ago elsewhere.
    pub force_n: f64,
}

/// How far the strands of a muscle that is held at its ends slide over one another per pascal, in m/Pa: the
/// stretch of nylon strands and the indentation of the bladder give some 20 mm at 0.5 MPa.
pub const SLIDE_M_PER_PA: f64 = 4e-8;

/// What eq. 11 says at the same instant, at the pressure and length that the muscle sees.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Base {
    /// Gas on the braid, in N.
    pub gas_n: f64,
    /// Bladder, with its sign (negative where it resists contraction), in N.
    pub bladder_n: f64,
    /// Bladder per pascal of `C₁₀` and of `C₀₁` together, shared as in the model; the shape of the bladder's force
    /// even where its parameters are zero, in N per Pa.
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

impl Base {
    /// What `model` says at a pressure and a length.
    pub fn of(model: &ForceModel, pressure_pa: f64, length_m: f64) -> Self {
        const STEP_PA: f64 = 1e2;
        const STEP_M: f64 = 1e-5;
        let terms = model.terms(pressure_pa, length_m, 0.0);
        let force_n = |pressure_pa: f64, length_m: f64| model.force_n(pressure_pa, length_m, 0.0);
        let shape = model.bladder_n_per_pa(length_m);
        Self {
            gas_n: terms.gas_n,
            bladder_n: terms.bladder_n,
            bladder_n_per_pa: shape,
            normal_n: model.normal_n(pressure_pa, length_m),
            static_force_n: terms.force_n(),
            slope_n_per_pa: (force_n(pressure_pa + STEP_PA, length_m) - force_n(pressure_pa - STEP_PA, length_m))
                / (2.0 * STEP_PA),
            slope_n_per_m: (force_n(pressure_pa, length_m + STEP_M) - force_n(pressure_pa, length_m - STEP_M))
                / (2.0 * STEP_M),
        }
    }
}
