//! How numbers are written for people.

/// `value` with `digits` significant digits: `1.052`, `152`, `1.5e-7`. Digits before the decimal point are
/// never replaced by zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            "–"
        } else if value > 0.0 {
            "∞"
        } else {
            "−∞"
        }
        .to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    // After rounding, so that 9.99 with two digits counts as 10.
    let exponent = exponent_of(&scientific);
    if (-4..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        with_minus(format!("{value:.decimals$}"))
    } else {
        with_minus(scientific)
    }
}

/// `value ± stderr`, both to the decimal place that the standard error allows: `1.052 ± 0.004`. The error
/// keeps one digit, two where the first is a 1, because rounding would change it by up to a half.
pub fn with_stderr(value: f64, stderr: f64) -> String {
    if !(stderr.is_finite() && stderr > 0.0 && value.is_finite()) {
        return significant(value, 4);
    }
    let rounded = format!("{stderr:.0e}");
    let leading_one = rounded.starts_with('1');
    let place = exponent_of(&rounded) - i32::from(leading_one);
    let largest = value.abs().max(stderr);
    let exponent = largest.log10().floor() as i32;
    if (-4..7).contains(&exponent) && place >= -9 {
        let decimals = (-place).max(0) as usize;
        return format!("{} ± {stderr:.decimals$}", with_minus(format!("{value:.decimals$}")));
    }
    let scale = 10f64.powi(exponent);
    let decimals = (exponent - place).max(0) as usize;
    let value = with_minus(format!("{:.decimals$}", value / scale));
    format!("({value} ± {:.decimals$})e{exponent}", stderr / scale)
}

/// `value` in `unit` with the prefix that keeps one to three digits before the point: `152 kPa`. A unit
/// that is empty, `1`, a reciprocal (`1/s`), or a power (`m^2`, `m²`) takes no prefix.
pub fn engineering(value: f64, unit: &str, digits: usize) -> String {
    const PREFIXES: [&str; 9] = ["p", "n", "µ", "m", "", "k", "M", "G", "T"];
    if let Some(value_mm2) = square_millimeters(value, unit) {
        return engineering(value_mm2, "mm²", digits);
    }
    let plain = unit.is_empty() || unit.starts_with('1') || unit.contains(['^', '²', '³', '%', '°']) || unit == "rad";
    if plain || !value.is_finite() || value == 0.0 {
        let unit = if unit == "1" { "" } else { unit };
        return format!("{} {unit}", significant(value, digits)).trim_end().to_owned();
    }
    let exponent = exponent_of(&format!("{value:.*e}", digits.max(1) - 1));
    let step = exponent.div_euclid(3).clamp(-4, 4);
    let prefix = PREFIXES[(step + 4) as usize];
    format!("{} {prefix}{unit}", significant(value / 1000f64.powi(step), digits))
}

/// Areas of muscles are some ten square millimeters; none where `unit` is another or the area large.
fn square_millimeters(value: f64, unit: &str) -> Option<f64> {
    (matches!(unit, "m^2" | "m²") && value.is_finite() && value.abs() < 1e-2).then_some(1e6 * value)
}

/// `value ± stderr` in `unit` with the prefix of [`engineering`]: `1.21 ± 0.03 mm`.
pub fn engineering_with_stderr(value: f64, stderr: f64, unit: &str) -> String {
    if !(stderr.is_finite() && stderr > 0.0 && value.is_finite()) {
        return engineering(value, unit, 3);
    }
    if let Some(stderr_mm2) = square_millimeters(value.abs().max(stderr), unit).map(|_| 1e6 * stderr) {
        return engineering_with_stderr(1e6 * value, stderr_mm2, "mm²");
    }
    let size = engineering(value.abs().max(stderr), unit, 3);
    let Some((number, prefixed)) = size.split_once(' ') else { return with_stderr(value, stderr) };
    // The factor that the prefix stands for, read off the power of ten between number and size.
    let shown: f64 = number.parse().unwrap_or(1.0);
    let scale = 10f64.powi((shown / value.abs().max(stderr)).log10().round() as i32);
    format!("({}) {prefixed}", with_stderr(value * scale, stderr * scale))
}

