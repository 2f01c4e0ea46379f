//! Section: campaigns that are not like the others.

use super::{FleetPage, multiples};
use crate::FigureError;
use crate::escape::escaped;
use crate::number::significant;
use crate::page::html::paragraph;

pub(super) fn standing(page: &FleetPage) -> Result<String, FigureError> {
    if page.standing.is_empty() {
        return Ok(paragraph("None: every value lies within its limits, and no diagnosis found what others lack."));
    }
    let mut html = paragraph(
        "Why a campaign is here: a quantity outside the limits of its chart, missing physics that most others do not have, a \
         mismatch without a name, a change since an earlier date. The weight compares reasons: 1 is just outside a limit; of \
         missing physics it is how many times the sensors' noise the effect is worth, and one more.",
    );
    html.push_str(&multiples::multiples(page)?);
    html.push_str(
        "<div class=\"scroll tall\">\n<table class=\"sortable\">\n<thead><tr><th>muscle</th><th>rig</th><th>date</th>\
         <th class=\"number\">weight</th><th>reasons</th></tr></thead>\n<tbody>\n",
    );
    for standing in &page.standing {
        let campaign = &page.campaigns[standing.campaign];
        let reasons: String = standing
            .reasons
            .iter()
            .map(|reason| format!("<span class=\"reason\">{}</span>", escaped(reason)))
            .collect();
        html.push_str(&format!(
            "<tr><td>{}</td><td class=\"rig\">{}</td><td class=\"date\">{}</td><td class=\"number\" data-value=\"{:.4}\">{}</td><td>{reasons}</td></tr>\n",
            linked(&campaign.muscle, campaign.link.as_deref()),
            escaped(&campaign.rig),
            escaped(&campaign.date),
            standing.weight,
            significant(standing.weight, 2),
        ));
    }
    html.push_str("</tbody>\n</table>\n</div>\n");
    Ok(html)
}

/// A name, with the way to its own page where there is one.
pub(super) fn linked(name: &str, link: Option<&str>) -> String {
    match link {
        // Folders of campaigns hold no character that a reference would have to spell otherwise.
        Some(link) => format!("<a href=\"{}\">{}</a>", escaped(link), escaped(name)),
        None => escaped(name),
    }
}
