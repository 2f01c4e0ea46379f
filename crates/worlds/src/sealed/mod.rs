//! The third part of the bench: forms and worlds that are in neither half, for when both have been looked at.
//!
//! Forms of the effects by other published equations, states and parametrizations: [`friction`], [`memory`], [`slow`],
//! [`geometry`], [`air`], [`fixture`], [`drift`]; what no catalogue has: [`nameless`]. Rubbers, turns of friction, laws at standstill,
//! calipers and sensors: [`world`]; recordings: [`protocol`].

use crate::catalogue::{Form, Half, form};
use crate::forms::Build;
use crate::protocol::Kind;

pub mod air;
pub mod drift;
pub mod fixture;
pub mod friction;
pub mod geometry;
pub mod memory;
pub mod nameless;
pub mod protocol;
pub mod slow;
pub mod world;

const TURNS: &[Kind] = &[Kind::DwelledSines, Kind::QuickRelease, Kind::HandHeld, Kind::RandomSteps];
const SPEEDS: &[Kind] = &[Kind::DwelledSines, Kind::GaitCycles, Kind::QuickRelease];
const LOADS: &[Kind] = &[Kind::GrowingSpiral, Kind::GaitCycles, Kind::LoadedHang];
const HOLDS: &[Kind] = &[Kind::RandomSteps, Kind::QuickRelease];
const PRESSURE_HOLDS: &[Kind] = &[Kind::Staircase, Kind::RandomSteps];
const STROKES: &[Kind] = &[Kind::GrowingSpiral, Kind::QuickRelease, Kind::GaitCycles];
const RAMPS: &[Kind] = &[Kind::Staircase];
const AIR: &[Kind] = &[Kind::GaitCycles, Kind::Staircase, Kind::RandomSteps];
const FAST: &[Kind] = &[Kind::DwelledSines];
const ANY: &[Kind] = &[Kind::RandomSteps, Kind::GrowingSpiral, Kind::GaitCycles, Kind::Staircase];

const fn of(id: &'static str, name: &'static str, build: Build, wants: &'static [Kind]) -> Form {
    form(id, name, Half::Sealed, build, wants, false)
}

const fn slowly(id: &'static str, name: &'static str, build: Build, wants: &'static [Kind]) -> Form {
    form(id, name, Half::Sealed, build, wants, true)
}

/// Forms of the effects that the catalogue names.
pub const NAMED: &[Form] = &[
    of("presliding-hysteresis", "endochronic", friction::presliding_endochronic, TURNS),
    of("presliding-hysteresis", "elasto-plastic", friction::presliding_elasto_plastic, TURNS),
    of("presliding-hysteresis", "dahl-exponent", friction::presliding_power, TURNS),
    of("rubber-hysteresis", "berg", memory::rubber_berg, TURNS),
    of("rubber-hysteresis", "triboelastic", memory::rubber_triboelastic, TURNS),
    of("stribeck", "secant", friction::stribeck_secant, SPEEDS),
    of("stribeck", "stretched", friction::stribeck_stretched, SPEEDS),
    of("stribeck", "frictional-memory", friction::stribeck_lagged, SPEEDS),
    of("viscous-damping", "carreau", friction::viscous_carreau, SPEEDS),
    of("viscous-damping", "newtonian-wall", friction::viscous_wall, SPEEDS),
    of("rate-dependent-hysteresis", "rate-and-state", friction::rate_state, SPEEDS),
    of("rate-dependent-hysteresis", "saturating", friction::rate_saturating, SPEEDS),
    of("load-dependent-friction", "elastic-contacts", friction::load_contacts, LOADS),
    of("load-dependent-friction", "wound-cable", friction::load_wound, LOADS),
    of("viscoelastic-relaxation", "stretched-exponential", memory::relaxation_stretched, HOLDS),
    of("viscoelastic-relaxation", "power-flow", memory::relaxation_power_flow, HOLDS),
    of("pressure-creep", "andrade", memory::creep_andrade, PRESSURE_HOLDS),
    of("pressure-creep", "activated-flow", memory::creep_activated, PRESSURE_HOLDS),
    of("mullins-softening", "simo", memory::mullins_simo, STROKES),
    of("mullins-softening", "dorfmann-ogden", memory::mullins_tanh, STROKES),
    slowly("thermal-softening", "two-nodes", slow::thermal_two_nodes, STROKES),
    slowly("thermal-softening", "cooling-after-warm-up", slow::thermal_cooling, STROKES),
    slowly("fatigue-wear", "friction-run-in", slow::wear_run_in, STROKES),
    slowly("fatigue-wear", "half-cycles", slow::wear_miner, STROKES),
    of("threshold-pressure", "rayleigh-contact", geometry::threshold_rayleigh, RAMPS),
    of("threshold-pressure", "exponential-contact", geometry::threshold_exponential, RAMPS),
    of("end-taper", "wide-ferrules", geometry::taper_ferrules, STROKES),
    of("end-taper", "factor-of-pressure", geometry::taper_factor, STROKES),
    of("braid-lockup", "contact", geometry::lock_up_contact, STROKES),
    of("braid-lockup", "pressed", geometry::lock_up_pressed, STROKES),
    of("slack", "hyperbola", geometry::slack_hyperbola, STROKES),
    of("slack", "sagging-cable", geometry::slack_sagging, STROKES),
    of("pressure-lag", "laminar", air::lag_laminar, AIR),
    of("pressure-lag", "mass-of-air", air::lag_mass, AIR),
    of("pressure-gauge-hysteresis", "endochronic", air::gauge_endochronic, AIR),
    of("pressure-gauge-hysteresis", "growing-play", air::gauge_growing, AIR),
    of("channel-delay", "growing", fixture::delay_growing, ANY),
    of("channel-delay", "polled", fixture::delay_polled, ANY),
    of("series-compliance", "contact", fixture::compliance_contact, RAMPS),
    of("series-compliance", "preloaded-joint", fixture::compliance_joint, RAMPS),
    of("inertia", "two-masses", fixture::inertia_two, FAST),
    of("inertia", "lever", fixture::inertia_lever, FAST),
    slowly("force-drift", "root-of-time", drift::drift_root, ANY),
    slowly("force-drift", "random-walk", drift::drift_walk, ANY),
    of("force-step", "back-in-part", drift::step_back, ANY),
    of("force-step", "slipping-bond", drift::step_slip, ANY),
];

/// Forms that no catalogue names.
pub const NAMELESS: &[Form] = &[
    of("nameless", "sleeve-wrinkle", nameless::sleeve_wrinkle, STROKES),
    of("nameless", "bundle-jump", nameless::bundle_jump, STROKES),
    slowly("nameless", "moist-air", nameless::moist_air, ANY),
    of("nameless", "pump-strokes", nameless::pump_strokes, PRESSURE_HOLDS),
    of("nameless", "sticking-swivel", nameless::sticking_swivel, AIR),
    of("nameless", "missed-pulses", nameless::missed_pulses, TURNS),
];
