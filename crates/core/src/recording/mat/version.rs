//! Which of MATLAB's formats a file is.

/// Length of the header.
pub(super) const HEADER_BYTES: usize = 128;

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Endian {
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

/// What a file of MATLAB is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// `save -v4`.
    Level4,
    /// `save -v6` or `save -v7`.
    Level5(Endian),
    /// `save -v7.3`.
    Hdf5,
}

/// The kind of the file that begins with `start`, if it is one of MATLAB's.
pub(crate) fn kind(start: &[u8]) -> Option<Kind> {
    if let Some(header) = start.get(..HEADER_BYTES) {
        // The version, and two letters that show the order of bytes.
        match header[HEADER_BYTES - 4..] {
            [0, 1, b'I', b'M'] => return Some(Kind::Level5(Endian::Little)),
            [1, 0, b'M', b'I'] => return Some(Kind::Level5(Endian::Big)),
            [0, 2, b'I', b'M'] | [2, 0, b'M', b'I'] => return Some(Kind::Hdf5),
            _ => {}
        }
    }
    [Endian::Little, Endian::Big].into_iter().any(|endian| is_level_4(start, endian)).then_some(Kind::Level4)
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
        assert_eq!(kind(b"time_s,pressure_kPa,length_mm,force_N\n"), None);
        assert_eq!(kind(&[b'x'; 200]), None);
        assert_eq!(kind(b""), None);
    }

    #[test]
    fn the_three_formats_are_told_apart() {
        let level_4 = [0_u32, 3, 1, 0, 2].map(u32::to_le_bytes).concat();
        assert_eq!(kind(&[level_4.as_slice(), b"p\0"].concat()), Some(Kind::Level4));
        let header = |end: &[u8]| [vec![b' '; 124].as_slice(), end].concat();
        assert_eq!(kind(&header(b"\0\x01IM")), Some(Kind::Level5(Endian::Little)));
        assert_eq!(kind(&header(b"\x01\0MI")), Some(Kind::Level5(Endian::Big)));
        assert_eq!(kind(&header(b"\0\x02IM")), Some(Kind::Hdf5));
    }
}
