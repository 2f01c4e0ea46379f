//! Constants of one model as C sees them.

use std::f64::consts::PI;
use std::fmt::Write as _;

use pam_artifact::ModelArtifact;
use pam_muscle::direction::{STICKS_FROM_PA, STICKS_UP_TO, Standstill};
use pam_muscle::effects::Term;
use pam_muscle::effects::moment::{LATEX_C10_SHARE, LATEX_PA};
use pam_muscle::force::braid::Braid;
use pam_muscle::force::strand_friction::POISSON_RATIO;
use pam_muscle::force::{ForceModel, Form, Parameter};
use pam_muscle::motion::NOISE_PER_THRESHOLD;
use pam_muscle::smoothing::HALF_WINDOW_S;

use super::parts::Part;

/// A number as C reads it back to the bit, in brackets so that a sign stays with it.
pub(super) fn number(value: f64) -> String {
    if value.is_nan() {
        return "NAN".to_owned();
    }
    let text = format!("{value:?}");
    if value.is_sign_negative() { format!("({text})") } else { text }
}

/// Lines of `#define` for the names without their prefix.
pub(super) fn defines(constants: &[(String, f64)]) -> String {
    let mut text = String::new();
    for (name, value) in constants {
        // Writing to memory cannot fail.
        let _ = writeln!(text, "#define PAM_{name} {}", number(*value));
    }
    text
}

/// Eq. 11 of `model` and what follows from its muscle.
pub(super) fn of_eq11(model: &ForceModel) -> Vec<(String, f64)> {
    let muscle = model.muscle();
    let value = |parameter| model.parameters().of(parameter);
    let (c10_pa, c01_pa) = (value(Parameter::C10), value(Parameter::C01));
    let sum_pa = c10_pa + c01_pa;
    let (strand_m, turns) = (muscle.strand_length_m(), muscle.turns());
    let per_pi_turns = 1.0 / (PI * turns);
    let mid_wall_m = 2.0 * muscle.rest_radius_m - muscle.wall_thickness_m;
    let volume_m3 = model.bladder().rubber_volume_m3();
    let as_printed = model.form() == Form::AsPrinted;
    let turns_squared = turns * turns;
    let braid_area_m2 = strand_m * strand_m / if as_printed { PI * turns } else { 4.0 * PI * turns_squared };
    let radius_m = 0.5 * muscle.strand_diameter_m;
    let named = [
        ("PI", PI),
        ("REST_LENGTH_M", muscle.rest_length_m),
        ("LATEX_PA", LATEX_PA),
        ("MAX_CONTRACTION_RATIO", muscle.max_contraction_ratio()),
        ("REST_DIAMETER_M", 2.0 * muscle.rest_radius_m),
        ("AREA_M2", PI * muscle.rest_radius_m * muscle.rest_radius_m),
        ("GAS_A", 3.0 / muscle.braid_angle_rad.tan().powi(2)),
        ("GAS_B", 1.0 / muscle.braid_angle_rad.sin().powi(2)),
        ("K1", value(Parameter::K1)),
        ("K2", value(Parameter::K2)),
        ("K3_N", value(Parameter::K3)),
        ("C10_PA", c10_pa),
        ("C01_PA", c01_pa),
        ("C10_SHARE", if sum_pa > 0.0 { c10_pa / sum_pa } else { LATEX_C10_SHARE }),
        ("BLADDER_SIGN", model.form().bladder_sign()),
        ("AS_PRINTED", f64::from(u8::from(as_printed))),
        ("STRAND_COMPLIANCE_PER_PA", value(Parameter::StrandCompliance)),
        ("STRAIN_PER_M", Braid::new(muscle, model.form()).strain(1.0, 1.0, 1.0)),
        ("BRAID_AREA_M2", braid_area_m2),
        ("RUBBER_FRICTION", value(Parameter::RubberFriction)),
        ("STRAND_FRICTION", value(Parameter::StrandFriction)),
        ("CROSSINGS", 0.5 * turns * muscle.strand_count * muscle.strand_count),
        ("HERTZ_M_PER_PA", 1.5 * radius_m * (1.0 - POISSON_RATIO * POISSON_RATIO) / model.strand_modulus_pa()),
        ("STRAND_LENGTH_SQUARE_M2", strand_m.powi(2)),
        ("PER_PI_TURNS", per_pi_turns),
        ("PER_PI_TURNS_SQUARE", per_pi_turns * per_pi_turns),
        ("RUBBER_VOLUME_M3", volume_m3),
        ("WALL_TERM_M3", 4.0 * volume_m3 / PI),
        ("PER_REST_LENGTH", 1.0 / muscle.rest_length_m),
        ("PER_REST_MID_WALL", 1.0 / mid_wall_m),
        ("PER_REST_WALL", 1.0 / muscle.wall_thickness_m),
        ("STRETCH_PER_PA_M", model.slide_m_per_pa(1.0)),
    ];
    named.map(|(name, value)| (name.to_owned(), value)).into()
}

