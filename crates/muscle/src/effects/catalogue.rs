//! Every effect: instruments, the bench around the muscle, the muscle, events.
//!
//! A new one is a file here and two lines below.

mod braid_lockup;
mod channel_delay;
pub mod end_stretch;
mod end_taper;
mod fatigue_wear;
mod force_drift;
mod force_step;
mod inertia;
mod load_dependent_friction;
mod mullins_softening;
mod presliding_hysteresis;
mod pressure_creep;
mod pressure_gauge_hysteresis;
mod pressure_lag;
mod rate_dependent_hysteresis;
mod rubber_hysteresis;
mod series_compliance;
mod slack;
pub mod static_map;
mod stribeck;
mod thermal_softening;
mod threshold_pressure;
mod viscoelastic_relaxation;
mod viscous_damping;

pub use inertia::Mount;

use super::Effect;

/// Every effect that a diagnosis may name.
pub static CATALOGUE: &[&dyn Effect] = &[
    &channel_delay::ChannelDelay,
    &pressure_gauge_hysteresis::PressureGaugeHysteresis,
    &force_drift::ForceDrift,
    &series_compliance::SeriesCompliance,
    &inertia::Inertia,
    &slack::Slack,
    &pressure_lag::PressureLag,
    &threshold_pressure::ThresholdPressure,
    &end_taper::EndTaper,
    &braid_lockup::BraidLockup,
    &presliding_hysteresis::PreslidingHysteresis,
    &rubber_hysteresis::RubberHysteresis,
    &stribeck::Stribeck,
    &rate_dependent_hysteresis::RateDependentHysteresis,
    &load_dependent_friction::LoadDependentFriction,
    &viscous_damping::ViscousDamping,
    &viscoelastic_relaxation::ViscoelasticRelaxation,
    &pressure_creep::PressureCreep,
    &mullins_softening::MullinsSoftening,
    &thermal_softening::ThermalSoftening,
    &fatigue_wear::FatigueWear,
    &force_step::ForceStep,
];

/// Parts that a model may carry beside eq. 11 without a name in physics; a diagnosis never names it.
pub static NAMELESS: &[&dyn Effect] = &[&static_map::StaticMap, &end_stretch::EndStretch];

/// The effect with an id of the catalogue, or of what has no name.
pub fn effect(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().chain(NAMELESS).copied().find(|effect| effect.page().id == id)
}

#[cfg(test)]
mod tests;
