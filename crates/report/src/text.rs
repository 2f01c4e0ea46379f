//! Text for a terminal, in lines that fit it.

/// Columns that text and tables keep within; terminals have at least as many.
pub const WIDTH: usize = 80;

/// `text` in lines of at most [`WIDTH`] columns, each after `indent`; line breaks stay. A word that is longer has a line of its
/// own. There is no line break at the end.
pub fn wrapped(text: &str, indent: &str) -> String {
    hanging(text, indent, indent)
}

/// The same, with `first` before the first line, and `indent` before all others.
pub fn hanging(text: &str, first: &str, indent: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for paragraph in text.split('\n') {
        let start = if lines.is_empty() { first } else { indent };
        let mut line = start.to_owned();
        let mut is_empty = true;
        for word in paragraph.split_whitespace() {
            if !is_empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(std::mem::replace(&mut line, indent.to_owned()));
                is_empty = true;
            }
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
        lines.push(line);
    }
    lines.join("\n")
}

/// A name in at most `room` columns: its beginning and its end, with … between.
pub fn shortened(name: &str, room: usize) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= room {
        return name.to_owned();
    }
    let kept = room.saturating_sub(1);
    let head = kept.div_ceil(2);
    letters[..head].iter().chain(&['…']).chain(&letters[letters.len() - (kept - head)..]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_fit_and_words_stay_whole() {
        let text = "one two three ".repeat(20);
        let lines = wrapped(&text, "  ");
        assert!(
            lines
                .lines()
                .all(|line| line.chars().count() <= WIDTH && line.starts_with("  o") || line.starts_with("  t"))
        );
        assert_eq!(lines.split_whitespace().count(), 60);
        assert_eq!(hanging("a b", "x ", "  "), "x a b");
        let long = "x".repeat(100);
        assert_eq!(wrapped(&format!("a {long} b"), ""), format!("a\n{long}\nb"));
    }

    #[test]
    fn a_name_keeps_both_ends() {
        assert_eq!(shortened("run1.csv", 8), "run1.csv");
        assert_eq!(shortened("bpa10_L20cm_len159.5mm.csv", 11), "bpa10…m.csv");
    }
}
