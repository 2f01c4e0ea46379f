//! Computed torque, force, pressure (eqs 52–55), and what goes beyond.
//!
//! ```text
//! τ = M (q̈_s + K_d ė + K_p e + K_i ∫e - d) + G(q),   e = q_s - q                eqs 53, 54
//! f = max(τ / r(q), 0),   p = F⁻¹(f, l(q), z)                                  eqs 30, 31: once, from the total
//! ```
//!
//! The load is in `M` and `G`, not in a passive torque on top, and one pressure comes out of the total torque:
//! the inverse is no linear function, so that pressures of parts do not add up.
//!
//! | option               | what it does                                                                         |
//! |----------------------|--------------------------------------------------------------------------------------|
//! | integral action      | `K_i ∫e`, held while the command is clipped                                          |
//! | disturbance observer | opposes the acceleration `d` that the model leaves out; see [`Observer`]             |
//! | lag compensation     | `p_c = p_m + τ_v [(p - p_m)/τ_c + κ (p_m + p_atm) V̇/V]`, and `q_s`, `q̈_s` later by what lag is left |
//! | ramp                 | the command runs to `p` over the period, and `q_s`, `q̈_s` are those of its end        |
//! | hysteresis-aware     | `z` by Dahl's model on the observed angle, instead of the sign of `q̇_s`              |
//! | memory of effects    | `p = F⁻¹(f - m, l, z)`, `m` what effects beyond eq. 11 add to the settled force now    |
//! | payload estimation   | weighs the load before the lift: mean of `r F(p_m, l, z)` over the hold              |

use pam_muscle::effects::AugmentedModel;

use super::{ControlSettings, LengthSource, Observer};
use crate::arm::{Elbow, Forearm, Lever, LeverAt, Load};
use crate::history::History;
use crate::inverse::Inverse;
use crate::plant::{ATMOSPHERE_PA, BladderGas, Dahl, POLYTROPIC};
use crate::reference::Quintic;

/// What the controller believes of arm and muscle.
#[derive(Clone, Copy)]
pub struct Knowledge<'a> {
    /// Load.
    pub load: Load,
    /// Forearm.
    pub forearm: Forearm,
    /// Muscle on the elbow.
    pub lever: Lever,
    /// Air in the muscle.
    pub gas: BladderGas,
    /// Force of the muscle.
    pub force: &'a AugmentedModel,
    /// Inverse of its settled force.
    pub inverse: &'a dyn Inverse,
}

impl std::fmt::Debug for Knowledge<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Knowledge").field("load", &self.load).finish_non_exhaustive()
    }
}

/// What a period of the controller comes to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Command {
    /// Total torque, in N m.
    pub torque_n_m: f64,
    /// Force for it, in N.
    pub force_n: f64,
    /// Pressure for that, in Pa.
    pub desired_pa: f64,
    /// Pressure that the valve is told, in Pa.
    pub pressure_pa: f64,
    /// Whether the desired pressure lies beyond a limit.
    pub limited: Limited,
    /// Whether the inverse was asked outside what it knows.
    pub outside: bool,
}

/// At which limit a desired pressure lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Limited {
    /// Between the limits.
    #[default]
    No,
    /// At the lowest pressure, or no tension wanted.
    Low,
    /// At the highest pressure.
    High,
}

/// The controller of one arm; see the [module](self).
#[derive(Debug)]
pub struct Controller<'a> {
    settings: &'a ControlSettings,
    knowledge: &'a Knowledge<'a>,
    reference: &'a Quintic,
    load: Load,
    elbow: Elbow,
    observer: Observer,
    integral_rad_s: f64,
    friction: Dahl,
    /// Length that the friction has followed, in m, and by how much it lags: noise must not wear it away.
    followed_m: f64,
    direction: f64,
    /// Motion as measured, where effects are to be followed.
    history: Option<History>,
    /// What they add to the settled force now, in N.
    remembered_n: f64,
    pressure_pa: f64,
    weighed: Weighed,
}

/// The load as weighed so far.
#[derive(Debug, Clone, Copy, Default)]
struct Weighed {
    torque_n_m: f64,
    count: f64,
}

/// A lag of the pressure: to oppose it by the pressure is to feed it back, and the loop around the valve rings.
const LEFT_TO_THE_LOOP: &str = "pressure-lag";

/// What the controller remembers of effects; none where there is nothing to remember.
fn history(model: &AugmentedModel) -> Option<History> {
    let followed = model.terms().iter().filter(|term| term.effect.page().id != LEFT_TO_THE_LOOP).cloned().collect();
    let model = AugmentedModel::new(model.base().clone(), followed);
    (!model.is_plain()).then(|| History::new(model))
}

