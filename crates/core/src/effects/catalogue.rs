//! Every effect: instruments, the bench around the muscle, the muscle, events.

use super::Effect;
use super::load_dependent_friction::LoadDependentFriction;
use super::presliding_hysteresis::PreslidingHysteresis;
use super::pressure_creep::PressureCreep;
use super::pressure_lag::PressureLag;
use super::rate_dependent_hysteresis::RateDependentHysteresis;
use super::rubber_hysteresis::RubberHysteresis;
use super::stribeck::Stribeck;
use super::viscoelastic_relaxation::ViscoelasticRelaxation;
use super::viscous_damping::ViscousDamping;

/// Every effect that a diagnosis may name.
pub static CATALOGUE: &[&dyn Effect] = &[
    &PressureLag,
    &PreslidingHysteresis,
    &RubberHysteresis,
    &Stribeck,
    &RateDependentHysteresis,
    &LoadDependentFriction,
    &ViscousDamping,
    &ViscoelasticRelaxation,
    &PressureCreep,
];

/// The effect with a catalogue id.
pub fn effect(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().copied().find(|effect| effect.page().id == id)
}
