//! Fields of one line, and the numbers in them.

use std::borrow::Cow;
use std::ops::Range;

/// A line whose quote is not closed, with the field (counted from 0) that it opens.
#[derive(Debug, PartialEq)]
pub(crate) struct OpenQuote {
    pub(crate) field: usize,
}

/// Text that is no number to calculate with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum NumberFault {
    NotANumber,
    NotFinite,
}

/// The line without its end and without a carriage return.
pub(crate) fn strip_line_end(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// Nothing but blanks.
pub(crate) fn is_blank(line: &[u8]) -> bool {
    line.iter().all(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n'))
}

/// A comment, perhaps indented.
pub(crate) fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start().first() == Some(&b'#')
}

/// Splits a line into fields without the blanks and quotes around them. Of the fields, at most `limit` are
/// stored in `fields`; the number of all of them is returned.
pub(crate) fn split(
    line: &[u8],
    separator: u8,
    limit: usize,
    fields: &mut Vec<Range<usize>>,
) -> Result<usize, OpenQuote> {
    fields.clear();
    let is_space = |byte: u8| byte == b' ' || (byte == b'\t' && separator != b'\t');
    let mut n_fields = 0;
    let mut position = 0;
    loop {
        while position < line.len() && is_space(line[position]) {
            position += 1;
        }
        let mut field = position..position;
        if line.get(position) == Some(&b'"') {
            let close = closing_quote(line, position + 1).ok_or(OpenQuote { field: n_fields })?;
            field = position + 1..close;
            position = close + 1;
        }
        let from = position;
        while position < line.len() && line[position] != separator {
            position += 1;
        }
        if !line[from..position].iter().all(|byte| is_space(*byte)) {
            // Text without quotes, or text behind a closing quote, which then is part of it.
            let first = if from == field.start { from } else { field.start - 1 };
            field = first..position;
        }
        let content = &line[field.clone()];
        let start = field.start + content.len() - content.trim_ascii_start().len();
        let field = start..start + content.trim_ascii().len();
        if n_fields < limit {
            fields.push(field);
        }
        n_fields += 1;
        if position == line.len() {
            return Ok(n_fields);
        }
        position += 1;
    }
}

/// The quote that closes; two in a row stand for one inside.
fn closing_quote(line: &[u8], mut position: usize) -> Option<usize> {
    loop {
        position += line.get(position..)?.iter().position(|byte| *byte == b'"')?;
        if line.get(position + 1) != Some(&b'"') {
            return Some(position);
        }
        position += 2;
    }
}

/// The text of a field; bytes that are not UTF-8 are replaced.
pub(crate) fn text(field: &[u8]) -> Cow<'_, str> {
    let text = String::from_utf8_lossy(field);
    if text.contains("\"\"") { Cow::Owned(text.replace("\"\"", "\"")) } else { text }
}

/// The number in a field without blanks around it.
pub(crate) fn number(field: &[u8], decimal_comma: bool) -> Result<f64, NumberFault> {
    let mut copy = [0_u8; 64];
    let mut digits = field;
    if decimal_comma && let Some(comma) = field.iter().position(|byte| *byte == b',') {
        if field.len() > copy.len() || field.contains(&b'.') {
            return Err(NumberFault::NotANumber);
        }
        copy[..field.len()].copy_from_slice(field);
        copy[comma] = b'.';
        digits = &copy[..field.len()];
    }
    match fast_float2::parse::<f64, _>(digits) {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(NumberFault::NotFinite),
        Err(_) => Err(NumberFault::NotANumber),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(line: &str, separator: char) -> Vec<String> {
        let mut ranges = Vec::new();
        let n_fields = split(line.as_bytes(), separator as u8, usize::MAX, &mut ranges).unwrap();
        assert_eq!(n_fields, ranges.len());
        ranges.into_iter().map(|range| text(&line.as_bytes()[range]).into_owned()).collect()
    }

    #[test]
    fn fields_lose_their_blanks_and_quotes() {
        assert_eq!(fields("a,b , c", ','), ["a", "b", "c"]);
        assert_eq!(fields("\"a, b\" ,\" c\",", ','), ["a, b", "c", ""]);
        assert_eq!(fields("\"say \"\"x\"\"\";2", ';'), ["say \"x\"", "2"]);
        assert_eq!(fields("\"a\"b,5\" pipe", ','), ["\"a\"b", "5\" pipe"]);
        assert_eq!(fields("\t1\t", '\t'), ["", "1", ""]);
        assert_eq!(fields("", ','), [""]);
        assert_eq!(fields(" \"\" ,\"1\"", ','), ["", "1"]);
    }

    #[test]
    fn a_quote_left_open_is_found_in_its_field() {
        assert_eq!(split(b"1,\"2,3", b',', 9, &mut Vec::new()), Err(OpenQuote { field: 1 }));
        assert_eq!(split(b"\"\"\"", b',', 9, &mut Vec::new()), Err(OpenQuote { field: 0 }));
    }

    #[test]
    fn numbers_are_read_with_point_or_comma() {
        for (text, value) in [("1", 1.0), ("-1.5e-3", -1.5e-3), ("+2.", 2.0), (".5", 0.5), ("1E3", 1e3)] {
            assert_eq!(number(text.as_bytes(), false), Ok(value), "{text}");
        }
        assert_eq!(number(b"-1,5e2", true), Ok(-150.0));
        assert_eq!(number(b"1,5", false), Err(NumberFault::NotANumber));
        for text in ["", "-", "1.2.3", "1e", "0x10", "1_0", "12 3", "1,2,3", "1.234,5", "one"] {
            assert_eq!(number(text.as_bytes(), true), Err(NumberFault::NotANumber), "{text}");
        }
        for text in ["nan", "NaN", "inf", "-Infinity", "1e999"] {
            assert_eq!(number(text.as_bytes(), true), Err(NumberFault::NotFinite), "{text}");
        }
    }
}
