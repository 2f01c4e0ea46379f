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

/// `C₁₀ + C₀₁` of latex, in Pa, for effects that need a bladder where the parameters of eq. 11 may be zero.
///
/// Source: Klute and Hannaford (2000), "Accounting for elastic energy storage in McKibben artificial muscle
/// actuators", J. Dynamic Systems, Measurement, and Control 122(2): 118.4 and 105.7 kPa.
pub const LATEX_PA: f64 = 2.2e5;

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

    /// Force of a bladder of latex, in N: negative where it resists contraction.
    pub fn latex_n(&self) -> f64 {
        self.bladder_n_per_pa * LATEX_PA
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Memory;
    use super::*;

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
            acceleration_m_per_s2: 0.0,
            direction: 1.0,
            slide_m: 0.027,
            force_n: 350.0,
        }
    }

    /// What eq. 11 says of the nominal muscle there, nearly.
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
    pub(in super::super) fn pull(memory: &mut dyn Memory, now: &Moment, base: &Base) -> [f64; 2] {
        let mut columns = [0.0; 2];
        memory.pulls(now, base, &mut columns);
        columns
    }
}
