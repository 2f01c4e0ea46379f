//! One arm: elbow, muscle, air and valve, in steps of a millisecond or finer.
//!
//! ```text
//! M q̈ = r(q) F(p, L, z) e^{-μΘ z} - G(q) - d q̇ + τ_support,   F ≥ 0: a cable does not push
//! ```
//!
//! | symbol      | code                      | unit     | meaning                                             |
//! |-------------|---------------------------|----------|-----------------------------------------------------|
//! | `F`         | [`ForceModel::force_n`]   | N        | eq. 11 with the friction's state for its direction  |
//! | `z`         | [`Dahl`]                  | 1        | state of the friction                               |
//! | `μΘ`        | `bowden`                  | 1        | friction times wrap of a Bowden cable (capstan)     |
//! | `d`         | `damping_n_m_s`           | N m s    | viscous damping of the joint                        |
//! | `τ_support` | `support_n_m`             | N m      | whatever else carries the load, before the lift     |
//!
//! Velocity Verlet for the joint, the exact steps of [`Dahl`] and [`Valve`], half the gas's expansion before
//! the valve and half after it. One evaluation of the force a step.

use pam_core::force::ForceModel;

use super::{BladderGas, Dahl, Valve, ValvePhysics};
use crate::arm::{Elbow, Lever};

/// Constants of one arm; see the [module](self).
#[derive(Debug, Clone)]
pub struct ArmPhysics {
    /// Inertia and gravity.
    pub elbow: Elbow,
    /// Muscle on the elbow.
    pub lever: Lever,
    /// Force of the muscle.
    pub force: ForceModel,
    /// Factor on the friction of the force model.
    pub friction_scale: f64,
    /// Travel of pre-sliding, in m.
    pub presliding_m: f64,
    /// `μΘ`.
    pub bowden: f64,
    /// `d`, in N m s.
    pub damping_n_m_s: f64,
    /// Air in the muscle.
    pub gas: BladderGas,
    /// Valve.
    pub valve: ValvePhysics,
    /// Step, in s.
    pub step_s: f64,
}

/// One arm in motion.
#[derive(Debug, Clone)]
pub struct ArmPlant<'a> {
    physics: &'a ArmPhysics,
    /// Angle, in rad.
    pub q_rad: f64,
    /// Angular velocity, in rad/s.
    pub dq_rad_per_s: f64,
    /// Angular acceleration, in rad/s².
    pub ddq_rad_per_s2: f64,
    /// Gauge pressure in the muscle, in Pa.
    pub pressure_pa: f64,
    /// Active length of the muscle, in m.
    pub length_m: f64,
    /// Moment arm of the muscle, in m.
    pub moment_arm_m: f64,
    /// Tension at the joint, in N.
    pub force_n: f64,
    /// Whether the muscle would push and the cable hangs slack.
    pub slack: bool,
    friction: Dahl,
    valve: Valve,
    volume_m3: f64,
}

impl<'a> ArmPlant<'a> {
    /// An arm at rest at an angle, with a pressure and a state of the friction (-1 to 1).
    pub fn at_rest(physics: &'a ArmPhysics, q_rad: f64, pressure_pa: f64, friction_state: f64) -> Self {
        let at = physics.lever.at_angle(q_rad);
        let mut plant = Self {
            physics,
            q_rad,
            dq_rad_per_s: 0.0,
            ddq_rad_per_s2: 0.0,
            pressure_pa,
            length_m: at.length_m,
            moment_arm_m: at.moment_arm_m,
            force_n: 0.0,
            slack: false,
            friction: Dahl::new(physics.presliding_m, friction_state),
            valve: Valve::new(physics.valve, physics.step_s),
            volume_m3: physics.gas.volume_m3(at.length_m),
        };
        plant.pull();
        plant
    }

    /// Torque of gravity, in N m.
    pub fn gravity_n_m(&self) -> f64 {
        let (sine, cosine) = self.q_rad.sin_cos();
        self.physics.elbow.gravity_n_m(sine, cosine)
    }

    /// Torque of the muscle, in N m.
    pub fn torque_n_m(&self) -> f64 {
        self.moment_arm_m * self.force_n
    }

    /// State of the friction.
    pub fn friction_state(&self) -> f64 {
        self.friction.state
    }

    /// Mechanical energy of joint and load, in J.
    pub fn energy_j(&self) -> f64 {
        self.physics.elbow.energy_j(self.q_rad, self.dq_rad_per_s)
    }

    /// One step with the valve at `command_pa`; `carried` of the weight is carried by the muscle, the rest by
    /// something else.
    pub fn advance(&mut self, command_pa: f64, carried: f64) {
        let physics = self.physics;
        let step_s = physics.step_s;
        let half_rad_per_s = self.dq_rad_per_s + 0.5 * step_s * self.ddq_rad_per_s2;
        self.q_rad += step_s * half_rad_per_s;
        let (sine, cosine) = self.q_rad.sin_cos();
        let at = physics.lever.at(sine, cosine);
        self.friction.advance(self.length_m - at.length_m);
        let volume_m3 = physics.gas.volume_m3(at.length_m);
        let (mean_m3, half_m3) = (0.5 * (volume_m3 + self.volume_m3), 0.5 * (volume_m3 - self.volume_m3));
        let expanded_pa = BladderGas::after_expansion_pa(self.pressure_pa, mean_m3, half_m3);
        let valved_pa = self.valve.advance(expanded_pa, command_pa, mean_m3);
        self.pressure_pa = BladderGas::after_expansion_pa(valved_pa, mean_m3, half_m3);
        (self.length_m, self.moment_arm_m, self.volume_m3) = (at.length_m, at.moment_arm_m, volume_m3);
        self.pull();
        let torque_n_m = self.moment_arm_m * self.force_n
            - carried * physics.elbow.gravity_n_m(sine, cosine)
            - physics.damping_n_m_s * half_rad_per_s;
        self.ddq_rad_per_s2 = torque_n_m / physics.elbow.inertia_kg_m2;
        self.dq_rad_per_s = half_rad_per_s + 0.5 * step_s * self.ddq_rad_per_s2;
    }

    /// Tension at the present pressure, length and friction.
    fn pull(&mut self) {
        let physics = self.physics;
        let state = self.friction.state;
        let tension_n = physics.force.force_n(self.pressure_pa, self.length_m, physics.friction_scale * state);
        self.slack = tension_n < 0.0;
        let passed_on = if physics.bowden > 0.0 { (-physics.bowden * state).exp() } else { 1.0 };
        self.force_n = tension_n.max(0.0) * passed_on;
    }
}
