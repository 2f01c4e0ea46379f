//! How a recording is read, and what options of a command line say of its columns.

use std::str::FromStr;

use super::expression::{self, ExpressionFault};
use super::samples::{MAX_COLUMNS, MEMORY_ROWS};
use super::units::{Name, Quantity, Unit};

/// How to read a recording.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// Names of the columns of a file without a header.
    pub columns: Option<Columns>,
    /// Other names for columns.
    pub map: Vec<ColumnMap>,
    /// Channels that were constant and not recorded.
    pub fixed: Vec<FixedChannel>,
    /// Channels computed from a transducer's reading.
    pub calibrate: Vec<Calibration>,
    /// Ends of the sensors' ranges, in SI and in the order of [`Quantity::ALL`](super::Quantity::ALL), as far as they are
    /// known.
    pub sensor_ranges: [Option<[f64; 2]>; MAX_COLUMNS],
    /// Drop and count rows that cannot be used, instead of refusing the file.
    pub skip_bad_rows: bool,
    /// Refuse a recording without force, or whose force never varies.
    pub force_required: bool,
    /// Fewest rows that are enough; two at least.
    pub min_rows: usize,
    /// Rows that stay in memory; the others go to a temporary file.
    pub memory_rows: usize,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            columns: None,
            map: Vec::new(),
            fixed: Vec::new(),
            calibrate: Vec::new(),
            sensor_ranges: [None; MAX_COLUMNS],
            skip_bad_rows: false,
            force_required: true,
            min_rows: 2,
            memory_rows: MEMORY_ROWS,
        }
    }
}

impl ReadOptions {
    /// Whether an option supplies `quantity`.
    pub(super) fn supply(&self, quantity: Quantity) -> bool {
        self.map.iter().any(|map| map.target.quantity == quantity)
            || self.calibrate.iter().any(|line| line.target.quantity == quantity)
            || self.fixed.iter().any(|fixed| fixed.quantity == quantity)
    }
}

/// Names of the columns of a file without a header, as in `force_N,pressure_kPa,time_s,-`; `-` skips one.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// One per column; `None` skips it.
    pub names: Vec<Option<String>>,
    /// Whether a header of the file wins over them.
    pub(crate) if_no_header: bool,
}

/// Another name for a column, as in `pressure_bar=P [V]`.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnMap {
    /// Name with quantity and unit that the column is to have.
    pub name: String,
    /// Name in the file.
    pub original: String,
    pub(crate) target: Target,
}

/// A channel that was constant and not recorded, as in `length_mm=126.75`.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedChannel {
    /// Name as written.
    pub name: String,
    /// Its quantity.
    pub quantity: Quantity,
    /// Its value, in SI.
    pub value: f64,
    /// File and table that it stands in, where that is not the command line.
    pub(crate) origin: Option<String>,
}

/// A channel computed from a transducer's reading, as in `pressure_kPa = 125 * ai0 - 12.5`.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Name with quantity and unit of the result.
    pub name: String,
    /// Column of the file that holds the reading.
    pub original: String,
    /// Units of the result per unit of the reading.
    pub gain: f64,
    /// Result at a reading of zero.
    pub offset: f64,
    pub(crate) target: Target,
    /// File and table that it stands in, where that is not the command line.
    pub(crate) origin: Option<String>,
}

/// Quantity and unit that an option supplies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Target {
    pub(crate) quantity: Quantity,
    pub(crate) unit: &'static Unit,
}

/// Why an option about columns cannot be understood.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OptionSyntaxError {
    /// A list of columns with nothing between two commas.
    #[error("column {position} has no name; write - to skip a column, as in force_N,pressure_kPa,time_s,-")]
    EmptyName {
        /// Which name, counted from 1.
        position: usize,
    },
    /// A name twice in a list of columns.
    #[error("\"{name}\" is given twice; name each column once, as in force_N,pressure_kPa,time_s,-")]
    NameTwice {
        /// The name.
        name: String,
    },
    /// No equals sign, or nothing on one side of it.
    #[error("\"{text}\" is not of the form NAME=…; expected for example {example}")]
    NotAnAssignment {
        /// The text as given.
        text: String,
        /// The form expected.
        example: &'static str,
    },
    /// The left side names no quantity.
    #[error(
        "\"{name}\" is not a quantity with its unit; expected for example {example} \
         (time, pressure, length, force or temperature)"
    )]
    UnknownTarget {
        /// The text as given.
        name: String,
        /// The form expected, or the name that was probably meant.
        example: String,
    },
    /// The left side names a quantity without a unit that is known.
    #[error("\"{name}\" has no unit that is known; write {quantity}_UNIT with {}, for example {example}", quantity.unit_list())]
    UnknownUnit {
        /// The text as given.
        name: String,
        /// The quantity it names.
        quantity: Quantity,
        /// The form expected.
        example: String,
    },
    /// A constant that is not a number.
    #[error("\"{text}\" is not a finite number; expected for example {example}")]
    NotANumber {
        /// The text as given.
        text: String,
        /// The form expected.
        example: &'static str,
    },
    /// Time as a constant.
    #[error("time cannot be fixed; fix for example {FIXED_EXAMPLE}")]
    FixedTime,
    /// A right side that is not linear in one column.
    #[error("{fault} in \"{text}\"; expected for example {CALIBRATION_EXAMPLE}")]
    NotLinear {
        /// The right side.
        text: String,
        /// Its fault.
        fault: ExpressionFault,
    },
}