/// Play between observed length and friction, in m; five times what the observer leaves of the angle's noise.
const PLAY_M: f64 = 5e-5;

impl<'a> Controller<'a> {
    /// A controller at its first readings of angle and pressure.
    pub fn new(
        settings: &'a ControlSettings,
        knowledge: &'a Knowledge<'a>,
        reference: &'a Quintic,
        angle_rad: f64,
        pressure_pa: f64,
    ) -> Self {
        let observer = settings.disturbance_observer;
        Self {
            settings,
            knowledge,
            reference,
            load: knowledge.load,
            elbow: Elbow::new(&knowledge.load, &knowledge.forearm),
            observer: Observer::new(angle_rad, settings.period_s, settings.observer_rad_per_s, observer),
            integral_rad_s: 0.0,
            friction: Dahl::new(settings.presliding_m, 0.0),
            followed_m: knowledge.lever.at_angle(reference.from_rad).length_m,
            direction: if reference.to_rad < reference.from_rad { -1.0 } else { 1.0 },
            history: if settings.effect_memory { history(knowledge.force) } else { None },
            remembered_n: 0.0,
            pressure_pa,
            weighed: Weighed::default(),
        }
    }

    /// Load that the controller believes in, in kg.
    pub fn payload_kg(&self) -> f64 {
        self.load.mass_kg
    }

    /// One period at `time_s` from the start of the lift; `carried` of the weight hangs on the arm now and
    /// `carried_ahead` when the command takes effect.
    pub fn update(&mut self, time_s: f64, carried: [f64; 2], angle_rad: f64, pressure_pa: f64) -> Command {
        let (settings, knowledge) = (self.settings, self.knowledge);
        self.observe(carried[0], angle_rad, pressure_pa);
        let here = knowledge.lever.at_angle(self.observer.q_rad);
        self.follow_friction(here.length_m);
        self.follow_effects(pressure_pa);

        let now = self.reference.at(time_s);
        let ahead = self.reference.at(time_s + self.look_ahead_s());
        if now.dq_rad_per_s != 0.0 {
            self.direction = now.dq_rad_per_s.signum();
        }
        let error_rad = now.q_rad - self.observer.q_rad;
        let acceleration = ahead.ddq_rad_per_s2
            + settings.kd_per_s * (now.dq_rad_per_s - self.observer.dq_rad_per_s)
            + settings.kp_per_s2 * error_rad
            + settings.integral_per_s3 * self.integral_rad_s
            - self.observer.disturbance_rad_per_s2;
        let q_rad = match settings.length {
            LengthSource::Measured => self.observer.q_rad + ahead.q_rad - now.q_rad,
            LengthSource::Reference => ahead.q_rad,
        };
        let (sine, cosine) = q_rad.sin_cos();
        let there = knowledge.lever.at(sine, cosine);
        let torque_n_m = self.elbow.inertia_kg_m2 * acceleration + carried[1] * self.elbow.gravity_n_m(sine, cosine);
        let force_n = (torque_n_m / there.moment_arm_m).max(0.0);
        let direction = if settings.hysteresis_aware {
            self.friction.after(self.followed_m - there.length_m)
        } else {
            self.direction
        };
        let inverted = knowledge.inverse.pressure_pa(force_n - self.remembered_n, there.length_m, direction);
        let [lowest_pa, highest_pa] = settings.pressure_limits_pa;
        let limited = if inverted.pressure_pa >= highest_pa {
            Limited::High
        } else if inverted.pressure_pa <= lowest_pa {
            Limited::Low
        } else {
            Limited::No
        };
        if limited == Limited::No {
            self.integral_rad_s += settings.period_s * error_rad;
        }
        let desired_pa = inverted.pressure_pa.clamp(lowest_pa, highest_pa);
        let wanted_pa = self.through_the_valve_pa(desired_pa, pressure_pa, here, now.dq_rad_per_s);
        Command {
            torque_n_m,
            force_n,
            desired_pa,
            pressure_pa: wanted_pa.clamp(lowest_pa, highest_pa),
            limited,
            outside: inverted.outside,
        }
    }

    /// How far ahead a command takes effect, in s.
    pub fn look_ahead_s(&self) -> f64 {
        let settings = self.settings;
        // A held command acts half a period late on average, a ramp arrives at the end of the period.
        let arrives_s = if settings.ramp { settings.period_s } else { 0.5 * settings.period_s };
        if settings.lag_compensation {
            settings.pressure_loop_s + settings.transport_delay_s + arrives_s
        } else if settings.ramp {
            arrives_s
        } else {
            0.0
        }
    }

