//! Every effect, instruments first.

use super::Effect;
use super::presliding_hysteresis::PreslidingHysteresis;
use super::pressure_lag::PressureLag;
use super::viscous_damping::ViscousDamping;

/// Every effect that a diagnosis may name.
pub static CATALOGUE: &[&dyn Effect] = &[&PressureLag, &PreslidingHysteresis, &ViscousDamping];

/// The effect with a catalogue id.
pub fn effect(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().copied().find(|effect| effect.page().id == id)
}
