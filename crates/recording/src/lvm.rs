//! Text files of LabVIEW (`.lvm`, "Write To Measurement File"): a header of keys, one of channels, and a table.
//!
//! Source: National Instruments, "Specification for the LabVIEW Measurement File (.lvm)", 2024.

use super::error::ReadErrorKind;
use super::fields::{decoded, strip_line_end};
use super::units::with_unit;

/// First bytes of a file.
const MAGIC: &[u8] = b"LabVIEW Measurement";
/// Ends a header.
const END: &[u8] = b"***End_of_Header***";
/// Name of the column of time, and of that of remarks.
const TIME: &str = "X_Value";
const REMARK: &str = "Comment";

/// Text above the table.
#[derive(Debug, PartialEq)]
pub(super) struct LvmHeader {
    /// Bytes and lines before the row of names.
    pub(super) n_bytes: usize,
    pub(super) n_lines: u64,
    pub(super) separator: u8,
    /// Units of the channels, where the file tells them, after that of time.
    pub(super) units: Vec<String>,
}

/// The header of a file that begins with `start`; none where it is no file of LabVIEW's.
pub(super) fn header(start: &[u8]) -> Option<Result<LvmHeader, ReadErrorKind>> {
    start.starts_with(MAGIC).then(|| read(start))
}

fn read(start: &[u8]) -> Result<LvmHeader, ReadErrorKind> {
    let incomplete = || ReadErrorKind::LvmHeader;
    let (mut n_bytes, mut n_lines, mut n_ends) = (0, 0, 0);
    let mut separator = b'\t';
    let mut units = Vec::new();
    for line in start.split_inclusive(|byte| *byte == b'\n') {
        n_bytes += line.len();
        n_lines += 1;
        let line = strip_line_end(line);
        if line.starts_with(END) {
            n_ends += 1;
            // The first header is that of the file, the second that of its first table.
            if n_ends == 2 {
                return Ok(LvmHeader { n_bytes, n_lines, separator, units });
            }
            continue;
        }
        let mut words = line.split(|byte| *byte == separator).map(<[u8]>::trim_ascii);
        let (key, value) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        match key {
            b"Separator" if line.ends_with(b"Comma") => separator = b',',
            // The key and its value are already parted by what it names.
            _ if line.starts_with(b"Separator,") => separator = b',',
            b"X_Columns" if value != b"One" => {
                return Err(ReadErrorKind::LvmTime { found: String::from_utf8_lossy(value).into_owned() });
            }
            b"Y_Unit_Label" => {
                units = std::iter::once(value).chain(words).map(decoded).collect();
            }
            _ => {}
        }
    }
    Err(incomplete())
}

/// Names of the columns of a table whose first row has `names`: time in s, channels with their units, no remarks.
pub(super) fn names(mut names: Vec<Option<String>>, header: &LvmHeader) -> Vec<Option<String>> {
    if names.last().is_some_and(|name| name.as_deref() == Some(REMARK)) {
        names.pop();
    }
    for (index, name) in names.iter_mut().enumerate() {
        let Some(text) = name else { continue };
        if index == 0 && text == TIME {
            *text = "time_s".to_owned();
        } else if let Some(unit) = index.checked_sub(1).and_then(|channel| header.units.get(channel)) {
            *text = with_unit(text, unit);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_found_below_two_headers() {
        let text = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tOne\n***End_of_Header***\t\n\t\n\
                    Channels\t2\t\nY_Unit_Label\tbar\tN\n***End_of_Header***\t\t\nX_Value\tDruck\tKraft\tComment\n0,0\t1\t2\n";
        let header = header(text.as_bytes()).unwrap().unwrap();
        assert!(text[header.n_bytes..].starts_with("X_Value"));
        assert_eq!((header.n_lines, header.separator), (9, b'\t'));
        let columns = ["X_Value", "Druck", "Kraft", "Comment"].map(|name| Some(name.to_owned())).to_vec();
        let named: Vec<String> = names(columns, &header).into_iter().flatten().collect();
        assert_eq!(named, ["time_s", "Druck [bar]", "Kraft [N]"]);
    }
}
