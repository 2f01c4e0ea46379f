//! Arrays: numbers, text, structures and cells.

use super::element::{Damaged, Element, Elements, MATRIX};
use super::format::Endian;

/// Arrays within arrays that are followed.
const MAX_DEPTH: usize = 32;

/// A named array of the file.
#[derive(Debug)]
pub(super) struct Variable<'a> {
    pub(super) name: String,
    pub(super) value: Value<'a>,
}

/// What an array holds.
#[derive(Debug)]
pub(super) enum Value<'a> {
    Numbers(Numbers<'a>),
    Text(String),
    Structure(Structure<'a>),
    Cells(Vec<Value<'a>>),
    /// An object, of which only MATLAB knows what it means; its class.
    Object(String),
    /// Sparse, complex, a function.
    Other,
}

/// A structure, or an array of structures.
#[derive(Debug)]
pub(super) struct Structure<'a> {
    pub(super) fields: Vec<String>,
    /// Per structure, the values of its fields.
    pub(super) elements: Vec<Vec<Value<'a>>>,
}

/// Real numbers, in the order of MATLAB: the first index runs first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Numbers<'a> {
    pub(super) n_rows: usize,
    /// Products of all dimensions but the first.
    pub(super) n_columns: usize,
    storage: Storage,
    bytes: &'a [u8],
    endian: Endian,
}

/// How a number is stored, which may be shorter than its class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Storage {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
    I64,
    U64,
}

impl Storage {
    fn of(kind: u32) -> Option<Self> {
        Some(match kind {
            1 => Self::I8,
            2 => Self::U8,
            3 => Self::I16,
            4 => Self::U16,
            5 => Self::I32,
            6 => Self::U32,
            7 => Self::F32,
            9 => Self::F64,
            12 => Self::I64,
            13 => Self::U64,
            _ => return None,
        })
    }

    fn n_bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }
}

impl Numbers<'_> {
    pub(super) fn len(&self) -> usize {
        self.bytes.len() / self.storage.n_bytes()
    }

    /// Number `index`; NaN where there is none.
    pub(super) fn get(&self, index: usize) -> f64 {
        let width = self.storage.n_bytes();
        let Some(bytes) = self.bytes.get(index * width..(index + 1) * width) else { return f64::NAN };
        // Lowest byte first, and zeros above.
        let mut low_first = [0; 8];
        for (position, byte) in bytes.iter().enumerate() {
            low_first[if self.endian == Endian::Little { position } else { width - 1 - position }] = *byte;
        }
        let bits = u64::from_le_bytes(low_first);
        match self.storage {
            Storage::I8 => f64::from(bits as i8),
            Storage::U8 => f64::from(bits as u8),
            Storage::I16 => f64::from(bits as i16),
            Storage::U16 => f64::from(bits as u16),
            Storage::I32 => f64::from(bits as i32),
            Storage::U32 => f64::from(bits as u32),
            Storage::F32 => f64::from(f32::from_bits(bits as u32)),
            Storage::F64 => f64::from_bits(bits),
            Storage::I64 => bits as i64 as f64,
            Storage::U64 => bits as f64,
        }
    }
}

impl<'a> Structure<'a> {
    /// Field `name` of structure `index`, whatever the case of its letters.
    pub(super) fn field(&self, index: usize, name: &str) -> Option<&Value<'a>> {
        let field = self.fields.iter().position(|field| field.eq_ignore_ascii_case(name))?;
        self.elements.get(index)?.get(field)
    }
}

/// The variable in an element of the file; nothing where it is none, or has no name.
pub(super) fn variable<'a>(element: Element<'a>, endian: Endian) -> Result<Option<Variable<'a>>, Damaged> {
    if element.kind != MATRIX {
        return Ok(None);
    }
    let (name, value) = array(element.data, endian, 0)?;
    Ok((!name.is_empty()).then_some(Variable { name, value }))
}

