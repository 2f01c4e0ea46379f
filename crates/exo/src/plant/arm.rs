//! One arm: elbow, muscle, air and valve, in steps of a millisecond or finer.
//!
//! ```text
//! M q̈ = r(q) T - G(q) - d q̇ + τ_support
//! ```
//!
//! | symbol      | code                      | unit     | meaning                                             |
//! |-------------|---------------------------|----------|-----------------------------------------------------|
//! | `T`         | [`PlantMuscle`]           | N        | tension of the muscle, with all that it remembers   |
//! | `d`         | `damping_n_m_s`           | N m s    | viscous damping of the joint                        |
//! | `τ_support` | `carried`                 | N m      | whatever else carries the load, before the lift     |
//!
//! Velocity Verlet for the joint, the exact steps of friction and [`Valve`], half the gas's expansion before
//! the valve and half after it. One evaluation of the force a step.

use super::{BladderGas, MusclePhysics, PlantMuscle, Pull, Valve, ValvePhysics};
use crate::arm::{Elbow, Lever};

/// Constants of one arm; see the [module](self).
#[derive(Debug, Clone)]
pub struct ArmPhysics {
    /// Inertia and gravity.
    pub elbow: Elbow,
    /// Muscle on the elbow.
    pub lever: Lever,
    /// Force of the muscle.
    pub muscle: MusclePhysics,
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
#[derive(Debug)]
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
    /// Moment arm of the muscle, in m.
    pub moment_arm_m: f64,
    /// Muscle.
    pub muscle: PlantMuscle<'a>,
    /// What the muscle does.
    pub pull: Pull,
    valve: Valve,
    volume_m3: f64,
}

impl<'a> ArmPlant<'a> {
    /// An arm at rest at an angle, with a pressure and a state of the friction (-1 to 1).
    pub fn at_rest(physics: &'a ArmPhysics, q_rad: f64, pressure_pa: f64, friction_state: f64) -> Self {
        let at = physics.lever.at_angle(q_rad);
        let mut muscle = PlantMuscle::at_rest(&physics.muscle, at.length_m, friction_state);
        let pull = muscle.advance(0.0, pressure_pa, at.length_m);
        Self {
            physics,
            q_rad,
            dq_rad_per_s: 0.0,
            ddq_rad_per_s2: 0.0,
            pressure_pa,
            moment_arm_m: at.moment_arm_m,
            muscle,
            pull,
            valve: Valve::new(physics.valve, physics.step_s),
            volume_m3: physics.gas.volume_m3(at.length_m),
        }
    }

    /// Torque of gravity, in N m.
    pub fn gravity_n_m(&self) -> f64 {
        let (sine, cosine) = self.q_rad.sin_cos();
        self.physics.elbow.gravity_n_m(sine, cosine)
    }

    /// Torque of the muscle, in N m.
    pub fn torque_n_m(&self) -> f64 {
        self.moment_arm_m * self.pull.tension_n
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
        self.moment_arm_m = at.moment_arm_m;
        self.pressure_pa = self.pressure_after_pa(physics.gas.volume_m3(at.length_m), command_pa);
        self.pull = self.muscle.advance(step_s, self.pressure_pa, at.length_m);
        let torque_n_m = self.torque_n_m()
            - carried * physics.elbow.gravity_n_m(sine, cosine)
            - physics.damping_n_m_s * half_rad_per_s;
        self.ddq_rad_per_s2 = torque_n_m / physics.elbow.inertia_kg_m2;
        self.dq_rad_per_s = half_rad_per_s + 0.5 * step_s * self.ddq_rad_per_s2;
    }

    /// Pressure after a step in which the volume becomes `volume_m3`, in Pa gauge.
    fn pressure_after_pa(&mut self, volume_m3: f64, command_pa: f64) -> f64 {
        let per_m3 = 1.0 / (0.5 * (volume_m3 + self.volume_m3));
        let half_expansion = 0.5 * (volume_m3 - self.volume_m3) * per_m3;
        self.volume_m3 = volume_m3;
        let expanded_pa = BladderGas::after_expansion_pa(self.pressure_pa, half_expansion);
        let valved_pa = self.valve.advance(expanded_pa, command_pa, BladderGas::stiffness_pa_per_kg(per_m3));
        BladderGas::after_expansion_pa(valved_pa, half_expansion)
    }
}
