//! First look at a file: whether it is text, what separates its columns and how many there are.

use super::date::stamp_s;
use super::error::ReadErrorKind;
use super::fields::{Fields, Splitter, decoded, is_blank, is_comment, number, strip_line_end};
use super::units::is_symbol;

/// Bytes that decide whether a file is text.
const TEXT_BYTES: usize = 4096;

/// Rows that decide which separator it is.
const SAMPLE_ROWS: usize = 32;

/// Fields of a row that are looked at.
const SAMPLE_FIELDS: usize = 4096;

/// Separators, in the order in which they win a draw.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// Files that people mistake for text: first bytes, what they are, what to do.
const MAGIC: [(&[u8], &str, &str); 5] = [
    (b"PK\x03\x04", "a zip archive or a spreadsheet", "unpack it, or export the sheet as CSV"),
    (b"\xd0\xcf\x11\xe0", "an old spreadsheet or document", "export the sheet as CSV"),
    (b"\x28\xb5\x2f\xfd", "a file compressed with zstd", "decompress it, or compress with gzip instead"),
    (b"\xfd7zXZ", "a file compressed with xz", "decompress it, or compress with gzip instead"),
    (b"BZh", "a file compressed with bzip2", "decompress it, or compress with gzip instead"),
];

/// Formats of recordings that are known and not read.
const NOT_READ: [(&[u8], &str, &str); 4] = [
    (
        b"PAR1",
        "a Parquet file",
        "write it as CSV: python3 -c 'import pandas, sys; pandas.read_parquet(sys.argv[1]).to_csv(sys.argv[2], \
         index=False)' log.parquet log.csv",
    ),
    (b"\x89HDF", "an HDF5 file", HDF5_AS_CSV),
    (b"TDSm", "a TDMS file of LabVIEW", TDMS_AS_CSV),
    (
        b"TDSh",
        "the index of a TDMS file of LabVIEW",
        "name the .tdms file beside it; it is not read either, and its message says how to convert it",
    ),
];

/// Remedy for HDF5, MATLAB's own included: vectors of equal length become columns.
pub(super) const HDF5_AS_CSV: &str = "write it as CSV: python3 -c 'import h5py, pandas, sys; d = {}; \
     h5py.File(sys.argv[1]).visititems(lambda n, o: d.update({n: pandas.Series(o[()].ravel())}) \
     if isinstance(o, h5py.Dataset) and o.dtype.kind in \"fiu\" and o.size == max(o.shape or [0]) else None); \
     pandas.DataFrame(d).to_csv(sys.argv[2], index=False)' log.h5 log.csv";

/// Remedy for TDMS: time is that of the waveforms, or else a channel of its own.
const TDMS_AS_CSV: &str = "write it as CSV: python3 -c 'import nptdms, sys; \
     f = nptdms.TdmsFile.read(sys.argv[1]); \
     w = all(\"wf_increment\" in c.properties for g in f.groups() for c in g.channels()); d = f.as_dataframe(time_index=w); \
     d.columns = [c.split(chr(39))[-2] for c in d.columns]; \
     d.rename_axis(\"time_s\" if w else None).to_csv(sys.argv[2], index=w)' log.tdms log.csv";

/// Checks that `start` begins a text; returns the length of its byte order mark.
pub(crate) fn check_text(start: &[u8]) -> Result<usize, ReadErrorKind> {
    for (magic, found, remedy) in MAGIC {
        if start.starts_with(magic) {
            return Err(ReadErrorKind::Binary { found, remedy });
        }
    }
    for (magic, found, remedy) in NOT_READ {
        if start.starts_with(magic) {
            return Err(ReadErrorKind::NotRead { found, remedy: remedy.to_owned() });
        }
    }
    if start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff") {
        return Err(ReadErrorKind::Utf16);
    }
    let head = &start[..start.len().min(TEXT_BYTES)];
    let nuls = |offset: usize| head.iter().skip(offset).step_by(2).filter(|byte| **byte == 0).count();
    let (even, odd) = (nuls(0), nuls(1));
    if head.len() >= 8 && (even == 0 || odd == 0) && (even + odd) * 5 >= head.len() * 2 {
        return Err(ReadErrorKind::Utf16);
    }
    let is_control = |byte: &u8| *byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c | 0x1a | 0x1b);
    let n_control = head.iter().filter(|byte| is_control(byte)).count();
    if n_control * 50 > head.len() {
        let remedy = "export the recording as CSV";
        return Err(ReadErrorKind::Binary { found: "a binary file", remedy });
    }
    if !start.contains(&b'\n') && start.iter().filter(|byte| **byte == b'\r').count() > 1 {
        return Err(ReadErrorKind::CarriageReturns);
    }
    Ok(if start.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 })
}

/// How rows are laid out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layout {
    pub(crate) separator: u8,
    /// Fields in most of the first rows.
    pub(crate) n_fields: usize,
    /// Words separated by blanks, in one column only.
    pub(crate) space_separated: bool,
}

/// Findings of the first rows below the header about its columns.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Hints {
    /// A row of units under the header, field by field.
    pub(crate) units: Option<Vec<String>>,
    /// Dates of the first row of values, field by field, in s.
    pub(crate) stamps_s: Vec<Option<f64>>,
}

