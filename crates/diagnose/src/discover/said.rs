//! A term in words.

use pam_artifact::diagnosis::EmpiricalCurve;
use pam_muscle::effects::Sentence;
use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale};

/// Share of the height of a curve above which it acts.
const ACTS: f64 = 0.2;
/// Share of the range that it acts in, at most, to act there only.
const ONLY: f64 = 0.6;
/// Share of the height of a curve by which one that grows may fall.
const STEADY: f64 = 0.1;

/// What a term does, in one sentence without its full stop; `bends` is the named effect whose form it bends.
pub(super) fn words(sentence: &Sentence, curve: &EmpiricalCurve, bends: Option<&str>) -> String {
    let height_n = curve.force_n.iter().fold(0.0_f64, |height_n, force_n| height_n.max(force_n.abs()));
    let parts = [
        format!("a force of up to {} N that {}", rounded(height_n), place(sentence, curve)),
        scale(sentence.scale, height_n, curve.typical_scale),
    ];
    let mut text = parts.join(", ");
    if let Some(id) = bends {
        text.push_str(&format!(": by this, {id} differs here from its published form"));
        return text;
    }
    if let Some(cause) = cause(sentence, acts_within(curve).is_some()) {
        text.push_str(": ");
        text.push_str(cause);
    }
    text
}

/// Driver, memory and scale in a few words.
pub(super) fn in_short(sentence: &Sentence) -> String {
    let of = remembered(sentence);
    match sentence.scale {
        Scale::One => of,
        Scale::Direction => format!("{of}, reversing sign with the direction"),
        Scale::Contracting => format!("{of}, while contracting"),
        Scale::Extending => format!("{of}, while extending"),
        Scale::SlopeOverPressure => format!("{of}, as an error of the pressure"),
        Scale::SlopeOverLength => format!("{of}, as an error of the length"),
        Scale::Pressure => format!("{of}, proportional to the pressure"),
        Scale::GasForce => format!("{of}, proportional to the gas force"),
        Scale::BladderForce => format!("{of}, proportional to the bladder force"),
        Scale::Friction => format!("{of}, proportional to friction"),
    }
}

/// What the curve is a function of, in words.
fn remembered(sentence: &Sentence) -> String {
    let driver = match sentence.driver {
        Driver::Pressure => "the pressure",
        Driver::Contraction => "the contraction",
        Driver::Speed => "the speed of contraction",
        Driver::Force => "the force",
        Driver::Time => "the time since the recording began",
        Driver::TravelSinceReversal => "the travel since the last reversal",
        Driver::TimeSinceLastMove { .. } => "the time since the last move",
        Driver::TimeSincePressureMoved { .. } => "the time since the pressure moved",
        Driver::Cycle => "the cycle of motion",
    };
    match sentence.memory {
        Recall::None => driver.to_owned(),
        Recall::Lag { time_constant_s } => {
            format!("the recent change of {driver} (time constant {} s)", rounded(time_constant_s))
        }
        Recall::TwoLags { time_constants_s } => {
            let [first, second] = time_constants_s.map(rounded);
            format!("the recent change of {driver} (two time constants, {first} and {second} s)")
        }
        Recall::Play { half_width } => {
            format!(
                "the position of {driver} within a backlash of {}",
                quantity(2.0 * half_width, sentence.driver.unit(), &sentence.driver)
            )
        }
        Recall::Dahl { distance } => {
            let within = quantity(distance, sentence.driver.unit(), &sentence.driver);
            format!("the direction of {driver}, turning over within {within}")
        }
        Recall::Largest => format!("the distance of {driver} from its maximum so far"),
        Recall::Travelled => format!("the accumulated travel of {driver}"),
        Recall::Work => "the accumulated work".to_owned(),
    }
}

/// Where it acts, or how it goes along.
fn place(sentence: &Sentence, curve: &EmpiricalCurve) -> String {
    let of = remembered(sentence);
    let show = |value: f64| quantity(value, &curve.unit, &sentence.driver);
    if let Some((from, to)) = acts_within(curve) {
        let (from, to) = (show(from), show(to));
        // A unit is said once.
        let unit = to.rsplit_once(' ').map(|(_, unit)| unit);
        let from = unit.and_then(|unit| from.strip_suffix(unit)).map_or(&*from, str::trim_end);
        return format!("acts only where {of} is between {from} and {to}");
    }
    if sentence.shape == Curve::Line {
        return format!("is proportional to {of}");
    }
    let (up, down) = curve.force_n.windows(2).fold((0.0, 0.0), |(up, down), pair| {
        let step = pair[1] - pair[0];
        (up + f64::max(step, 0.0), down + f64::max(-step, 0.0))
    });
    if down < STEADY * up {
        format!("grows with {of}")
    } else if up < STEADY * down {
        format!("falls with {of}")
    } else {
        format!("varies with {of}, rising and falling")
    }
}

/// The part of the range that a curve acts in, if it is one part and not nearly all; at an end that acts, to the end.
fn acts_within(curve: &EmpiricalCurve) -> Option<(f64, f64)> {
    let height_n = curve.force_n.iter().fold(0.0_f64, |height_n, force_n| height_n.max(force_n.abs()));
    let acts: Vec<bool> = curve.force_n.iter().map(|force_n| force_n.abs() > ACTS * height_n).collect();
    let (first, last) = (acts.iter().position(|acts| *acts)?, acts.iter().rposition(|acts| *acts)?);
    let is_part = (last - first) as f64 <= ONLY * (acts.len() - 1) as f64;
    is_part.then(|| (curve.argument[first], curve.argument[last]))
}

