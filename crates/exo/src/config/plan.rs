//! The configuration as checked: SI, every range tested.

use crate::arm::{Forearm, Load};
use crate::control::ControlSettings;
use crate::plant::{Sensor, ValvePhysics};
use crate::reference::Quintic;

/// A lift that can be simulated, but for the muscle.
#[derive(Debug, Clone, PartialEq)]
pub struct LiftPlan {
    /// Reference.
    pub reference: Quintic,
    /// Time over which the load is laid onto the arms, in s.
    pub handover_s: f64,
    /// Time for which they hold it before the lift, in s.
    pub hold_s: f64,
    /// Time after the reference has come to rest, in s.
    pub settle_s: f64,
    /// Elbow to the muscle's end on the upper arm, in m.
    pub upper_m: f64,
    /// Elbow to the muscle's end on the forearm, in m.
    pub lower_m: f64,
    /// Active length of the muscle at `q = 0`, in m; the muscle's rest length where it is not given.
    pub mounted_length_m: Option<f64>,
    /// Load as the controller is told.
    pub load: Load,
    /// Mass of the load as it is, in kg.
    pub true_mass_kg: f64,
    /// Forearm.
    pub forearm: Forearm,
    /// Step of the plant, in s.
    pub step_s: f64,
    /// Travel of pre-sliding in the plant, in m.
    pub presliding_m: f64,
    /// Factor on the friction of the plant's force model.
    pub friction_factor: f64,
    /// State of the friction before the lift.
    pub friction_state: f64,
    /// Friction times wrap of a Bowden cable.
    pub bowden: f64,
    /// Viscous damping of the joint, in N m s.
    pub damping_n_m_s: f64,
    /// Valve of the plant.
    pub valve: ValvePhysics,
    /// Transport delay, in s.
    pub transport_delay_s: f64,
    /// Volume of fittings and tube, in m³.
    pub dead_volume_m3: f64,
    /// Sensor of the angle.
    pub angle_sensor: Sensor,
    /// Sensor of the pressure.
    pub pressure_sensor: Sensor,
    /// Controller.
    pub control: ControlSettings,
    /// Angle error at which a lift is given up, in rad.
    pub diverged_rad: f64,
    /// Variations of the trials of a robustness study.
    pub spreads: Spreads,
}

/// What the trials of a robustness study vary: half ranges of uniform distributions, as shares of the value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spreads {
    /// Mass of the load.
    pub payload: f64,
    /// Friction of the muscle.
    pub friction: f64,
    /// Lag of the valve.
    pub lag: f64,
    /// Both ends of the muscle and the load arm, each on its own.
    pub geometry: f64,
    /// Active length of the muscle as mounted, in m.
    pub mounting_m: f64,
    /// Noise of the sensors.
    pub noise: f64,
    /// Whether parameters of the force model are drawn from their covariance.
    pub model_parameters: bool,
}
