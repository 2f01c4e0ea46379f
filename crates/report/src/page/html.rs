//! Pieces of the document.

use pam_muscle::effects::Symbol;

use crate::escape::escaped;
use crate::number::significant;

/// A paragraph.
pub(crate) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// A paragraph in small gray letters.
pub(crate) fn remark(text: &str) -> String {
    format!("<p class=\"remark\">{}</p>\n", escaped(text))
}

/// A heading below the section's.
pub(crate) fn heading(text: &str) -> String {
    format!("<h3>{}</h3>\n", escaped(text))
}

/// A list with a dot before each entry; nothing for none.
pub(crate) fn list<S: AsRef<str>>(entries: &[S]) -> String {
    if entries.is_empty() {
        return String::new();
    }
    let entries: String = entries.iter().map(|entry| format!("<li>{}</li>\n", escaped(entry.as_ref()))).collect();
    format!("<ul>\n{entries}</ul>\n")
}

/// A figure with what it says written below.
pub(crate) fn figure(svg: &str, caption: &str) -> String {
    format!("<figure>\n{svg}<figcaption>{}</figcaption>\n</figure>\n", escaped(caption))
}

/// A narrow figure, which is not stretched to the width of the page.
pub(crate) fn compact_figure(svg: &str, caption: &str) -> String {
    format!("<figure class=\"compact\">\n{svg}<figcaption>{}</figcaption>\n</figure>\n", escaped(caption))
}

/// A table that scrolls by itself where the page is narrow.
pub(crate) fn table(table: &crate::Table) -> String {
    format!("<div class=\"scroll\">\n{}</div>\n", table.to_html())
}

/// A table whose first column holds symbols, set as in an equation.
pub(crate) fn symbol_table(table: &crate::Table) -> String {
    let set = |symbol: &str| if symbol.is_empty() { String::new() } else { format!("<em>{}</em>", scripts(symbol)) };
    format!("<div class=\"scroll\">\n{}</div>\n", table.to_html_with(set))
}

/// An equation: one line per part, what follows `_` lowered, what follows `^` raised.
pub(crate) fn equation(text: &str) -> String {
    let lines: Vec<String> = text.split(",  ").map(|line| format!("<span>{}</span>", scripts(line.trim()))).collect();
    format!("<div class=\"equation\">{}</div>\n", lines.join("\n"))
}

/// Symbols of an equation with unit and meaning, each symbol set as in the equation.
pub(crate) fn symbols(symbols: &[Symbol]) -> String {
    let rows: String = symbols
        .iter()
        .map(|Symbol { symbol, unit, meaning }| {
            let (unit, meaning) = (escaped(unit), escaped(meaning));
            format!("<tr><td><em>{}</em></td><td>{unit}</td><td>{meaning}</td></tr>\n", scripts(symbol))
        })
        .collect();
    format!(
        "<div class=\"scroll\">\n<table>\n<thead><tr><th>symbol</th><th>unit</th><th>meaning and usual range</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n</div>\n"
    )
}

/// Subscripts of symbols of one or two letters; longer names with `_` are left as they are.
fn scripts(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let word = |at: usize| characters.get(at).is_some_and(|character| character.is_alphanumeric() || *character == '_');
    let mut out = String::new();
    let mut at = 0;
    while at < characters.len() {
        let letters_before = (0..at).rev().take_while(|before| word(*before)).count();
        let tag = match characters[at] {
            '_' if (1..=2).contains(&letters_before) => "sub",
            '^' => "sup",
            _ => "",
        };
        let end = (at + 1..characters.len()).find(|next| !word(*next)).unwrap_or(characters.len());
        if characters[at] == '-' && !word(at.wrapping_sub(1)) {
            // A minus, but not the hyphen of a compound word.
            out.push('−');
            at += 1;
        } else if tag.is_empty() || end == at + 1 {
            out.push_str(&escaped(&characters[at].to_string()));
            at += 1;
        } else {
            let script: String = characters[at + 1..end].iter().collect();
            out.push_str(&format!("<{tag}>{}</{tag}>", escaped(&script)));
            at = end;
        }
    }
    out
}

/// A figure that matters, in a frame with what it is.
pub(crate) fn card(label: &str, figure: &str, note: &str) -> String {
    let (label, figure, note) = (escaped(label), escaped(figure), escaped(note));
    format!(
        "<div class=\"card\"><p class=\"label\">{label}</p><p class=\"figure\">{figure}</p>\
         <p class=\"note\">{note}</p></div>\n"
    )
}

/// A force for people: `2.31 N`, `0.61 N`, `120 N`.
pub(crate) fn newtons(value: f64) -> String {
    if !value.is_finite() {
        return significant(value, 3);
    }
    let size = value.abs();
    // Forces beside one another show the same decimals on both sides of 1 N.
    format!("{} N", significant(value, if size < 0.995 { 2 } else { 3 }))
}

/// A share for people: `38 %`.
pub(crate) fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".to_owned();
    }
    let percent = 100.0 * share;
    match percent {
        _ if percent > 0.0 && percent < 1.0 => "< 1 %".to_owned(),
        _ if percent > 99.0 && percent < 100.0 => "> 99 %".to_owned(),
        _ => format!("{percent:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_have_lines_and_scripts() {
        let html = equation("F = F_c(p) - z_i,  a < b^2,  gas_gain");
        let expected = "<div class=\"equation\"><span>F = F<sub>c</sub>(p) − z<sub>i</sub></span>\n\
                        <span>a &lt; b<sup>2</sup></span>\n<span>gas_gain</span></div>\n";
        assert_eq!(html, expected);
    }

    #[test]
    fn shares_are_whole_percents() {
        assert_eq!([0.0, 0.004, 0.376, 0.999, 1.0].map(percent), ["0 %", "< 1 %", "38 %", "> 99 %", "100 %"]);
    }
}
