//! A configuration and a muscle together: lifts that can be run.

use pam_muscle::effects::AugmentedModel;
use rand_pcg::Pcg64;

use crate::arm::{Elbow, Lever, Load};
use crate::config::LiftPlan;
use crate::control::Knowledge;
use crate::inverse::Inverse;
use crate::lift::{Instant, Lift, Outcome};
use crate::plant::{ArmPhysics, BladderGas, MusclePhysics, Sensor};

/// Everything that a lift needs but what is drawn.
#[derive(Clone, Copy)]
pub struct Simulation<'a> {
    /// Configuration.
    pub plan: &'a LiftPlan,
    /// Force of the muscle as the controller knows it, without instruments, fixture and events.
    pub model: &'a AugmentedModel,
    /// Its inverse.
    pub inverse: &'a dyn Inverse,
    /// Force of the muscle as it is, likewise.
    pub plant: &'a AugmentedModel,
}

impl std::fmt::Debug for Simulation<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Simulation").field("plan", self.plan).finish_non_exhaustive()
    }
}

/// How one lift differs from the configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// Factor on mass and inertia of the load.
    pub payload: f64,
    /// Factor on the friction.
    pub friction: f64,
    /// Factor on the valve's lag.
    pub lag: f64,
    /// Factors on the muscle's end on the upper arm, on the forearm, and on the load arm.
    pub geometry: [f64; 3],
    /// Added to the mounted length, in m.
    pub mounting_m: f64,
    /// Factor on the noise of the sensors.
    pub noise: f64,
    /// State of the friction before the lift, left and right.
    pub friction_state: [f64; 2],
}

impl Deviation {
    /// None: the lift as configured.
    pub fn none(plan: &LiftPlan) -> Self {
        Self {
            payload: 1.0,
            friction: 1.0,
            lag: 1.0,
            geometry: [1.0; 3],
            mounting_m: 0.0,
            noise: 1.0,
            friction_state: [plan.friction_state; 2],
        }
    }
}

impl Simulation<'_> {
    /// Active length of the muscle at `q = 0`, in m.
    pub fn mounted_length_m(&self) -> f64 {
        self.plan.mounted_length_m.unwrap_or(self.model.base().muscle().rest_length_m)
    }

    /// Muscle on the elbow, as configured.
    pub fn lever(&self) -> Lever {
        Lever::new(self.plan.upper_m, self.plan.lower_m, self.mounted_length_m())
    }

    /// Model of the controller.
    pub fn knowledge(&self) -> Knowledge<'_> {
        let plan = self.plan;
        Knowledge {
            load: plan.load,
            forearm: plan.forearm,
            lever: self.lever(),
            gas: BladderGas::new(self.model.base().muscle(), plan.dead_volume_m3),
            force: self.model,
            inverse: self.inverse,
        }
    }

    /// One arm of the plant with a deviation and the muscle `force`.
    pub fn physics(&self, deviation: &Deviation, force: &AugmentedModel) -> ArmPhysics {
        let plan = self.plan;
        let [upper, lower, load_arm] = deviation.geometry;
        let scale = if plan.load.mass_kg > 0.0 { plan.true_mass_kg / plan.load.mass_kg } else { 1.0 };
        let load = Load {
            mass_kg: plan.true_mass_kg * deviation.payload,
            inertia_kg_m2: plan.load.inertia_kg_m2 * scale * deviation.payload,
            load_arm_m: plan.load.load_arm_m * load_arm,
        };
        let mut valve = plan.valve;
        valve.lag_s *= deviation.lag;
        ArmPhysics {
            elbow: Elbow::new(&load, &plan.forearm),
            lever: Lever::new(
                plan.upper_m * upper,
                plan.lower_m * lower,
                self.mounted_length_m() + deviation.mounting_m,
            ),
            muscle: MusclePhysics::new(
                force,
                plan.friction_factor * deviation.friction,
                plan.presliding_m,
                plan.bowden,
            ),
            damping_n_m_s: plan.damping_n_m_s,
            gas: BladderGas::new(force.base().muscle(), plan.dead_volume_m3),
            valve,
            step_s: plan.step_s,
        }
    }

    /// Both arms, left first; `watch` gets the arm, 0 or 1, and every period from the start of the lift on.
    pub fn run(
        &self,
        deviation: &Deviation,
        force: &AugmentedModel,
        rng: &mut Pcg64,
        mut watch: impl FnMut(usize, &Instant),
    ) -> [Outcome; 2] {
        let plan = self.plan;
        let (physics, knowledge) = (self.physics(deviation, force), self.knowledge());
        let noisy = |sensor: Sensor| Sensor { noise: sensor.noise * deviation.noise, ..sensor };
        [0, 1].map(|arm| {
            let lift = Lift {
                reference: plan.reference,
                handover_s: plan.handover_s,
                hold_s: plan.hold_s,
                settle_s: plan.settle_s,
                physics: &physics,
                knowledge: &knowledge,
                settings: &plan.control,
                angle_sensor: noisy(plan.angle_sensor),
                pressure_sensor: noisy(plan.pressure_sensor),
                transport_delay_s: plan.transport_delay_s,
                friction_state: deviation.friction_state[arm],
                diverged_rad: plan.diverged_rad,
            };
            lift.run(rng, |instant| watch(arm, instant))
        })
    }

    /// The lift as configured, from a seed.
    pub fn run_nominal(&self, seed: u64, watch: impl FnMut(usize, &Instant)) -> [Outcome; 2] {
        let mut rng = stream(seed, 0);
        self.run(&Deviation::none(self.plan), self.plant, &mut rng, watch)
    }
}

