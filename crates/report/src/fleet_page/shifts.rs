//! Sections: rigs and days that differ; muscles that changed.

use super::FleetPage;
use super::headline::counted;
use crate::Table;
use crate::number::significant;
use crate::page::html::{paragraph, remark, table};

pub(super) fn rigs(page: &FleetPage) -> String {
    if page.n_shifts_weighed == 0 {
        return paragraph("There are too few campaigns on each rig, or one rig and one day alone, to compare them.");
    }
    let weighed = format!(
        "{} weighed; the limits allow for that many, so that chance alone names one in twenty fleets.",
        counted(page.n_shifts_weighed, "comparison")
    );
    if page.shifts.is_empty() {
        return paragraph("None. Rigs agree with one another, and days of a rig with its other days.")
            + &remark(&weighed);
    }
    let mut rows = Table::new(["rig", "day", "quantity", "lies off by", "standard errors", "compared with"]);
    for shift in &page.shifts {
        let day = shift.day.clone().unwrap_or_else(|| "all".to_owned());
        let distance = significant(shift.distance, 3);
        let (rig, quantity) = (shift.rig.clone(), shift.quantity.clone());
        rows.row([rig, day, quantity, shift.shift.clone(), distance, shift.compared.clone()]);
    }
    let text = "What all muscles of a rig share is the rig's: its load cell, gauge, mounting or delay. It is taken off before \
                muscles are compared with one another. With two rigs, both differ from the other by the same amount.";
    paragraph(text) + &table(&rows) + &remark(&weighed)
}

pub(super) fn changes(page: &FleetPage) -> String {
    if page.n_changes_weighed == 0 {
        return paragraph("No muscle was recorded on two days, so nothing can be said.");
    }
    let weighed = format!("{} from one date to the next weighed.", counted(page.n_changes_weighed, "difference"));
    if page.changes.is_empty() {
        return paragraph("Nothing beyond what standard errors and the usual scatter allow.") + &remark(&weighed);
    }
    let mut rows =
        Table::new(["muscle", "quantity", "since", "until", "rig before", "rig after", "before", "after", "distance"]);
    for change in &page.changes {
        let (from, to) = (&page.campaigns[change.from], &page.campaigns[change.to]);
        rows.row([
            to.muscle.clone(),
            change.quantity.clone(),
            from.date.clone(),
            to.date.clone(),
            from.rig.clone(),
            to.rig.clone(),
            change.before.clone(),
            change.after.clone(),
            significant(change.distance, 3),
        ]);
    }
    let text = "Quantities of a muscle that moved further than the other muscles did meanwhile; the distance counts standard \
                errors, or the usual scatter where that is larger. Where the rigs differ, so may the cause.";
    paragraph(text) + &table(&rows) + &remark(&weighed)
}
