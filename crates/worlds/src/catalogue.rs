//! Every effect in its forms, and which half each form belongs to.
//!
//! The half `choose` is for those who choose methods and constants; the half `report` is for those who report how good the
//! outcome is. Every effect has at least one form in each half, and no form is in both. Once both have been looked at, the
//! third part, [`crate::sealed`], has forms and worlds that are in neither.

use crate::forms::{Build, fixture, friction, geometry, memory, nameless, pneumatics, slow};
use crate::protocol::Kind;
use crate::sealed;

/// Half that a form belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// For choosing.
    Choose,
    /// For reporting.
    Report,
    /// Beside the halves: other forms in other worlds, for when both halves have been looked at.
    Sealed,
}

impl Half {
    /// Name, for the truth.
    pub fn name(self) -> &'static str {
        match self {
            Self::Choose => "choose",
            Self::Report => "report",
            Self::Sealed => "sealed",
        }
    }
}

/// One form of one effect.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// Catalogue id, or `nameless`.
    pub id: &'static str,
    /// Name of the form.
    pub form: &'static str,
    /// Half.
    pub half: Half,
    /// Builder.
    pub build: Build,
    /// Protocols that show the effect.
    pub wants: &'static [Kind],
    /// Whether only minutes show it.
    pub slow: bool,
}

pub(crate) const fn form(
    id: &'static str,
    form: &'static str,
    half: Half,
    build: Build,
    wants: &'static [Kind],
    slow: bool,
) -> Form {
    Form { id, form, half, build, wants, slow }
}

const TURNS: &[Kind] = &[Kind::MinorLoops, Kind::Isobaric, Kind::HandPulled, Kind::LengthChirp];
const SPEEDS: &[Kind] = &[Kind::RateLadder, Kind::LengthChirp, Kind::HandPulled];
const LOADS: &[Kind] = &[Kind::Isobaric, Kind::Multisine, Kind::MinorLoops];
const HOLDS: &[Kind] = &[Kind::LengthSteps, Kind::HandPulled];
const PRESSURE_HOLDS: &[Kind] = &[Kind::PressureSteps];
const STROKES: &[Kind] = &[Kind::Isobaric, Kind::Multisine];
const RAMPS: &[Kind] = &[Kind::IsometricRamps];
const AIR: &[Kind] = &[Kind::PressureChirp, Kind::PressureSteps, Kind::Multisine];
const FAST: &[Kind] = &[Kind::LengthChirp];
const ANY: &[Kind] = &[Kind::Multisine, Kind::Isobaric, Kind::IsometricRamps, Kind::LengthChirp];

use Half::{Choose, Report};

