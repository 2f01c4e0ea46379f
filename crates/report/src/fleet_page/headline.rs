//! Top of the page: who stands out, in one sentence and four figures.

use std::collections::BTreeSet;

use super::FleetPage;
use crate::escape::escaped;
use crate::page::html::{card, list};

pub(super) fn headline(page: &FleetPage) -> String {
    let n_campaigns = page.campaigns.len();
    let muscles: BTreeSet<&str> = page.campaigns.iter().map(|campaign| campaign.muscle.as_str()).collect();
    let rigs: BTreeSet<&str> = page.campaigns.iter().map(|campaign| campaign.rig.as_str()).collect();
    let refused: BTreeSet<usize> = page.refusals.iter().map(|refusal| refusal.campaign).collect();
    let odd_rigs: BTreeSet<&str> = page.shifts.iter().map(|shift| shift.rig.as_str()).collect();
    let changed: BTreeSet<&str> = page.changes.iter().map(|change| page.campaigns[change.to].muscle.as_str()).collect();
    let standing: BTreeSet<&str> =
        page.standing.iter().map(|standing| page.campaigns[standing.campaign].muscle.as_str()).collect();
    let class = match (standing.is_empty(), refused.is_empty()) {
        (true, true) => "consistent",
        (false, true) => "ambiguous",
        (_, false) => "unexplained",
    };
    let words = match standing.len() {
        0 => "No muscle stands out".to_owned(),
        1 => "One muscle is not like the others".to_owned(),
        n => format!("{n} muscles are not like the others"),
    };
    let names = |names: &BTreeSet<&str>| match names.len() {
        0 => "none".to_owned(),
        1..=3 => names.iter().copied().collect::<Vec<_>>().join(", "),
        n => format!("{} and {} more", names.iter().copied().take(2).collect::<Vec<_>>().join(", "), n - 2),
    };
    let worst = page.standing.first().map_or(String::new(), |first| {
        let muscle = &page.campaigns[first.campaign].muscle;
        format!(" First of all {muscle}: {}.", first.reasons.first().map_or("", String::as_str).trim_end_matches('.'))
    });
    let statement = format!(
        "{} of {}, {}.{worst}",
        counted(n_campaigns, "campaign"),
        counted(muscles.len(), "muscle"),
        counted(rigs.len(), "rig")
    );
    let cards = [
        card("Stand out", &standing.len().to_string(), &names(&standing)),
        card("Rigs that differ, or days of them", &odd_rigs.len().to_string(), &names(&odd_rigs)),
        card("Changed since an earlier date", &changed.len().to_string(), &names(&changed)),
        card("Campaigns refused", &refused.len().to_string(), "each with its reason below"),
    ]
    .concat();
    let common = match page.common.as_slice() {
        [] => String::new(),
        common => format!(
            "<div class=\"warnings\">\n<p>Found in most, so said of no single one</p>\n{}</div>\n",
            list(common)
        ),
    };
    format!(
        "<header class=\"{class}\">\n<h1>{}</h1>\n<p class=\"verdict\">{words}</p>\n<p class=\"statement\">{}</p>\n\
         <div class=\"cards four\">\n{cards}</div>\n{common}</header>\n",
        escaped(&page.title),
        escaped(&statement)
    )
}

/// `1 muscle`, `3 muscles`.
pub(super) fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
