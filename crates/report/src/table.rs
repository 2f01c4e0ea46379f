//! Tables for terminals, Markdown and HTML.

use comfy_table::{CellAlignment, ContentLineStyle, LineStyle, TableStyle, presets};

use crate::escape::escaped;
use crate::number::with_minus;

/// A header, a thin rule, columns held apart by blanks.
const LIGHT: TableStyle = TableStyle::new()
    .header_lines(ContentLineStyle::none().junction(' '))
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .content_lines(ContentLineStyle::none().junction(' '));

/// A table; columns that hold numbers are aligned right.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table.
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row; missing cells stay empty, superfluous ones get a column without a name. A hyphen in
    /// front of a number becomes a minus.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) -> &mut Self {
        let cells = cells.into_iter().map(Into::into);
        self.rows.push(cells.map(|cell: String| if is_number(&cell) { with_minus(cell) } else { cell }).collect());
        self
    }

    /// For a terminal; every line ends with a line break.
    pub fn to_terminal(&self) -> String {
        let drawn = self.draw(LIGHT, true, |cell| cell.to_owned());
        drawn.lines().map(|line| format!("{}\n", line.trim_end())).collect()
    }

    /// As a Markdown table; every line ends with a line break.
    pub fn to_markdown(&self) -> String {
        let drawn = self.draw(presets::ASCII_MARKDOWN, false, |cell| cell.replace('|', "\\|"));
        let mut text = String::new();
        for (index, line) in drawn.lines().enumerate() {
            if index == 1 {
                // The colon that aligns a column to the right takes the place of its last dash.
                for (column, dashes) in line.trim_matches('|').split('|').enumerate() {
                    let end = if self.is_numeric(column) { ":" } else { "-" };
                    text.extend(["|", &dashes[..dashes.len().saturating_sub(1)], end]);
                }
                text.push_str("|\n");
            } else {
                text.extend([line, "\n"]);
            }
        }
        text
    }

    /// As an HTML table; cells of columns that hold numbers have the class `number`.
    pub fn to_html(&self) -> String {
        self.to_html_with(escaped)
    }

    /// The same, with the first column as `first` sets it; what that gives is taken as markup.
    pub(crate) fn to_html_with(&self, first: impl Fn(&str) -> String) -> String {
        let columns = self.columns();
        let line = |name: &str, cells: &[String]| {
            let cell = |column: usize| {
                let set = |cell: &String| if column == 0 && name == "td" { first(cell) } else { escaped(cell) };
                let text = cells.get(column).map_or(String::new(), set);
                let class = if self.is_numeric(column) { " class=\"number\"" } else { "" };
                format!("<{name}{class}>{text}</{name}>")
            };
            format!("<tr>{}</tr>\n", (0..columns).map(cell).collect::<String>())
        };
        let body: String = self.rows.iter().map(|row| line("td", row)).collect();
        format!("<table>\n<thead>{}</thead>\n<tbody>\n{body}</tbody>\n</table>\n", line("th", &self.header).trim_end())
    }

    fn columns(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0).max(self.header.len())
    }

    fn draw(&self, style: TableStyle, terminal: bool, escape: impl Fn(&str) -> String) -> String {
        let columns = self.columns();
        let padded = |cells: &[String]| -> Vec<String> {
            (0..columns).map(|column| cells.get(column).map_or(String::new(), |cell| escape(cell))).collect()
        };
        let mut table = comfy_table::Table::new();
        table.load_style(style).set_header(padded(&self.header));
        for row in &self.rows {
            table.add_row(padded(row));
        }
        for (index, column) in table.column_iter_mut().enumerate() {
            // Two blanks between columns: more would cost a terminal a column.
            if terminal {
                column.set_padding((1, 0));
            }
            if self.is_numeric(index) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        table.to_string()
    }

    /// Whether every cell of a column that says something is a number.
    fn is_numeric(&self, column: usize) -> bool {
        let mut cells =
            self.rows.iter().filter_map(|row| row.get(column)).filter(|cell| !matches!(cell.as_str(), "" | "–" | "-"));
        let first = cells.next().is_some_and(|cell| is_number(cell));
        first && cells.all(|cell| is_number(cell))
    }
}

/// Whether a cell starts like a number: `1.05 ± 0.01`, `(2.5 ± 0.1)e9`, `152 kPa`, `0, at its bound`.
fn is_number(cell: &str) -> bool {
    let unsigned = cell.trim_start_matches(['(', '-', '−', '+', '<', '>', ' ']);
    let first_word = unsigned.split([' ', ')']).next().unwrap_or("").trim_end_matches(['%', ',']);
    unsigned.starts_with(|character: char| character.is_ascii_digit())
        && first_word.chars().all(|character| character.is_ascii_digit() || "+-−.e⁻⁰¹²³⁴⁵⁶⁷⁸⁹".contains(character))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> Table {
        let mut table = Table::new(["parameter", "value", "status"]);
        table.row(["gas_gain", "1.052 ± 0.004", "fitted"]);
        table.row(["friction|rubber", "-12.5 ± 0.3", "at_bound"]);
        table.row(["tare", "–"]);
        table
    }

    #[test]
    fn a_terminal_table_is_light_and_aligned() {
        let expected = " parameter                value  status
─────────────────────────────────────────
 gas_gain         1.052 ± 0.004  fitted
 friction|rubber    −12.5 ± 0.3  at_bound
 tare                         –
";
        assert_eq!(parameters().to_terminal(), expected);
    }

    #[test]
    fn a_markdown_table_aligns_numbers_and_escapes_bars() {
        let expected = "\
| parameter        |         value | status   |
|------------------|--------------:|----------|
| gas_gain         | 1.052 ± 0.004 | fitted   |
| friction\\|rubber |   −12.5 ± 0.3 | at_bound |
| tare             |             – |          |
";
        assert_eq!(parameters().to_markdown(), expected);
    }

    #[test]
    fn an_html_table_marks_numbers_and_escapes_markup() {
        let html = parameters().to_html();
        assert!(html.contains("<th>parameter</th><th class=\"number\">value</th>"), "{html}");
        assert!(html.contains("<tr><td>tare</td><td class=\"number\">–</td><td></td></tr>"), "{html}");
        let mut table = Table::new(["<a> & b"]);
        assert!(table.row(["<"]).to_html().contains("<th>&lt;a&gt; &amp; b</th>"));
    }

    #[test]
    fn words_that_begin_with_a_digit_are_no_numbers() {
        assert!(!is_number("2nd"));
        assert!(!is_number("log-3"));
        assert!(is_number("95 %") && is_number("1.6e-7") && is_number("−3") && is_number("0, at its bound"));
    }

    #[test]
    fn an_empty_table_is_a_header() {
        assert_eq!(Table::new(["a"]).to_terminal().lines().next(), Some(" a"));
    }
}
