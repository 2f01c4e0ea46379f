//! An empirical term in C: its sentence as one function over the parts of `templates/sentence.h`.

use std::fmt::Write as _;

use pam_muscle::effects::Amplitude;
use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale, Sentence};

use super::constants::{number, parameter};
use super::parts::Part;

/// The part of the `index`th empirical term of a model, from 1.
pub(super) fn part(index: usize, sentence: &Sentence, amplitudes: &[Amplitude]) -> Part {
    let id = format!("empirical-{index}");
    let text = text(&id, sentence, amplitudes);
    Part::new(&id, text)
}

fn text(id: &str, sentence: &Sentence, amplitudes: &[Amplitude]) -> String {
    let name = id.replace('-', "_");
    let [low, high] = sentence.seen.map(number);
    let constants: Vec<String> =
        amplitudes.iter().map(|amplitude| format!("PAM_{}", parameter(id, amplitude.name))).collect();
    let (tables, curve) = curve(&sentence.shape, &constants);
    let (turn, driver) = driver(&sentence.driver);
    let memory = memory(&sentence.memory);
    let factor = factor(sentence.scale);
    let mut body = tables;
    // Writing to memory cannot fail.
    let _ = write!(
        body,
        "    double argument, x;\n{turn}    pam_sentence_follow(memory, now, {driver});\n    argument = {memory};\n    \
         memory->started = 1;\n    x = fmin(fmax(argument, {low}), {high});\n    \
         return pam_sentence_weight(argument, {low}, {high}) * {factor}\n           * {curve};\n"
    );
    let base = if body.contains("base") { ", const pam_base *base" } else { "" };
    format!(
        "typedef pam_sentence pam_{name};\n\n\
         static inline double pam_{name}_pulls(pam_{name} *memory, const pam_moment *now{base})\n{{\n{body}}}\n"
    )
}

/// A statement before the driver, where it needs one, and its value.
fn driver(driver: &Driver) -> (&'static str, String) {
    const TURN: &str = "    pam_sentence_turn(memory, now);\n";
    let since = |moves: String| format!("pam_sentence_since(memory, now, {moves})");
    let pressure = |above_pa_per_s: f64| format!("fabs(now->pressure_rate_pa_per_s) > {}", number(above_pa_per_s));
    match *driver {
        Driver::Pressure => ("", "now->pressure_pa".to_owned()),
        Driver::Contraction => ("", "now->contraction_ratio".to_owned()),
        Driver::Speed => ("", "now->speed_m_per_s".to_owned()),
        Driver::Force => ("", "base->static_force_n".to_owned()),
        Driver::Time => ("", "now->time_s".to_owned()),
        Driver::TravelSinceReversal => (TURN, "fabs(now->slide_m - memory->turn_m)".to_owned()),
        Driver::Cycle => (TURN, "1.0 + (double)(memory->flips / 2)".to_owned()),
        Driver::TimeSinceLastMove { above_m_per_s, above_pa_per_s } => {
            let moves = format!("fabs(now->speed_m_per_s) > {} || {}", number(above_m_per_s), pressure(above_pa_per_s));
            ("", since(moves))
        }
        Driver::TimeSincePressureMoved { above_pa_per_s } => ("", since(pressure(above_pa_per_s))),
    }
}

fn memory(memory: &Recall) -> String {
    match *memory {
        Recall::None => "memory->last".to_owned(),
        Recall::Lag { time_constant_s } => format!("pam_sentence_lag(memory, {})", number(time_constant_s)),
        Recall::TwoLags { time_constants_s: [first_s, second_s] } => {
            format!("pam_sentence_two_lags(memory, {}, {})", number(first_s), number(second_s))
        }
        Recall::Play { half_width } => format!("pam_sentence_play(memory, now, {})", number(half_width)),
        Recall::Dahl { distance } => format!("pam_sentence_dahl(memory, now, {})", number(distance)),
        Recall::Largest => "pam_sentence_largest(memory)".to_owned(),
        Recall::Travelled => "pam_sentence_travelled(memory)".to_owned(),
        Recall::Work => "pam_sentence_work(memory, base)".to_owned(),
    }
}

fn factor(scale: Scale) -> &'static str {
    match scale {
        Scale::One => "1.0",
        Scale::Pressure => "now->pressure_pa",
        Scale::GasForce => "base->gas_n",
        Scale::BladderForce => "pam_latex_n(base)",
        Scale::Friction => "(now->direction * base->normal_n)",
        Scale::Direction => "now->direction",
        Scale::Contracting => "(0.5 * (1.0 + now->direction))",
        Scale::Extending => "(0.5 * (1.0 - now->direction))",
        Scale::SlopeOverPressure => "base->slope_n_per_pa",
        Scale::SlopeOverLength => "base->slope_n_per_m",
    }
}

/// Tables that the curve needs, and its value at `x` with the constants of its amplitudes.
fn curve(curve: &Curve, constants: &[String]) -> (String, String) {
    let through = |knots: &[f64], name: &str| {
        let numbers: Vec<String> = knots.iter().map(|knot| number(*knot)).collect();
        let tables = format!(
            "    static const double knots[{}] = {{{}}};\n    static const double values[{}] = {{{}}};\n",
            knots.len(),
            numbers.join(", "),
            constants.len(),
            constants.join(", "),
        );
        (tables, format!("pam_sentence_{name}(x, knots, values, {})", knots.len()))
    };
    let sized = |by: String| (String::new(), format!("({} * {by})", constants.join(" + ")));
    match curve {
        Curve::Line => sized("x".to_owned()),
        Curve::Saturation { from, over } => {
            sized(format!("pam_sentence_saturation(x, {}, {})", number(*from), number(*over)))
        }
        Curve::Bump { center, width } => {
            sized(format!("pam_sentence_bump(x, {}, {})", number(*center), number(*width)))
        }
        Curve::Monotone { knots } => through(knots, "monotone"),
        Curve::Spline { knots } => through(knots, "spline"),
    }
}