/// Looks at the rows below the first one.
pub(crate) fn hints(start: &[u8], layout: Layout) -> Hints {
    let mut rows = content(start).skip(1);
    let mut splitter = Splitter::new(layout.separator);
    let mut fields = |row: &[u8]| -> Vec<Vec<u8>> {
        splitter.split(row).map(|fields| fields.iter().map(<[u8]>::to_vec).collect()).unwrap_or_default()
    };
    let mut first = rows.next().map(&mut fields).unwrap_or_default();
    let names: Vec<String> = first.iter().map(|field| decoded(field)).collect();
    let is_value = |field: &Vec<u8>| number(field, layout.separator != b',').is_ok() || stamp_s(field).is_some();
    // A single letter is a symbol by chance.
    let is_units = names.iter().filter(|name| is_symbol(name)).count() > 1 && !first.iter().any(is_value);
    if is_units {
        first = rows.next().map(&mut fields).unwrap_or_default();
    }
    Hints { units: is_units.then_some(names), stamps_s: first.iter().map(|field| stamp_s(field)).collect() }
}

/// Rows of the first look that are neither blank nor comments; the last may be cut off.
fn content(start: &[u8]) -> impl Iterator<Item = &[u8]> {
    start
        .split_inclusive(|byte| *byte == b'\n')
        .filter(|line| line.ends_with(b"\n") || line.len() < start.len() || start.len() < TEXT_BYTES)
        .map(strip_line_end)
        .filter(|line| !is_blank(line) && !is_comment(line))
}

/// Finds the separator that makes the first rows alike and numeric; `n_columns` where the user has said how
/// many there are.
pub(crate) fn layout(start: &[u8], n_columns: Option<usize>) -> Layout {
    let rows: Vec<&[u8]> = content(start).take(SAMPLE_ROWS).collect();
    let ranked = SEPARATORS.map(|separator| {
        let mut splitter = Splitter::new(separator);
        let counts: Vec<usize> = rows.iter().map(|row| count(row, separator, &mut splitter)).collect();
        let n_fields = commonest(&counts);
        let n_first = counts.first().copied().unwrap_or(1);
        let alike = counts.iter().filter(|count| **count == n_first).count();
        let expected = n_columns == Some(n_fields);
        let rank = (expected, n_first > 1, alike, numeric_share(&rows, separator, &mut splitter), n_first);
        (rank, Layout { separator, n_fields, space_separated: false })
    });
    let [first, rest @ ..] = ranked;
    let (_, mut layout) = rest.into_iter().fold(first, |best, next| if next.0 > best.0 { next } else { best });
    let words = |row: &&[u8]| row.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    layout.space_separated = layout.n_fields == 1 && !rows.is_empty() && rows.iter().take(2).all(|row| words(row) > 1);
    layout
}

/// Fields of a row; an empty one at its end is the mark of loggers that end a row with a separator.
fn count(row: &[u8], separator: u8, splitter: &mut Splitter) -> usize {
    // A quote left open is for the reader to refuse.
    let n_plain = || row.iter().filter(|byte| **byte == separator).count() + 1;
    let n_fields = splitter.split(row).map_or_else(|_| n_plain(), Fields::len);
    n_fields - usize::from(n_fields > 1 && row.trim_ascii_end().last().is_none_or(|byte| *byte == separator))
}

fn commonest(counts: &[usize]) -> usize {
    let times = |count: usize| counts.iter().filter(|other| **other == count).count();
    counts.iter().copied().max_by_key(|count| (times(*count), *count)).unwrap_or(1)
}

/// Fields below the first row that are numbers, in thousandths.
fn numeric_share(rows: &[&[u8]], separator: u8, splitter: &mut Splitter) -> usize {
    let (mut n_numbers, mut n_fields) = (0, 0);
    for row in rows.iter().skip(1) {
        if let Ok(fields) = splitter.split(row) {
            n_fields += fields.len().min(SAMPLE_FIELDS);
            let is_number = |field: &&[u8]| number(field, separator != b',').is_ok();
            n_numbers += fields.iter().take(SAMPLE_FIELDS).filter(is_number).count();
        }
    }
    (1000 * n_numbers).checked_div(n_fields).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn separator(text: &str) -> (char, usize) {
        let layout = layout(text.as_bytes(), None);
        (char::from(layout.separator), layout.n_fields)
    }

    #[test]
    fn the_separator_is_the_one_that_makes_rows_alike() {
        assert_eq!(separator("time_s,force_N\n0,1\n"), (',', 2));
        assert_eq!(separator("time_s;force_N\n0,5;1,5\n"), (';', 2));
        assert_eq!(separator("time_s\tforce_N\n0,5\t1,5\n"), ('\t', 2));
        assert_eq!(separator("# a,b,c\n\n0,1;0,2;0,3\n0,1;0,2;0,3\n"), (';', 3));
        assert_eq!(separator("0,1;0,2\n0,1;0,2\n"), (';', 2));
        assert_eq!(separator("time_s;\"a;b;c\";force_N\n0;1;2"), (';', 3));
        assert_eq!(separator("time_s,force_N,\n0,1,\n"), (',', 2));
        assert_eq!(separator("time_s"), (',', 1));
        assert_eq!(separator(""), (',', 1));
    }
}
