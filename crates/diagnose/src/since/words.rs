//! The verdict in words.

use pam_artifact::change::{Change, ChangeFit, ChangeKind, ChangeVerdict, Compared};

/// One or two sentences.
pub(super) fn statement(verdict: ChangeVerdict, changes: &[Change], fit: &ChangeFit) -> String {
    let [as_then, within, now, then] = [fit.as_then_n, fit.within_errors_n, fit.now_n, fit.then_n].map(number);
    let named: Vec<String> = changes.iter().map(said).collect();
    match (verdict, named.is_empty()) {
        (ChangeVerdict::Unchanged, _) => format!(
            "nothing has changed beyond the standard errors of the baseline, which leaves an RMSE of {as_then} N on these \
             recordings."
        ),
        (_, true) => format!(
            "something has changed that no single parameter, channel or effect explains: an RMSE of {within} N is left, where the \
             baseline left {then} N on its own recordings."
        ),
        (_, false) => {
            let more = if verdict == ChangeVerdict::Unexplained { "; the rest has no name" } else { "" };
            format!("{}. The RMSE falls from {as_then} N to {now} N{more}.", named.join("; "))
        }
    }
}

/// A change in words with its size.
pub fn said(change: &Change) -> String {
    let size = change.differences.first().filter(|_| change.kind != ChangeKind::EffectGone);
    let size = size.map_or(String::new(), |compared| format!(" ({})", size_of(compared, change.kind)));
    format!("{}{size}", titled(change))
}

/// A change in words.
pub fn titled(change: &Change) -> String {
    let Change { id, name, .. } = change;
    match change.kind {
        ChangeKind::Channel => format!("the {name} has shifted"),
        ChangeKind::Parameter | ChangeKind::Effect => format!("{name} ({id}) has changed"),
        ChangeKind::EffectGone => format!("{name} ({id}) is gone"),
        ChangeKind::NewEffect => format!("{name} ({id}) is new"),
    }
}

/// Size of a change, in its unit and in standard errors.
fn size_of(compared: &Compared, kind: ChangeKind) -> String {
    let Compared { name, unit, then, now, stderr, standard_errors } = compared;
    let short = name.rsplit('.').next().unwrap_or(name);
    let (scale, unit) = prefixed(unit, now.abs().max(then.unwrap_or(0.0).abs()));
    let (now, then, stderr) = (scale * now, then.map(|then| scale * then), stderr.map(|stderr| scale * stderr));
    let known = stderr.map_or(String::new(), |stderr| format!(" ± {stderr:.*}", decimals(stderr, 2)));
    // A value has the decimals of its standard error, and one that has none three digits.
    let written = |value: f64| match stderr.filter(|stderr| *stderr > 0.0) {
        Some(stderr) => format!("{value:.*}", decimals(stderr, 2)),
        None => number(value),
    };
    let errors = standard_errors.map_or(String::new(), |errors| format!(", {errors:+.1} standard errors"));
    match (kind, then) {
        (ChangeKind::Channel, _) => {
            let sign = if now >= 0.0 { "+" } else { "" };
            format!("{sign}{}{known}{unit}{errors}", written(now))
        }
        (_, Some(then)) if then != 0.0 => {
            let percent = 100.0 * (now - then) / then.abs();
            format!("{short} {} → {}{known}{unit}, {percent:+.0} %{errors}", written(then), written(now))
        }
        _ => format!("{short} {}{known}{unit}{errors}", written(now)),
    }
}

/// Factor and name of a unit that suits a value of `size`, with a blank before it.
fn prefixed(unit: &str, size: f64) -> (f64, String) {
    let (scale, unit) = match unit {
        "1" => return (1.0, String::new()),
        "Pa" if size >= 1e8 => (1e-9, "GPa"),
        "Pa" if size >= 1e2 => (1e-3, "kPa"),
        "m" if size < 1e-3 => (1e6, "µm"),
        "m" if size < 1.0 => (1e3, "mm"),
        "s" if size < 1.0 => (1e3, "ms"),
        unit => (1.0, unit),
    };
    (scale, format!(" {unit}"))
}

/// Decimals that show `digits` significant digits.
fn decimals(value: f64, digits: i32) -> usize {
    (digits - 1 - value.abs().log10().floor() as i32).clamp(0, 12) as usize
}

/// Three significant digits.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-6..1e6).contains(&size) {
        format!("{value:.*}", decimals(value, 3))
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(name: &str, unit: &str, then: Option<f64>, now: f64, stderr: f64) -> Compared {
        let standard_errors = Some((now - then.unwrap_or(0.0)) / stderr);
        Compared { name: name.to_owned(), unit: unit.to_owned(), then, now, stderr: Some(stderr), standard_errors }
    }

    #[test]
    fn a_size_has_the_unit_that_suits_it_and_the_decimals_of_its_error() {
        let size = |kind, compared: Compared| size_of(&compared, kind);
        let bladder = compared("c10 + c01", "Pa", Some(224e3), 355_120.0, 2234.0);
        assert_eq!(
            size(ChangeKind::Parameter, bladder),
            "c10 + c01 224.0 → 355.1 ± 2.2 kPa, +59 %, +58.7 standard errors"
        );
        let zero = compared("pressure-zero", "Pa", Some(0.0), 31_024.0, 708.0);
        assert_eq!(size(ChangeKind::Channel, zero), "+31.02 ± 0.71 kPa, +43.8 standard errors");
        let new = compared("stribeck.stribeck_force_n", "N", None, 4.5, 0.05);
        assert_eq!(size(ChangeKind::NewEffect, new), "stribeck_force_n 4.500 ± 0.050 N, +90.0 standard errors");
        let slip = compared("presliding-hysteresis.slip_distance_m", "m", Some(5e-4), 4e-4, 2e-5);
        assert_eq!(size(ChangeKind::Effect, slip), "slip_distance_m 500 → 400 ± 20 µm, -20 %, -5.0 standard errors");
    }
}
