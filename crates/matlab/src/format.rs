//! Which of MATLAB's formats a file has.

/// Length of the header.
pub(super) const HEADER_BYTES: usize = 128;

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Endian {
    /// Lowest first.
    Little,
    /// Highest first.
    Big,
}

impl Endian {
    pub(super) fn u32(self, bytes: [u8; 4]) -> u32 {
        match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        }
    }
}

/// A format of MATLAB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// `save -v4`.
    Level4,
    /// `save -v6` or `save -v7`.
    Level5,
    /// `save -v7.3`.
    Hdf5,
}

/// The format of the file that begins with `start`, if it is one of MATLAB's.
pub fn format_of(start: &[u8]) -> Option<Format> {
    if level_5(start).is_some() {
        return Some(Format::Level5);
    }
    if let Some([0, 2, b'I', b'M'] | [2, 0, b'M', b'I']) = version(start) {
        return Some(Format::Hdf5);
    }
    [Endian::Little, Endian::Big].into_iter().any(|endian| is_level_4(start, endian)).then_some(Format::Level4)
}

/// The order of bytes of a file of level 5, if it is one.
pub(super) fn level_5(start: &[u8]) -> Option<Endian> {
    match version(start)? {
        [0, 1, b'I', b'M'] => Some(Endian::Little),
        [1, 0, b'M', b'I'] => Some(Endian::Big),
        _ => None,
    }
}

/// The last bytes of a header: the version, and two letters that show the order of bytes.
fn version(start: &[u8]) -> Option<[u8; 4]> {
    start.get(..HEADER_BYTES)?.last_chunk().copied()
}

/// Level 4 has no header: type, rows, columns, whether complex, length of the name; then the name, ended by a zero.
fn is_level_4(start: &[u8], endian: Endian) -> bool {
    let field = |index: usize| start.get(4 * index..4 * index + 4)?.try_into().ok().map(|bytes| endian.u32(bytes));
    let (Some(kind), Some(complex), Some(length)) = (field(0), field(3), field(4)) else { return false };
    let digits = [kind / 1000, kind / 100 % 10, kind / 10 % 10, kind % 10];
    let order = if endian == Endian::Little { 0 } else { 1 };
    if digits[0] != order || digits[1] != 0 || digits[2] > 5 || digits[3] > 2 || complex > 1 {
        return false;
    }
    let name = (length as usize).checked_add(20).and_then(|end| start.get(20..end));
    let is_word = |name: &[u8]| name.iter().all(|byte| byte.is_ascii_alphanumeric() || *byte == b'_');
    matches!(name, Some([name @ .., 0]) if !name.is_empty() && is_word(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_no_file_of_matlab() {
        assert_eq!(format_of(b"time_s,pressure_kPa,length_mm,force_N\n"), None);
        assert_eq!(format_of(&[b'x'; 200]), None);
        assert_eq!(format_of(b""), None);
    }

    #[test]
    fn the_three_formats_are_told_apart() {
        let level_4 = [0_u32, 3, 1, 0, 2].map(u32::to_le_bytes).concat();
        assert_eq!(format_of(&[level_4.as_slice(), b"p\0"].concat()), Some(Format::Level4));
        let header = |end: &[u8]| [vec![b' '; 124].as_slice(), end].concat();
        assert_eq!(format_of(&header(b"\0\x01IM")), Some(Format::Level5));
        assert_eq!(format_of(&header(b"\x01\0MI")), Some(Format::Level5));
        assert_eq!(format_of(&header(b"\0\x02IM")), Some(Format::Hdf5));
        assert_eq!(level_5(&header(b"\0\x01IM")), Some(Endian::Little));
        assert_eq!(level_5(&header(b"\x01\0MI")), Some(Endian::Big));
    }
}
