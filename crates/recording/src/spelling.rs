//! The word that was probably meant.

use std::io;
use std::path::Path;

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

/// A number for a message: as it is written, or with a power of ten where that would fill the line with digits.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-6..1e15).contains(&size) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// Why a file cannot be read, for a message; where it is missing, with the name of the folder that is nearest to its own.
pub fn unreadable(path: &Path, reason: &io::Error) -> String {
    if reason.kind() != io::ErrorKind::NotFound {
        return reason.to_string();
    }
    let near = path.file_name().and_then(|name| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut names: Vec<String> =
            folder.read_dir().ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
        // The order in which a folder lists its files is nobody's.
        names.sort_unstable();
        // The ending alone makes no name alike.
        let stem = |name: &str| name.split('.').next().unwrap_or(name).to_owned();
        let wanted = name.to_str()?;
        names.retain(|name| nearest(&stem(wanted), [stem(name).as_str()]).is_some());
        let near = nearest(wanted, names.iter().map(String::as_str))?;
        Some(path.with_file_name(near).display().to_string())
    });
    match near {
        Some(near) => format!("no such file; did you mean {near}?"),
        None => "no such file; check the path".to_owned(),
    }
}

/// Message of a parser about an unknown word, with the nearest word it knows in place of all of them where one is near.
///
/// Understands the sentences of serde: "unknown field `a`, expected one of `b`, `c`".
pub fn suggesting(message: &str) -> String {
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

/// Line and column of the byte `start`, both counted from 1.
pub fn place_in(text: &str, start: usize) -> (usize, usize) {
    let before = &text[..start.min(text.len())];
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |tail| tail.chars().count()) + 1;
    (line, column)
}

/// Why a text is no TOML of the kind that was expected: line and column, both counted from 1, and the reason.
pub fn toml_fault(text: &str, error: &toml::de::Error) -> (usize, usize, String) {
    let (line, column) = place_in(text, error.span().map_or(0, |span| span.start));
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
    fn a_number_of_three_hundred_digits_is_written_with_a_power_of_ten() {
        let said = [-5.0, 0.0, 0.1 + 0.2, 3e9, 1e300, -2e-9].map(number);
        assert_eq!(said, ["-5", "0", "0.30000000000000004", "3000000000", "1e300", "-2e-9"]);
    }

    #[test]
    fn a_missing_file_is_told_its_nearest_neighbor() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("model.json"), "").expect("a file");
        let said = |name: &str| {
            let path = folder.path().join(name);
            let reason = std::fs::read(&path).expect_err("no such file");
            unreadable(&path, &reason).replace(&folder.path().display().to_string(), "F")
        };
        assert_eq!(said("modle.json"), "no such file; did you mean F/model.json?");
        assert_eq!(said("recording.csv"), "no such file; check the path");
        assert_eq!(said("none.json"), "no such file; check the path");
        assert_eq!(said("none/model.json"), "no such file; check the path");
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