/// Parameters of effects, each under the id of its part and their names.
pub(super) fn of_effects(parts: &[(Part, &Term)]) -> Vec<(String, f64)> {
    let named = parts.iter().flat_map(|(part, term)| {
        let shapes = term.effect.shape().iter().map(|shape| shape.name);
        let names = shapes.chain(term.effect.amplitudes().iter().map(|amplitude| amplitude.name));
        let values = term.shape.iter().chain(&term.amplitudes).copied();
        let keeps = term.effect.keeps().iter().enumerate();
        let past = keeps.map(|(index, kept)| (kept.name, term.past.after.get(index).copied().unwrap_or(kept.fresh)));
        names.zip(values).chain(past).map(|(name, value)| (parameter(&part.id, name), value))
    });
    named.collect()
}

/// Name of a parameter in C, without its prefix.
pub(super) fn parameter(id: &str, name: &str) -> String {
    format!("{id}_{name}").replace('-', "_").to_uppercase()
}

/// Thresholds of the direction, for kinematics without the future.
pub(super) fn of_direction(artifact: &ModelArtifact, model: &ForceModel) -> Vec<(String, f64)> {
    let thresholds = artifact.direction;
    let (slides, over_pa, share) = match thresholds.standstill {
        Standstill::Held | Standstill::Sticks | Standstill::Relaxes { .. } => (0.0, 0.0, 1.0),
        Standstill::Slides { over_pa, share } => (1.0, over_pa, share),
    };
    let (relaxes, within_s, to) = match thresholds.standstill {
        Standstill::Relaxes { time_constant_s, to } => (1.0, time_constant_s, to),
        _ => (0.0, 1.0, 1.0),
    };
    let sticks = f64::from(u8::from(thresholds.standstill == Standstill::Sticks));
    let rest_slide_m_per_pa = model.slide_m_per_pa(model.muscle().rest_length_m);
    let named = [
        ("TURN_THRESHOLD_M", thresholds.length_m),
        ("PRESSURE_THRESHOLD_PA", thresholds.pressure_pa),
        ("HELD_M", thresholds.held_m),
        ("TURN_M", thresholds.turn_m),
        ("STANDSTILL_SLIDES", slides),
        ("STANDSTILL_OVER_PA", over_pa),
        ("STANDSTILL_SHARE", share),
        ("STANDSTILL_STICKS", sticks),
        ("STANDSTILL_RELAXES", relaxes),
        ("STANDSTILL_TIME_CONSTANT_S", within_s),
        ("STANDSTILL_RELAXES_TO", to),
        ("STICKS_UP_TO", STICKS_UP_TO),
        ("STICKS_FROM_PA", STICKS_FROM_PA),
        ("REST_SLIDE_THRESHOLD_M", rest_slide_m_per_pa * thresholds.pressure_pa),
        ("NOISE_PER_THRESHOLD", NOISE_PER_THRESHOLD),
        ("RATE_WINDOW_S", 2.0 * HALF_WINDOW_S),
    ];
    named.map(|(name, value)| (name.to_owned(), value)).into()
}