    /// Ends the hold: the load is what it weighed, and what stood in for that in observer and integral goes.
    pub fn begin_lift(&mut self) {
        let settings = self.settings;
        if !settings.payload_estimation || self.weighed.count == 0.0 {
            return;
        }
        let (sine, cosine) = self.reference.from_rad.sin_cos();
        let believed_n_m = self.elbow.gravity_n_m(sine, cosine);
        let weighed_n_m = self.weighed.torque_n_m / self.weighed.count;
        let mut load = self.knowledge.load;
        let per_kg_n_m = 0.5 * crate::arm::GRAVITY_M_PER_S2 * load.load_arm_m * cosine;
        let more_kg = ((weighed_n_m - believed_n_m) / per_kg_n_m).clamp(-load.mass_kg, 2.0 * load.mass_kg);
        let scale = if load.mass_kg > 0.0 { 1.0 + more_kg / load.mass_kg } else { 1.0 };
        load.mass_kg += more_kg;
        load.inertia_kg_m2 *= scale;
        let before = self.elbow;
        self.load = load;
        self.elbow = Elbow::new(&load, &self.knowledge.forearm);
        // Without a jump of the torque: M (K_i ∫e - d) + G stays.
        let kept_n_m = before.inertia_kg_m2
            * (settings.integral_per_s3 * self.integral_rad_s - self.observer.disturbance_rad_per_s2)
            + believed_n_m
            - self.elbow.gravity_n_m(sine, cosine);
        if settings.disturbance_observer {
            self.observer.disturbance_rad_per_s2 = -kept_n_m / self.elbow.inertia_kg_m2;
            self.integral_rad_s = 0.0;
        } else if settings.integral_per_s3 > 0.0 {
            self.integral_rad_s = kept_n_m / (self.elbow.inertia_kg_m2 * settings.integral_per_s3);
        }
    }

    /// Observer: the torque of the last period by the mean of its pressures.
    fn observe(&mut self, carried: f64, angle_rad: f64, pressure_pa: f64) {
        let (sine, cosine) = self.observer.q_rad.sin_cos();
        let at = self.knowledge.lever.at(sine, cosine);
        let mean_pa = 0.5 * (pressure_pa + self.pressure_pa);
        let state = if self.settings.hysteresis_aware { self.friction.state } else { self.direction };
        let force_n = self.knowledge.force.settled_force_n(mean_pa, at.length_m, state) + self.remembered_n;
        let torque_n_m = at.moment_arm_m * force_n.max(0.0);
        if self.settings.payload_estimation && carried >= 1.0 {
            self.weighed.torque_n_m += torque_n_m;
            self.weighed.count += 1.0;
        }
        let rest_n_m = torque_n_m - carried * self.elbow.gravity_n_m(sine, cosine);
        self.observer.advance(rest_n_m / self.elbow.inertia_kg_m2, angle_rad);
        self.pressure_pa = pressure_pa;
    }

    fn follow_friction(&mut self, length_m: f64) {
        let travel_m = self.followed_m - length_m;
        let beyond_m = travel_m.abs() - PLAY_M;
        if beyond_m > 0.0 {
            let step_m = beyond_m.copysign(travel_m);
            self.friction.advance(step_m);
            self.followed_m -= step_m;
        }
    }

    /// What effects add now to the force that they settle at.
    fn follow_effects(&mut self, pressure_pa: f64) {
        let Some(history) = &mut self.history else { return };
        let length_m = self.followed_m;
        let state = if self.settings.hysteresis_aware { self.friction.state } else { self.direction };
        history.advance(self.settings.period_s, pressure_pa, length_m, state);
        self.remembered_n = history.remembered_n();
    }

    /// What the valve must be told so that the pressure becomes the desired one.
    fn through_the_valve_pa(&self, desired_pa: f64, measured_pa: f64, here: LeverAt, dq_rad_per_s: f64) -> f64 {
        let settings = self.settings;
        if !settings.lag_compensation {
            return desired_pa;
        }
        let gas = &self.knowledge.gas;
        let rate_m_per_s = -here.moment_arm_m * dq_rad_per_s;
        let relative_per_s = gas.volume_slope_m2(here.length_m) * rate_m_per_s / gas.volume_m3(here.length_m);
        let expansion_pa_per_s = POLYTROPIC * (measured_pa + ATMOSPHERE_PA) * relative_per_s;
        measured_pa
            + settings.valve_lag_s * ((desired_pa - measured_pa) / settings.pressure_loop_s + expansion_pa_per_s)
    }
}
