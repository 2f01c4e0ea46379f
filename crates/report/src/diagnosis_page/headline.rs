//! Top of the page: verdict, statement, the figures that matter.

use pam_artifact::diagnosis::{BeforeAfter, Verdict};

use super::DiagnosisPage;
use crate::escape::escaped;
use crate::page::html::{card, list, newtons, percent};

pub(super) fn headline(page: &DiagnosisPage) -> String {
    let (class, words) = match page.verdict {
        Verdict::Consistent => ("consistent", "Model and recordings agree"),
        Verdict::Explained => ("explained", "The mismatch is explained"),
        Verdict::ExplainedInPart => ("explained-in-part", "The mismatch is explained in part"),
        Verdict::Ambiguous => ("ambiguous", "The mismatch has more than one explanation"),
        Verdict::Unexplained => ("unexplained", "Unmodelled structure is left"),
    };
    let words = match &page.as_given {
        Some(given) if given.misses => "The model as given is not that of these recordings",
        Some(given) if !given.holdout_missed.is_empty() => "Held-out recordings differ from the fitted ones",
        _ => words,
    };
    let after = page.additions().is_some();
    let mut cards = card_of_fit("On the recordings used for fitting", page.estimation, after);
    cards.push_str(&match page.holdout {
        Some(fit) => card_of_fit("On held-out recordings", fit, after),
        None => card("On held-out recordings", "–", "no recording was held out"),
    });
    let floor = page.holdout.map(|fit| fit.noise_floor_n);
    let note = match floor {
        Some(floor) if newtons(floor) != newtons(page.estimation.noise_floor_n) => {
            format!("RMSE that the sensors leave of a perfect model; {} on held-out recordings", newtons(floor))
        }
        _ => "RMSE that the sensors leave of a perfect model".to_owned(),
    };
    cards.push_str(&card("Noise floor", &newtons(page.estimation.noise_floor_n), &note));
    let mut html = format!(
        "<header class=\"{class}\">\n<h1>{}</h1>\n<p class=\"verdict\">{words}</p>\n<p class=\"statement\">{}</p>\n\
         <div class=\"cards\">\n{cards}</div>\n",
        escaped(&page.title),
        escaped(&page.statement)
    );
    if !page.warnings.is_empty() {
        let warnings = list(&page.warnings);
        html.push_str(&format!("<div class=\"warnings\">\n<p>Know before use</p>\n{warnings}</div>\n"));
    }
    html.push_str("</header>\n");
    html
}

/// Share of the excess over the noise floor, mean squares, that is gone afterwards; none where there was none.
pub(super) fn share_explained(fit: BeforeAfter) -> Option<f64> {
    let excess = |rmse_n: f64| rmse_n * rmse_n - fit.noise_floor_n * fit.noise_floor_n;
    let before = excess(fit.rmse_before_n);
    (before > 0.0).then(|| (1.0 - excess(fit.rmse_after_n) / before).clamp(0.0, 1.0))
}

fn card_of_fit(label: &str, fit: BeforeAfter, after: bool) -> String {
    let all = newtons(fit.rmse_all_before_n);
    if !after {
        let note = format!("RMSE of the base model, counted samples; {all} over all samples");
        return card(label, &newtons(fit.rmse_before_n), &note);
    }
    let figure = format!("{} → {}", newtons(fit.rmse_before_n), newtons(fit.rmse_after_n));
    let all = format!("{all} → {} over all samples", newtons(fit.rmse_all_after_n));
    let note = match share_explained(fit) {
        Some(share) => {
            format!("RMSE, counted samples; {} of the excess over the noise floor is gone; {all}", percent(share))
        }
        None => format!("RMSE, counted samples; {all}"),
    };
    card(label, &figure, &note)
}
