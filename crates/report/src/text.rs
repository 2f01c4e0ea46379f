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

/// Names in at most `room` columns each: where that makes two the same, without what all of them begin with.
pub fn told_apart(names: &[&str], room: usize) -> Vec<String> {
    let short: Vec<String> = names.iter().map(|name| shortened(name, room)).collect();
    let is_twice = |index: usize| short[..index].contains(&short[index]) && !names[..index].contains(&names[index]);
    let Some((first, others)) = names.split_first().filter(|_| (0..short.len()).any(is_twice)) else { return short };
    let alike = |other: &&str| first.chars().zip(other.chars()).take_while(|(left, right)| left == right).count();
    let n_alike = others.iter().map(alike).min().unwrap_or(0);
    let tail = |name: &&str| format!("…{}", name.chars().skip(n_alike).collect::<String>());
    names.iter().map(|name| shortened(&tail(name), room)).collect()
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
    fn names_that_begin_alike_are_told_apart() {
        let names = ["bpa10_L30cm_len244.2mm_test9.csv", "bpa10_L30cm_len281.0mm_test9.csv"];
        assert_eq!(told_apart(&names, 22), ["…44.2mm_test9.csv", "…81.0mm_test9.csv"]);
        assert_eq!(told_apart(&["a.csv", "b.csv"], 22), ["a.csv", "b.csv"]);
        assert_eq!(told_apart(&[], 22), Vec::<String>::new());
    }

    #[test]
    fn a_name_keeps_both_ends() {
        assert_eq!(shortened("run1.csv", 8), "run1.csv");
        assert_eq!(shortened("bpa10_L20cm_len159.5mm.csv", 11), "bpa10…m.csv");
    }
}