fn array<'a>(bytes: &'a [u8], endian: Endian, depth: usize) -> Result<(String, Value<'a>), Damaged> {
    if bytes.is_empty() {
        return Ok((String::new(), Value::Other));
    }
    if depth > MAX_DEPTH {
        return Err(Damaged("its structures are too deep"));
    }
    let mut parts = Elements::new(bytes, endian);
    let flags = parts.next()?.data.first_chunk().ok_or(Damaged("an array has no class"))?;
    let flags = endian.u32(*flags);
    let (class, is_complex) = (flags & 0xff, flags & 0x800 != 0);
    if class == 17 {
        // An object of a class by classdef: name, system, class, and a reference to where only MATLAB looks.
        let [name, _system, class] = [text(parts.next()?), text(parts.next()?), text(parts.next()?)];
        return Ok((name, Value::Object(class)));
    }
    let dimensions = dimensions(parts.next()?, endian)?;
    let n_values = dimensions.iter().try_fold(1_usize, |product, length| product.checked_mul(*length));
    let n_values = n_values.ok_or(Damaged("an array is larger than any memory"))?;
    let name = text(parts.next()?);
    let value = match class {
        1 => Value::Cells(
            (0..n_values).map(|_| Ok(array(parts.next()?.data, endian, depth + 1)?.1)).collect::<Result<_, _>>()?,
        ),
        2 => Value::Structure(structure(&mut parts, n_values, depth)?),
        3 => Value::Object(text(parts.next()?)),
        4 => Value::Text(characters(parts.next()?, endian)),
        6..=15 if !is_complex => numbers(parts.next()?, &dimensions, n_values, endian)?,
        _ => Value::Other,
    };
    Ok((name, value))
}

fn dimensions(element: Element<'_>, endian: Endian) -> Result<Vec<usize>, Damaged> {
    let (lengths, _) = element.data.as_chunks::<4>();
    if lengths.len() < 2 {
        return Err(Damaged("an array has no dimensions"));
    }
    Ok(lengths.iter().map(|length| endian.u32(*length) as usize).collect())
}

fn numbers<'a>(
    element: Element<'a>,
    dimensions: &[usize],
    n_values: usize,
    endian: Endian,
) -> Result<Value<'a>, Damaged> {
    let storage = Storage::of(element.kind).ok_or(Damaged("numbers are of a type that is not known"))?;
    let numbers = Numbers {
        n_rows: dimensions[0],
        n_columns: n_values.checked_div(dimensions[0]).unwrap_or(0),
        storage,
        bytes: element.data,
        endian,
    };
    if numbers.len() != n_values {
        return Err(Damaged("an array has not as many numbers as its dimensions say"));
    }
    Ok(Value::Numbers(numbers))
}

fn structure<'a>(parts: &mut Elements<'a>, n_values: usize, depth: usize) -> Result<Structure<'a>, Damaged> {
    let endian = parts.endian;
    let length = parts.next()?.data.first_chunk().ok_or(Damaged("a structure has no field names"))?;
    let length = endian.u32(*length) as usize;
    let names = parts.next()?.data;
    let fields: Vec<String> = match length {
        0 => Vec::new(),
        _ => names.chunks_exact(length).map(until_zero).collect(),
    };
    // Without fields, structures take no bytes, and there could be any number of them.
    let n_values = if fields.is_empty() { 0 } else { n_values };
    let mut elements = Vec::new();
    for _ in 0..n_values {
        let values = fields.iter().map(|_| Ok(array(parts.next()?.data, endian, depth + 1)?.1));
        elements.push(values.collect::<Result<_, _>>()?);
    }
    Ok(Structure { fields, elements })
}

fn text(element: Element<'_>) -> String {
    until_zero(element.data)
}

fn until_zero(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.split(|byte| *byte == 0).next().unwrap_or(&[])).into_owned()
}

/// Text of a character array, in UTF-8, UTF-16 or bytes.
fn characters(element: Element<'_>, endian: Endian) -> String {
    let (pairs, _) = element.data.as_chunks::<2>();
    match element.kind {
        4 | 17 => {
            let units = pairs.iter().map(|[a, b]| match endian {
                Endian::Little => u16::from_le_bytes([*a, *b]),
                Endian::Big => u16::from_be_bytes([*a, *b]),
            });
            char::decode_utf16(units).map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
        }
        _ => until_zero(element.data),
    }
}
