//! Whole lines from a stream, many at a time and with bounded memory.

use super::error::ReadErrorKind;
use super::source::ByteSource;

/// Longest line that is read, in bytes; a thousand columns of twenty digits take a fiftieth of it.
pub(crate) const MAX_LINE_BYTES: usize = 1 << 20;

/// Next item of the stream.
#[derive(Debug, PartialEq)]
pub(crate) enum Lines<'a> {
    /// One or more lines, each with its line feed (the last line of the file is given one).
    Whole(&'a [u8]),
    /// A line longer than [`MAX_LINE_BYTES`], passed over.
    TooLong,
    /// Nothing.
    End,
}

/// Buffer over a source.
pub(crate) struct LineReader {
    source: ByteSource,
    buffer: Vec<u8>,
    /// Bytes of the buffer that are given out.
    start: usize,
    /// Bytes of the buffer that are filled.
    end: usize,
    at_end: bool,
}

impl LineReader {
    pub(crate) fn new(source: ByteSource) -> Self {
        // One more byte for the line feed that the last line may lack.
        Self { source, buffer: vec![0; MAX_LINE_BYTES + 1], start: 0, end: 0, at_end: false }
    }

    /// The start of the text, before any line is taken: all of a short file, or at least `n_bytes`.
    pub(crate) fn peek(&mut self, n_bytes: usize) -> Result<&[u8], ReadErrorKind> {
        while self.end < n_bytes.min(MAX_LINE_BYTES) && !self.at_end {
            self.fill()?;
        }
        Ok(&self.buffer[self.start..self.end])
    }

    /// Passes over `n_bytes` of what was peeked at.
    pub(crate) fn skip(&mut self, n_bytes: usize) {
        self.start = (self.start + n_bytes).min(self.end);
    }

    /// The next lines.
    pub(crate) fn next(&mut self) -> Result<Lines<'_>, ReadErrorKind> {
        loop {
            if let Some(length) = self.buffer[self.start..self.end].iter().rposition(|byte| *byte == b'\n') {
                let lines = self.start..self.start + length + 1;
                self.start = lines.end;
                return Ok(Lines::Whole(&self.buffer[lines]));
            }
            self.buffer.copy_within(self.start..self.end, 0);
            self.end -= self.start;
            self.start = 0;
            if self.at_end {
                if self.end == 0 {
                    return Ok(Lines::End);
                }
                self.buffer[self.end] = b'\n';
                self.end += 1;
            } else if self.end == MAX_LINE_BYTES {
                self.pass_over()?;
                return Ok(Lines::TooLong);
            } else {
                self.fill()?;
            }
        }
    }

    /// Drops everything up to and with the next line feed.
    fn pass_over(&mut self) -> Result<(), ReadErrorKind> {
        loop {
            self.end = 0;
            if self.at_end {
                return Ok(());
            }
            self.fill()?;
            if let Some(index) = self.buffer[..self.end].iter().position(|byte| *byte == b'\n') {
                self.start = index + 1;
                return Ok(());
            }
        }
    }

    fn fill(&mut self) -> Result<(), ReadErrorKind> {
        let n_bytes = self.source.read(&mut self.buffer[self.end..MAX_LINE_BYTES])?;
        self.end += n_bytes;
        self.at_end = n_bytes == 0;
        Ok(())
    }

    /// Everything that is left, unless it is more than `limit` says of the bytes stored so far.
    pub(crate) fn rest(&mut self, limit: impl Fn(u64) -> u64) -> Result<Vec<u8>, ReadErrorKind> {
        let mut bytes = self.buffer[self.start..self.end].to_vec();
        (self.start, self.end) = (0, 0);
        while !self.at_end {
            self.fill()?;
            bytes.extend_from_slice(&self.buffer[..self.end]);
            self.end = 0;
            let limit = limit(self.source.n_stored());
            if bytes.len() as u64 > limit {
                return Err(ReadErrorKind::ExpandsTooFar { limit });
            }
        }
        Ok(bytes)
    }

    /// Bytes that have been taken from the source and bytes that it has, where that is known.
    pub(crate) fn progress(&self) -> Option<(u64, u64)> {
        Some((self.source.n_stored(), self.source.n_bytes()?))
    }

    /// SHA-256 of all bytes of the source.
    pub(crate) fn sha256(self) -> Result<String, ReadErrorKind> {
        self.source.sha256()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reader(text: Vec<u8>) -> LineReader {
        LineReader::new(ByteSource::over(Box::new(std::io::Cursor::new(text))).unwrap())
    }

    #[test]
    fn lines_come_whole_and_the_last_is_given_its_line_feed() {
        let mut lines = reader(b"a\nbb\nc".to_vec());
        let mut all = Vec::new();
        while let Lines::Whole(text) = lines.next().unwrap() {
            assert_eq!(text.last(), Some(&b'\n'));
            all.extend_from_slice(text);
        }
        assert_eq!(all, b"a\nbb\nc\n");
    }

    #[test]
    fn a_line_of_absurd_length_is_passed_over() {
        let mut text = b"a\n".to_vec();
        text.extend(std::iter::repeat_n(b'x', 3 * MAX_LINE_BYTES));
        text.extend(b"\nb\n");
        let mut lines = reader(text);
        assert_eq!(lines.next().unwrap(), Lines::Whole(b"a\n"));
        assert_eq!(lines.next().unwrap(), Lines::TooLong);
        assert_eq!(lines.next().unwrap(), Lines::Whole(b"b\n"));
        assert_eq!(lines.next().unwrap(), Lines::End);
    }

    #[test]
    fn the_longest_line_allowed_may_end_the_file() {
        let text = vec![b'x'; MAX_LINE_BYTES - 1];
        let mut lines = reader(text);
        assert!(matches!(lines.next().unwrap(), Lines::Whole(text) if text.len() == MAX_LINE_BYTES));
        assert_eq!(lines.next().unwrap(), Lines::End);
    }
}
