//! Fields of one line, and the numbers in them.

use csv_core::{ReadFieldResult, ReadRecordResult};

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

/// The text of a header: UTF-8, or what loggers on Windows write, whose letters are those of Latin-1.
pub(crate) fn decoded(field: &[u8]) -> String {
    match std::str::from_utf8(field) {
        Ok(text) => text.to_owned(),
        Err(_) => field.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Splits lines into fields.
///
/// # Design
/// `csv-core` knows where a field ends and what its quotes mean. Two habits of loggers are outside its grammar, so
/// a line with quotes is handed to it field by field: blanks before a quote are passed over, and text after a
/// closing quote leaves the field as it was written. A line is all it sees, so that a quote left open cannot take
/// the lines below along.
#[derive(Debug)]
pub(crate) struct Splitter {
    reader: csv_core::Reader,
    separator: u8,
    /// Fields without their quotes, one after the other.
    text: Vec<u8>,
    /// Where in `text` each field ends.
    ends: Vec<usize>,
}

impl Clone for Splitter {
    fn clone(&self) -> Self {
        // A cloned reader of csv-core 0.1 forgets its separator.
        Self::new(self.separator)
    }
}

impl Splitter {
    pub(crate) fn new(separator: u8) -> Self {
        let terminator = csv_core::Terminator::Any(b'\n');
        let reader = csv_core::ReaderBuilder::new().delimiter(separator).terminator(terminator).build();
        Self { reader, separator, text: Vec::new(), ends: Vec::new() }
    }

    /// Splits one line, with or without its line feed.
    pub(crate) fn split(&mut self, line: &[u8]) -> Result<Fields<'_>, OpenQuote> {
        // No line has more fields than bytes and one.
        if self.text.len() <= line.len() {
            self.text.resize(line.len() + 1, 0);
            self.ends.resize(line.len() + 1, 0);
        }
        self.reader.reset();
        let n_fields =
            if memchr::memchr(b'"', line).is_some() { self.split_quoted(line)? } else { self.split_plain(line) };
        Ok(Fields { text: &self.text, ends: &self.ends[..n_fields] })
    }

    fn split_plain(&mut self, line: &[u8]) -> usize {
        let (result, _, n_bytes, mut n_fields) = self.reader.read_record(line, &mut self.text, &mut self.ends);
        if result != ReadRecordResult::Record {
            // Nothing ends the last field but the end of the line.
            self.ends[n_fields] = n_bytes;
            n_fields += 1;
        }
        n_fields
    }

    #[cold]
    fn split_quoted(&mut self, line: &[u8]) -> Result<usize, OpenQuote> {
        let (mut rest, mut start, mut n_fields) = (line, 0, 0);
        loop {
            while let [byte @ (b' ' | b'\t'), tail @ ..] = rest
                && *byte != self.separator
            {
                rest = tail;
            }
            let (mut result, n_read, n_written) = self.reader.read_field(rest, &mut self.text[start..]);
            if result == ReadFieldResult::InputEmpty {
                // A line feed ends the field unless it is within quotes.
                (result, _, _) = self.reader.read_field(b"\n", &mut [0]);
            }
            let ReadFieldResult::Field { record_end } = result else { return Err(OpenQuote { field: n_fields }) };
            let (field, tail) = rest.split_at(n_read);
            let written = if record_end { field } else { &field[..n_read - 1] }.trim_ascii();
            let mut end = start + n_written;
            if written.first() == Some(&b'"') && written.last() != Some(&b'"') {
                end = start + written.len();
                self.text[start..end].copy_from_slice(written);
            }
            self.ends[n_fields] = end;
            n_fields += 1;
            if record_end {
                return Ok(n_fields);
            }
            (rest, start) = (tail, end);
        }
    }
}

/// Fields of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fields<'a> {
    text: &'a [u8],
    ends: &'a [usize],
}

impl<'a> Fields<'a> {
    pub(crate) fn len(self) -> usize {
        self.ends.len()
    }

    /// Field `index`, counted from 0, without blanks around it.
    #[inline]
    pub(crate) fn get(self, index: usize) -> &'a [u8] {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        self.text[start..self.ends[index]].trim_ascii()
    }

    pub(crate) fn iter(self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.len()).map(move |index| self.get(index))
    }
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
        let mut splitter = Splitter::new(separator as u8);
        let fields = splitter.split(line.as_bytes()).unwrap();
        fields.iter().map(|field| String::from_utf8_lossy(field).into_owned()).collect()
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
        for (line, field) in [("1,\"2,3", 1), ("\"\"\"", 0), ("1,2, \"3\n", 2), ("\"", 0)] {
            let open = Splitter::new(b',').split(line.as_bytes()).unwrap_err();
            assert_eq!(open, OpenQuote { field }, "{line}");
        }
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
