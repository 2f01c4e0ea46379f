//! The word that was probably meant.

/// The candidate nearest to `word`, if one is near enough to be worth suggesting; case does not count.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates {
        let similarity = strsim::jaro_winkler(&lower, &candidate.to_lowercase());
        // 0.8 keeps transposed, missing and doubled letters and drops words that only share a beginning.
        if similarity > best.map_or(0.8, |(similarity, _)| similarity) {
            best = Some((similarity, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// What a parser said of an unknown word, with the nearest word it knows in place of all of them where one is near.
///
/// Understands the sentences of serde: "unknown field `a`, expected one of `b`, `c`".
pub(crate) fn suggesting(message: &str) -> String {
    let suggestion = || {
        let (known, expected) = message.split_once(", expected ")?;
        let (what, rest) = known.split_once('`')?;
        let word = rest.strip_suffix('`').filter(|_| what.starts_with("unknown "))?;
        // Between backquotes is every second piece.
        let near = nearest(word, expected.split('`').skip(1).step_by(2))?;
        Some(format!("{known}; did you mean `{near}`?"))
    };
    suggestion().unwrap_or_else(|| message.to_owned())
}

/// Why a text is no TOML of the kind that was expected: line and column, both counted from 1, and the reason.
pub fn toml_fault(text: &str, error: &toml::de::Error) -> (usize, usize, String) {
    let start = error.span().map_or(0, |span| span.start).min(text.len());
    let before = &text[..start];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |tail| tail.chars().count()) + 1;
    (line, column, suggesting(&error.message().replace('\n', " ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_finds_its_word() {
        let effects = ["stribeck", "viscous-damping", "mullins-softening"];
        assert_eq!(nearest("Stibreck", effects), Some("stribeck"));
        assert_eq!(nearest("viscous-dampning", effects), Some("viscous-damping"));
        assert_eq!(nearest("gearbox", effects), None);
    }

    #[test]
    fn a_parser_that_lists_what_it_knows_gets_the_nearest_word() {
        let said = "unknown field `rest_lenght_mm`, expected one of `rest_radius_mm`, `rest_length_mm`";
        assert_eq!(suggesting(said), "unknown field `rest_lenght_mm`; did you mean `rest_length_mm`?");
        let said = "unknown variant `on-of`, expected `proportional` or `on-off`";
        assert_eq!(suggesting(said), "unknown variant `on-of`; did you mean `on-off`?");
        for said in ["unknown field `gearbox`, expected one of `arm`, `load`", "missing field `fit`", "expected `=`"] {
            assert_eq!(suggesting(said), said);
        }
    }
}