/// A probability for a table: `0.032`, `2 × 10⁻⁶`, `< 10⁻¹⁵` where rounding has the last word.
pub fn probability(p: f64) -> String {
    if !p.is_finite() || p >= 1e-3 {
        return significant(p.min(1.0), 2);
    }
    if p < 1e-15 {
        return "< 10⁻¹⁵".to_owned();
    }
    let scientific = format!("{p:.0e}");
    let mantissa = scientific.split('e').next().unwrap_or("1").to_owned();
    let exponent = exponent_of(&scientific).unsigned_abs().to_string();
    let raised: String = exponent.bytes().map(|digit| RAISED[usize::from(digit - b'0')]).collect();
    format!("{mantissa} × 10⁻{raised}")
}

/// Digits as exponents.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Exponent in the output of `{:e}`.
fn exponent_of(scientific: &str) -> i32 {
    scientific.rsplit('e').next().and_then(|exponent| exponent.parse().ok()).unwrap_or(0)
}

/// A typographic minus, which is as wide as a plus; a negative zero loses its sign.
pub(crate) fn with_minus(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|digit| matches!(digit, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_of_muscles_are_square_millimeters() {
        assert_eq!(engineering(8.9991e-5, "m^2", 3), "90.0 mm²");
        assert_eq!(engineering_with_stderr(8.9991e-5, 8e-9, "m²"), "(89.991 ± 0.008) mm²");
        assert_eq!(engineering(2.0, "m^2", 3), "2.00 m^2");
    }

    #[test]
    fn significant_digits_survive_rounding_and_size() {
        let cases = [(1.0517, "1.05"), (9.999, "10.0"), (151_950.0, "151950"), (-0.001, "−0.00100"), (0.0, "0")];
        for (value, expected) in cases {
            assert_eq!(significant(value, 3), expected);
        }
        assert_eq!(significant(1.6e-7, 2), "1.6e-7");
        assert_eq!(significant(3.0e9, 2), "3.0e9");
        assert_eq!(significant(f64::NAN, 2), "–");
    }

    #[test]
    fn a_value_is_written_to_the_place_its_error_allows() {
        assert_eq!(with_stderr(1.05213, 0.0041), "1.052 ± 0.004");
        assert_eq!(with_stderr(1.05213, 0.00141), "1.0521 ± 0.0014");
        assert_eq!(with_stderr(152.3, 12.0), "152 ± 12");
        assert_eq!(with_stderr(1234.0, 40.0), "1234 ± 40");
        assert_eq!(with_stderr(2.5e9, 3.0e7), "(2.50 ± 0.03)e9");
        assert_eq!(with_stderr(-0.0001, 0.04), "0.00 ± 0.04");
        assert_eq!(with_stderr(1.05213, f64::NAN), "1.052");
    }

    #[test]
    fn uncertainty_takes_the_prefix_of_its_value() {
        assert_eq!(engineering_with_stderr(1.213e-3, 3.1e-5, "m"), "(1.21 ± 0.03) mm");
        assert_eq!(engineering_with_stderr(-152e3, 2e3, "Pa"), "(−152 ± 2) kPa");
        assert_eq!(engineering_with_stderr(0.213, 0.02, "1"), "0.21 ± 0.02");
        assert_eq!(engineering_with_stderr(0.35, f64::NAN, "s"), "350 ms");
    }

    #[test]
    fn small_probabilities_are_powers_of_ten() {
        let cases = [(0.0321, "0.032"), (1.0, "1.0"), (2.2e-6, "2 × 10⁻⁶"), (9.7e-11, "1 × 10⁻¹⁰"), (0.0, "< 10⁻¹⁵")];
        for (p, expected) in cases {
            assert_eq!(probability(p), expected);
        }
    }

    #[test]
    fn engineering_units_keep_one_to_three_digits_before_the_point() {
        assert_eq!(engineering(151_950.0, "Pa", 3), "152 kPa");
        assert_eq!(engineering(0.267, "m", 3), "267 mm");
        assert_eq!(engineering(999.96, "N", 4), "1.000 kN");
        assert_eq!(engineering(3.0e9, "Pa", 2), "3.0 GPa");
        assert_eq!(engineering(0.436, "rad", 3), "0.436 rad");
        assert_eq!(engineering(0.5, "1", 2), "0.50");
    }
}