const MAP_EXAMPLE: &str = "pressure_bar=\"P [V]\"";
const FIXED_EXAMPLE: &str = "length_mm=126.75";
const CALIBRATION_EXAMPLE: &str = "'pressure_kPa = 125 * ai0 - 12.5'";

impl Target {
    fn parse(name: &str, example: &str) -> Result<Self, OptionSyntaxError> {
        let example_name = example.split(['=', ' ']).next().unwrap_or(example).trim_start_matches('\'');
        let name_owned = || name.to_owned();
        match Name::read(name) {
            Name::Channel(quantity, unit) => Ok(Self { quantity, unit }),
            Name::UnitMissing(quantity) | Name::UnitUnknown(quantity, _) => {
                Err(OptionSyntaxError::UnknownUnit { name: name_owned(), quantity, example: quantity.example() })
            }
            Name::Misspelt(_, right) => Err(OptionSyntaxError::UnknownTarget { name: name_owned(), example: right }),
            Name::Other => {
                Err(OptionSyntaxError::UnknownTarget { name: name_owned(), example: example_name.to_owned() })
            }
        }
    }
}

/// Splits at the first equals sign.
fn assignment<'a>(text: &'a str, example: &'static str) -> Result<(&'a str, &'a str), OptionSyntaxError> {
    match text.split_once('=').map(|(name, value)| (name.trim(), value.trim())) {
        Some((name, value)) if !name.is_empty() && !value.is_empty() => Ok((name, value)),
        _ => Err(OptionSyntaxError::NotAnAssignment { text: text.to_owned(), example }),
    }
}

impl Columns {
    /// A list of names, one per column; `-` skips one.
    pub(crate) fn of<'a>(list: impl Iterator<Item = &'a str>) -> Result<Self, OptionSyntaxError> {
        let mut names: Vec<Option<String>> = Vec::new();
        for (index, name) in list.map(str::trim).enumerate() {
            match name {
                "" => return Err(OptionSyntaxError::EmptyName { position: index + 1 }),
                "-" => names.push(None),
                _ if names.iter().flatten().any(|other| other.eq_ignore_ascii_case(name)) => {
                    return Err(OptionSyntaxError::NameTwice { name: name.to_owned() });
                }
                _ => names.push(Some(name.to_owned())),
            }
        }
        Ok(Self { names, if_no_header: false })
    }
}

impl FromStr for Columns {
    type Err = OptionSyntaxError;

    fn from_str(text: &str) -> Result<Self, OptionSyntaxError> {
        Self::of(text.split(','))
    }
}

impl FromStr for ColumnMap {
    type Err = OptionSyntaxError;

    fn from_str(text: &str) -> Result<Self, OptionSyntaxError> {
        let (name, original) = assignment(text, MAP_EXAMPLE)?;
        let original = original.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(original);
        let target = Target::parse(name, MAP_EXAMPLE)?;
        Ok(Self { name: name.to_owned(), original: original.to_owned(), target })
    }
}

impl FromStr for FixedChannel {
    type Err = OptionSyntaxError;

    fn from_str(text: &str) -> Result<Self, OptionSyntaxError> {
        let (name, value) = assignment(text, FIXED_EXAMPLE)?;
        let target = Target::parse(name, FIXED_EXAMPLE)?;
        if target.quantity == Quantity::Time {
            return Err(OptionSyntaxError::FixedTime);
        }
        match value.parse::<f64>().map(|number| target.unit.si(number)) {
            Ok(si) if si.is_finite() => {
                Ok(Self { name: name.to_owned(), quantity: target.quantity, value: si, origin: None })
            }
            _ => Err(OptionSyntaxError::NotANumber { text: value.to_owned(), example: FIXED_EXAMPLE }),
        }
    }
}

impl FromStr for Calibration {
    type Err = OptionSyntaxError;

    fn from_str(text: &str) -> Result<Self, OptionSyntaxError> {
        let (name, right) = assignment(text, CALIBRATION_EXAMPLE)?;
        let target = Target::parse(name, CALIBRATION_EXAMPLE)?;
        let line =
            expression::parse(right).map_err(|fault| OptionSyntaxError::NotLinear { text: right.to_owned(), fault })?;
        Ok(Self {
            name: name.to_owned(),
            original: line.column,
            gain: line.gain,
            offset: line.offset,
            target,
            origin: None,
        })
    }
}
