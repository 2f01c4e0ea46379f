//! One lift: hold, handover of the load, quintic, end.
//!
//! The load is first carried by something else, a table or the wearer, and laid onto the arms during the
//! handover, at the angle at which the lift starts; then the arms hold it for a while. Time counts from the
//! start of the lift. Without a hold the lift begins with the load on the arms and the pressure that the
//! controller expects to need. The controller knows the course of the handover, not the weight.
//!
//! Each period: sensors are read, the controller computes, the valve is told after the transport delay, the
//! plant goes on in its own steps. The two arms share the load and are coupled by nothing else, so one follows
//! the other here.

use rand_pcg::Pcg64;

use crate::arm::Elbow;
use crate::control::{Command, ControlSettings, Controller, Knowledge};
use crate::metrics::{ErrorSums, TrackingErrors};
use crate::plant::{ArmPhysics, ArmPlant, Delay, Sensor};
use crate::reference::{Quintic, ReferenceAt};
use crate::trouble::{Trouble, TroubleWatch};

/// A lift of one arm, everything but the random numbers.
#[derive(Debug, Clone)]
pub struct Lift<'a> {
    /// Reference.
    pub reference: Quintic,
    /// Time over which the load is laid onto the arms before the lift, in s; 0 for none.
    pub handover_s: f64,
    /// Time for which the arms then hold it, in s.
    pub hold_s: f64,
    /// Time after the reference has come to rest, in s.
    pub settle_s: f64,
    /// Plant.
    pub physics: &'a ArmPhysics,
    /// Model of the controller.
    pub knowledge: &'a Knowledge<'a>,
    /// Gains and options.
    pub settings: &'a ControlSettings,
    /// Sensor of the angle, in rad.
    pub angle_sensor: Sensor,
    /// Sensor of the pressure, in Pa.
    pub pressure_sensor: Sensor,
    /// Transport delay from command to valve, in s; a whole number of the plant's steps.
    pub transport_delay_s: f64,
    /// State of the friction before the lift, -1 to 1.
    pub friction_state: f64,
    /// Angle error at which the lift is given up, in rad.
    pub diverged_rad: f64,
}

/// An instant of one arm: what is, what should be, what was measured and commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Time from the start of the lift, in s.
    pub time_s: f64,
    /// Reference.
    pub reference: ReferenceAt,
    /// Angle, velocity and acceleration of the arm.
    pub state: ReferenceAt,
    /// Angle as read, in rad.
    pub measured_rad: f64,
    /// Torque of the load and all other weight, in N m; negative, it pulls down.
    pub load_torque_n_m: f64,
    /// Torque of the muscle, in N m.
    pub muscle_torque_n_m: f64,
    /// Tension of the muscle, in N.
    pub muscle_force_n: f64,
    /// Pressure in the muscle, in Pa.
    pub pressure_pa: f64,
    /// Pressure as read, in Pa.
    pub measured_pa: f64,
    /// Active length of the muscle, in m.
    pub length_m: f64,
    /// Its rate, in m/s.
    pub length_rate_m_per_s: f64,
    /// Its acceleration, in m/s².
    pub length_acceleration_m_per_s2: f64,
    /// State of the friction.
    pub friction_state: f64,
    /// Outcome of the controller.
    pub command: Command,
}

/// How a lift went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Errors, once every period of the controller from the start of the lift on, against the true state; all 0 where it
    /// was given up before.
    pub errors: TrackingErrors,
    /// Whether there was a lift at all: it is given up before its start where the arm does not stay at the angle that the
    /// lift starts from.
    pub began: bool,
    /// The first trouble of each kind: slack, saturated, diverged.
    pub troubles: [Option<Trouble>; 3],
    /// Whether the inverse was asked outside what it knows.
    pub outside: bool,
    /// Load that the controller believed in at the end, in kg.
    pub payload_kg: f64,
}

impl Outcome {
    /// Whether nothing went wrong.
    pub fn is_clean(&self) -> bool {
        self.troubles.iter().all(Option::is_none)
    }
}

/// What no arm does, in any unit that an instant has: beyond it a simulation has run away and sums of squares overflow.
const BEYOND_ALL: f64 = 1e100;

/// Whether the arm and the command for it still are numbers that mean something.
fn is_sane(plant: &ArmPlant<'_>, measured_pa: f64, command: &Command) -> bool {
    let state = [plant.q_rad, plant.dq_rad_per_s, plant.ddq_rad_per_s2, plant.pressure_pa, plant.pull.tension_n];
    let seen = [measured_pa, command.torque_n_m, command.force_n, command.desired_pa, command.pressure_pa];
    state.iter().chain(&seen).all(|value| value.abs() < BEYOND_ALL)
}

