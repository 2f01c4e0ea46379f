//! Color on a terminal.
//!
//! Standard error is colored where it is a terminal, `NO_COLOR` is not set (<https://no-color.org>) and the terminal is not dumb.
//! Nothing is said by color alone.

use std::io::IsTerminal as _;
use std::sync::OnceLock;

/// What is said in passing.
pub(crate) const DIM: &str = "2";
/// What a person should look at.
pub(crate) const YELLOW: &str = "1;33";
/// What ended the run.
pub(crate) const RED: &str = "1;31";
/// Headings.
const BOLD: &str = "1";

/// `text` in `style`, where there is color.
pub(crate) fn level(text: &str, style: &str) -> String {
    painted(text, style, is_colored())
}

/// A table with its heading in bold, where there is color: the line before the rule, and where there is one the line before that.
pub(crate) fn table(text: &str) -> String {
    table_in(text, is_colored())
}

fn table_in(text: &str, colored: bool) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let is_rule = |index: usize| lines.get(index).is_some_and(|line| line.starts_with('─'));
    let styled = lines.iter().enumerate().map(|(index, line)| {
        let bold = is_rule(index + 1) || (index == 0 && !line.is_empty());
        painted(line, if is_rule(index) { DIM } else { BOLD }, colored && (bold || is_rule(index)))
    });
    styled.collect::<Vec<String>>().join("\n")
}

fn painted(text: &str, style: &str, colored: bool) -> String {
    if colored { format!("\u{1b}[{style}m{text}\u{1b}[0m") } else { text.to_owned() }
}

fn is_colored() -> bool {
    static COLORED: OnceLock<bool> = OnceLock::new();
    *COLORED.get_or_init(|| {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let is_dumb = std::env::var_os("TERM").is_none_or(|value| value == "dumb");
        wants_color(std::io::stderr().is_terminal(), is_set("NO_COLOR"), is_dumb)
    })
}

fn wants_color(is_terminal: bool, no_color: bool, is_dumb: bool) -> bool {
    is_terminal && !no_color && !is_dumb
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_terminal_that_wants_it_is_colored() {
        assert!(wants_color(true, false, false));
        for (is_terminal, no_color, is_dumb) in [(false, false, false), (true, true, false), (true, false, true)] {
            assert!(!wants_color(is_terminal, no_color, is_dumb));
        }
    }

    #[test]
    fn a_heading_is_bold_and_the_rest_as_it_was() {
        let text = "Fit\n a  b\n─────\n 1  2";
        assert_eq!(table_in(text, false), text);
        let expected = "\u{1b}[1mFit\u{1b}[0m\n\u{1b}[1m a  b\u{1b}[0m\n\u{1b}[2m─────\u{1b}[0m\n 1  2";
        assert_eq!(table_in(text, true), expected);
    }
}