fn scale(scale: Scale, height_n: f64, typical: f64) -> String {
    let error = if typical > 0.0 { height_n / typical } else { 0.0 };
    match scale {
        Scale::One => "the same in both directions, independent of pressure".to_owned(),
        Scale::Pressure => "the same in both directions, proportional to the pressure".to_owned(),
        Scale::GasForce => "the same in both directions, proportional to the gas force".to_owned(),
        Scale::BladderForce => "the same in both directions, proportional to the bladder force".to_owned(),
        Scale::Friction => {
            "reversing sign with the direction of motion, proportional to the pressure as friction is".to_owned()
        }
        Scale::Direction => "reversing sign with the direction of motion, independent of pressure".to_owned(),
        Scale::Contracting => "only while the muscle contracts, independent of pressure".to_owned(),
        Scale::Extending => "only while the muscle extends, independent of pressure".to_owned(),
        Scale::SlopeOverPressure => format!("equivalent to a pressure error of up to {} kPa", rounded(1e-3 * error)),
        Scale::SlopeOverLength => format!("equivalent to a length error of up to {} mm", rounded(1e3 * error)),
    }
}

/// What usually stands behind such a term.
fn cause(sentence: &Sentence, is_local: bool) -> Option<&'static str> {
    let of = (sentence.driver, sentence.memory, sentence.scale);
    match of {
        (Driver::Contraction, Recall::None, Scale::One) if is_local => Some("something may touch the muscle there"),
        (Driver::Contraction, Recall::None, Scale::Direction | Scale::Friction) if is_local => {
            Some("something may rub or stick there")
        }
        (Driver::Contraction, Recall::None, Scale::Contracting | Scale::Extending) if is_local => {
            Some("something may catch there that lets go the other way")
        }
        (Driver::Force, Recall::None, Scale::One) => Some("the load cell may read wrong there"),
        (Driver::Contraction, Recall::Play { .. } | Recall::Dahl { .. }, Scale::SlopeOverLength) => {
            Some("a fitting may have play")
        }
        (Driver::Contraction, Recall::None, Scale::SlopeOverLength) => Some("the length sensor may read wrong"),
        (Driver::Pressure, Recall::None, Scale::SlopeOverPressure) => Some("the gauge may read wrong"),
        (Driver::Pressure, Recall::Lag { .. } | Recall::TwoLags { .. }, _) => {
            Some("the pressure in the muscle may follow the gauge late")
        }
        (
            Driver::TimeSincePressureMoved { .. } | Driver::TimeSinceLastMove { .. },
            _,
            Scale::SlopeOverPressure | Scale::GasForce | Scale::Pressure,
        ) => Some("pressure may be lost while the valve holds it"),
        (Driver::Time, Recall::None, Scale::One) => Some("something may drift during each recording"),
        _ => None,
    }
}

/// `value` in the unit that people use.
fn quantity(value: f64, unit: &str, driver: &Driver) -> String {
    match (unit, driver) {
        ("1", Driver::Contraction) => format!("{} %", rounded(1e2 * value)),
        ("1", _) => rounded(value),
        ("Pa", _) => format!("{} kPa", rounded(1e-3 * value)),
        ("m", _) => format!("{} mm", rounded(1e3 * value)),
        ("m/s", _) => format!("{} mm/s", rounded(1e3 * value)),
        (unit, _) => format!("{} {unit}", rounded(value)),
    }
}

/// With three digits that count.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".to_owned();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bump(scale: Scale) -> (Sentence, EmpiricalCurve) {
        let argument: Vec<f64> = (0..121).map(|at| 0.002 * f64::from(at)).collect();
        let shape = Curve::Bump { center: 0.12, width: 0.008 };
        let sentence = Sentence { driver: Driver::Contraction, memory: Recall::None, scale, shape, seen: [0.0, 0.24] };
        let force_n: Vec<f64> = argument.iter().map(|&argument| sentence.value(argument, &[-7.25])).collect();
        let curve = EmpiricalCurve {
            unit: "1".to_owned(),
            low_n: force_n.clone(),
            high_n: force_n.clone(),
            argument,
            force_n,
            typical_scale: 1.0,
        };
        (sentence, curve)
    }

    #[test]
    fn a_bump_is_said_by_its_place_and_by_what_it_does_not_depend_on() {
        let (sentence, curve) = bump(Scale::One);
        assert_eq!(
            words(&sentence, &curve, None),
            "a force of up to 7.25 N that acts only where the contraction is between 11 and 13 %, the same in both directions, independent of pressure: something may touch the muscle there"
        );
    }

    #[test]
    fn what_acts_all_along_is_said_by_the_way_it_goes() {
        let (sentence, mut curve) = bump(Scale::SlopeOverPressure);
        curve.force_n = curve.argument.iter().map(|argument| 50.0 * argument).collect();
        let sentence = Sentence {
            driver: Driver::Pressure,
            memory: Recall::Lag { time_constant_s: 0.31 },
            shape: Curve::Line,
            ..sentence
        };
        (curve.typical_scale, curve.unit) = (1e-3, "Pa".to_owned());
        assert_eq!(
            words(&sentence, &curve, None),
            "a force of up to 12 N that is proportional to the recent change of the pressure (time constant 0.31 s), equivalent to a pressure error of up to 12 kPa: the pressure in the muscle may follow the gauge late"
        );
    }
}
