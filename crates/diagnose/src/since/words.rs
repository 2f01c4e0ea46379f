//! The verdict in words.

use pam_core::artifact::change::{Change, ChangeFit, ChangeKind, ChangeVerdict, Compared};

/// One or two sentences.
pub(super) fn statement(verdict: ChangeVerdict, changes: &[Change], fit: &ChangeFit) -> String {
    let ChangeFit { within_errors_n, now_n, .. } = fit;
    let named: Vec<String> = changes.iter().map(said).collect();
    match (verdict, named.is_empty()) {
        (ChangeVerdict::Unchanged, _) => format!(
            "nothing has changed beyond the standard errors of the model of then: it leaves {within_errors_n:.2} N of these \
             recordings."
        ),
        (_, true) => format!(
            "something has changed that no single parameter, channel or effect explains: {within_errors_n:.2} N are left, where \
             the model of then left {:.2} N of its own recordings.",
            fit.then_n
        ),
        (_, false) => {
            let more =
                if verdict == ChangeVerdict::Unexplained { "; the rest is something that is not named" } else { "" };
            format!("{}. {within_errors_n:.2} N are left without, {now_n:.2} N with it{more}.", named.join("; "))
        }
    }
}

/// A change in words with its size.
pub fn said(change: &Change) -> String {
    let numbers = change.differences.first().map(|compared| size(compared, change.kind));
    let numbers = numbers.map_or(String::new(), |size| format!(" ({size})"));
    match change.kind {
        ChangeKind::Channel => format!("the {} has shifted{numbers}", change.name),
        ChangeKind::Parameter => format!("{}, {}, has changed{numbers}", change.id, change.name),
        ChangeKind::Effect => format!("{} ({}) has changed{numbers}", change.name, change.id),
        ChangeKind::EffectGone => format!("{} ({}) is gone", change.name, change.id),
        ChangeKind::NewEffect => format!("{} ({}) is new{numbers}", change.name, change.id),
    }
}

/// Size of a change, in its unit and in standard errors.
pub fn size(compared: &Compared, kind: ChangeKind) -> String {
    let Compared { name, unit, then, now, stderr, standard_errors } = compared;
    let short = name.rsplit('.').next().unwrap_or(name);
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    let known = stderr.map_or(String::new(), |stderr| format!(" ± {}", number(stderr)));
    let errors = standard_errors.map_or(String::new(), |errors| format!(", {errors:+.1} standard errors"));
    match (kind, then) {
        (ChangeKind::Channel, _) => {
            let sign = if *now >= 0.0 { "+" } else { "" };
            format!("{sign}{}{known}{unit}{errors}", number(*now))
        }
        (_, Some(then)) if *then != 0.0 => {
            let percent = 100.0 * (now - then) / then.abs();
            format!("{short} {} → {}{known}{unit}, {percent:+.0} %{errors}", number(*then), number(*now))
        }
        _ => format!("{short} {}{known}{unit}{errors}", number(*now)),
    }
}

/// Three significant digits.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let decimals = (2 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}
