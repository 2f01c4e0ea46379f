//! Sections: what was refused, and every campaign.

use pam_artifact::diagnosis::Verdict;

use super::FleetPage;
use super::standing::linked;
use crate::escape::escaped;
use crate::number::significant;
use crate::page::html::paragraph;

pub(super) fn refusals(page: &FleetPage) -> String {
    if page.refusals.is_empty() {
        return paragraph("Nothing was refused.");
    }
    let mut html = paragraph(
        "A recording that cannot be used costs its campaign and nothing else. Mend or replace it, or take it out of the table, and \
         run the same command again: only these are done anew.",
    );
    html.push_str(
        "<div class=\"scroll tall\">\n<table class=\"sortable\">\n<thead><tr><th>muscle</th><th>rig</th><th>date</th><th>step</th>\
         <th>reason</th></tr></thead>\n<tbody>\n",
    );
    for refusal in &page.refusals {
        let campaign = &page.campaigns[refusal.campaign];
        html.push_str(&format!(
            "<tr><td>{}</td><td class=\"rig\">{}</td><td class=\"date\">{}</td><td>{}</td><td class=\"said\">{}</td></tr>\n",
            escaped(&campaign.muscle),
            escaped(&campaign.rig),
            escaped(&campaign.date),
            escaped(&refusal.step),
            escaped(&refusal.reason)
        ));
    }
    html.push_str("</tbody>\n</table>\n</div>\n");
    html
}

pub(super) fn campaigns(page: &FleetPage) -> String {
    let with_make = page.campaigns.iter().any(|campaign| !campaign.make.is_empty());
    let make = if with_make { "<th>make</th>" } else { "" };
    let mut html =
        paragraph("A name leads to the page of the muscle's own diagnosis. Residuals are root mean squares.");
    html.push_str(&format!(
        "<div class=\"scroll tall\">\n<table class=\"sortable\">\n<thead><tr><th>muscle</th><th>rig</th><th>date</th>{make}\
         <th>outcome</th><th>diagnosis</th><th>missing physics</th><th class=\"number\">residual</th>\
         <th class=\"number\">held out</th><th class=\"number\">noise</th></tr></thead>\n<tbody>\n"
    ));
    for campaign in &page.campaigns {
        let make = if with_make { format!("<td>{}</td>", escaped(&campaign.make)) } else { String::new() };
        let outcome = campaign.outcome;
        let effects: Vec<&str> = campaign.effects.iter().map(|(id, _)| id.as_str()).collect();
        html.push_str(&format!(
            "<tr><td>{}</td><td class=\"rig\">{}</td><td class=\"date\">{}</td>{make}<td class=\"{outcome}\">{outcome}</td>{}<td>{}</td>{}{}{}</tr>\n",
            linked(&campaign.muscle, campaign.link.as_deref()),
            escaped(&campaign.rig),
            escaped(&campaign.date),
            verdict(campaign.verdict),
            escaped(&effects.join(", ")),
            newtons(campaign.rmse_n),
            newtons(campaign.holdout_rmse_n),
            newtons(campaign.noise_n),
        ));
    }
    html.push_str("</tbody>\n</table>\n</div>\n");
    html
}

fn verdict(verdict: Option<Verdict>) -> String {
    let (class, word) = match verdict {
        Some(Verdict::Consistent) => ("consistent", "consistent"),
        Some(Verdict::Explained) => ("explained", "explained"),
        Some(Verdict::ExplainedInPart) => ("explained", "explained in part"),
        Some(Verdict::Ambiguous) => ("ambiguous", "ambiguous"),
        Some(Verdict::Unexplained) => ("unexplained", "unexplained"),
        None => ("none", "–"),
    };
    format!("<td class=\"verdict-{class}\">{word}</td>")
}

fn newtons(value: Option<f64>) -> String {
    match value {
        Some(value) => format!("<td class=\"number\" data-value=\"{value:.5}\">{} N</td>", significant(value, 3)),
        None => "<td class=\"number\">–</td>".to_owned(),
    }
}
