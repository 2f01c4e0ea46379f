//! The muscle of the plant and the cable behind it: what they pull, and what they remember of their motion.
//!
//! ```text
//! T = max(F(p, L, s z), 0) e^{-μΘ z}
//! ```
//!
//! | symbol | code                    | unit | meaning                                                     |
//! |--------|-------------------------|------|-------------------------------------------------------------|
//! | `T`    | `tension_n`             | N    | tension at the joint; a cable does not push                 |
//! | `F`    | [`AugmentedModel`]      | N    | eq. 11 with the friction's state for its direction, and effects beyond it |
//! | `z`    | [`Dahl`]                | 1    | state of the friction, 1 where the muscle has contracted    |
//! | `s`    | `friction_scale`        | 1    | factor on the friction of the force model                   |
//! | `μΘ`   | `bowden`                | 1    | friction times wrap of a Bowden cable (capstan)             |
//!
//! # Design
//! The arm asks for nothing but the tension after each step, and hands over nothing but the step, the pressure
//! and the length at its end. Whatever else a muscle remembers is a state here and concerns no other file. Where the
//! model has effects, those that the friction slides by take the place of `z` in eq. 11; `z` is the direction of the
//! others, and what a Bowden cable rubs by.

use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::{BaseParameters, ForceModel, Parameter};

use super::Dahl;
use crate::history::History;

/// Constants of one muscle; see the [module](self).
#[derive(Debug, Clone)]
pub struct MusclePhysics {
    /// Force of the muscle.
    force: AugmentedModel,
    /// Factor on the direction in eq. 11; 1 where there are effects, whose eq. 11 has it in its parameters.
    friction_scale: f64,
    /// Travel of pre-sliding, in m.
    presliding_m: f64,
    /// `μΘ`.
    bowden: f64,
}

impl MusclePhysics {
    /// A muscle whose friction in eq. 11 is `friction_scale` times that of `force`.
    pub fn new(force: &AugmentedModel, friction_scale: f64, presliding_m: f64, bowden: f64) -> Self {
        if force.is_plain() {
            return Self { force: force.clone(), friction_scale, presliding_m, bowden };
        }
        // Effects take the direction for themselves.
        let base = force.base();
        let mut theta = base.parameters().theta;
        for parameter in [Parameter::RubberFriction, Parameter::StrandFriction] {
            theta[parameter.index()] *= friction_scale;
        }
        let base = ForceModel::new(base.muscle(), base.strand_modulus_pa(), base.form(), BaseParameters { theta });
        Self { force: force.on(base), friction_scale: 1.0, presliding_m, bowden }
    }

    /// Force of the muscle.
    pub fn force(&self) -> &AugmentedModel {
        &self.force
    }

    /// `T` without a cable's refusal to push, at rest: negative where the muscle would.
    pub fn thrust_n(&self, pressure_pa: f64, length_m: f64, friction_state: f64) -> f64 {
        let force_n = self.force.settled_force_n(pressure_pa, length_m, self.friction_scale * friction_state);
        self.through_the_cable_n(force_n, friction_state)
    }

    fn through_the_cable_n(&self, force_n: f64, friction_state: f64) -> f64 {
        if self.bowden > 0.0 { force_n * (-self.bowden * friction_state).exp() } else { force_n }
    }
}

/// One muscle in motion.
#[derive(Debug)]
pub struct PlantMuscle<'a> {
    physics: &'a MusclePhysics,
    friction: Dahl,
    /// What effects remember, where there are any.
    history: Option<History>,
    length_m: f64,
}

/// What a muscle does after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    /// Tension at the joint, in N.
    pub tension_n: f64,
    /// Whether the muscle would push and the cable hangs slack.
    pub slack: bool,
}

impl<'a> PlantMuscle<'a> {
    /// A muscle that has rested at a length with a state of its friction, -1 to 1.
    pub fn at_rest(physics: &'a MusclePhysics, length_m: f64, friction_state: f64) -> Self {
        let history = (!physics.force.is_plain()).then(|| History::new(physics.force.clone()));
        Self { physics, friction: Dahl::new(physics.presliding_m, friction_state), history, length_m }
    }

    /// Active length, in m.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// State of the friction.
    pub fn friction_state(&self) -> f64 {
        self.friction.state
    }

    /// Moves on by `step_s` to a pressure and a length. The muscle's own speed is the change of length over the
    /// step; a `step_s` of 0 asks for the tension at rest.
    pub fn advance(&mut self, step_s: f64, pressure_pa: f64, length_m: f64) -> Pull {
        let contraction_m = self.length_m - length_m;
        self.length_m = length_m;
        let state = self.friction.advance(contraction_m);
        let Some(history) = &mut self.history else {
            let thrust_n = self.physics.thrust_n(pressure_pa, length_m, state);
            return Pull { tension_n: thrust_n.max(0.0), slack: thrust_n < 0.0 };
        };
        let force_n = history.advance(step_s, pressure_pa, length_m, state);
        let thrust_n = self.physics.through_the_cable_n(force_n, state);
        Pull { tension_n: thrust_n.max(0.0), slack: thrust_n < 0.0 || history.is_slack() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::nominal_model;

    fn physics() -> MusclePhysics {
        MusclePhysics::new(&nominal_model().into(), 1.0, 1e-3, 0.1)
    }

    #[test]
    fn friction_is_that_of_the_model_once_pre_sliding_is_over() {
        let physics = MusclePhysics { bowden: 0.0, ..physics() };
        let mut muscle = PlantMuscle::at_rest(&physics, 0.25, 0.0);
        for (step, direction) in [(-2e-5, 1.0), (2e-5, -1.0)] {
            let mut pull = muscle.advance(1e-3, 1e5, 0.25);
            for _ in 0..1000 {
                pull = muscle.advance(1e-3, 1e5, muscle.length_m() + step);
            }
            let expected_n = physics.force.settled_force_n(1e5, muscle.length_m(), direction);
            assert!((pull.tension_n - expected_n).abs() < 1e-6, "{pull:?} {expected_n}");
        }
    }

    #[test]
    fn a_bowden_cable_passes_on_less_while_contracting_and_more_while_extending() {
        let physics = physics();
        let through = |state: f64| physics.thrust_n(1e5, 0.25, state) / physics.force.settled_force_n(1e5, 0.25, state);
        assert!((through(1.0) - (-0.1_f64).exp()).abs() < 1e-12 && (through(-1.0) - 0.1_f64.exp()).abs() < 1e-12);
    }

    #[test]
    fn a_cable_does_not_push() {
        let physics = physics();
        // At 30 % contraction a muscle without pressure would have to be compressed.
        let pull = PlantMuscle::at_rest(&physics, 0.187, 0.0).advance(0.0, 0.0, 0.187);
        assert!(pull.slack && pull.tension_n.abs() < f64::EPSILON, "{pull:?}");
    }
}
