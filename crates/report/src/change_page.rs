//! The page of what has changed since an earlier diagnosis: one self-contained HTML document.
//!
//! | section    | says                                                             |
//! |------------|------------------------------------------------------------------|
//! | top        | the verdict, and what is left of the force                       |
//! | changed    | each change with its size, in its unit and in standard errors    |
//! | unchanged  | everything else that was compared, and how far it may differ     |
//! | time       | force as measured, of the baseline and with the changes          |
//! | candidates | everything that was weighed                                      |
//! | appendix   | muscle, command, files and their digests                         |

use crate::diagnosis_page::ending::appendix;
use crate::diagnosis_page::over_time::{SCRIPT, over_time};
use crate::diagnosis_page::samples::Samples;
use crate::escape::escaped;
use crate::number::significant;
use crate::page::document;
use crate::page::html::{card, heading, list, newtons, paragraph, percent, remark, table};
use crate::{FigureError, PageAppendix, PageRecording, Table};

/// Content of the page; numbers with units come as they are written.
#[derive(Debug, Clone)]
pub struct ChangePage {
    /// Title.
    pub title: String,
    /// Color of the verdict: `consistent`, `explained`, `ambiguous` or `unexplained`.
    pub class: &'static str,
    /// The verdict in a few words.
    pub verdict: String,
    /// In a sentence or two.
    pub statement: String,
    /// Changes.
    pub changes: Vec<PageChange>,
    /// Everything else.
    pub unchanged: Vec<PageCompared>,
    /// RMSE of the baseline on its own recordings, on the later ones, and with what has changed, in N.
    pub rmse_n: [f64; 3],
    /// RMSE that the sensors leave of a perfect model, in N.
    pub noise_floor_n: f64,
    /// Share of the samples that were compared.
    pub share_compared: f64,
    /// Names of the baseline and of the baseline with the changes, beside the measured force.
    pub names: [&'static str; 2],
    /// The later recordings.
    pub recordings: Vec<PageRecording>,
    /// Candidates: id, log predictive ratio, RMSE in N.
    pub candidates: Vec<(String, f64, f64)>,
    /// How the comparison came about.
    pub appendix: PageAppendix,
    /// Warnings before use.
    pub warnings: Vec<String>,
}

/// A change.
#[derive(Debug, Clone)]
pub struct PageChange {
    /// In words.
    pub said: String,
    /// Its numbers.
    pub numbers: Vec<PageCompared>,
    /// Cross-validated RMSE without and with it, in N.
    pub rmse_n: [f64; 2],
    /// Effects that it cannot be distinguished from.
    pub alternatives: Vec<String>,
}

/// A number then and now.
#[derive(Debug, Clone)]
pub struct PageCompared {
    /// Name.
    pub name: String,
    /// Value then.
    pub then: String,
    /// Value now, with the standard error of the difference.
    pub now: String,
    /// Difference over it.
    pub standard_errors: String,
}

/// Writes the page, as an HTML document.
///
/// # Errors
/// [`FigureError`] if columns of a recording differ in length.
pub fn change_page(page: &ChangePage) -> Result<String, FigureError> {
    let [own, before, after] = &page.rmse_n;
    let floor = page.noise_floor_n;
    let note = format!("RMSE; {} on its own recordings", newtons(*own));
    let within = format!("RMSE; noise floor {}", newtons(floor));
    let cards = card("Baseline on the later recordings", &newtons(*before), &note)
        + &card(&capitalized(page.names[1]), &newtons(*after), &within)
        + &card(
            "Compared",
            &percent(page.share_compared),
            "of the samples: within the pressures and lengths of the baseline",
        );
    let warnings = if page.warnings.is_empty() {
        String::new()
    } else {
        format!("<div class=\"warnings\">\n<p>Know before use</p>\n{}</div>\n", list(&page.warnings))
    };
    let header = format!(
        "<header class=\"{}\">\n<h1>{}</h1>\n<p class=\"verdict\">{}</p>\n<p class=\"statement\">{}</p>\n\
         <div class=\"cards\">\n{cards}</div>\n{warnings}</header>\n",
        page.class,
        escaped(&page.title),
        escaped(&page.verdict),
        escaped(&capitalized(&page.statement))
    );
    let recordings = page.recordings.iter().map(Samples::new).collect::<Result<Vec<_>, _>>()?;
    let sections = [
        ("changed", "What has changed?", changed(page)),
        ("time", "Measured and modelled force over time", over_time(&recordings, |_| floor, page.names)?),
        ("unchanged", "Not named as changed", unchanged(page)),
        ("candidates", "Candidates", candidates(page)),
        ("appendix", "Appendix: provenance", appendix(&page.appendix)),
    ];
    Ok(document(&page.title, &header, &sections, "", SCRIPT))
}

fn compared(rows: &[PageCompared]) -> String {
    let mut cells = Table::new(["", "then", "now", "standard errors"]);
    for row in rows {
        cells.row([row.name.clone(), row.then.clone(), row.now.clone(), row.standard_errors.clone()]);
    }
    table(&cells)
}

fn changed(page: &ChangePage) -> String {
    if page.changes.is_empty() {
        return paragraph("Nothing that these recordings show.");
    }
    let remark_of_errors = remark("Each standard error is of the difference, of then and now together.");
    let one = |change: &PageChange| {
        let [without_n, with_n] = change.rmse_n;
        let mut html = heading(&capitalized(&change.said));
        html.push_str(&compared(&change.numbers));
        html.push_str(&remark(&format!(
            "Cross-validated RMSE {} without it, {} with it.",
            newtons(without_n),
            newtons(with_n)
        )));
        if !change.alternatives.is_empty() {
            html.push_str(&paragraph(&format!(
                "These recordings cannot distinguish it from a change of {}.",
                change.alternatives.join(" or ")
            )));
        }
        html
    };
    page.changes.iter().map(one).collect::<String>() + &remark_of_errors
}

fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

fn unchanged(page: &ChangePage) -> String {
    remark(
        "Each alone, fitted beside the changes. A number is named as changed where it lowers the error on blocks left out of the \
         fit; one that does not is listed here, however many standard errors it moves.",
    ) + &compared(&page.unchanged)
}

fn candidates(page: &ChangePage) -> String {
    let mut cells = Table::new(["candidate, alone", "log predictive ratio", "cross-validated RMSE"]);
    for (id, log_ratio, rmse_n) in &page.candidates {
        cells.row([id.clone(), significant(*log_ratio, 3), newtons(*rmse_n)]);
    }
    table(&cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_a_text_contains_is_shown_as_written() {
        let number = PageCompared {
            name: "c10 + c01".to_owned(),
            then: "220 kPa".to_owned(),
            now: "180 ± 3 kPa".to_owned(),
            standard_errors: "-13.3".to_owned(),
        };
        let columns = [[0.0, 1.0, 2.0].to_vec(), vec![5.0; 3], vec![8.0; 3], vec![5.5; 3]];
        let page = ChangePage {
            title: "What has changed since <a>.json".to_owned(),
            class: "explained",
            verdict: "Changed".to_owned(),
            statement: "bladder & nothing else".to_owned(),
            changes: vec![PageChange {
                said: "the bladder is softer".to_owned(),
                numbers: vec![number],
                rmse_n: [3.0, 0.5],
                alternatives: vec!["k1".to_owned()],
            }],
            unchanged: Vec::new(),
            rmse_n: [0.5, 3.0, 0.5],
            noise_floor_n: 0.4,
            share_compared: 0.97,
            names: ["baseline", "with the changes"],
            recordings: vec![PageRecording::over_time("later <1>".to_owned(), columns, vec![true; 3])],
            candidates: vec![("k1".to_owned(), 12.0, 1.0)],
            appendix: PageAppendix::default(),
            warnings: vec!["mind <this>".to_owned()],
        };
        let html = change_page(&page).expect("columns of one length");
        assert!(html.contains("What has changed since &lt;a&gt;.json") && html.contains("mind &lt;this&gt;"));
        assert!(html.contains("180 ± 3 kPa") && html.contains("−13.3") && html.contains("cannot distinguish it"));
        assert!(html.contains("The bladder is softer") && html.contains("Bladder &amp; nothing else"));
        assert!(html.contains("later &lt;1&gt;") && html.contains("RMSE 3.00 N → 0.50 N counted"), "{html}");
    }
}
