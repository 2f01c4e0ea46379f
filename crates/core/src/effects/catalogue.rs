//! Every effect: instruments, the bench around the muscle, the muscle, events.

use super::Effect;
use super::braid_lockup::BraidLockup;
use super::channel_delay::ChannelDelay;
use super::end_taper::EndTaper;
use super::fatigue_wear::FatigueWear;
use super::force_drift::ForceDrift;
use super::force_step::ForceStep;
use super::inertia::Inertia;
use super::load_dependent_friction::LoadDependentFriction;
use super::mullins_softening::MullinsSoftening;
use super::presliding_hysteresis::PreslidingHysteresis;
use super::pressure_creep::PressureCreep;
use super::pressure_gauge_hysteresis::PressureGaugeHysteresis;
use super::pressure_lag::PressureLag;
use super::rate_dependent_hysteresis::RateDependentHysteresis;
use super::rubber_hysteresis::RubberHysteresis;
use super::series_compliance::SeriesCompliance;
use super::slack::Slack;
use super::static_map::StaticMap;
use super::stribeck::Stribeck;
use super::thermal_softening::ThermalSoftening;
use super::threshold_pressure::ThresholdPressure;
use super::viscoelastic_relaxation::ViscoelasticRelaxation;
use super::viscous_damping::ViscousDamping;

/// Every effect that a diagnosis may name.
pub static CATALOGUE: &[&dyn Effect] = &[
    &ChannelDelay,
    &PressureGaugeHysteresis,
    &ForceDrift,
    &SeriesCompliance,
    &Inertia,
    &Slack,
    &PressureLag,
    &ThresholdPressure,
    &EndTaper,
    &BraidLockup,
    &PreslidingHysteresis,
    &RubberHysteresis,
    &Stribeck,
    &RateDependentHysteresis,
    &LoadDependentFriction,
    &ViscousDamping,
    &ViscoelasticRelaxation,
    &PressureCreep,
    &MullinsSoftening,
    &ThermalSoftening,
    &FatigueWear,
    &ForceStep,
];

/// Parts that a model may carry beside eq. 11 without a name in physics; a diagnosis never names it.
pub static NAMELESS: &[&dyn Effect] = &[&StaticMap];

/// The effect with an id of the catalogue, or of what has no name.
pub fn effect(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().chain(NAMELESS).copied().find(|effect| effect.page().id == id)
}

#[cfg(test)]
mod tests;
