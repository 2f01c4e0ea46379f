//! The page of what has changed since an earlier diagnosis: one self-contained HTML document.
//!
//! | section    | says                                                             |
//! |------------|------------------------------------------------------------------|
//! | top        | the verdict, and what is left of the force                       |
//! | changed    | each change with its size, in its unit and in standard errors    |
//! | unchanged  | everything else that was compared, and how far it may differ     |
//! | candidates | what was weighed                                                 |
//! | inputs     | files and their digests                                          |

use crate::Table;
use crate::escape::escaped;
use crate::number::significant;
use crate::page::document;
use crate::page::html::{card, heading, list, newtons, paragraph, remark, table};

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
    /// What has changed.
    pub changes: Vec<PageChange>,
    /// Everything else.
    pub unchanged: Vec<PageCompared>,
    /// Root mean squares of residuals, each with its name, in N.
    pub residuals_n: Vec<(String, f64)>,
    /// What was weighed: id, log predictive ratio, RMSE in N.
    pub candidates: Vec<(String, f64, f64)>,
    /// Files with their SHA-256.
    pub inputs: Vec<(String, String)>,
    /// What to know before use.
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
    /// Ids of what it cannot be distinguished from.
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
pub fn change_page(page: &ChangePage) -> String {
    let cards: String = page.residuals_n.iter().map(|(name, value)| card(name, &newtons(*value), "RMSE")).collect();
    let warnings = if page.warnings.is_empty() {
        String::new()
    } else {
        format!("<div class=\"warnings\">\n<p>Know before use</p>\n{}</div>\n", list(&page.warnings))
    };
    let header = format!(
        "<header class=\"{}\">\n<h1>{}</h1>\n<p class=\"verdict\">{}</p>\n<p class=\"statement\">{}</p>\n\
         <div class=\"cards four\">\n{cards}</div>\n{warnings}</header>\n",
        page.class,
        escaped(&page.title),
        escaped(&page.verdict),
        escaped(&page.statement)
    );
    let sections = [
        ("changed", "What has changed?", changed(page)),
        ("unchanged", "What has not?", unchanged(page)),
        ("candidates", "What was weighed?", candidates(page)),
        ("inputs", "Files", inputs(page)),
    ];
    document(&page.title, &header, &sections, "", "")
}

fn compared(rows: &[PageCompared]) -> String {
    let mut cells = Table::new(["", "then", "now", "difference in standard errors"]);
    for row in rows {
        cells.row([row.name.clone(), row.then.clone(), row.now.clone(), row.standard_errors.clone()]);
    }
    table(&cells)
}

fn changed(page: &ChangePage) -> String {
    if page.changes.is_empty() {
        return paragraph("Nothing that these recordings show.");
    }
    let one = |change: &PageChange| {
        let [without_n, with_n] = change.rmse_n;
        let mut html = heading(&change.said);
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
    page.changes.iter().map(one).collect()
}

fn unchanged(page: &ChangePage) -> String {
    remark("Each alone beside what has changed; standard errors are of the difference, of then and now together.")
        + &compared(&page.unchanged)
}

fn candidates(page: &ChangePage) -> String {
    let mut cells = Table::new(["candidate, alone", "log predictive ratio", "cross-validated RMSE N"]);
    for (id, log_ratio, rmse_n) in &page.candidates {
        cells.row([id.clone(), significant(*log_ratio, 3), significant(*rmse_n, 3)]);
    }
    table(&cells)
}

fn inputs(page: &ChangePage) -> String {
    let mut cells = Table::new(["file", "SHA-256"]);
    for (path, sha256) in &page.inputs {
        cells.row([path.clone(), sha256.clone()]);
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
        let page = ChangePage {
            title: "What has changed since <a>.json".to_owned(),
            class: "explained",
            verdict: "Changed".to_owned(),
            statement: "c10 + c01 & nothing else".to_owned(),
            changes: vec![PageChange {
                said: "the bladder is softer".to_owned(),
                numbers: vec![number],
                rmse_n: [3.0, 0.5],
                alternatives: vec!["k1".to_owned()],
            }],
            unchanged: Vec::new(),
            residuals_n: vec![("Noise floor".to_owned(), 0.4)],
            candidates: vec![("k1".to_owned(), 12.0, 1.0)],
            inputs: vec![("<a>.json".to_owned(), "0".repeat(64))],
            warnings: vec!["mind <this>".to_owned()],
        };
        let html = change_page(&page);
        assert!(html.contains("What has changed since &lt;a&gt;.json") && html.contains("mind &lt;this&gt;"));
        assert!(html.contains("180 ± 3 kPa") && html.contains("−13.3") && html.contains("cannot distinguish it"));
    }
}
