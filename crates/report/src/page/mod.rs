//! Parts of pages: the document around them, its pieces, and its colors in the light and in the dark.

pub(crate) mod html;
pub(crate) mod style;

use crate::escape::escaped;

/// A section: anchor, title, body.
pub(crate) type Section = (&'static str, &'static str, String);

/// A whole document: `header`, links to the sections, and the sections, counted. `more_style` follows the style sheet of
/// all pages, and `script` ends the document; a page says all that it has to say without it.
pub(crate) fn document(title: &str, header: &str, sections: &[Section], more_style: &str, script: &str) -> String {
    let links: String = sections.iter().map(|(id, title, _)| format!("<a href=\"#{id}\">{title}</a>\n")).collect();
    let body: String = sections
        .iter()
        .enumerate()
        .map(|(index, (id, title, body))| {
            let count = index + 1;
            format!("<section id=\"{id}\">\n<h2><span class=\"count\">{count}</span>{title}</h2>\n{body}</section>\n")
        })
        .collect();
    let script = if script.is_empty() { String::new() } else { format!("<script>\n{script}</script>\n") };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n\
         <style>\n{}{more_style}</style>\n</head>\n<body>\n<main>\n{header}<nav>\n{links}</nav>\n{body}</main>\n\
         {script}</body>\n</html>\n",
        escaped(title),
        style::style(),
    )
}