/// Forms of the effects that the catalogue names.
pub const NAMED: &[Form] = &[
    form("presliding-hysteresis", "lugre", Choose, friction::presliding_lugre, TURNS, false),
    form("presliding-hysteresis", "maxwell-slip", Choose, friction::presliding_maxwell_slip, TURNS, false),
    form("presliding-hysteresis", "dahl", Report, friction::presliding_dahl, TURNS, false),
    form("presliding-hysteresis", "bouc-wen", Report, friction::presliding_bouc_wen, TURNS, false),
    form("presliding-hysteresis", "iwan", Report, friction::presliding_iwan, TURNS, false),
    form("rubber-hysteresis", "dahl-constant", Choose, friction::rubber_dahl, TURNS, false),
    form("rubber-hysteresis", "prandtl-ishlinskii", Report, friction::rubber_prandtl, TURNS, false),
    form("rubber-hysteresis", "share-of-bladder", Report, friction::rubber_of_bladder, TURNS, false),
    form("stribeck", "gaussian", Choose, friction::stribeck_gaussian, SPEEDS, false),
    form("stribeck", "rational", Choose, friction::stribeck_rational, SPEEDS, false),
    form("stribeck", "exponential", Report, friction::stribeck_exponential, SPEEDS, false),
    form("stribeck", "aging-contacts", Report, friction::stribeck_aging, SPEEDS, false),
    form("viscous-damping", "linear", Choose, friction::viscous_linear, SPEEDS, false),
    form("viscous-damping", "power", Choose, friction::viscous_power, SPEEDS, false),
    form("viscous-damping", "asymmetric", Report, friction::viscous_asymmetric, SPEEDS, false),
    form("viscous-damping", "by-pressure", Report, friction::viscous_by_pressure, SPEEDS, false),
    form("rate-dependent-hysteresis", "logarithmic", Choose, friction::rate_logarithmic, SPEEDS, false),
    form("rate-dependent-hysteresis", "power", Report, friction::rate_power, SPEEDS, false),
    form("rate-dependent-hysteresis", "eyring", Report, friction::rate_eyring, SPEEDS, false),
    form("load-dependent-friction", "amontons", Choose, friction::load_amontons, LOADS, false),
    form("load-dependent-friction", "capstan", Report, friction::load_capstan, LOADS, false),
    form("viscoelastic-relaxation", "zener", Choose, memory::relaxation_zener, HOLDS, false),
    form("viscoelastic-relaxation", "fractional", Choose, memory::relaxation_fractional, HOLDS, false),
    form("viscoelastic-relaxation", "two-branches", Report, memory::relaxation_two_branches, HOLDS, false),
    form("viscoelastic-relaxation", "burgers", Report, memory::relaxation_burgers, HOLDS, false),
    form("pressure-creep", "exponential", Choose, memory::creep_exponential, PRESSURE_HOLDS, false),
    form("pressure-creep", "logarithmic", Report, memory::creep_logarithmic, PRESSURE_HOLDS, false),
    form("pressure-creep", "two-exponentials", Report, memory::creep_two_exponentials, PRESSURE_HOLDS, false),
    form("mullins-softening", "exponential-largest", Choose, memory::mullins_exponential, STROKES, false),
    form("mullins-softening", "ogden-roxburgh", Report, memory::mullins_ogden_roxburgh, STROKES, false),
    form("mullins-softening", "settling-cycles", Report, memory::mullins_settling, STROKES, false),
    form("thermal-softening", "self-heating-softening", Choose, slow::thermal_softening, STROKES, true),
    form("thermal-softening", "self-heating-entropic", Report, slow::thermal_entropic, STROKES, true),
    form("thermal-softening", "room-logged", Report, slow::thermal_room, STROKES, true),
    form("fatigue-wear", "linear", Choose, slow::wear_linear, STROKES, true),
    form("fatigue-wear", "power", Report, slow::wear_power, STROKES, true),
    form("fatigue-wear", "set-of-length", Report, slow::wear_set, STROKES, true),
    form("threshold-pressure", "softplus", Choose, geometry::threshold_soft, RAMPS, false),
    form("threshold-pressure", "hyperbola", Choose, geometry::threshold_hyperbola, RAMPS, false),
    form("threshold-pressure", "dead-band", Report, geometry::threshold_hard, RAMPS, false),
    form("threshold-pressure", "bladder-own", Report, geometry::threshold_bladder, RAMPS, false),
    form("end-taper", "conical", Choose, geometry::taper_conical, STROKES, false),
    form("end-taper", "round-caps", Report, geometry::taper_caps, STROKES, false),
    form("end-taper", "inactive-length", Report, geometry::taper_inactive, STROKES, false),
    form("braid-lockup", "softplus", Choose, geometry::lock_up_soft, STROKES, false),
    form("braid-lockup", "cubic", Choose, geometry::lock_up_cubic, STROKES, false),
    form("braid-lockup", "exponential", Report, geometry::lock_up_exponential, STROKES, false),
    form("braid-lockup", "jam", Report, geometry::lock_up_jam, STROKES, false),
    form("slack", "softplus", Choose, geometry::slack_soft, STROKES, false),
    form("slack", "clamp", Report, geometry::slack_hard, STROKES, false),
    form("slack", "dead-length", Report, geometry::slack_dead_length, STROKES, false),
    form("pressure-lag", "first-order", Choose, pneumatics::lag_first, AIR, false),
    form("pressure-lag", "choked", Choose, pneumatics::lag_choked, AIR, false),
    form("pressure-lag", "two-in-series", Report, pneumatics::lag_second, AIR, false),
    form("pressure-lag", "by-volume", Report, pneumatics::lag_volume, AIR, false),
    form("pressure-gauge-hysteresis", "play", Choose, pneumatics::gauge_play, AIR, false),
    form("pressure-gauge-hysteresis", "bouc-wen", Report, pneumatics::gauge_bouc_wen, AIR, false),
    form("pressure-gauge-hysteresis", "preisach", Report, pneumatics::gauge_preisach, AIR, false),
    form("channel-delay", "pure", Choose, fixture::delay_pure, ANY, false),
    form("channel-delay", "wandering", Report, fixture::delay_wandering, ANY, false),
    form("series-compliance", "linear", Choose, fixture::compliance_linear, RAMPS, false),
    form("series-compliance", "hardening", Report, fixture::compliance_hardening, RAMPS, false),
    form("inertia", "mass", Choose, fixture::inertia_mass, FAST, false),
    form("inertia", "mass-on-spring", Report, fixture::inertia_spring, FAST, false),
    form("force-drift", "linear", Choose, slow::drift_linear, ANY, true),
    form("force-drift", "saturating", Choose, slow::drift_saturating, ANY, true),
    form("force-drift", "wandering", Report, slow::drift_wandering, ANY, true),
    form("force-step", "jump", Choose, slow::step_jump, ANY, false),
    form("force-step", "settling", Report, slow::step_settling, ANY, false),
];

