//! The model as it was given: what it misses before anything is refitted, and how far a refit moves its parameters.

use pam_artifact::diagnosis::AsGiven;

use crate::Table;
use crate::number::{engineering, significant};
use crate::page::html::{heading, list, newtons, paragraph, table};

/// Standard errors below which a parameter has not moved.
const HARDLY: f64 = 0.05;

/// Part of the section on the mismatch.
pub(super) fn given(given: &AsGiven) -> String {
    let held_out = given.holdout.map_or(String::new(), |left| format!(", {} on held-out ones", newtons(left.rmse_n)));
    let verdict = if given.misses {
        " It misses them: they are of another muscle, or an instrument reads otherwise."
    } else {
        ""
    };
    let mut html = heading("The model as given")
        + &paragraph(&format!(
            "Before anything is refitted the model leaves {} on these recordings{held_out}; refitted it leaves {}.{verdict}",
            newtons(given.estimation.rmse_n),
            newtons(given.refitted.rmse_n)
        ));
    if let Some(instrument) = &given.instrument {
        html.push_str(&paragraph(&format!("An instrument alone would explain that: {instrument}.")));
    }
    html.push_str(&list(&given.holdout_missed));
    if given.shifts.is_empty() {
        return html;
    }
    if given.shifts.iter().all(|shift| shift.standard_errors.is_none_or(|errors| errors.abs() < HARDLY)) {
        let words = "The refit moves no parameter by more than a twentieth of its standard error.";
        return html + &paragraph(words);
    }
    let mut shifts = Table::new(["parameter", "as given", "refitted", "moved, in standard errors"]);
    for shift in &given.shifts {
        let errors = shift.standard_errors.map_or("not known".to_owned(), |errors| {
            if errors.abs() < HARDLY { "0".to_owned() } else { significant(errors, 2) }
        });
        let value = |value: f64| engineering(value, &shift.unit, 4);
        shifts.row([shift.parameter.clone(), value(shift.given), value(shift.refitted), errors]);
    }
    html + &table(&shifts)
}