/// Random numbers of one trial; 0 is the lift as configured.
pub fn stream(seed: u64, trial: u64) -> Pcg64 {
    Pcg64::new(u128::from(seed), u128::from(trial))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::config::LiftConfig;
    use crate::inverse::ExactInverse;
    use crate::testing::{nominal_model, with_effect};

    fn plan() -> LiftPlan {
        let path = Path::new("lift.toml");
        let config = LiftConfig::parse(include_str!("../../../configs/lift.toml"), path).expect("the shipped file");
        config.check(path).expect("the shipped file")
    }

    /// Mean absolute angle error of a lift, in rad, and whether it was clean.
    fn lift(model: &AugmentedModel, plant: &AugmentedModel, effect_memory: bool) -> (f64, bool) {
        let mut plan = plan();
        plan.control.effect_memory = effect_memory;
        let inverse = ExactInverse::new(model.clone(), 0.0, 5e5);
        let simulation = Simulation { plan: &plan, model, inverse: &inverse, plant };
        let [left, right] = simulation.run_nominal(1, |_, _| {});
        (left.errors.angle_rad.mae.max(right.errors.angle_rad.mae), left.is_clean() && right.is_clean())
    }

    #[test]
    fn effects_of_size_zero_change_no_lift() {
        let zero = with_effect("load-dependent-friction", &[], &[0.0, 0.0]);
        let plain = AugmentedModel::from(nominal_model());
        let expected = lift(&plain, &plain, true);
        for (model, plant) in [(&plain, &zero), (&zero, &plain), (&zero, &zero)] {
            assert!((lift(model, plant, true).0 - expected.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_muscle_that_lags_follows_worse() {
        let plain = AugmentedModel::from(nominal_model());
        let without_rad = lift(&plain, &plain, true).0;
        for plant in [
            with_effect("viscoelastic-relaxation", &[0.3], &[0.3, 0.2, 0.1]),
            with_effect("pressure-creep", &[1.0, 0.0], &[0.1, 0.1, 0.1]),
            with_effect("viscous-damping", &[], &[500.0, 0.0]),
        ] {
            assert!(lift(&plain, &plant, true).0 > 3.0 * without_rad);
        }
        // A long tube is more than gains for a short one bear.
        assert!(!lift(&plain, &with_effect("pressure-lag", &[0.04, 0.0], &[]), true).1);
    }

    #[test]
    fn a_controller_that_knows_the_effects_follows_better() {
        let plain = AugmentedModel::from(nominal_model());
        let (threshold, relaxing) = (
            with_effect("threshold-pressure", &[4e4], &[]),
            with_effect("viscoelastic-relaxation", &[0.3], &[0.3, 0.2, 0.1]),
        );
        assert!(lift(&threshold, &threshold, true).0 < 0.2 * lift(&plain, &threshold, true).0);
        let remembering_rad = lift(&relaxing, &relaxing, true).0;
        assert!(remembering_rad < 0.3 * lift(&relaxing, &relaxing, false).0);
        assert!(remembering_rad < 0.3 * lift(&plain, &relaxing, true).0);
    }

    #[test]
    fn effects_have_the_friction_of_the_plan_as_eq_11_alone_has() {
        let plan = plan();
        let (plain, zero) =
            (AugmentedModel::from(nominal_model()), with_effect("load-dependent-friction", &[], &[0.0, 0.0]));
        let inverse = ExactInverse::new(plain.clone(), 0.0, 5e5);
        let simulation = Simulation { plan: &plan, model: &plain, inverse: &inverse, plant: &plain };
        let worn = Deviation { friction: 1.5, friction_state: [-1.0; 2], ..Deviation::none(&plan) };
        let [expected, found] =
            [&plain, &zero].map(|force| simulation.run(&worn, force, &mut stream(1, 0), |_, _| {})[0].errors.angle_rad);
        assert!((expected.max - found.max).abs() < 1e-9);
    }
}