/// Forms that no catalogue names.
pub const NAMELESS: &[Form] = &[
    form("nameless", "touching-object", Choose, nameless::touching_object, STROKES, false),
    form("nameless", "kinked-hose", Choose, nameless::kinked_hose, AIR, false),
    form("nameless", "bad-spot", Choose, nameless::bad_spot, ANY, false),
    form("nameless", "creeping-clamp", Choose, nameless::creeping_clamp, ANY, false),
    form("nameless", "eccentric-pulley", Choose, nameless::eccentric_pulley, STROKES, false),
    form("nameless", "stick-at-one-length", Choose, nameless::stick_at_one_length, STROKES, false),
    form("nameless", "encoder-slip", Choose, nameless::encoder_slip, ANY, false),
    form("nameless", "room-swing", Report, nameless::room_swing, ANY, false),
    form("nameless", "loose-fitting", Report, nameless::loose_fitting, TURNS, false),
    form("nameless", "leak-while-holding", Report, nameless::leak_while_holding, PRESSURE_HOLDS, false),
    form("nameless", "second-muscle", Report, nameless::second_muscle, STROKES, false),
    form("nameless", "supply-sagging", Report, nameless::supply_sagging, AIR, false),
    form("nameless", "dead-zone", Report, nameless::dead_zone, RAMPS, false),
    form("nameless", "one-way-catch", Report, nameless::one_way_catch, STROKES, false),
];

/// Catalogue ids, in the order of their forms, each once.
pub fn ids() -> Vec<&'static str> {
    let mut ids: Vec<&'static str> = Vec::new();
    for form in NAMED {
        if !ids.contains(&form.id) {
            ids.push(form.id);
        }
    }
    ids
}

/// Forms of an effect in a half.
pub fn named(id: &str, half: Half) -> Vec<&'static Form> {
    NAMED.iter().chain(sealed::NAMED).filter(|form| form.id == id && form.half == half).collect()
}

/// Forms of a half that no catalogue names.
pub fn nameless(half: Half) -> Vec<&'static Form> {
    NAMELESS.iter().chain(sealed::NAMELESS).filter(|form| form.half == half).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_a_form_in_each_half() {
        assert_eq!(ids().len(), 22);
        for half in [Choose, Report, Half::Sealed] {
            for id in ids() {
                assert!(!named(id, half).is_empty(), "{id} {half:?}");
            }
            assert!(nameless(half).len() >= 6);
        }
    }

    #[test]
    fn no_form_is_in_two_halves_and_none_has_an_id_of_its_own() {
        let all: Vec<&Form> = NAMED.iter().chain(NAMELESS).chain(sealed::NAMED).chain(sealed::NAMELESS).collect();
        for (index, form) in all.iter().enumerate() {
            assert!(!all[..index].iter().any(|other| (other.id, other.form) == (form.id, form.form)), "{}", form.form);
            assert!(form.id == "nameless" || ids().contains(&form.id), "{}", form.id);
        }
    }
}
