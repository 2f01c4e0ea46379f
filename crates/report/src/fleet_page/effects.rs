//! Section: missing physics, campaign by campaign.

use std::collections::BTreeMap;

use super::FleetPage;
use super::headline::counted;
use super::standing::linked;
use crate::escape::escaped;
use crate::number::significant;
use crate::page::html::{paragraph, remark};

pub(super) fn effects(page: &FleetPage) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (id, _) in page.campaigns.iter().flat_map(|campaign| &campaign.effects) {
        *counts.entry(id).or_default() += 1;
    }
    let diagnosed = page.campaigns.iter().filter(|campaign| campaign.verdict.is_some()).count();
    if counts.is_empty() {
        return paragraph(&format!(
            "Nothing that has a name, in {}.",
            counted(diagnosed, "diagnosis").replace("diagnosiss", "diagnoses")
        ));
    }
    let mut ids: Vec<(&str, usize)> = counts.into_iter().collect();
    ids.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    let with: Vec<_> = page.campaigns.iter().filter(|campaign| !campaign.effects.is_empty()).collect();
    let heads: String = ids
        .iter()
        .map(|(id, n)| format!("<th class=\"upward\"><span>{} <i>{n}</i></span></th>", escaped(id)))
        .collect();
    let mut html = paragraph(&format!(
        "Effects of the catalogue that a diagnosis named, in {} of {diagnosed} diagnosed campaigns. A cell holds the force that the effect \
         explains on recordings it was not fitted to, root mean square in N; its shade is that force over the sensors' noise.",
        with.len()
    ));
    html.push_str(&format!(
        "<div class=\"scroll tall\">\n<table class=\"sortable matrix\">\n<thead><tr><th>muscle</th><th>rig</th><th>date</th>{heads}\
         </tr></thead>\n<tbody>\n"
    ));
    for campaign in with {
        let cells: String = ids
            .iter()
            .map(|(id, _)| match campaign.effects.iter().find(|(named, _)| named == id) {
                Some((_, worth_n)) => {
                    let shade = shade(worth_n / campaign.noise_n.unwrap_or(f64::NAN));
                    format!("<td class=\"shade{shade}\" data-value=\"{worth_n:.4}\">{}</td>", significant(*worth_n, 2))
                }
                None => "<td></td>".to_owned(),
            })
            .collect();
        html.push_str(&format!(
            "<tr><td>{}</td><td class=\"rig\">{}</td><td class=\"date\">{}</td>{cells}</tr>\n",
            linked(&campaign.muscle, campaign.link.as_deref()),
            escaped(&campaign.rig),
            escaped(&campaign.date)
        ));
    }
    html.push_str("</tbody>\n</table>\n</div>\n");
    html + &remark("After the name of an effect stands the number of campaigns that it was named in.")
}

/// Shade of a force over the noise, from 1 to 5.
fn shade(over_noise: f64) -> usize {
    1 + [1.0, 2.0, 4.0, 8.0].iter().filter(|bound| over_noise >= **bound).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_go_up_with_the_force() {
        assert_eq!([0.1, 1.0, 3.0, 5.0, 100.0].map(shade), [1, 2, 3, 4, 5]);
        assert_eq!(shade(f64::NAN), 1);
    }
}