impl Lift<'_> {
    /// Periods before the lift.
    fn periods_before(&self) -> i64 {
        ((self.handover_s + self.hold_s) / self.settings.period_s).round() as i64
    }

    /// Periods of the lift and after it.
    fn periods_after(&self) -> i64 {
        ((self.reference.duration_s + self.settle_s) / self.settings.period_s).round() as i64
    }

    /// Share of the weight on the arms.
    fn carried(&self, time_s: f64) -> f64 {
        if self.handover_s > 0.0 {
            Quintic { from_rad: 0.0, to_rad: 1.0, duration_s: self.handover_s }
                .at(time_s + self.handover_s + self.hold_s)
                .q_rad
        } else {
            1.0
        }
    }

    /// Runs the lift; `watch` sees every period from the start of the lift on.
    pub fn run(&self, rng: &mut Pcg64, mut watch: impl FnMut(&Instant)) -> Outcome {
        let period_s = self.settings.period_s;
        let steps = (period_s / self.physics.step_s).round() as usize;
        let start_pa = self.start_pressure_pa();
        let mut plant = ArmPlant::at_rest(self.physics, self.reference.from_rad, start_pa, self.friction_state);
        let mut line = Delay::new((self.transport_delay_s / self.physics.step_s).round() as usize, start_pa);
        let angle_rad = self.angle_sensor.read(plant.q_rad, rng);
        let mut controller = Controller::new(self.settings, self.knowledge, &self.reference, angle_rad, start_pa);
        let mut sums = ErrorSums::default();
        let mut troubles = TroubleWatch::default();
        let mut told_pa = start_pa;
        let (mut outside, mut began) = (false, false);
        for period in -self.periods_before()..=self.periods_after() {
            let time_s = period as f64 * period_s;
            let measured_rad = self.angle_sensor.read(plant.q_rad, rng);
            let measured_pa = self.pressure_sensor.read(plant.pressure_pa, rng);
            if period == 0 {
                controller.begin_lift();
            }
            let carried = self.carried(time_s);
            let ahead = self.carried(time_s + controller.look_ahead_s());
            let command = controller.update(time_s, [carried, ahead], measured_rad, measured_pa);
            let reference = self.reference.at(time_s);
            let error_rad = reference.q_rad - plant.q_rad;
            let sane = is_sane(&plant, measured_pa, &command);
            let given_up = !sane || error_rad.abs() > self.diverged_rad;
            if period >= 0 && sane {
                began = true;
                let instant = self.instant(time_s, reference, &plant, [measured_rad, measured_pa], command);
                sums.add(time_s, &instant.reference, &instant.state);
                outside |= command.outside;
                troubles.look(&instant);
                watch(&instant);
            }
            if given_up {
                troubles.give_up(time_s, if sane { error_rad } else { f64::INFINITY });
                break;
            }
            let from_pa = std::mem::replace(&mut told_pa, command.pressure_pa);
            for step in 1..=steps {
                let share = if self.settings.ramp { step as f64 / steps as f64 } else { 1.0 };
                plant.advance(line.pass(told_pa - (1.0 - share) * (told_pa - from_pa)), carried);
                if plant.pull.slack && period >= 0 {
                    troubles.slacken(time_s, plant.q_rad);
                }
            }
        }
        Outcome {
            errors: sums.finish(period_s),
            began,
            troubles: troubles.found(),
            outside,
            payload_kg: controller.payload_kg(),
        }
    }

    /// Pressure before the first period: what the controller expects to need there.
    fn start_pressure_pa(&self) -> f64 {
        let knowledge = self.knowledge;
        let at = knowledge.lever.at_angle(self.reference.from_rad);
        let (sine, cosine) = self.reference.from_rad.sin_cos();
        let elbow = Elbow::new(&knowledge.load, &knowledge.forearm);
        let before_s = -(self.handover_s + self.hold_s);
        let force_n = (self.carried(before_s) * elbow.gravity_n_m(sine, cosine) / at.moment_arm_m).max(0.0);
        let direction = if self.settings.hysteresis_aware { 0.0 } else { 1.0 };
        let [lowest_pa, highest_pa] = self.settings.pressure_limits_pa;
        knowledge.inverse.pressure_pa(force_n, at.length_m, direction).pressure_pa.clamp(lowest_pa, highest_pa)
    }

    fn instant(
        &self,
        time_s: f64,
        reference: ReferenceAt,
        plant: &ArmPlant<'_>,
        [measured_rad, measured_pa]: [f64; 2],
        command: Command,
    ) -> Instant {
        let (q_rad, dq_rad_per_s, ddq_rad_per_s2) = (plant.q_rad, plant.dq_rad_per_s, plant.ddq_rad_per_s2);
        let motion = self.physics.lever.motion(q_rad, dq_rad_per_s, ddq_rad_per_s2);
        Instant {
            time_s,
            reference,
            state: ReferenceAt { q_rad, dq_rad_per_s, ddq_rad_per_s2 },
            measured_rad,
            load_torque_n_m: -plant.gravity_n_m(),
            muscle_torque_n_m: plant.torque_n_m(),
            muscle_force_n: plant.pull.tension_n,
            pressure_pa: plant.pressure_pa,
            measured_pa,
            length_m: plant.muscle.length_m(),
            length_rate_m_per_s: motion.length_rate_m_per_s,
            length_acceleration_m_per_s2: motion.length_acceleration_m_per_s2,
            friction_state: plant.muscle.friction_state(),
            command,
        }
    }
}
